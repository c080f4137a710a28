"""Stability of an equilibrium: eigenvalues of the second variation on normal motion.

The problem is ``K v = lambda M v`` on the null space of the constraints, ``M`` being the mass
matrix of normal displacement, so ``lambda`` is an energy per area and squared length and does not
depend on the mesh. The index comes from the inertia of a factorization (Sylvester), the smallest
eigenvalue from inverse iteration: two ways that must agree.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..deadline import check_time
from ..surface.surface import Surface
from .assembly import Assembly
from .linear import Bordered, Matrix


@dataclass(frozen=True, eq=False)
class Stability:
    """Verdict on an equilibrium.

    Attributes
    ----------
    index : number of negative eigenvalues.
    smallest : eigenvalue of smallest magnitude, negative if the index is not 0.
    error : how far ``smallest`` still moved in the last iteration.
    mode : (n,) its motion of the unknowns.
    """

    index: int
    smallest: float
    error: float
    mode: Array

    @property
    def marginal(self) -> bool:
        """Whether the sign of the smallest eigenvalue is undecided."""
        return abs(self.smallest) <= self.error


def stability_of(assembly: Assembly, surface: Surface, multipliers: Array) -> Stability:
    """Stability of a state in the scene's scale.

    Raises
    ------
    SingularMatrix
        If the Hessian cannot be factorized.
    """
    directions = assembly.motion(surface).directions
    system = assembly.system(surface, directions, multipliers)
    border = system.constraint_gradients
    factor = Bordered(system.matrix, border)
    return stability(system.matrix, assembly.mass(surface, directions), border, factor)


def stability(
    matrix: Matrix, mass: Matrix, border: Array, factor: Bordered, *, block: int = 4
) -> Stability:
    """Index and critical eigenvalue by inverse subspace iteration.

    Parameters
    ----------
    matrix, mass : K and M; border : (n, m) constraint gradients.
    factor : factorization of the bordered matrix without shift.
    """
    n, m = border.shape
    width = min(block, n - m)
    start = np.random.default_rng(0).standard_normal((n, width))
    vectors = _inverse(factor, start, m)
    smallest, error = np.inf, np.inf
    for _ in range(40):
        check_time()
        vectors = _inverse(factor, np.column_stack([mass @ v for v in vectors.T]), m)
        vectors, _ = np.linalg.qr(vectors)
        k = vectors.T @ np.column_stack([matrix @ v for v in vectors.T])
        g = vectors.T @ np.column_stack([mass @ v for v in vectors.T])
        low = np.linalg.cholesky(g)
        reduced = np.linalg.solve(low, np.linalg.solve(low, k).T)
        values, modes = np.linalg.eigh(0.5 * (reduced + reduced.T))
        vectors = vectors @ np.linalg.solve(low.T, modes)
        critical = 0 if factor.index else int(np.abs(values).argmin())
        error, smallest = abs(float(values[critical]) - smallest), float(values[critical])
        if error <= 1e-6 * abs(smallest):
            break
    return Stability(factor.index, smallest, error, vectors[:, critical])


def _inverse(factor: Bordered, columns: Array, m: int) -> Array:
    zero = np.zeros(m)
    return np.column_stack([factor.solve(column, zero)[0] for column in columns.T])
