import numpy as np
import pytest
from scipy.interpolate import BSpline

from iga_membrane import SceneError
from iga_membrane.splines import (
    bspline_basis,
    lagrange_basis,
    line_basis,
    open_knots,
    periodic_basis,
    tensor_space,
)

T = np.linspace(0.0, 1.0, 57)


@pytest.mark.parametrize("degree", [2, 3, 4])
@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_bsplines_agree_with_scipy(degree, derivative):
    knots = open_knots(np.linspace(0, 1, 7) ** 1.4, degree)
    basis = bspline_basis(knots, degree)
    exact = np.column_stack(
        [BSpline(knots, row, degree)(T, derivative) for row in np.eye(basis.count)]
    )
    assert basis.matrix(T, derivative) == pytest.approx(exact, abs=1e-11)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_lagrange_is_one_at_its_node_and_zero_at_the_others(degree):
    basis = lagrange_basis([0.0, 0.3, 1.0], degree)
    assert basis.matrix(basis.abscissae) == pytest.approx(np.eye(basis.count), abs=1e-12)


@pytest.mark.parametrize("kind", ["bspline", "lagrange"])
@pytest.mark.parametrize("degree", [2, 3, 4])
def test_polynomials_of_the_degree_are_reproduced(kind, degree):
    basis = line_basis(kind, 5, degree)
    for power in range(degree + 1):
        c = np.linalg.solve(basis.matrix(basis.abscissae), basis.abscissae**power)
        assert basis.matrix(T) @ c == pytest.approx(T**power, abs=1e-12)
        slope = power * T ** max(power - 1, 0)
        assert basis.matrix(T, 1) @ c == pytest.approx(slope, abs=1e-10)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_a_ring_is_as_smooth_at_its_seam_as_elsewhere(degree):
    basis = periodic_basis(9, degree, 2 * np.pi)
    for derivative in range(degree):
        before, after = basis.matrix([2 * np.pi - 1e-12, 1e-12], derivative)
        assert before == pytest.approx(after, abs=1e-9)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_ring_converges_to_the_circle_at_its_order(degree):
    errors = []
    for elements in (8, 16, 32):
        basis = periodic_basis(elements, degree, 2 * np.pi)
        c = np.linalg.solve(basis.matrix(basis.abscissae), np.cos(basis.abscissae))
        t = np.linspace(0, 2 * np.pi, 400)
        errors.append(np.abs(basis.matrix(t) @ c - np.cos(t)).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates.min() >= degree + 1 - 0.2
    assert errors[-1] < [0, 0, 1e-4, 4e-6, 2e-7][degree]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: periodic_basis(9, 1), "C1 needed"),
        (lambda: periodic_basis(3, 3), "elements = 3"),
        (lambda: lagrange_basis([0, 1], 5), "degree = 5"),
        (lambda: tensor_space(line_basis("bspline", 2, 2), line_basis("bspline", 2, 2),
                              np.ones((3, 4))), "weights: shape"),
        (lambda: tensor_space(line_basis("bspline", 1, 2), line_basis("bspline", 1, 2),
                              [[1, 1, 1], [1, -2, 1], [1, 1, 1]]), r"weights\[1, 1\] = -2"),
    ],
)  # fmt: skip
def test_bad_bases_are_refused(make, message):
    with pytest.raises(SceneError, match=message):
        make()
