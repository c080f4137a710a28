"""Factorization of sparse symmetric matrices by nested dissection and dense fronts.

The unknowns are halved again and again across the longest side of the box that holds their places;
those of one half that touch the other separate the two and are eliminated last (George 1973). What
is eliminated together is one dense front, and what it leaves behind is added to the front above
(Duff and Reid 1983), so that nearly all work is products of dense matrices.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg.blas import dsyrk
from scipy.linalg.lapack import dtrtri
from scipy.sparse import csr_array

from ..arrays import Array, Index, Mask
from ..deadline import check_time
from ..threads import one_thread
from .inverse_root import InverseRoot, SingularMatrix

LEAF = 96
"""Unknowns that are not halved further: fewer cost calls, more cost arithmetic."""


@dataclass(frozen=True, eq=False)
class Front:
    """One dense front of a factorization, its unknowns in the order of elimination.

    Attributes
    ----------
    own : those that it eliminates.
    rest : (m,) later ones that couple with them.
    entries : its entries in the values sorted by front, and their ``places`` in (own, own + rest).
    below : fronts that leave something to this one, with runs ``(first, last, place)`` of their
        rest that stand in one piece at a place in (own + rest), all of it in own or in rest.
    """

    own: slice
    rest: Index
    entries: slice
    places: Index
    below: list[tuple[int, list[tuple[int, int, int]]]]


class Elimination:
    """Order of elimination and fronts of all matrices with one sparsity.

    Parameters
    ----------
    rows, starts : compressed columns of a symmetric matrix, both triangles.
    places : (n, dimensions) where each unknown is; those at one place stay together.

    Attributes
    ----------
    order : (n,) the unknowns as they are eliminated.
    values : places of the matrix's entries sorted by front.
    fronts : each after those below it.
    """

    def __init__(self, rows: Index, starts: Index, places: Array) -> None:
        columns = np.repeat(np.arange(len(places)), np.diff(starts))
        points, owner = np.unique(places, axis=0, return_inverse=True)
        pairs = owner[columns], owner[rows]
        graph = csr_array((np.ones(len(rows), bool), pairs), 2 * (len(points),))
        graph.sum_duplicates()
        sizes = np.bincount(owner)
        tree = _dissected(graph, points, sizes)
        rank = np.empty(len(points), int)
        rank[np.concatenate([own for own, _ in tree])] = np.arange(len(points))
        self.order: Index = np.argsort(rank[owner], kind="stable")
        turn = np.empty_like(self.order)
        turn[self.order] = np.arange(len(turn))
        counts = np.array([sizes[own].sum() for own, _ in tree])
        ends = np.cumsum(counts)
        starts_ = ends - counts
        front = np.repeat(np.arange(len(tree)), counts)[turn]
        # an entry belongs to the front that eliminates the first of its two unknowns
        kept = np.flatnonzero(turn[rows] >= starts_[front[columns]])
        self.values: Index = kept[np.argsort(front[columns[kept]], kind="stable")]
        row, column = turn[rows[self.values]], turn[columns[self.values]]
        cuts = np.searchsorted(front[columns[self.values]], np.arange(len(tree) + 1))
        self.fronts: list[Front] = []
        for f, (_, children) in enumerate(tree):
            check_time()
            entries, first, end = slice(cuts[f], cuts[f + 1]), starts_[f], ends[f]
            mine = [row[entries], *(self.fronts[c].rest for c in children)]
            rest = np.unique(np.concatenate([some[some >= end] for some in mine]))
            both = np.concatenate([np.arange(first, end), rest])
            flat = (column[entries] - first) * len(both) + np.searchsorted(both, row[entries])
            below = [
                (c, _runs(np.searchsorted(both, self.fronts[c].rest), end - first))
                for c in children
                if len(self.fronts[c].rest)
            ]
            self.fronts.append(Front(slice(first, end), rest, entries, flat, below))


class Multifrontal:
    """Factorization ``K = L S L^T`` of a symmetric matrix, S a diagonal of signs.

    Parameters
    ----------
    elimination : of the matrix's sparsity.
    data : (entries,) in compressed columns.

    Attributes
    ----------
    negative : number of negative eigenvalues (Sylvester, Haynsworth).

    Raises
    ------
    SingularMatrix
        If a front is singular or entries are not finite.
    """

    @one_thread  # scipy brings a BLAS of its own, here at the latest
    def __init__(self, elimination: Elimination, data: Array) -> None:
        self._elimination = elimination
        self.negative = 0
        if not np.isfinite(data).all():
            raise SingularMatrix("the matrix has entries that are not finite")
        values = data[elimination.values]
        left: dict[int, Array] = {}
        self._parts: list[tuple[InverseRoot, Array]] = []
        for number, front in enumerate(elimination.fronts):
            check_time()
            k, m = front.own.stop - front.own.start, len(front.rest)
            own = np.zeros((k, k + m))
            own.ravel()[front.places] = values[front.entries]
            rest = np.zeros((m, m))
            for child, runs in front.below:
                _add(own, rest, left.pop(child), runs)
            root = InverseRoot(own[:, :k], _inverse)
            self.negative += root.negative
            x = root.h @ own[:, k:]
            if m and root.signs is None:
                # the upper triangles of rest and of what is left are those that count
                left[number] = dsyrk(-1.0, x.T, 1.0, rest.T, lower=1, overwrite_c=1).T
            elif m:
                left[number] = rest - x.T @ root.signed(x)
            self._parts.append((root, x))

    def solve(self, right: Array) -> Array:
        """Solution for right-hand sides (n,) or (n, k)."""
        order, fronts = self._elimination.order, self._elimination.fronts
        s = right[order]
        for front, (root, x) in zip(fronts, self._parts, strict=True):
            s[front.own] = root.h @ s[front.own]
            s[front.rest] -= x.T @ root.signed(s[front.own])
        for front, (root, x) in zip(fronts[::-1], self._parts[::-1], strict=True):
            s[front.own] = root.h.T @ root.signed(s[front.own] - x @ s[front.rest])
        solution = np.empty_like(s)
        solution[order] = s
        return solution


def _inverse(low: Array) -> Array:
    """Inverse of a lower triangular matrix by LAPACK, which numpy does not offer."""
    return np.asarray(dtrtri(low, lower=1)[0])


def _add(own: Array, rest: Array, below: Array, runs: list[tuple[int, int, int]]) -> None:
    """Add the upper triangle of what a front below leaves, run by run."""
    k = len(own)
    for n, (i, i_end, row) in enumerate(runs):
        target, first, top = (own, 0, row) if row < k else (rest, k, row - k)
        for j, j_end, column in runs[n:]:
            left = column - first
            target[top : top + i_end - i, left : left + j_end - j] += below[i:i_end, j:j_end]


def _dissected(graph: csr_array, points: Array, sizes: Index) -> list[tuple[Index, list[int]]]:
    """Nodes of each front and the numbers of the fronts below it, which come first."""
    tree: list[tuple[Index, list[int]]] = []
    other = np.zeros(len(points), bool)

    def touching(one: Index, two: Index) -> Mask:
        other[two] = True
        near = graph[one]
        touch = np.logical_or.reduceat(other[near.indices], near.indptr[:-1])
        other[two] = False
        return touch

    def dissect(nodes: Index) -> int:
        check_time()
        children = []
        own = nodes
        if sizes[nodes].sum() > LEAF and len(nodes) > 1:
            along = points[nodes, np.ptp(points[nodes], axis=0).argmax()]
            halves = np.split(nodes[np.argsort(along, kind="stable")], [len(nodes) // 2])
            touches = touching(halves[0], halves[1]), touching(halves[1], halves[0])
            a = int(touches[1].sum() < touches[0].sum())
            own = halves[a][touches[a]] if touches[a].any() else halves[a][:1]
            parts = np.setdiff1d(halves[a], own, assume_unique=True), halves[1 - a]
            children = [dissect(part) for part in parts if len(part)]
        # along the longest side last, so that what separates others stands in few pieces
        sides = np.argsort(np.ptp(points[own], axis=0), kind="stable")
        tree.append((own[np.lexsort(points[own][:, sides].T)], children))
        return len(tree) - 1

    dissect(np.arange(len(points)))
    return tree


def _runs(places: Index, own: int) -> list[tuple[int, int, int]]:
    """Pieces of consecutive places, cut where those of the front's own end."""
    cuts = np.flatnonzero((np.diff(places) != 1) | (places[1:] == own)) + 1
    ends = [0, *cuts.tolist(), len(places)]
    return [(i, j, int(places[i])) for i, j in pairwise(ends)]
