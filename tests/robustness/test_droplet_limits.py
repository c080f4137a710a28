"""Extremes of a drop on a plane (P1, P3, P6, N9): right, or a status that says why not."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet, worst

import iga_membrane as iga
from iga_membrane.reference import cap_on_plane, drop_on_plane

ANGLES = [0.5, 1, 5, 30, 60, 90, 120, 150, 170, 179, 179.5, 179.9]


@pytest.mark.parametrize("angle", ANGLES)
def test_caps_at_every_angle(angle):
    solution = iga.solve(droplet(angle), on_fail="return")
    allowed = 1e-2 if angle in (0.5, 179.5, 179.9) else 1e-3
    exact = cap_on_plane(angle)
    error = worst(solution.measures, exact, ("height", "contact_radius", "p_base"))
    if solution.success:
        assert error <= allowed
    else:
        assert solution.status is iga.Status.UNDERRESOLVED
        assert exact["contact_radius"] < 0.02


@pytest.mark.parametrize("bond", [0, 1e-6, 1e-3, 0.1, 1, 10, 100, 1000])
def test_bond_numbers_from_zero_to_a_thousand(bond):
    solution = iga.solve(droplet(150, bond))
    exact = drop_on_plane(bond, 150)
    assert worst(solution.measures, exact, ("height", "p_base")) <= 1e-3
    if bond == 1000:
        puddle = 2 * np.sin(np.radians(75)) / np.sqrt(bond)
        assert solution.measures["height"] == pytest.approx(puddle, rel=2e-2)


@pytest.mark.parametrize("volume", [1e-30, 1e30])
def test_volumes_beyond_any_unit(volume):
    solution = iga.solve(iga.sessile_droplet(iga.Plane(contact_angle=70), volume=volume))
    radius = cap_on_plane(70.0)["contact_radius"] * (volume / UNIT_VOLUME) ** (1 / 3)
    assert solution.measures["contact_radius"] == pytest.approx(radius, rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("angle", [3, 7, 20, 40, 70, 100, 130, 155, 168, 172, 177, 179])
@pytest.mark.parametrize("bond", [0, 0.003, 0.2, 2, 8, 20, 45, 59, 80, 100])
def test_the_whole_family_on_a_grid(angle, bond):
    solution = iga.solve(droplet(angle, bond))
    extreme = not 10 < angle < 170 or bond >= 60
    assert worst(solution.measures, drop_on_plane(bond, angle)) <= (1e-3 if extreme else 1e-6)


def test_a_penalty_too_hard_for_newton_ends_with_a_name():
    scene = iga.sessile_droplet(iga.Plane(180.0), volume=UNIT_VOLUME, gravity=1.0, penalty=1e9)
    found = iga.solve(scene, on_fail="return")
    assert found.status in (iga.Status.STALLED, iga.Status.MAX_ITER, iga.Status.CONVERGED_STABLE)
    if not found.success:
        assert found.message
