import numpy as np
import pytest

from iga_membrane.surface.inside import inside


@pytest.mark.parametrize("turned", [1, -1])
def test_points_inside_and_outside_an_ellipsoid_with_a_dent(turned):
    polar, azimuth = np.linspace(0.0, np.pi, 65), np.linspace(0.0, 2.0 * np.pi, 65)
    radius = np.sin(polar)
    height = 0.5 * np.cos(polar) + 0.8 * radius**2  # hollow on top
    x = np.stack(
        [np.outer(f(azimuth), radius) for f in (np.cos, np.sin)] + [np.tile(height, (65, 1))],
        axis=-1,
    )[::turned]
    points = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.7), (0.9, 0.0, 0.75), (0.9, 0.0, 0.0), (5.0, 5.0, 5.0)]
    assert inside(x, np.array(points)).tolist() == [True, False, True, False, False]


def test_no_points_are_nowhere():
    assert inside(np.zeros((3, 3, 3)), np.zeros((0, 3))).shape == (0,)
