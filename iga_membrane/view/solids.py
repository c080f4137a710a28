"""Substrate and particles in a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..solids.disc import Disc
from ..solids.fan import on_surface
from ..solids.wettability import varies

if TYPE_CHECKING:
    from ..driver.solution import Solution

SEEN_THROUGH = 0.35
"""Opacity of a plate above the liquid."""
DRY, WET = "#d9d2c5", "#cc4125"
"""Colours of solids, and of asperities that carry a part of the droplet."""
PATTERN = ["#f3ead8", "#8c9bab"]
"""Colours of a pattern of contact angles, from the largest to the smallest."""


def add_solids(plotter: Any, pv: Any, solution: Solution, opacity: float) -> None:
    """Draw substrate and particles.

    Parameters
    ----------
    opacity : of the particles.
    """
    substrate = solution.scene.substrate
    look: dict[str, Any] = {"color": DRY, "ambient": 0.3, "smooth_shading": True}
    for each in solution.scene.particles:
        if each != substrate:
            plotter.add_mesh(_ball(pv, each.center, each.radius), opacity=opacity, **look)
    if isinstance(substrate, (SphereLattice, Spheres)):
        _add_asperities(plotter, pv, solution)
        return
    for term in solution.scene.local_terms().wetting:
        if term.level:  # a plane above the liquid, through which one sees it
            plate = _plate(pv, solution, term.level, 1.0, _reach(solution))
            plotter.add_mesh(plate, color=DRY, ambient=0.3, opacity=min(opacity, SEEN_THROUGH))
    if substrate is None:
        return
    solid = _mesh_of(pv, substrate, solution)
    look["smooth_shading"] = not isinstance(substrate, Plane)
    angle: Any = substrate.contact_angle
    if varies(angle):
        solid["cosine"], _ = angle.at(np.asarray(solid.points, float))
        del look["color"]
        look |= {"scalars": "cosine", "cmap": PATTERN, "show_scalar_bar": False}
    opacity = opacity if solution.scene.kind == "liquid_sheet" else 1.0
    plotter.add_mesh(solid, opacity=opacity, **look)


def _mesh_of(pv: Any, substrate: Solid, solution: Solution) -> Any:
    """The surface of a solid under the membrane and a little beside it."""
    if isinstance(substrate, Sphere):
        # a membrane that covers the sphere and has sunk into it is shown on top
        sunk = solution.contact.get("max_penetration") if solution.scene.line_inside else None
        return _ball(pv, substrate.center, substrate.radius - 1.5 * (sunk or 0.0))
    if isinstance(substrate, Disc):
        return _plate(pv, solution, 0.0, -1.0, substrate.radius / solution.scene.units.length)
    if not isinstance(substrate, Plane):
        return _by_gap(pv, substrate, solution)
    if not varies(substrate.contact_angle):
        return _plate(pv, solution, 0.0, -1.0, _reach(solution))
    solid = pv.Disc(inner=0.0, outer=_reach(solution), r_res=ACROSS, c_res=2 * ACROSS)
    solid.points = solution.scene.units.to_world(np.asarray(solid.points, float))
    return solid


def _reach(solution: Solution) -> float:
    """Radius of a plane that is drawn, in the scene's scale."""
    local = solution.scene.units.to_local(solution.surface.points)
    return 1.35 * float(np.linalg.norm(local[:, :2], axis=1).max())


def _plate(pv: Any, solution: Solution, level: float, side: float, reach: float) -> Any:
    """A round plate of a radius with one face at a level of the scene's frame, the other above it
    (side 1) or below (-1)."""
    thick = 0.05 * reach
    center = (0.0, 0.0, level + side * (0.5 * thick + 1e-3))
    plate = pv.Cylinder(
        center=center, direction=(0, 0, 1), radius=reach, height=thick, resolution=180
    )
    plate.points = solution.scene.units.to_world(np.asarray(plate.points, float))
    return plate


def _ball(pv: Any, center: tuple[float, float, float], radius: float) -> Any:
    return pv.Sphere(radius=radius, center=center, theta_resolution=120, phi_resolution=120)


ACROSS = 240
"""Cells across the surface of a solid that is known by its gap only."""


def _by_gap(pv: Any, solid: Solid, solution: Solution) -> Any:
    """Where the gap vanishes, under the droplet and a little beside it: the graph that it is over
    the plane z = 0, if it is one."""
    points = solution.surface.points
    reach = 1.3 * float(np.abs(points[:, :2]).max())
    axis = np.linspace(-reach, reach, 2 * ACROSS + 1)
    plane = np.stack([*np.meshgrid(axis, axis, indexing="ij"), np.zeros(2 * [len(axis)])], axis=-1)
    x, _, found = on_surface(solid, plane)
    if found.all():
        return pv.StructuredGrid(*(np.ascontiguousarray(x[..., i])[..., None] for i in range(3)))
    cell, top = 2.0 * reach / ACROSS, float(points[:, 2].min())
    deep = min(2.0 * solid.scale, 0.5 * reach) + 4.0 * cell
    grid = pv.ImageData(
        dimensions=(ACROSS + 1, ACROSS + 1, int(np.ceil(2.0 * deep / cell)) + 1),
        spacing=(cell, cell, cell),
        origin=(-reach, -reach, top - deep),
    )
    grid["gap"] = solid.nearest(np.asarray(grid.points, float)).gap
    return grid.contour([0.0], scalars="gap").compute_normals(flip_normals=False)


def _add_asperities(plotter: Any, pv: Any, solution: Solution) -> None:
    """Spheres under the droplet and a little beside it, and their base."""
    substrate = solution.scene.substrate
    assert isinstance(substrate, (SphereLattice, Spheres))
    reach = 1.3 * float(np.linalg.norm(solution.surface.points[:, :2], axis=1).max())
    near = substrate.within(reach)
    wet = {asperity["index"] for asperity in solution.contact.get("asperities", ())}
    dry = np.array([which not in wet for which in near.tolist()], bool)
    for which, color in ((near[dry], DRY), (near[~dry], WET)):
        if not len(which):
            continue
        cloud = pv.PolyData(substrate.center_of(which))
        cloud["diameter"] = 2.0 * substrate.radius_of(which)
        ball = pv.Sphere(radius=0.5, theta_resolution=80, phi_resolution=80)
        balls = cloud.glyph(geom=ball, scale="diameter", orient=False)
        plotter.add_mesh(balls, color=color, ambient=0.3, smooth_shading=True)
    if substrate.base is not None:
        base = pv.Disc(center=(0.0, 0.0, substrate.base), inner=0.0, outer=reach, c_res=120)
        plotter.add_mesh(base, color=DRY, ambient=0.3)
