"""Independent check of a membrane that passes through its solids.

Doubled quadrature, the geometry of :mod:`iga_membrane.surface.kinematics`, and the weak form with
dual tangents and line elements.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ..arrays import Array, Index
from ..assembly.lagrangian import TINY
from ..contact.unfitted import EXTRA, Outside, Unfitted
from ..deadline import check_time
from ..dofs.spines import Motion
from ..problems.scene import Scene
from ..results.contact_line import ContactLine, contact_line, vertical_forces
from ..splines import Table
from ..surface.surface import Surface
from ..terms import BodyDensity, WettingLine
from ..terms.trimmed import Line
from .audit import (
    AT_A_TIME,
    cosine_error,
    density_at,
    edge_forces,
    is_hung,
    missing_volume,
    relative_residual,
    scatter,
    stands_free,
)
from .balance import NOTHING, Loads, line_balance
from .evidence import Audit

DENSE = 12
"""Points along an element at which the outer part must lie outside."""


def trimmed_audit(
    scene: Scene, surface: Surface, motion: Motion, body: BodyDensity, unfitted: Unfitted
) -> Audit:
    """Check a state.

    Parameters
    ----------
    surface : in the scene's scale.
    motion : the directions in which the residual is tested.
    body : body density of the Lagrangian, so minus the pressure.
    unfitted : with the contact lines of the state.
    """
    terms, sector = scene.local_terms(), scene.sector
    tension = terms.tension
    outside = unfitted.cut(surface.points, 2 * (surface.space.degree + EXTRA))
    points = 2 * (surface.space.degree + 1)
    dense = surface.space.table(points, unfitted.elements)
    dense = dense.weighted(outside.share * unfitted.portion)
    total, absolute = np.zeros(motion.size + 1), np.zeros(motion.size + 1)
    loads = Loads(sector.copies)
    for table in (dense, outside.area):
        for start in range(0, len(table.functions), AT_A_TIME):
            check_time()
            part = table.part(slice(start, start + AT_A_TIME))
            _membrane(surface, part, tension, body, motion, total, absolute, loads)
    line = unfitted.on_line(surface.points, outside)
    arc = np.linalg.norm(line.tangent, axis=-1) * line.table.weights
    membrane, solid = line.m / line.area[..., None], line.at.normal
    sine = np.linalg.norm(np.cross(membrane, solid), axis=-1)
    # a line that moves along both surfaces trades the one for the other
    density = tension * (solid - line.cosine[..., None] * membrane) * (arc / sine)[..., None]
    pull = line.table.rows[0].transpose(0, 2, 1) @ density
    scatter(total, absolute, motion, line.table.functions, pull)
    for which, pull in edge_forces(scene, surface, np.zeros(len(surface.points)), points):
        scatter(total, absolute, motion, which, pull)
    pull = tension * unfitted.ties.forces(surface.points)
    scatter(total, absolute, motion, unfitted.ties.across[0], pull)
    total[unfitted.ties.idle] = 0.0
    under = unfitted.under(surface.points, BodyDensity(1.0), outside)
    inside = loads.inside + sector.copies * under
    off = float(np.abs(line.at.gap).max(initial=0.0)) / unfitted.length
    own, young = (float(v[..., 2].ravel() @ arc.ravel()) for v in _conormals(line))
    pulls = [sector.copies * tension * pull for pull in (own, young)]
    foot = next((t for t in terms.wetting if t.ball is None), None)
    rim = None if foot is None else contact_line(surface, foot.edge, points)
    found = Audit(
        relative_residual(total, absolute, tension),
        missing_volume(terms, inside),
        line=line_balance(scene, surface, loads, tension, points, inside=pulls[:1]),
        angle=_worst_angle(line, arc, rim, foot),
        penetration=max(_depth(surface, unfitted, outside.share), off),
    )
    if is_hung(scene):
        return found
    if not stands_free(scene):
        size = max(abs(loads.push), abs(pulls[1]), TINY)
        return replace(found, force=abs(loads.push + pulls[1]) / size)
    gradient = np.array(body.gradient)
    drawn = sector.copies * density.sum(axis=(0, 1))
    pressed = sector.copies * _pressed(unfitted, surface, body, outside)
    push = drawn + pressed
    below = 0.0
    if foot is not None and rim is not None:
        on_plane = vertical_forces(rim, body, tension, _young(foot))
        push[2] -= on_plane.push - on_plane.line
        below = abs(on_plane.push)
    weight = float(np.linalg.norm(gradient)) * inside
    carried = float(abs(drawn[2]) + abs(pressed[2]))
    least = NOTHING * carried if weight else carried  # without weight lines and pressure balance
    size = max(weight, below, abs(float(push[2])), least, TINY)
    missing = push + gradient * inside
    loose = [axis not in sector.mirrored for axis in "xy"]
    sideways = float(np.hypot(*(missing[:2] * loose))) / size if any(loose) else None
    return replace(found, force=abs(float(missing[2])) / size, sideways=sideways)


def _pressed(unfitted: Unfitted, surface: Surface, body: BodyDensity, outside: Outside) -> Array:
    """(3,) force of the liquid on the wetted surfaces of the solids (one sector)."""

    def push(x: Array, n: Array, which: Index, k: int) -> Array:
        return np.asarray(body.at(x) * n[..., k])

    return np.array(
        [unfitted.cap(surface.points, partial(push, k=axis), outside) for axis in range(3)]
    )


def _conormals(line: Line) -> tuple[Array, Array]:
    """(pieces, points, 3) outward unit conormals of the membrane at its lines on solids: by its
    own tangents, and those of a membrane at Young's angle."""
    normal, solid = line.m / line.area[..., None], line.at.normal
    cosine = (normal * solid).sum(axis=-1, keepdims=True)
    sine = np.sqrt(np.maximum(1.0 - cosine**2, TINY))
    along = (normal - cosine * solid) / sine
    young = line.cosine[..., None]
    return (cosine * normal - solid) / sine, young * along - np.sqrt(1.0 - young**2) * solid


