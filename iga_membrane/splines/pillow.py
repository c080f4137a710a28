"""A closed surface from one square: its sides are folded at their middles.

The square [-1, 1]^2 is one face of a pillow: the point (1, y) is glued to (1, -y), (x, 1) to
(-x, 1), and so on, which closes the square to a sphere. Splines on equal knots cross the seams as
smoothly as any knot: the coefficient at ``(2 - x, -y)`` is that at ``(x, y)``. Only at the middles
of the sides, where the pillow's corners are, the parametrization turns like ``z^2``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Index
from .basis import uniform_basis
from .space import Space, tensor_space


def pillow_space(degree: int, elements: int) -> Space:
    """Closed space.

    Parameters
    ----------
    elements : from the middle of the square to a side; the square has four times their square.
    """
    line = uniform_basis(-1.0, 1.0, 2 * elements, degree)
    flat = tensor_space(line, line)
    shared = _glued(degree, elements, line.count)
    _, first, numbers = np.unique(shared, return_index=True, return_inverse=True)
    return replace(
        flat,
        functions=numbers[flat.functions],
        count=len(first),
        shared=numbers.ravel(),
        leaders=first,
    )


def _glued(degree: int, elements: int, count: int) -> Index:
    """(count^2,) for each place of the net the first place that has the same coefficient."""
    # function i is centred at i - (degree - 1) / 2 elements from the side
    i, j = np.divmod(np.arange(count * count), count)
    width = 2 * elements
    owner: Index = np.arange(count * count)
    folds = []
    for low in (0, 2 * width):
        across, along = low + degree - 1, width + degree - 1
        folds += [(across - i, along - j), (along - i, across - j)]
    for _ in range(8):
        for k, m in folds:
            inside = (k >= 0) & (k < count) & (m >= 0) & (m < count)
            image = np.where(inside, k * count + m, np.arange(count * count))
            owner = np.minimum(owner, owner[image])
    return owner
