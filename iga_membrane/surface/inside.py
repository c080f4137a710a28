"""Whether points lie inside a closed surface."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Mask


def inside(x: Array, points: Array) -> Mask:
    """Points inside a surface of triangles.

    Parameters
    ----------
    x : (n, m, 3) a grid that closes: its first row is its last, its first and last columns are one
        point each.
    points : (k, 3)

    Returns
    -------
    (k,) where the solid angle of the surface, ``4 pi`` inside and 0 outside, is the larger part of
    a sphere (Van Oosterom and Strackee, doi 10.1109/TBME.1983.326207).
    """
    a, b = x[:-1, :-1].reshape(-1, 3), x[1:, :-1].reshape(-1, 3)
    c, d = x[1:, 1:].reshape(-1, 3), x[:-1, 1:].reshape(-1, 3)
    triangles = np.concatenate([np.stack([a, b, c]), np.stack([a, c, d])], axis=1)
    angles = [_solid_angle(triangles - point) for point in points]
    return np.abs(np.array(angles)) > 2.0 * np.pi


def _solid_angle(corners: Array) -> float:
    """Of triangles (3, k, 3), seen from the origin."""
    a, b, c = corners
    la, lb, lc = np.linalg.norm(corners, axis=-1)
    volume = np.einsum("ki,ki->k", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("ki,ki->k", p, q) for p, q in ((a, b), (b, c), (c, a)))
    return float(2.0 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb).sum())
