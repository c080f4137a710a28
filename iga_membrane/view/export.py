"""Write a solution to a file, by the file's ending; whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..arguments import checked
from ..driver.solution import Solution
from ..errors import OutputError
from ..files import write_whole


@checked()
def save(solution: Solution, path: str | Path) -> None:
    """Write a solution.

    Parameters
    ----------
    solution : converged or not.
    path : its ending says what is written: .json the result, .npz the state, .vtu the exact
        rational Bezier surface with its fields, .stl, .obj or .ply the shape in triangles,
        .geomdl.json the spline surface for geomdl, .lines.csv the points of the contact lines,
        .forces.csv the forces on particles, asperities and substrate, .png a picture.

    Raises
    ------
    OutputError
        Another ending, or a place that cannot be written. Nothing half-written is left behind.
    """
    path = Path(path)
    write_whole(path, WRITERS[ending_of(path)](solution))


def ending_of(path: Path) -> str:
    """The ending that says what to write.

    Raises
    ------
    OutputError
        None that is known.
    """
    known = [ending for ending in WRITERS if path.name.endswith(ending)]
    if not known:
        raise OutputError(f"{path}: ending must be one of {', '.join(WRITERS)}")
    return max(known, key=len)


Writer = Callable[[str], object]
"""Writes the file of a name."""


def _result(solution: Solution) -> Writer:
    from ..driver.result_file import result_text

    return _text(result_text(solution))


def _state(solution: Solution) -> Writer:
    from ..driver.state import write_state

    return lambda file: write_state(Path(file), solution)


def _vtu(solution: Solution) -> Writer:
    from .vtu import write_vtu

    return lambda file: write_vtu(solution, file)


def _shape(solution: Solution) -> Writer:
    from .shape import write_shape

    return lambda file: write_shape(solution, file)


def _geomdl(solution: Solution) -> Writer:
    from ..surface.exchange import write_geomdl

    return lambda file: write_geomdl(solution.surface, file)


def _lines(solution: Solution) -> Writer:
    from ..tables import csv_text
    from .tables import line_rows

    return _text(csv_text(line_rows(solution)))


def _forces(solution: Solution) -> Writer:
    from ..tables import csv_text
    from .tables import force_rows

    return _text(csv_text(force_rows(solution)))


def _picture(solution: Solution) -> Writer:
    from .picture import plot

    return lambda file: plot(solution, file)


def _text(text: str) -> Writer:
    return lambda file: Path(file).write_text(text, encoding="utf-8")


WRITERS: dict[str, Callable[[Solution], Writer]] = {
    ".json": _result,
    ".npz": _state,
    ".vtu": _vtu,
    ".stl": _shape,
    ".obj": _shape,
    ".ply": _shape,
    ".geomdl.json": _geomdl,
    ".lines.csv": _lines,
    ".forces.csv": _forces,
    ".png": _picture,
}
"""Ending to what writes it."""
