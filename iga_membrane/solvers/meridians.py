"""Meridians of a ring patch, walked by arc length again while an iteration distorts them."""

from __future__ import annotations

import numpy as np

from ..splines import Grading
from ..surface.reparametrize import distortion, regridded
from ..surface.surface import Surface

POLISHES = 2
"""Walks by arc length after the steps have become small; each costs one or two iterations."""
POLISHED = 1e-6
"""Distortion that a last walk leaves alone."""
UNEVEN, FALLING = 1e-3, 0.3
"""Distortion of a converged state that is mended and the iteration begun again, and over that of
the time before at most: contact lines that are nearly tangent to their solid slide far along it,
and find their place on an even mesh only."""
DISTORTED = 0.2
"""Distortion that is mended at once, also while steps are large."""


class Meridians:
    """When meridians are walked again.

    Parameters
    ----------
    grading : of the arc length, or None to leave the parametrization alone.
    small : steps below which a last walk follows.
    """

    def __init__(self, grading: Grading | None, small: float) -> None:
        self._grading, self._small = grading, small
        self._left, self._uneven = POLISHES, np.inf

    def of_converged(self, surface: Surface) -> Surface | None:
        """The mended surface of a state that has converged, from which to begin again; None where
        it is even enough, or does not become more even."""
        if self._grading is None:
            return None
        twist = distortion(surface, self._grading)
        if not UNEVEN < twist <= FALLING * self._uneven:
            return None
        self._uneven, self._left = twist, POLISHES
        return regridded(surface, self._grading)

    def after(self, surface: Surface, step: float) -> Surface:
        """The surface after a step of a size."""
        if self._grading is None or not self._left:
            return surface
        small = step <= self._small
        if distortion(surface, self._grading) <= (POLISHED if small else DISTORTED):
            return surface
        self._left -= small
        return regridded(surface, self._grading)
