"""Asperities as point supports: their law, its derivatives, and where they are in the mesh."""

import numpy as np
import pytest
from helpers import UNIT_VOLUME
from taylor import remainder_slopes

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.contact.subgrid import PointSupports


def scene_of(model, offset=(0.0, 0.0), spacing=0.07, angle=180.0):
    return iga.sessile_droplet(
        iga.SphereLattice(angle, 0.22 * spacing, spacing, offset=offset),
        volume=UNIT_VOLUME,
        gravity=1.0,
        discretization=iga.Discretization(model=model),
    )


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


@pytest.mark.parametrize("angle", [180.0, 165.0, 140.0])
@pytest.mark.parametrize("model", ["full", "eighth"])
def test_derivatives_of_the_supports_energy(model, angle):
    scene = scene_of(model, angle=angle)
    assembly, rng = Assembly(scene), np.random.default_rng(0)
    contact = assembly.contact
    surface = scene.local_surface()
    contact.hold(surface.points - [0.0, 0.0, 2e-2])  # all are wet
    contact.hold(surface.points - [0.0, 0.0, 2e-2])
    # from pulled on one side to pressed on the other
    surface = surface.moved(surface.points - (surface.points[:, :1] - 0.3) * [0.0, 0.0, 3e-2])
    motion = assembly.spines.on(surface)
    touch = contact.touch(surface.points)
    assert (touch.traction > 0.0).any()
    assert (touch.pull > 0.0).any() == (angle < 180.0)
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
        return contact.energy(surface.points + t * step)

    first, rest = remainder_slopes(energy, work, second)
    assert first > 1.9
    assert rest > 2.7


@pytest.mark.parametrize("angle", [180.0, 150.0])
def test_an_asperity_that_was_met_stays_wet_until_it_is_torn_off(angle):
    scene = scene_of("eighth", angle=angle)
    contact = Assembly(scene).contact
    points = scene.local_surface().points
    lower = points - [0.0, 0.0, 1e-3]
    contact.hold(lower)
    wet = contact.wet
    assert wet.any()
    # just out of touch
    depth = -contact.touch(lower).at.gap
    apart = lower + [0.0, 0.0, depth.max() + 1e-4]
    contact.hold(lower)
    contact.hold(lower + [0.0, 0.0, 1e-9])
    pulled = contact.touch(apart)
    assert not (pulled.traction > 0.0).any()
    assert ((pulled.pull > 0.0) == (wet & (angle < 180.0))).all()
    # also in the next solve
    recalled = Assembly(scene).contact
    recalled.recall(contact.memory)
    recalled.hold(lower + [0.0, 0.0, 1e-9])
    assert (recalled.wet == wet).all()
    far = points + [0.0, 0.0, 1.0]
    contact.hold(far)
    assert not contact.wet.any()


def test_the_law_follows_from_the_mesh():
    laws = {}
    for elements in (None, 80, 300):
        scene = iga.sessile_droplet(
            iga.SphereLattice(180.0, 0.0125, 0.05),
            volume=UNIT_VOLUME,
            gravity=1.0,
            discretization=iga.Discretization(elements=elements),
        )
        laws[elements] = Assembly(scene).contact.law
    assert laws == {None: "point supports", 80: "point supports", 300: "penalty"}
