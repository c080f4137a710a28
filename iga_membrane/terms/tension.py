"""Surface tension of the liquid-gas interface."""

from __future__ import annotations

from dataclasses import dataclass

from ..arguments import checked
from .term import AreaTerm, Scale


@dataclass(frozen=True)
@checked(gamma="liquid.surface_tension")
class SurfaceTension(AreaTerm):
    """``gamma`` times the area: the constant in-plane stress of the paper, between eqs (19)
    and (20).

    Attributes
    ----------
    gamma : energy per area, > 0.
    """

    gamma: float
    name = "surface_tension"
    forms = ("areas", "surface_tensions")

    def tension(self) -> float:
        return self.gamma

    def scaled(self, scale: Scale) -> SurfaceTension:
        return SurfaceTension(self.gamma / scale.tension)
