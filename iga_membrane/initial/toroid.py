"""The start of a liquid bridge: the toroid of least energy between two solids of revolution.

Its meridian is a circular arc between a circle on each solid, bent so that it holds the volume.
With the chord c between the circles, of mean radius m and outward normal part n along r, and half
the turn w of the arc (positive where it bulges), Pappus' rules give in closed form

    V = frustum + 2 pi c^2 (m a(w) + n c b(w)),
    A = 2 pi c w / sin w (m + n c (1 - w cot w) / 2 w),
    a = (2 w - sin 2w) / (8 sin^2 w), b = 1 / 12 - a cot(w) / 2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask
from ..solids import Plane, Sphere

FLATTEST = 6.0
"""Contact angle of the start at least, degrees: a nearly tangent line finds its place from larger
angles, which halve with every step of Newton's method, and not from smaller ones."""
WIDEST = np.radians(175.0)
"""Polar angle of a circle on a sphere at most."""
GRID, ZOOMS = 64, 1
"""Circles tried on each solid, and how often again around the best pair, at last within 1e-3 of the
widest from each other."""
SEEN = 12
"""Points of an arc between its ends at which it must lie outside of both solids."""
MOST = 0.97 * np.pi
"""Half the turn of an arc at most: a whole circle but for a small opening."""
WIDER = 3.0
"""Volume of the gap inside the widest circles over the liquid's."""


@dataclass(frozen=True)
class End:
    """A solid of revolution that a bridge ends on.

    Attributes
    ----------
    radius : of the sphere, infinite for a plane; level : height of its point on the axis.
    side : 1 if it lies below the bridge, -1 above.
    contact_angle : degrees, of the start.
    """

    radius: float
    level: float
    side: float
    contact_angle: float

    @classmethod
    def of(cls, solid: Plane | Sphere, side: float) -> End:
        """Of a solid in the scene's scale."""
        angle = max(solid.contact_angle, FLATTEST)
        if isinstance(solid, Plane):
            return cls(np.inf, solid.point[2], side, angle)
        return cls(solid.radius, solid.center[2] + side * solid.radius, side, angle)

    def circle(self, way: Array) -> tuple[Array, Array]:
        """Radius and depth below the point on the axis of circles, by their way from there."""
        polar = way / self.radius
        return np.sinc(polar / np.pi) * way, 0.5 * np.sinc(0.5 * polar / np.pi) ** 2 * way * polar

    def height(self, way: Array) -> Array:
        """Of circles."""
        return np.asarray(self.level - self.side * self.circle(way)[1])

    def cap(self, way: Array) -> tuple[Array, Array]:
        """Area and volume of the caps inside circles."""
        r, depth = self.circle(way)
        square = r**2 + depth**2
        return np.pi * square, np.pi * depth / 6.0 * (2.0 * r**2 + square)

    def clear(self, r: Array, z: Array) -> Mask:
        """Whether points of a meridian lie outside."""
        above = self.side * (z - self.level)
        curved = 0.0 if np.isinf(self.radius) else (r**2 + above**2) / (2.0 * self.radius)
        return above + curved > 0.0

    def ways(self, widest: float) -> Array:
        """(GRID,) of circles up to the widest."""
        most = min(WIDEST * self.radius, widest)
        return np.linspace(most / GRID, most, GRID)


@dataclass(frozen=True, eq=False)
class Toroid:
    """A circular meridian, walked from the lower solid to the upper.

    Attributes
    ----------
    low, high : (r, z) of its ends; turn : half its turning angle, positive where it bulges.
    """

    low: tuple[float, float]
    high: tuple[float, float]
    turn: float

    @property
    def length(self) -> float:
        chord = float(np.hypot(self.high[0] - self.low[0], self.high[1] - self.low[1]))
        return chord / float(np.sinc(self.turn / np.pi))

    def __call__(self, fraction: Array) -> tuple[Array, Array, Array]:
        """``r, z`` and the slope of r at fractions of its length."""
        r0, z0 = (np.array(x) for x in self.low)
        r1, z1 = (np.array(x) for x in self.high)
        r, z = on_arc(r0, z0, r1, z1, np.array(self.turn), fraction)
        across, up = r1 - r0, z1 - z0
        back = self.turn * (1.0 - 2.0 * np.asarray(fraction))
        slope = (across * np.cos(back) + up * np.sin(back)) / np.sinc(self.turn / np.pi)
        return r, z, slope


