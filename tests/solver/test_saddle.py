"""Down from saddles: the mode, and the equilibrium below."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet, pinned_cap
from scipy.optimize import brentq

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly

FOLLOW = iga.SolverOptions(follow_instability=True)


def large_cap(degrees=115.0):
    """A cap beyond the hemisphere under its pressure: it grows or shrinks."""
    opening = np.radians(degrees)
    terms = [iga.SurfaceTension(1.0), iga.Pressure(2.0 * np.sin(opening))]
    return pinned_cap(opening, terms, "eighth", elements=12)


def swollen(model="half"):
    """Most of the liquid between two rings beyond where its round state is stable."""
    mesh = iga.Discretization(model=model)
    return iga.film_between_rings(half_height=0.5, volume=4.0 * np.pi, discretization=mesh)


def between_spheres(apart=1.25):
    """A bridge between two spheres that holds less liquid round their gap than beside it."""
    pair = [iga.Sphere(90.0, 0.8, (0.0, 0.0, z)) for z in (-apart, apart)]
    mesh = iga.Discretization(elements=8, model="half")
    return iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=pair, discretization=mesh)


def under_a_particle():
    """A droplet on a plane with a particle that presses on its top."""
    return iga.sessile_droplet(
        iga.Plane(contact_angle=150.0),
        volume=UNIT_VOLUME,
        gravity=1.0,
        particles=[iga.Sphere(90.0, 0.2, (0.0, 0.0, 1.3))],
        contact_line="conforming",
        discretization=iga.Discretization(model="half"),
    )


@pytest.mark.parametrize("degrees", [100.0, 115.0])
def test_large_cap_shrinks_to_the_small_one_of_the_same_pressure(degrees):
    """N4: the energy below is that of the spherical cap of the supplementary opening."""
    found = iga.solve(large_cap(degrees), FOLLOW)
    opening = np.pi - np.radians(degrees)
    radius = 1.0 / np.sin(opening)
    height = radius * (1.0 - np.cos(opening))
    volume = np.pi * height * (3.0 + height**2) / 6.0
    exact = 2.0 * np.pi * radius * height - 2.0 / radius * volume
    assert found.measures["energy"] == pytest.approx(exact, rel=1e-6)
    assert "followed down from a saddle" in found.message
    assert found.mode is None


def test_mode_is_a_motion_with_the_smallest_eigenvalue():
    """Second difference of the energy along it over its normal displacement squared."""
    saddle = iga.solve(large_cap(), on_fail="return")
    assembly = Assembly(saddle.scene)
    scale, mode = saddle.scene.units, saddle.mode
    surface = saddle.surface.moved(scale.to_local(saddle.surface.points))
    assert np.linalg.norm(mode, axis=1).max() == pytest.approx(1.0)
    table = assembly.table
    cross = assembly.energies(surface).area_vectors
    area = np.linalg.norm(cross, axis=2)
    normal = np.einsum("eqi,eqi->eq", table.values @ mode[table.functions], cross) / area
    squared = assembly.copies * (table.weights * area * normal**2).sum()

    def energy(push):
        return (
            assembly.copies * assembly.energies(surface.moved(surface.points + push * mode)).total
        )

    for push, close in ((1e-2, 1e-2), (1e-3, 1e-4)):
        second = (energy(push) + energy(-push) - 2.0 * energy(0.0)) / push**2
        eigenvalue = saddle.lambda_min * scale.length**2 / scale.tension
        assert second / squared == pytest.approx(eigenvalue, rel=close)


def test_mode_is_kept_in_a_state_file(tmp_path):
    saddle = iga.solve(large_cap(), on_fail="return")
    saddle.save(tmp_path / "saddle.npz")
    np.testing.assert_array_equal(iga.load(tmp_path / "saddle.npz").mode, saddle.mode)


def test_stable_state_is_left_alone():
    plain, asked = iga.solve(droplet(120, elements=6)), iga.solve(droplet(120, elements=6), FOLLOW)
    np.testing.assert_array_equal(plain.surface.points, asked.surface.points)
    assert (plain.message, plain.mode) == (asked.message, None)


def test_following_is_refused_where_it_is_not_built():
    with pytest.raises(iga.SceneError, match=r"follow_instability.*at 0 or 180 degrees"):
        iga.solve(droplet(180, 1.0), FOLLOW)
    moving = iga.Sphere(90.0, 0.5, (1.0, 0.0, 0.0), motion="vertical")
    held = iga.sessile_droplet(None, volume=UNIT_VOLUME, particles=[moving], hold="xyz")
    with pytest.raises(iga.SceneError, match=r"follow_instability.*particles that move"):
        iga.solve(held, FOLLOW)
    with pytest.raises(iga.SceneError, match=r"follow_instability.*along a path"):
        iga.trace(lambda angle: droplet(angle), [120.0, 110.0], options=FOLLOW)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [swollen, between_spheres, under_a_particle])
def test_symmetric_state_that_gives_way_is_followed_down(scene):
    """L10: with its volume kept, to a stable state of lower energy."""
    saddle, found = iga.solve(scene(), on_fail="return"), iga.solve(scene(), FOLLOW)
    assert saddle.status is iga.Status.CONVERGED_SADDLE
    drop = saddle.measures["energy"] - found.measures["energy"]
    assert drop > 1e-3 * saddle.measures["energy"]
    assert f"by {drop:.6g} in energy" in found.message
    assert found.volume_error <= 1e-8
    assert found.newton_iterations > saddle.newton_iterations


@pytest.mark.slow
@pytest.mark.parametrize("apart", [1.22, 1.25, 1.28])
def test_bridge_that_gives_way_sideways_becomes_part_of_a_ball(apart):
    """At 90 degrees a ball that meets both spheres at right angles is an equilibrium."""

    def volume(radius):
        """Of a ball less what lies in the spheres of radius 0.8, whose centres are ``away``."""
        away = np.hypot(radius, 0.8)
        both = away**2 + 2.0 * away * (radius + 0.8) - 3.0 * (radius - 0.8) ** 2
        lens = np.pi * (radius + 0.8 - away) ** 2 * both / (12.0 * away)
        return 4.0 / 3.0 * np.pi * radius**3 - 2.0 * lens

    radius = brentq(lambda r: volume(r) - UNIT_VOLUME, 0.8, 2.0)
    assert np.hypot(radius, 0.8) > apart  # its centre lies beside the gap
    found = iga.solve(between_spheres(apart), FOLLOW)
    assert "followed down from a saddle" in found.message
    assert found.measures["pressure"] == pytest.approx(2.0 / radius, rel=1e-4)


@pytest.mark.slow
def test_fall_that_finds_no_equilibrium_leaves_the_saddle_and_says_so():
    """A droplet slides off a sphere: nothing stable lies below."""
    scene = iga.sessile_droplet(
        iga.Sphere(120.0, 1.0, (0.0, 0.0, -1.0)),
        volume=UNIT_VOLUME,
        gravity=0.5,
        discretization=iga.Discretization(elements=8, model="half"),
    )
    saddle, found = (iga.solve(scene, o, on_fail="return") for o in (iga.SolverOptions(), FOLLOW))
    assert found.status is iga.Status.CONVERGED_SADDLE
    assert found.message.startswith(f"{saddle.message}; followed down: ")
    np.testing.assert_array_equal(found.surface.points, saddle.surface.points)
