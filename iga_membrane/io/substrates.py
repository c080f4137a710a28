"""The substrates of scene files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import SceneError
from ..files import read_file
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..solids.cylinder import Cylinder
from ..solids.disc import Disc
from ..solids.height_map import HeightMap
from ..solids.wettability import patch, stripes

Table = Mapping[str, Any]
LARGEST_MAP = 1_000_000_000
"""Bytes of a measured map at most."""


def substrate_of(table: Table) -> Solid | None:
    """The solid under a droplet, None for a free one; a sphere, a fibre or a lattice has its tops
    at z = 0.

    Raises
    ------
    SceneError
    """
    kind = table.get("kind", "plane")
    _check_fields(table, f'substrate.kind = "{kind}"', _FIELDS[kind], _NEEDED[kind])
    angle = _angle(table, kind)
    return _KINDS[kind](table, angle)


def facing_solid(name: str, table: Table) -> Plane | Sphere:
    """The solid below or above a bridge.

    Parameters
    ----------
    name : of the table, "lower" or "upper".

    Raises
    ------
    SceneError
    """
    kind = table.get("kind", "plane")
    allowed, needed = _FACING[kind]
    _check_fields(table, f'{name}.kind = "{kind}"', allowed, needed, name)
    angle = table.get("contact_angle", 90.0)
    if kind == "disc":
        return _disc(table, angle)
    return Plane(angle) if kind == "plane" else Sphere(angle, table["radius"])


def _disc(table: Table, angle: Any) -> Disc:
    return Disc(angle, radius=table["radius"], edge=table.get("edge", 90.0))


def _angle(table: Table, kind: str) -> Any:
    """The contact angle, or the field in its place."""
    if "wettability" in table and "contact_angle" in table:
        raise SceneError(
            "substrate.contact_angle, substrate.wettability: both are given; give one of them"
        )
    if "wettability" in table:
        return _field(table["wettability"])
    angle = table.get("contact_angle", 90.0 if kind == "disc" else None)
    if isinstance(angle, list) and kind != "spheres":
        raise SceneError(f"substrate.contact_angle = {angle}: one number is needed here")
    if angle is None and kind != "none":
        raise SceneError("substrate.contact_angle: missing; a substrate needs it")
    return angle


def _field(table: Table) -> Any:
    """A pattern of contact angles."""
    kind = table.get("kind")
    fields = {"stripes": ("period", "border"), "patch": ("radius", "border")}
    if kind not in fields:
        raise SceneError(
            f"substrate.wettability.kind = {kind!r}: must be one of {', '.join(map(repr, fields))}"
        )
    needed = ("angles", *fields[kind])
    _check_fields(table, f"substrate.wettability.kind = \"{kind}\"", needed, needed,
                  "substrate.wettability")  # fmt: skip
    if len(table["angles"]) != 2:
        raise SceneError(f"substrate.wettability.angles = {table['angles']}: two are needed")
    make = stripes if kind == "stripes" else patch
    return make(*table["angles"], *(table[name] for name in fields[kind]))


def _check_fields(
    table: Table,
    told: str,
    allowed: tuple[str, ...],
    needed: tuple[str, ...],
    name: str = "substrate",
) -> None:
    """Refuse fields that a kind does not have, or lacks."""
    for key in table:
        if key != "kind" and key not in allowed:
            raise SceneError(
                f"{name}.{key}: {told} has no such field, only {', '.join(allowed) or 'its kind'}; "
                "remove it or choose another kind"
            )
    for key in needed:
        if key not in table:
            raise SceneError(f"{name}.{key}: missing; {told} needs it")


def _height_map(table: Table, angle: Any) -> HeightMap:
    """A surface z = h(x, y) of a shape."""
    shape = table["shape"]
    fields = _SHAPES[shape]
    optional = {"pillars": ("arrangement", "offset"), "grid": ("scale",)}.get(shape, ())
    _check_fields(table, f"substrate.shape = \"{shape}\"", ("shape", "contact_angle", "wettability",
                  *fields, *optional), fields)  # fmt: skip
    if shape == "grid":
        return _grid(table["file"], angle, table.get("scale"))
    given = {name: table[name] for name in (*fields, *optional) if name in table}
    make: Callable[..., HeightMap] = getattr(HeightMap, shape)
    return make(**given, contact_angle=angle)


def _grid(path: str, angle: Any, scale: float | None) -> HeightMap:
    """A measured map of an npz file with x (n), y (m), z (n, m)."""
    data = read_file(Path(path), LARGEST_MAP, SceneError)
    try:
        with np.load(BytesIO(data), allow_pickle=False) as found:
            x, y, z = (np.asarray(found[name], float) for name in ("x", "y", "z"))
    except (ValueError, KeyError, OSError, EOFError) as error:
        raise SceneError(
            f"substrate.file = {path!r}: must be an npz file with arrays x (n), y (m), z (n, m); "
            f"{error}"
        ) from error
    if scale is None:
        scale = 4.0 * max(float(np.diff(x).min(initial=np.inf)),
                          float(np.diff(y).min(initial=np.inf)))  # fmt: skip
    return HeightMap.from_grid(x, y, z, contact_angle=angle, scale=scale)


def _sphere(table: Table, angle: Any) -> Sphere:
    x, y = _offset(table)
    return Sphere(angle, table["radius"], (x, y, -table["radius"]))


def _lattice(table: Table, angle: Any) -> SphereLattice:
    arrangement = table.get("arrangement", "square")
    return SphereLattice(angle, table["radius"], table["spacing"], arrangement, _offset(table),
                         table.get("base"))  # fmt: skip


def _offset(table: Table) -> tuple[float, float]:
    x, y = table.get("offset", (0.0, 0.0))
    return float(x), float(y)


_KINDS: dict[str, Callable[[Table, Any], Solid | None]] = {
    "none": lambda table, angle: None,
    "plane": lambda table, angle: Plane(angle),
    "sphere": _sphere,
    "sphere_lattice": _lattice,
    "spheres": lambda table, angle: Spheres(
        angle, table["centers"], table["radii"], table.get("base")
    ),
    "height_map": _height_map,
    "disc": _disc,
    "cylinder": lambda table, angle: Cylinder(
        angle, table["radius"], axis=table.get("axis", (0.0, 1.0, 0.0))
    ),
}
_SHAPES: dict[str, tuple[str, ...]] = {
    "bump": ("height", "width"),
    "egg_carton": ("amplitude", "period"),
    "grooves": ("amplitude", "period"),
    "pillars": ("radius", "height", "spacing", "edge"),
    "two_level": ("amplitudes", "periods"),
    "grid": ("file",),
}
"""Shape of a height map to the fields that it needs."""
_FIELDS: dict[str, tuple[str, ...]] = {
    "none": (),
    "plane": ("contact_angle", "wettability"),
    "sphere": ("contact_angle", "radius", "offset"),
    "sphere_lattice": ("contact_angle", "radius", "spacing", "arrangement", "offset", "base"),
    "spheres": ("contact_angle", "centers", "radii", "base"),
    "height_map": ("contact_angle", "wettability", "shape", "arrangement", "offset", "scale",
                   *dict.fromkeys(name for names in _SHAPES.values() for name in names)),
    "cylinder": ("contact_angle", "wettability", "radius", "axis"),
    "disc": ("contact_angle", "radius", "edge"),
}  # fmt: skip
_FACING: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "plane": (("contact_angle",), ("contact_angle",)),
    "sphere": (("contact_angle", "radius"), ("contact_angle", "radius")),
    "disc": (("contact_angle", "radius", "edge"), ("radius",)),
}
"""Kinds of solids that a bridge joins to the fields that they have, and that they need."""
_NEEDED: dict[str, tuple[str, ...]] = {
    "none": (),
    "plane": (),
    "sphere": ("radius",),
    "sphere_lattice": ("radius", "spacing"),
    "spheres": ("centers", "radii"),
    "height_map": ("shape",),
    "cylinder": ("radius",),
    "disc": ("radius",),
}
