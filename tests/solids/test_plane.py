"""The frame of a plane."""

import numpy as np
import pytest

import iga_membrane as iga

NORMALS = [(0.3, -0.4, 0.2), (0.0, 0.5, 1.0), (1.0, 0.0, 0.0), (-0.2, 0.1, -1.0), (1e-8, 0.0, -1.0)]


@pytest.mark.parametrize("normal", NORMALS)
def test_the_axes_of_a_plane_are_the_worlds_turned_as_little_as_can_be(normal):
    """The axis of the smallest rotation is normal to both z and the normal, and stays."""
    axes = iga.Plane(90.0, normal=normal).axes()
    n = np.array(normal) / np.linalg.norm(normal)
    assert axes.T @ axes == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[:, 2] == pytest.approx(n, abs=1e-15)
    fixed = np.cross([0.0, 0.0, 1.0], n) / np.linalg.norm(n[:2])
    assert axes @ fixed == pytest.approx(fixed, abs=1e-14)


@pytest.mark.parametrize("z", [1.0, -1.0])
def test_level_planes_keep_the_axis_x(z):
    assert iga.Plane(90.0, normal=(0.0, 0.0, z)).axes()[:, 0].tolist() == [1.0, 0.0, 0.0]


def test_a_droplet_is_held_along_the_axis_x_of_its_plane():
    """On a plane that is tilted about the world's x, that is the world's."""
    tilt = np.radians(20.0)
    plane = iga.Plane(110.0, normal=(0.0, -np.sin(tilt), np.cos(tilt)))
    pull = 0.2 * np.array([1.0, 0.0, 0.0]) - 0.5 * np.array(plane.normal)
    mesh = iga.Discretization(elements=6)
    given = {"volume": 4.0, "gravity": pull.tolist(), "discretization": mesh}
    solution = iga.solve(iga.sessile_droplet(plane, hold="x", **given))
    assert solution.hold_force == pytest.approx((-0.2 * 4.0, 0.0, 0.0), abs=1e-8)
