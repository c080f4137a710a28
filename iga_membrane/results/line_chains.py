"""Closed lines from their pieces."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..quadrature import gauss


def closed_lines(points: Array) -> list[Index]:
    """Numbers of the points (k * q,) of each closed line, in order along it.

    Parameters
    ----------
    points : (k, q, 3) Gauss points on pieces of lines, which meet end to end.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count, along = points.shape[:2]
    if not count:
        return []
    partner = _partners(_ends(points))
    ends = np.arange(2 * count) // 2
    graph = coo_array((np.ones(2 * count), (ends, partner // 2)), (count, count))
    _, label = connected_components(graph, directed=False)
    found, order = [], np.arange(along)
    for which in np.unique(label):
        members = np.flatnonzero(label == which)
        walk = _walked(int(members[0]), len(members), partner)
        numbers = [k * along + (order[::-1] if back else order) for k, back in walk]
        found.append(np.concatenate(numbers))
    return found


def seen_once(places: Array, images: int) -> tuple[Index, Index]:
    """Pieces of all images of a sector, those of elements on mirror planes from one image only, and
    the number of images in which each of them is.

    Parameters
    ----------
    places : (images * k, 3) a place of the element of each piece, image by image.
    """
    from scipy.spatial import cKDTree

    each = len(places) // images
    if not each:
        return np.zeros(0, int), np.zeros(0, int)
    near = SAME * float(np.ptp(places, axis=0).max())
    pairs = cKDTree(places).query_pairs(near, output_type="ndarray")
    pairs = pairs[pairs[:, 0] // each != pairs[:, 1] // each]
    first, second = pairs.min(axis=1), pairs.max(axis=1)
    in_images = np.unique(np.stack([first, second // each], axis=1), axis=0)[:, 0]
    times = 1 + np.bincount(in_images, minlength=len(places))
    kept = np.setdiff1d(np.arange(len(places)), second)
    return kept, times[kept]


SAME = 1e-7
"""Distance of places that are one and the same, over the size of all."""


def _ends(points: Array) -> Array:
    """(2 k, 3) both ends of each piece, by the polynomial through its points."""
    nodes, _ = gauss(points.shape[1])
    power = np.arange(len(nodes))
    at_ends = np.array([[0.0], [1.0]]) ** power @ np.linalg.inv(nodes[:, None] ** power)
    return np.asarray(np.einsum("eq,kqi->kei", at_ends, points)).reshape(-1, 3)


def _partners(ends: Array) -> Index:
    """(2 k,) the end of another piece that each end meets: the nearest pairs first."""
    from scipy.spatial import cKDTree

    away, near = cKDTree(ends).query(ends, min(5, len(ends)))
    first, place = np.unravel_index(np.argsort(away, axis=None), away.shape)
    partner = np.full(len(ends), -1)
    for one, two in zip(first.tolist(), near[first, place].tolist(), strict=True):
        if one // 2 != two // 2 and partner[one] < 0 and partner[two] < 0:
            partner[one], partner[two] = two, one
    return np.where(partner < 0, np.arange(len(ends)) ^ 1, partner)


def _walked(piece: int, count: int, partner: Index) -> list[tuple[int, bool]]:
    """Pieces from one on, and whether each is walked backwards."""
    found: list[tuple[int, bool]] = []
    end = 2 * piece
    while len(found) < count and (end // 2, bool(end % 2)) not in found[:1]:
        found.append((end // 2, bool(end % 2)))
        end = int(partner[end ^ 1])
    return found
