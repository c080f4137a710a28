"""A droplet at rest on a substrate (paper section 6.1, figure 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import either, instance, vector, wet_angle, words
from ..errors import SceneError
from ..fields import as_acceleration
from ..initial.closed_droplet import STARTS
from ..initial.liquid import Discretization, Liquid, with_defaults
from ..initial.particle_placement import check_particles
from ..own import is_own
from ..solids import Plane, Solid, Sphere
from ..solids.own import check_solid
from ..solids.wettability import varies
from ..surface.surface import Surface
from ..terms import (
    Centroid,
    Contact,
    Gravity,
    Scale,
    SurfaceTension,
    Term,
    Volume,
)
from ..terms.term import ROOM
from .bridge import Ends, ends_of
from .bridge import frame_of as frame_between
from .contact_setup import CONTACT_LINES
from .description import described_droplet
from .droplet_ways import (
    between_particles,
    built_for,
    ramp_of,
    with_its_particles,
    with_its_ways,
)
from .free import frame_of, seat_of
from .hints import hints
from .memory import placed_on
from .moving import check_fixed, fixed
from .one_asperity import discretizations as asperity_lines
from .osman_sauer import WholeMembrane
from .osman_sauer_droplet import by_whole_membrane
from .particle_foot import discretizations as particle_lines
from .recipe import Recipe, family
from .scene import Scene
from .spec import Foot, Question
from .well_posed import refuse_perfectly_wet

ROUNDING = 1e-12
"""Part of gravity along an axis of the scene below which it has none there."""


@family
@checked(
    volume="liquid.volume",
    gravity=as_acceleration,
    hold="droplet.hold",
    start=either(words(*STARTS), instance(Surface)),
    penalty="solver.penalty",
    penetration_tolerance="solver.penetration_tolerance",
    contact_line=words(*CONTACT_LINES),
    placed_at=wet_angle,
)
def sessile_droplet(
    substrate: Solid | None,
    *,
    volume: float,
    liquid: Liquid | None = None,
    gravity: float | Sequence[float] = 0.0,
    discretization: Discretization | None = None,
    hold: str = "none",
    start: Surface | str | None = None,
    penalty: float | None = None,
    penetration_tolerance: float = 1e-2,
    contact_line: str = "auto",
    particles: Sequence[Sphere] = (),
    membrane: WholeMembrane | None = None,
    placed_at: float | None = None,
) -> Scene:
    """Droplet of a volume on a plane, on top of a sphere, on asperities, or free.

    Below 180 degrees it has a contact line; at 180 its foot is a contact area and the whole skin is
    one closed membrane. On asperities below 180 degrees that membrane passes through them, with a
    contact line on each.

    Parameters
    ----------
    substrate : the solid with its contact angle: ``Plane``, ``Sphere``, ``SphereLattice``,
        ``Spheres``, or any ``Solid`` of your own at 180 degrees; None for a droplet about the
        origin that touches nothing but a particle, or one that bridges two wherever they are.
    volume : of liquid, > 0.
    liquid : surface tension and density; both 1 by default.
    gravity : acceleration >= 0 along -z, or a vector.
    discretization : space, degree, elements, model.
    hold : "none", or the axes (of the plane's frame) along which a uniform body force holds the
        centroid: "x", "xy", "xyz"; of a free droplet "none" or "xyz".
    start : a surface of the same space to start from, in world coordinates; at 180 degrees also
        "flat", the drop on a plane through the tops, "touching" or "above", a sphere.
    penalty : None for exact contact, else the paper's penalty (eq. 24): traction over depth in
        units of tension over squared length, length that of a ball of the volume.
    penetration_tolerance : depth over the radius of the smallest sphere (plane: over the length)
        that exact contact leaves at most and beyond which a state is no success.
    contact_line : "conforming", the membrane ends on it (planes, spheres, one particle beside a
        plane); "trimmed", it passes through the sphere, the asperities or the particles;
        "adhesion", it lies on asperities that attract it, for angles near 180 degrees; "auto"
        chooses: on one fixed particle the membrane ends, and where that fails passes through it.
    particles : spheres on its surface, with contact angles, densities and motions.
    placed_at : angle at which a droplet is placed on a plane with hysteresis, within it; by default
        that of the mean cosine.
    membrane : the paper's formulation, with its own penalty: below 180 degrees on a plane, instead
        of a contact line as the membrane's edge; at 180 degrees on a plane or asperities.

    Raises
    ------
    SceneError
        A value out of its range; a model with a mirror plane that gravity or the substrate does not
        have; a start below the substrate.
    """
    liquid, mesh = with_defaults(liquid, discretization)
    given, substrate = substrate, placed_on(substrate, placed_at, particles)
    if membrane is not None:
        penalty = membrane.penalty_of(substrate, penalty)
    grains = check_particles(particles)
    length = (3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)
    place = _placed(substrate, grains, hold, contact_line, length)
    acceleration = np.array(gravity)
    local = acceleration @ place.axes
    # a scene that is turned as a whole leans by rounding
    local[np.abs(local) <= ROUNDING * np.abs(local).max()] = 0.0
    if grains or penalty is not None or start is not None:
        contact_line, *others = particle_lines(substrate, grains, contact_line)
    else:
        pushed = any(pull and axis not in hold for axis, pull in zip("xy", local, strict=False))
        contact_line, *others = asperity_lines(place.carrier, length, pushed, contact_line)
    x, y, z = (tuple(float(a) for a in row) for row in place.axes)
    scale = Scale(length, liquid.surface_tension, place.origin, (x, y, z))
    bond = _bond_numbers(volume, liquid, local, scale)
    _check_carrier(place, scale, bond, hold)
    unit = liquid.surface_tension / length**2
    stiffness = None if penalty is None else penalty * unit
    law = Contact(place.carrier, stiffness, penetration_tolerance)
    held = "" if hold == "none" else hold
    beside = fixed(grains) if substrate is not None else ()
    parts = Question(
        place.carrier, mesh, scale, bond, start, liquid, law, contact_line, beside, held
    )
    built = built_for(parts, place.ends)
    terms = _terms(parts, built, volume, acceleration, grains)
    recipe = Recipe(
        "sessile_droplet",
        {
            "substrate": given,
            "placed_at": placed_at,
            "volume": volume,
            "liquid": liquid,
            "gravity": list(cast(Sequence[float], gravity)),
            "discretization": replace(mesh, model=built.sector.model),
            "hold": hold,
            "contact_line": contact_line,
            "particles": fixed(grains),
            "penalty": penalty,
            "penetration_tolerance": penetration_tolerance,
        },
    )
    described = described_droplet(given, volume, liquid, acceleration, hold, grains)
    pull = float(np.linalg.norm(acceleration))
    scene = Scene(
        built.surface,
        [*terms, *built.terms],
        [*built.supports, built.sector],
        scale=scale,
        grading=built.grading,
        directions=built.directions,
        ramp=ramp_of(parts, place.ends, built, recipe, pull),
        substrate=place.carrier,
        particles=fixed(grains),
        acceleration=vector("gravity", acceleration),
        liquid_density=liquid.density,
        hold=held,
        recipe=recipe,
        kind="sessile_droplet",
        description=described | {"discretization": built.mesh.described(built.sector.model)},
        warnings=hints(place.carrier, liquid, volume, pull, tuple(bond)),
    )
    if membrane is not None:
        return by_whole_membrane(scene, mesh, parts.down, start, membrane)
    if others:
        # a mesh that was chosen for one asperity says nothing of another's discretization
        again = mesh if grains else Discretization()
        other = recipe.changed(contact_line=others[0], discretization=again)
        scene = replace(scene, otherwise=other)
    return _with_ways(scene, place, built, parts, terms, grains)


def _with_ways(
    scene: Scene,
    place: _Place,
    built: Foot,
    parts: Question,
    terms: list[Term],
    grains: tuple[Sphere, ...],
) -> Scene:
    """The scene with its particles, and its ways round a failing solve."""
    if place.ends is not None or place.free:
        return between_particles(scene, built, grains, place.axes[:, 2])
    if grains:
        return with_its_particles(scene, built, grains, terms)
    return with_its_ways(scene, built, parts, terms)


@dataclass(frozen=True, eq=False)
class _Place:
    """Where a droplet is.

    Attributes
    ----------
    carrier : the solid it stands on, or the particle that carries a free one.
    ends : the two solids that it bridges, or None.
    origin, axes : of its frame; axes are columns.
    free : whether it touches nothing but particles.
    """

    carrier: Solid
    ends: Ends | None
    origin: tuple[float, float, float]
    axes: Array
    free: bool


def _placed(
    substrate: Solid | None,
    grains: tuple[Sphere, ...],
    hold: str,
    contact_line: str,
    length: float,
) -> _Place:
    """Where a droplet of a length is, on what was asked for."""
    carrier = seat_of(grains, hold) if substrate is None else substrate
    check_fixed(carrier)
    ends = ends_of(substrate, grains, contact_line, length)
    if ends is not None:
        return _Place(carrier, ends, *frame_between(ends), substrate is None)
    refuse_perfectly_wet("substrate", substrate)
    for i, each in enumerate(grains):
        refuse_perfectly_wet(f"particle[{i}]", each)
    return _Place(carrier, None, *_frame(carrier, free=substrate is None), substrate is None)


def _check_carrier(place: _Place, scale: Scale, bond: Array, hold: str) -> None:
    """Refuse solids that the scene's frame cannot hold, and gravity across a free droplet."""
    scale.local_solid(place.carrier)  # refuses sizes that it cannot hold
    check = getattr(place.carrier, "check", None)
    if check is not None:
        check(place.origin, scale.length)
    elif is_own(place.carrier):
        check_solid(place.carrier, place.origin, scale.length)
    across = float(np.linalg.norm(bond[:2]))
    hangs = place.free and place.ends is None and hold == "none"
    if hangs and across > 1e-9 * np.linalg.norm(bond):
        raise SceneError(
            "gravity.direction: a free droplet hangs on its particle along gravity, here they "
            'differ; move the particle, or hold the droplet by droplet.hold = "xyz"'
        )


def _terms(
    parts: Question, built: Foot, volume: float, acceleration: Array, grains: tuple[Sphere, ...]
) -> list[Term]:
    """What the liquid pays for, its contact left out."""
    liquid = parts.liquid
    terms: list[Term] = [SurfaceTension(liquid.surface_tension), Volume(volume)]
    if parts.bond.any():
        gx, gy, gz = (float(g) for g in acceleration)
        terms.append(Gravity(liquid.density, (gx, gy, gz)))
    movable = "".join(axis for axis in "xyz" if axis not in built.sector.mirrored)
    even = not varies(parts.substrate.contact_angle)
    on_plane = isinstance(parts.substrate, Plane) and even and not grains
    pinned = movable.strip("z") if on_plane else ""
    return terms + [Centroid(axis) for axis in movable if axis in pinned or axis in parts.held]


def _frame(substrate: Solid, *, free: bool) -> tuple[tuple[float, float, float], Array]:
    """Origin and axes of the scene: on the plane, at the top of the sphere, or those of a free
    droplet."""
    if free:
        assert isinstance(substrate, Sphere)
        return (0.0, 0.0, 0.0), frame_of(substrate)
    if isinstance(substrate, Plane):
        return substrate.point, substrate.axes()
    if not isinstance(substrate, Sphere):
        return (0.0, 0.0, 0.0), np.eye(3)
    x, y, z = substrate.center
    return (x, y, z + substrate.radius), np.eye(3)


def _bond_numbers(volume: float, liquid: Liquid, acceleration: Array, scale: Scale) -> Array:
    """(3,) Bond numbers of an acceleration along the scene's axes."""
    bond = liquid.density * acceleration * scale.length**2 / liquid.surface_tension
    size = float(np.abs(bond).max())
    if size and not 1.0 / ROOM < size < ROOM:
        raise SceneError(
            f"liquid.volume = {volume:g}, liquid.density = {liquid.density:g}, gravity = "
            f"{acceleration.tolist()}, liquid.surface_tension = {liquid.surface_tension:g}: their "
            f"Bond number {size:g} must be 0 or from {1.0 / ROOM:g} to {ROOM:g}; beyond it double "
            "precision has no room; choose other units"
        )
    return np.asarray(bond)
