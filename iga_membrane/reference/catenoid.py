"""Films between two equal coaxial rings at z = +-h: the catenoid, in closed form."""

from __future__ import annotations

import numpy as np

LIMIT = 0.6627434193491816
"""Half height over radius beyond which no catenoid spans the rings."""


def catenoid(half_height: float, radius: float = 1.0) -> dict[str, float]:
    """The stable catenoid ``r = c cosh(z / c)``, tension 1.

    Raises
    ------
    ValueError
        Beyond the limit, where none exists.
    """
    h = half_height / radius
    if h > LIMIT:
        raise ValueError(f"half_height / radius = {h:g} > {LIMIT:.8f}: no catenoid exists")
    # u = h / c solves u / cosh(u) = h; the stable one has u below 1.19967864...
    low, high = 0.0, 1.1996786402577339
    for _ in range(200):
        u = 0.5 * (low + high)
        low, high = (u, high) if u / np.cosh(u) < h else (low, u)
    c = radius / np.cosh(u)
    area = np.pi * c**2 * (np.sinh(2 * u) + 2 * u)
    return {
        "neck_radius": c,
        "A_LG": area,
        "force": 2 * np.pi * c,
        "volume": 0.5 * c * area,
        "end_slope_deg": float(np.degrees(np.arctan(np.sinh(u)))),
    }
