"""Independent check of a state before it may be called a success.

Nothing assembled by the solver is reused: doubled quadrature, the geometry of
:mod:`iga_membrane.surface.kinematics`, and the weak form with dual tangents.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import Array, Index
from ..assembly.lagrangian import TINY
from ..contact.model import ContactModel
from ..contact.obstacle import Obstacle, is_obstacle
from ..deadline import check_time
from ..dofs.boundary_conditions import Sector
from ..dofs.spines import Motion
from ..dofs.symmetry import sector_table
from ..problems.scene import Scene
from ..results.contact_line import ContactLine, contact_line, vertical_forces
from ..results.measures import sphere_of
from ..results.wetted_cap import WettedCap
from ..solids import Plane, Sphere
from ..splines import EdgeTable
from ..surface.ring import rational_matrix
from ..surface.surface import Surface
from ..terms import BodyDensity, NormalLineLoad, WettingLine
from ..terms.terms import Terms
from .balance import Loads, body_balance, line_balance
from .evidence import Audit
from .own_lines import nodal_forces, outward_pull

AT_A_TIME = 100
"""Elements that are checked at a time: so many fit a processor's cache."""


def audit(
    scene: Scene,
    surface: Surface,
    motion: Motion,
    body: BodyDensity,
    line_load: Array,
    points: tuple[int, int],
    contact: ContactModel,
) -> Audit:
    """Check a state.

    Parameters
    ----------
    surface : in the scene's scale.
    motion : the directions in which the residual is tested.
    body : body density of the Lagrangian, so minus the pressure.
    line_load : (count,) coefficients of the load with which a curved solid holds its edge.
    points : the solver's Gauss points in each direction.
    contact : of the state, with its multipliers.
    """
    space, sector = surface.space, scene.sector
    terms = scene.local_terms()
    tension = terms.tension
    total, absolute = np.zeros(motion.size + 1), np.zeros(motion.size + 1)
    whole = sector_table(space, sector, (2 * points[0], 2 * points[1]))
    laws = terms.gaps
    loads, lowest = Loads(sector.copies), np.inf
    for first in range(0, len(whole.functions), AT_A_TIME):
        check_time()
        table = whole.part(slice(first, first + AT_A_TIME))
        k = surface.on(table)
        area = k.area_element * table.weights
        # int gamma a^alpha . u_,alpha dA + int e u . n dA: membrane and pressure
        # and int f a^alpha . u_,alpha + f' grad(gap) . u dA: laws of the gap
        gaps = [law.at(k.position) for law in laws]
        taut = area * (tension + sum(law.value for law in gaps))
        dual = taut[..., None, None] * k.dual_tangents
        load = (density_at(body, k.position) * area)[..., None] * k.normal
        pulled = area[..., None] * sum((law.pull for law in gaps), np.zeros(3))
        load += pulled
        loads.add(body, k.position, k.normal, area, pulled)
        lowest = min([lowest, *(float(law.at.gap.min()) for law in gaps)])
        force = (
            table.d1.transpose(0, 2, 1) @ dual[..., 0, :]
            + table.d2.transpose(0, 2, 1) @ dual[..., 1, :]
            + table.values.transpose(0, 2, 1) @ load
        )
        scatter(total, absolute, motion, table.functions, force)
    others = []
    for at, carried in contact.loads(surface.points):
        others.append(sector.copies * float(carried[..., 2].sum()))
        pull = -at.values.transpose(0, 2, 1) @ carried
        scatter(total, absolute, motion, at.functions, pull)
    for which, edge_pull in edge_forces(scene, surface, line_load, 2 * points[0]):
        scatter(total, absolute, motion, which, edge_pull)
        if scene.line_inside is not None:
            others.append(-sector.copies * float(edge_pull[..., 2].sum()))
    found = Audit(
        relative_residual(total, absolute, tension),
        missing_volume(terms, loads.inside),
        line=line_balance(scene, surface, loads, tension, 2 * points[0], solids=others),
    )
    if is_obstacle(contact):
        return replace(found, **_lying(scene, surface, body, loads, contact, others, points))
    if not terms.wetting:
        depth = max(0.0, -lowest) / surface.size if laws else None
        return replace(found, penetration=depth)
    return replace(found, **_ending(scene, surface, body, loads.inside, terms.wetting, points))


