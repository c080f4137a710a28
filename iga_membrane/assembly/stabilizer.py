"""The stabilization of paper eq. (23) during one load step."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..splines import Table
from ..terms import Stabilization, pairs
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
        return self.tangential(full, self._table.functions)

    def hessian(self, points: Array) -> Array:
        """(9, elements, pairs) tangent before projection, as :func:`..terms.pairs.hessian`."""
        at, mu, before = self._at(points), self._mu, self.before
        return pairs.hessian(self._table, lambda e: stable.form(mu, before.part(e), at.part(e)))

    def _at(self, points: Array) -> ElementPoints:
        return element_points(self._table, points)

    def tangential(self, vectors: Array, points: Index) -> Array:
        """Vectors (..., 3) at control points (...), projected if the forces are."""
        if not self.projected:
            return vectors
        n = self._normals[points]
        return np.asarray(vectors - np.einsum("...i,...i->...", vectors, n)[..., None] * n)
