"""The feet of a droplet: a contact line, a contact area, a flat foot that ends tangentially."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..errors import SceneError
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from .one_asperity import one_asperity
from .smooth_foot import on_a_line, on_the_plane
from .spec import Foot, Question
from .whole_foot import on_an_area, through_one

CONTACT_LINES = ("auto", "conforming", "trimmed", "adhesion")


def foot_of(parts: Question) -> Foot:
    """The kind of foot that a substrate and its contact angle make."""
    solid, way = parts.substrate, parts.contact_line
    _check_way(solid, way)
    if isinstance(solid, (SphereLattice, Spheres)) and way == "conforming":
        return on_a_line(replace(parts, substrate=one_asperity(solid, parts.scale.length)))
    if isinstance(solid, Sphere) and way == "trimmed":
        return through_one(parts)
    if isinstance(solid, (Plane, Sphere)) and solid.contact_angle < 180.0:
        return on_a_line(parts)
    exact = parts.law.penalty is None and parts.start is None
    return on_the_plane(parts) if isinstance(solid, Plane) and exact else on_an_area(parts)


def _check_way(solid: Solid, way: str) -> None:
    """Refuse a kind of contact that a solid does not have.

    Raises
    ------
    SceneError
    """
    own = not isinstance(solid, (Plane, Sphere, SphereLattice, Spheres))
    if own and np.min(solid.contact_angle) < 180.0:
        raise SceneError(
            f"substrate.contact_angle = {np.min(solid.contact_angle):g}: contact lines are known "
            "on planes and spheres only; on a solid of your own the membrane lies, at 180 degrees"
        )
    refused: tuple[str, ...] = CONTACT_LINES[1:] if own else ("trimmed", "adhesion")
    if isinstance(solid, (SphereLattice, Spheres)):
        refused = ()
    elif isinstance(solid, Sphere):
        refused = ("adhesion",)
    if way in refused:
        raise SceneError(
            f'solver.contact_line = "{way}": not available here; on a plane it is "conforming", on '
            'one sphere also "trimmed", on asperities "trimmed", or "adhesion" near 180 degrees; '
            '"auto" knows'
        )
