"""Independent check of a state before it may be called a success.

Nothing assembled by the solver is reused: doubled quadrature, the geometry of
:mod:`iga_membrane.surface.kinematics`, and the weak form with dual tangents.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index
from ..deadline import check_time
from ..scenes.scene import Scene
from ..solids import Sphere
from ..splines import EdgeTable
from ..surface.motion import Motion
from ..surface.ring import rational_matrix
from ..surface.sector import sector_table
from ..surface.supports import Fixed, Sector, Symmetry
from ..surface.surface import Surface
from ..terms import (
    BodyDensity,
    LineTerm,
    LocalGap,
    NormalLineLoad,
    Pressure,
    SphereContactLine,
    SurfaceTension,
    Term,
    Volume,
)
from .assembly import TINY
from .contact import ContactSet
from .contact_line import contact_line, vertical_forces
from .measures import sphere_of
from .point_supports import PointSupports
from .wetted_cap import WettedCap


@dataclass(frozen=True)
class Audit:
    """Defects of a state, all relative.

    Attributes
    ----------
    residual : norm of the weak form over the norm of its absolute contributions.
    volume : over the prescribed volume; 0 where none is prescribed.
    force : vertical force balance ``p A_wet - line - weight`` over ``p A_wet`` plus the line's
        force, with the line's force from Young's angle; on a sphere the same over the weight.
    sideways : horizontal force of the solids on the liquid over its weight, where gravity has none
        and the model does not rule it out; beside a particle over the same as ``force``.
    line : the same with the line's force from the spline's own tangents: converges slower, so it
        tells how well the line is resolved.
    angle : mean cosine of the measured contact angle minus that of Young's.
    penetration : depth in the solid on a sampling four times denser than the quadrature, over the
        scene's length (plane) or the sphere's radius; there also the line's distance from it.
    indentation : the same of a particle beside a plane, over its radius.
    deepest : the point of the sampling that lies deepest, or nearest to the solid, in the scene's
        scale; None without a solid.
    """

    residual: float
    volume: float = 0.0
    force: float = 0.0
    sideways: float = 0.0
    line: float = 0.0
    angle: float = 0.0
    penetration: float = 0.0
    indentation: float = 0.0
    deepest: tuple[float, float, float] | None = None

    @property
    def defects(self) -> dict[str, float]:
        """Name to value."""
        return {name: value for name, value in vars(self).items() if name != "deepest"}


NOTHING = 1e-2
"""Weight over the forces of line and pressure on a sphere below which these are the measure."""
AT_A_TIME = 100
"""Elements that are checked at a time: so many fit a processor's cache."""


