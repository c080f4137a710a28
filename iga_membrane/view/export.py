"""Write a solution to a file, by the file's ending; whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..arguments import checked
from ..checks import refusal, text
from ..driver.solution import Solution
from ..errors import OutputError
from ..files import write_whole


def _ending(field: str, value: Any) -> str:
    """The end of a file's name, from its dot on."""
    if not text(field, value).startswith(".") or len(value) < 2:
        raise refusal(field, value, "must be the end of a file's name, from its dot on", "name one")
    return str(value)


@checked()
def save(solution: Solution, path: str | Path) -> None:
    """Write a solution.

    Parameters
    ----------
    solution : converged or not.
    path : its ending says what is written: .json the result, .npz the state, .vtu the exact
        rational Bezier surface with its fields, .linear.vtu the same in flat cells (for meshio and
        others), .stl, .obj or .ply the shape in triangles,
        .geomdl.json the spline surface for geomdl, .lines.csv the points of the contact lines,
        .forces.csv the forces on particles, asperities and substrate, .png a picture, .html one
        that turns in a browser; others by :func:`writer`.

    Raises
    ------
    OutputError
        Another ending, or a place that cannot be written. Nothing half-written is left behind.
    """
    path = Path(path)
    write_whole(path, _WRITERS[ending_of(path)](solution))


Writer = Callable[[str], object]
"""Writes the file of a name."""
Prepare = Callable[[Solution], Writer]
"""What is to be written of a solution, before any file is opened, to its writer."""
_WRITERS: dict[str, Prepare] = {}


@checked(ending=_ending)
def writer(ending: str) -> Callable[[Prepare], Prepare]:
    """Decorate a function that writes solutions to files with an ending.

    Parameters
    ----------
    ending : with its dot, ``".ply"``; the longest that fits a file's name decides.

    Returns
    -------
    Callable
        The decorator. What it decorates takes a solution and returns a function from the name of
        the file to write; what that writes appears under the name whole or not at all.

    Raises
    ------
    SceneError
        An ending without its dot.
    """

    def register(prepare: Prepare) -> Prepare:
        _WRITERS[ending] = prepare
        return prepare

    return register


def known_endings() -> tuple[str, ...]:
    """Endings that can be written."""
    return tuple(_WRITERS)


def ending_of(path: Path) -> str:
    """The ending that says what to write.

    Raises
    ------
    OutputError
        None that is known.
    """
    known = [ending for ending in _WRITERS if path.name.endswith(ending)]
    if not known:
        raise OutputError(f"{path}: ending must be one of {', '.join(_WRITERS)}")
    return max(known, key=len)


@writer(".json")
def _result(solution: Solution) -> Writer:
    from ..driver.result_file import result_text

    return _text(result_text(solution))


@writer(".npz")
def _state(solution: Solution) -> Writer:
    from ..driver.state import write_state

    return lambda file: write_state(Path(file), solution)


@writer(".vtu")
def _vtu(solution: Solution) -> Writer:
    from .vtu import write_vtu

    return lambda file: write_vtu(solution, file)


@writer(".linear.vtu")
def _linear_vtu(solution: Solution) -> Writer:
    from .vtu import write_linear_vtu

    return lambda file: write_linear_vtu(solution, file)


@writer(".stl")
@writer(".obj")
@writer(".ply")
def _shape(solution: Solution) -> Writer:
    from .shape import write_shape

    return lambda file: write_shape(solution, file)


@writer(".geomdl.json")
def _geomdl(solution: Solution) -> Writer:
    from ..surface.exchange import write_geomdl

    return lambda file: write_geomdl(solution.surface, file)


@writer(".lines.csv")
def _lines(solution: Solution) -> Writer:
    from ..tables import csv_text
    from .tables import line_rows

    return _text(csv_text(line_rows(solution)))


@writer(".forces.csv")
def _forces(solution: Solution) -> Writer:
    from ..tables import csv_text
    from .tables import force_rows

    return _text(csv_text(force_rows(solution)))


@writer(".html")
@writer(".png")
def _picture(solution: Solution) -> Writer:
    from .picture import plot

    return lambda file: plot(solution, file)


def _text(text: str) -> Writer:
    return lambda file: Path(file).write_text(text, encoding="utf-8")
