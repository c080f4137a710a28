"""Droplets, substrates and particles by the names of the scene file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import Array
from ..initial.liquid import Liquid
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..solids.disc import Disc
from ..solids.hysteresis import Hysteresis
from ..solids.wettability import varies


def described_droplet(
    substrate: Solid | None,
    volume: float,
    liquid: Liquid,
    acceleration: Array,
    hold: str,
    particles: Sequence[Sphere],
) -> dict[str, Any]:
    """A droplet's scene but for its mesh."""
    size = float(np.linalg.norm(acceleration))
    direction = acceleration / size if size else np.array([0.0, 0.0, -1.0])
    return {
        "scene": "sessile_droplet",
        "liquid": {
            "surface_tension": liquid.surface_tension,
            "density": liquid.density,
            "volume": volume,
        },
        "gravity": {"acceleration": size, "direction": [float(d) for d in direction]},
        "substrate": described_substrate(substrate),
        "particle": [described_particle(each) for each in particles],
        "droplet": {"hold": hold},
    }


def described_substrate(substrate: Solid | None) -> dict[str, Any]:
    match substrate:
        case None:
            return {"kind": "none"}
        case Sphere():
            size: dict[str, Any] = {
                "kind": "sphere",
                "contact_angle": substrate.contact_angle,
                "radius": substrate.radius,
            }
            top = substrate.center == (0.0, 0.0, -substrate.radius)
            return size if top else size | {"center": list(substrate.center)}
        case Disc():
            disc = {"kind": "disc", "radius": substrate.radius, "edge": substrate.edge}
            disc |= {"contact_angle": substrate.contact_angle}
            if substrate.point == (0.0, 0.0, 0.0) and substrate.normal == (0.0, 0.0, 1.0):
                return disc
            return disc | {"point": list(substrate.point), "normal": list(substrate.normal)}
        case Plane():
            plane = {"kind": "plane"} | _angle(substrate)
            if substrate == Plane(substrate.contact_angle):
                return plane
            return plane | {"point": list(substrate.point), "normal": list(substrate.normal)}
        case SphereLattice():
            lattice = {
                "kind": "sphere_lattice",
                "contact_angle": substrate.contact_angle,
                "radius": substrate.radius,
                "spacing": substrate.spacing,
                "arrangement": substrate.arrangement,
                "offset": list(substrate.offset),
            }
            return lattice if substrate.base is None else lattice | {"base": substrate.base}
        case Spheres():
            spheres = {
                "kind": "spheres",
                "contact_angle": np.asarray(substrate.contact_angle).tolist(),
                "centers": np.asarray(substrate.centers).tolist(),
                "radii": np.asarray(substrate.radii).tolist(),
            }
            return spheres if substrate.base is None else spheres | {"base": substrate.base}
        case _:
            own = getattr(substrate, "described", lambda: {"kind": type(substrate).__name__})
            return dict(own()) | _angle(substrate)


def _angle(substrate: Solid) -> dict[str, Any]:
    """Contact angle, or the kind of field that stands in its place."""
    angle = substrate.contact_angle
    if varies(angle):
        return {"wettability": angle.described()}
    if isinstance(angle, Hysteresis):
        return {"contact_angle": {"receding": angle.receding, "advancing": angle.advancing}}
    return {"contact_angle": np.asarray(angle).tolist()}


def described_particle(particle: Sphere) -> dict[str, Any]:
    """A particle by the names of the scene file."""
    return {
        "radius": particle.radius,
        "center": list(particle.center),
        "density": particle.density,
        "contact_angle": particle.contact_angle,
        "motion": particle.motion,
    }
