"""Particles of a droplet: where they may be, which way they are dry, mirror planes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..checks import record
from ..dofs.boundary_conditions import Model
from ..errors import SceneError
from ..solids import Sphere, Spheres
from ..surface.surface import Surface
from .liquid import MODELS

FAR = 0.3
"""Gap between a particle and the start, over the droplet's length, that no meniscus spans."""


def check_particles(particles: Sequence[Sphere]) -> tuple[Sphere, ...]:
    """Particles of a droplet, apart from each other.

    Raises
    ------
    SceneError
        Something else than spheres, an angle of 180 degrees, two that overlap.
    """
    for i, each in enumerate(particles):
        record(f"particle[{i}]", each, Sphere)
        if each.contact_angle == 180.0:
            raise SceneError(
                f"particle[{i}].contact_angle = 180: nothing holds such a particle to a droplet; "
                "give an angle below 180"
            )
        for j, other in enumerate(particles[:i]):
            away = float(np.linalg.norm(np.subtract(each.center, other.center)))
            depth = each.radius + other.radius - away
            if depth > 0.0:
                raise SceneError(
                    f"particle[{j}], particle[{i}]: their centres are {away:g} apart, less than "
                    f"the sum of their radii {each.radius + other.radius:g}: they overlap by "
                    f"{depth:.3g}"
                )
    return tuple(particles)


def as_list(particles: Sequence[Sphere]) -> Spheres:
    """Particles as one solid, in their order."""
    return Spheres(
        [each.contact_angle for each in particles],
        [each.center for each in particles],
        [each.radius for each in particles],
    )


def towards_liquid(start: Surface, particles: Sequence[Sphere], length: float) -> Array:
    """(n, 3) from each particle into the liquid: about against the normal where the start is
    nearest.

    Parameters
    ----------
    start : in the particles' coordinates; length : of the droplet.

    Raises
    ------
    SceneError
        If a particle is farther from the start than a meniscus reaches.
    """
    one, two = (np.linspace(b.breaks[0], b.breaks[-1], 161)[1:-1] for b in start.space.bases)
    k = start.at(np.stack(np.meshgrid(one, two, indexing="ij"), axis=-1), 1)
    x, normals = k.position.reshape(-1, 3), k.normal.reshape(-1, 3)
    axes = []
    for i, each in enumerate(particles):
        distance = np.linalg.norm(x - np.array(each.center), axis=1)
        nearest = int(distance.argmin())
        gap = float(distance[nearest]) - each.radius
        check_reach(i, each, gap, length)
        # in a mirror plane of the particle's own the sample may lie on either side
        axis = np.where(np.abs(each.center) > 1e-9 * length, -normals[nearest], 0.0)
        axes.append(axis / np.linalg.norm(axis))
    return np.array(axes)


def check_reach(i: int, particle: Sphere, gap: float, length: float) -> None:
    """Refuse a particle whose gap to the start is wider than a meniscus.

    Raises
    ------
    SceneError
    """
    if gap > FAR * length:
        raise SceneError(
            f"particle[{i}].center = {list(particle.center)}: {gap:g} away from the droplet's "
            "surface, farther than a meniscus reaches; move it to the surface"
        )


def mirrored_model(particles: Sequence[Sphere], smallest: Model, *, pairs: bool = False) -> Model:
    """The smallest model that particles have, none smaller than another's: with all of them in its
    mirror planes, or, if ``pairs`` are as good, images of each other.

    A patch with its pole in a particle is not symmetric to a pair. Mirror planes of the models:
    y = 0, then x = 0, then x = y.

    Parameters
    ----------
    particles : in the droplet's scale.
    """
    centers = np.array([each.center for each in particles])
    kinds = np.array([(each.radius, each.contact_angle) for each in particles])
    kept = 0
    for image in (centers * [1, -1, 1], centers * [-1, 1, 1], centers[:, [1, 0, 2]]):
        away = np.abs(image[:, None] - centers).max(axis=-1)
        away += np.where((kinds[:, None] == kinds).all(axis=-1), 0.0, np.inf)
        if float((away.min(axis=1) if pairs else away.diagonal()).max()) > 1e-9:
            break
        kept += 1
    return MODELS[min(kept, MODELS.index(smallest))]
