"""Where a path ends: at a limit point, at a known bound, or with a solver at a loss."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..assembly.lagrangian import Assembly
from ..linalg.inverse_root import SingularMatrix
from ..problems.scene import Ramp, Scene
from ..status import Status
from .load_path import Bracket, LoadPath
from .newton import NewtonOptions, NewtonResult, newton
from .stability import Stability, stability_of

BRACKET = 4e-4
"""Width of a bracket over the parameter's value."""
BOUNDED = 0.02
"""Distance from a ramp's known bound, over it, within which a failure is that bound's."""
PATIENCE = 20
"""Newton iterations of one attempt: a load that needs more is approached by shorter steps."""
FOLD = 3.0
"""Steps of load within which a limit point must be foretold by the smallest eigenvalue."""


def sufficient(ramp: Ramp, one: float, two: float) -> float:
    """Width of a sufficient bracket between two loads."""
    lo, hi = ramp.value(one), ramp.value(two)
    return BRACKET * max(abs(lo), abs(hi)) / abs(hi - lo) * (two - one)


def give_up(
    assembly: Assembly,
    path: LoadPath,
    ramp: Ramp,
    load: float,
    failed: NewtonResult,
    options: NewtonOptions,
) -> None:
    """Name the end of a path: a limit point, or a solver at a loss."""
    lo, hi = ramp.value(path.last_good), ramp.value(load)
    if ramp.short_of_bound(path.last_good) <= BOUNDED and ramp.short_of_bound(1.0) <= 0.0:
        bounded(path, ramp, failed.index)
        return
    narrow = load - path.last_good <= sufficient(ramp, path.last_good, load)
    if failed.status is None and narrow:
        path.result.status = Status.LIMIT_POINT
        path.bracket = Bracket(ramp.parameter, lo, hi, path.result.index, failed.index)
        path.result.message = (
            f"no stable equilibrium beyond {ramp.parameter} = {lo:.6g} ({ramp.values[-1]:.6g} was "
            f"asked for): the one at {hi:.6g} has {failed.index} negative eigenvalue(s)"
        )
        return
    _end_at_fold(assembly, path, ramp, load, failed, options)
    if path.result.status is not None:
        return
    # the user's own limit of iterations, not the steps, may be what is too small
    limited = failed.status is Status.MAX_ITER and options.max_iterations < PATIENCE
    path.result.status = Status.MAX_ITER if limited else Status.STALLED
    path.result.message = (
        f"load stepping stopped at {ramp.parameter} = {lo:.6g} of {ramp.values[-1]:.6g}, with "
        f"steps of {hi - lo:.1e} ({failed.message or 'unstable'})"
    )


def _end_at_fold(
    assembly: Assembly,
    path: LoadPath,
    ramp: Ramp,
    load: float,
    failed: NewtonResult,
    options: NewtonOptions,
) -> None:
    """End a path at a fold, if there is one.

    At a fold the square of the smallest eigenvalue falls linearly to zero. Its extrapolation from
    a step before the last good load must end about where the attempts fail.
    """
    step = load - path.last_good
    back = max(0.0, path.last_good - step)
    earlier = path.attempt(assembly, ramp(back), options)
    if earlier.status is Status.INTERRUPTED:
        path.result.status, path.result.message = earlier.status, earlier.message
        return
    softer = verdict(path.scene, assembly, earlier) if earlier.status is None else None
    assembly.load(path.scene)
    last = verdict(path.scene, assembly, path.result)
    left, before = (found.smallest**2 if found else 0.0 for found in (last, softer))
    if before <= left or left * (path.last_good - back) > FOLD * step * (before - left):
        return
    lo, hi = ramp.value(path.last_good), ramp.value(load)
    path.result.status = Status.LIMIT_POINT
    beyond = _beyond_fold(assembly, path.result, last, options) if last else None
    index = failed.index if beyond is None else beyond
    path.bracket = Bracket(ramp.parameter, lo, hi, path.result.index, index)
    path.result.message = (
        f"no equilibrium beyond {ramp.parameter} = {lo:.6g} (none found at {hi:.6g}; "
        f"{ramp.values[-1]:.6g} was asked for): the smallest eigenvalue has fallen to "
        f"{last.smallest if last else 0.0:.2g}"
    )


def bounded(path: LoadPath, ramp: Ramp, index: int) -> None:
    """End a path at the ramp's known bound."""
    lo, bound = ramp.value(path.last_good), ramp.bound
    assert bound is not None
    path.result.status = Status.LIMIT_POINT
    path.bracket = Bracket(ramp.parameter, lo, bound, path.result.index, index)
    path.result.message = (
        f"no equilibrium from {ramp.parameter} = {bound:.6g} on, by the balance of forces "
        f"({ramp.values[-1]:.6g} was asked for); found up to {lo:.6g}"
    )


def verdict(scene: Scene, assembly: Assembly, state: NewtonResult) -> Stability | None:
    """Stability of a state of the load taken last."""
    try:
        return stability_of(scene, assembly, state.surface, state.multipliers, "model")
    except (SingularMatrix, np.linalg.LinAlgError):
        return None


def _beyond_fold(
    assembly: Assembly, state: NewtonResult, verdict: Stability, options: NewtonOptions
) -> int | None:
    """Index of the equilibrium of the same load on the other side of the fold, or None.

    Near a fold the two differ by a multiple of the softest motion, so Newton's method without
    descent is started that way at growing distances.
    """
    plain = replace(options, near=np.inf)
    along = verdict.mode
    along = along / np.linalg.norm(along, axis=1).max()
    for distance in np.geomspace(0.01, 0.3, 6):
        for sign in (1.0, -1.0):
            start = state.surface.moved(state.surface.points + sign * distance * along)
            other = newton(assembly, start, state.multipliers, None, plain)
            if other.status is None and other.index == state.index + 1:
                return other.index
    return None
