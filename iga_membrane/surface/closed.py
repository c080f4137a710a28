"""Closed surfaces of revolution on a pillow: nearly square elements everywhere.

The square goes to the sphere by the lemniscate sine, ``rho = sl(w (X + i Y))``, ``w = 1.311...``:
middle to the south pole, sides' middles to four points of the equator, corners to the north pole
(Peirce's quincuncial map). A meridian with ``d log |rho| = ds / r`` makes the whole map conformal.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..splines import Space, points_of

QUARTER = 1.3110287771460598
"""A quarter period of the lemniscate sine, ``K(m = 1/2) / sqrt(2)``."""


@dataclass(frozen=True, eq=False)
class Meridian:
    """A meridian from a flat foot to a flat top, both perhaps small.

    Attributes
    ----------
    r, z : (k,) from the foot's rim to the top's rim.
    normal : (k, 2) unit normals (r, z) out of the body.
    """

    r: Array
    z: Array
    normal: Array

    @cached_property
    def log(self) -> Array:
        """(k,) ``log |rho|``, 0 at the widest place."""
        step = np.hypot(np.diff(self.r), np.diff(self.z))
        middle = 0.5 * (self.r[1:] + self.r[:-1])
        log = np.concatenate([[0.0], np.cumsum(step / middle)])
        return np.asarray(log - log[self.r.argmax()])

    def __call__(self, size: Array) -> tuple[Array, Array, Array]:
        """``r, z, normal`` where ``|rho|`` is given; 1 at the widest place."""
        log = self.log
        with np.errstate(divide="ignore"):
            at = np.log(size)
        # beyond its ends the meridian goes on, flat, to the axis
        near = np.exp(np.minimum(np.minimum(at - log[0], log[-1] - at), 0.0))
        r, z = near * np.interp(at, log, self.r), np.interp(at, log, self.z)
        normal = np.stack([np.interp(at, log, n) for n in self.normal.T], axis=-1)
        normal[..., 0] *= near
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        return r, z, normal

    def size_at(self, radius: float) -> float:
        """``|rho|`` where the meridian below its widest place has a radius."""
        if radius <= self.r[0]:
            return float(np.exp(self.log[0]) * radius / self.r[0])
        below = slice(int(self.r.argmax()) + 1)
        return float(np.exp(np.interp(radius, self.r[below], self.log[below])))


@dataclass(frozen=True)
class Stretch:
    """Odd, smooth map of [-1, 1] to itself: equal steps to ``fine``, then ever longer ones.

    Attributes
    ----------
    fine : part of the parameter with equal steps.
    slope : of the map there, <= 1.
    """

    fine: float = 0.0
    slope: float = 1.0

    @property
    def last(self) -> float:
        """Slope at the ends."""
        return self.slope + 2.0 * (1.0 - self.slope) / (1.0 - self.fine)

    @property
    def aspect(self) -> float:
        """Of the elements in the middle of a side, across it over along it."""
        return self.last / self.slope

    def __call__(self, x: Array) -> Array:
        # the square goes on beyond its sides, point-symmetric about their middles
        folded = np.where(np.abs(x) > 1.0, np.sign(x) * 2.0 - x, x)
        t = np.maximum(np.abs(folded) - self.fine, 0.0) / (1.0 - self.fine)
        rise = (1.0 - self.slope) * (t - np.sin(np.pi * t) / np.pi)
        inside = np.sign(folded) * (self.slope * np.abs(folded) + rise)
        return np.asarray(np.where(np.abs(x) > 1.0, np.sign(x) * 2.0 - inside, inside))


def lemniscate_sine(x: Array, y: Array) -> Array:
    """``sl(QUARTER (x + i y))``, complex."""
    from scipy.special import ellipj

    def real(u: Array) -> tuple[Array, Array]:
        s, c, d, _ = ellipj(np.sqrt(2.0) * QUARTER * u, 0.5)
        return s / (d * np.sqrt(2.0)), c

    (s, c), (t, d) = real(x), real(y)
    # addition theorem; the denominator 1 - s^2 t^2 without cancellation
    below = c * c * (1.0 + s * s) + s * s * d * d * (1.0 + t * t)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((s * d * (1.0 + t * t) + 1j * t * c * (1.0 + s * s)) / below)


def inverse_lemniscate_sine(value: float) -> float:
    """``x`` with ``sl(QUARTER x) = value``, for values in [0, 1]."""
    x = np.linspace(0.0, 1.0, 4001)
    return float(np.interp(value, lemniscate_sine(x, np.zeros_like(x)).real, x))


def closed_surface(space: Space, meridian: Meridian, stretch: Stretch) -> tuple[Array, Array]:
    """Control points (count, 3) and directions (count, 3) of a surface of revolution.

    The net is that of a square with ``xi1`` along y and ``xi2`` along x, so the normal points out.
    """
    one, two = space.bases
    y, x = stretch(one.abscissae)[:, None], stretch(two.abscissae)[None, :]
    rho = lemniscate_sine(*np.broadcast_arrays(x, y))
    size = np.abs(rho)
    finite = np.where(np.isfinite(size), size, 1e300)
    r, z, normal = meridian(finite)
    with np.errstate(invalid="ignore"):
        turn = np.where(size > 0, rho / np.where(size > 0, size, 1.0), 0.0)
    turn = np.where(np.isfinite(turn), turn, 0.0)
    net = np.stack([r * turn.real, r * turn.imag, z], axis=-1)
    field = np.stack([normal[..., 0] * turn.real, normal[..., 0] * turn.imag, normal[..., 1]], -1)
    return points_of(space, net), points_of(space, field)
