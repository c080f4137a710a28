"""Droplets whose foot is a contact area at 180 degrees, on asperities or anything else.

The whole skin of the droplet is one closed membrane, evenly meshed under the droplet.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..solids import Solid, SphereLattice, Spheres
from ..splines import Space, pillow_space
from ..surface.closed import Meridian, Stretch, closed_surface, inverse_lemniscate_sine
from .liquid import Model
from .start import FlatDrop, flat_drop, rounded

STARTS = ("flat", "above", "touching")
PER_RADIUS = 3.35
"""Elements along the radius of the smallest asperity, by default."""
FEWEST = 48
"""Elements from the middle to a side at least, for the droplet itself."""
SOFTEST, HARDEST = 0.032, 500.0
"""Depth over radius of a penalty from which on the default mesh must be finer, by the power 0.51 of
the depth, for its dips to stay below a fifth of it; and the elements at most that this asks for."""
MOST = 600
"""The same at most, by default."""
SPREAD = 1.15
"""Growth of the finely meshed foot below 180 degrees; the same for all angles, so that paths in the
angle keep their mesh."""
FINE = 0.75
"""Part of the elements from the middle of the square to a side that lies under the foot."""


MANY = 100
"""Asperities under the foot from which they are many: the start is then the drop on their tops,
pressed on them, and contact is a hard penalty at all quadrature points."""
PER_SPOT = 2.2
"""Elements along the radius of the smallest of many asperities, by default."""
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
    stiffness : traction over depth of a penalty that was asked for, else 0: the mesh is then as
        fine as the depth asks for.
    """

    length: float
    cell: float = np.inf
    lies: bool = True
    stiffness: float = 0.0

    def many(self, foot: float) -> bool:
        """Whether many asperities lie under a foot of a radius."""
        return self.lies and np.pi * foot**2 > MANY * self.cell

    def sag(self, pressure: float) -> float:
        """Mean depth under the tops of a membrane of tension 1 that lies on a wide square lattice:
        the potential of a lattice of point forces ``pressure * cell``, cut off at spots of radius
        a, ``a^2 = pressure cell length / 2 pi``."""
        spot = np.sqrt(pressure * self.cell * self.length / (2.0 * np.pi))
        log = np.log(np.sqrt(self.cell) / spot) - ROBIN
        return float(pressure * self.cell * (2.0 * log + 1.0) / (4.0 * np.pi))

    def penalty(self, pressure: float) -> float:
        """Traction over depth with which the smallest asperity lets the membrane sink by
        ``SUNK``."""
        return (pressure + 2.0 / self.length) / (SUNK * self.length)


ROBIN = 1.3105329259
"""``log(2 pi |eta(i)|^2)``, eta being Dedekind's: constant of the potential of a unit square
lattice."""


@dataclass(frozen=True, eq=False)
class Skin:
    """Closed start of a droplet (dimensionless).

    Attributes
    ----------
    space, points, directions : of the membrane.
    pressure : estimated at its foot.
    many : whether many asperities carry it.
    """

    space: Space
    points: Array
    directions: Array
    pressure: float
    many: bool


def whole_skin(
    bond: float,
    volume: float,
    pattern: Pattern,
    degree: int,
    elements: int,
    start: object = None,
) -> Skin:
    """Flat-footed droplet of least energy, its foot meshed evenly.

    Parameters
    ----------
    bond : density times vertical gravity.
    elements : from the middle of the foot to the widest place; 0 for ``PER_RADIUS`` along the
        pattern's length.
    start : "above" or "touching" for a sphere; anything else for the flat-footed droplet.
    """
    length = pattern.length
    drop = rounded(bond, volume)
    many = pattern.many(drop.foot)
    if many:
        drop = flat_drop(bond, volume)
    wide = _foot(drop, pattern, many)
    meridian = _meridian(drop, wide)
    reach = inverse_lemniscate_sine(meridian.size_at(wide))
    if not elements:
        elements = _elements(drop, pattern, wide, reach, many)
    fine = _fine_part(reach, elements) if many else FINE
    stretch = Stretch(fine, reach / fine) if reach < fine else Stretch()
    space = pillow_space(degree, elements)
    points, directions = closed_surface(space, meridian, stretch)
    if start in STARTS[1:]:
        points, _ = closed_surface(
            space, ball((3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)), stretch
        )
        points[:, 2] += length if start == "above" else 0.0
    elif many:
        points[:, 2] -= 0.5 * pattern.sag(drop.pressure)
    return Skin(space, points, directions, drop.pressure, many)


