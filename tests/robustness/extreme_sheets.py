"""Extreme films, bridges, caps on a ring and sheets on a particle, with what is known of them.

An oracle takes the result and the parameters of its scene and gives the measures that are known.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

import iga_membrane as iga
from iga_membrane.reference import catenoid

# Films, bridges, caps on a ring


def ringed(half_height, length, tension, **held_by):
    return iga.film_between_rings(
        radius=length, half_height=half_height * length, liquid=iga.Liquid(tension), **held_by
    )


def film_oracle(result, half_height, length, tension):
    exact = catenoid(half_height)
    return {
        "neck_radius": exact["neck_radius"] * length,
        "force": exact["force"] * length * tension,
    }


def bridge(half_height, length, tension):
    volume = 2.0 * np.pi * half_height * length**3
    return ringed(half_height, length, tension, volume=volume)


def bridge_oracle(result, half_height, length, tension):
    return {"neck_radius": length, "pressure": tension / length}


def swollen(half_height, ratio, length, tension):
    """So many times the cylinder's volume."""
    return ringed(
        half_height, length, tension, volume=2.0 * np.pi * half_height * ratio * length**3
    )


def swollen_exists(half_height, ratio, **_):
    """A bridge gives way sideways once it leaves its rings within their planes, about where its
    profile is a half circle from ring to ring."""
    h = half_height
    half_circle = 1.0 + 0.5 * np.pi * h + 2.0 * h * h / 3.0
    return False if ratio > 1.5 * half_circle else True if ratio < half_circle / 1.5 else None


def pinned(length, tension, **held_by):
    return iga.liquid_sheet(
        size=2.0 * length, boundary="circle", liquid=iga.Liquid(tension), **held_by
    )


def cap_of_volume(volume, length, tension):
    return pinned(length, tension, volume=volume * length**3)


def volume_oracle(result, volume, length, tension):
    # a sheet hangs, so its liquid above z = 0 is missing below
    depth = brentq(lambda h: np.pi * h * (3 + h * h) / 6 - volume, 0.0, 1e3)
    return {"sag": depth * length}


def cap_of_pressure(pressure, length, tension):
    return pinned(length, tension, pressure=pressure * tension / length)


def pressure_oracle(result, pressure, length, tension):
    radius = 2.0 / pressure
    return {"sag": (radius - np.sqrt(radius**2 - 1.0)) * length}


# A weightless sheet on a particle hangs on a catenoid


def on_particle(angle, depth, size, length, tension):
    particle = iga.Sphere(angle, length, (0.0, 0.0, -depth * length))
    return iga.liquid_sheet(
        particle, size=size * length, boundary="circle", liquid=iga.Liquid(tension)
    )


def particle_oracle(result, angle, depth, size, length, tension):
    """Place of the line on the catenoid ``r = c cosh((z - z0) / c)`` through the rim.

    The sheet rises outwards from the line by ``psi = 180 - angle - phi``; ``c = a sin(psi)``.
    """
    theta = np.radians(angle)

    def height_missing(phi):
        a, psi = np.sin(phi), np.pi - theta - phi
        c = a * abs(np.sin(psi))
        away = np.arccosh(0.5 * size / c) - np.arccosh(max(a / c, 1.0)) if c > 0 else 0.0
        return (np.cos(phi) - depth) + np.sign(psi) * c * away

    found = result["measures"]["phi_deg"]
    places = np.radians(np.linspace(max(found - 5, 0.01), min(found + 5, 179.99), 101))
    values = np.array([height_missing(phi) for phi in places])
    roots = np.flatnonzero(values[:-1] * values[1:] <= 0)
    if not len(roots):
        return {"phi_deg": np.inf}
    phi = min(
        (brentq(height_missing, places[k], places[k + 1]) for k in roots),
        key=lambda p: abs(np.degrees(p) - found),
    )
    pull = 2.0 * np.pi * np.sin(phi) * np.sin(phi + theta) * length * tension
    small = 1e-3 * length * tension  # near no force at all its relative error says nothing
    pull = pull if abs(pull) > small else result["measures"]["F_CL"]
    return {"phi_deg": np.degrees(phi), "F_CL": pull}


def leaning_sheet(angle, depth, x, bond, length, tension):
    particle = iga.Sphere(angle, length, (x * length, 0.0, -depth * length), 1000.0)
    return iga.liquid_sheet(
        particle,
        size=5.0 * length,
        boundary="circle",
        liquid=iga.Liquid(tension, 1000.0),
        gravity=bond * tension / (1000.0 * length**2),
    )
