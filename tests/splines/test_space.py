import numpy as np
import pytest

from iga_membrane.splines import (
    close_pole,
    line_basis,
    net_of,
    points_of,
    ring_basis,
    tensor_space,
)


def spaces():
    for degree in (2, 3, 4):
        for kind in ("bspline", "lagrange"):
            base = tensor_space(ring_basis(kind, 9, degree, 2 * np.pi), line_basis(kind, 4, degree))
            yield pytest.param(close_pole(base), id=f"polar {kind} {degree}")
        line = line_basis("bspline", 4, degree)
        w = 1.0 + 0.5 * np.random.default_rng(degree).random((line.count, line.count))
        yield pytest.param(tensor_space(line, line, w), id=f"nurbs {degree}")


@pytest.mark.parametrize("space", list(spaces()))
def test_functions_sum_to_one_and_their_derivatives_to_zero(space):
    table = space.table(second=True)
    assert table.values.sum(-1) == pytest.approx(1.0, abs=1e-12)
    for rows in (table.d1, table.d2, *table.second):
        assert np.abs(rows.sum(-1)).max() < 1e-9


@pytest.mark.parametrize("space", list(spaces()))
def test_tables_and_point_evaluation_agree(space):
    table = space.table(3, second=True)
    functions, rows = space.at(table.parameters.reshape(-1, 2))
    shape = table.values.shape
    assert (functions.reshape(*shape[:2], -1) == table.functions[:, None]).all()
    named = {(0, 0): table.values, (1, 0): table.d1, (0, 1): table.d2}
    named |= dict(zip([(2, 0), (1, 1), (0, 2)], table.second, strict=True))
    for key, tabulated in named.items():
        assert rows[key].reshape(shape) == pytest.approx(tabulated, abs=1e-9)


@pytest.mark.parametrize("space", list(spaces()))
def test_derivatives_agree_with_differences(space):
    rng = np.random.default_rng(0)
    points = rng.standard_normal((space.count, 1))
    ends = [basis.breaks[-1] for basis in space.bases]
    xi = (0.15 + 0.7 * rng.random((20, 2))) * ends
    h = 1e-5

    def value(shift):
        functions, rows = space.at(xi + shift)
        return {key: (row * points[functions, 0]).sum(-1) for key, row in rows.items()}

    exact = value(0.0)
    for axis, (first, second) in enumerate([((1, 0), (2, 0)), ((0, 1), (0, 2))]):
        shift = h * np.eye(2)[axis]
        up, down = value(shift), value(-shift)
        smooth = space.continuity >= 2
        assert (up[0, 0] - down[0, 0]) / (2 * h) == pytest.approx(exact[first], abs=1e-5)
        if smooth:
            assert (up[first] - down[first]) / (2 * h) == pytest.approx(exact[second], abs=1e-3)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_polar_functions_are_tensor_functions_with_a_common_tangent_plane(degree):
    base = tensor_space(
        ring_basis("bspline", 9, degree, 2 * np.pi), line_basis("bspline", 4, degree)
    )
    polar = close_pole(base)
    points = np.random.default_rng(1).standard_normal((polar.count, 3))
    net = net_of(polar, points)
    assert polar.table().derivatives(points)[0] == pytest.approx(
        base.table().derivatives(net.reshape(-1, 3))[0], abs=1e-12
    )
    assert points_of(polar, net) == pytest.approx(points, abs=1e-12)
    spokes = net[:, -2] - net[0, -1]
    assert np.linalg.matrix_rank(spokes, tol=1e-10) == 2


def test_edge_functions_are_those_of_the_boundary_row():
    line = line_basis("bspline", 4, 3)
    space = tensor_space(line, line)
    n = line.count
    assert list(space.edge_functions("xi2=0")) == list(range(0, n * n, n))
    assert list(space.edge_functions("xi1=1")) == list(range(n * (n - 1), n * n))


def test_no_elements_have_an_empty_table():
    space = tensor_space(line_basis("bspline", 3, 2), line_basis("bspline", 4, 2))
    table = space.table(3, np.zeros(0, int))
    assert table.values.shape == (0, 9, space.functions.shape[1])
