import numpy as np
import pytest

from iga_membrane import SceneError
from iga_membrane.splines import Grading, bspline_basis, check_knots, insertion_matrix, open_knots


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_knot_insertion_leaves_the_curve(degree):
    rng = np.random.default_rng(degree)
    knots = open_knots([0, 0.2, 0.5, 0.9, 1], degree)
    basis = bspline_basis(knots, degree)
    finer, matrix = insertion_matrix(knots, degree, [0.1, 0.5, 0.77])
    points = rng.standard_normal((basis.count, 3))
    t = np.linspace(0, 1, 101)
    fine = bspline_basis(finer, degree, continuity=degree - 2)
    assert np.allclose(
        fine.matrix(t) @ (matrix @ points), basis.matrix(t) @ points, rtol=0, atol=1e-13
    )


@pytest.mark.parametrize(
    ("knots", "message"),
    [
        ([0, 0, 0, 0.5, float("nan"), 1, 1, 1], r"knots\[4\] = nan"),
        ([0, 0, 0, 0.6, 0.4, 1, 1, 1], r"knots\[4\] = 0.4 is smaller"),
        ([0, 0, 0, 0.5, 0.5, 1, 1, 1], r"knots\[3\] = 0.5 is repeated 2 times: .* C1 needed"),
        ([0, 0, 0, 0, 0.5, 1, 1, 1], r"knots\[0\] = 0 is repeated 4 times"),
        ([0, 0, 1, 1], "too few"),
        ([0, 0.1, 0.2, 0.5, 1, 1, 1], "clamped"),
    ],
)
def test_bad_knots_are_named_by_index(knots, message):
    with pytest.raises(SceneError, match=message):
        check_knots(knots, 2)


@pytest.mark.parametrize("degree", [0, 1])
def test_a_spline_needs_c1(degree):
    with pytest.raises(SceneError, match="C1 needed"):
        bspline_basis(open_knots([0, 1, 2], degree), degree)


@pytest.mark.parametrize("even", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("first", [1.0, 0.5, 0.1, 1e-3, 1e-6])
def test_grading_has_the_first_step_asked_for(first, even):
    grading = Grading(first, even)
    assert grading.fraction([0.0, 1.0]) == pytest.approx([0.0, 1.0], abs=1e-15)
    assert grading.slope(0.0) == pytest.approx(first, rel=1e-12)
    h = 1e-6
    t = np.linspace(0.1, 0.9, 9)
    difference = (grading.fraction(t + h) - grading.fraction(t - h)) / (2 * h)
    assert grading.slope(t) == pytest.approx(difference, rel=1e-8)


def test_a_grading_with_equal_steps_does_not_make_the_rest_coarse():
    growing, even = (Grading(1e-4, part).slope(np.linspace(0.6, 1.0, 5)) for part in (0.0, 0.5))
    assert even == pytest.approx(2.0, rel=0.2)
    assert growing[-1] > 10.0
