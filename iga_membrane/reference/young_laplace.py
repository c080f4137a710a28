"""Axisymmetric drops under gravity: Young-Laplace by arc-length shooting from the apex.

From the apex down, with inclination ``psi``: ``r' = cos psi``, ``depth' = sin psi``,
``psi' = p_apex + Bo depth - sin(psi) / r``. The one unknown is the apex pressure, searched by its
logarithm: in flat puddles it decays like ``exp(-radius / capillary length)``, and shooting with
the growing mode is stable.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .caps import cap_on_plane

Array = NDArray[np.float64]
Rates = Callable[[float, float, float], tuple[Array, float]]


def drop_on_plane(
    bond: float, contact_angle: float, volume: float = 4.0 * np.pi / 3.0
) -> dict[str, float]:
    """Sessile drop on the plane z = 0.

    Parameters
    ----------
    bond : ``rho g / gamma`` in the units of the volume (the Bond number for radius 1), >= 0.
    contact_angle : degrees, 0 < angle <= 180 (180 needs bond > 0 to touch in more than a point).
    volume : of the drop.

    Returns
    -------
    Measures by the names of the result file.

    Raises
    ------
    ValueError
        A puddle so wide that its apex pressure is not a double any more.
    """
    if bond == 0.0:
        return cap_on_plane(contact_angle, volume)
    pressure = _apex_pressure(bond, contact_angle, volume)
    rim, height, inside, area, moment, equator = _profile(pressure, bond, contact_angle)
    wet = np.pi * rim**2
    surface = area - np.cos(np.radians(contact_angle)) * wet
    gravity = bond * (height * inside - moment)
    return {
        "contact_radius": rim,
        "height": height,
        "equator_radius": equator,
        "p_apex": pressure,
        "p_base": pressure + bond * height,
        "A_LG": area,
        "A_wet": wet,
        "E_surf": surface,
        "E_grav": gravity,
        "energy": surface + gravity,
    }


def profile_on_plane(
    bond: float, contact_angle: float, volume: float = 4.0 * np.pi / 3.0, points: int = 2001
) -> tuple[Array, Array]:
    """Profile of that drop.

    Returns
    -------
    r, z : (points,) distance from the axis and height above the plane, equally far from each other
        along the arc, from the apex to the contact line.
    """
    if bond == 0.0:
        pressure = cap_on_plane(contact_angle, volume)["p_apex"]
    else:
        pressure = _apex_pressure(bond, contact_angle, volume)
    from scipy.integrate import solve_ivp

    start, rates = _apex(pressure, bond)
    theta = np.radians(contact_angle)

    def by_length(_: float, y: Array) -> list[float]:
        rate, bend = rates(y[2], y[0], y[1])
        return [rate[0], rate[1], bend]

    def ended(_: float, y: Array) -> float:
        return float(y[2] - theta)

    ended.terminal = True  # type: ignore[attr-defined]
    longest = 1e4 * (volume ** (1.0 / 3.0) + (1.0 / np.sqrt(bond) if bond else 0.0))
    found = solve_ivp(
        by_length, (0.0, longest), start[[0, 1, 5]], method="DOP853", rtol=1e-12, atol=1e-300,
        events=ended, dense_output=True,
    )  # fmt: skip
    r, depth, _ = found.sol(np.linspace(0.0, found.t[-1], points - 1))
    return np.append(0.0, r), np.append(depth[-1], depth[-1] - depth)


def _apex_pressure(bond: float, contact_angle: float, volume: float) -> float:
    """Pressure at the apex with which the profile holds the volume."""
    from scipy.optimize import brentq

    def missing(log_pressure: float) -> float:
        return float(np.log(_profile(np.exp(log_pressure), bond, contact_angle)[2] / volume))

    # A drop without gravity has the largest apex pressure; lower it until the volume is too large.
    high = np.log(4.0 * cap_on_plane(contact_angle, volume)["p_apex"])
    low, step = high - 1.0, 1.0
    while missing(low) < 0.0:
        high, step = low, 1.5 * step
        low -= step
        if low < -600.0:
            raise ValueError(
                f"bond = {bond:g} at {contact_angle:g} degrees: the puddle is wider than 600 "
                "capillary lengths and its apex pressure underflows; use the puddle's limits"
            )
    root = brentq(missing, low, high, xtol=1e-14, rtol=8.9e-16)
    return float(np.exp(root))


def _profile(pressure: float, bond: float, contact_angle: float) -> tuple[float, ...]:
    """Rim radius, depth, volume, area, first moment of depth, equator radius."""
    from scipy.integrate import solve_ivp

    theta = np.radians(contact_angle)
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-300}

    start, rates = _apex(pressure, bond)
    tilt = start[5]

    def by_length(_: float, y: Array) -> Array:
        rate, bend = rates(y[5], y[0], y[1])
        return np.append(rate, bend)

    def by_angle(psi: float, y: Array) -> Array:
        rate, bend = rates(psi, y[0], y[1])
        return np.asarray(rate / bend)

    if tilt >= 0.5 * theta:
        raise ValueError("the apex pressure is too large for the volume")

    def halfway(_: float, y: Array) -> float:
        return float(y[5] - 0.5 * theta)

    halfway.terminal = True  # type: ignore[attr-defined]
    longest = 1e4 * (1.0 + 1.0 / np.sqrt(bond))
    first = solve_ivp(by_length, (0.0, longest), start, events=halfway, **options).y[:, -1]
    stops = [theta] if theta <= 0.5 * np.pi else [0.5 * np.pi, theta]
    state, angle, equator = first[:5], first[5], 0.0
    for stop in stops:
        if stop > angle:
            state = solve_ivp(by_angle, (angle, stop), state, **options).y[:, -1]
            angle = stop
        equator = max(equator, float(state[0]))
    r, depth, inside, area, moment = (float(v) for v in state)
    return r, depth, inside, area, moment, equator


def _apex(pressure: float, bond: float) -> tuple[Array, Rates]:
    """State near the apex (radius, depth, volume, area, first moment, inclination), and the rates
    of the first five along the arc with that of the inclination."""

    def rates(psi: float, r: float, depth: float) -> tuple[Array, float]:
        sine, cosine = np.sin(psi), np.cos(psi)
        bend = pressure + bond * depth - sine / r
        section = np.pi * r * r * sine
        return np.array([cosine, sine, section, 2 * np.pi * r, depth * section]), bend

    # Series at the apex: flat or spherical over a small part of the smallest length there is.
    r0 = 1e-3 * min(1.0 / pressure, 1.0 / np.sqrt(bond) if bond else 1.0, 1.0)
    b = 0.5 * pressure
    d0 = 0.5 * b * r0**2 * (1.0 + r0**2 * (b**2 / 4 + bond / 16))
    tilt = np.arctan(b * r0 * (1.0 + r0**2 * (0.5 * b**2 + bond / 8)))
    start = np.array(
        [r0, d0, np.pi * r0**2 * d0 / 2, np.pi * r0**2, np.pi * r0**2 * d0**2 / 3, tilt]
    )
    return start, rates
