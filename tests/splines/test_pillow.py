"""One square closed to a pillow: its functions cross the glued sides smoothly."""

import numpy as np
import pytest

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


@pytest.mark.parametrize(("degree", "elements"), SPACES)
def test_a_net_has_one_value_at_glued_places(degree, elements):
    space = pillow_space(degree, elements)
    points = np.random.default_rng(1).standard_normal((space.count, 3))
    assert np.array_equal(points_of(space, net_of(space, points)), points)
    # the flat square has more: the folds give up the functions beyond the sides
    assert (2 * elements) ** 2 <= space.count < (2 * elements + degree) ** 2
