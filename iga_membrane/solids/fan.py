"""Integrals over the wetted side of a contact line, by lines from the middle of a solid to it.

A surface integral inside closed lines is ``oint G``, where ``G`` integrates along rays of a chart
that end on the line: meridians of a ball, straight lines under a graph, or in a developed cylinder.
It is exact for any number of lines, holes included, wherever the middle lies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask
from ..errors import GeometryError
from ..quadrature import gauss
from .nearest import Solid

ARC = 12
"""Gauss points along an arc of a ball."""
RAY = 16
"""Gauss points along each part of a ray."""
PARTS = 64
"""Parts of a ray at most."""
STEPS, CLOSE, FOUND = 30, 1e-12, 1e-9
"""Newton steps to a point of a surface at most, their size at its end over the length over which
contact changes, and how far from the surface it may be."""


@dataclass(frozen=True, eq=False)
class Fan:
    """Points of wetted surfaces with their weights, by points (k, q) of contact lines.

    Attributes
    ----------
    points, normals : (k, q, f, 3), normals out of the solid.
    weights : (k, q, f) of area per coordinate along the line, positive on the left of a line that
        runs counterclockwise seen from the liquid.
    """

    points: Array
    normals: Array
    weights: Array


def ball_fan(centers: Array, radii: Array, axes: Array, points: Array, tangents: Array) -> Fan:
    """Meridians of balls from the ends of axes towards the liquid.

    Parameters
    ----------
    centers, axes : (k, q, 3); radii : (k, q).
    points, tangents : (k, q, 3) of the lines, derivatives by the coordinate along them.

    Notes
    -----
    With ``X`` from the centre and ``a`` the axis, an integral over the cap is
    ``oint G a . (X x X') / |a x X|^2``, ``G`` the integral along the meridian from the axis to the
    line. It holds wherever the axis lies, as long as its other end is dry.
    """
    away, r = points - centers, radii[..., None]
    along = np.einsum("kqi,kqi->kq", away, axes)
    across = away - along[..., None] * axes
    level = np.linalg.norm(across, axis=-1)
    turn = np.einsum("kqi,kqi->kq", axes, np.cross(away, tangents)) / level**2
    polar = np.arctan2(level, along)[..., None]
    u, w = gauss(ARC)
    angle = polar * u
    out = (across / level[..., None])[..., None, :]
    normal = np.sin(angle)[..., None] * out + np.cos(angle)[..., None] * axes[..., None, :]
    x = centers[..., None, :] + r[..., None] * normal
    return Fan(x, normal, np.sin(angle) * polar * r**2 * w * turn[..., None])


def chart_fan(
    place: Callable[[Array], tuple[Array, Array, Array]],
    ends: Array,
    tangents: Array,
    scale: float,
) -> Fan:
    """Rays of a chart from its origin.

    Parameters
    ----------
    place : coordinates (..., 2) to points (..., 3), unit normals (..., 3) and the area (...) per
        area of the chart.
    ends, tangents : (k, q, 2) of the lines in the chart.
    scale : length over which the surface and what is integrated change.
    """
    longest = float(np.linalg.norm(ends, axis=-1).max(initial=0.0))
    parts = int(np.clip(np.ceil(longest / scale), 1, PARTS))
    u, w = gauss(RAY)
    u = ((np.arange(parts)[:, None] + u) / parts).ravel()
    w = np.tile(w / parts, parts)
    points, normals, area = place(u[:, None] * ends[..., None, :])
    turn = ends[..., 0] * tangents[..., 1] - ends[..., 1] * tangents[..., 0]
    return Fan(points, normals, area * (u * w) * turn[..., None])


def fan_of(solid: Solid, points: Array, tangents: Array) -> Fan:
    """The fan of a solid at contact lines, its own if it has one, else that of the graph that its
    surface is over the plane z = 0.

    Parameters
    ----------
    points, tangents : (k, q, 3) of the lines, derivatives by the coordinate along them.

    Raises
    ------
    GeometryError
        The wetted surface is no such graph.
    """
    own = getattr(solid, "fan", None)
    if own is not None:
        found: Fan = own(points, tangents)
        return found
    middle = points.reshape(-1, 3).mean(axis=0)[2] if points.size else 0.0

    def place(chart: Array) -> tuple[Array, Array, Array]:
        start = np.concatenate([chart, np.full((*chart.shape[:-1], 1), middle)], axis=-1)
        x, normal, found = on_surface(solid, start)
        if not found.all():
            raise GeometryError(
                f"{type(solid).__name__}: its wetted surface is no graph over the plane z = 0; "
                "give the solid a method fan"
            )
        return x, normal, 1.0 / normal[..., 2]

    return chart_fan(place, points[..., :2], tangents[..., :2], solid.scale)


def on_surface(solid: Solid, points: Array) -> tuple[Array, Array, Mask]:
    """Points (..., 3) of a solid's upper surface above or below others, the normals there, and
    whether there are any."""
    x = points.copy()
    for _ in range(STEPS):
        at = solid.nearest(x)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.clip(at.gap / at.normal[..., 2], -solid.scale, solid.scale)
        x[..., 2] -= step
        if np.abs(step).max(initial=0.0) <= CLOSE * solid.scale:
            break
    at = solid.nearest(x)
    found = (at.normal[..., 2] > 0.0) & (np.abs(at.gap) <= FOUND * solid.scale)
    return x, at.normal, found
