"""A path of load steps: what was tried, where it stands, how it ended."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..errors import GeometryError
from ..problems.scene import Scene
from ..status import Status
from ..surface.reparametrize import regridded
from .newton import NewtonOptions, NewtonResult, newton


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

    def attempt(self, assembly: Assembly, scene: Scene, options: NewtonOptions) -> NewtonResult:
        """Newton at a new load from the last good state."""
        assembly.load(scene)
        good = self.result
        # what the start knows of the parameter, moved rims above all, comes with it
        shift = scene.local_surface().points - self.scene.local_surface().points
        try:
            moved = good.surface.moved(good.surface.points + shift)
            grading = scene.meridian_grading
            start = moved if grading is None else regridded(moved, grading)
        except (GeometryError, np.linalg.LinAlgError) as error:
            return NewtonResult(good.surface, good.multipliers, Status.NONFINITE, str(error))
        return newton(assembly, start, good.multipliers, scene.meridian_grading, options)
