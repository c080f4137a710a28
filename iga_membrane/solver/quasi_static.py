"""Load steps of the paper's formulation: each starts from the metric of the one before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..scenes.scene import Scene
from ..terms import Stabilization
from .assembly import Assembly
from .load_stepping import LoadStep
from .newton import NewtonOptions, NewtonResult, newton
from .status import Status

HALVINGS = 6
"""How often a load step that fails is halved."""
FADING, FADED = 0.5, 0.1
"""Stabilization of each step at the last load over that of the step before, and over the tension
where that ends: so the last state does not know with which one they began."""
RELAXED = 1e-7
"""Displacement along the normals (over the length) of a step at the last load that ends them."""
RELAXATIONS = 100
"""Steps at the last load at most."""
CREPT = 1e-4
"""Displacement of the last of them from which the state is no equilibrium yet."""
WEAK = 1e-2
"""Stabilization over tension with which stability is judged: more than the discrete membrane's own
stiffness in its plane, which may be negative, and little against that of the contact line."""


def quasi_static(
    scene: Scene,
    assembly: Assembly,
    options: NewtonOptions,
    report: Callable[[float], None] = lambda load: None,
) -> tuple[NewtonResult, list[LoadStep]]:
    """Walk the ramp of a scene with a stabilized membrane, then relax at its end.

    At a fixed load every step takes over the metric of the last one and half its stabilization, so
    the stress of eq. (23) fades until it holds only what the discrete membrane cannot balance in
    its plane.

    Returns
    -------
    The last state and all steps. The stabilization left in the assembly is projected and weak: it
    only keeps motions in the plane from counting when stability is judged.
    """
    ramp = scene.ramp
    assert ramp is not None
    surface = scene.local_surface()
    result = NewtonResult(surface, np.zeros(assembly.multipliers))
    steps: list[LoadStep] = []
    reached, wanted = -1.0, list(ramp.stops)
    smallest = (ramp.stops[1] - ramp.stops[0]) / 2**HALVINGS
    while wanted:
        load = float(wanted[0])
        tried = _step(ramp(load), assembly, result, None if reached < 0 else result, options)
        steps.append(LoadStep(load, len(tried.iterations), tried.status, ramp.value(load)))
        if tried.status is None:
            result, reached = tried, load
            report(load)
            wanted.pop(0)
        elif tried.status is Status.INTERRUPTED or load - max(reached, 0.0) <= smallest:
            tried.linear_seconds = result.linear_seconds
            return tried, steps
        else:
            wanted.insert(0, 0.5 * (load + reached))
    for k in range(RELAXATIONS):
        tried = _step(ramp(1.0), assembly, result, result, options, relaxing=k + 1)
        steps.append(LoadStep(1.0, len(tried.iterations), tried.status, ramp.value(1.0)))
        if tried.status is not None:
            return tried, steps
        moved = tried.surface.points - result.surface.points
        result = tried
        normals = assembly.spines.on(result.surface).directions[: len(moved)]
        crept = float(np.abs(np.einsum("ki,ki->k", moved, normals)).max())
        if crept <= RELAXED:
            break
    if crept > CREPT:
        result.status = Status.STALLED
        result.message = (
            f"the stabilization has not relaxed in {RELAXATIONS} steps at the last load (the last "
            f"one moved the membrane by {crept:.1e} lengths): lower solver.stabilization"
        )
    assembly.begin_step(result.surface, Stabilization(WEAK * assembly.tension, projected=True))
    return result, steps


def _step(
    scene: Scene,
    assembly: Assembly,
    state: NewtonResult,
    before: NewtonResult | None,
    options: NewtonOptions,
    relaxing: int = 0,
) -> NewtonResult:
    """One load step, or one of those at the last load, by number."""
    assembly.load(scene)
    term = next(t for t in scene.local_terms() if isinstance(t, Stabilization))
    if relaxing:
        term = replace(term, mu=max(FADING**relaxing * term.mu, FADED * assembly.tension))
    assembly.begin_step(state.surface, term)
    multipliers = None if before is None else before.multipliers
    result = newton(assembly, state.surface, multipliers, None, options)
    result.linear_seconds += state.linear_seconds
    return result
