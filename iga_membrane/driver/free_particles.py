"""Free particles: where the forces along their lines vanish.

With the membrane in equilibrium at every place, the forces are minus the slope of the energy by the
displacements alone. Their root is found by Newton's method on that reduced energy, its second
derivatives by differences, then by Broyden's updates; steps follow the forces downhill, so that an
unstable place is left. The whole is stable where the membrane is and the reduced energy has a
minimum.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..arrays import Array, Mask
from ..problems.scene import FreeParticles, Scene
from ..solvers.load_path import Bracket
from ..status import Status
from .solution import Solution, with_effort

BALANCED = 1e-8
"""Force over tension times radius that counts as none."""
PROBE = 1e-3
"""Displacement over the radius by which slopes are found."""
STEP, SHORTEST = 0.25, 1e-3
"""Displacement over the radius in one step at most, and below which a failed one is given up."""
TRIES = 60
LOST = frozenset(Status) - {Status.CONVERGED_STABLE, Status.INTERRUPTED, Status.UNVERIFIED}
"""Ends of a solve, close to a place that was solved, which say that its equilibrium is gone."""


class Places:
    """Equilibria with the particles of a scene fixed somewhere on their lines, each started from
    the nearest one known unless they have a better start.

    Attributes
    ----------
    tried : the displacements (k,) in radii; found : their solutions.
    """

    def __init__(self, free: FreeParticles, solve_fixed: Callable[[Scene], Solution]) -> None:
        self.free = free
        self.tried: list[Array] = []
        self.found: list[Solution] = []
        self._solve_fixed = solve_fixed

    def at(self, place: Array) -> Solution:
        """The solution at displacements (k,), in radii."""
        asked = self.free.scene_at(place * self.free.radii)
        known = [k for k, one in enumerate(self.found) if one.success]
        if known and asked.predictor is None:
            near = min(known, key=lambda k: float(np.linalg.norm(self.tried[k] - place)))
            found = self.found[near]
            # a free droplet's frame turns with its particle
            local = found.scene.units.to_local(found.surface.points)
            start = found.surface.moved(asked.units.to_world(local))
            asked = replace(asked, surface=start, ramp=None)
        self.tried.append(place)
        self.found.append(self._solve_fixed(asked))
        return self.found[-1]

    def ended(self, last: Solution) -> Solution:
        """A solution with the effort of all."""
        return with_effort(last, self.found)


def settled(scene: Scene, solve_fixed: Callable[[Scene], Solution]) -> Solution:
    """The equilibrium of a scene with its free particles.

    Parameters
    ----------
    scene : with free particles.
    solve_fixed : solution of a scene with fixed ones, whatever its status.

    Notes
    -----
    Lengths here are in radii of the particles, forces in tension times radius.
    """
    free = scene.free_particles
    assert free is not None
    places = Places(free, solve_fixed)

    def ended(last: Solution) -> Solution:
        return places.ended(replace(last, scene=replace(last.scene, description=own)))

    own = scene.description
    place, least = np.zeros(len(free.which)), free.least / free.radii
    place = np.maximum(place, least)
    here = places.at(place)
    if not here.success:
        return ended(here)
    slopes: Array | None = None
    for _ in range(TRIES):
        force = forces_along(free, here)
        open_ = ~((place <= least) & (force <= 0.0))
        if np.abs(force[open_]).max(initial=0.0) <= BALANCED:
            if not open_.any():
                return ended(here)
            slopes = _slopes(free, place, force, places.at)
            return ended(places.found[-1] if slopes is None else _judged(here, slopes, open_))
        if slopes is None:
            slopes = _slopes(free, place, force, places.at)
            if slopes is None:
                return ended(places.found[-1])
        step = np.zeros_like(place)
        step[open_] = _step(slopes[np.ix_(open_, open_)], force[open_])
        step = np.maximum(place + step, least) - place
        ahead = places.at(place + step)
        while ahead.status in LOST and np.abs(step).max() > SHORTEST:
            step = 0.5 * step
            ahead = places.at(place + step)
        if ahead.status in LOST:
            return ended(_lost(free, ahead, place, step))
        if not ahead.success:
            return ended(ahead)
        change = forces_along(free, ahead) - force
        slopes = slopes + np.outer(change - slopes @ step, step) / (step @ step)
        place, here = place + step, ahead
    return ended(
        replace(
            here,
            status=Status.STALLED,
            message=f"no place without force on the particles was found in {TRIES} moves: start "
            "nearer to it",
        )
    )


def forces_along(free: FreeParticles, solution: Solution) -> Array:
    """(k,) along the lines, over tension times radius."""
    forces = np.array([solution.forces[i].effective for i in free.which])
    along = np.einsum("ki,ki->k", forces, free.lines)
    return np.asarray(along / (free.tension * free.radii))


def _slopes(
    free: FreeParticles, place: Array, force: Array, at: Callable[[Array], Solution]
) -> Array | None:
    """(k, k) derivative of the forces by the displacements; None where a solve failed."""
    columns = []
    for probe in PROBE * np.eye(len(place)):
        beside = at(place + probe)
        if not beside.success:
            return None
        columns.append((forces_along(free, beside) - force) / PROBE)
    return np.array(columns).T


def _step(slopes: Array, force: Array) -> Array:
    """Newton's step, downhill also where the energy is no minimum, and limited."""
    stiffness, modes = np.linalg.eigh(-0.5 * (slopes + slopes.T))
    size = np.maximum(np.abs(stiffness), np.abs(force).max() * 1e-6)
    step = modes @ ((modes.T @ force) / size)
    return np.asarray(step * min(1.0, STEP / np.abs(step).max()))


def _judged(solution: Solution, slopes: Array, open_: Mask) -> Solution:
    """With the particles' share of the stability index."""
    own = slopes[np.ix_(open_, open_)]
    falling = int((np.linalg.eigvalsh(-0.5 * (own + own.T)) <= 0).sum())
    if not falling:
        return solution
    return replace(
        solution,
        status=Status.CONVERGED_SADDLE,
        index=(solution.index or 0) + falling,
        message="the particles are in balance but would leave it",
    )


def _lost(free: FreeParticles, ahead: Solution, place: Array, step: Array) -> Solution:
    """Where a particle moved until its equilibrium was lost."""
    first = int(np.abs(step).argmax())
    number, out = int(free.which[first]), float(free.outward[first] * step[first])
    kind = "detached" if out > 0 else "engulfed"
    lo, hi = (float(w[first] * free.radii[first]) for w in (place, place + step))
    bracket = Bracket(f"particle[{number}] displacement", lo, hi, 0, ahead.index or 0)
    way = "out of" if out > 0 else "into"
    return replace(
        ahead,
        status=Status.TOPOLOGY_CHANGE,
        kind=kind,
        bracket=bracket,
        message=f"the forces move particle[{number}] {way} the liquid to displacement {lo:.6g}, "
        f"beyond which nothing holds it ({ahead.message})",
    )
