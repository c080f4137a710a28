"""Sectors of a whole patch: mirror images share unknowns, one sector is integrated.

A ring patch has its azimuth ``xi1`` counted from the x axis. A square patch has ``xi1`` along y and
``xi2`` along x, the origin at its middle.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import Array, Index
from ..errors import GeometryError, SceneError
from ..splines import Space, Table
from ..surface.surface import Surface
from .boundary_conditions import Model, Sector

# Mirror planes as fractions of the ring: xi1 -> fold * turn - xi1.
FOLDS: dict[Model, tuple[float, ...]] = {
    "full": (),
    "half": (0.0,),
    "quarter": (0.0, 0.5),
    "eighth": (0.0, 0.5, 0.25),
}


def sector_table(space: Space, sector: Sector, points: tuple[int, int]) -> Table:
    """Functions at the Gauss points of one sector; elements astride a mirror plane have half the
    weight."""
    elements, share = sector_elements(space, sector)
    table = space.table(points, elements)
    return replace(table, weights=table.weights * share[:, None])


def sector_elements(space: Space, sector: Sector) -> tuple[Index, Array]:
    """Elements of one sector, and the share of each that belongs to it."""
    one, two = space.bases
    if one.periodic:
        elements = np.arange(one.elements // sector.copies * two.elements)
        return elements, np.ones(len(elements))
    share = np.ones((one.elements, two.elements))
    if sector.model != "full":
        share *= _upper_half(one.elements)[:, None]
    if sector.model in ("quarter", "eighth"):
        share *= _upper_half(two.elements)
    if sector.model == "eighth":
        share *= np.tri(one.elements) - 0.5 * np.eye(one.elements)
    elements = np.flatnonzero(share)
    return elements, share.ravel()[elements]


def _upper_half(elements: int) -> Array:
    """Which elements of a line lie above its middle; one astride it counts half."""
    ahead = np.arange(elements) - 0.5 * (elements - 1)
    return np.asarray(0.5 * (1.0 + np.sign(ahead)))


def mirrors(sector: Sector) -> list[Array]:
    """Matrices (3, 3) that carry one sector to each of its images, itself first."""
    images: list[Array] = [np.eye(3)]
    for fold in FOLDS[sector.model]:
        images += [m @ reflection(fold) for m in images]
    return images


def in_sector(space: Space, sector: Sector, places: Array, rounding: float) -> Array:
    """(k,) whether places (k, 3) lie in the part of space of one sector, or on its edge."""
    x, y = places[:, 0], places[:, 1]
    inside = np.ones(len(x), bool)
    if sector.model != "full":
        inside &= y >= -rounding
    if sector.model in ("quarter", "eighth"):
        inside &= x >= -rounding
    if sector.model == "eighth":
        inside &= (x - y if space.bases[0].periodic else y - x) >= -rounding
    return inside


def reflection(fold: float) -> Array:
    """(3, 3) reflection by the vertical plane at half of a fraction of the turn."""
    turn = 2.0 * np.pi * fold
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.array([[cosine, sine, 0.0], [sine, -cosine, 0.0], [0.0, 0.0, 1.0]])


def sense(surface: Surface) -> int:
    """1 where a ring patch turns from x to y, -1 where it turns from y to x; 1 of other patches."""
    if not surface.space.bases[0].periodic:
        return 1
    rim = surface.net[:, 0, :2]
    ahead = np.roll(rim, -1, axis=0)
    return -1 if float((rim[:, 0] * ahead[:, 1] - rim[:, 1] * ahead[:, 0]).sum()) < 0 else 1


def check_symmetric(surface: Surface, sector: Sector) -> None:
    """Refuse a start that lacks the mirror planes of its model.

    Raises
    ------
    SceneError
        With the largest distance of a control point from the mirror image it should be.
    """
    net, turn = surface.net, sense(surface)
    for fold in FOLDS[sector.model]:
        image = net @ reflection(turn * fold)
        off = float(np.abs(net_image(surface.space, net, fold) - image).max())
        if off > 1e-8 * surface.size:
            raise SceneError(
                f'start: not symmetric as the "{sector.model}" model needs (off by {off:g}); '
                "centre the start or take a larger discretization.model"
            )


def net_image(space: Space, net: Any, fold: float) -> Any:
    """The entries of a net (n1, n2, ...) at the mirror images of its places."""
    ring = space.bases[0]
    if not ring.periodic:
        return {0.0: net[::-1], 0.5: net[:, ::-1], 0.25: np.swapaxes(net, 0, 1)}[fold]
    length = ring.breaks[-1] - ring.breaks[0]
    # abscissae of images add up to the fold
    wanted = fold * length - ring.abscissae
    off = np.abs((ring.abscissae - wanted[:, None] + 0.5 * length) % length - 0.5 * length)
    image = off.argmin(axis=1)
    if off[np.arange(len(image)), image].max() > 1e-9 * length:
        raise GeometryError("the ring's elements are not symmetric in the model's mirror planes")
    return net[image]


def _check_sectors(space: Space, sector: Sector) -> None:
    """Refuse a space that its sectors do not divide."""
    ring, other = space.bases
    if ring.periodic and ring.elements % sector.copies:
        raise SceneError(
            f'model = "{sector.model}" needs a ring of elements that {sector.copies} divides '
            f"(got {ring.elements})"
        )
    if not ring.periodic and sector.model == "eighth" and ring.elements != other.elements:
        raise SceneError('model = "eighth" needs as many elements in both directions')


def sector_images(space: Space, sector: Sector) -> Index:
    """(count,) the control point of which each is a mirror image (or itself).

    Raises
    ------
    SceneError
        If the space is neither a closed ring of whole sectors nor a square.
    """
    _check_sectors(space, sector)
    n1, n2 = space.net_shape
    numbers = np.arange(n1 * n2) if space.shared is None else space.shared
    first = np.arange(n1 * n2) if space.leaders is None else space.leaders
    owner = np.arange(len(first))
    for fold in list(FOLDS[sector.model]) * sector.copies:
        image = net_image(space, numbers.reshape(n1, n2), fold).ravel()[first]
        least = np.minimum(owner, owner[image])
        owner[image] = np.minimum(owner[image], least)
        owner = np.minimum(owner, least)
    if space.pole is None:
        return owner
    rings = n2 - space.joined_rings
    i, j = np.divmod(owner.reshape(n1, n2)[:, :rings].ravel(), n2)
    result = np.arange(space.count)
    result[: n1 * rings] = i * rings + j
    if space.pole == 1 and sector.model != "full":
        # corners of the pole at 0, 120 and 240 degrees: y -> -y swaps the last two; with
        # x -> -x as well the tangent plane cannot tilt and all three are one
        corner = n1 * rings
        result[corner + 2] = corner + 1
        if sector.model != "half":
            result[corner + 1 :] = corner
    return result
