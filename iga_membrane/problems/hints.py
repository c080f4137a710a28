"""What a user should know about the numbers of a scene before it is solved."""

from __future__ import annotations

import numpy as np

from ..initial.liquid import Liquid
from ..solids import Plane, Solid
from ..solids.wettability import least_angle
from ..units import implausible, length_as_text, says_si

HEAVY = 1e4
"""Bond number above which a droplet is called a puddle: it is then a hundredth of its width high,
and half of its energy changes by less than 1e-2 with the surface tension."""


def hints(
    substrate: Solid, liquid: Liquid, volume: float, weight: float, bond: tuple[float, ...]
) -> tuple[str, ...]:
    """Of a droplet.

    Parameters
    ----------
    weight : size of the acceleration.
    bond : Bond numbers along the scene's axes.
    """
    angle = least_angle(substrate.contact_angle)
    texts = list(implausible(weight, liquid.surface_tension, liquid.density, volume))
    if 0.0 < angle <= np.pi:
        texts.append(
            f"substrate.contact_angle = {angle:g}: degrees? An angle below pi degrees is rare; "
            "angles are in degrees through the liquid"
        )
    if angle == 180.0 and isinstance(substrate, Plane) and not any(bond):
        texts.append(
            "at 180 degrees without gravity a droplet touches its plane in a point: it rolls along "
            "x and y and lifts off freely"
        )
    size = float(np.linalg.norm(bond))
    if size > HEAVY and angle > 0.0:  # a perfectly wet one is a film
        texts.append(_heavy(size, liquid, volume, weight, angle))
    return tuple(texts)


def _heavy(bond: float, liquid: Liquid, volume: float, weight: float, angle: float) -> str:
    """What a large Bond number means: a puddle of the height ``2 sin(theta / 2) sqrt(gamma / rho
    g)`` and the volume ``pi (width / 2)^2 height``."""
    capillary = np.sqrt(liquid.surface_tension / (liquid.density * weight))
    height = 2.0 * np.sin(0.5 * np.radians(angle)) * capillary
    width = 2.0 * np.sqrt(volume / (np.pi * height))
    high, wide = (length_as_text(float(one), si=says_si(weight)) for one in (height, width))
    return (
        f"Bond number {bond:.2g}: on a level plane this is a puddle {high} high and {wide} wide; "
        "are liquid.volume, gravity and surface_tension in one set of units?"
    )
