"""Load stepping with halving: along a path that was asked for, or round a direct solve that
fails."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..errors import GeometryError
from ..linalg.inverse_root import SingularMatrix
from ..problems.scene import Ramp, Scene
from ..results.contact_patches import substrate_patches
from ..status import Status
from ..surface.reparametrize import regridded
from .foretold import Foretold
from .newton import NewtonOptions, NewtonResult, newton
from .predictor import first
from .stability import Stability, stability_of


@dataclass(frozen=True)
class LoadStep:
    """One attempted load: the parameter's value there, the Newton iterations and how they ended
    (None: converged); on a path that was asked for, the measures at its values, and where contact
    lines lie inside the membrane the wet set of every step and its energy."""

    load: float
    iterations: int
    status: Status | None
    value: float | None = None
    measures: Mapping[str, float] | None = None


@dataclass(frozen=True)
class Bracket:
    """Values of a parameter between which the equilibrium is lost.

    Attributes
    ----------
    parameter : its path in the scene file; lo : the last value with a stable equilibrium, hi : the
        first without.
    index_lo, index_hi : negative eigenvalues of the stable equilibrium at ``lo`` and of the one
        that meets it at the limit, beyond the fold of the path; where no such state was found,
        of the last iterate at ``hi``.
    """

    parameter: str
    lo: float
    hi: float
    index_lo: int
    index_hi: int


@dataclass(frozen=True, eq=False)
class Progress:
    """Where load stepping stands after a converged step: enough to go on as if never interrupted.

    Attributes
    ----------
    digest : of the ramp and the options that it belongs to.
    load : the last good one; step : the next one's length.
    result : the state there; memory : of its contact, if there is any.
    steps : every attempt so far.
    found : solutions at the ramp's values so far.
    """

    digest: str
    load: float
    step: float
    result: NewtonResult
    memory: Array | None
    steps: Sequence[LoadStep]
    found: Sequence[Any] = ()


@dataclass(frozen=True)
class Journal:
    """Reads and writes the progress of load stepping.

    Attributes
    ----------
    digest : of the ramp and the options.
    write : called with the progress after every converged step.
    start : where to go on, or None.
    """

    digest: str = ""
    write: Callable[[Progress], None] = lambda progress: None
    start: Progress | None = None


Reached = Callable[[Scene, NewtonResult], tuple[NewtonResult, Sequence[Any]]]


@dataclass(eq=False)
class LoadPath:
    """End of load stepping.

    Attributes
    ----------
    result : at the last good load, with the status of the last attempt.
    scene : the scene at that load.
    steps : every attempt.
    bracket : of the limit point, if that is why it ended.
    progress : from which it can go on.
    """

    result: NewtonResult
    scene: Scene
    steps: list[LoadStep] = field(default_factory=list)
    last_good: float = 0.0
    bracket: Bracket | None = None
    progress: Progress | None = None


def load_stepping(
    ramp: Ramp,
    assembly: Assembly,
    options: NewtonOptions,
    smallest: float,
    report: Callable[[float], None] = lambda load: None,
    reached: Reached = lambda scene, result: (result, ()),
    journal: Journal | None = None,
) -> LoadPath:
    """From the ramp's own start at load 0 to load 1, in steps that grow and halve.

    Parameters
    ----------
    ramp : its scenes share the assembly's space and the edges that move.
    smallest : step of the load below which to give up: LIMIT_POINT if the smallest eigenvalue
        foretells a fold there, else STALLED.
    report : called with every load reached.
    reached : called with the scene and the state at each of the ramp's values; it returns the
        state to go on from, with a status where the path is to end there, and the solutions so far,
        which are kept with the progress.
    journal : of converged steps, to go on after an interruption.
    """
    journal = journal or Journal()
    stops = ramp.stops
    if journal.start is not None:
        path, step, found = _resumed(journal.start, ramp, assembly)
    else:
        scene = ramp(0.0)
        assembly.load(scene)
        result = first(scene, assembly, replace(options, phase="load 0"))
        wet = _wet_set(assembly, scene, result)
        begun = LoadStep(0.0, len(result.iterations), result.status, ramp.value(0.0), wet)
        path, step = LoadPath(result, scene, [begun]), 0.25
        if result.status is not None:
            return path
        path.result, found = reached(scene, result)
        if path.result.status is not None:
            return path
        _note(journal, path, step, assembly, found)
    attempts = replace(options, max_iterations=min(options.max_iterations, PATIENCE))
    ahead, aim = Foretold(), None
    while path.last_good < 1.0:
        stop = float(stops[np.searchsorted(stops, path.last_good, "right")])
        if ramp.short_of_bound(path.last_good) <= BRACKET:
            _bounded(path, ramp, path.result.index)
            break
        load = min(stop, path.last_good + step if aim is None else aim)
        if ramp.short_of_bound(load) <= 0.0:
            # what the bound rules out is not tried: half the way to it
            load = path.last_good + 0.5 * (ramp.load_at_bound(path.last_good) - path.last_good)
        scene = ramp(load)
        phase = replace(attempts, phase=f"load {load:.3g}")
        result = _attempt(assembly, path, scene, phase)
        wet = _wet_set(assembly, scene, result)
        tried = LoadStep(load, len(result.iterations), result.status, ramp.value(load), wet)
        path.steps.append(tried)
        if result.status is None and result.index <= 0:
            path.result, path.scene, path.last_good = result, scene, load
            report(load)
            if load == stop:
                path.result, found = reached(scene, result)
                if path.result.status is not None:
                    break
            step *= 1.5 if len(result.iterations) > 5 else 2.0
            _note(journal, path, step, assembly, found)
            ahead.reached(load)
            aim = _aim(ahead, assembly, path, ramp)
        elif result.status is Status.INTERRUPTED:
            path.result.status, path.result.message = result.status, result.message
            break
        else:
            sufficient = _sufficient(ramp, path.last_good, load)
            if ramp.value(path.last_good) == 0.0:
                # no bracket is narrow over its value next to 0
                sufficient = max(sufficient, smallest)
            narrow = load - path.last_good <= sufficient
            step = 0.5 * min(step, load - path.last_good)
            lost = narrow and (step < smallest or result.status is None)
            if lost or len(path.steps) > ATTEMPTS * len(stops):
                _give_up(assembly, path, ramp, load, result, attempts)
                break
            if ahead.lost is None or load < ahead.lost:
                ahead.lost = load
                if result.status is None and (verdict := _verdict(scene, assembly, result)):
                    ahead.beyond = load, verdict.smallest
            assembly.load(path.scene)
            aim = _aim(ahead, assembly, path, ramp)
    return path


def _sufficient(ramp: Ramp, one: float, two: float) -> float:
    """Width of a sufficient bracket between two loads."""
    lo, hi = ramp.value(one), ramp.value(two)
    return BRACKET * max(abs(lo), abs(hi)) / abs(hi - lo) * (two - one)


def _aim(ahead: Foretold, assembly: Assembly, path: LoadPath, ramp: Ramp) -> float | None:
    """The next load by what is foretold once an attempt has failed; the assembly has taken that of
    the last good state."""
    if ahead.lost is None:
        return None
    if not ahead.good or ahead.good[-1][0] < path.last_good:
        verdict = _verdict(path.scene, assembly, path.result)
        if verdict is None:
            return None
        ahead.good.append((path.last_good, verdict.smallest))
    return ahead.next(_sufficient(ramp, path.last_good, ahead.lost))


def _note(
    journal: Journal, path: LoadPath, step: float, assembly: Assembly, found: Sequence[Any]
) -> None:
    """Write down a converged step."""
    memory = assembly.contact.memory
    result = replace(path.result, iterations=list(path.result.iterations))
    path.progress = Progress(
        journal.digest, path.last_good, step, result, memory, tuple(path.steps), tuple(found)
    )
    journal.write(path.progress)


def _resumed(
    start: Progress, ramp: Ramp, assembly: Assembly
) -> tuple[LoadPath, float, Sequence[Any]]:
    """The path as it was when its progress was written, and the next step."""
    scene = ramp(start.load)
    assembly.load(scene)
    if start.memory is not None:
        assembly.contact.recall(start.memory)
    result = replace(start.result, iterations=list(start.result.iterations))
    path = LoadPath(result, scene, list(start.steps), start.load, progress=start)
    return path, start.step, start.found


def _wet_set(assembly: Assembly, scene: Scene, state: NewtonResult) -> dict[str, float] | None:
    """How many asperities have a contact line and the energy with them: several equilibria exist,
    and which one is met is a matter of the path."""
    if not assembly.contact.passes or state.status is not None:
        return None
    body = assembly.density(state.multipliers)
    feet = substrate_patches(scene, assembly, state.surface, body)
    energy = float(assembly.copies * assembly.energy(state.surface) * scene.units.energy)
    return {"wet_solids": float(len(feet.which)), "energy": energy}


BRACKET = 4e-4
"""Width of a bracket over the parameter's value."""
BOUNDED = 0.02
"""Distance from a ramp's known bound, over it, within which a failure is that bound's."""
ATTEMPTS = 200
"""Loads tried at most, per value of the ramp: beyond, the path creeps."""
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
        moved = good.surface.moved(good.surface.points + shift)
        grading = scene.meridian_grading
        start = moved if grading is None else regridded(moved, grading)
    except (GeometryError, np.linalg.LinAlgError) as error:
        return NewtonResult(good.surface, good.multipliers, Status.NONFINITE, str(error))
    return newton(assembly, start, good.multipliers, scene.meridian_grading, options)


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
    if ramp.short_of_bound(path.last_good) <= BOUNDED and ramp.short_of_bound(1.0) <= 0.0:
        _bounded(path, ramp, failed.index)
        return
    narrow = load - path.last_good <= _sufficient(ramp, path.last_good, load)
    if failed.status is None and narrow:
        path.result.status = Status.LIMIT_POINT
        path.bracket = Bracket(ramp.parameter, lo, hi, path.result.index, failed.index)
        path.result.message = (
            f"no stable equilibrium beyond {ramp.parameter} = {lo:.6g} ({ramp.values[-1]:.6g} was "
            f"asked for): the one at {hi:.6g} has {failed.index} negative eigenvalue(s)"
        )
        return
    step = load - path.last_good
    back = max(0.0, path.last_good - step)
    earlier = _attempt(assembly, path, ramp(back), options)
    if earlier.status is Status.INTERRUPTED:
        path.result.status, path.result.message = earlier.status, earlier.message
        return
    softer = _verdict(path.scene, assembly, earlier) if earlier.status is None else None
    assembly.load(path.scene)
    verdict = _verdict(path.scene, assembly, path.result)
    left = verdict.smallest if verdict else 0.0
    fall = (softer.smallest if softer else 0.0) ** 2 - left**2
    ahead = left**2 * (path.last_good - back) / fall if fall > 0 else np.inf
    if ahead <= FOLD * step:
        path.result.status = Status.LIMIT_POINT
        beyond = _beyond_fold(assembly, path.result, verdict, options) if verdict else None
        index = failed.index if beyond is None else beyond
        path.bracket = Bracket(ramp.parameter, lo, hi, path.result.index, index)
        path.result.message = (
            f"no equilibrium beyond {ramp.parameter} = {lo:.6g} (none found at {hi:.6g}; "
            f"{ramp.values[-1]:.6g} was asked for): the smallest eigenvalue has fallen to "
            f"{left:.2g}"
        )
        return
    # the user's own limit of iterations, not the steps, may be what is too small
    limited = failed.status is Status.MAX_ITER and options.max_iterations < PATIENCE
    path.result.status = Status.MAX_ITER if limited else Status.STALLED
    path.result.message = (
        f"load stepping stopped at {ramp.parameter} = {lo:.6g} of {ramp.values[-1]:.6g}, with "
        f"steps of {hi - lo:.1e} ({failed.message or 'unstable'})"
    )


def _bounded(path: LoadPath, ramp: Ramp, index: int) -> None:
    """End a path at the ramp's known bound."""
    lo, bound = ramp.value(path.last_good), ramp.bound
    assert bound is not None
    path.result.status = Status.LIMIT_POINT
    path.bracket = Bracket(ramp.parameter, lo, bound, path.result.index, index)
    path.result.message = (
        f"no equilibrium from {ramp.parameter} = {bound:.6g} on, by the balance of forces "
        f"({ramp.values[-1]:.6g} was asked for); found up to {lo:.6g}"
    )


def _verdict(scene: Scene, assembly: Assembly, state: NewtonResult) -> Stability | None:
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
