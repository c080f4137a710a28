"""Particles that move: equilibrium, stability, pull-off, and the answer on self-cleaning."""

import tomllib
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet_file

import iga_membrane as iga
from iga_membrane.driver.result_file import result


def sheet(angle=90.0, height=0.0, *, density=1.0, gravity=0.1, motion="fixed", size=5.0, **mesh):
    """Circular sheet with a particle whose top stands at a height."""
    particle = iga.Sphere(angle, 1.0, (0.0, 0.0, height - 1.0), density, motion)
    mesh = iga.Discretization(**mesh)
    return iga.liquid_sheet(
        particle, size=size, boundary="circle", gravity=gravity, discretization=mesh
    )


def lift(solution):
    return solution.forces[0].effective[2]


@pytest.mark.parametrize(
    ("angle", "density", "low"),
    [(65.0, 1.0, 0.8), pytest.param(115.0, 0.6, 0.2, marks=pytest.mark.slow)],
)
def test_free_particle_on_sheet_rests_at_root_of_force_curve(angle, density, low):
    free = iga.solve(sheet(angle, density=density, motion="vertical"))
    root = iga.critical_value(lambda h: sheet(angle, h, density=density), lift, low, low + 0.7)
    assert abs(lift(free)) <= 1e-8
    assert free.forces[0].center[2] + 1.0 == pytest.approx(root.value, abs=1e-7)
    assert free.scene.substrate.center[2] == free.forces[0].center[2]
    # the force falls on the way up: it draws the particle back
    assert not root.rising
    assert free.index == 0


@pytest.mark.slow
def test_equilibrium_does_not_depend_on_where_particle_starts():
    heights = [
        iga.solve(sheet(100.0, start, motion="vertical")).forces[0].center[2]
        for start in (-0.4, 0.3)
    ]
    assert heights[0] == pytest.approx(heights[1], abs=1e-7)


@pytest.mark.slow
def test_particle_too_heavy_for_its_line_falls_off():
    """At 150 degrees no contact line carries more than 2 pi gamma r cos^2(75 degrees)."""
    fallen = iga.solve(sheet(150.0, motion="vertical"), on_fail="return")
    assert (fallen.status, fallen.kind) == (iga.Status.TOPOLOGY_CHANGE, "detached")
    assert not fallen.success
    bracket = fallen.bracket
    assert bracket.parameter == "particle[0] displacement"
    assert bracket.hi < bracket.lo < 0.0
    assert bracket.lo - bracket.hi <= 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("angle", [30.0, 90.0, 150.0])
def test_pull_off_reaches_the_line_s_largest_force_and_never_more(angle):
    found = iga.pull_off(sheet(angle, gravity=0.0, motion="vertical", size=12.0, elements=8))
    line = max(s.forces[0].contact_line[2] for s in found.solutions)
    most = 2.0 * np.pi * np.cos(0.5 * np.radians(angle)) ** 2
    assert line <= most * (1.0 + 1e-6)
    assert found.force == pytest.approx(most, rel=1e-5)
    assert found.limit == "line"
    assert found.bracket.hi < found.bracket.lo < found.at < 0.0
    assert found.bracket.lo - found.bracket.hi <= 0.01 * abs(found.bracket.lo)
    assert found.displacements[0] == 0.0 > found.displacements[-1] == found.bracket.lo


@pytest.mark.slow
def test_pull_off_is_bounded_by_film_where_rim_is_near():
    """The line would contract beyond the rim before its force falls."""
    found = iga.pull_off(sheet(30.0, gravity=0.0, motion="vertical", size=1.6))
    assert found.limit == "film"
    assert found.force < 0.99 * 2.0 * np.pi * np.cos(np.radians(15.0)) ** 2


def test_pull_needs_one_free_particle():
    with pytest.raises(iga.SceneError, match=r"particle\.motion: exactly one particle"):
        iga.pull_off(sheet())


@pytest.mark.parametrize("boundary", ["circle", pytest.param("square", marks=pytest.mark.slow)])
def test_self_cleaning_turns_at_critical_density(boundary):
    def scene(density):
        particle = iga.Sphere(85.0, 1.0, (0.0, 0.0, -1.0), density)
        return iga.liquid_sheet(particle, size=5.0, boundary=boundary, gravity=0.3)

    critical = iga.critical_value(scene, lift, 0.1, 5.0).value
    answers = [
        iga.self_cleaning(scene(critical * part), friction=0.3).verdicts[0]
        for part in (0.999, 1.001)
    ]
    assert [each.answer for each in answers] == ["lifted", "stays"]
    assert answers[0].normal == pytest.approx(answers[0].weight, rel=2e-3)
    assert answers[0].slide == np.inf
    assert answers[1].slide < 1e-6


# ---------------------------------------------------------------- on a droplet

PLANE = iga.Plane(150.0)
BOND = 0.5


def droplet(*particles, hold="none"):
    return iga.sessile_droplet(
        PLANE, volume=UNIT_VOLUME, gravity=BOND, particles=particles, hold=hold
    )


def along_normal(free, solution):
    return float(solution.forces[0].effective @ free.lines[0])


