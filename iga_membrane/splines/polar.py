"""Polar spaces: a ring patch closed to a point at ``xi2 = end``, C1 where the splines are.

At a C1 pole the last two rings of the control net belong to one tangent plane, so three control
points rule them: ring point ``i`` at azimuth ``phi_i`` is the convex combination with weights
``(1 + rho cos(phi_i - psi_k)) / 3``, ``psi_k = 0, 120, 240`` degrees, ``rho = 0`` on the last
ring and 1 on the one before (Toshniwal, Speleers, Hiemstra, Hughes, doi
10.1016/j.cma.2016.11.009).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..errors import SceneError
from .space import Space

CORNERS = 2.0 * np.pi * np.arange(3) / 3.0


def ring_angles(space: Space) -> Array:
    """(n1,) azimuth of each control point of a ring."""
    ring = space.bases[0]
    return np.asarray(2.0 * np.pi * ring.abscissae / (ring.breaks[-1] - ring.breaks[0]))


@checked()
def close_pole(space: Space) -> Space:
    """Close a ring patch at ``xi2 = end``.

    The result has the control points of the remaining rings, ring point ``(i, j)`` at number
    ``i * rings + j``, then three at a C1 pole (one at the C0 pole of a Lagrange space).

    Parameters
    ----------
    space : whose first direction is a ring.

    Raises
    ------
    SceneError
        If the first direction is no ring, or the pole is closed already.
    """
    if not space.bases[0].periodic:
        raise SceneError("a pole closes a ring: the first basis must be periodic")
    if space.pole is not None:
        raise SceneError("space: its pole is closed already; give the ring space")
    smooth = min(space.continuity, 1)
    joined, corners = (2, 3) if smooth else (1, 1)
    n1, n2 = space.net_shape
    rings = n2 - joined
    angles = ring_angles(space)
    count = n1 * rings + corners
    tensor_i, tensor_j = np.divmod(space.functions, n2)
    local = space.functions.shape[1]
    functions = np.where(tensor_j < rings, tensor_i * rings + tensor_j, 0)
    near = np.flatnonzero((tensor_j >= rings).any(axis=1))
    combine = np.broadcast_to(np.eye(local), (len(near), local, local)).copy()
    for place, e in enumerate(near):
        absorbed = np.flatnonzero(tensor_j[e] >= rings)
        combine[place, absorbed] = 0.0
        rho = (tensor_j[e, absorbed] == n2 - 2).astype(float) if smooth else np.zeros(len(absorbed))
        phi = angles[tensor_i[e, absorbed]]
        for k in range(corners):
            # the first absorbed slots now hold the pole's functions, the rest stay empty
            weight = (1.0 + rho * np.cos(phi - CORNERS[k])) / 3.0 if smooth else 1.0
            combine[place, absorbed[k], absorbed] = weight
            functions[e, absorbed[k]] = n1 * rings + k
    return replace(space, functions=functions, count=count, near=near, combine=combine, pole=smooth)


def net_of(space: Space, points: Array) -> Array:
    """(n1, n2, c) the full control net of control points (count, c)."""
    n1, n2 = space.net_shape
    if space.shared is not None:
        full = points[space.shared]
        if space.ruled is not None:
            full[space.ruled.places] = space.ruled.of(points)
        return full.reshape(n1, n2, -1)
    if space.pole is None:
        return points.reshape(n1, n2, -1)
    net = np.empty((n1, n2, points.shape[1]))
    rings = n2 - space.joined_rings
    net[:, :rings] = points[: n1 * rings].reshape(n1, rings, -1)
    corners = points[n1 * rings :]
    net[:, -1] = corners.mean(axis=0)
    if space.pole:
        lean = np.cos(ring_angles(space)[:, None] - CORNERS)
        net[:, -2] = (1.0 + lean) @ corners / 3.0
    return net


def points_of(space: Space, net: Array) -> Array:
    """(count, c) control points of a full net; the best tangent plane at a pole."""
    n1, n2 = space.net_shape
    if space.leaders is not None:
        return net.reshape(n1 * n2, -1)[space.leaders]
    if space.pole is None:
        return net.reshape(n1 * n2, -1)
    centre = net[:, -1].mean(axis=0)
    corners = centre[None]
    if space.pole:
        phi = ring_angles(space)
        offset = net[:, -2] - centre
        along = 2.0 / n1 * np.stack([np.cos(phi), np.sin(phi)]) @ offset
        corners = centre + 2.0 * np.stack([np.cos(CORNERS), np.sin(CORNERS)], axis=1) @ along
    return np.concatenate([net[:, : n2 - space.joined_rings].reshape(-1, net.shape[-1]), corners])
