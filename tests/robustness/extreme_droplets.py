"""Extreme droplets on planes, on a sphere and on rough surfaces, with what is known of them.

An oracle takes the result and the parameters of its scene and gives the measures that are known.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import round_cell
from scipy.optimize import brentq

import iga_membrane as iga
from iga_membrane.reference import cap_on_plane, drop_on_plane
from iga_membrane.splines import points_of

UNIT = 4.0 * np.pi / 3.0


def scaled(values: Mapping[str, float], length: float, tension: float) -> dict[str, float]:
    """Measures of a unit droplet in other units."""
    powers = {"height": (1, 0), "contact_radius": (1, 0), "p_base": (-1, 1), "energy": (2, 1)}
    return {k: values[k] * length**a * tension**b for k, (a, b) in powers.items()}


# Droplets on a plane


def distorted(scene: iga.Scene, amount: float) -> iga.Surface:
    """The start with rings moved along the meridians by a part of their distance."""
    net = scene.surface.net.copy()
    random = np.random.default_rng(int(1e6 * amount))
    inner = slice(1, net.shape[1] - 3)
    step = net[:, 2 : net.shape[1] - 2] - net[:, inner]
    net[:, inner] += amount * random.uniform(0, 1, step.shape[1])[:, None] * step
    return scene.surface.moved(points_of(scene.surface.space, net))


def on_plane(angle, bond, length, tension, distortion=0.0, **options):
    density = 1000.0
    given = {
        "volume": UNIT * length**3,
        "liquid": iga.Liquid(tension, density),
        "gravity": bond * tension / (density * length**2),
    } | options
    plane = iga.Plane(contact_angle=angle)
    scene = iga.sessile_droplet(plane, **given)
    if distortion:
        scene = iga.sessile_droplet(plane, start=distorted(scene, distortion), **given)
    return scene


def plane_oracle(result, angle, bond, length, tension, **_):
    try:
        exact = drop_on_plane(bond, angle)
    except ValueError:
        # wider than 600 capillary lengths, where a puddle's height is that of its straight edge
        height = 2.0 * np.sin(0.5 * np.radians(angle)) / np.sqrt(bond)
        return {"height": height * length, "p_base": bond * height * tension / length}
    return scaled(exact, length, tension)


def flat_foot(**parameters):
    return on_plane(180.0, **parameters)


def flat_oracle(result, **parameters):
    return plane_oracle(result, 180.0, **parameters)


def caps(angle, length, tension):
    return on_plane(angle, 0.0, length, tension)


def cap_oracle(result, angle, length, tension):
    return scaled(cap_on_plane(angle), length, tension)


def tilted(angle, bond, tilt, length, tension, hold="none"):
    tilt = np.radians(tilt)
    pull = bond * tension / (1000.0 * length**2)
    gravity = (pull * np.sin(tilt), 0.0, -pull * np.cos(tilt))
    mesh = iga.Discretization(elements=10)
    return on_plane(angle, bond, length, tension, gravity=gravity, hold=hold, discretization=mesh)


def held(angle, bond, tilt, length, tension):
    return tilted(angle, bond, tilt, length, tension, hold="x")


# Droplets on a sphere, without gravity: two spherical caps


def on_sphere(angle, radius, length, tension):
    sphere = iga.Sphere(angle, radius * length, (0.0, 0.0, -radius * length))
    liquid = iga.Liquid(tension, 1000.0)
    return iga.sessile_droplet(sphere, volume=UNIT * length**3, liquid=liquid)


def segment(radius, opening):
    """Volume of a spherical cap by its half angle."""
    c = np.cos(opening)
    return np.pi * radius**3 * (2 + c) * (1 - c) ** 2 / 3


def sphere_oracle(result, angle, radius, length, tension):
    theta = np.radians(angle)

    def missing(polar):
        free = radius * np.sin(polar) / np.sin(theta + polar)
        return segment(free, theta + polar) - segment(radius, polar) - UNIT

    polar = brentq(missing, 1e-9, np.pi - theta - 1e-9, xtol=1e-15)
    free = radius * np.sin(polar) / np.sin(theta + polar)
    return {
        "contact_radius": radius * np.sin(polar) * length,
        "pressure": 2.0 / free * tension / length,
    }


def heavy_on_sphere(angle, radius, bond, length, tension):
    pull = bond * tension / (1000.0 * length**2)
    sphere = iga.Sphere(angle, radius * length, (0.0, 0.0, -radius * length))
    liquid = iga.Liquid(tension, 1000.0)
    return iga.sessile_droplet(
        sphere, volume=UNIT * length**3, liquid=liquid, gravity=pull, hold="xy"
    )


def weight(result, bond, length, tension, **_):
    return {"support_force": UNIT * bond * tension * length}


# Rough surfaces at 180 degrees


def carried(radius, area):
    """Pressure over tension at which the wet spot reaches the equator of its sphere."""
    return 2.0 * np.pi * radius / (area - np.pi * radius**2)


def cell(size, part, length, tension):
    size *= length
    pressure = part * carried(length, 0.25 * np.pi * size**2) * tension
    return iga.asperity_cell(
        iga.Sphere(180.0, length, (0.0, 0.0, -length)),
        size=size,
        pressure=pressure,
        shape="circle",
        liquid=iga.Liquid(tension),
    )


def cell_oracle(result, size, part, length, tension):
    # the mirror edge is level, so the sphere carries the pressure on the whole cell
    area = 0.25 * np.pi * (size * length) ** 2
    return {"F_sphere": part * carried(length, area) * tension * area}


def lattice(radius, pitch, bond, length, tension, penalty=None):
    return iga.sessile_droplet(
        iga.SphereLattice(180.0, radius * length, pitch * radius * length),
        volume=UNIT * length**3,
        liquid=iga.Liquid(tension, 1000.0),
        gravity=bond * tension / (1000.0 * length**2),
        hold="xy",
        penalty=penalty,
    )


def carries(radius, pitch, bond, **_):
    """Whether a lattice carries a droplet, from its pressure at rest on a plane; near the limit,
    or where the droplet stands on one or two asperities, this does not tell."""
    share = drop_on_plane(bond, 180.0)["p_base"] / carried(radius, (pitch * radius) ** 2)
    wide = drop_on_plane(bond, 180.0)["contact_radius"] > pitch * radius
    return True if share < 0.7 and wide else False if share > 1.5 else None


# Contact lines on asperities


def lined_cell(angle, size, part, length, tension):
    most = round_cell.largest_pressure(angle, 0.5 * size, 1.0)
    return iga.asperity_cell(
        iga.Sphere(angle, length, (0.0, 0.0, -length)),
        size=size * length,
        pressure=part * most * tension / length,
        shape="circle",
        liquid=iga.Liquid(tension),
        contact_line="trimmed",
    )


def lined_cell_oracle(result, angle, size, part, length, tension):
    most = round_cell.largest_pressure(angle, 0.5 * size, 1.0)
    exact = round_cell.exact(angle, part * most, 0.5 * size, 1.0)
    return {
        "phi_deg": exact["phi_deg"],
        "contact_radius": exact["contact_radius"] * length,
        "F_sphere": exact["F_sphere"] * length * tension,
        "F_press": exact["F_press"] * length * tension,
    }


def lines_carry(angle, radius, pitch, bond, **_):
    """The same as ``carries`` with the most that contact lines do."""
    cell = pitch * radius / np.sqrt(np.pi)
    flat = drop_on_plane(bond, 180.0)
    share = flat["p_base"] / round_cell.largest_pressure(angle, cell, radius)
    wide = flat["contact_radius"] > 2.0 * pitch * radius
    return True if share < 0.7 and wide else False if share > 1.5 else None


def lined_lattice(angle, radius, pitch, bond, length, tension, particles=(), **options):
    return iga.sessile_droplet(
        iga.SphereLattice(angle, radius * length, pitch * radius * length, **options),
        volume=UNIT * length**3,
        liquid=iga.Liquid(tension, 1000.0),
        gravity=bond * tension / (1000.0 * length**2),
        particles=particles,
    )


def lined_defects(result, angle, radius, bond, length, tension, pulls=(0.0, 0.0, 0.0), **_):
    """Forces on the asperities sum to the weight and what pulls beside it; none is drawn up harder
    than a line can."""
    unit = length * tension
    weight = np.array([0.0, 0.0, UNIT * bond * unit])
    forces = np.array([each["force_vector"] for each in result["contact"]["asperities"]])
    pull = 2.0 * np.pi * radius * np.cos(0.5 * np.radians(angle)) ** 2 * unit
    missing = forces.sum(axis=0) + weight + pulls - result["contact"]["hold_force"]
    return {
        "weight": np.linalg.norm(missing) / weight[2],
        "pull": max(0.0, forces[:, 2].max() / pull - 1.0),
    }


def whole_system(angle, radius, pitch, bond, grain, size, shift, length, tension):
    """A particle on top of a droplet on asperities."""
    top = drop_on_plane(bond, 180.0)["height"]
    center = (0.0, 0.0, (top + shift * size) * length)
    half = 0.5 * pitch * radius * length
    particle = iga.Sphere(grain, size * length, center, 1000.0)
    return lined_lattice(
        angle, radius, pitch, bond, length, tension, [particle], offset=(half, half)
    )


def whole_defects(result, **parameters):
    (force,) = result["forces"]
    return lined_defects(result, pulls=np.subtract(force["F_e"], force["F_G"]), **parameters)
