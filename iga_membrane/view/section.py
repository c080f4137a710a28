"""Cross-section of a droplet or sheet, against the axisymmetric profile."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..driver.solution import Solution
from ..reference import profile_on_plane
from ..solids import Plane, Sphere, SphereLattice, Spheres
from ..solids.wettability import varies
from .fields import solids
from .figure import figure, write_figure
from .mesh import RESOLUTION, membrane, outside, trimming_solid

SOLID, LIQUID = "#d9d2c5", "#1f5f99"
BESIDE = 1e-4
"""Distance of the drawn section from y = 0, over the scene's length."""


@checked(resolution=RESOLUTION)
def plot_section(
    solution: Solution, path: str | os.PathLike[str], *, resolution: int = 129
) -> float | None:
    """Draw the section in the plane y = 0 of the scene's frame.

    For a droplet that stands upright on a plane the axisymmetric profile of the same Bond number,
    contact angle and volume, from an integrator that shares no code with the solver, is drawn over
    it, and below it the distance of the membrane from that profile.

    Parameters
    ----------
    solution : converged or not.
    path : of the picture; its ending chooses the format (.png, .pdf, .svg).
    resolution : points along each direction of the patch.

    Returns
    -------
    The largest distance from that profile over the scene's length, or None where there is none.

    Raises
    ------
    OutputError
        If the file cannot be written, or matplotlib is not installed.
    """
    exact = _axisymmetric(solution)
    panels: Any
    if exact is None:
        made, axes = figure(path, height=3.2)
    else:
        made, panels = figure(path, height=4.6, rows=2, height_ratios=(2.6, 1.0))
        axes = panels[0]
    scale = solution.scene.units
    mesh = membrane(solution, resolution)
    through = trimming_solid(solution)
    if through is not None:
        mesh = outside(through, mesh)
    # a closed square has its seam in y = 0, where its mesh is open by a hair
    beside = np.array(scale.origin) + BESIDE * scale.length * scale.axes[:, 1]
    cut = mesh.slice(normal=scale.axes[:, 1], origin=beside)
    local = scale.to_local(np.asarray(cut.points, float))
    for one in cut.strip(join=True, max_length=10**6).cell:
        x = local[one.point_ids]
        axes.plot(x[:, 0], x[:, 2], color=LIQUID, lw=1.6, label="membrane")
    _draw_solids(axes, solution, local)
    axes.set(aspect="equal", xlabel="x / L", ylabel="z / L")
    largest = None
    if exact is not None:
        r, z = exact
        both = np.append(-r[::-1], r), np.append(z[::-1], z)
        axes.plot(*both, "--", color="#e07a00", lw=1.0, label="axisymmetric profile")
        place, away = _distance(solution, exact)
        largest = float(away.max())
        panels[1].semilogy(place, np.maximum(away, 1e-16), ".", ms=2, color=LIQUID)
        panels[1].set(xlabel="z / L", ylabel="distance / L")
        panels[1].grid(True, alpha=0.3)
    names = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    axes.legend(names.values(), names.keys(), frameon=False, fontsize=8)
    write_figure(made, path)
    return largest


def _axisymmetric(solution: Solution) -> tuple[Array, Array] | None:
    """Reference profile of an upright droplet on a plane, in the scene's scale."""
    scene = solution.scene
    even = isinstance(scene.substrate, Plane) and not varies(scene.substrate.contact_angle)
    upright = even and not scene.lateral_load and not scene.particles
    if scene.kind != "sessile_droplet" or not upright or scene.line_inside:
        return None
    bond = solution.body.gradient[2]
    if bond < 0:
        return None  # it hangs
    assert isinstance(scene.substrate, Plane)
    volume = solution.measures["volume"] / scene.units.length**3
    return profile_on_plane(bond, scene.substrate.contact_angle, volume, points=20001)


def _distance(solution: Solution, exact: tuple[Array, Array]) -> tuple[Array, Array]:
    """Heights of points of the membrane and their distances from a profile."""
    from scipy.spatial import cKDTree

    scale = solution.scene.units
    x = scale.to_local(solution.surface.grid(9, 201, 1).position).reshape(-1, 3)
    x[:, :2] -= x[:, :2].mean(axis=0) * bool(solution.scene.loose_axes)
    points = np.stack([np.hypot(x[:, 0], x[:, 1]), x[:, 2]], axis=1)
    curve = np.stack(exact, axis=1)
    nearest = np.clip(cKDTree(curve).query(points)[1], 1, len(curve) - 2)
    along = curve[nearest + 1] - curve[nearest - 1]
    away = points - curve[nearest]
    turned = away[:, 0] * along[:, 1] - away[:, 1] * along[:, 0]
    return points[:, 1], np.abs(turned) / np.linalg.norm(along, axis=1)


def _draw_solids(axes: Any, solution: Solution, section: Array) -> None:
    """Sections of substrate and particles in the scene's scale."""
    from matplotlib.patches import Circle

    scale = solution.scene.units
    wide = 1.35 * float(np.abs(section[:, 0]).max())
    low, high = float(section[:, 2].min()), float(section[:, 2].max())
    circles: list[tuple[Array, float]] = []
    for solid in solids(solution):
        if isinstance(solid, Plane):
            axes.axhspan(-0.12 * wide, 0.0, color=SOLID, lw=0)
            low = -0.12 * wide
        elif isinstance(solid, Sphere):
            circles.append((np.array(solid.center), solid.radius))
        elif isinstance(solid, (SphereLattice, Spheres)):
            which = solid.within(1.3 * wide * scale.length)
            circles += zip(solid.center_of(which), solid.radius_of(which), strict=True)
        else:
            low = float(section[:, 2].min()) - 0.12 * wide
            x, z = np.meshgrid(np.linspace(-wide, wide, 601), np.linspace(low, high, 401))
            cut = scale.to_world(np.stack([x, np.zeros_like(x), z], axis=-1))
            axes.contourf(x, z, solid.nearest(cut).gap, levels=[-np.inf, 0.0], colors=[SOLID])
    for center, radius in circles:
        x, y, z = scale.to_local(center)
        cut = (radius / scale.length) ** 2 - y**2
        if cut > 0.0 and abs(x) < wide + np.sqrt(cut):
            axes.add_patch(Circle((x, z), np.sqrt(cut), color=SOLID, lw=0))
            low, high = min(low, z - np.sqrt(cut)), max(high, z + np.sqrt(cut))
    # of large solids the part near the membrane
    low = max(low, float(section[:, 2].min()) - 0.5 * wide)
    high = min(high, float(section[:, 2].max()) + 0.5 * wide)
    axes.set(xlim=(-wide, wide), ylim=(low, high + 0.06 * wide))
