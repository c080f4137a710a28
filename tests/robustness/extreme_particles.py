"""Extreme droplets with particles, with what is known of them.

A sphere of liquid that a particle cuts at its contact angle stays a sphere, and the particle feels
nothing, wherever it is: ``d^2 = R^2 + r^2 - 2 R r cos(theta)``. Elsewhere forces balance, and a
line carries at most ``2 pi gamma r``.

A *defect* takes the result and the parameters of its scene and gives relative errors by name.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane
from iga_membrane.reference.young_laplace import profile_on_plane

UNIT = 4.0 * np.pi / 3.0
DENSITY = 1000.0


def pull(result, which=0):
    """Force of membrane and liquid on a particle."""
    force = result["forces"][which]
    return np.subtract(force["F_e"], force["F_G"])


def fed(length, tension, bond=0.0):
    """Volume, liquid and the size of gravity of a droplet in its units."""
    return {
        "volume": UNIT * length**3,
        "liquid": iga.Liquid(tension, DENSITY),
    }, bond * tension / (DENSITY * length**2)


def distance(radius, r, angle):
    """Between the centres of a sphere of liquid and a particle at rest on it."""
    return np.sqrt(radius**2 + r**2 - 2.0 * radius * r * np.cos(np.radians(angle)))


def lens(radius, r, angle):
    """Volume of a particle at rest inside a sphere of liquid, and its part beyond the plane of the
    line, seen from the particle."""
    d = distance(radius, r, angle)
    over = 12.0 * d / np.pi
    both = (radius + r - d) ** 2 * (d * d + 2 * d * (r + radius) - 3 * (r - radius) ** 2) / over
    c = (d * d + r * r - radius**2) / (2.0 * d * r)
    return both, np.pi * r**3 * (2.0 + c) * (1.0 - c) ** 2 / 3.0


# Caps on a plane with a particle at rest


def rested(angle, particle, r, place):
    """Radius of the cap, and its particle's place as a share of all that are free."""
    c = np.cos(np.radians(angle))
    whole = np.pi * (2.0 + c) * (1.0 - c) ** 2 / 3.0
    radius = brentq(lambda s: whole * s**3 - lens(s, r, particle)[0] - UNIT, 0.5, 50.0, xtol=1e-15)
    d = distance(radius, r, particle)
    lowest = np.arccos(np.clip((1.5 * r + radius * c) / d, -1.0, 1.0))
    polar = np.radians(10.0) + place * (lowest - np.radians(10.0))
    return radius, at_rest(angle, particle, r, radius, polar)


def at_rest(angle, particle, r, radius, polar):
    """Centre of a particle at rest, the centroid of the liquid above the origin."""
    d = distance(radius, r, particle)
    aside = d * lens(radius, r, particle)[1] / UNIT * np.sin(polar)
    height = d * np.cos(polar) - radius * np.cos(np.radians(angle))
    return np.array([aside + d * np.sin(polar), 0.0, height])


def on_cap(
    angle, particle, r, place, length, tension, shift=0.0, motion="fixed", line="auto"
):  # fmt: skip
    radius, center = rested(angle, particle, r, place)
    out = center + [0.0, 0.0, radius * np.cos(np.radians(angle))]
    center = center + shift * r * out / np.linalg.norm(out)
    return iga.sessile_droplet(
        iga.Plane(angle),
        particles=[iga.Sphere(particle, r * length, tuple(length * center), DENSITY, motion)],
        hold="x",
        contact_line=line,
        **fed(length, tension)[0],
    )


def ends_on_cap(**parameters):
    return on_cap(**parameters, line="conforming")


def cap_defects(result, angle, particle, r, place, length, tension, **_):
    """Pressure, line and no force at all."""
    radius, _ = rested(angle, particle, r, place)
    found = result["measures"]
    return {
        "p_base": found["p_base"] * length / tension * radius / 2.0 - 1.0,
        "contact_radius": found["contact_radius"] / (length * radius * np.sin(np.radians(angle)))
        - 1.0,
        "pull": np.linalg.norm(pull(result)) / (2.0 * np.pi * r * length * tension),
    }


