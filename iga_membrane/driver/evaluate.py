"""From an iterated state to a solution: measured, judged on independent evidence, recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from time import thread_time
from typing import Any

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..contact.unfitted import is_unfitted
from ..deadline import OutOfTime, until
from ..errors import GeometryError
from ..linalg.inverse_root import SingularMatrix
from ..problems.scene import Scene
from ..results.forces import ParticleForces, particle_forces
from ..results.measures import measures, volume
from ..results.particles import forces_on_particles
from ..solvers.load_path import Bracket, LoadPath, LoadStep, Progress
from ..solvers.newton import NewtonResult
from ..solvers.options import SolverOptions
from ..solvers.stability import Stability, stability_of
from ..status import Status
from ..surface.surface import Surface
from ..verification.audit import audit
from ..verification.evidence import Audit
from ..verification.trimmed_audit import trimmed_audit
from .contact_record import contact_record
from .ending import Evidence, ending_of
from .solution import Solution

GRACE = 0.05
"""Part of the CPU limit beyond it that the evidence may take."""
UNSTABLE = frozenset({Status.CONVERGED_SADDLE, Status.CONVERGED_MARGINAL})
"""Equilibria whose softest motion is of interest."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """What the iteration reached: ``scene`` is not the one asked for if a path stopped early."""

    scene: Scene
    result: NewtonResult
    steps: list[LoadStep]
    bracket: Bracket | None = None
    progress: Progress | None = None

    @classmethod
    def of(cls, path: LoadPath) -> Outcome:
        """What load stepping reached."""
        return cls(path.scene, path.result, path.steps, path.bracket, path.progress)


def conclude(
    outcome: Outcome, assembly: Assembly, options: SolverOptions, started: float
) -> Solution:
    """Measure, judge and record a state."""
    scene, result = outcome.scene, outcome.result
    surface, multipliers, scale = result.surface, result.multipliers, scene.units
    values = measures(scene, assembly, surface, multipliers)
    found = _evidence(outcome, assembly, options, started)
    ending, verdict = ending_of(found), found.stability
    assert ending.status is not None
    contact = contact_record(scene, assembly, result, values, found.audit)
    forces = _forces(scene, assembly, surface, multipliers)
    asked = scene.sector.model if options.stability == "model" else "full"
    solution = Solution(
        scene=scene,
        status=ending.status,
        message=ending.message,
        kind=ending.kind,
        surface=surface.moved(scale.to_world(surface.points)),
        measures=values,
        forces=forces,
        multipliers=_named(scene, assembly, multipliers),
        body=assembly.density(multipliers),
        index=None,
        lambda_min=None,
        mode=None,
        stability_scope=asked,
        audit=found.audit,
        volume_error=_volume_error(scene, found.inside),
        hold_force=_hold_force(scene, assembly, multipliers, found.inside),
        contact=contact,
        unknowns=assembly.size,
        iterations=tuple(result.iterations),
        load_steps=tuple(outcome.steps),
        bracket=outcome.bracket,
        progress=outcome.progress,
        cpu_seconds={
            "compile": assembly.compile_seconds,
            "assembly": assembly.seconds,
            "linear": result.linear_seconds,
            "contact": 0.0,
            "solve": thread_time() - started - assembly.compile_seconds,
        },
        warnings=_warnings(scene, verdict, asked, values),
    )
    return solution if verdict is None else _with_verdict(solution, verdict)


def _evidence(
    outcome: Outcome, assembly: Assembly, options: SolverOptions, started: float
) -> Evidence:
    """What can be known of a state within the CPU limit, and a little more."""
    scene, result = outcome.scene, outcome.result
    surface, multipliers = result.surface, result.multipliers
    checked, verdict, doubt, late = None, None, "", ""
    try:
        with until(started + (1.0 + GRACE) * options.max_cpu_s):
            checked = _audited(scene, assembly, surface, multipliers) if options.audit else None
            verdict, doubt = _examined(scene, assembly, surface, multipliers, options.stability)
    except OutOfTime as end:
        late = str(end)
    inside = volume(assembly, surface)
    return Evidence(scene, assembly, result, inside, checked, verdict, doubt, late)


def _with_verdict(solution: Solution, verdict: Stability) -> Solution:
    """A solution with what is known of its stability."""
    scale = solution.scene.units
    return replace(
        solution,
        index=verdict.index,
        lambda_min=verdict.smallest * scale.tension / scale.length**2,
        mode=_mode(solution.scene, verdict) if solution.status in UNSTABLE else None,
        stability_scope=verdict.scope,
        mode_within=verdict.within,
    )


def _mode(scene: Scene, verdict: Stability) -> Array:
    """(count, 3) the softest motion of the control points in world axes, the largest 1."""
    largest = np.linalg.norm(verdict.mode, axis=1).max()
    return np.asarray(verdict.mode @ scene.units.axes.T / largest)


def _examined(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array, scope: str
) -> tuple[Stability | None, str]:
    """Stability of a state, converged or not; or why there is none."""
    with np.errstate(all="ignore"):
        try:
            verdict = stability_of(scene, assembly, surface, multipliers, scope)
        except (SingularMatrix, GeometryError, np.linalg.LinAlgError, MemoryError) as error:
            return None, str(error)
    if not np.isfinite(verdict.smallest):
        return None, "the smallest eigenvalue is not finite"
    return verdict, ""


def _forces(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> tuple[ParticleForces, ...]:
    """Forces on a sheet's particle, or on those of a droplet."""
    if scene.particles and assembly.contact.passes:
        return forces_on_particles(scene, assembly, surface, multipliers)
    return particle_forces(scene, assembly, surface, multipliers)


