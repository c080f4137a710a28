"""Forces on a particle: consistent ones, and the paper's (eqs 35-39) beside them.

The force of membrane and liquid is ``-dE/d(position)`` of the particle, the membrane carried along
by a shift that fades towards the rim: it converges like the energy, which a line integral does
not. The liquid's part of it is ``-int p n dA`` over the wetted cap; what is left is the line's.
Archimedes' term is the weight of liquid between the wetted cap and the cone from the line to its
centroid, upwards; the rest of the liquid's part is the hydrostatic force, for a level line
``-pi a^2`` times the pressure at its height.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array, Index
from ..assembly.lagrangian import Assembly
from ..contact.unfitted import is_unfitted
from ..dofs.symmetry import mirrors
from ..overview import brief_repr
from ..problems.scene import Scene
from ..solids import Sphere
from ..splines import points_of
from ..surface.surface import Surface
from ..terms import BodyDensity, SphereContactLine
from ..terms.variations import element_points, forces
from .contact_line import ContactLine, contact_line, trimmed_line
from .contact_patches import substrate_patches
from .wetted_cap import WettedCap


@dataclass(frozen=True, eq=False)
class ParticleForces:
    """Forces on a particle in world axes, in the user's units.

    Attributes
    ----------
    center : (3,) of the particle, where it came to rest if it is free.
    up : (3,) unit normal of the substrate or of the sheet's level rim; of a free droplet the
        direction against gravity, or without any from the particle to the droplet or the second.
    weight : (3,) F_G; contact_line : F_CL; hydrostatic : F_H; buoyancy : F_B.
    torque : (3,) about the centre: zero, as the energy does not change when a sphere of one
        contact angle turns.
    paper : F_G, F_CL, F_H, F_B_up, F_B_down, F_e_up, F_e_down by the paper's formulas, positive
        from the particle into the liquid, which for a sheet is up.
    """

    center: Array
    up: Array
    weight: Array
    contact_line: Array
    hydrostatic: Array
    buoyancy: Array
    torque: Array
    paper: Mapping[str, float] = field(repr=False)

    __repr__ = brief_repr

    @property
    def effective(self) -> Array:
        """(3,) F_e, paper eq. (39)."""
        return self.weight + self.contact_line + self.hydrostatic + self.buoyancy

    @property
    def normal(self) -> float:
        """Part of F_e along ``up``."""
        return float(self.effective @ self.up)

    @property
    def tangential(self) -> float:
        """Size of the rest of F_e, >= 0."""
        return float(np.linalg.norm(self.effective - self.normal * self.up))

    @property
    def lifts(self) -> bool:
        """Whether F_e points up."""
        return self.normal > 0.0


@dataclass(frozen=True, eq=False)
class Pull:
    """What membrane and liquid do to a sphere (dimensionless, full body).

    Attributes
    ----------
    total : (3,) force; pressure : (3,) the liquid's part of it.
    """

    total: Array
    pressure: Array


def line_on_sphere(
    scene: Scene, assembly: Assembly, surface: Surface, which: int = 0
) -> ContactLine:
    """A whole contact line on a sphere of a scene, by its number."""
    if is_unfitted(assembly.contact):
        return trimmed_line(assembly.contact, surface, mirrors(scene.sector))
    term = sphere_lines(scene)[which]
    return contact_line(surface, term.edge, solid=term.sphere)


def sphere_lines(scene: Scene) -> list[SphereContactLine]:
    """The membrane's lines on spheres at its edges, in the scene's scale."""
    return scene.local_terms().on_spheres


def pull_on_sphere(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array, which: int = 0
) -> Pull:
    """Force on the sphere that carries one of the membrane's lines, by its number."""
    if is_unfitted(assembly.contact):
        own = assembly.density(multipliers)
        unfitted, slope = assembly.contact, np.array(own.gradient)
        pressed = np.zeros(3)
        for k in range(3):

            def push(x: Array, n: Array, which: Index, k: int = k) -> Array:
                return np.asarray((own.constant + x @ slope) * n[..., k])

            pressed[k] = unfitted.cap(surface.points, push)
        total = substrate_patches(scene, assembly, surface, own).total
        return Pull(total, assembly.whole(pressed))
    term, edge = assembly.edges.on_spheres[which]
    points, body = surface.points, assembly.density(multipliers)
    if term.covered:
        return _pull_through(assembly, surface, term, body)
    total = term.forces(edge, points, term.strength, body).sum(axis=(0, 1))
    total += assembly.edges.push(term.edge, points, assembly.line_load(multipliers))
    _, at = surface.space.edge_place(term.edge)
    fading = 1.0 - np.abs(surface.space.abscissae[..., 1] - at)
    along = points_of(surface.space, fading[..., None])
    for i in range(3):
        total[i] -= work_of(assembly, surface, multipliers, along * np.eye(3)[i])
    line = contact_line(surface, term.edge, assembly.points[0], term.sphere)
    cap = WettedCap(line, term.sphere, term.toward)
    pressure = cap.push(body)
    # the body integrals under the cap change with it: their flux is upwards, of the height
    lifted = cap.push(BodyDensity(0.0, (0.0, 0.0, 1.0)))[2]
    ex, ey, _ = body.gradient
    return Pull(assembly.whole(total) + [ex * lifted, ey * lifted, pressure[2]], pressure)


