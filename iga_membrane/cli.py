"""The command line: ``python -m iga_membrane solve SCENE.toml --out DIR`` and its sisters."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any, TypeVar

from .checks import choice
from .command_line import parser
from .driver.solution import Solution
from .driver.solve import solve
from .errors import GeometryError, OutputError, SceneError, StateError
from .files import check_folder, write_whole
from .io.scene_file import read_scene, read_tables
from .output_folder import (
    PICTURE,
    RESULT,
    STATE,
    STATE_BEFORE,
    SURFACE,
    TABLES,
    output_folder,
    remove,
    remove_results,
)
from .progress import iterations, progress_bar
from .progress import log as progress_log
from .solvers.options import SolverOptions
from .view.export import ending_of, save

SOLVED, BAD_SCENE, FAILED, NOT_WRITABLE, INTERRUPTED = 0, 2, 3, 4, 130

File = TypeVar("File")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code (0 only for a success)."""
    given = parser(_RUN).parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    progress_log.setLevel(logging.INFO if given.progress else logging.WARNING)
    iterations.setLevel(logging.DEBUG if given.progress else logging.WARNING)
    try:
        code: int = given.run(given)
        return code
    except (SceneError, GeometryError, StateError) as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_SCENE
    except OutputError as error:
        print(f"error: {error}", file=sys.stderr)
        return NOT_WRITABLE
    except MemoryError:
        print("error: out of memory; choose fewer discretization.elements", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED


def _solve(given: argparse.Namespace) -> int:
    imported = process_time()
    folder = output_folder("--out", given.out)
    file = _read(given.scene, read_scene, folder)
    if given.png:
        from .view.drawing import check_drawing

        check_drawing()
    options = replace(SolverOptions(), **file.solver, checkpoint=folder / STATE)
    with progress_bar("solving") as report:
        solution = solve(file.scene, options, on_fail="return", report=report)
    seconds = {"import": imported, **solution.cpu_seconds, "total": process_time()}
    solution = replace(solution, cpu_seconds=seconds)
    _say(solution.summary())
    # the state first: where there is a result, the state beside it is of the same scene
    names = [STATE, RESULT, *[SURFACE] * given.vtu, *[PICTURE] * given.png]
    for name in names:
        save(solution, folder / name)
    remove(folder / STATE_BEFORE)
    return SOLVED if solution.success else FAILED


def _read(path: str, read: Callable[[Any], File], folder: Path) -> File:
    """A scene or sweep file, with the folder ready for its results.

    Results of an older scene are gone then, also if this one is refused; a state stays that the
    file itself starts from, or, if it is refused, one that an interrupted path goes on from.
    """
    start: Collection[str] = ()
    try:
        tables = read_tables(path)
        start = _start_in(folder, tables)
        file = read(tables)
    except (SceneError, GeometryError):
        remove_results(folder, start or _unfinished(folder))
        raise
    check_folder(folder)
    remove_results(folder, start)
    return file


def _start_in(folder: Path, tables: Any) -> Collection[str]:
    """Names of the states that stay, since the tables of a file say to start from one of them."""
    states = (STATE, STATE_BEFORE)
    try:
        start = Path(tables["solver"]["start"]).resolve()
    except (TypeError, KeyError, ValueError, OSError, RuntimeError):
        return ()
    return states if start in [(folder / name).resolve() for name in states] else ()


def _unfinished(folder: Path) -> Collection[str]:
    """Names of the states of a path that has not come to its end."""
    from .driver.state import holds_path

    return [name for name in (STATE, STATE_BEFORE) if holds_path(folder / name)]


def _sweep(given: argparse.Namespace) -> int:
    from .analysis.sweep import sweep
    from .io.sweep_file import read_sweep

    folder = output_folder("--out", given.out)
    file = _read(given.sweep, read_sweep, folder)
    found = sweep(
        file.scene_of,
        file.over,
        out=folder / "points",
        workers=given.workers,
        timeout=given.timeout,
        options=replace(SolverOptions(), **file.solver),
        allow_mixed=given.allow_mixed,
        retry_failed=given.retry_failed,
    )
    for name in TABLES:
        found.save(folder / name)
    counts = ", ".join(f"{count} {name}" for name, count in found.statuses.items())
    _say(f"{len(found.records)} points ({found.computed} computed now): {counts}")
    return SOLVED if found.success else FAILED


def _info(given: argparse.Namespace) -> int:
    """Print a summary of a result: a folder, a state or a result file."""
    path = _result_of(Path(given.result))
    if path.suffix == ".npz":
        _say(_load(path).summary())
        return SOLVED
    from .driver.result_file import read_result

    record = read_result(path)
    lines = [f"{record['status']}: {record.get('message')}"]
    for part in ("measures", "dimensionless"):
        lines += [f"  {name:<24}{value!r:>24}" for name, value in record[part].items()]
    _say("\n".join(lines))
    return SOLVED


def _plot(given: argparse.Namespace) -> int:
    state = _state_of(Path(given.result))
    out = state.with_name(PICTURE) if given.out is None else _picture("--out", given.out)
    words = {
        name: getattr(given, name) for name in ("color", "view", "focus", "traction", "forces")
    }
    asked = {name: value for name, value in words.items() if value}
    if asked and given.kind != "space":
        raise SceneError(f"--{next(iter(asked))}: has no meaning with --kind {given.kind}")
    check_folder(out.parent)
    solution = _load(state)
    if given.kind == "section":
        from .view.section import plot_section

        plot_section(solution, out)
    elif given.kind == "goniometer":
        from .view.goniometer import plot_side

        plot_side(solution, out)
    else:
        solution.plot(out, **asked)
    _say(str(out))
    return SOLVED


def _picture(field: str, given: str) -> Path:
    """A file to draw, in a folder that need not exist yet."""
    path = Path(given)
    if not path.suffix or path.is_dir():
        raise OutputError(f"{field} = {given!r}: name a picture, like {PICTURE}")
    return path


def _export(given: argparse.Namespace) -> int:
    """Write other files of a result, by their endings; all endings are checked first."""
    files = [Path(name) for name in given.files]
    for file in files:
        ending_of(file)
        check_folder(file.parent)
    solution = _load(_state_of(Path(given.result)))
    for file in files:
        save(solution, file)
        _say(str(file))
    return SOLVED


def _state_of(path: Path) -> Path:
    return path / STATE if path.is_dir() else path


def _load(path: Path) -> Solution:
    from .driver.state import load

    return load(path)


def _result_of(path: Path) -> Path:
    """The file of a result to look at: of a folder its state, else its result."""
    if not path.is_dir():
        return path
    names = (STATE, RESULT)
    found = next((path / name for name in names if (path / name).exists()), None)
    if found is None:
        raise StateError(f"{path}: holds neither {' nor '.join(names)}")
    return found


def _say(text: str) -> None:
    """Print; a reader that has left, like ``head``, is no error."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _fit(given: argparse.Namespace) -> int:
    """Measure the droplet in a photograph."""
    from .driver.result_file import finite
    from .initial.liquid import Liquid
    from .photograph.fit import fit_profile
    from .photograph.silhouette import silhouette
    from .tables import csv_text
    from .view.overlay import plot_fit

    folder = output_folder("--out", given.out)
    points = silhouette(given.image, scale=_quantity(given.scale))
    liquid = Liquid(_quantity(given.tension), _quantity(given.density))
    found = fit_profile(points, liquid=liquid, gravity=_quantity(given.gravity), fit=given.fit)
    check_folder(folder)
    _say(repr(found))
    text = json.dumps(finite(found.record()), indent=1, allow_nan=False) + "\n"
    write_whole(folder / "fit.json", partial(_write_text, text))
    for name, rows in (("points.csv", found.points), ("profile.csv", found.curve)):
        table = csv_text([{"x": x, "z": z, "units": found.units} for x, z in rows.tolist()])
        write_whole(folder / name, partial(_write_text, table))
    plot_fit(found, folder / "overlay.png")
    return SOLVED


def _write_text(text: str, name: str) -> None:
    Path(name).write_text(text, encoding="utf-8")


def _quantity(text: str) -> Any:
    """A plain number, or a text with a unit for the rule of the field."""
    try:
        return float(text)
    except ValueError:
        return text


def _init(given: argparse.Namespace) -> int:
    """Write a commented scene file to begin with."""
    from .io.first_scene import KINDS, first_scene

    path = Path(given.scene)
    if path.exists():
        raise OutputError(f"scene = {str(path)!r}: is there already; name another file")
    text = first_scene(choice("--kind", given.kind, KINDS))
    write_whole(path, partial(_write_text, text))
    _say(f"{path}: edit it, then python -m iga_membrane solve {path} --out out")
    return SOLVED


def _schema(given: argparse.Namespace) -> int:
    from .io.schema import scene_schema

    print(json.dumps(scene_schema(), indent=2))
    return SOLVED


_RUN: dict[str, Callable[[argparse.Namespace], int]] = {
    "init": _init,
    "solve": _solve,
    "sweep": _sweep,
    "fit": _fit,
    "info": _info,
    "plot": _plot,
    "export": _export,
    "schema": _schema,
}
"""Command to what runs it."""
