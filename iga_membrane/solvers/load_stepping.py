"""Load stepping with halving: along a path that was asked for, or round a direct solve that
fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from ..assembly.lagrangian import Assembly
from ..linalg.bordered import Bordered
from ..linalg.inverse_root import SingularMatrix
from ..problems.scene import Ramp, Scene
from ..results.contact_patches import substrate_patches
from ..status import Status
from .foretold import Foretold
from .limit_point import BRACKET, PATIENCE, bounded, give_up, sufficient, verdict
from .load_path import Journal, LoadPath, LoadStep, Progress, Reached
from .newton import NewtonOptions, NewtonResult
from .predictor import first

FIRST = 0.25
"""The first step of the load."""
ATTEMPTS = 200
"""Loads tried at most, per value of the ramp: beyond, the path creeps."""


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
    return _Stepper(
        ramp, assembly, options, smallest, report, reached, journal or Journal()
    ).walked()


class _Stepper:
    """Load stepping on its way: the parameters of :func:`load_stepping`, where it stands, how long
    the next step is and what the smallest eigenvalue foretells."""

    def __init__(
        self,
        ramp: Ramp,
        assembly: Assembly,
        options: NewtonOptions,
        smallest: float,
        report: Callable[[float], None],
        reached: Reached,
        journal: Journal,
    ) -> None:
        self._ramp, self._assembly, self._smallest = ramp, assembly, smallest
        self._report, self._reached, self._journal = report, reached, journal
        self._options = options
        most = min(options.max_iterations, PATIENCE)
        self._attempts = replace(options, max_iterations=most)
        self._ahead = Foretold()
        self._aim: float | None = None
        self._path, self._step, self._found = self._begun()

    def walked(self) -> LoadPath:
        """The path to load 1, or to where it ends before."""
        path, ramp = self._path, self._ramp
        while path.result.status is None and path.last_good < 1.0:
            if ramp.short_of_bound(path.last_good) <= BRACKET:
                bounded(path, ramp, path.result.index)
                break
            load = self._next_load()
            scene, result = self._attempt(load)
            if result.status is None and result.index <= 0:
                self._keep(load, scene, result)
            elif result.status is Status.INTERRUPTED:
                path.result.status, path.result.message = result.status, result.message
            else:
                self._shorten(load, scene, result)
        return path

    def _begun(self) -> tuple[LoadPath, float, Sequence[Any]]:
        """The path at its start or where it was left, the next step, and the solutions so far."""
        if self._journal.start is not None:
            return _resumed(self._journal.start, self._ramp, self._assembly)
        ramp, assembly = self._ramp, self._assembly
        scene = ramp(0.0)
        assembly.load(scene)
        result = first(scene, assembly, replace(self._options, phase="load 0"))
        wet = _wet_set(assembly, scene, result)
        begun = LoadStep(0.0, len(result.iterations), result.status, ramp.value(0.0), wet)
        path = LoadPath(result, scene, [begun])
        found: Sequence[Any] = ()
        if result.status is None:
            path.result, found = self._reached(scene, result)
        if path.result.status is None:
            _note(self._journal, path, FIRST, assembly, found)
        return path, FIRST, found

    @property
    def _stop(self) -> float:
        """The first load after the last good one at which the ramp has a value."""
        stops = self._ramp.stops
        return float(stops[np.searchsorted(stops, self._path.last_good, "right")])

    def _next_load(self) -> float:
        """The load to be tried: the next step's or the one that is foretold, but not one that the
        ramp's bound rules out; then half the way to it."""
        good = self._path.last_good
        load = min(self._stop, good + self._step if self._aim is None else self._aim)
        if self._ramp.short_of_bound(load) > 0.0:
            return load
        return good + 0.5 * (self._ramp.load_at_bound(good) - good)

    def _attempt(self, load: float) -> tuple[Scene, NewtonResult]:
        """A load from the last good state."""
        scene, path = self._ramp(load), self._path
        phase = replace(self._attempts, phase=f"load {load:.3g}")
        result = path.attempt(self._assembly, scene, phase)
        wet, value = _wet_set(self._assembly, scene, result), self._ramp.value(load)
        path.steps.append(LoadStep(load, len(result.iterations), result.status, value, wet))
        if result.status is None:
            _judge(self._assembly, result)
        return scene, result

    def _keep(self, load: float, scene: Scene, result: NewtonResult) -> None:
        """Go on from a stable equilibrium, by a longer step."""
        path, stop = self._path, self._stop
        path.result, path.scene, path.last_good = result, scene, load
        self._report(load)
        if load == stop:
            path.result, self._found = self._reached(scene, result)
            if path.result.status is not None:
                return
        self._step *= 1.5 if len(result.iterations) > 5 else 2.0
        _note(self._journal, path, self._step, self._assembly, self._found)
        self._ahead.reached(load)
        self._aim = _aim(self._ahead, self._assembly, path, self._ramp)

    def _shorten(self, load: float, scene: Scene, result: NewtonResult) -> None:
        """After a failure: a shorter step, or the end of the path."""
        path, ahead = self._path, self._ahead
        width = load - path.last_good
        narrow = sufficient(self._ramp, path.last_good, load)
        if self._ramp.value(path.last_good) == 0.0:
            # no bracket is narrow over its value next to 0
            narrow = max(narrow, self._smallest)
        self._step = 0.5 * min(self._step, width)
        lost = width <= narrow and (self._step < self._smallest or result.status is None)
        if lost or len(path.steps) > ATTEMPTS * len(self._ramp.stops):
            give_up(self._assembly, path, self._ramp, load, result, self._attempts)
            return
        if ahead.lost is None or load < ahead.lost:
            ahead.lost = load
            if result.status is None and (found := verdict(scene, self._assembly, result)):
                ahead.beyond = load, found.smallest
        self._assembly.load(path.scene)
        self._aim = _aim(ahead, self._assembly, path, self._ramp)


def _judge(assembly: Assembly, result: NewtonResult) -> None:
    """Count the negative eigenvalues at a converged state: those of the last iteration are of the
    state before its step, which near a limit is another side."""
    motion = assembly.motion(result.surface)
    system = assembly.system(result.surface, motion.directions, result.multipliers)
    with suppress(SingularMatrix):
        result.index = Bordered(system.matrix, system.constraint_gradients).index


def _aim(ahead: Foretold, assembly: Assembly, path: LoadPath, ramp: Ramp) -> float | None:
    """The next load by what is foretold once an attempt has failed; the assembly has taken that of
    the last good state."""
    if ahead.lost is None:
        return None
    if not ahead.good or ahead.good[-1][0] < path.last_good:
        found = verdict(path.scene, assembly, path.result)
        if found is None:
            return None
        ahead.good.append((path.last_good, found.smallest))
    return ahead.next(sufficient(ramp, path.last_good, ahead.lost))


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