@cache
def carried(motion="normal"):
    """A heavy particle on a droplet's shoulder."""
    particle = iga.Sphere(90.0, 0.2, (0.82, 0.0, 1.12), 2.0, motion)
    scene = droplet(particle, hold="x")
    return scene, iga.solve(scene)


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["normal", "vertical"])
def test_free_particle_on_droplet_is_in_balance_along_its_line(motion):
    scene, solution = carried(motion)
    assert abs(along_normal(scene.free_particles, solution)) <= 1e-8 * 0.2
    moved = np.subtract(solution.forces[0].center, (0.82, 0.0, 1.12))
    line = scene.free_particles.lines[0]
    assert np.linalg.norm(moved) > 1e-3
    assert np.linalg.norm(moved - (moved @ line) * line) < 1e-12
    # its energy is least there
    energies = []
    for way in (-0.02, 0.0, 0.02):
        center = solution.forces[0].center + way * line
        beside = replace(solution.scene.particles[0], center=tuple(center))
        found = iga.solve(droplet(beside, hold="x"))
        weight = beside.density * 4.0 / 3.0 * np.pi * beside.radius**3 * BOND
        energies.append(found.measures["energy"] + weight * center[2])
    assert energies[1] < min(energies[0], energies[2])


@pytest.mark.slow
def test_two_free_particles_rise_like_one_another():
    one = iga.Sphere(80.0, 0.15, (0.75, 0.0, 1.2), 1.5, "normal")
    # held: away from both it would slip sideways
    pair = iga.solve(droplet(one, replace(one, center=(-0.75, 0.0, 1.2)), hold="xy"))
    (x, y, z), (u, v, w) = (f.center for f in pair.forces)
    assert (x, y, z) == pytest.approx((-u, v, w), abs=1e-5)
    for force, center in zip(pair.forces, [(x, y, z), (u, v, w)], strict=True):
        line = np.subtract(center, one.center) if center[0] > 0 else None
        if line is not None:
            assert abs(force.effective @ line) / np.linalg.norm(line) <= 1e-8 * 0.15


@pytest.mark.slow
def test_resting_particle_stays_where_liquid_presses_it_down():
    """Or is lifted, when it is light and wettable enough."""
    alone = iga.solve(droplet())
    x = alone.surface.grid(3, 400, 1).position[0]
    low = x[x[:, 2] < 0.5 * alone.measures["height"]]
    beside = float(np.hypot(*low[np.abs(low[:, 2] - 0.3).argmin(), :2]))
    heavy, light = (
        iga.solve(droplet(iga.Sphere(60.0, 0.3, (beside, 0.0, 0.3), density, "resting"), hold="x"))
        for density in (20.0, 0.0)
    )
    assert heavy.forces[0].center[2] == pytest.approx(0.3, abs=1e-15)
    assert heavy.forces[0].effective[2] < 0.0
    assert light.forces[0].center[2] > 0.3 + 1e-3
    assert abs(light.forces[0].effective[2]) <= 1e-8 * 0.3


@pytest.mark.slow
def test_scene_file_reads_motion():
    text = "[[particle]]\nradius = 0.2\ncontact_angle = 90.0\ncenter = [0.82, 0.0, 1.12]\n"
    text += 'density = 2.0\nmotion = "normal"\n[droplet]\nhold = "x"\n'
    scene = iga.read_scene(tomllib.loads(droplet_file(150.0, BOND, text))).scene
    asked, solution = carried("normal")
    assert scene.description["particle"] == asked.description["particle"]
    assert scene.description["particle"][0]["motion"] == "normal"
    assert scene.free_particles.lines == pytest.approx(asked.free_particles.lines)
    assert result(solution)["forces"][0]["center"] == solution.forces[0].center.tolist()


def test_motions_that_a_scene_lacks_are_refused():
    with pytest.raises(iga.SceneError, match=r'particle\[0\]\.motion = "resting": only on a plane'):
        sheet(motion="resting")
    with pytest.raises(iga.SceneError, match=r'substrate\.motion = "vertical".*is fixed'):
        iga.sessile_droplet(iga.Sphere(90.0, 1.0, motion="vertical"), volume=1.0)
    with pytest.raises(iga.SceneError, match=r"particle\.motion"):
        iga.Sphere(90.0, 1.0, motion="sideways")


@pytest.mark.slow
def test_length_of_the_plane_s_normal_does_not_matter():
    """Lines are unit vectors, and verdicts are the forces themselves."""
    particle = iga.Sphere(90.0, 0.2, (0.82, 0.0, 1.12), 2.0, "resting")

    def scene(size):
        plane = iga.Plane(150.0, normal=(0.0, 0.0, size))
        return iga.sessile_droplet(
            plane, volume=UNIT_VOLUME, gravity=BOND, particles=[particle], hold="x"
        )

    assert scene(3.0).free_particles.lines == pytest.approx(np.array([[0.0, 0.0, 1.0]]))
    one, three = (iga.self_cleaning(scene(size), friction=0.3).verdicts[0] for size in (1.0, 3.0))
    assert three.normal == pytest.approx(one.normal, rel=1e-9)
    assert three.weight == pytest.approx(2.0 * 4.0 / 3.0 * np.pi * 0.2**3 * BOND, rel=1e-12)
    assert three.slide == pytest.approx(one.slide, rel=1e-9)
