"""Particles on a droplet on asperities: balances, symmetry, the slope of the energy."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet_file

import iga_membrane as iga

ASPERITIES = iga.SphereLattice(150.0, 0.1, 0.3, offset=(0.15, 0.15))
TOP = 1.43
"""Height of the droplet alone."""


def scene(*particles, substrate=ASPERITIES, hold="none", **mesh):
    return iga.sessile_droplet(
        substrate,
        volume=UNIT_VOLUME,
        gravity=1.0,
        hold=hold,
        particles=particles,
        discretization=iga.Discretization(**mesh),
    )


@cache
def solved(*particles, **given):
    solution = iga.solve(scene(*particles, **given))
    assert solution.success, solution.message
    return solution


def on_top(z=TOP, angle=90.0, radius=0.25):
    return iga.Sphere(angle, radius, (0.0, 0.0, z))


PAIR = (iga.Sphere(80.0, 0.25, (0.735, 0.0, 1.22)), iga.Sphere(80.0, 0.25, (-0.735, 0.0, 1.22)))


def carried(solution):
    """Sum of the forces on asperities."""
    return sum(np.array(each["force_vector"]) for each in solution.contact["asperities"])


def pull(solution, which=0):
    """Force of liquid and membrane on a particle."""
    forces = solution.forces[which]
    return forces.effective - forces.weight


def assert_balanced(solution, within=1e-3):
    total = carried(solution) + sum(pull(solution, k) for k in range(len(solution.forces)))
    missing = total + [0.0, 0.0, UNIT_VOLUME] - solution.hold_force
    assert np.abs(missing).max() < within * UNIT_VOLUME
    for asperity in solution.contact["asperities"]:
        assert asperity["contact_angle"] == pytest.approx(150.0, abs=1.5)


def test_asperities_carry_the_droplet_with_a_particle_on_top():
    solution = solved(on_top())
    assert solution.scene.sector.model == "eighth"
    assert_balanced(solution)
    assert abs(pull(solution)[2]) > 0.01


@pytest.mark.slow
def test_asperities_and_particles_carry_the_weight():
    solution = solved(on_top(), *PAIR)
    assert solution.scene.sector.model == "quarter"
    assert_balanced(solution)
    fx, fy, fz = pull(solution, 1)
    assert abs(fx) > 0.01
    np.testing.assert_allclose(pull(solution, 2), [-fx, -fy, fz], atol=1e-12)
    # numbers are those of the lattice, whatever list the membrane meets
    for asperity in solution.contact["asperities"]:
        np.testing.assert_allclose(
            ASPERITIES.center_of(np.array(asperity["index"])), asperity["center"], atol=1e-12
        )


@pytest.mark.slow
def test_force_is_slope_of_energy():
    step = 4e-3
    lower, upper = (solved(on_top(TOP + s)) for s in (0.05, 0.05 + step))
    slope = (upper.measures["energy"] - lower.measures["energy"]) / step
    mean = 0.5 * (pull(lower) + pull(upper))[2]
    assert mean < -0.05
    assert mean == pytest.approx(-slope, rel=2e-3)


@pytest.mark.parametrize(
    ("given", "substrate", "said"),
    [
        (on_top(), replace(ASPERITIES, contact_angle=120.0), "on asperities of 135 to 172 degrees"),
        (on_top(), replace(ASPERITIES, contact_angle=180.0), "on asperities of 135 to 172 degrees"),
        (on_top(), iga.Sphere(120.0, 1.0, (0.0, 0.0, -1.0)), "not available yet on this droplet"),
        (on_top(TOP, radius=0.02), ASPERITIES, r"particle\[0\]\.radius: .* give a larger particle"),
        (on_top(2.5), ASPERITIES, "farther than a meniscus reaches"),
        (iga.Sphere(90.0, 0.2, (1.1, 0.0, 0.4)), ASPERITIES, r"put it above z = 0\.59"),
    ],
)
def test_what_is_not_built_is_refused(given, substrate, said):
    with pytest.raises(iga.SceneError, match=said):
        scene(given, substrate=substrate)


def test_a_model_that_the_particles_do_not_have_is_refused():
    assert scene(*PAIR).sector.model == "quarter"
    assert scene(PAIR[0]).sector.model == "half"
    with pytest.raises(iga.SceneError, match=r'model = "quarter": .* particles have no such'):
        scene(PAIR[0], model="quarter")


def test_scene_file_gives_the_same_scene(tmp_path):
    more = """
