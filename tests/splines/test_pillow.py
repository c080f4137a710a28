"""One square closed to a pillow: its functions cross the glued sides smoothly."""

import numpy as np
import pytest

from iga_membrane.errors import SceneError
from iga_membrane.splines import net_of, pillow_space, points_of

SPACES = [(degree, elements) for degree in (2, 3, 4) for elements in (3, 6)]
SIDES = {
    "xi1=1": lambda t: np.stack([1 + 0 * t, t], -1),
    "xi1=-1": lambda t: np.stack([-1 + 0 * t, t], -1),
    "xi2=1": lambda t: np.stack([t, 1 + 0 * t], -1),
    "xi2=-1": lambda t: np.stack([t, -1 + 0 * t], -1),
}


@pytest.mark.parametrize(("degree", "elements"), SPACES)
def test_functions_sum_to_one_and_their_derivatives_to_zero(degree, elements):
    table = pillow_space(degree, elements).table(second=True)
    assert table.values.sum(-1) == pytest.approx(1.0, abs=1e-12)
    for rows in (table.d1, table.d2, *table.second):
        assert np.abs(rows.sum(-1)).max() < 1e-9


def test_rounding_at_the_folds_leads_no_control_point():
    """On some meshes functions that vanish there are 1e-25."""
    for elements in range(8, 100, 10):
        assert np.abs(pillow_space(2, elements).combine).max() < 10.0


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(("degree", "elements"), SPACES)
def test_derivatives_below_the_degree_cross_the_glued_sides(degree, elements, side):
    space = pillow_space(degree, elements)
    values = np.random.default_rng(0).standard_normal(space.count)
    along = np.linspace(0.05, 0.95, 31)

    def jets(t):
        functions, rows = space.at(SIDES[side](t))
        return {key: (row * values[functions]).sum(-1) for key, row in rows.items()}

    here, there = jets(along), jets(-along)
    assert np.ptp(here[0, 0]) > 0.1
    for (i, j), jet in here.items():
        if i + j < degree:  # the pillow turns by half a turn across a side
            size = elements ** (i + j)
            assert jet == pytest.approx((-1) ** (i + j) * there[i, j], abs=1e-10 * size), (i, j)


@pytest.mark.parametrize("aspect", [1.0, 3.0])
@pytest.mark.parametrize(("degree", "elements"), SPACES)
def test_functions_at_a_fold_have_the_second_derivatives_of_a_plane_in_the_squared_coordinate(
    degree, elements, aspect
):
    space = pillow_space(degree, elements, aspect)
    values = np.random.default_rng(0).standard_normal(space.count)
    inside = 1e-7 * np.array([0.6, 0.8])
    for across in (0, 1):
        for side in (1.0, -1.0):
            xi = np.roll([side, 0.0], across) - side * np.roll(inside, across)
            functions, rows = space.at(xi)
            first, second, mixed = (
                float(rows[key][0] @ values[functions[0]]) / elements ** sum(key)
                for key in ((1, 0), (2 - 2 * across, 2 * across), (1, 1))
            )
            other = float(rows[2 * across, 2 - 2 * across][0] @ values[functions[0]])
            assert abs(first) < 1e-4
            assert second == pytest.approx(-(aspect**2) * other / elements**2, abs=1e-3)
            assert abs(mixed) > 1e-3


def test_a_folded_patch_of_another_degree_is_refused():
    for degree in (1, 5):
        with pytest.raises(SceneError, match="degree 2 to 4"):
            pillow_space(degree, 6)


@pytest.mark.parametrize(("degree", "elements"), SPACES)
def test_a_net_has_one_value_at_glued_places(degree, elements):
    space = pillow_space(degree, elements)
    points = np.random.default_rng(1).standard_normal((space.count, 3))
    net = net_of(space, points)
    assert np.array_equal(points_of(space, net), points)
    # it is the net of the same surface
    one, two = space.bases
    xi = np.random.default_rng(2).uniform(-1.0, 1.0, (50, 2))
    found = np.einsum("ti,tj,ijc->tc", one.matrix(xi[:, 0]), two.matrix(xi[:, 1]), net)
    functions, rows = space.at(xi, 0)
    assert found == pytest.approx(np.einsum("ta,tac->tc", rows[0, 0], points[functions]))
    # the folds give up the functions beyond the sides, and one or two each that follow others
    ruled = 4 if degree % 2 else 8
    assert (2 * elements) ** 2 <= space.count + ruled < (2 * elements + degree) ** 2
