"""The command line: ``python -m iga_membrane solve SCENE.toml --out DIR`` and its sisters."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any, TypeVar

from . import __version__
from .driver.solution import Solution
from .driver.solve import solve
from .errors import GeometryError, OutputError, SceneError, StateError
from .files import check_folder
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
from .progress import bar, iterations
from .progress import log as progress_log
from .solvers.options import SolverOptions
from .view.export import ending_of, save

SOLVED, BAD_SCENE, FAILED, NOT_WRITABLE, INTERRUPTED = 0, 2, 3, 4, 130

File = TypeVar("File")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code (0 only for a success)."""
    parser = _parser()
    given = parser.parse_args(arguments)
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
    with bar("solving") as report:
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


def _schema(given: argparse.Namespace) -> int:
    from .io.schema import scene_schema

    print(json.dumps(scene_schema(), indent=2))
    return SOLVED


def _command(commands: Any, name: str, run: Callable[[Any], int], text: str) -> Any:
    command = commands.add_parser(name, help=text)
    command.set_defaults(run=run)
    return command


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="iga_membrane", description="Static wetting with C1 spline membranes."
    )
    parser.add_argument("--version", action="version", version=__version__)
    parser.add_argument("--progress", action="store_true",
                        help="lines of progress on stderr where it is no terminal")  # fmt: skip
    commands = parser.add_subparsers(dest="command", required=True)
    command = _command(commands, "solve", _solve, "solve one scene file")
    command.add_argument("scene", help="scene file, .toml or .json")
    command.add_argument("--out", required=True, help="folder for result.json and state.npz")
    command.add_argument("--vtu", action="store_true", help="also write the surface (surface.vtu)")
    command.add_argument("--png", action="store_true", help="also write a picture (picture.png)")
    command = _command(commands, "sweep", _sweep, "solve a grid of scenes; again: what is missing")
    command.add_argument("sweep", help="scene file with [[over]] tables, .toml or .json")
    command.add_argument("--out", required=True, help="folder for points/, table.csv, table.npz")
    command.add_argument("--workers", type=int, help="processes (default: the processors)")
    command.add_argument("--timeout", type=float, help="seconds per point")
    command.add_argument("--allow-mixed", action="store_true",
                         help="keep points of other options or versions")  # fmt: skip
    command.add_argument("--retry-failed", action="store_true",
                         help="compute again what is recorded, but not as a success")  # fmt: skip
    command = _command(commands, "info", _info, "print the summary of a result")
    command.add_argument("result", help="output folder, state.npz or result.json")
    command = _command(commands, "plot", _plot, "draw a result")
    command.add_argument("result", help="output folder or state.npz")
    command.add_argument(
        "--out",
        help="picture (.png; section and goniometer also .pdf, .svg); by default picture.png",
    )
    command.add_argument("--kind", choices=("space", "goniometer", "section"), default="space",
                         help="in space; the shadow from the side; the section")  # fmt: skip
    command.add_argument("--color", choices=("none", "mean_curvature", "pressure", "gap",
                                             "residual"))  # fmt: skip
    command.add_argument("--view", choices=("oblique", "foot", "side", "top"))
    command.add_argument("--focus", choices=("asperity",), help="zoom on a wet asperity")
    command.add_argument("--traction", action="store_true", help="arrows along contact lines")
    command.add_argument("--forces", action="store_true", help="arrows of forces on particles")
    command = _command(commands, "export", _export, "write other files of a result")
    command.add_argument("result", help="output folder or state.npz")
    command.add_argument("files", nargs="+", metavar="FILE",
                         help="by its ending .vtu, .stl, .obj, .ply, .geomdl.json, .lines.csv, "
                         ".forces.csv, .json, .npz or .png")  # fmt: skip
    _command(commands, "schema", _schema, "print the JSON schema of scene files")
    return parser
