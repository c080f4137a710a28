"""The axisymmetric profile of Young and Laplace nearest to points, by weighted least squares."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import Array, Mask
from ..errors import SceneError
from ..overview import brief_repr
from ..results.meridian import Meridian, meridian

FAR = 5.0
"""Distances beyond it, over their own standard deviation, are dust: of a thousand points of a clean
image none is so far."""
ROUNDS = 6
"""How often the weights follow the distances; they settle in 3."""
SETTLED = 1e-3
"""Change of the parts of the noise at which they have."""
EXACT = 1e-3
"""Part of an edge's error that is not along its row, of the variance, at least."""
BEYOND = 1.05
"""Depth of a meridian over that of the lowest point, so that the point has a foot on it."""


@dataclass(frozen=True, eq=False)
class Distances:
    """Points beside a profile.

    Attributes
    ----------
    off : (n,) distances, positive outside; slant : (n,) sine of the profile's inclination there.
    by : (n, parameters) derivatives of the distances.
    """

    off: Array
    slant: Array
    by: Array

    __repr__ = brief_repr


@dataclass(frozen=True)
class Profile:
    """A profile by its apex.

    Attributes
    ----------
    middle, apex : x of the axis; height of the apex above the base, a length.
    radius : of curvature at the apex.
    weight : weight per volume over the tension, per squared length; < 0 where the liquid hangs.
    base : height of the base line.
    """

    middle: float
    apex: float
    radius: float
    weight: float
    base: float = 0.0

    @property
    def bond(self) -> float:
        """Weight over tension in units of the radius at the apex."""
        return self.weight * self.radius**2

    def down_to(self, height: float) -> Meridian:
        """The meridian from the apex to a height."""
        return _meridian(self.bond, (self.apex - height) / self.radius)


_meridian = lru_cache(maxsize=8)(meridian)


def distances(profile: Profile, x: Array, y: Array, mirrored: Mask) -> Distances:
    """How far points (n,) are off a profile, with derivatives by its parameters: middle, apex,
    logarithm of the radius, logarithm of the weight, base.

    Parameters
    ----------
    mirrored : (n,) whether a point belongs to the profile's image below the base.
    """
    seen = np.where(mirrored, 2.0 * profile.base - y, y)
    side, size = np.sign(x - profile.middle), profile.radius
    u, v = np.abs(x - profile.middle) / size, (profile.apex - seen) / size
    m = _meridian(profile.bond, BEYOND * max(float(v.max()), 1e-3))
    k = ((u[:, None] - m.r) ** 2 + (v[:, None] - m.depth) ** 2).argmin(axis=1)
    turn, bend = m.turn[k], m.bend[k]
    du, dv = u - m.r[k], v - m.depth[k]
    along = du * np.cos(turn) + dv * np.sin(turn)
    out = du * np.sin(turn) - dv * np.cos(turn)
    # to the circle of curvature at the nearest sample, on which the foot lies
    past = along / (1.0 + bend * out)
    inside = (k > 0) & (k < len(m.s) - 1)
    past = np.where(inside, past, 0.0)
    off = out + np.where(inside, 0.5 * bend * along * past, 0.0)
    turn = turn + bend * past
    sine, cosine = np.sin(turn), np.cos(turn)
    r = m.r[k] + past * np.cos(turn)
    depth = m.depth[k] + past * np.sin(turn)
    by_bond = sine * m.by_bond[0, k] - cosine * m.by_bond[1, k]
    by = np.stack(
        [
            -side * sine,
            -cosine,
            -size * (sine * r - cosine * depth + 2.0 * profile.bond * by_bond),
            -size * profile.bond * by_bond,
            np.where(mirrored, 2.0 * cosine, 0.0),
        ],
        axis=1,
    )
    return Distances(size * off, np.abs(sine), by)


@dataclass(frozen=True, eq=False)
class Fit:
    """The profile nearest to points.

    Attributes
    ----------
    profile : it.
    free : numbers of its parameters that were sought, in the order of :func:`distances`.
    covariance : (free, free) of them.
    off : (n,) distances of all points; used : (n,) those that counted.
    """

    profile: Profile
    free: tuple[int, ...]
    covariance: Array
    off: Array
    used: Mask

    __repr__ = brief_repr


