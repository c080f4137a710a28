"""The scene file as a JSON schema (draft 7), from the rules of its fields."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from .. import checks
from ..checks import SMALLEST_ANGLE, Rule
from ..fields import FIELDS, LONGEST_PATH, keys_of, path_values, table
from ..quantities import DIMENSIONLESS, SI, SIZES, dimension_of
from .scene_file import SCENES, SCHEMA
from .scene_keys import TABLES
from .scene_readers import FOREIGN

Schema = dict[str, Any]
EMPTY = {"maxProperties": 0, "maxItems": 0}
SEVERAL = "particle", "path"
"""Tables of which a file has a list."""


def scene_schema() -> Schema:
    """What a scene file may hold, for editors that complete and check while one writes.

    Returns
    -------
    dict
        A JSON schema of draft 7, which most editors know. What depends on several fields at once
        is left to :func:`iga_membrane.read_scene`.
    """
    tables = {name: _table(name) for name in TABLES}
    several = {name: {"type": "array", "items": tables[name]} for name in SEVERAL}
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "scene file of iga_membrane",
        "type": "object",
        "properties": {
            "schema": {"const": SCHEMA},
            "scene": {"enum": list(SCENES)},
            "units": {"enum": [SI, DIMENSIONLESS]},
        }
        | tables
        | several,
        "required": ["scene"],
        "additionalProperties": False,
        "allOf": [
            {
                "if": {"properties": {"scene": {"const": kind}}},
                "then": {"properties": dict.fromkeys(foreign, EMPTY)},
            }
            for kind, foreign in FOREIGN.items()
        ],
    }


def _table(name: str) -> Schema:
    return _object({key: FIELDS[f"{name}.{key}"] for key in keys_of(name)})


def _object(rules: Mapping[str, Rule]) -> Schema:
    keys = {key: _with_units(schema_of(rule), dimension_of(key)) for key, rule in rules.items()}
    return {"type": "object", "properties": keys, "additionalProperties": False}


def _with_units(schema: Any, dimension: str) -> Any:
    """A schema whose numbers may also be text with a unit."""
    if not dimension or "type" not in schema or schema["type"] == "object":
        return schema
    if schema["type"] == "array":
        return schema | {"items": _with_units(schema["items"], dimension)}
    units = "|".join(map(re.escape, SIZES[dimension]))
    return {"anyOf": [schema, {"type": "string", "pattern": rf"^[-+.\deE]+ ({units})$"}]}


def schema_of(rule: Rule) -> Schema:
    """The schema of a rule.

    Raises
    ------
    KeyError
        A rule that none is known for.
    """
    if isinstance(rule, partial):
        return _SCHEMAS[rule.func](rule.keywords)
    return _SCHEMAS[rule]({})


def _number(limits: Mapping[str, Any], kind: str = "number") -> Schema:
    names = {"above": "exclusiveMinimum", "least": "minimum", "most": "maximum"}
    known = {names[key]: limit for key, limit in limits.items() if key in names}
    return {"type": kind} | {name: limit for name, limit in known.items() if math.isfinite(limit)}


def _several(count: int) -> Schema:
    return {"type": "array", "items": {"type": "number"}, "minItems": count, "maxItems": count}


def _items(given: Mapping[str, Any]) -> Schema:
    return {"type": "array", "items": schema_of(given["each"]), "minItems": given.get("least", 0)}


_SCHEMAS: dict[Callable[..., Any], Callable[[Mapping[str, Any]], Schema]] = {
    checks.number: _number,
    checks.integer: partial(_number, kind="integer"),
    checks.flag: lambda given: {"type": "boolean"},
    checks.text: lambda given: {"type": "string"},
    checks.path: lambda given: {"type": "string", "minLength": 1},
    checks.choice: lambda given: {"enum": list(given["allowed"])},
    checks.state_file: lambda given: {"type": "string", "pattern": r"\.npz$"},
    checks.direction: lambda given: _several(3),
    checks.vector: lambda given: _several(3),
    checks.pair: lambda given: _several(2),
    checks.wet_angle: lambda given: {"type": "number", "minimum": 0.0, "maximum": 180.0},
    checks.items: _items,
    table: lambda given: _object(given["fields"]),
    checks.contact_angle: lambda given: {
        "type": "number", "minimum": SMALLEST_ANGLE, "maximum": 180.0
    },
    checks.one_or_more: lambda given: {
        "anyOf": [schema_of(given["each"]), _items({"each": given["each"], "least": 1})]
    },
    checks.first_of: lambda given: {"anyOf": [schema_of(rule) for rule in given["rules"]]},
    path_values: lambda given: {
        "type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": LONGEST_PATH
    },
}  # fmt: skip
"""Rule to the schema of what it was made with."""
