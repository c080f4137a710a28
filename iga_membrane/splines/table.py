"""Basis functions tabulated at quadrature points, in the layout every loop of the package uses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, Index


@dataclass(frozen=True, eq=False)
class Table:
    """Functions of a space at the quadrature points of some elements.

    Attributes
    ----------
    functions : (elements, local) global number of each local function.
    values, d1, d2 : (elements, points, local) the functions and their first derivatives.
    weights : (elements, points) quadrature weights in the parameter domain.
    parameters : (elements, points, 2) the points themselves.
    second : (3, elements, points, local) second derivatives 11, 12, 22, or None.
    """

    functions: Index
    values: Array
    d1: Array
    d2: Array
    weights: Array
    parameters: Array
    second: Array | None = None

    @cached_property
    def stacked(self) -> Array:
        """(elements, 3 points, local): values, d1 and d2 under each other, for one product."""
        return np.concatenate([self.values, self.d1, self.d2], axis=1)

    def part(self, elements: slice) -> Table:
        """First-order table of some of the elements."""
        return Table(
            self.functions[elements],
            self.values[elements],
            self.d1[elements],
            self.d2[elements],
            self.weights[elements],
            self.parameters[elements],
        )

    def derivatives(self, coefficients: Array) -> tuple[Array, Array, Array]:
        """A field and its two parametric derivatives: three arrays (elements, points, c)."""
        field = self.stacked @ coefficients[self.functions]
        value, d1, d2 = np.split(field, 3, axis=1)
        return value, d1, d2


@dataclass(frozen=True, eq=False)
class EdgeTable:
    """Functions of a space along an edge; ``d`` is the derivative along it.

    Attributes
    ----------
    functions : (elements, local); values, d : (elements, points, local); weights : (elements,
        points).
    """

    functions: Index
    values: Array
    d: Array
    weights: Array
