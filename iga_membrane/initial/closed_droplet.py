"""Droplets whose foot is a contact area at 180 degrees, on asperities or anything else.

The whole skin of the droplet is one closed membrane, evenly meshed under the droplet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..dofs.boundary_conditions import Model
from ..errors import SceneError
from ..solids import Solid, Sphere, Spheres
from ..solids.wettability import cosine_of, varies
from ..splines import Space, pillow_space
from ..surface.closed import Meridian, Stretch, closed_surface, inverse_lemniscate_sine
from ..surface.surface import Surface
from .particle_placement import mirrored_model
from .profiles import FlatDrop, flat_drop, rounded
from .resolution import FEW, FINE, LEAST, RING, Pattern, element_size, fine_part, graded

STARTS = ("flat", "above", "touching")
PER_RADIUS = 3.35
"""Elements along the radius of the smallest asperity, by default."""
FEWEST = 48
"""Elements from the middle to a side at least, for the droplet itself."""
MOST = 600
"""The same at most, by default."""
SPREAD = 1.15
"""Growth of the finely meshed foot below 180 degrees; the same for all angles, so that paths in the
angle keep their mesh."""


@dataclass(frozen=True, eq=False)
class Spot:
    """A part of the skin beside its foot, round a place near it.

    Attributes
    ----------
    center : (3,) that place; radius : of the part beyond the distance to the skin.
    element : largest element in it.
    """

    center: Array
    radius: float
    element: float


NARROW_LINE, PER_LINE = 0.4, 4.0
"""Radius of a particle's line over its own, at least, and elements along it."""


def fine_at(particle: Sphere) -> Spot:
    """Where a particle's line is, and what resolves it."""
    sine = float(np.sin(np.radians(particle.contact_angle)))
    line = particle.radius * max(sine, NARROW_LINE)
    return Spot(np.array(particle.center), 0.5 * line, line / PER_LINE)


@dataclass(frozen=True, eq=False)
class Skin:
    """Closed start of a droplet (dimensionless).

    Attributes
    ----------
    space, points, directions : of the membrane.
    pressure : estimated at its foot.
    many : whether many asperities carry it.
    ring : radius of the rings on which each of them does, or None.
    """

    space: Space
    points: Array
    directions: Array
    pressure: float
    many: bool
    ring: float | None


def whole_skin(
    bond: float,
    volume: float,
    pattern: Pattern,
    degree: int,
    elements: int,
    start: object = None,
    spots: Sequence[Spot] = (),
) -> Skin:
    """Flat-footed droplet of least energy, its foot meshed evenly.

    Parameters
    ----------
    bond : density times vertical gravity.
    elements : from the middle of the foot to the widest place; 0 for ``PER_RADIUS`` along the
        pattern's length.
    start : "above" or "touching" for a sphere; anything else for the flat-footed droplet.
    spots : where the skin must be as fine as in its foot.
    """
    length = pattern.length
    drop = rounded(bond, volume)
    many = pattern.many(drop.foot)
    if many:
        drop = flat_drop(bond, volume)
    wide = _foot(drop, pattern, many)
    meridian = _meridian(drop, wide)
    reach = inverse_lemniscate_sine(meridian.size_at(wide))
    known = many or (elements and pattern.repels and pattern.under(drop.foot) > FEW)
    if spots:
        fine, needed = _finest(meridian, reach, PER_RADIUS * wide / length, spots)
        elements = elements or needed
    else:
        elements = elements or _elements(drop, pattern, wide, reach, many)
        fine = fine_part(reach, elements) if many else FINE
    coarse = known and pattern.unresolved(drop.pressure, wide / (fine * elements))
    ring = RING * pattern.spot(drop.pressure) if coarse else None
    stretch = Stretch(fine, reach / fine) if reach < fine or spots else Stretch()
    space = pillow_space(degree, elements, stretch.aspect)
    points, directions = closed_surface(space, meridian, stretch)
    if start in STARTS[1:]:
        whole = ball((3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0))
        points, _ = closed_surface(space, whole, stretch)
        points[:, 2] += length if start == "above" else 0.0
    elif many:
        points[:, 2] -= 0.5 * pattern.sag(drop.pressure)
    return Skin(space, points, directions, drop.pressure, many, ring)


