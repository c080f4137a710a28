"""Newton's method for membranes: exact Hessian, step limit, energy line search, inertia shift.

One iteration: re-base the spines, factorize, shift until the Hessian is positive on the
constraints' null space, limit the step, search along it on an exact merit function, walk the
meridians by arc length again while steps are large.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from time import thread_time

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly, System
from ..deadline import OutOfTime, check_time, until
from ..errors import GeometryError
from ..linalg.bordered import Bordered
from ..linalg.inverse_root import SingularMatrix
from ..splines import Grading
from ..status import Status
from ..surface.reparametrize import distortion, regridded
from ..surface.surface import Surface

log = logging.getLogger(__name__)

NEAR = 1e-3
"""Relative residual below which an unstable equilibrium is approached, not fled."""
POLISHES = 2
"""Walks by arc length after the steps have become small; each costs one or two iterations."""
POLISHED = 1e-6
"""Distortion that a last walk leaves alone."""
UNEVEN, FALLING = 1e-3, 0.3
"""Distortion of a converged state that is mended and the iteration begun again, and over that of
the time before at most: contact lines that are nearly tangent to their solid slide far along it,
and find their place on an even mesh only."""
DISTORTED = 0.2
"""Distortion that is mended at once, also while steps are large."""
ROUNDS = 30
"""Updates of the multipliers of contact at most."""
CRAWL, PATIENCE = 0.02, 5
"""Part of a step, and how often in a row no more of it may be taken, with contact: a membrane that
has been carried too far sideways folds."""
LAG, ROLLS = 1.0, 30
"""Way over the contact length that a droplet's top may roll ahead of its foot before the start
begins anew there, and how often it does."""
ROLL, HELD = 0.5, 0.01
"""Way over the contact length that a droplet may roll in one step: once its foot has taken a full
step, and before; less while it rolls to and fro."""
FLOOR = 1e-12
"""Relative residual of a state that no step improves."""
ROUNDING = 1e-10
"""Relative residual at which a search that finds no descent has met rounding, not an obstacle."""


@dataclass(frozen=True)
class NewtonOptions:
    """Tolerances, all relative to the scene's length and tension.

    Attributes
    ----------
    max_iterations : of one solve at one load, and with one set of multipliers of contact.
    tolerance : the last step's largest displacement.
    step_limit : largest displacement of a control point in one step.
    polish_below : steps smaller than this are followed by a last walk by arc length.
    near : relative residual below which an unstable equilibrium is approached, not fled.
    deadline : CPU time (``thread_time``) after which to stop.
    phase : what its iterations are called in a log.
    """

    max_iterations: int = 50
    tolerance: float = 1e-8
    step_limit: float = 0.25
    polish_below: float = 1e-3
    near: float = NEAR
    deadline: float = float("inf")
    phase: str = "solve"


@dataclass(frozen=True)
class Iteration:
    """One Newton step: relative residual before it, its size, the part of it taken; both 0 where
    the linear system could not be solved."""

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
    surface, multipliers : the equilibrium, or the state of smallest residual met.
    best : that residual and state.
    index : negative eigenvalues of the last Hessian on the constraints' null space.
    floor : relative residual at which rounding ended the iteration, before its tolerance; or None.
    """

    surface: Surface
    multipliers: Array
    status: Status | None = None
    message: str = ""
    index: int = 0
    best: tuple[float, Surface, Array] | None = None
    iterations: list[Iteration] = field(default_factory=list)
    linear_seconds: float = 0.0
    floor: float | None = None


