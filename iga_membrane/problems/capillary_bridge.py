"""A liquid bridge between two solids on one axis: planes and spheres in any pairing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..arguments import checked
from ..checks import instance, listed, number, shown, vector
from ..errors import SceneError
from ..initial.liquid import Discretization, Liquid, with_defaults
from ..solids import Plane, Sphere
from ..terms import Centroid, Contact, Gravity, Scale, SurfaceTension, Term, Volume
from ..units import implausible
from .bridge import Ends, bridge, easy_gap
from .description import described_substrate
from .recipe import Along, Recipe, family
from .scene import Ramp, Scene
from .spec import Foot, Question

SOLID = instance(Plane, Sphere)
GAP = "gap.distance"
"""Path of the distance in the scene file."""


def _along_the_axis(field: str, value: Any) -> float:
    """Acceleration along -z, from its size or a vector along z."""
    if not listed(value):
        return number("gravity.acceleration", value, least=0.0)
    x, y, z = vector(field, value)
    if x or y:
        raise SceneError(
            f"gravity.direction = {[x, y, z]}: must lie along the axis of the bridge, z; turn it"
        )
    return -z


@family
@checked(lower=SOLID, upper=SOLID, gap=GAP, volume="liquid.volume", gravity=_along_the_axis)
def capillary_bridge(
    lower: Plane | Sphere,
    upper: Plane | Sphere,
    *,
    gap: float,
    volume: float,
    liquid: Liquid | None = None,
    gravity: float | Sequence[float] = 0.0,
    discretization: Discretization | None = None,
) -> Scene:
    """Liquid between two solids on the z axis, which it wets at their contact angles, or to a rim.

    Parameters
    ----------
    lower, upper : plane, disc or sphere with its contact angle, 0 (perfectly wet) to 180 degrees;
        where they lie follows from the gap.
    gap : distance between the facing surfaces along z; the lower one has its top at z = 0.
    volume : of liquid, > 0.
    liquid : surface tension and density; both 1 by default.
    gravity : acceleration along -z, or a vector along z.
    discretization : space, degree, elements, model; all chosen by the scene if omitted.

    Returns
    -------
    Scene
        Its measures have ``force`` on the upper solid, positive = attraction, ``neck_radius``,
        ``contact_radius_lower`` and ``contact_radius_upper``.

    Raises
    ------
    SceneError
        A value out of its range, gravity across the axis, an angle that differs from place to
        place.
    """
    for name, solid in (("lower", lower), ("upper", upper)):
        if not isinstance(solid.contact_angle, (int, float)):
            raise SceneError(
                f"{name}.contact_angle = {shown(solid.contact_angle)}: must be one number; a "
                "bridge is round, and has no memory"
            )
    liquid, asked = with_defaults(liquid, discretization)
    gravity = float(np.ravel(gravity)[0])
    length = (3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)
    ends = _placed(lower, upper, gap)
    scale = Scale(length, liquid.surface_tension)
    scale.check_lengths("gap.distance", gap)
    acceleration = (0.0, 0.0, -gravity)
    weight = liquid.density * length**2 / liquid.surface_tension
    bond = weight * np.array(acceleration)
    parts = Question(
        ends[0], asked, scale, bond, None, liquid, Contact(ends[0]), "conforming", _balls(ends)
    )
    built = bridge(parts, ends)
    recipe = Recipe(
        "capillary_bridge",
        {
            "lower": lower,
            "upper": upper,
            "gap": gap,
            "volume": volume,
            "liquid": liquid,
            "gravity": list(acceleration),
            "discretization": replace(asked, model=built.sector.model),
        },
    )
    near = easy_gap(parts, ends)
    return Scene(
        built.surface,
        [*_terms(liquid, volume, acceleration, ends, built), *built.terms],
        [*built.supports, built.sector],
        scale=scale,
        grading=built.grading,
        ramp=None if near is None else Ramp(GAP, (near, gap), Along(recipe, GAP)),
        free_edge=built.free_edge,
        substrate=ends[0],
        particles=_balls(ends),
        acceleration=acceleration,
        liquid_density=liquid.density,
        recipe=recipe,
        kind="capillary_bridge",
        description={
            "scene": "capillary_bridge",
            "liquid": {
                "surface_tension": liquid.surface_tension,
                "density": liquid.density,
                "volume": volume,
            },
            "gravity": {
                "acceleration": abs(gravity),
                "direction": [0.0, 0.0, 1.0 if gravity < 0.0 else -1.0],
            },
            "lower": described_substrate(_unplaced(lower)),
            "upper": described_substrate(_unplaced(upper)),
            "gap": {"distance": gap},
            "discretization": built.mesh.described(built.sector.model),
        },
        warnings=implausible(gravity, liquid.surface_tension, liquid.density, volume),
    )


def _placed(lower: Plane | Sphere, upper: Plane | Sphere, gap: float) -> Ends:
    """The solids where they face each other."""
    below: Plane | Sphere = (
        replace(lower, point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
        if isinstance(lower, Plane)
        else replace(lower, center=(0.0, 0.0, -lower.radius), motion="fixed")
    )
    above: Plane | Sphere = (
        replace(upper, point=(0.0, 0.0, gap), normal=(0.0, 0.0, -1.0))
        if isinstance(upper, Plane)
        else replace(upper, center=(0.0, 0.0, gap + upper.radius), motion="fixed")
    )
    return below, above


def _unplaced(solid: Plane | Sphere) -> Plane | Sphere:
    if isinstance(solid, Plane):
        return replace(solid, point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    return replace(solid, center=(0.0, 0.0, -solid.radius))


def _balls(ends: Ends) -> tuple[Sphere, ...]:
    """The spheres among the solids, on which forces are told one by one."""
    return tuple(solid for solid in ends if isinstance(solid, Sphere))


def _terms(
    liquid: Liquid,
    volume: float,
    acceleration: tuple[float, float, float],
    ends: Ends,
    built: Foot,
) -> list[Term]:
    """What the liquid pays for, its contact left out."""
    terms: list[Term] = [SurfaceTension(liquid.surface_tension), Volume(volume)]
    if any(acceleration):
        terms.append(Gravity(liquid.density, acceleration))
    # between two planes nothing tells where it is
    slides = not _balls(ends) and all(support.kind == "sliding" for support in built.supports)
    loose = "xy" if slides else ""
    return terms + [Centroid(axis) for axis in loose if axis not in built.sector.mirrored]
