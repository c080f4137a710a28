"""An edge held on a solid in the weak sense: its gap integrates to zero against every function.

``oint gap(x) N_k dxi = 0`` for the functions ``N_k`` of the edge. The multipliers are the line load
``q_n`` of paper eq. (31) with which the solid balances the membrane. Weak enforcement keeps the
membrane a spline and the energy superconvergent, where interpolating the solid would not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..solids.sphere import Sphere
from ..splines import EDGE, EdgeTable


@dataclass(frozen=True)
@checked(edge=EDGE)
class EdgeGap:
    """Gap integrals of an edge against its own functions.

    Attributes
    ----------
    sphere : the solid, in the units of the control points.
    edge : edge of the membrane.
    """

    sphere: Sphere
    edge: str = "xi2=0"

    def values(self, table: EdgeTable, points: Array) -> Array:
        """(elements, local) ``int gap N_k dxi``."""
        gap = self.sphere.gap(table.values @ points[table.functions])
        return np.einsum("eqa,eq->ea", table.values, gap * table.weights)

    def gradients(self, table: EdgeTable, points: Array) -> Array:
        """(elements, local, local, 3) derivative of value ``k`` by control point ``a``."""
        normal = self.sphere.normal(table.values @ points[table.functions])
        n = table.values
        return np.einsum("eqk,eqa,eqi,eq->ekai", n, n, normal, table.weights, optimize=True)

    def hessian(self, table: EdgeTable, points: Array, multipliers: Array) -> Array:
        """(elements, local, 3, local, 3) second derivative of ``sum multipliers * values``.

        Parameters
        ----------
        multipliers : (elements, local) of the local values.
        """
        bend = self.sphere.gap_hessian(table.values @ points[table.functions])
        load = np.einsum("eqk,ek,eq->eq", table.values, multipliers, table.weights)
        n = table.values
        return np.einsum("eqa,eqb,eqij,eq->eaibj", n, n, bend, load, optimize=True)
