"""A droplet that bridges two solids, particles or a plane and a particle: its membrane lies between
their contact lines.

Its frame has the axis z from the first solid to the second and its origin where the first one meets
it. It starts from the toroid of least energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..dofs.boundary_conditions import Fixed, Sliding, Support
from ..errors import SceneError
from ..initial.toroid import End, least_energy_toroid
from ..solids import Plane, Solid, Sphere
from ..solids.disc import Disc
from ..surface.ring import axisymmetric, ring_space
from ..terms import LineTerm, PlaneContactLine, Scale, SphereContactLine
from .recipe import Recipe
from .scene import Scene
from .smooth_foot import rest_of, rim_line
from .spec import BALL, Foot, Question, sector_of
from .wet_rims import WetRims

CLOSE = 0.5
"""Gap between two solids over a droplet's length across which it bridges them easily."""
SMALL = 0.15
"""Radius of a particle on a plane's droplet, over the droplet's length, below which elements must
crowd round it: from there on the force differs by 1e-6 between 20 and 40 elements here."""
CENTERED = 1e-9
"""Distance of a particle from a plane's axis, over its radius, that is none."""

Ends = tuple[Plane | Sphere, Plane | Sphere]
"""The solids that a bridge joins, from the frame's origin upwards."""


def ends_of(
    substrate: Solid | None, particles: Sequence[Sphere], contact_line: str, length: float
) -> Ends | None:
    """The solids that a droplet of a length bridges: two particles, or a plane and a particle on
    its axis that is not small and on which the membrane may end; else None."""
    if substrate is None and len(particles) == 2:
        return particles[0], particles[1]
    if not isinstance(substrate, Plane) or len(particles) != 1:
        return None
    (particle,) = particles
    conforming = contact_line == "conforming" or (
        contact_line == "auto" and particle.motion == "fixed"
    )
    x, y, _ = np.subtract(particle.center, substrate.point) @ substrate.axes()
    centered = float(np.hypot(x, y)) <= CENTERED * particle.radius
    large = particle.radius >= SMALL * length and substrate.contact_angle < 180.0
    return (substrate, particle) if centered and conforming and large else None


def frame_of(ends: Ends) -> tuple[tuple[float, float, float], Array]:
    """Origin and axes of a bridge."""
    first, second = ends
    if isinstance(first, Plane):
        return first.point, first.axes()
    way = (
        -second.unit_normal()
        if isinstance(second, Plane)
        else np.subtract(second.center, first.center)
    )
    x, y, z = (float(c) for c in way / np.linalg.norm(way))
    axes = Plane(90.0, normal=(x, y, z)).axes()
    x, y, z = (float(c) for c in np.array(first.center) + first.radius * axes[:, 2])
    return (x, y, z), axes


def gap_between(ends: Ends) -> float:
    """Shortest distance between two solids."""
    (origin, axes), second = frame_of(ends), ends[1]
    if isinstance(second, Plane):
        return float(np.subtract(second.point, origin) @ axes[:, 2])
    return float(np.subtract(second.center, origin) @ axes[:, 2]) - second.radius


def at_gap(ends: Ends, gap: float) -> Sphere:
    """The second solid, a sphere, at another distance from the first."""
    (origin, axes), second = frame_of(ends), ends[1]
    assert isinstance(second, Sphere)
    x, y, z = np.array(origin) + (gap + second.radius) * axes[:, 2]
    return replace(second, center=(float(x), float(y), float(z)))


@dataclass(frozen=True)
class AtGap:
    """Scenes of two solids at other gaps.

    Attributes
    ----------
    recipe : of the scene; ends : its two solids.
    """

    recipe: Recipe
    ends: Ends

    def __call__(self, gap: float) -> Scene:
        particles = self.recipe.arguments["particles"]
        return self.recipe.scene(particles=[*particles[:-1], at_gap(self.ends, gap)])


def easy_gap(parts: Question, ends: Ends) -> float | None:
    """The gap from which a wider one is approached where its own start fails, or None if this one
    is no wider.

    Notes
    -----
    Solids that the liquid draws together it bridges easily when they are close. A drop that stands
    up on the first would have to be crushed for that; on it the second floats, where a level
    surface meets it at its contact angle, ``r (1 + cos(theta))`` deep.
    """
    scale, (first, second), gap = parts.scale, ends, gap_between(ends)
    if gap <= CLOSE * scale.length:
        return None
    if isinstance(second, Plane):
        return CLOSE * scale.length  # a plane floats nowhere
    rest = rest_of(first, parts.liquid, scale, parts.down)
    top = scale.length * (rest.lift + float(rest.pancake(np.ones(1))[1][0]))
    deep = 1.0 + float(np.cos(np.radians(second.contact_angle)))
    floating = top - second.radius * deep
    return max(near for near in (CLOSE * scale.length, floating) if near < gap)


