"""The shape of the liquid as triangles, for CAD and printing: STL, OBJ, PLY."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import Array, Index
from ..solids import Plane
from .mesh import membrane, outside, trimming_solid

if TYPE_CHECKING:
    from ..driver.solution import Solution


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
    """Write the triangles by the file's ending.

    VTK's writers of these files do not say when a disk is full, so they are not used.
    """
    made = triangles(solution)
    corners, faces = np.asarray(made.points, "<f4"), np.asarray(made.regular_faces, "<i4")
    file = Path(path)
    file.write_bytes(FORMATS[file.suffix](corners, faces))


def stl(corners: Array, faces: Index) -> bytes:
    """Binary STL of points (n, 3) and triangles (m, 3)."""
    places = corners[faces]
    normals = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    kind = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    rows = np.zeros(len(faces), kind)
    rows["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    rows["corners"] = places
    return b"iga_membrane".ljust(80) + np.uint32(len(faces)).tobytes() + rows.tobytes()


def obj(corners: Array, faces: Index) -> bytes:
    """OBJ of points (n, 3) and triangles (m, 3), which it counts from 1."""
    text = io.StringIO()
    np.savetxt(text, corners, "v %.9g %.9g %.9g")
    np.savetxt(text, faces + 1, "f %d %d %d")
    return text.getvalue().encode()


def ply(corners: Array, faces: Index) -> bytes:
    """Binary PLY of points (n, 3) and triangles (m, 3)."""
    rows = np.zeros(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    header = [
        "ply", "format binary_little_endian 1.0",
        f"element vertex {len(corners)}", *(f"property float {axis}" for axis in "xyz"),
        f"element face {len(faces)}", "property list uchar int vertex_indices",
        "end_header", "",
    ]  # fmt: skip
    return "\n".join(header).encode() + corners.tobytes() + rows.tobytes()


FORMATS = {".stl": stl, ".obj": obj, ".ply": ply}
"""Ending to the bytes of a file."""
