"""Spherical caps: drops without gravity."""

from __future__ import annotations

import numpy as np


def cap_on_plane(contact_angle: float, volume: float = 4.0 * np.pi / 3.0) -> dict[str, float]:
    """Drop on a plane at zero Bond number: a spherical cap.

    Parameters
    ----------
    contact_angle : degrees, 0 < angle <= 180.

    Returns
    -------
    Measures by the names of the result file, plus ``sphere_radius``.
    """
    theta = np.radians(contact_angle)
    half = np.sin(0.5 * theta) ** 2  # (1 - cos) / 2 without cancellation
    radius = (volume / (4.0 * np.pi * half**2 * (3.0 - 2.0 * half) / 3.0)) ** (1.0 / 3.0)
    rim = radius * np.sin(theta)
    area, wet = 4.0 * np.pi * radius**2 * half, np.pi * rim**2
    energy = area - np.cos(theta) * wet
    return {
        "contact_radius": rim,
        "height": 2.0 * radius * half,
        "equator_radius": radius if theta > 0.5 * np.pi else rim,
        "p_apex": 2.0 / radius,
        "p_base": 2.0 / radius,
        "A_LG": area,
        "A_wet": wet,
        "E_surf": energy,
        "E_grav": 0.0,
        "energy": energy,
        "sphere_radius": radius,
    }
