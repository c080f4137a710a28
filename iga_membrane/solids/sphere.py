"""A spherical substrate, asperity or particle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import wet_angle
from ..errors import GeometryError
from .nearest import Nearest, nearest_of_balls


@dataclass(frozen=True)
@checked("substrate", contact_angle=wet_angle, density="particle.density", motion="particle.motion")
class Sphere:
    """Solid ball.

    Attributes
    ----------
    contact_angle : Young's angle in degrees, through the liquid, 0 < angle <= 180; 0, perfectly
        wet, only where a liquid bridges two solids.
    radius : > 0.
    center : its centre.
    density : of the solid, >= 0; the weight of a particle.
    motion : how a particle moves until the force along its way vanishes: "fixed", "vertical",
        "normal" to the liquid's surface, or "resting" on the substrate unless it is lifted.
    """

    contact_angle: float
    radius: float
    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    density: float = 0.0
    motion: str = "fixed"

    def offset(self, points: ArrayLike) -> tuple[Array, Array]:
        """Vectors from the centre to points (..., 3) and their lengths."""
        away = np.asarray(points) - np.array(self.center)
        return away, np.sqrt(np.einsum("...i,...i->...", away, away))

    def gap(self, points: ArrayLike) -> Array:
        """Distance to the surface of points (..., 3), positive outside: paper eq. (24)."""
        return np.asarray(self.offset(points)[1] - self.radius)

    def normal(self, points: ArrayLike) -> Array:
        """(..., 3) gradient of the gap, out of the solid: paper eq. (27).

        Raises
        ------
        GeometryError
            At the centre, where there is no normal.
        """
        away, distance = self.offset(points)
        if np.any(distance == 0.0):
            raise GeometryError(
                f"a point of the membrane lies at the centre {self.center} of a sphere: no "
                "direction leads out of it"
            )
        return np.asarray(away / distance[..., None])

    def gap_hessian(self, points: ArrayLike) -> Array:
        """(..., 3, 3) second derivative of the gap, ``(1 - n n) / distance``."""
        normal = self.normal(points)
        distance = self.offset(points)[1][..., None, None]
        return np.asarray((np.eye(3) - normal[..., :, None] * normal[..., None, :]) / distance)

    def closest_point(self, points: ArrayLike) -> Array:
        """(..., 3) projection onto the surface: paper eq. (28)."""
        return np.asarray(np.array(self.center) + self.radius * self.normal(points))

    def nearest(self, points: Array) -> Nearest:
        """Gap and its derivatives; the sphere has number 0."""
        which = np.zeros(points.shape[:-1], int)
        return nearest_of_balls(points, np.array(self.center), np.asarray(self.radius), which)

    @property
    def scale(self) -> float:
        """Length over which contact changes."""
        return self.radius

    def center_of(self, which: Index) -> Array:
        """(..., 3) its centre."""
        return np.broadcast_to(np.array(self.center), (*np.shape(which), 3))

    def radius_of(self, which: Index) -> Array:
        """(...) its radius."""
        return np.full(np.shape(which), self.radius)