def _worst_angle(
    line: Line, arc: Array, rim: ContactLine | None, foot: WettingLine | None
) -> float | None:
    """Mean cosine of the angle less Young's, on the solid where it is worst; None without lines."""
    cosine = (line.m / line.area[..., None] * line.at.normal).sum(axis=-1)
    _, place = np.unique(line.at.which[:, 0], return_inverse=True)
    off = np.bincount(place, ((cosine - line.cosine) * arc).sum(axis=1))
    errors = [*(off / np.bincount(place, arc.sum(axis=1)))]
    if rim is not None and foot is not None:
        errors.append(cosine_error(rim, -foot.strength / foot.gamma))
    return float(max(errors, key=abs)) if errors else None


def _young(line: WettingLine) -> float:
    """Contact angle of a line in degrees."""
    return float(np.degrees(np.arccos(np.clip(-line.strength / line.gamma, -1.0, 1.0))))


def _membrane(
    surface: Surface,
    table: Table,
    tension: float,
    body: BodyDensity,
    motion: Motion,
    total: Array,
    absolute: Array,
    loads: Loads,
) -> None:
    """Scatter the weak form of one table, and add its loads."""
    k = surface.on(table)
    area = k.area_element * table.weights
    dual = tension * area[..., None, None] * k.dual_tangents
    load = (density_at(body, k.position) * area)[..., None] * k.normal
    force = (
        table.d1.transpose(0, 2, 1) @ dual[..., 0, :]
        + table.d2.transpose(0, 2, 1) @ dual[..., 1, :]
        + table.values.transpose(0, 2, 1) @ load
    )
    scatter(total, absolute, motion, table.functions, force)
    loads.add(body, k.position, k.normal, area, None)


def _depth(surface: Surface, unfitted: Unfitted, share: Array) -> float:
    """Largest depth over the contact length of elements that count as outside."""
    near = np.flatnonzero(unfitted.near(surface.points) * share)
    dense = surface.space.table(DENSE, unfitted.elements[near])
    gap = unfitted.solid.nearest(dense.values @ surface.points[dense.functions]).gap
    return max(0.0, -float(gap.min(initial=np.inf))) / unfitted.length
