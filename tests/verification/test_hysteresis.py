"""Contact lines with memory against exact loops of volume."""

from functools import lru_cache

import numpy as np
import pytest
from helpers import UNIT_VOLUME
from scipy.optimize import brentq
from taylor import remainder_slopes

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane
from iga_membrane.terms.line_friction import LineFriction


def radius(part, angle):
    """Of the foot of a droplet of a part of the unit volume, Bond number 1."""
    length = part ** (1.0 / 3.0)
    return length * drop_on_plane(length**2, angle)["contact_radius"]


def exact(parts, receding, advancing, placed):
    """Radii and angles: the line stays unless its angle would leave the range."""
    at, found = radius(parts[0], placed), []
    for part in parts:
        least, most = radius(part, advancing), radius(part, receding)
        at = min(max(at, least), most)
        angle = {least: advancing, most: receding}.get(at)
        if angle is None:
            angle = brentq(lambda a: radius(part, a) - at, receding - 0.1, advancing + 0.1)  # noqa: B023
        found.append((at, angle))
    return np.array(found).T


@lru_cache
def evolved(parts, receding, advancing, placed):
    solid = iga.Plane(contact_angle=iga.Hysteresis(receding, advancing))

    def at(part):
        return iga.sessile_droplet(solid, volume=part * UNIT_VOLUME, gravity=1.0, placed_at=placed)

    return iga.evolve(at, list(parts), parameter="liquid.volume")


LOOP = (1.0, 1.3, 1.8, 1.8, 1.2, 0.7, 0.5, 0.6, 0.9, 1.1)


@pytest.mark.parametrize(
    ("parts", "angles"),
    [
        ((1.0, 1.8, 0.7), (80.0, 120.0, 100.0)),
        pytest.param(LOOP, (80.0, 120.0, 100.0), marks=pytest.mark.slow),
        pytest.param((1.0, 0.6, 0.3, 0.5, 1.0, 1.6), (35.0, 70.0, 60.0), marks=pytest.mark.slow),
        pytest.param((1.0, 1.5, 0.4, 1.5), (100.0, 150.0, 101.0), marks=pytest.mark.slow),
    ],
)
def test_loops_of_volume_are_exact(parts, angles):
    """Pinned, advancing, pinned, receding: evaporation in two stages."""
    path = evolved(parts, *angles)
    assert path.success
    radii, exact_angles = exact(parts, *angles)
    assert path.column("contact_radius") == pytest.approx(radii, rel=1e-5)
    assert path.column("contact_angle_measured") == pytest.approx(exact_angles, abs=0.01)
    moves = np.abs(exact_angles[:, None] - [angles[:2]]).min(axis=1) < 1e-9
    assert path.column("pinned_fraction") == pytest.approx(1.0 - moves)


def test_heat_is_the_work_of_the_moving_line():
    """gamma (cos R - cos Y) on every area that is swept, and never less than before."""
    path = evolved((1.0, 1.8, 0.7), 80.0, 120.0, 100.0)
    areas = np.pi * path.column("contact_radius") ** 2
    swept = np.cumsum(np.abs(np.diff(areas, prepend=areas[0])))
    receding, advancing = np.cos(np.radians([80.0, 120.0]))
    assert np.array(path.dissipated) == pytest.approx(
        0.5 * (receding - advancing) * swept, abs=1e-6
    )


@pytest.mark.slow
def test_a_pinned_line_holds_a_droplet_on_a_slope():
    """F = gamma oint cos(theta) m ds; for a circle (pi / 2) gamma r (cos_back - cos_front) to the
    first order."""
    solid = iga.Plane(contact_angle=iga.Hysteresis(70.0, 120.0))
    mesh = iga.Discretization(elements=16, model="half")

    def at(tilt):
        pull = [np.sin(np.radians(tilt)), 0.0, -np.cos(np.radians(tilt))]
        return iga.sessile_droplet(
            solid, volume=UNIT_VOLUME, gravity=pull, placed_at=95.0, discretization=mesh
        )

    path = iga.evolve(at, [0.0, 0.5, 0.0], parameter="gravity.tilt")
    placed, leaning, back = (s.measures for s in path.solutions)
    cosines = np.cos(np.radians([leaning["angle_rear"], leaning["angle_front"]]))
    held = 0.5 * np.pi * leaning["contact_radius"] * (cosines[0] - cosines[1])
    assert held == pytest.approx(UNIT_VOLUME * np.sin(np.radians(0.5)), rel=2e-3)
    assert leaning["pinned_fraction"] == 1.0
    assert leaning["contact_radius"] == pytest.approx(placed["contact_radius"], rel=1e-8)
    assert back["energy"] == pytest.approx(placed["energy"], rel=1e-8)


def test_friction_has_exact_derivatives():
    """Lines that stay, advance and recede at once."""
    found = iga.sessile_droplet(
        iga.Plane(95.0), volume=2.0, discretization=iga.Discretization(elements=6, model="half")
    )
    start, rng = found.surface.points, np.random.default_rng(0)
    friction = LineFriction(1.0, -0.3, 0.2, start, np.full(len(start), -0.05), 20.0)
    table = found.surface.space.edge_table("xi2=0")
    points = start + 0.02 * rng.standard_normal(start.shape)
    way = 1e-2 * rng.standard_normal(start.shape)
    local = way[table.functions]
    slope = (friction.forces(table, points, friction.strength, None) * local).sum()
    hessian = friction.hessian(table, points, friction.strength, None)
    bend = np.einsum("eai,eaibj,ebj->", local, hessian, local)
    first, second = remainder_slopes(
        lambda h: friction.energy(table, points + h * way, friction.strength, None), slope, bend
    )
    assert first >= 1.9
    assert second >= 2.9


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: iga.Hysteresis(110.0, 80.0), "must be > the receding angle"),
        (lambda: iga.Sphere(iga.Hysteresis(80.0, 110.0), 1.0), "contact_angle"),
        (lambda: iga.sessile_droplet(iga.Plane(90.0), volume=1.0, placed_at=95.0), "hysteresis"),
        (lambda: iga.sessile_droplet(iga.Plane(iga.Hysteresis(80.0, 110.0)), volume=1.0,
                                     placed_at=120.0), "placed_at = 120"),
        (lambda: iga.sessile_droplet(iga.Plane(iga.Hysteresis(80.0, 110.0)), volume=1.0,
                                     particles=[iga.Sphere(90.0, 0.2, (0.0, 0.0, 1.0))]),
         "not available yet with particles"),
        (lambda: iga.capillary_bridge(iga.Plane(iga.Hysteresis(80.0, 110.0)), iga.Plane(60.0),
                                      gap=0.1, volume=1.0), "has no memory"),
        (lambda: iga.evolve(lambda v: iga.sessile_droplet(iga.Plane(90.0), volume=v), [1.0, 2.0]),
         "needs a Hysteresis"),
        (lambda: iga.evolve(lambda v: iga.sessile_droplet(iga.Plane(90.0), volume=v), [1.0, 2.0],
                            options=iga.SolverOptions(checkpoint="state.npz")), "not available"),
    ],
)  # fmt: skip
def test_what_has_no_memory_is_refused(make, said):
    with pytest.raises(iga.SceneError, match=said):
        make()
