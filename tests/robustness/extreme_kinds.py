"""The kinds of extreme scenes: how often, over which ranges, what is known of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from robustness import extreme_droplets as droplets
from robustness import extreme_particles as particles
from robustness import extreme_sheets as sheets

import iga_membrane as iga
from iga_membrane.reference.catenoid import LIMIT


@dataclass(frozen=True)
class Kind:
    """How often, over which ranges, what is known: ``expected`` values of measures, and ``defects``
    of laws, already relative."""

    share: float
    ranges: dict[str, tuple[float, float]]
    scene: Callable[..., iga.Scene]
    exists: bool | Callable[..., bool | None] | None
    expected: Callable[..., dict[str, float]] = lambda result, **parameters: {}
    defects: Callable[..., dict[str, float]] = lambda result, **parameters: {}


UNITS = {"length": (1e-9, 1e6), "tension": (1e-6, 1e6)}


ANGLE = (0.5, 179.9)
ON_CAP = {
    "angle": (60.0, 165.0),
    "particle": (35.0, 145.0),
    "r": (0.08, 0.4),
    "place": (0.0, 1.0),
}
ON_DROPLET = {
    "angle": (60.0, 165.0),
    "particle": (45.0, 135.0),
    "r": (0.08, 0.35),
    "bond": (1e-2, 2.0),
    "place": (0.0, 1.0),
    "shift": (-0.4, 0.4),
}
WAY = {"azimuth": (0.0, 6.28), "height": (-0.99, 0.99)}
PAIR = {
    "one": (30.0, 110.0),
    "two": (30.0, 110.0),
    "r": (0.3, 1.0),
    "s": (0.3, 1.0),
}
KINDS = {
    "droplet": Kind(
        0.28,
        {"angle": ANGLE, "bond": (1e-4, 1e3), **UNITS, "distortion": (0.0, 0.3)},
        droplets.on_plane,
        True,
        droplets.plane_oracle,
    ),
    "cap": Kind(0.05, {"angle": ANGLE, **UNITS}, droplets.caps, True, droplets.cap_oracle),
    "contact area": Kind(
        0.07,
        {"bond": (1e-2, 300.0), **UNITS},
        droplets.flat_foot,
        True,
        droplets.flat_oracle,
    ),
    "tilted": Kind(
        0.07,
        {"angle": (20.0, 170.0), "bond": (1e-3, 30.0), "tilt": (1e-3, 10.0), **UNITS},
        droplets.tilted,
        False,
    ),
    "held": Kind(
        0.04,
        {"angle": (40.0, 150.0), "bond": (1e-3, 3.0), "tilt": (0.1, 10.0), **UNITS},
        droplets.held,
        True,
    ),
    "sphere": Kind(
        0.07,
        {"angle": (5.0, 175.0), "radius": (0.1, 30.0), **UNITS},
        droplets.on_sphere,
        True,
        droplets.sphere_oracle,
    ),
    "heavy on sphere": Kind(
        0.05,
        {"angle": (20.0, 160.0), "radius": (0.3, 10.0), "bond": (1e-3, 3.0), **UNITS},
        droplets.heavy_on_sphere,
        None,
        droplets.weight,
    ),
    "film": Kind(
        0.05,
        {"half_height": (0.05, 0.9), **UNITS},
        sheets.ringed,
        lambda half_height, **_: half_height < LIMIT,
        sheets.film_oracle,
    ),
    "bridge": Kind(
        0.03, {"half_height": (0.1, 2.5), **UNITS}, sheets.bridge, True, sheets.bridge_oracle
    ),
    "swollen bridge": Kind(
        0.03,
        {"half_height": (0.2, 1.0), "ratio": (1.0, 12.0), **UNITS},
        sheets.swollen,
        sheets.swollen_exists,
    ),
    "cap of volume": Kind(
        0.04, {"volume": (0.01, 8.0), **UNITS}, sheets.cap_of_volume, True, sheets.volume_oracle
    ),
    "cap of pressure": Kind(
        0.05,
        {"pressure": (0.1, 2.6), **UNITS},
        sheets.cap_of_pressure,
        lambda pressure, **_: pressure < 2.0,
        sheets.pressure_oracle,
    ),
    "sheet": Kind(
        0.06,
        {"angle": (10.0, 170.0), "depth": (0.8, 1.2), "size": (2.5, 12.0), **UNITS},
        sheets.on_particle,
        None,
        sheets.particle_oracle,
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
        sheets.leaning_sheet,
        None,
    ),
    "cell": Kind(
        0.04,
        {"size": (2.2, 6.0), "part": (0.05, 1.4), **UNITS},
        droplets.cell,
        lambda part, **_: part < 1.0,
        droplets.cell_oracle,
    ),
    "lattice": Kind(
        0.04,
        {"radius": (0.06, 0.3), "pitch": (2.05, 4.0), "bond": (0.1, 5.0), **UNITS},
        droplets.lattice,
        droplets.carries,
        droplets.weight,
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
        droplets.lattice,
        None,
        droplets.weight,
    ),
    "overload": Kind(
        0.02,
        {"radius": (0.1, 0.3), "pitch": (5.0, 8.0), "bond": (1.0, 10.0), **UNITS},
        droplets.lattice,
        droplets.carries,
        droplets.weight,
    ),
    "particle on cap": Kind(
        0.05, {**ON_CAP, **UNITS}, particles.on_cap, True, defects=particles.cap_defects
    ),
    "cap ends on particle": Kind(
        0.04, {**ON_CAP, **UNITS}, particles.ends_on_cap, True, defects=particles.cap_defects
    ),
    "particle finds rest": Kind(
        0.02,
        {**ON_CAP, "shift": (-0.3, 0.3), **UNITS},
        particles.finds_rest,
        None,
        defects=particles.rest_defects,
    ),
    "particle on droplet": Kind(
        0.03,
        {**ON_DROPLET, **UNITS},
        particles.on_droplet,
        None,
        defects=particles.droplet_defects,
    ),
    "droplet ends on particle": Kind(
        0.02,
        {**ON_DROPLET, **UNITS},
        particles.ends_on_droplet,
        None,
        defects=particles.droplet_defects,
    ),
    "too heavy particle": Kind(
        0.007,
        {
            "angle": (90.0, 160.0),
            "particle": (45.0, 135.0),
            "r": (0.1, 0.3),
            "bond": (1e-2, 1.0),
            "share": (1.5, 20.0),
            **UNITS,
        },
        particles.too_heavy,
        False,
    ),
    "free droplet": Kind(
        0.06,
        {"particle": (5.0, 175.0), "r": (0.05, 10.0), **WAY, **UNITS},
        particles.free,
        True,
        defects=particles.free_defects,
    ),
    "pulled droplet": Kind(
        0.03,
        {
            "particle": (20.0, 150.0),
            "r": (0.1, 0.6),
            **WAY,
            "stretch": (-0.3, 0.3),
            **UNITS,
        },
        particles.pulled,
        None,
        defects=particles.pulled_defects,
    ),
    "torn droplet": Kind(
        0.01,
        {"particle": (20.0, 150.0), "r": (0.1, 0.5), **WAY, "stretch": (10.0, 40.0), **UNITS},
        particles.pulled,
        False,
    ),
    "hanging droplet": Kind(
        0.04,
        {"particle": (20.0, 140.0), "r": (0.1, 1.0), **WAY, "bond": (1e-2, 1.0), **UNITS},
        particles.free,
        particles.hangs,
        defects=particles.hanging_defects,
    ),
    "particle bridge": Kind(
        0.04,
        {**PAIR, "gap": (0.05, 1.0), **UNITS},
        particles.between,
        None,
        defects=particles.between_defects,
    ),
    "loaded particle bridge": Kind(
        0.02,
        {**PAIR, "gap": (0.05, 1.0), "load": (1e-3, 0.3), **UNITS},
        particles.between,
        None,
        defects=particles.between_defects,
    ),
    "torn bridge": Kind(0.015, {**PAIR, "gap": (20.0, 40.0), **UNITS}, particles.between, False),
    "floating particle": Kind(
        0.04,
        {"particle": (20.0, 150.0), "share": (0.05, 1.5), **UNITS},
        particles.floating,
        lambda share, **_: False if share > 1.0 else None,
        defects=particles.floating_defects,
    ),
    "cell with a line": Kind(
        0.05,
        {"angle": (90.0, 172.0), "size": (2.2, 6.0), "part": (0.05, 1.4), **UNITS},
        droplets.lined_cell,
        lambda part, **_: part < 1.0,
        droplets.lined_cell_oracle,
    ),
    "lattice with lines": Kind(
        0.02,
        {
            "angle": (136.0, 171.0),
            "radius": (0.05, 0.1),
            "pitch": (2.5, 4.5),
            "bond": (0.3, 2.0),
            **UNITS,
        },
        droplets.lined_lattice,
        droplets.lines_carry,
        defects=droplets.lined_defects,
    ),
    "many with lines": Kind(
        0.03,
        {
            "angle": (115.0, 171.0),
            "radius": (0.008, 0.02),
            "pitch": (3.0, 6.0),
            "bond": (0.3, 2.0),
            **UNITS,
        },
        droplets.lined_lattice,
        droplets.lines_carry,
        defects=droplets.lined_defects,
    ),
    "many overloaded": Kind(
        0.007,
        {
            "angle": (115.0, 171.0),
            "radius": (0.01, 0.03),
            "pitch": (16.0, 30.0),
            "bond": (1.0, 5.0),
            **UNITS,
        },
        droplets.lined_lattice,
        droplets.lines_carry,
        defects=droplets.lined_defects,
    ),
    "any roughness": Kind(
        0.02,
        {
            "angle": ANGLE,
            "radius": (0.01, 1.01),
            "pitch": (2.05, 6.0),
            "bond": (1e-4, 1e3),
            **UNITS,
        },
        droplets.lined_lattice,
        None,
        defects=droplets.lined_defects,
    ),
    "whole system": Kind(
        0.01,
        {
            "angle": (140.0, 165.0),
            "radius": (0.07, 0.1),
            "pitch": (2.6, 3.5),
            "bond": (0.3, 1.5),
            "grain": (50.0, 120.0),
            "size": (0.2, 0.4),
            "shift": (-0.3, 0.3),
            **UNITS,
        },
        droplets.whole_system,
        None,
        defects=droplets.whole_defects,
    ),
}
