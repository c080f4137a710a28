"""Rows of the motion: tables by them, and sums of element contributions by unknown.

A row is a control point with a direction. Where control points have more than one (edges on curved
solids, three unknowns per control point, shifts) their functions stand in a table once per row.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..arrays import Array, Index
from ..linalg.bordered import DENSE_LIMIT, Contributions, Matrix, SparsePattern
from ..splines import EdgeTable, Table
from .pair_sums import PairSums
from .spines import Spines


class Rows:
    """The rows of a motion on the elements of a sector.

    Parameters
    ----------
    spines : the motion.
    table : functions of the sector's elements at its quadrature points.

    Attributes
    ----------
    groups : elements and their tables by rows of the motion; elements at a curved solid have more
        rows than functions, and all have with three unknowns per control point.
    """

    def __init__(self, spines: Spines, table: Table) -> None:
        self.spines, self.table = spines, table
        self.size = spines.size
        self.groups = self._groups()
        self._tied: Index | None = None

    def _groups(self) -> list[tuple[slice | Index, Table]]:
        table, spare = self.table, self.spines.spare
        if len(self.spines.shifts):
            shifted = (self.spines.share[table.functions] != 0.0).any(axis=1)
            moving, still = np.flatnonzero(shifted), np.flatnonzero(~shifted)
            foot = [(still, table.part(still))] if len(still) else []
            return [*foot, (moving, self.with_shifts(table.part(moving)))]
        touching = np.zeros(len(table.functions), bool)
        for extra in self.spines.extra:
            touching |= (extra[table.functions] < spare).any(axis=1)
        if not touching.any():
            return [(slice(None), table)]
        if touching.all():
            return [(slice(None), self.wide)]
        near, rest = np.flatnonzero(touching), np.flatnonzero(~touching)
        edge = table.part(near)
        return [(rest, table.part(rest)), (near, edge.with_columns(*self._extra(edge.functions)))]

    def _extra(self, functions: Index) -> tuple[Index, Index]:
        """Which local functions have further rows of the motion, and those rows."""
        spare = self.spines.spare
        columns, rows = [], []
        for extra in self.spines.extra:
            more = extra[functions]
            own = np.flatnonzero((more < spare).any(axis=0))
            columns.append(own)
            rows.append(more[:, own])
        return np.concatenate(columns), np.hstack(rows)

    @cached_property
    def wide(self) -> Table:
        """The table with three rows of the motion for every control point."""
        return self.table.with_columns(*self._extra(self.table.functions))

    def with_shifts(self, table: Table) -> Table:
        """A table with one more column for each shift of the motion."""
        if not len(self.spines.shifts):
            return table
        rows = self.spines.spare + 1 + np.arange(len(self.spines.shifts))
        return table.with_field(self.spines.share, rows.tolist())

    def of(self, table: Table) -> Table:
        """A table of points of the sector's elements by rows of the motion."""
        return self.wide if self.spines.by_pairs else self.with_shifts(table)

    @cached_property
    def shifted(self) -> Table:
        """The table of all elements :meth:`with_shifts`."""
        return self.with_shifts(self.table)

    def edge(self, edge: EdgeTable) -> EdgeTable:
        """An edge's table by rows of the motion."""
        columns, rows = self._extra(edge.functions)
        return edge.with_columns(columns, rows) if len(columns) else edge

    def held(self, edge: EdgeTable) -> Index:
        """(elements, local) number of the gap constraint of each function, -1 for none."""
        return self.spines.held[self.spines.second[edge.functions]]

    def unknowns(self, functions: Index) -> Index:
        """Unknowns of rows by their numbers, -1 for none."""
        return self.spines.unknowns[functions]

    def gather(self, values: Array, functions: Index) -> Array:
        """(n,) sums of element contributions by unknown; rows without one are dropped."""
        where = self.unknowns(functions)
        sums = np.bincount(where.ravel() + 1, values.ravel(), self.size + 1)[1:]
        return sums.astype(float, copy=False)

    def matrix(self, tied: Index | None = None) -> Matrix:
        """An empty matrix; its sparsity changes only with the functions ``tied`` in groups."""
        if self.size <= DENSE_LIMIT:
            return Matrix(self.size)
        if tied is not None and self._tied is not tied:
            self._tied = tied
            self._pattern = self._pattern_of([self.shifted.functions, tied])
        return Matrix(self.size, self._pattern)

    @cached_property
    def _pattern(self) -> SparsePattern:
        return self._pattern_of([rows.functions for _, rows in self.groups])

    @cached_property
    def pair_sums(self) -> PairSums:
        """Sums by pairs of control points of all elements."""
        dense = self.size <= DENSE_LIMIT
        return PairSums(self.spines, self.table.functions, None if dense else self._pattern)

    def _pattern_of(self, groups: list[Index]) -> SparsePattern:
        own = self.size - len(self.spines.shifts)
        unknowns = [self.unknowns(functions) for functions in groups]
        return SparsePattern(own, unknowns, self.spines.places[:own])


class Released(Rows):
    """Rows of a motion, each an unknown; what elements contribute to a Hessian is kept.

    Parameters
    ----------
    rows : with the tables.
    """

    def __init__(self, rows: Rows) -> None:
        self.spines, self.table, self.groups = rows.spines.released(), rows.table, rows.groups
        self.size = self.spines.size

    def matrix(self, tied: Index | None = None) -> Contributions:
        return Contributions(self.size)

    @cached_property
    def pair_sums(self) -> PairSums:
        return PairSums(self.spines, self.table.functions, None)


class FirstOrder:
    """First derivatives of a state by its unknowns, summed from element contributions.

    Parameters
    ----------
    rows : of the motion.
    directions : (rows, 3) displacement per unit of each.
    multipliers : number of constraints.

    Attributes
    ----------
    gradient : (n,) of the energy.
    columns : (n, multipliers) gradients of the constraints.
    scale : (n,) sums of absolute contributions.
    """

    def __init__(self, rows: Rows, directions: Array, multipliers: int) -> None:
        self.rows, self.directions = rows, directions
        self.gradient, self.scale = np.zeros(rows.size), np.zeros(rows.size)
        self.columns = np.zeros((rows.size, multipliers))
        self.columns[:, multipliers - len(rows.spines.shifts) :] = rows.spines.gauge

    def add(self, forces: Array, functions: Index) -> None:
        """Add derivatives (elements, local, 3) of the energy by rows (elements, local)."""
        work = self.work(forces, functions)
        self.gradient += self.rows.gather(work, functions)
        self.scale += self.rows.gather(np.abs(work), functions)

    def add_unjudged(self, forces: Array, functions: Index) -> None:
        """Add forces of numerical aids, which are nothing to judge a residual against."""
        self.gradient += self.rows.gather(self.work(forces, functions), functions)

    def add_nodal(self, forces: Array, functions: Index) -> None:
        """The same by control points (elements, local), whatever their rows."""
        spines = self.rows.spines
        count, where = spines.space.count, functions.ravel()
        nodal = np.stack([np.bincount(where, f.ravel(), count) for f in np.moveaxis(forces, -1, 0)])
        work = np.einsum("ir,ri->r", nodal[:, spines.points], self.directions)
        self.gradient += self.rows.gather(work, np.arange(len(work)))

    def constrain(self, number: int, forces: Array, functions: Index) -> None:
        """Add derivatives (elements, local, 3) of one constraint."""
        self.columns[:, number] += self.rows.gather(self.work(forces, functions), functions)

    def work(self, forces: Array, functions: Index) -> Array:
        """(elements, local) work of forces along the rows' directions."""
        return np.einsum("eai,eai->ea", forces, self.directions[functions])
