"""A droplet on a plane as a patch whose pole is in a particle.

A droplet on a plane is a disc. The map ``zeta = (w - b) / (1 - b* w)`` of the unit disc, ``w`` the
conformal place on the droplet (1 on its contact line) and ``b`` that of a particle, keeps the line
a circle and makes the particle's another: rings of ``zeta`` fit both, and elements shrink towards
the particle by themselves. From the particle to the line the azimuth of ``zeta`` turns into that
of ``w``, so that the line is divided about evenly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..solids import Sphere
from ..splines import Space, ring_angles
from ..surface.closed import Meridian
from ..surface.reparametrize import interpolated
from ..surface.ring import drop_space, meridian_interpolation
from ..surface.surface import Surface
from .liquid import Mesh
from .profiles import Funnel, Pancake, meniscus

ROUND, ALONG = 48, 14
"""Elements round a particle, and from the droplet's line to the particle's at least."""
CLOSE = 0.4
"""Closeness of the pole to the droplet's line below which that line is
divided more finely there, and the whole mesh is finer by as much."""
FINEST = 2.2
"""The same at most."""
COARSEST = 0.12
"""Length of an element at the droplet's line, over the droplet's length, at most."""
ACROSS = 3.0
"""Elements at least across the radius of a line that does not hold the patch's pole."""
NARROW = 0.1
"""Radius of a line over its particle's that the mesh is made for at least."""

SAMPLES = 4001
"""Points along a meridian."""


@dataclass(frozen=True, eq=False)
class RoundPatch:
    """Where the control points of a droplet lie.

    Attributes
    ----------
    space : ring patch closed by a pole.
    pole : conformal place of the pole on the droplet.
    spot : ``|zeta|`` of the particle's line; span : ``arcsinh(1 / spot)``.
    """

    space: Space
    pole: complex
    spot: float
    span: float

    def surface(self, meridian: Meridian) -> Surface:
        """A droplet of revolution on the plane z = 0."""
        space = self.space
        points, matrix = meridian_interpolation(space)
        size = self.spot * np.sinh(self.span * (1.0 - points))
        values = rings(meridian, self.pole, ring_angles(space), size)
        values[:, 0, 2] = 0.0
        # in its place the derivative at the pole, against which the ring shrinks
        step = 1e-3 * self.spot
        ring = _droplet(meridian, self.pole, step * np.exp(1j * ring_angles(space)))
        top = _droplet(meridian, self.pole, np.zeros(1))
        values[:, -2] = (top - ring) * (self.spot * self.span / step)
        return interpolated(space, values, matrix)


def rings(meridian: Meridian, pole: complex, azimuth: Array, size: Array) -> Array:
    """(n1, n2, 3) points of a droplet on rings ``|zeta| = size`` (n2,) round a pole, at the azimuth
    of ``zeta`` (n1,) near it."""
    aim = pole / abs(pole) if pole else 1.0
    half = 0.5 * (azimuth - np.angle(aim))[:, None]
    # Moebius maps act on half the azimuth's tangent by a factor
    factor = max(closeness(pole), CLOSE) ** -size
    turn = aim * np.exp(2j * np.arctan2(factor * np.sin(half), np.cos(half)))
    return _droplet(meridian, pole, size * turn)


def round_patch(
    meridian: Meridian, particles: Sequence[Sphere], mesh: Mesh, sectors: int
) -> RoundPatch:
    """The patch for a droplet, its pole in the particle with the smallest contact line.

    Parameters
    ----------
    meridian, particles : in the droplet's scale.
    mesh : its ``elements`` lie between the droplet's line and the pole; -1 chooses.
    sectors : the ring's elements are a multiple of it.
    """
    places = [place_on(meridian, each) for each in particles]
    line = [_line(meridian, each) for each in particles]
    least = int(np.argmin(line))
    pole = places[least]

    def scale_at(zeta: complex) -> float:
        return stretch(meridian, pole, zeta)

    spot = min(0.5, line[least] / scale_at(0.0))
    span = float(np.arcsinh(1.0 / spot))
    along, outside = mesh.elements, 1.0 - np.arcsinh(1.0) / span
    if along < 0:
        finer = float(np.clip(CLOSE / closeness(pole), 1.0, FINEST))
        around = max(finer * ROUND, 2.0 * np.pi * meridian.r[0] / COARSEST)
        along = int(np.ceil(max(finer * ALONG / outside, around * span / (2.0 * np.pi))))
        for own, place in zip(line, places, strict=True):
            zeta = (place - pole) / (1.0 - np.conj(pole) * place)
            size = max(abs(zeta), spot) * scale_at(zeta) * span
            along = max(along, int(np.ceil(ACROSS * size / own)) if abs(zeta) else 0)
    around = int(np.ceil(along * 2.0 * np.pi / span / sectors)) * sectors
    space = drop_space("bspline", mesh.degree, along, sectors, around=around)
    return RoundPatch(space, pole, spot, span)


