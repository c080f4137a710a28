"""Starts of sheets: a funnel on a particle, a spherical cap in a circle, a bulge in a square."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..solids import Sphere
from ..splines import Grading, Space, points_of
from ..surface.ring import (
    axisymmetric,
    circle,
    drop_space,
    meridian_interpolation,
    ring_space,
    square,
)
from ..surface.shapes import sheet as flat_square
from ..surface.surface import Surface
from .liquid import Mesh
from .profiles import funnel


def sheet_space(particle: Sphere | None, boundary: str, mesh: Mesh) -> Space:
    if particle is not None:
        corners = boundary == "square"
        return ring_space(mesh.space, mesh.degree, mesh.elements, angle=1.0, corners=corners)
    if boundary == "circle":
        return drop_space(mesh.space, mesh.degree, mesh.elements)
    kind = "bspline" if mesh.space == "nurbs" else mesh.space
    return flat_square(1.0, elements=mesh.elements, degree=mesh.degree, space=kind).space


def sheet_start(
    particle: Sphere | None,
    size: float,
    boundary: str,
    mesh: Mesh,
    curvature: float,
    volume: float | None,
) -> Surface:
    """A funnel on the particle, a spherical cap in the circle, a bulge in the square."""
    space, half = sheet_space(particle, boundary, mesh), 0.5 * size
    if particle is not None:
        return _funnel(space, particle, half, boundary, curvature)
    if boundary == "circle":
        depth = _cap_depth(curvature * half, None if volume is None else volume / half**3)
        return _cap(space, half, half * depth)
    y, x = np.moveaxis(2.0 * space.abscissae - 1.0, -1, 0)
    # a uniform load bends the unit square by 0.0737 of it in the middle; the bulge holds 4/9
    depth = 0.0737 * curvature * size**2 if volume is None else 9.0 / 4.0 * volume / size**2
    z = -np.clip(depth, -half, half) * (1.0 - x**2) * (1.0 - y**2)
    net = np.stack([half * x, half * y, z], axis=-1)
    return Surface(space, net.reshape(-1, 3))


def _funnel(
    space: Space, particle: Sphere, half: float, boundary: str, curvature: float
) -> Surface:
    """The sheet of small slopes from its circle on the sphere to the rim."""
    r, (x, y, _) = particle.radius, particle.center
    profile = funnel(particle, half, curvature)
    ring = circle(space.bases[0])
    outer = half * ring if boundary == "circle" else half * square(space.bases[0])
    inner = np.array([x, y, 0.0]) + r * profile.edge * ring
    points, matrix = meridian_interpolation(space)
    sag = r * profile.height(profile.edge + (profile.rim - profile.edge) * points)
    values = np.stack([1.0 - points, points, sag], axis=1)
    first, second, height = np.linalg.solve(matrix, values).T[:, :, None]
    up = np.array([0.0, 0.0, 1.0])
    net = inner[:, None] * first + outer[:, None] * second + height * up
    return Surface(space, points_of(space, net))


def sheet_grading(surface: Surface, size: float) -> Grading:
    """Shorter steps near the particle, where the sheet falls like a logarithm; 0.8 balances the
    errors of round and square rims (docs/results/sheet_and_particle.md)."""
    inner = surface.net[:, 0, :2]
    radius = np.linalg.norm(inner - inner.mean(axis=0), axis=1).mean()
    if not radius > 0:
        raise SceneError("start: its inner edge is a point; give it a ring round the particle")
    rate = 0.8 * np.log(0.5 * size / radius)
    return Grading(float(rate / np.expm1(rate))) if rate > 0 else Grading()


def _cap_depth(curvature: float, volume: float | None) -> float:
    """Depth over rim radius of the spherical cap of a pressure over tension, or of a volume."""
    if volume is not None:
        # pi h (3 + h^2) / 6 = V
        return float(2.0 * np.sinh(np.arcsinh(3.0 * volume / np.pi) / 3.0))
    return float(np.tan(0.5 * np.arcsin(np.clip(0.5 * curvature, -1.0, 1.0))))


def _cap(space: Space, rim: float, depth: float) -> Surface:
    """Spherical cap that hangs below its rim; the ring runs clockwise, so the normal points down.

    Depth and rim radius give the opening: ``tan(turn / 2) = depth / rim``.
    """
    turn = 2.0 * np.arctan(depth / rim)

    def profile(t: Array) -> tuple[Array, Array, Array]:
        angle = (1.0 - t) * turn
        over_sine = turn / np.sin(turn) if depth else 1.0
        r = rim * (1.0 - t) * np.sinc(angle / np.pi) * over_sine
        rise = 0.5 * (1.0 - t) * angle * np.sinc(0.5 * angle / np.pi) ** 2 * over_sine
        return r, rim * rise - depth, -rim * np.cos(angle) * over_sine

    counterclockwise = axisymmetric(space, profile)
    return counterclockwise.moved(counterclockwise.points * [1.0, -1.0, 1.0])
