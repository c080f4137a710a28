"""Heights over the plane with their derivatives: x, y (...) to h, h_x, h_y, h_xx, h_xy, h_yy."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array
from ..overview import brief_repr

GONE = 18.0
"""Distance beyond a pillar's border over its width at which ``1 + tanh`` is rounding."""


@dataclass(frozen=True)
class Bump:
    """``height exp(-(x^2 + y^2) / width^2)``"""

    height: float
    width: float

    def __call__(self, x: Array, y: Array) -> tuple[Array, ...]:
        u, v, w = x / self.width, y / self.width, self.width
        h = self.height * np.exp(-(u**2) - v**2)
        return (
            h,
            -2.0 * u * h / w,
            -2.0 * v * h / w,
            (4.0 * u**2 - 2.0) * h / w**2,
            4.0 * u * v * h / w**2,
            (4.0 * v**2 - 2.0) * h / w**2,
        )

    def described(self) -> dict[str, Any]:
        """By the names of the scene file."""
        return {"shape": "bump", "height": self.height, "width": self.width}


@dataclass(frozen=True)
class Waves:
    """Egg cartons ``amplitude cos(2 pi x / period) cos(2 pi y / period)``, added up."""

    waves: tuple[tuple[float, float], ...]

    def __call__(self, x: Array, y: Array) -> tuple[Array, ...]:
        total = np.zeros((6, *np.shape(x)))
        for amplitude, period in self.waves:
            k = 2.0 * np.pi / period
            (cx, sx), (cy, sy) = ((np.cos(k * t), np.sin(k * t)) for t in (x, y))
            total += amplitude * np.stack(
                [cx * cy, -k * sx * cy, -k * cx * sy, -(k**2) * cx * cy, k**2 * sx * sy,
                 -(k**2) * cx * cy]
            )  # fmt: skip
        return tuple(total)

    def described(self) -> dict[str, Any]:
        """By the names of the scene file."""
        amplitudes, periods = (list(values) for values in zip(*self.waves, strict=True))
        if len(amplitudes) == 1:
            return {"shape": "egg_carton", "amplitude": amplitudes[0], "period": periods[0]}
        return {"shape": "two_level", "amplitudes": amplitudes, "periods": periods}


@dataclass(frozen=True)
class Grooves:
    """``amplitude cos(2 pi x / period)``"""

    amplitude: float
    period: float

    def __call__(self, x: Array, y: Array) -> tuple[Array, ...]:
        k, none = 2.0 * np.pi / self.period, np.zeros(np.shape(x))
        h = self.amplitude * np.cos(k * x)
        return h, -self.amplitude * k * np.sin(k * x), none, -(k**2) * h, none, none

    def described(self) -> dict[str, Any]:
        """By the names of the scene file."""
        return {"shape": "grooves", "amplitude": self.amplitude, "period": self.period}


@dataclass(frozen=True)
class Pillars:
    """Pillars on a lattice, ``height (1 + tanh((radius - distance) / edge)) / 2`` each."""

    radius: float
    height: float
    spacing: float
    edge: float
    arrangement: str
    offset: tuple[float, float]

    def __call__(self, x: Array, y: Array) -> tuple[Array, ...]:
        rise = 1.0 if self.arrangement == "square" else np.sqrt(0.75)
        lean = 0.0 if self.arrangement == "square" else 0.5
        j = np.rint((y - self.offset[1]) / (rise * self.spacing))
        total = np.zeros((6, *np.shape(x)))
        # beyond, a pillar is less than rounding; the nearest row and column are half a spacing away
        reach = int(0.5 + (self.radius + GONE * self.edge) / (rise * self.spacing))
        for dj in range(-reach, reach + 1):
            v = y - self.offset[1] - rise * self.spacing * (j + dj)
            shift = self.offset[0] + lean * self.spacing * (j + dj)
            i = np.rint((x - shift) / self.spacing)
            for di in range(-reach, reach + 1):
                total += self._one(x - shift - self.spacing * (i + di), v)
        return tuple(total)

    def described(self) -> dict[str, Any]:
        """By the names of the scene file."""
        return {"shape": "pillars"} | vars(self) | {"offset": list(self.offset)}

    def _one(self, u: Array, v: Array) -> Array:
        """(6, ...) of the pillar at the origin."""
        r = np.maximum(np.hypot(u, v), 1e-300)
        t = np.tanh((self.radius - r) / self.edge)
        rise = -0.5 * self.height * (1.0 - t**2) / self.edge
        bend = -2.0 * t * 0.5 * self.height * (1.0 - t**2) / self.edge**2
        cu, cv = u / r, v / r
        return np.stack(
            [0.5 * self.height * (1.0 + t), rise * cu, rise * cv,
             bend * cu**2 + rise / r * cv**2, (bend - rise / r) * cu * cv,
             bend * cv**2 + rise / r * cu**2]
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Grid:
    """The bicubic spline through heights z (n, m) at places x (n,), y (m,); beyond them as at the
    border."""

    x: Array
    y: Array
    z: Array

    __repr__ = brief_repr

    @property
    def limits(self) -> tuple[Array, Array]:
        """(2,) lowest and highest places."""
        return np.array([self.x[0], self.y[0]]), np.array([self.x[-1], self.y[-1]])

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import RectBivariateSpline

        return RectBivariateSpline(self.x, self.y, self.z)

    def __call__(self, x: Array, y: Array) -> tuple[Array, ...]:
        (low_x, low_y), (high_x, high_y) = self.limits
        u, v = np.clip(x, low_x, high_x), np.clip(y, low_y, high_y)
        inside = (u == x) & (v == y)
        orders = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        return tuple(
            self._spline.ev(u, v, dx=dx, dy=dy) * (inside if dx + dy else 1.0) for dx, dy in orders
        )

    def described(self) -> dict[str, Any]:
        """By the names of the scene file."""
        return {"shape": "grid"}
