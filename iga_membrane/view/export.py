"""Write a solution to a file, by the file's ending; whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from ..errors import OutputError
from ..solver.solution import Solution


def save(solution: Solution, path: str | Path) -> None:
    """Write a solution.

    Parameters
    ----------
    path : ending in .json (result), .npz (state), .vtu (exact rational Bezier surface) or .png
        (picture).

    Raises
    ------
    OutputError
        Another ending, or a place that cannot be written. Nothing half-written is left behind.
    """
    path = Path(path)
    match path.suffix:
        case ".json":
            from .result_file import result_text

            text = result_text(solution)
            write_whole(path, lambda file: Path(file).write_text(text, encoding="utf-8"))
        case ".npz":
            from .result_file import write_state

            write_whole(path, lambda file: write_state(solution, file))
        case ".vtu":
            from .vtu import write_vtu

            write_whole(path, lambda file: write_vtu(solution, file))
        case ".png":
            from .picture import plot

            write_whole(path, lambda file: plot(solution, file))
        case _:
            raise OutputError(f"{path}: ending must be .json, .npz, .vtu or .png")


def write_whole(path: Path, write: Callable[[str], object]) -> None:
    """Write to a temporary file beside ``path``, flush it to the disk, then rename it."""
    try:
        handle, name = tempfile.mkstemp(suffix=path.suffix, dir=path.parent or Path())
        os.close(handle)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error})") from error
    try:
        write(name)
        with open(name, "rb+") as file:
            os.fsync(file.fileno())
        os.chmod(name, 0o644)
        os.replace(name, path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error})") from error
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(name)


def check_folder(folder: Path) -> None:
    """Make a folder and prove that files can be written in it, before any work.

    Raises
    ------
    OutputError
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written ({error})") from error
