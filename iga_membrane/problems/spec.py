"""What is asked of a droplet's foot, and what a foot is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array
from ..dofs.boundary_conditions import Model, Sector, Support
from ..errors import SceneError
from ..initial.liquid import MODELS, Discretization, Liquid, Mesh
from ..solids import Solid, Sphere
from ..splines import Grading
from ..surface.surface import Surface
from ..terms import Contact, Scale, Term
from .scene import FreeEdge

BALL = 4.0 * np.pi / 3.0
"""Volume of a droplet in its own scale."""


@dataclass(frozen=True, eq=False)
class Question:
    """What a foot is built from (scene, units, Bond numbers along the axes)."""

    substrate: Solid
    asked: Discretization
    scale: Scale
    bond: Array
    start: Surface | str | None
    liquid: Liquid
    law: Contact
    contact_line: str
    particles: tuple[Sphere, ...] = ()
    held: str = ""

    @property
    def down(self) -> float:
        """Bond number of gravity's part towards the substrate."""
        return max(0.0, -float(self.bond[2]))


@dataclass(frozen=True, eq=False)
class Foot:
    """Start, support and price of a foot.

    Attributes
    ----------
    tangent : whether the membrane leaves a plane at 180 degrees; free_edge : edges on perfectly wet
        solids.
    predictor : other terms that give a better start.
    start_from : a start from the equilibrium of the same droplet without particles.
    alone : what that droplet stands on, on the same patch.
    """

    surface: Surface
    sector: Sector
    mesh: Mesh
    terms: Sequence[Term]
    supports: Sequence[Support] = ()
    grading: Grading | None = field(default_factory=Grading)
    directions: Array | None = None
    tangent: bool = False
    free_edge: FreeEdge | None = None
    predictor: Sequence[Term] = ()
    start_from: Callable[[Surface], Surface] | None = None
    alone: Foot | None = None


def sector_of(mesh: Mesh, bond: Array) -> Sector:
    """The model asked for, or the smallest that gravity's direction allows."""
    along_x, along_y = (bool(b) for b in bond[:2])
    smallest: Model = "full" if along_y else "half" if along_x else "eighth"
    model = mesh.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": gravity leans to '
            f"{'y' if along_y else 'x'} of the substrate, so the droplet has no such mirror "
            f'planes; "{smallest}" is the smallest model here'
        )
    return Sector(model)
