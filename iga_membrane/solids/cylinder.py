"""A fibre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import contact_angle, direction, either, instance
from .fan import Fan, chart_fan
from .nearest import Nearest
from .wettability import Field, varies


@dataclass(frozen=True)
@checked("substrate", contact_angle=either(contact_angle, instance(Field)), axis=direction)
class Cylinder:
    """Round solid cylinder without ends, on which a droplet sits to one side (a clamshell).

    Attributes
    ----------
    contact_angle : Young's angle in degrees, through the liquid; or a :class:`.Wettability`.
    radius : > 0.
    point : a point of its axis; by default its top line passes through the origin.
    axis : its direction, any length > 0, not vertical.
    """

    contact_angle: Any
    radius: float
    point: tuple[float, float, float] | None = None
    axis: tuple[float, float, float] = (0.0, 1.0, 0.0)

    def described(self) -> dict[str, Any]:
        """By the names of the scene file, but for the contact angle."""
        return {"kind": "cylinder", "radius": self.radius, "axis": list(self.axis)}

    @property
    def frame(self) -> Array:
        """(3, 3) unit vectors across, along and up, as columns."""
        along = np.array(self.axis) / np.linalg.norm(self.axis)
        up = np.array([0.0, 0.0, 1.0])
        up = up - (up @ along) * along
        up /= np.linalg.norm(up)
        return np.stack([np.cross(along, up), along, up], axis=1)

    @property
    def middle(self) -> Array:
        """(3,) the point of its axis."""
        below = (0.0, 0.0, -self.radius) if self.point is None else self.point
        return np.array(below)

    @property
    def scale(self) -> float:
        """Length over which contact changes."""
        return self.radius

    def nearest(self, points: Array) -> Nearest:
        """Gap and its derivatives; a fibre is one body without an inside, of number -1."""
        away = points - self.middle
        along = self.frame[:, 1]
        across = away - (away @ along)[..., None] * along
        distance = np.sqrt((across**2).sum(axis=-1))
        with np.errstate(invalid="ignore", divide="ignore"):
            normal = across / distance[..., None]
            ridge = np.cross(along, normal) / np.sqrt(distance)[..., None]
        shape = distance.shape
        return Nearest.computed(
            distance - self.radius, normal, np.zeros(shape), np.full(shape, -1), ridge
        )

    def fan(self, points: Array, tangents: Array) -> Fan:
        """Straight lines of the unrolled surface from the top of its point."""
        frame, r = self.frame, self.radius
        x, t = (points - self.middle) @ frame, tangents @ frame
        polar = np.arctan2(x[..., 0], x[..., 2])
        size = x[..., 0] ** 2 + x[..., 2] ** 2
        turn = (x[..., 2] * t[..., 0] - x[..., 0] * t[..., 2]) / size

        def place(chart: Array) -> tuple[Array, Array, Array]:
            angle = chart[..., 0] / r
            out = np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=-1)
            local = r * out
            local[..., 1] = chart[..., 1]
            return self.middle + local @ frame.T, out @ frame.T, np.ones(angle.shape)

        ends = np.stack([r * polar, x[..., 1]], axis=-1)
        ways = np.stack([r * turn, t[..., 1]], axis=-1)
        angle = self.contact_angle
        scale = min(r, angle.width) if varies(angle) else r
        return chart_fan(place, ends, ways, scale)

    def center_of(self, which: Any) -> Array:
        """A fibre has no centre: not a number."""
        return np.full((*np.shape(which), 3), np.nan)

    def radius_of(self, which: Any) -> Array:
        """(...) infinite: it is no ball."""
        return np.full(np.shape(which), np.inf)
