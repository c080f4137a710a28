"""What every solid knows of a point: its nearest surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol, runtime_checkable

import numpy as np

from ..arguments import checked
from ..arrays import Array, Index, Mask
from ..checks import ndarray
from ..overview import brief_repr


@dataclass(frozen=True, eq=False)
@checked(
    normal=partial(ndarray, shape=(3,)),
    ridge=partial(ndarray, shape=(3,)),
    turn=partial(ndarray, shape=(3, 3)),
)
class Nearest:
    """Nearest surface of a solid at points (...).

    Attributes
    ----------
    gap : (...) distance to it, positive outside: paper eq. (24).
    normal : (..., 3) gradient of the gap, out of the solid: eq. (27).
    bend : (...) the smaller principal curvature of the surface through the point that has the same
        gap everywhere: 0 over a plane, one over the distance from the centre of a sphere.
    which : (...) number of the body (sphere, pillar) that is nearest, -1 for a plane.
    ridge : (..., 3) or None where both curvatures are the same: a vector along the direction of the
        larger one, whose squared length is their difference. The gap's Hessian is
        ``bend (1 - n n) + ridge ridge``.
    turn : (..., 3, 3) or None: the derivative of the normal by the place (last axis), where the gap
        is a level that is no distance, 0 on the surface only; it need not be symmetric, and
        ``bend`` and ``ridge`` do not count then. Contact lines need no more.
    """

    gap: Array
    normal: Array
    bend: Array
    which: Index
    ridge: Array | None = None
    turn: Array | None = None

    __repr__ = brief_repr

    @classmethod
    def computed(
        cls,
        gap: Array,
        normal: Array,
        bend: Array,
        which: Index,
        ridge: Array | None = None,
        turn: Array | None = None,
    ) -> Nearest:
        """What this package has computed itself: made in the innermost loops, it is not checked."""
        found = object.__new__(cls)
        vars(found).update(gap=gap, normal=normal, bend=bend, which=which, ridge=ridge, turn=turn)
        return found

    def part(self, some: Mask) -> Nearest:
        """At some of the points."""
        ridge = None if self.ridge is None else self.ridge[some]
        turn = None if self.turn is None else self.turn[some]
        return Nearest.computed(
            self.gap[some], self.normal[some], self.bend[some], self.which[some], ridge, turn
        )

    def turned(self, ways: Array) -> Array:
        """(..., k, 3) change of the normal along any number of vectors (..., k, 3) at each
        point."""
        if self.turn is not None:
            return np.asarray(ways @ np.swapaxes(self.turn, -1, -2))
        n, bend = self.normal[..., None, :], self.bend[..., None, None]
        found = bend * (ways - n * (ways * n).sum(axis=-1, keepdims=True))
        if self.ridge is None:
            return np.asarray(found)
        v = self.ridge[..., None, :]
        return np.asarray(found + v * (ways * v).sum(axis=-1, keepdims=True))

    def hessian(self) -> Array:
        """(..., 3, 3) derivative of the normal, of a distance the second one of the gap."""
        if self.turn is not None:
            return self.turn
        n, v = self.normal, self.ridge
        across = np.eye(3) - n[..., :, None] * n[..., None, :]
        found = self.bend[..., None, None] * across
        return np.asarray(found if v is None else found + v[..., :, None] * v[..., None, :])


@runtime_checkable
class Solid(Protocol):
    """Something that a membrane cannot enter: what an own substrate must answer.

    All lengths are in the user's units, all points in world coordinates.
    """

    @property
    def contact_angle(self) -> Any:
        """Young's angle in degrees through the liquid; one, one for each body, or a
        :class:`.wettability.Wettability`."""

    @property
    def scale(self) -> float:
        """Length over which contact changes, as the radius of an asperity. The default mesh has
        about three elements along it."""

    def nearest(self, points: Array) -> Nearest:
        """Gap and its derivatives at points (..., 3)."""

    def center_of(self, which: Index) -> Array:
        """(..., 3) a point inside each body, by their numbers: the centres of spheres."""

    def radius_of(self, which: Index) -> Array:
        """(...) radii of spheres by their numbers; infinite for other bodies."""


class Asperities(Solid, Protocol):
    """Many spheres."""

    def angle_of(self, which: Index) -> Array:
        """(...) contact angles in degrees of spheres by their numbers."""

    def within(self, reach: float) -> Index:
        """Numbers of the spheres whose centres lie within a distance of the z axis."""


def nearest_of_balls(points: Array, centers: Array, radii: Array, which: Index) -> Nearest:
    """Nearest surface where it is known which ball (..., 3), (...) is nearest."""
    away = points - centers
    distance = np.sqrt(np.einsum("...i,...i->...", away, away))
    with np.errstate(invalid="ignore", divide="ignore"):
        normal, bend = away / distance[..., None], 1.0 / distance
    return Nearest.computed(distance - radii, normal, bend, which)


def closer(first: Nearest, second: Nearest) -> Nearest:
    """The nearer of two surfaces at each point."""
    wins = second.gap < first.gap
    return Nearest.computed(
        np.where(wins, second.gap, first.gap),
        np.where(wins[..., None], second.normal, first.normal),
        np.where(wins, second.bend, first.bend),
        np.where(wins, second.which, first.which),
        _ridge(wins, first, second),
    )


def _ridge(wins: Mask, first: Nearest, second: Nearest) -> Array | None:
    if first.ridge is None and second.ridge is None:
        return None
    none = np.zeros_like(first.normal)
    one, two = (none if each.ridge is None else each.ridge for each in (first, second))
    return np.where(wins[..., None], two, one)
