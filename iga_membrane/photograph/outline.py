"""The outline of a droplet in a photograph, as points with the camera that saw them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..overview import brief_repr


@dataclass(frozen=True, eq=False)
class Camera:
    """Where the points of an outline lie in the image.

    Attributes
    ----------
    image : (rows, columns) grey values.
    scale : length of a pixel.
    origin : (2,) column and row of x = 0, z = 0, on the base line.
    tilt : of the base line against the image's rows (radians), positive where it falls to the
        right.
    base_error : standard error of the base line's height, a length.
    hangs : whether the droplet hangs from its base.
    units : "SI" where the scale was given with its unit, else "dimensionless".
    """

    image: Array
    scale: float
    origin: tuple[float, float]
    tilt: float
    base_error: float
    hangs: bool
    units: str

    __repr__ = brief_repr

    def points(self, pixels: Array) -> Array:
        """Lengths (..., 2) along the base line and up from it, of columns and rows (..., 2)."""
        return np.asarray((pixels - self.origin) @ self._axes * self.scale)

    def pixels(self, points: Array) -> Array:
        """Columns and rows (..., 2) of points (..., 2)."""
        return np.asarray(points / self.scale @ self._axes.T + self.origin)

    @property
    def _axes(self) -> Array:
        """(2, 2) with x along the base line and z up as columns, in columns and rows."""
        c, s = np.cos(self.tilt), np.sin(self.tilt)
        return np.array([[c, s], [s, -c]])


class Outline(np.ndarray[Any, np.dtype[np.float64]]):
    """Points (n, 2) of a droplet's outline: x along its base line, z up from it.

    An array like any other, which knows the :class:`Camera` that saw it.
    """

    camera: Camera | None

    def __new__(cls, points: Array, camera: Camera | None = None) -> Outline:
        made = np.asarray(points, float).view(cls)
        made.camera = camera
        return made

    def __array_finalize__(self, other: Any) -> None:
        self.camera = getattr(other, "camera", None)
