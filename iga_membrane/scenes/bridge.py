"""A droplet that touches nothing but two particles: a bridge between their contact lines.

Its frame has its origin in the first particle and the axis z towards the second. It starts from the
barrel ``r = linear + bulge (1 - s^2)`` between circles round the axis that has the least energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..solids import Plane, Sphere
from ..splines.quadrature import gauss
from ..surface.ring import axisymmetric, ring_space
from ..surface.supports import Sector, Sliding
from ..terms import SphereContactLine
from .question import Foot, Question, sector_of

CLOSE = 0.5
"""Gap between two particles over a droplet's length across which its bridge is easily solved."""
WIDEST = 175.0
"""Polar angle, degrees, of the start's circles at most."""


def axes_between(particles: Sequence[Sphere]) -> Array:
    """(3, 3) columns are axes of which z points from the first particle to the second."""
    way = np.subtract(particles[1].center, particles[0].center)
    x, y, z = (float(c) for c in way / np.linalg.norm(way))
    return Plane(90.0, normal=(x, y, z)).axes()


def moved_apart(particles: Sequence[Sphere], displacement: float) -> Sphere:
    """The second particle, farther from the first by a displacement."""
    x, y, z = np.array(particles[1].center) + displacement * axes_between(particles)[:, 2]
    return replace(particles[1], center=(float(x), float(y), float(z)))


def room_between(particles: Sequence[Sphere], length: float) -> float:
    """How much farther apart two particles are than where a droplet of a length bridges them
    easily."""
    one, two = particles
    away = float(np.linalg.norm(np.subtract(two.center, one.center)))
    return max(0.0, away - one.radius - two.radius - CLOSE * length)


def bridge(parts: Question, particles: Sequence[Sphere]) -> Foot:
    """The skin of a droplet between two particles.

    Raises
    ------
    SceneError
        A start, a penalty, or another kind of contact line.
    """
    if parts.start is not None or parts.law.penalty is not None:
        raise SceneError("particle: a droplet between two needs its own start and no penalty")
    if parts.contact_line not in ("auto", "conforming"):
        raise SceneError(
            f'solver.contact_line = "{parts.contact_line}": between two particles it is '
            '"conforming"; leave it out'
        )
    mesh, scale, gamma = parts.asked.mesh(), parts.scale, parts.liquid.surface_tension
    low, high = (scale.local_sphere(each) for each in particles)
    (z0, z1), (r0, r1), bulge = _barrel(low, high, 4.0 * np.pi / 3.0)

    def profile(t: Array) -> tuple[Array, Array, Array]:
        s = 2.0 * t - 1.0
        r = r0 + (r1 - r0) * t + bulge * (1.0 - s * s)
        return r, z0 + (z1 - z0) * t, r1 - r0 - 4.0 * bulge * s

    space = ring_space(mesh.space, mesh.degree, mesh.elements)
    start = axisymmetric(space, profile)
    x, y, z = (float(a) for a in scale.axes[:, 2])
    lines = [
        SphereContactLine(gamma, particles[0], "xi2=0", toward=(x, y, z)),
        SphereContactLine(gamma, particles[1], "xi2=1", toward=(-x, -y, -z)),
    ]
    supports = [Sliding(line.edge, line.sphere) for line in lines]
    surface = start.moved(scale.to_world(start.points))
    # it may give way sideways, so that no smaller model than half tells whether it is stable
    sector = sector_of(mesh, parts.bond)
    if mesh.model is None and sector.model != "full":
        sector = Sector("full" if parts.bond[0] else "half")
    return Foot(surface, sector, mesh, lines, supports)


def _barrel(
    low: Sphere, high: Sphere, volume: float
) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Heights and radii of the circles, and the bulge, of the barrel of least energy."""
    polar = np.radians(np.linspace(2.0, WIDEST, 120))
    one, two = polar[:, None], polar[None, :]
    z0 = low.center[2] + low.radius * np.cos(one)
    z1 = high.center[2] - high.radius * np.cos(two)
    r0, r1 = low.radius * np.sin(one), high.radius * np.sin(two)
    height = z1 - z0
    held = volume + _cap(low.radius, one) + _cap(high.radius, two)
    # mean of (linear + bulge (1 - s^2))^2 over the height
    square = (r0**2 + r0 * r1 + r1**2) / 3.0
    half = (r0 + r1) / 3.0
    with np.errstate(divide="ignore", invalid="ignore"):
        root = half**2 - 8.0 / 15.0 * (square - held / (np.pi * height))
        bulge = (np.sqrt(root) - half) * 15.0 / 8.0
    t, w = gauss(12)
    s = 2.0 * t - 1.0
    r = r0[..., None] + (r1 - r0)[..., None] * t + bulge[..., None] * (1.0 - s * s)
    slope = (r1 - r0)[..., None] - 4.0 * bulge[..., None] * s
    area = 2.0 * np.pi * (r * np.hypot(slope, height[..., None])) @ w
    wet = [
        2.0
        * np.pi
        * ball.radius**2
        * (1.0 - np.cos(angle))
        * np.cos(np.radians(ball.contact_angle))
        for ball, angle in ((low, one), (high, two))
    ]
    energy = area - wet[0] - wet[1]
    thick = (r.min(axis=-1) > 0.0) & (height > 0.0) & np.isfinite(energy)
    i, j = np.unravel_index(np.where(thick, energy, np.inf).argmin(), energy.shape)
    return (
        (float(z0[i, 0]), float(z1[0, j])),
        (float(r0[i, 0]), float(r1[0, j])),
        float(bulge[i, j]),
    )


def _cap(radius: float, polar: Array) -> Array:
    return np.asarray(np.pi * radius**3 * (2 + np.cos(polar)) * (1 - np.cos(polar)) ** 2 / 3)
