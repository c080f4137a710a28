"""Compiled element loops: plain arrays in, plain arrays out. The one file that names numba.

Imported only where a mesh is large enough to repay the start-up of the compiler; the numpy path of
:mod:`iga_membrane.terms.variations` gives the same numbers and is the oracle of the tests.
"""

from __future__ import annotations

import logging
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
log = logging.getLogger("iga_membrane")

_OPTIONS = {"nogil": True, "fastmath": {"contract"}}


def _hessian(
    values: Array,
    d1: Array,
    d2: Array,
    weights: Array,
    a1: Array,
    a2: Array,
    c: Array,
    area: Array,
    flux: Array,
    slope: Array,
    gradient: Array,
    along: Array,
    tension: float,
) -> Array:
    """(elements, local, local) second variation; see ``variations.hessian`` for the formulas.

    ``values, d1, d2`` of one element only serve all.
    """
    elements = len(weights)
    shapes, points, local = values.shape
    out = np.zeros((elements, local, local))
    r = np.empty((7, local))
    half = np.empty((local, local))
    for e in range(elements):
        half[:] = 0.0
        k = min(e, shapes - 1)
        for q in range(points):
            w, area_q = weights[e, q], area[e, q]
            t1, t2, c_q = a1[e, q], a2[e, q], c[e, q]
            n0, n1, n2 = c_q[0] / area_q, c_q[1] / area_q, c_q[2] / area_q
            m0, m1, m2 = tension * n0, tension * n1, tension * n2 + flux[e, q]
            scale = 0.5 * tension * w / area_q
            a11 = scale * (t1[0] * t1[0] + t1[1] * t1[1] + t1[2] * t1[2])
            a12 = scale * (t1[0] * t2[0] + t1[1] * t2[1] + t1[2] * t2[2])
            a22 = scale * (t2[0] * t2[0] + t2[1] * t2[1] + t2[2] * t2[2])
            for b in range(local):
                x, y, z = along[e, b, 0], along[e, b, 1], along[e, b, 2]
                normal = x * n0 + y * n1 + z * n2
                value, one, two = values[k, q, b], d1[k, q, b], d2[k, q, b]
                r[0, b] = one * normal
                r[1, b] = two * normal
                r[2, b] = two * (y * m2 - z * m1)
                r[3, b] = two * (z * m0 - x * m2)
                r[4, b] = two * (x * m1 - y * m0)
                r[5, b] = one * (x * t2[1] - y * t2[0]) - two * (x * t1[1] - y * t1[0])
                r[6, b] = value * (gradient[0] * x + gradient[1] * y + 0.5 * gradient[2] * z)
            for a in range(local):
                x, y, z = along[e, a, 0], along[e, a, 1], along[e, a, 2]
                g1, g2 = r[0, a], r[1, a]
                l0 = a22 * g1 - a12 * g2
                l1 = a11 * g2 - a12 * g1
                one = w * d1[k, q, a]
                l2, l3, l4 = one * x, one * y, one * z
                value = w * values[k, q, a]
                l5 = value * (slope[e, q, 0] * x + slope[e, q, 1] * y + slope[e, q, 2] * z)
                l6 = value * z * c_q[2]
                for b in range(local):
                    half[a, b] += (
                        l0 * r[0, b]
                        + l1 * r[1, b]
                        + l2 * r[2, b]
                        + l3 * r[3, b]
                        + l4 * r[4, b]
                        + l5 * r[5, b]
                        + l6 * r[6, b]
                    )
        for a in range(local):
            for b in range(local):
                out[e, a, b] = half[a, b] + half[b, a]
    return out


def _compiled(function: Any) -> Any:
    """Compile, with a disk cache where one can be written."""
    try:
        return numba.njit(cache=True, **_OPTIONS)(function)
    except RuntimeError:
        # a read-only install without a writable home has no place for a cache
        log.warning("no folder for the cache of compiled loops: every process compiles them anew")
        return numba.njit(**_OPTIONS)(function)


hessian = _compiled(_hessian)


def warm_up() -> None:
    """Compile (or load from the cache) before the first timed call."""
    log.info("compiling kernels (once)")
    one = np.ones((1, 1))
    vectors = np.ones((1, 1, 3))
    basis = np.ones((1, 1, 1))
    hessian(basis, basis, basis, one, vectors, vectors, vectors, one, one, vectors, np.ones(3),
            vectors, 1.0)  # fmt: skip
