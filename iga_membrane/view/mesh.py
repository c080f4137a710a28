"""The membrane as a mesh for drawing, and the part of it that bounds the liquid."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import Array
from ..checks import integer
from ..solids import Solid
from .drawing import pyvista
from .fields import field

if TYPE_CHECKING:
    from ..driver.solution import Solution

RESOLUTION = partial(integer, least=2, most=4097)
"""Rule of the number of points along a direction of a patch that is drawn."""


def membrane(
    solution: Solution,
    resolution: int,
    names: Sequence[str] = (),
    near: tuple[Array, float] | None = None,
) -> Any:
    """Smooth mesh with exact normals.

    Parameters
    ----------
    resolution : points along each direction of the patch.
    names : of the fields to keep at its points.
    near : a point and a distance: mesh the part of the patch that comes so near.
    """
    pv = pyvista()
    surface = solution.surface
    ring, across = surface.space.bases
    # stop just short of a pole, where the parametrization has no normal
    s = np.linspace(ring.breaks[0], ring.breaks[-1], 2 * resolution - 1)
    t = np.linspace(across.breaks[0], across.breaks[-1], resolution)
    if surface.space.pole is not None:
        t[-1] -= 1e-4
    elif ring.joints:  # nor has a rim at its corners
        t[-1] -= 1e-6 * (t[-1] - t[0])
    if surface.space.shared is not None:  # nor has a closed square at the middles of its sides
        s, t = (1.0 - 1e-6) * s, (1.0 - 1e-6) * t
    if near is not None:
        x = surface.at(np.stack(np.meshgrid(s, t, indexing="ij"), axis=-1), 1).position
        close = np.linalg.norm(x - near[0], axis=-1) < near[1]
        if close.any():
            i, j = np.flatnonzero(close.any(axis=1)), np.flatnonzero(close.any(axis=0))
            s = np.linspace(s[i[0]], s[i[-1]], len(s))
            t = np.linspace(t[j[0]], t[j[-1]], len(t))
    k = surface.at(np.stack(np.meshgrid(s, t, indexing="ij"), axis=-1))
    number = np.arange(k.normal[..., 0].size).reshape(k.normal.shape[:2])
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    quads = np.stack(corners, axis=-1).reshape(-1, 4)
    mesh = pv.PolyData.from_regular_faces(k.position.reshape(-1, 3), quads)
    mesh.point_data.active_normals = k.normal.reshape(-1, 3)
    for name in names:
        mesh[name] = field(solution, name, k).ravel()
    return mesh


def trimming_solid(solution: Solution) -> Solid | None:
    """The solid that the membrane passes through, in world coordinates."""
    passed = solution.scene.by_form.unfitted
    return None if passed is None else passed.solid


def outside(solid: Solid, mesh: Any) -> Any:
    """The part of the membrane's mesh that bounds the liquid."""
    mesh["gap"] = solid.nearest(np.asarray(mesh.points, float)).gap
    # inside its solid the membrane may rise above it: such parts hang on nothing
    outer = mesh.clip_scalar(scalars="gap", value=0.0, invert=False)
    # the edges of a folded patch are open by rounding
    return outer.extract_surface(algorithm=None).clean(tolerance=JOINED).connectivity("largest")


JOINED = 1e-5
"""Distance of points of a mesh that are joined, over its size: seams are open by 3e-6."""
