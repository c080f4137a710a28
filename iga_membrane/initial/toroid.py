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
from ..solids.disc import Disc

FLATTEST = 6.0
"""Contact angle of the start at least, degrees: a nearly tangent line finds its place from larger
angles, which halve with every step of Newton's method, and not from smaller ones."""
WIDEST = np.radians(175.0)
"""Polar angle of a circle on a sphere at most."""
GRID, ZOOMS = 49, 2
"""Turns and slants tried, an odd number, so that between equal solids the chord is upright, and how
often again around the best pair, at last within 0.01 degrees: bridges 1e-3 as high as they are wide
then take two iterations."""
NONE = 1e-6
"""Way to a circle over the widest at which there is none."""
STEEPEST = 1.5
"""Slant of a chord at most, radians."""
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
    contact_angle : degrees, of the start; rim : radius of the circle, where one holds it, else 0.
    """

    radius: float
    level: float
    side: float
    contact_angle: float
    rim: float = 0.0

    @classmethod
    def of(cls, solid: Plane | Sphere, side: float) -> End:
        """Of a solid in the scene's scale."""
        angle = max(solid.contact_angle, FLATTEST)
        if isinstance(solid, Disc):
            return cls(np.inf, solid.point[2], side, angle, solid.radius)
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
    It is a valley of the energy over the turn of the arc and the slant of its chord; where there is
    none, the toroid nearest to balance. The volume then tells where the circles are, those of a
    flat bridge to a small part of its height.
    """
    if low.rim and high.rim:
        return _between_rims(low, high, volume)
    turns: Array = np.linspace(-MOST, MOST, GRID)
    slants: Array = np.linspace(-STEEPEST, STEEPEST, GRID)
    steady = True
    for zoom in range(1 + ZOOMS):
        energy, one, two = _energies(low, high, turns, slants, volume)
        objective = _valleys(energy)
        found = bool(np.isfinite(objective).any())
        steady = steady if zoom else found
        if not steady:
            objective = _mismatch(energy, one, two)
        elif not found:
            objective = np.where(np.isfinite(energy), energy, np.inf)
        i, k = np.unravel_index(objective.argmin(), energy.shape)
        a, b, turn = one[i, k], two[i, k], float(turns[i])
        turns, slants = _around(turns, int(i)), _around(slants, int(k))
    return Toroid(
        (float(low.circle(a)[0]), float(low.height(a))),
        (float(high.circle(b)[0]), float(high.height(b))),
        turn,
    )


def _between_rims(low: End, high: End, volume: float) -> Toroid:
    """The toroid of a volume between two circles."""
    one, two = np.array(low.rim), np.array(high.rim)
    least, most = -MOST, MOST
    for _ in range(60):
        turn = 0.5 * (least + most)
        more = float(_volume(low, high, one, two, np.array(turn))) < volume
        least, most = (turn, most) if more else (least, turn)
    return Toroid((low.rim, low.level), (high.rim, high.level), 0.5 * (least + most))


def _volume(low: End, high: End, one: Array, two: Array, turn: Array) -> Array:
    """Of the liquid between circles at ways from the axis, by half the turn of the arc."""
    bulge, tilt = _segment(turn)
    (r0, _), (r1, _) = low.circle(one), high.circle(two)
    across, up = r1 - r0, high.height(two) - low.height(one)
    frustum = np.pi / 3.0 * up * (r0**2 + r0 * r1 + r1**2) - low.cap(one)[1] - high.cap(two)[1]
    square = across**2 + up**2
    return frustum + 2.0 * np.pi * square * (0.5 * (r0 + r1) * bulge + up * tilt)


def _valleys(energy: Array) -> Array:
    """Energies where they are lower than at all eight neighbours on a grid, else infinite."""
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
    """How far energies are from balance at both circles, whose ways are given: squares of their
    slopes per wetted area, differences of cosines; infinite where a neighbour is none."""
    with np.errstate(invalid="ignore", divide="ignore"):
        (e0, e1), (a0, a1), (b0, b1) = (np.gradient(each) for each in (energy, one, two))
        both = a0 * b1 - a1 * b0
        off = ((e0 * b1 - e1 * b0) / (both * one)) ** 2 + ((e1 * a0 - e0 * a1) / (both * two)) ** 2
    return np.where(np.isfinite(off), off, np.inf)


def _around(values: Array, k: int) -> Array:
    return np.linspace(values[max(k - 1, 0)], values[min(k + 1, len(values) - 1)], GRID)


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


def _energies(
    low: End, high: End, turns: Array, slants: Array, volume: float
) -> tuple[Array, Array, Array]:
    """Energies (a, b) of toroids of turns (a,) and slants (b,) of the chord, infinite where there
    is none of the volume, minus infinity where it leaves or swallows a solid; and the ways to
    their circles."""
    turn, slope = np.broadcast_arrays(turns[:, None], np.tan(slants))
    apart = high.level - low.level
    curved = 0.5 * (1.0 / low.radius + 1.0 / high.radius)
    most = max(_widest(low, high, WIDER * volume), low.rim, high.rim)

    def circles(way: Array) -> tuple[Array, Array]:
        """Ways whose mean is given; of the height between the circles the slant makes their
        difference."""
        off = 0.5 * slope * (apart + curved * way**2)
        ends = [(way - off, low.radius), (way + off, high.radius)]
        one, two = (np.clip(w, NONE * most, min(WIDEST * r, most)) for w, r in ends)
        return np.where(low.rim, low.rim, one), np.where(high.rim, high.rim, two)

    short: Array = np.zeros(turn.shape)
    far: Array = np.full(turn.shape, most)
    for _ in range(45):
        middle = 0.5 * (short + far)
        less = _volume(low, high, *circles(middle), turn) < volume
        short, far = np.where(less, middle, short), np.where(less, far, middle)
    one, two = circles(0.5 * (short + far))
    (r0, _), (r1, _) = low.circle(one), high.circle(two)
    z0, z1 = low.height(one), high.height(two)
    across, up = r1 - r0, z1 - z0
    chord, mean = np.hypot(across, up), 0.5 * (r0 + r1)
    longer = 1.0 / np.sinc(turn / np.pi)
    with np.errstate(divide="ignore", invalid="ignore"):
        out = np.where(np.abs(turn) < 1e-4, turn / 6.0, 0.5 * (1.0 / turn - 1.0 / np.tan(turn)))
    area = 2.0 * np.pi * chord * longer * (mean + up * out)
    energy = area - np.cos(np.radians(low.contact_angle)) * low.cap(one)[0]
    energy = energy - np.cos(np.radians(high.contact_angle)) * high.cap(two)[0]
    s = (np.arange(SEEN) + 0.5) / SEEN
    r, z = on_arc(r0, z0, r1, z1, turn, s)
    fits = (low.clear(r, z) & high.clear(r, z) & (r > 0.0)).all(axis=-1)
    fits &= np.abs(_volume(low, high, one, two, turn) - volume) < 1e-6 * volume
    # the liquid has left a solid, or swallowed it: no valley is beside that
    ends = (one, low.radius), (two, high.radius)
    gone = [(way <= NONE * most) | (way >= WIDEST * r) for way, r in ends]
    return np.where(gone[0] | gone[1], -np.inf, np.where(fits, energy, np.inf)), one, two


def _segment(turn: Array) -> tuple[Array, Array]:
    """Area of a circular segment over its chord squared, and its moment about the chord over the
    chord cubed, by half its turn."""
    small = np.abs(turn) < 1e-3
    w = np.where(small, 1.0, turn)
    a = (2.0 * w - np.sin(2.0 * w)) / (8.0 * np.sin(w) ** 2)
    b = 1.0 / 12.0 - 0.5 * a / np.tan(w)
    return np.where(small, turn / 6.0, a), np.where(small, turn**2 / 60.0, b)
