"""The paper's formulation: one membrane round the whole liquid, its wetted part included.

The wetted part lies on the solid by a penalty (eq. 24) and has the tension gamma too, so
``gamma_SL = gamma`` and ``gamma_SG = gamma (1 + cos(theta))``. The contact line is a line of
continuity 0 inside the membrane under the load ``q_c`` of eqs (29)-(34). Control points have three
unknowns and the stabilization of eq. (23), and the contact angle is reached in load steps.

The innermost part of the wetted membrane, which lies on the solid in every step, is left out: the
membrane ends on a fixed circle round the axis.

At 180 degrees there is no contact line: the closed skin of the droplet lies on its solid, a plane
or asperities, and the weight is the load (section 6.1, figures 5 and 6).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from ..arguments import checked
from ..checks import integer
from ..dofs.boundary_conditions import Fixed, Sector, Support
from ..errors import SceneError
from ..initial.liquid import Liquid, Mesh, space_name
from ..initial.profiles import funnel
from ..solids import Plane, Solid, Sphere
from ..solids.wettability import least_angle
from ..splines import Grading, Space, points_of
from ..surface.ring import circle, meridian_interpolation, ring_space, square
from ..surface.surface import Surface
from ..terms import (
    Contact,
    NormalLineLoad,
    PlaneContactLine,
    Scale,
    SphereContactLine,
    Stabilization,
    SurfaceTension,
    Term,
    Volume,
)
from .scene import Ramp, Scene

EASY = 150.0
"""Contact angle of the first load step at most."""
INNER = 0.4
"""Radius of the fixed circle over that of the first contact line."""
WET = 1.0 / 3.0
"""Part of the elements along a meridian that lies on the solid."""


@dataclass(frozen=True)
@checked("solver", load_steps=partial(integer, least=1, most=100_000))
class WholeMembrane:
    """Choices of the paper's formulation.

    Attributes
    ----------
    stabilization : ``mu / gamma`` of eq. (23), > 0; the paper's is 1.
    projected : whether the stabilization acts along tangent planes only.
    penalty : traction over depth, times the scene's length squared over gamma; the paper's is 1e4.
    load_steps : equal steps of the contact angle, from 150 degrees (or the angle itself, if larger)
        on; steps at the last angle follow until the stabilization has relaxed. At 180 degrees steps
        of the weight, after which the membrane settles without stabilization.
    penetration_tolerance : depth over the sphere's radius (plane: over the length) beyond which a
        state is no success.
    """

    stabilization: float = 1.0
    projected: bool = False
    penalty: float = 1e4
    load_steps: int = 20
    penetration_tolerance: float = 1e-2

    def penalty_of(self, solid: Solid | None, penalty: float | None) -> float | None:
        """The penalty of a skin that lies on its solid at 180 degrees; below, None.

        Raises
        ------
        SceneError
            Another penalty was given.
        """
        if penalty is not None:
            raise SceneError(
                f"solver.penalty = {penalty:g}: the paper's formulation has a penalty of its own; "
                "give that, WholeMembrane(penalty=...)"
            )
        lies = solid is not None and least_angle(solid.contact_angle) == 180.0
        return self.penalty if lies else None


def sheet_with_wetted_part(
    particle: Sphere,
    size: float,
    boundary: str,
    liquid: Liquid,
    gravity: float,
    mesh: Mesh,
    sector: Sector,
    how: WholeMembrane,
    description: Mapping[str, Any],
    bodies: Sequence[Term],
    curvature: float,
) -> Scene:
    """A sheet on a particle on its axis (figures 8-10 of the paper).

    Parameters
    ----------
    bodies : what its liquid pays for: pressure or volume, and weight.
    curvature : pressure over tension.
    """
    x, y, _ = particle.center
    if x or y:
        raise SceneError('solver.contact_line = "line_load": not available yet off the axis')
    check_mesh(mesh, sector, particle.contact_angle)
    gamma = liquid.surface_tension
    kink = kink_of(mesh.elements)
    space = ring_space(
        mesh.space, mesh.degree, mesh.elements, angle=1.0, corners=boundary == "square", kink=kink
    )
    first = Sphere(max(EASY, particle.contact_angle), particle.radius, particle.center)
    surface = _sheet_start(space, first, 0.5 * size, boundary, curvature)

    line = LineOnSolid(particle, gamma, edge_of(space))
    scale = Scale(particle.radius, gamma)
    hole = _under_hole(particle, INNER * funnel(first, 0.5 * size, curvature).polar)
    held = [replace(t, ends=t.ends + hole) if isinstance(t, Volume) else t for t in bodies]
    supports: list[Support] = [sector, Fixed("xi2=0"), Fixed("xi2=1")]
    scene = Scene(
        surface,
        [*skin(particle, gamma, scale, how), *held, *line.terms(first.contact_angle)],
        supports,
        scale=scale,
        motion="cartesian",
        substrate=particle,
        kind="liquid_sheet",
        acceleration=(0.0, 0.0, -gravity),
        liquid_density=liquid.density,
        description=described(description, mesh, how),
    )
    return stepped(scene, "particle[0].contact_angle", first, particle, line, how)


def described(description: Mapping[str, Any], mesh: Mesh, how: WholeMembrane) -> dict[str, Any]:
    """A description with the formulation's own mesh and solver table."""
    model = description["discretization"]["model"]
    return dict(description) | {
        "discretization": mesh.described(model),
        "solver": solver_table(how),
    }