def work_of(assembly: Assembly, surface: Surface, multipliers: Array, displacement: Array) -> float:
    """Derivative of the Lagrangian along any displacement (count, 3) of the control points."""
    points, body = surface.points, assembly.density(multipliers)
    table, edges = assembly.table, assembly.edges
    pull = forces(table, element_points(table, points), assembly.tension, body)
    total = float((pull * displacement[table.functions]).sum())
    for at, load in assembly.contact.loads(points):
        total -= float((load * (at.values @ displacement[at.functions])).sum())
    for term, edge in edges.lines:
        pull = term.forces(edge, points, term.strength, body)
        total += float((pull * displacement[edge.functions]).sum())
    loads = assembly.line_load(multipliers)
    for gap, edge in edges.gaps:
        pull = np.einsum("ekai,ek->eai", gap.gradients(edge, points), loads[edge.functions])
        total -= float((pull * displacement[edge.functions]).sum())
    return total


def _pull_through(
    assembly: Assembly, surface: Surface, term: SphereContactLine, body: BodyDensity
) -> Pull:
    """The same where the membrane covers the sphere: its wetted part and the line are carried along
    whole, with the cap inside its fixed edge."""
    table, abscissae = assembly.table, surface.space.abscissae[..., 1]
    _, place = surface.space.edge_place(term.edge)
    fading = 1.0 - np.maximum(abscissae - place, 0.0) / (surface.space.bases[1].breaks[-1] - place)
    along = points_of(surface.space, fading[..., None])[:, 0]
    at = element_points(table, surface.points)
    pull = forces(table, at, assembly.tension, body)
    total = -np.einsum("eai,ea->i", pull, along[table.functions])
    line, hole = (
        contact_line(surface, edge, assembly.points[0], term.sphere)
        for edge in (term.edge, "xi2=0")
    )
    inside = WettedCap(hole, term.sphere, term.toward).push(body)
    pressure = WettedCap(line, term.sphere, term.toward).push(body)
    return Pull(assembly.whole(total) + [0.0, 0.0, inside[2]], pressure)


def particle_forces(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> tuple[ParticleForces, ...]:
    """Forces on the particles on which the membrane ends, of a sheet or a droplet; none where the
    scene has no particle."""
    particles = scene.particles
    if scene.kind == "liquid_sheet" and isinstance(scene.substrate, Sphere):
        particles = (scene.substrate,)
    return tuple(
        _on_particle(scene, assembly, surface, multipliers, particle, which)
        for which, particle in enumerate(particles)
    )


def _on_particle(
    scene: Scene,
    assembly: Assembly,
    surface: Surface,
    multipliers: Array,
    particle: Sphere,
    which: int,
) -> ParticleForces:
    """Forces on a particle with the line of its number.

    Notes
    -----
    The scene's ``acceleration`` weighs the particle and the liquid on it, also where the sheet
    itself is computed without weight.
    """
    scale, sheet = scene.units, scene.kind == "liquid_sheet"
    pull = pull_on_sphere(scene, assembly, surface, multipliers, which)
    line, ball = line_on_sphere(scene, assembly, surface, which), scale.local_sphere(particle)
    lines = sphere_lines(scene)
    cap = WettedCap(line, ball, lines[which].toward) if lines else WettedCap(line, ball)
    g, rho = np.array(scene.acceleration), scene.liquid_density
    pressed, body = pull.pressure, assembly.density(multipliers)
    if sheet and g[2] and not assembly.body.gradient[2]:
        # a sheet without weight still carries weighty liquid: p0 - rho g z on the cap
        unit = scale.length**3 / scale.force
        pressed = pressed - cap.push(BodyDensity(0.0, (0.0, 0.0, rho * g[2] * unit)))
    pressed = scale.axes @ pressed * scale.force
    buoyancy = -rho * cap.volume_over_cone * scale.length**3 * g
    weight = 4.0 / 3.0 * np.pi * particle.radius**3 * particle.density * g
    contact = scale.axes @ (pull.total - pull.pressure) * scale.force
    axis = scale.axes @ np.array(cap.axis)
    # the paper's pressure is that at the rim
    level = np.zeros(3) if sheet else cap.apex
    paper = paper_forces(
        particle,
        -float(body.at(level)) * scale.pressure,
        particle.radius * (1.0 - float(np.cos(cap.polar))),
        *(float(part @ axis) for part in (weight, contact, buoyancy)),
    )
    none, center = np.zeros(3), np.array(particle.center)
    rest = pressed - buoyancy
    return ParticleForces(center, scene.up, weight, contact, rest, buoyancy, none, paper)


def paper_forces(
    particle: Sphere,
    pressure: float,
    cap_height: float,
    weight: float,
    line: float,
    buoyancy: float,
) -> dict[str, float]:
    """Eqs (35)-(39) along the axis from a particle into the liquid, with the pressure on the cap's
    area ``2 pi r b`` and F_B either way."""
    on_cap = -pressure * 2.0 * np.pi * particle.radius * cap_height
    return {
        "F_G": weight,
        "F_CL": line,
        "F_H": on_cap,
        "F_B_up": buoyancy,
        "F_B_down": -buoyancy,
        "F_e_up": weight + line + on_cap + buoyancy,
        "F_e_down": weight + line + on_cap - buoyancy,
    }
