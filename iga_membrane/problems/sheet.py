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
from ..initial.profiles import check_net
from ..initial.sheet_start import sheet_grading, sheet_space, sheet_start
from ..initial.sheet_through import sheet_through
from ..solids import Sphere
from ..splines import Grading, points_of
from ..surface.ring import circle
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
    sheet = _Sheet(particle, size, boundary, liquid, gravity, pressure, volume, liquid_weight)
    sector = _sector(mesh, particle)
    sheet.check(off_axis=mesh.model is None and sector.model in ("full", "half"))
    if membrane is not None:
        return _whole(sheet, asked.mesh(degree=3, elements=18), sector, start, membrane)
    recipe = Recipe(
        "liquid_sheet",
        {
            "particle": particle,
            "size": size,
            "boundary": boundary,
            "liquid": liquid,
            "gravity": gravity,
            "pressure": sheet.held_pressure,
            "volume": volume,
            "liquid_weight": liquid_weight,
            "discretization": Discretization(mesh.space, mesh.degree, mesh.elements, sector.model),
            "contact_line": contact_line,
        },
    )
    surface, directions, ramp = _start(sheet, mesh, start, recipe, through=through)
    lines, supports = _lines(particle, boundary, liquid.surface_tension, through=through)
    started = recipe.changed(start=start)
    scene = Scene(
        surface,
        [SurfaceTension(liquid.surface_tension), *lines, *sheet.bodies()],
        [sector, *supports],
        scale=sheet.scale,
        grading=Grading() if particle is None or through else sheet_grading(surface, size),
        ramp=ramp,
        directions=directions,
        substrate=particle,
        kind="liquid_sheet",
        recipe=started,
        acceleration=(0.0, 0.0, -gravity),
        liquid_density=liquid.density,
        description=sheet.described(mesh, sector),
        warnings=implausible(gravity, liquid.surface_tension, liquid.density, volume),
    )
    if particle is None:
        return scene
    if particle.contact_angle == 180.0:
        scene = replace(scene, free_edge=EdgeOnSphere(particle))
    liquid_above = np.array([[0.0, 0.0, 1.0]])
    return moving(scene, [particle], liquid_above, liquid.surface_tension, started, "particle")


@dataclass(frozen=True, eq=False)
class _Sheet:
    """What is asked of a sheet, by the arguments of :func:`liquid_sheet`."""

    particle: Sphere | None
    size: float
    boundary: str
    liquid: Liquid
    gravity: float
    pressure: float | None
    volume: float | None
    liquid_weight: bool

    @property
    def scale(self) -> Scale:
        """Lengths in radii of the particle, or half sizes of the rim."""
        length = 0.5 * self.size if self.particle is None else self.particle.radius
        return Scale(length, self.liquid.surface_tension)

    @property
    def held_pressure(self) -> float | None:
        """The pressure that is prescribed; None where a volume is."""
        return self.pressure or 0.0 if self.volume is None else None

    @property
    def curvature(self) -> float:
        """Twice the mean curvature that the prescribed pressure bends a sheet to."""
        return (self.held_pressure or 0.0) / self.liquid.surface_tension

    def check(self, *, off_axis: bool) -> None:
        """Refuse what contradicts itself, and a particle at 180 degrees where it is not built."""
        if self.pressure is not None and self.volume is not None:
            raise SceneError("sheet.pressure, sheet.volume: both are prescribed; give one of them")
        self.scale.check_lengths("sheet.size", self.size)
        if self.particle is None:
            return
        if self.particle.contact_angle == 180.0 and (self.boundary == "square" or off_axis):
            raise SceneError(
                "particle.contact_angle = 180: not available yet with a square rim or off the axis"
            )
        _check_place(self.particle, self.size, self.boundary)

    def bodies(self) -> list[Term]:
        """The volume that is held, or the pressure, if there is any, and the liquid's weight."""
        found: list[Term] = []
        if self.volume is not None:
            # a sheet's volume is signed, so the constraint's positive scale is the rim's own
            whole = np.pi * (0.5 * self.size) ** 3
            found.append(Volume(whole, ends=whole - self.volume))
        elif self.pressure:
            found.append(Pressure(self.pressure))
        if self.liquid_weight and self.gravity * self.liquid.density:
            found.append(Gravity(self.liquid.density, (0.0, 0.0, -self.gravity)))
        return found

    def described(self, mesh: Mesh, sector: Sector) -> dict[str, Any]:
        """In words of the scene file."""
        held = {"pressure": self.held_pressure, "volume": self.volume}
        particles = [] if self.particle is None else [self.particle]
        rim = {
            "boundary": self.boundary,
            "size": self.size,
            "liquid_weight": self.liquid_weight,
        }
        liquid = self.liquid
        return {
            "scene": "liquid_sheet",
            "liquid": {"surface_tension": liquid.surface_tension, "density": liquid.density},
            "gravity": {"acceleration": self.gravity, "direction": [0.0, 0.0, -1.0]},
            "particle": [described_particle(each) for each in particles],
            "sheet": rim | {key: value for key, value in held.items() if value is not None},
            "discretization": mesh.described(sector.model),
        }


