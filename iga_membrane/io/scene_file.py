"""The scene file (TOML or JSON): read, check every key, build the scene. The contract is fixed."""

from __future__ import annotations

import copy
import json
import re
import tomllib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..arguments import checked
from ..checks import choice
from ..errors import SceneError
from ..fields import path_values
from ..files import read_file
from ..initial.liquid import MODELS
from ..problems.recipe import in_its_units
from ..problems.scene import Ramp, Scene
from ..quantities import DIMENSIONLESS, SI, has_units, in_numbers
from .scene_keys import KEYS, check_values, later, table_of
from .scene_readers import FOREIGN, READERS, solver_limits

SCHEMA = 1
LARGEST_FILE = 10_000_000

SCENES = (
    "sessile_droplet",
    "liquid_sheet",
    "asperity_cell",
    "film_between_rings",
    "capillary_bridge",
)


@dataclass(frozen=True)
class SceneFile:
    """A scene file, read and checked.

    Attributes
    ----------
    scene : what to solve.
    solver : the solver's limits and start that the file sets, by the names of ``SolverOptions``.
    """

    scene: Scene
    solver: dict[str, Any]


@checked()
def load_scene(path: str | Path) -> SceneFile:
    """Read a scene file (.toml or .json).

    Parameters
    ----------
    path : of the file.

    Raises
    ------
    SceneError
        Not readable, too large, not TOML/JSON, or any field wrong; the message names the field.
    """
    return read_scene(read_tables(path))


@checked()
def read_tables(path: str | Path) -> Any:
    """The tables of a TOML or JSON file, not checked yet.

    Raises
    ------
    SceneError
        Not a regular file, not readable, too large, or not TOML/JSON.
    """
    path = Path(path)
    data = read_file(path, LARGEST_FILE, SceneError)
    try:
        text = data.decode("utf-8-sig")  # Windows marks the order of bytes
    except ValueError as error:
        raise SceneError(f"{path}: cannot be read as text ({error})") from error
    try:
        if path.suffix == ".json":
            return json.loads(text, object_pairs_hook=_no_duplicates)
        return tomllib.loads(text)
    except SceneError:
        raise
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{path}: not a scene file ({error})") from error


def read_scene(data: Any) -> SceneFile:
    """Build the scene from the tables of a scene file.

    Parameters
    ----------
    data : nested mapping with the keys of the contract.

    Raises
    ------
    SceneError
    """
    data = in_numbers("", table_of("", data))
    choice("units", data.get("units", DIMENSIONLESS), (SI, DIMENSIONLESS))
    if has_units(data):
        data["units"] = SI
    if "schema" in data and data["schema"] != SCHEMA:
        raise SceneError(
            f"schema = {data['schema']!r}: this version reads schema {SCHEMA}; leave the key out "
            "or convert the file"
        )
    if "scene" not in data:
        raise SceneError(f"scene: missing; must be one of {', '.join(map(repr, SCENES))}")
    kind = choice("scene", data["scene"], SCENES)
    tables = _tables(data)
    if kind not in READERS:
        raise later(f'scene = "{kind}"')
    for name in FOREIGN[kind]:
        if data.get(name):
            raise SceneError(f'{name}: does not belong to scene = "{kind}"; remove it')
    limits = solver_limits(tables["solver"], kind)
    if data.get("path"):
        return SceneFile(_along_path(data), limits)
    scene = READERS[kind](data, tables)
    return SceneFile(in_its_units(scene, si=data.get("units") == SI), limits)


def _tables(data: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Tables by their names, every key and value of them and of those in lists checked."""
    several = "particle", "path"
    alone = [name for name in KEYS if name not in ("", *several)]
    tables = {name: table_of(name, data.get(name, {})) for name in alone}
    for name in several:
        entries = data.get(name, [])
        if not isinstance(entries, list):
            raise SceneError(f"{name}: must be a list of tables, [[{name}]]")
        for i, entry in enumerate(entries):
            label = f"{name}[{i}]"
            check_values(table_of(name, entry, label), name, label)
    for name, table in tables.items():
        check_values(table, name)
    return tables


def _along_path(data: Mapping[str, Any]) -> Scene:
    """The scene at the end of its path, with the path as the ramp to walk."""
    if len(data["path"]) > 1:
        raise later(f"{len(data['path'])} [[path]] tables")
    path = data["path"][0]
    for key in ("parameter", "values"):
        if key not in path:
            raise SceneError(f"path[0].{key}: missing; a path needs it")
    parameter, values = path["parameter"], path_values("path[0].values", path["values"])
    fixed = {key: value for key, value in data.items() if key != "path"}

    at = AlongTables(fixed, parameter)
    # one model and mesh for the whole path: the largest that any of its scenes needs
    scenes = [at(value) for value in values]
    model = min((scene.sector.model for scene in scenes), key=MODELS.index)
    meshes = [scene.description["discretization"]["elements"] for scene in scenes]
    mesh = dict(fixed.get("discretization", {}))
    fixed["discretization"] = {"model": model, "elements": max(meshes)} | mesh
    at = AlongTables(fixed, parameter)
    end = at(values[-1])
    description = dict(end.description) | {"path": [{"parameter": parameter, "values": values}]}
    ramp = Ramp(parameter, values, at, asked=True, bound=end.bound(parameter))
    return replace(end, ramp=ramp, description=description)


@dataclass(frozen=True)
class AlongTables:
    """Scenes of a scene file with one number changed.

    Attributes
    ----------
    tables : of the file; parameter : path of the number.
    """

    tables: Mapping[str, Any]
    parameter: str

    def __call__(self, value: float) -> Scene:
        changed = with_number(self.tables, "path[0].parameter", self.parameter, value)
        return read_scene(changed).scene


def with_number(
    data: Mapping[str, Any], field: str, parameter: Any, value: float
) -> dict[str, Any]:
    """A copy of a scene file's tables with one number changed.

    Parameters
    ----------
    field : the place that names the parameter, for messages.
    parameter : path of the number, "substrate.contact_angle" or "particle[0].center[2]".

    Raises
    ------
    SceneError
        If there is no such place.
    """
    if not isinstance(parameter, str):
        raise SceneError(f"{field} = {parameter!r}: must be text")
    steps = re.findall(r"[a-z_]+|\[\d+\]", parameter)
    well_formed = re.fullmatch(r"[a-z_]+(\[\d+\])?\.[a-z_]+(\[\d+\])?", parameter)
    keys = [step for step in steps if not step.startswith("[")]
    if not well_formed or keys[1] not in KEYS.get(keys[0], ()):
        raise SceneError(
            f"{field} = {parameter!r}: must be the path of a number in the scene file, "
            'like "substrate.contact_angle" or "particle[0].center[2]"'
        )
    changed = copy.deepcopy(dict(data))
    place: Any = changed
    indices = [int(step[1:-1]) if step.startswith("[") else step for step in steps]
    try:
        for step in indices[:-1]:
            place = place.setdefault(step, {}) if isinstance(step, str) else place[step]
        if isinstance(indices[-1], int):
            place[indices[-1]]  # only what is there can be counted through
        place[indices[-1]] = value
    except (AttributeError, IndexError, KeyError, TypeError) as error:
        raise SceneError(
            f"{field} = {parameter!r}: there is no such place in the scene file"
        ) from error
    return changed


def _no_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    for key, count in Counter(key for key, _ in pairs).items():
        if count > 1:
            raise SceneError(f"{key}: given {count} times in one table; give it once")
    return dict(pairs)
