"""Pressure, prescribed or as the multiplier of a volume; and the hold of a centroid.

The liquid's volume is the flux of ``z e_z`` through the membrane: the part of the liquid's surface
that is not the membrane lies in z = 0 or is vertical, and adds nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from ..arguments import checked
from ..checks import Rule, number, words
from .term import BodyDensity, BodyTerm, Constraint, Scale

ANY: Rule = partial(number, smallest=0.0)
"""A number that may come near 0 by cancellation."""


@dataclass(frozen=True)
@checked(pressure=ANY)
class Pressure(BodyTerm):
    """Prescribed pressure (liquid minus gas) at the origin's height: energy ``-p V``.

    Attributes
    ----------
    pressure : tension over length.
    """

    pressure: float
    name = "pressure"
    forms = ("bodies", "pressures")

    def density(self) -> BodyDensity:
        return BodyDensity(-self.pressure)

    def scaled(self, scale: Scale) -> Pressure:
        return Pressure(self.pressure / scale.pressure)


@dataclass(frozen=True)
@checked(value="liquid.volume", ends=ANY)
class Volume(Constraint):
    """Prescribed volume of liquid; its multiplier is the pressure ``lambda`` of paper eq. (22).

    Attributes
    ----------
    value : volume, > 0.
    ends : the part of it that the flux through the membrane does not see, because it lies under
        fixed ends off z = 0.
    """

    value: float
    ends: float = 0.0
    name = "volume"
    forms = ("constraints", "volumes")

    @property
    def target(self) -> float:
        return self.value - self.ends

    def density(self) -> BodyDensity:
        return BodyDensity(1.0)

    def scaled(self, scale: Scale) -> Volume:
        return Volume(self.value / scale.length**3, self.ends / scale.length**3)


@dataclass(frozen=True)
@checked(axis=words(*"xyz"), target=ANY)
class Centroid(Constraint):
    """Holds the liquid's centroid at 0 along an axis by a uniform body force per volume, the
    multiplier.

    Where nothing pushes the liquid along the axis, the multiplier is zero and the constraint only
    removes a neutral rigid motion.

    Attributes
    ----------
    axis : "x", "y" or "z" in local coordinates.
    target : of the integral of that coordinate over the liquid.
    """

    axis: str
    target: float = 0.0
    forms = ("constraints", "centroids")

    @property
    def name(self) -> str:  # type: ignore[override]
        """Key of the multiplier."""
        return f"centroid_{self.axis}"

    def density(self) -> BodyDensity:
        x, y, z = (float(self.axis == axis) for axis in "xyz")
        return BodyDensity(0.0, (x, y, z))

    def scaled(self, scale: Scale) -> Centroid:
        return self
