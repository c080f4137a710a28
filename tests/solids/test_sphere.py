import numpy as np
import pytest

import iga_membrane as iga

SPHERE = iga.Sphere(contact_angle=120, radius=0.7, center=(0.1, -0.2, 0.3))
POINTS = np.random.default_rng(0).uniform(-2, 2, (20, 3))


def test_closest_points_lie_on_the_sphere_along_the_normal():
    closest = SPHERE.closest_point(POINTS)
    assert SPHERE.gap(closest) == pytest.approx(0.0, abs=1e-14)
    rebuilt = closest + SPHERE.gap(POINTS)[:, None] * SPHERE.normal(POINTS)
    assert rebuilt == pytest.approx(POINTS, abs=1e-14)


def test_normal_and_hessian_are_the_derivatives_of_the_gap():
    h = 1e-5
    for axis in np.eye(3):
        slope = (SPHERE.gap(POINTS + h * axis) - SPHERE.gap(POINTS - h * axis)) / (2 * h)
        assert SPHERE.normal(POINTS) @ axis == pytest.approx(slope, abs=1e-9)
        bend = (SPHERE.normal(POINTS + h * axis) - SPHERE.normal(POINTS - h * axis)) / (2 * h)
        assert SPHERE.gap_hessian(POINTS) @ axis == pytest.approx(bend, abs=1e-8)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"radius": 0.0}, "radius must be > 0"),
        ({"contact_angle": 181.0}, "contact_angle must be"),
        ({"center": (0, 0)}, "three numbers"),
        ({"center": (0, 0, float("nan"))}, "center"),
    ],
)
def test_bad_spheres_are_refused(values, said):
    good = {"contact_angle": 90.0, "radius": 1.0, "center": (0.0, 0.0, 0.0)}
    with pytest.raises(iga.SceneError, match=said):
        iga.Sphere(**(good | values))
