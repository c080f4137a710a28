"""Does self-cleaning work: what the liquid does to each particle where it lies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import NOT_NEGATIVE, real, words
from ..driver.solution import Solution
from ..driver.solve import solve
from ..errors import SceneError
from ..problems.scene import Scene
from ..results.forces import ParticleForces
from ..solids import Plane, SphereLattice, Spheres
from ..solvers.options import SolverOptions

ROUNDING = 1e-9
"""Force over weight and line force that counts as none."""


@dataclass(frozen=True)
@checked(
    answer=words("lifted", "dragged", "stays"),
    normal=real,
    tangential=real,
    weight=real,
    slide=real,
)
class Verdict:
    """What happens to a particle, and by which forces.

    Attributes
    ----------
    answer : "lifted", "dragged" or "stays".
    normal, tangential : force of the liquid out of the substrate (asperities: along z), and size of
        that along it.
    weight : part of the weight that presses the particle on the substrate.
    slide : tangential force, that of the weight included, over the force that presses the particle
        on the substrate: it is dragged above the coefficient of friction; inf where nothing presses
        it down.
    """

    answer: str
    normal: float
    tangential: float
    weight: float
    slide: float


@dataclass(frozen=True, eq=False)
@checked()
class SelfCleaning:
    """The answer for every particle of a scene.

    Attributes
    ----------
    verdicts : one for each particle; solution : with the particles fixed.
    """

    verdicts: Sequence[Verdict]
    solution: Solution = field(repr=False)

    @property
    def cleans(self) -> bool:
        """Whether no particle stays."""
        return all(each.answer != "stays" for each in self.verdicts)


@checked(friction=NOT_NEGATIVE)
def self_cleaning(
    scene: Scene, *, friction: float, options: SolverOptions | None = None
) -> SelfCleaning:
    """Whether the liquid lifts the particles of a scene, drags them, or leaves them (eq. 39).

    Parameters
    ----------
    scene : with particles; they are held where they stand, whatever their motion.
    friction : coefficient between particle and substrate, >= 0. A particle is lifted where the
        force of the liquid out of the substrate is more than its weight; otherwise it is dragged
        where the force along the substrate is more than friction times what presses it down.
    options : of the solve.

    Raises
    ------
    SceneError
        If the scene has no particle, or a droplet stands on neither a plane nor asperities.
    SolveError
        If there is no stable equilibrium.
    """
    rough = isinstance(scene.substrate, (SphereLattice, Spheres))
    if scene.kind == "sessile_droplet" and not (rough or isinstance(scene.substrate, Plane)):
        raise SceneError(
            "substrate: particles are cleaned from a plane or from asperities, or lifted by a "
            "sheet; give a Plane, a SphereLattice or Spheres"
        )
    if scene.free_particles is not None:
        scene = scene.free_particles.scene_at(np.zeros(len(scene.free_particles.which)))
    solution = solve(scene, options)
    if not solution.forces:
        raise SceneError("particle: the scene has none; give it one or more")
    solid = scene.substrate
    up = np.array(solid.unit_normal() if isinstance(solid, Plane) else (0.0, 0.0, 1.0))
    return SelfCleaning([_verdict(each, up, friction) for each in solution.forces], solution)


def _verdict(forces: ParticleForces, up: Array, friction: float) -> Verdict:
    liquid = forces.effective - forces.weight
    out = float(forces.effective @ up)
    along = float(np.linalg.norm(forces.effective - out * up))
    # what is less than rounding is nothing
    none = ROUNDING * float(np.linalg.norm(forces.weight) + np.linalg.norm(forces.contact_line))
    slide = along / -out if out < -none else float("inf") if out > none or along > none else 0.0
    return Verdict(
        "lifted" if out > none else "dragged" if slide > friction else "stays",
        float(liquid @ up),
        float(np.linalg.norm(liquid - (liquid @ up) * up)),
        -float(forces.weight @ up),
        slide,
    )
