"""The command line: ``python -m iga_membrane solve SCENE.toml --out DIR``."""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from time import process_time

from . import __version__
from .errors import GeometryError, OutputError, SceneError, StateError
from .files import check_folder, previous
from .scenes.scene_file import load_scene
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
        return _solve(given)
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
    with _progress() as report:
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
    print(solution.summary())
    return SOLVED if solution.success else FAILED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="iga_membrane", description="Static wetting with C1 spline membranes."
    )
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("solve", help="solve one scene file")
    command.add_argument("scene", help="scene file, .toml or .json")
    command.add_argument("--out", required=True, help="folder for result.json and state.npz")
    command.add_argument("--vtu", action="store_true", help="also write the surface (surface.vtu)")
    command.add_argument("--png", action="store_true", help="also write a picture (picture.png)")
    return parser


@contextmanager
def _progress() -> Iterator[Callable[[float], None]]:
    """A bar over the load on a terminal; nothing elsewhere."""
    if not (sys.stderr.isatty() and find_spec("rich")):
        yield lambda load: None
        return
    from rich.progress import Progress

    with Progress(transient=True) as bar:
        task = bar.add_task("solving", total=1.0)
        yield lambda load: bar.update(task, completed=load)
