"""The start of a droplet: a rounded, squashed pancake of least energy.

A flat disc of radius ``b`` whose edge is an elliptic arc (semi-axes ``rho`` and ``aspect * rho``)
that is tangent to the disc and meets the plane at the contact angle. ``b = 0, aspect = 1`` is the
spherical cap, the exact drop without gravity; large ``b`` is a puddle. Of all pancakes of the
volume the one with the least energy is close enough to any sessile drop for Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import GeometryError, SceneError
from ..quadrature import gauss
from ..solids import Solid, Sphere
from ..splines import Space
from ..surface.surface import Surface

STEEPEST = 171.0
"""Contact angle of the start at most (degrees, with gravity): flatter feet start nearly tangent to
the plane and Newton's first steps would cross it."""


@dataclass(frozen=True, eq=False)
class Pancake:
    """Profile of a rounded pancake, walked by arc length from the rim.

    Attributes
    ----------
    flat : radius b of the flat top.
    radius, aspect : of the elliptic arc.
    turn : parameter range of the arc, from ``turn`` at the rim to 0 at the flat top.
    """

    flat: float
    radius: float
    aspect: float
    turn: float

    @property
    def length(self) -> float:
        """Arc length from the rim to the axis."""
        return float(self._arc()[1][-1] + self.flat)

    def __call__(self, fraction: Array) -> tuple[Array, Array]:
        """``r, z`` at fractions of the arc length."""
        angle, walked = self._arc()
        s = np.asarray(fraction) * self.length
        u = np.interp(s, walked, angle)
        on_arc = s <= walked[-1]
        r = np.where(on_arc, self.flat + self.radius * np.sin(u), self.length - s)
        z = self.radius * self.aspect * (np.cos(u) - np.cos(self.turn))
        return r, z

    def _arc(self) -> tuple[Array, Array]:
        """Parameters along the arc from the rim and the arc length walked."""
        angle = np.linspace(self.turn, 0.0, 2001)
        middle = 0.5 * (angle[1:] + angle[:-1])
        speed = self.radius * np.hypot(np.cos(middle), self.aspect * np.sin(middle))
        step = self.turn / 2000.0
        return angle, np.concatenate([[0.0], np.cumsum(speed * step)])


def least_energy_pancake(
    contact_angle: float, bond: float, volume: float, *, steepest: float = STEEPEST
) -> Pancake:
    """The pancake of least energy (tension 1, density times gravity ``bond``).

    Parameters
    ----------
    contact_angle : degrees; limited to ``steepest`` if there is gravity.
    """
    theta = np.radians(min(contact_angle, steepest if bond > 0 else 180.0))
    flats = np.concatenate([[0.0], np.geomspace(1e-3, 3e3, 300)])[:, None]
    u, w = gauss(20)
    best = (np.inf, Pancake(0.0, 1.0, 1.0, theta))
    for aspect in np.geomspace(0.3, 1.0, 13)[::-1] if bond > 0 else [1.0]:
        turn = np.arctan2(np.sin(theta) / aspect, np.cos(theta))
        angle = turn * u
        r = flats + np.sin(angle)
        z = aspect * (np.cos(angle) - np.cos(turn))
        section = np.pi * r**2 * aspect * np.sin(angle) * turn
        radius = (volume / (section @ w)) ** (1.0 / 3.0)
        speed = np.hypot(np.cos(angle), aspect * np.sin(angle)) * turn
        area = np.pi * flats[:, 0] ** 2 + 2 * np.pi * ((r * speed) @ w)
        wet = np.pi * (flats[:, 0] + np.sin(turn)) ** 2
        energy = radius**2 * (area - np.cos(theta) * wet) + bond * radius**4 * ((section * z) @ w)
        k = int(energy.argmin())
        if energy[k] < best[0]:
            flat = float(flats[k, 0] * radius[k])
            best = (energy[k], Pancake(flat, float(radius[k]), float(aspect), float(turn)))
    return best[1]


