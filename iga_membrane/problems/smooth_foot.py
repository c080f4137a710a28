"""Feet on planes and spheres where the membrane is the liquid-gas surface alone.

It ends on a contact line, or at 180 degrees on a plane tangentially.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..dofs.boundary_conditions import Fixed, Sector, Sliding
from ..errors import SceneError
from ..initial.liquid import Liquid, Mesh
from ..initial.profiles import (
    Pancake,
    check_clear,
    check_net,
    check_turns,
    drop_on_sphere,
    flat_drop,
    least_energy_pancake,
    rounded,
)
from ..solids import Plane, Sphere
from ..solids.disc import Disc
from ..splines import Grading, points_of
from ..surface.ring import axisymmetric, drop_space
from ..surface.surface import Surface
from ..terms import LineTerm, PlaneContactLine, Scale, SphereContactLine
from ..terms.rim_line import RimLine
from .spec import BALL, Foot, Question, sector_of


def on_a_line(parts: Question) -> Foot:
    """The liquid-gas surface alone, its edge a contact line on a plane or a sphere."""
    substrate, mesh, scale = parts.substrate, parts.asked.mesh(), parts.scale
    assert isinstance(substrate, (Plane, Sphere))
    sector = sector_of(mesh, parts.bond)
    foot = rest_of(substrate, parts.liquid, scale, parts.down)
    bond = abs(float(parts.bond[2]))
    grading = _grading(substrate.contact_angle, bond, foot.pancake.length)
    if "z" in parts.held and isinstance(substrate, Sphere):
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


def on_the_plane(parts: Question) -> Foot:
    """A flat foot at 180 degrees: the liquid-gas surface alone, which leaves the plane
    tangentially where its edge is found to be."""
    gamma, scale, bond = parts.liquid.surface_tension, parts.scale, parts.down
    mesh, sector = parts.asked.mesh(), sector_of(parts.asked.mesh(), parts.bond)
    if parts.bond[:2].any() or parts.bond[2] > 0.0:
        raise SceneError(
            "substrate.contact_angle = 180, gravity: on a plane only gravity straight towards it "
            "holds a droplet at 180 degrees; give such gravity, none, or an angle < 180"
        )
    if not bond:
        return _on_a_point(parts, mesh, sector)
    drop = (flat_drop if bond > ROUND else rounded)(bond, BALL)
    walked, r, z = drop.meridian()
    length = float(walked[-1])
    # the membrane bends over the foot's own radius, beyond which it is a ball, or the capillary
    # length, whichever is shorter
    bends, foot = min(1.0, 3.5 / (np.sqrt(bond) * length)), 8.0 * drop.foot / length
    grading = Grading(float(foot), EVEN) if foot < bends else Grading(float(bends))

    def profile(t: Array) -> tuple[Array, Array, Array]:
        at = length * grading.fraction(t)
        return np.interp(at, walked, r), np.interp(at, walked, z), -length * grading.slope(t)

    local = axisymmetric(drop_space(mesh.space, mesh.degree, mesh.elements, angle=np.pi), profile)
    start = local.moved(scale.to_world(local.points))
    line = PlaneContactLine(gamma, 180.0)
    return Foot(start, sector, mesh, [line], [Fixed("xi2=0")], grading, tangent=True)


def on_a_rim(parts: Question) -> Foot:
    """The liquid-gas surface alone, its edge at rest on the rim of a disc: from the cap of a sphere
    that holds the volume.

    Raises
    ------
    SceneError
        A start or a penalty.
    """
    disc, mesh, scale = parts.substrate, parts.asked.mesh(), parts.scale
    assert isinstance(disc, Disc)
    if parts.start is not None or parts.law.penalty is not None:
        raise SceneError("substrate: a droplet on a disc needs its own start, no penalty")
    pancake = least_energy_pancake(_cap_angle(disc.radius / scale.length), 0.0, BALL)
    line = rim_line(parts.liquid.surface_tension, disc, "xi2=0", 0.0)
    rest = Rest(pancake, 0.0, line, Sliding("xi2=0"))
    grading = _grading(90.0, abs(float(parts.bond[2])), pancake.length)
    start = _start(rest, mesh, grading, scale)
    return Foot(start, sector_of(mesh, parts.bond), mesh, [line], [Fixed("xi2=0")], grading)


def rim_line(gamma: float, disc: Disc, edge: str, level: float) -> RimLine:
    """The contact line on a disc's rim."""
    return RimLine(gamma, disc.contact_angle, edge, level=level, turn_of_rim=disc.edge)


def _cap_angle(radius: float) -> float:
    """Angle in degrees at which a cap with the volume of the unit ball has a rim."""
    low, high = 0.0, np.pi
    for _ in range(100):
        angle = 0.5 * (low + high)
        c, s = np.cos(angle), np.sin(angle)
        volume = np.pi / 3.0 * (2.0 + c) * (1.0 - c) ** 2 * (radius / s) ** 3
        low, high = (angle, high) if volume < BALL else (low, angle)
    return float(np.degrees(0.5 * (low + high)))


def _on_a_point(parts: Question, mesh: Mesh, sector: Sector) -> Foot:
    """A sphere that touches the plane, but for a hole too small to matter, whose rim is held."""
    if "z" in parts.held:
        raise SceneError(
            'droplet.hold = "xyz": a droplet at 180 degrees without gravity touches its plane in a '
            'point, which holds it already; take "xy" or "none"'
        )
    local = least_energy_pancake(180.0 - POINT, 0.0, BALL, steepest=180.0)
    rest = Rest(local, 0.0, PlaneContactLine(parts.liquid.surface_tension, 180.0), Sliding("xi2=0"))
    start = _start(rest, mesh, Grading(), parts.scale)
    return Foot(start, sector, mesh, [rest.line], [Fixed("xi2=0")], Grading())


ROUND = 1e-3
"""Bond number up to which a drop at 180 degrees begins as a ball with the foot that its weight asks
for, right to 2e-6; beyond, as the solution of its ordinary differential equations (30 ms)."""
EVEN = 0.5
"""Part of the steps along a meridian that are equal, beside a foot smaller than the drop. At Bond
numbers of 1e-6 to 1e-2 height and pressure are right to 1e-7 on the default mesh with 0.4 and 0.5,
to 1e-6 with 0.3, to 1e-4 if steps grow all the way. First steps of 4 to 12 feet over the elements
are as good."""
POINT = 0.01
"""Degrees by which the membrane at the rim of that hole misses 180: the sphere's radius is right to
1e-15."""


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
    check_clear(start, substrate, 1e-6 * start.size)
    check_turns(start, substrate.unit_normal() if isinstance(substrate, Plane) else np.eye(3)[2])
