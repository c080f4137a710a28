"""A droplet that touches nothing but two particles."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.terms import BodyDensity

PAIR = [iga.Sphere(60.0, 0.8, (-1.2, 0.3, -0.5)), iga.Sphere(75.0, 0.6, (1.1, 0.2, 0.8))]
WEIGHT = (0.05, 0.05, -0.12)


def bridge(particles, gravity=0.0, volume=UNIT_VOLUME, **mesh):
    return iga.sessile_droplet(
        None,
        volume=volume,
        gravity=gravity,
        particles=particles,
        discretization=iga.Discretization(**mesh),
    )


def solved(*given, **more):
    found = iga.solve(bridge(*given, **more))
    assert found.success, found.message
    return found


def pulls(found):
    """Forces of liquid and membrane on the two particles."""
    return np.array([each.effective - each.weight for each in found.forces])


def centroid(found):
    """Of the liquid, in the world."""
    scene, scale = found.scene, found.scene.units
    surface = found.surface.moved(scale.to_local(found.surface.points))
    assembly = Assembly(scene)
    whole = assembly.body_integral(surface, BodyDensity(1.0))
    first = [assembly.body_integral(surface, BodyDensity(0.0, tuple(e))) for e in np.eye(3)]
    return scale.to_world(assembly.whole(np.array(first)) / (assembly.copies * whole))


def test_force_is_that_across_the_neck():
    """Without gravity ``2 pi r gamma - pi r^2 p`` with the radius of the neck halfway."""
    pair = [iga.Sphere(50.0, 0.8, (0.0, 0.0, z)) for z in (-1.3, 1.3)]
    found = solved(pair)
    ring = found.surface.grid(9, 3, 1).position[:, 1]
    neck = np.linalg.norm(ring[:, :2], axis=1).mean()
    p = found.measures["pressure"]
    expected = 2.0 * np.pi * neck - np.pi * neck**2 * p
    forces = pulls(found)
    np.testing.assert_allclose(forces[0], [0.0, 0.0, expected], atol=1e-7 * expected)
    np.testing.assert_allclose(forces[1], -forces[0], atol=1e-10 * expected)


@pytest.mark.parametrize(
    ("gravity", "elements", "allowed"),
    [
        ((0.0, 0.0, 0.0), 20, 1e-8),
        ((0.1, 0.2, -0.3), 20, 5e-6),
        pytest.param(WEIGHT, 20, 1e-6, marks=pytest.mark.slow),
        pytest.param((0.1, 0.2, -0.3), 40, 1e-8, marks=pytest.mark.slow),
        pytest.param(WEIGHT, 48, 1e-8, marks=pytest.mark.slow),
    ],
)
def test_forces_and_torques_balance(gravity, elements, allowed):
    """P16, Q7: torques fall with the mesh, by three orders when it is twice as fine."""
    found = solved(PAIR, gravity, elements=elements)
    forces, weight = pulls(found), UNIT_VOLUME * np.array(gravity)
    size = np.abs(forces).max()
    assert np.abs(forces.sum(axis=0) - weight).max() < 1e-8 * size
    places = [np.array(each.center) for each in PAIR]
    torque = sum(np.cross(x, f) for x, f in zip(places, forces, strict=True))
    assert np.abs(torque - np.cross(centroid(found), weight)).max() < allowed * size
    assert found.contact["wet_solids"] == 2
    assert [each.solid for each in iga.contact_lines(found)] == [0, 1]


@pytest.mark.slow
def test_force_is_slope_of_energy():
    gravity, step, way = WEIGHT, 2e-3, np.array([0.48, -0.6, 0.64])
    energies = []
    for sign in (1.0, -1.0):
        moved = iga.Sphere(75.0, 0.6, tuple(np.array(PAIR[1].center) + sign * step * way))
        energies.append(solved([PAIR[0], moved], gravity).measures["energy"])
    slope = (energies[0] - energies[1]) / (2.0 * step)
    assert pulls(solved(PAIR, gravity))[1] @ way == pytest.approx(-slope, rel=1e-4)


@pytest.mark.slow
def test_turned_pair_has_turned_forces():
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    gravity = np.array(WEIGHT)
    other = [iga.Sphere(p.contact_angle, p.radius, tuple(turn @ p.center)) for p in PAIR]
    one, two = pulls(solved(PAIR, gravity)), pulls(solved(other, turn @ gravity))
    np.testing.assert_allclose(two, one @ turn.T, atol=1e-6 * np.abs(one).max())


@pytest.mark.slow
def test_too_little_liquid_to_bridge_is_named_and_bracketed():
    pair = [iga.Sphere(60.0, 0.8, (0.0, 0.0, z)) for z in (-1.5, 1.5)]
    found = iga.solve(bridge(pair, 0.5, 0.8), on_fail="return")
    assert found.status is iga.Status.LIMIT_POINT
    assert found.bracket.parameter == "gap"
    assert found.bracket.lo < found.bracket.hi < 1.4
    nearer = iga.Sphere(60.0, 0.8, (0.0, 0.0, -0.7 + found.bracket.lo + 0.8))
    assert iga.solve(bridge([pair[0], nearer], 0.5, 0.8)).success


def test_what_bridges_cannot_do_is_refused():
    with pytest.raises(iga.SceneError, match=r"3 given; .* bridges two"):
        bridge([*PAIR, iga.Sphere(60.0, 0.2, (0.0, 2.0, 0.0))])
    with pytest.raises(iga.SceneError, match=r"droplet\.hold.*two particles hold a droplet"):
        iga.sessile_droplet(None, volume=1.0, particles=PAIR, hold="xyz")
    with pytest.raises(iga.SceneError, match=r'"trimmed": between two particles'):
        iga.sessile_droplet(None, volume=1.0, particles=PAIR, contact_line="trimmed")


def test_round_bridge_that_gives_way_sideways_is_no_success():
    """Two spheres near each other hold less liquid round their gap than beside it."""
    pair = [iga.Sphere(90.0, 0.8, (0.0, 0.0, z)) for z in (-1.05, 1.05)]
    scene = bridge(pair, model="eighth", elements=8)
    assert iga.solve(scene, iga.SolverOptions(stability="model")).success
    found = iga.solve(scene, on_fail="return")
    assert found.status is iga.Status.CONVERGED_SADDLE
    assert found.lambda_min < -0.1