class _Stop(Exception):
    """The iteration ends with a status."""

    def __init__(self, status: Status, message: str) -> None:
        super().__init__(message)
        self.status = status


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
    count = assembly.multipliers
    result = NewtonResult(surface, np.zeros(count) if multipliers is None else multipliers)
    try:
        with until(options.deadline):
            _begin(assembly, surface)
            if multipliers is None and count:
                result.multipliers = _best_balance(assembly, surface)
            _iterate(assembly, result, grading, options)
        return result
    except _Stop as stop:
        result.status, result.message = stop.status, str(stop)
    except OutOfTime as end:
        result.status, result.message = Status.INTERRUPTED, str(end)
    except SingularMatrix as error:
        result.status, result.message = Status.LINEAR_SOLVE_FAILED, str(error)
    except (GeometryError, np.linalg.LinAlgError) as error:
        result.status, result.message = Status.NONFINITE, str(error)
    except MemoryError:
        result.status = Status.LINEAR_SOLVE_FAILED
        result.message = "the memory does not suffice for a Newton step"
    if result.best is not None:
        _, result.surface, result.multipliers = result.best
    return result


def _begin(assembly: Assembly, surface: Surface) -> None:
    """Find what is in contact at the start."""
    check_time()
    assembly.contact.begin(surface)


def _iterate(
    assembly: Assembly, result: NewtonResult, grading: Grading | None, options: NewtonOptions
) -> None:
    """Newton steps until convergence; improves ``result`` in place."""
    polish = POLISHES
    flee, approached, uneven = False, None, np.inf
    left, rounds, crawling, rolled = options.max_iterations, 0, 0, 0
    steady, reach = False, ROLL
    way: Array = np.zeros(3)
    roll: Array = np.zeros(len(assembly.spines.shifts))
    while left and rounds < ROUNDS:
        left -= 1
        motion = assembly.motion(result.surface)
        result.surface = assembly.relaxed(result.surface, motion)
        system = assembly.system(result.surface, motion.directions, result.multipliers)
        residual = float(np.linalg.norm(system.residual(result.multipliers)) / system.scale)
        if not np.isfinite(residual):
            raise _Stop(Status.NONFINITE, "the residual is not finite")
        flee = flee or (approached is not None and residual > approached and options.near < 1.0)
        if result.best is None or residual < result.best[0]:
            result.best = (residual, result.surface, result.multipliers)
        before = thread_time()
        farthest = (reach if steady else HELD) * assembly.contact.reach
        try:
            direction = _direction(system, farthest, plain=residual <= options.near and not flee)
        except SingularMatrix:
            result.iterations.append(Iteration(residual, 0.0, 0.0, 0.0))
            raise
        result.linear_seconds += thread_time() - before
        result.index = direction.index
        approached = residual if direction.index > 0 and not direction.shift else None
        displacement = assembly.displacement(motion, direction.step)
        size = assembly.largest(result.surface, displacement)
        if not np.isfinite(size):
            raise _Stop(Status.NONFINITE, "the Newton step is not finite")
        near = assembly.near_contact(result.surface, displacement)
        longest = min(1.0, options.step_limit / size) if size > 0 else 1.0
        if near > 0.5:
            longest = min(longest, 0.5 / near)
        taken, moved = _search(assembly, system, result.surface, displacement, direction, longest)
        result.iterations.append(Iteration(residual, size, taken, direction.shift))
        log.debug("%s, %d, residual %.0e", options.phase, len(result.iterations), residual)
        if moved is None and residual <= ROUNDING:
            result.floor = residual
            return
        crawling = crawling + 1 if taken < CRAWL else 0
        if assembly.contact.lies and crawling >= PATIENCE:
            raise _Stop(Status.STALLED, f"{PATIENCE} steps in a row were cut short")
        if moved is None:
            raise _Stop(
                Status.STALLED,
                f"no step along the Newton direction lowers the energy (relative residual "
                f"{residual:.1e})",
            )
        result.surface, steady = moved, taken == 1.0
        last, roll = roll, direction.step[assembly.size - len(roll) :]
        reach = max(0.5 * reach, HELD) if roll @ last < 0.0 else min(1.5 * reach, ROLL)
        if assembly.contact.lies:
            lag = assembly.spines.lag(moved)
            ahead = np.linalg.norm(lag) > LAG * assembly.contact.length
            # one that rolls back is near its place
            if ahead and assembly.contact.rounds == 0 and rolled < ROLLS and lag @ way >= 0.0:
                result.surface, steady = assembly.anew(moved), False
                left, rolled, way = options.max_iterations, rolled + 1, lag
        result.multipliers = result.multipliers + taken * (
            direction.multipliers - result.multipliers
        )
        # where energies differ by rounding only, no part of a step tells more than another
        floor = residual <= FLOOR and size <= options.tolerance
        full = (taken == 1.0 or floor) and not direction.shift
        if full and not assembly.contact.settled_at(result.surface, near):
            if assembly.contact.rounds > rounds:
                # other multipliers of contact are another problem
                left, rounds = options.max_iterations, assembly.contact.rounds
            continue
        if full and size <= options.tolerance:
            twist = 0.0 if grading is None else distortion(result.surface, grading)
            if grading is None or not UNEVEN < twist <= FALLING * uneven:
                return
            result.surface = regridded(result.surface, grading)
            uneven, polish = twist, POLISHES
            continue
        if full and residual <= FLOOR and size <= 1e-6:
            result.floor = residual  # of an ill-conditioned state, or of a tolerance below it
            return
        if grading is not None and polish:
            small = size * taken <= options.polish_below
            allowed = POLISHED if small else DISTORTED
            if distortion(result.surface, grading) > allowed:
                result.surface = regridded(result.surface, grading)
                polish -= small
    raise _Stop(Status.MAX_ITER, f"{options.max_iterations} iterations did not converge")


