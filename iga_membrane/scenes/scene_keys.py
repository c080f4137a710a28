"""The tables and keys of the scene file, and the ranges of their numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypedDict

from ..checks import choice, flag, integer, number, suggestion
from ..errors import SceneError
from .liquid import MODELS
from .whole_membrane import WholeMembrane

# Every table and key of the contract; those whose capability is not built are refused by name.
KEYS: dict[str, tuple[str, ...]] = {
    "": ("schema", "scene", "liquid", "gravity", "substrate", "particle", "droplet", "sheet",
         "cell", "rings", "discretization", "solver", "path"),
    "liquid": ("surface_tension", "density", "volume"),
    "gravity": ("acceleration", "direction"),
    "substrate": ("kind", "contact_angle", "radius", "spacing", "arrangement", "offset",
                  "centers", "radii", "base"),
    "particle": ("radius", "center", "density", "contact_angle", "motion"),
    "droplet": ("hold",),
    "sheet": ("boundary", "size", "pressure", "volume", "liquid_weight"),
    "cell": ("shape", "size", "pressure"),
    "rings": ("radius", "half_height", "volume", "pressure"),
    "discretization": ("space", "degree", "elements", "model"),
    "solver": ("motion", "stabilization", "contact", "penalty", "penetration_tolerance",
               "contact_line", "start", "follow_instability", "max_cpu_s", "max_memory_gb"),
    "path": ("parameter", "values"),
}  # fmt: skip


LISTS = ("direction", "contact_angle", "offset", "centers", "radii", "center", "values")


class Limits(TypedDict, total=False):
    """Bounds of a number, by the names of :func:`iga_membrane.checks.number`."""

    above: float
    least: float
    most: float


def table_of(name: str, value: Any, label: str | None = None) -> Mapping[str, Any]:
    """A mapping with known keys only."""
    label = name if label is None else label
    if not isinstance(value, Mapping):
        raise SceneError(f"{label or 'scene file'} = {value!r}: must be a table of keys and values")
    for key in value:
        if key not in KEYS[name]:
            path = f"{label}.{key}" if label else str(key)
            raise SceneError(
                f"{path}: unknown key{suggestion(key, KEYS[name])} (known: {', '.join(KEYS[name])})"
            )
    return value


_LIMITS: dict[str, Limits] = {
    "surface_tension": {"above": 0.0},
    "density": {"least": 0.0},
    "volume": {"above": 0.0},
    "acceleration": {"least": 0.0},
    "contact_angle": {"above": 0.0, "most": 180.0},
    "radius": {"above": 0.0},
    "radii": {"above": 0.0},
    "spacing": {"above": 0.0},
    "size": {"above": 0.0},
    "half_height": {"above": 0.0},
}


def check_numbers(label: str, table: Mapping[str, Any]) -> None:
    """Ranges of every number in a table, also of those that the scene does not use."""
    texts = ("kind", "arrangement", "motion", "hold", "boundary", "shape", "space", "model",
             "contact", "contact_line", "start", "parameter")  # fmt: skip
    for key, value in table.items():
        field = f"{label}.{key}"
        if key in texts:
            if not isinstance(value, str):
                raise SceneError(f"{field} = {value!r}: must be text")
        elif key in ("liquid_weight", "follow_instability"):
            flag(field, value)
        elif key in ("degree", "elements"):
            least, most = (1, 4) if key == "degree" else (3, 4096)
            integer(field, value, least=least, most=most)
        else:
            _check_nested(field, value, _LIMITS.get(key, Limits()))
    if label == "discretization" and "model" in table:
        choice("discretization.model", table["model"], MODELS)


def _check_nested(field: str, value: Any, limits: Limits) -> None:
    if isinstance(value, list) and field.rpartition(".")[2].partition("[")[0] in LISTS:
        for i, item in enumerate(value):
            _check_nested(f"{field}[{i}]", item, limits)
    else:
        number(field, value, **limits)


def later(what: str) -> SceneError:
    """A value of the contract whose capability is not built."""
    return SceneError(f"{what}: not available yet in this version")


def membrane_of(table: Mapping[str, Any]) -> WholeMembrane | None:
    """The paper's formulation, if its contact line is asked for."""
    line = table.get("contact_line", "auto")
    motion = table.get("motion", "cartesian" if line == "line_load" else "spines")
    if line != "line_load":
        if motion == "cartesian":
            raise later('solver.motion = "cartesian" without contact_line = "line_load"')
        return None
    if motion == "spines" or table.get("contact", "penalty") == "exact":
        key, word = ("motion", "spines") if motion == "spines" else ("contact", "exact")
        raise SceneError(
            f'solver.{key} = "{word}": contact_line = "line_load" is the paper\'s formulation, '
            'with motion = "cartesian" and contact = "penalty"; leave them out or choose another '
            "line"
        )
    names = ("stabilization", "penalty", "penetration_tolerance")
    return WholeMembrane(**{name: table[name] for name in names if name in table})
