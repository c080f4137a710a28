"""From an iterated state to a solution: measured, judged on independent evidence, recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
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
from ..solvers.load_stepping import Bracket, LoadStep, Progress
from ..solvers.newton import NewtonResult
from ..solvers.options import SolverOptions
from ..solvers.stability import Stability, stability_of
from ..status import REMEDY, Status
from ..surface.surface import Surface
from ..terms import Centroid, Volume
from ..verification.audit import audit
from ..verification.evidence import Audit
from ..verification.self_intersection import crossing
from ..verification.trimmed_audit import trimmed_audit
from .acceptance import (
    contact_objection,
    judge,
    leaves_its_asperity,
    overload,
    reaches_boundary,
    rests_on_a_point,
    rolling,
    too_soft,
)
from .contact_record import contact_record
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


def conclude(
    outcome: Outcome, assembly: Assembly, options: SolverOptions, started: float
) -> Solution:
    """Measure, judge and record a state."""
    scene, result = outcome.scene, outcome.result
    surface, multipliers = result.surface, result.multipliers
    verdict, checked, kind, doubt = None, None, None, ""
    status, message = result.status, result.message
    asked = scene.sector.model if options.stability == "model" else "full"
    if status is Status.TOPOLOGY_CHANGE:
        kind = "touches_in_a_point"  # the edge at 180 degrees has closed
    if status in REMEDY:
        message = f"{message}: {REMEDY[status]}{rolling(scene)}"
    inside = volume(assembly, surface)
    found = measures(scene, assembly, surface, multipliers)
    try:
        with until(started + (1.0 + GRACE) * options.max_cpu_s):
            checked = _audited(scene, assembly, surface, multipliers) if options.audit else None
            verdict, doubt = _examined(scene, assembly, surface, multipliers, options.stability)
    except OutOfTime as end:
        if status is None:
            status = Status.INTERRUPTED
            message = f"an equilibrium, but {end} before it was judged: {REMEDY[status]}"
    if status is None and verdict is None:
        status, message = Status.CONVERGED_MARGINAL, f"no stability verdict: {doubt}"
    hold = _hold_force(scene, assembly, multipliers, inside)
    if status is None:
        assert verdict is not None
        status, message = judge(scene, verdict, checked, inside)
        if assembly.contact.carries or assembly.contact.passes:
            objection = contact_objection(scene, assembly, surface, multipliers)
            if objection is not None:
                status, kind, message = objection
        point = rests_on_a_point(scene)
        if point is not None:
            status, kind, message = point
    ends = not (assembly.contact.lies or assembly.contact.passes)
    if status is Status.CONVERGED_STABLE and ends:
        place = crossing(surface)
        if place is not None:
            status, kind = Status.TOPOLOGY_CHANGE, "self-contact"
            x, y, z = scene.units.to_world(place)
            message = f"the membrane meets itself at ({x:.4g}, {y:.4g}, {z:.4g})"
    if result.floor is not None and status is not None:
        message += f"; rounding ended the iteration, at a relative residual of {result.floor:.0e}"
    sunk = too_soft(scene, assembly, multipliers)
    if sunk is not None and status is not Status.INTERRUPTED:
        status, message = sunk
    if result.status not in (None, Status.INTERRUPTED) and reaches_boundary(scene, surface):
        status, kind = Status.TOPOLOGY_CHANGE, "reaches boundary"
        message = "the contact line reaches the rim: no sheet is left between them"
    if status not in (Status.CONVERGED_STABLE, Status.INTERRUPTED):
        message += overload(scene, assembly, multipliers)
    left = leaves_its_asperity(scene, surface, status, message)
    if left is not None:
        status, kind, message = left
    scale = scene.units
    contact = contact_record(scene, assembly, result, found, checked)
    total = thread_time() - started - assembly.compile_seconds
    return Solution(
        scene=scene,
        status=status,
        message=message,
        kind=kind,
        surface=surface.moved(scale.to_world(surface.points)),
        measures=found,
        forces=_forces(scene, assembly, surface, multipliers),
        multipliers=_named(scene, assembly, multipliers),
        body=assembly.density(multipliers),
        index=verdict.index if verdict else None,
        lambda_min=verdict.smallest * scale.tension / scale.length**2 if verdict else None,
        mode=_mode(scene, verdict) if status in UNSTABLE else None,
        stability_scope=verdict.scope if verdict else asked,
        mode_within=verdict.within if verdict else None,
        audit=checked,
        volume_error=_volume_error(scene, inside),
        hold_force=hold,
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
            "solve": total,
        },
        warnings=_warnings(scene, verdict, asked, found),
    )


def _mode(scene: Scene, verdict: Stability | None) -> Array | None:
    """(count, 3) the softest motion of the control points in world axes, the largest 1."""
    if verdict is None:
        return None
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
    held = next((t for t in scene.local_terms() if isinstance(t, Volume)), None)
    return abs(inside - held.target) / held.value if held else None


def _hold_force(
    scene: Scene, assembly: Assembly, multipliers: Array, inside: float
) -> tuple[float, float, float]:
    """World vector of the force with which the centroid constraints act on the liquid."""
    local = np.zeros(3)
    for term, multiplier in zip(assembly.constraints, multipliers, strict=False):
        if isinstance(term, Centroid):
            local["xyz".index(term.axis)] = multiplier * inside
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
        unit = scale.pressure / (scale.length if isinstance(term, Centroid) else 1.0)
        moved = lifted if isinstance(term, Volume) else 0.0
        found[term.name] = (float(multiplier) + moved) * unit
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
    return tuple(texts)