def _whole(
    sheet: _Sheet, mesh: Mesh, sector: Sector, start: Surface | None, membrane: WholeMembrane
) -> Scene:
    """The sheet by the paper's formulation."""
    if sheet.particle is None or start is not None:
        raise SceneError(
            'solver.contact_line = "line_load": not available yet for a sheet without a particle '
            "or from a start"
        )
    return sheet_with_wetted_part(
        sheet.particle,
        sheet.size,
        sheet.boundary,
        sheet.liquid,
        sheet.gravity,
        mesh,
        sector,
        membrane,
        sheet.described(mesh, sector),
        sheet.bodies(),
        sheet.curvature,
    )


def _start(
    sheet: _Sheet, mesh: Mesh, start: Surface | None, recipe: Recipe, *, through: bool
) -> tuple[Surface, Array | None, Ramp | None]:
    """The start, the directions of its control points if they are given, and the way to it."""
    particle, size, boundary = sheet.particle, sheet.size, sheet.boundary
    if through:
        wrong = particle is None or particle.contact_angle == 180.0 or mesh.space != "bspline"
        if particle is None or wrong or start is not None:
            raise SceneError(
                'solver.contact_line = "trimmed": needs a particle below 180 degrees, the scene\'s '
                'own start and space "bspline"'
            )
        surface, directions = sheet_through(particle, 0.5 * size, boundary, mesh, sheet.curvature)
        return surface, directions, None
    if start is not None:
        check_net(start, sheet_space(particle, boundary, mesh))
        return start, None, None
    surface = sheet_start(particle, size, boundary, mesh, sheet.curvature, sheet.volume)
    return surface, None, _ramp_of(recipe)


def _lines(
    particle: Sphere | None, boundary: str, gamma: float, *, through: bool
) -> tuple[list[Term], list[Support]]:
    """What the line on a particle costs, and how rim and line are held."""
    if particle is None or through:
        rim: list[Support] = [Fixed(edge) for edge in _rim_edges(boundary)]
        return [TrimmedContactLine(gamma, particle)] if particle is not None else [], rim
    tangent = particle.contact_angle == 180.0
    edge = Fixed("xi2=0") if tangent else Sliding("xi2=0", particle)
    return [SphereContactLine(gamma, particle)], [edge, Fixed("xi2=1")]


def _ramp_of(recipe: Recipe) -> Ramp | None:
    """The way to a sheet from an easier angle of its particle, or from a flat one."""
    given = recipe.arguments
    particle = given["particle"]
    if particle is not None:
        easy = particle.contact_angle in (EASY, 180.0)
        path, ends = "particle[0].contact_angle", (EASY, particle.contact_angle)
        return None if easy else _ramp(recipe, path, *ends)
    for name in ("pressure", "volume"):
        if given[name]:
            return _ramp(recipe, f"sheet.{name}", 0.0, given[name])
    return None


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
