"""Load stepping with halving: the way round where a direct solve fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array
from ..errors import GeometryError
from ..scenes.scene import Scene
from ..surface.reparametrize import arc_length
from ..surface.surface import Surface
from .assembly import Assembly
from .newton import NewtonOptions, NewtonResult, newton
from .status import Status


@dataclass(frozen=True)
class LoadStep:
    """One attempted load: its Newton iterations and how it ended (None: converged)."""

    load: float
    iterations: int
    status: Status | None


@dataclass(eq=False)
class LoadPath:
    """End of load stepping.

    Attributes
    ----------
    result : at the last good load, with the status of the last attempt.
    scene : the scene at that load.
    steps : every attempt.
    """

    result: NewtonResult
    scene: Scene
    steps: list[LoadStep] = field(default_factory=list)
    last_good: float = 0.0


def load_stepping(
    ramp: Callable[[float], Scene],
    assembly: Assembly,
    options: NewtonOptions,
    smallest: float,
    report: Callable[[float], None] = lambda load: None,
) -> LoadPath:
    """From the ramp's own start at load 0 to load 1, in steps that grow and halve.

    Parameters
    ----------
    ramp : load to scene; all scenes share the assembly's space and supports.
    smallest : step of the load below which to give up, STALLED.
    report : called with every load reached.
    """
    scene = ramp(0.0)
    assembly.load(scene)
    result = newton(assembly, scene.local_surface(), None, scene.grading, options)
    path = LoadPath(result, scene, [LoadStep(0.0, len(result.iterations), result.status)])
    load, step = 0.0, 0.25
    surface, multipliers = result.surface, result.multipliers
    while result.status is None and load < 1.0:
        target = min(1.0, load + step)
        scene = ramp(target)
        assembly.load(scene)
        result = _attempt(assembly, scene, surface, multipliers, options)
        path.steps.append(LoadStep(target, len(result.iterations), result.status))
        if result.status is None and result.index <= 0:
            load, surface, multipliers = target, result.surface, result.multipliers
            path.result, path.scene, path.last_good = result, scene, load
            report(load)
            step *= 1.5 if len(result.iterations) > 5 else 2.0
            continue
        step *= 0.5
        interrupted = result.status is Status.INTERRUPTED
        if interrupted or step < smallest:
            reason = result.message or f"{result.index} negative eigenvalues"
            path.result.status = Status.INTERRUPTED if interrupted else Status.STALLED
            path.result.message = (
                f"load stepping stopped at {load:.4g} of the load with steps of {2 * step:.2g} "
                f"({reason})"
            )
            return path
        result.status = None
    return path


def _attempt(
    assembly: Assembly,
    scene: Scene,
    surface: Surface,
    multipliers: Array,
    options: NewtonOptions,
) -> NewtonResult:
    try:
        start = arc_length(surface, scene.grading)
    except (GeometryError, np.linalg.LinAlgError) as error:
        return NewtonResult(surface, multipliers, Status.NONFINITE, str(error))
    return newton(assembly, start, multipliers, scene.grading, options)
