"""Newton's method for membranes: exact Hessian, step limit, energy line search, inertia shift.

One iteration: re-base the spines, factorize, shift until the Hessian is positive on the
constraints' null space, limit the step, search along it on an exact merit function, walk the
meridians by arc length again while steps are large.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from time import process_time

import numpy as np
from numpy.typing import NDArray

from ..errors import GeometryError
from ..splines import Grading
from ..surface.reparametrize import arc_length, distortion
from ..surface.surface import Surface
from .assembly import Assembly, System
from .linear import Bordered, SingularMatrix
from .status import Status

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NewtonOptions:
    """Tolerances, all relative to the scene's length and tension.

    Attributes
    ----------
    max_iterations : of one solve at one load.
    tolerance : the last step's largest displacement.
    step_limit : largest displacement of a control point in one step.
    polish_below : steps smaller than this are followed by a last walk by arc length.
    deadline : CPU time (``process_time``) after which to stop.
    """

    max_iterations: int = 50
    tolerance: float = 1e-8
    step_limit: float = 0.25
    polish_below: float = 1e-3
    deadline: float = float("inf")


@dataclass(frozen=True)
class Iteration:
    """One Newton step: relative residual before it, its size, the part of it taken."""

    residual: float
    step: float
    taken: float
    shift: float


@dataclass(eq=False)
class NewtonResult:
    """End of an iteration.

    Attributes
    ----------
    status : None where it converged.
    surface, multipliers : the best state.
    index : negative eigenvalues of the last Hessian on the constraints' null space.
    """

    surface: Surface
    multipliers: Array
    status: Status | None = None
    message: str = ""
    index: int = 0
    iterations: list[Iteration] = field(default_factory=list)
    linear_seconds: float = 0.0


def newton(
    assembly: Assembly,
    surface: Surface,
    multipliers: Array | None,
    grading: Grading | None,
    options: NewtonOptions,
) -> NewtonResult:
    """Iterate to an equilibrium.

    Parameters
    ----------
    surface : start in the scene's scale.
    multipliers : start, or None for the best balance of the start's forces.
    grading : of the arc length, or None to leave the parametrization alone.
    """
    lines = slice(0, None)
    result = NewtonResult(surface, np.zeros(len(assembly.constraints)))
    guess = multipliers
    polish = 2
    for _ in range(options.max_iterations):
        if process_time() > options.deadline:
            return _ended(result, Status.INTERRUPTED, "the CPU limit was reached")
        try:
            motion = assembly.spines.on(result.surface)
        except GeometryError as error:
            return _ended(result, Status.NONFINITE, str(error))
        if guess is None:
            start = assembly.system(result.surface, motion.directions, result.multipliers)
            guess = np.linalg.lstsq(start.constraint_gradients, start.gradient)[0]
        result.multipliers = guess
        system = assembly.system(result.surface, motion.directions, guess)
        if not np.isfinite(system.gradient).all():
            return _ended(result, Status.NONFINITE, "the residual is not finite")
        before = process_time()
        try:
            step, new_multipliers, shift, result.index = _direction(system)
        except SingularMatrix as error:
            return _ended(result, Status.LINEAR_SOLVE_FAILED, str(error))
        finally:
            result.linear_seconds += process_time() - before
        displacement = motion.displacement(step)
        size = float(np.linalg.norm(displacement, axis=1).max(initial=0.0))
        residual = float(np.linalg.norm(system.residual(guess)) / system.scale)
        if not np.isfinite(size):
            return _ended(result, Status.NONFINITE, "the Newton step is not finite")
        longest = min(1.0, options.step_limit / size) if size > 0 else 1.0
        taken, moved = _search(
            assembly, system, result.surface, displacement, step, new_multipliers, longest
        )
        result.iterations.append(Iteration(residual, size, taken, shift))
        if moved is None:
            if residual <= 1e-10:
                return result
            return _ended(
                result, Status.STALLED, f"no step along the Newton direction lowers the energy "
                f"(relative residual {residual:.1e})"
            )  # fmt: skip
        result.surface = moved
        guess = guess + taken * (new_multipliers - guess)
        result.multipliers = guess
        if taken == 1.0 and size <= options.tolerance and not shift:
            return result
        if residual <= 1e-12 and size <= 1e-6:
            return result  # rounding floor of an ill-conditioned state
        if grading is not None:
            small = size * taken <= options.polish_below
            allowed = 1e-6 if small else 0.2
            try:
                if polish > 0 and distortion(result.surface, grading, lines) > allowed:
                    result.surface = arc_length(result.surface, grading, lines)
                    polish -= small
            except (GeometryError, np.linalg.LinAlgError) as error:
                return _ended(result, Status.NONFINITE, str(error))
    return _ended(result, Status.MAX_ITER, f"{options.max_iterations} iterations did not converge")


def _ended(result: NewtonResult, status: Status, message: str) -> NewtonResult:
    result.status, result.message = status, message
    return result


def _direction(system: System) -> tuple[Array, Array, float, int]:
    """Newton step; the diagonal is shifted until the Hessian is positive where it must be."""
    border = system.constraint_gradients
    index = None
    shift = 0.0
    for _ in range(12):
        diagonal = np.abs(system.matrix.diagonal())
        diagonal = np.maximum(diagonal, diagonal.max() * 1e-6)
        factor = Bordered(system.matrix, border, shift * diagonal if shift else None)
        index = factor.index if index is None else index
        if factor.index <= 0:
            break
        shift = max(10.0 * shift, 1e-3)
    step, multipliers = factor.solve(-system.gradient, -system.constraints)
    return step, -multipliers, shift, index


def _search(
    assembly: Assembly,
    system: System,
    surface: Surface,
    displacement: Array,
    step: Array,
    multipliers: Array,
    longest: float,
) -> tuple[float, Surface | None]:
    """Backtrack on ``E - m . c + kappa/2 |c|^2``; the part taken and the new state, or None.

    With the new multipliers m the slope along the Newton step is ``-s^T K s - kappa |c|^2``;
    kappa makes it negative even where K is not.
    """
    start = assembly.energies(surface)
    c = system.constraints
    slope = float(system.gradient @ step - multipliers @ (system.constraint_gradients.T @ step))
    square = float(c @ c)
    kappa = 1.0
    if square > 0 and slope - kappa * square > -abs(slope):
        kappa = 2.0 * abs(slope) / square + 1.0
    slope -= kappa * square

    def merit(total: float, missing: Array) -> float:
        return float(total - multipliers @ missing + 0.5 * kappa * missing @ missing)

    begin = merit(start.total, start.constraints)
    noise = 1e-13 * (abs(start.total) + abs(begin))
    part = longest
    for _ in range(25):
        trial = surface.moved(surface.points + part * displacement)
        energies = assembly.energies(trial)
        value = merit(energies.total, energies.constraints)
        if (
            energies.regular_after(start)
            and not (assembly.above_plane and energies.lowest < -1e-9)
            and value <= begin + 1e-4 * part * slope + noise
        ):
            return part, trial
        part *= 0.5
    return 0.0, None
