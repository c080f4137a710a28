"""The foot of a droplet with particles, and the lines inside its membrane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Index
from ..dofs.boundary_conditions import Sector, Sliding
from ..errors import SceneError
from ..initial.liquid import MODELS, Mesh
from ..initial.particle_edge import ending_on, ending_space, seat_of
from ..initial.particle_placement import as_list, check_reach, mirrored_model, towards_liquid
from ..initial.round_patch import RoundPatch, of_droplet, of_pancake, round_patch
from ..solids import Plane, Solid, Sphere, SphereLattice, Spheres
from ..splines import Space
from ..surface.surface import Surface
from ..terms import SphereContactLine, TrimmedContactLine
from .contact_setup import foot_of
from .smooth_foot import Rest, rest_of
from .spec import Foot, Question, sector_of
from .whole_foot import PREDICTABLE, SHARP


def discretizations(
    substrate: Solid | None, particles: Sequence[Sphere], contact_line: str
) -> tuple[str, ...]:
    """How the membrane meets particles, the first choice first and then what is tried where it
    fails.

    A membrane that ends on its particle is cheaper and more exact; one that passes through it may
    also lose it, and is solved more often where lines nearly touch. A particle that moves meets one
    discretization everywhere: the small difference between two would be a force.
    """
    one = isinstance(substrate, Plane) and substrate.contact_angle < 180.0 and len(particles) == 1
    if contact_line != "auto" or not one:
        return (contact_line,)
    return ("conforming", "trimmed") if particles[0].motion == "fixed" else ("trimmed",)


def with_particles(parts: Question) -> Foot:
    """A drop whose membrane passes through particles, on a plane or on asperities, or on a plane
    ends on one."""
    ends = isinstance(parts.substrate, Plane) and len(parts.particles) == 1
    ways = ("auto", "trimmed", "conforming") if ends else ("auto", "trimmed")
    if parts.contact_line not in ways:
        raise SceneError(
            f'solver.contact_line = "{parts.contact_line}": not available with '
            f'{len(parts.particles)} particle(s), whose lines are "trimmed", or "conforming" if '
            "there is one, on a plane; leave it out"
        )
    if parts.law.penalty is not None or parts.start is not None or parts.asked.space != "bspline":
        raise SceneError(
            "particle: a droplet with particles needs the scene's own start, no penalty and space "
            '"bspline"'
        )
    solid, least = parts.substrate, float(np.min(parts.substrate.contact_angle))
    if isinstance(solid, Plane) and least < 180.0:
        return _on_a_plane(parts)
    lowest, highest = PREDICTABLE[0], SHARP
    if isinstance(solid, (SphereLattice, Spheres)) and lowest <= least <= highest:
        return _beside_asperities(parts)
    raise SceneError(
        f"particle: not available yet on this droplet, only on one on a plane below 180 degrees or "
        f"on asperities of {lowest:g} to {highest:g} degrees"
    )


def _beside_asperities(parts: Question) -> Foot:
    """The whole skin, which passes through asperities and particles."""
    scale = parts.scale
    foot = foot_of(parts)
    start = foot.surface.moved(scale.to_local(foot.surface.points))
    local = [scale.local_sphere(each) for each in parts.particles]
    for i, (each, given) in enumerate(zip(local, parts.particles, strict=True)):
        if each.center[2] < WIDEST * float(start.points[:, 2].max()):
            raise SceneError(
                f"particle[{i}].center = {list(given.center)}: not available yet so low beside "
                f"asperities; put it above z = {WIDEST * float(foot.surface.points[:, 2].max()):g}"
            )
    reach = AROUND * float(np.linalg.norm(foot.surface.points[:, :2], axis=1).max())
    solid = _one_list(parts.substrate, parts.particles, reach)
    line = TrimmedContactLine(
        parts.liquid.surface_tension, solid, towards_liquid(start, local, 1.0)
    )
    # contact lines take no part in shifts, and particles stand in their way
    alone = replace(foot, supports=())
    return replace(alone, terms=[line], predictor=(), alone=alone)


def _one_list(substrate: Solid, particles: Sequence[Sphere], reach: float) -> Spheres:
    """Asperities and, behind them, particles; of a lattice those within ``reach`` of the axis."""
    assert isinstance(substrate, (SphereLattice, Spheres))
    if isinstance(substrate, Spheres):
        which: Index = np.arange(len(substrate.centers))
    else:
        which = substrate.within(reach)
    angles = np.broadcast_to(substrate.contact_angle, which.shape)
    grains = as_list(particles)
    return Spheres(
        np.concatenate([angles, grains.contact_angle]),
        np.concatenate([substrate.center_of(which), grains.centers]),
        np.concatenate([substrate.radius_of(which), grains.radii]),
    )


WIDEST = 0.45
"""Height of a droplet on asperities, over that of its top, below which its directions turn."""
AROUND = 2.0
"""Distance from a droplet's axis, over its largest radius, of the spheres of a lattice that it may
meet."""
REACH = 1.5
"""Distance over which the line's conormals turn into the membrane's normals."""


def _on_a_plane(parts: Question) -> Foot:
    """A ring patch whose edge is the line on the plane, its pole in a particle."""
    scale, mesh = parts.scale, parts.asked.mesh(degree=3, elements=-1)
    assert isinstance(parts.substrate, Plane)
    local = tuple(scale.local_sphere(each) for each in parts.particles)
    for i, (each, given) in enumerate(zip(local, parts.particles, strict=True)):
        if each.center[2] < each.radius * (1.0 - 1e-9):
            raise SceneError(
                f"particle[{i}].center = {list(given.center)}: "
                f"{each.center[2] * scale.length:g} above the plane, less than its radius "
                f"{given.radius:g}: it reaches {(each.radius - each.center[2]) * scale.length:.3g} "
                "into the substrate"
            )
    model = mirrored_model(local, sector_of(mesh, parts.bond).model)
    if mesh.model is not None and MODELS.index(mesh.model) > MODELS.index(model):
        raise SceneError(
            f'discretization.model = "{mesh.model}": the particles do not lie in its mirror '
            f'planes; "{model}" is the smallest model here'
        )
    # away from a particle that presses on its top a droplet may slip along the plane
    slips = model in ("quarter", "eighth") and "x" not in parts.held
    sector = Sector(mesh.model or ("half" if slips else model))
    rest = rest_of(parts.substrate, parts.liquid, scale, parts.down)
    if parts.contact_line == "conforming":
        return _ending_on(parts, local[0], sector, mesh, rest)
    patch = round_patch(of_pancake(rest.pancake), local, mesh, 2 * sector.copies)
    start = patch.surface(of_pancake(rest.pancake))
    mesh = replace(mesh, elements=start.space.bases[1].elements)
    solid = as_list(parts.particles)
    toward = towards_liquid(start, local, 1.0) @ scale.axes.T
    line = TrimmedContactLine(parts.liquid.surface_tension, solid, toward)
    surface = start.moved(scale.to_world(start.points))

    # far from the line its conormals may point against the membrane's normals
    support = [Sliding("xi2=0", reach=REACH)]
    start_from = RoundParticles(patch)
    return Foot(surface, sector, mesh, [rest.line, line], support, start_from=start_from)


@dataclass(frozen=True)
class RoundParticles:
    """Start, in the scene's scale, from the droplet without particles.

    Attributes
    ----------
    patch : its control points crowd round the particles.
    """

    patch: RoundPatch

    def __call__(self, alone: Surface) -> Surface:
        return self.patch.surface(of_droplet(alone))


def _ending_on(parts: Question, local: Sphere, sector: Sector, mesh: Mesh, rest: Rest) -> Foot:
    """The membrane ends on the one particle too."""
    scale, (particle,) = parts.scale, parts.particles
    meridian = of_pancake(rest.pancake)
    seat, toward = seat_of(meridian, local)
    check_reach(0, local, float(np.linalg.norm(seat - local.center)) - local.radius, 1.0)
    space = ending_space(meridian, local, mesh, 2 * sector.copies)
    start = ending_on(meridian, local, space)
    mesh = replace(mesh, elements=space.bases[1].elements)
    x, y, z = (float(a) for a in scale.axes @ toward)
    gamma = parts.liquid.surface_tension
    line = SphereContactLine(gamma, particle, "xi2=1", toward=(x, y, z))
    surface = start.moved(scale.to_world(start.points))
    support = [Sliding("xi2=0", reach=REACH), Sliding("xi2=1", particle)]
    lines, start_from = [rest.line, line], EndingOn(local, space)
    return Foot(surface, sector, mesh, lines, support, None, start_from=start_from)


@dataclass(frozen=True)
class EndingOn:
    """Start, in the scene's scale, from the droplet without its particle.

    Attributes
    ----------
    particle : on which the membrane ends, in that scale; space : of the start.
    """

    particle: Sphere
    space: Space

    def __call__(self, alone: Surface) -> Surface:
        return ending_on(of_droplet(alone), self.particle, self.space)
