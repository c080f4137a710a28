"""A droplet at rest on a substrate (paper section 6.1, figure 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import choice, number, record, vector
from ..errors import SceneError
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..surface.supports import Sector
from ..surface.surface import Surface
from ..terms import (
    Centroid,
    Contact,
    Gravity,
    Scale,
    SphereContactLine,
    SurfaceTension,
    Term,
    TrimmedContactLine,
    Volume,
)
from .beside import check_particles
from .bridge import axes_between, bridge, moved_apart, room_between
from .foot import (
    CONTACT_LINES,
    PREDICTABLE,
    Foot,
    Question,
    foot_of,
    rim_radius,
    with_angle,
    with_rim,
)
from .free import at_displacement, frame_of, pulled_by, seat_of
from .liquid import Discretization, Liquid, with_defaults
from .moving import check_fixed, fixed, moving
from .particle_foot import with_particles
from .scene import FreeEdge, Ramp, Scene, described_particle
from .whole_membrane import WholeMembrane, droplet_with_wetted_part

HOLDS = ("none", "x", "xy", "xyz")


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
        chooses.
    particles : spheres on its surface, with contact angles, densities and motions; the membrane
        passes through them, or ends on one.
    membrane : the paper's formulation, with its own penalty, instead of a contact line as the
        membrane's edge; on a plane, below 180 degrees.

    Raises
    ------
    SceneError
        A value out of its range; a model with a mirror plane that gravity or the substrate does not
        have; a start below the substrate.
    """
    liquid, asked = with_defaults(liquid, discretization)
    grains = check_particles(particles)
    asked_substrate, beside = substrate, fixed(grains)
    if substrate is None:
        # its particle carries it
        substrate, beside = seat_of(grains, hold), ()
    record("substrate", substrate, Solid)
    check_fixed(substrate)
    volume = number("liquid.volume", volume, above=0.0)
    choice("droplet.hold", hold, HOLDS)
    choice("solver.contact_line", contact_line, CONTACT_LINES)
    acceleration = _acceleration(gravity)
    bridges = asked_substrate is None and len(grains) == 2
    if bridges:
        origin, axes = grains[0].center, axes_between(grains)
    else:
        origin, axes = _frame(substrate, free=asked_substrate is None)
    length = (3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)
    x, y, z = (tuple(float(a) for a in row) for row in axes)
    scale = Scale(length, liquid.surface_tension, origin, (x, y, z))
    with np.errstate(over="ignore", invalid="ignore"):
        bond = liquid.density * (acceleration @ axes) * length**2 / liquid.surface_tension
    if not (np.isfinite(bond).all() and 0.0 < length**3 < np.inf):
        raise SceneError(
            f"liquid.volume = {volume:g}, density, gravity, surface_tension: their Bond number or "
            "length leaves the range of floating point numbers; choose other units"
        )
    across = float(np.linalg.norm(bond[:2]))
    hangs = asked_substrate is None and not bridges and hold == "none"
    if hangs and across > 1e-9 * np.linalg.norm(bond):
        raise SceneError(
            "gravity.direction: a free droplet hangs on its particle along gravity, here they "
            'differ; move the particle, or hold the droplet by droplet.hold = "xyz"'
        )
    terms: list[Term] = [SurfaceTension(liquid.surface_tension), Volume(volume)]
    if bond.any():
        gx, gy, gz = (float(g) for g in acceleration)
        terms.append(Gravity(liquid.density, (gx, gy, gz)))
    law = Contact(
        substrate,
        None if penalty is None else penalty * liquid.surface_tension / length**2,
        penetration_tolerance,
    )
    held = "" if hold == "none" else hold
    parts = Question(substrate, asked, scale, bond, start, liquid, law, contact_line, beside, held)
    if bridges:
        built = bridge(parts, fixed(grains))
    else:
        built = with_particles(parts) if beside else foot_of(parts)
    sector = built.sector
    movable = "".join(axis for axis in "xyz" if axis not in sector.mirrored)
    pinned = movable.strip("z") if isinstance(substrate, Plane) and not grains else ""
    terms += [Centroid(axis) for axis in movable if axis in pinned or axis in held]
    pull = float(np.linalg.norm(acceleration))

    def again(**changed: Any) -> Scene:
        given: dict[str, Any] = {
            "substrate": asked_substrate,
            "volume": volume,
            "liquid": liquid,
            "gravity": [float(g) for g in acceleration],
            "discretization": replace(asked, model=sector.model),
            "hold": hold,
            "contact_line": contact_line,
            "particles": fixed(grains),
        }
        return sessile_droplet(**given | changed)

    def at(size: float) -> Scene:
        return again(gravity=[size / pull * g for g in acceleration])

    def moved(displacement: float) -> Sphere:
        return at_displacement(grains[0], length, displacement)

    # at 180 degrees on a plane there is nothing to start from without gravity
    has_way = isinstance(substrate, Sphere) or (
        isinstance(substrate, Plane) and substrate.contact_angle < 180.0
    )
    described = _describe(asked_substrate, volume, liquid, acceleration, hold, grains)
    ramp = None
    if bridges and (near := -room_between(grains, length)) < 0.0:

        def apart(displacement: float) -> Scene:
            return again(particles=[grains[0], moved_apart(grains, displacement)])

        ramp = Ramp("particle[1] displacement", (near, 0.0), apart)
    elif bond.any() and has_way:
        ramp = Ramp("gravity.acceleration", (0.0, pull), at)
    elif asked_substrate is None and held:
        values = (0.0, pulled_by(grains[0], length))
        ramp = Ramp("particle[0] displacement", values, lambda d: again(particles=[moved(d)]))
    scene = Scene(
        built.surface,
        [*terms, *built.terms],
        [*built.supports, sector],
        scale=scale,
        grading=built.grading,
        directions=built.directions,
        ramp=ramp,
        substrate=substrate,
        particles=fixed(grains),
        acceleration=vector("gravity", acceleration),
        liquid_density=liquid.density,
        hold=held,
        kind="sessile_droplet",
        description=described | {"discretization": built.mesh.described(sector.model)},
        warnings=_hints(
            substrate, bond, sector, rolls=asked_substrate is not None or not (held or bridges)
        ),
    )
    if membrane is not None:
        return droplet_with_wetted_part(scene, asked, parts.down, parts.law, start, membrane)
    if asked_substrate is None:
        toward = axes[:, 2] * [[1.0], [-1.0]][: len(grains)]
        gamma = liquid.surface_tension
        return moving(scene, grains, toward, gamma, lambda at: again(particles=at))
    if grains:
        line, gamma = built.terms[-1], liquid.surface_tension
        if built.alone is None:
            alone = again(
                particles=(), hold="none", discretization=Discretization(), contact_line="auto"
            )
        else:
            # it must not roll away from its particles
            bare = [*terms, *(Centroid(axis) for axis in movable.strip("z") if axis not in held)]
            alone = _with_start(replace(scene, particles=()), bare, built.alone)
        scene = _with_particles(replace(scene, start_from=built.start_from), alone)
        assert isinstance(line, (TrimmedContactLine, SphereContactLine))
        toward = np.atleast_2d(np.array(line.toward))
        return moving(scene, grains, toward, gamma, lambda at: again(particles=at))
    if built.predictor:
        return _with_start(scene, terms, built)
    if not built.tangent:
        return scene

    def edge_at(radius: float) -> Scene:
        return replace(scene, surface=with_rim(built.surface, radius, scale))

    def below(angle: float) -> Scene:
        assert isinstance(substrate, Plane)
        return again(substrate=replace(substrate, contact_angle=angle))

    return replace(scene, free_edge=FreeEdge(edge_at, rim_radius, below))


