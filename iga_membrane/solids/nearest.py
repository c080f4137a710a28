"""What every solid knows of a point: its nearest surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import Array, Index


@dataclass(frozen=True, eq=False)
class Nearest:
    """Nearest surface of a solid at points (...).

    Attributes
    ----------
    gap : (...) distance to it, positive outside: paper eq. (24).
    normal : (..., 3) gradient of the gap, out of the solid: eq. (27).
    bend : (...) the gap's Hessian is ``bend (1 - n n)``: one over the distance from the centre.
    which : (...) number of the sphere, -1 for a plane.
    """

    gap: Array
    normal: Array
    bend: Array
    which: Index


class Solid(Protocol):
    """Something that a membrane cannot enter."""

    @property
    def scale(self) -> float:
        """Length over which contact changes."""

    def nearest(self, points: Array) -> Nearest:
        """Gap and its derivatives at points (..., 3)."""

    def center_of(self, which: Index) -> Array:
        """(..., 3) centres of spheres by their numbers."""

    def radius_of(self, which: Index) -> Array:
        """(...) radii of spheres by their numbers."""


class Asperities(Solid, Protocol):
    """Many spheres."""

    def within(self, reach: float) -> Index:
        """Numbers of the spheres whose centres lie within a distance of the z axis."""


def nearest_of_balls(points: Array, centers: Array, radii: Array, which: Index) -> Nearest:
    """Nearest surface where it is known which ball (..., 3), (...) is nearest."""
    away = points - centers
    distance = np.sqrt(np.einsum("...i,...i->...", away, away))
    with np.errstate(invalid="ignore", divide="ignore"):
        normal, bend = away / distance[..., None], 1.0 / distance
    return Nearest(distance - radii, normal, bend, which)


def closer(first: Nearest, second: Nearest) -> Nearest:
    """The nearer of two surfaces at each point."""
    wins = second.gap < first.gap
    return Nearest(
        np.where(wins, second.gap, first.gap),
        np.where(wins[..., None], second.normal, first.normal),
        np.where(wins, second.bend, first.bend),
        np.where(wins, second.which, first.which),
    )
