"""Droplets on surfaces of revolution and radial patterns of wettability, by shooting."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Radial = Callable[[Any], Any]


def drop_on_revolution(
    height: Radial, slope: Radial, cosine: Radial, bond: float, volume: float, guess: float
) -> dict[str, float]:
    """Axisymmetric droplet on the surface z = h(r), tension 1.

    Parameters
    ----------
    height, slope : r to h and dh/dr.
    cosine : r to the cosine of the contact angle there.
    bond : weight per volume, towards -z.
    volume : of the liquid.
    guess : contact angle in degrees of a cap that is near.

    Returns
    -------
    dict
        ``energy``, ``height`` (of the apex), ``A_LG``, ``A_wet``, ``contact_radius``, ``p_apex``.

    Raises
    ------
    ValueError
        No droplet is found.

    Notes
    -----
    Along the arc from the apex ``r' = cos(phi)``, ``z' = -sin(phi)``, ``phi' = p_apex + Bo (z_0 -
    z) - sin(phi) / r``, until it meets the surface. Of the pressure and the height at the apex the
    contact angle and the volume make two equations.
    """
    from scipy.integrate import quad, solve_ivp
    from scipy.optimize import root

    def shot(pressure: float, top: float, weight: float) -> Any:
        def rise(s: float, state: Any) -> list[float]:
            r, z, phi = state[:3]
            turn = np.sin(phi) / r if r > 1e-12 else 0.5 * pressure
            disc = np.pi * r**2 * np.sin(phi)
            bent = pressure + weight * (top - z) - turn
            return [np.cos(phi), -np.sin(phi), bent, disc, 2.0 * np.pi * r, disc * z]

        def meets(s: float, state: Any) -> float:
            return float(state[1] - height(state[0]))

        meets.terminal, meets.direction = True, -1.0  # type: ignore[attr-defined]
        found = solve_ivp(rise, (0.0, 50.0), [0.0, top, 0.0, 0.0, 0.0, 0.0], method="DOP853",
                          events=meets, rtol=1e-12, atol=1e-13)  # fmt: skip
        if not len(found.y_events[0]):
            raise ValueError("the profile does not meet the surface")
        return found.y_events[0][0]

    def under(r: float, z: float) -> tuple[float, float]:
        """Volume between the level z and the surface inside r, and its moment."""
        shape = lambda t: 2.0 * np.pi * t * (height(t) - z)  # noqa: E731
        moment = lambda t: np.pi * t * (height(t) ** 2 - z**2)  # noqa: E731
        return tuple(
            quad(f, 0.0, r, epsabs=1e-13, epsrel=1e-12, limit=400)[0] for f in (shape, moment)
        )

    def missing(unknown: Any, weight: float) -> list[float]:
        try:
            r, z, phi, above, *_ = shot(unknown[0], unknown[1], weight)
        except ValueError:
            return [10.0, 10.0]
        angle = phi + np.arctan(slope(r))
        return [angle - np.arccos(cosine(r)), above - under(r, z)[0] - volume]

    c = np.cos(np.radians(guess))
    ball = np.cbrt(3.0 * volume / (np.pi * (2.0 + c) * (1.0 - c) ** 2))
    start = [2.0 / ball, ball * (1.0 - c) + float(height(ball * np.sqrt(1.0 - c**2)))]
    for weight in np.linspace(0.0, bond, 1 + int(np.ceil(4.0 * abs(bond)))):
        found = root(missing, start, (weight,), method="hybr", tol=1e-12)
        if np.abs(missing(found.x, weight)).max() > 1e-8:
            raise ValueError("no droplet is found: start from another angle")
        start = found.x
    r, z, _, _, area, moment = shot(start[0], start[1], bond)

    def per_area(f: Radial) -> float:
        inside = lambda t: 2.0 * np.pi * t * f(t) * np.sqrt(1.0 + slope(t) ** 2)  # noqa: E731
        return float(quad(inside, 0.0, r, epsabs=1e-13, epsrel=1e-12, limit=400)[0])

    return {
        "energy": float(area - per_area(cosine) + bond * (moment - under(r, z)[1])),
        "height": float(start[1]),
        "A_LG": float(area),
        "A_wet": per_area(lambda t: 1.0),
        "contact_radius": float(r),
        "p_apex": float(start[0]),
    }
