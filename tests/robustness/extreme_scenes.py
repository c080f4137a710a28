"""Randomized extreme scenes with a verdict on each result that shares no code with the solver.

``extreme_scenes(seed, count)`` is a Latin hypercube over kinds of scenes: droplets on planes,
tilted planes, spheres and lattices, films, caps, sheets, cells; contact angles 0.5 to 180, Bond
numbers 1e-4 to 1e3, lengths 1e-9 to 1e6, tensions 1e-6 to 1e6, distorted starts, penalties. Of each
is known whether an equilibrium exists (``True``), is ruled out (``False``), or not (``None``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.stats import qmc

import iga_membrane as iga
from iga_membrane.reference import cap_on_plane, catenoid, drop_on_plane
from iga_membrane.reference.catenoid import LIMIT
from iga_membrane.splines import points_of

UNIT = 4.0 * np.pi / 3.0
TOLERANCE = 1e-2
"""Relative error of a measure beyond which a success is a wrong answer."""


@dataclass(frozen=True)
class Extreme:
    """One scene of the hypercube.

    Attributes
    ----------
    kind : name in ``KINDS``; numbers : its place in [0, 1) along each of its directions.
    """

    kind: str
    numbers: tuple[float, ...]

    @property
    def parameters(self) -> dict[str, float]:
        """By name."""
        ranges = KINDS[self.kind].ranges
        found = {}
        for (name, (low, high)), u in zip(ranges.items(), self.numbers, strict=True):
            if low > 0 and high / low > 100:
                found[name] = float(low * (high / low) ** u)
            else:
                found[name] = float(low + (high - low) * u)
        return found

    def scene(self) -> iga.Scene:
        return KINDS[self.kind].scene(**self.parameters)

    def exists(self) -> bool | None:
        """Whether there is an equilibrium: known, ruled out, or not known."""
        known = KINDS[self.kind].exists
        return known(**self.parameters) if callable(known) else known

    def error(self, result: Mapping[str, Any]) -> float:
        """Largest relative error of the measures that are known."""
        expected = KINDS[self.kind].expected(result, **self.parameters)
        found = result["measures"] | {k: v for k, v in result["contact"].items() if k != "volume"}
        errors = [
            abs(found[name] - value) / max(abs(value), 1e-300) for name, value in expected.items()
        ]
        return max(errors, default=0.0)


@dataclass(frozen=True)
class Kind:
    share: float
    ranges: dict[str, tuple[float, float]]
    scene: Callable[..., iga.Scene]
    exists: bool | Callable[..., bool | None] | None
    expected: Callable[..., dict[str, float]] = lambda result, **parameters: {}


UNITS = {"length": (1e-9, 1e6), "tension": (1e-6, 1e6)}


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
    return iga.sessile_droplet(sphere, volume=UNIT * length**3, liquid=liquid, gravity=pull)


def weight(result, bond, length, tension, **_):
    return {"support_force": UNIT * bond * tension * length}


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
        penalty=penalty,
    )


def carries(radius, pitch, bond, **_):
    """Whether a lattice carries a droplet, from its pressure at rest on a plane; near the limit,
    or where the droplet stands on one or two asperities, this does not tell."""
    share = drop_on_plane(bond, 180.0)["p_base"] / carried(radius, (pitch * radius) ** 2)
    wide = drop_on_plane(bond, 180.0)["contact_radius"] > pitch * radius
    return True if share < 0.7 and wide else False if share > 1.5 else None


ANGLE = (0.5, 179.9)
KINDS = {
    "droplet": Kind(
        0.28,
        {"angle": ANGLE, "bond": (1e-4, 1e3), **UNITS, "distortion": (0.0, 0.3)},
        on_plane,
        True,
        plane_oracle,
    ),
    "cap": Kind(0.05, {"angle": ANGLE, **UNITS}, caps, True, cap_oracle),
    "contact area": Kind(
        0.07,
        {"bond": (1e-2, 300.0), **UNITS},
        flat_foot,
        True,
        flat_oracle,
    ),
    "tilted": Kind(
        0.07,
        {"angle": (20.0, 170.0), "bond": (1e-3, 30.0), "tilt": (1e-3, 10.0), **UNITS},
        tilted,
        False,
    ),
    "held": Kind(
        0.04,
        {"angle": (40.0, 150.0), "bond": (1e-3, 3.0), "tilt": (0.1, 10.0), **UNITS},
        held,
        True,
    ),
    "sphere": Kind(
        0.07,
        {"angle": (5.0, 175.0), "radius": (0.1, 30.0), **UNITS},
        on_sphere,
        True,
        sphere_oracle,
    ),
    "heavy on sphere": Kind(
        0.05,
        {"angle": (20.0, 160.0), "radius": (0.3, 10.0), "bond": (1e-3, 3.0), **UNITS},
        heavy_on_sphere,
        None,
        weight,
    ),
    "film": Kind(
        0.05,
        {"half_height": (0.05, 0.9), **UNITS},
        ringed,
        lambda half_height, **_: half_height < LIMIT,
        film_oracle,
    ),
    "bridge": Kind(0.03, {"half_height": (0.1, 2.5), **UNITS}, bridge, True, bridge_oracle),
    "cap of volume": Kind(
        0.04, {"volume": (0.01, 8.0), **UNITS}, cap_of_volume, True, volume_oracle
    ),
    "cap of pressure": Kind(
        0.05,
        {"pressure": (0.1, 2.6), **UNITS},
        cap_of_pressure,
        lambda pressure, **_: pressure < 2.0,
        pressure_oracle,
    ),
    "sheet": Kind(
        0.06,
        {"angle": (10.0, 170.0), "depth": (0.8, 1.2), "size": (2.5, 12.0), **UNITS},
        on_particle,
        None,
        particle_oracle,
    ),
    "leaning sheet": Kind(
        0.05,
        {
            "angle": (30.0, 150.0),
            "depth": (0.7, 1.3),
            "x": (0.01, 0.6),
            "bond": (1e-3, 1.0),
            **UNITS,
        },
        leaning_sheet,
        None,
    ),
    "cell": Kind(
        0.04,
        {"size": (2.2, 6.0), "part": (0.05, 1.4), **UNITS},
        cell,
        lambda part, **_: part < 1.0,
        cell_oracle,
    ),
    "lattice": Kind(
        0.04,
        {"radius": (0.06, 0.3), "pitch": (2.05, 4.0), "bond": (0.1, 5.0), **UNITS},
        lattice,
        carries,
        weight,
    ),
    "penalty": Kind(
        0.02,
        {
            "radius": (0.2, 0.5),
            "pitch": (2.05, 3.0),
            "bond": (0.1, 3.0),
            "penalty": (1e3, 1e9),
            **UNITS,
        },
        lattice,
        None,
        weight,
    ),
    "overload": Kind(
        0.02,
        {"radius": (0.1, 0.3), "pitch": (5.0, 8.0), "bond": (1.0, 10.0), **UNITS},
        lattice,
        carries,
        weight,
    ),
}


def extreme_scenes(seed: int, count: int = 300) -> list[Extreme]:
    """A hypercube per kind, in a random order."""
    found = []
    for number, (name, kind) in enumerate(KINDS.items()):
        some = max(1, round(kind.share * count))
        sampler = qmc.LatinHypercube(len(kind.ranges), rng=np.random.default_rng([seed, number]))
        found += [Extreme(name, tuple(row)) for row in sampler.random(some).tolist()]
    order = np.random.default_rng(seed).permutation(len(found))
    return [found[k] for k in order]


@dataclass(frozen=True)
class Hypercube:
    """Index to scene, for a sweep over processes."""

    seed: int
    count: int

    def __call__(self, index: int) -> iga.Scene:
        return extreme_scenes(self.seed, self.count)[index].scene()


def score(extreme: Extreme, record: Mapping[str, Any]) -> tuple[str, float | None]:
    """How a point ended: ``solved``, ``failed`` (typed), ``refused`` (before any work),
    ``wrong`` (a success that is none) or ``crashed``; and the error of a success."""
    if "result" not in record:
        refused = record["error"].startswith(("SceneError", "GeometryError"))
        return ("refused" if refused else "crashed"), None
    result = record["result"]
    if not result["success"]:
        return "failed", None
    error = extreme.error(result)
    wrong = extreme.exists() is False or not error <= TOLERANCE
    return ("wrong" if wrong else "solved"), error