def _foot(drop: FlatDrop, pattern: Pattern, many: bool) -> float:
    """How far out asperities may be wet."""
    widest = 0.95 * float(drop.r.max())
    wide = 1.1 * drop.foot * (1.0 if pattern.lies else SPREAD) + 2.0 * pattern.length
    if many:
        # the sag brings the rim, of curvature p, as much lower
        rim = np.sqrt(2.0 * pattern.sag(drop.pressure) / drop.pressure)
        wide = min(wide, drop.foot + rim + 1.5 * np.sqrt(pattern.cell))
    return float(min(wide, widest))


def _elements(drop: FlatDrop, pattern: Pattern, wide: float, reach: float, many: bool) -> int:
    """Elements from the middle of the foot to the widest place by default.

    Raises
    ------
    SceneError
        If the asperities are too small.
    """
    length, stiffness = pattern.length, pattern.stiffness
    across = wide / reach * min(reach / FINE, 1.0)  # length of the even elements, by their number
    needed = PER_RADIUS * across / length
    if many and not stiffness:
        needed = _graded(reach, PER_SPOT * wide / length)
    if stiffness:
        sunk = (drop.pressure + 2.0 / length) / stiffness / length
        needed = min(needed * max(1.0, (SOFTEST / sunk) ** 0.51), max(needed, HARDEST))
    if needed > MOST:
        raise SceneError(
            f"substrate.radius: asperities of {length:.2g} droplet radii need {needed:.0f} "
            f"elements from the middle to a side, more than {MOST}: not available yet; give "
            "larger asperities, or discretization.elements"
        )
    return max(FEWEST, int(np.ceil(needed)))


PARTS = np.linspace(FINE, 0.97, 221)
"""Parts of the elements under the foot to choose from."""


def _growth(reach: float, elements: Array | float) -> Array:
    """(parts,) largest growth from element to element beside a foot that takes each of the parts:
    of the slope ``s + A (1 - cos(pi t))`` of :class:`~iga_membrane.surface.closed.Stretch`."""
    s = np.minimum(reach / PARTS, 1.0)
    a = (1.0 - s) / (1.0 - PARTS)
    return np.asarray(np.pi * a / np.sqrt(s * s + 2.0 * s * a) / ((1.0 - PARTS) * elements))


def _fine_part(reach: float, elements: int) -> float:
    """Largest part of the elements under the foot that the others can follow."""
    gentle = np.flatnonzero(_growth(reach, elements) <= GROWTH)
    return float(PARTS[gentle[-1] if len(gentle) else 0])


def _graded(reach: float, under: float) -> float:
    """Elements from the middle to a side with as many under the foot, the others growing."""
    gentle = np.flatnonzero(_growth(reach, under / PARTS) <= GROWTH)
    return float(under / PARTS[gentle[-1] if len(gentle) else 0])


def _meridian(drop: FlatDrop, wide: float) -> Meridian:
    """The start's meridian; its directions are vertical as far out as asperities may be wet, and
    turn into its normals at the widest place."""
    widest = float(drop.r.max())
    part = np.clip((drop.r - wide) / (widest - wide), 0.0, 1.0)
    angle = np.pi - drop.turn
    angle = np.where(drop.turn > 0.5 * np.pi, angle * part**2 * (3.0 - 2.0 * part), angle)
    normal = np.stack([np.sin(angle), -np.cos(angle)], axis=-1)
    return Meridian(drop.r, drop.z, normal)


def ball(radius: float) -> Meridian:
    """A sphere that stands on the origin."""
    u = np.linspace(np.pi, 0.0, 2001)[1:-1]
    normal = np.stack([np.sin(u), np.cos(u)], axis=-1)
    return Meridian(radius * np.sin(u), radius * (1.0 + np.cos(u)), normal)


def smallest_model(solid: Solid, reach: float, lateral: tuple[float, float]) -> Model:
    """The smallest model whose mirror planes both the solid and gravity have.

    Parameters
    ----------
    reach : distance from the origin within which the solid counts.
    lateral : gravity along x and y.
    """
    sample = np.random.default_rng(0).uniform(-reach, reach, (400, 3)) * [1.0, 1.0, 0.1]
    gap = solid.nearest(sample).gap

    def mirrored(image: Array) -> bool:
        off = np.abs(solid.nearest(image).gap - gap).max(initial=0.0)
        return bool(off <= 1e-9 * reach)

    if lateral[1] or not mirrored(sample * [1.0, -1.0, 1.0]):
        return "full"
    if lateral[0] or not mirrored(sample * [-1.0, 1.0, 1.0]):
        return "half"
    return "eighth" if mirrored(sample[:, [1, 0, 2]]) else "quarter"


def cell_of(solid: Solid) -> float:
    """Area of the substrate per asperity; infinite without asperities."""
    if isinstance(solid, SphereLattice):
        return solid.area_per_sphere
    if isinstance(solid, Spheres):
        place = np.asarray(solid.centers)[:, :2]
        return float(np.prod(np.ptp(place, axis=0)) / len(place)) or np.inf
    return float(np.inf)
