"""Contact line on a plane: Young's angle as a natural boundary condition.

The wetted part of z = 0 adds nothing to body integrals, so ``body`` is not used here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import choice, wet_angle
from ..solids import Plane, Solid
from ..splines import EdgeTable, line
from .term import LINE_EDGES, BodyDensity, Scale, WettingLine


@dataclass(frozen=True)
@checked(gamma="liquid.surface_tension", contact_angle=wet_angle, edge=line)
class PlaneContactLine(WettingLine):
    """Energy ``-gamma cos(theta) A_wet`` of the wetted part of the plane z = 0.

    ``A_wet = 1/2 oint (x dy - y dx)`` along the edge. Its variation against the membrane's tension
    is the tangential balance of paper eq. (30), ``gamma_SG - gamma cos(theta) - gamma_SL = 0``;
    the normal one, eq. (31), is the plane's reaction.

    Attributes
    ----------
    gamma : surface tension.
    contact_angle : Young's angle in degrees, through the liquid.
    edge : edge of the membrane that slides on the plane.
    covered : whether the membrane, with its tension, covers the wetted area too: gamma_SL = gamma
        and gamma_SG = gamma (1 + cos(theta)) in paper eq. (32); ``edge`` is then a line inside it.
    """

    gamma: float
    contact_angle: float
    edge: str = "xi2=0"
    covered: bool = False
    name = "wetting"

    def __post_init__(self) -> None:
        if not self.covered:
            choice("edge", self.edge, LINE_EDGES)

    @property
    def strength(self) -> float:
        """Energy per wetted area."""
        return float(-self.gamma * (np.cos(np.radians(self.contact_angle)) + self.covered))

    @property
    def solids(self) -> tuple[Solid, ...]:
        return (Plane(self.contact_angle),)

    def scaled(self, scale: Scale) -> PlaneContactLine:
        return replace(self, gamma=self.gamma / scale.tension)

    def energy(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> float:
        return strength * wetted_area(table, points)

    def forces(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        x, dx = _curve(table, points)
        w = 0.5 * strength * table.weights[..., None]
        forces = np.zeros((*table.functions.shape, 3))
        forces[..., 0] = _test(table.values, w * dx[..., 1:2]) - _test(table.d, w * x[..., 1:2])
        forces[..., 1] = _test(table.d, w * x[..., :1]) - _test(table.values, w * dx[..., :1])
        return forces

    def hessian(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        half = np.einsum("eqa,eqb,eq->eab", table.values, table.d, table.weights)
        skew = 0.5 * strength * (half - half.transpose(0, 2, 1))
        elements, local = table.functions.shape
        hessian = np.zeros((elements, local, 3, local, 3))
        hessian[:, :, 0, :, 1] = skew
        hessian[:, :, 1, :, 0] = -skew
        return hessian


def wetted_area(table: EdgeTable, points: Array) -> float:
    """Area between an edge in z = 0 and the origin, counterclockwise positive."""
    x, dx = _curve(table, points)
    moment = x[..., 0] * dx[..., 1] - x[..., 1] * dx[..., 0]
    area: float = 0.5 * (moment * table.weights).sum()
    return area


def _curve(table: EdgeTable, points: Array) -> tuple[Array, Array]:
    local = points[table.functions]
    return table.values @ local, table.d @ local


def _test(rows: Array, weighted: Array) -> Array:
    """(elements, local): integral of a weighted scalar against the functions in ``rows``."""
    return np.einsum("eqa,eq->ea", rows, weighted[..., 0])
