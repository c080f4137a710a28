"""A small picture of a solution for a notebook."""

from __future__ import annotations

import tempfile
from pathlib import Path

from ..driver.solution import Solution
from .drawing import can_draw
from .picture import plot

SIZE, RESOLUTION = (640, 480), 65
"""Pixels, shown at half their size; points along each direction of the patch."""


def portrait(solution: Solution) -> bytes | None:
    """PNG of the solution without colours; None where this machine cannot draw."""
    if not can_draw():
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "portrait.png"
        plot(solution, file, color="none", size=SIZE, resolution=RESOLUTION)
        return file.read_bytes()
