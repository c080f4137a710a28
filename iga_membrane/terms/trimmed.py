"""Contact lines where the membrane passes through a solid, at any contact angle.

The spline runs smoothly through the solid; only its part outside is liquid-gas interface, the
wetted surface inside the line ``gap(x(xi)) = 0`` is the solid's own. With ``m = a_1 x a_2``,
``J = |m|``, the solid's normal ``n`` and the flux ``c = Q(x)`` of the body density, the first
variation of

    int_{gap > 0} (gamma J + c m_z) dxi + int_wet (-gamma cos(theta) - c n_z) dA

along ``N_I d_I`` is ``int_{gap > 0} F_I dxi + oint N_I d_I . q do / |g_h|`` with

    q = gamma (J n - cos(theta) m) + c (m_z n - n_z m),

where the line is a graph of the coordinate ``h`` over the other, ``o``, and ``g_h`` the slope of
the gap along ``h``. The wetted side itself never enters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import array
from ..solids import Nearest, Solid, SphereLattice, Spheres
from ..solids.fan import Fan, ball_fan, fan_of
from ..solids.wettability import cosine_of, least_angle, varies
from ..splines import LineTable
from .term import BodyDensity, Scale, Term
from .variations import cross, flux, flux_gradient

CapDensity = Callable[[Array, Array, Index], Array]
"""Positions and normals (..., 3) on a wetted surface and its spheres' numbers (...) to values."""


@dataclass(frozen=True, eq=False)
@checked(gamma="liquid.surface_tension", toward=partial(array, shape=(None, 3)))
class TrimmedContactLine(Term):
    """Energy ``-gamma cos(theta)`` of the solid's wetted surface, the membrane passing through it.

    Attributes
    ----------
    gamma : surface tension.
    solid : sphere, lattice or list of spheres, with its contact angles; a plane under them is left
        out, no line is computed on it.
    toward : (k, 3) unit vectors towards the liquid from the last spheres of a list, the particles;
        away from the liquid they are dry. From all others it points upwards.
    """

    gamma: float
    solid: Solid
    toward: Array | None = None
    name = "wetting"
    forms = ("passed",)

    def __post_init__(self) -> None:
        if isinstance(self.solid, (SphereLattice, Spheres)) and self.solid.base is not None:
            object.__setattr__(self, "solid", replace(self.solid, base=None))

    @property
    def solids(self) -> tuple[Solid, ...]:
        return (self.solid,)

    def scaled(self, scale: Scale) -> TrimmedContactLine:
        toward = None if self.toward is None else self.toward @ scale.axes
        return TrimmedContactLine(self.gamma / scale.tension, scale.local_solid(self.solid), toward)

    def axis(self, which: Index) -> Array:
        """(..., 3) towards the liquid from spheres by their numbers."""
        axes = np.broadcast_to([0.0, 0.0, 1.0], (*np.shape(which), 3))
        if self.toward is None:
            return axes
        own = self.particle(which)
        return np.where(own[..., None] >= 0, self.toward[own], axes)

    @property
    def count(self) -> int:
        """Number of the spheres of a list, 0 of other solids."""
        return len(self.solid.centers) if isinstance(self.solid, Spheres) else 0

    def particle(self, which: Index) -> Index:
        """(...) number among the particles of spheres by their numbers, -1 for others."""
        if self.toward is None or not isinstance(self.solid, Spheres):
            return np.full(np.shape(which), -1)
        return np.maximum(np.asarray(which) - len(self.solid.centers) + len(self.toward), -1)

    @property
    def angles_of_substrate(self) -> Array:
        """Contact angles in degrees, those of particles left out."""
        least = least_angle(self.solid.contact_angle)
        if varies(self.solid.contact_angle):
            return np.array([least])
        angles = np.atleast_1d(np.asarray(self.solid.contact_angle, float))
        return angles if self.toward is None else angles[: len(angles) - len(self.toward)]

    def cosine(self, points: Array, which: Index) -> tuple[Array, Array | None]:
        """(...) cosine of the contact angle at points (..., 3) of bodies by their numbers, and its
        gradient (..., 3), None where it is the same all over a body."""
        return cosine_of(self.solid.contact_angle, points, which)

    def fan(self, which: Index, points: Array, tangents: Array) -> Fan:
        """The fan at lines on bodies by their numbers: of finite radius they are balls."""
        radii = self.solid.radius_of(which)
        if np.isfinite(radii).all():
            centers = self.solid.center_of(which)
            return ball_fan(centers, radii, self.axis(which), points, tangents)
        return fan_of(self.solid, points, tangents)


