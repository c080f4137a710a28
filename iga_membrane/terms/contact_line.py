"""Contact line on a plane: Young's angle as a natural boundary condition.

The wetted part of z = 0 adds nothing to body integrals. That of a plane at another level z = h,
above a bridge, adds ``int Q dA`` with ``Q = e_0 h + (e_x x + e_y y) h + e_z h^2 / 2``: like the
wetted area, moments of the area inside the line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import choice, wet_angle
from ..errors import SceneError
from ..solids import Plane, Solid
from ..splines import EdgeTable, line
from .term import CEILING_EDGES, LINE_EDGES, BodyDensity, Scale, WettingLine


@dataclass(frozen=True)
@checked(gamma="liquid.surface_tension", contact_angle=wet_angle, edge=line)
class PlaneContactLine(WettingLine):
    """Energy ``-gamma cos(theta) A_wet`` of the wetted part of the plane z = 0, or of one above the
    liquid.

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
    level : height of the plane in the frame of the scene; another than 0 is that of a plane above
        the liquid, on which the other edge lies.
    """

    gamma: float
    contact_angle: float
    edge: str = "xi2=0"
    covered: bool = False
    level: float = 0.0
    name = "wetting"

    def __post_init__(self) -> None:
        if self.level and self.edge not in CEILING_EDGES:
            raise SceneError(
                f"level = {self.level:g}, edge = {self.edge!r}: a plane off z = 0 lies above the "
                f"liquid, where the membrane's edge is {CEILING_EDGES[0]!r}; name that or leave "
                "the level out"
            )
        if not (self.covered or self.level):
            choice("edge", self.edge, LINE_EDGES)

    @property
    def strength(self) -> float:
        """Energy per wetted area."""
        return float(-self.gamma * (np.cos(np.radians(self.contact_angle)) + self.covered))

    @property
    def toward(self) -> tuple[float, float, float]:  # type: ignore[override]
        return 0.0, 0.0, -1.0 if self.level else 1.0

    @property
    def turn(self) -> float:
        return -1.0 if self.level else 1.0

    @property
    def solids(self) -> tuple[Solid, ...]:
        return (self.face,)

    @property
    def face(self) -> Plane:
        """The plane in the frame of the scene."""
        return Plane(self.contact_angle, (0.0, 0.0, self.level), self.toward)

    def normal(self, points: Array) -> Array:
        return np.broadcast_to(self.toward, points.shape)

    def scaled(self, scale: Scale) -> PlaneContactLine:
        level = self.level / scale.length
        return replace(self, gamma=self.gamma / scale.tension, level=level)

    def energy(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> float:
        x, dx = _curve(table, points)
        even, slope = self._density(strength, body)
        # Green: int (a + b . x) dA = 1/2 oint (a x + b_x x^2) dy - (a y + b_y y^2) dx
        flux = 0.5 * (even + slope * x[..., :2]) * x[..., :2]
        turned = flux[..., 0] * dx[..., 1] - flux[..., 1] * dx[..., 0]
        total: float = (turned * table.weights).sum()
        return total

    def forces(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        x, dx = _curve(table, points)
        even, slope = self._density(strength, body)
        w = table.weights[..., None]
        flux = 0.5 * (even + slope * x[..., :2]) * x[..., :2] * w
        change = (0.5 * even + slope * x[..., :2]) * w
        forces = np.zeros((*table.functions.shape, 3))
        for k, sign in ((0, 1.0), (1, -1.0)):
            own, other = slice(k, k + 1), slice(1 - k, 2 - k)
            forces[..., k] = sign * (
                _test(table.values, change[..., own] * dx[..., other])
                - _test(table.d, flux[..., other])
            )
        return forces

    def hessian(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        x, dx = _curve(table, points)
        even, slope = self._density(strength, body)
        elements, local = table.functions.shape
        hessian = np.zeros((elements, local, 3, local, 3))
        for k, sign in ((0, 1.0), (1, -1.0)):
            change = (0.5 * even + slope[k] * x[..., k]) * table.weights
            mixed = np.einsum("eqa,eqb,eq->eab", table.values, table.d, sign * change)
            hessian[:, :, k, :, 1 - k] += mixed
            hessian[:, :, 1 - k, :, k] += mixed.transpose(0, 2, 1)
            bent = sign * slope[k] * dx[..., 1 - k] * table.weights
            hessian[:, :, k, :, k] += np.einsum("eqa,eqb,eq->eab", table.values, table.values, bent)
        return hessian

    def _density(self, strength: float, body: BodyDensity) -> tuple[float, Array]:
        """What an area inside the line counts, and its slopes (2,) by x and y."""
        h, (ex, ey, ez) = self.level, body.gradient
        return strength + (body.constant + 0.5 * ez * h) * h, np.array([ex, ey]) * h


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
