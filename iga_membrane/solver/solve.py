"""The verb: scene in, solution out, with a true status."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from time import process_time
from typing import Literal

import numpy as np

from ..arrays import Array
from ..errors import SceneError, SolveError
from ..scenes.scene import Scene
from ..solids import Sphere
from ..splines import Grading
from ..surface.surface import Surface
from ..terms import Centroid, LineTerm, PlaneContactLine, SphereContactLine
from .assembly import Assembly
from .audit import Audit, audit
from .forces import particle_forces
from .linear import SingularMatrix
from .load_stepping import Bracket, LoadStep, load_stepping
from .measures import contact_line, measures, vertical_forces, vertical_pull, volume
from .newton import NewtonOptions, NewtonResult, newton
from .options import SolverOptions
from .solution import Solution
from .stability import Stability, stability_of
from .status import Status

log = logging.getLogger("iga_membrane")


@dataclass(frozen=True)
class Tolerance:
    """What the audit lets pass; beyond, the status is not a success.

    Attributes
    ----------
    residual : weak form on doubled quadrature.
    volume : relative error of the volume.
    force : vertical balance of the drop.
    line : the same from the spline's own contact angle.
    angle : error of the mean cosine of the contact angle.
    penetration : depth below a plane over the scene's length.
    indentation : depth in a sphere over its radius; an edge lies on it only in the mean.
    """

    residual: float = 1e-3
    volume: float = 1e-4
    force: float = 1e-3
    line: float = 2e-2
    angle: float = 2e-2
    penetration: float = 1e-6
    indentation: float = 1e-2


TOLERANCE = Tolerance()


def solve(
    scene: Scene,
    options: SolverOptions | None = None,
    *,
    on_fail: Literal["raise", "return"] = "raise",
    report: Callable[[float], None] = lambda load: None,
) -> Solution:
    """Find the equilibrium of a scene.

    Direct Newton from the scene's start; if that fails or ends unstable, load stepping along the
    scene's ramp. The state is then measured, its stability decided and audited on an independent
    path.

    Parameters
    ----------
    options : tolerances and limits.
    on_fail : "raise" a :class:`SolveError` that carries the solution, or "return" it.
    report : called with every load reached, for progress.

    Raises
    ------
    SceneError
        Before any work, if the scene is ill-posed or too large for the memory allowed.
    SolveError
        If the status is not ``CONVERGED_STABLE`` and ``on_fail`` is "raise".
    """
    options = options or SolverOptions()
    started = process_time()
    _check_memory(scene, options)
    assembly = Assembly(scene, options.quadrature)
    settings = NewtonOptions(
        options.max_iterations, options.tolerance, deadline=started + options.max_cpu_s
    )
    outcome = _iterate(scene, assembly, settings, options, report)
    assembly.load(outcome.scene)
    solution = _conclude(outcome, assembly, options, started)
    solution = replace(solution, scene=scene)
    log.debug("%s: %s", solution.status.name, solution.message)
    if not solution.success and on_fail == "raise":
        raise SolveError(f"{solution.status.name}: {solution.message}", solution)
    return solution


def _check_memory(scene: Scene, options: SolverOptions) -> None:
    """Tables, blocks and factors, from counts; refuse before allocating any."""
    space = scene.surface.space
    elements = space.elements / scene.sector.copies
    local = space.functions.shape[1]
    points = options.quadrature**2 if options.quadrature else local
    need = 8.0 * elements * (14.0 * points * local + 6.0 * local**2)
    need += 4e3 * space.count / scene.sector.copies
    if need > options.max_memory_gb * 1e9:
        raise SceneError(
            f"solver.max_memory_gb = {options.max_memory_gb:g}: this mesh needs about "
            f"{need / 1e9:.1f} GB; raise the limit or choose fewer elements"
        )


@dataclass(frozen=True, eq=False)
class _Outcome:
    """What the iteration reached: ``scene`` is not the one asked for if a path stopped early."""

    scene: Scene
    result: NewtonResult
    steps: list[LoadStep]
    bracket: Bracket | None = None


def _iterate(
    scene: Scene,
    assembly: Assembly,
    settings: NewtonOptions,
    options: SolverOptions,
    report: Callable[[float], None],
) -> _Outcome:
    """Direct Newton; load stepping where it failed or ended on a saddle; at last the nearest
    equilibrium of any kind, to tell an unstable state from none."""
    start, grading = scene.local_surface(), _grading(scene)
    direct = newton(assembly, start, None, grading, settings)
    steps = [LoadStep(1.0, len(direct.iterations), direct.status)]
    if direct.status is Status.INTERRUPTED or (direct.status is None and direct.index <= 0):
        return _Outcome(scene, direct, steps)
    outcome = _Outcome(scene, direct, steps)
    if scene.ramp is not None:
        log.info("direct solve failed (%s): load stepping", direct.message or "unstable")
        path = load_stepping(scene.ramp, assembly, settings, options.min_load_step, report)
        path.result.linear_seconds += direct.linear_seconds
        steps = steps + path.steps
        if path.result.status is None:
            return _Outcome(path.scene, path.result, steps)
        partial = path.last_good > 0 and direct.status is not None
        outcome = _Outcome(scene, direct, steps)
        if partial:
            outcome = _Outcome(path.scene, path.result, steps, path.bracket)
    if direct.status is not None and outcome.bracket is None:
        assembly.load(scene)
        nearest = newton(assembly, start, None, grading, replace(settings, near=np.inf))
        steps = [*steps, LoadStep(1.0, len(nearest.iterations), nearest.status)]
        if nearest.status is None:
            return _Outcome(scene, nearest, steps)
        if nearest.status is Status.INTERRUPTED:
            outcome.result.status, outcome.result.message = nearest.status, nearest.message
        outcome = replace(outcome, steps=steps)
    return outcome


def _grading(scene: Scene) -> Grading | None:
    return scene.grading if scene.surface.space.bases[0].periodic else None


def _conclude(
    outcome: _Outcome, assembly: Assembly, options: SolverOptions, started: float
) -> Solution:
    """Measure, judge and record a state."""
    scene, result = outcome.scene, outcome.result
    surface, multipliers = result.surface, result.multipliers
    verdict, checked = None, None
    status, message = result.status, result.message
    if status is None:
        try:
            verdict = stability_of(assembly, surface, multipliers)
        except (SingularMatrix, np.linalg.LinAlgError) as error:
            status, message = Status.CONVERGED_MARGINAL, f"no stability verdict: {error}"
    if status is None and options.audit:
        motion = assembly.spines.on(surface)
        body = assembly.density(multipliers)
        load = assembly.line_load(multipliers)
        checked = audit(scene, surface, motion, body, load, assembly.points)
    hold = _hold_force(scene, assembly, surface, multipliers)
    if status is None:
        assert verdict is not None
        inside = volume(assembly, surface)
        status, message = _judge(scene, verdict, checked, inside)
    scale = scene.units
    found = measures(scene, assembly, surface, multipliers)
    with_particle = scene.kind == "liquid_sheet"
    total = process_time() - started - assembly.compile_seconds
    return Solution(
        scene=scene,
        status=status,
        message=message,
        surface=surface.moved(scale.to_world(surface.points)),
        measures=found,
        forces=particle_forces(scene, found, scene.particle_pull) if with_particle else None,
        multipliers=_named(assembly, multipliers, scale.pressure, scale.length),
        body=assembly.density(multipliers),
        index=verdict.index if verdict else None,
        lambda_min=verdict.smallest * scale.tension / scale.length**2 if verdict else None,
        audit=checked,
        hold_force=hold,
        contact=_contact(scene, assembly, result, found, checked),
        unknowns=assembly.size,
        iterations=tuple(result.iterations),
        load_steps=tuple(outcome.steps),
        bracket=outcome.bracket,
        cpu_seconds={
            "compile": assembly.compile_seconds,
            "assembly": assembly.seconds,
            "linear": result.linear_seconds,
            "contact": 0.0,
            "solve": total,
        },
        warnings=_warnings(scene),
    )


def _hold_force(
    scene: Scene, assembly: Assembly, surface: Surface, multipliers: Array
) -> tuple[float, float, float]:
    """World vector of the force with which the centroid constraints act on the liquid."""
    local = np.zeros(3)
    inside = volume(assembly, surface)
    for term, multiplier in zip(assembly.constraints, multipliers, strict=False):
        if isinstance(term, Centroid):
            local["xyz".index(term.axis)] = multiplier * inside
    x, y, z = (float(f) for f in scene.units.axes @ local * scene.units.force)
    return x, y, z


def _unheld(scene: Scene) -> str:
    """Axes along which nothing but the computation holds the membrane."""
    return "".join(axis for axis in scene.loose_axes if axis not in scene.hold)


def _judge(
    scene: Scene, verdict: Stability, checked: Audit | None, inside: float
) -> tuple[Status, str]:
    """Status of a converged state."""
    slipping = {a: f for a, f in scene.lateral_load.items() if a in _unheld(scene)}
    if slipping:
        pull = float(np.linalg.norm(list(slipping.values())))
        force = pull * inside * scene.units.force
        return Status.NO_EQUILIBRIUM, (
            f"nothing balances a tangential force of {force:.6g}: a smooth plane holds no droplet "
            'against it; hold the centroid (droplet.hold = "xy") or level the plane'
        )
    if checked is not None:
        found = _defect(checked, isinstance(scene.substrate, Sphere))
        if found is not None:
            return found
    if verdict.index > 0 and verdict.smallest < 0:
        return Status.CONVERGED_SADDLE, (
            f"equilibrium, but unstable: {verdict.index} motion(s) lower the energy (eigenvalue "
            f"{verdict.smallest:.3g}); disturb the start to leave it"
        )
    pinned = {t.axis for t in scene.terms if isinstance(t, Centroid)}
    neutral = [axis for axis in scene.loose_axes if axis not in pinned]
    if neutral:
        return Status.CONVERGED_MARGINAL, (
            f"equilibrium, but free to slide along {', '.join(neutral)}; add a Centroid there or "
            "take a symmetric model"
        )
    if verdict.marginal or verdict.index > 0:
        return Status.CONVERGED_MARGINAL, (
            f"equilibrium, but the smallest eigenvalue {verdict.smallest:.1e} is below its own "
            f"error {verdict.error:.1e}"
        )
    if checked is None:
        return Status.UNVERIFIED, "converged and stable; the audit was switched off"
    return Status.CONVERGED_STABLE, "converged, audited and stable"


def _defect(checked: Audit, curved: bool) -> tuple[Status, str] | None:
    """The audit's objection, or None."""
    limit = TOLERANCE
    if not checked.penetration <= (limit.indentation if curved else limit.penetration):
        return Status.PENETRATION, (
            f"the membrane lies up to {checked.penetration:.1e} "
            f"{'radii inside' if curved else 'lengths below'} the substrate"
        )
    for what, value, most in (
        ("residual on doubled quadrature", checked.residual, limit.residual),
        ("volume error", checked.volume, limit.volume),
        ("vertical force balance", checked.force, limit.force),
        ("force balance at the contact line", checked.line, limit.line),
        ("error of the contact angle's cosine", abs(checked.angle), limit.angle),
    ):
        if not value <= most:
            return Status.UNDERRESOLVED, (
                f"the audit's {what} is {value:.1e} (allowed {most:.0e}): take more "
                "discretization.elements or a higher degree"
            )
    return None


