"""The foot of a droplet with particles: a line on its plane, and lines inside the membrane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..errors import SceneError
from ..solids import Plane, Sphere
from ..surface.supports import Sector, Sliding
from ..surface.surface import Surface
from ..terms import SphereContactLine, TrimmedContactLine
from .beside import as_list, check_reach, mirrored_model, towards_liquid
from .foot import Foot, Question, Rest, rest_of, sector_of
from .liquid import MODELS, Mesh
from .particle_edge import ending_on, ending_space, seat_of
from .round_patch import of_droplet, of_pancake, round_patch


def with_particles(parts: Question) -> Foot:
    """A drop on a plane whose membrane passes through particles."""
    scale, mesh = parts.scale, parts.asked.mesh(degree=3, elements=-1)
    if not isinstance(parts.substrate, Plane) or parts.substrate.contact_angle == 180.0:
        raise SceneError(
            "particle: not available yet on a droplet on spheres, or at 180 degrees on a plane"
        )
    conforming = parts.contact_line == "conforming"
    if parts.contact_line == "adhesion" or (conforming and len(parts.particles) > 1):
        raise SceneError(
            f'solver.contact_line = "{parts.contact_line}": not available with '
            f'{len(parts.particles)} particle(s), whose lines are "trimmed", or "conforming" if '
            "there is one; leave it out"
        )
    if parts.law.penalty is not None or parts.start is not None or mesh.space != "bspline":
        raise SceneError(
            "particle: a droplet with particles needs the scene's own start, no penalty and space "
            '"bspline"'
        )
    local = tuple(scale.local_sphere(each) for each in parts.particles)
    for i, (each, given) in enumerate(zip(local, parts.particles, strict=True)):
        if each.center[2] < each.radius * (1.0 - 1e-9):
            raise SceneError(
                f"particle[{i}].center = {list(given.center)}: "
                f"{each.center[2] * scale.length:g} above the plane, less than its radius "
                f"{given.radius:g}: it reaches into the substrate"
            )
    model = mirrored_model(local, sector_of(mesh, parts.bond).model)
    if mesh.model is not None and MODELS.index(mesh.model) > MODELS.index(model):
        raise SceneError(
            f'discretization.model = "{mesh.model}": the particles do not lie in its mirror '
            f'planes; "{model}" is the smallest model here'
        )
    sector = Sector(mesh.model or model)
    rest = rest_of(parts.substrate, parts.liquid, scale, parts.down)
    if conforming:
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

    def from_alone(alone: Surface) -> Surface:
        """Start, in the scene's scale, from the droplet without particles."""
        return patch.surface(of_droplet(alone))

    return Foot(surface, sector, mesh, [rest.line, line], support, start_from=from_alone)


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

    def from_alone(alone: Surface) -> Surface:
        return ending_on(of_droplet(alone), local, space)

    lines = [rest.line, line]
    return Foot(surface, sector, mesh, lines, support, None, start_from=from_alone)


REACH = 1.5
"""Distance over which the line's conormals turn into the membrane's normals."""