def nearest_profile(
    start: Profile, x: Array, y: Array, mirrored: Mask, free: tuple[int, ...]
) -> Fit:
    """The profile with the least sum of squared distances, each over its variance.

    Notes
    -----
    The edge of a row of pixels is wrong along the row (noise of the camera, row by row) and across
    the outline (focus, light): the variance of a distance is ``a sin^2 + b`` with the outline's
    inclination. Both parts are estimated from the distances, by the largest likelihood.

    Raises
    ------
    SceneError
        No profile is near the points.
    """
    used = np.ones(len(x), bool)
    across = 1.0
    profile = start
    for _ in range(ROUNDS):
        profile = _solved(profile, x[used], y[used], mirrored[used], free, across)
        found = distances(profile, x, y, mirrored)
        before, across = across, _across(found.off[used], found.slant[used])
        variance = _variance(found.slant, across)
        normal = found.off / np.sqrt(variance)
        width = 1.4826 * float(np.median(np.abs(normal[used])))
        kept = np.abs(normal) <= FAR * max(width, 1e-12 * profile.radius)
        same = bool((kept == used).all())
        used = kept
        if same and abs(across - before) < SETTLED:
            break
    jacobian = found.by[used][:, free] / np.sqrt(variance[used])[:, None]
    rest = float(np.sum(normal[used] ** 2)) / max(int(used.sum()) - len(free), 1)
    covariance = rest * np.linalg.pinv(jacobian.T @ jacobian)
    return Fit(profile, free, covariance, found.off, used)


def _solved(
    start: Profile, x: Array, y: Array, mirrored: Mask, free: tuple[int, ...], across: float
) -> Profile:
    """The nearest profile with the parts of the noise as they are, from another one."""
    from scipy.optimize import least_squares

    first = distances(start, x, y, mirrored)
    weights = 1.0 / np.sqrt(_variance(first.slant, across))

    def made(p: Array) -> Profile:
        full = np.zeros(5)
        full[list(free)] = p
        return Profile(
            start.middle + full[0] * start.radius, start.apex + full[1] * start.radius,
            start.radius * float(np.exp(full[2])), start.weight * float(np.exp(full[3])),
            start.base + full[4] * start.radius,
        )  # fmt: skip

    sizes = np.array([start.radius, start.radius, 1.0, 1.0, start.radius])[list(free)]

    @lru_cache(maxsize=1)
    def at(p: tuple[float, ...]) -> Distances:
        return distances(made(np.array(p)), x, y, mirrored)

    def off(p: Array) -> Array:
        return at(tuple(p)).off * weights / start.radius

    def slope(p: Array) -> Array:
        return at(tuple(p)).by[:, free] * sizes * weights[:, None] / start.radius

    limit = np.array([2.0, 2.0, 2.5, 4.0, 2.0])[list(free)]
    found = least_squares(
        off, np.zeros(len(free)), slope, bounds=(-limit, limit), xtol=1e-12, ftol=1e-12, gtol=1e-12,
        x_scale="jac", max_nfev=200,
    )  # fmt: skip
    if not found.success:
        raise SceneError(f"points: no axisymmetric profile is near them ({found.message})")
    return made(found.x)


def _variance(slant: Array, across: float) -> Array:
    return np.asarray((1.0 - across) * slant**2 + across)


def _across(off: Array, slant: Array) -> float:
    """The part of the variance that is across the outline, by the largest likelihood."""
    from scipy.optimize import minimize_scalar

    def unlikely(log: float) -> float:
        variance = _variance(slant, float(np.exp(log)))
        mean = float(np.mean(off**2 / variance)) + 1e-300
        return float(np.log(mean) + np.mean(np.log(variance)))

    found = minimize_scalar(unlikely, bounds=(np.log(EXACT), 0.0), method="bounded")
    return float(np.exp(found.x))
