"""A sheet that passes through its particle: one patch over the whole rim, moving vertically."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..solids import Sphere
from ..surface.ring import axisymmetric, drop_space
from ..surface.shapes import sheet as flat_square
from ..surface.surface import Surface
from .liquid import Mesh
from .profiles import funnel, gathered

DRAWN = 0.5
"""Part by which steps at the contact line are shorter."""


def sheet_through(
    particle: Sphere, half: float, boundary: str, mesh: Mesh, curvature: float
) -> tuple[Surface, Array]:
    """Start of a sheet whose contact line may lie anywhere in it, and its vertical directions.

    Parameters
    ----------
    half : half of the rim's size.
    curvature : pressure over tension.
    """
    profile, r = funnel(particle, half, curvature), particle.radius
    rim, line = r * profile.rim, r * profile.edge
    x, y, _ = particle.center
    centre = np.array([x, y])
    radii = np.linspace(0.0, rim, 8001)
    drawn = gathered(radii, line, DRAWN)
    flat: Array
    if boundary == "circle":
        space = drop_space("bspline", mesh.degree, mesh.elements)

        def disc_of(t: Array) -> tuple[Array, Array, Array]:
            return half * (1.0 - t), np.zeros_like(t), np.full_like(t, -half)

        disc = axisymmetric(space, disc_of)
        flat = disc.points * [1.0, -1.0, 1.0]
    else:
        square = flat_square(2.0 * half, elements=mesh.elements, degree=mesh.degree)
        space, flat = square.space, square.points[:, [1, 0, 2]]
    away = flat[:, :2] - centre
    reach = np.linalg.norm(away, axis=1)
    factor = np.where(reach < rim, np.interp(reach, radii, drawn) / np.maximum(reach, 1e-300), 1.0)
    place = centre + away * factor[:, None]
    radius = np.linalg.norm(place - centre, axis=1)
    z = r * profile.through(radius / r)
    z[_on_rim(flat, half, boundary)] = 0.0
    surface = Surface(space, np.column_stack([place, z]))
    return surface, np.tile([0.0, 0.0, 1.0], (space.count, 1))


def _on_rim(flat: Array, half: float, boundary: str) -> Array:
    """(count,) whether control points lie on the rim."""
    if boundary == "square":
        return np.asarray(np.abs(flat[:, :2]).max(axis=1) > half * (1.0 - 1e-9))
    reach = np.linalg.norm(flat[:, :2], axis=1)
    return np.asarray(reach > reach.max() * (1.0 - 1e-9))
