"""Contact line on a sphere: the wetted cap and what the liquid owes to it, by line integrals.

The wetted cap W lies round the end of an axis ``a`` towards the liquid, inside a line that runs
counterclockwise about it. With ``X`` from the sphere's centre C the cone from C to the line cuts a
sector S out of the ball, and ``X x X'`` is the cone's area vector, so that for the flux
``F = Q e_z`` of a body density ``e``

    -int_W F . n dA = -int_S e dV - oint int_0^1 F(C + s X) s ds . (X x X') dxi,
    int_S e dV = e(C) r A_W / 3 + r^2 / 8 oint grad(e) . (X x X') (r / |X|)^2 dxi,
    A_W = r^2 oint a . (X x X') / (|X| (|X| + a . X)) dxi:

all is ``oint p(X) . (X x X') dxi`` with a vector ``p`` that is smooth but for the dry end of the
axis. The line itself is held on the sphere by :class:`.edge_gap.EdgeGap`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import choice, direction
from ..errors import GeometryError
from ..solids import Solid, Sphere
from ..splines import EdgeTable, line
from ..splines.space import EDGES
from .term import BodyDensity, Scale, WettingLine
from .variations import cross

RING_EDGES = ("xi2=0", "xi2=1")


@dataclass(frozen=True)
@checked(gamma="liquid.surface_tension", edge=line, toward=direction)
class SphereContactLine(WettingLine):
    """Energy ``-gamma cos(theta) A_wet`` of a sphere that the liquid wets, and the part of body
    integrals that lies under the wetted cap.

    Attributes
    ----------
    gamma : surface tension.
    sphere : with its contact angle.
    edge : edge of the membrane that slides on the sphere.
    covered : as for :class:`.contact_line.PlaneContactLine`.
    toward : unit vector from the centre to the liquid; its other end is dry.
    """

    gamma: float
    sphere: Sphere
    edge: str = "xi2=0"
    covered: bool = False
    toward: tuple[float, float, float] = (0.0, 0.0, 1.0)
    name = "wetting"
    forms = ("lines", "wetting", "on_spheres")

    def __post_init__(self) -> None:
        if not self.covered:
            choice("edge", self.edge, RING_EDGES)

    @property
    def ball(self) -> Sphere:
        return self.sphere

    @property
    def face(self) -> Sphere:
        return self.sphere

    def normal(self, points: Array) -> Array:
        return self.sphere.normal(points)

    @property
    def strength(self) -> float:
        cosine = np.cos(np.radians(self.sphere.contact_angle))
        return float(-self.gamma * (cosine + self.covered))

    @property
    def turn(self) -> float:
        """1 where the edge runs counterclockwise about the axis, -1 at the membrane's other end."""
        return -1.0 if EDGES.get(self.edge, (0, 0))[1] else 1.0

    @property
    def solids(self) -> tuple[Solid, ...]:
        return (self.sphere,)

    def scaled(self, scale: Scale) -> SphereContactLine:
        sphere = scale.local_sphere(self.sphere)
        x, y, z = (float(a) for a in np.array(self.toward) @ scale.axes)
        return replace(self, gamma=self.gamma / scale.tension, sphere=sphere, toward=(x, y, z))

    def energy(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> float:
        x, dx = self._curve(table, points)
        p = self._density(x, strength, body)[0]
        total: float = ((p * cross(x, dx)).sum(axis=-1) * table.weights).sum()
        return self.turn * total

    def forces(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        x, dx = self._curve(table, points)
        p, slope, _ = self._density(x, strength, body)
        area, w = cross(x, dx), self.turn * table.weights[..., None]
        value = np.einsum("eqki,eqk->eqi", slope, area) + cross(dx, p)
        return np.asarray(
            table.values.transpose(0, 2, 1) @ (value * w)
            + table.d.transpose(0, 2, 1) @ (cross(p, x) * w)
        )

    def hessian(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        x, dx = self._curve(table, points)
        p, slope, bend = self._density(x, strength, body)
        n, d, w = table.values, table.d, self.turn * table.weights
        # column i of the slope is the change of p by x_i
        columns = np.swapaxes(slope, -1, -2)
        once = cross(*np.broadcast_arrays(dx[..., None, :], columns))
        plain = np.einsum("eqkij,eqk->eqij", bend, cross(x, dx)) + once + np.swapaxes(once, -1, -2)
        mixed = cross(*np.broadcast_arrays(columns, x[..., None, :]))
        mixed = mixed + cross(*np.broadcast_arrays(p[..., None, :], np.eye(3)))
        half = np.einsum("eqa,eqb,eqij,eq->eaibj", n, d, mixed, w, optimize=True)
        whole = np.einsum("eqa,eqb,eqij,eq->eaibj", n, n, plain, w, optimize=True)
        return np.asarray(whole + half + half.transpose(0, 3, 4, 1, 2))

    def _curve(self, table: EdgeTable, points: Array) -> tuple[Array, Array]:
        """Positions from the centre, and their derivatives along the edge."""
        local = points[table.functions]
        return table.values @ local - np.array(self.sphere.center), table.d @ local

    def _density(self, x: Array, strength: float, body: BodyDensity) -> tuple[Array, Array, Array]:
        """The vector ``p`` (..., 3), its slope (..., 3, 3), derivatives last, and (..., 3, 3, 3)
        second derivatives."""
        center, r, up = np.array(self.sphere.center), self.sphere.radius, np.array([0.0, 0.0, 1.0])
        e = BodyDensity() if self.covered else body
        gradient = np.array(e.gradient)
        on_area = r**2 * (strength - r / 3.0 * (e.constant + center @ gradient))
        axis, in_sector = np.array(self.toward), -(r**4) / 8.0 * gradient
        share, share_1, share_2 = _solid_angle(x, axis)
        inverse, inverse_1, inverse_2 = _inverse_square(x)
        on_cone, on_cone_1, on_cone_2 = _cone_flux(x, center, e)
        value = (
            np.multiply.outer(share, on_area * axis)
            + np.multiply.outer(inverse, in_sector)
            - np.multiply.outer(on_cone, up)
        )
        slope = (
            on_area * axis[:, None] * share_1[..., None, :]
            + in_sector[:, None] * inverse_1[..., None, :]
            - up[:, None] * on_cone_1[..., None, :]
        )
        bend = (
            on_area * axis[:, None, None] * share_2[..., None, :, :]
            + in_sector[:, None, None] * inverse_2[..., None, :, :]
            - up[:, None, None] * on_cone_2
        )
        return value, slope, bend


def _solid_angle(x: Array, axis: Array) -> tuple[Array, Array, Array]:
    """``u = 1 / (|x| (|x| + a . x))`` with its gradient and Hessian; ``oint u a . (x x dx)`` is the
    solid angle inside a line about the axis a."""
    size = np.sqrt((x * x).sum(axis=-1))[..., None]
    along = (x @ axis)[..., None]
    if not np.all(size + along > DRY * size):
        raise GeometryError("the contact line meets the dry end of its sphere's axis")
    normal, unit = x / size, np.eye(3)
    u = 1.0 / (size**2 + size * along)
    turned = normal[..., :, None] * axis
    across = unit - normal[..., :, None] * normal[..., None, :]
    slope = 2.0 * x + along * normal + size * axis
    bend = 2.0 * unit + turned + np.swapaxes(turned, -1, -2) + (along / size)[..., None] * across
    hessian = (2.0 * u**3)[..., None] * slope[..., :, None] * slope[..., None, :]
    return u[..., 0], -(u**2) * slope, hessian - (u**2)[..., None] * bend


DRY = 1e-9
"""How near the cosine from the axis may come to -1."""


def _inverse_square(x: Array) -> tuple[Array, Array, Array]:
    """``1 / |x|^2`` with its gradient and Hessian."""
    v = 1.0 / (x * x).sum(axis=-1)[..., None]
    outer = (8.0 * v**3)[..., None] * x[..., :, None] * x[..., None, :]
    return v[..., 0], -2.0 * v**2 * x, outer - (2.0 * v**2)[..., None] * np.eye(3)


def _cone_flux(x: Array, center: Array, e: BodyDensity) -> tuple[Array, Array, Array]:
    """``int_0^1 Q(C + s x) s ds`` of the flux Q of a density with its gradient and Hessian, the
    latter the same everywhere."""
    lean = np.array(e.gradient) * [1.0, 1.0, 0.5]  # Q = z (constant + lean . x)
    up, level = np.array([0.0, 0.0, 1.0]), center[2]
    here, there = e.constant + center @ lean, x @ lean
    z = x[..., 2]
    value = level * here / 2.0 + (level * there + z * here) / 3.0 + z * there / 4.0
    slope = (level * lean + here * up) / 3.0 + (z[..., None] * lean + there[..., None] * up) / 4.0
    return value, slope, (np.outer(lean, up) + np.outer(up, lean)) / 4.0
