"""Self-check: are the derivatives of a scene's terms those of its energy?

Each term is taken alone with the surface tension, near the scene's start, so that an error belongs
to it: first derivatives against fourth-order differences of the Lagrangian, second ones against
those of the residual, along random motions of the unknowns.

Where contact begins and ends the energy is only once differentiable, and differences across that
are none of a derivative. The shorter the step, the fewer of a surface's points it takes across; a
wrong derivative is as wrong by every step. Of several steps the one with the least error counts.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..assembly.lagrangian import TINY, Assembly
from ..checks import integer, real
from ..problems.scene import Scene
from ..surface.surface import Surface
from ..terms import Term

STEPS = (1e-3, 1e-4, 1e-5)
"""Steps of the differences over the smallest element. Across the edges of contact errors of a
Hessian fall from 1e-3 to 1e-11; by rounding they are 2e-10 with the last."""
OFF = 0.02
"""How far from the start, over the smallest element: a symmetric start hides errors."""
DIRECTIONS = 3


@dataclass(frozen=True)
@checked(gradient=real, hessian=real)
class Derivatives:
    """Relative errors of a term's derivatives.

    Attributes
    ----------
    gradient, hessian : norms of the differences over those of the derivatives.
    """

    gradient: float
    hessian: float

    @property
    def right(self) -> bool:
        """Whether both are the derivatives, up to the differences' own error."""
        return max(self.gradient, self.hessian) < 1e-5


@checked(seed=partial(integer, least=0))
def check_derivatives(scene: Scene, seed: int = 0) -> dict[str, Derivatives]:
    """Compare the derivatives of a scene's energy and constraints with differences, term by term.

    Parameters
    ----------
    scene : with terms of the package or own ones.
    seed : of the random motions.

    Returns
    -------
    Names of the terms' classes, numbered from the second of a class on, to their errors; and
    ``"all terms"`` together. An error of the surface tension is in every term's.
    """
    tension = scene.by_form.surface_tensions
    found: dict[str, Derivatives] = {}
    for term in scene.terms:
        alone = [*(t for t in tension if t is not term), term]
        found[_name(term, found)] = _checked(
            replace(scene, terms=alone, acceleration=(0.0, 0.0, 0.0), origin=None), seed
        )
    found["all terms"] = _checked(scene, seed)
    return found


def _name(term: Term, taken: dict[str, Derivatives]) -> str:
    kind = type(term).__name__
    number = sum(name.split(" ")[0] == kind for name in taken)
    return f"{kind} {number + 1}" if number else kind


def _checked(scene: Scene, seed: int) -> Derivatives:
    """Errors of the derivatives of the whole scene."""
    assembly, surface = Assembly(scene), scene.local_surface()
    rng = np.random.default_rng(seed)
    areas = np.linalg.norm(assembly.energies(surface).area_vectors, axis=-1)
    size = float(np.sqrt((areas * assembly.table.weights).sum(axis=1).min()))
    spines = assembly.spines
    off = spines.on(surface).displacement(rng.uniform(-1.0, 1.0, assembly.size))
    surface = surface.moved(surface.points + OFF * size * off)
    surface = assembly.relaxed(surface, spines.on(surface))
    motion = spines.on(surface)
    multipliers = rng.uniform(0.5, 2.0, assembly.multipliers)
    multipliers[assembly.multipliers - len(spines.shifts) :] = 0.0  # a gauge, not an energy
    system = assembly.system(surface, motion.directions, multipliers)
    gradient = system.residual(multipliers)
    ways = rng.uniform(-1.0, 1.0, (DIRECTIONS, assembly.size))
    ways[:, assembly.contact.idle] = 0.0

    def moved(step: float, way: Array) -> Surface:
        return surface.moved(surface.points + motion.displacement(step * way))

    def lagrangian(step: float, way: Array) -> float:
        energies = assembly.energies(moved(step, way))
        return energies.total - float(multipliers @ energies.constraints)

    def residual(step: float, way: Array) -> Array:
        first, columns = assembly.forces(moved(step, way), motion.directions)
        return np.asarray(first - columns @ multipliers)

    least = TINY + 1e-6 * system.scale * size
    slopes = [gradient @ way for way in ways]
    bends = [system.matrix @ way for way in ways]
    best = Derivatives(np.inf, np.inf)
    for step in STEPS:
        found = [_slope(partial(lagrangian, way=way), step * size) for way in ways]
        turned = [_slope(partial(residual, way=way), step * size) for way in ways]
        best = Derivatives(
            min(best.gradient, _error(found, slopes, least)),
            min(best.hessian, _error(turned, bends, least)),
        )
        if best.right:
            break
    return best


def _slope(value: Callable[[float], Array | float], h: float) -> Array:
    """Fourth-order central difference at 0."""
    near = np.asarray(value(h)) - np.asarray(value(-h))
    far = np.asarray(value(2.0 * h)) - np.asarray(value(-2.0 * h))
    return np.asarray((8.0 * near - far) / (12.0 * h))


def _error(found: Sequence[Array], exact: Sequence[Array], least: float) -> float:
    off = float(np.linalg.norm(np.subtract(found, exact)))
    return off / max(float(np.linalg.norm(exact)), least)
