"""First and second variations of area and body terms, exact, once for all of them.

With ``c = a_1 x a_2``, ``J = |c|`` and ``e(x)`` the body density, the integrand over the parameter
domain is ``F = gamma J + Q c_z`` where ``Q(x) = int_0^z e dz``. Displacing control point ``a``
along ``d_a`` by one unit moves ``x, a_1, a_2`` by ``N_a d_a, N_a,1 d_a, N_a,2 d_a``.
"""

from __future__ import annotations

import logging
import os
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ..arrays import Array, Index
from ..splines import Table
from ..splines.table import shared
from .term import BodyDensity

log = logging.getLogger("iga_membrane")

CACHED = 16_000
"""Numbers per array that numpy works on at a time: half as long a Hessian as with whole arrays."""
COMPILED_FROM = 10_000
"""Elements from which the compiled loops repay about one second of start-up
(docs/results/choices.md)."""


@dataclass(frozen=True, eq=False)
class ElementPoints:
    """Kinematics at the quadrature points of all elements, shared by all terms.

    Attributes
    ----------
    x, a1, a2, c : (elements, points, 3); area : (elements, points) ``J``.
    """

    x: Array
    a1: Array
    a2: Array
    c: Array
    area: Array

    def part(self, elements: slice | Index) -> ElementPoints:
        """Some of the elements."""
        return ElementPoints(
            *(getattr(self, name)[elements] for name in ("x", "a1", "a2", "c", "area"))
        )


def element_points(table: Table, points: Array) -> ElementPoints:
    """Kinematics of a surface with control points (count, 3)."""
    x, a1, a2 = table.derivatives(points)
    c = cross(a1, a2)
    return ElementPoints(x, a1, a2, c, np.sqrt(np.einsum("eqi,eqi->eq", c, c)))


def cross(a: Array, b: Array, out: Array | None = None) -> Array:
    """Vector product along the last axis; several times faster than numpy's on small arrays."""
    if out is None:
        out = np.empty(np.broadcast_shapes(a.shape, b.shape), np.result_type(a, b))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        np.subtract(a[..., j] * b[..., k], a[..., k] * b[..., j], out=out[..., i])
    return out


def flux(body: BodyDensity, x: Array) -> Array:
    """``Q(x) = int_0^z e dz``: the body integral is the flux of ``Q e_z``."""
    ex, ey, ez = body.gradient
    level = body.constant + 0.5 * ez * x[..., 2]
    if ex or ey:
        level = level + ex * x[..., 0] + ey * x[..., 1]
    return np.asarray(level * x[..., 2])


def flux_gradient(body: BodyDensity, x: Array) -> Array:
    """Gradient of ``Q``; its z component is the body density itself."""
    ex, ey, ez = body.gradient
    z = x[..., 2]
    return np.stack([ex * z, ey * z, body.constant + ex * x[..., 0] + ey * x[..., 1] + ez * z], -1)


def energies(table: Table, at: ElementPoints, bodies: list[BodyDensity]) -> tuple[float, Array]:
    """Area of the elements and their integral of each body density."""
    area = (at.area * table.weights).sum()
    weighted = at.c[..., 2] * table.weights
    return area, np.array([(flux(body, at.x) * weighted).sum() for body in bodies])


def forces(table: Table, at: ElementPoints, tension: float, body: BodyDensity) -> Array:
    """(elements, local, 3) derivative of ``tension * area + body`` by local control points."""
    w = table.weights
    points = w.shape[1]
    conjugate = (tension * w / at.area)[..., None] * at.c if tension else np.zeros_like(at.c)
    conjugate[..., 2] += w * flux(body, at.x)
    rows = np.empty((len(w), 3 * points, 3))
    np.multiply(flux_gradient(body, at.x), (w * at.c[..., 2])[..., None], out=rows[:, :points])
    cross(at.a2, conjugate, rows[:, points : 2 * points])
    cross(conjugate, at.a1, rows[:, 2 * points :])
    return np.asarray(table.stacked.transpose(0, 2, 1) @ rows)


def compiled_kernels(elements: int) -> Any:
    """The compiled loops where a mesh repays their start-up, else None (numpy, same numbers).

    ``IGA_MEMBRANE_NO_NUMBA=1`` switches them off.
    """
    if elements < COMPILED_FROM or os.environ.get("IGA_MEMBRANE_NO_NUMBA") == "1":
        return None
    return _loaded()


@cache
def _loaded() -> Any:
    """The compiled loops, or None with one warning in a process."""
    try:
        from .. import _kernels
    except ImportError as error:
        log.warning("compiled loops cannot be used (%s): numpy takes longer on large meshes", error)
        return None
    return _kernels


