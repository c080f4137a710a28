"""What is drawn beside membrane and solids: contact lines, wet spots, tractions, forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import Array
from ..driver.lines import LineOnSolid, contact_lines
from ..solids import Sphere
from ..solids.fan import on_surface
from .fields import solids
from .mesh import trimming_solid

if TYPE_CHECKING:
    from ..driver.solution import Solution

LINE_COLOR, WET_COLOR, PULL_COLOR = "#cc0000", "#8e2a1c", "#1155cc"
FORCES = {"F_e": "black", "F_CL": PULL_COLOR, "F_H + F_B": "#2a9d8f", "F_G": "#7f7f7f"}
"""Forces on a particle and their colours."""
LIFT = 2e-3
"""Height of a drawn wet spot above its solid, over the solid's size."""


def add_lines(plotter: Any, pv: Any, solution: Solution, traction: bool) -> None:
    """Contact lines with their wet spots, and arrows of the membrane's pull along them."""
    size = solution.scene.units.length
    for each in contact_lines(solution):
        x = each.line.position
        radius = _sphere_of(solution, each)[1]
        curve = pv.lines_from_points(np.vstack([x, x[:1]]))
        thick = curve.tube(radius=min(0.008 * size, 0.03 * radius))
        plotter.add_mesh(thick, color=LINE_COLOR)
        plotter.add_mesh(_spot(pv, solution, each), color=WET_COLOR, ambient=0.3)
        if traction:
            _arrows(plotter, pv, x, -each.line.conormal, min(0.5 * size, radius))
    for asperity in solution.contact.get("asperities", ()):
        on = solution.scene.substrate
        ball = on is not None and np.isfinite(on.radius_of(np.array(asperity["index"])))
        if ball and solution.contact["law"] != "contact lines":
            plotter.add_mesh(_lain_on(pv, solution, asperity), color=WET_COLOR, ambient=0.3)


def add_forces(plotter: Any, pv: Any, solution: Solution, aside: Array) -> None:
    """Arrows of the forces on particles from their centres, as long as they are large.

    Parameters
    ----------
    aside : unit vector along which arrows stand beside each other.
    """
    particles = [s for s in solids(solution) if isinstance(s, Sphere)][-len(solution.forces) :]
    parts = [
        (f.effective, f.contact_line, f.hydrostatic + f.buoyancy, f.weight) for f in solution.forces
    ]
    largest = max((float(np.linalg.norm(v)) for part in parts for v in part), default=0.0)
    if not largest:
        return
    for particle, vectors in zip(particles, parts, strict=True):
        for k, (vector, color) in enumerate(zip(vectors, FORCES.values(), strict=True)):
            long = 3.0 * particle.radius * float(np.linalg.norm(vector)) / largest
            if long > 0.02 * particle.radius:
                start = np.array(particle.center) + (k - 1.5) * 0.35 * particle.radius * aside
                shaft = 0.06 * particle.radius / long
                arrow = pv.Arrow(
                    start=start, direction=vector, scale=long, shaft_radius=shaft,
                    tip_radius=2.2 * shaft, tip_length=min(0.5, 0.35 * particle.radius / long),
                )  # fmt: skip
                plotter.add_mesh(arrow, color=color, ambient=0.4)
    entries = [[name, color] for name, color in FORCES.items()]
    plotter.add_legend(
        entries, bcolor="white", face="rectangle", size=(0.2, 0.16), loc="upper left"
    )


def _sphere_of(solution: Solution, each: LineOnSolid) -> tuple[Array, float]:
    """Centre and radius of the solid of a line; a plane has an infinite radius."""
    if each.solid < 0:
        return np.zeros(3), np.inf
    on, which = trimming_solid(solution) or solution.scene.substrate, np.array(each.solid)
    assert on is not None
    return np.asarray(on.center_of(which)), float(on.radius_of(which))


def _spot(pv: Any, solution: Solution, each: LineOnSolid) -> Any:
    """The wetted surface inside a line: part of a sphere, or flat."""
    center, radius = _sphere_of(solution, each)
    through = solution.scene.by_form.unfitted
    wet = solution.scene.units.axes[:, 2]
    if through is not None and each.solid >= 0:
        wet = through.axis(np.array(each.solid))
    grid = _fan(pv, each.line.position, center, radius, wet)
    if through is not None and each.solid < 0:
        scale = solution.scene.units
        local = scale.to_local(np.asarray(grid.points, float))
        on, _, found = on_surface(scale.local_solid(through.solid), local)
        local[found] = on[found] + [0.0, 0.0, LIFT]
        grid.points = scale.to_world(local)
    return grid


def _lain_on(pv: Any, solution: Solution, asperity: Any) -> Any:
    """The wet spot of an asperity that the membrane lies on, round its force."""
    on = solution.scene.substrate
    assert on is not None
    center = np.array(asperity["center"])
    radius = float(on.radius_of(np.array(asperity["index"])))
    axis = -np.array(asperity["force_vector"]) / asperity["force"]
    polar = np.arccos(np.clip(1.0 - asperity["wet_area"] / (2.0 * np.pi * radius**2), -1.0, 1.0))
    one = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    one /= np.linalg.norm(one)
    turn = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)[:, None]
    around = np.cos(turn) * one + np.sin(turn) * np.cross(axis, one)
    line = center + radius * (np.cos(polar) * axis + np.sin(polar) * around)
    return _fan(pv, line, center, radius, axis)


def _fan(pv: Any, line: Array, center: Array, radius: float, wet: Array) -> Any:
    """Surface inside a closed line, a little above its sphere, or its plane.

    Parameters
    ----------
    wet : unit vector from a sphere's centre to its wet side, or a plane's normal.
    """
    closed = np.vstack([line, line[:1]])
    part = np.linspace(0.0, 1.0, 41)[:, None, None]
    if np.isfinite(radius):
        # along great circles from the wet side's middle
        out = (closed - center) / np.linalg.norm(closed - center, axis=-1)[:, None]
        angle = np.arccos(np.clip(out @ wet, -1.0, 1.0))[:, None]
        across = out - np.cos(angle) * wet
        across /= np.linalg.norm(across, axis=-1)[:, None]
        away = np.cos(part * angle) * wet + np.sin(part * angle) * across
        x = center + (1.0 + LIFT) * radius * away
    else:
        middle = line.mean(axis=0)
        x = middle + part * (closed - middle) + LIFT * float(np.ptp(line, axis=0).max()) * wet
    return pv.StructuredGrid(*(np.ascontiguousarray(x[..., i])[..., None] for i in range(3)))


def _arrows(plotter: Any, pv: Any, points: Array, directions: Array, length: float) -> None:
    """Some arrows of the pull on the solid along a line, equally far from each other."""
    some = slice(None, None, max(1, len(points) // ARROWS))
    cloud = pv.PolyData(points[some])
    cloud["pull"] = directions[some]
    shape = pv.Arrow(shaft_radius=0.02, tip_radius=0.06, tip_length=0.2)
    arrows = cloud.glyph(geom=shape, orient="pull", scale=False, factor=length)
    plotter.add_mesh(arrows, color=PULL_COLOR)


ARROWS = 32
"""Arrows along a contact line, at least."""
