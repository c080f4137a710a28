"""Small pictures for a notebook."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

from ..driver.solution import Solution
from ..photograph.fit import ProfileFit
from .drawing import can_draw
from .overlay import plot_fit
from .picture import plot

SIZE, RESOLUTION = (640, 480), 65
"""Pixels, shown at half their size; points along each direction of the patch."""


def portrait(solution: Solution) -> bytes | None:
    """PNG of the solution without colours; None where this machine cannot draw."""
    if not can_draw():
        return None
    return _drawn(lambda file: plot(solution, file, color="none", size=SIZE, resolution=RESOLUTION))


def fit_portrait(fit: ProfileFit) -> bytes:
    """PNG of a fit over its photograph."""
    return _drawn(lambda file: plot_fit(fit, file))


def _drawn(draw: Callable[[Path], None]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "portrait.png"
        draw(file)
        return file.read_bytes()
