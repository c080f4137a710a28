"""Extremes of a drop on a plane (P1-P4, P6, P12, N9): right, or a status that says why not."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet, some, worst

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


@pytest.mark.parametrize("angle", [0.5289, 0.6206, 0.85])
def test_the_flattest_caps_stop_at_the_floor_of_rounding(angle):
    solution = iga.solve(droplet(angle))
    assert worst(solution.measures, cap_on_plane(angle), ("height", "p_base")) < 1e-9
    assert len(solution.iterations) <= 5


EASY = [(150, bond) for bond in (0, 1e-6, 1e-3, 0.1, 1, 10, 100)]
OTHERS = [(150, 1000), *((180, bond) for bond in (1e-3, 0.1, 1, 10, 100, 1000))]


@pytest.mark.parametrize(
    ("angle", "bond"), [*EASY, *(pytest.param(*case, marks=pytest.mark.slow) for case in OTHERS)]
)
def test_bond_numbers_from_zero_to_a_thousand(angle, bond):
    solution = iga.solve(droplet(angle, bond))
    exact = drop_on_plane(bond, angle)
    assert worst(solution.measures, exact, ("height", "p_base")) <= 1e-3
    if bond == 1000:
        puddle = 2 * np.sin(np.radians(0.5 * angle)) / np.sqrt(bond)
        assert solution.measures["height"] == pytest.approx(puddle, rel=2e-2)


@pytest.mark.parametrize(
    ("bond", "space"),
    some(
        [
            *((bond, "bspline") for bond in (1e-6, 7e-6, 3e-5, 1e-4, 2e-3, 1e-2)),
            *((bond, "nurbs") for bond in (1e-6, 4e-4)),
        ],
        {0, 2, 5, 7},
    ),
)
def test_a_small_ball_stands_on_the_foot_that_carries_its_weight(bond, space):
    """Mahadevan and Pomeau (1999): a^2 = 2 Bo R^2 / 3 to the leading order."""
    found = iga.solve(droplet(180, bond, space=space))
    radius = found.measures["contact_radius"]
    leading = np.sqrt(2.0 * bond / 3.0) * (1.0 - bond / 3.0)
    assert radius == pytest.approx(leading, rel=2e-4)
    carried = np.pi * radius**2 * found.measures["p_base"]
    assert carried == pytest.approx(bond * UNIT_VOLUME, rel=1e-6)
    assert found.contact["support_force"] == pytest.approx(bond * UNIT_VOLUME, rel=1e-6)
    exact = drop_on_plane(bond, 180)
    assert worst(found.measures, exact, ("height", "p_base", "contact_radius")) <= 1e-6


def test_no_tangent_of_the_spline_makes_a_wrong_small_foot():
    """On a coarse mesh the tangents beside a small foot are wrong, which is said; the balance that
    places the edge is not."""
    found = iga.solve(droplet(180, 1e-6, elements=12), on_fail="return")
    assert found.status in (iga.Status.UNDERRESOLVED, iga.Status.PENETRATION)
    assert found.measures["contact_radius"] == pytest.approx(np.sqrt(2e-6 / 3.0), rel=1e-5)


def test_a_large_droplet_at_180_degrees_stands_on_its_weight_too():
    for bond in (1.0, 50.0):
        found = iga.solve(droplet(180, bond))
        exact = drop_on_plane(bond, 180)
        assert worst(found.measures, exact, ("height", "p_base", "contact_radius")) <= 1e-6
        assert found.audit.force <= 1e-8


@pytest.mark.parametrize("model", ["eighth", "full"])
def test_a_ball_without_weight_touches_its_plane_in_a_point(model):
    """P2"""
    found = iga.solve(droplet(180, 0.0, model=model), on_fail="return")
    assert (found.status, found.kind) == (iga.Status.TOPOLOGY_CHANGE, "touches_in_a_point")
    x = found.surface.grid(65, 65, 1).position
    assert np.abs(np.linalg.norm(x - [0.0, 0.0, 1.0], axis=-1) - 1.0).max() < 1e-7
    assert found.measures["pressure"] == pytest.approx(2.0, abs=1e-10)
    # it has not moved along the plane
    net = found.surface.points[:, :2]
    assert np.abs(net.max(axis=0) + net.min(axis=0)).max() < 1e-8
    assert found.measures["contact_radius"] < 1e-3
    assert any("rolls along x and y and lifts off" in text for text in found.warnings)
    with pytest.raises(iga.SceneError, match="holds it already"):
        droplet(180, 0.0, hold="xyz")


@pytest.mark.parametrize(
    "angle", [150, *(pytest.param(a, marks=pytest.mark.slow) for a in (30, 90))]
)
def test_a_heavy_droplet_is_found_from_that_without_weight(angle):
    """P4: one load step from a ball's cap to a puddle."""
    start = droplet(angle).surface
    scene = iga.sessile_droplet(
        iga.Plane(contact_angle=angle), volume=UNIT_VOLUME, gravity=1000.0, start=start
    )
    solution, direct = iga.solve(scene), iga.solve(droplet(angle, 1000.0))
    assert solution.last_good_load.load == 1.0
    assert worst(solution.measures, direct.measures) <= 1e-6


@pytest.mark.parametrize("volume", [1e-30, 1e30])
def test_volumes_beyond_any_unit(volume):
    """N9: the digits are those of any other volume, and so is the way to them."""
    scene = iga.sessile_droplet(iga.Plane(contact_angle=70), volume=volume)
    solution, base = iga.solve(scene), iga.solve(droplet(70))
    assert abs(solution.newton_iterations - base.newton_iterations) <= 1
    length = (volume / UNIT_VOLUME) ** (1 / 3)
    for name, power in {"contact_radius": 1, "height": 1, "A_LG": 2, "p_base": -1}.items():
        found = solution.measures[name] / length**power
        assert found == pytest.approx(base.measures[name], rel=1e-9), name
    radius = cap_on_plane(70.0)["contact_radius"] * length
    assert solution.measures["contact_radius"] == pytest.approx(radius, rel=1e-8)


TILTED = [
    (120.0, {}),
    *(pytest.param(angle, {}, marks=pytest.mark.slow) for angle in (30.0, 60.0, 150.0)),
    pytest.param(180.0, {"penalty": 1e4, "penetration_tolerance": 0.1}, marks=pytest.mark.slow),
    pytest.param(180.0, {"start": "touching"}, marks=pytest.mark.slow),
]


@pytest.mark.parametrize("degrees", [1e-3, 5.0, 45.0, 90.0])
@pytest.mark.parametrize(("angle", "options"), TILTED)
def test_nothing_holds_a_drop_on_a_smooth_tilted_plane(angle, options, degrees):
    """P12"""
    tilt = np.radians(degrees)
    gravity = (np.sin(tilt), 0.0, -np.cos(tilt))
    given = {"volume": UNIT_VOLUME, "gravity": gravity} | options
    scene = iga.sessile_droplet(iga.Plane(contact_angle=angle), **given)
    solution = iga.solve(scene, on_fail="return")
    assert solution.status is iga.Status.NO_EQUILIBRIUM
    asked = UNIT_VOLUME * np.sin(tilt)
    assert solution.hold_force == pytest.approx([-asked, 0, 0], rel=1e-3, abs=1e-12)


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
