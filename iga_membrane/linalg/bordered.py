"""Symmetric matrices by size: dense when small, sparse fronts when large.

Both solve ``K s - B m = -g, B^T s = -c`` (a Newton step with multipliers) and count the negative
eigenvalues of ``K`` on the null space of ``B^T``: the stability index.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import Array, Index
from ..deadline import check_time
from .inverse_root import InverseRoot, SingularMatrix

if TYPE_CHECKING:
    from .multifrontal import Elimination, Multifrontal

# scipy takes a quarter of a small solve's process, so it is imported where a matrix is sparse
DENSE_LIMIT = 400
"""Up to this many unknowns a solve costs less with dense factorizations than with sparse ones and
what they load (docs/results/choices.md)."""
WEIGHT = 10.0
"""Stiffness of the constraints of a dense matrix over its largest diagonal entry."""
LOST = 1e-8
"""Relative defect of a solve from which the matrix counts as singular."""
REFINEMENTS = 4
"""Solves at most with one factorization; the second is usually the last."""


class SparsePattern:
    """Where element blocks land in a compressed column matrix, found once.

    Parameters
    ----------
    size : number of unknowns.
    groups : arrays (elements, local) of the unknown of each local function, -1 where fixed;
        unknowns from ``size`` on are left out.
    places : (size, dimensions) where each unknown is.
    """

    def __init__(self, size: int, groups: Sequence[Index], places: Array) -> None:
        from scipy.sparse import csc_array

        self.size = size
        self._places = places
        keys = np.concatenate([_keys(size, unknowns) for unknowns in groups])
        columns, rows = np.divmod(keys[keys < size * size], size)
        filled = csc_array((np.ones(len(rows), bool), (rows, columns)), (size, size))
        filled.sum_duplicates()  # sorts, several times faster than unique keys
        self.rows, self.starts = filled.indices, filled.indptr
        columns = np.repeat(np.arange(size), np.diff(self.starts))
        self.entries = columns * size + self.rows
        self.diagonal = np.searchsorted(self.entries, np.arange(size) * (size + 1))
        self._slots: dict[bytes, Index] = {}

    @cached_property
    def elimination(self) -> Elimination:
        """The order in which matrices with this pattern are factorized."""
        from .multifrontal import Elimination

        return Elimination(self.rows, self.starts, self._places)

    def slots(self, unknowns: Index) -> Index:
        """Places of blocks that lie inside the pattern, found once for each set of them."""
        key = unknowns.tobytes()
        found = self._slots.get(key)
        if found is None:
            keys = _keys(self.size, unknowns)
            places = np.searchsorted(self.entries, keys)
            found = np.where(keys < self.size**2, places, len(self.entries))
            self._slots[key] = found
        return found


def _keys(size: int, unknowns: Index) -> Index:
    columns, rows = unknowns[:, :, None], unknowns[:, None, :]
    inside = (columns >= 0) & (rows >= 0) & (columns < size) & (rows < size)
    return np.where(inside, columns * size + rows, size * size).ravel()


class Matrix:
    """Symmetric matrix assembled from element blocks.

    Parameters
    ----------
    size : number of unknowns.
    pattern : of the first ``pattern.size`` unknowns, the rest couple with all of them; None for
        dense storage.

    Attributes
    ----------
    full : (n, k) columns of the unknowns that are not in the pattern.
    """

    def __init__(self, size: int, pattern: SparsePattern | None = None) -> None:
        self.size = size
        self.pattern = pattern
        self.data = np.zeros(size * size if pattern is None else len(pattern.entries))
        self._sparse: Any = None
        self.full = np.zeros((size, 0 if pattern is None else size - pattern.size))

    def add(self, unknowns: Index, blocks: Array) -> None:
        """Add symmetric element blocks (elements, local, local)."""
        inside = self.pattern
        slots = _keys(self.size, unknowns) if inside is None else inside.slots(unknowns)
        self.data += np.bincount(slots, blocks.ravel(), len(self.data) + 1)[:-1]
        for k, column in enumerate(self.full.T):
            elements, local = np.nonzero(unknowns == self.size - len(self.full.T) + k)
            rows = unknowns[elements]
            column += np.bincount(
                rows.ravel() + 1, blocks[elements, :, local].ravel(), self.size + 1
            )[1:]

    def add_at(self, places: Index, values: Array) -> None:
        """Add values at places of :attr:`data`."""
        self.data += np.bincount(places, values, len(self.data))

    def diagonal(self) -> Array:
        """(n,)"""
        if self.pattern is None:
            return np.asarray(self.data[:: self.size + 1])
        return np.append(self.data[self.pattern.diagonal], np.diag(self.full[self.pattern.size :]))

    def dense(self) -> Array:
        """(n, n)"""
        if self.pattern is None:
            return self.data.reshape(self.size, self.size)
        below = self.full[: self.pattern.size].T
        return np.hstack([np.vstack([self.sparse().toarray(), below]), self.full])

    def sparse(self) -> Any:
        """The part with a pattern as ``scipy.sparse.csc_array``."""
        from scipy.sparse import csc_array

        pattern = self.pattern
        assert pattern is not None
        if self._sparse is None or self._sparse.data is not self.data:
            shape = (pattern.size, pattern.size)
            self._sparse = csc_array((self.data, pattern.rows, pattern.starts), shape)
        return self._sparse

    def __matmul__(self, right: Array) -> Array:
        """The product with (n,) or (n, k)."""
        if self.pattern is None:
            return np.asarray(self.dense() @ right)
        first = self.pattern.size
        near, far = self.sparse() @ right[:first], self.full[:first].T @ right[:first]
        return np.concatenate([near, far]) + self.full @ right[first:]


class Contributions(Matrix):
    """Element blocks by rows of a motion, kept to be summed by the unknowns of several.

    Attributes
    ----------
    kept : arrays (elements, local) of rows, each with its blocks (elements, local, local).
    """

    def __init__(self, size: int) -> None:
        super().__init__(0)
        self._rows = size
        self.kept: list[tuple[Index, Array]] = []

    def add(self, unknowns: Index, blocks: Array) -> None:
        self.kept.append((unknowns, blocks))

    def add_at(self, places: Index, values: Array) -> None:
        """Add values at places of a full matrix of rows."""
        pairs = np.stack(np.divmod(places, self._rows), axis=1)
        self.kept.append((pairs, values[:, None, None] * np.eye(2, k=1)))

    def summed(self, into: Matrix, factors: Array, unknowns: Index) -> Matrix:
        """Add all blocks to a matrix, for motions in which each row takes ``factors`` of its
        ``unknowns`` (images, rows)."""
        for rows, blocks in self.kept:
            for factor, unknown in zip(factors, unknowns, strict=True):
                part = factor[rows]
                into.add(unknown[rows], blocks * part[:, :, None] * part[:, None, :])
        return into


class Bordered:
    """Factorization of ``[[K + shift, B], [B^T, 0]]``.

    Raises
    ------
    SingularMatrix
        If the factorization breaks down.
    """

    def __init__(self, matrix: Matrix, border: Array, shift: Array | None = None) -> None:
        check_time()
        self._n, self._m = border.shape
        self._border = border
        self._shift = shift
        self._matrix = matrix
        self._weights: Array = np.zeros(self._m)
        self._first = self._n if matrix.pattern is None else matrix.pattern.size
        self._inner = self._dense() if matrix.pattern is None else self._sparse(matrix.pattern)
        self._reduce()

    def solve(
        self, top: Array, bottom: Array, accuracy: float = 1e-13, lost: float = LOST
    ) -> tuple[Array, Array]:
        """``K s + B q = top`` (n,) or (n, k), ``B^T s = bottom`` (m,) or (m, k), each refined down
        to a relative defect of ``accuracy``; one above ``lost`` is refused."""
        s, q = np.zeros_like(top), np.zeros_like(bottom)
        r_top, r_bottom = top, bottom
        size = np.linalg.norm(np.concatenate([top, bottom]), axis=0)
        for _ in range(REFINEMENTS):
            ds, dq = self._solve_once(r_top, r_bottom)
            s, q = s + ds, q + dq
            r_top, r_bottom = self._defect(s, q, top, bottom)
            miss = np.linalg.norm(np.concatenate([r_top, r_bottom]), axis=0)
            if np.all(miss <= accuracy * size):
                break
        if not np.all(miss <= lost * size):
            raise SingularMatrix(
                f"the linear solve leaves a relative defect of {np.max(miss / size):.1e}"
            )
        return s, q

    def stiffened(self, block: Array) -> Bordered:
        """The same with a matrix (k, k) added to the last unknowns."""
        k = len(block)
        if self._matrix.pattern is None:
            return Bordered(self._plus(block), self._border, self._shift)
        other = copy(self)
        other._matrix = self._plus(block)
        other._schur = self._schur.copy()
        other._schur[:k, :k] += block
        other._count()
        return other

    def _plus(self, block: Array) -> Matrix:
        plus = copy(self._matrix)
        plus.data, plus.full = plus.data.copy(), plus.full.copy()
        k = len(block)
        if plus.pattern is None:
            plus.dense()[-k:, -k:] += block
        else:
            plus.full[-k:] += block
        return plus

    def _count(self) -> None:
        negative = int((np.linalg.eigvalsh(self._schur) < 0).sum()) if self._schur.size else 0
        self.index = self._inner.negative + negative - self._m

    def last(self, count: int) -> Array:
        """(count, count) Hessian of the last unknowns when all the others follow them."""
        unit = np.eye(self._n, count, count - self._n)
        follow = self.solve(unit, np.zeros((self._m, count)))[0][self._n - count :]
        return np.linalg.inv(0.5 * (follow + follow.T))

    def _defect(self, s: Array, q: Array, top: Array, bottom: Array) -> tuple[Array, Array]:
        r = top - self._matrix @ s - self._border @ q
        if self._shift is not None:
            r = r - (self._shift * s.T).T
        return r, bottom - self._border.T @ s

    def _dense(self) -> InverseRoot:
        """Root of ``K + B W B^T``, which is positive wherever K is on the null space of B^T and the
        weights are large; the multipliers absorb the rest (augmented Lagrangian)."""
        full = self._matrix.dense().copy()
        if self._shift is not None:
            full[np.diag_indices(self._n)] += self._shift
        if self._m:
            largest = np.abs(full.diagonal()).max(initial=0.0)
            squares = (self._border**2).sum(axis=0)
            self._weights = WEIGHT * largest / np.where(squares > 0.0, squares, 1.0)
            full += (self._border * self._weights) @ self._border.T
        if not np.isfinite(full).all():
            raise SingularMatrix("the matrix has entries that are not finite")
        return InverseRoot(full)

    def _sparse(self, pattern: SparsePattern) -> Multifrontal:
        from .multifrontal import Multifrontal

        data = self._matrix.data
        if self._shift is not None:
            data = data.copy()
            data[pattern.diagonal] += self._shift[: self._first]
        return Multifrontal(pattern.elimination, data)

    def _reduce(self) -> None:
        """The Schur complement of the border and of the full columns; it adds its own negative
        eigenvalues (Haynsworth)."""
        first, n = self._first, self._n
        full = self._matrix.full
        self._outer = np.hstack([full[:first], self._border[:first]])
        corner = np.zeros(2 * (self._outer.shape[1],))
        corner[: n - first, : n - first] = full[first:]
        if self._shift is not None:
            corner[: n - first, : n - first] += np.diag(self._shift[first:])
        corner[: n - first, n - first :] = self._border[first:]
        corner[n - first :, : n - first] = self._border[first:].T
        self._outer_solved = self._inner.solve(self._outer) if corner.size else self._outer
        self._schur = corner - self._outer.T @ self._outer_solved
        self._count()

    def _solve_once(self, top: Array, bottom: Array) -> tuple[Array, Array]:
        s = self._inner.solve(top[: self._first])
        if not self._schur.size:
            return s, bottom
        rest = np.concatenate([top[self._first :], bottom]) - self._outer.T @ s
        q = np.linalg.solve(self._schur, rest)
        last = self._n - self._first
        s = np.concatenate([s - self._outer_solved @ q, q[:last]])
        return s, q[last:] + (self._weights * bottom.T).T
