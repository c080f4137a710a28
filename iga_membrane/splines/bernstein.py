"""Bernstein polynomials on [0, 1] and the Bezier extraction of B-splines."""

from __future__ import annotations

from math import comb

import numpy as np

from ..arrays import Array


def bernstein(u: Array, degree: int, derivative: int = 0) -> Array:
    """Bernstein polynomials, or a derivative of them, at points of [0, 1].

    Parameters
    ----------
    u : (...,) points.

    Returns
    -------
    (..., degree + 1)
    """
    if derivative:
        if degree == 0:
            return np.zeros((*np.shape(u), 1))
        lower = bernstein(u, degree - 1, derivative - 1)
        padded = np.zeros((*np.shape(u), degree + 2))
        padded[..., 1:-1] = lower
        return np.asarray(degree * (padded[..., :-1] - padded[..., 1:]))
    u = np.asarray(u, float)
    result = np.empty((*u.shape, degree + 1))
    rising, falling = [np.ones_like(u)], [np.ones_like(u)]
    for _ in range(degree):
        rising.append(rising[-1] * u)
        falling.append(falling[-1] * (1.0 - u))
    for k in range(degree + 1):
        result[..., k] = comb(degree, k) * rising[k] * falling[degree - k]
    return result


def extraction(windows: Array, degree: int) -> Array:
    """Bezier extraction of the B-splines on each element, by blossoming.

    Parameters
    ----------
    windows : (elements, 2 * degree) the knots round each element: ``degree`` up to and including
        its left end, ``degree`` from its right end on.

    Returns
    -------
    (elements, degree + 1, degree + 1)
        ``C[e, i, j]``: B-spline ``i`` of element ``e`` is ``sum_j C[e, i, j] bernstein_j``.
    """
    p = degree
    count = len(windows)
    if p == 0:
        return np.ones((count, 1, 1))
    left, right = windows[:, p - 1], windows[:, p]
    result = np.empty((count, p + 1, p + 1))
    for j in range(p + 1):
        # Bernstein coefficient j is the blossom at p - j left and j right ends (de Boor's scheme).
        control = np.broadcast_to(np.eye(p + 1), (count, p + 1, p + 1)).copy()
        for level in range(1, p + 1):
            argument = (left if level <= p - j else right)[:, None]
            low, high = windows[:, level - 1 : p], windows[:, p : 2 * p - level + 1]
            a = ((argument - low) / (high - low))[..., None]
            control = (1.0 - a) * control[:, :-1] + a * control[:, 1:]
        result[:, :, j] = control[:, 0]
    return result
