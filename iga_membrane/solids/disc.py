"""A flat disc with a sharp rim."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ..arguments import checked
from ..checks import POSITIVE, direction, number, wet_angle
from .plane import Plane


@dataclass(frozen=True)
@checked("substrate", contact_angle=wet_angle, normal=direction, radius=POSITIVE)
class Disc(Plane):
    """The round face of a plane, which ends in a sharp rim: a post or the mouth of a needle.

    The contact line rests on the rim while its angle with the face is between Young's and Young's
    plus ``edge`` (Gibbs); below it would recede over the face, above run down the side.

    Attributes
    ----------
    contact_angle : Young's angle in degrees, through the liquid.
    point : the middle of the face.
    normal : out of the solid.
    radius : of the rim, > 0.
    edge : by how many degrees the solid turns at the rim, > 0 and <= 180.
    """

    contact_angle: Any = 90.0
    radius: float = field(default=1.0, kw_only=True)
    edge: float = field(default=90.0, kw_only=True)

    def __post_init__(self) -> None:
        number("substrate.edge", self.edge, above=0.0, most=180.0)

    @property
    def scale(self) -> float:
        """Length over which contact changes: the rim's radius."""
        return self.radius
