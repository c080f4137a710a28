"""Scenes whose particles move: along which lines, and the scenes with them fixed on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..solids import Plane, Sphere
from .recipe import Recipe
from .scene import FreeParticles, Scene

VERTICAL = (0.0, 0.0, 1.0)


def fixed(particles: Sequence[Sphere]) -> tuple[Sphere, ...]:
    """The same particles, held where they are."""
    return tuple(replace(each, motion="fixed") for each in particles)


def check_fixed(substrate: object) -> None:
    """Refuse a substrate that moves.

    Raises
    ------
    SceneError
    """
    if isinstance(substrate, Sphere) and substrate.motion != "fixed":
        raise SceneError(
            f'substrate.motion = "{substrate.motion}": a substrate is fixed; leave it out, or make '
            "the sphere a particle"
        )


def moving(
    scene: Scene,
    particles: Sequence[Sphere],
    toward: Array,
    tension: float,
    recipe: Recipe,
    argument: str = "particles",
) -> Scene:
    """The scene, with those of its particles free to move whose motion says so.

    Parameters
    ----------
    scene : with all its particles fixed.
    toward : (n, 3) unit vectors from the particles into the liquid.
    recipe : of the same scene with its particles fixed; argument : of it that is theirs.

    Raises
    ------
    SceneError
        A particle that rests where there is no plane.
    """
    which = [i for i, each in enumerate(particles) if each.motion != "fixed"]
    if not which:
        return scene
    lines, least = [], []
    for i in which:
        each, plane = particles[i], scene.substrate
        stop = -np.inf
        if each.motion == "resting":
            if not isinstance(plane, Plane):
                raise SceneError(
                    f'particle[{i}].motion = "resting": only on a plane; choose "vertical" or '
                    '"normal"'
                )
            stop = each.radius - float(plane.gap(np.array(each.center)))
        line = {
            "vertical": np.array(VERTICAL),
            "normal": -toward[i],
            "resting": np.array(plane.unit_normal() if isinstance(plane, Plane) else VERTICAL),
        }[each.motion]
        lines.append(line)
        least.append(stop)
    along, held = np.array(lines), fixed(particles)

    free = FreeParticles(
        np.array(which),
        along,
        np.array([particles[i].radius for i in which]),
        tension,
        -np.einsum("ki,ki->k", along, toward[which]),
        np.array(least),
        recipe,
        argument,
        held,
    )
    return replace(scene, free_particles=free)