def finds_rest(**parameters):
    return on_cap(**parameters, motion="normal")


def rest_defects(result, angle, particle, r, place, length, tension, **_):
    """How far from the curve of all places of rest the particle has come to rest."""
    radius, _ = rested(angle, particle, r, place)
    x, _, z = np.array(result["forces"][0]["center"]) / length
    d = distance(radius, r, particle)
    polar = np.arccos(np.clip((z + radius * np.cos(np.radians(angle))) / d, -1.0, 1.0))
    off = x - at_rest(angle, particle, r, radius, polar)[0]
    return cap_defects(result, angle, particle, r, place, length, tension) | {"place": off / r}


# Heavy droplets on a plane with a particle


def beside(angle, bond, r, place, shift):
    """Centre of a particle near the surface of the droplet alone."""
    x, z = profile_on_plane(bond, angle)
    normal = np.column_stack([-np.gradient(z), np.gradient(x)])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    free = np.flatnonzero((z > 1.5 * r) & (x > 0.2))
    k = free[int(place * (len(free) - 1))]
    across, up = np.array([x[k], z[k]]) + shift * r * normal[k]
    return across, 0.0, max(up, 1.2 * r)


def on_droplet(angle, particle, r, bond, place, shift, length, tension, line="auto"):
    center = tuple(length * np.array(beside(angle, bond, r, place, shift)))
    given, gravity = fed(length, tension, bond)
    return iga.sessile_droplet(
        iga.Plane(angle),
        gravity=gravity,
        particles=[iga.Sphere(particle, r * length, center, DENSITY)],
        hold="x",
        contact_line=line,
        **given,
    )


def ends_on_droplet(**parameters):
    return on_droplet(**parameters, line="conforming")


def droplet_defects(result, angle, r, bond, length, tension, **_):
    """The plane carries droplet and pull, the hold its part along the plane; no torque."""
    force, weight = pull(result), UNIT * bond
    unit = length * tension
    missing = result["contact"]["support_force"] - force[2] - weight * unit
    most = 2.0 * np.pi * r * unit
    line = np.linalg.norm(result["forces"][0]["F_CL"])
    return {
        "upwards": missing / (most + weight * unit),
        "sideways": (result["contact"]["hold_force"][0] - force[0]) / most,
        "line": max(0.0, line / most - 1.0),
    }


def too_heavy(angle, particle, r, bond, share, length, tension):
    """More than the line, the pressure and Archimedes could carry together, twice."""
    p = drop_on_plane(bond, angle)["p_base"]
    most = 2.0 * np.pi * r + 2.0 * p * np.pi * r**2 + bond * UNIT * r**3
    density = DENSITY * share * most / (bond * UNIT * r**3)
    x, y, z = beside(angle, bond, r, 0.2, 0.0)
    given, gravity = fed(length, tension, bond)
    center = (x * length, y * length, z * length)
    return iga.sessile_droplet(
        iga.Plane(angle),
        gravity=gravity,
        particles=[iga.Sphere(particle, r * length, center, density, "vertical")],
        hold="x",
        **given,
    )


# Free droplets


def direction(azimuth, height):
    flat = np.sqrt(1.0 - height**2)
    return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), height])


def free_radius(particle, r):
    """Of the sphere of liquid that a particle at rest cuts."""
    return brentq(lambda s: UNIT * (s**3 - 1.0) - lens(s, r, particle)[0], 1.0, 50.0, xtol=1e-15)


def free(particle, r, azimuth, height, length, tension, away=1.0, bond=0.0, hold="none"):
    """Gravity points from the particle to the liquid."""
    way = direction(azimuth, height)
    given, size = fed(length, tension, bond)
    center = tuple((away * length * way).tolist())
    return iga.sessile_droplet(
        None,
        gravity=(-size * way).tolist(),
        particles=[iga.Sphere(particle, r * length, center, DENSITY)],
        hold=hold,
        **given,
    )


def free_defects(result, particle, r, length, tension, **_):
    radius = free_radius(particle, r)
    return {
        "pressure": result["measures"]["pressure"] * length / tension * radius / 2.0 - 1.0,
        "pull": np.linalg.norm(pull(result)) / (2.0 * np.pi * r * length * tension),
    }


