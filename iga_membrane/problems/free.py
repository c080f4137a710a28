"""A free droplet: it touches nothing but a particle, which carries it like a substrate.

Its frame has its origin at the world's and the axis z from the particle to there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..initial.profiles import drop_on_sphere
from ..solids import Plane, Sphere
from .recipe import Recipe
from .scene import Scene

HOLDS = ("none", "xyz")


def seat_of(particles: Sequence[Sphere], hold: str) -> Sphere:
    """The particle that carries a free droplet, the first of two that it bridges.

    Raises
    ------
    SceneError
        None or more than two particles, two and a hold, one about the origin or moving without a
        hold, a hold along some axes only.
    """
    if len(particles) not in (1, 2):
        raise SceneError(
            f"particle: {len(particles)} given; a free droplet is carried by one or bridges two, "
            "more are not available yet: give fewer, or a substrate"
        )
    particle = particles[0]
    if len(particles) == 2:
        if hold != "none":
            raise SceneError(f'droplet.hold = "{hold}": two particles hold a droplet; leave it out')
        return replace(particle, motion="fixed")
    if not np.linalg.norm(particle.center) > 0.0:
        raise SceneError(
            "particle[0].center = [0, 0, 0]: a free droplet lies about the origin; put the "
            "particle beside it"
        )
    if particle.motion != "fixed" and hold == "none":
        raise SceneError(
            f'particle[0].motion = "{particle.motion}": a free droplet follows its particle; hold '
            'it by droplet.hold = "xyz", or leave the motion out'
        )
    if hold not in HOLDS:
        raise SceneError(
            f'droplet.hold = "{hold}": a free droplet has no axes of its own; choose '
            + " or ".join(f'"{h}"' for h in HOLDS)
        )
    return replace(particle, motion="fixed")


def frame_of(particle: Sphere) -> Array:
    """(3, 3) columns are axes of which z points from a particle to the origin."""
    x, y, z = (-float(c) / float(np.linalg.norm(particle.center)) for c in particle.center)
    return Plane(90.0, normal=(x, y, z)).axes()


def pulled_by(particle: Sphere, length: float) -> float:
    """How much farther a particle is from the origin than where nothing holds a weightless droplet,
    of a length, whose centroid is there."""
    return float(np.linalg.norm(particle.center)) - _rest(particle, length)


def at_displacement(particle: Sphere, length: float, displacement: float) -> Sphere:
    """The same particle, farther out than there by a displacement."""
    distance = float(np.linalg.norm(particle.center))
    part = (_rest(particle, length) + displacement) / distance
    x, y, z = (part * c for c in particle.center)
    return replace(particle, center=(x, y, z), motion="fixed")


@dataclass(frozen=True)
class Displaced:
    """Scenes of a free droplet with its particle farther out.

    Attributes
    ----------
    recipe : of the scene; particle : where it is in the end; length : of the droplet.
    """

    recipe: Recipe
    particle: Sphere
    length: float

    def __call__(self, displacement: float) -> Scene:
        moved = at_displacement(self.particle, self.length, displacement)
        return self.recipe.scene(particles=[moved])


def _rest(particle: Sphere, length: float) -> float:
    """Distance from a particle's centre to the centroid of a weightless droplet on it.

    It is a ball's part above the level of the line less the particle's. The first moment of such a
    part about its ball's centre is ``pi a^4 / 4``, with the line's radius a, the same for both.
    """
    volume, r = 4.0 / 3.0 * np.pi * length**3, particle.radius
    polar, cap = drop_on_sphere(particle.contact_angle, r, volume)
    level = r * np.cos(polar)
    middle = level - cap.radius * np.cos(cap.turn)
    above = volume + np.pi * r**3 * (2 + np.cos(polar)) * (1 - np.cos(polar)) ** 2 / 3
    return float(middle * above / volume)
