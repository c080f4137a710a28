"""Edges at 180 degrees: find where the membrane leaves a smooth solid tangentially.

With the edge fixed too far inside, the membrane would dip into the solid; too far outside, it rises
from it with a kink. The slope between them vanishes at the contact line: a scalar root, found by
the secant method over Newton solves that start from one another, the first from contact lines just
below 180 degrees.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..scenes.scene import FreeEdge, Scene
from ..surface.reparametrize import regridded
from ..surface.surface import Surface
from .assembly import Assembly
from .contact_line import contact_line
from .measures import sphere_of
from .newton import NewtonOptions, NewtonResult, newton
from .status import Status

NEARBY = (177.0, 179.0)
"""Contact angles from which the edge at 180 degrees is foretold."""
TANGENT = 1e-10
"""Slope of the membrane against the solid that counts as none."""
TRIES = 30
SHORTEST = 1e-6
"""Move of the edge over its place below which a solve that fails is not tried again."""
GONE = 0.05
"""Edge over that at the nearest contact angle which counts as no contact."""


def tangent_edge(
    edge: FreeEdge,
    assembly: Assembly,
    options: NewtonOptions,
    find: Callable[[Scene], NewtonResult],
) -> tuple[Scene, NewtonResult]:
    """Scene with its edge in place, and its state with the iterations of every solve.

    Parameters
    ----------
    find : state of a scene with a contact line.
    """
    found = [find(edge.nearby(angle)) for angle in NEARBY]
    near = found[-1]
    iterations = [step for result in found for step in result.iterations]
    first, here = (edge.place_of(result.surface) for result in found)
    scene = edge.scene_at(here)
    # a line on a sphere has multipliers of its own, after those of the constraints
    near.multipliers = near.multipliers[: assembly.multipliers]
    failed = next((result for result in found if result.status is not None), None)
    if failed is not None:
        near.status, near.message = failed.status, failed.message
        return scene, near
    grading = scene.meridian_grading
    assert grading is not None
    surface = regridded(near.surface, grading)
    place = here + (here - first) * (180.0 - NEARBY[1]) / (NEARBY[1] - NEARBY[0])
    before: tuple[float, float] | None = None
    result, good = near, here
    for _ in range(TRIES):
        if place <= GONE * here:
            result.status = Status.TOPOLOGY_CHANGE
            result.message = "at 180 degrees the membrane touches the solid in a point at most"
            return scene, result
        start = edge.scene_at(good).local_surface().points
        scene = edge.scene_at(place)
        assembly.load(scene)
        moved = surface.moved(surface.points + scene.local_surface().points - start)
        result = newton(assembly, moved, near.multipliers, grading, options)
        iterations += result.iterations
        result.iterations = iterations
        if result.status is not None:
            if result.status is Status.INTERRUPTED or abs(place - good) <= SHORTEST * good:
                return scene, result
            place = 0.5 * (good + place)  # too far from the last state
            continue
        slope = slope_at_edge(scene, result.surface)
        if abs(slope) <= TANGENT:
            return scene, result
        step = 1e-3 * place if slope < 0 else -1e-3 * place
        if before is not None and slope != before[1]:
            step = -slope * (place - before[0]) / (slope - before[1])
        before, surface, good, near = (place, slope), result.surface, place, result
        place += float(np.clip(step, -0.1 * place, 0.1 * place))
    result.status = Status.STALLED
    result.message = f"the edge at 180 degrees was not found in {TRIES} solves"
    return scene, result


def slope_at_edge(scene: Scene, surface: Surface) -> float:
    """Mean sine of the angle by which the membrane rises from the solid at its edge."""
    solid = sphere_of(scene)
    line = contact_line(surface, solid=solid)
    length = float(line.arc.sum())
    if solid is None:
        return -float(line.conormal[:, 2] @ line.arc) / length
    out = solid.normal(line.position)
    return -float(np.einsum("ki,ki->k", line.conormal, out) @ line.arc) / length
