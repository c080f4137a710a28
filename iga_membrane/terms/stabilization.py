"""The in-plane stabilization stress of the paper, eq. (23), as an energy.

A liquid membrane has no stiffness in its own plane. Where its points move freely, the stress

    sigma_sta^ab = mu / J (A^ab - a^ab)

holds them near the metric ``A`` of the last load step. With ``J = sqrt(a / A)`` it is that of the
energy ``mu / 2 int (A^ab a_ab - 2 - ln(a / A)) dA_pre``, which is never negative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arguments import checked
from ..arrays import Array, Index
from ..splines import Table
from .pairs import COMPONENTS, Form, components
from .term import Scale, Term
from .variations import ElementPoints


@dataclass(frozen=True)
@checked(mu="solver.stabilization")
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
    forms = ("stabilizations",)

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

    def part(self, elements: Index) -> PreviousMetric:
        """Some of the elements."""
        one, mixed, two = (component[elements] for component in self.inverse)
        return PreviousMetric((one, mixed, two), self.area[elements])

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
    slopes = table.stacked[:, table.weights.shape[1] :]
    return np.asarray(slopes.transpose(0, 2, 1) @ np.concatenate([f1, f2], axis=1))


def form(mu: float, before: PreviousMetric, at: ElementPoints) -> Form:
    """Second variation at quadrature points.

    Notes
    -----
    ``mu dA_pre [A^ab 1 - a^ab n (x) n + a^b (x) a^a]`` between ``u_,a`` and ``u'_,b``, with the
    dual tangents ``a^a``.
    """
    inverse = _inverse(at)
    normal, a1, a2 = components(at.c) / at.area, components(at.a1), components(at.a2)
    duals = inverse[0] * a1 + inverse[1] * a2, inverse[1] * a1 + inverse[2] * a2
    scale = mu * before.area
    symmetric = np.empty((6, len(scale), 3, scale.shape[1]))
    for row, (one, two) in enumerate(((0, 0), (0, 1), (1, 1))):
        for k, (i, j) in enumerate(COMPONENTS):
            both = 0.5 * (duals[one][i] * duals[two][j] + duals[one][j] * duals[two][i])
            both -= inverse[row] * normal[i] * normal[j]
            both += before.inverse[row] * (i == j)
            np.multiply(scale, both, out=symmetric[k, :, row])
    skew = -0.5 * scale / at.area * normal
    return Form(symmetric, skew[:, :, None])


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
