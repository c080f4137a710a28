"""Contact without a contact line: the membrane may lie on a solid but not in it.

Just below 180 degrees the solid also attracts it: wetting an area gains ``gamma (1 + cos(theta))``
of energy, here by a smooth well whose range is shorter than the mesh resolves.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from ..arguments import checked
from ..checks import NOT_NEGATIVE, POSITIVE, number
from ..solids import Solid
from .term import Scale, Term


@dataclass(frozen=True)
@checked(radius=POSITIVE, pressure=partial(number, smallest=0.0))
class Ring:
    """Where an asperity carries a membrane whose mesh is too coarse for its wet spot.

    Attributes
    ----------
    radius : of the ring round its top.
    pressure : estimated, of the liquid there.
    """

    radius: float
    pressure: float

    def scaled(self, scale: Scale) -> Ring:
        """In the scene's scale."""
        return Ring(self.radius / scale.length, self.pressure * scale.length / scale.tension)


@dataclass(frozen=True, eq=False)
@checked(
    penalty="solver.penalty",
    depth="solver.penetration_tolerance",
    adhesion=NOT_NEGATIVE,
    compliance=NOT_NEGATIVE,
    traction=NOT_NEGATIVE,
)
class Contact(Term):
    """The gap to a solid is not negative, paper section 4.

    Attributes
    ----------
    solid : plane, sphere, lattice or list of spheres, or one of the user's own.
    penalty : None holds the gap exactly; else the traction per depth of paper eq. (24), which lets
        the membrane sink in.
    depth : how deep the membrane may dip into the solid between contact points, over the radius
        of the smallest sphere (plane: over the scene's length).
    adhesion : energy per wetted area, ``gamma (1 + cos(theta))``.
    ring : where each asperity carries the membrane; None where contact is resolved.
    compliance : depth per traction by which exact contact gives way all the same, one over a
        penalty so hard that the membrane would dip deeper between contact points than it sinks.
    """

    solid: Solid
    penalty: float | None = None
    depth: float = 1e-2
    adhesion: float = 0.0
    ring: Ring | None = None
    compliance: float = 0.0
    traction: float = 0.0
    name = "contact"
    forms = ("obstacles",)

    @property
    def repels(self) -> bool:
        """Whether the solid is not wetted at all."""
        return not self.adhesion

    @property
    def solids(self) -> tuple[Solid, ...]:
        return (self.solid,)

    def scaled(self, scale: Scale) -> Contact:
        unit = scale.length**2 / scale.tension
        eps = None if self.penalty is None else self.penalty * unit
        adhesion = self.adhesion / scale.tension
        solid = scale.local_solid(self.solid)
        ring = None if self.ring is None else self.ring.scaled(scale)
        traction = self.traction * scale.length / scale.tension
        return Contact(solid, eps, self.depth, adhesion, ring, self.compliance / unit, traction)