def pulled(particle, r, stretch, **more):
    """Its centroid held, so much farther than at rest."""
    radius = free_radius(particle, r)
    d, cap = distance(radius, r, particle), lens(radius, r, particle)[1]
    rest = d * (1.0 + cap / UNIT)
    return free(particle, r, away=rest + stretch * r, hold="xyz", **more)


def pulled_defects(result, r, azimuth, height, length, tension, **_):
    """What holds the liquid is what it does to the particle, along their axis."""
    force, way = pull(result), direction(azimuth, height)
    unit = 2.0 * np.pi * r * length * tension
    return {
        "hold": np.linalg.norm(force - result["contact"]["hold_force"]) / unit,
        "across": np.linalg.norm(np.cross(force, way)) / unit,
        "line": max(0.0, np.linalg.norm(result["forces"][0]["F_CL"]) / unit - 1.0),
    }


def hanging_defects(result, r, azimuth, height, bond, length, tension, **_):
    weight = -UNIT * bond * length * tension * direction(azimuth, height)
    return {
        "weight": np.linalg.norm(pull(result) - weight) / np.linalg.norm(weight),
        "line": max(
            0.0,
            np.linalg.norm(result["forces"][0]["F_CL"]) / (2.0 * np.pi * r * length * tension)
            - 1.0,
        ),
    }


def hangs(r, bond, **_):
    """A line carries at most 2 pi gamma r, and suction over it no more than the droplet's own
    height of liquid, three radii, does."""
    most = 2.0 * np.pi * r + 3.0 * bond * np.pi * r**2
    return False if UNIT * bond > most else None


# Droplets between two particles


def between(one, two, r, s, gap, length, tension, load=0.0):
    particles = [
        iga.Sphere(one, r * length, (0.0, 0.0, -r * length)),
        iga.Sphere(two, s * length, (0.0, 0.0, (gap + s) * length)),
    ]
    given, size = fed(length, tension, load)
    gravity = [0.0, 0.3 * size, -size]
    return iga.sessile_droplet(None, gravity=gravity, particles=particles, **given)


def between_defects(result, one, two, r, s, length, tension, load=0.0, **_):
    """Both particles carry the weight; without it their forces are along their axis."""
    weight = UNIT * load * length * tension * np.array([0.0, 0.3, -1.0])
    below, above = pull(result, 0), pull(result, 1)
    unit = 2.0 * np.pi * min(r, s) * length * tension
    lines = [
        np.linalg.norm(result["forces"][k]["F_CL"]) / (2.0 * np.pi * size * length * tension)
        for k, size in enumerate((r, s))
    ]
    return {
        "weight": np.linalg.norm(below + above - weight) / (unit + np.linalg.norm(weight)),
        "across": 0.0 if load else np.hypot(*below[:2]) / unit,
        "line": max(0.0, max(lines) - 1.0),
    }


# A heavy particle that finds its height on a weightless sheet


def floating(particle, share, length, tension):
    """Its weight is a share of the most that a line carries."""
    most = 2.0 * np.pi * length * tension * np.cos(0.5 * np.radians(particle)) ** 2
    gravity = tension / (DENSITY * length**2)
    density = share * most / (gravity * UNIT * length**3)
    sphere = iga.Sphere(particle, length, (0.0, 0.0, -length), density, "vertical")
    return iga.liquid_sheet(
        sphere, size=12.0 * length, boundary="circle", liquid=iga.Liquid(tension), gravity=gravity
    )


def floating_defects(result, particle, share, length, tension):
    """The line is where it carries the weight: ``sin(phi) sin(phi + theta)``."""
    phi, theta = np.radians(result["measures"]["phi_deg"]), np.radians(particle)
    carried = np.sin(phi) * np.sin(phi + theta) / np.cos(0.5 * theta) ** 2
    return {
        "weight": carried / share - 1.0,
        "rest": np.linalg.norm(result["forces"][0]["F_e"]) / (length * tension),
    }