@dataclass(frozen=True, eq=False)
class FlatDrop:
    """Axisymmetric drop that lies on a plane at 180 degrees (tension 1).

    Attributes
    ----------
    r, z, turn : (k,) profile from the foot's rim to the top, with its inclination.
    pressure : at the plane.
    foot : contact radius.
    """

    r: Array
    z: Array
    turn: Array
    pressure: float
    foot: float

    def meridian(self) -> tuple[Array, Array, Array]:
        """Arc length, radius and height from the rim of the foot, which it leaves at the foot's
        own radius, to the axis."""
        above = self.r >= self.foot
        above |= self.z > 0.5 * self.z.max()
        r = np.concatenate([[self.foot], self.r[above], [0.0]])
        z = np.concatenate([[0.0], self.z[above], self.z[-1:]])
        z = z - z[1] * (1.0 - z / z[-1])
        z[0] = 0.0
        walked = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(r), np.diff(z)))])
        return walked, r, z


def flat_drop(bond: float, volume: float) -> FlatDrop:
    """The drop at 180 degrees on a plane, by Young and Laplace's equation from its top.

    Parameters
    ----------
    bond : density times gravity, > 0.

    Notes
    -----
    ``r' = cos(turn), depth' = sin(turn), turn' = p_top + bond depth - sin(turn) / r`` by arc
    length; ``p_top`` is what the volume asks for.
    """
    from scipy.integrate import solve_ivp
    from scipy.optimize import brentq

    top = 1.0

    def rates(s: float, state: Array) -> list[float]:
        r, depth, turn, _ = state
        bend = top + bond * depth - np.sin(turn) / r
        return [np.cos(turn), np.sin(turn), bend, np.pi * r * r * np.sin(turn)]

    def closed(s: float, state: Array) -> float:
        return float(np.pi - state[2])

    closed.terminal = True  # type: ignore[attr-defined]

    def path(log: float, dense: bool = False) -> Any:
        nonlocal top
        top = float(np.exp(log))
        first = 1e-4 * min(1.0 / top, bond**-0.5)
        start = [first, 0.25 * top * first**2, 0.5 * top * first, 0.0]
        longest = 1e3 * (1.0 + bond**-0.5)
        return solve_ivp(rates, (0.0, longest), start, events=closed, dense_output=dense,
                         method="DOP853", rtol=1e-8, atol=1e-12)  # fmt: skip

    def missing(log: float) -> float:
        return float(np.log(path(log).y[3, -1] / volume))

    ball = float(np.log(2.0 * (4.0 * np.pi / (3.0 * volume)) ** (1.0 / 3.0)))
    low = ball - 1.0
    while missing(low) < 0.0:
        low -= 1.0
    found = path(float(brentq(missing, low, ball + 0.7, rtol=1e-9)), dense=True)
    r, depth, turn, _ = found.sol(np.linspace(found.t[-1], 0.0, 2001))
    pressure = top + bond * float(depth[0])
    # the weight over the pressure: a small foot has lost its digits where the path ends
    foot = float(np.sqrt(bond * volume / (np.pi * pressure)))
    return FlatDrop(r, depth[0] - depth, turn, pressure, foot)


def rounded(bond: float, volume: float) -> FlatDrop:
    """The pancake of least energy in the place of the drop on a plane."""
    pancake = least_energy_pancake(180.0, bond, volume, steepest=180.0)
    pressure = estimated_pressure(pancake, bond, volume)
    u = np.linspace(pancake.turn, 0.0, 2001)
    rho, a = pancake.radius, pancake.aspect
    r, z = pancake.flat + rho * np.sin(u), rho * a * (np.cos(u) - np.cos(pancake.turn))
    inside = r >= 1e-3 * rho
    turn = np.pi - np.arctan2(a * np.sin(u), -np.cos(u))
    foot = float(np.sqrt(bond * volume / (np.pi * pressure)))
    return FlatDrop(r[inside], z[inside], turn[inside], pressure, foot)


