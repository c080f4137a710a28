"""Asperities as point supports: their law, its derivatives, and where they are in the mesh."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME
from taylor import remainder_slopes

import iga_membrane as iga
from iga_membrane.solver.assembly import Assembly
from iga_membrane.solver.point_supports import LARGEST, PointSupports, spot


def scene_of(model, offset=(0.0, 0.0), spacing=0.07):
    return iga.sessile_droplet(
        iga.SphereLattice(180.0, 0.22 * spacing, spacing, offset=offset),
        volume=UNIT_VOLUME,
        gravity=1.0,
        discretization=iga.Discretization(model=model),
    )


def test_the_spring_inverts_its_law():
    phi = np.linspace(1e-6, LARGEST, 50)
    assert spot(phi * (1.0 - np.log(phi))) == pytest.approx(phi, rel=1e-9)
    assert spot(np.array([-1.0, 0.0])) == pytest.approx([0.0, 0.0])
    # beyond, it goes on with the same stiffness
    end = LARGEST * (1.0 - np.log(LARGEST))
    below, above = np.diff(spot(end + np.array([-1e-6, 0.0, 1e-6])))
    assert below == pytest.approx(above, rel=1e-4)


@pytest.mark.parametrize("model", ["full", "eighth"])
def test_supports_are_where_the_mesh_passes_the_axes(model):
    scene = scene_of(model)
    contact = Assembly(scene).contact
    assert isinstance(contact, PointSupports)
    points = scene.local_surface().points
    x = (contact.table.values @ points[contact.table.functions])[:, 0]
    assert x[:, :2] == pytest.approx(contact.solid.center_of(contact.which)[:, :2], abs=1e-10)
    # each asperity of the whole foot counts once
    whole = Assembly(scene_of("full")).contact
    copies = scene.sector.copies
    assert copies * contact.area.sum() == pytest.approx(whole.area.sum(), rel=1e-12)
    assert np.unique(whole.which).size == whole.which.size > 290


@pytest.mark.parametrize("model", ["full", "eighth"])
def test_derivatives_of_the_supports_energy(model):
    scene = scene_of(model)
    assembly, rng = Assembly(scene), np.random.default_rng(0)
    contact = assembly.contact
    surface = scene.local_surface()
    surface = surface.moved(surface.points - [0.0, 0.0, 2e-4])
    motion = assembly.spines.on(surface)
    depth = -contact.touch(surface.points).at.gap
    assert (depth > 1e-4).any()
    unknowns = rng.standard_normal(assembly.size)
    step = 0.02 * motion.displacement(unknowns) / np.abs(motion.displacement(unknowns)).max()
    work = np.einsum("eai,eai->", contact.forces(contact.touch(surface.points)),
                     step[contact.table.functions])  # fmt: skip
    near, blocks = contact.hessian(contact.touch(surface.points), motion.directions)
    along = np.einsum("ki,ki->k", step, motion.directions[: len(step)])
    along /= (motion.directions[: len(step)] ** 2).sum(axis=1)
    local = along[contact.table.functions[near]]
    second = float(np.einsum("ea,eab,eb->", local, blocks, local))

    def energy(t):
        return contact.energy(contact.touch(surface.points + t * step))

    first, rest = remainder_slopes(energy, work, second)
    assert first > 1.9
    assert rest > 2.7


def test_a_mesh_between_the_laws_is_underresolved():
    scene = scene_of("eighth", spacing=0.05)
    assert Assembly(scene).contact.law == "point supports"
    between = iga.sessile_droplet(
        scene.substrate,
        volume=UNIT_VOLUME,
        gravity=1.0,
        discretization=iga.Discretization(elements=110),
    )
    solution = iga.solve(between, on_fail="return")
    assert solution.status is iga.Status.UNDERRESOLVED
    assert "discretization.elements" in solution.message
