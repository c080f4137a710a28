"""A flat substrate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import direction, either, instance, wet_angle
from .fan import Fan, chart_fan
from .hysteresis import Hysteresis
from .nearest import Nearest
from .wettability import Field, varies


@dataclass(frozen=True)
@checked(
    "substrate", contact_angle=either(wet_angle, instance(Field, Hysteresis)), normal=direction
)
class Plane:
    """Half space below a plane.

    Attributes
    ----------
    contact_angle : Young's angle in degrees, through the liquid, 0 < angle <= 180; 0, perfectly
        wet, only where a liquid bridges two solids; or, under a droplet, a :class:`.Wettability` or
        a :class:`.Hysteresis`.
    point : a point of the plane.
    normal : out of the solid, any length > 0.
    """

    contact_angle: Any
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def unit_normal(self) -> Array:
        """(3,) unit normal."""
        n = np.asarray(self.normal, float) / np.abs(self.normal).max()
        return np.asarray(n / np.linalg.norm(n))

    def axes(self) -> Array:
        """(3, 3) rotation whose columns are two axes in the plane and its normal: the world's axes
        turned by the smallest rotation that takes z to the normal; downwards, about x.

        Notes
        -----
        With the horizontal part h of the normal n it is the identity but for ``-h h / (1 + n_z)``
        in the first two rows and columns, ``-h`` in the third row and n in the third column
        (Rodrigues' formula).
        """
        n = self.unit_normal()
        aside = n[:2]
        size = float(aside @ aside)
        if not size:
            return np.diag([1.0, n[2], n[2]])
        axes = np.eye(3)
        # 1 / (1 + n_z), without cancellation near n_z = -1
        share = 1.0 / (1.0 + n[2]) if n[2] > 0.0 else (1.0 - n[2]) / size
        axes[:2, :2] -= share * np.outer(aside, aside)
        axes[2, :2], axes[:, 2] = -aside, n
        return axes

    def gap(self, points: ArrayLike) -> Array:
        """Distance above the plane of points (..., 3); positive in the gas (paper eq. 24)."""
        return np.asarray((np.asarray(points, float) - self.point) @ self.unit_normal())

    def nearest(self, points: Array) -> Nearest:
        """Gap and its derivatives; a plane has number -1."""
        normal = np.broadcast_to(self.unit_normal(), points.shape)
        shape = points.shape[:-1]
        return Nearest.computed(self.gap(points), normal, np.zeros(shape), np.full(shape, -1))

    def fan(self, points: Array, tangents: Array) -> Fan:
        """Straight lines from its ``point`` to contact lines on it."""
        axes = self.axes()

        def place(chart: Array) -> tuple[Array, Array, Array]:
            x = np.array(self.point) + chart @ axes[:, :2].T
            return x, np.broadcast_to(axes[:, 2], x.shape), np.ones(x.shape[:-1])

        ends = (points - self.point) @ axes[:, :2]
        width = self.contact_angle.width if varies(self.contact_angle) else np.inf
        return chart_fan(place, ends, tangents @ axes[:, :2], width)

    @property
    def scale(self) -> float:
        """Length over which contact changes: a plane has none, so that of the scene."""
        return 1.0

    def center_of(self, which: Index) -> Array:
        """A plane has no centre: not a number."""
        return np.full((*np.shape(which), 3), np.nan)

    def radius_of(self, which: Index) -> Array:
        """(...) infinite."""
        return np.full(np.shape(which), np.inf)