def _lying(
    scene: Scene,
    surface: Surface,
    body: BodyDensity,
    loads: Loads,
    contact: Obstacle,
    others: list[float],
    points: tuple[int, int],
) -> dict[str, Any]:
    """Defects of a membrane that lies on a solid.

    Parameters
    ----------
    others : vertical forces on the membrane of the solid and of lines inside it.
    """
    found: dict[str, Any] = {}
    if contact.resolves:
        found["penetration"], found["deepest"] = _depth(surface, contact, points)
        found["angle"] = _tilt(surface, contact)
    if scene.line_inside is not None:
        term = scene.local_terms().wetting[0]
        line = contact_line(surface, scene.line_inside, 2 * points[0], sphere_of(scene))
        found["angle"] = cosine_error(line, -term.strength / term.gamma - 1.0)
    if is_hung(scene):
        return found
    size = max(abs(loads.push), abs(others[0]), TINY)
    found["force"] = abs(loads.push + sum(others)) / size
    sector = scene.sector
    loose = [axis not in sector.mirrored for axis in "xy"]
    if any(loose) and stands_free(scene):
        push = contact.push(contact.touch(surface.points)).sum(axis=(0, 1))[:2]
        aside = sector.copies * push - np.array(body.gradient[:2]) * loads.inside
        found["sideways"] = float(np.hypot(*(aside * loose))) / size
    return found


def _ending(
    scene: Scene,
    surface: Surface,
    body: BodyDensity,
    inside: float,
    lines: list[WettingLine],
    points: tuple[int, int],
) -> dict[str, Any]:
    """Defects of a membrane that ends on solids.

    Parameters
    ----------
    inside : volume behind the membrane alone.
    """
    sector = scene.sector
    tension = scene.local_terms().tension
    found: dict[str, Any] = {}
    cosine, sunk, pull, carried = 0.0, 0.0, np.zeros(3), 0.0
    foot, on_spheres, standing = None, False, 90.0
    for term in lines:
        sphere = term.ball
        line = contact_line(surface, term.edge, 2 * points[0], term.face)
        young = young_cosine(scene, surface, term, line)
        angle = float(np.arccos(np.clip(young, -1.0, 1.0)))
        if not term.pinned:
            cosine = max(cosine, cosine_error(line, young), key=abs)
        gap, nearest = _nearest(surface, points, sector, term.face)
        found.setdefault("deepest", nearest)
        if sphere is None:
            found["penetration"] = max(found.get("penetration", 0.0), -gap)
            level = term.level
            if not level:
                foot, standing = line, float(np.degrees(angle))
                continue
            above = BodyDensity(float(body.at(np.array([0.0, 0.0, level]))), body.gradient)
            on_it = vertical_forces(line, above, tension, float(np.degrees(angle)))
            # the edge runs clockwise, so what is wet counts negative
            inside -= level * on_it.wet_area
            pull[2] -= on_it.push + on_it.line
            carried += abs(on_it.push) + abs(on_it.line)
            continue
        on_spheres = True
        cap = WettedCap(line, sphere, term.toward)
        inside -= cap.push(BodyDensity(0.0, (0.0, 0.0, 1.0)))[2]
        line_pull = _line_pull(cap, tension, angle)
        pull += line_pull + cap.push(body)
        carried += float(abs(line_pull[2]) + abs(cap.push(body)[2]))
        away = float(np.abs(sphere.gap(line.position)).max())
        sunk = max(sunk, away / sphere.radius, -gap / sphere.radius)
    found["angle"] = cosine
    if on_spheres:
        found["indentation" if foot is not None else "penetration"] = sunk
    found["volume"] = missing_volume(scene.local_terms(), inside)
    if not stands_free(scene):
        return found
    return found | body_balance(scene, body, inside, pull, carried, foot, standing)


def _tilt(surface: Surface, contact: Obstacle) -> float | None:
    """Mean cosine between membrane and solid where they touch, less that of 180 degrees, on the
    solid where it is worst; None where adhesion stands for an angle, or nothing touches."""
    touch = contact.touch(surface.points)
    load = touch.traction * contact.area
    if contact.adhesion or not load.any():
        return None
    cosine = np.einsum("eqi,eqi->eq", surface.on(contact.table).normal, touch.at.normal)
    _, place = np.unique(touch.at.which[load > 0], return_inverse=True)
    on_each = [np.bincount(place, v[load > 0]) for v in (load * (cosine + 1.0), load)]
    return float((on_each[0] / on_each[1]).max())


def cosine_error(line: ContactLine, young: float) -> float:
    """Mean cosine of the angle along a contact line, less Young's."""
    return float(np.cos(line.angle) @ line.arc / line.arc.sum()) - young


def relative_residual(total: Array, absolute: Array, tension: float) -> float | None:
    """Norm of the weak form over that of its absolute contributions; None where nothing moves.

    Parameters
    ----------
    total, absolute : (unknowns + 1,) sums and sums of sizes; the last entry is that of what is
        held.
    """
    if len(total) == 1:
        return None
    size = max(float(np.linalg.norm(absolute[:-1])), TINY * tension)
    return float(np.linalg.norm(total[:-1])) / size


