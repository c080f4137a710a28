"""The first solve of a scene: how it iterates, and the nearby equilibrium that it may start from,
pressed through the spheres it touches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..contact.laws import law_of, line_of
from ..contact.unfitted import is_unfitted
from ..dofs.symmetry import mirrors
from ..initial.profiles import meniscus
from ..problems.scene import Scene
from ..solids import Sphere
from ..status import Status
from ..surface.surface import Surface
from .newton import NEAR, NewtonOptions, NewtonResult, newton
from .options import SolverOptions

SHALLOW = 0.6
"""Part of its depth under a flat membrane below which a spot is pressed to that depth."""
WIDE = 1.5
"""Reach of that press over the sphere's radius."""
FIRM = 20.0
"""Firmness of ties with which a failed solve begins anew: steadier, but the angle is less exact."""
FAILED = Status.STALLED, Status.MAX_ITER
NEARBY = 1.0
"""Distance from a particle's centre along its axis, over the droplet's length, within which the
membrane is its own."""
FARTHEST, CAREFUL = 0.25, 0.5
"""Longest step, over the droplet's length and over a particle's radius."""
PLANE = 0.05
"""Height above a plane, over the droplet's length, at which half of a meniscus is left."""
DIMPLE = 0.3
"""Depth over radius of a dimple in the middle of every spot: inside its solid the start must lie
clear of the solid's surface, which a membrane on a penalty follows."""


def settings_of(scene: Scene, options: SolverOptions, started: float) -> NewtonOptions:
    """How Newton's method iterates from a scene's own start, at CPU time ``started``."""
    # a droplet on asperities may roll to a place where it is stable
    near = 0.0 if _rolls(scene) else NEAR
    deadline = started + options.max_cpu_s
    sizes = [each.radius / scene.units.length for each in scene.particles]
    return NewtonOptions(
        options.max_iterations,
        options.tolerance,
        step_limit=min([FARTHEST, *(CAREFUL * size for size in sizes)]),
        near=near,
        deadline=deadline,
    )


def _rolls(scene: Scene) -> bool:
    """Whether the membrane lies on solids or passes through several of them."""
    through = line_of(scene) is not None and scene.kind == "sessile_droplet"
    return law_of(scene) is not None or through


def first(scene: Scene, assembly: Assembly, options: NewtonOptions) -> NewtonResult:
    """Newton from a scene's own start, or from the equilibrium of its predictor."""
    start, multipliers, before = scene.local_surface(), None, None
    if scene.predictor is not None:
        near = scene.predictor
        before = first(near, Assembly(near), replace(options, phase="start"))
        near_start = before.surface
        if scene.start_from is not None:
            near_start = scene.start_from(before.surface)
        if before.status is Status.INTERRUPTED:
            none = np.zeros(assembly.multipliers)
            return replace(before, surface=near_start, multipliers=none, best=None)
        start = near_start
        if assembly.contact.passes:
            start = pressed(scene, assembly, near_start)
            assembly.keep_motion(near_start)
        if len(before.multipliers) == assembly.multipliers:
            multipliers = before.multipliers
    result = newton(assembly, start, multipliers, scene.meridian_grading, options)
    if result.status in FAILED and assembly.contact.passes:
        result = _firmly(scene, assembly, start, multipliers, options) or result
    if before is not None:
        result.iterations = before.iterations + result.iterations
        result.linear_seconds += before.linear_seconds
    return result


def _firmly(
    scene: Scene,
    assembly: Assembly,
    start: Surface,
    multipliers: Array | None,
    options: NewtonOptions,
) -> NewtonResult | None:
    """Newton with firmer ties first, then from there with the usual ones; None if either fails."""
    grading = scene.meridian_grading
    assembly.contact.firm(FIRM)
    firm = newton(assembly, start, multipliers, grading, options)
    assembly.contact.firm(1.0)
    if firm.status is not None:
        return None
    result = newton(assembly, firm.surface, firm.multipliers, grading, options)
    result.iterations = firm.iterations + result.iterations
    result.linear_seconds += firm.linear_seconds
    return result if result.status is None else None


