"""Ways to iterate a scene to an equilibrium, tried in order until one of them is enough."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..assembly.lagrangian import Assembly
from ..problems.scene import Scene
from ..solvers.free_edge import tangent_edge
from ..solvers.load_path import LoadPath, LoadStep
from ..solvers.load_stepping import load_stepping
from ..solvers.newton import NewtonOptions, newton
from ..solvers.options import SolverOptions
from ..solvers.predictor import first
from ..solvers.quasi_static import quasi_static
from ..status import Status
from .evaluate import Outcome
from .state import journal_of

log = logging.getLogger("iga_membrane")


@dataclass(frozen=True, eq=False)
class Run:
    """What is to be iterated, and how.

    Attributes
    ----------
    report : called with every load reached.
    """

    scene: Scene
    assembly: Assembly
    settings: NewtonOptions
    options: SolverOptions
    report: Callable[[float], None]

    def stepped(self) -> LoadPath:
        """Load stepping along the scene's ramp, from where its journal says."""
        ramp, options = self.scene.ramp, self.options
        assert ramp is not None
        journal = journal_of(ramp, options)
        smallest = options.min_load_step
        return load_stepping(
            ramp, self.assembly, self.settings, smallest, self.report, journal=journal
        )


Attempt = Callable[[Run, Outcome | None], tuple[Outcome, bool]]
"""A run and what the attempt before reached, to what is reached and whether that is enough."""


@dataclass(frozen=True)
class FirstSuccess:
    """Attempts in order, each of which knows what the one before it reached.

    Attributes
    ----------
    attempts : at least one.
    """

    attempts: Sequence[Attempt]

    def __call__(self, run: Run) -> Outcome:
        reached: Outcome | None = None
        for attempt in self.attempts:
            reached, enough = attempt(run, reached)
            if enough:
                break
        assert reached is not None
        return reached


def strategy_of(scene: Scene) -> FirstSuccess:
    """The attempts of a scene: direct Newton, load stepping where it failed or ended on a saddle,
    at last the nearest equilibrium of any kind, to tell an unstable state from none."""
    if scene.motion == "cartesian":
        return FirstSuccess([_in_load_steps])
    if scene.free_edge is not None:
        return FirstSuccess([_to_tangent_edges])
    if scene.ramp is None:
        return FirstSuccess([_directly, _nearest])
    return FirstSuccess([_along] if scene.ramp.only else [_directly, _around, _nearest])


def _in_load_steps(run: Run, before: Outcome | None) -> tuple[Outcome, bool]:
    found = quasi_static(run.scene, run.assembly, run.settings, run.report)
    return Outcome(*found), True


def _to_tangent_edges(run: Run, before: Outcome | None) -> tuple[Outcome, bool]:
    scene, state = tangent_edge(run.scene, run.assembly, run.settings)
    return Outcome(scene, state, [LoadStep(1.0, len(state.iterations), state.status)]), True


def _along(run: Run, before: Outcome | None) -> tuple[Outcome, bool]:
    return Outcome.of(run.stepped()), True


def _directly(run: Run, before: Outcome | None) -> tuple[Outcome, bool]:
    state = first(run.scene, run.assembly, run.settings)
    stable = state.status is None and state.index <= 0
    steps = [LoadStep(1.0, len(state.iterations), state.status)]
    return Outcome(run.scene, state, steps), stable or state.status is Status.INTERRUPTED


def _around(run: Run, before: Outcome | None) -> tuple[Outcome, bool]:
    """Load stepping round a direct solve that failed."""
    assert before is not None
    direct = before.result
    log.info("direct solve failed (%s): load stepping", direct.message or "unstable")
    path = run.stepped()
    path.result.linear_seconds += direct.linear_seconds
    steps = before.steps + path.steps
    if path.result.status is None:
        return Outcome(path.scene, path.result, steps), True
    partial = path.last_good > 0 and (direct.status is not None or path.bracket is not None)
    if partial:
        return replace(Outcome.of(path), steps=steps), False
    return replace(before, steps=steps, progress=path.progress), False


def _nearest(run: Run, before: Outcome | None) -> tuple[Outcome, bool]:
    """Newton without descent, from a start of the scene's own, where all else failed."""
    assert before is not None
    scene, assembly = run.scene, run.assembly
    own_start = not assembly.contact.lies and scene.predictor is None
    if before.steps[0].status is None or before.bracket is not None or not own_start:
        return before, True
    assembly.load(scene)
    plain = replace(run.settings, near=np.inf)
    state = newton(assembly, scene.local_surface(), None, scene.meridian_grading, plain)
    steps = [*before.steps, LoadStep(1.0, len(state.iterations), state.status)]
    if state.status is None:
        return Outcome(scene, state, steps), True
    if state.status is Status.INTERRUPTED:
        before.result.status, before.result.message = state.status, state.message
    return replace(before, steps=steps), True
