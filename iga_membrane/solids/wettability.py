"""Contact angles that differ from place to place."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import POSITIVE, contact_angle
from ..own import answer_of, called


class Frame(Protocol):
    """Units and axes of a scene (:class:`..terms.Scale`)."""

    @property
    def length(self) -> float: ...

    @property
    def axes(self) -> Array: ...

    def to_world(self, points: Array) -> Array: ...


class Field(ABC):
    """A field of contact angles, in place of one.

    Notes
    -----
    Its energy is ``-gamma int cos(theta) dA`` over the wetted surface, so that Young's angle holds
    at every place of a contact line.
    """

    @abstractmethod
    def at(self, points: Array) -> tuple[Array, Array]:
        """The cosine of Young's angle (...) at points (..., 3), and its gradient (..., 3)."""

    @property
    def width(self) -> float:
        """Length over which it changes, infinite if unknown."""
        return np.inf

    @property
    def least(self) -> float:
        """Smallest angle in degrees, 90 if unknown."""
        return 90.0

    def described(self) -> dict[str, Any]:
        """By the names of the scene file; of an own field its class."""
        return {"kind": type(self).__name__}

    def scaled(self, scale: Frame) -> Field:
        """The field in the coordinates of a scene."""
        return LocalField(self, scale)


@dataclass(frozen=True)
@checked()
class Wettability(Field):
    """A field of one's own.

    Attributes
    ----------
    cosine : points (..., 3) in world coordinates to the cosine of Young's angle (...) and its
        gradient (..., 3). The mesh does not know over which length it changes: give
        ``Discretization(elements=...)``.
    """

    cosine: Callable[..., Any]

    def at(self, points: Array) -> tuple[Array, Array]:
        call, shape = self.cosine, points.shape
        found = called(call, points)
        (value,) = answer_of(call, [found[0]], ["cosine"], shape[:-1])
        (gradient,) = answer_of(call, [found[1]], ["gradient"], shape)
        return value, gradient


@dataclass(frozen=True)
class LocalField(Field):
    """A field in the coordinates of a scene.

    Attributes
    ----------
    field : in world coordinates.
    view : units and axes of the scene.
    """

    field: Field
    view: Frame

    def at(self, points: Array) -> tuple[Array, Array]:
        value, gradient = self.field.at(self.view.to_world(points))
        return value, gradient @ self.view.axes * self.view.length

    @property
    def width(self) -> float:
        return self.field.width / self.view.length

    @property
    def least(self) -> float:
        return self.field.least


class Bordered(Field):
    """Two angles with a smooth border between them: of their cosines ``(c1 + c2) / 2 + (c1 - c2) /
    2 tanh(s / border)``, ``s`` the way into the first one.

    Attributes
    ----------
    first, second : angles in degrees.
    border : width.
    """

    first: float
    second: float
    border: float

    @abstractmethod
    def way(self, points: Array) -> tuple[Array, Array]:
        """``s`` (...) at points (..., 3), and its gradient (..., 3)."""

    def at(self, points: Array) -> tuple[Array, Array]:
        one, two = np.cos(np.radians([self.first, self.second]))
        s, slope = self.way(points)
        part = np.tanh(s / self.border)
        rise = 0.5 * (one - two) * (1.0 - part**2) / self.border
        return 0.5 * (one + two) + 0.5 * (one - two) * part, rise[..., None] * slope

    def described(self) -> dict[str, Any]:
        own = {name: value for name, value in vars(self).items() if name not in ("first", "second")}
        return {"kind": type(self).__name__.lower(), "angles": [self.first, self.second]} | own

    @property
    def width(self) -> float:
        return self.border

    @property
    def least(self) -> float:
        return min(self.first, self.second)


@dataclass(frozen=True)
@checked(first=contact_angle, second=contact_angle, period=POSITIVE, border=POSITIVE)
class Stripes(Bordered):
    """Stripes along y, the first angle at x = 0: ``s = period / (2 pi) cos(2 pi x / period)``."""

    first: float
    second: float
    period: float
    border: float

    def way(self, points: Array) -> tuple[Array, Array]:
        wave = 2.0 * np.pi * points[..., 0] / self.period
        slope = -np.sin(wave)[..., None] * [1.0, 0.0, 0.0]
        return self.period / (2.0 * np.pi) * np.cos(wave), slope


@dataclass(frozen=True)
@checked(first=contact_angle, second=contact_angle, radius=POSITIVE, border=POSITIVE)
class Patch(Bordered):
    """A round patch about the z axis, the first angle inside: ``s = radius - r``."""

    first: float
    second: float
    radius: float
    border: float

    def way(self, points: Array) -> tuple[Array, Array]:
        away = np.hypot(points[..., 0], points[..., 1])
        with np.errstate(invalid="ignore", divide="ignore"):
            slope = np.where(away[..., None] > 0.0, -points / away[..., None], 0.0)
        return self.radius - away, slope * [1.0, 1.0, 0.0]


@checked(first=contact_angle, second=contact_angle, period=POSITIVE, border=POSITIVE)
def stripes(first: float, second: float, period: float, border: float) -> Stripes:
    """Stripes along y of two contact angles.

    Parameters
    ----------
    first, second : contact angles in degrees, the first one at x = 0.
    period : along x.
    border : width of the borders between them, of the form ``tanh(s / border)`` with
        ``s = period / (2 pi) cos(2 pi x / period)``.
    """
    return Stripes(first, second, period, border)


@checked(inside=contact_angle, outside=contact_angle, radius=POSITIVE, border=POSITIVE)
def patch(inside: float, outside: float, radius: float, border: float) -> Patch:
    """A round patch about the z axis with a contact angle of its own.

    Parameters
    ----------
    inside, outside : contact angles in degrees.
    radius : of the patch.
    border : width of its border, of the form ``tanh((radius - r) / border)``.
    """
    return Patch(inside, outside, radius, border)


def cosine_of(angle: Any, points: Array, which: Index) -> tuple[Array, Array | None]:
    """Cosine (...) of a solid's contact angle at points (..., 3), and its gradient, None where the
    angle is the same all over a body.

    Parameters
    ----------
    angle : of the solid: one, one for each body, or a field.
    which : (...) numbers of the bodies.
    """
    if varies(angle):
        value, gradient = angle.at(points)
        return value, gradient
    angles = np.radians(np.asarray(angle))
    return np.cos(angles[which] if angles.ndim else np.full(np.shape(which), angles)), None


def local_angle(angle: Any, scale: Frame) -> Any:
    """A contact angle in the coordinates of a scene."""
    return angle.scaled(scale) if varies(angle) else angle


def varies(angle: Any) -> bool:
    """Whether a contact angle is a field."""
    return isinstance(angle, Field)


def least_angle(angle: Any) -> float:
    """Smallest contact angle of a solid in degrees."""
    return float(angle.least if varies(angle) else np.min(angle))
