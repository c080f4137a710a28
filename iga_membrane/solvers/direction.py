"""The direction of a Newton step: exact Hessian, made positive where it must be.

Where it is not, its diagonal is shifted; shifts of a body as a whole, along which the energy may
fall for long, get the curvature of a bowl.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import System
from ..linalg.bordered import Bordered


@dataclass(frozen=True, eq=False)
class Direction:
    """Newton step, new multipliers, the shift it needed, and the index without the shift."""

    step: Array
    multipliers: Array
    shift: float
    index: int


def direction_of(system: System, farthest: float, *, plain: bool) -> Direction:
    """Newton step; the diagonal is shifted until the Hessian is positive where it must be.

    ``plain`` leaves the shift out: the step then leads to the nearest equilibrium, stable or not.
    """
    border = system.constraint_gradients
    diagonal = np.abs(system.matrix.diagonal())
    diagonal = np.maximum(diagonal, 1e-6 * diagonal.max(initial=0.0))
    factor = Bordered(system.matrix, border)
    index, shift = factor.index, 0.0
    rolls = bool(system.shifts) and not plain
    factor = _with_a_bowl(system, factor, farthest) if rolls else factor
    while factor.index > 0 and not plain and shift < 1e8:
        shift = max(8.0 * shift, 1e-3)  # never 1: a negative pivot would vanish
        factor = Bordered(system.matrix, border, shift * diagonal)
        factor = _with_a_bowl(system, factor, farthest) if rolls else factor
    step, multipliers = factor.solve(-system.gradient, -system.constraints)
    return Direction(step, -multipliers, shift, index)


def _with_a_bowl(system: System, factor: Bordered, farthest: float) -> Bordered:
    """Add the curvature of a bowl to the shifts: where they lower the energy like a ball on a hill
    the step leads as far as up a bowl of the same curvature, and nowhere farther than allowed."""
    step, _ = factor.solve(-system.gradient, -system.constraints)
    curvature, axes = np.linalg.eigh(factor.last(system.shifts))
    pull = -curvature * (axes.T @ step[-system.shifts :])
    bowl = 2.0 * max(0.0, -curvature[0])
    while np.linalg.norm(pull / (curvature + bowl)) > farthest:
        bowl = 1.5 * bowl + 1e-3 * np.abs(curvature).max()
    return factor.stiffened(bowl * np.eye(system.shifts)) if bowl else factor