[[particle]]
contact_angle = 90.0
radius = 0.25
center = [0.0, 0.0, 1.43]
"""
    text = droplet_file(150.0, 1.0, more).replace(
        "[substrate]\n",
        '[substrate]\nkind = "sphere_lattice"\nradius = 0.1\nspacing = 0.3\n'
        "offset = [0.15, 0.15]\n",
    )
    path = tmp_path / "whole_system.toml"
    path.write_text(text)
    read, asked = iga.load_scene(path).scene, scene(on_top())
    assert read.description == asked.description
    np.testing.assert_array_equal(read.surface.points, asked.surface.points)
    assert read.sector == asked.sector


@pytest.mark.slow
def test_a_small_particle_leaves_the_asperities_alone():
    """Where it neither pulls nor pushes, only the liquid that it displaces is felt."""
    alone, beside = iga.solve(scene()), solved(on_top(1.419, radius=0.1))
    assert abs(pull(beside)[2]) < 5e-3
    forces = [
        {
            tuple(np.round(each["center"], 9)): each["force_vector"]
            for each in s.contact["asperities"]
        }
        for s in (alone, beside)
    ]
    assert forces[0].keys() == forces[1].keys()
    largest = max(np.linalg.norm(force) for force in forces[0].values())
    for place, force in forces[0].items():
        assert np.linalg.norm(np.subtract(force, forces[1][place])) < 1e-2 * largest


@pytest.mark.slow
def test_half_model_agrees_with_full():
    one = replace(PAIR[0], radius=0.3)
    half, full = solved(one, elements=60), solved(one, elements=60, model="full")
    assert half.scene.sector.model == "half"
    assert np.abs(pull(half) - pull(full)).max() < 1e-6
    assert half.measures["energy"] == pytest.approx(full.measures["energy"], rel=1e-8)


@pytest.mark.slow
def test_forces_converge():
    coarse, middle, fine = (solved(on_top(), *PAIR, elements=n) for n in (54, 60, 76))
    for k in (0, 1):
        change = [np.abs(pull(s, k) - pull(fine, k)).max() for s in (coarse, middle)]
        assert change[1] < 2e-3 * np.abs(pull(fine, k)).max()
        assert change[1] < change[0]
    assert_balanced(fine, 3e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("angle", "radius", "hold"), [(45.0, 0.25, "x"), (130.0, 0.25, "xy"), (90.0, 0.4, "x")]
)
def test_a_held_droplet_takes_any_particle(angle, radius, hold):
    """At 130 degrees it would roll sideways: a saddle, if it were held along x only."""
    solution = solved(iga.Sphere(angle, radius, (0.64, 0.0, 1.24)), hold=hold)
    assert_balanced(solution)
    assert solution.hold_force[0] == pytest.approx(
        (carried(solution) + pull(solution))[0], abs=1e-3 * UNIT_VOLUME
    )


@pytest.mark.slow
def test_force_beside_the_top_is_slope_of_energy():
    step, one = 4e-3, PAIR[0]
    force = pull(solved(one, hold="x"))
    for axis in (0, 2):
        way = step * np.eye(3)[axis]
        moved = [replace(one, center=tuple((one.center + s * way).tolist())) for s in (1, -1)]
        above, below = (solved(p, hold="x").measures["energy"] for p in moved)
        slope = (below - above) / (2.0 * step)
        assert force[axis] == pytest.approx(slope, abs=1e-2 * np.linalg.norm(force))


@pytest.mark.slow
def test_liquid_on_asperities_lifts_a_light_particle_only():
    """Of a density on either side of the one that the liquid's pull carries."""
    light = on_top(1.35, 110.0)
    carried_up = pull(solved(light))[2]
    assert carried_up > 0.0
    even = carried_up / (4.0 / 3.0 * np.pi * light.radius**3)
    answers = [
        iga.self_cleaning(scene(replace(light, density=part * even)), friction=0.3).verdicts[0]
        for part in (0.999, 1.001)
    ]
    assert [each.answer for each in answers] == ["lifted", "stays"]
    assert answers[0].normal == pytest.approx(carried_up, rel=1e-6)
