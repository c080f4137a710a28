"""To and from geomdl (NURBS-Python): the one file that names it.

geomdl accepts NaN knots and negative weights without a word, so everything that comes in goes
through our own checks.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import record
from ..errors import SceneError
from ..optional import optional
from ..splines import Basis, bspline_basis, tensor_space
from .bezier import bezier_net
from .surface import Surface


def from_geomdl(surface: Any) -> Surface:
    """Surface from a ``geomdl.BSpline.Surface`` or ``geomdl.NURBS.Surface``.

    Parameters
    ----------
    surface : of geomdl.

    Raises
    ------
    SceneError
        Knots or weights that are not valid; the message names the first bad one.
    """
    from geomdl import BSpline

    record("surface", surface, BSpline.Surface)
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


@checked()
def to_geomdl(surface: Surface) -> Any:
    """``geomdl.NURBS.Surface`` (or ``BSpline.Surface`` without weights) of any surface.

    Parameters
    ----------
    surface : of any space.

    Notes
    -----
    Open B-spline and NURBS surfaces keep their knots. Lagrange, periodic and polar ones, which
    geomdl does not have, become the same surface by its Bezier points: knots as often as the
    degree, rings closed by equal points. geomdl scales the
    parameters to [0, 1].
    """
    nurbs, bspline = (optional(f"geomdl.{name}", "to_geomdl") for name in ("NURBS", "BSpline"))
    space = surface.space
    weights, net = space.weights, surface.net
    knots = [basis.knots for basis in space.bases if basis.knots is not None]
    if space.pole is not None or space.shared is not None or len(knots) < 2:
        net, w = _bezier_points(surface)
        knots = [_bezier_knots(basis) for basis in space.bases]
        weights = None if space.weights is None else w
    made = bspline.Surface() if weights is None else nurbs.Surface()
    made.degree_u, made.degree_v = (basis.degree for basis in space.bases)
    made.ctrlpts_size_u, made.ctrlpts_size_v = net.shape[:2]
    if weights is None:
        made.ctrlpts = net.reshape(-1, 3).tolist()
    else:
        each = weights[..., None]
        made.ctrlptsw = np.concatenate([net * each, each], axis=-1).reshape(-1, 4).tolist()
    made.knotvector_u, made.knotvector_v = ([float(k) for k in line] for line in knots)
    return made


def write_geomdl(surface: Surface, path: str) -> None:
    """Write a surface as JSON that ``geomdl.exchange.import_json`` reads.

    Raises
    ------
    OSError
    """
    exchange = optional("geomdl.exchange", "a .geomdl.json file")
    failed = optional("geomdl.exceptions", "a .geomdl.json file").GeomdlException
    try:
        exchange.export_json(to_geomdl(surface), path)
    except failed as error:  # what it makes of a full disk
        raise OSError(str(error)) from error


def _bezier_points(surface: Surface) -> tuple[Array, Array]:
    """Control net (n1, n2, 3) and weights (n1, n2) with all elements' Bezier points, once each."""
    one, two = surface.space.bases
    cells = bezier_net(surface)
    p1, p2 = one.degree, two.degree
    cells = cells.reshape(one.elements, two.elements, p1 + 1, p2 + 1, 4)
    net = np.empty((one.elements * p1 + 1, two.elements * p2 + 1, 4))
    for i in range(p1 + 1):
        for j in range(p2 + 1):
            net[i::p1, j::p2][: one.elements, : two.elements] = cells[:, :, i, j]
    return net[..., :3] / net[..., 3:], net[..., 3]


def _bezier_knots(basis: Basis) -> Array:
    """Open knots, those inside as often as the degree."""
    ends = basis.breaks[[0, -1]]
    inside = np.repeat(basis.breaks[1:-1], basis.degree)
    first, last = (np.full(basis.degree + 1, end) for end in ends)
    return np.concatenate([first, inside, last])
