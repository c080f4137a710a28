"""Roots of the inverse of dense symmetric matrices, with their inertia."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array

VANISHED = 1e-15
"""Eigenvalue over the largest below which a matrix is singular."""
BLOCK = 48
"""Triangular matrices up to this size are inverted as a whole."""


class SingularMatrix(ArithmeticError):
    """The factorization broke down or its solution misses the right-hand side."""


class InverseRoot:
    """H and signs S with ``H F H^T = S``, so that ``F^-1 = H^T S H``.

    H is the inverse of the Cholesky factor; where the matrix is not positive definite it comes from
    the eigenvalues.

    Parameters
    ----------
    upper : (n, n) a finite matrix of which the upper triangle counts.
    inverse : of lower triangular matrices.

    Attributes
    ----------
    h : (n, n).
    signs : (n,), or None where all are positive.
    negative : number of negative eigenvalues.

    Raises
    ------
    SingularMatrix
        If an eigenvalue vanishes.
    """

    def __init__(self, upper: Array, inverse: Callable[[Array], Array] | None = None) -> None:
        self.signs: Array | None = None
        self.negative = 0
        try:
            self.h: Array = (inverse or _inverse)(np.linalg.cholesky(upper.T))
        except np.linalg.LinAlgError:
            values, vectors = np.linalg.eigh(upper, UPLO="U")
            size = np.abs(values)
            if size.min() <= VANISHED * size.max():
                raise SingularMatrix("the matrix is singular") from None
            self.h = vectors.T / np.sqrt(size)[:, None]
            self.signs = np.sign(values)
            self.negative = int((values < 0).sum())

    def signed(self, right: Array) -> Array:
        """``S`` times (n,) or (n, k)."""
        return right if self.signs is None else (self.signs * right.T).T

    def solve(self, right: Array) -> Array:
        """Solution for right-hand sides (n,) or (n, k)."""
        return np.asarray(self.h.T @ self.signed(self.h @ right))


def _inverse(low: Array) -> Array:
    """Inverse of a lower triangular matrix, by halves: nearly all of it products of matrices."""
    n = len(low)
    if n <= BLOCK:
        return np.linalg.inv(low)
    k = n // 2
    out = np.zeros_like(low)
    out[:k, :k], out[k:, k:] = _inverse(low[:k, :k]), _inverse(low[k:, k:])
    out[k:, :k] = -out[k:, k:] @ (low[k:, :k] @ out[:k, :k])
    return out
