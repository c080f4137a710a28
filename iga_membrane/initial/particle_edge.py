"""A droplet on a plane whose membrane ends on a particle: a ring between the two contact lines.

The rings are those of :mod:`.round_patch`, ``|zeta| = 1`` the line on the plane; they end at the
particle's line, and elements are about square in ``log |zeta|``.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..solids import Sphere
from ..splines import Space, ring_angles
from ..surface.closed import Meridian
from ..surface.reparametrize import interpolated
from ..surface.ring import meridian_interpolation, ring_space
from ..surface.surface import Surface
from .liquid import Mesh
from .round_patch import (
    CLOSE,
    COARSEST,
    FINEST,
    closeness,
    meniscus_at,
    nearest,
    place_on,
    rings,
    stretch,
)

ROUND = 56
"""Elements round a particle at least."""
ROOM = 2.0
"""Height over a particle's radius above which a droplet starts with the whole meniscus."""
LARGEST = 0.7
"""Ring of a particle's line at most."""


def ending_on(meridian: Meridian, particle: Sphere, space: Space) -> Surface:
    """A droplet of revolution on the plane z = 0, bent to a particle's meniscus, in a space of
    :func:`ending_space`.

    Parameters
    ----------
    meridian, particle : in the droplet's scale.
    """
    points, matrix = meridian_interpolation(space)
    pole, spot = _place(meridian, particle)
    size = spot**points
    x = rings(meridian, pole, ring_angles(space), size)
    x[:, 0, 2] = 0.0
    center, r = np.array(particle.center), particle.radius
    seat, toward = seat_of(meridian, particle)
    bent = meniscus_at(meridian, particle)
    distance = np.linalg.norm(x - seat, axis=-1) / r
    # a plane close by leaves no room for the meniscus
    room = min(1.0, float(seat[2]) / (ROOM * r))
    flat = np.arccos(np.clip((seat - center) @ toward / r, -LARGEST, LARGEST))
    polar = room * bent.polar + (1.0 - room) * flat
    rise = room * r * bent.through(distance) * (1.0 - size**2)
    x += rise[..., None] * toward
    away = x[:, -1] - center
    across = away - (away @ toward)[:, None] * toward
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    line = center + r * (np.sin(polar) * across + np.cos(polar) * toward)
    x += (line - x[:, -1])[:, None] * (points**2)[:, None]
    return interpolated(space, x, matrix)


def seat_of(meridian: Meridian, particle: Sphere) -> tuple[Array, Array]:
    """Point of a droplet that is nearest to a particle, and the direction into the liquid there."""
    k, (x, y, _) = nearest(meridian, particle), particle.center
    if x == y == 0.0:
        return np.array([0.0, 0.0, meridian.z[k]]), np.array([0.0, 0.0, -1.0])
    aside = np.array([x, y]) / np.hypot(x, y)
    seat = np.array([*(meridian.r[k] * aside), meridian.z[k]])
    across, up = meridian.normal[k]
    return seat, -np.array([*(across * aside), up])


def ending_space(meridian: Meridian, particle: Sphere, mesh: Mesh, sectors: int) -> Space:
    """Ring patch for a droplet that ends on a particle; ``xi2`` runs from the plane (0) to the
    particle (1).

    Parameters
    ----------
    meridian, particle : in the droplet's scale.
    mesh : its ``elements`` lie between the lines; -1 chooses.
    sectors : the ring's elements are a multiple of it.
    """
    pole, spot = _place(meridian, particle)
    aspect = 2.0 * np.pi / -np.log(spot)
    finer = float(np.clip(CLOSE / closeness(pole), 1.0, FINEST))
    around = max(finer * ROUND, 2.0 * np.pi * meridian.r[0] / COARSEST)
    along = mesh.elements if mesh.elements > 0 else int(np.ceil(around / aspect))
    around = int(np.ceil(along * aspect / sectors)) * sectors
    return ring_space("bspline", mesh.degree, along, sectors, around=around)


def _place(meridian: Meridian, particle: Sphere) -> tuple[complex, float]:
    """Conformal place of a particle on a droplet, and ``|zeta|`` of its line."""
    pole = place_on(meridian, particle)
    line = particle.radius * meniscus_at(meridian, particle).edge
    return pole, min(LARGEST, line / stretch(meridian, pole, 0.0))
