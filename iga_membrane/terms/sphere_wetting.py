"""Contact line on a sphere: the wetted cap and what the liquid owes to it, by line integrals.

The wetted cap W lies round the top of the sphere (axis +z), inside a line that runs
counterclockwise. Every integral over it with an integrand that depends on height only is
``oint G(t) dphi``, ``t`` the cosine of the polar angle; one that grows along X or Y as well gives
``oint H(t) cos(phi) dphi``. With ``X`` the position from the centre
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
from ..splines.quadrature import gauss
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
        slope, curvature = _of_distance(x, g_s, g_z, g_ss, g_sz, g_zz)
        along = np.array([*body.gradient[:2], 0.0])
        if along.any() and not self.covered:
            # m = k w with the arc's integral k(t) and w = (sphere's radius / r)^3
            k, k_1, k_2 = self._side(t)
            w = (self.sphere.radius / r) ** 3
            w_s, w_z, w_ss = -1.5 * w / r**2, -3 * z * w / r**2, 3.75 * w / r**4
            w_sz, w_zz = 7.5 * z * w / r**4, (15 * z * z / r**2 - 3) * w / r**2
            m_slope, m_curvature = _of_distance(
                x,
                k_1 * t_s * w + k * w_s,
                k_1 * t_z * w + k * w_z,
                (k_2 * t_s**2 + k_1 * t_ss) * w + 2 * k_1 * t_s * w_s + k * w_ss,
                (k_2 * t_s * t_z + k_1 * t_sz) * w + k_1 * (t_s * w_z + t_z * w_s) + k * w_sz,
                (k_2 * t_z**2 + k_1 * t_zz) * w + 2 * k_1 * t_z * w_z + k * w_zz,
            )
            pull, mixed = x @ along, along[:, None] * m_slope[..., None, :]
            g = g - pull * k * w
            slope = slope - along * (k * w)[..., None] - pull[..., None] * m_slope
            mixed = mixed + np.swapaxes(mixed, -1, -2)
            curvature = curvature - mixed - pull[..., None, None] * m_curvature
        a, b = x[..., 0], x[..., 1]
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
        e0, ez = (0.0, 0.0) if self.covered else (_at_axis(body, self.sphere), body.gradient[2])
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

    def _side(self, t: Array) -> tuple[Array, Array, Array]:
        """What densities along X and Y add to ``g``, over ``-(e_x X + e_y Y)``: the arc's integral
        ``int_t^1 sqrt(1 - u^2) (c + r u) u du / (1 - t^2)^(3/2)`` and two derivatives.
        """
        r, c = self.sphere.radius, self.sphere.center[2]
        nodes, weights = gauss(ARC)
        square = nodes**2
        u = 1.0 - (1.0 - t[..., None]) * square
        # 1 - u^2 = (1 - t) nodes^2 (1 + u), so the root of 1 - t cancels
        root = np.sqrt(1.0 + u)
        inner = u * u * root
        inner_1 = (2 * u * root + 0.5 * u * u / root) * square
        inner_2 = (2 * root + 2 * u / root - 0.25 * u * u / root**3) * square**2
        top, top_1, top_2 = (f @ (2.0 * weights * square) for f in (inner, inner_1, inner_2))
        below = (1.0 + t) ** -1.5
        below_1, below_2 = -1.5 * below / (1.0 + t), 3.75 * below / (1.0 + t) ** 2
        return (
            c / 3.0 + r * top * below,
            r * (top_1 * below + top * below_1),
            r * (top_2 * below + 2 * top_1 * below_1 + top * below_2),
        )


def _at_axis(body: BodyDensity, sphere: Sphere) -> float:
    """Its constant on the vertical axis of a sphere."""
    (x, y, _), (ex, ey, _) = sphere.center, body.gradient
    return body.constant + ex * x + ey * y


def _of_distance(
    x: Array, g_s: Array, g_z: Array, g_ss: Array, g_sz: Array, g_zz: Array
) -> tuple[Array, Array]:
    """Gradient (..., 3) and Hessian (..., 3, 3) of a function of ``s = X^2 + Y^2`` and Z."""
    a, b = x[..., 0], x[..., 1]
    slope = np.stack([2 * a * g_s, 2 * b * g_s, g_z], axis=-1)
    rows: list[list[Array]] = [
        [2 * g_s + 4 * a * a * g_ss, 4 * a * b * g_ss, 2 * a * g_sz],
        [4 * a * b * g_ss, 2 * g_s + 4 * b * b * g_ss, 2 * b * g_sz],
        [2 * a * g_sz, 2 * b * g_sz, g_zz],
    ]
    return slope, np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


ARC = 16
"""Gauss points along the arc from the axis to the line."""
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
