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


def check_convergence_and_balance(meshes, *, sideways):
    """Forces on three meshes, each half as fine again as the one before, settle at fourth order
    to 1 part in 10,000; both forces on the droplet balance at that order, to ``sideways``."""
    coarse, middle, fine = (pull(s)[[0, 2]] for s in meshes)
    first, last = np.abs(middle - coarse), np.abs(fine - middle)
    assert last.max() < 1e-4 * size(fine)
    assert size(last) < size(first) / 1.5**4
    # what holds the liquid is what the liquid does to the particle; the plane carries the rest
    across = [abs(s.hold_force[0] - pull(s)[0]) / size(pull(s)) for s in meshes]
    weight = BOND * UNIT_VOLUME
    upwards = [abs(s.contact["support_force"] - pull(s)[2] - weight) / weight for s in meshes]
    assert across[2] < sideways
    assert upwards[2] < 1e-5
    assert across[2] < across[0] / 2.25**4
    assert upwards[2] < upwards[0] / 2.25**4
