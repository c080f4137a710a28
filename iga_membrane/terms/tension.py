"""Surface tension of the liquid-gas interface."""

from __future__ import annotations

from dataclasses import dataclass

from ..checks import number
from .term import AreaTerm, Scale


@dataclass(frozen=True)
class SurfaceTension(AreaTerm):
    """``gamma`` times the area: the constant in-plane stress of the paper, between eqs (19)
    and (20).

    Attributes
    ----------
    gamma : energy per area, > 0.
    """

    gamma: float
    name = "surface_tension"

    def __post_init__(self) -> None:
        number("liquid.surface_tension", self.gamma, above=0.0)

    def tension(self) -> float:
        return self.gamma

    def scaled(self, scale: Scale) -> SurfaceTension:
        return SurfaceTension(self.gamma / scale.tension)
