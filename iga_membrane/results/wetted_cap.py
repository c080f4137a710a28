"""The wetted cap of a sphere, seen from its contact line alone: areas and integrals over it.

With ``X`` from the centre C the cone from C to the line cuts a sector S out of the ball. Integrals
over S and the cone, whose area vector is ``X x X' ds / 2``, give those over the cap W.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..solids import Sphere
from ..terms import BodyDensity
from .contact_line import ContactLine


@dataclass(frozen=True, eq=False)
class WettedCap:
    """Inside a line that runs counterclockwise about an axis.

    Attributes
    ----------
    line : whole, on the sphere.
    sphere : in the line's coordinates.
    axis : unit vector from the centre to the liquid.
    """

    line: ContactLine
    sphere: Sphere
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)

    @property
    def _away(self) -> Array:
        return np.asarray(self.line.position - np.array(self.sphere.center))

    @property
    def _twice_cone(self) -> Array:
        """(k, 3) twice the area vectors of the cone at the line's points."""
        return np.asarray(np.cross(self._away, self.line.tangent) * self.line.arc[:, None])

    @property
    def polar(self) -> float:
        """Mean angle of the line from the axis."""
        along = self._away @ np.array(self.axis)
        across = np.linalg.norm(np.cross(self._away, np.array(self.axis)), axis=1)
        return float(np.arctan2(across, along) @ self.line.arc / self.line.arc.sum())

    @property
    def apex(self) -> Array:
        """(3,) centroid of the line."""
        return np.asarray(self.line.arc @ self.line.position / self.line.arc.sum())

    @property
    def area(self) -> float:
        """``r^2 oint a . (X x dX) / (|X| (|X| + a . X))``."""
        axis, size = np.array(self.axis), np.linalg.norm(self._away, axis=1)
        turn = self._twice_cone @ axis
        return float(self.sphere.radius**2 * (turn / (size * (size + self._away @ axis))).sum())

    def push(self, body: BodyDensity) -> Array:
        """(3,) ``int_W e n dA``, the pull of a body density on the sphere: ``int_S grad(e) dV``
        less ``e`` on the cone."""
        slope = np.array(body.gradient)
        at_center = body.constant + float(slope @ np.array(self.sphere.center))
        cone = (at_center / 2.0 + self._away @ slope / 3.0) @ self._twice_cone
        return np.asarray(slope * self.sphere.radius * self.area / 3.0 + cone)

    @property
    def volume_over_cone(self) -> float:
        """Between the cap and the cone from its line to the line's centroid."""
        vector = 0.5 * self._twice_cone.sum(axis=0)
        shift = np.array(self.sphere.center) - self.apex
        return float(self.sphere.radius * self.area + shift @ vector) / 3.0
