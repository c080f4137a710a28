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
from ..deadline import OutOfTime, until
from ..dofs.spines import Motion
from ..errors import GeometryError
from ..linalg.inverse_root import SingularMatrix
from ..splines import Grading
from ..status import Status
from ..surface.surface import Surface
from .direction import Direction, direction_of
from .line_search import search
from .meridians import Meridians
from .rolling import Rolling

log = logging.getLogger(__name__)

NEAR = 1e-3
"""Relative residual below which an unstable equilibrium is approached, not fled."""
ROUNDS = 30
"""Updates of the multipliers of contact at most."""
CRAWL, PATIENCE = 0.02, 5
"""Part of a step, and how often in a row no more of it may be taken, with contact: a membrane that
has been carried too far sideways folds."""
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
            assembly.contact.begin(surface)
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


def _iterate(
    assembly: Assembly, result: NewtonResult, grading: Grading | None, options: NewtonOptions
) -> None:
    """Newton steps until convergence; improves ``result`` in place."""
    rolling, target = Rolling(assembly), _Target(options.near)
    meridians, budget = Meridians(grading, options.polish_below), _Budget(assembly, options)
    while budget.left:
        motion, system, residual = _linearized(assembly, result)
        direction = _solved(system, result, rolling.farthest, residual, target)
        displacement = assembly.displacement(motion, direction.step)
        size, near = _sizes(assembly, result.surface, displacement)
        longest = _longest(size, near, options.step_limit)
        taken, moved = search(assembly, system, result.surface, displacement, direction, longest)
        result.iterations.append(Iteration(residual, size, taken, direction.shift))
        log.debug("%s, %d, residual %.0e", options.phase, len(result.iterations), residual)
        budget.spend(taken)
        if moved is None and residual <= ROUNDING:
            result.floor = residual
            return
        if moved is None or budget.crawls:
            raise budget.stalled(residual)
        result.surface, begun = rolling.after(moved, direction.step, taken)
        if begun:
            budget.renew()
        change = direction.multipliers - result.multipliers
        result.multipliers = result.multipliers + taken * change
        if not _is_whole(direction, taken, residual, size <= options.tolerance):
            result.surface = meridians.after(result.surface, size * taken)
        elif not assembly.contact.settled_at(result.surface, near):
            budget.next_round()
        elif size <= options.tolerance:
            mended = meridians.of_converged(result.surface)
            if mended is None:
                return
            result.surface = mended
        elif residual <= FLOOR and size <= 1e-6:
            result.floor = residual  # of an ill-conditioned state, or of a tolerance below it
            return
        else:
            result.surface = meridians.after(result.surface, size * taken)
    raise _Stop(Status.MAX_ITER, f"{options.max_iterations} iterations did not converge")


def _is_whole(direction: Direction, taken: float, residual: float, small: bool) -> bool:
    """Whether a Newton step was taken as it is: where energies differ by rounding only, no part of
    it tells more than another."""
    return (taken == 1.0 or (residual <= FLOOR and small)) and not direction.shift


class _Budget:
    """Iterations that are left, renewed where another problem begins.

    Parameters
    ----------
    assembly : whose multipliers of contact are updated in rounds, each another problem.
    """

    def __init__(self, assembly: Assembly, options: NewtonOptions) -> None:
        self._contact, self._most = assembly.contact, options.max_iterations
        self._iterations, self._rounds, self._crawling = options.max_iterations, 0, 0

    @property
    def left(self) -> bool:
        """Whether another iteration may follow."""
        return self._iterations > 0 and self._rounds < ROUNDS

    @property
    def crawls(self) -> bool:
        """Whether a membrane in contact comes forward no more."""
        return self._contact.lies and self._crawling >= PATIENCE

    def spend(self, taken: float) -> None:
        """One iteration, of whose step a part was taken."""
        self._iterations -= 1
        self._crawling = self._crawling + 1 if taken < CRAWL else 0

    def renew(self) -> None:
        """All iterations again."""
        self._iterations = self._most

    def next_round(self) -> None:
        """All iterations again, if the multipliers of contact have been updated."""
        if self._contact.rounds > self._rounds:
            self._rounds = self._contact.rounds
            self.renew()

    def stalled(self, residual: float) -> _Stop:
        """Why an iteration does not go on."""
        if self.crawls:
            return _Stop(Status.STALLED, f"{PATIENCE} steps in a row were cut short")
        return _Stop(
            Status.STALLED,
            "no step along the Newton direction lowers the energy (relative residual "
            f"{residual:.1e})",
        )


def _longest(size: float, near: float, limit: float) -> float:
    """Longest part of a step of a size, and near solids: not beyond the limit, nor over more than
    half a contact length there."""
    part = min(1.0, limit / size) if size > 0 else 1.0
    return min(part, 0.5 / near) if near > 0.5 else part


class _Target:
    """Which equilibrium a step leads to: the nearest one, or a stable one.

    Parameters
    ----------
    near : relative residual below which an unstable equilibrium is approached, not fled.
    """

    def __init__(self, near: float) -> None:
        self._near, self._flee = near, False
        self._approached: float | None = None

    def nearest(self, residual: float) -> bool:
        """Whether the step from a state leads to the nearest equilibrium, stable or not: one that
        has come no nearer on such a step is fled from then on."""
        away = self._approached is not None and residual > self._approached
        self._flee = self._flee or (away and self._near < 1.0)
        return residual <= self._near and not self._flee

    def took(self, direction: Direction, residual: float) -> None:
        """Take note of a step's direction."""
        approached = direction.index > 0 and not direction.shift
        self._approached = residual if approached else None


def _linearized(assembly: Assembly, result: NewtonResult) -> tuple[Motion, System, float]:
    """Motion, linearization and relative residual of a state, which is kept if it is the best."""
    motion = assembly.motion(result.surface)
    result.surface = assembly.relaxed(result.surface, motion)
    system = assembly.system(result.surface, motion.directions, result.multipliers)
    residual = float(np.linalg.norm(system.residual(result.multipliers)) / system.scale)
    if not np.isfinite(residual):
        raise _Stop(Status.NONFINITE, "the residual is not finite")
    if result.best is None or residual < result.best[0]:
        result.best = (residual, result.surface, result.multipliers)
    return motion, system, residual


def _solved(
    system: System, result: NewtonResult, farthest: float, residual: float, target: _Target
) -> Direction:
    """The direction of a step, with its seconds and its index."""
    before = thread_time()
    try:
        direction = direction_of(system, farthest, plain=target.nearest(residual))
    except SingularMatrix:
        result.iterations.append(Iteration(residual, 0.0, 0.0, 0.0))
        raise
    result.linear_seconds += thread_time() - before
    result.index = direction.index
    target.took(direction, residual)
    return direction


def _sizes(assembly: Assembly, surface: Surface, displacement: Array) -> tuple[float, float]:
    """Size of a step, and near solids over the contact length."""
    size = assembly.largest(surface, displacement)
    if not np.isfinite(size):
        raise _Stop(Status.NONFINITE, "the Newton step is not finite")
    return size, assembly.near_contact(surface, displacement)


def _best_balance(assembly: Assembly, surface: Surface) -> Array:
    """Multipliers that leave the least of the forces of a state."""
    gradient, columns = assembly.forces(surface, assembly.motion(surface).directions)
    return np.asarray(np.linalg.lstsq(columns, gradient)[0], float)
