"""Places of a control net that follow several control points: poles and folds are closed by them.

On an element the functions of such a place are spread over those of the control points it follows.
They take the slots that it leaves free, so that every element keeps its number of functions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index


@dataclass(frozen=True, eq=False)
class Ruled:
    """Places of a net that are combinations of control points.

    Attributes
    ----------
    places : (k,) numbers of the places, rising.
    by : (k, m) the control points that each follows; share : (k, m) their parts, which sum to 1.
    """

    places: Index
    by: Index
    share: Array

    def of(self, points: Array) -> Array:
        """(k, c) their values from those of the control points (count, c)."""
        return np.einsum("km,kmc->kc", self.share, points[self.by])


def combined(tensor: Index, shared: Index, ruled: Ruled) -> tuple[Index, Index, Array]:
    """Functions of the elements by control points.

    Parameters
    ----------
    tensor : (elements, local) places of the net.
    shared : (places,) the control point of each, -1 where it is ruled.

    Returns
    -------
    functions : (elements, local) control points.
    near, combine : as in :class:`.Space`.

    Raises
    ------
    ValueError
        If an element has not enough slots.
    """
    functions = shared[tensor]
    near = np.flatnonzero((functions < 0).any(axis=1))
    local = tensor.shape[1]
    combine = np.broadcast_to(np.eye(local), (len(near), local, local)).copy()
    for operator, e in zip(combine, near, strict=True):
        own = functions[e]  # a view: slots are filled in place
        free = np.flatnonzero(own < 0)
        operator[free] = 0.0
        rows = np.searchsorted(ruled.places, tensor[e, free])
        missing = np.setdiff1d(ruled.by[rows], own)
        if len(missing) > len(free):
            raise ValueError(f"element {e}: {len(missing)} functions for {len(free)} slots")
        own[free] = own.max() if len(free) < local else missing[0]  # the rest stay empty
        own[free[: len(missing)]] = missing
        slot = {int(point): k for k, point in reversed(list(enumerate(own)))}
        slot |= dict(zip(missing.tolist(), free.tolist(), strict=False))
        for column, row in zip(free, rows, strict=True):
            for point, share in zip(ruled.by[row].tolist(), ruled.share[row], strict=True):
                operator[slot[point], column] += share
    return functions, near, combine
