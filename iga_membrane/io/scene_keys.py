"""The tables and keys of the scene file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..checks import refusal, suggestion
from ..errors import SceneError
from ..fields import FIELDS, keys_of
from ..problems.osman_sauer import WholeMembrane

TABLES = tuple(dict.fromkeys(field.partition(".")[0] for field in FIELDS))
KEYS = {"": ("schema", "scene", "units", *TABLES), **{table: keys_of(table) for table in TABLES}}
"""Table to its keys: those of the contract; what is not built is refused by name."""


def table_of(name: str, value: Any, label: str | None = None) -> Mapping[str, Any]:
    """A mapping with known keys only."""
    label = name if label is None else label
    if not isinstance(value, Mapping):
        raise refusal(label or "scene file (data)", value, "must be a table of keys and values")
    for key in value:
        if key not in KEYS[name]:
            path = f"{label}.{key}" if label else str(key)
            raise SceneError(
                f"{path}: unknown key{suggestion(key, KEYS[name])} (known: {', '.join(KEYS[name])})"
            )
    return value


def check_values(table: Mapping[str, Any], name: str, label: str | None = None) -> None:
    """Every value of a table against the rule of its field, also those that the scene does not
    use."""
    for key, value in table.items():
        FIELDS[f"{name}.{key}"](f"{label or name}.{key}", value)


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
