"""The in-plane stabilization stress of the paper, eq. (23), as an energy.

A liquid membrane has no stiffness in its own plane. Where its points move freely, the stress

    sigma_sta^ab = mu / J (A^ab - a^ab)

holds them near the metric ``A`` of the last load step. With ``J = sqrt(a / A)`` it is that of the
energy ``mu / 2 int (A^ab a_ab - 2 - ln(a / A)) dA_pre``, which is never negative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import number
from ..splines import Table
from .term import Scale, Term
from .variations import ElementPoints


@dataclass(frozen=True)
class Stabilization(Term):
    """How strongly a membrane with three unknowns per control point is held in its plane.

    Attributes
    ----------
    mu : stabilization parameter, in units of a surface tension; the paper's is ``gamma``.
    projected : whether control points are held along their tangent planes only. Then no part of
        the stress acts along the normals, and the shape does not feel it.
    """

    mu: float
    projected: bool = False
    name = "stabilization"

    def __post_init__(self) -> None:
        number("solver.stabilization", self.mu, above=0.0)

    def scaled(self, scale: Scale) -> Stabilization:
        return Stabilization(self.mu / scale.tension, self.projected)


@dataclass(frozen=True, eq=False)
class PreviousMetric:
    """Metric of the last load step at quadrature points (elements, points).

    Attributes
    ----------
    inverse : ``A^11, A^12, A^22``; area : quadrature weights times ``sqrt(A)``.
    """

    inverse: tuple[Array, Array, Array]
    area: Array

    @classmethod
    def of(cls, table: Table, at: ElementPoints) -> PreviousMetric:
        """The metric of a state."""
        return cls(_inverse(at), at.area * table.weights)


def energy(mu: float, before: PreviousMetric, at: ElementPoints) -> float:
    """Energy of a state."""
    a11, a12, a22 = _metric(at)
    b11, b12, b22 = before.inverse
    # det A^ab = 1 / A
    stretch = np.log((a11 * a22 - a12**2) * (b11 * b22 - b12**2))
    density = b11 * a11 + 2.0 * b12 * a12 + b22 * a22 - 2.0 - stretch
    return float(0.5 * mu * (density * before.area).sum())


def forces(mu: float, table: Table, before: PreviousMetric, at: ElementPoints) -> Array:
    """(elements, local, 3) derivative by local control points."""
    s11, s12, s22 = _stress(mu, before, at)
    f1 = s11[..., None] * at.a1 + s12[..., None] * at.a2
    f2 = s12[..., None] * at.a1 + s22[..., None] * at.a2
    return np.asarray(table.d1.transpose(0, 2, 1) @ f1 + table.d2.transpose(0, 2, 1) @ f2)


def hessian(
    mu: float, table: Table, before: PreviousMetric, at: ElementPoints, directions: Array
) -> Array:
    """(elements, local, local) second derivative along directions (elements, local, 3)."""
    s11, s12, s22 = (s[..., None] for s in _stress(mu, before, at))
    d1, d2 = table.d1, table.d2
    along = directions.transpose(0, 2, 1)
    geometric = d1.transpose(0, 2, 1) @ (s11 * d1 + s12 * d2)
    geometric = geometric + d2.transpose(0, 2, 1) @ (s12 * d1 + s22 * d2)
    # variations of a_11, a_12, a_22 along each direction
    one, two = at.a1 @ along, at.a2 @ along
    e11, e12, e22 = 2.0 * d1 * one, d1 * two + d2 * one, 2.0 * d2 * two
    g11, g12, g22 = (g[..., None] for g in _inverse(at))
    w = (0.5 * mu * before.area)[..., None]
    # mu / 2 tr(a^-1 e a^-1 e')
    r11 = w * (g11**2 * e11 + 2.0 * g11 * g12 * e12 + g12**2 * e22)
    r12 = w * 2.0 * (g11 * g12 * e11 + (g11 * g22 + g12**2) * e12 + g12 * g22 * e22)
    r22 = w * (g12**2 * e11 + 2.0 * g12 * g22 * e12 + g22**2 * e22)
    rows = np.concatenate([e11, e12, e22], axis=1).transpose(0, 2, 1)
    material = rows @ np.concatenate([r11, r12, r22], axis=1)
    return np.asarray(material + geometric * (directions @ along))


def _stress(mu: float, before: PreviousMetric, at: ElementPoints) -> tuple[Array, ...]:
    """``mu (A^ab - a^ab)`` times quadrature weights and ``sqrt(A)``."""
    scale = mu * before.area
    return tuple(scale * (b - g) for b, g in zip(before.inverse, _inverse(at), strict=True))


def _metric(at: ElementPoints) -> tuple[Array, Array, Array]:
    """``a_11, a_12, a_22``"""
    pairs = ((at.a1, at.a1), (at.a1, at.a2), (at.a2, at.a2))
    one, mixed, two = (np.einsum("eqi,eqi->eq", a, b) for a, b in pairs)
    return one, mixed, two


def _inverse(at: ElementPoints) -> tuple[Array, Array, Array]:
    """``a^11, a^12, a^22``"""
    a11, a12, a22 = _metric(at)
    square = at.area**2
    return a22 / square, -a12 / square, a11 / square