@dataclass(frozen=True, eq=False)
class Line:
    """Geometry at points of contact lines, arrays (pieces, points, ...).

    Attributes
    ----------
    term : what they cost.
    table : functions there; ``across`` the coordinate h and ``rising`` the sign of ``g_h``.
    x, a1, a2 : position and tangents.
    m, area : ``a_1 x a_2`` and its length.
    ah, ao, xhh, xho : derivatives along h and o.
    at : nearest surface of the solid; cosine of its contact angle, and its gradient, None where it
        has none.
    gh, go : slopes of the gap.
    """

    term: TrimmedContactLine
    table: LineTable
    x: Array
    a1: Array
    a2: Array
    m: Array
    area: Array
    ah: Array
    ao: Array
    xhh: Array
    xho: Array
    at: Nearest
    cosine: Array
    cosine_slope: Array | None
    gh: Array
    go: Array

    @property
    def tangent(self) -> Array:
        """(pieces, points, 3) derivative of the position along o."""
        return np.asarray(self.ao - (self.go / self.gh)[..., None] * self.ah)

    @property
    def left(self) -> Index:
        """(pieces,) 1 where the wetted side lies to the left of the tangent, seen from the liquid,
        else -1: along h the gap rises."""
        return np.asarray(np.where(self.table.across == 1, 1, -1) * self.table.rising)

    @cached_property
    def fan(self) -> Fan:
        """Lines over the wetted surfaces to them."""
        return self.term.fan(self.at.which, self.x, self.tangent)


def on_line(term: TrimmedContactLine, table: LineTable, points: Array) -> Line:
    """Geometry of a surface with control points (count, 3) on its contact lines."""
    x, a1, a2, x11, x12, x22 = (rows @ points[table.functions] for rows in table.rows)
    m = cross(a1, a2)
    one = (table.across == 0)[:, None, None]
    ah, ao, xhh = np.where(one, a1, a2), np.where(one, a2, a1), np.where(one, x11, x22)
    at = term.solid.nearest(x)
    gh, go = (np.einsum("kqi,kqi->kq", at.normal, a) for a in (ah, ao))
    area = np.sqrt(np.einsum("kqi,kqi->kq", m, m))
    cosine, slope = term.cosine(x, at.which)
    return Line(term, table, x, a1, a2, m, area, ah, ao, xhh, x12, at, cosine, slope, gh, go)


def line_density(line: Line, tension: float, body: BodyDensity) -> Array:
    """(pieces, points, 3) the vector q: membrane's edge and Young's term in one."""
    c = flux(body, line.x)[..., None]
    n, m = line.at.normal, line.m
    q = c * (m[..., 2:] * n - n[..., 2:] * m)
    if tension:
        q = q + tension * (line.area[..., None] * n - line.cosine[..., None] * m)
    return np.asarray(q)


def line_forces(line: Line, tension: float, body: BodyDensity) -> Array:
    """(pieces, local, 3) derivative of the energy by local control points."""
    q = line_density(line, tension, body) * (line.table.weights / np.abs(line.gh))[..., None]
    return np.asarray(line.table.rows[0].transpose(0, 2, 1) @ q)


