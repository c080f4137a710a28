"""The meridian of an axisymmetric surface of constant tension under gravity, from its apex."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array
from ..overview import brief_repr

Event = Callable[[float, Any], float]


def rates(turn: float, r: float, depth: float, pressure: float, weight: float) -> list[float]:
    """``r' = cos(turn), depth' = sin(turn), turn' = p + w depth - sin(turn) / r`` by arc length.

    Parameters
    ----------
    pressure, weight : at the apex and its rise with depth, over the tension.
    """
    around = np.sin(turn) / r if r > 0 else 0.5 * pressure
    return [np.cos(turn), np.sin(turn), pressure + weight * depth - around]


def stops(depth: float, level: float) -> list[Event]:
    """Where a meridian ends: at a depth, where it closes, or where it has come to lie level."""

    def deep(s: float, y: Any) -> float:
        return float(y[1] - depth)

    def closed(s: float, y: Any) -> float:
        return float(np.pi - y[2])

    def flat(s: float, y: Any) -> float:
        return float(y[2] - level)

    events = [deep, closed, flat]
    for event in events:
        event.terminal = True  # type: ignore[attr-defined]
    return list(events)


@dataclass(frozen=True, eq=False)
class Meridian:
    """A meridian whose radius of curvature at the apex is 1.

    Attributes
    ----------
    bond : weight per volume over the tension, > 0 where the liquid sits on its base, < 0 where it
        hangs.
    s, r, depth, turn, volume : (k,) arc length, distance from the axis, depth below the apex,
        inclination (radians), volume above.
    by_bond : (4, k) derivatives of the last four by ``bond`` at the same arc length.
    """

    bond: float
    s: Array
    r: Array
    depth: Array
    turn: Array
    volume: Array
    by_bond: Array

    __repr__ = brief_repr

    @cached_property
    def bend(self) -> Array:
        """(k,) rate of the inclination."""
        return np.asarray(2.0 + self.bond * self.depth - np.sin(self.turn) / self.r)


SAMPLES = 1200
"""Points of a meridian: of a droplet 250 pixels wide every half pixel."""
FIRST = 1e-4
"""Length from the apex at which a meridian begins, over its radius there: the sphere that stands
for it so far is right to its square."""


def meridian(bond: float, depth: float) -> Meridian:
    """The meridian down to a depth, or to where its inclination is a straight angle again.

    Parameters
    ----------
    bond : see :class:`Meridian`.
    depth : over the radius of curvature at the apex.
    """
    from scipy.integrate import solve_ivp

    def slope(s: float, y: Any) -> list[float]:
        r, d, turn, _, r_b, d_b, turn_b, _ = y
        along, down, bend = rates(turn, r, d, 2.0, bond)
        bend_b = d + bond * d_b - along / r * turn_b + down / r**2 * r_b
        disc = np.pi * r * r * down
        disc_b = 2.0 * np.pi * r * down * r_b + np.pi * r * r * along * turn_b
        return [along, down, bend, disc, -down * turn_b, along * turn_b, bend_b, disc_b]

    ends = stops(depth, 0.0)
    start = [FIRST, 0.5 * FIRST**2, FIRST, 0.25 * np.pi * FIRST**4, 0.0, 0.0, 0.125 * FIRST**3, 0.0]
    found = solve_ivp(slope, (FIRST, 4.0 * depth + 8.0), start, method="DOP853", events=ends,
                      rtol=1e-9, atol=1e-12, dense_output=True)  # fmt: skip
    s = np.linspace(FIRST, found.t[-1], SAMPLES)
    r, d, turn, volume, *by_bond = found.sol(s)
    return Meridian(bond, s, r, d, turn, volume, np.array(by_bond))
