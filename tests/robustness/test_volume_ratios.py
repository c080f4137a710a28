"""Droplets from a millionth to a billion times the size of an asperity."""

import numpy as np
import pytest
from helpers import some

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane

WATER = {"volume": 4.0 * np.pi / 3.0, "liquid": iga.Liquid(1.0, 1.0), "gravity": 1.0}


def on_lattice(angle, ratio, pitch=4.0, hold="xy", **more):
    r = ratio ** (-1.0 / 3.0)
    lattice = iga.SphereLattice(angle, r, pitch * r)
    return iga.sessile_droplet(lattice, **WATER, hold=hold, **more)


@pytest.mark.parametrize("angle", [60.0, 90.0, 150.0])
def test_a_droplet_a_millionth_of_an_asperity_is_that_on_a_plane(angle):
    found = iga.solve(on_lattice(angle, 1e-6))
    flat = drop_on_plane(1.0, angle)
    for name in ("height", "contact_radius"):
        assert found.measures[name] == pytest.approx(flat[name], rel=1e-2)
    (spot,) = found.contact["asperities"]
    assert spot["force_vector"] == pytest.approx([0.0, 0.0, -WATER["volume"]], abs=1e-6)
    assert spot["contact_angle"] == pytest.approx(angle, abs=0.01)


def test_a_small_droplet_on_a_large_asperity_slides_off():
    loose = iga.solve(on_lattice(90.0, 1e-6, hold="none"), on_fail="return")
    assert loose.status is iga.Status.CONVERGED_SADDLE
    assert "slide off" in loose.message


def test_one_asperity_of_many_is_the_same_sphere():
    alone = iga.solve(
        iga.sessile_droplet(iga.Sphere(150.0, 1.0, (0.0, 0.0, -1.0)), **WATER, hold="xy")
    )
    found = iga.solve(on_lattice(150.0, 1.0))
    for name in ("energy", "height", "pressure", "contact_radius"):
        assert found.measures[name] == alone.measures[name]
    assert found.contact["wet_area"] == alone.contact["wet_area"]
    (line,) = iga.contact_lines(found)
    assert line.solid == found.contact["asperities"][0]["index"]


@pytest.mark.parametrize("ratio", some((1e-6, 1e-3, 1.0), {1}))
def test_a_mesh_too_coarse_for_large_asperities_is_refined(ratio):
    found = iga.solve(on_lattice(180.0, ratio))
    assert found.contact["wet_solids"] == 1
    assert found.contact["support_force"] == pytest.approx(WATER["volume"], rel=1e-3)


def test_a_droplet_that_spreads_to_other_asperities_is_not_on_one_alone():
    scene = on_lattice(150.0, 8.0, pitch=2.2, contact_line="conforming")
    found = iga.solve(scene, on_fail="return")
    assert found.status is iga.Status.TOPOLOGY_CHANGE
    assert found.kind == "touches another asperity"


@pytest.mark.parametrize("radius", [1e-3, 0.01, 0.05])
def test_a_droplet_that_swallows_another_asperity_is_not_on_one_alone(radius):
    """Weightless it is clear of it; gravity widens it until the whole sphere is in the liquid."""
    spheres = iga.Spheres([60.0, 60.0], [(0.0, 0.0, -1.0), (1.2, 0.0, -0.6)], [1.0, radius])
    given = {"volume": 4.0, "contact_line": "conforming"}
    found = iga.solve(iga.sessile_droplet(spheres, **given, gravity=0.8), on_fail="return")
    assert found.status is iga.Status.TOPOLOGY_CHANGE
    assert found.kind == "touches another asperity"
    assert iga.solve(iga.sessile_droplet(spheres, **given)).contact["wet_solids"] == 1


def test_a_pushed_droplet_is_not_thought_to_stay_on_its_asperity():
    lattice, push = iga.SphereLattice(120.0, 1.0, 3.0), (0.3, 0.0, -0.3)
    held = iga.sessile_droplet(lattice, volume=4.0, gravity=push, hold="x")
    assert held.surface.space.pole is not None
    assert iga.sessile_droplet(lattice, volume=4.0, gravity=push).surface.space.pole is None


def test_the_mesh_of_one_asperity_is_not_taken_for_its_fallback():
    coarse = on_lattice(120.0, 1.0, discretization=iga.Discretization(elements=12, degree=3))
    given, own = (scene.otherwise.scene() for scene in (coarse, on_lattice(120.0, 1.0)))
    assert given.surface.space.net_shape == own.surface.space.net_shape


def test_a_bridge_between_particles_is_on_no_asperities():
    pair = [iga.Sphere(50.0, 0.8, (0.0, 0.0, z)) for z in (-1.3, 1.3)]
    scene = iga.sessile_droplet(
        None,
        volume=WATER["volume"],
        particles=pair,
        discretization=iga.Discretization(model="quarter"),
    )
    assert not any("asperities" in text for text in iga.solve(scene).warnings)


def test_a_second_mesh_that_is_refused_leaves_the_first_answer():
    scene = on_lattice(180.0, 1.0)
    less = iga.SolverOptions(max_memory_gb=0.04)
    found = iga.solve(scene, less, on_fail="return")
    assert found.status is iga.Status.UNDERRESOLVED
    assert "max_memory_gb" in found.message


@pytest.mark.slow
def test_no_limit_is_claimed_for_a_droplet_that_only_leaves_its_asperity():
    found = iga.solve(on_lattice(90.0, 8.0, contact_line="conforming"), on_fail="return")
    assert found.status is iga.Status.TOPOLOGY_CHANGE
    assert found.kind == "leaves its asperity"
    assert found.bracket.parameter == "gravity.acceleration"
    assert 0.5 < found.bracket.lo < found.bracket.hi < 0.7


@pytest.mark.parametrize("offset", [(0.2, 0.0), (5.0, 5.0)])
def test_a_conforming_line_needs_an_asperity_at_the_origin(offset):
    lattice = iga.SphereLattice(150.0, 5.0, 12.0, offset=offset)
    with pytest.raises(iga.SceneError, match="whose top is the origin"):
        iga.sessile_droplet(lattice, **WATER, contact_line="conforming")


def test_asperities_too_small_to_resolve_are_refused_by_name():
    with pytest.raises(iga.SceneError, match=r"substrate\.radius.*larger asperities"):
        on_lattice(150.0, 1e9)


@pytest.mark.slow
def test_a_droplet_between_asperities_rolls_to_better_ones_unless_it_is_held():
    """In the full model its eigenvalue is negative too."""
    lattice = iga.SphereLattice(180.0, 0.2, 0.45, offset=(0.225, 0.225))
    found = iga.solve(iga.sessile_droplet(lattice, **WATER), on_fail="return")
    assert found.contact["wet_solids"] == 12
    assert found.status is iga.Status.CONVERGED_SADDLE
    assert 'roll or slide off; hold its centroid by droplet.hold = "xy"' in found.message
    held = iga.solve(iga.sessile_droplet(lattice, **WATER, hold="xy"))
    assert not any("roll" in text for text in held.warnings)