def line_hessian(line: Line, tension: float, body: BodyDensity, directions: Array) -> Array:
    """(pieces, local, local) second derivative along directions (pieces, local, 3), with the part
    that is owed to the line's own motion; :func:`end_hessian` completes it.

    Notes
    -----
    At fixed parameters the density varies by ``q_J``; the graph moves by ``h_J = -g_J / g_h``, and
    the measure ``1 / |g_h|`` by ``e_J``. The antisymmetric part is a total derivative along the
    line and drops out.
    """
    n0, n1, n2 = (rows[..., None] for rows in line.table.rows[:3])
    one = (line.table.across == 0)[:, None, None, None]
    nh = np.where(one, n1, n2)
    d = directions[:, None]  # (pieces, 1, local, 3)
    n, m = (v[:, :, None] for v in (line.at.normal, line.m))
    a1, a2, ah = (v[:, :, None] for v in (line.a1, line.a2, line.ah))
    area, cosine = line.area[..., None, None], line.cosine[..., None, None]
    gh = line.gh[..., None, None]
    c, slope = flux(body, line.x)[..., None, None], flux_gradient(body, line.x)[:, :, None]

    def dot(u: Array, v: Array) -> Array:
        return np.asarray((u * v).sum(axis=-1, keepdims=True))

    def cosine_along(way: Array) -> Array:
        """Change of the contact angle's cosine along vectors."""
        slope = line.cosine_slope
        return np.zeros(1) if slope is None else dot(slope[:, :, None], way)

    def density(n_: Array, m_: Array, area_: Array, c_: Array, cosine_: Array) -> Array:
        """Variation of q by those of n, m, J, c and cos(theta)."""
        varied = c_ * (m[..., 2:] * n - n[..., 2:] * m)
        varied = varied + c * (
            m_[..., 2:] * n + m[..., 2:] * n_ - n_[..., 2:] * m - n[..., 2:] * m_
        )
        return np.asarray(varied + tension * (area_ * n + area * n_ - cosine * m_ - cosine_ * m))

    # at fixed parameters
    m_j = n1 * cross(*np.broadcast_arrays(d, a2)) + n2 * cross(*np.broadcast_arrays(a1, d))
    area_j = dot(m, m_j) / area
    nd = dot(n, d)
    turned = line.at.turned(np.broadcast_to(d, (*line.x.shape[:2], *d.shape[2:])))
    n_j = n0 * turned
    c_j = n0 * dot(slope, d)
    g_j = n0 * nd
    f_j = tension * area_j + c_j * m[..., 2:] + c * m_j[..., 2:]
    q_j = density(n_j, m_j, area_j, c_j, n0 * cosine_along(d))
    # along h
    x1h = np.where(one[..., 0], line.xhh, line.xho)[:, :, None]
    x2h = np.where(one[..., 0], line.xho, line.xhh)[:, :, None]
    m_h = cross(x1h, a2) + cross(a1, x2h)
    n_h = line.at.turned(ah)
    q_h = density(n_h, m_h, dot(m, m_h) / area, dot(slope, ah), cosine_along(ah))
    g_hh = dot(n, line.xhh[:, :, None]) + dot(n_h, ah)
    g_jh = nh * nd + n0 * dot(turned, ah)
    h_j = -g_j / gh
    e_j = -(g_jh + h_j * g_hh) / gh
    q = line_density(line, tension, body)[:, :, None]
    p_j = q_j + h_j * q_h + e_j * q
    w = (line.table.weights / np.abs(line.gh))[..., None, None]
    left = n0 * d * w
    blocks = np.einsum("kqai,kqbi->kab", left, p_j, optimize=True)
    dq = dot(d, q)
    blocks += np.einsum("kqa,kqb->kab", (nh * dq * w)[..., 0], h_j[..., 0], optimize=True)
    blocks += np.einsum("kqa,kqb->kab", (f_j * w)[..., 0], g_j[..., 0], optimize=True)
    return np.asarray(0.5 * (blocks + blocks.transpose(0, 2, 1)))


def end_hessian(ends: Line, tension: float, body: BodyDensity, directions: Array) -> Array:
    """(ends, local, local) what the second derivative owes to the ends of the graphs."""
    along = np.einsum("kqa,kai->kqai", ends.table.rows[0], directions)
    q = line_density(ends, tension, body)
    work = np.einsum("kqai,kqi->kqa", along, q)
    gap = np.einsum("kqai,kqi->kqa", along, ends.at.normal)
    grazing = np.abs(ends.go) <= 1e-13 * np.abs(ends.gh)
    size = np.abs(ends.gh) * np.where(grazing, np.inf, np.abs(ends.go))
    w = ends.table.weights * ends.table.rising[:, None] / size
    half = np.einsum("kqa,kqb,kq->kab", work, gap, 0.5 * w, optimize=True)
    return np.asarray(half + half.transpose(0, 2, 1))


def wet_integral(line: Line, density: CapDensity) -> Array:
    """(pieces,) integrals over the wetted surface, by fans (:mod:`iga_membrane.solids.fan`).

    Parameters
    ----------
    density : position and normal (..., 3), numbers of bodies (...) to the integrand (...).
    """
    fan = line.fan
    owner = np.broadcast_to(line.at.which[..., None], fan.weights.shape)
    whole = (density(fan.points, fan.normals, owner) * fan.weights).sum(axis=-1)
    return np.asarray((whole * line.table.weights).sum(axis=1) * line.left)