def young_cosine(scene: Scene, surface: Surface, term: WettingLine, line: ContactLine) -> float:
    """Mean cosine of the angle at which a contact line is in balance: Young's, and what other lines
    along the same edge pull outwards."""
    terms, normal = scene.local_terms(), term.normal(line.position)
    along, _ = surface.space.edge_place(term.edge)
    points = len(line.arc) // surface.space.bases[along].elements
    pull = sum(
        outward_pull(t, surface.space.edge_table(t.edge, points), surface, line, normal)
        for t in terms.others
        if t.edge == term.edge
    )
    return -(term.strength + pull) / terms.tension


def _line_pull(cap: WettedCap, tension: float, angle: float) -> Array:
    """(3,) force of the membrane on a sphere at an angle (radians): along
    ``sin(theta) n + cos(theta) n x t``."""
    line = cap.line
    normal = cap.sphere.normal(line.position)
    along = np.sin(angle) * normal + np.cos(angle) * np.cross(normal, line.tangent)
    return np.asarray(tension * line.arc @ along)


def edge_forces(
    scene: Scene, surface: Surface, line_load: Array, points: int
) -> Iterator[tuple[Index, Array]]:
    """Control points (elements, local) and forces (elements, local, 3) on them of the lines at the
    membrane's edges, with Gauss points along them."""
    ring = np.arange(surface.space.bases[0].elements // scene.sector.copies)
    terms, space = scene.local_terms(), surface.space
    for other in terms.others:
        yield nodal_forces(other, space.edge_table(other.edge, points, ring), surface)
    for pressed in terms.pressed:
        edge = space.edge_table(pressed.edge, points, ring)
        yield edge.functions, _pressed(pressed, edge, surface.points)
    for term in terms.wetting:
        edge = space.edge_table(term.edge, points, ring)
        tangent = edge.d @ surface.points[edge.functions]
        up = term.normal(edge.values @ surface.points[edge.functions])
        load = np.einsum("eqa,ea->eq", edge.values, line_load[edge.functions])
        density = term.turn * term.strength * np.cross(tangent, up) - load[..., None] * up
        pull = edge.values.transpose(0, 2, 1) @ (edge.weights[..., None] * density)
        yield edge.functions, pull


def _pressed(term: NormalLineLoad, edge: EdgeTable, points: Array) -> Array:
    """(elements, local, 3) nodal forces of the normal line load, with its part of the gap."""
    x, tangent = (rows @ points[edge.functions] for rows in (edge.values, edge.d))
    speed = np.linalg.norm(tangent, axis=-1, keepdims=True)
    load = term.strength * edge.weights[..., None]
    at = term.solid.nearest(x)
    return np.asarray(
        edge.values.transpose(0, 2, 1) @ (load * speed * at.normal)
        + edge.d.transpose(0, 2, 1) @ (load * at.gap[..., None] * tangent / speed)
    )


def missing_volume(terms: Terms, inside: float) -> float | None:
    """Relative error of a prescribed volume; None where none is."""
    held = terms.volume
    return abs(inside - held.target) / held.value if held else None


def stands_free(scene: Scene) -> bool:
    """Whether nothing but the solid carries the liquid's weight."""
    return not scene.by_form.pressures and not is_hung(scene)


def is_hung(scene: Scene) -> bool:
    """Whether edges are held that no solid carries: an edge that leaves its solid at 0 or 180
    degrees is fixed where it does so by itself."""
    tangent = {t.edge for t in scene.by_form.wetting if abs(t.strength) >= t.gamma}
    kinds = scene.by_kind
    return bool(kinds.mirrors) or any(s.edge not in tangent for s in kinds.fixed)


Place = tuple[float, float, float]


def _depth(
    surface: Surface, contact: Obstacle, points: tuple[int, int]
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


def density_at(body: BodyDensity, x: Array) -> Array:
    return np.asarray(body.constant + x @ np.array(body.gradient))


def scatter(total: Array, absolute: Array, motion: Motion, functions: Index, force: Array) -> None:
    work = np.einsum("eai,eai->ea", force, motion.directions[functions])
    where = motion.unknowns[functions]
    np.add.at(total, where, work)
    np.add.at(absolute, where, np.abs(work))


def _nearest(
    surface: Surface, points: tuple[int, int], sector: Sector, solid: Plane | Sphere
) -> tuple[float, Place]:
    """Smallest gap to the solid on a sampling four times denser than the quadrature, and where."""
    one, two = surface.space.bases
    n1 = 4 * points[0] * one.elements // sector.copies
    s = np.linspace(one.breaks[0], one.breaks[-1], n1 * sector.copies + 1)[: n1 + 1]
    t = np.linspace(two.breaks[0], two.breaks[-1], 4 * points[1] * two.elements + 1)
    lines = np.tensordot(one.matrix(s), surface.net, axes=1)
    x = (rational_matrix(surface.space, t) @ lines).reshape(-1, 3)
    gap = solid.gap(x)
    return float(gap.min()), _place(x[gap.argmin()])
