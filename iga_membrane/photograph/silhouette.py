"""From a photograph against the light to the droplet's outline, to a part of a pixel."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import POSITIVE, array, listed, path, refusal
from ..errors import SceneError
from ..optional import optional
from ..quantities import DIMENSIONLESS, SI, Quantity
from .base_line import BaseLine, base_of
from .outline import Camera, Outline
from .shadow import CLEAR, edge_near, shadow_of

SMALLEST_IMAGE = 32
"""Pixels along a side at least: below there is no droplet to measure."""


def _image(field: str, value: Any) -> Any:
    """Grey or coloured values of pixels, or the file of a picture."""
    if not listed(value):
        return path(field, value)
    found = array(field, value)
    if found.ndim not in (2, 3) or min(found.shape[:2]) < SMALLEST_IMAGE:
        raise refusal(
            field, value, "must be an image, (rows, columns) or (rows, columns, colours)",
            f"got shape {found.shape}, and a side has {SMALLEST_IMAGE} pixels at least",
        )  # fmt: skip
    return found


@checked(image=_image, scale=POSITIVE)
def silhouette(image: Any, *, scale: float = 1.0) -> Outline:
    """The outline of the droplet in a photograph against the light.

    Parameters
    ----------
    image : (rows, columns) or (rows, columns, colours) values of pixels, the first row on top, or
        the file of a picture. The droplet is dark before a bright background; what it stands on or
        hangs from is dark too and reaches the image's border, or is not seen, or mirrors it.
    scale : length of a pixel, ``"8 um"``.

    Returns
    -------
    Outline
        (n, 2) points where rows of the image meet the droplet's edge, by lengths: x along the base
        line from the middle of the foot, z up from the base line, negative where the droplet
        hangs. An array whose ``camera`` knows the image, where the base line is and how well.

    Raises
    ------
    SceneError
        A file that cannot be read as a picture; no droplet in it, or no base line.
    """
    units = SI if isinstance(scale, Quantity) else DIMENSIONLESS
    shadow = shadow_of(_grey(image))
    base = base_of(shadow)
    edges = np.array(list(_edges(shadow.values, base)))
    if len(edges) < FEWEST:
        raise SceneError(
            f"image: only {len(edges)} points of an outline are clear of the base line, {FEWEST} "
            "are needed; a droplet must be dark on a bright background and in focus"
        )
    foot = base.foot(edges)
    camera = Camera(
        shadow.values, float(scale), (foot, base.row(foot)), base.tilt, base.error * scale,
        base.hangs, units,
    )  # fmt: skip
    points = camera.points(edges)
    return Outline(points, camera)


FEWEST = 12
"""Points of an outline at least: three for each number that is sought."""


def _edges(values: Array, base: BaseLine) -> Iterator[tuple[float, float]]:
    """Columns and rows where rows of the image meet the body's edge, left and right."""
    dark = float(np.median(values[base.body]))
    faint = dark + FAINT * (1.0 - dark)
    for row in map(int, np.flatnonzero(base.body.any(axis=1))):
        columns = np.flatnonzero(base.body[row])
        left, right = float(columns[0]) - 0.5, float(columns[-1]) + 0.5
        room = 0.5 * (right - left)
        inside = values[row, int(left + 0.35 * (right - left)) : int(right - 0.35 * (right - left))]
        # the blur of a flat top covers rows from above and below
        if room < CLEAR + 2 or not base.is_clear(row, (left, right)) or inside.mean() > faint:
            continue
        for start, way in ((left, 1), (right, -1)):
            found = edge_near(values[row], start, way, room)
            if found is not None:
                yield found, float(row)


FAINT = 0.02
"""Light in the middle of a row, over that of the background, up to which it is all shadow."""


def _grey(image: Any) -> Array:
    """(rows, columns) grey values of pixels or of a picture's file."""
    if isinstance(image, (str, os.PathLike)):
        image = _read(Path(image))
    found = np.asarray(image, float)
    return found if found.ndim == 2 else found[..., :3].mean(axis=-1)


def _read(file: Path) -> Array:
    """The pixels of a picture's file."""
    if not file.is_file():
        raise SceneError(f"image = {str(file)!r}: there is no such file")
    pictures = optional("PIL.Image", "a photograph")
    try:
        with pictures.open(file) as opened:
            return np.asarray(opened.convert("F") if opened.mode != "I" else opened, float)
    except (OSError, ValueError) as error:
        raise SceneError(f"image = {str(file)!r}: cannot be read as a picture ({error})") from error
