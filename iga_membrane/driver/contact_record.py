"""Contact of a solved membrane with its substrate, by the names of the result file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..problems.scene import Scene
from ..results.contact_line import contact_line, vertical_forces
from ..results.contact_patches import substrate_patches, touches_base
from ..results.forces import pull_on_sphere, sphere_lines
from ..results.measures import own_asperity
from ..solids import SphereLattice, Spheres
from ..solvers.newton import NewtonResult
from ..terms import Scale
from ..verification.audit import young_cosine
from ..verification.evidence import Audit


def contact_record(
    scene: Scene,
    assembly: Assembly,
    result: NewtonResult,
    found: Mapping[str, Any],
    checked: Audit | None,
) -> dict[str, Any]:
    """Contact with the substrate, by the names of the result file."""
    surface, scale = result.surface, scene.units
    contact = assembly.contact
    if contact.carries or (contact.passes and not assembly.edges.wetted):
        return _patches(scene, assembly, result, found, checked)
    line = next(iter(scene.local_terms().wetting), None)
    if line is None:
        return {}
    unit, pulls = scale.length, []
    if line.ball is None:
        body = assembly.density(result.multipliers)
        at = contact_line(surface, line.edge)
        cosine = np.clip(young_cosine(scene, surface, line, at), -1.0, 1.0)
        angle = float(np.degrees(np.arccos(cosine)))
        forces = vertical_forces(at, body, assembly.tension, angle)
        pulled = forces.measured if line.pinned else forces.line
        support, solids = forces.push - pulled, 1
    else:
        pulls = [
            pull_on_sphere(scene, assembly, surface, result.multipliers, which).total
            for which in range(max(1, len(sphere_lines(scene))))
        ]
        support, solids = -float(scale.axes @ np.sum(pulls, axis=0) @ scene.up), len(pulls)
    wet = assembly.copies * assembly.edges.wet_areas(surface.points)[0] * scale.length**2
    rim = found.get("contact_radius", float(np.sqrt(max(wet, 0.0) / np.pi)))
    alone: dict[str, Any] = {}
    if line.ball is not None:
        unit *= line.ball.radius
        own = own_asperity(scene)
        if own is not None:
            angle, center = found["contact_angle_measured"], np.array(line.ball.center)
            row = _row(scale, own, center, pulls[0], wet, angle)
            alone = {"law": "contact lines", "asperities": [row], "touches_base": False}
    return alone | {
        "wet_solids": solids,
        "wet_area": wet,
        "wet_fraction": wet / (np.pi * rim**2),
        "max_penetration": _depth(checked, unit),
        "deepest_point": _deepest(scene, checked),
        "support_force": support * scale.force,
    }


def _row(
    scale: Scale, which: int, center: Array, force: Array, wet: float, angle: float
) -> dict[str, Any]:
    """One wet asperity; ``wet`` and ``angle`` in the user's units, the rest in the scene's. Its
    ``force`` presses it where it is positive, and pulls it up where it is negative."""
    pressed = -np.copysign(np.linalg.norm(force), force[2])
    return {
        "index": int(which),
        "center": scale.to_world(center).tolist(),
        "force": float(pressed) * scale.force,
        "force_vector": (scale.axes @ force * scale.force).tolist(),
        "wet_area": float(wet),
        "contact_angle": float(angle),
    }


def _depth(checked: Audit | None, unit: float) -> float | None:
    """Deepest penetration in the user's units; None where it was not looked for."""
    if checked is None or checked.penetration is None:
        return None
    return checked.penetration * unit


def _deepest(scene: Scene, checked: Audit | None) -> list[float] | None:
    """World point where the membrane lies deepest in the solid, or nearest to it."""
    if checked is None or checked.deepest is None:
        return None
    place: list[float] = scene.units.to_world(np.array(checked.deepest)).tolist()
    return place


def _patches(
    scene: Scene,
    assembly: Assembly,
    result: NewtonResult,
    found: Mapping[str, Any],
    checked: Audit | None,
) -> dict[str, Any]:
    """Contact area by area, by the names of the result file."""
    scale = scene.units
    body = assembly.density(result.multipliers)
    feet = substrate_patches(scene, assembly, result.surface, body)
    numbers = feet.which
    if scene.particles and isinstance(scene.substrate, (SphereLattice, Spheres)):
        # the membrane's solid is a list of its own
        numbers = scene.substrate.nearest(scale.to_world(feet.centers)).which
    wetted = feet.areas * scale.length**2
    rows = [
        _row(scale, *values)
        for values in zip(numbers, feet.centers, feet.forces, wetted, feet.angles, strict=True)
        if values[0] >= 0
    ]
    foot = np.pi * found["contact_radius"] ** 2 if "contact_radius" in found else 0.0
    wet = float(feet.areas.sum()) * scale.length**2
    return {
        "law": assembly.contact.law,
        "wet_solids": len(feet.which),
        "asperities": rows,
        "wet_area": wet,
        "wet_fraction": wet / foot if foot else None,
        "max_penetration": _depth(checked, assembly.contact.length * scale.length),
        "deepest_point": _deepest(scene, checked),
        "support_force": -float(feet.total[2]) * scale.force,
        "touches_base": touches_base(scene, assembly, result.surface, feet),
    }
