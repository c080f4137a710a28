"""Pictures: droplet, substrate, contact line; safe on machines without a screen."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..errors import OutputError
from ..solids import Plane, Sphere, SphereLattice, Spheres
from ..solver.contact_line import contact_line
from ..terms import Contact, TrimmedContactLine

if TYPE_CHECKING:
    from ..solver.solution import Solution

Color = Literal["mean_curvature", "pressure", "none"]

_PROBE = (
    "import pyvista as pv; p = pv.Plotter(off_screen=True, window_size=(16, 16)); "
    "p.add_mesh(pv.Sphere()); p.screenshot(return_img=True)"
)
REMEDY = "on Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri"


def plot(
    solution: Solution,
    path: str | os.PathLike[str] | None = None,
    *,
    color: Color = "mean_curvature",
    size: tuple[int, int] = (1200, 900),
    resolution: int = 129,
    traction: bool = False,
    view: tuple[float, float, float] = (1.0, -2.2, 0.55),
    zoom: float = 1.0,
    focus: tuple[float, float, float] | None = None,
) -> Any:
    """Draw a solution.

    Parameters
    ----------
    path : PNG file to write; an interactive window if None.
    color : "mean_curvature" (exact, from the spline), "pressure" or "none".
    size : of the picture in pixels.
    resolution : points along each direction of the patch.
    traction : whether to draw the pull of the membrane on the solid along the contact line on which
        it ends.
    view : direction from the middle of the picture to the eye, in the scene's frame.
    zoom : enlargement.
    focus : world point in the middle of the picture; the membrane's middle if omitted.

    Notes
    -----
    Asperities that carry a part of the droplet are drawn red. Where the membrane passes through
    solids only its part outside is drawn, and its contact lines there.

    Raises
    ------
    OutputError
        If this machine cannot draw, with what to install.
    """
    pv = _pyvista()
    if path is not None:
        check_drawing()
    plotter = pv.Plotter(off_screen=path is not None, window_size=size)
    plotter.set_background("white")
    length = solution.scene.units.length
    mesh, name = _membrane(solution, color, resolution)
    through = _trimming_solid(solution)
    if through is not None:
        mesh, lines = _outside(through, mesh)
        plotter.add_mesh(lines, color="#3d0c02")
    options: dict[str, Any] = {"color": "#6fa8dc"}
    if name:
        unit = solution.scene.units
        low, high = _range(mesh[name], 1 / length if color == "mean_curvature" else unit.pressure)
        bar = {"title": name, "color": "black", "fmt": "%.3g", "vertical": True,
               "position_x": 0.88, "position_y": 0.3, "height": 0.4}  # fmt: skip
        options = {"scalars": name, "cmap": "viridis", "clim": (low, high), "scalar_bar_args": bar}
    # arrows tangent to the membrane show through it
    opacity = 0.7 if traction else 1.0
    plotter.add_mesh(mesh, smooth_shading=True, specular=0.3, opacity=opacity, **options)
    _solids(plotter, pv, solution)
    inside = solution.scene.line_inside
    flat = isinstance(solution.scene.substrate, Plane)
    on_edge = (flat or through is None) and not _on_an_area(solution)
    if solution.scene.substrate is not None and (inside or on_edge):
        line = contact_line(solution.surface.moved(_local(solution)), inside or "xi2=0")
        world = solution.scene.units.to_world(line.position)
        curve = pv.lines_from_points(np.vstack([world, world[:1]]))
        plotter.add_mesh(curve.tube(radius=0.008 * length), color="#cc0000")
        if traction:
            _arrows(plotter, pv, world, -line.conormal @ solution.scene.units.axes.T, length)
    up = solution.scene.units.axes
    middle = np.array(mesh.center if focus is None else focus)
    eye = up @ np.array(view)
    reach = 1.6 * mesh.length / zoom
    plotter.camera_position = [middle + reach * eye / np.linalg.norm(eye), middle, up[:, 2]]
    plotter.enable_anti_aliasing("ssaa")
    if path is None:
        return plotter.show()
    plotter.screenshot(str(path))
    plotter.close()
    return None


def _arrows(plotter: Any, pv: Any, points: Any, directions: Any, length: float) -> None:
    """Some forty arrows of the pull on the solid along a line."""
    some = slice(None, None, max(1, len(points) // 40))
    cloud = pv.PolyData(points[some])
    cloud["pull"] = directions[some]
    arrows = cloud.glyph(orient="pull", scale=False, factor=0.5 * length)
    plotter.add_mesh(arrows, color="#1155cc")


def check_drawing() -> None:
    """Prove that pictures can be drawn here.

    Raises
    ------
    OutputError
    """
    if not can_draw():
        raise OutputError(f"pictures cannot be drawn on this machine: {REMEDY}")


@cache
def can_draw() -> bool:
    """Whether one small picture can be drawn, tried in a process of its own.

    Without the right driver VTK does not raise but kills the process.
    """
    _headless()
    run = subprocess.run([sys.executable, "-c", _PROBE], capture_output=True, check=False)
    return run.returncode == 0


def _headless() -> None:
    """Off-screen rendering by EGL where there is no display; must precede the import of vtk."""
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")


def _pyvista() -> Any:
    _headless()
    import pyvista

    return pyvista


def _local(solution: Solution) -> Any:
    return solution.scene.units.to_local(solution.surface.points)


def _membrane(solution: Solution, color: Color, resolution: int) -> tuple[Any, str]:
    """Smooth mesh with exact normals, and the name of its colours."""
    pv = _pyvista()
    surface = solution.surface
    ring, across = surface.space.bases
    # stop just short of a pole, where the parametrization has no normal
    s = np.linspace(ring.breaks[0], ring.breaks[-1], 2 * resolution - 1)
    t = np.linspace(across.breaks[0], across.breaks[-1], resolution)
    if surface.space.pole is not None:
        t[-1] -= 1e-4
    if surface.space.shared is not None:  # nor has a closed square at the middles of its sides
        s, t = (1.0 - 1e-6) * s, (1.0 - 1e-6) * t
    k = surface.at(np.stack(np.meshgrid(s, t, indexing="ij"), axis=-1))
    x, y, z = (np.ascontiguousarray(k.position[..., i])[..., None] for i in range(3))
    mesh = pv.StructuredGrid(x, y, z).extract_surface(algorithm="dataset_surface")
    order = _match(mesh.points, k.position.reshape(-1, 3))
    mesh.point_data.active_normals = k.normal.reshape(-1, 3)[order]
    if color == "none":
        return mesh, ""
    field = k.mean_curvature if color == "mean_curvature" else solution.pressure(k.position)
    name = "mean curvature" if color == "mean_curvature" else "pressure"
    mesh[name] = np.asarray(field).reshape(-1)[order]
    return mesh, name


def _match(points: Any, source: Any) -> Any:
    """Which source point each mesh point is (VTK stores single precision and reorders)."""
    from scipy.spatial import cKDTree

    return cKDTree(source).query(points)[1]


def _range(values: Any, unit: float) -> tuple[float, float]:
    """Colour range without the few outliers, wide enough not to show rounding as a pattern."""
    low, high = np.percentile(values, [1.0, 99.0])
    middle = 0.5 * (low + high)
    half = max(0.5 * (high - low), 1e-2 * max(unit, abs(middle)))
    return float(middle - half), float(middle + half)


def _on_an_area(solution: Solution) -> bool:
    """Whether the membrane lies on the solid with its inside, not with an edge."""
    return any(isinstance(term, Contact) for term in solution.scene.terms)


def _trimming_solid(solution: Solution) -> Plane | Sphere | SphereLattice | Spheres | None:
    """The solid that the membrane passes through, in world coordinates."""
    terms = (term for term in solution.scene.terms if isinstance(term, TrimmedContactLine))
    return next((term.solid for term in terms), None)


LINE = 0.02
"""Thickness of contact lines on spheres over their radius."""


def _outside(solid: Plane | Sphere | SphereLattice | Spheres, mesh: Any) -> tuple[Any, Any]:
    """The part of the membrane's mesh that bounds the liquid, and its contact lines."""
    mesh["gap"] = solid.nearest(np.asarray(mesh.points, float)).gap
    # inside its solid the membrane may rise above it: such parts hang on nothing
    outer = mesh.clip_scalar(scalars="gap", value=0.0, invert=False).connectivity("largest")
    edges = outer.extract_feature_edges(
        feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    lines = edges.threshold(1e-6 * solid.scale, scalars="gap", invert=True)
    lines = lines.extract_surface(algorithm=None).strip(join=True)
    return outer, lines.tube(radius=LINE * solid.scale)


def _asperities(plotter: Any, pv: Any, solution: Solution) -> None:
    """Spheres under the droplet and a little beside it, and their base."""
    substrate = solution.scene.substrate
    assert isinstance(substrate, (SphereLattice, Spheres))
    reach = 1.3 * float(np.linalg.norm(solution.surface.points[:, :2], axis=1).max())
    near = substrate.within(reach)
    wet = {asperity["index"] for asperity in solution.contact.get("asperities", ())}
    dry = np.array([which not in wet for which in near.tolist()], bool)
    for which, color in ((near[dry], "#d9d2c5"), (near[~dry], "#cc4125")):
        cloud = pv.PolyData(substrate.center_of(which))
        cloud["diameter"] = 2.0 * substrate.radius_of(which)
        ball = pv.Sphere(radius=0.5, theta_resolution=80, phi_resolution=80)
        balls = cloud.glyph(geom=ball, scale="diameter", orient=False)
        plotter.add_mesh(balls, color=color, ambient=0.3, smooth_shading=True)
    if substrate.base is not None:
        base = pv.Disc(center=(0.0, 0.0, substrate.base), inner=0.0, outer=reach, c_res=120)
        plotter.add_mesh(base, color="#d9d2c5", ambient=0.3)


def _solids(plotter: Any, pv: Any, solution: Solution) -> None:
    """Substrate and particles."""
    substrate, scale = solution.scene.substrate, solution.scene.units
    for each in solution.scene.particles:
        if each != substrate:
            ball = pv.Sphere(
                radius=each.radius, center=each.center, theta_resolution=80, phi_resolution=80
            )
            plotter.add_mesh(ball, color="#d9d2c5", ambient=0.3, smooth_shading=True)
    if isinstance(substrate, (SphereLattice, Spheres)):
        _asperities(plotter, pv, solution)
        return
    if isinstance(substrate, Sphere):
        # a membrane that covers the sphere and has sunk into it is shown on top
        sunk = solution.contact.get("max_penetration") if solution.scene.line_inside else None
        solid = pv.Sphere(
            radius=substrate.radius - 1.5 * (sunk or 0.0),
            center=substrate.center,
            theta_resolution=120,
            phi_resolution=120,
        )
    elif substrate is not None:
        span = 3.0 * float(np.abs(_local(solution)[:, :2]).max())
        solid = pv.Plane(center=(0.0, 0.0, -1e-3), i_size=span, j_size=span)
        solid.points = scale.to_world(np.asarray(solid.points, float))
    else:
        return
    plotter.add_mesh(solid, color="#d9d2c5", ambient=0.3, smooth_shading=True)
