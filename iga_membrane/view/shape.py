"""The shape of the liquid as triangles, for CAD and printing: STL, OBJ, PLY."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..solids import Plane
from .mesh import membrane, outside, trimming_solid

if TYPE_CHECKING:
    from ..solver.solution import Solution


def triangles(solution: Solution, resolution: int = 129) -> Any:
    """``pyvista.PolyData`` of triangles, normals out of the liquid.

    Parameters
    ----------
    resolution : points along the main direction of the patch, twice as many round a ring.

    Notes
    -----
    A droplet on a plane without particles is closed by its wetted area and has the liquid's
    volume. Elsewhere it is the liquid-gas surface, open at its contact lines.
    """
    mesh = membrane(solution, resolution).triangulate()
    through = trimming_solid(solution)
    if through is not None:
        mesh = outside(through, mesh).extract_surface(algorithm=None).triangulate()
    # one point where the ring closes and at its pole
    mesh = mesh.clean(tolerance=1e-9)
    flat = isinstance(solution.scene.substrate, Plane) and through is None
    mesh = mesh.fill_holes((1e3 if flat else 1e-3) * mesh.length)
    return mesh.compute_normals(
        point_normals=False, auto_orient_normals=mesh.is_manifold, split_vertices=False
    )


def write_shape(solution: Solution, path: str) -> None:
    """Write the triangles by the file's ending."""
    made = triangles(solution)
    made.clear_data()
    made.save(path)
