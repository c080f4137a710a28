"""State files: a solution, or load stepping on its way, without pickle and with a checksum."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import __version__
from ..arguments import checked
from ..errors import OutputError, SceneError, StateError
from ..files import previous, read_arrays, write_arrays
from ..problems.scene import Ramp, Scene
from ..records import decode, digest, encode
from ..solvers.load_path import Journal, Progress
from ..solvers.options import SolverOptions
from ..splines import Space
from ..surface.surface import Surface
from .solution import Solution

log = logging.getLogger("iga_membrane")


@checked()
def load(path: str | Path, *, also: Sequence[type] = ()) -> Solution:
    """Read back a solution, bit by bit as it was saved.

    The scene comes with it, with its ways round a failing solve, so it can be solved again. Of your
    own, functions are not kept and refuse to be called: build such a scene anew.

    Parameters
    ----------
    path : a state file, written by ``solution.save("drop.npz")`` or the command line.
    also : terms of your own that the scene may hold.

    Raises
    ------
    StateError
        Corrupt, cut off, foreign or newer; or a checkpoint that holds no solution yet.
    """
    found = _read(Path(path), also)
    if isinstance(found, Solution):
        return found
    raise StateError(
        f"{path}: holds a path interrupted at load {found.load:.6g}, no solution yet: go on from "
        f'it with solver.start = "{path}"'
    )


def holds_path(path: Path) -> bool:
    """Whether a file is the state of a path on its way: no solution's, not damaged, and there."""
    try:
        return isinstance(_read(path), Progress)
    except StateError:
        return False


def write_state(path: Path, state: Solution | Progress, *, keep: bool = False) -> None:
    """Write a state file, whole or not at all.

    Parameters
    ----------
    keep : whether to keep the generation before.
    """
    arrays: dict[str, Any] = {}
    header = {"version": __version__, "state": encode(state, arrays)}
    write_arrays(path, header, arrays, keep=keep)


def journal_of(ramp: Ramp, options: SolverOptions) -> Journal:
    """Where the progress of a ramp is written, and where it goes on."""
    if options.checkpoint is None and options.start is None:
        return Journal()
    mark = digest([__version__, options.numerical(), ramp.parameter, ramp.values, ramp(0.0),
                   ramp(1.0)])  # fmt: skip
    place = options.checkpoint

    def write(progress: Progress) -> None:
        if place is None:
            return
        try:
            write_state(Path(place), progress, keep=True)
        except OutputError as error:  # a full disk does not end a solve; the one before stays
            log.warning("%s; going on without this checkpoint", error)

    return Journal(mark, write, _progress(options.start, mark))


def start_surface(path: str | Path, scene: Scene) -> Surface:
    """The surface of a state file as a start of a scene of the same space.

    Raises
    ------
    StateError
        If the file cannot be trusted.
    SceneError
        If its space is another one.
    """
    found, asked = _read(Path(path)), scene.surface
    surface = found.surface if isinstance(found, Solution) else found.result.surface
    if isinstance(found, Progress):
        surface = surface.moved(scene.units.to_world(surface.points))
    given, wanted = surface.space, asked.space
    if not _same(given, wanted):
        raise SceneError(
            f"solver.start = {str(path)!r}: control net {given.net_shape} of degree "
            f"{given.degree} given, {wanted.net_shape} of degree {wanted.degree} expected from the "
            "discretization"
        )
    return asked.moved(surface.points)


def fits(path: str | Path, scene: Scene) -> bool:
    """Whether the surface of a state file has the space of a scene.

    Raises
    ------
    StateError
        If the file cannot be trusted.
    """
    found = _read(Path(path))
    surface = found.surface if isinstance(found, Solution) else found.result.surface
    return _same(surface.space, scene.surface.space)


def _same(one: Space, other: Space) -> bool:
    return (one.net_shape, one.degree, one.pole, one.count) == (
        other.net_shape, other.degree, other.pole, other.count
    )  # fmt: skip


def _progress(path: str | Path | None, mark: str) -> Progress | None:
    """Progress of the same ramp in a state file, or in the generation before it if the file
    itself is damaged."""
    if path is None:
        return None
    path = Path(path)
    try:
        found = _read(path)
    except StateError as error:
        if not previous(path).exists():
            raise
        log.warning("%s; going on from %s", error, previous(path))
        found = _read(previous(path))
    progress = found.progress if isinstance(found, Solution) else found
    return progress if progress is not None and progress.digest == mark else None


def _read(path: Path, also: Sequence[type] = ()) -> Solution | Progress:
    header, arrays = read_arrays(path)
    try:
        found = decode(header.get("state"), arrays, also)
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise StateError(
            f"{path}: written by version {header.get('version')}, not readable by {__version__}: "
            f"{error}"
        ) from error
    if not isinstance(found, (Solution, Progress)):
        raise StateError(f"{path}: holds no state")
    return found