def _best_balance(assembly: Assembly, surface: Surface) -> Array:
    """Multipliers that leave the least of the forces of a state."""
    gradient, columns = assembly.forces(surface, assembly.motion(surface).directions)
    return np.asarray(np.linalg.lstsq(columns, gradient)[0], float)


@dataclass(frozen=True, eq=False)
class _Direction:
    """Newton step, new multipliers, the shift it needed, and the index without the shift."""

    step: Array
    multipliers: Array
    shift: float
    index: int


def _direction(system: System, farthest: float, *, plain: bool) -> _Direction:
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
    return _Direction(step, -multipliers, shift, index)


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


def _search(
    assembly: Assembly,
    system: System,
    surface: Surface,
    displacement: Array,
    direction: _Direction,
    longest: float,
) -> tuple[float, Surface | None]:
    """Backtrack on ``E - m . c + kappa/2 |c|^2``; the part taken and the new state, or None.

    With the new multipliers m the slope along the Newton step is ``-s^T K s - kappa |c|^2``;
    kappa makes it negative even where K is not.
    """
    start = system.energies
    c, multipliers = system.constraints, direction.multipliers
    along = system.gradient - system.constraint_gradients @ multipliers
    slope = float(along @ direction.step)
    square = float(c @ c)
    kappa = 1.0
    if square > 0 and slope - kappa * square > -abs(slope):
        kappa = 2.0 * abs(slope) / square + 1.0
    slope -= kappa * square
    uphill = (direction.index > 0 and not direction.shift) or not assembly.conservative

    def merit(total: float, missing: Array) -> float:
        return float(total - multipliers @ missing + 0.5 * kappa * missing @ missing)

    begin = merit(start.total, start.constraints)
    noise = 1e-13 * (abs(start.total) + abs(begin))
    lowest = -np.inf
    if assembly.above_plane:
        lowest = -assembly.contact.depth_allowed
    part = longest
    for _ in range(25):
        trial = surface.moved(surface.points + part * displacement)
        energies = assembly.energies(trial)
        value = merit(energies.total, energies.constraints)
        if (
            energies.regular_after(start)
            and energies.lowest >= lowest
            and (uphill or value <= begin + 1e-4 * part * slope + noise)
        ):
            return part, trial
        part *= 0.5
    return 0.0, None
