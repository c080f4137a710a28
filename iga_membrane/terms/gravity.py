"""Weight of the liquid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arguments import checked
from .term import BodyDensity, BodyTerm, Scale


@dataclass(frozen=True)
@checked(density_of_liquid="liquid.density")
class Gravity(BodyTerm):
    """Weight of the liquid: potential energy per volume, the hydrostatic pressure of eq. (21).

    It is ``-rho g . x``, zero at the origin.

    Attributes
    ----------
    density_of_liquid : rho.
    acceleration : (3,) vector g, of any direction.
    """

    density_of_liquid: float
    acceleration: tuple[float, float, float]
    name = "gravity"
    forms = ("bodies", "weights")

    def density(self) -> BodyDensity:
        x, y, z = (-self.density_of_liquid * g for g in self.acceleration)
        return BodyDensity(0.0, (x, y, z))

    def scaled(self, scale: Scale) -> Gravity:
        weight = self.density_of_liquid * np.array(self.acceleration) @ scale.axes
        x, y, z = (float(w) for w in weight * scale.length**2 / scale.tension)
        return Gravity(1.0, (x, y, z))
