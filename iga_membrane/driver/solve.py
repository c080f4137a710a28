"""The verb: scene in, solution out, with a true status."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from time import thread_time
from typing import Literal

from ..arguments import checked
from ..assembly.lagrangian import Assembly
from ..errors import SceneError, SolveError
from ..own import begin
from ..problems.recipe import Recipe
from ..problems.scene import Scene
from ..problems.well_posed import check_held
from ..solvers.options import SolverOptions
from ..solvers.predictor import settings_of
from ..status import Status
from ..terms.own import check_own_terms
from ..threads import one_thread
from .attempts import Run, strategy_of
from .evaluate import Outcome, conclude
from .free_particles import settled
from .saddle import check_followed, followed
from .solution import Solution, blamed, with_effort
from .state import fits, journal_of, start_surface
from .trace import walk

log = logging.getLogger("iga_membrane")


@checked()
@one_thread
def solve(
    scene: Scene,
    options: SolverOptions | None = None,
    *,
    on_fail: Literal["raise", "return"] = "raise",
    report: Callable[[float], None] = lambda load: None,
) -> Solution:
    """Find the equilibrium of a scene.

    Direct Newton from the scene's start; if that fails or ends unstable, load stepping along the
    scene's ramp; a ramp that was asked for is walked from its own start. The state is then
    measured, its stability decided and audited on an independent path.

    Parameters
    ----------
    scene : what is asked.
    options : tolerances and limits.
    on_fail : "raise" a :class:`SolveError` that carries the solution, or "return" it.
    report : called with every load reached, for progress.

    Raises
    ------
    SceneError
        Before any work, if the scene is ill-posed or too large for the memory allowed.
    StateError
        If ``options.start`` cannot be trusted.
    SolveError
        If the status is not ``CONVERGED_STABLE`` and ``on_fail`` is "raise".
    """
    options = SolverOptions() if options is None else options
    begin()
    check_own_terms(scene.local_terms(), scene.local_surface(), scene.units)
    options.check_folder()
    if options.follow_instability:
        check_followed(scene)
    check_held(scene)
    solution = _solved(scene, options, report, thread_time())
    log.debug("%s: %s", solution.status.name, solution.message)
    solution = blamed(solution)
    if not solution.success and on_fail == "raise":
        raise SolveError(f"{solution.status.name}: {solution.message}", solution)
    return solution


def _solved(
    scene: Scene, options: SolverOptions, report: Callable[[float], None], started: float
) -> Solution:
    """The equilibrium of a scene, by what the scene needs: its particles moved, another
    discretization or a finer mesh behind it, a path that was asked for, or one state."""
    if scene.free_particles is not None:
        return _with_free_particles(scene, options, started)
    if scene.ramp is not None and scene.ramp.asked:
        _check_memory(scene, options)
        return replace(walk(scene.ramp, options, report)[-1], scene=scene)
    if scene.otherwise is not None:
        one = replace(scene, otherwise=None)
        return _either(one, scene.otherwise, FAILED, options, report)
    if scene.finer is not None:
        one = replace(scene, finer=None)
        return _either(one, scene.finer, COARSE, options, report)
    _check_memory(scene, options)
    return _one_state(scene, options, report, started)


def _one_state(
    scene: Scene, options: SolverOptions, report: Callable[[float], None], started: float
) -> Solution:
    """The equilibrium of a scene with one discretization and fixed particles."""
    halfway = options.start is not None and _halfway(scene, options)
    if options.start is not None and not halfway:
        scene = replace(scene, surface=start_surface(options.start, scene), predictor=None)
    try:
        assembly = Assembly(scene, options.quadrature)
    except MemoryError as error:
        raise SceneError(
            "discretization.elements: the mesh does not fit into memory; choose fewer elements"
        ) from error
    run = Run(scene, assembly, settings_of(scene, options, started), options, report)
    outcome = Outcome.of(run.stepped()) if halfway else strategy_of(scene)(run)
    assembly.load(outcome.scene)
    solution = conclude(outcome, assembly, options, started)
    if solution.status is Status.UNDERRESOLVED and len(outcome.steps) == 1 and scene.ramp:
        # a mesh may fake an equilibrium where there is none; the way to the scene tells
        path = run.stepped()
        if path.bracket is not None:
            assembly.load(path.scene)
            steps = [*outcome.steps, *path.steps]
            outcome = Outcome(path.scene, path.result, steps, path.bracket)
            solution = conclude(outcome, assembly, options, started)
    if options.follow_instability and solution.status is Status.CONVERGED_SADDLE:
        solution = followed(solution, outcome, assembly, run.settings, options, started)
    return replace(solution, scene=scene)


DECIDED = frozenset(
    status
    for status in Status
    if status.name.startswith("CONVERGED")
    or status in (Status.NO_EQUILIBRIUM, Status.LIMIT_POINT, Status.TOPOLOGY_CHANGE)
)
"""Ends of a solve that say something about the liquid, not about the discretization."""
COARSE = frozenset({Status.UNDERRESOLVED})
"""Ends after which a finer mesh is tried."""
FAILED = frozenset(Status) - {Status.CONVERGED_STABLE, Status.INTERRUPTED, Status.UNVERIFIED}


def _either(
    first: Scene,
    other: Recipe,
    ends: frozenset[Status],
    options: SolverOptions,
    report: Callable[[float], None],
) -> Solution:
    """A scene in the first of two discretizations that solves it, within one limit; if neither
    does, the end that says more, with both messages and the bracket of either.

    Parameters
    ----------
    ends : of the first one after which the other is tried.
    """
    if options.start is not None and not fits(options.start, first):
        return solve(other.scene(), options, on_fail="return", report=report)
    started = thread_time()
    one = solve(first, options, on_fail="return", report=report)
    if one.status not in ends or one.mode_beyond_model:
        return one
    log.info("%s: %s; in another discretization", one.status.name, one.message)
    left = max(started + options.max_cpu_s - thread_time(), 1e-3)
    own = replace(options, max_cpu_s=left, start=None)
    try:
        two = solve(other.scene(), own, on_fail="return", report=report)
    except SceneError as error:
        return replace(one, message=f"{one.message}; in another discretization: {error}")
    told = two if two.status in DECIDED or one.status not in DECIDED else one
    found = with_effort(told, [one, two])
    if told.success:
        return found
    missed = one if told is two else two
    message = f"{told.message}; in another discretization {missed.status.name}: {missed.message}"
    return replace(found, message=message, bracket=told.bracket or missed.bracket)


def _with_free_particles(scene: Scene, options: SolverOptions, started: float) -> Solution:
    """The equilibrium of a scene whose particles move; every solve within one limit."""

    def solve_fixed(at: Scene) -> Solution:
        left = max(started + options.max_cpu_s - thread_time(), 1e-3)
        return solve(at, replace(options, max_cpu_s=left, start=None), on_fail="return")

    if options.start is not None:
        raise SceneError("solver.start: not available yet with particles that move; leave it out")
    return settled(scene, solve_fixed)


def _halfway(scene: Scene, options: SolverOptions) -> bool:
    """Whether the start is this scene's own load stepping, interrupted."""
    return scene.ramp is not None and journal_of(scene.ramp, options).start is not None


WORTH_SAYING = 1e8
"""Bytes of memory from which a solve says what it needs."""


def _check_memory(scene: Scene, options: SolverOptions) -> None:
    """Tables, blocks and factors, from counts; refuse before allocating any."""
    space = scene.surface.space
    elements = space.elements / scene.sector.copies
    local = space.functions.shape[1]
    points = options.quadrature**2 if options.quadrature else local
    need = 8.0 * elements * (14.0 * points * local + 6.0 * local**2)
    need += 4e3 * space.count / scene.sector.copies
    level = logging.INFO if need > WORTH_SAYING else logging.DEBUG
    log.log(level, "%d elements need about %.2g GB of memory", elements, need / 1e9)
    if need > options.max_memory_gb * 1e9:
        raise SceneError(
            f"solver.max_memory_gb = {options.max_memory_gb:g}: this mesh needs about "
            f"{need / 1e9:.1f} GB; raise the limit or choose fewer elements"
        )
