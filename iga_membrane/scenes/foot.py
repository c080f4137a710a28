"""The feet of a droplet: a contact line, a contact area, a flat foot that ends tangentially."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..splines import Grading, pillow_space, points_of
from ..surface.closed import Stretch, closed_surface
from ..surface.ring import axisymmetric, drop_space
from ..surface.supports import Fixed, Sector, Shift, Sliding, Support
from ..surface.surface import Surface
from ..terms import (
    Contact,
    LineTerm,
    PlaneContactLine,
    Ring,
    Scale,
    SphereContactLine,
    Term,
    TrimmedContactLine,
)
from .asperities import ball, fine_at, smallest_model, whole_skin
from .liquid import MODELS, Discretization, Liquid, Mesh, Model, space_name
from .pattern import Pattern, cell_of
from .start import STEEPEST, Pancake, check_net, drop_on_sphere, least_energy_pancake, rounded


@dataclass(frozen=True, eq=False)
class Question:
    """What a foot is built from (scene, units, Bond numbers along the axes)."""

    substrate: Solid
    asked: Discretization
    scale: Scale
    bond: Array
    start: Surface | str | None
    liquid: Liquid
    law: Contact
    contact_line: str
    particles: tuple[Sphere, ...] = ()
    held: str = ""

    @property
    def down(self) -> float:
        """Bond number of gravity's part towards the substrate."""
        return max(0.0, -float(self.bond[2]))


@dataclass(frozen=True, eq=False)
class Foot:
    """Start, support and price of a foot.

    Attributes
    ----------
    predictor : other terms that give a better start.
    start_from : a start from the equilibrium of the same droplet without particles.
    alone : what that droplet stands on, on the same patch.
    """

    surface: Surface
    sector: Sector
    mesh: Mesh
    terms: Sequence[Term]
    supports: Sequence[Support] = ()
    grading: Grading | None = field(default_factory=Grading)
    directions: Array | None = None
    tangent: bool = False
    predictor: Sequence[Term] = ()
    start_from: Callable[[Surface], Surface] | None = None
    alone: Foot | None = None


CONTACT_LINES = ("auto", "conforming", "trimmed", "adhesion")


def foot_of(parts: Question) -> Foot:
    """The kind of foot that a substrate and its contact angle make."""
    solid, way = parts.substrate, parts.contact_line
    refused: tuple[str, ...] = ("trimmed", "adhesion")
    if not isinstance(solid, (Plane, Sphere, SphereLattice, Spheres)):
        refused = CONTACT_LINES[1:]
        if np.min(solid.contact_angle) < 180.0:
            raise SceneError(
                f"substrate.contact_angle = {np.min(solid.contact_angle):g}: contact lines are "
                "known on planes and spheres only; on a solid of your own the membrane lies, at "
                "180 degrees"
            )
    elif isinstance(solid, (SphereLattice, Spheres)):
        refused = ("conforming",)
    elif isinstance(solid, Sphere):
        refused = ("adhesion",)
    if way in refused:
        raise SceneError(
            f'solver.contact_line = "{way}": not available here; on a plane it is "conforming", on '
            'one sphere also "trimmed", on asperities "trimmed", or "adhesion" near 180 degrees; '
            '"auto" knows'
        )
    if isinstance(solid, Sphere) and way == "trimmed":
        return _through_one(parts)
    if isinstance(solid, (Plane, Sphere)) and solid.contact_angle < 180.0:
        return _on_a_line(parts)
    exact = parts.law.penalty is None and parts.start is None
    return _on_the_plane(parts) if isinstance(solid, Plane) and exact else _on_an_area(parts)


def _on_a_line(parts: Question) -> Foot:
    """The liquid-gas surface alone, its edge a contact line on a plane or a sphere."""
    substrate, mesh, scale = parts.substrate, parts.asked.mesh(), parts.scale
    assert isinstance(substrate, (Plane, Sphere))
    sector = sector_of(mesh, parts.bond)
    foot = rest_of(substrate, parts.liquid, scale, parts.down)
    bond = abs(float(parts.bond[2]))
    grading = _grading(substrate.contact_angle, bond, foot.pancake.length)
    if parts.held and isinstance(substrate, Sphere):
        # pulled at, the membrane bends over the sphere's radius, and turns away from it slowly
        slow = min(1.0, float(np.sin(np.radians(min(substrate.contact_angle, 90.0)))) / WEDGE)
        first = NECK * substrate.radius / scale.length * slow
        grading = Grading(min(grading.first, first))
    if parts.law.penalty is not None:
        raise SceneError(
            'solver.contact = "penalty": not available yet with a contact line, only at 180 degrees'
        )
    if isinstance(parts.start, str):
        raise SceneError(f'start = "{parts.start}": only at 180 degrees; leave it out here')
    if parts.start is None:
        start = _start(foot, mesh, grading, scale)
    else:
        start = parts.start
        _check_start(start, mesh, substrate)
    return Foot(start, sector, mesh, [foot.line], [foot.support], grading)


