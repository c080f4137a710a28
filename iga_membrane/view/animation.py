"""Frames of a path: one picture for each of its solutions, all from the same place."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import checked
from ..checks import POSITIVE
from ..driver.solution import Solution
from ..driver.trace import Path as Walk
from ..errors import OutputError, SceneError
from ..files import check_folder, write_whole
from ..optional import optional
from ..output_folder import FRAME, remove
from .fields import field
from .picture import extent, plot


@checked(seconds=POSITIVE)
def animate(
    solutions: Walk | Sequence[Solution],
    path: str | os.PathLike[str],
    *,
    seconds: float = 0.25,
    **options: Any,
) -> None:
    """Draw the solutions of a path, from one place and in one range of colours.

    Parameters
    ----------
    solutions : of a path, whose parameter is then written on the frames, or any others.
    path : a GIF file, or a folder for the frames ``frame_0000.png`` and so on, for a program that
        makes a film of them.
    seconds : per frame.
    options : of :func:`iga_membrane.plot`; ``color`` is "none" by default.

    Raises
    ------
    SceneError
        No solutions.
    OutputError
        Another ending, a place that cannot be written, or a machine that cannot draw.
    """
    path = Path(path)
    if path.suffix not in ("", ".gif"):
        raise OutputError(f"{path}: must end in .gif, or be a folder for frames")
    found, texts = _told(solutions)
    options = {"color": "none", "size": (800, 600), **options}
    if options["color"] != "none":
        options.setdefault("limits", _limits(found, options["color"]))
    boxes = [extent(solution) for solution in found]
    span = max(length for _, length in boxes)
    options.setdefault("focus", np.mean([middle for middle, _ in boxes], axis=0))
    zoom = options.pop("zoom", 1.0)
    folder = path if path.suffix == "" else None
    if folder is not None:
        _empty(folder)
    with tempfile.TemporaryDirectory() as scratch:
        frames = []
        for k, (solution, (_, length), text) in enumerate(zip(found, boxes, texts, strict=True)):
            frame = (folder or Path(scratch)) / FRAME.format(f"{k:04d}")
            plot(solution, frame, zoom=zoom * length / span, **options)
            frames.append(_with_text(frame, text))
        if folder is None:
            first, *others = frames
            write_whole(path, lambda file: first.save(
                file, save_all=True, append_images=others, duration=1e3 * seconds, loop=0
            ))  # fmt: skip


def _told(solutions: Walk | Sequence[Solution]) -> tuple[list[Solution], list[str]]:
    """The solutions of a film, and a line of text for each."""
    if isinstance(solutions, Walk):
        texts = [f"{solutions.parameter} = {value:.4g}" for value in solutions.values]
        return list(solutions.solutions), texts
    if not solutions:
        raise SceneError("solutions = []: at least one is needed")
    return list(solutions), [""] * len(solutions)


def _empty(folder: Path) -> None:
    """Make room for frames: those of an older path may be more."""
    check_folder(folder)
    for frame in folder.glob(FRAME.format("[0-9]" * 4)):
        remove(frame)


def _with_text(frame: Path, text: str) -> Any:
    """The picture of a frame, with a line of text in its corner, there and in the file."""
    Image, ImageDraw, ImageFont = (
        optional(f"PIL.{name}", "an animation") for name in ("Image", "ImageDraw", "ImageFont")
    )
    with Image.open(frame) as opened:
        image = opened.convert("RGB")
    if text:
        size = image.height // 24
        ImageDraw.Draw(image).text((size, size), text, "black", ImageFont.load_default(size))
        image.save(frame)
    return image


def _limits(solutions: Sequence[Solution], color: str) -> tuple[float, float]:
    """Range of a field over all solutions."""
    scale = solutions[0].scene.units
    values = []
    for solution in solutions:
        t = (np.arange(32) + 0.5) / 32
        bases = solution.surface.space.bases
        axes = [b.breaks[0] + (b.breaks[-1] - b.breaks[0]) * t for b in bases]
        at = solution.surface.at(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))
        values.append(field(solution, color, at).ravel())
    every = np.concatenate(values)
    if color == "residual":
        every = np.maximum(np.abs(every) / scale.pressure, 1e-16)
    low, high = np.percentile(every, [1.0, 99.0])
    return float(low), float(max(high, low + 1e-9 * abs(low) + 1e-300))
