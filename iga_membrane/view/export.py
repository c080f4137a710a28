"""Write a solution to a file, by the file's ending; whole or not at all."""

from __future__ import annotations

from pathlib import Path

from ..errors import OutputError
from ..files import write_whole
from ..solver.solution import Solution
from ..solver.state import write_state


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
            from ..solver.result_file import result_text

            text = result_text(solution)
            write_whole(path, lambda file: Path(file).write_text(text, encoding="utf-8"))
        case ".npz":
            write_state(path, solution)
        case ".vtu":
            from .vtu import write_vtu

            write_whole(path, lambda file: write_vtu(solution, file))
        case ".png":
            from .picture import plot

            write_whole(path, lambda file: plot(solution, file))
        case _:
            raise OutputError(f"{path}: ending must be .json, .npz, .vtu or .png")