def solver_table(how: WholeMembrane) -> dict[str, Any]:
    return {
        "motion": "cartesian",
        "stabilization": how.stabilization,
        "contact": "penalty",
        "penalty": how.penalty,
        "penetration_tolerance": how.penetration_tolerance,
        "contact_line": "line_load",
    }


def check_mesh(mesh: Mesh, sector: Sector, contact_angle: float) -> None:
    if contact_angle >= 180.0:
        raise SceneError(
            f"contact_angle = {contact_angle:g}: there is no contact line at 180 degrees, so no "
            'solver.contact_line = "line_load"; choose an angle < 180'
        )
    if mesh.elements < 6:
        raise SceneError(
            f"discretization.elements = {mesh.elements}: a membrane with its wetted part needs >= 6"
        )
    if mesh.space != "bspline":
        raise SceneError(
            f'discretization.space = "{space_name(mesh.space)}": not available yet with '
            'solver.contact_line = "line_load"; "bspline" is'
        )
    if sector.model not in ("quarter", "eighth"):
        raise SceneError(
            f'discretization.model = "{sector.model}": not available yet with solver.contact_line '
            '= "line_load"; "quarter" and "eighth" are'
        )


def skin(solid: Plane | Sphere, gamma: float, scale: Scale, how: WholeMembrane) -> list[Term]:
    law = Contact(solid, how.penalty * gamma / scale.length**2, how.penetration_tolerance)
    mu = how.stabilization * gamma
    return [SurfaceTension(gamma), law, Stabilization(mu, how.projected)]


def stepped(
    scene: Scene,
    parameter: str,
    first: Plane | Sphere,
    solid: Plane | Sphere,
    line: LineOnSolid,
    how: WholeMembrane,
) -> Scene:
    """The scene at its own angle, with the steps to it as its ramp."""
    at = AtAngle(scene, line)
    angles = np.linspace(first.contact_angle, solid.contact_angle, how.load_steps + 1)
    values = tuple(float(a) for a in angles)
    return replace(at(solid.contact_angle), ramp=Ramp(parameter, values, at))


@dataclass(frozen=True)
class LineOnSolid:
    """The line inside a whole membrane: what wetting gains there, and the paper's load.

    Attributes
    ----------
    solid : plane or sphere; gamma : surface tension; edge : where in the patch the line is.
    """

    solid: Plane | Sphere
    gamma: float
    edge: str

    def terms(self, angle: float) -> list[Term]:
        """At a contact angle."""
        solid = replace(self.solid, contact_angle=angle)
        wetting: Term = (
            SphereContactLine(self.gamma, solid, self.edge, covered=True)
            if isinstance(solid, Sphere)
            else PlaneContactLine(self.gamma, angle, self.edge, covered=True)
        )
        return [wetting, NormalLineLoad(self.gamma, solid, self.edge)]


@dataclass(frozen=True)
class AtAngle:
    """A scene with a whole membrane at other contact angles.

    Attributes
    ----------
    scene : whose last terms are those of its line; line : which they are.
    """

    scene: Scene
    line: LineOnSolid

    def __call__(self, angle: float) -> Scene:
        line = self.line.terms(angle)
        held = self.scene.terms[: len(self.scene.terms) - len(line)]
        return replace(self.scene, terms=[*held, *line], ramp=None, origin=None)


def kink_of(elements: int) -> int:
    """The element at whose start the contact line lies."""
    return max(2, round(WET * elements))


def edge_of(space: Space) -> str:
    return f"xi2={space.bases[1].joints[0]!r}"


def _under_hole(particle: Sphere, polar: float) -> float:
    """Volume between z = 0 and the cap of a sphere inside a polar angle."""
    a, r = particle.radius * np.sin(polar), particle.radius
    under = 2.0 / 3.0 * (r**3 - (r * np.cos(polar)) ** 3)
    return float(-np.pi * (particle.center[2] * a**2 + under))


def _sheet_start(
    space: Space, particle: Sphere, half: float, boundary: str, curvature: float
) -> Surface:
    """A cap of the sphere from the fixed circle to the line, a funnel from there to the rim."""
    profile = funnel(particle, half, curvature)
    points, matrix = meridian_interpolation(space)
    kink = space.bases[1].joints[0]
    on_solid = points <= kink
    polar = profile.polar * (INNER + (1.0 - INNER) * np.minimum(points / kink, 1.0))
    rate = np.log(profile.rim / profile.edge)
    part = Grading(float(rate / np.expm1(rate))).fraction(
        np.maximum(points - kink, 0.0) / (1 - kink)
    )
    radius = profile.edge + (profile.rim - profile.edge) * part
    top = particle.center[2] / particle.radius
    height = np.where(on_solid, top + np.cos(polar), profile.height(radius))
    inward = np.where(on_solid, np.sin(polar), profile.edge * (1.0 - part))
    outward = np.where(on_solid, 0.0, part)
    values = np.stack([inward, outward, height], axis=1)
    first, second, sag = np.linalg.solve(matrix, values).T[:, :, None]
    ring = circle(space.bases[0])
    outer = half * (ring if boundary == "circle" else square(space.bases[0]))
    r, up = particle.radius, np.array([0.0, 0.0, 1.0])
    net = r * ring[:, None] * first + outer[:, None] * second + r * sag * up
    return Surface(space, points_of(space, net))
