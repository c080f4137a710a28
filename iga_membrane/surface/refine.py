"""Finer spaces for the same surface: knot insertion and degree elevation, geometry unchanged."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array
from ..checks import array, integer
from ..errors import SceneError
from ..splines import Basis, bspline_basis, insertion_matrix, tensor_space
from .surface import Surface


@checked(new1=partial(array, shape=(None,)), new2=partial(array, shape=(None,)))
def refined(surface: Surface, new1: ArrayLike = (), new2: ArrayLike = ()) -> Surface:
    """Insert knots in the two directions (Boehm); the surface stays the same.

    Parameters
    ----------
    surface : of an open tensor-product B-spline or NURBS space.
    new1, new2 : knots to insert.

    Raises
    ------
    SceneError
        For a Lagrange, periodic or polar space, or a knot outside of the patch.
    """
    bases, operators = [], []
    both = (("new1", new1), ("new2", new2))
    for basis, (name, new) in zip(_open_bases(surface), both, strict=True):
        assert basis.knots is not None
        first, last = basis.knots[[0, -1]]
        outside = [float(t) for t in np.ravel(new) if not first < t < last]
        if outside:
            raise SceneError(
                f"{name} = {outside[0]!r}: a new knot must lie inside the patch, between "
                f"{first:g} and {last:g}"
            )
        knots, matrix = insertion_matrix(basis.knots, basis.degree, new)
        bases.append(bspline_basis(knots, basis.degree, continuity=0))
        operators.append(matrix)
    return _carried(surface, bases, operators)


@checked(by=partial(integer, least=0, most=8))
def elevated(surface: Surface, by: int = 1) -> Surface:
    """Raise the degree in both directions, keeping the smoothness; the surface stays the same.

    Parameters
    ----------
    surface : on clamped B-splines in both directions.
    by : degrees to add, >= 0.
    """
    bases, operators = [], []
    for basis in _open_bases(surface):
        assert basis.knots is not None
        values, counts = np.unique(basis.knots, return_counts=True)
        knots = np.repeat(values, counts + by)
        finer = bspline_basis(knots, basis.degree + by, continuity=0)
        # the finer space holds the old functions, so interpolation is exact
        t = finer.abscissae
        bases.append(finer)
        operators.append(np.linalg.solve(finer.matrix(t), basis.matrix(t)))
    return _carried(surface, bases, operators)


def _open_bases(surface: Surface) -> tuple[Basis, Basis]:
    space = surface.space
    if space.pole is not None or any(basis.knots is None for basis in space.bases):
        raise SceneError(
            "refine: needs an open B-spline or NURBS surface; build a ring, polar or lagrange "
            "surface anew with more elements"
        )
    return space.bases


def _carried(surface: Surface, bases: Sequence[Basis], operators: list[Array]) -> Surface:
    """Homogeneous control points in the finer space."""
    space, net = surface.space, surface.net
    weights = np.ones(space.net_shape) if space.weights is None else space.weights
    homogeneous = np.concatenate([net * weights[..., None], weights[..., None]], axis=-1)
    fine = np.einsum("ai,bj,ijc->abc", *operators, homogeneous)
    product = tensor_space(bases[0], bases[1], None if space.weights is None else fine[..., 3])
    return Surface(product, (fine[..., :3] / fine[..., 3:]).reshape(-1, 3))