def stretch(meridian: Meridian, pole: complex, zeta: complex) -> float:
    """Length on a droplet over that of ``zeta``."""
    beside = 0.999 * zeta + 1e-4  # nearer to the middle of the disc
    one, other = _droplet(meridian, pole, np.array([zeta, beside]))
    return float(np.linalg.norm(one - other)) / abs(zeta - beside)


def closeness(pole: complex) -> float:
    """Of the pole to the droplet's line: 1 in the middle, 0 on the line."""
    return (1.0 - abs(pole)) / (1.0 + abs(pole))


def _droplet(meridian: Meridian, pole: complex, zeta: Array) -> Array:
    """(..., 3) points of a droplet at conformal places round a pole."""
    w = (zeta + pole) / (1.0 + np.conj(pole) * zeta)
    size = np.maximum(np.abs(w), 1e-12)
    r, z, _ = meridian(np.exp(meridian.log[0]) / size)
    turn = w / size
    return np.stack([r * turn.real, r * turn.imag, z], axis=-1)


def of_pancake(pancake: Pancake) -> Meridian:
    """From its contact line to a small circle at its top."""
    return _meridian(*pancake(np.linspace(0.0, 1.0, SAMPLES)[:-1]))


def of_droplet(surface: Surface) -> Meridian:
    """Mean meridian of a droplet on a ring patch closed by a pole."""
    ring, line = surface.space.bases
    t = np.linspace(line.breaks[0], line.breaks[-1], SAMPLES)[:-1]
    azimuth = np.linspace(ring.breaks[0], ring.breaks[-1], 17)[:-1]
    x = surface.at(np.stack(np.meshgrid(azimuth, t, indexing="ij"), axis=-1), 1).position
    middle = x[:, 0, :2].mean(axis=0)
    return _meridian(
        np.linalg.norm(x[..., :2] - middle, axis=-1).mean(axis=0), x[..., 2].mean(axis=0)
    )


def _meridian(r: Array, z: Array) -> Meridian:
    slope = np.gradient(np.stack([r, z], axis=1), axis=0)
    normal = np.stack([slope[:, 1], -slope[:, 0]], axis=1)
    return Meridian(r, z, normal / np.linalg.norm(normal, axis=1, keepdims=True))


def meniscus_at(meridian: Meridian, particle: Sphere) -> Funnel:
    """The meniscus of small slopes where a droplet is nearest to a particle."""
    k = nearest(meridian, particle)
    x, y, z = particle.center
    beside = np.array([meridian.r[k] - np.hypot(x, y), meridian.z[k] - z])
    return meniscus(particle, float(beside @ meridian.normal[k]), 1.0)


def _line(meridian: Meridian, particle: Sphere) -> float:
    """Estimated radius of the contact line on a particle."""
    return particle.radius * max(meniscus_at(meridian, particle).edge, NARROW)


def nearest(meridian: Meridian, particle: Sphere) -> int:
    """Place on a meridian that is nearest to a particle."""
    x, y, z = particle.center
    return int(np.hypot(meridian.r - np.hypot(x, y), meridian.z - z).argmin())


def place_on(meridian: Meridian, particle: Sphere) -> complex:
    """Conformal place of the point of a droplet that is nearest to a particle, 0 at the top."""
    x, y, _ = particle.center
    if x == y == 0.0:
        return 0j  # the meridian ends beside it
    size = float(meridian.log[0] - meridian.log[nearest(meridian, particle)])
    return complex(np.exp(size + 1j * np.arctan2(y, x)))
