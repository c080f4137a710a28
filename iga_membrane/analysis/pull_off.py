"""Pull-off: the largest force with which liquid holds a particle, and where it lets go."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from time import thread_time

import numpy as np
from scipy.optimize import minimize_scalar

from ..arguments import checked
from ..checks import items, real, words
from ..driver.free_particles import LOST, Places
from ..driver.solution import Solution
from ..driver.solve import solve
from ..errors import SceneError, SolveError
from ..problems.scene import Scene
from ..solids import Sphere
from ..solvers.load_stepping import Bracket
from ..solvers.options import SolverOptions

FIRST, LONGEST = 0.05, 0.2
"""Displacement in radii of the first step, and of any."""
WIDTH = 2e-3
"""Width of the bracket of detachment in radii."""
REACHED = 0.01
"""Part of the line's largest force that may be missing where it counts as reached."""
FARTHEST = 50.0
"""Displacement in radii at which the search ends."""


@dataclass(frozen=True, eq=False)
@checked(
    force=real,
    at=real,
    limit=words("line", "film"),
    displacements=partial(items, each=real),
    forces=partial(items, each=real),
)
class PullOff:
    """How liquid holds a particle that is pulled out of it, in the user's units.

    Displacements are along the line of the particle's motion, upwards if it is vertical and out of
    the liquid if it is normal.

    Attributes
    ----------
    force : the largest force against the pull, of membrane and liquid, without the weight.
    at : displacement where it is reached.
    bracket : displacements between which the particle detaches.
    limit : "line", the contact line came to the largest force that it has on a sphere,
        ``2 pi gamma r cos^2(theta / 2)``; "film", the membrane gave way before.
    displacements, forces, solutions : along the way.
    """

    force: float
    at: float
    bracket: Bracket
    limit: str
    displacements: Sequence[float] = field(repr=False)
    forces: Sequence[float] = field(repr=False)
    solutions: Sequence[Solution] = field(repr=False)


@checked()
def pull_off(
    scene: Scene,
    options: SolverOptions | None = None,
    *,
    report: Callable[[float], None] = lambda displacement: None,
) -> PullOff:
    """Pull a particle out of the liquid until it detaches.

    Parameters
    ----------
    scene : with one particle that moves, from where it stands; its motion gives the line.
    options : limits of the whole search.
    report : called with every displacement reached.

    Raises
    ------
    SceneError
        If not exactly one particle moves, or its line does not lead out of the liquid.
    SolveError
        If the particle has no equilibrium where it stands, does not detach, or a limit is reached.
    """
    options = SolverOptions() if options is None else options
    free = scene.free_particles
    if free is None or len(free.which) != 1:
        raise SceneError(
            'particle.motion: exactly one particle must be free to be pulled: set it to "vertical" '
            'or "normal"'
        )
    if abs(free.outward[0]) < 1e-6:
        raise SceneError(
            'particle.motion = "vertical": here that line leads along the liquid\'s surface; '
            'choose "normal"'
        )
    way, number = float(np.sign(free.outward[0])), int(free.which[0])
    until = thread_time() + options.max_cpu_s

    def solve_fixed(at: Scene) -> Solution:
        left = max(until - thread_time(), 1e-3)
        return solve(at, replace(options, max_cpu_s=left), on_fail="return")

    places, radius, line = Places(free, solve_fixed), float(free.radii[0]), free.lines[0]
    held: dict[float, float] = {}

    def pulled(place: float) -> Solution:
        solution = places.at(np.array([way * place]))
        if solution.success:
            forces = solution.forces[number]
            held[place] = -way * float((forces.effective - forces.weight) @ line)
            report(place * radius)
        elif solution.status not in LOST:
            raise SolveError(f"{solution.status.name}: {solution.message}", solution)
        return solution

    first = pulled(0.0)
    if not first.success:
        raise SolveError(f"{first.status.name}: {first.message}", first)
    here, step, failed = 0.0, FIRST, None
    while failed is None or failed - here > WIDTH:
        ahead = here + step if failed is None else 0.5 * (here + failed)
        last = pulled(ahead)
        if last.success:
            here, step = ahead, min(1.5 * step, LONGEST)
        else:
            failed, beyond = ahead, last
        if here > FARTHEST:
            raise SolveError(f"the particle does not detach within {FARTHEST:g} radii", last)
    ways = sorted(held)
    most = ways[int(np.argmax([held[w] for w in ways]))]
    if 0.0 < most < ways[-1]:
        k, poor = ways.index(most), -min(held.values())
        found = minimize_scalar(
            lambda place: -held[place] if pulled(place).success else poor,
            bounds=(ways[k - 1], ways[k + 1]),
            method="bounded",
            options={"xatol": 1e-2 * (ways[k + 1] - ways[k - 1])},
        )
        most = max([most, float(found.x)], key=lambda place: held.get(place, -np.inf))
    ways = sorted(held)
    name = f"particle[{number}] displacement"
    solutions = [one for one in places.found if one.success]
    particle = scene.particles[number] if scene.particles else scene.substrate
    assert isinstance(particle, Sphere)
    half = 0.5 * np.radians(particle.contact_angle)
    most_of_line = 2.0 * np.pi * free.tension * radius * float(np.cos(half)) ** 2
    of_line = max(-way * float(one.forces[number].contact_line @ line) for one in solutions)
    order = np.argsort(list(held))
    return PullOff(
        held[most],
        way * most * radius,
        Bracket(name, way * here * radius, way * failed * radius, 0, beyond.index or 0),
        "line" if of_line >= (1.0 - REACHED) * most_of_line else "film",
        [way * w * radius for w in ways],
        [held[w] for w in ways],
        [solutions[k] for k in order],
    )
