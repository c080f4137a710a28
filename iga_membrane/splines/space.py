"""Tensor-product spaces of B-splines, NURBS or Lagrange polynomials, open or closed by a pole."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import Rule, choice, integer, ndarray, words
from ..errors import SceneError
from ..quadrature import gauss
from .basis import Basis
from .ruled import Ruled
from .table import EdgeTable, Table

Rows = dict[tuple[int, int], Array]
"""Derivative (i, j) to its table."""


@dataclass(frozen=True, eq=False)
@checked(
    functions=partial(ndarray, kinds="iu", shape=(None, None)),
    count=partial(integer, least=1),
    weights=partial(ndarray, shape=(None, None)),
    combine=partial(ndarray, shape=(None, None, None)),
    pole=partial(integer, least=0, most=1),
)
class Space:
    """Functions of two parameters ``(xi1, xi2)``.

    The functions of an element are tensor products of the two bases, made rational if there are
    weights. At a pole (:mod:`.polar`) or a fold (:mod:`.pillow`) element ``near[k]`` combines them
    by ``combine[k]``.

    Attributes
    ----------
    bases : the two one-dimensional bases; element ``(e1, e2)`` has number ``e1 * m2 + e2``.
    functions : (elements, local) global number of each local function.
    count : number of functions, that is of control points.
    weights : (n1, n2) NURBS weights > 0, or None for polynomials.
    near, combine : (k,) elements at a pole or a fold and (k, local, local) their functions by
        tensor products.
    pole : continuity with which ``xi2 = end`` is closed to a point (0 or 1), or None.
    shared, leaders, ruled : of a pillow (:mod:`.pillow`): (n1 * n2,) the control point of each
        place of the net, -1 where it follows several, (count,) the first place of each control
        point, and the places that follow several.
    """

    bases: tuple[Basis, Basis]
    functions: Index = field(repr=False)
    count: int
    weights: Array | None = field(default=None, repr=False)
    near: Index = field(default_factory=lambda: np.zeros(0, int), repr=False)
    combine: Array = field(default_factory=lambda: np.zeros((0, 0, 0)), repr=False)
    pole: int | None = None
    shared: Index | None = field(default=None, repr=False)
    leaders: Index | None = field(default=None, repr=False)
    ruled: Ruled | None = field(default=None, repr=False)

    @property
    def degree(self) -> int:
        """Polynomial degree (the larger of the two directions)."""
        return max(basis.degree for basis in self.bases)

    @property
    def continuity(self) -> int:
        """Continuous derivatives across element boundaries."""
        return min(basis.continuity for basis in self.bases)

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.functions)

    @property
    def joined_rings(self) -> int:
        """Rings of the control net that a pole rules: 2 at a C1 pole, 1 at a C0 pole."""
        return {None: 0, 0: 1, 1: 2}[self.pole]

    @property
    def net_shape(self) -> tuple[int, int]:
        """Shape of the tensor-product control net (before a pole joins any of it)."""
        return self.bases[0].count, self.bases[1].count

    @property
    def open_edges(self) -> tuple[str, ...]:
        """Edges at which a surface of the space ends: neither folded, nor a ring, nor a pole."""
        if self.shared is not None:
            return ()
        closed = [self.bases[1].periodic, self.bases[0].periodic]
        return tuple(
            edge
            for edge, (along, end) in EDGES.items()
            if not closed[along] and not (self.pole is not None and (along, end) == (0, 1))
        )

    @property
    def is_band(self) -> bool:
        """Whether a surface of the space is a ring between two edges."""
        return self.bases[0].periodic and len(self.open_edges) == 2

    def table(
        self,
        points: int | tuple[int, int] | None = None,
        elements: Index | None = None,
        *,
        second: bool = False,
    ) -> Table:
        """Functions at Gauss points.

        Parameters
        ----------
        points : Gauss points per direction, or of each direction; ``degree + 1`` if omitted.
        elements : which elements, all if omitted.
        second : whether to tabulate second derivatives too.
        """
        rule = points or self.degree + 1
        (u, wu), (v, wv) = (gauss(n) for n in (rule if isinstance(rule, tuple) else (rule, rule)))
        local = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        chosen = np.arange(self.elements) if elements is None else elements
        e1, e2 = np.divmod(chosen, self.bases[1].elements)
        orders = 2 if second else 1
        # elements that are all alike share one table
        kinds = self._kinds(e1, e2)
        own = slice(None) if kinds.any() else slice(1)
        one = [self.bases[0].on_elements(u, k)[e1[own]] for k in range(orders + 1)]
        two = [self.bases[1].on_elements(v, k)[e2[own]] for k in range(orders + 1)]
        rows: Rows = {}
        for i, j in _ORDERS[: 6 if second else 3]:
            product = one[i][:, :, None, :, None] * two[j][:, None, :, None, :]
            rows[i, j] = product.reshape(len(product), len(local), self.functions.shape[1])
        rows = {
            key: np.broadcast_to(row, (len(chosen), *row.shape[1:]))
            for key, row in self.finished(rows, chosen[own]).items()
        }
        h1, h2 = self.bases[0].sizes[e1], self.bases[1].sizes[e2]
        start = np.stack([self.bases[0].breaks[e1], self.bases[1].breaks[e2]], axis=-1)
        size = np.stack([h1, h2], axis=-1)
        return Table(
            self.functions[chosen],
            rows[0, 0],
            rows[1, 0],
            rows[0, 1],
            np.multiply.outer(h1 * h2, np.outer(wu, wv).ravel()),
            start[:, None] + size[:, None] * local,
            np.stack([rows[2, 0], rows[1, 1], rows[0, 2]]) if second else None,
            kinds,
        )

    def at(self, xi: ArrayLike, orders: int = 2) -> tuple[Index, Rows]:
        """Functions at any points.

        Parameters
        ----------
        xi : (points, 2) parameters.
        orders : highest derivative, 0 to 2.

        Returns
        -------
        functions : (points, local).
        rows : derivative ``(i, j)`` to an array (points, local).
        """
        xi = np.atleast_2d(np.asarray(xi, float))
        e1, u = self.bases[0].locate(xi[:, 0])
        e2, v = self.bases[1].locate(xi[:, 1])
        chosen = e1 * self.bases[1].elements + e2
        rows = self.inside(chosen, np.stack([u, v], axis=-1)[:, None], orders)
        return self.functions[chosen], {key: row[:, 0] for key, row in rows.items()}

    def inside(self, elements: Index, u: Array, orders: int = 2) -> Rows:
        """Functions of elements (k,) at local points (k, q, 2) in [0, 1]^2: derivative
        ``(i, j)`` to an array (k, q, local)."""
        e1, e2 = np.divmod(elements, self.bases[1].elements)
        one = [self.bases[0].inside(e1, u[..., 0], k) for k in range(orders + 1)]
        two = [self.bases[1].inside(e2, u[..., 1], k) for k in range(orders + 1)]
        shape = (*u.shape[:2], self.functions.shape[1])
        rows: Rows = {
            (i, j): (one[i][..., :, None] * two[j][..., None, :]).reshape(shape)
            for i, j in _ORDERS
            if i + j <= orders
        }
        return self.finished(rows, elements)

    def edge_table(
        self, edge: str, points: int | None = None, elements: Index | None = None
    ) -> EdgeTable:
        """Functions along an edge at Gauss points.

        Parameters
        ----------
        edge : "xi2=0" (along xi1), "xi2=1", "xi1=0" or "xi1=1" (along xi2); also a line inside the
            patch, "xi2=0.25", there with the values of the element behind it.
        elements : which elements of the edge's own direction, all if omitted.
        """
        along, place = self.edge_place(edge)
        u, w = gauss(points or self.degree + 1)
        basis = self.bases[along]
        chosen = np.arange(basis.elements) if elements is None else elements
        t = basis.breaks[chosen][:, None] + basis.sizes[chosen][:, None] * u
        xi = np.empty((t.size, 2))
        xi[:, along] = t.ravel()
        xi[:, 1 - along] = place
        functions, rows = self.at(xi, 1)
        shape = (*t.shape, -1)
        key = (1, 0) if along == 0 else (0, 1)
        return EdgeTable(
            functions.reshape(shape)[:, 0],
            rows[0, 0].reshape(shape),
            rows[key].reshape(shape),
            basis.sizes[chosen][:, None] * w,
        )

    def edge_place(self, edge: str) -> tuple[int, float]:
        """The parameter along a line of :meth:`edge_table`, and the value of the other one."""
        if edge in EDGES:
            along, end = EDGES[edge]
            return along, float(self.bases[1 - along].breaks[-end])
        return 0, float(edge.removeprefix("xi2="))

    def edge_functions(self, edge: str) -> Index:
        """Numbers of the functions that do not vanish on an edge."""
        table = self.edge_table(edge)
        alive = np.abs(table.values).max(axis=1) > 1e-14
        return np.unique(table.functions[alive])

    def _kinds(self, e1: Index, e2: Index) -> Index:
        """Number of the set of functions that each element (e1, e2) has, from 0 on."""
        if self.weights is not None:
            return np.arange(len(e1))
        one, two = (basis.kinds for basis in self.bases)
        kinds = one[e1] * (two.max() + 1) + two[e2]
        near = np.isin(e1 * self.bases[1].elements + e2, self.near)
        kinds[near] = kinds.max(initial=0) + 1 + np.arange(near.sum())
        return np.asarray(np.unique(kinds, return_inverse=True)[1])

    @cached_property
    def abscissae(self) -> Array:
        """(n1, n2, 2) the parameter point of each control point of the net."""
        grids = np.meshgrid(self.bases[0].abscissae, self.bases[1].abscissae, indexing="ij")
        return np.stack(grids, axis=-1)

    def finished(self, rows: Rows, elements: Index) -> Rows:
        """Tensor products (e, q, local) made rational, then combined at a pole or a fold."""
        if self.weights is not None:
            tensor = _tensor_functions(self.bases)[elements]
            rows = _rational(rows, self.weights.ravel()[tensor][:, None])
        if len(self.near):
            place = np.searchsorted(self.near, elements)
            place[place == len(self.near)] = 0
            joined = np.flatnonzero(self.near[place] == elements)
            operator = self.combine[place[joined]].transpose(0, 2, 1)
            for row in rows.values():
                row[joined] = row[joined] @ operator
        return rows


EDGES = {"xi2=0": (0, 0), "xi2=1": (0, 1), "xi1=0": (1, 0), "xi1=1": (1, 1)}
EDGE: Rule = words(*EDGES)
"""Rule of the name of an edge."""


def line(field: str, value: Any) -> str:
    """Rule of an edge, or of a line inside the patch, "xi2=0.25"."""
    inside = isinstance(value, str) and re.fullmatch(r"xi2=(0?\.\d+([eE]-\d+)?)", value)
    return str(value) if inside else choice(field, value, EDGES)


_ORDERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]


@checked()
def tensor_space(one: Basis, two: Basis, weights: ArrayLike | None = None) -> Space:
    """Tensor product of two bases, rational if weights are given.

    Parameters
    ----------
    one, two : bases of xi1 and xi2.
    weights : (n1, n2) > 0, or None.

    Raises
    ------
    SceneError
        A weight that is not a finite number > 0, or weights of the wrong shape.
    """
    checked = None
    if weights is not None:
        checked = np.array(weights, float)
        if checked.shape != (one.count, two.count):
            raise SceneError(
                f"weights: shape {checked.shape} given, {(one.count, two.count)} expected"
            )
        bad = np.argwhere(~(np.isfinite(checked) & (checked > 0)))
        if len(bad):
            index = tuple(int(k) for k in bad[0])
            raise SceneError(f"weights{list(index)} = {checked[index]}: a weight must be > 0")
        if np.ptp(checked) == 0:
            checked = None
    return Space((one, two), _tensor_functions((one, two)), one.count * two.count, checked)


def _tensor_functions(bases: tuple[Basis, Basis]) -> Index:
    one, two = bases
    grid = one.functions[:, None, :, None] * two.count + two.functions[None, :, None, :]
    return grid.reshape(one.elements * two.elements, -1)


def _rational(rows: Rows, w: Array) -> Rows:
    """NURBS from B-splines by the quotient rule: R = w N / W, W = sum w N."""
    num = {key: row * w for key, row in rows.items()}
    total = {key: row.sum(axis=-1, keepdims=True) for key, row in num.items()}
    out: Rows = {}
    for key in rows:
        i, j = key
        value = num[key]
        if (i, j) in ((1, 0), (0, 1)):
            value = value - total[key] * out[0, 0]
        elif (i, j) in ((2, 0), (0, 2)):
            first = (i // 2, j // 2)
            value = value - 2 * total[first] * out[first] - total[key] * out[0, 0]
        elif (i, j) == (1, 1):
            value = (
                value - total[1, 0] * out[0, 1] - total[0, 1] * out[1, 0] - total[1, 1] * out[0, 0]
            )
        out[key] = value / total[0, 0]
    return out
