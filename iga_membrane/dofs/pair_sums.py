"""Hessians by pairs of control points, summed over the elements and carried over to unknowns.

The sum knows no directions, so it costs the same however many unknowns a control point has: each
pair has nine numbers, ``K_ab = S_ab + [k_ab]x``, and those of two unknowns are ``d . K_ab d'``.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..arrays import Array, Index
from ..linalg.bordered import Matrix, SparsePattern
from .spines import Spines


class PairSums:
    """Where pairs of local functions land in the Hessian of the unknowns.

    Parameters
    ----------
    spines : the motion, without shifts.
    functions : (elements, local) control points of the elements.
    pattern : of the matrices, or None where they are dense.
    """

    def __init__(self, spines: Spines, functions: Index, pattern: SparsePattern | None) -> None:
        a, b = np.triu_indices(functions.shape[1])
        count = spines.space.count
        keys, slots = np.unique(functions[:, a] * count + functions[:, b], return_inverse=True)
        self._slots: Index = slots.ravel()
        self._first, self._second = np.divmod(keys, count)
        self._rows = [np.arange(count), *spines.extra]
        unknowns = [
            (spines.unknowns[one[self._first]], spines.unknowns[two[self._second]])
            for one in self._rows
            for two in self._rows
        ]
        self._moving = [np.flatnonzero((u >= 0) & (v >= 0)) for u, v in unknowns]
        moved = [(u[k], v[k]) for (u, v), k in zip(unknowns, self._moving, strict=True)]
        one, two = (np.concatenate(side) for side in zip(*moved, strict=True))
        size = spines.size
        places = np.concatenate([one * size + two, two * size + one])
        self._places = places if pattern is None else np.searchsorted(pattern.entries, places)

    def add(self, matrix: Matrix, numbers: Array, directions: Array) -> None:
        """Add a Hessian to a matrix.

        Parameters
        ----------
        numbers : (9, elements, pairs) of :func:`iga_membrane.terms.pairs.hessian`.
        directions : (rows, 3) of the motion.
        """
        k: list[Array] = [
            np.bincount(self._slots, some.ravel()).astype(float, copy=False) for some in numbers
        ]
        values = [
            value if len(some) == len(value) else value[some]
            for value, some in zip(self._carried(k, directions), self._moving, strict=True)
        ]
        # the half of each pair, and its transpose
        matrix.add_at(self._places, np.tile(np.concatenate(values), 2))

    def _carried(self, k: list[Array], directions: Array) -> Iterator[Array]:
        """``d . K d'`` of all pairs, for every row of the first and of the second point."""
        xx, yy, zz, xy, xz, yz, x, y, z = k
        columns = (
            (xx, xy - z, xz + y),
            (xy + z, yy, yz - x),
            (xz - y, yz + x, zz),
        )
        d = [np.ascontiguousarray(directions[rows].T) for rows in self._rows]
        ends = [np.take(one, self._second, axis=1) for one in d]
        for one in d:
            u, v, w = np.take(one, self._first, axis=1)
            carried = [u * a + v * b + w * c for a, b, c in columns]
            for end in ends:
                yield carried[0] * end[0] + carried[1] * end[1] + carried[2] * end[2]
