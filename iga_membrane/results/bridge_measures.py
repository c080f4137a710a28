"""Measures of a liquid bridge: its force, its neck and its contact lines."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..problems.scene import Scene
from ..splines import points_of
from ..surface.surface import Surface
from ..terms import BodyDensity
from ..terms.term import WettingLine
from .farthest import narrowest
from .forces import pull_on_sphere, work_of


def bridge_measures(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> dict[str, float]:
    """Measures of a state in the user's units.

    Notes
    -----
    ``force`` is that of liquid and membrane on the upper solid, positive = attraction.
    """
    scale = scene.units
    second = _on_the_second(assembly, surface, multipliers, scene)
    areas = assembly.copies * np.array(assembly.edges.wet_areas(surface.points))
    radii = [
        _radius(term, area) for (term, _), area in zip(assembly.edges.wetted, areas, strict=True)
    ]
    lower_radius, upper_radius = radii
    neck = narrowest(surface, np.zeros(2))
    return {
        "force": -float(second[2]) * scale.force,
        "neck_radius": float(np.hypot(neck[0], neck[1])) * scale.length,
        "contact_radius_lower": lower_radius * scale.length,
        "contact_radius_upper": upper_radius * scale.length,
    }


def _on_the_second(assembly: Assembly, surface: Surface, multipliers: Array, scene: Scene) -> Array:
    """(3,) force on the solid at the membrane's end ``xi2 = 1``, in the scene's frame."""
    term, edge = assembly.edges.wetted[-1]
    if term.ball is not None:
        which = len(assembly.edges.on_spheres) - 1
        return pull_on_sphere(scene, assembly, surface, multipliers, which).total
    # dE by a lift of the plane that carries the membrane along, fading towards its other end
    body = assembly.density(multipliers)
    along = points_of(surface.space, surface.space.abscissae[..., 1:])
    up = np.array([0.0, 0.0, 1.0])
    lifted = work_of(assembly, surface, multipliers, along * up)
    at_level = BodyDensity(float(body.at(term.level * up)) / term.level)
    lifted += term.energy(edge, surface.points, 0.0, at_level)
    return np.asarray(assembly.whole(-lifted * up))


def _radius(term: WettingLine, area: float) -> float:
    """Of a contact circle that bounds an area of a plane, or a cap of a sphere."""
    if term.ball is None:
        return float(np.sqrt(area / np.pi))
    r = term.ball.radius
    return float(r * np.sin(2.0 * np.arcsin(np.sqrt(0.25 * area / np.pi) / r)))