def _on_an_area(parts: Question) -> Foot:
    """The whole skin, lying on the solid with its foot."""
    substrate, scale = parts.substrate, parts.scale
    if parts.asked.space != "bspline":
        raise SceneError(
            f'discretization.space = "{space_name(parts.asked.space)}": a membrane over its whole '
            'foot needs "bspline"'
        )
    x, y, _ = (float(b) for b in parts.bond)
    tiny = 1e-14 * float(np.abs(parts.bond).max())
    local = scale.local_solid(substrate)
    lateral = (x if abs(x) > tiny else 0.0, y if abs(y) > tiny else 0.0)
    particles = [scale.local_sphere(each) for each in parts.particles]
    smallest = smallest_model(local, 1.5, lateral, particles)
    model = parts.asked.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": gravity, the substrate or particles have no such '
            f'mirror planes; "{smallest}" is the smallest model here'
        )
    unit, mesh = 4.0 * np.pi / 3.0, parts.asked.mesh(degree=2, elements=-1)
    length, elements = min(local.scale, COARSEST), max(mesh.elements, 0)
    least = float(np.min(substrate.contact_angle))
    attracts = parts.contact_line == "adhesion" or (parts.contact_line == "auto" and least > SHARP)
    lies = attracts or least == 180.0
    unit_law = scale.length**2 / scale.tension
    stiffness = 0.0 if isinstance(substrate, Plane) else (parts.law.penalty or 0.0) * unit_law
    single = not stiffness and (least == 180.0 or parts.contact_line == "auto") and not particles
    psi = float(np.radians(180.0 - least))
    pattern = Pattern(length, cell_of(local), lies, psi, single, stiffness)
    skin = whole_skin(
        parts.down,
        unit,
        pattern,
        mesh.degree,
        elements,
        parts.start,
        [fine_at(p) for p in particles],
    )
    mesh = replace(mesh, elements=skin.space.bases[0].elements // 2)
    surface = Surface(skin.space, scale.to_world(skin.points))
    if isinstance(parts.start, Surface):
        surface = surface.moved(parts.start.points)
    sector = Sector(model)
    free = "".join(axis for axis in "xy" if axis not in sector.mirrored)
    # contact lines lie in the part of the membrane that takes no part in shifts
    above = 0.0 if lies else 2.0 * largest_radius(local)
    if skin.ring is not None:
        # where the membrane meets point supports it moves vertically only
        above = float(skin.points[skin.directions[:, 2] == -1.0, 2].max())
    # on a plane every place is as good, and the centroid is held
    supports = [Shift(free, above)] if free and not isinstance(substrate, Plane) else []
    law = parts.law
    if skin.ring is not None:
        pressure = skin.pressure * scale.tension / scale.length
        law = replace(law, ring=Ring(skin.ring * scale.length, pressure))
    elif skin.many and pattern.repels and law.penalty is None:
        law = replace(law, penalty=pattern.penalty(skin.pressure) / unit_law)
    foot = Foot(surface, sector, mesh, [law], supports, directions=skin.directions)
    if least == 180.0:
        return foot
    if skin.ring is not None:
        # from where they repel, no more asperities are met than pull the membrane down on others
        return replace(foot, predictor=[replace(law, solid=with_angle(law.solid, 180.0))])
    if attracts:
        most = float(np.max(substrate.contact_angle))
        if most > least:
            raise SceneError(
                f"substrate.contact_angle: {least:g} to {most:g} degrees: adhesion has one angle "
                "for all spheres; give one, or smaller ones"
            )
        return replace(foot, terms=[replace(parts.law, adhesion=adhesion(parts.liquid, least))])
    return _through(foot, parts, skin.pressure)


SHARP = 172.0
"""Contact angle in degrees above which a line on an asperity is not resolved by the default mesh:
the membrane leaves so flat that lying on the sphere, which attracts it, is the better model."""


def adhesion(liquid: Liquid, contact_angle: float) -> float:
    """Energy per wetted area, Young and Dupre's ``gamma (1 + cos(theta))``."""
    return liquid.surface_tension * (1.0 + float(np.cos(np.radians(contact_angle))))


def _through_one(parts: Question) -> Foot:
    """A ball that passes through a sphere: without gravity its outer part is the drop."""
    solid, scale = parts.substrate, parts.scale
    assert isinstance(solid, Sphere)
    if (
        solid.contact_angle == 180.0
        or parts.law.penalty is not None
        or parts.start is not None
        or parts.asked.space != "bspline"
    ):
        raise SceneError(
            'solver.contact_line = "trimmed": on one sphere it needs an angle below 180 degrees, '
            'the scene\'s own start, no penalty and space "bspline"'
        )
    mesh, radius = parts.asked.mesh(degree=2, elements=BALL_ELEMENTS), solid.radius / scale.length
    polar, cap = drop_on_sphere(solid.contact_angle, radius, BALL)
    space = pillow_space(mesh.degree, mesh.elements)
    points, directions = closed_surface(space, ball(cap.radius), Stretch())
    # the line lies 1 - cos(polar) radii under the sphere's top, at the cap's lowest circle
    lowest = -2.0 * radius * np.sin(0.5 * polar) ** 2
    points[:, 2] += lowest - cap.radius * (1.0 + np.cos(cap.turn))
    line = TrimmedContactLine(parts.liquid.surface_tension, solid)
    surface = Surface(space, scale.to_world(points))
    return Foot(surface, sector_of(mesh, parts.bond), mesh, [line], directions=directions)


BALL_ELEMENTS = 48
"""From the middle of such a ball's foot to its widest place."""


def _through(foot: Foot, parts: Question, pressure: float) -> Foot:
    """The skin passes through the asperities; a penalty under which it sinks into them as deep as
    a flat membrane at the contact angle tells where to start."""
    substrate, scale = parts.substrate, parts.scale
    assert isinstance(substrate, (Sphere, SphereLattice, Spheres))
    if parts.law.penalty is not None:
        raise SceneError(
            'solver.contact = "penalty": only at 180 degrees; leave it out below, contact lines '
            "need none"
        )
    line = TrimmedContactLine(parts.liquid.surface_tension, substrate)
    angle = np.clip(np.mean(substrate.contact_angle), *PREDICTABLE)
    r = scale.local_solid(substrate).scale
    sunk = r * (1.0 + np.cos(np.radians(angle)))
    law = (pressure + 2.0 / r) / sunk * scale.tension / scale.length**2
    below = Contact(with_angle(line.solid, 180.0), float(law), 1.0)
    return replace(foot, terms=[line], predictor=[below])


def largest_radius(solid: Solid) -> float:
    """Of spheres; 0 for a plane."""
    return float(np.max(solid.radii if isinstance(solid, Spheres) else getattr(solid, "radius", 0)))


PREDICTABLE = 135.0, 175.0
"""Contact angles, in degrees, for which that start is good."""


def with_angle(solid: Solid, angle: float) -> Solid:
    """The solid with contact angles of at least ``angle``."""
    assert isinstance(solid, (Plane, Sphere, SphereLattice, Spheres))
    if isinstance(solid, Spheres):
        return replace(solid, contact_angle=np.maximum(solid.contact_angle, angle))
    return replace(solid, contact_angle=max(solid.contact_angle, angle))


COARSEST = 0.2
"""Length over that of the drop which the mesh resolves on large spheres too."""


FIRST = 0.75


def _on_the_plane(parts: Question) -> Foot:
    """A flat foot at 180 degrees: the liquid-gas surface alone, which leaves the plane
    tangentially where its edge is found to be."""
    gamma, scale, bond = parts.liquid.surface_tension, parts.scale, parts.down
    mesh, sector = parts.asked.mesh(), sector_of(parts.asked.mesh(), parts.bond)
    if not bond > 0 or parts.bond[:2].any():
        raise SceneError(
            "substrate.contact_angle = 180, gravity: on a plane only gravity straight towards it "
            "holds a droplet at 180 degrees; give such gravity or an angle < 180"
        )
    foot = rest_of(Plane(STEEPEST), parts.liquid, scale, bond)
    length = foot.pancake.length
    rim = rounded(bond, BALL).foot
    # the foot bends over its own radius or the capillary length, whichever is shorter
    first = min(3.5 / (np.sqrt(bond) * length), (4.0 * rim / length) ** 0.75)
    grading = Grading(float(min(1.0, first)))
    start = _start(foot, mesh, grading, scale)
    line = PlaneContactLine(gamma, 180.0)
    return Foot(start, sector, mesh, [line], [Fixed("xi2=0")], grading, tangent=True)


BALL = 4.0 * np.pi / 3.0


def rim_radius(surface: Surface) -> float:
    """Mean radius of the edge xi2 = 0."""
    ring = surface.space.bases[0]
    middle = ring.breaks[:-1] + 0.5 * ring.sizes
    xi = np.column_stack([np.concatenate([ring.breaks[:-1], middle]), np.zeros(2 * len(middle))])
    return float(np.linalg.norm(surface.at(xi, 1).position[:, :2], axis=1).mean())


def with_rim(surface: Surface, radius: float, scale: Scale) -> Surface:
    """The same surface with another radius of its edge, the change fading towards the pole."""
    local = surface.moved(scale.to_local(surface.points))
    fading = points_of(surface.space, 1.0 - surface.space.abscissae[..., 1:2])
    points = local.points.copy()
    points[:, :2] *= 1.0 + (radius / rim_radius(local) - 1.0) * fading
    return surface.moved(scale.to_world(points))


def sector_of(mesh: Mesh, bond: Array) -> Sector:
    """The model asked for, or the smallest that gravity's direction allows."""
    tiny = 1e-14 * float(np.abs(bond).max())
    along_x, along_y = (abs(float(b)) > tiny for b in bond[:2])
    smallest: Model = "full" if along_y else "half" if along_x else "eighth"
    model = mesh.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": gravity leans to '
            f"{'y' if along_y else 'x'} of the substrate, so the droplet has no such mirror "
            f'planes; "{smallest}" is the smallest model here'
        )
    return Sector(model)


