"""Edges at 180 degrees: find where the membrane leaves a smooth solid tangentially.

With the edge fixed too far inside, the membrane would dip into the solid; too far outside, it rises
from it with a kink. The rise between them vanishes at the contact line: a scalar root, found by the
secant method over Newton solves that start from one another.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..assembly.lagrangian import Assembly
from ..problems.scene import Scene
from ..results.contact_line import contact_line, vertical_forces
from ..results.measures import sphere_of, volume
from ..status import Status
from ..verification.audit import stands_free
from .newton import NewtonOptions, NewtonResult, newton

TANGENT = 1e-10
"""Slope of the membrane against the solid that counts as none."""
BALANCED = 1e-9
"""The same as a force along the edge, over the weight it helps to carry."""
TRIES = 30
FARTHEST = -0.3, 0.1
"""Longest moves of the edge inwards and outwards, over its place."""
GONE = 0.05
"""Edge over that of the start which counts as no contact."""
SHORTEST = 1e-6
"""Move of the edge over its place below which a solve that fails is not tried again."""


def tangent_edge(
    asked: Scene, assembly: Assembly, options: NewtonOptions
) -> tuple[Scene, NewtonResult]:
    """Scene with its edge in place, and its state with the iterations of every solve.

    Parameters
    ----------
    asked : its surface is the start, with the edge where it is foretold.
    """
    edge, grading = asked.free_edge, asked.meridian_grading
    assert edge is not None
    asked = scene = replace(asked, surface=edge.foretold(asked))
    surface, multipliers, iterations = scene.local_surface(), None, []
    place = good = foretold = edge.place_of(surface)
    before: tuple[float, float] | None = None
    for _ in range(TRIES):
        start = edge.fixed_at(asked, good).local_surface().points
        scene = edge.fixed_at(asked, place)
        assembly.load(scene)
        moved = surface.moved(surface.points + scene.local_surface().points - start)
        result = newton(assembly, moved, multipliers, grading, options)
        iterations += result.iterations
        result.iterations = iterations
        if result.status is not None:
            if result.status is Status.INTERRUPTED or abs(place - good) <= SHORTEST * good:
                return scene, result
            place = 0.5 * (good + place)  # too far from the last state
            continue
        rise, least, slope = rise_at_edge(scene, assembly, result)
        if abs(rise) <= least:
            return scene, result
        step = -rise / slope
        if before is not None and rise != before[1]:
            step = -rise * (place - before[0]) / (rise - before[1])
        before, surface, multipliers = (place, rise), result.surface, result.multipliers
        good = place
        place += float(np.clip(step, FARTHEST[0] * place, FARTHEST[1] * place))
        if place <= GONE * foretold:
            result.status = Status.TOPOLOGY_CHANGE
            result.message = "at 180 degrees the membrane touches the solid in a point at most"
            return scene, result
    result.status = Status.STALLED
    result.message = f"the edge at 180 degrees was not found in {TRIES} solves"
    return scene, result


def rise_at_edge(
    scene: Scene, assembly: Assembly, result: NewtonResult
) -> tuple[float, float, float]:
    """Mean sine of the angle by which the membrane rises from the solid at its edge, what counts
    as none of it, and about how it grows with the edge's place.

    Notes
    -----
    On a plane that carries a droplet the edge pulls ``gamma l sin(rise) = p A - W``: the balance of
    the whole droplet, which is right to far more digits than the spline's slope is in a layer as
    narrow as a small foot. Elsewhere it is that slope.
    """
    surface, solid = result.surface, sphere_of(scene)
    line = contact_line(surface, solid=solid)
    length = float(line.arc.sum())
    if solid is not None or not stands_free(scene):
        assert solid is not None
        out = solid.normal(line.position)
        rise = -float(np.einsum("ki,ki->k", line.conormal, out) @ line.arc) / length
        return rise, TANGENT, 1.0
    body, tension = assembly.density(result.multipliers), assembly.tension
    push = vertical_forces(line, body, tension, 180.0).push
    weight = body.gradient[2] * volume(assembly, surface)
    pull = tension * length
    return (push - weight) / pull, BALANCED * weight / pull, -body.constant / tension
