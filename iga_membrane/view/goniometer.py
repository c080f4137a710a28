"""A droplet from the side as a goniometer's camera sees it: its shadow, profile and angle."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..driver.lines import contact_lines
from ..driver.solution import Solution
from ..errors import SceneError
from ..problems.scene import Scene
from ..results.apparent import profile
from ..results.measures import own_asperity
from ..solids import Plane, Sphere, SphereLattice, Spheres
from .fields import solids
from .figure import figure, write_figure
from .mesh import RESOLUTION, membrane, outside, trimming_solid

SHADOW, PROFILE, TANGENT = "#101418", "#ff9f1c", "#e71d36"


@checked(resolution=RESOLUTION)
def plot_side(
    solution: Solution,
    path: str | os.PathLike[str],
    *,
    azimuth: float = 0.0,
    resolution: int = 97,
) -> tuple[float, float]:
    """Draw a droplet's shadow with its profile and apparent contact angles.

    Parameters
    ----------
    solution : of a droplet.
    path : of the picture; its ending chooses the format (.png, .pdf, .svg).
    azimuth : degrees round the frame's z axis by which the camera is turned; it looks along y from
        where y is negative.
    resolution : points along each direction of the patch.

    Returns
    -------
    The angles left and right, in degrees: where the contact line reaches farthest; on asperities
    where the axisymmetric profile of the droplet's height and pressure meets the level of their
    tops (:func:`iga_membrane.results.apparent.apparent_angle`).

    Raises
    ------
    SceneError
        A scene that is no droplet on a substrate, one that leans on asperities, or one that lies
        on a sphere at 180 degrees.
    OutputError
        If the file cannot be written, or matplotlib is not installed.
    """
    scene = solution.scene
    rough = _is_rough(scene)
    made, axes = figure(path)
    turn = np.radians(azimuth)
    right = np.array([np.cos(turn), np.sin(turn), 0.0])
    mesh = membrane(solution, resolution)
    through = trimming_solid(solution)
    if through is not None:
        mesh = outside(through, mesh).extract_surface(algorithm=None)
    local = scene.units.to_local(np.asarray(mesh.points, float))
    flat = np.stack([local @ right, local[:, 2]], axis=1)
    _shadow(axes, flat[mesh.triangulate().regular_faces])
    _shade_solids(axes, solution, right, flat)
    if rough:
        sides = _of_profile(axes, solution)
    else:
        sides = _of_line(solution, right)
        if not scene.lateral_load and not scene.particles and isinstance(scene.substrate, Plane):
            _of_profile(axes, solution)
    long = 0.45 * float(np.ptp(flat[:, 0]))
    for sign, side in zip((1.0, -1.0), sides, strict=True):
        axes.plot(
            *np.stack([side.foot, side.foot + long * side.way], axis=1), color=TANGENT, lw=1.2
        )
        axes.annotate(
            f"{side.angle:.2f}°",
            side.foot,
            (-8.0 * sign, -6.0),
            textcoords="offset points",
            ha="right" if sign > 0 else "left",
            va="top",
            color=TANGENT,
            fontsize=9,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
        )
    axes.set_axis_off()
    axes.set_aspect("equal")
    write_figure(made, path)
    return sides[0].angle, sides[1].angle


def _is_rough(scene: Scene) -> bool:
    """Whether a droplet stands on several asperities.

    Raises
    ------
    SceneError
        A scene that a goniometer does not measure.
    """
    if scene.kind != "sessile_droplet":
        raise SceneError("plot_side: shows droplets on a substrate; take plot or plot_section")
    if not isinstance(scene.substrate, (Plane, Sphere, SphereLattice, Spheres)):
        raise SceneError(
            f"plot_side: what a goniometer sees on {type(scene.substrate).__name__} is not known; "
            "take plot or plot_section"
        )
    alone = own_asperity(scene) is not None
    rough = isinstance(scene.substrate, (SphereLattice, Spheres)) and not alone
    if rough and scene.lateral_load:
        raise SceneError("plot_side: a leaning droplet on asperities has no apparent angle")
    return rough


def _shadow(axes: Any, triangles: Array) -> None:
    from matplotlib.collections import PolyCollection

    # neighbours without antialiasing leave no hairlines between them
    axes.add_collection(PolyCollection(list(triangles), facecolors=SHADOW, antialiaseds=False))


@dataclass(frozen=True, eq=False)
class Side:
    """Where the outline meets the solid: contact angle (degrees), place (2,) and direction (2,) in
    which the liquid's surface leaves it, as the camera sees them."""

    angle: float
    foot: Array
    way: Array


def _of_line(solution: Solution, right: Array) -> tuple[Side, Side]:
    """Where the contact line reaches farthest to the left and to the right."""
    scale = solution.scene.units
    lines = [each.line for each in contact_lines(solution) if not _on_particle(solution, each)]
    if not lines:
        raise SceneError("plot_side: the membrane lies on its solid; no line has an angle to show")
    line = lines[0]
    seen = np.stack([right, [0.0, 0.0, 1.0]], axis=1)
    x, leaving = scale.to_local(line.position) @ seen, -(line.conormal @ scale.axes) @ seen
    one, two = (
        Side(float(np.degrees(line.angle[k])), x[k], leaving[k])
        for k in (x[:, 0].argmin(), x[:, 0].argmax())
    )
    return one, two


def _on_particle(solution: Solution, each: Any) -> bool:
    return bool(solution.scene.particles) and each.solid >= 0


def _of_profile(axes: Any, solution: Solution) -> tuple[Side, Side]:
    """Where the axisymmetric profile meets z = 0; draws it."""
    scale = solution.scene.units
    r, z, turn = profile(solution.measures["height"] / scale.length, solution.body, 1.0)
    axes.plot(np.append(-r[::-1], r), np.append(z[::-1], z), "--", color=PROFILE, lw=1.2)
    slope = min(turn[-1], np.pi)
    one, two = (
        Side(
            float(np.degrees(slope)),
            np.array([sign * r[-1], z[-1]]),
            np.array([-sign * np.cos(slope), np.sin(slope)]),
        )
        for sign in (-1.0, 1.0)
    )
    return one, two


def _shade_solids(axes: Any, solution: Solution, right: Array, shadow: Array) -> None:
    """Substrate and particles, dark as the droplet, and the window of the picture."""
    from matplotlib.patches import Circle, Rectangle

    scale = solution.scene.units
    low, high = shadow.min(axis=0), shadow.max(axis=0)
    middle, wide = 0.5 * (low[0] + high[0]), 0.85 * (high[0] - low[0])
    floor = -0.3 * wide
    for solid in solids(solution):
        if isinstance(solid, Plane):
            axes.add_patch(Rectangle((middle - wide, floor), 2.0 * wide, -floor, color="#3a3f44"))
            continue
        if isinstance(solid, Sphere):
            centers, radii = np.array([solid.center]), np.array([solid.radius])
        else:
            assert isinstance(solid, (SphereLattice, Spheres))
            which = solid.within(1.5 * wide * scale.length)
            centers, radii = solid.center_of(which), solid.radius_of(which)
        for center, radius in zip(scale.to_local(centers), radii / scale.length, strict=True):
            axes.add_patch(Circle((center @ right, center[2]), radius, color="#3a3f44", lw=0))
    axes.set(xlim=(middle - wide, middle + wide), ylim=(floor, high[1] + 0.15 * wide))
