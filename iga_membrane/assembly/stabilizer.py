"""The stabilization of paper eq. (23) during one load step."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..dofs.dof_map import FirstOrder
from ..dofs.pair_sums import PairSums
from ..linalg.bordered import Matrix
from ..splines import Table
from ..terms import Stabilization, pairs
from ..terms import stabilization as stable
from ..terms.variations import ElementPoints, element_points


class Unstabilized:
    """A membrane whose tangential motions need no holding.

    Attributes
    ----------
    projected : whether forces are those that have no energy.
    tangential : whether tangential motions are unknowns that must be held.
    """

    projected = tangential = False

    def energy(self, points: Array) -> float:
        """Energy of a state, of forces that are not projected."""
        return 0.0

    def add_forces(self, total: FirstOrder, points: Array) -> None:
        """Add the derivatives by local control points, projected if asked for."""

    def add_hessian(
        self,
        numbers: Array,
        matrix: Matrix,
        sums: PairSums,
        points: Array,
        directions: Array,
        owners: Index,
    ) -> None:
        """Add the tangent to ``numbers`` (9, elements, pairs), or, projected, to the matrix.

        Parameters
        ----------
        owners : (rows,) control points of the rows of the motion.
        """


class Stabilizer(Unstabilized):
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

    tangential = True

    def __init__(self, term: Stabilization, table: Table, points: Array, normals: Array) -> None:
        self._mu, self._table, self._normals = term.mu, table, normals
        self.projected = term.projected
        self.before = stable.PreviousMetric.of(table, element_points(table, points))

    def energy(self, points: Array) -> float:
        return stable.energy(self._mu, self.before, self._at(points))

    def add_forces(self, total: FirstOrder, points: Array) -> None:
        total.add_nodal(self.forces(points), self._table.functions)

    def add_hessian(
        self,
        numbers: Array,
        matrix: Matrix,
        sums: PairSums,
        points: Array,
        directions: Array,
        owners: Index,
    ) -> None:
        held = self.hessian(points)
        if self.projected:
            sums.add(matrix, held, self.onto_planes(directions, owners))
        else:
            numbers += held

    def forces(self, points: Array) -> Array:
        """(elements, local, 3) derivative by local control points, projected if asked for."""
        full = stable.forces(self._mu, self._table, self.before, self._at(points))
        return self.onto_planes(full, self._table.functions)

    def hessian(self, points: Array) -> Array:
        """(9, elements, pairs) tangent before projection, as :func:`..terms.pairs.hessian`."""
        at, mu, before = self._at(points), self._mu, self.before
        return pairs.hessian(self._table, lambda e: stable.form(mu, before.part(e), at.part(e)))

    def _at(self, points: Array) -> ElementPoints:
        return element_points(self._table, points)

    def onto_planes(self, vectors: Array, points: Index) -> Array:
        """Vectors (..., 3) at control points (...), projected if the forces are."""
        if not self.projected:
            return vectors
        n = self._normals[points]
        return np.asarray(vectors - np.einsum("...i,...i->...", vectors, n)[..., None] * n)
