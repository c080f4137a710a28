"""Surfaces that are graphs over the plane z = 0: bumps, textures, measured maps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array, Mask
from ..checks import (
    POSITIVE,
    array,
    contact_angle,
    either,
    function,
    instance,
    items,
    number,
    words,
)
from ..errors import SceneError
from ..own import answer_of, called, check_slopes, note_bad
from .fan import Fan, chart_fan
from .nearest import Nearest
from .shapes import Bump, Grid, Grooves, Pillars, Waves
from .wettability import Field, varies

NAMES = ("h", "h_x", "h_y", "h_xx", "h_xy", "h_yy")
ANGLE = either(contact_angle, instance(Field))
"""The rule of a contact angle."""
CHECKED = 60
"""Places at which the derivatives of a height are compared with differences."""
Height = Callable[[Array, Array], Any]
"""Places x, y (...) to the height, its slopes and its second derivatives (...): h, h_x, h_y, h_xx,
h_xy, h_yy."""


@dataclass(frozen=True)
@checked(
    "substrate",
    height=partial(function, arguments=2),
    contact_angle=ANGLE,
    scale=POSITIVE,
)
class HeightMap:
    """Solid below a smooth surface z = h(x, y).

    Attributes
    ----------
    height : x, y (...) to h, h_x, h_y, h_xx, h_xy, h_yy, six arrays (...) in the user's units.
    contact_angle : Young's angle in degrees, through the liquid, below 180; or a
        :class:`.Wettability`.
    scale : length over which the surface bends, a quarter of a period; the default mesh has about
        three elements along it.

    Notes
    -----
    Contact lines need a level that is 0 on the surface, here ``(z - h) / sqrt(1 + |grad h|^2)``,
    its unit normal there, and how that turns: not the distance.
    """

    height: Height
    contact_angle: Any
    scale: float

    def __post_init__(self) -> None:
        if not varies(self.contact_angle) and self.contact_angle == 180.0:
            raise SceneError(
                "substrate.contact_angle = 180: not available yet on a height map; give an angle "
                "below"
            )

    @classmethod
    @checked("substrate", height=number, width=POSITIVE, contact_angle=ANGLE)
    def bump(cls, height: float, width: float, *, contact_angle: Any) -> HeightMap:
        """``h = height exp(-(x^2 + y^2) / width^2)``; a dimple where the height is negative.

        Parameters
        ----------
        height, width : of the bump.
        contact_angle : as of :class:`HeightMap`.
        """
        return cls(Bump(height, width), contact_angle, 0.5 * width)

    @classmethod
    @checked("substrate", amplitude=number, period=POSITIVE, contact_angle=ANGLE)
    def egg_carton(cls, amplitude: float, period: float, *, contact_angle: Any) -> HeightMap:
        """``h = amplitude cos(2 pi x / period) cos(2 pi y / period)``.

        Parameters
        ----------
        amplitude, period : of the waves.
        contact_angle : as of :class:`HeightMap`.
        """
        return cls(Waves(((amplitude, period),)), contact_angle, 0.25 * period)

    @classmethod
    @checked("substrate", amplitude=number, period=POSITIVE, contact_angle=ANGLE)
    def grooves(cls, amplitude: float, period: float, *, contact_angle: Any) -> HeightMap:
        """``h = amplitude cos(2 pi x / period)``, along y.

        Parameters
        ----------
        amplitude, period : of the waves.
        contact_angle : as of :class:`HeightMap`.
        """
        return cls(Grooves(amplitude, period), contact_angle, 0.25 * period)

    @classmethod
    @checked(
        "substrate",
        amplitudes=partial(items, each=number, least=1),
        periods=partial(items, each=POSITIVE, least=1),
        contact_angle=ANGLE,
    )
    def two_level(
        cls, amplitudes: Sequence[float], periods: Sequence[float], *, contact_angle: Any
    ) -> HeightMap:
        """The sum of egg cartons.

        Parameters
        ----------
        amplitudes, periods : of each, as many of the one as of the other.
        contact_angle : as of :class:`HeightMap`.

        Raises
        ------
        SceneError
        """
        if len(amplitudes) != len(periods):
            raise SceneError(
                f"substrate.amplitudes, substrate.periods: {len(amplitudes)} and {len(periods)} "
                "given; as many of the one as of the other are needed"
            )
        waves = tuple(zip(amplitudes, periods, strict=True))
        return cls(Waves(waves), contact_angle, 0.25 * min(periods))

    @classmethod
    @checked(
        "substrate",
        radius=POSITIVE,
        height=POSITIVE,
        spacing=POSITIVE,
        edge=POSITIVE,
        arrangement=words("square", "hexagonal"),
        contact_angle=ANGLE,
    )
    def pillars(
        cls,
        radius: float,
        height: float,
        spacing: float,
        edge: float,
        *,
        contact_angle: Any,
        arrangement: str = "square",
        offset: tuple[float, float] = (0.0, 0.0),
    ) -> HeightMap:
        """Round pillars with rounded edges, ``height (1 + tanh((radius - distance) / edge)) / 2``
        each.

        Parameters
        ----------
        radius, height, spacing : of the pillars.
        edge : width of their rounded borders.
        arrangement : "square" or "hexagonal", with neighbours along x.
        offset : x, y of one of them.
        contact_angle : as of :class:`HeightMap`.
        """
        shape = Pillars(radius, height, spacing, edge, arrangement, offset)
        return cls(shape, contact_angle, edge)

    @classmethod
    @checked(
        "substrate",
        x=partial(array, shape=(None,)),
        y=partial(array, shape=(None,)),
        z=partial(array, shape=(None, None)),
        contact_angle=ANGLE,
    )
    def from_grid(
        cls, x: Array, y: Array, z: Array, *, contact_angle: Any, scale: float
    ) -> HeightMap:
        """A measured map: the smooth (cubic) surface through its heights.

        Parameters
        ----------
        x, y : (n,), (m,) places, each growing, 4 or more.
        z : (n, m) heights.
        contact_angle, scale : as of :class:`HeightMap`.

        Raises
        ------
        SceneError
            Places that do not grow, heights of another shape.
        """
        for name, places in (("x", x), ("y", y)):
            if len(places) < 4 or not (np.diff(places) > 0.0).all():
                raise SceneError(
                    f"substrate.{name}: must be four or more growing places, got {len(places)}"
                )
        if z.shape != (len(x), len(y)):
            raise SceneError(f"substrate.z: must have the shape {(len(x), len(y))}, got {z.shape}")
        return cls(Grid(np.array(x), np.array(y), np.array(z)), contact_angle, scale)

    def described(self) -> dict[str, Any]:
        """By the names of the scene file, but for the contact angle; of an own height its class."""
        name = getattr(self.height, "__qualname__", type(self.height).__name__)
        known = getattr(self.height, "described", lambda: {"shape": name})
        return {"kind": "height_map", "scale": self.scale} | known()

    def at(self, x: Array, y: Array) -> list[Array]:
        """Height and derivatives."""
        found = answer_of(self.height, called(self.height, x, y), NAMES, np.shape(x), finite=False)
        note_bad(self.height, "h", found[0], np.stack([x, y, x], axis=-1), "point")
        return found

    def check(self, origin: tuple[float, float, float], length: float) -> None:
        """Compare the derivatives of the height with differences, at places round a scene.

        Raises
        ------
        SceneError
            The message names the function that is wrong.
        """
        rng = np.random.default_rng(0)
        x, y = (origin[k] + length * rng.uniform(-1.5, 1.5, CHECKED) for k in range(2))
        found, short = self.at(x, y), min(self.scale, length)

        def moved(k: int, axis: int) -> Callable[[Array], Array]:
            def values(step: Array) -> Array:
                return self.at(x + step * (axis == 0), y + step * (axis == 1))[k]

            return values

        for k, axis, slope in ((0, 0, 1), (0, 1, 2), (1, 0, 3), (1, 1, 4), (2, 1, 5)):
            check_slopes(self.height, (NAMES[slope], NAMES[k]), moved(k, axis), found[slope], short)

    def nearest(self, points: Array) -> Nearest:
        """The level and its normal; the surface is one body without an inside, of number -1."""
        h, h_x, h_y, h_xx, h_xy, h_yy = self.at(points[..., 0], points[..., 1])
        size = np.sqrt(1.0 + h_x**2 + h_y**2)
        normal = np.stack([-h_x, -h_y, np.ones_like(h)], axis=-1) / size[..., None]
        none = np.zeros_like(h)
        slopes = np.stack([-h_xx, -h_xy, none, -h_xy, -h_yy, none, none, none, none], axis=-1)
        slopes = slopes.reshape(*h.shape, 3, 3) / size[..., None, None]
        along = np.einsum("...i,...ij->...j", normal, slopes)
        turn = slopes - normal[..., :, None] * along[..., None, :]
        which = np.full(h.shape, -1)
        return Nearest.computed((points[..., 2] - h) / size, normal, none, which, None, turn)

    def fan(self, points: Array, tangents: Array) -> Fan:
        """Straight lines in the plane from the origin."""

        def place(chart: Array) -> tuple[Array, Array, Array]:
            h, h_x, h_y = self.at(chart[..., 0], chart[..., 1])[:3]
            size = np.sqrt(1.0 + h_x**2 + h_y**2)
            normal = np.stack([-h_x, -h_y, np.ones_like(h)], axis=-1) / size[..., None]
            return np.concatenate([chart, h[..., None]], axis=-1), normal, size

        angle = self.contact_angle
        scale = min(self.scale, angle.width) if varies(angle) else self.scale
        return chart_fan(place, points[..., :2], tangents[..., :2], scale)

    def knows(self, points: Array) -> Mask:
        """(...) whether a measured map reaches to points (..., 3)."""
        limits = getattr(self.height, "limits", None)
        if limits is None:
            return np.ones(points.shape[:-1], bool)
        low, high = limits
        return np.asarray(((points[..., :2] >= low) & (points[..., :2] <= high)).all(axis=-1))

    def center_of(self, which: Any) -> Array:
        """A surface has no centre: not a number."""
        return np.full((*np.shape(which), 3), np.nan)

    def radius_of(self, which: Any) -> Array:
        """(...) infinite."""
        return np.full(np.shape(which), np.inf)
