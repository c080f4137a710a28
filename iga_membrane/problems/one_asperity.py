"""A droplet so small that it stands on one asperity of many."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError
from ..initial.profiles import drop_on_sphere
from ..solids import Solid, Sphere, SphereLattice, Spheres
from .spec import BALL
from .whole_foot import SHARP

CLEAR = 1.1
"""Distance of the other asperities from the middle of the weightless cap, over its radius."""


def discretizations(
    solid: Solid | None, length: float, pushed: bool, contact_line: str
) -> tuple[str, ...]:
    """How the membrane meets asperities, the first choice first and then what is tried where it
    fails.

    Parameters
    ----------
    length : of a droplet, the radius of a ball of its volume.
    pushed : whether gravity pushes it off its asperity, to others.
    """
    if contact_line != "auto" or pushed or _alone(solid, length) is None:
        return (contact_line,)
    assert solid is not None
    resolved = np.min(solid.contact_angle) <= SHARP
    return "conforming", "trimmed" if resolved else "adhesion"


def one_asperity(solid: SphereLattice | Spheres, length: float) -> Sphere:
    """The asperity on whose top, at the origin, the weightless droplet is clear of all others.

    Raises
    ------
    SceneError
        If there is none.
    """
    found = _alone(solid, length)
    if found is None:
        raise SceneError(
            'solver.contact_line = "conforming": on asperities only for a droplet that stands on '
            "one alone, below 180 degrees, whose top is the origin; leave it out"
        )
    return found


def _alone(solid: Solid | None, length: float) -> Sphere | None:
    if not isinstance(solid, (SphereLattice, Spheres)):
        return None
    at = solid.nearest(np.zeros((1, 3)))
    center, angle = solid.center_of(at.which)[0], float(solid.angle_of(at.which)[0])
    radius = float(solid.radius_of(at.which)[0])
    if angle == 180.0 or np.abs(center + [0.0, 0.0, radius]).max() > 1e-9 * length:
        return None
    polar, cap = drop_on_sphere(angle, radius / length, BALL)
    free = cap.radius * length
    middle = radius * (np.cos(polar) - 1.0) - free * np.cos(cap.turn)
    # of equal spheres the neighbours are nearest
    reach = 1.5 * solid.spacing if isinstance(solid, SphereLattice) else np.inf
    others = np.setdiff1d(solid.within(reach), at.which)
    away = np.linalg.norm(solid.center_of(others) - [0.0, 0.0, middle], axis=-1)
    clear = np.all(away - solid.radius_of(others) > CLEAR * free)
    x, y, z = (float(c) for c in center)
    return Sphere(angle, radius, (x, y, z)) if clear else None
