"""Sectors of a closed ring patch: mirror images share unknowns, one sector is integrated."""

from __future__ import annotations

import numpy as np

from ..arrays import Index
from ..errors import SceneError
from ..splines import Space
from .supports import Sector
from .surface import Surface

# Mirror planes as fractions of the ring: xi1 -> fold * turn - xi1.
FOLDS = {"full": (), "half": (0.0,), "quarter": (0.0, 0.5), "eighth": (0.0, 0.5, 0.25)}


def sector_elements(space: Space, sector: Sector) -> Index:
    """Numbers of the elements in one sector."""
    ring, meridian = space.bases
    return np.arange(ring.elements // sector.copies * meridian.elements)


def check_symmetric(surface: Surface, sector: Sector) -> None:
    """Refuse a start that lacks the mirror planes of its model.

    Raises
    ------
    SceneError
        With the largest distance of a control point from the mirror image it should be.
    """
    net = surface.net
    around = np.arange(len(net))
    for fold in FOLDS[sector.model]:
        turn = 2.0 * np.pi * fold
        mirror = np.array(
            [[np.cos(turn), np.sin(turn), 0.0], [np.sin(turn), -np.cos(turn), 0.0], [0.0, 0.0, 1.0]]
        )
        off = float(np.abs(net[_image(surface.space, fold, around)] - net @ mirror).max())
        if off > 1e-8 * surface.size:
            raise SceneError(
                f'start: not symmetric as the "{sector.model}" model needs (off by {off:g}); '
                "centre the start or take a larger discretization.model"
            )


def _image(space: Space, fold: float, around: Index) -> Index:
    """Mirror images of functions of the ring: abscissae add up to the fold."""
    ring, n1 = space.bases[0], len(around)
    first = ring.abscissae[0] / (ring.breaks[-1] - ring.breaks[0]) * n1
    return (round(fold * n1 - 2 * first) - around) % n1


def sector_images(space: Space, sector: Sector) -> Index:
    """(count,) the control point of which each is a mirror image (or itself).

    Raises
    ------
    SceneError
        If the space is not a closed ring of whole sectors.
    """
    ring, _ = space.bases
    if not ring.periodic or ring.elements % sector.copies:
        raise SceneError(
            f'model = "{sector.model}" needs a closed ring of elements that {sector.copies} '
            f"divides (got {ring.elements})"
        )
    n1 = ring.count
    around = np.arange(n1)
    owner = around.copy()
    for fold in FOLDS[sector.model]:
        image = _image(space, fold, around)
        for _ in range(sector.copies):
            owner = np.minimum(owner, owner[image])
            owner = owner[owner]
    rings = space.net_shape[1] - space.joined_rings
    result = np.arange(space.count)
    result[: n1 * rings] = (owner[:, None] * rings + np.arange(rings)).ravel()
    if space.pole == 1 and sector.model != "full":
        # corners of the pole at 0, 120 and 240 degrees: y -> -y swaps the last two; with
        # x -> -x as well the tangent plane cannot tilt and all three are one
        corner = n1 * rings
        result[corner + 2] = corner + 1
        if sector.model != "half":
            result[corner + 1 :] = corner
    return result
