"""Down from a saddle: a push along its softest mode, then Newton's method anew."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..errors import SceneError
from ..problems.scene import Scene
from ..solvers.load_path import LoadStep
from ..solvers.newton import NewtonOptions, NewtonResult, newton
from ..solvers.options import SolverOptions
from ..status import Status
from ..surface.surface import Surface
from .evaluate import Outcome, conclude
from .solution import Solution

log = logging.getLogger("iga_membrane")

FALLS = 4
"""Saddles from which to fall, one after the other, at most."""
PUSHES = 0.5 ** np.arange(12)
"""Pushes tried, over the longest step of Newton's method."""
CORRECTIONS = 3
"""Steps back to the constraints after a push; each squares what is missing."""
ALIKE = 1e-3
"""Relative difference of what both pushes gain below which they are mirror images."""
ENDS = frozenset({
    Status.CONVERGED_STABLE, Status.CONVERGED_SADDLE, Status.CONVERGED_MARGINAL, Status.UNVERIFIED,
})  # fmt: skip
"""Equilibria; a fall that ends otherwise is told, but its saddle stays the answer."""


def check_followed(scene: Scene) -> None:
    """Refuse scenes whose state is not the end of one Newton iteration.

    Raises
    ------
    SceneError
    """
    for stands, what in (
        (scene.free_particles is not None, "with particles that move"),
        (scene.motion == "cartesian", 'with solver.motion = "cartesian"'),
        (scene.free_edge is not None, "at 0 or 180 degrees on a smooth solid"),
    ):
        if stands:
            raise SceneError(f"solver.follow_instability: not available yet {what}; leave it out")


def followed(
    saddle: Solution,
    outcome: Outcome,
    assembly: Assembly,
    settings: NewtonOptions,
    options: SolverOptions,
    started: float,
) -> Solution:
    """The equilibrium below a saddle; or the saddle, and in its message where the fall ended.

    Parameters
    ----------
    saddle : what was concluded of ``outcome``, the state of ``assembly``.
    settings : of Newton's method; options, started : of the solve.

    Returns
    -------
    Of several saddles on the way, each below the one before, the last if none leads further.
    """
    settings = replace(settings, near=0.0)  # away from saddles, however near they are
    here, result, tried = saddle, outcome.result, [saddle]
    message = saddle.message
    for _ in range(FALLS):
        if here.mode_beyond_model:
            message = (
                f'{message}; not followed down, the "{assembly.spines.model}" model cannot take '
                f'that motion: take discretization.model = "{here.mode_within}"'
            )
            break
        ends = []
        for start in _pushes(here, result, assembly, settings.step_limit):
            grading = outcome.scene.meridian_grading
            fallen = newton(assembly, start, result.multipliers, grading, settings)
            step = LoadStep(1.0, len(fallen.iterations), fallen.status)
            below = conclude(Outcome(outcome.scene, fallen, [step]), assembly, options, started)
            tried.append(below)
            drop = saddle.measures["energy"] - below.measures["energy"]
            log.info("below a saddle: %s, energy lower by %.3g", below.status.name, drop)
            if below.status in ENDS and below.measures["energy"] < here.measures["energy"]:
                here, result = below, fallen
                message = f"{below.message}; followed down from a saddle, by {drop:.6g} in energy"
                break
            ends.append(f"{below.status.name} ({below.message})")
        else:
            told = " and ".join(dict.fromkeys(ends)) or "no push along the mode lowers the energy"
            message = f"{message}; followed down: {told}"
            break
        if here.status is not Status.CONVERGED_SADDLE:
            break
    return replace(
        here,
        message=message,
        iterations=tuple(step for one in tried for step in one.iterations),
        load_steps=tuple(step for one in tried for step in one.load_steps),
        cpu_seconds={
            **tried[-1].cpu_seconds,
            "linear": sum(one.cpu_seconds["linear"] for one in tried),
        },
    )


def _pushes(
    saddle: Solution, result: NewtonResult, assembly: Assembly, longest: float
) -> list[Surface]:
    """States beside a saddle along its mode, lower than it, the lowest first; one of the two ways
    if they are mirror images."""
    assert saddle.mode is not None
    mode = saddle.mode @ saddle.scene.units.axes
    before = assembly.energies(result.surface)
    found: list[tuple[float, Surface]] = []
    for way in (1.0, -1.0):
        states = [
            _constrained(assembly, result, result.surface.points + way * push * mode)
            for push in longest * PUSHES
        ]
        gains = []
        for state in states:
            at = assembly.energies(state)
            # what is left of the constraints costs its multiplier
            gain = before.total - at.total + float(result.multipliers @ at.constraints)
            gains.append(gain if at.regular_after(before) else -np.inf)
        best = int(np.argmax(gains))
        if gains[best] > 0.0:
            found.append((gains[best], states[best]))
    if len(found) == 2 and np.isclose(found[0][0], found[1][0], rtol=ALIKE, atol=0.0):
        found.pop()
    return [state for _, state in sorted(found, key=lambda one: -one[0])]


def _constrained(assembly: Assembly, result: NewtonResult, points: Array) -> Surface:
    """The nearest state, to first order, that keeps the constraints."""
    motion = assembly.motion(result.surface)
    _, columns = assembly.forces(result.surface, motion.directions)
    surface = result.surface.moved(points)
    for _ in range(CORRECTIONS):
        missing = assembly.energies(surface).constraints
        step = np.linalg.lstsq(columns.T, -missing)[0]
        surface = surface.moved(surface.points + assembly.displacement(motion, step))
    return surface
