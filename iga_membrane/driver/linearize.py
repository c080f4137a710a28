"""The linearization of a solution as scipy's matrices, for solvers and studies of one's own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..assembly.lagrangian import TINY, Assembly
from ..dofs.spines import Motion
from ..errors import SceneError
from ..overview import brief_repr
from ..problems.scene import Scene
from .solution import Solution

BALANCED = 1e-5
"""Residual over the sum of the sizes of all forces up to which the matrices are those of the
solution: solutions have 1e-9 and less. Where more is left, something else acts."""


@dataclass(frozen=True, eq=False)
class Linearization:
    """Second-order model of a body's energy about a solution, in the user's units.

    ``E(s) = E + g.s + s.K.s / 2`` with ``g = r + B @ multipliers``, of the whole body for motions
    with the symmetry of the computed part. ``K, r, B = linearize(solution)`` unpacks the first
    three.

    Attributes
    ----------
    K : (n, n) sparse, symmetric: Hessian of the energy minus multipliers times constraints, a force
        per length.
    r : (n,) out-of-balance forces, zero at equilibrium.
    B : (n, m) sparse: gradients of the constraints.
    T : (3 c, n) sparse: displacements of the c control points, ``(T @ s).reshape(-1, 3)`` in world
        axes. Unknown k moves the points that have entries in column k: a point along its normal
        (its "spine"), one on a plane along it, mirror images and joined points together; points
        without an entry are fixed.
    multipliers : (m,) of the constraints; names : of the multipliers, "volume" first where there is
        one.
    """

    K: Any
    r: Array
    B: Any
    T: Any
    multipliers: Array
    names: tuple[str, ...]

    __repr__ = brief_repr

    def __iter__(self) -> Iterator[Any]:
        return iter((self.K, self.r, self.B))


@checked()
def linearize(solution: Solution) -> Linearization:
    """Stiffness, residual and constraints of a solution.

    Parameters
    ----------
    solution : converged or not, with contact lines or without; of the whole body with
        ``Discretization(model="full")``, else for motions with the symmetry of the model.

    Returns
    -------
    Linearization
        ``K, r, B`` and the numbering of their unknowns.

    Raises
    ------
    SceneError
        A body that lies on its solid: contact areas have unknowns that are no motions.

    Examples
    --------
    A Newton step with the volume held:

    >>> import iga_membrane as iga
    >>> from scipy.sparse import block_array
    >>> from scipy.sparse.linalg import spsolve
    >>> import numpy as np
    >>> mesh = iga.Discretization(elements=4, degree=3)
    >>> drop = iga.solve(iga.sessile_droplet(iga.Plane(90), volume=1.0, discretization=mesh))
    >>> K, r, B = iga.linearize(drop)
    >>> system = block_array([[K, -B], [-B.T, None]], format="csc")
    >>> step = spsolve(system, np.append(-r, np.zeros(B.shape[1])))[: len(r)]
    >>> bool(abs(step).max() < 1e-7)
    True
    """
    from scipy.sparse import csc_array

    scene = solution.scene
    assembly = Assembly(scene)
    if assembly.contact.lies or scene.free_edge:
        raise SceneError(
            "linearize: the body lies on its solid, and contact areas have unknowns that are no "
            "motions; take a scene with contact lines"
        )
    surface = solution.surface.moved(scene.units.to_local(solution.surface.points))
    motion = assembly.motion(surface)
    gradient, columns = assembly.forces(surface, motion.directions)
    multipliers = np.linalg.lstsq(columns, gradient, rcond=None)[0]
    system = assembly.system(surface, motion.directions, multipliers)
    residual = system.residual(multipliers)
    if solution.success and np.linalg.norm(residual) > BALANCED * max(system.scale, TINY):
        raise SceneError(
            "linearize: forces act on this body that are no motions' nor constraints'; take a "
            "scene without contact areas"
        )
    unit, whole = scene.units, assembly.copies
    held = _units(scene, assembly, len(multipliers))
    matrix = system.matrix.dense() if system.matrix.pattern is None else _sparse(system.matrix)
    return Linearization(
        csc_array(matrix) * (unit.tension * whole),
        residual * (unit.force * whole),
        csc_array(system.constraint_gradients * (whole * unit.force / held)),
        _displacements(motion, scene, surface.space.count),
        multipliers * held,
        _names(assembly, len(multipliers)),
    )


def _sparse(matrix: Any) -> Any:
    """All of a matrix whose last unknowns couple with all others."""
    from scipy.sparse import block_array, csc_array

    first = matrix.pattern.size
    if first == matrix.size:
        return matrix.sparse()
    corner = csc_array(matrix.full[first:])
    return block_array([[matrix.sparse(), matrix.full[:first]], [matrix.full[:first].T, corner]])


def _units(scene: Scene, assembly: Assembly, count: int) -> Array:
    """(m,) units of the multipliers: of a volume a pressure, of a moment that per length, of all
    others a force."""
    unit = scene.units
    found = np.full(count, unit.force)
    for k, density in enumerate(assembly.held):
        found[k] = unit.pressure / (unit.length if any(density.gradient) else 1.0)
    return found


def _names(assembly: Assembly, count: int) -> tuple[str, ...]:
    """Of the constraints, and numbers of the others."""
    named = [term.name for term in assembly.constraints]
    return (*named, *(f"hold {k}" for k in range(count - len(named))))


def _displacements(motion: Motion, scene: Scene, count: int) -> Any:
    """(3 count, n) displacements of the control points by the unknowns, in world axes."""
    from scipy.sparse import csc_array

    shifts = len(motion.shifts)
    own = len(motion.points) - shifts
    free = np.flatnonzero(motion.unknowns[:own] >= 0)
    points, unknowns = motion.points[free], motion.unknowns[free]
    moves = motion.directions[free] @ scene.units.axes.T
    rows = [3 * points + axis for axis in range(3)]
    columns, values = [unknowns] * 3, list(moves.T)
    for k, shift in enumerate(motion.shifts @ scene.units.axes.T):
        for axis in range(3):
            rows.append(3 * np.arange(count) + axis)
            columns.append(np.full(count, motion.size - shifts + k))
            values.append(motion.share * shift[axis])
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return csc_array(entries, shape=(3 * count, motion.size))
