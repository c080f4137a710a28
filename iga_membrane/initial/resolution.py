"""Patterns of asperities under a droplet: how deep it sags between them, how fine a mesh they need.

Meshes are those of :class:`~iga_membrane.surface.closed.Stretch`: even elements under the foot,
longer and longer ones beside it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..solids import Solid, SphereLattice, Spheres
from ..solids.wet_spot import spot_radius
from ..splines.point_load import ROBIN

FINE = 0.75
"""Part of the elements from the middle of the square to a side that lies under the foot, at
least."""
FEW, MANY = 20, 100
"""Asperities under the foot up to which they are resolved on any mesh, and from which they are
many: the start is then the drop on their tops, pressed on them, and contact at 180 degrees is a
hard penalty at all quadrature points where it is resolved."""
PER_SPOT = 2.2, 1.25
"""Elements along the radius of the smallest of many asperities, and along that of its wet spot, by
default."""
LEAST = 36
"""Elements from the middle to a side at least, for a droplet on point supports."""
PER_SPACING = 3.0, 4.0
"""Elements from one point support to the next: at least, and by default."""
WIDE = 0.25
"""Radius of the spot of a point support over the spacing, at most."""
RING = 1.0
"""Radius of the ring on which a point support acts, over that of the spot."""
SUNK = 3e-4
"""Depth over radius to which that penalty lets the membrane sink."""
GROWTH = 0.15
"""Largest growth from one element to the next beside the evenly meshed foot of many asperities."""


@dataclass(frozen=True)
class Pattern:
    """What carries a droplet (dimensionless).

    Attributes
    ----------
    length : over which the contact changes: radius of the smallest asperity.
    cell : area of the substrate per asperity; infinite without asperities.
    lies : whether the membrane lies on the asperities; where it passes through them, below 180
        degrees, more of them are wet.
    psi : pi minus the smallest contact angle, in radians.
    single : whether an asperity may carry the membrane at one place of its mesh.
    penalized : whether a penalty was asked for, whose wet spots are resolved.
    """

    length: float
    cell: float = np.inf
    lies: bool = True
    psi: float = 0.0
    single: bool = True
    penalized: bool = False

    @property
    def repels(self) -> bool:
        """Whether the contact angle is 180 degrees."""
        return self.psi == 0.0

    def under(self, foot: float) -> float:
        """Number of asperities under a foot of a radius."""
        return float(np.pi * foot**2 / self.cell)

    def many(self, foot: float) -> bool:
        """Whether many asperities lie there."""
        return self.under(foot) > MANY

    @property
    def spacing(self) -> float:
        """Of a square lattice with as many asperities."""
        return float(np.sqrt(self.cell))

    def spot(self, pressure: float) -> float:
        """Radius of the wet spots of a membrane of tension 1 that carry a pressure."""
        load = pressure * self.cell / (2.0 * np.pi * self.length)
        weight = 0.5 * pressure * self.length
        return self.length * float(spot_radius(*np.array([load, self.psi, weight])))

    def narrow(self, pressure: float) -> bool:
        """Whether its spots are so narrow that each may be carried at one place."""
        return self.single and self.spot(pressure) <= WIDE * self.spacing

    def unresolved(self, pressure: float, size: float) -> bool:
        """Whether elements of a size carry each spot at one place: too coarse to resolve it, and
        fine enough for the membrane in between."""
        fine = size * PER_SPACING[0] <= self.spacing
        return self.narrow(pressure) and fine and self.spot(pressure) <= PER_SPOT[1] * size

    def sag(self, pressure: float) -> float:
        """Mean depth of such a membrane under the tops: the potential of a wide square lattice of
        point forces ``pressure cell``, cut off at the spots."""
        log = np.log(self.spacing / self.spot(pressure)) - ROBIN
        return float(pressure * self.cell * (2.0 * log + 1.0) / (4.0 * np.pi))

    def penalty(self, pressure: float) -> float:
        """Traction over depth with which the smallest asperity lets the membrane sink by
        ``SUNK``."""
        return (pressure + 2.0 / self.length) / (SUNK * self.length)


def element_size(pattern: Pattern, pressure: float, largest: float) -> float:
    """Under many asperities: each a point support, or, where wet spots are too wide for that, so
    fine that they are resolved; ``largest`` : for the droplet itself."""
    if pattern.narrow(pressure):
        return min(pattern.spacing / PER_SPACING[1], largest)
    return min(pattern.length / PER_SPOT[0], pattern.spot(pressure) / PER_SPOT[1])


PARTS = np.linspace(FINE, 0.97, 221)
"""Parts of the elements under the foot to choose from."""


def _growth(reach: float, elements: Array | float) -> Array:
    """(parts,) largest growth from element to element beside a foot that takes each of the parts:
    of the slope ``s + A (1 - cos(pi t))`` of :class:`~iga_membrane.surface.closed.Stretch`."""
    s = np.minimum(reach / PARTS, 1.0)
    a = (1.0 - s) / (1.0 - PARTS)
    return np.asarray(np.pi * a / np.sqrt(s * s + 2.0 * s * a) / ((1.0 - PARTS) * elements))


def fine_part(reach: float, elements: int) -> float:
    """Largest part of the elements under the foot that the others can follow."""
    gentle = np.flatnonzero(_growth(reach, elements) <= GROWTH)
    return float(PARTS[gentle[-1] if len(gentle) else 0])


def graded(reach: float, under: float) -> float:
    """Elements from the middle to a side with as many under the foot, the others growing."""
    gentle = np.flatnonzero(_growth(reach, under / PARTS) <= GROWTH)
    return float(under / PARTS[gentle[-1] if len(gentle) else 0])


def cell_of(solid: Solid) -> float:
    """Area of the substrate per asperity; infinite without asperities."""
    if isinstance(solid, SphereLattice):
        return solid.area_per_sphere
    if isinstance(solid, Spheres):
        place = np.asarray(solid.centers)[:, :2]
        return float(np.prod(np.ptp(place, axis=0)) / len(place)) or np.inf
    return float(np.inf)
