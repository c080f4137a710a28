"""Laws of the gap: exact gradient and Hessian, frames and units, refusals."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from helpers import UNIT_VOLUME, example, pinned_cap
from taylor import lagrangian_slopes

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly

TENSION = iga.SurfaceTension(1.3)


@dataclass(frozen=True)
class Attraction(iga.GapTerm):
    solid: iga.Solid
    strength: float = 0.4
    reach: float = 0.7

    def law(self, gap):
        f = -self.strength * np.exp(-gap / self.reach)
        return f, -f / self.reach, f / self.reach**2


SOLIDS = {
    "plane": iga.Plane(90, (0.1, 0.2, -0.3), (0.2, -0.1, 1.0)),
    "sphere": iga.Sphere(90, 0.8, (0.1, -0.2, -1.0)),
    "lattice": iga.SphereLattice(90, 0.2, 0.9, offset=(0.1, 0.3)),
    "pillars": example("pillars").Pillars(0.45, 0.2, 0.95),
}


@pytest.mark.parametrize("solid", SOLIDS.values(), ids=SOLIDS)
def test_variations_of_a_law_are_exact(solid):
    scene = pinned_cap(1.1, [TENSION, iga.Volume(1.0), Attraction(solid)], elements=3)
    scene = replace(scene, scale=iga.Scale(0.8, 1.7, (0.0, 0.1, 0.05)))
    assembly, surface = Assembly(scene), scene.local_surface()
    motion, rng = assembly.spines.on(surface), np.random.default_rng(2)
    direction = 0.1 * rng.standard_normal(assembly.size)
    first, second = lagrangian_slopes(assembly, surface, np.array([0.7]), motion, direction)
    assert first > 1.9
    assert second > 2.9


def test_pillars_know_the_derivatives_of_their_gap():
    solid, rng, h = SOLIDS["pillars"], np.random.default_rng(3), 1e-5
    x = rng.uniform(-0.6, 0.6, (3000, 3)) * [1, 1, 0.5] + [0, 0, 0.1]
    at = solid.nearest(x)
    steps = [(solid.nearest(x + h * e), solid.nearest(x - h * e)) for e in np.eye(3)]
    gradient = np.stack([(a.gap - b.gap) / (2 * h) for a, b in steps], axis=-1)
    hessian = np.stack([(a.normal - b.normal) / (2 * h) for a, b in steps], axis=-1)
    # where curvature jumps, between top, rim and side, and between pillars, differences fail
    near = at.gap > -0.1
    slope = np.abs(gradient - at.normal).max(axis=-1)[near]
    bend = np.abs(hessian - at.hessian()).max(axis=(-1, -2))[near]
    assert np.quantile(slope, 0.98) < 1e-6
    assert np.quantile(bend, 0.98) < 1e-4


def test_a_law_is_the_same_in_other_units_and_frames():
    """A film at a sphere, and the same in millimetres, millinewtons and moved aside."""

    def film(unit, tension, shift):
        scene = pinned_cap(0.6, [TENSION], "full", rim=unit, elements=4)
        ball = iga.Sphere(90, 0.5 * unit, (shift, 0.0, 0.8 * unit))
        law = Attraction(ball, 0.3 * tension, 0.2 * unit)
        moved = scene.surface.moved(scene.surface.points + [shift, 0.0, 0.0])
        supports = [iga.Fixed("xi2=0")]
        return iga.solve(iga.Scene(moved, [iga.SurfaceTension(tension), law], supports))

    one, other = film(1.0, 1.0, 0.0), film(1e-3, 0.072, 5e-3)
    top = one.surface.at([0.0, 1.0]).position[2]
    assert top > 0.01
    assert other.surface.at([0.0, 1.0]).position[2] / 1e-3 == pytest.approx(top, rel=1e-9)
    assert other.measures["energy"] / (0.072e-6) == pytest.approx(one.measures["energy"], rel=1e-9)


def test_audit_knows_the_force_of_a_law():
    """A droplet that lies on a plane and is drawn to it presses harder than its weight."""
    scene = iga.sessile_droplet(iga.Plane(180), volume=UNIT_VOLUME, gravity=1.0, penalty=500.0)
    drawn = [*scene.terms, Attraction(iga.Plane(180), 0.1, 0.5)]
    alone, held = (iga.solve(replace(scene, terms=t, ramp=None)) for t in (scene.terms, drawn))
    more = held.contact["support_force"] / alone.contact["support_force"] - 1.0
    assert more > 0.05
    assert held.audit.force < 1e-2 * more
    assert held.measures["height"] < alone.measures["height"]


def test_a_law_under_a_mirror_needs_a_solid_with_that_mirror():
    law = Attraction(iga.Sphere(90, 0.3, (0.1, 0.0, 1.0)))
    pinned_cap(1.0, [TENSION, law], "half")
    with pytest.raises(iga.SceneError, match=r'solid of "gap" has no mirror plane for x'):
        pinned_cap(1.0, [TENSION, law], "quarter")
    other = Attraction(iga.Spheres(90, [[0.5, 0.0, 1.0], [-0.5, 0.0, 1.0]], 0.2))
    pinned_cap(1.0, [TENSION, other], "quarter")
    with pytest.raises(iga.SceneError, match="no mirror plane for x = y"):
        pinned_cap(1.0, [TENSION, other], "eighth")


def test_a_law_at_a_contact_line_is_refused():
    scene = iga.sessile_droplet(iga.Plane(120), volume=1.0)
    with pytest.raises(iga.SceneError, match="changes the tension at the contact line"):
        replace(scene, terms=[*scene.terms, Attraction(iga.Plane(120))])


def test_a_film_inside_its_solid_is_no_success():
    """A law that draws through the solid's surface ends inside it."""

    @dataclass(frozen=True)
    class Spring(iga.GapTerm):
        solid: iga.Solid

        def law(self, gap):
            return (gap + 0.2) ** 2, 2.0 * (gap + 0.2), np.full_like(gap, 2.0)

    flat = iga.sheet(2.0, elements=4)
    edges = [iga.Fixed(edge) for edge in ("xi1=0", "xi1=1", "xi2=0", "xi2=1")]
    terms = [iga.SurfaceTension(0.1), Spring(iga.Plane(90, (0, 0, -0.05)))]
    found = iga.solve(iga.Scene(flat, terms, edges), on_fail="return")
    assert found.status is iga.Status.PENETRATION
