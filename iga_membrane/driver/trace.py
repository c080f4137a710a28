"""Continuation: equilibria along a path of scenes, each started from the one before."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from time import thread_time
from typing import Any, Literal

from ..arguments import checked
from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..errors import SceneError, SolveError, StateError
from ..fields import path_values
from ..overview import Overview, Told
from ..own import begin, called
from ..problems.scene import Ramp, Scene
from ..quantities import told_value
from ..solvers.load_path import Bracket, LoadStep
from ..solvers.load_stepping import load_stepping
from ..solvers.newton import NewtonResult
from ..solvers.options import SolverOptions
from ..solvers.predictor import first, settings_of
from ..status import Status
from ..tables import column, dataframe, dataset
from ..terms.own import check_own_terms
from ..threads import one_thread
from .evaluate import Outcome, conclude
from .solution import Solution, blamed
from .state import journal_of

SAME = 1e-3
"""Difference of energies, relative, up to which a state on a distorted mesh and one on the scene's
own mesh are the same equilibrium."""


@dataclass(frozen=True, eq=False, repr=False)
@checked()
class Path(Told):
    """Equilibria along a parameter.

    Attributes
    ----------
    parameter : its name; values : those reached, of the ones asked for.
    solutions : one at each of them.
    end : how the path ended: the last solution, or where it stopped short, the last good state
        with the status that says why.
    """

    parameter: str
    values: Sequence[float]
    solutions: Sequence[Solution]
    end: Solution

    def overview(self) -> Overview:
        """How it ended, and its measures from the first value to the last."""
        system = self.end.scene.unit_system
        reached = f"{len(self.values)} values of {self.parameter}"
        rows = [("ended", f"{self.end.status.name}: {self.end.message}")]
        if self.solutions:
            first, last = self.solutions[0].measures, self.solutions[-1].measures
            ends = told_value(self.parameter, self.values[-1], system)
            rows.insert(0, (self.parameter, f"{self.values[0]:.6g} to {ends}"))
            rows += [
                (name, f"{_plain(first[name])} to {told_value(name, value, system)}")
                for name, value in last.items()
                if name in first
            ]
        return Overview(f"path, {system}: {reached}", rows)

    def portrait(self) -> bytes | None:
        """A small picture of its end (PNG), where this machine can draw."""
        return self.end.portrait()

    @property
    def units(self) -> str:
        """Of its numbers: "SI" or "dimensionless"."""
        return self.end.scene.unit_system

    @property
    def success(self) -> bool:
        """Whether every value was reached and every solution is a success."""
        return self.end.success and all(s.success for s in self.solutions)

    @property
    def bracket(self) -> Bracket | None:
        """Of the limit point at which the path ended, if it did."""
        return self.end.bracket

    def column(self, name: str) -> Array:
        """(values,) the parameter, a measure or a force; not a number where there is none."""
        return column(self._rows(), name)

    def to_dataframe(self) -> Any:
        """``pandas.DataFrame`` with a row for each value that was reached.

        Raises
        ------
        OutputError
            If pandas is not installed.
        """
        return dataframe(self._rows())

    def to_xarray(self) -> Any:
        """``xarray.Dataset`` along the parameter.

        Raises
        ------
        OutputError
            If xarray is not installed.
        """
        return dataset(self._rows(), [self.parameter])

    def _rows(self) -> list[dict[str, Any]]:
        pairs = zip(self.values, self.solutions, strict=True)
        return [{self.parameter: value, **solution.row()} for value, solution in pairs]


def _plain(value: float | None) -> str:
    return "n/a" if value is None else f"{value:.6g}"


@checked(values=path_values)
@one_thread
def trace(
    scene_at: Callable[[float], Scene],
    values: Sequence[float],
    *,
    parameter: str = "parameter",
    options: SolverOptions | None = None,
    on_fail: Literal["raise", "return"] = "raise",
    report: Callable[[float], None] = lambda load: None,
) -> Path:
    """Follow an equilibrium along a parameter by load stepping; limit points are bracketed.

    Parameters
    ----------
    scene_at : value of the parameter to a scene; all have the same space and supports.
    values : two or more; the first is solved from its own start.
    parameter : its name in messages and brackets.
    on_fail : "raise" a :class:`SolveError` with the last good state if the path stops short, or
        "return" the path as far as it came.
    report : called with the part of the path reached.
    options : tolerances and limits of the whole path.

    Raises
    ------
    SceneError
        Fewer than two values, too many, or one that is not a number; ``follow_instability``.
    StateError
        If ``options.start`` is not the state of this path.
    OutputError
        If the folder of ``options.checkpoint`` cannot be written; before any work.
    SolveError
    """
    asked = tuple(values)
    end = called(scene_at, asked[-1]) if asked else None
    bound = end.bound(parameter) if isinstance(end, Scene) else None
    ramp = Ramp(parameter, asked, lambda value: called(scene_at, value), asked=True, bound=bound)
    options = SolverOptions() if options is None else options
    options.check_folder()
    begin()
    first_scene = ramp(0.0)
    check_own_terms(first_scene.local_terms(), first_scene.local_surface(), first_scene.units)
    found = walk(ramp, options, report)
    reached = [s for s in found if s.success]
    path = Path(parameter, asked[: len(reached)], reached, blamed(found[-1]))
    if not path.success and on_fail == "raise":
        raise SolveError(f"{path.end.status.name}: {path.end.message}", path.end)
    return path


def walk(
    ramp: Ramp, options: SolverOptions, report: Callable[[float], None] = lambda load: None
) -> list[Solution]:
    """Solutions at the ramp's values; the last one says how the walk ended."""
    _check_walk(ramp, options)
    started = thread_time()
    if len({_formulation(ramp(load)) for load in ramp.stops}) > 1:
        return _each(ramp, options, started, report)
    first_scene = ramp(0.0)
    settings = settings_of(first_scene, options, started)
    assembly = Assembly(first_scene, options.quadrature)
    journal = journal_of(ramp, options)
    if options.start is not None and journal.start is None:
        raise StateError(
            f"{options.start}: not the state of this path, interrupted, with these options; a path "
            "starts from its own first value: leave solver.start out"
        )
    found: list[Solution] = list(journal.start.found) if journal.start else []

    def reached(scene: Scene, state: NewtonResult) -> tuple[NewtonResult, Sequence[Solution]]:
        solution, state = _concluded(scene, state, assembly, options, started)
        if solution.status is Status.INTERRUPTED:
            # what was not judged is not kept: it is done again
            late = "the CPU limit was reached before an equilibrium was judged"
            return replace(state, status=solution.status, message=late), found
        found.append(solution)
        return state, found

    path = load_stepping(ramp, assembly, settings, options.min_load_step, report, reached, journal)
    history = [_with_measures(step, ramp, found) for step in path.steps]
    if path.result.status is not None:
        assembly.load(path.scene)
        outcome = Outcome(path.scene, path.result, history, path.bracket, path.progress)
        return [*found, conclude(outcome, assembly, options, started)]
    return [*found[:-1], replace(found[-1], load_steps=tuple(history))]