def estimated_pressure(pancake: Pancake, bond: float, volume: float) -> float:
    """Pressure at a plane at 180 degrees, by the virial ``3 p V = 2 E_surf + 4 E_grav`` of the
    start."""
    u, w = gauss(20)
    angle = pancake.turn * u
    r = pancake.flat + pancake.radius * np.sin(angle)
    z = pancake.radius * pancake.aspect * (np.cos(angle) - np.cos(pancake.turn))
    rate = pancake.radius * pancake.turn * w
    area = 2.0 * np.pi * r @ (rate * np.hypot(np.cos(angle), pancake.aspect * np.sin(angle)))
    area += 2.0 * np.pi * pancake.flat**2
    weight = bond * np.pi * (r**2 * z) @ (rate * pancake.aspect * np.sin(angle))
    return float((2.0 * area + 4.0 * weight) / (3.0 * volume))


def drop_on_sphere(contact_angle: float, radius: float, volume: float) -> tuple[float, Pancake]:
    """Drop without gravity on top of a sphere: the exact spherical cap.

    Parameters
    ----------
    radius : of the solid sphere, whose top is the origin.

    Returns
    -------
    polar : angle of the contact line from the sphere's top.
    cap : the free surface above the height of the contact line.
    """
    theta = np.radians(contact_angle)

    def drop(polar: float) -> tuple[float, Pancake]:
        turn = theta + polar
        free = radius * np.sin(polar) / np.sin(turn)
        above = np.pi * free**3 * (2 + np.cos(turn)) * (1 - np.cos(turn)) ** 2 / 3
        solid = np.pi * radius**3 * (2 + np.cos(polar)) * (1 - np.cos(polar)) ** 2 / 3
        return above - solid, Pancake(0.0, free, 1.0, turn)

    low, high = 0.0, np.pi - theta
    for _ in range(200):
        polar = 0.5 * (low + high)
        low, high = (polar, high) if drop(polar)[0] < volume else (low, polar)
    return polar, drop(polar)[1]


@dataclass(frozen=True)
class Funnel:
    """Sheet of small slopes on a sphere, lengths over its radius.

    Attributes
    ----------
    polar : angle of the circle on the sphere from its top; edge : that circle's radius.
    rim : radius of the rim.
    depth, log, quarter : of :meth:`height`.
    """

    polar: float
    edge: float
    rim: float
    depth: float
    log: float
    quarter: float

    def height(self, radius: Array) -> Array:
        """``z = z_a + B log(r / a) + p (r^2 - a^2) / 4 gamma`` at distances from the axis."""
        bowl = self.quarter * (radius**2 - self.edge**2)
        return np.asarray(self.depth + self.log * np.log(radius / self.edge) + bowl)

    @property
    def slope(self) -> float:
        """Of the sheet at the sphere, outwards."""
        return self.log / self.edge + 2.0 * self.quarter * self.edge

    def through(self, radius: Array) -> Array:
        """The same, and on inside the sphere to the axis, level there and beyond the rim."""
        inside = self.depth - 0.5 * self.slope / self.edge * (self.edge**2 - radius**2)
        outside = self.height(np.clip(radius, self.edge, self.rim))
        return np.where(radius < self.edge, inside, outside)


def meniscus(particle: Sphere, above: float, length: float) -> Funnel:
    """The membrane near a particle on a droplet, as a sheet of small slopes.

    Parameters
    ----------
    above : distance of the droplet's surface from the particle's centre, outwards.
    length : of the droplet, where the meniscus ends.
    """
    place = Sphere(particle.contact_angle, particle.radius, (0.0, 0.0, above))
    return funnel(place, max(MENISCUS * length, 2.0 * particle.radius), 0.0)


MENISCUS = 0.8
"""Reach of a meniscus over the length of the droplet."""


