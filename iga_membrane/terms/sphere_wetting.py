"""Contact line on a sphere: the wetted cap and what the liquid owes to it, by line integrals.

The wetted cap W lies round the top of the sphere (axis +z), inside a line that runs
counterclockwise. Every integral over it with an integrand that depends on height only is
``oint G(t) dphi``, ``t`` the cosine of the polar angle. With ``X`` the position from the centre
this is the line integral of ``g (X dY - Y dX)``, ``g = G / (X^2 + Y^2)``, a smooth function near
the sphere: the line itself is held on the sphere by :class:`.edge_gap.EdgeGap`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..checks import choice, number
from ..errors import GeometryError
from ..solids.sphere import Sphere
from ..splines import EdgeTable
from .term import LINE_EDGES, BodyDensity, LineTerm, Scale


@dataclass(frozen=True)
class SphereContactLine(LineTerm):
    """Energy ``-gamma cos(theta) A_wet`` of a sphere wetted from above, and the part of body
    integrals that lies under the wetted cap.

    Attributes
    ----------
    gamma : surface tension.
    sphere : with its contact angle.
    edge : edge of the membrane that slides on the sphere.
    covered : as for :class:`.contact_line.PlaneContactLine`.
    """

    gamma: float
    sphere: Sphere
    edge: str = "xi2=0"
    covered: bool = False
    name = "wetting"

    def __post_init__(self) -> None:
        number("liquid.surface_tension", self.gamma, above=0.0)
        if not self.covered:
            choice("edge", self.edge, LINE_EDGES)

    @property
    def strength(self) -> float:
        cosine = np.cos(np.radians(self.sphere.contact_angle))
        return float(-self.gamma * (cosine + self.covered))

    def scaled(self, scale: Scale) -> SphereContactLine:
        sphere = scale.local_sphere(self.sphere)
        return replace(self, gamma=self.gamma / scale.tension, sphere=sphere)

    def energy(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> float:
        at = self._line(table, points, strength, body)
        total: float = (at.g * at.turn * table.weights).sum()
        return total

    def forces(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        at = self._line(table, points, strength, body)
        w = table.weights[..., None]
        value = (at.slope * at.turn[..., None] + at.g[..., None] * at.q) * w
        derivative = at.g[..., None] * at.p * w
        return np.asarray(
            table.values.transpose(0, 2, 1) @ value + table.d.transpose(0, 2, 1) @ derivative
        )

    def hessian(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        at = self._line(table, points, strength, body)
        n, d, w = table.values, table.d, table.weights
        both = at.slope[..., :, None] * at.q[..., None, :]
        plain = at.curvature * at.turn[..., None, None] + both + np.swapaxes(both, -1, -2)
        mixed = at.slope[..., :, None] * at.p[..., None, :]
        mixed = mixed + at.g[..., None, None] * _QUARTER_TURN
        half = np.einsum("eqa,eqb,eqij,eq->eaibj", n, d, mixed, w, optimize=True)
        whole = np.einsum("eqa,eqb,eqij,eq->eaibj", n, n, plain, w, optimize=True)
        return np.asarray(whole + half + half.transpose(0, 3, 4, 1, 2))

    def _line(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> _Line:
        """The integrand ``g (X Y' - Y X')`` and its derivatives at the quadrature points."""
        local = points[table.functions]
        x = table.values @ local - np.array(self.sphere.center)
        dx = table.d @ local
        s = x[..., 0] ** 2 + x[..., 1] ** 2
        if not np.all(s > 0.0):
            raise GeometryError("the contact line meets the vertical axis of its sphere")
        z = x[..., 2]
        r = np.sqrt(s + z * z)
        t = z / r
        t_s, t_z = -z / (2 * r**3), s / r**3
        t_ss = 3 * z / (4 * r**5)
        t_sz = -1 / (2 * r**3) + 3 * z * z / (2 * r**5)
        t_zz = -3 * z * s / r**5
        cap, cap_1, cap_2 = self._cap(t, strength, body)
        g = cap / s
        g_s = (cap_1 * t_s - g) / s
        g_z = cap_1 * t_z / s
        g_ss = (cap_2 * t_s**2 + cap_1 * t_ss - 2 * g_s) / s
        g_sz = (cap_2 * t_s * t_z + cap_1 * t_sz - g_z) / s
        g_zz = (cap_2 * t_z**2 + cap_1 * t_zz) / s
        a, b = x[..., 0], x[..., 1]
        slope = np.stack([2 * a * g_s, 2 * b * g_s, g_z], axis=-1)
        rows = [
            [2 * g_s + 4 * a * a * g_ss, 4 * a * b * g_ss, 2 * a * g_sz],
            [4 * a * b * g_ss, 2 * g_s + 4 * b * b * g_ss, 2 * b * g_sz],
            [2 * a * g_sz, 2 * b * g_sz, g_zz],
        ]
        curvature = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
        zero = np.zeros_like(a)
        return _Line(
            g,
            slope,
            curvature,
            a * dx[..., 1] - b * dx[..., 0],
            np.stack([-b, a, zero], axis=-1),
            np.stack([dx[..., 1], -dx[..., 0], zero], axis=-1),
        )

    def _cap(self, t: Array, strength: float, body: BodyDensity) -> tuple[Array, Array, Array]:
        """``G(t)`` and two derivatives: ``strength`` times area plus the body's share.

        On the cap the liquid's outward normal is minus the sphere's, so the body's share is
        ``-int Q N_z dA`` with ``Q = int_0^z e dz`` and ``e = e0 + ez z``.
        """
        r, c = self.sphere.radius, self.sphere.center[2]
        e0, ez = (0.0, 0.0) if self.covered else (body.constant, body.gradient[2])
        # -Q(c + r t) t r^2 as a polynomial k1 t + k2 t^2 + k3 t^3, to be integrated from t to 1
        k1 = -(r**2) * (e0 * c + 0.5 * ez * c * c)
        k2 = -(r**3) * (e0 + ez * c)
        k3 = -0.5 * r**4 * ez
        cap = (
            strength * r**2 * (1 - t)
            + k1 * (1 - t**2) / 2
            + k2 * (1 - t**3) / 3
            + k3 * (1 - t**4) / 4
        )
        first = -strength * r**2 - k1 * t - k2 * t**2 - k3 * t**3
        second = -k1 - 2 * k2 * t - 3 * k3 * t**2
        return cap, first, second


_QUARTER_TURN = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])


@dataclass(frozen=True, eq=False)
class _Line:
    """Pieces of the integrand ``g turn`` at points.

    Attributes
    ----------
    g, slope, curvature : ``g`` with its gradient and Hessian by ``x``.
    turn, p, q : ``X Y' - Y X'`` with its derivatives by ``x'`` and by ``x``.
    """

    g: Array
    slope: Array
    curvature: Array
    turn: Array
    p: Array
    q: Array