def audit(
    scene: Scene,
    surface: Surface,
    motion: Motion,
    body: BodyDensity,
    line_load: Array,
    points: tuple[int, int],
    contact: ContactSet | None = None,
) -> Audit:
    """Check a state.

    Parameters
    ----------
    surface : in the scene's scale.
    motion : the directions in which the residual is tested.
    body : body density of the Lagrangian, so minus the pressure.
    line_load : (count,) coefficients of the load with which a curved solid holds its edge.
    points : the solver's Gauss points in each direction.
    contact : of a membrane that lies on a solid, with its multipliers.
    """
    space, sector = surface.space, scene.sector
    terms = scene.local_terms()
    tension = sum(t.gamma for t in terms if isinstance(t, SurfaceTension))
    total, absolute = np.zeros(motion.size + 1), np.zeros(motion.size + 1)
    whole = sector_table(space, sector, (2 * points[0], 2 * points[1]))
    inside, lift, lowest = 0.0, 0.0, np.inf
    for first in range(0, len(whole.functions), AT_A_TIME):
        check_time()
        table = whole.part(slice(first, first + AT_A_TIME))
        k = surface.on(table)
        area = k.area_element * table.weights
        # int gamma a^alpha . u_,alpha dA + int e u . n dA: membrane and pressure
        # and int f a^alpha . u_,alpha + f' grad(gap) . u dA: laws of the gap
        laws = [term.at(k.position) for term in terms if isinstance(term, LocalGap)]
        taut = area * (tension + sum(law.value for law in laws))
        dual = taut[..., None, None] * k.dual_tangents
        load = (_density(body, k.position) * area)[..., None] * k.normal
        for law in laws:
            load += area[..., None] * law.pull
            lift += sector.copies * float((law.pull[..., 2] * area).sum())
            lowest = min(lowest, float(law.at.gap.min()))
        force = (
            table.d1.transpose(0, 2, 1) @ dual[..., 0, :]
            + table.d2.transpose(0, 2, 1) @ dual[..., 1, :]
            + table.values.transpose(0, 2, 1) @ load
        )
        scatter(total, absolute, motion, table.functions, force)
        inside += sector.copies * float((k.position[..., 2] * k.normal[..., 2] * area).sum())
    if contact is not None:
        push = contact.push(contact.touch(surface.points))
        pull = -contact.table.values.transpose(0, 2, 1) @ push
        scatter(total, absolute, motion, contact.table.functions, pull)
    lines = [t for t in terms if isinstance(t, LineTerm)]
    solid = sphere_of(scene)
    for edge, edge_pull in edge_forces(scene, surface, line_load, 2 * points[0]):
        scatter(total, absolute, motion, edge.functions, edge_pull)
    size = max(float(np.linalg.norm(absolute[:-1])), TINY * tension)
    residual = float(np.linalg.norm(total[:-1])) / size
    if contact is not None:
        depth, place = 0.0, None
        if not isinstance(contact, PointSupports):
            depth, place = _depth(surface, contact, points)
        weight = body.gradient[2] * inside
        carried = -sector.copies * float(push[..., 2].sum())
        if scene.line_inside is not None:
            line = contact_line(surface, scene.line_inside, 2 * points[0], solid)
            young = -lines[0].strength / tension - 1.0
            cosine = float(np.cos(line.angle) @ line.arc / line.arc.sum()) - young
            volume = missing_volume(terms, inside)
            return Audit(residual, volume, angle=cosine, penetration=depth)
        missing = abs(carried + weight + lift) / max(abs(weight), abs(carried), TINY)
        if not stands_free(scene):
            return Audit(residual, missing_volume(terms, inside), penetration=depth, deepest=place)
        loose = [axis not in sector.mirrored for axis in "xy"]
        pushed = sector.copies * push[..., :2].sum(axis=(0, 1)) * loose
        pushed = pushed - np.array(body.gradient[:2]) * inside * loose
        sideways = float(np.hypot(*pushed)) / max(abs(weight), TINY)
        volume = missing_volume(terms, inside)
        return Audit(residual, volume, missing, sideways, penetration=depth, deepest=place)
    if not lines:
        depth = max(0.0, -lowest) / surface.size
        return Audit(residual, missing_volume(terms, inside), penetration=depth)
    cosine, sunk, depth, pull, carried = 0.0, 0.0, 0.0, np.zeros(3), 0.0
    place, foot = None, None
    for term in lines:
        sphere = term.sphere if isinstance(term, SphereContactLine) else None
        line = contact_line(surface, term.edge, 2 * points[0], sphere)
        off = float(np.cos(line.angle) @ line.arc / line.arc.sum()) + term.strength / tension
        cosine = max(cosine, off, key=abs)
        gap, nearest = _nearest(surface, points, sector, sphere)
        place = place or nearest
        if not isinstance(term, SphereContactLine):
            depth, foot = max(0.0, -gap), line
            continue
        cap = WettedCap(line, term.sphere, term.toward)
        inside -= cap.push(BodyDensity(0.0, (0.0, 0.0, 1.0)))[2]
        line_pull = _line_pull(cap, tension)
        pull += line_pull + cap.push(body)
        carried += float(abs(line_pull[2]) + abs(cap.push(body)[2]))
        away = float(np.abs(term.sphere.gap(line.position)).max())
        sunk = max(sunk, away / term.sphere.radius, -gap / term.sphere.radius)
    missing = missing_volume(terms, inside)
    if foot is None:
        open_force = 0.0
        if stands_free(scene):
            # of the weight, unless it is nothing beside what balances at the line
            weight = float(body.gradient[2] * inside)
            open_force = abs(weight + float(pull[2])) / max(abs(weight), NOTHING * carried, TINY)
        return Audit(residual, missing, open_force, angle=cosine, penetration=sunk, deepest=place)
    if any(isinstance(s, (Fixed, Symmetry)) for s in scene.supports):
        return Audit(residual, missing, angle=cosine, penetration=depth, deepest=place)
    angle = np.degrees(np.arccos(np.clip(-lines[0].strength / tension, -1.0, 1.0)))
    forces = vertical_forces(foot, body, tension, float(angle))
    weight = body.gradient[2] * inside + pull[2]
    scale = abs(forces.push) + abs(forces.line) + abs(weight)
    loose = [bool(pull.any()) and axis not in sector.mirrored for axis in "xy"]
    unbalanced = (np.array(body.gradient[:2]) * inside + pull[:2]) * loose
    return Audit(
        residual,
        missing,
        force=abs(forces.push - forces.line - weight) / scale,
        sideways=float(np.hypot(*unbalanced)) / scale,
        line=abs(forces.push - forces.measured - weight) / scale,
        angle=cosine,
        penetration=depth,
        indentation=sunk,
        deepest=place,
    )


