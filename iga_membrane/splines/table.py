"""Basis functions tabulated at quadrature points, in the layout every loop of the package uses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import ndarray
from ..overview import brief_repr


@dataclass(frozen=True, eq=False)
@checked(
    functions=partial(ndarray, kinds="iu", shape=(None, None)),
    **dict.fromkeys(("values", "d1", "d2"), partial(ndarray, shape=(None, None, None))),
    weights=partial(ndarray, shape=(None, None)),
    parameters=partial(ndarray, shape=(None, None, 2)),
    second=partial(ndarray, shape=(None, None, None, None)),
)
class Table:
    """Functions of a space at the quadrature points of some elements.

    Attributes
    ----------
    functions : (elements, local) global number of each local function.
    values, d1, d2 : (elements, points, local) the functions and their first derivatives; elements
        that are all alike share one piece of memory.
    weights : (elements, points) quadrature weights in the parameter domain.
    parameters : (elements, points, 2) the points themselves.
    second : (3, elements, points, local) second derivatives 11, 12, 22, or None.
    kinds : (elements,) a number that elements with the same rows share, or None if not known.
    """

    functions: Index
    values: Array
    d1: Array
    d2: Array
    weights: Array
    parameters: Array
    second: Array | None = None
    kinds: Index | None = None

    __repr__ = brief_repr

    @cached_property
    def alike(self) -> list[Index]:
        """Elements (kinds, n) with the same rows along the second axis, by how many there are."""
        if self.kinds is None:
            return [np.arange(len(self.functions))[:, None]]
        counts = np.bincount(self.kinds)
        sorted_ = np.argsort(self.kinds, kind="stable")
        first = np.cumsum(counts) - counts
        return [
            sorted_[first[counts == n][:, None] + np.arange(n)]
            for n in np.unique(counts[counts > 0]).tolist()
        ]

    @cached_property
    def stacked(self) -> Array:
        """(elements, 3 points, local): values, d1 and d2 under each other, for one product."""
        rows = [shared(row) for row in (self.values, self.d1, self.d2)]
        one = np.concatenate(rows, axis=1)
        return np.broadcast_to(one, (len(self.functions), *one.shape[1:]))

    def part(self, elements: slice | Index) -> Table:
        """First-order table of some of the elements."""
        values, d1, d2 = (_some(row, elements) for row in (self.values, self.d1, self.d2))
        weights, parameters = self.weights[elements], self.parameters[elements]
        kinds = None if self.kinds is None else self.kinds[elements]
        return Table(self.functions[elements], values, d1, d2, weights, parameters, kinds=kinds)

    def with_columns(self, columns: Index, functions: Index) -> Table:
        """Some local functions once more, under other numbers (elements, len(columns))."""
        values, d1, d2 = (
            np.concatenate([rows, rows[..., columns]], axis=-1)
            for rows in (self.values, self.d1, self.d2)
        )
        functions = np.hstack([self.functions, functions])
        return Table(functions, values, d1, d2, self.weights, self.parameters)

    def with_field(self, coefficients: Array, functions: Sequence[int]) -> Table:
        """A field (count,) of the space as one more local function under each of some numbers."""
        own = coefficients[self.functions][..., None]
        values, d1, d2 = (
            np.concatenate([rows, np.repeat(rows @ own, len(functions), axis=-1)], axis=-1)
            for rows in (self.values, self.d1, self.d2)
        )
        numbers = np.broadcast_to(functions, (len(self.functions), len(functions)))
        functions_ = np.hstack([self.functions, numbers])
        return Table(functions_, values, d1, d2, self.weights, self.parameters)

    def derivatives(self, coefficients: Array) -> tuple[Array, Array, Array]:
        """A field and its two parametric derivatives: three arrays (elements, points, c)."""
        field = self.stacked @ coefficients[self.functions]
        value, d1, d2 = np.split(field, 3, axis=1)
        return value, d1, d2

    def weighted(self, share: Array) -> Table:
        """The same points, each element with a share (elements,) of its weight, or each point with
        its own (elements, points)."""
        other = replace(self, weights=self.weights * share.reshape(len(share), -1))
        other.__dict__["stacked"] = self.stacked
        return other


def shared(rows: Array) -> Array:
    """Rows of one element only, (1, ...), where all elements share them."""
    return rows[:1] if len(rows) and rows.strides[0] == 0 else rows


def _some(rows: Array, elements: slice | Index) -> Array:
    """Rows of some elements, shared where they were."""
    if isinstance(elements, slice) or len(shared(rows)) == len(rows):
        return rows[elements]
    count = len(np.arange(len(rows))[elements])
    return np.broadcast_to(rows[:1], (count, *rows.shape[1:]))


@dataclass(frozen=True, eq=False)
class EdgeTable:
    """Functions of a space along an edge; ``d`` is the derivative along it.

    Attributes
    ----------
    functions : (elements, local); values, d : (elements, points, local); weights : (elements,
        points).
    repeated : local functions that stand a second time at the end, under other numbers.
    """

    functions: Index
    values: Array
    d: Array
    weights: Array
    repeated: Index = field(default_factory=lambda: np.zeros(0, int))

    __repr__ = brief_repr

    def with_columns(self, columns: Index, functions: Index) -> EdgeTable:
        """Some local functions once more, under other numbers (elements, len(columns))."""
        return EdgeTable(
            np.hstack([self.functions, functions]),
            np.concatenate([self.values, self.values[..., columns]], axis=-1),
            np.concatenate([self.d, self.d[..., columns]], axis=-1),
            self.weights,
            columns,
        )


@dataclass(frozen=True, eq=False)
class LineTable:
    """Functions of a space along lines inside its elements, each the graph of one parameter over
    the other.

    Attributes
    ----------
    functions : (pieces, local) global number of each local function.
    rows : the functions and their derivatives 1, 2, 11, 12, 22, each (pieces, points, local).
    weights : (pieces, points) quadrature weights of the parameter along the line; at ends +1 or -1.
    across : (pieces,) 0 or 1, the parameter that the line is a graph of.
    rising : (pieces,) sign of the level's slope along that parameter.
    """

    functions: Index
    rows: tuple[Array, ...]
    weights: Array
    across: Index
    rising: Index

    __repr__ = brief_repr
