"""Lines that pay for something else than the area they wet: their forces from their energy alone.

A term that only gives its energy is audited by differences of it, so that its derivatives, which
the solver used, are checked and not reused.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..results.contact_line import ContactLine
from ..splines import EdgeTable
from ..surface.surface import Surface
from ..terms import BodyDensity, LineTerm

STEP = 6e-6
"""Step over a surface's size: of the central difference truncation and rounding are alike there,
about 1e-11 (the cube root of double precision)."""


def energy_of(term: LineTerm, edge: EdgeTable, points: Array) -> float:
    """Energy of a line for control points (count, 3)."""
    return float(term.energy(edge, points, term.strength, BodyDensity()))


def slope_of(term: LineTerm, edge: EdgeTable, surface: Surface, motion: Array) -> float:
    """Derivative of the energy along a motion (count, 3) of the control points."""
    reach = float(np.abs(motion).max())
    if not reach:
        return 0.0
    if term.holds:
        # its law bends on a scale of its own, below that of differences
        pull = term.forces(edge, surface.points, term.strength, BodyDensity())
        return float((pull * motion[edge.functions]).sum())
    step = STEP * surface.size / reach
    there, back = (energy_of(term, edge, surface.points + h * motion) for h in (step, -step))
    return (there - back) / (2.0 * step)


def nodal_forces(term: LineTerm, edge: EdgeTable, surface: Surface) -> tuple[Index, Array]:
    """Control points (1, k) on which a line's energy depends, and its derivatives (1, k, 3)."""
    which = np.unique(edge.functions)
    forces = np.zeros((1, len(which), 3))
    for place, point in enumerate(which):
        for axis in range(3):
            motion = np.zeros_like(surface.points)
            motion[point, axis] = 1.0
            forces[0, place, axis] = slope_of(term, edge, surface, motion)
    return which[None], forces


def outward_pull(
    term: LineTerm, edge: EdgeTable, surface: Surface, line: ContactLine, normal: Array
) -> float:
    """Derivative of a line's energy per length as the line moves outwards along its solid.

    Parameters
    ----------
    edge : of the whole line, at the points of ``line``.
    normal : (k, 3) of the solid there.

    Notes
    -----
    With it Young's equation reads ``gamma (cos(theta) - cos(theta_Y)) + dE/dn / length = 0``; for a
    line tension tau on a plane that is Boruvka's and Neumann's, ``- tau / (gamma r)``.
    """
    out = np.cross(line.tangent, normal)
    which, place = np.unique(edge.functions, return_inverse=True)
    values = np.zeros((edge.values.shape[0] * edge.values.shape[1], len(which)))
    rows = np.arange(len(values)).reshape(edge.values.shape[:2])
    where = place.reshape(edge.functions.shape)
    np.add.at(values, (rows[..., None], where[:, None, :]), edge.values)
    motion = np.zeros_like(surface.points)
    motion[which] = np.linalg.lstsq(values, out, rcond=None)[0]
    return slope_of(term, edge, surface, motion) / float(line.arc.sum())
