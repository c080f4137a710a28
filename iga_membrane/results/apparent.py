"""Angles at which a droplet on asperities seems to stand on them."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..terms import BodyDensity
from .meridian import rates, stops

LEVEL = 1e-9
"""Slope angle (radians) of a profile that has come to lie level, far below any that can be seen."""


def apparent_angle(height: float, body: BodyDensity, tension: float) -> float | None:
    """Angle of the axisymmetric Young-Laplace profile from the apex where it meets z = 0.

    Parameters
    ----------
    height : of the apex.
    body : body density of the Lagrangian, so minus the pressure.

    Returns
    -------
    degrees; 180 where the profile closes above z = 0, None where it does not come down: under a
    negative pressure at the apex, or where one that hangs turns up again.

    Notes
    -----
    What a goniometer sees: the profile knows the pressure and the height of the droplet, not its
    asperities.
    """
    if body.constant + body.gradient[2] * height >= 0.0:
        return None
    turn = profile(height, body, tension)[2, -1]
    return float(np.degrees(min(turn, np.pi))) if turn > LEVEL else None


def profile(height: float, body: BodyDensity, tension: float) -> Array:
    """(3, points) distance from the axis, height and slope angle (radians) of that profile, from
    the apex down to z = 0, or to where it closes or comes to lie level."""
    from scipy.integrate import solve_ivp  # a third of a small solve's process: only where needed

    pressure = -(body.constant + body.gradient[2] * height) / tension
    weight = body.gradient[2] / tension
    first = 1e-6 * height
    r, depth, turn = solve_ivp(
        lambda s, y: rates(y[2], y[0], y[1], pressure, weight), (first, 20.0 * height + 20.0),
        [first, 0.0, 0.5 * first * pressure], method="DOP853", rtol=1e-9, atol=1e-12,
        events=stops(height, 0.5 * LEVEL),
    ).y  # fmt: skip
    return np.stack([r, height - depth, turn])


def cassie_baxter_angle(
    wet: float, projected: float, base: float, contact_angle: float
) -> float | None:
    """Cassie and Baxter's angle (degrees): ``cos = (A_wet cos(theta) + A_projected) / A_base - 1``.

    Parameters
    ----------
    wet, projected : area of the wet spots, and projected on the base; base : area of the foot.

    Returns
    -------
    degrees; None where the right-hand side is no cosine.
    """
    cosine = (wet * np.cos(np.radians(contact_angle)) + projected) / base - 1.0
    return float(np.degrees(np.arccos(cosine))) if abs(cosine) <= 1.0 else None
