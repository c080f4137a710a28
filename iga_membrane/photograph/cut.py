"""A profile that is cut by its base: angle, volume and sizes, with their standard errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .axisymmetric import Fit

SIDEWAYS = 1e-6
"""Sine of the contact angle at least, by which errors of the base become errors of the angle."""


@dataclass(frozen=True, eq=False)
class Cut:
    """Values with their slopes.

    Attributes
    ----------
    values : by name; slopes : (5,) of each by the profile's parameters, in the order of
        :func:`.axisymmetric.distances`.
    curve : (k, 2) the profile from the contact line left to the one right, y towards the apex.
    """

    values: dict[str, float]
    slopes: dict[str, Array]
    curve: Array

    def errors(self, fit: Fit, base: float) -> dict[str, float]:
        """Standard errors of the values, with that of a base line that was not sought."""
        free = list(fit.free)
        known = 0.0 if BASE in free else base
        return {
            name: float(
                np.sqrt(slope[free] @ fit.covariance @ slope[free] + (known * slope[BASE]) ** 2)
            )
            for name, slope in self.slopes.items()
        }


MIDDLE, APEX, RADIUS, WEIGHT, BASE = range(5)
"""Numbers of the parameters of a profile."""


def cut(fit: Fit, tension: float) -> Cut:
    """The profile of a fit down to its base.

    Parameters
    ----------
    tension : of the liquid, or the one to which a sought tension is a factor.
    """
    p = fit.profile
    size, bond = p.radius, p.bond
    m = p.down_to(p.base)
    depth = (p.apex - p.base) / size
    turn, r, volume = float(m.turn[-1]), float(m.r[-1]), float(m.volume[-1])
    r_b, depth_b, turn_b, volume_b = m.by_bond[:, -1]
    # of depth over radius and of the bond number by the parameters
    down = np.array([0.0, 1.0 / size, -depth, 0.0, -1.0 / size])
    heavy = np.array([0.0, 0.0, 2.0 * bond, bond, 0.0])
    along = (down - depth_b * heavy) / max(np.sin(turn), SIDEWAYS)
    larger = np.eye(5)[RADIUS]
    rise = along * float(m.bend[-1]) + turn_b * heavy
    wider = along * np.cos(turn) + r_b * heavy
    fuller = along * np.pi * r**2 * np.sin(turn) + volume_b * heavy
    values = {
        "contact_angle": float(np.degrees(turn)),
        "volume": volume * size**3,
        "contact_radius": r * size,
        "height": p.apex - p.base,
    }
    slopes = {
        "contact_angle": np.degrees(rise),
        "volume": size**3 * (fuller + 3.0 * volume * larger),
        "contact_radius": size * (wider + r * larger),
        "height": np.array([0.0, 1.0, 0.0, 0.0, -1.0]),
    }
    if WEIGHT in fit.free:
        values["surface_tension"] = tension
        slopes["surface_tension"] = -tension * np.eye(5)[WEIGHT]
    if BASE in fit.free:
        values["base"] = p.base
        slopes["base"] = np.eye(5)[BASE]
    half = np.stack([size * m.r, p.apex - size * m.depth], axis=1)
    left = np.stack([p.middle - half[::-1, 0], half[::-1, 1]], axis=1)
    right = np.stack([p.middle + half[:, 0], half[:, 1]], axis=1)
    return Cut(values, slopes, np.concatenate([left, right]))