def on_arc(
    r0: Array, z0: Array, r1: Array, z1: Array, turn: Array, fraction: Array
) -> tuple[Array, Array]:
    """Points ``r, z`` (..., k) of arcs at fractions (k,) of their length."""
    half = turn[..., None]
    off = half * (2.0 * fraction - 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = 0.5 * (
            1.0 + np.where(half == 0.0, 2.0 * fraction - 1.0, np.sin(off) / np.sin(half))
        )
        out = np.where(half == 0.0, 0.0, 0.5 * (np.cos(off) - np.cos(half)) / np.sin(half))
    across, up = (r1 - r0)[..., None], (z1 - z0)[..., None]
    return r0[..., None] + along * across + out * up, z0[..., None] + along * up - out * across


def least_energy_toroid(low: End, high: End, volume: float) -> Toroid:
    """The toroid of a volume with the least energy, tension 1 and no weight.

    Parameters
    ----------
    low, high : solids below and above, apart from each other.

    Notes
    -----
    It is a valley of the energy over the two circles, as a narrow circle belongs to a droplet that
    has left a solid; where there is none, the toroid nearest to balance.
    """
    widest = _widest(low, high, WIDER * volume)
    one, two = low.ways(widest), high.ways(widest)
    energy, turn = _energies(low, high, one, two, volume)
    objective = _valleys(energy)
    steady = bool(np.isfinite(objective).any())
    if not steady:
        objective = _mismatch(energy, one, two)
    best = np.unravel_index(objective.argmin(), energy.shape)
    for _ in range(ZOOMS):
        one, two = _around(one, int(best[0])), _around(two, int(best[1]))
        energy, turn = _energies(low, high, one, two, volume)
        objective = energy if steady else _mismatch(energy, one, two)
        best = np.unravel_index(objective.argmin(), energy.shape)
    a, b = one[best[0]], two[best[1]]
    return Toroid(
        (float(low.circle(a)[0]), float(low.height(a))),
        (float(high.circle(b)[0]), float(high.height(b))),
        float(turn[best]),
    )


def _valleys(energy: Array) -> Array:
    """Energies where they are lower than at all eight neighbours on a grid, else infinite: on the
    grid's rim the liquid has left a solid."""
    middle = energy[1:-1, 1:-1]
    one, two = (range(n - 2) for n in energy.shape)
    around = [
        energy[i : i + len(one), j : j + len(two)]
        for i in range(3)
        for j in range(3)
        if (i, j) != (1, 1)
    ]
    lowest = np.isfinite(middle) & (middle <= np.min(around, axis=0))
    return np.pad(np.where(lowest, middle, np.inf), 1, constant_values=np.inf)


def _mismatch(energy: Array, one: Array, two: Array) -> Array:
    """How far energies are from balance at both circles: squares of their slopes per wetted area,
    differences of cosines; infinite where a neighbour is none."""
    with np.errstate(invalid="ignore"):
        slopes = np.gradient(energy, one, two)
    off = (slopes[0] / one[:, None]) ** 2 + (slopes[1] / two) ** 2
    return np.where(np.isfinite(off), off, np.inf)


def _around(ways: Array, k: int) -> Array:
    return np.linspace(ways[max(k - 1, 0)], ways[min(k + 1, len(ways) - 1)], GRID)


def _widest(low: End, high: End, volume: float) -> float:
    """Way to circles inside which the gap between the solids holds a volume."""
    short, far = 0.0, 1.0

    def gap(way: float) -> float:
        ends = [np.array(min(way, 0.5 * np.pi * end.radius)) for end in (low, high)]
        height = float(high.height(ends[1]) - low.height(ends[0]))
        r = min(float(low.circle(ends[0])[0]), float(high.circle(ends[1])[0]))
        return np.pi * r**2 * height

    limit = max(end.radius if np.isfinite(end.radius) else 0.0 for end in (low, high)) or 1e3
    while gap(far) < volume and far < np.pi * limit:
        far *= 2.0
    for _ in range(30):
        middle = 0.5 * (short + far)
        short, far = (middle, far) if gap(middle) < volume else (short, middle)
    return far


def _energies(low: End, high: End, one: Array, two: Array, volume: float) -> tuple[Array, Array]:
    """Energies (a, b) of circles at the ways (a,) and (b,), infinite where there is no such toroid,
    and half turns."""
    one, two = one[:, None], two[None, :]
    (r0, _), (r1, _) = low.circle(one), high.circle(two)
    z0, z1 = low.height(one), high.height(two)
    across, up = r1 - r0, z1 - z0
    chord, mean = np.hypot(across, up), 0.5 * (r0 + r1)
    (wet0, under0), (wet1, under1) = low.cap(one), high.cap(two)
    missing = volume + under0 + under1 - np.pi / 3.0 * up * (r0**2 + r0 * r1 + r1**2)

    def bulged(turn: Array) -> Array:
        a, b = _segment(turn)
        return 2.0 * np.pi * chord**2 * (mean * a + up * b)

    least, most = np.full(chord.shape, -MOST), np.full(chord.shape, MOST)
    for _ in range(40):
        turn = 0.5 * (least + most)
        more = bulged(turn) < missing
        least, most = np.where(more, turn, least), np.where(more, most, turn)
    longer = 1.0 / np.sinc(turn / np.pi)
    with np.errstate(divide="ignore", invalid="ignore"):
        out = np.where(np.abs(turn) < 1e-4, turn / 6.0, 0.5 * (1.0 / turn - 1.0 / np.tan(turn)))
    area = 2.0 * np.pi * chord * longer * (mean + up * out)
    energy = area - np.cos(np.radians(low.contact_angle)) * wet0
    energy = energy - np.cos(np.radians(high.contact_angle)) * wet1
    s = (np.arange(SEEN) + 0.5) / SEEN
    r0, z0, r1, z1 = np.broadcast_arrays(r0, z0, r1, z1)
    r, z = on_arc(r0, z0, r1, z1, turn, s)
    fits = (low.clear(r, z) & high.clear(r, z) & (r > 0.0)).all(axis=-1)
    fits &= np.abs(bulged(turn) - missing) < 1e-6 * volume
    return np.where(fits, energy, np.inf), turn


def _segment(turn: Array) -> tuple[Array, Array]:
    """Area of a circular segment over its chord squared, and its moment about the chord over the
    chord cubed, by half its turn."""
    small = np.abs(turn) < 1e-3
    w = np.where(small, 1.0, turn)
    a = (2.0 * w - np.sin(2.0 * w)) / (8.0 * np.sin(w) ** 2)
    b = 1.0 / 12.0 - 0.5 * a / np.tan(w)
    return np.where(small, turn / 6.0, a), np.where(small, turn**2 / 60.0, b)
