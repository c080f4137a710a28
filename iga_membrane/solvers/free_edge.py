"""Edges at 0 or 180 degrees: find where the membrane leaves smooth solids tangentially.

With an edge at 180 degrees fixed too far inside, the membrane would dip into the solid; too far
outside, it rises from it with a kink; at 0 degrees the other way round. The rise between them
vanishes at the contact line: a root, for one edge or two, found by Broyden's method (the secant
method for one) over Newton solves that start from one another.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..problems.scene import FreeEdge, Scene, TangentEdge
from ..results.contact_line import contact_line, vertical_forces
from ..results.measures import volume
from ..solids import Sphere
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
POINT = "at 180 degrees the membrane touches the solid in a point at most"
BESIDE = 1e-3
"""Move of an edge over its place by which the slopes of several edges are found."""
SHORTEST = 1e-6
"""Move of the edge over its place below which a solve that fails is not tried again."""


def tangent_edge(
    asked: Scene, assembly: Assembly, options: NewtonOptions
) -> tuple[Scene, NewtonResult]:
    """Scene with its edges in place, and its state with the iterations of every solve.

    Parameters
    ----------
    asked : its surface is the start, with the edges where they are foretold.
    """
    edge = asked.free_edge
    assert edge is not None
    search = _Search(replace(asked, surface=edge.foretold(asked)), edge, assembly, options)
    foretold = place = search.good
    slopes = None
    for _ in range(TRIES):
        before = search.good, search.rise
        if not search.at(place):
            near = (np.abs(place - search.good) <= SHORTEST * search.good).all()
            if search.result.status is Status.INTERRUPTED or near:
                return search.scene, search.result
            place = 0.5 * (search.good + place)  # too far from the last state
            continue
        if search.done:
            return search.scene, search.result
        if slopes is None:
            slopes = search.slopes()
        else:
            way, rise = search.good - before[0], search.rise - before[1]
            if (way @ way) > 0.0 and rise.any():
                slopes = slopes + np.outer(rise - slopes @ way, way) / (way @ way)
        step = -np.linalg.solve(slopes, search.rise)
        place = search.good + np.clip(step, FARTHEST[0] * search.good, FARTHEST[1] * search.good)
        repelled = [each.solid.contact_angle == 180.0 for each in edge.edges(asked)]
        if (repelled & (place <= GONE * foretold)).any():
            search.result.status = Status.TOPOLOGY_CHANGE
            search.result.message = POINT
            return search.scene, search.result
    search.result.status = Status.STALLED
    search.result.message = f"a tangent edge was not found in {TRIES} solves"
    return search.scene, search.result


class _Search:
    """Solves with edges at places, each from the state of the last one that came to an end.

    Attributes
    ----------
    good, rise : (k,) places of the last state, and how the membrane rises from its solids there.
    done : whether that is nothing.
    scene, result : of the last solve, with the iterations of all.
    """

    def __init__(
        self, asked: Scene, edge: FreeEdge, assembly: Assembly, options: NewtonOptions
    ) -> None:
        self._asked, self._edge = asked, edge
        self._assembly, self._options = assembly, options
        self.scene, self._surface = asked, asked.local_surface()
        self.good = edge.place_of(self._surface)
        self.rise: Array = np.zeros(len(self.good))
        self._guess: Array = self.rise
        self.done = False
        self.result = NewtonResult(self._surface, np.zeros(0))

    def at(self, place: Array) -> bool:
        """Solve with the edges at places (k,); whether it came to an end."""
        edge, multipliers = self._edge, self.result.multipliers
        start = edge.fixed_at(self._asked, self.good).local_surface().points
        self.scene = edge.fixed_at(self._asked, place)
        self._assembly.load(self.scene)
        shift = self.scene.local_surface().points - start
        moved = self._surface.moved(self._surface.points + shift)
        known = multipliers if len(multipliers) else None
        grading = self._asked.meridian_grading
        result = newton(self._assembly, moved, known, grading, self._options)
        result.iterations = self.result.iterations + result.iterations
        result.linear_seconds += self.result.linear_seconds
        self.result, kept = result, self.result
        if result.status is not None:
            self.result.multipliers = kept.multipliers
            return False
        scene, assembly = self.scene, self._assembly
        rises = [rise_at_edge(each, scene, assembly, result) for each in edge.edges(scene)]
        self.rise, least, self._guess = (np.array(v) for v in zip(*rises, strict=True))
        self.done = bool((np.abs(self.rise) <= least).all())
        self.good, self._surface = place, result.surface
        return True

    def slopes(self) -> Array:
        """(k, k) derivatives of the rises by the places: what is known of one edge, differences of
        several, which feel each other."""
        if np.isfinite(self._guess).all():
            return np.diag(self._guess)
        place, rise = self.good, self.rise
        columns = []
        for k in range(len(place)):
            beside = place.copy()
            beside[k] *= 1.0 + BESIDE
            if not self.at(beside):
                return np.diag(-np.ones(len(place)) / place)
            columns.append((self.rise - rise) / (BESIDE * place[k]))
            self.at(place)
        return np.stack(columns, axis=1)


def rise_at_edge(
    at: TangentEdge, scene: Scene, assembly: Assembly, result: NewtonResult
) -> tuple[float, float, float]:
    """Mean sine of the angle by which the membrane rises from the solid at an edge, what counts
    as none of it, and about how it grows with the edge's place, where that is known.

    Notes
    -----
    On a plane that carries a droplet the edge pulls ``gamma l sin(rise) = p A - W``: the balance of
    the whole droplet, which is right to far more digits than the spline's slope is in a layer as
    narrow as a small foot. Elsewhere it is that slope.
    """
    surface = result.surface
    solid = at.solid if isinstance(at.solid, Sphere) else None
    line = contact_line(surface, at.edge, solid=solid)
    length = float(line.arc.sum())
    if at.carries and stands_free(scene):
        body, tension = assembly.density(result.multipliers), assembly.tension
        push = vertical_forces(line, body, tension, 180.0).push
        weight = body.gradient[2] * volume(assembly, surface)
        pull = tension * length
        return (push - weight) / pull, BALANCED * weight / pull, -body.constant / tension
    out = at.solid.nearest(line.position).normal
    rise = -float(np.einsum("ki,ki->k", line.conormal, out) @ line.arc) / length
    return rise, TANGENT, 1.0 if at.solid.contact_angle == 180.0 else np.nan
