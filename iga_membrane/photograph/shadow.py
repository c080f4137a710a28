"""What is dark in a photograph against the light, and where its edges are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ..arrays import Array, Mask
from ..errors import SceneError
from ..overview import brief_repr

CLEAR = 5
"""Pixels on either side of an edge within which it may be blurred: focused pictures are blurred
over 1 to 4."""
LEVEL = 10
"""Pixels beyond them that tell how bright it is there: few enough for uneven light."""
ROUNDS = 3
"""How often an edge is sought anew from where it was found: the second shift is below 0.01."""
CONTRAST = 0.3
"""Of an edge at least, over that of the picture: dust and reflections have less."""
BINS = 256
"""Of the histogram of grey values: as many as a camera tells apart."""


@dataclass(frozen=True, eq=False)
class Shadow:
    """A photograph in which the background is 1 and the shadow 0.

    Attributes
    ----------
    values : (rows, columns) brightness, that of highlights inside the shadow 0.
    dark : (rows, columns) whether a pixel belongs to the shadow.
    """

    values: Array
    dark: Mask

    __repr__ = brief_repr


def shadow_of(grey: Array) -> Shadow:
    """The shadow in a photograph whose upper corners are background.

    Raises
    ------
    SceneError
        A picture of one shade.
    """
    level = _threshold(grey)
    high, low = grey > level, grey <= level
    bright, dim = float(np.median(grey[high])), float(np.median(grey[low]))
    values = (grey - dim) / (bright - dim)
    corner = max(2, min(grey.shape) // 40)
    corners = np.concatenate([values[:corner, :corner].ravel(), values[:corner, -corner:].ravel()])
    if np.median(corners) < 0.5:  # a bright droplet before a dark background
        values = 1.0 - values
    dark = values < 0.5
    inside = ndimage.binary_fill_holes(dark) & ~dark
    values = np.where(ndimage.binary_dilation(inside, iterations=2), 0.0, values)
    return Shadow(values, values < 0.5)


def _threshold(grey: Array) -> float:
    """The level that parts bright from dark pixels: Otsu's, of the largest variance between."""
    counts, borders = np.histogram(grey, BINS)
    middle = 0.5 * (borders[1:] + borders[:-1])
    below, above = np.cumsum(counts)[:-1], counts.sum() - np.cumsum(counts)[:-1]
    if not counts.sum() or not np.ptp(grey) > 0.0:
        raise SceneError("image: every pixel has the same shade; there is no droplet in it")
    total = np.cumsum(counts * middle)
    with np.errstate(invalid="ignore", divide="ignore"):
        apart = below * above * (total[:-1] / below - (total[-1] - total[:-1]) / above) ** 2
    best = np.flatnonzero(apart == np.nanmax(apart))
    return float(borders[1:-1][best].mean())


def edge_near(line: Array, start: float, way: int, room: float) -> float | None:
    """Where a row or column of pixels passes an edge, to a part of a pixel.

    Parameters
    ----------
    line : brightness; pixel k reaches from k - 0.5 to k + 0.5.
    start : a place within a pixel or two of the edge.
    way : 1 if the shadow lies at larger places, else -1.
    room : pixels of shadow from the edge on, at least ``CLEAR + 2``.

    Returns
    -------
    The place at which a sharp edge would leave as much light as there is between the levels on both
    sides, which is right for any blur that is the same on both sides; None where there is hardly an
    edge.
    """
    light = np.concatenate([[0.0], np.cumsum(line)])
    borders = np.arange(len(line) + 1) - 0.5

    def within(one: float, two: float) -> tuple[float, float]:
        """Light between two places, and the distance that is inside the picture."""
        low, high = np.clip(sorted((one, two)), borders[0], borders[-1])
        between = np.interp([low, high], borders, light)
        return float(between[1] - between[0]), float(high - low)

    place, deep = start, min(CLEAR + LEVEL, room)
    for _ in range(ROUNDS):
        outside, reach = within(place - way * CLEAR, place - way * (CLEAR + LEVEL))
        inside, depth = within(place + way * CLEAR, place + way * deep)
        if reach < 1.0 or depth < 1.0:
            return None
        bright, dim = outside / reach, inside / depth
        if bright - dim < CONTRAST:
            return None
        across, span = within(place - CLEAR, place + CLEAR)
        if span < 2.0 * CLEAR - 1e-9:
            return None
        lit = (across - dim * span) / (bright - dim)
        place = place + way * (lit - CLEAR)
    return place if abs(place - start) < CLEAR else None