def bridge(parts: Question, ends: Ends) -> Foot:
    """The skin of a droplet between two solids.

    Raises
    ------
    SceneError
        A start, a penalty, or another kind of contact line.
    """
    _check_bridge(parts, ends)
    mesh, scale, gamma = parts.asked.mesh(), parts.scale, parts.liquid.surface_tension
    level = gap_between(ends) / scale.length
    low, high = (
        End.of(_local(scale, solid, height), side)
        for solid, height, side in zip(ends, (0.0, level), (1.0, -1.0), strict=True)
    )
    arc = least_energy_toroid(low, high, BALL)
    start = axisymmetric(ring_space(mesh.space, mesh.degree, mesh.elements), arc)
    lines = [_line(gamma, ends[0], "xi2=0", scale.axes[:, 2], 0.0)]
    lines.append(_line(gamma, ends[1], "xi2=1", -scale.axes[:, 2], gap_between(ends)))
    surface, edges = start.moved(scale.to_world(start.points)), ("xi2=0", "xi2=1")
    wet = tuple(
        (edge, _local(scale, solid, height), side)
        for edge, solid, height, side in zip(edges, ends, (0.0, level), (1.0, -1.0), strict=True)
        if solid.contact_angle == 0.0 and not isinstance(solid, Disc)
    )
    supports: list[Support] = [
        Fixed(edge)
        if solid.contact_angle == 0.0 or isinstance(solid, Disc)
        else Sliding(edge, level=height)
        if isinstance(solid, Plane)
        else Sliding(edge, solid)
        for edge, solid, height in zip(edges, ends, (0.0, gap_between(ends)), strict=True)
    ]
    sector = sector_of(mesh, parts.bond)
    rims = WetRims(wet) if wet else None
    return Foot(surface, sector, mesh, lines, supports, free_edge=rims)


def _check_bridge(parts: Question, ends: Ends) -> None:
    """Refuse what a bridge does not have, and ends that overlap."""
    if parts.start is not None or parts.law.penalty is not None:
        raise SceneError("particle: a droplet between two solids needs its own start, no penalty")
    if parts.contact_line not in ("auto", "conforming"):
        raise SceneError(
            f'solver.contact_line = "{parts.contact_line}": between two particles it is '
            '"conforming"; leave it out'
        )
    gap = gap_between(ends)
    if isinstance(ends[0], Plane) and isinstance(ends[1], Sphere) and gap < -1e-9 * ends[1].radius:
        raise SceneError(
            f"particle[0].center = {list(ends[1].center)}: {ends[1].radius + gap:g} above the "
            f"plane, less than its radius {ends[1].radius:g}: it reaches {-gap:.3g} into the "
            "substrate"
        )
    if parts.bond[:2].any() and any(solid.contact_angle == 0.0 for solid in ends):
        raise SceneError(
            "contact_angle = 0: not available yet where gravity leans across the axis of a bridge; "
            "turn it along the axis, or take an angle > 0"
        )


def _local(scale: Scale, solid: Plane | Sphere, level: float) -> Plane | Sphere:
    """A solid in the scale; a plane lies at a level."""
    if isinstance(solid, Disc):
        return replace(solid, point=(0.0, 0.0, level), radius=solid.radius / scale.length)
    if isinstance(solid, Plane):
        return Plane(solid.contact_angle, (0.0, 0.0, level))
    return scale.local_sphere(solid)


def _line(gamma: float, solid: Plane | Sphere, edge: str, toward: Array, level: float) -> LineTerm:
    """The contact line on a solid, whose liquid lies in a direction; a plane lies at a level."""
    if isinstance(solid, Disc):
        return rim_line(gamma, solid, edge, level)
    if isinstance(solid, Plane):
        return PlaneContactLine(gamma, solid.contact_angle, edge, level=level)
    x, y, z = (float(a) for a in toward)
    return SphereContactLine(gamma, solid, edge, toward=(x, y, z))
