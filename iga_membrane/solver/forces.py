"""Forces on a particle under a sheet with a level contact line (paper eqs 35-39).

Consistent forces: the pressure acts on the projected area ``pi a^2``, Archimedes' term on the cap
points up when paired with the pressure at the contact line, and the line force is what is left of
``-dE/dz``. The paper's formulas, with the cap's area ``2 pi r b``, stand beside them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..scenes.scene import Scene
from ..solids import Sphere


@dataclass(frozen=True)
class ParticleForces:
    """Vertical forces on a particle, up positive, in the user's units.

    Attributes
    ----------
    weight : F_G; line : F_CL; hydrostatic : F_H, the pressure at the contact line on the projected
        area; buoyancy : F_B of the liquid between line and cap; effective : F_e, their sum.
    paper : F_G, F_CL, F_H, F_B_up, F_B_down, F_e_up, F_e_down by the paper's formulas.
    """

    weight: float
    line: float
    hydrostatic: float
    buoyancy: float
    paper: Mapping[str, float] = field(repr=False)

    @property
    def effective(self) -> float:
        """Paper eq. (39)."""
        return self.weight + self.line + self.hydrostatic + self.buoyancy

    @property
    def lifts(self) -> bool:
        """Whether the liquid pulls the particle up."""
        return self.effective > 0


def particle_forces(scene: Scene, measures: Mapping[str, float], pull: float) -> ParticleForces:
    """Forces on the particle of a sheet.

    Parameters
    ----------
    measures : of the state.
    pull : acceleration along -z. It weighs the particle and the liquid on it, also where the
        sheet itself is computed without weight.
    """
    particle = scene.substrate
    assert isinstance(particle, Sphere)
    density = scene.liquid_density
    r, a, height = particle.radius, measures["contact_radius"], measures["cap_height"]
    at_line = measures["pressure"] - density * pull * measures["z_contact"]
    weight = -4.0 / 3.0 * np.pi * r**3 * particle.density * pull
    buoyancy = density * pull * measures["V_cap"]
    on_cap = -measures["pressure"] * 2.0 * np.pi * r * height
    line = measures["F_CL"]
    paper = {
        "F_G": weight,
        "F_CL": line,
        "F_H": on_cap,
        "F_B_up": buoyancy,
        "F_B_down": -buoyancy,
        "F_e_up": weight + line + on_cap + buoyancy,
        "F_e_down": weight + line + on_cap - buoyancy,
    }
    return ParticleForces(weight, line, -np.pi * a**2 * at_line, buoyancy, paper)
