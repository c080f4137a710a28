"""Convergence studies: one scene on many spaces and meshes, error against what it costs."""

from __future__ import annotations

import csv
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import isnan, log, nan
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import checked
from ..checks import anything, choice, integer, items, number, record
from ..dofs.boundary_conditions import Model
from ..driver.solution import Solution
from ..driver.solve import solve
from ..errors import OutputError, SceneError
from ..fields import FIELDS
from ..files import write_whole
from ..initial.liquid import Discretization, space_name
from ..optional import optional
from ..own import called
from ..problems.scene import Scene
from ..solvers.options import SolverOptions
from ..splines import BasisOf
from ..status import Status

COSTS = {"unknowns": "unknowns", "cpu": "CPU seconds", "memory": "peak memory, MB"}


@dataclass(frozen=True)
class Run:
    """One mesh of a study.

    Attributes
    ----------
    space, degree, elements : its discretization.
    status : how the solve ended; its errors are of the state it reached.
    unknowns, iterations, load_steps : counts.
    errors : by measure, relative; absolute where the exact value is 0.
    cpu_seconds : medians of "solve" and of its parts "assembly", "linear"; without imports and
        compilation.
    memory : largest resident size of the process during the solves (MB); nan where the operating
        system does not tell.
    """

    space: str
    degree: int
    elements: int
    status: Status
    unknowns: int
    iterations: int
    load_steps: int
    errors: Mapping[str, float]
    cpu_seconds: Mapping[str, float]
    memory: float

    def cost(self, of: str) -> float:
        """What the run cost: "unknowns", "cpu" (seconds) or "memory" (MB)."""
        found = {
            "unknowns": float(self.unknowns),
            "cpu": self.cpu_seconds["solve"],
            "memory": self.memory,
        }
        return found[choice("of", of, COSTS)]


@dataclass(frozen=True)
@checked()
class Study:
    """Runs of a convergence study, by space and then by mesh.

    Attributes
    ----------
    runs : every solve.
    measures : names of the errors.
    """

    runs: tuple[Run, ...]
    measures: tuple[str, ...]

    def of(self, space: str, degree: int) -> tuple[Run, ...]:
        """Runs of one space, coarse to fine."""
        return tuple(run for run in self.runs if (run.space, run.degree) == (space, degree))

    @property
    def spaces(self) -> tuple[tuple[str, int], ...]:
        """The spaces, in the order in which they were given."""
        return tuple(dict.fromkeys((run.space, run.degree) for run in self.runs))

    def rates(self, space: str, degree: int, measure: str) -> tuple[float, ...]:
        """Order in the element size between successive meshes of one space."""
        runs = self.of(space, degree)
        return tuple(_rate(one, two, measure) for one, two in pairwise(runs))

    def cost(
        self, error: float, measure: str, space: str, degree: int, of: str = "unknowns"
    ) -> float | None:
        """What an error costs in one space, interpolated between the logarithms of its runs.

        Parameters
        ----------
        of : "unknowns", "cpu" (seconds) or "memory" (MB).

        Returns
        -------
        The cost, or None where no two successive runs have the error between them.
        """
        number("error", error, above=0.0)
        choice("measure", measure, self.measures)
        runs = self.of(space, degree)
        for one, two in pairwise(runs):
            before, after = one.errors[measure], two.errors[measure]
            if before > error >= after > 0:
                part = log(before / error) / log(before / after)
                return float(one.cost(of) ** (1.0 - part) * two.cost(of) ** part)
        return None

    def table(self) -> str:
        """All runs as a Markdown table; rates (order in the element size) in parentheses."""
        names = ["space", "degree", "elements", "unknowns", "iterations", "CPU s", "assembly",
                 "linear", "MB", *self.measures, "status"]  # fmt: skip
        rows = [_row(names), "|---" * len(names) + "|"]
        for space, degree in self.spaces:
            before: Run | None = None
            for run in self.of(space, degree):
                seconds = [run.cpu_seconds[name] for name in ("solve", "assembly", "linear")]
                cells = [space, degree, run.elements, run.unknowns, run.iterations]
                cells += [f"{s:.3f}" for s in seconds]
                cells.append("" if isnan(run.memory) else f"{run.memory:.0f}")
                cells += [_error(before, run, measure) for measure in self.measures]
                rows.append(_row([*cells, run.status.name]))
                before = run
        return "\n".join(rows)

    def save(self, path: str | Path) -> None:
        """Write all runs as comma separated values.

        Raises
        ------
        OutputError
            If the file cannot be written.
        """
        head = ["space", "degree", "elements", "status", "unknowns", "iterations", "load_steps",
                "cpu_solve", "cpu_assembly", "cpu_linear", "memory_mb"]  # fmt: skip
        rows: list[list[Any]] = [head + [f"error_{name}" for name in self.measures]]
        for run in self.runs:
            counts = [run.unknowns, run.iterations, run.load_steps]
            seconds = [run.cpu_seconds[name] for name in ("solve", "assembly", "linear")]
            rows.append(
                [run.space, run.degree, run.elements, run.status.name, *counts, *seconds,
                 run.memory, *(run.errors[name] for name in self.measures)]
            )  # fmt: skip

        def write(name: str) -> None:
            with open(name, "w", newline="", encoding="utf-8") as file:
                csv.writer(file).writerows(rows)

        write_whole(Path(path), write)

    def plot(self, path: str | Path, *, measure: str | None = None, against: str = "cpu") -> None:
        """Picture of the error against its cost, one line a space; hollow marks did not succeed.

        Parameters
        ----------
        path : of the picture; its ending chooses the format.
        measure : whose error, the first one if omitted.
        against : "cpu" seconds, "unknowns" or peak "memory".

        Raises
        ------
        OutputError
            If the file cannot be written.
        """
        Figure = optional("matplotlib.figure", "a plot").Figure
        NullFormatter = optional("matplotlib.ticker", "a plot").NullFormatter
        name = choice("measure", self.measures[0] if measure is None else measure, self.measures)
        choice("against", against, COSTS)
        figure = Figure(figsize=(6.0, 4.5), layout="constrained")
        axes = figure.add_subplot(
            xscale="log",
            yscale="log",
            xlabel=COSTS[against],
            ylabel=f"relative error of {name}",
        )
        kinds = list(dict.fromkeys(space for space, _ in self.spaces))
        for space, degree in self.spaces:
            runs = self.of(space, degree)
            x = [run.cost(against) for run in runs]
            y = [run.errors[name] for run in runs]
            colour = f"C{degree - 1}"
            style = ("-", "--", ":")[kinds.index(space) % 3]
            axes.plot(x, y, style, color=colour, label=f"{space}, degree {degree}")
            for run, a, b in zip(runs, x, y, strict=True):
                good = run.status is Status.CONVERGED_STABLE
                axes.plot(a, b, "o", color=colour, fillstyle="full" if good else "none")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(True, alpha=0.3)
        axes.legend()
        try:
            write_whole(Path(path), lambda file: figure.savefig(file, dpi=150))
        except ValueError as error:
            raise OutputError(f"{path}: cannot be written ({error})") from error