def funnel(particle: Sphere, half: float, curvature: float) -> Funnel:
    """The funnel that meets a sphere at its contact angle.

    Parameters
    ----------
    half : size of the rim from the middle.
    curvature : pressure over tension.
    """
    r, (x, y, z) = particle.radius, particle.center
    rim, quarter = (half - max(abs(x), abs(y))) / r, 0.25 * curvature * r
    polar = np.linspace(1e-3, np.pi - 1e-3, 4001)
    polar = polar[(np.sin(polar) < 0.95 * rim) & ((rim > 1.0) | (polar < 0.5 * np.pi))]
    a, depth = np.sin(polar), z / r + np.cos(polar)
    log = -(depth + quarter * (rim**2 - a**2)) / np.log(rim / a)
    slope = np.arctan(log / a + 2.0 * quarter * a)
    excess = np.pi - np.radians(particle.contact_angle) - polar - slope
    falls = np.flatnonzero((excess[:-1] > 0) & (excess[1:] <= 0))
    # the last crossing is the stable one; without any, the nearest to one
    k = int(falls[-1]) if len(falls) else int(np.abs(excess).argmin())
    return Funnel(float(polar[k]), float(a[k]), rim, float(depth[k]), float(log[k]), quarter)


def check_net(start: Surface, asked: Space) -> None:
    """Refuse a start of another space.

    Raises
    ------
    SceneError
    """
    given = start.space
    if (given.net_shape, given.degree, given.pole) != (asked.net_shape, asked.degree, asked.pole):
        raise SceneError(
            f"start: control net {given.net_shape} of degree {given.degree} given, "
            f"{asked.net_shape} of degree {asked.degree} expected from the discretization"
        )


def check_clear(start: Surface, solid: Solid, allowed: float) -> None:
    """Refuse a start that lies deeper in its solid than allowed.

    Raises
    ------
    SceneError
        With the depth, the body's number (0 for a plane), the place and the way out.
    """
    points = start.on(start.space.table(2)).position.reshape(-1, 3)
    at = solid.nearest(points)
    deepest = int(np.argmin(at.gap))
    depth, which = -float(at.gap[deepest]), max(int(at.which[deepest]), 0)
    if depth > allowed:
        x, y, z = points[deepest]
        raise SceneError(
            f"start: the surface lies up to {depth:g} below the substrate (solid {which}) at "
            f"[{x:g}, {y:g}, {z:g}]; lift it by at least {depth - allowed:g} along the solid's "
            "normal"
        )


def check_turns(start: Surface, up: Array) -> None:
    """Refuse a ring patch that passes through its own middle.

    Parameters
    ----------
    up : (3,) unit vector about which its rings run counterclockwise.

    Raises
    ------
    GeometryError
        With the element and the place.
    """
    one, two = start.space.bases
    k = start.grid(SEEN * one.elements + 1, SEEN * two.elements + 1, 1)
    across, along = k.position - k.position[:-1].mean(axis=0), k.tangents[..., 0, :]
    turn = np.cross(across, along) @ up
    beyond = (across[:, 1:] * across[:, :-1]).sum(axis=-1)
    tiny = 1e-9 * start.size**2
    backwards = np.argwhere((turn[:, :-1] < -tiny) | (beyond < -tiny))
    if len(backwards):
        i, j = (int(n) for n in backwards[0])
        x, y, z = k.position[i, j]
        raise GeometryError(
            f"start: the surface is folded in element ({i // SEEN}, {j // SEEN}) of its patch, at "
            f"[{x:g}, {y:g}, {z:g}], where it passes through its own middle; give a start whose "
            "rings run counterclockwise about the droplet, each within reach of the next"
        )


SEEN = 3
"""Points of an element, along each parameter, at which a start is looked at."""


def gathered(radius: Array, spot: float, part: float) -> Array:
    """Radii drawn towards the contact line: their steps there are shorter by ``part``, as a steep
    membrane's are longer than their projection, and somewhat more."""
    away = (radius - spot) / (GATHERED * spot)
    middle = radius**2 / (radius**2 + (0.2 * spot) ** 2)
    rim = (1.0 - (radius / radius[-1]) ** 4) ** 2
    return radius - part * (radius - spot) * np.exp(-(away**2)) * middle * rim


GATHERED = 0.65
"""Width, over the spot's radius, of the zone of shorter steps on either side of its edge."""
