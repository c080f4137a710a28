"""Contact at one state, point by point."""

from __future__ import annotations

from dataclasses import dataclass

from ..arrays import Array
from ..solids import Nearest


@dataclass(frozen=True, eq=False)
class Touch:
    """Contact at one state.

    Attributes
    ----------
    at : nearest surfaces at the contact points (elements, points).
    traction : (elements, points) pressure of the solid on the membrane, per reference area.
    gain : (elements, points) part of the adhesion that is gained; pull, rise : its first and second
        derivative by the gap, times the adhesion.
    """

    at: Nearest
    traction: Array
    gain: Array
    pull: Array
    rise: Array
