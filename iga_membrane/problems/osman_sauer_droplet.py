"""Droplets by the paper's formulation (section 6.1, figures 5 and 6)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..dofs.boundary_conditions import Fixed
from ..errors import SceneError
from ..initial.liquid import Discretization
from ..initial.profiles import Pancake, least_energy_pancake
from ..solids import Plane
from ..splines import Space, points_of
from ..surface.ring import circle, drop_space, meridian_interpolation
from ..surface.surface import Surface
from ..terms import Stabilization
from .osman_sauer import (
    EASY,
    INNER,
    LineOnSolid,
    WholeMembrane,
    check_mesh,
    described,
    edge_of,
    kink_of,
    skin,
    solver_table,
    stepped,
)
from .scene import Ramp, Scene


def by_whole_membrane(
    scene: Scene, asked: Discretization, bond: float, start: object, how: WholeMembrane
) -> Scene:
    """The paper's formulation of a droplet.

    Parameters
    ----------
    scene : the same droplet by the default formulation.
    asked : mesh that was asked for.
    bond : Bond number of gravity towards the solid.
    start : that was asked for; there is none here.

    Raises
    ------
    SceneError
        A solid, a start or particles that it is not built for.
    """
    if start is not None or scene.particles:
        raise SceneError(
            'solver.contact_line = "line_load": not available yet from a start or with particles '
            "on a droplet"
        )
    if scene.by_form.obstacles:
        return _lying(scene, how)
    if isinstance(scene.substrate, Plane):
        return _with_wetted_part(scene, scene.substrate, asked, bond, how)
    raise SceneError(
        'solver.contact_line = "line_load": not available yet for droplets on spheres below 180 '
        "degrees"
    )


def _with_wetted_part(
    scene: Scene, plane: Plane, asked: Discretization, bond: float, how: WholeMembrane
) -> Scene:
    """A droplet on a level plane, its contact line inside the membrane."""
    mesh = asked.mesh(degree=3, elements=24)
    check_mesh(mesh, scene.sector, plane.contact_angle)
    scale, gamma = scene.units, scene.units.tension
    angle = max(EASY, plane.contact_angle)
    pancake = least_energy_pancake(angle, bond, 4.0 * np.pi / 3.0)
    kink = kink_of(mesh.elements)
    space = drop_space(mesh.space, mesh.degree, mesh.elements, kink=kink)
    local = _droplet_start(space, pancake)
    first = replace(plane, contact_angle=max(EASY, plane.contact_angle))

    line = LineOnSolid(plane, gamma, edge_of(space))
    kept = [t for t in scene.terms if t.name in ("volume", "gravity")]
    whole = Scene(
        local.moved(scale.to_world(local.points)),
        [*skin(plane, gamma, scale, how), *kept, *line.terms(first.contact_angle)],
        [scene.sector, Fixed("xi2=0")],
        scale=scale,
        motion="cartesian",
        substrate=plane,
        kind=scene.kind,
        description=described(scene.description, mesh, how),
        warnings=scene.warnings,
    )
    return stepped(whole, "substrate.contact_angle", first, plane, line, how)


def _lying(scene: Scene, how: WholeMembrane) -> Scene:
    """A droplet at 180 degrees (figures 5 and 6).

    Raises
    ------
    SceneError
        Nothing weighs the droplet, or it has more asperities than a mesh resolves.
    """
    law = scene.by_form.obstacle
    assert law is not None
    if law.ring is not None:
        raise SceneError(
            'solver.contact_line = "line_load": the asperities are so many that they are point '
            "supports; the paper's formulation resolves each of them: take fewer"
        )
    if not any(scene.acceleration):
        raise SceneError(
            "gravity.acceleration = 0: the load steps of the paper's formulation at 180 degrees "
            "are steps of the weight; give one > 0"
        )
    scale = scene.units
    law = replace(
        law, penalty=how.penalty * scale.tension / scale.length**2, compliance=0.0,
        depth=how.penetration_tolerance,
    )  # fmt: skip
    # the first step begins as deep as the pressure of a ball sinks
    sunk = np.array([0.0, 0.0, 2.0 * scale.length / how.penalty]) @ np.transpose(scale.axes)
    kept = [term for term in scene.terms if term not in scene.by_form.obstacles]
    whole = replace(
        scene,
        surface=scene.surface.moved(scene.surface.points - sunk),
        terms=[*kept, law, Stabilization(how.stabilization * scale.tension, how.projected)],
        motion="cartesian",
        description=dict(scene.description) | {"solver": solver_table(how)},
        ramp=None, predictor=None, otherwise=None, finer=None, recipe=None, origin=None,
    )  # fmt: skip
    weight = np.linalg.norm(scene.acceleration)
    # without any weight the droplet would not touch its solid
    values = np.linspace(0.0, weight, how.load_steps + 1)[1:]
    values = np.append(0.5 * values[0], values)
    ramp = Ramp("gravity.acceleration", tuple(map(float, values)), AtWeight(whole))
    return replace(whole, ramp=ramp)


@dataclass(frozen=True)
class AtWeight:
    """A droplet at other accelerations of gravity along its own.

    Attributes
    ----------
    scene : at its own.
    """

    scene: Scene

    def __call__(self, acceleration: float) -> Scene:
        own = np.array(self.scene.acceleration)
        x, y, z = (float(a) for a in acceleration / np.linalg.norm(own) * own)
        terms = [
            replace(term, acceleration=(x, y, z)) if term in self.scene.by_form.weights else term
            for term in self.scene.terms
        ]
        return replace(self.scene, terms=terms, acceleration=(x, y, z), ramp=None, origin=None)


def _droplet_start(space: Space, pancake: Pancake) -> Surface:
    """A ring on the plane from the fixed circle to the line, a rounded pancake from there on."""
    points, matrix = meridian_interpolation(space)
    kink = space.bases[1].joints[0]
    on_solid = points <= kink
    r, z = pancake(np.maximum(points - kink, 0.0) / (1.0 - kink))
    r = np.where(on_solid, r[0] * (INNER + (1.0 - INNER) * np.minimum(points / kink, 1.0)), r)
    values = np.stack([r, np.where(on_solid, 0.0, z)], axis=1)
    # at the pole the last value but one is the slope there
    values[-2] = -pancake.length / (1.0 - kink), 0.0
    r, z = np.linalg.solve(matrix, values).T
    ring: Array = circle(space.bases[0])
    net = ring[:, None] * r[:, None] + np.outer(z, [0.0, 0.0, 1.0])
    return Surface(space, points_of(space, net))
