"""The stabilization of paper eq. (23) during one load step."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..splines import Table
from ..terms import Stabilization
from ..terms import stabilization as stable
from ..terms.variations import ElementPoints, element_points


class Stabilizer:
    """Holds a membrane near the metric that it had at the end of the last load step.

    Projected, it sees only the displacements of the control points along their tangent planes of
    that state, ``y = X + (1 - n n) (x - X)``, so its forces have no part along the normals.

    Parameters
    ----------
    term : its parameter.
    table : functions at the quadrature points.
    points : (count, 3) control points of the last load step, with their normals (count, 3).

    Attributes
    ----------
    before : the metric of that state.
    """

    def __init__(self, term: Stabilization, table: Table, points: Array, normals: Array) -> None:
        self._mu, self._table, self._start = term.mu, table, points
        self._normals = normals if term.projected else np.zeros_like(normals)
        self.before = stable.PreviousMetric.of(table, element_points(table, points))

    def energy(self, points: Array) -> float:
        """Energy of a state."""
        return stable.energy(self._mu, self.before, self._seen(points))

    def forces(self, points: Array) -> Array:
        """(elements, local, 3) derivative by local control points."""
        full = stable.forces(self._mu, self._table, self.before, self._seen(points))
        return self._tangential(full, self._table.functions)

    def hessian(self, points: Array, rows: Table, columns: Index, directions: Array) -> Array:
        """(elements, rows, rows) second derivative.

        Parameters
        ----------
        rows : the table by rows of the motion; columns : the function of each row.
        directions : (elements, rows, 3).
        """
        along = self._tangential(directions, self._table.functions[:, columns])
        return stable.hessian(self._mu, rows, self.before, self._seen(points), along)

    def _seen(self, points: Array) -> ElementPoints:
        moved = points - self._start
        normal = np.einsum("ki,ki->k", moved, self._normals)[:, None] * self._normals
        return element_points(self._table, points - normal)

    def _tangential(self, vectors: Array, functions: Index) -> Array:
        n = self._normals[functions]
        return np.asarray(vectors - np.einsum("eai,eai->ea", vectors, n)[..., None] * n)
