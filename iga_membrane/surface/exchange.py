"""To and from geomdl (NURBS-Python): the one file that names it.

geomdl accepts NaN knots and negative weights without a word, so everything that comes in goes
through our own checks.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import SceneError
from ..splines import bspline_basis, tensor_space
from .surface import Surface


def from_geomdl(surface: Any) -> Surface:
    """Surface from a ``geomdl.BSpline.Surface`` or ``geomdl.NURBS.Surface``.

    Raises
    ------
    SceneError
        Knots or weights that are not valid; the message names the first bad one.
    """
    bases = [
        bspline_basis(surface.knotvector_u, surface.degree_u, continuity=0),
        bspline_basis(surface.knotvector_v, surface.degree_v, continuity=0),
    ]
    shape = (bases[0].count, bases[1].count)
    if (surface.ctrlpts_size_u, surface.ctrlpts_size_v) != shape:
        raise SceneError(
            f"control points: {surface.ctrlpts_size_u} x {surface.ctrlpts_size_v} given, "
            f"{shape[0]} x {shape[1]} expected from knots and degrees"
        )
    weights = getattr(surface, "weights", None)
    if weights is not None:
        weights = np.array(weights, float).reshape(shape)
    points = np.array(surface.ctrlpts, float).reshape(-1, 3)
    return Surface(tensor_space(bases[0], bases[1], weights), points)


def to_geomdl(surface: Surface) -> Any:
    """``geomdl.NURBS.Surface`` (or ``BSpline.Surface`` without weights) of an open surface.

    Raises
    ------
    SceneError
        For Lagrange, periodic or polar spaces, which geomdl does not have.
    """
    from geomdl import NURBS, BSpline

    space = surface.space
    if space.pole is not None or any(basis.knots is None for basis in space.bases):
        raise SceneError("to_geomdl: only open B-spline and NURBS surfaces can be exchanged")
    made = BSpline.Surface() if space.weights is None else NURBS.Surface()
    made.degree_u, made.degree_v = (basis.degree for basis in space.bases)
    made.ctrlpts_size_u, made.ctrlpts_size_v = space.net_shape
    points = surface.points
    if space.weights is None:
        made.ctrlpts = points.tolist()
    else:
        w = space.weights.reshape(-1, 1)
        made.ctrlptsw = np.hstack([points * w, w]).tolist()
    made.knotvector_u, made.knotvector_v = (
        [float(k) for k in basis.knots] for basis in space.bases if basis.knots is not None
    )
    return made
