"""Sectors of a closed ring patch: mirror images share unknowns, one sector is integrated."""

from __future__ import annotations

import numpy as np

from ..arrays import Index
from ..errors import SceneError
from ..splines import Space
from .supports import Sector

# Mirror planes as fractions of the ring: xi1 -> fold * turn - xi1.
FOLDS = {"full": (), "half": (0.0,), "quarter": (0.0, 0.5), "eighth": (0.0, 0.5, 0.25)}


def sector_elements(space: Space, sector: Sector) -> Index:
    """Numbers of the elements in one sector."""
    ring, meridian = space.bases
    return np.arange(ring.elements // sector.copies * meridian.elements)


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
    # The mirror image of function i is function shift - i: abscissae add up to the fold.
    first = ring.abscissae[0] / (ring.breaks[-1] - ring.breaks[0]) * n1
    for fold in FOLDS[sector.model]:
        image = (round(fold * n1 - 2 * first) - around) % n1
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
