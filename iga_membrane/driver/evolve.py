"""Evolution with memory: a droplet whose contact line stays, advances and recedes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from time import thread_time
from typing import Any, Literal

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..checks import items, number, record
from ..deadline import until
from ..errors import SceneError, SolveError
from ..own import begin, called
from ..problems.scene import Scene
from ..results.contact_line import contact_line
from ..solids.hysteresis import Hysteresis
from ..solvers.load_path import LoadStep
from ..solvers.newton import newton
from ..solvers.options import SolverOptions
from ..solvers.predictor import settings_of
from ..surface.surface import Surface
from ..terms import PlaneContactLine
from ..terms.line_friction import LineFriction
from ..threads import one_thread
from .evaluate import Outcome, conclude
from .solution import Solution, blamed
from .solve import solve
from .trace import Path

EDGE = "xi2=0"
STIFFNESS = 1e3
"""Change of cosine per length of the scene by which a line gives way that stays; each repetition
makes its way a thousandth. 1e2 gives the same with more repetitions; at 1e5 Newton's method
fails."""
REPEATED, STILL = 12, 1e-9
"""How often a step is repeated with the cosines that it came to at most, and the change of cosine
at which it is not: the line has then moved by 1e-11 lengths where it should stay."""


@dataclass(frozen=True, eq=False, repr=False)
@checked()
class Evolution(Path):
    """States along a parameter, each with the memory of the one before.

    Attributes
    ----------
    parameter, values, solutions, end : as of a :class:`.trace.Path`.
    dissipated : (values,) work that the moving line has turned into heat since the first value.
    """

    dissipated: Sequence[float] = ()


@dataclass(frozen=True, eq=False)
class Memory:
    """What a contact line remembers.

    Attributes
    ----------
    surface : the last state, in world coordinates.
    held : (count,) cosines at which its line is held, by control point.
    dissipated : work turned into heat so far.
    """

    surface: Surface
    held: Array
    dissipated: float = 0.0


@checked(values=partial(items, each=number, least=1))
@one_thread
def evolve(
    scene_of: Callable[[float], Scene],
    values: Sequence[float],
    *,
    parameter: str = "parameter",
    options: SolverOptions | None = None,
    on_fail: Literal["raise", "return"] = "raise",
    report: Callable[[float], None] = lambda load: None,
) -> Evolution:
    """Follow a droplet with hysteresis along a parameter; its contact line has memory.

    At the first value the droplet is placed, at the angle ``placed_at`` of its scene. In every step
    from there the line stays where its angle is between the receding and the advancing one of
    ``Plane(contact_angle=Hysteresis(...))``, and moves at one of them elsewhere.

    Parameters
    ----------
    scene_of : value of the parameter to a droplet on a plane with hysteresis, all on one mesh.
    values : one or more; they may repeat and turn back.
    parameter : its name.
    options : tolerances, and limits of the whole evolution.
    on_fail : "raise" a :class:`SolveError` if a step fails, or "return" the states up to there.
    report : called with the part of the values reached.

    Returns
    -------
    Evolution
        A path whose solutions also have the measures ``angle_min``, ``angle_max``, ``angle_front``
        and ``angle_rear`` (degrees, the latter at the line's ends along x), ``width`` and
        ``length`` across and along x, and ``pinned_fraction`` of the line.

    Raises
    ------
    SceneError
        A scene without hysteresis, or not of a droplet on a plane alone.
    SolveError
    """
    asked = [float(value) for value in values]
    options = SolverOptions() if options is None else options
    if options.start is not None or options.checkpoint is not None:
        raise SceneError(
            "solver.start, solver.checkpoint: not available yet in an evolution with memory; leave "
            "them out"
        )
    begin()
    started = thread_time()
    first = record("scene_of(value)", called(scene_of, asked[0]), Scene)
    hysteresis = hysteresis_of(first)
    placed, memory = _placed(first, hysteresis, options)
    reached, heat = [placed], [0.0]
    for k, value in enumerate(asked[1:] if reached[0].success else [], 1):
        scene = record("scene_of(value)", called(scene_of, value), Scene)
        with until(started + options.max_cpu_s):
            solution, memory = _step(scene, memory, first, options, started)
        reached.append(solution)
        if not solution.success:
            break
        heat.append(memory.dissipated)
        report(k / (len(asked) - 1))
    good = [solution for solution in reached if solution.success]
    path = Evolution(parameter, asked[: len(good)], good, blamed(reached[-1]), heat[: len(good)])
    if not path.success and on_fail == "raise":
        raise SolveError(f"{path.end.status.name}: {path.end.message}", path.end)
    return path


def _placed(
    scene: Scene, hysteresis: Hysteresis, options: SolverOptions
) -> tuple[Solution, Memory]:
    """The droplet where it is placed, and what its line remembers."""
    (line,) = scene.by_form.wetting
    assert isinstance(line, PlaneContactLine)
    solution = solve(scene, options, on_fail="return")
    held = np.full(scene.surface.space.count, np.cos(np.radians(line.contact_angle)))
    memory = Memory(solution.surface, held)
    if not solution.success:
        return solution, memory
    return _measured(_by_young(solution, hysteresis), memory, hysteresis), memory


def _by_young(solution: Solution, hysteresis: Hysteresis) -> Solution:
    """A droplet that was placed at an angle, with the energy of the angle of the mean cosine, to
    which work and heat refer."""
    (line,) = solution.scene.by_form.wetting
    assert isinstance(line, PlaneContactLine)
    young = np.cos(np.radians([line.contact_angle, hysteresis.young]))
    found = dict(solution.measures)
    more = line.gamma * float(young[0] - young[1]) * found["A_wet"]
    return replace(
        solution,
        measures=found | {name: found[name] + more for name in ("energy", "E_surf")},
    )


def hysteresis_of(scene: Scene) -> Hysteresis:
    """The hysteresis of a droplet's plane.

    Raises
    ------
    SceneError
    """
    solid = None if scene.recipe is None else scene.recipe.arguments.get("substrate")
    found = getattr(solid, "contact_angle", None)
    if not isinstance(found, Hysteresis):
        raise SceneError(
            "substrate.contact_angle: an evolution with memory needs a Hysteresis(receding, "
            "advancing) on a plane; without one follow the path by trace"
        )
    return found


def _step(
    scene: Scene, memory: Memory, first: Scene, options: SolverOptions, started: float
) -> tuple[Solution, Memory]:
    """The state at a value, and what its line remembers; if it is none, the memory as it was."""
    hysteresis, scale = hysteresis_of(scene), first.units
    (line,) = scene.by_form.wetting
    assert isinstance(line, PlaneContactLine)
    receding, advancing = hysteresis.cosines
    friction = LineFriction(
        line.gamma,
        advancing,
        receding,
        memory.surface.points,
        memory.held,
        STIFFNESS / scale.length,
    )
    rest = [
        term
        for term in scene.terms
        if term not in scene.by_form.wetting and term not in scene.by_form.centroids
    ]
    young = replace(line, contact_angle=hysteresis.young)

    def with_friction(held: Array) -> Scene:
        return replace(
            scene, surface=memory.surface, scale=scale, ramp=None, predictor=None, otherwise=None,
            finer=None, recipe=None, origin=None,
            terms=[*rest, young, replace(friction, held=held)],
        )  # fmt: skip

    now = with_friction(memory.held)
    assembly = Assembly(now, options.quadrature)
    settings = settings_of(now, options, started)
    held, surface, multipliers, count = memory.held, now.local_surface(), None, 0
    for _ in range(REPEATED):
        assembly.load(now)
        result = newton(assembly, surface, multipliers, now.meridian_grading, settings)
        count += len(result.iterations)
        surface, multipliers = result.surface, result.multipliers
        if result.status is not None:
            break
        before, held = held, _held(now, surface)
        if np.abs(held - before).max() <= STILL:
            break
        now = with_friction(held)
    steps = [LoadStep(1.0, count, result.status)]
    solution = conclude(Outcome(now, result, steps), assembly, options, started)
    if not solution.success:
        return replace(solution, scene=scene), memory
    heat = memory.dissipated + _dissipated(now, solution.surface, hysteresis)
    found = solution.measures
    solution = replace(solution, measures={**found, "energy": found["E_surf"] + found["E_grav"]})
    after = Memory(solution.surface, held, heat)
    return _measured(replace(solution, scene=scene), after, hysteresis), after


def _friction(scene: Scene) -> LineFriction:
    (friction,) = (term for term in scene.local_terms().others if term.holds)
    assert isinstance(friction, LineFriction)
    return friction


def _held(scene: Scene, surface: Surface) -> Array:
    """(count,) cosines at which the line is held now, by control point."""
    friction, table = _friction(scene), surface.space.edge_table(EDGE)
    cosines = friction.cosines(table, surface.points)
    which, place = np.unique(table.functions, return_inverse=True)
    rows = np.zeros((cosines.size, len(which)))
    place = place.reshape(table.functions.shape)
    lines = np.arange(cosines.size).reshape(cosines.shape)
    np.add.at(rows, (lines[..., None], place[:, None, :]), table.values)
    held = friction.held.copy()
    held[which] = np.linalg.lstsq(rows, cosines.ravel(), rcond=None)[0]
    return held


def _dissipated(scene: Scene, surface: Surface, hysteresis: Hysteresis) -> float:
    """Work that the line has turned into heat in a step, in the user's units."""
    local = surface.moved(scene.units.to_local(surface.points))
    table = surface.space.edge_table(EDGE)
    at = _friction(scene).swept(table, local.points)
    receding, advancing = hysteresis.cosines
    work = 0.5 * (receding - advancing) * float((np.abs(at) * table.weights).sum())
    return work * scene.units.energy


def _measured(solution: Solution, memory: Memory, hysteresis: Hysteresis) -> Solution:
    """A solution with measures of its line."""
    scene = solution.scene
    local = solution.surface.moved(scene.units.to_local(solution.surface.points))
    line = contact_line(local, EDGE)
    angles, (x, y) = np.degrees(line.angle), line.position[:, :2].T
    table = local.space.edge_table(EDGE, len(line.arc) // local.space.bases[0].elements)
    held = np.einsum("eqa,ea->eq", table.values, memory.held[table.functions]).ravel()
    receding, advancing = hysteresis.cosines
    margin = PINNED * (receding - advancing)
    pinned = (held > advancing + margin) & (held < receding - margin)
    more: dict[str, Any] = {
        "angle_min": float(angles.min()),
        "angle_max": float(angles.max()),
        "angle_front": float(angles[x.argmax()]),
        "angle_rear": float(angles[x.argmin()]),
        "width": float(np.ptp(y)) * scene.units.length,
        "length": float(np.ptp(x)) * scene.units.length,
        "pinned_fraction": float(line.arc[pinned].sum() / line.arc.sum()),
    }
    return replace(solution, measures={**solution.measures, **more})


PINNED = 1e-6
"""Part of the range of cosines within its ends in which a line counts as pinned."""
