"""A round cell of a rough surface below 180 degrees in closed form."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar


def exact(angle, pressure, outer, radius):
    """Vertical equilibrium gives the polar angle, then the profile is an integral."""
    hang = np.pi - np.radians(angle)

    def unbalanced(phi):
        a = radius * np.sin(phi)
        return np.sin(phi - hang) - pressure * (outer**2 - a**2) / (2.0 * a)

    top = minimize_scalar(lambda phi: -unbalanced(phi), bounds=(hang, hang + 1.5), method="bounded")
    phi = brentq(unbalanced, hang + 1e-9, top.x, xtol=1e-14)
    a = radius * np.sin(phi)

    def fall(r):
        sine = pressure * (outer**2 - r**2) / (2.0 * r)
        return sine / np.sqrt(1.0 - sine**2)

    sag = quad(fall, a, outer, epsabs=1e-15, epsrel=1e-13)[0]
    return {
        "phi_deg": np.degrees(phi),
        "contact_radius": a,
        "sag": sag,
        "z_edge": radius * (np.cos(phi) - 1.0) - sag,
        "F_sphere": pressure * np.pi * outer**2,
        "F_press": pressure * np.pi * a**2,
        "A_wet": 2.0 * np.pi * radius**2 * (1.0 - np.cos(phi)),
    }


def largest_pressure(angle, outer, radius):
    """De-pinning pressure of a round cell: the most that any line can carry."""
    hang = np.pi - np.radians(angle)

    def carried(phi):
        a = radius * np.sin(phi)
        return 2.0 * a * np.sin(phi - hang) / (outer**2 - a**2)

    found = minimize_scalar(
        lambda phi: -carried(phi), bounds=(hang, hang + 1.57), method="bounded",
        options={"xatol": 1e-10},
    )  # fmt: skip
    return carried(found.x)
