"""A contact line that rests on the sharp rim of a disc."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ..arguments import checked
from ..checks import number, wet_angle
from ..splines import line
from .contact_line import PlaneContactLine


@dataclass(frozen=True)
@checked(gamma="liquid.surface_tension", contact_angle=wet_angle, edge=line)
class RimLine(PlaneContactLine):
    """The wetted face of a disc: its energy and what the liquid owes to it. Its edge is held, and
    may have any angle of Gibbs' range.

    Attributes
    ----------
    gamma, contact_angle, edge, level : as of a :class:`.contact_line.PlaneContactLine`.
    turn_of_rim : by how many degrees the solid turns at the rim.
    """

    turn_of_rim: float = 90.0
    pinned: ClassVar[bool] = True
    forms: ClassVar[tuple[str, ...]] = ("lines", "wetting", "rims")

    def __post_init__(self) -> None:
        super().__post_init__()
        number("substrate.edge", self.turn_of_rim, above=0.0, most=180.0)