@dataclass(frozen=True, eq=False)
class Rest:
    """How a drop stands on its substrate.

    Attributes
    ----------
    pancake : free surface of the start (dimensionless); lift : height of its rim.
    line : what the contact line costs; support : on what it slides.
    """

    pancake: Pancake
    lift: float
    line: LineTerm
    support: Sliding


def rest_of(substrate: Plane | Sphere, liquid: Liquid, scale: Scale, bond: float) -> Rest:
    gamma, angle, unit = liquid.surface_tension, substrate.contact_angle, 4.0 * np.pi / 3.0
    if isinstance(substrate, Plane):
        pancake = least_energy_pancake(angle, bond, unit)
        return Rest(pancake, 0.0, PlaneContactLine(gamma, angle), Sliding("xi2=0"))
    ball = scale.local_sphere(substrate)
    polar, cap = drop_on_sphere(angle, ball.radius, unit)
    x, y, z = (float(a) for a in scale.axes[:, 2])
    line = SphereContactLine(gamma, substrate, toward=(x, y, z))
    lift = ball.center[2] + ball.radius * np.cos(polar)
    return Rest(cap, float(lift), line, Sliding("xi2=0", substrate))


NECK = 3.0
"""First step along a neck on a sphere, by the mean one, over the sphere's radius by the drop's."""

