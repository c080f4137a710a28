"""Angles left and right of any droplet, leaning or not, from its outline next to the base."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array

PARTS = (0.6, 0.42, 0.3, 0.21, 0.15)
"""Heights of the outline that may count, over the droplet's: higher ones feel noise less, lower
ones the change of curvature."""
AGREES = 3.0
"""Standard errors by which the angle of a higher part may differ from those of all lower ones."""
FEWEST, SURE = 8, 20
"""Points of a side at least, for the three numbers of an arc; of one that another must agree with,
whose error is known to a sixth."""


@dataclass(frozen=True)
class SideAngle:
    """Where one side of an outline meets the base.

    Attributes
    ----------
    degrees, error : the angle through the liquid, with its standard error; not a number where the
        side has too few points.
    place : distance of the contact line outwards from x = 0.
    """

    degrees: float
    error: float
    place: float


def side_angles(x: Array, y: Array) -> tuple[SideAngle, SideAngle]:
    """The angles left and right.

    Parameters
    ----------
    x, y : (n,) points of the outline, y their distance from the base.
    """
    low = (y > 0.0) & (y < PARTS[0] * float(y.max()))
    middle = 0.5 * float(x[low].min() + x[low].max()) if low.any() else 0.0
    left, right = low & (x < middle), low & (x >= middle)
    top = float(y.max())
    return (
        _side(middle - x[left], y[left], -middle, top),
        _side(x[right] - middle, y[right], middle, top),
    )


def _side(u: Array, y: Array, middle: float, top: float) -> SideAngle:
    """By an arc through as many points as agree with those next to the base.

    Notes
    -----
    Lepski (1991): of estimates that are the more biased the more points they use, the one of the
    most points that differs from none of fewer by more than their errors.
    """
    best = SideAngle(np.nan, np.nan, np.nan)
    lower: list[SideAngle] = []
    for part in reversed(PARTS):
        near = y < part * top
        count = int(near.sum())
        if count < FEWEST:
            continue
        arc = _arc(u[near], y[near], middle)
        if any(abs(arc.degrees - each.degrees) > AGREES * each.error for each in lower):
            break
        lower += [arc] if count >= SURE else []
        best = arc
    return best


def _arc(u: Array, y: Array, middle: float) -> SideAngle:
    """By the circle nearest to points (n,) at distances u outwards from the middle.

    Notes
    -----
    Through the contact line with direction t, normal n and curvature k, a point that is d away from
    there lies ``(2 d.n - k d.d) / (1 + sqrt(1 - 2 k d.n + k^2 d.d))`` inside.
    """
    from scipy.optimize import least_squares

    tall = float(y.max())
    powers = (y / tall)[:, None] ** np.arange(2)
    foot, lean = np.linalg.lstsq(powers, u, rcond=None)[0]

    def off(p: Array) -> Array:
        place, turn, bend = p[0] * tall, p[1], p[2] / tall
        d = np.stack([u - place, y], axis=1)
        along = d @ [np.sin(turn), np.cos(turn)]
        inside = np.maximum(1.0 - 2.0 * bend * along + bend**2 * (d * d).sum(axis=1), 0.0)
        return (2.0 * along - bend * (d * d).sum(axis=1)) / (1.0 + np.sqrt(inside)) / tall

    start = [float(foot) / tall, float(np.arctan2(1.0, -lean / tall)), 0.0]
    found = least_squares(off, start, xtol=1e-12, ftol=1e-12, gtol=1e-12, x_scale="jac")
    rest = 2.0 * float(found.cost) / max(len(u) - 3, 1)
    covariance = rest * np.linalg.pinv(found.jac.T @ found.jac)
    place, turn, _ = found.x
    error = float(np.degrees(np.sqrt(covariance[1, 1])))
    return SideAngle(float(np.degrees(turn)), error, float(place * tall + middle))
