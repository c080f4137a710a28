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

    Projected, only the parts of its forces along the tangent planes at the control points act.
    These forces have no energy; their tangent keeps the symmetric part along the tangent planes.

    Parameters
    ----------
    term : its parameter.
    table : functions at the quadrature points.
    points : (count, 3) control points of the last load step, with their normals (count, 3); a
        normal of 0 leaves the force as it is.

    Attributes
    ----------
    before : the metric of that state.
    projected : whether the forces are projected.
    """

    def __init__(self, term: Stabilization, table: Table, points: Array, normals: Array) -> None:
        self._mu, self._table, self._normals = term.mu, table, normals
        self.projected = term.projected
        self.before = stable.PreviousMetric.of(table, element_points(table, points))

    def energy(self, points: Array) -> float:
        """Energy of a state, of forces that are not projected."""
        return stable.energy(self._mu, self.before, self._at(points))

    def forces(self, points: Array) -> Array:
        """(elements, local, 3) derivative by local control points, projected if asked for."""
        full = stable.forces(self._mu, self._table, self.before, self._at(points))
        return self._tangential(full, self._table.functions)

    def hessian(self, points: Array, rows: Table, columns: Index, directions: Array) -> Array:
        """(elements, rows, rows) tangent.

        Parameters
        ----------
        rows : the table by rows of the motion; columns : the function of each row.
        directions : (elements, rows, 3).
        """
        along = self._tangential(directions, self._table.functions[:, columns])
        return stable.hessian(self._mu, rows, self.before, self._at(points), along)

    def _at(self, points: Array) -> ElementPoints:
        return element_points(self._table, points)

    def _tangential(self, vectors: Array, functions: Index) -> Array:
        if not self.projected:
            return vectors
        n = self._normals[functions]
        return np.asarray(vectors - np.einsum("eai,eai->ea", vectors, n)[..., None] * n)
