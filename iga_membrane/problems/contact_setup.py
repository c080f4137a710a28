"""The feet of a droplet: a contact line, a contact area, a flat foot that ends tangentially."""

from __future__ import annotations

from dataclasses import replace

from ..errors import SceneError
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..solids.disc import Disc
from ..solids.wettability import least_angle, varies
from .any_solid_foot import through_any
from .one_asperity import one_asperity
from .smooth_foot import on_a_line, on_a_rim, on_the_plane
from .spec import Foot, Question
from .whole_foot import on_an_area, through_one

CONTACT_LINES = ("auto", "conforming", "trimmed", "adhesion")


def foot_of(parts: Question) -> Foot:
    """The kind of foot that a substrate and its contact angle make."""
    solid, way = parts.substrate, parts.contact_line
    _check_way(solid, way)
    if isinstance(solid, Disc):
        return on_a_rim(parts)
    if isinstance(solid, (SphereLattice, Spheres)) and way == "conforming":
        return on_a_line(replace(parts, substrate=one_asperity(solid, parts.scale.length)))
    if isinstance(solid, Sphere) and way == "trimmed":
        return through_one(parts)
    ends = _is_known(solid) and not varies(solid.contact_angle) and way != "trimmed"
    if least_angle(solid.contact_angle) < 180.0 and not (ends or _is_rough(solid)):
        return through_any(parts)
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
    refused: tuple[str, ...] = ("adhesion",)
    if _is_rough(solid):
        refused = ()
    elif not _is_known(solid) or varies(solid.contact_angle):
        refused = ("conforming", "adhesion")
    if least_angle(solid.contact_angle) == 180.0 and not isinstance(solid, Sphere):
        refused = () if _is_rough(solid) else CONTACT_LINES[1 + _is_known(solid) :]
    if way in refused:
        raise SceneError(
            f'solver.contact_line = "{way}": not available here; on a plane and on one sphere it '
            'is "conforming" or "trimmed", on asperities "trimmed", or "adhesion" near 180 '
            'degrees, on other solids and wettabilities "trimmed"; "auto" knows'
        )


def _is_known(solid: Solid) -> bool:
    """Whether the membrane can end on a solid, or lies on its spheres."""
    return isinstance(solid, (Plane, Sphere, SphereLattice, Spheres))


def _is_rough(solid: Solid) -> bool:
    """Whether it is many asperities."""
    return isinstance(solid, (SphereLattice, Spheres))
