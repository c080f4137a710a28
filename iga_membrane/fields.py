"""The fields of a scene, each with its rule: for scene files and for Python alike.

A file's value that its rule refuses is refused in Python too, and by the same words. What only some
kinds of scenes allow is narrowed where they are made.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

from .checks import (
    NOT_NEGATIVE,
    POSITIVE,
    Rule,
    contact_angle,
    direction,
    either,
    flag,
    integer,
    items,
    listed,
    number,
    one_or_more,
    pair,
    path,
    refusal,
    state_file,
    suggestion,
    text,
    vector,
    wet_angle,
    words,
)
from .errors import SceneError

LONGEST_PATH = 10_000
"""Values of a path at most."""


def path_values(field: str, values: Any) -> tuple[float, ...]:
    """Two or more finite numbers, each different from the one before; a path may turn back."""
    if not listed(values):
        raise refusal(field, values, "a list of two or more numbers is needed", "give them")
    given = list(values)
    if not 2 <= len(given) <= LONGEST_PATH:
        told = given if len(given) < 2 else f"{len(given)} numbers"
        raise SceneError(
            f"{field} = {told}: a path needs two or more values, at most {LONGEST_PATH}"
        )
    checked = tuple(number(f"{field}[{i}]", value) for i, value in enumerate(given))
    for i in range(1, len(checked)):
        if checked[i] == checked[i - 1]:
            raise SceneError(f"{field}[{i}] = {checked[i]!r}: the same as the value before it")
    return checked


def as_acceleration(field: str, value: Any) -> tuple[float, float, float]:
    """A vector, or its size along -z."""
    if listed(value):
        return vector(field, value)
    return 0.0, 0.0, -number("gravity.acceleration", value, least=0.0)


def table(field: str, value: Any, *, fields: Mapping[str, Rule]) -> Any:
    """A table of known fields that keep their rules."""
    if not isinstance(value, Mapping):
        raise refusal(field, value, "must be a table of keys and values")
    for key in value:
        if key not in fields:
            raise SceneError(
                f"{field}.{key}: unknown key, must be one of {', '.join(fields)}"
                f"{suggestion(key, fields)}"
            )
    return {key: fields[key](f"{field}.{key}", item) for key, item in value.items()}


WETTABILITY: dict[str, Rule] = {
    "kind": words("stripes", "patch"),
    "angles": partial(items, each=contact_angle, least=2),
    "period": POSITIVE,
    "radius": POSITIVE,
    "border": POSITIVE,
}
"""Fields of a pattern of contact angles."""
FIELDS: dict[str, Rule] = {
    "liquid.surface_tension": POSITIVE,
    "liquid.density": number,
    "liquid.volume": POSITIVE,
    "gravity.acceleration": NOT_NEGATIVE,
    "gravity.direction": direction,
    "substrate.kind": words(
        "plane", "sphere", "sphere_lattice", "spheres", "height_map", "cylinder", "disc", "none"
    ),
    "substrate.contact_angle": partial(one_or_more, each=wet_angle),
    "substrate.radius": POSITIVE,
    "substrate.spacing": POSITIVE,
    "substrate.arrangement": words("square", "hexagonal"),
    "substrate.offset": pair,
    "substrate.centers": partial(items, each=vector, least=1),
    "substrate.radii": partial(one_or_more, each=POSITIVE),
    "substrate.base": number,
    "substrate.shape": words("bump", "egg_carton", "grooves", "pillars", "two_level", "grid"),
    "substrate.amplitude": number,
    "substrate.period": POSITIVE,
    "substrate.height": number,
    "substrate.width": POSITIVE,
    "substrate.edge": POSITIVE,
    "substrate.amplitudes": partial(items, each=number, least=1),
    "substrate.periods": partial(items, each=POSITIVE, least=1),
    "substrate.file": path,
    "substrate.scale": POSITIVE,
    "substrate.axis": direction,
    "substrate.wettability": partial(table, fields=WETTABILITY),
    "particle.radius": POSITIVE,
    "particle.center": vector,
    "particle.density": NOT_NEGATIVE,
    "particle.contact_angle": wet_angle,
    "particle.motion": words("fixed", "vertical", "normal", "resting"),
    "droplet.hold": words("none", "x", "xy", "xyz"),
    "sheet.boundary": words("square", "circle"),
    "sheet.size": POSITIVE,
    "sheet.pressure": number,
    "sheet.volume": number,
    "sheet.liquid_weight": flag,
    "cell.shape": words("square", "circle"),
    "cell.size": POSITIVE,
    "cell.pressure": POSITIVE,
    "rings.radius": POSITIVE,
    "rings.half_height": POSITIVE,
    "rings.volume": POSITIVE,
    "rings.pressure": number,
    "lower.kind": words("plane", "sphere", "disc"),
    "lower.radius": POSITIVE,
    "lower.edge": partial(number, above=0.0, most=180.0),
    "lower.contact_angle": wet_angle,
    "upper.kind": words("plane", "sphere", "disc"),
    "upper.radius": POSITIVE,
    "upper.edge": partial(number, above=0.0, most=180.0),
    "upper.contact_angle": wet_angle,
    "gap.distance": POSITIVE,
    "discretization.space": words("bspline", "nurbs", "lagrange"),
    "discretization.degree": partial(integer, least=1, most=4),
    "discretization.elements": partial(integer, least=3, most=4096),
    "discretization.model": words("full", "half", "quarter", "eighth"),
    "solver.motion": words("spines", "cartesian"),
    "solver.stabilization": POSITIVE,
    "solver.contact": words("exact", "penalty"),
    "solver.penalty": POSITIVE,
    "solver.penetration_tolerance": POSITIVE,
    "solver.contact_line": words("auto", "conforming", "trimmed", "adhesion", "line_load"),
    "solver.start": either(words("auto", "flat", "above", "touching"), state_file),
    "solver.follow_instability": flag,
    "solver.stability": words("full", "model"),
    "solver.max_cpu_s": POSITIVE,
    "solver.max_memory_gb": POSITIVE,
    "path.parameter": text,
    "path.values": path_values,
}  # fmt: skip
"""Path of a field in the scene file to its rule."""


def keys_of(table: str) -> tuple[str, ...]:
    """Keys of a table of the scene file."""
    return tuple(path.partition(".")[2] for path in FIELDS if path.partition(".")[0] == table)
