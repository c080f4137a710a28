"""Exact surface for VTK: one rational Bezier cell per element, weights and fields included."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import Array, Index
from ..splines.bernstein import bernstein
from ..surface.bezier import bezier_net
from ..surface.surface import Surface
from .drawing import pyvista
from .fields import FIELDS, field
from .mesh import membrane, outside, trimming_solid

if TYPE_CHECKING:
    from ..driver.solution import Solution


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
    pv = pyvista()
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
    """Write a solution's surface with its fields (:data:`.fields.FIELDS`) as a VTU file.

    Notes
    -----
    VTK interpolates point data like positions, so fields are kept by their Bezier coefficients and
    are right at ``degree + 1`` points in each direction of every cell. A gap is left out where
    there is no solid.
    """
    made = grid(solution.surface)
    xi, to_coefficients = _sampling(solution.surface)
    at = solution.surface.at(xi)
    for name in FIELDS:
        values = field(solution, name, at)
        if np.isfinite(values).all():
            made.point_data[name] = to_coefficients(values)
    made.field_data["units"] = [solution.scene.unit_system]
    _write(made, path)


FLAT = 97
"""Points along each direction of the patch of a file of flat cells: a droplet's area to 1e-4."""


def write_linear_vtu(solution: Solution, path: str) -> None:
    """Write the part of a solution's surface that bounds the liquid in flat triangles and
    quadrilaterals, which every program reads, with its fields at their corners; the units are named
    in a comment, since not every program reads text as data."""
    mesh = membrane(solution, FLAT, FIELDS)
    for name in FIELDS:
        if not np.isfinite(mesh[name]).all():
            del mesh.point_data[name]
    through = trimming_solid(solution)
    made = mesh if through is None else outside(through, mesh)
    _write(made.cast_to_unstructured_grid(), path, f"units: {solution.scene.unit_system}")


def _write(made: Any, path: str, remark: str = "") -> None:
    """A grid as a file, which may begin with a remark."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(made)
    writer.SetDataModeToBinary()
    writer.SetWriteToOutputString(True)  # VTK's own way to the file crashes on a full disk
    writer.Write()
    text = writer.GetOutputString()
    if remark:
        text = text.replace("<VTKFile", f"<!-- {remark} -->\n<VTKFile", 1)
    Path(path).write_text(text, encoding="utf-8")


def _sampling(surface: Surface) -> tuple[Array, Any]:
    """Points inside the cells (cells, points, 2), and what makes values there (cells, points) the
    coefficients of rational Bezier functions, cell after cell in VTK's order."""
    one, two = surface.space.bases
    weights = bezier_net(surface)[..., 3]
    count, n1, n2 = weights.shape
    # Chebyshev's points keep away from poles, where the parametrization has no normal
    u, v = (0.5 - 0.5 * np.cos((np.arange(n) + 0.5) * np.pi / n) for n in (n1, n2))
    rows, columns = bernstein(u, n1 - 1), bernstein(v, n2 - 1)
    s = (one.breaks[:-1, None] + one.sizes[:, None] * u)[:, None, :, None]
    t = (two.breaks[:-1, None] + two.sizes[:, None] * v)[None, :, None, :]
    xi = np.stack(np.broadcast_arrays(s, t), axis=-1).reshape(count, n1 * n2, 2)
    inverse = np.linalg.inv(rows), np.linalg.inv(columns).T
    order = bezier_order(n1 - 1, n2 - 1)

    def to_coefficients(values: Array) -> Array:
        weighted = values.reshape(count, n1, n2) * (rows @ weights @ columns.T)
        found = inverse[0] @ weighted @ inverse[1] / weights
        return np.asarray(found.reshape(count, n1 * n2)[:, order].ravel())

    return xi, to_coefficients
