"""A liquid sheet, alone or on a spherical particle (paper section 6.2, figures 8-11).

The rim is fixed at z = 0, the liquid lies above the membrane and gas below.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import words
from ..dofs.boundary_conditions import Fixed, Model, Sector, Sliding, Support
from ..errors import SceneError
from ..initial.liquid import MODELS, Discretization, Liquid, Mesh, with_defaults
from ..initial.profiles import check_net, funnel
from ..initial.sheet_through import sheet_through
from ..solids import Sphere
from ..splines import Grading, Space, points_of
from ..surface.ring import (
    axisymmetric,
    circle,
    drop_space,
    meridian_interpolation,
    ring_space,
    square,
)
from ..surface.shapes import sheet as flat_square
from ..surface.surface import Surface
from ..terms import (
    Gravity,
    Pressure,
    Scale,
    SphereContactLine,
    SurfaceTension,
    Term,
    TrimmedContactLine,
    Volume,
)
from ..units import implausible
from .description import described_particle
from .moving import moving
from .osman_sauer import WholeMembrane, sheet_with_wetted_part
from .recipe import Along, Recipe, family
from .scene import FreeEdge, Ramp, Scene, TangentEdge
from .well_posed import refuse_perfectly_wet

CONTACT_LINES = ("auto", "conforming", "trimmed")
THROUGH = {"degree": 3, "elements": 40}
"""Mesh of a sheet that passes through its particle."""


@family
@checked(
    "sheet",
    gravity="gravity.acceleration",
    contact_line=words(*CONTACT_LINES),
)
def liquid_sheet(
    particle: Sphere | None = None,
    *,
    size: float,
    boundary: str = "square",
    liquid: Liquid | None = None,
    gravity: float = 0.0,
    pressure: float | None = None,
    volume: float | None = None,
    liquid_weight: bool = False,
    discretization: Discretization | None = None,
    start: Surface | None = None,
    contact_line: str = "auto",
    membrane: WholeMembrane | None = None,
) -> Scene:
    """Sheet pinned on a rim in z = 0; without a particle a film or a cap.

    Parameters
    ----------
    particle : sphere that the sheet touches from above, with contact angle, density and motion.
    size : edge length of the square rim, or diameter of the circular one.
    boundary : "square" or "circle".
    gravity : acceleration along -z; it weighs the particle, and the sheet if ``liquid_weight``.
    pressure : liquid minus gas at z = 0, 0 if neither it nor a volume is given.
    volume : signed liquid volume below z = 0 less the wetted cap.
    liquid_weight : whether the pressure along the sheet is ``p0 - rho g z``.
    start : a surface of the same space to start from; it also chooses among several equilibria.
    contact_line : "conforming", the membrane ends on it; "trimmed", the membrane covers the whole
        rim and passes through the particle; "auto" is conforming.
    membrane : the paper's formulation, which covers the wetted part of the particle too, instead
        of a contact line as the sheet's edge; without pressure, volume and weight of the liquid.
    liquid : surface tension and density; both 1 by default.
    discretization : space, degree, elements, model; all chosen by the scene if omitted.

    Raises
    ------
    SceneError
        A value out of its range, both pressure and volume, a particle whose middle is not inside
        the rim, a model with a mirror plane that the particle's place does not have.
    """
    refuse_perfectly_wet("particle[0]", particle)
    liquid, asked = with_defaults(liquid, discretization)
    through = contact_line == "trimmed"
    mesh = asked.mesh(**(THROUGH if through else {"elements": 8 if boundary == "square" else 20}))
    if pressure is not None and volume is not None:
        raise SceneError("sheet.pressure, sheet.volume: both are prescribed; give one of them")
    sector = _sector(mesh, particle)
    gamma = liquid.surface_tension
    tangent = particle is not None and particle.contact_angle == 180.0
    if tangent and (boundary == "square" or (sector.model in ("full", "half") and not mesh.model)):
        raise SceneError(
            "particle.contact_angle = 180: not available yet with a square rim or off the axis"
        )
    described = _describe(
        particle, size, boundary, liquid, gravity, pressure, volume, liquid_weight, mesh, sector
    )
    if membrane is not None:
        if particle is None or pressure or volume is not None or liquid_weight or start is not None:
            raise SceneError(
                'solver.contact_line = "line_load": not available yet for a sheet without a '
                "particle, with pressure, volume or the liquid's weight, or from a start"
            )
        _check_place(particle, size, boundary)
        mesh = asked.mesh(degree=3, elements=18)
        return sheet_with_wetted_part(
            particle, size, boundary, liquid, gravity, mesh, sector, membrane, described
        )
    terms: list[Term] = [SurfaceTension(gamma)]
    supports: list[Support] = [sector]
    if through and (particle is None or tangent or start is not None or mesh.space != "bspline"):
        raise SceneError(
            'solver.contact_line = "trimmed": needs a particle below 180 degrees, the scene\'s own '
            'start and space "bspline"'
        )
    if particle is None or through:
        supports += [Fixed(edge) for edge in _rim_edges(boundary)]
        if particle is not None:
            _check_place(particle, size, boundary)
            terms.append(TrimmedContactLine(gamma, particle))
    else:
        _check_place(particle, size, boundary)
        terms.append(SphereContactLine(gamma, particle))
        edge = Fixed("xi2=0") if tangent else Sliding("xi2=0", particle)
        supports += [edge, Fixed("xi2=1")]
    if volume is not None:
        # a sheet's volume is signed, so the constraint's positive scale is the rim's own
        whole = np.pi * (0.5 * size) ** 3
        terms.append(Volume(whole, ends=whole - volume))
    else:
        pressure = 0.0 if pressure is None else pressure
        if pressure:
            terms.append(Pressure(pressure))
    if liquid_weight and gravity * liquid.density:
        terms.append(Gravity(liquid.density, (0.0, 0.0, -gravity)))

    recipe = Recipe(
        "liquid_sheet",
        {
            "particle": particle,
            "size": size,
            "boundary": boundary,
            "liquid": liquid,
            "gravity": gravity,
            "pressure": pressure,
            "volume": volume,
            "liquid_weight": liquid_weight,
            "discretization": Discretization(mesh.space, mesh.degree, mesh.elements, sector.model),
            "contact_line": contact_line,
        },
    )

    ramp, directions = None, None
    if through and particle is not None:
        curvature = (pressure or 0.0) / gamma
        surface, directions = sheet_through(particle, 0.5 * size, boundary, mesh, curvature)
    elif start is None:
        surface = _start(particle, size, boundary, mesh, (pressure or 0.0) / gamma, volume)
        if particle is not None:
            if particle.contact_angle != EASY and not tangent:
                ramp = _ramp(recipe, "particle[0].contact_angle", EASY, particle.contact_angle)
        elif pressure:
            ramp = _ramp(recipe, "sheet.pressure", 0.0, pressure)
        elif volume:
            ramp = _ramp(recipe, "sheet.volume", 0.0, volume)
    else:
        surface = start
        check_net(start, _space(particle, boundary, mesh))
    length = 0.5 * size if particle is None else particle.radius
    Scale(length, gamma).check_lengths("sheet.size", size)
    scene = Scene(
        surface,
        terms,
        supports,
        scale=Scale(length, gamma),
        grading=Grading() if particle is None or through else _grading(surface, size),
        ramp=ramp,
        directions=directions,
        substrate=particle,
        kind="liquid_sheet",
        recipe=recipe.changed(start=start),
        acceleration=(0.0, 0.0, -gravity),
        liquid_density=liquid.density,
        description=described,
        warnings=implausible(gravity, gamma, liquid.density, volume),
    )
    if particle is None:
        return scene
    if tangent:
        scene = replace(scene, free_edge=EdgeOnSphere(particle))
    liquid_above = np.array([[0.0, 0.0, 1.0]])
    started = recipe.changed(start=start)
    return moving(scene, [particle], liquid_above, gamma, started, "particle")


def _ramp(recipe: Recipe, path: str, first: float, last: float) -> Ramp:
    """The way along one number."""
    return Ramp(path, (first, last), Along(recipe, path))


@dataclass(frozen=True)
class EdgeOnSphere(FreeEdge):
    """The edge on a particle at 180 degrees, by its polar angle.

    Attributes
    ----------
    particle : in the user's units.
    """

    particle: Sphere

    def edges(self, scene: Scene) -> list[TangentEdge]:
        return [TangentEdge("xi2=0", scene.units.local_sphere(self.particle))]

    def surface_at(self, scene: Scene, place: Array) -> Surface:
        return _with_edge(scene.surface, self.particle, float(place[0]))

    def place_of(self, surface: Surface) -> Array:
        ball = Scale(self.particle.radius).local_sphere(self.particle)
        return np.array([_edge_polar(surface, ball)])


def _edge_polar(surface: Surface, ball: Sphere) -> float:
    """Mean polar angle of the edge xi2 = 0 about a sphere."""
    ring = surface.space.bases[0]
    middle = ring.breaks[:-1] + 0.5 * ring.sizes
    xi = np.column_stack([np.concatenate([ring.breaks[:-1], middle]), np.zeros(2 * len(middle))])
    x = surface.at(xi, 1).position - np.array(ball.center)
    return float(np.arctan2(np.hypot(x[:, 0], x[:, 1]), x[:, 2]).mean())


def _with_edge(surface: Surface, particle: Sphere, polar: float) -> Surface:
    """The same sheet with its edge on another circle of the sphere, the change fading outwards."""
    space, r = surface.space, particle.radius
    ring = circle(space.bases[0])
    inner = np.array(particle.center) + r * (np.sin(polar) * ring + [0.0, 0.0, np.cos(polar)])
    shift = inner - surface.net[:, 0]
    fading = 1.0 - space.bases[1].abscissae[:, None]
    return surface.moved(surface.points + points_of(space, shift[:, None] * fading))


EASY = 90.0
"""Contact angle at which every sheet on a particle starts its ramp."""


def _rim_edges(boundary: str) -> tuple[str, ...]:
    return ("xi2=0",) if boundary == "circle" else ("xi1=0", "xi1=1", "xi2=0", "xi2=1")


def _sector(mesh: Mesh, particle: Sphere | None) -> Sector:
    x, y, _ = (0.0, 0.0, 0.0) if particle is None else particle.center
    smallest: Model = "full" if y else "half" if x else "eighth"
    model = mesh.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": the particle stands at x, y = {x:g}, {y:g}, so the '
            f'sheet has no such mirror planes; "{smallest}" is the smallest model here'
        )
    return Sector(model)


def _check_place(particle: Sphere, size: float, boundary: str) -> None:
    x, y, _ = particle.center
    reach = max(abs(x), abs(y)) if boundary == "square" else float(np.hypot(x, y))
    if reach >= 0.5 * size:
        raise SceneError(
            f"particle[0].center = {list(particle.center)}: must lie inside the rim, less than "
            f"{0.5 * size:g} from its middle"
        )


def _space(particle: Sphere | None, boundary: str, mesh: Mesh) -> Space:
    if particle is not None:
        corners = boundary == "square"
        return ring_space(mesh.space, mesh.degree, mesh.elements, angle=1.0, corners=corners)
    if boundary == "circle":
        return drop_space(mesh.space, mesh.degree, mesh.elements)
    kind = "bspline" if mesh.space == "nurbs" else mesh.space
    return flat_square(1.0, elements=mesh.elements, degree=mesh.degree, space=kind).space


def _start(
    particle: Sphere | None,
    size: float,
    boundary: str,
    mesh: Mesh,
    curvature: float,
    volume: float | None,
) -> Surface:
    """A funnel on the particle, a spherical cap in the circle, a bulge in the square."""
    space, half = _space(particle, boundary, mesh), 0.5 * size
    if particle is not None:
        return _funnel(space, particle, half, boundary, curvature)
    if boundary == "circle":
        depth = _cap_depth(curvature * half, None if volume is None else volume / half**3)
        return _cap(space, half, half * depth)
    y, x = np.moveaxis(2.0 * space.abscissae - 1.0, -1, 0)
    # a uniform load bends the unit square by 0.0737 of it in the middle; the bulge holds 4/9
    depth = 0.0737 * curvature * size**2 if volume is None else 9.0 / 4.0 * volume / size**2
    z = -np.clip(depth, -half, half) * (1.0 - x**2) * (1.0 - y**2)
    net = np.stack([half * x, half * y, z], axis=-1)
    return Surface(space, net.reshape(-1, 3))


def _funnel(
    space: Space, particle: Sphere, half: float, boundary: str, curvature: float
) -> Surface:
    """The sheet of small slopes from its circle on the sphere to the rim."""
    r, (x, y, _) = particle.radius, particle.center
    profile = funnel(particle, half, curvature)
    ring = circle(space.bases[0])
    outer = half * ring if boundary == "circle" else half * square(space.bases[0])
    inner = np.array([x, y, 0.0]) + r * profile.edge * ring
    points, matrix = meridian_interpolation(space)
    sag = r * profile.height(profile.edge + (profile.rim - profile.edge) * points)
    values = np.stack([1.0 - points, points, sag], axis=1)
    first, second, height = np.linalg.solve(matrix, values).T[:, :, None]
    up = np.array([0.0, 0.0, 1.0])
    net = inner[:, None] * first + outer[:, None] * second + height * up
    return Surface(space, points_of(space, net))


def _grading(surface: Surface, size: float) -> Grading:
    """Shorter steps near the particle, where the sheet falls like a logarithm; 0.8 balances the
    errors of round and square rims (docs/results/sheet_and_particle.md)."""
    inner = surface.net[:, 0, :2]
    radius = np.linalg.norm(inner - inner.mean(axis=0), axis=1).mean()
    if not radius > 0:
        raise SceneError("start: its inner edge is a point; give it a ring round the particle")
    rate = 0.8 * np.log(0.5 * size / radius)
    return Grading(float(rate / np.expm1(rate))) if rate > 0 else Grading()


def _cap_depth(curvature: float, volume: float | None) -> float:
    """Depth over rim radius of the spherical cap of a pressure over tension, or of a volume."""
    if volume is not None:
        # pi h (3 + h^2) / 6 = V
        return float(2.0 * np.sinh(np.arcsinh(3.0 * volume / np.pi) / 3.0))
    return float(np.tan(0.5 * np.arcsin(np.clip(0.5 * curvature, -1.0, 1.0))))


def _cap(space: Space, rim: float, depth: float) -> Surface:
    """Spherical cap that hangs below its rim; the ring runs clockwise, so the normal points down.

    Depth and rim radius give the opening: ``tan(turn / 2) = depth / rim``.
    """
    turn = 2.0 * np.arctan(depth / rim)

    def profile(t: Array) -> tuple[Array, Array, Array]:
        angle = (1.0 - t) * turn
        over_sine = turn / np.sin(turn) if depth else 1.0
        r = rim * (1.0 - t) * np.sinc(angle / np.pi) * over_sine
        rise = 0.5 * (1.0 - t) * angle * np.sinc(0.5 * angle / np.pi) ** 2 * over_sine
        return r, rim * rise - depth, -rim * np.cos(angle) * over_sine

    counterclockwise = axisymmetric(space, profile)
    return counterclockwise.moved(counterclockwise.points * [1.0, -1.0, 1.0])


def _describe(
    particle: Sphere | None,
    size: float,
    boundary: str,
    liquid: Liquid,
    gravity: float,
    pressure: float | None,
    volume: float | None,
    liquid_weight: bool,
    mesh: Mesh,
    sector: Sector,
) -> dict[str, Any]:
    held = {"pressure": pressure, "volume": volume}
    particles = [] if particle is None else [particle]
    return {
        "scene": "liquid_sheet",
        "liquid": {"surface_tension": liquid.surface_tension, "density": liquid.density},
        "gravity": {"acceleration": gravity, "direction": [0.0, 0.0, -1.0]},
        "particle": [described_particle(each) for each in particles],
        "sheet": {"boundary": boundary, "size": size, "liquid_weight": liquid_weight}
        | {key: value for key, value in held.items() if value is not None},
        "discretization": mesh.described(sector.model),
    }
