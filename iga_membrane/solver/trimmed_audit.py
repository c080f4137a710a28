"""Independent check of a membrane that passes through its solids.

Doubled quadrature, the geometry of :mod:`iga_membrane.surface.kinematics`, and the weak form with
dual tangents and line elements.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..deadline import check_time
from ..scenes.scene import Scene
from ..splines import Table
from ..surface.motion import Motion
from ..surface.surface import Surface
from ..terms import BodyDensity, PlaneContactLine, SurfaceTension
from .assembly import TINY
from .audit import AT_A_TIME, Audit, edge_forces, missing_volume, scatter, stands_free
from .contact_line import contact_line, vertical_forces
from .trim import EXTRA, Trim

DENSE = 12
"""Points along an element at which the outer part must lie outside."""


def trimmed_audit(
    scene: Scene, surface: Surface, motion: Motion, body: BodyDensity, trim: Trim
) -> Audit:
    """Check a state.

    Parameters
    ----------
    surface : in the scene's scale.
    motion : the directions in which the residual is tested.
    body : body density of the Lagrangian, so minus the pressure.
    trim : with the contact lines of the state.
    """
    terms, sector = scene.local_terms(), scene.sector
    tension = sum(t.gamma for t in terms if isinstance(t, SurfaceTension))
    outside = trim.cut(surface.points, 2 * (surface.space.degree + EXTRA))
    points = 2 * (surface.space.degree + 1)
    dense = surface.space.table(points, trim.elements)
    dense = dense.weighted(outside.share * trim.portion)
    total, absolute = np.zeros(motion.size + 1), np.zeros(motion.size + 1)
    inside = 0.0
    for table in (dense, outside.area):
        for start in range(0, len(table.functions), AT_A_TIME):
            check_time()
            part = table.part(slice(start, start + AT_A_TIME))
            inside += _membrane(surface, part, tension, body, motion, total, absolute)
    line = trim.on_line(surface.points, outside)
    arc = np.linalg.norm(line.tangent, axis=-1) * line.table.weights
    membrane, solid = line.m / line.area[..., None], line.at.normal
    sine = np.linalg.norm(np.cross(membrane, solid), axis=-1)
    # a line that moves along both surfaces trades the one for the other
    density = tension * (solid - line.cosine[..., None] * membrane) * (arc / sine)[..., None]
    pull = line.table.rows[0].transpose(0, 2, 1) @ density
    scatter(total, absolute, motion, line.table.functions, pull)
    for edge, pull in edge_forces(scene, surface, np.zeros(len(surface.points)), points):
        scatter(total, absolute, motion, edge.functions, pull)
    pull = tension * trim.ties.forces(surface.points)
    scatter(total, absolute, motion, trim.ties.across[0], pull)
    total[trim.ties.idle] = 0.0
    size = max(float(np.linalg.norm(absolute[:-1])), TINY * tension)
    residual = float(np.linalg.norm(total[:-1])) / size
    inside += trim.under(surface.points, BodyDensity(1.0), outside)
    inside *= sector.copies
    off = float(np.abs(line.at.gap).max(initial=0.0)) / trim.length
    depth = max(_depth(surface, trim, outside.share), off)
    volume = missing_volume(terms, inside)
    if not stands_free(scene):
        return Audit(residual, volume, penetration=depth)
    gradient = np.array(body.gradient)
    push = density.sum(axis=(0, 1))
    for axis in range(3):
        push[axis] += trim.cap(
            surface.points,
            lambda x, n, which, k=axis: (body.constant + x @ gradient) * n[..., k],  # type: ignore[misc]
            outside,
        )
    push = sector.copies * push
    foot = next((t for t in terms if isinstance(t, PlaneContactLine)), None)
    cosine, below = 0.0, 0.0
    if foot is not None:
        rim = contact_line(surface, foot.edge, points)
        on_plane = vertical_forces(rim, body, tension, foot.contact_angle)
        push[2] -= on_plane.push - on_plane.line
        below = abs(on_plane.push)
        young = float(np.cos(np.radians(foot.contact_angle)))
        cosine = float(np.cos(rim.angle) @ rim.arc / rim.arc.sum()) - young
    weight = float(np.linalg.norm(gradient)) * inside
    size = max(weight, below, abs(float(push[2])), TINY)
    missing = push + gradient * inside
    loose = [axis not in sector.mirrored for axis in "xy"]
    sideways = float(np.hypot(*(missing[:2] * loose))) / size
    return Audit(
        residual,
        volume,
        abs(float(missing[2])) / size,
        sideways,
        angle=cosine,
        penetration=depth,
    )


def _membrane(
    surface: Surface,
    table: Table,
    tension: float,
    body: BodyDensity,
    motion: Motion,
    total: Array,
    absolute: Array,
) -> float:
    """Scatter the weak form of one table; its flux of ``z e_z``."""
    k = surface.on(table)
    area = k.area_element * table.weights
    dual = tension * area[..., None, None] * k.dual_tangents
    pressure = body.constant + k.position @ np.array(body.gradient)
    load = (pressure * area)[..., None] * k.normal
    force = (
        table.d1.transpose(0, 2, 1) @ dual[..., 0, :]
        + table.d2.transpose(0, 2, 1) @ dual[..., 1, :]
        + table.values.transpose(0, 2, 1) @ load
    )
    scatter(total, absolute, motion, table.functions, force)
    return float((k.position[..., 2] * k.normal[..., 2] * area).sum())


def _depth(surface: Surface, trim: Trim, share: Array) -> float:
    """Largest depth over the contact length of elements that count as outside."""
    near = np.flatnonzero(trim.near(surface.points) * share)
    dense = surface.space.table(DENSE, trim.elements[near])
    gap = trim.solid.nearest(dense.values @ surface.points[dense.functions]).gap
    return max(0.0, -float(gap.min(initial=np.inf))) / trim.length
