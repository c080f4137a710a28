"""A droplet whose membrane ends on its particle, against the one that passes through it."""

from dataclasses import replace

import numpy as np
import pytest
from helpers import some
from particle_scenes import (
    check_convergence_and_balance,
    particle,
    place,
    pull,
    scene,
    size,
    solved,
)

import iga_membrane as iga
from iga_membrane.terms import SphereContactLine

ENDS = {"line": "conforming"}
PLACES = [(95.0, 90.0, 0.2), (65.0, 110.0, 0.4)]
MORE = [((20.0, 60.0, 0.1), {}), ((115.0, 75.0, 0.15), {})] + [
    ((polar, angle, radius), {"elements": 40})
    for polar in (30.0, 75.0, 110.0)
    for angle in (60.0, 85.0, 120.0)
    for radius in (0.1, 0.25)
]

CASES = [
    (95.0, 90.0, 0.2),
    pytest.param((50.0, 70.0, 0.12), marks=pytest.mark.slow),
    pytest.param((85.0, 115.0, 0.3), marks=pytest.mark.slow),
]


@pytest.mark.parametrize(
    ("case", "mesh"),
    some([(each, {}) for each in PLACES], {0})
    + [pytest.param(*each, marks=pytest.mark.slow) for each in MORE],
)
def test_agrees_with_the_membrane_that_passes_through(case, mesh):
    """On default meshes; on finer ones also where the force nearly vanishes."""
    ends, passes = solved(*case, **ENDS, **mesh), solved(*case, **mesh)
    assert np.abs(pull(ends) - pull(passes)).max() < 5e-4 * size(pull(passes))
    for name in ("p_base", "energy", "height", "contact_radius", "A_LG", "A_wet"):
        assert ends.measures[name] == pytest.approx(passes.measures[name], rel=5e-5), name
    for part in ("contact_line", "hydrostatic", "buoyancy"):
        one, other = (getattr(s.forces[0], part) for s in (ends, passes))
        assert np.abs(one - other).max() < 5e-4 * size(other), part


@pytest.mark.parametrize("case", CASES, ids=str)
def test_forces_converge_and_balance(case):
    meshes = [solved(*case, **ENDS, elements=n) for n in (14, 21, 31)]
    check_convergence_and_balance(meshes, sideways=1e-4)


@pytest.mark.slow
def test_half_model_agrees_with_full():
    half = solved(**ENDS)
    full = iga.solve(scene(particle(), hold="xy", model="full", **ENDS))
    assert (half.scene.sector.model, full.scene.sector.model) == ("half", "full")
    assert full.success, full.message
    assert size(pull(full) - pull(half)) < 1e-6 * size(pull(half))
    assert full.measures["energy"] == pytest.approx(half.measures["energy"], rel=1e-8)


@pytest.mark.slow
def test_force_is_slope_of_energy():
    _, normal = place(95.0)
    step, force = 2e-3, pull(solved(elements=24, **ENDS))
    for way in (normal, np.array([-normal[2], 0.0, normal[0]])):
        energies = []
        for sign in (1.0, -1.0):
            moved = iga.solve(scene(particle(shift=sign * step * way), elements=24, **ENDS))
            assert moved.success, moved.message
            energies.append(moved.measures["energy"])
        slope = (energies[0] - energies[1]) / (2.0 * step)
        assert abs(force @ way) > 0.05 * size(force)
        assert force @ way == pytest.approx(-slope, abs=1e-4 * size(force))


def test_lines_lie_on_particle_and_plane():
    found = solved(**ENDS)
    on_particle, on_plane = sorted(iga.contact_lines(found), key=lambda each: -each.solid)
    away = on_particle.line.position - np.array(found.scene.particles[0].center)
    assert np.linalg.norm(away, axis=1) == pytest.approx(0.2, abs=2e-6)
    assert np.abs(on_plane.line.position[:, 2]).max() < 1e-12
    for each, angle in ((on_particle, 90.0), (on_plane, 150.0)):
        mean = np.degrees(each.line.angle @ each.line.arc / each.line.arc.sum())
        assert mean == pytest.approx(angle, abs=0.1)


