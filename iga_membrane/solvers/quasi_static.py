"""Load steps of the paper's formulation: each starts from the metric of the one before.

A membrane that ends on contact lines relaxes at the last load. One that lies on its solid with a
penalty does not: what the discrete contact leaves along its plane makes it creep for ever. Its
places in its plane do not matter, so it settles along its spines.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..assembly.lagrangian import Assembly
from ..problems.scene import Ramp, Scene
from ..status import Status
from ..terms import Stabilization
from .load_path import LoadStep
from .newton import NewtonOptions, NewtonResult, newton

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
) -> tuple[Scene, NewtonResult, list[LoadStep]]:
    """Walk the ramp of a scene with a stabilized membrane, then relax at its end or settle.

    At a fixed load every step takes over the metric of the last one and half its stabilization, so
    the stress of eq. (23) fades until it holds only what the discrete membrane cannot balance in
    its plane. Where such a step fails, they begin again and fade less, at last not at all.

    Returns
    -------
    The scene that was solved at last, its state and all steps. A stabilization left in the assembly
    is projected and weak: it only keeps motions in the plane from counting when stability is
    judged.
    """
    ramp = scene.ramp
    assert ramp is not None
    result, steps = _walked(ramp, scene, assembly, options, report)
    if result.status is not None:
        return scene, result, steps
    if scene.directions is None:
        return scene, *_relaxed(ramp, assembly, result, options, steps)
    free = scene.along_spines(result.surface)
    assembly.load(free)
    settled = newton(assembly, result.surface, result.multipliers, None, options)
    settled.linear_seconds += result.linear_seconds
    steps.append(LoadStep(1.0, len(settled.iterations), settled.status, ramp.value(1.0)))
    return free, settled, steps


def _walked(
    ramp: Ramp,
    scene: Scene,
    assembly: Assembly,
    options: NewtonOptions,
    report: Callable[[float], None],
) -> tuple[NewtonResult, list[LoadStep]]:
    """The state at the end of the ramp, or the first that failed, and the steps to it."""
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
    return result, steps


def _relaxed(
    ramp: Ramp,
    assembly: Assembly,
    result: NewtonResult,
    options: NewtonOptions,
    steps: list[LoadStep],
) -> tuple[NewtonResult, list[LoadStep]]:
    """Steps at the last load, added to those before."""
    given, weakest = _stabilization(ramp(1.0)).mu, FADED * assembly.tension
    while True:
        relaxed, mu, crept = _relax(ramp, assembly, result, options, weakest, steps)
        if relaxed.status in (None, Status.INTERRUPTED) or mu >= given:
            break
        weakest = min(mu / FADING, given)
    if relaxed.status is not None:
        return relaxed, steps
    if crept > CREPT:
        relaxed.status = Status.STALLED
        relaxed.message = (
            f"the stabilization has not relaxed in {RELAXATIONS} steps at the last load (the last "
            f"one moved the membrane by {crept:.1e} lengths): lower solver.stabilization"
        )
    weak = Stabilization(WEAK * assembly.tension, projected=True)
    assembly.begin_step(relaxed.surface, weak)
    return relaxed, steps


def _relax(
    ramp: Ramp,
    assembly: Assembly,
    result: NewtonResult,
    options: NewtonOptions,
    weakest: float,
    steps: list[LoadStep],
) -> tuple[NewtonResult, float, float]:
    """Steps at the last load: the last one, its stabilization, how far it moved the membrane."""
    mu, crept = _stabilization(ramp(1.0)).mu, np.inf
    for _ in range(RELAXATIONS):
        mu = max(FADING * mu, weakest)
        tried = _step(ramp(1.0), assembly, result, result, options, mu)
        steps.append(LoadStep(1.0, len(tried.iterations), tried.status, ramp.value(1.0)))
        if tried.status is not None:
            return tried, mu, np.inf
        moved = tried.surface.points - result.surface.points
        result = tried
        normals = assembly.spines.on(result.surface).directions[: len(moved)]
        crept = float(np.abs(np.einsum("ki,ki->k", moved, normals)).max())
        if crept <= RELAXED:
            break
    return result, mu, crept


def _step(
    scene: Scene,
    assembly: Assembly,
    state: NewtonResult,
    before: NewtonResult | None,
    options: NewtonOptions,
    mu: float | None = None,
) -> NewtonResult:
    """One load step, or with a stabilization of its own one of those at the last load."""
    assembly.load(scene)
    term = _stabilization(scene)
    assembly.begin_step(state.surface, term if mu is None else replace(term, mu=mu))
    multipliers = None if before is None else before.multipliers
    result = newton(assembly, state.surface, multipliers, None, options)
    result.linear_seconds += state.linear_seconds
    return result


def _stabilization(scene: Scene) -> Stabilization:
    return scene.local_terms().stabilizations[0]
