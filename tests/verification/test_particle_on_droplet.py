"""Particles on a droplet on a plane: forces, symmetries, the slope of the energy."""

from dataclasses import replace

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet_file
from particle_scenes import (
    BOND,
    PLANE,
    check_convergence_and_balance,
    particle,
    place,
    pull,
    scene,
    size,
    solved,
)

import iga_membrane as iga


@pytest.mark.parametrize(
    "case",
    [
        (95.0, 90.0, 0.2),
        pytest.param((65.0, 110.0, 0.3), marks=pytest.mark.slow),
        pytest.param((65.0, 75.0, 0.05), marks=pytest.mark.slow),
    ],
)
def test_forces_converge_and_balance(case):
    """By 1 part in 10,000, at fifth order; both forces on the droplet balance, faster still."""
    meshes = [solved(*case, elements=n) for n in (16, 24, 36)]
    check_convergence_and_balance(meshes, sideways=2e-4)


@pytest.mark.slow
def test_half_model_agrees_with_full():
    half, full = solved(), iga.solve(scene(particle(), hold="xy", model="full"))
    assert (half.scene.sector.model, full.scene.sector.model) == ("half", "full")
    assert full.success, full.message
    assert size(pull(full) - pull(half)) < 1e-6 * size(pull(half))
    assert full.measures["energy"] == pytest.approx(half.measures["energy"], rel=1e-8)


def test_turned_particle_turns_force():
    beside = particle()
    x, _, z = beside.center
    turned = iga.solve(scene(replace(beside, center=(0.0, x, z)), hold="xy"))
    assert turned.success, turned.message
    fx, fy, fz = pull(solved())
    assert size(pull(turned) - [-fy, fx, fz]) < 1e-6 * size(pull(turned))


@pytest.mark.slow
def test_force_is_slope_of_energy():
    _, normal = place(95.0)
    step, force = 2e-3, pull(solved(elements=24))
    for way in (normal, np.array([-normal[2], 0.0, normal[0]])):
        energies = []
        for sign in (1.0, -1.0):
            moved = iga.solve(scene(particle(shift=sign * step * way), elements=24))
            assert moved.success, moved.message
            energies.append(moved.measures["energy"])
        slope = (energies[0] - energies[1]) / (2.0 * step)
        assert abs(force @ way) > 0.05 * size(force)
        assert force @ way == pytest.approx(-slope, abs=3e-4 * size(force))


@pytest.mark.parametrize(
    "polar", [35.0, pytest.param(95.0, marks=pytest.mark.slow)], ids=["near", "opposite"]
)
def test_mirror_images_have_mirrored_forces(polar):
    """No mirror plane between them is used: the patch has its pole in one."""
    one = particle(polar, radius=0.3)
    x, _, z = one.center
    pair = iga.solve(scene(one, replace(one, center=(-x, 0.0, z)), hold="xy"))
    assert pair.success, pair.message
    assert pair.scene.sector.model == "half"
    fx, fy, fz = pull(pair, 0)
    assert size(pull(pair, 1) - [-fx, fy, fz]) < 1e-4 * size(pull(pair))
    assert abs(pair.hold_force[0]) < 1e-4 * size(pull(pair))


def test_model_with_particle_beside_its_mirror_plane_is_refused():
    one = particle()
    x, _, z = one.center
    pair = [replace(one, center=(y * 0.6, y, z)) for y in (-0.8 * x, 0.8 * x)]
    assert scene(*pair, hold="xy").sector.model == "full"
    with pytest.raises(iga.SceneError, match=r'model = "half".*do not lie in its mirror planes'):
        scene(*pair, hold="xy", model="half")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            [(1.0, 0.0, 0.7), (1.1, 0.2, 0.7)],
            r"particle\[0\], particle\[1\].*sum of their radii 0\.4: they overlap by 0\.176",
        ),
        (
            [(0.9, 0.0, 0.15)],
            r"particle\[0\].*0\.15 above the plane.*reaches 0\.05 into the substrate",
        ),
        ([(2.0, 0.0, 0.7)], r"particle\[0\]\.center.*farther than a meniscus reaches"),
    ],
)
def test_particles_in_wrong_places_are_refused(given, said):
    with pytest.raises(iga.SceneError, match=said):
        scene(*(iga.Sphere(90.0, 0.2, center) for center in given))


def test_particle_that_nothing_holds_is_refused():
    with pytest.raises(iga.SceneError, match=r"particle\[0\]\.contact_angle = 180"):
        scene(iga.Sphere(180.0, 0.2, (1.0, 0.0, 0.7)))


def test_scene_file_gives_the_same_numbers(tmp_path):
    given = particle()
    more = f"""
[droplet]
hold = "x"
[[particle]]
contact_angle = 90.0
radius = 0.2
density = 1.0
center = {list(given.center)}
"""
    path = tmp_path / "particle.toml"
    path.write_text(droplet_file(PLANE.contact_angle, BOND, more, elements=24))
    loaded = iga.load_scene(path).scene
    assert loaded.description == scene(given, line="auto", elements=24).description
    read, asked = iga.solve(loaded), solved(line="auto", elements=24)
    np.testing.assert_array_equal(read.forces[0].effective, asked.forces[0].effective)
    assert read.hold_force == asked.hold_force
    assert dict(read.measures) == dict(asked.measures)


def on_top(height, *, hold="none", line="auto", radius=0.2, **mesh):
    return iga.sessile_droplet(
        PLANE,
        volume=UNIT_VOLUME,
        gravity=BOND,
        hold=hold,
        particles=[iga.Sphere(90.0, radius, (0.0, 0.0, height))],
        contact_line=line,
        discretization=iga.Discretization(**mesh),
    )


def test_particle_on_top_carries_what_a_line_can():
    """P17: up to ``2 pi gamma r cos^2(45 degrees)``; without a line there is no force at all."""
    passed, ended = (iga.solve(on_top(1.9, hold="xy", line=way)) for way in ("auto", "conforming"))
    force = passed.forces[0].contact_line[2]
    assert ended.forces[0].contact_line[2] == pytest.approx(force, rel=1e-5)
    assert 0.95 < -force / (0.2 * np.pi) < 1.0


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "height"), [(0.2, 2.0), (0.16, 1.96)])
def test_particle_above_what_a_line_can_carry_is_lost(radius, height):
    lost = iga.solve(on_top(height, hold="xy", radius=radius, elements=12), on_fail="return")
    assert (lost.status, lost.kind) == (iga.Status.TOPOLOGY_CHANGE, "detached")
    assert not lost.forces[0].contact_line.any()
    lo, hi = lost.bracket.lo, lost.bracket.hi
    assert lost.bracket.parameter == "gap"
    assert 1.9 - 0.2 < lo < hi < height - radius
    assert hi - lo < 1e-3 * lo


def test_droplet_slips_from_under_a_particle_that_presses_on_its_top():
    """L10: the symmetric state is an equilibrium that sliding leaves; held it is stable."""
    slips = iga.solve(on_top(1.3, line="conforming"), on_fail="return")
    assert (slips.status, slips.index) == (iga.Status.CONVERGED_SADDLE, 2)
    assert slips.lambda_min < 0
    held = iga.solve(on_top(1.3, hold="xy", line="conforming"))
    assert held.scene.sector.model == "eighth"
    assert pull(held)[2] == pytest.approx(pull(slips)[2], rel=1e-5)
    assert iga.solve(on_top(1.9, line="conforming")).success
