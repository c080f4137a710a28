"""Exact surface for VTK: one rational Bezier cell per element, weights included."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import Index
from ..surface.bezier import bezier_net
from ..surface.surface import Surface

if TYPE_CHECKING:
    from ..solver.solution import Solution


BEZIER_QUADRILATERAL = 77


def bezier_order(p1: int, p2: int) -> Index:
    """VTK's order of a Bezier quadrilateral: corners, edges, inside (first index fastest)."""
    corners = [(0, 0), (p1, 0), (p1, p2), (0, p2)]
    along = [(i, 0) for i in range(1, p1)]
    right = [(p1, j) for j in range(1, p2)]
    back = [(i, p2) for i in range(1, p1)]
    left = [(0, j) for j in range(1, p2)]
    inside = [(i, j) for j in range(1, p2) for i in range(1, p1)]
    pairs = np.array(corners + along + right + back + left + inside)
    return np.asarray(pairs[:, 0] * (p2 + 1) + pairs[:, 1])


def grid(surface: Surface) -> Any:
    """``pyvista.UnstructuredGrid`` of rational Bezier cells."""
    import pyvista as pv

    cells = bezier_net(surface)
    count, n1, n2, _ = cells.shape
    points = cells.reshape(count, n1 * n2, 4)[:, bezier_order(n1 - 1, n2 - 1)]
    weights = points[..., 3]
    numbers = np.arange(count * n1 * n2).reshape(count, -1)
    connectivity = np.hstack([np.full((count, 1), n1 * n2), numbers]).ravel()
    made = pv.UnstructuredGrid(
        connectivity,
        np.full(count, BEZIER_QUADRILATERAL, np.uint8),
        (points[..., :3] / weights[..., None]).reshape(-1, 3),
    )
    degrees = pv.convert_array(np.tile([n1 - 1.0, n2 - 1.0, 0.0], (count, 1)))
    degrees.SetName("HigherOrderDegrees")
    made.GetCellData().SetHigherOrderDegrees(degrees)
    rational = pv.convert_array(np.ascontiguousarray(weights.ravel()))
    rational.SetName("RationalWeights")
    made.GetPointData().SetRationalWeights(rational)
    return made


def write_vtu(solution: Solution, path: str) -> None:
    """Write a solution's surface as a VTU file."""
    grid(solution.surface).save(path)
