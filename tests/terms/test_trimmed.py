"""Contact lines inside the membrane: exact derivatives, exact caps."""

import numpy as np
import pytest
from helpers import some
from taylor import lagrangian_slopes

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.terms import BodyDensity


def cell(shape="square", degree=2, elements=9, place=(0.013, 0.007), angle=150.0, model=None):
    sphere = iga.Sphere(angle, 0.05, (*place, -0.05))
    mesh = iga.Discretization(degree=degree, elements=elements, model=model)
    return iga.asperity_cell(sphere, size=0.2, pressure=2.0, shape=shape, discretization=mesh)


def droplet(angle=140.0, offset=(0.03, 0.0)):
    lattice = iga.SphereLattice(angle, 0.1, 0.3, offset=offset)
    mesh = iga.Discretization(elements=24)
    return iga.sessile_droplet(
        lattice, volume=4.0 * np.pi / 3.0, gravity=[0.1, 0.0, -1.0], discretization=mesh
    )


def particle_on_droplet():
    particle = iga.Sphere(80.0, 0.3, (1.0, 0.1, 0.7))
    mesh = iga.Discretization(elements=12)
    return iga.sessile_droplet(
        iga.Plane(150.0),
        volume=4.0 * np.pi / 3.0,
        gravity=0.5,
        hold="xy",
        particles=[particle],
        contact_line="trimmed",
        discretization=mesh,
    )


def state(scene, seed, sunk):
    """An assembly and a disturbed state whose membrane passes through solids."""
    assembly, surface = Assembly(scene), scene.local_surface()
    motion = assembly.spines.on(surface)
    random = np.random.default_rng(seed)
    step = 0.02 * assembly.contact.term.solid.scale * random.standard_normal(assembly.size)
    surface = surface.moved(surface.points + motion.displacement(step) - [0.0, 0.0, sunk])
    surface = assembly.relaxed(surface, assembly.spines.on(surface))
    return assembly, surface, motion, random


SCENES = {
    "square cell": lambda: (cell(), 0.0),
    "cubic, at 90 degrees": lambda: (cell(degree=3, angle=90.0), 0.0),
    "mirrored": lambda: (cell(place=(0.0, 0.0), elements=8), 0.0),
    "round cell": lambda: (cell("circle", elements=8, place=(0.0, 0.0)), 0.0),
    "round cell off centre": lambda: (cell("circle", degree=3, elements=8), 0.0),
    "droplet on tilted asperities": lambda: (droplet(), 0.03),
    "particle on a droplet": lambda: (particle_on_droplet(), 0.0),
}


@pytest.mark.parametrize("name", some(SCENES, {1, 2, 4, 6}))
def test_energy_and_volume_have_exact_derivatives(name, monkeypatch):
    monkeypatch.setattr("iga_membrane.contact.unfitted.EXTRA", 22)  # the integrals, not their rule
    scene, sunk = SCENES[name]()
    assembly, surface, motion, random = state(scene, 1, sunk)
    multipliers = np.zeros(assembly.multipliers)  # the last holds a shift's gauge, not an energy
    multipliers[: len(assembly.constraints)] = 2.0
    along = 0.3 * assembly.contact.term.solid.scale * random.standard_normal(assembly.size)
    along[assembly.contact.ties.idle] = 0.0
    first, second = lagrangian_slopes(assembly, surface, multipliers, motion, along)
    assert first > 1.8
    assert second > 2.7


def test_derivatives_without_the_ends_of_graphs_are_wrong(monkeypatch):
    """The Taylor test can fail: leaving out one term of the Hessian shows."""
    scene, _ = SCENES["square cell"]()
    assembly, surface, motion, random = state(scene, 1, 0.0)
    along = random.standard_normal(assembly.size) * 0.05
    along[assembly.contact.ties.idle] = 0.0
    whole = along @ (assembly.system(surface, motion.directions, np.zeros(0)).matrix @ along)
    monkeypatch.setattr(
        "iga_membrane.contact.unfitted_lines.end_hessian",
        lambda at, *rest: np.zeros((len(at.table.functions), *[at.table.functions.shape[1]] * 2)),
    )
    part = along @ (assembly.system(surface, motion.directions, np.zeros(0)).matrix @ along)
    assert abs(part - whole) > 1e-3 * abs(whole)


def test_wetted_caps_are_integrated_exactly(monkeypatch):
    """A flat membrane cuts a sphere in a circle, whose cap is known."""
    monkeypatch.setattr("iga_membrane.contact.unfitted.EXTRA", 12)
    scene = cell("square", elements=12)
    assembly = Assembly(scene)
    x, y, z = (c / 0.05 for c in (0.013, 0.007, -0.05))
    for depth in (0.2, 0.7, 1.0, 1.3):
        points = scene.local_surface().points.copy()
        points[:, 2] = z + 1.0 - depth
        contact = assembly.contact
        _, area = contact.wetting(points)
        assert area == pytest.approx(2.0 * np.pi * depth, rel=1e-9)
        cap = np.pi * depth**2 * (3.0 - depth) / 3.0
        base = np.pi * (2.0 * depth - depth**2)
        # liquid above the membrane less the solid in it: the flux through cap and disc
        flux = -(cap + (z + 1.0 - depth) * base)
        assert contact.under(points, BodyDensity(1.0)) == pytest.approx(flux, rel=1e-9)
        moment = contact.under(points, BodyDensity(0.0, (1.0, 0.0, 0.0)))
        assert moment == pytest.approx(x * flux, rel=1e-8)
    assert y > 0


def test_ties_vanish_on_polynomials():
    """No force where the height is one polynomial: they add nothing of lower order."""
    scene = cell("square", elements=12)
    assembly = Assembly(scene)
    surface = scene.local_surface()
    assembly.relaxed(surface, assembly.spines.on(surface))
    flat = surface.points.copy()
    flat[:, 2] = -1.3
    ties = assembly.contact.ties
    assert len(ties.across[0]) > 0
    assert np.abs(ties.forces(flat)[..., 2]).max() < 1e-14
    assert np.abs(ties.forces(surface.points)[..., 2]).max() > 1e-6


def test_a_trial_far_from_all_solids_has_an_energy():
    scene = cell(shape="circle", elements=8)
    assembly, surface = Assembly(scene), scene.local_surface()
    up = 20.0 * surface.size * np.array([0.0, 0.0, 1.0])
    assembly.contact.begin(surface)
    away = assembly.energies(surface.moved(surface.points + up))
    assert np.isfinite(away.total)