def pressed(scene: Scene, assembly: Assembly, surface: Surface) -> Surface:
    """A start for contact lines at Young's angle on every sphere that a membrane has sunk into.

    A flat membrane at depth ``r (1 + cos(theta))`` meets a sphere at the angle theta. Spots that
    are much shallower are pressed to that depth: a small one is far from any equilibrium. At a
    particle, which may stand anywhere, the membrane gets the meniscus of small slopes.

    Parameters
    ----------
    scene : with contact lines inside its membrane.
    assembly : of that scene.
    surface : the nearby equilibrium, in the scene's scale.
    """
    from scipy.spatial import cKDTree

    if not is_unfitted(assembly.contact):
        return surface
    term = assembly.contact.term
    solid = term.solid
    x = assembly.table.values @ surface.points[assembly.table.functions]
    x = np.concatenate([x.reshape(-1, 3) @ m for m in mirrors(scene.sector)])
    at = solid.nearest(x)
    which, place = np.unique(at.which, return_inverse=True)
    gap = np.full(len(which), np.inf)
    np.minimum.at(gap, place.ravel(), at.gap)
    on_asperity = (gap < 0) & (term.particle(which) < 0)
    # else it passes through them already
    lies = scene.predictor is not None and law_of(scene.predictor) is not None
    touched = np.flatnonzero(on_asperity & lies)
    which, depth = which[touched], -gap[touched]
    centers, radii = solid.center_of(which), solid.radius_of(which)
    wanted = radii * (1.0 + term.cosine(centers, which)[0])
    press = np.where(depth < SHALLOW * wanted, (wanted - depth) / SHALLOW, 0.0)
    deep = np.maximum(depth, wanted)
    spot = 0.9 * np.sqrt(np.maximum(2.0 * radii * deep - deep**2, 0.0))
    fall = np.zeros(len(surface.points))
    places = cKDTree(surface.points[:, :2])
    for k, center in enumerate(centers):
        near = np.array(places.query_ball_point(center[:2], WIDE * radii[k]), int)
        fall[near] += _bump(surface.points[near], center, WIDE * radii[k], press[k])
        fall[near] += _bump(surface.points[near], center, spot[k], DIMPLE * spot[k])
    points = surface.points - np.outer(fall, [0.0, 0.0, 1.0])
    first_particle = term.count - len(scene.particles)
    for k in range(len(scene.particles)):
        each = np.array(first_particle + k)
        center, toward = solid.center_of(each), term.axis(each)
        along = (x - center) @ toward
        beside = np.linalg.norm(x - center - along[:, None] * toward, axis=1)
        # the drop's other side is crossed by the axis too
        pierced = int(np.where(np.abs(along) < NEARBY, beside, np.inf).argmin())
        angle = float(np.degrees(np.arccos(term.cosine(center, each)[0])))
        particle = Sphere(angle, float(solid.radius_of(each)))
        bent = meniscus(particle, -float(along[pierced]), 1.0)
        distance = np.linalg.norm(surface.points - x[pierced], axis=1) / particle.radius
        fading = np.maximum(1.0 - (distance / bent.rim) ** 4, 0.0) ** 2
        if assembly.above_plane:
            fading *= surface.points[:, 2] / (surface.points[:, 2] + PLANE)
        points += np.outer(particle.radius * bent.through(distance) * fading, toward)
    return surface.moved(points)


def _bump(points: Array, center: Array, reach: float, height: float) -> Array:
    """(count,) smooth bump round the vertical axis through a sphere, above its lower half."""
    if not height:
        return np.zeros(len(points))
    away = points - center
    level = np.maximum(1.0 - (away[:, 0] ** 2 + away[:, 1] ** 2) / reach**2, 0.0)
    return np.asarray(np.where(np.abs(away[:, 2]) < 3.0 * reach, height * level**2, 0.0))