def _with_start(scene: Scene, terms: Sequence[Term], built: Foot) -> Scene:
    """A scene with contact lines on asperities, and the way to it from an angle where its start is
    good."""
    solid = scene.substrate
    assert solid is not None

    def started(angle: float) -> Scene:
        """The scene at contact angles of at least ``angle``."""
        raised = with_angle(solid, angle)
        line = replace(built.terms[0], solid=raised)  # type: ignore[type-var]
        near = replace(scene, terms=[*terms, *built.predictor], ramp=None)
        return replace(scene, terms=[*terms, line], substrate=raised, ramp=None, predictor=near)

    least, good = float(np.min(solid.contact_angle)), PREDICTABLE[0]
    if least < good:
        ramp = Ramp("substrate.contact_angle", (good, least), started, only=True)
        return replace(scene, ramp=ramp)
    # another angle may have a better start; its wet set may be another one, too
    easier = min(least + AROUND, 0.5 * (least + 180.0))
    ramp = Ramp("substrate.contact_angle", (easier, least), started)
    return replace(started(least), ramp=ramp)


def _with_particles(scene: Scene, alone: Scene) -> Scene:
    """A droplet whose membrane passes through particles: it starts from the droplet alone, and if
    that fails from particles at easier angles."""
    angles = np.array([each.contact_angle for each in scene.particles])
    easy = np.where((angles < EASY[0]) | (angles > EASY[1]), np.clip(angles, *EASY), EASIEST)
    lead = int(np.abs(angles - easy).argmax())

    def at(angle: float) -> Scene:
        """All angles on the way from the easy ones, as far as that of one particle."""
        way = angles[lead] - easy[lead]
        turned = easy + (angle - easy[lead]) / way * (angles - easy) if way else angles

        def through(term: Term) -> Term:
            if isinstance(term, SphereContactLine):
                return replace(term, sphere=replace(term.sphere, contact_angle=float(turned[0])))
            if not isinstance(term, TrimmedContactLine):
                return term
            assert isinstance(term.solid, Spheres)
            every = np.array(term.solid.contact_angle)
            every[len(every) - len(turned) :] = turned
            return replace(term, solid=replace(term.solid, contact_angle=every))

        return replace(scene, terms=[through(t) for t in scene.terms], ramp=None, predictor=alone)

    values = float(easy[lead]), float(angles[lead])
    ramp = Ramp(f"particle[{lead}].contact_angle", values, at)
    return replace(at(values[1]), ramp=ramp if values[0] != values[1] else None)


