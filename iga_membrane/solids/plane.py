"""A flat substrate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..checks import contact_angle, vector
from ..errors import SceneError


@dataclass(frozen=True)
class Plane:
    """Half space below a plane.

    Attributes
    ----------
    contact_angle : Young's angle in degrees, through the liquid, 0 < angle <= 180.
    point : a point of the plane.
    normal : out of the solid, any length > 0.
    """

    contact_angle: float
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "contact_angle", contact_angle("substrate.contact_angle", self.contact_angle)
        )
        object.__setattr__(self, "point", vector("substrate.point", self.point))
        object.__setattr__(self, "normal", vector("substrate.normal", self.normal))
        if not np.abs(self.normal).max() > 0:
            raise SceneError(f"substrate.normal = {self.normal}: must not be zero")

    def unit_normal(self) -> Array:
        """(3,) unit normal."""
        n = np.asarray(self.normal, float) / np.abs(self.normal).max()
        return np.asarray(n / np.linalg.norm(n))

    def axes(self) -> Array:
        """(3, 3) rotation whose columns are two axes in the plane and its normal."""
        n = self.unit_normal()
        if n[2] > 1 - 1e-15:
            return np.eye(3)
        helper = np.eye(3)[np.argmin(np.abs(n))]
        first = np.cross(helper, n)
        first /= np.linalg.norm(first)
        return np.stack([first, np.cross(n, first), n], axis=1)

    def gap(self, points: ArrayLike) -> Array:
        """Distance above the plane of points (..., 3); positive in the gas (paper eq. 24)."""
        return np.asarray((np.asarray(points, float) - self.point) @ self.unit_normal())