@pytest.mark.slow
def test_moving_particle_finds_the_place_of_the_other_discretization():
    """Along the vertical, where the force on it vanishes."""
    center = particle(polar=40.0).center
    free = iga.Sphere(100.0, 0.2, center, 0.0, "vertical")
    places = []
    for line in ("conforming", "trimmed"):
        found = iga.solve(scene(free, line=line, elements=24))
        assert found.success, found.message
        places.append(found.forces[0].center)
    assert size(places[1] - places[0]) < 1e-5
    assert size(places[0] - center) > 0.01


def test_paper_s_archimedes_force_up_is_up():
    """Along the axis from the particle into the liquid, which here leads down."""
    for line in ("conforming", "trimmed"):
        found = solved(65.0, 110.0, 0.4, line=line)
        forces, axis = found.forces[0], np.ravel(found.scene.terms[-1].toward)
        assert forces.buoyancy[2] > 0.0
        assert forces.paper["F_B_up"] == pytest.approx(axis @ forces.buoyancy, rel=1e-6)
        assert axis @ forces.buoyancy < 0.0


@pytest.mark.slow
def test_passes_through_particle_where_ending_on_it_fails():
    """A wide, hardly wet particle on the shoulder; the effort of both ways is counted."""
    ends, passes, chosen = (
        iga.solve(scene(particle(20.0, 130.0, 0.5), line=line), on_fail="return")
        for line in ("conforming", "trimmed", "auto")
    )
    assert not ends.success
    assert passes.success
    assert chosen.success
    np.testing.assert_array_equal(pull(chosen), pull(passes))
    assert chosen.newton_iterations == ends.newton_iterations + passes.newton_iterations
    assert len(chosen.iterations) == len(ends.iterations) + len(passes.iterations)


@pytest.mark.slow
def test_starts_from_a_state_of_either_discretization(tmp_path):
    """From another start control points move along other directions: the same but for the error of
    so coarse a mesh."""
    mesh = {"elements": 12, "model": "full", "hold": "xy"}
    for line in ("conforming", "trimmed"):
        before, path = iga.solve(scene(particle(), line=line, **mesh)), tmp_path / f"{line}.npz"
        before.save(path)
        again = iga.solve(scene(particle(), line="auto", **mesh), iga.SolverOptions(start=path))
        assert again.unknowns == before.unknowns
        assert len(again.iterations) < len(before.iterations)
        assert size(pull(again) - pull(before)) < 1e-3 * size(pull(before))


@pytest.mark.slow
def test_lost_particle_is_named_and_confirmed():
    """Hardly wet particles that are pulled out: no line on them, and the way to them has an end."""
    _, normal = place(65.0)
    lost = iga.solve(
        scene(particle(65.0, 150.0, shift=0.25 * normal), line="auto"), on_fail="return"
    )
    assert (lost.status, lost.kind) == (iga.Status.TOPOLOGY_CHANGE, "detached")
    assert "in another discretization LIMIT_POINT" in lost.message
    bracket = lost.bracket
    assert bracket.parameter == "particle[0].contact_angle"
    assert bracket.lo < bracket.hi < 150.0
    assert bracket.hi - bracket.lo < 1e-3 * bracket.lo


@pytest.mark.parametrize(
    ("given", "chosen"),
    [({}, ["xi2=1"]), ({"motion": "normal"}, [])],
)
def test_membrane_ends_on_one_fixed_particle(given, chosen):
    asked = scene(replace(particle(), **given), line="auto")
    assert [term.edge for term in asked.terms if isinstance(term, SphereContactLine)] == chosen


def test_several_particles_are_refused():
    one = particle(35.0)
    x, _, z = one.center
    with pytest.raises(iga.SceneError, match=r'contact_line = "conforming".*2 particle'):
        scene(one, iga.Sphere(90.0, 0.2, (-x, 0.0, z)), **ENDS)