WEDGE = 0.7
"""Sine of a contact angle below which those steps are shorter as it is."""


def _grading(contact_angle: float, bond: float, length: float) -> Grading:
    """Shorter steps near the rim: for the capillary length, and for a foot nearly tangent to the
    substrate. The constants balance the errors of height and rim over the whole family."""
    if bond == 0:
        return Grading()  # a circular arc has no layer
    first = min(1.0, 3.5 / (np.sqrt(bond) * length))
    if contact_angle > 90:
        first = min(first, max(np.sin(np.radians(contact_angle)), 4e-4) ** 0.5)
    return Grading(float(first))


def _start(foot: Rest, mesh: Mesh, grading: Grading, scale: Scale) -> Surface:
    pancake = foot.pancake

    def profile(t: Array) -> tuple[Array, Array, Array]:
        r, z = pancake(grading.fraction(t))
        return r, z, -pancake.length * grading.slope(t)

    space = drop_space(mesh.space, mesh.degree, mesh.elements, angle=pancake.turn)
    local = axisymmetric(space, profile)
    return local.moved(scale.to_world(local.points + [0.0, 0.0, foot.lift]))


def _check_start(start: Surface, mesh: Mesh, substrate: Plane | Sphere) -> None:
    check_net(start, drop_space(mesh.space, mesh.degree, mesh.elements))
    table = start.space.table(2)
    depth = -float(substrate.gap(start.on(table).position).min())
    if depth > 1e-6 * start.size:
        raise SceneError(
            f"start: the surface lies up to {depth:g} below the substrate (solid 0); lift it by at "
            f"least {depth:g} along the solid's normal"
        )
