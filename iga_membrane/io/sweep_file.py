"""The sweep file: a scene file with ``[[over]]`` tables, one per parameter that is varied."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..checks import number
from ..errors import SceneError
from ..problems.scene import Scene
from ..quantities import SI, has_units, in_numbers
from .scene_file import read_scene, read_tables, with_number


@dataclass(frozen=True)
class FileScenes:
    """Parameters by their paths in the scene file to the scene.

    Attributes
    ----------
    tables : of the scene file, without ``[[over]]``.
    """

    tables: Mapping[str, Any]

    def __call__(self, **parameters: float) -> Scene:
        data = dict(self.tables)
        for name, value in parameters.items():
            data = with_number(data, f"over {name}", name, value)
        return read_scene(data).scene


@dataclass(frozen=True)
class SweepFile:
    """A sweep file, read and checked.

    Attributes
    ----------
    scene_of : parameters to a scene; over : their values.
    solver : the solver's limits that the file sets, by the names of ``SolverOptions``.
    """

    scene_of: FileScenes
    over: dict[str, list[float]]
    solver: dict[str, Any]


def load_sweep(path: str | Path) -> SweepFile:
    """Read a sweep file (.toml or .json).

    Raises
    ------
    SceneError
        As for a scene file; or ``over`` missing or wrong. The scene of the first point is built to
        see that it can be.
    """
    return read_sweep(read_tables(path))


def read_sweep(data: Any) -> SweepFile:
    """The sweep that the tables of a sweep file ask for.

    Raises
    ------
    SceneError
    """
    tables = dict(data) if isinstance(data, Mapping) else {}
    entries = in_numbers("over", tables.pop("over", None))
    if has_units(entries):
        tables["units"] = SI
    if not isinstance(entries, list) or not entries:
        raise SceneError(f"over = {entries!r}: one or more [[over]] tables are needed in a sweep")
    over: dict[str, list[float]] = {}
    for i, entry in enumerate(entries):
        name, values = _entry(f"over[{i}]", entry)
        tables = with_number(tables, f"over[{i}].parameter", name, values[0])
        if name in over:
            raise SceneError(f"over[{i}].parameter = {name!r}: given twice; give it once")
        over[name] = values
    return SweepFile(FileScenes(tables), over, read_scene(tables).solver)


def _entry(field: str, entry: Any) -> tuple[str, list[float]]:
    if not isinstance(entry, Mapping) or set(entry) != {"parameter", "values"}:
        raise SceneError(f"{field} = {entry!r}: must be a table of parameter and values")
    values = entry["values"]
    if not isinstance(values, list) or not values:
        raise SceneError(f"{field}.values = {values!r}: a list of numbers is needed")
    return entry["parameter"], [number(f"{field}.values[{i}]", v) for i, v in enumerate(values)]