def _check_walk(ramp: Ramp, options: SolverOptions) -> None:
    """Refuse what is not built along a path."""
    if options.follow_instability:
        raise SceneError("solver.follow_instability: not available yet along a path; leave it out")
    if any(ramp(load).free_edge is not None for load in ramp.stops):
        raise SceneError(
            "path: not available at 0 or 180 degrees on a smooth solid, where the edge is searched "
            "for at every value; solve the scenes one by one (sweep), or stay between"
        )


def _concluded(
    scene: Scene, state: NewtonResult, assembly: Assembly, options: SolverOptions, started: float
) -> tuple[Solution, NewtonResult]:
    """The solution of a state at one of a path's values, and the state to go on from."""
    assembly.load(scene)
    solution = conclude(Outcome(scene, state, []), assembly, options, started)
    if solution.status is not Status.UNDERRESOLVED or assembly.contact.lies:
        return solution, state
    # the way may have distorted the mesh: the same state on the scene's own
    own = first(scene, assembly, settings_of(scene, options, started))
    fresh = conclude(Outcome(scene, own, []), assembly, options, started)
    before, after = (s.measures["energy"] for s in (solution, fresh))
    same = fresh.success and abs(after - before) <= SAME * abs(before)
    return (fresh, own) if same else (solution, state)


def _formulation(scene: Scene) -> frozenset[str]:
    """How the membrane meets its solid: an assembly has one of them."""
    return frozenset(t.name for t in (*scene.by_form.obstacles, *scene.by_form.passed))


def _each(
    ramp: Ramp, options: SolverOptions, started: float, report: Callable[[float], None]
) -> list[Solution]:
    """Solutions at the ramp's values where its formulation changes, as between contact areas at 180
    degrees and contact lines below: each from its own start, which its predictor brings near."""
    found: list[Solution] = []
    history: list[LoadStep] = []
    for load in ramp.stops:
        scene = ramp(load)
        assembly = Assembly(scene, options.quadrature)
        state = first(scene, assembly, settings_of(scene, options, started))
        history.append(LoadStep(load, len(state.iterations), state.status, ramp.value(load)))
        found.append(conclude(Outcome(scene, state, []), assembly, options, started))
        if not found[-1].success:
            break
        history[-1] = replace(history[-1], measures=dict(found[-1].measures))
        report(load)
    return [*found[:-1], replace(found[-1], load_steps=tuple(history))]


def _with_measures(step: LoadStep, ramp: Ramp, found: Sequence[Solution]) -> LoadStep:
    """A load step at one of the ramp's values with what was measured there."""
    for load, solution in zip(ramp.stops, found, strict=False):
        if step.load == load and step.status is None:
            return replace(step, measures=dict(solution.measures))
    return step
