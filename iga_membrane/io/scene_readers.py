"""From the tables of a scene file to its scene: one reader for each kind of scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import SceneError
from ..initial.closed_droplet import STARTS
from ..initial.liquid import Discretization, Liquid
from ..problems.capillary_bridge import capillary_bridge
from ..problems.cell import asperity_cell
from ..problems.droplet import sessile_droplet
from ..problems.film import film_between_rings
from ..problems.scene import Scene
from ..problems.sheet import liquid_sheet
from ..solids import Sphere, Spheres
from .scene_keys import later, membrane_of
from .substrates import facing_solid, substrate_of

Tables = dict[str, Mapping[str, Any]]


def _contact(table: Mapping[str, Any]) -> dict[str, Any]:
    """How contact areas are held, by the names of the scenes."""
    law: dict[str, Any] = {}
    if table.get("contact_line") == "line_load":
        return law
    if table.get("contact", "exact") == "penalty":
        law["penalty"] = table.get("penalty", 1e4)
    if "penetration_tolerance" in table:
        law["penetration_tolerance"] = table["penetration_tolerance"]
    return law


def _cell(data: Mapping[str, Any], tables: Tables) -> Scene:
    liquid, cell, substrate = tables["liquid"], tables["cell"], tables["substrate"]
    for field, table in (("cell.size", cell), ("cell.pressure", cell),
                         ("substrate.contact_angle", substrate)):  # fmt: skip
        if field.rpartition(".")[2] not in table:
            raise SceneError(f"{field}: missing; an asperity cell needs it")
    solid = substrate_of(dict(substrate) | {"kind": substrate.get("kind", "sphere")})
    if isinstance(solid, Spheres) and len(solid.centers) == 1 and solid.base is None:
        x, y, z = (float(c) for c in solid.centers[0])
        angle, radius = float(np.ravel(solid.contact_angle)[0]), float(np.ravel(solid.radii)[0])
        solid = Sphere(angle, radius, (x, y, z))
    if not isinstance(solid, Sphere):
        raise SceneError(
            f'substrate.kind = "{substrate["kind"]}": a cell holds one sphere, "sphere" or '
            '"spheres" with one centre, without a base'
        )
    return asperity_cell(
        solid,
        size=cell["size"],
        pressure=cell["pressure"],
        shape=cell.get("shape", "square"),
        liquid=Liquid(liquid.get("surface_tension", 1.0), liquid.get("density", 1.0)),
        discretization=Discretization(**tables["discretization"]),
        contact_line=_line(tables["solver"]),
        **_contact(tables["solver"]),
    )


def _droplet(data: Mapping[str, Any], tables: Tables) -> Scene:
    liquid, substrate = tables["liquid"], tables["substrate"]
    needed = [("liquid.volume", liquid)]
    if substrate.get("kind") not in ("none", "disc") and "wettability" not in substrate:
        needed.append(("substrate.contact_angle", substrate))
    for field, table in needed:
        if field.split(".")[1] not in table:
            raise SceneError(f"{field}: missing; a sessile droplet needs it")
    membrane = membrane_of(tables["solver"])
    return sessile_droplet(
        substrate_of(substrate),
        volume=liquid["volume"],
        liquid=Liquid(liquid.get("surface_tension", 1.0), liquid.get("density", 1.0)),
        gravity=_gravity(tables["gravity"]),
        discretization=Discretization(**tables["discretization"]),
        hold=tables["droplet"].get("hold", "none"),
        start=_start(tables["solver"]),
        contact_line=_line(tables["solver"]),
        particles=[_particle(f"particle[{i}]", p) for i, p in enumerate(data.get("particle", []))],
        membrane=membrane,
        **_contact(tables["solver"]),
    )


def _line(table: Mapping[str, Any]) -> str:
    """The way of the contact line; "line_load" is a membrane of its own."""
    way = str(table.get("contact_line", "auto"))
    return "auto" if way == "line_load" else way


def _start(table: Mapping[str, Any]) -> str | None:
    """A word; a state file is read by the solver."""
    start = table.get("start", "auto")
    return str(start) if start in STARTS else None


def _film(data: Mapping[str, Any], tables: Tables) -> Scene:
    liquid, rings = tables["liquid"], tables["rings"]
    if "volume" in liquid:
        raise SceneError("liquid.volume: a film's volume is rings.volume; move it there")
    if "half_height" not in rings:
        raise SceneError("rings.half_height: missing; a film between rings needs it")
    return film_between_rings(
        liquid=Liquid(liquid.get("surface_tension", 1.0), liquid.get("density", 1.0)),
        discretization=Discretization(**tables["discretization"]),
        **rings,
    )


def _sheet(data: Mapping[str, Any], tables: Tables) -> Scene:
    liquid, sheet = tables["liquid"], tables["sheet"]
    particles = data.get("particle", [])
    if len(particles) > 1:
        raise later(f"a sheet with {len(particles)} [[particle]] tables")
    if "volume" in liquid:
        raise SceneError("liquid.volume: a sheet's volume is sheet.volume; move it there")
    if "size" not in sheet:
        raise SceneError("sheet.size: missing; a liquid sheet needs it")
    gravity = _gravity(tables["gravity"])
    if gravity[0] or gravity[1] or gravity[2] > 0:
        raise later("a sheet with gravity that does not point along -z")
    return liquid_sheet(
        _particle("particle[0]", particles[0]) if particles else None,
        size=sheet["size"],
        boundary=sheet.get("boundary", "square"),
        liquid=Liquid(liquid.get("surface_tension", 1.0), liquid.get("density", 1.0)),
        gravity=abs(gravity[2]),
        pressure=sheet.get("pressure"),
        volume=sheet.get("volume"),
        liquid_weight=sheet.get("liquid_weight", False),
        discretization=Discretization(**tables["discretization"]),
        contact_line=_line(tables["solver"]),
        membrane=membrane_of(tables["solver"]),
    )


def _particle(field: str, given: Mapping[str, Any]) -> Sphere:
    for key in ("radius", "center", "contact_angle"):
        if key not in given:
            raise SceneError(f"{field}.{key}: missing; a particle needs it")
    return Sphere(
        given["contact_angle"],
        given["radius"],
        given["center"],
        given.get("density", 0.0),
        given.get("motion", "fixed"),
    )


def _bridge(data: Mapping[str, Any], tables: Tables) -> Scene:
    liquid, gap = tables["liquid"], tables["gap"]
    for field, table in (("liquid.volume", liquid), ("gap.distance", gap)):
        if field.split(".")[1] not in table:
            raise SceneError(f"{field}: missing; a capillary bridge needs it")
    gravity = _gravity(tables["gravity"])
    return capillary_bridge(
        facing_solid("lower", tables["lower"]),
        facing_solid("upper", tables["upper"]),
        gap=gap["distance"],
        volume=liquid["volume"],
        liquid=Liquid(liquid.get("surface_tension", 1.0), liquid.get("density", 1.0)),
        gravity=gravity,
        discretization=Discretization(**tables["discretization"]),
    )


READERS: dict[str, Callable[[Mapping[str, Any], Tables], Scene]] = {
    "sessile_droplet": _droplet,
    "asperity_cell": _cell,
    "film_between_rings": _film,
    "liquid_sheet": _sheet,
    "capillary_bridge": _bridge,
}
"""Kind of scene to its reader, which takes the whole file and its tables."""
BRIDGES = "lower", "upper", "gap"
FOREIGN = {
    "sessile_droplet": ("sheet", "cell", "rings", *BRIDGES),
    "asperity_cell": ("gravity", "particle", "droplet", "sheet", "rings", *BRIDGES),
    "film_between_rings": ("gravity", "substrate", "particle", "droplet", "sheet", "cell",
                           *BRIDGES),
    "liquid_sheet": ("substrate", "droplet", "cell", "rings", *BRIDGES),
    "capillary_bridge": ("substrate", "particle", "droplet", "sheet", "cell", "rings"),
}  # fmt: skip
"""Kind of scene to the tables that do not belong to it."""


def _gravity(table: Mapping[str, Any]) -> list[float]:
    if "direction" in table and "acceleration" not in table:
        raise SceneError("gravity.acceleration: missing, but gravity.direction is given")
    size = float(table.get("acceleration", 0.0))
    direction = np.array(table.get("direction", [0.0, 0.0, -1.0]), float)
    direction = direction / np.abs(direction).max()
    return [float(g) for g in size * direction / np.linalg.norm(direction)]


def solver_limits(table: Mapping[str, Any], kind: str) -> dict[str, Any]:
    """The solver's limits and start by the names of ``SolverOptions``."""
    if kind not in ("sessile_droplet", "liquid_sheet") and membrane_of(table) is not None:
        raise later(f'solver.contact_line = "line_load" in scene = "{kind}"')
    limits: dict[str, Any] = {
        key: float(table[key]) for key in ("max_cpu_s", "max_memory_gb") if key in table
    }
    for key in ("follow_instability", "stability"):
        if key in table:
            limits[key] = table[key]
    start = table.get("start", "auto")
    return limits | {"start": start} if start.endswith(".npz") else limits
