"""The command line: ``python -m iga_membrane solve SCENE.toml --out DIR`` and its sisters."""

from __future__ import annotations

import argparse
import logging
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

from . import __version__
from .errors import GeometryError, OutputError, SceneError, StateError
from .files import check_folder, previous
from .progress import bar
from .scenes.scene_file import load_scene, read_tables
from .solver.options import SolverOptions
from .solver.solve import solve
from .view.export import save

SOLVED, BAD_SCENE, FAILED, NOT_WRITABLE, INTERRUPTED = 0, 2, 3, 4, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code (0 only for a success)."""
    parser = _parser()
    given = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
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
    file = load_scene(given.scene)
    folder = Path(given.out)
    check_folder(folder)
    if given.png:
        from .view.picture import check_drawing

        check_drawing()
    state = folder / "state.npz"
    options = replace(SolverOptions(), **file.solver, checkpoint=state)
    with bar("solving") as report:
        solution = solve(file.scene, options, on_fail="return", report=report)
    seconds = {"import": imported, **solution.cpu_seconds, "total": process_time()}
    solution = replace(solution, cpu_seconds=seconds)
    save(solution, folder / "result.json")
    save(solution, state)
    previous(state).unlink(missing_ok=True)
    if given.vtu:
        save(solution, folder / "surface.vtu")
    if given.png:
        save(solution, folder / "picture.png")
    _say(solution.summary())
    return SOLVED if solution.success else FAILED


def _sweep(given: argparse.Namespace) -> int:
    from .analysis.sweep import sweep
    from .scenes.sweep_file import load_sweep

    file = load_sweep(given.sweep)
    folder = Path(given.out)
    check_folder(folder)
    found = sweep(
        file.scene_of,
        file.over,
        out=folder / "points",
        workers=given.workers,
        timeout=given.timeout,
        options=replace(SolverOptions(), **file.solver),
        allow_mixed=given.allow_mixed,
    )
    for name in ("table.csv", "table.npz"):
        found.save(folder / name)
    counts = ", ".join(f"{count} {name}" for name, count in found.statuses.items())
    _say(f"{len(found.records)} points ({found.computed} computed now): {counts}")
    return SOLVED if found.success else FAILED


def _info(given: argparse.Namespace) -> int:
    """Print a summary of a result: a folder, a state or a result file."""
    path = _result_of(Path(given.result))
    if path.suffix == ".npz":
        from .solver.state import load

        _say(load(path).summary())
        return SOLVED
    record = _json(path)
    lines = [f"{record['status']}: {record.get('message')}"]
    lines += [f"  {name:<24}{value!r:>24}" for name, value in record.get("measures", {}).items()]
    _say("\n".join(lines))
    return SOLVED


def _plot(given: argparse.Namespace) -> int:
    from .solver.state import load
    from .view.picture import check_drawing

    state = Path(given.result)
    state = state / "state.npz" if state.is_dir() else state
    out = Path(given.out) if given.out else state.with_name("picture.png")
    solution = load(state)
    check_drawing()
    solution.plot(out, **({"color": given.color} if given.color else {}))
    _say(str(out))
    return SOLVED


def _result_of(path: Path) -> Path:
    """The file of a result to look at: of a folder its state, else its result."""
    if not path.is_dir():
        return path
    names = ("state.npz", "result.json")
    found = next((path / name for name in names if (path / name).exists()), None)
    if found is None:
        raise StateError(f"{path}: holds neither {' nor '.join(names)}")
    return found


def _json(path: Path) -> dict[str, Any]:
    try:
        record = read_tables(path)
    except SceneError as error:
        raise StateError(str(error)) from error
    if not isinstance(record, dict) or "status" not in record:
        raise StateError(f"{path}: not a result file of iga_membrane")
    return record


def _say(text: str) -> None:
    """Print; a reader that has left, like ``head``, is no error."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _command(commands: Any, name: str, run: Callable[[Any], int], text: str) -> Any:
    command = commands.add_parser(name, help=text)
    command.set_defaults(run=run)
    return command


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="iga_membrane", description="Static wetting with C1 spline membranes."
    )
    parser.add_argument("--version", action="version", version=__version__)
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
    command = _command(commands, "info", _info, "print the summary of a result")
    command.add_argument("result", help="output folder, state.npz or result.json")
    command = _command(commands, "plot", _plot, "draw a result")
    command.add_argument("result", help="output folder or state.npz")
    command.add_argument("--out", help="picture (.png); by default picture.png beside the state")
    command.add_argument("--color", choices=("mean_curvature", "pressure", "none"))
    return parser
