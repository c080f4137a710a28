"""Droplets whose foot is a contact area at 180 degrees, on asperities or anything else.

The whole skin of the droplet is one closed membrane, evenly meshed under the droplet.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..solids import Solid
from ..splines import Space, pillow_space
from ..splines.quadrature import gauss
from ..surface.closed import Meridian, Stretch, closed_surface, inverse_lemniscate_sine
from .liquid import Model
from .start import Pancake, least_energy_pancake

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


@dataclass(frozen=True, eq=False)
class Skin:
    """Closed start of a droplet (dimensionless).

    Attributes
    ----------
    space, points, directions : of the membrane.
    pressure : estimated at its foot.
    """

    space: Space
    points: Array
    directions: Array
    pressure: float


def whole_skin(
    bond: float,
    volume: float,
    length: float,
    degree: int,
    elements: int,
    lies: bool = True,
    start: object = None,
    stiffness: float = 0.0,
) -> Skin:
    """Flat-footed droplet of least energy, its foot meshed evenly.

    Parameters
    ----------
    bond : density times vertical gravity.
    length : over which the contact changes: radius of the smallest asperity.
    elements : from the middle of the foot to the widest place; 0 for ``PER_RADIUS`` along
        ``length``.
    lies : whether the membrane lies on the asperities; where it passes through them, below 180
        degrees, more of them are wet.
    start : "above" or "touching" for a sphere; anything else for the flat-footed droplet.
    stiffness : traction over depth of a penalty, 0 without: the mesh is then as fine as the depth
        asks for.
    """
    pancake = least_energy_pancake(180.0, bond, volume, steepest=180.0)
    pressure = estimated_pressure(pancake, bond, volume)
    foot = estimated_foot(pancake, bond, volume)
    foot *= 1.0 if lies else SPREAD
    widest = pancake.flat + pancake.radius
    wide = min(1.1 * foot + 2.0 * length, 0.95 * widest)
    meridian = _meridian(pancake, wide)
    reach = inverse_lemniscate_sine(meridian.size_at(wide))
    stretch = Stretch(FINE, reach / FINE) if reach < FINE else Stretch()
    if not elements:
        # physical length of the even elements, times their number
        across = wide / reach * stretch.slope
        needed = PER_RADIUS * across / length
        if stiffness:
            sunk = (pressure + 2.0 / length) / stiffness / length
            needed = min(needed * max(1.0, (SOFTEST / sunk) ** 0.51), max(needed, HARDEST))
        if needed > MOST:
            raise SceneError(
                f"substrate.radius: asperities of {length:.2g} droplet radii need {needed:.0f} "
                f"elements from the middle to a side, more than {MOST}: not available yet; give "
                "larger asperities, or discretization.elements"
            )
        elements = max(FEWEST, int(np.ceil(needed)))
    space = pillow_space(degree, elements)
    points, directions = closed_surface(space, meridian, stretch)
    if start in STARTS[1:]:
        points, _ = closed_surface(
            space, ball((3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)), stretch
        )
        points[:, 2] += length if start == "above" else 0.0
    return Skin(space, points, directions, pressure)


def estimated_foot(pancake: Pancake, bond: float, volume: float) -> float:
    """Contact radius on a plane at 180 degrees: weight over pressure."""
    pressure = estimated_pressure(pancake, bond, volume)
    return float(np.sqrt(bond * volume / (np.pi * pressure)))


def estimated_pressure(pancake: Pancake, bond: float, volume: float) -> float:
    """Pressure at a plane at 180 degrees, by the virial ``3 p V = 2 E_surf + 4 E_grav`` of the
    start."""
    u, w = gauss(20)
    angle = pancake.turn * u
    r = pancake.flat + pancake.radius * np.sin(angle)
    z = pancake.radius * pancake.aspect * (np.cos(angle) - np.cos(pancake.turn))
    rate = pancake.radius * pancake.turn * w
    area = 2.0 * np.pi * r @ (rate * np.hypot(np.cos(angle), pancake.aspect * np.sin(angle)))
    area += 2.0 * np.pi * pancake.flat**2
    weight = bond * np.pi * (r**2 * z) @ (rate * pancake.aspect * np.sin(angle))
    return float((2.0 * area + 4.0 * weight) / (3.0 * volume))


def _meridian(pancake: Pancake, wide: float) -> Meridian:
    """The start's meridian; its directions are vertical as far out as asperities may be wet, and
    turn into its normals at the widest place."""
    u = np.linspace(pancake.turn, 0.0, 2001)
    b, rho, a = pancake.flat, pancake.radius, pancake.aspect
    r, z = b + rho * np.sin(u), rho * a * (np.cos(u) - np.cos(pancake.turn))
    angle = np.arctan2(a * np.sin(u), -np.cos(u))
    part = np.clip((r - wide) / (b + rho - wide), 0.0, 1.0)
    angle = np.where(u > 0.5 * np.pi, angle * part**2 * (3.0 - 2.0 * part), angle)
    inside = r >= 1e-3 * rho
    normal = np.stack([np.sin(angle), -np.cos(angle)], axis=-1)
    return Meridian(r[inside], z[inside], normal[inside])


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