def _audited(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> Audit | None:
    """The audit of a state, converged or not; None where there is no normal or no memory."""
    body, load = assembly.density(multipliers), assembly.line_load(multipliers)
    with np.errstate(all="ignore"):
        try:
            motion = assembly.motion(surface)
            if is_unfitted(assembly.contact):
                return trimmed_audit(scene, surface, motion, body, assembly.contact)
            return audit(scene, surface, motion, body, load, assembly.points, assembly.contact)
        except (GeometryError, MemoryError):
            return None


def _volume_error(scene: Scene, inside: float) -> float | None:
    """Relative error of a prescribed volume; None where none is."""
    held = scene.local_terms().volume
    return abs(inside - held.target) / held.value if held else None


def _hold_force(
    scene: Scene, assembly: Assembly, multipliers: Array, inside: float
) -> tuple[float, float, float]:
    """World vector of the force with which the centroid constraints act on the liquid."""
    local = np.zeros(3)
    for term, multiplier in zip(assembly.constraints, multipliers, strict=False):
        local += multiplier * inside * np.array(term.density().gradient)
    x, y, z = (float(f) for f in scene.units.axes @ local * scene.units.force)
    return x, y, z


def _named(scene: Scene, assembly: Assembly, multipliers: Array) -> dict[str, float]:
    """Multipliers of the constraints in the user's units: slopes of the energy, that of weight zero
    at the world's origin."""
    scale = scene.units
    # what it costs to lift a volume from there to the frame's origin
    lifted = -float(assembly.body.at(scale.to_local(np.zeros(3)))) + assembly.body.constant
    found = {}
    for term, multiplier in zip(assembly.constraints, multipliers, strict=False):
        # per volume, or per volume and length
        density = term.density()
        unit = scale.pressure / (scale.length if any(density.gradient) else 1.0)
        found[term.name] = (float(multiplier) + lifted * density.constant) * unit
    return found


def _warnings(
    scene: Scene, verdict: Stability | None, asked: str, found: Mapping[str, Any]
) -> tuple[str, ...]:
    texts = list(scene.warnings)
    if verdict and verdict.scope != asked:
        texts.append(
            f"stability is judged within the symmetry of the {verdict.scope} model: the whole "
            'body\'s is not available yet with solver.motion = "cartesian"; take '
            'discretization.model = "full"'
        )
    if verdict and verdict.pinned:
        texts.append(f"neutral rigid motions are pinned: {', '.join(verdict.pinned)}")
    if "cassie_baxter_angle" in found and found["cassie_baxter_angle"] is None:
        texts.append(
            "cassie_baxter_angle is null: the wet spots are so curved that the cosine of the "
            "formula of Cassie and Baxter leaves [-1, 1]"
        )
    if "apparent_angle" in found and found["apparent_angle"] is None:
        texts.append(
            "apparent_angle is null: a profile under the pressure at the apex does not come down"
        )
    return tuple(texts)