def _space(field: str, value: Any) -> tuple[Any, int]:
    """A space and a degree, as a discretization has them."""
    space, degree = items(field, value, each=anything, count=2)
    made = Discretization(space, degree)
    return made.space, degree


@checked(
    spaces=partial(items, each=_space, least=1),
    elements=partial(items, each=FIELDS["discretization.elements"], least=1),
    model="discretization.model",
    repeats=partial(integer, least=1, most=1000),
)
def convergence_study(
    scene_of: Callable[[Discretization], Scene],
    *,
    spaces: Sequence[tuple[str | BasisOf, int]] = (("bspline", 2), ("lagrange", 2)),
    elements: Sequence[int] = (4, 8, 16, 32),
    exact: Mapping[str, float],
    model: Model | None = None,
    repeats: int = 1,
    options: SolverOptions | None = None,
) -> Study:
    """Solve a scene on every space and mesh.

    Parameters
    ----------
    scene_of : discretization to scene.
    spaces : pairs of "bspline", "nurbs", "lagrange" or a basis of your own
        (:class:`Discretization`) and a degree (1 to 4, splines from 2).
    elements : along the main direction, coarse to fine.
    exact : measures (:attr:`Solution.measures`) and the values they should have.
    model : sector that is computed; the smallest the scene allows if omitted.
    repeats : solves of each mesh; CPU seconds are their median.
    options : of the solver.

    Raises
    ------
    SceneError
        No space, mesh or measure; a measure that the scene does not have; whatever ``scene_of``
        refuses. All meshes are checked before the first solve.
    """
    if not exact:
        raise SceneError("exact is empty: a study needs at least one measure")
    meshes = [
        Discretization(space, degree, count, model)
        for space, degree in spaces
        for count in sorted(elements)
    ]
    scenes = [record("scene_of(mesh)", called(scene_of, mesh), Scene) for mesh in meshes]
    runs = tuple(
        _run(mesh, scene, exact, repeats, options)
        for mesh, scene in zip(meshes, scenes, strict=True)
    )
    return Study(runs, tuple(exact))


def _run(
    mesh: Discretization,
    scene: Scene,
    exact: Mapping[str, float],
    repeats: int,
    options: SolverOptions | None,
) -> Run:
    _reset_peak()
    found = [solve(scene, options, on_fail="return") for _ in range(repeats)]
    solution = found[0]
    for name in exact:
        if name not in solution.measures:
            raise SceneError(
                f"exact[{name!r}]: the scene has no such measure, only "
                f"{', '.join(solution.measures)}"
            )
    assert mesh.degree is not None
    assert mesh.elements is not None
    return Run(
        space_name(mesh.space),
        mesh.degree,
        mesh.elements,
        solution.status,
        solution.unknowns,
        solution.newton_iterations,
        len(solution.load_steps),
        {name: _distance(solution, name, value) for name, value in exact.items()},
        {
            part: statistics.median(s.cpu_seconds[part] for s in found)
            for part in ("solve", "assembly", "linear")
        },
        _peak(),
    )


def _distance(solution: Solution, name: str, value: float) -> float:
    found = solution.measures[name]
    return np.nan if found is None else float(abs(found - value) / (abs(value) or 1.0))


def _rate(one: Run, two: Run, measure: str) -> float:
    before, after = one.errors[measure], two.errors[measure]
    if not (before > 0 and after > 0):
        return nan
    return float(np.log(before / after) / np.log(two.elements / one.elements))


def _error(before: Run | None, run: Run, measure: str) -> str:
    rate = "" if before is None else f" ({_rate(before, run, measure):.1f})"
    return f"{run.errors[measure]:.1e}{rate}"


def _row(cells: Sequence[object]) -> str:
    return "| " + " | ".join(map(str, cells)) + " |"


def _reset_peak() -> None:
    """Count the process's largest resident size from here on (Linux)."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return


def _peak() -> float:
    """Largest resident size since :func:`_reset_peak`, MB."""
    try:
        text = Path("/proc/self/status").read_text()
    except OSError:
        return nan
    return next(
        (int(line.split()[1]) / 1024.0 for line in text.splitlines() if line.startswith("VmHWM")),
        nan,
    )
