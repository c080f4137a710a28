"""Feet of a membrane that is a droplet's whole skin: it lies on its solid or passes through it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..dofs.boundary_conditions import Model, Sector, Shift, Support
from ..errors import SceneError
from ..initial.closed_droplet import Skin, ball, fine_at, smallest_model, whole_skin
from ..initial.liquid import MODELS, Liquid, space_name
from ..initial.profiles import check_clear, drop_on_sphere
from ..initial.resolution import Pattern, cell_of
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..splines import pillow_space
from ..surface.closed import Stretch, closed_surface
from ..surface.surface import Surface
from ..terms import Contact, Ring, TrimmedContactLine
from .spec import BALL, Foot, Question, sector_of

COARSEST = 0.2
"""Length over that of the drop which the mesh resolves on large spheres too."""

DEEPEST = 0.5
"""Depth of a start in a solid over the solid's scale up to which contact pushes it out again."""


def on_an_area(parts: Question) -> Foot:
    """The whole skin, lying on the solid with its foot."""
    substrate, scale = parts.substrate, parts.scale
    if parts.asked.space != "bspline":
        raise SceneError(
            f'discretization.space = "{space_name(parts.asked.space)}": a membrane over its whole '
            'foot needs "bspline"'
        )
    local = scale.local_solid(substrate)
    particles = [scale.local_sphere(each) for each in parts.particles]
    sector = Sector(_model_of(parts, local, particles))
    mesh = parts.asked.mesh(degree=2, elements=-1)
    length, least = min(local.scale, COARSEST), float(np.min(substrate.contact_angle))
    attracts = parts.contact_line == "adhesion" or (parts.contact_line == "auto" and least > SHARP)
    lies = attracts or least == 180.0
    penalized = parts.law.penalty is not None and not isinstance(substrate, Plane)
    single = not penalized and (least == 180.0 or parts.contact_line == "auto") and not particles
    psi = float(np.radians(180.0 - least))
    pattern = Pattern(length, cell_of(local), lies, psi, single, penalized)
    fine = [fine_at(each) for each in particles]
    elements = max(mesh.elements, 0)
    skin = whole_skin(parts.down, BALL, pattern, mesh.degree, elements, parts.start, fine)
    law = _law_of(parts, skin, pattern)
    foot = Foot(
        _start_of(parts, skin),
        sector,
        replace(mesh, elements=skin.space.bases[0].elements // 2),
        [law],
        _shift_of(parts, skin, sector, lies=lies),
        directions=skin.directions,
    )
    if least == 180.0:
        return foot
    if skin.ring is not None:
        # from where they repel, no more asperities are met than pull the membrane down on others
        return replace(foot, predictor=[replace(law, solid=with_angle(law.solid, 180.0))])
    return _attracting(foot, parts) if attracts else _through(foot, parts, skin.pressure)


def _model_of(parts: Question, local: Solid, particles: list[Sphere]) -> Model:
    """The model asked for, or the smallest that gravity, the solid and particles allow."""
    x, y, _ = (float(b) for b in parts.bond)
    smallest = smallest_model(local, 1.5, (x, y), particles)
    model = parts.asked.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": gravity, the substrate or particles have no such '
            f'mirror planes; "{smallest}" is the smallest model here'
        )
    return model


def _start_of(parts: Question, skin: Skin) -> Surface:
    """The skin in the world, or the start that was given."""
    surface = Surface(skin.space, parts.scale.to_world(skin.points))
    if not isinstance(parts.start, Surface):
        return surface
    given, solid = surface.moved(parts.start.points), parts.substrate
    check_clear(given, solid, DEEPEST * min(solid.scale, parts.scale.length))
    return given


def _shift_of(parts: Question, skin: Skin, sector: Sector, *, lies: bool) -> list[Support]:
    """What may be shifted as a whole; on a plane, where every place is as good, nothing."""
    free = "".join(axis for axis in "xy" if axis not in sector.mirrored)
    if not free or isinstance(parts.substrate, Plane):
        return []
    # contact lines lie in the part of the membrane that takes no part in shifts
    above = 0.0 if lies else 2.0 * largest_radius(parts.scale.local_solid(parts.substrate))
    if skin.ring is not None:
        # where the membrane meets point supports it moves vertically only
        above = float(skin.points[skin.directions[:, 2] == -1.0, 2].max())
    return [Shift(free, above)]


def _law_of(parts: Question, skin: Skin, pattern: Pattern) -> Contact:
    """How the skin is kept out of the solid: as asked, or as its mesh can."""
    law, scale, length = parts.law, parts.scale, pattern.length
    unit_law = scale.length**2 / scale.tension
    if pattern.penalized:
        law = given_way(law, (skin.pressure + 2.0 / length) / length / unit_law)
    if skin.ring is not None:
        pressure = skin.pressure * scale.tension / scale.length
        return replace(law, ring=Ring(skin.ring * scale.length, pressure))
    if skin.many and pattern.repels and not pattern.penalized:
        return replace(law, penalty=pattern.penalty(skin.pressure) / unit_law)
    return law


def _attracting(foot: Foot, parts: Question) -> Foot:
    """A skin that lies on spheres which attract it."""
    angles = parts.substrate.contact_angle
    least, most = float(np.min(angles)), float(np.max(angles))
    if most > least:
        raise SceneError(
            f"substrate.contact_angle: {least:g} to {most:g} degrees: adhesion has one angle "
            "for all spheres; give one, or smaller ones"
        )
    return replace(foot, terms=[replace(parts.law, adhesion=adhesion(parts.liquid, least))])


def given_way(law: Contact, traction: float) -> Contact:
    """A penalty so hard that it sinks less than the membrane dips between contact points acts
    through multipliers that give way.

    Parameters
    ----------
    traction : on the smallest asperity, over its radius.
    """
    assert law.penalty is not None
    if traction > HARD * law.penalty:
        return law
    return replace(law, penalty=None, compliance=1.0 / law.penalty)


HARD = 0.032
"""Depth over radius from which on a penalty sinks less than the default mesh dips, five times."""
SHARP = 172.0
"""Contact angle in degrees above which a line on an asperity is not resolved by the default mesh:
the membrane leaves so flat that lying on the sphere, which attracts it, is the better model."""


def adhesion(liquid: Liquid, contact_angle: float) -> float:
    """Energy per wetted area, Young and Dupre's ``gamma (1 + cos(theta))``."""
    return liquid.surface_tension * (1.0 + float(np.cos(np.radians(contact_angle))))


def through_one(parts: Question) -> Foot:
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
