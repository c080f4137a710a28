"""A particle on a droplet on a plane, and what the liquid does to it."""

from functools import cache

import numpy as np
from helpers import UNIT_VOLUME

import iga_membrane as iga

BOND = 0.5
PLANE = iga.Plane(150.0)


@cache
def place(polar):
    """Point and normal of the droplet without particles at an angle from its top, seen from its
    half height, in the plane y = 0."""
    alone = iga.solve(iga.sessile_droplet(PLANE, volume=UNIT_VOLUME, gravity=BOND))
    k = alone.surface.grid(3, 2001, 1)
    x, normal = k.position[0], k.normal[0]
    r, z = np.hypot(x[:, 0], x[:, 1]), x[:, 2]
    nearest = np.abs(np.degrees(np.arctan2(r, z - 0.5 * alone.measures["height"])) - polar).argmin()
    sideways = np.hypot(*normal[nearest, :2])
    return np.array([r[nearest], 0.0, z[nearest]]), np.array([sideways, 0.0, normal[nearest, 2]])


def scene(*particles, hold="x", line="trimmed", **mesh):
    return iga.sessile_droplet(
        PLANE,
        volume=UNIT_VOLUME,
        gravity=BOND,
        hold=hold,
        particles=particles,
        contact_line=line,
        discretization=iga.Discretization(**mesh),
    )


def particle(polar=95.0, angle=90.0, radius=0.2, *, shift=(0.0, 0.0, 0.0)):
    return iga.Sphere(angle, radius, tuple((place(polar)[0] + shift).tolist()), 1.0)


@cache
def solved(polar=95.0, angle=90.0, radius=0.2, *, line="trimmed", **mesh):
    solution = iga.solve(scene(particle(polar, angle, radius), line=line, **mesh))
    assert solution.success, solution.message
    return solution


def pull(solution, which=0):
    """Force of liquid and membrane on a particle, without its weight."""
    forces = solution.forces[which]
    return forces.effective - forces.weight


def size(force):
    return np.linalg.norm(force)