def _foot(drop: FlatDrop, pattern: Pattern, many: bool) -> float:
    """How far out asperities may be wet."""
    widest = 0.95 * float(drop.r.max())
    spreads = not pattern.lies or (many and not pattern.repels and pattern.narrow(drop.pressure))
    wide = 1.1 * drop.foot * (SPREAD if spreads else 1.0) + 2.0 * pattern.length
    if many and pattern.repels:
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
    length = pattern.length
    across = wide / reach * min(reach / FINE, 1.0)  # length of the even elements, by their number
    needed = PER_RADIUS * across / length
    if many and not pattern.penalized:
        size = length / PER_RADIUS
        if pattern.repels or pattern.narrow(drop.pressure):
            size = element_size(pattern, drop.pressure, wide / (FINE * LEAST))
        needed = graded(reach, wide / size)
    if needed > MOST:
        raise SceneError(
            f"substrate.radius: asperities of {length:.2g} droplet radii need {needed:.0f} "
            f"elements from the middle to a side, more than {MOST}: not available yet; give "
            "larger asperities, or discretization.elements"
        )
    least = LEAST if many and pattern.narrow(drop.pressure) else FEWEST
    return max(least, int(np.ceil(needed)))


def _finest(
    meridian: Meridian, reach: float, under: float, spots: Sequence[Spot]
) -> tuple[float, int]:
    """The part of the elements under the foot with which fewest are needed from the middle to the
    widest place, and their number.

    Parameters
    ----------
    reach : of the foot, over that of the widest place, on the square without stretch.
    under : elements that the foot needs.

    Raises
    ------
    SceneError
        If a spot is too small.
    """
    chosen, fewest = FINE, (np.inf, -1)
    for fine in PARTS_BELOW:
        stretch = Stretch(float(fine), reach / fine)
        if stretch.aspect < STEEPEST:
            continue
        needed = [(under / fine, -1)]
        space = pillow_space(2, SAMPLE, stretch.aspect)
        surface = Surface(space, closed_surface(space, meridian, stretch)[0])
        ticks = np.linspace(-1.0, 1.0, 4 * SAMPLE + 2)[1:-1]
        k = surface.at(np.stack(np.meshgrid(ticks, ticks, indexing="ij"), axis=-1), 1)
        for i, spot in enumerate(spots):
            away = np.linalg.norm(k.position - spot.center, axis=-1)
            lengths = np.linalg.norm(k.tangents, axis=-1)[away < spot.radius + away.min()]
            needed.append((float(lengths.max()) / spot.element, i))
        if max(needed) < fewest:
            chosen, fewest = float(fine), max(needed)
    count, which = fewest
    if which >= 0 and count > MOST_AT_SPOTS:
        raise SceneError(
            f"particle[{which}].radius: its contact line needs {count:.0f} elements from the "
            f"middle of the foot to the widest place, more than {MOST_AT_SPOTS}: not available "
            "yet on asperities; give a larger particle, or discretization.elements"
        )
    return chosen, max(FEWEST, int(np.ceil(count)))


PARTS_BELOW = np.linspace(0.45, 0.75, 9)
"""Parts of the elements under the foot to choose from where others must be fine, too."""
STEEPEST = 0.2
"""Least size of an element at the top over that in the foot, on the square."""
SAMPLE = 24
"""Elements from the middle to a side with which these are compared."""
MOST_AT_SPOTS = 160
"""Elements from the middle to a side at most, by default, for spots beside the foot."""


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


def smallest_model(
    solid: Solid, reach: float, lateral: tuple[float, float], particles: Sequence[Sphere] = ()
) -> Model:
    """The smallest model whose mirror planes the solid, gravity and particles have.

    Parameters
    ----------
    reach : distance from the origin within which the solid counts.
    lateral : gravity along x and y.
    """
    sample = np.random.default_rng(0).uniform(-reach, reach, (400, 3)) * [1.0, 1.0, 0.1]
    if isinstance(solid, Spheres):
        # a place tells nothing of the angle there
        near = solid.within(reach)
        radii = solid.radius_of(near)
        sample = solid.center_of(near) + 0.5 * radii[:, None] * [0.0, 0.0, 1.0]
        kinds = np.column_stack([radii, solid.angle_of(near)])
    at = solid.nearest(sample)

    def mirrored(image: Array) -> bool:
        there = solid.nearest(image)
        off = np.abs(there.gap - at.gap).max(initial=0.0)
        if varies(solid.contact_angle):
            wet = [cosine_of(solid.contact_angle, x, at.which)[0] for x in (sample, image)]
            off = max(off, np.abs(wet[1] - wet[0]).max(initial=0.0))
        if isinstance(solid, Spheres):
            which = there.which
            known = np.column_stack([solid.radius_of(which), solid.angle_of(which)])
            off = max(off, np.abs(known - kinds).max(initial=0.0))
        return bool(off <= 1e-9 * reach)

    model: Model = "eighth" if mirrored(sample[:, [1, 0, 2]]) else "quarter"
    if lateral[0] or not mirrored(sample * [-1.0, 1.0, 1.0]):
        model = "half"
    if lateral[1] or not mirrored(sample * [1.0, -1.0, 1.0]):
        model = "full"
    return mirrored_model(particles, model, pairs=True) if particles else model
