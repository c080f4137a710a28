"""Load stepping with halving: the way round where a direct solve fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import GeometryError
from ..scenes.scene import Ramp, Scene
from ..surface.reparametrize import arc_length
from .assembly import Assembly
from .linear import SingularMatrix
from .newton import NewtonOptions, NewtonResult, newton
from .stability import stability_of
from .status import Status


@dataclass(frozen=True)
class LoadStep:
    """One attempted load: its Newton iterations and how it ended (None: converged)."""

    load: float
    iterations: int
    status: Status | None


@dataclass(frozen=True)
class Bracket:
    """Values of a parameter between which the equilibrium is lost.

    Attributes
    ----------
    parameter : its path in the scene file; lo : the last value with a stable equilibrium, hi : the
        first without.
    index_lo, index_hi : negative eigenvalues of the Hessian there; at ``hi`` of the last iterate.
    """

    parameter: str
    lo: float
    hi: float
    index_lo: int
    index_hi: int


@dataclass(eq=False)
class LoadPath:
    """End of load stepping.

    Attributes
    ----------
    result : at the last good load, with the status of the last attempt.
    scene : the scene at that load.
    steps : every attempt.
    bracket : of the limit point, if that is why it ended.
    """

    result: NewtonResult
    scene: Scene
    steps: list[LoadStep] = field(default_factory=list)
    last_good: float = 0.0
    bracket: Bracket | None = None


def load_stepping(
    ramp: Ramp,
    assembly: Assembly,
    options: NewtonOptions,
    smallest: float,
    report: Callable[[float], None] = lambda load: None,
) -> LoadPath:
    """From the ramp's own start at load 0 to load 1, in steps that grow and halve.

    Parameters
    ----------
    ramp : its scenes share the assembly's space and supports.
    smallest : step of the load below which to give up: LIMIT_POINT if the smallest eigenvalue
        foretells a fold there, else STALLED.
    report : called with every load reached.
    """
    scene = ramp(0.0)
    assembly.load(scene)
    result = newton(assembly, scene.local_surface(), None, scene.grading, options)
    path = LoadPath(result, scene, [LoadStep(0.0, len(result.iterations), result.status)])
    if result.status is not None:
        return path
    attempts = replace(options, max_iterations=min(options.max_iterations, PATIENCE))
    step = 0.25
    while path.last_good < 1.0:
        load = min(1.0, path.last_good + step)
        result = _attempt(assembly, path, ramp(load), attempts)
        path.steps.append(LoadStep(load, len(result.iterations), result.status))
        if result.status is None and result.index <= 0:
            path.result, path.scene, path.last_good = result, ramp(load), load
            report(load)
            step *= 1.5 if len(result.iterations) > 5 else 2.0
        elif result.status is Status.INTERRUPTED:
            path.result.status, path.result.message = result.status, result.message
            break
        else:
            step *= 0.5
            if step < smallest:
                _give_up(assembly, path, ramp, load, result, attempts)
                break
    return path


PATIENCE = 20
"""Newton iterations of one attempt: a load that needs more is approached by shorter steps."""
FOLD = 3.0
"""Steps of load within which a limit point must be foretold by the smallest eigenvalue."""


def _attempt(
    assembly: Assembly, path: LoadPath, scene: Scene, options: NewtonOptions
) -> NewtonResult:
    """Newton at a new load from the last good state."""
    assembly.load(scene)
    good = path.result
    # what the start knows of the parameter, moved rims above all, comes with it
    shift = scene.local_surface().points - path.scene.local_surface().points
    try:
        start = arc_length(good.surface.moved(good.surface.points + shift), scene.grading)
    except (GeometryError, np.linalg.LinAlgError) as error:
        return NewtonResult(good.surface, good.multipliers, Status.NONFINITE, str(error))
    return newton(assembly, start, good.multipliers, scene.grading, options)


def _give_up(
    assembly: Assembly,
    path: LoadPath,
    ramp: Ramp,
    load: float,
    failed: NewtonResult,
    options: NewtonOptions,
) -> None:
    """Name the end of a path: a limit point, or a solver at a loss.

    At a fold the square of the smallest eigenvalue falls linearly to zero. Its extrapolation from
    a step before the last good load must end about where the attempts fail.
    """
    lo, hi = ramp.value(path.last_good), ramp.value(load)
    step = load - path.last_good
    back = max(0.0, path.last_good - step)
    earlier = _attempt(assembly, path, ramp(back), options)
    softer = _stiffness(assembly, earlier) if earlier.status is None else 0.0
    assembly.load(path.scene)
    left = _stiffness(assembly, path.result)
    fall = softer**2 - left**2
    ahead = left**2 * (path.last_good - back) / fall if fall > 0 else np.inf
    if ahead <= FOLD * step:
        path.result.status = Status.LIMIT_POINT
        path.bracket = Bracket(ramp.parameter, lo, hi, path.result.index, failed.index)
        path.result.message = (
            f"no equilibrium beyond {ramp.parameter} = {lo:.6g} (none found at {hi:.6g}; "
            f"{ramp.end:.6g} was asked for): the smallest eigenvalue has fallen to {left:.2g}"
        )
        return
    reason = failed.message or f"{failed.index} negative eigenvalues"
    path.result.status = Status.STALLED
    path.result.message = (
        f"load stepping stopped at {ramp.parameter} = {lo:.6g} of {ramp.end:.6g}, with steps of "
        f"{hi - lo:.1e} ({reason})"
    )


def _stiffness(assembly: Assembly, state: NewtonResult) -> float:
    """Smallest eigenvalue of a state of the load taken last."""
    try:
        return stability_of(assembly, state.surface, state.multipliers).smallest
    except (SingularMatrix, np.linalg.LinAlgError):
        return 0.0