def hessian(
    table: Table,
    at: ElementPoints,
    tension: float,
    body: BodyDensity,
    directions: Array,
    kernels: Any = None,
) -> Array:
    """(elements, local, local) second derivative along given directions.

    Parameters
    ----------
    directions : (elements, local, 3) of the local control points.
    kernels : compiled loops (:func:`compiled_kernels`), or None for numpy.

    Notes
    -----
    The structured form of the second variation: normal gradients against the contravariant metric,
    ``J a^ab (N_a,alpha d_a.n)(N_b,beta d_b.n)``; a skew part ``(N_a,1 N_b,2 - N_a,2 N_b,1) N' .
    (d_a x d_b)`` with ``N' = gamma n + Q e_z``; and the variation of ``Q``. As few columns per
    quadrature point as possible, one product of matrices per element, then symmetrized.
    """
    if kernels is not None:
        # one memory layout, so that one compiled version serves
        arrays = map(np.ascontiguousarray, (
            shared(table.values), shared(table.d1), shared(table.d2), table.weights,
            at.a1, at.a2, at.c, at.area,
            flux(body, at.x), flux_gradient(body, at.x), np.array(body.gradient), directions,
        ))  # fmt: skip
        return np.asarray(kernels.hessian(*arrays, float(tension)))
    elements, points, local = table.values.shape
    chunk = max(1, CACHED // (points * local))
    return np.concatenate(
        [
            _hessian(table.part(some), at.part(some), tension, body, directions[some])
            for some in (slice(i, i + chunk) for i in range(0, elements, chunk))
        ]
    )


def _hessian(
    table: Table, at: ElementPoints, tension: float, body: BodyDensity, directions: Array
) -> Array:
    """The same by numpy, for as many elements as fit into the cache."""
    n = at.c / at.area[..., None]
    w = table.weights
    conjugate = tension * n
    conjugate[..., 2] += flux(body, at.x)
    along = directions.transpose(0, 2, 1)
    normal = n @ along
    g1, g2 = table.d1 * normal, table.d2 * normal
    scale = 0.5 * tension * w / at.area
    a11, a12, a22 = (
        (np.einsum("eqi,eqi->eq", a, b) * scale)[..., None]
        for a, b in ((at.a1, at.a1), (at.a1, at.a2), (at.a2, at.a2))
    )
    left = [a22 * g1 - a12 * g2, a11 * g2 - a12 * g1]
    right = [g1, g2]
    # skew part: sum_i (N_a,1 d_a)_i (d_b x N')_i N_b,2, to be symmetrized
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        turned = (
            along[:, None, j] * conjugate[..., k, None]
            - along[:, None, k] * conjugate[..., j, None]
        )
        left.append(table.d1 * along[:, None, i] * w[..., None])
        right.append(table.d2 * turned)
    if body != BodyDensity():
        dz = along[:, None, 2]
        slope = flux_gradient(body, at.x) @ along
        lift = table.d1 * _vertical(along, at.a2) - table.d2 * _vertical(along, at.a1)
        left.append(table.values * slope * w[..., None])
        right.append(lift)
        if any(body.gradient):
            ex, ey, ez = body.gradient
            tilt = ex * along[:, None, 0] + ey * along[:, None, 1] + 0.5 * ez * dz
            left.append(table.values * dz * (w * at.c[..., 2])[..., None])
            right.append(table.values * tilt)
    half = np.concatenate(left, axis=1).transpose(0, 2, 1) @ np.concatenate(right, axis=1)
    return np.asarray(half + half.transpose(0, 2, 1))


def mass(table: Table, at: ElementPoints, directions: Array, *, full: bool = False) -> Array:
    """(elements, local, local) ``int (u_a . n)(u_b . n) dA`` of normal displacements, or
    ``int u_a . u_b dA`` if ``full``."""
    if full:
        weighted = table.values * (at.area * table.weights)[..., None]
        gram = directions @ directions.transpose(0, 2, 1)
        return np.asarray(weighted.transpose(0, 2, 1) @ table.values * gram)
    normal = (at.c / at.area[..., None]) @ directions.transpose(0, 2, 1)
    rows = table.values * normal
    weighted = rows * (at.area * table.weights)[..., None]
    return np.asarray(weighted.transpose(0, 2, 1) @ rows)


def _vertical(along: Array, a: Array) -> Array:
    """(elements, points, local) z component of ``d x a``."""
    return along[:, None, 0] * a[..., 1, None] - along[:, None, 1] * a[..., 0, None]
