"""Plots on paper, as wide as a column, by matplotlib."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ..errors import OutputError
from ..files import write_whole
from ..optional import optional

DPI = 200
"""Dots per inch of pictures without vectors."""


def figure(
    path: str | os.PathLike[str],
    width: float = 5.0,
    height: float = 3.75,
    rows: int = 1,
    **options: Any,
) -> Any:
    """A figure (inches) that can be written to a path, and its axes, beneath each other.

    Raises
    ------
    OutputError
        If matplotlib is not installed, or does not know the path's ending.
    """
    made = optional("matplotlib.figure", "a plot").Figure(
        figsize=(width, height), layout="constrained"
    )
    known = made.canvas.get_supported_filetypes()
    if Path(path).suffix.removeprefix(".") not in known:
        raise OutputError(f"{path}: ending must be one of {', '.join('.' + k for k in known)}")
    return made, made.subplots(rows, 1, **options)


def write_figure(made: Any, path: str | os.PathLike[str]) -> None:
    """Write a figure; the ending chooses the format (.png, .pdf, .svg), vectors where it has them.

    Raises
    ------
    OutputError
        A place that cannot be written.
    """
    write_whole(Path(path), lambda file: made.savefig(file, dpi=DPI))