def _contact(
    scene: Scene,
    assembly: Assembly,
    result: NewtonResult,
    found: Mapping[str, float],
    checked: Audit | None,
) -> dict[str, float | None]:
    """Contact with the substrate, by the names of the result file."""
    surface, scale = result.surface, scene.units
    line = next((t for t in scene.local_terms() if isinstance(t, LineTerm)), None)
    if line is None:
        return {}
    unit = scale.length
    if isinstance(line, PlaneContactLine):
        body = assembly.density(result.multipliers)
        at = contact_line(surface, line.edge)
        forces = vertical_forces(at, body, line.gamma, line.contact_angle)
        support = forces.push - forces.line
    else:
        support = -vertical_pull(assembly, surface, result.multipliers)[0]
    if isinstance(line, SphereContactLine):
        unit *= line.sphere.radius
    rim = found.get("contact_radius", float(np.sqrt(found["A_wet"] / np.pi)))
    return {
        "wet_solids": 1,
        "wet_area": found["A_wet"],
        "wet_fraction": found["A_wet"] / (np.pi * rim**2),
        "max_penetration": checked.penetration * unit if checked else None,
        "support_force": support * scale.force,
    }


def _named(
    assembly: Assembly, multipliers: Array, pressure: float, length: float
) -> dict[str, float]:
    return {
        term.name: float(m) * pressure / (length if isinstance(term, Centroid) else 1.0)
        for term, m in zip(assembly.constraints, multipliers, strict=False)
    }


def _warnings(scene: Scene) -> tuple[str, ...]:
    pinned = [t.axis for t in scene.terms if isinstance(t, Centroid) and t.axis not in scene.hold]
    texts = list(scene.warnings)
    if pinned:
        texts.append(
            f"neutral rigid translations along {', '.join(pinned)} are pinned by holding the "
            "centroid"
        )
    return tuple(texts)
