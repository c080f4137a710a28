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
from ..problems.scene import FreeParticles, Scene
from ..solids import Sphere
from ..solvers.load_path import Bracket
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
    pull = _Pull(scene, free, SolverOptions() if options is None else options, report)
    here, beyond, lost = pull.search()
    most = pull.largest()
    solutions = [one for one in pull.places.found if one.success]
    order, number = np.argsort(list(pull.held)), int(free.which[0])
    unit, ways = pull.way * pull.radius, sorted(pull.held)
    return PullOff(
        pull.held[most],
        unit * most,
        Bracket(f"particle[{number}] displacement", unit * here, unit * beyond, 0, lost.index or 0),
        "line" if pull.share_of_line(solutions) >= 1.0 - REACHED else "film",
        [unit * w for w in ways],
        [pull.held[w] for w in ways],
        [solutions[k] for k in order],
    )


class _Pull:
    """A particle on its way out of the liquid, along its line.

    Attributes
    ----------
    way : 1 along the line, -1 against it; radius : of the particle.
    places : solves with the particle fixed; held : force that holds it, by its way in radii.
    """

    def __init__(
        self,
        scene: Scene,
        free: FreeParticles,
        options: SolverOptions,
        report: Callable[[float], None],
    ) -> None:
        self.way, self.radius = float(np.sign(free.outward[0])), float(free.radii[0])
        self.held: dict[float, float] = {}
        self._scene, self._free, self._number = scene, free, int(free.which[0])
        self._options, self._report = options, report
        self._until = thread_time() + options.max_cpu_s
        self.places = Places(free, self._solved)

    def _solved(self, at: Scene) -> Solution:
        left = max(self._until - thread_time(), 1e-3)
        return solve(at, replace(self._options, max_cpu_s=left), on_fail="return")

    def at(self, place: float) -> Solution:
        """The solution with the particle at a place, in radii along its way."""
        solution = self.places.at(np.array([self.way * place]))
        if solution.success:
            forces = solution.forces[self._number]
            pull = (forces.effective - forces.weight) @ self._free.lines[0]
            self.held[place] = -self.way * float(pull)
            self._report(place * self.radius)
        elif solution.status not in LOST:
            raise SolveError(f"{solution.status.name}: {solution.message}", solution)
        return solution

    def search(self) -> tuple[float, float, Solution]:
        """The last place that holds the particle, the first that does not, and how that ends."""
        first = self.at(0.0)
        if not first.success:
            raise SolveError(f"{first.status.name}: {first.message}", first)
        here, step = 0.0, FIRST
        last = self.at(step)
        while last.success:
            here, step = here + step, min(1.5 * step, LONGEST)
            if here > FARTHEST:
                raise SolveError(f"the particle does not detach within {FARTHEST:g} radii", last)
            last = self.at(here + step)
        failed, lost = here + step, last
        while failed - here > WIDTH:
            middle = 0.5 * (here + failed)
            last = self.at(middle)
            if last.success:
                here = middle
            else:
                failed, lost = middle, last
        return here, failed, lost

    def largest(self) -> float:
        """The place of the largest force."""
        ways = sorted(self.held)
        most = ways[int(np.argmax([self.held[w] for w in ways]))]
        if not 0.0 < most < ways[-1]:
            return most
        k, poor = ways.index(most), -min(self.held.values())
        found = minimize_scalar(
            lambda place: -self.held[place] if self.at(place).success else poor,
            bounds=(ways[k - 1], ways[k + 1]),
            method="bounded",
            options={"xatol": 1e-2 * (ways[k + 1] - ways[k - 1])},
        )
        return max([most, float(found.x)], key=lambda place: self.held.get(place, -np.inf))

    def share_of_line(self, solutions: Sequence[Solution]) -> float:
        """Largest force of the contact line over the most that a line can have."""
        scene, line = self._scene, self._free.lines[0]
        particle = scene.particles[self._number] if scene.particles else scene.substrate
        assert isinstance(particle, Sphere)
        half = 0.5 * np.radians(particle.contact_angle)
        most = 2.0 * np.pi * self._free.tension * self.radius * float(np.cos(half)) ** 2
        forces = (one.forces[self._number].contact_line for one in solutions)
        return max(-self.way * float(force @ line) for force in forces) / most