def _line_pull(cap: WettedCap, tension: float) -> Array:
    """(3,) force of the membrane on a sphere at Young's angle: along
    ``sin(theta) n + cos(theta) n x t``."""
    line, angle = cap.line, np.radians(cap.sphere.contact_angle)
    normal = cap.sphere.normal(line.position)
    along = np.sin(angle) * normal + np.cos(angle) * np.cross(normal, line.tangent)
    return np.asarray(tension * line.arc @ along)


def edge_forces(
    scene: Scene, surface: Surface, line_load: Array, points: int
) -> Iterator[tuple[EdgeTable, Array]]:
    """Nodal forces (elements, local, 3) of the contact lines at the membrane's edges, with
    Gauss points along them."""
    ring = np.arange(surface.space.bases[0].elements // scene.sector.copies)
    for term in scene.local_terms():
        if not isinstance(term, LineTerm):
            continue
        edge = surface.space.edge_table(term.edge, points, ring)
        tangent = edge.d @ surface.points[edge.functions]
        x = edge.values @ surface.points[edge.functions]
        if isinstance(term, NormalLineLoad):
            yield edge, _pressed(term, edge, x, tangent)
            continue
        up, turn = np.broadcast_to([0.0, 0.0, 1.0], x.shape), 1.0
        if isinstance(term, SphereContactLine):
            up, turn = term.sphere.normal(x), term.turn
        load = np.einsum("eqa,ea->eq", edge.values, line_load[edge.functions])
        density = turn * term.strength * np.cross(tangent, up) - load[..., None] * up
        yield edge, edge.values.transpose(0, 2, 1) @ (edge.weights[..., None] * density)


def _pressed(term: NormalLineLoad, edge: EdgeTable, x: Array, tangent: Array) -> Array:
    """(elements, local, 3) nodal forces of the normal line load, with its part of the gap."""
    speed = np.linalg.norm(tangent, axis=-1, keepdims=True)
    load = term.strength * edge.weights[..., None]
    at = term.solid.nearest(x)
    return np.asarray(
        edge.values.transpose(0, 2, 1) @ (load * speed * at.normal)
        + edge.d.transpose(0, 2, 1) @ (load * at.gap[..., None] * tangent / speed)
    )


def missing_volume(terms: tuple[Term, ...], inside: float) -> float:
    """Relative error of a prescribed volume."""
    held = next((t for t in terms if isinstance(t, Volume)), None)
    return abs(inside - held.target) / held.value if held else 0.0


def stands_free(scene: Scene) -> bool:
    """Whether nothing but the solid carries the liquid's weight."""
    return not any(isinstance(t, Pressure) for t in scene.terms) and not any(
        isinstance(s, (Fixed, Symmetry)) for s in scene.supports
    )


Place = tuple[float, float, float]


def _depth(
    surface: Surface, contact: ContactSet, points: tuple[int, int]
) -> tuple[float, Place | None]:
    """Largest depth over the contact length, sampled four times denser than the quadrature, and
    where the membrane is nearest to the solid."""
    touch = contact.touch(surface.points)
    near = np.flatnonzero((touch.at.gap < contact.length).any(axis=1))
    lowest, place = np.inf, None
    for some in np.array_split(contact.elements[near], max(1, len(near) // 500)):
        dense = surface.space.table((4 * points[0], 4 * points[1]), some)
        x = (dense.values @ surface.points[dense.functions]).reshape(-1, 3)
        gap = contact.solid.nearest(x).gap
        if gap.size and gap.min() < lowest:
            lowest, place = float(gap.min()), _place(x[gap.argmin()])
    return max(0.0, -lowest) / contact.length, place


def _place(x: Array) -> Place:
    return float(x[0]), float(x[1]), float(x[2])


def _density(body: BodyDensity, x: Array) -> Array:
    return np.asarray(body.constant + x @ np.array(body.gradient))


def scatter(total: Array, absolute: Array, motion: Motion, functions: Index, force: Array) -> None:
    work = np.einsum("eai,eai->ea", force, motion.directions[functions])
    where = motion.unknowns[functions]
    np.add.at(total, where, work)
    np.add.at(absolute, where, np.abs(work))


def _nearest(
    surface: Surface, points: tuple[int, int], sector: Sector, solid: Sphere | None
) -> tuple[float, Place]:
    """Smallest gap to the solid on a sampling four times denser than the quadrature, and where."""
    one, two = surface.space.bases
    n1 = 4 * points[0] * one.elements // sector.copies
    s = np.linspace(one.breaks[0], one.breaks[-1], n1 * sector.copies + 1)[: n1 + 1]
    t = np.linspace(two.breaks[0], two.breaks[-1], 4 * points[1] * two.elements + 1)
    lines = np.tensordot(one.matrix(s), surface.net, axes=1)
    x = (rational_matrix(surface.space, t) @ lines).reshape(-1, 3)
    gap = x[:, 2] if solid is None else solid.gap(x)
    return float(gap.min()), _place(x[gap.argmin()])