EASY = 60.0, 130.0
"""Contact angles of particles, in degrees, between which their menisci are good starts."""
EASIEST = 90.0
"""The angle from which a solve between them is approached if its own start fails."""


AROUND = 12.0
"""Degrees above its own angle from which a scene is approached if its own start fails."""


def _acceleration(gravity: Any) -> Array:
    if isinstance(gravity, (str, bool)) or np.ndim(gravity) == 0:
        return np.array([0.0, 0.0, -number("gravity.acceleration", gravity, least=0.0)])
    return np.array(vector("gravity", gravity))


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


def _hints(substrate: Solid, bond: Array, sector: Sector, *, rolls: bool) -> tuple[str, ...]:
    texts = []
    angle = float(np.min(substrate.contact_angle))
    if angle <= np.pi:
        texts.append(
            f"substrate.contact_angle = {angle:g}: degrees? An angle below pi degrees is rare; "
            "angles are in degrees through the liquid"
        )
    if rolls and isinstance(substrate, Sphere) and sector.model in ("quarter", "eighth"):
        texts.append(
            "a drop on a smooth sphere "
            + ("slides off it" if bond.any() else "rolls on it freely")
            + f": that motion is not in the {sector.model} model, whose stability is judged"
        )
    return tuple(texts)


def _describe(
    substrate: Solid | None,
    volume: float,
    liquid: Liquid,
    acceleration: Array,
    hold: str,
    particles: Sequence[Sphere],
) -> dict[str, Any]:
    """The scene by the names of the scene file."""
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
        "substrate": _describe_substrate(substrate),
        "particle": [described_particle(each) for each in particles],
        "droplet": {"hold": hold},
    }


def _describe_substrate(substrate: Solid | None) -> dict[str, Any]:
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
        case Plane():
            plane: dict[str, Any] = {"kind": "plane", "contact_angle": substrate.contact_angle}
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
            angle = np.asarray(substrate.contact_angle).tolist()
            return {"kind": type(substrate).__name__, "contact_angle": angle}
