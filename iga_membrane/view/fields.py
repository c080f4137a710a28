"""Fields on a membrane, by name: what pictures colour and files hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arrays import Array
from ..solids import Solid
from ..surface.kinematics import Kinematics

if TYPE_CHECKING:
    from ..driver.solution import Solution

FIELDS = ("mean_curvature", "pressure", "gap", "residual")
"""Names of the fields."""


def field(solution: Solution, name: str, kinematics: Kinematics) -> Array:
    """A field at points of the membrane, in the user's units.

    Parameters
    ----------
    name : "mean_curvature", exactly that of the spline; "pressure", liquid minus gas; "gap" to the
        nearest solid; "residual", ``2 H gamma + p``, zero at equilibrium, and where the membrane
        lies on a solid minus the contact pressure.

    Returns
    -------
    (...) values at ``kinematics.position``; a gap is infinite where there is no solid.
    """
    if name == "mean_curvature":
        return kinematics.mean_curvature
    if name == "pressure":
        return solution.pressure(kinematics.position)
    if name == "residual":
        return solution.laplace_residual(kinematics)
    return gap(solution, kinematics.position)


def solids(solution: Solution) -> list[Solid]:
    """Substrate and particles, each once."""
    scene = solution.scene
    found: list[Solid] = [] if scene.substrate is None else [scene.substrate]
    return found + [each for each in scene.particles if each != scene.substrate]


def gap(solution: Solution, points: Array) -> Array:
    """Distance (...) of points (..., 3) from the nearest solid, negative inside it."""
    gaps = [each.nearest(points).gap for each in solids(solution)]
    return np.asarray(np.min(gaps, axis=0)) if gaps else np.full(points.shape[:-1], np.inf)
