"""Free droplets on one particle: the closed form in any direction, the force when it is pulled."""

from itertools import product

import numpy as np
import pytest
from helpers import UNIT_VOLUME, some

import iga_membrane as iga
from iga_membrane.initial.profiles import drop_on_sphere


def free(angle, radius, center, **given):
    particle = iga.Sphere(angle, radius, tuple(float(c) for c in center), 1.0)
    return iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=[particle], **given)


def directions(count, seed=0):
    ways = np.random.default_rng(seed).standard_normal((count, 3))
    return ways / np.linalg.norm(ways, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("angle", "radius"), some(product((20.0, 70.0, 120.0, 160.0), (0.1, 0.5)), {0, 5, 7})
)
def test_weightless_droplet_is_a_cap_in_every_direction(angle, radius):
    polar, cap = drop_on_sphere(angle, radius, UNIT_VOLUME)
    wet = 4.0 * np.pi * radius**2 * np.sin(0.5 * polar) ** 2
    for way in directions(3):
        found = iga.solve(free(angle, radius, 1.3 * way))
        assert found.success, found.message
        assert found.measures["pressure"] == pytest.approx(2.0 / cap.radius, rel=1e-8)
        assert found.measures["A_wet"] == pytest.approx(wet, rel=1e-7)
        assert np.abs(found.forces[0].effective).max() < 1e-8


@pytest.mark.parametrize(
    ("angle", "radius", "distance"),
    some([(20.0, 0.3, 0.95), (90.0, 0.1, 1.1), (140.0, 0.5, 1.45)], {0}),
)
def test_pulled_particle_feels_the_force_that_holds_the_droplet(angle, radius, distance):
    pulls = []
    for way in directions(3, seed=1):
        scene = free(angle, radius, distance * way, hold="xyz")
        found = iga.solve(scene)
        assert found.success, found.message
        force = found.forces[0].effective
        assert force == pytest.approx(found.hold_force, abs=1e-5 * np.linalg.norm(force))
        pulls.append(force @ way)
        assert np.linalg.norm(force - pulls[-1] * way) < 1e-7 * np.linalg.norm(force)
    assert np.ptp(pulls) < 1e-7 * abs(pulls[0])


def test_force_is_slope_of_energy():
    way, step = directions(1, seed=2)[0], 1e-3
    near, here, far = (
        iga.solve(free(75.0, 0.3, distance * way, hold="xyz"))
        for distance in (1.2 - step, 1.2, 1.2 + step)
    )
    slope = (far.measures["energy"] - near.measures["energy"]) / (2.0 * step)
    assert here.forces[0].effective @ way == pytest.approx(-slope, rel=1e-5)


@pytest.mark.slow
def test_droplet_pulled_off_its_particle_is_named():
    lost = iga.solve(free(160.0, 0.5, (0.0, 0.0, 1.62), hold="xyz"), on_fail="return")
    assert lost.status is iga.Status.LIMIT_POINT
    assert lost.bracket.parameter == "particle[0] displacement"
    assert lost.bracket.hi - lost.bracket.lo < 1e-3 * lost.bracket.hi


def test_pendant_droplet_hangs_from_its_particle_along_gravity():
    """Its weight is carried by the particle, whatever the direction of gravity."""
    heights = []
    for way in directions(2, seed=3):
        hanging = iga.solve(free(60.0, 0.5, -way, gravity=list(0.3 * way)))
        assert hanging.success, hanging.message
        force = hanging.forces[0].effective - hanging.forces[0].weight
        assert force == pytest.approx(0.3 * UNIT_VOLUME * way, abs=1e-7)
        heights.append(hanging.measures["A_LG"])
    assert heights[0] == pytest.approx(heights[1], rel=1e-9)


def test_droplet_with_lateral_load_on_a_sphere_is_in_balance():
    """Held against gravity that leans; the audit's balances and the slope of energy know nothing
    of the way in which the part under the cap was integrated."""
    scene = iga.sessile_droplet(
        iga.Sphere(90.0, 1.0, (0.0, 0.0, -1.0)),
        volume=1.0,
        gravity=[0.2, 0.0, -0.5],
        hold="x",
    )
    held = iga.solve(scene)
    assert held.success, held.message
    assert held.audit.defects["force"] < 1e-6


def test_droplet_about_its_particle_is_refused():
    with pytest.raises(iga.SceneError, match=r"center = \[0, 0, 0\]"):
        iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=[iga.Sphere(90.0, 0.2)])


@pytest.mark.slow
def test_moving_particle_of_held_droplet_finds_its_place_off_the_axis():
    """The droplet's frame turns with the particle on the way."""
    particle = iga.Sphere(90.0, 0.5, (1.0, 0.0, 0.01), motion="vertical")
    scene = iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=[particle], hold="xyz")
    found = iga.solve(scene)
    assert found.success, found.message
    assert abs(found.forces[0].effective[2]) <= 1e-8 * 0.5
    # at rest on the droplet, wherever that is
    at_rest = iga.solve(free(90.0, 0.5, (0.0, 0.0, 1.2)))
    assert found.measures["energy"] == pytest.approx(at_rest.measures["energy"], rel=1e-9)


def test_balance_at_a_maximum_of_the_energy_is_a_saddle():
    particle = iga.Sphere(90.0, 0.5, (1.0, 0.0, 0.0), motion="vertical")
    scene = iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=[particle], hold="xyz")
    found = iga.solve(scene, on_fail="return")
    assert found.status is iga.Status.CONVERGED_SADDLE
    assert found.index == 1


def test_cpu_limit_is_no_detachment():
    particle = iga.Sphere(90.0, 0.5, (0.0, 0.0, -1.0), motion="normal")
    scene = iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=[particle], hold="xyz")
    with pytest.raises(iga.SolveError, match="INTERRUPTED"):
        iga.pull_off(scene, iga.SolverOptions(max_cpu_s=0.5))
    stopped = iga.solve(scene, iga.SolverOptions(max_cpu_s=0.15), on_fail="return")
    assert stopped.status is iga.Status.INTERRUPTED


def test_free_droplets_that_nothing_holds_are_refused():
    with pytest.raises(iga.SceneError, match=r"gravity\.direction: a free droplet hangs"):
        free(90.0, 0.5, (0.0, 0.0, -1.0), gravity=[0.3, 0.0, 0.0])
    moving = iga.Sphere(90.0, 0.5, (0.0, 0.0, -1.0), motion="normal")
    with pytest.raises(iga.SceneError, match=r"motion = \"normal\": a free droplet follows"):
        iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=[moving])
    with pytest.raises(iga.SceneError, match="substrate: particles are cleaned from a plane"):
        iga.self_cleaning(free(90.0, 0.5, (0.0, 0.0, -1.0), hold="xyz"), friction=0.3)
