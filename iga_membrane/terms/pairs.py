"""Second variations by pairs of control points, for elements that share their functions.

The second variation of an energy of position and tangents is at every point a quadratic form of
``u_,0 = u``, ``u_,1`` and ``u_,2``. For control points A and B it is ``K_AB = S_AB + [k_AB]x``: six
numbers of a symmetric matrix and three of a skew one, sums over the points of

    S_AB = (N_A,a N_B,b + N_A,b N_B,a) S^ab,  a <= b (once where a = b)
    k_AB = (N_A,a N_B,b - N_A,b N_B,a) k^ab,  a < b

with coefficients S^ab, k^ab that know nothing of the functions. Products of functions are the same
for all elements that share them, so the sums are a few large products of matrices; directions of
motion come in once for each pair of control points, not at every point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index
from ..splines import Table
from .term import BodyDensity
from .variations import ElementPoints, flux, flux_gradient

SYMMETRIC = ((1, 1), (1, 2), (2, 2), (0, 1), (0, 2), (0, 0))
"""Which derivatives a b each row of symmetric coefficients belongs to, ..."""
SKEW = ((1, 2), (0, 1), (0, 2))
"""... and each row of skew ones."""
COMPONENTS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""The six numbers of a symmetric matrix."""
POINTS = 3000
"""Quadrature points that are worked on at a time, so that they stay in the cache."""


@dataclass(frozen=True, eq=False)
class Form:
    """Coefficients of a second variation at quadrature points, their weights included.

    Attributes
    ----------
    symmetric : (6, elements, a, points) of the first ``a`` pairs in :data:`SYMMETRIC`.
    skew : (3, elements, b, points) of the first ``b`` pairs in :data:`SKEW`.
    """

    symmetric: Array
    skew: Array


def liquid(weights: Array, at: ElementPoints, tension: float, body: BodyDensity) -> Form:
    """Form of ``tension * area + body``; see :mod:`.variations`."""
    some, steep = body != BodyDensity(), any(body.gradient)
    elements, points = weights.shape
    symmetric = np.zeros((6, elements, 3 + 2 * some + steep, points))
    skew = np.zeros((3, elements, 1 + 2 * some, points))
    normal = components(at.c) / at.area
    # gamma J a^ab n (x) n + [gamma n + Q e_z]x
    scale = tension * weights / at.area
    metric = contravariant(at, scale)
    for k, (i, j) in enumerate(COMPONENTS):
        both = normal[i] * normal[j]
        for row, m in enumerate(metric):
            np.multiply(m, both, out=symmetric[k, :, row])
    skew[:, :, 0] = tension * weights * normal
    if some:
        skew[2, :, 0] += weights * flux(body, at.x)
        slope = components(flux_gradient(body, at.x)) * weights
        # (grad Q . u) (u'_,1 x a_2 + a_1 x u'_,2)_z = (grad Q . u) (b_1 . u'_,1 + b_2 . u'_,2)
        for row, a, sign in ((1, at.a2, 0.5), (2, at.a1, -0.5)):
            x, y = sign * a[..., 1], -sign * a[..., 0]
            symmetric[4, :, 2 + row], symmetric[5, :, 2 + row] = slope[2] * x, slope[2] * y
            skew[0, :, row], skew[1, :, row] = -slope[2] * y, slope[2] * x
            if steep:
                symmetric[0, :, 2 + row] = 2.0 * slope[0] * x
                symmetric[1, :, 2 + row] = 2.0 * slope[1] * y
                symmetric[3, :, 2 + row] = slope[0] * y + slope[1] * x
                skew[2, :, row] = slope[0] * y - slope[1] * x
    if steep:
        lift = weights * at.c[..., 2]
        for k, e in zip((4, 5, 2), body.gradient, strict=True):
            symmetric[k, :, 5] = e * lift
    return Form(symmetric, skew)


def components(vectors: Array) -> Array:
    """(3, elements, points) of vectors (elements, points, 3), each in one piece of memory."""
    return np.ascontiguousarray(np.moveaxis(vectors, -1, 0))


def contravariant(at: ElementPoints, scale: Array) -> tuple[Array, Array, Array]:
    """``a^11, a^12, a^22`` times ``J^2`` and a scale."""
    pairs = ((at.a2, at.a2), (at.a1, at.a2), (at.a1, at.a1))
    one, mixed, two = (np.einsum("eqi,eqi->eq", a, b) for a, b in pairs)
    return one * scale, -mixed * scale, two * scale


def hessian(table: Table, form: Callable[[Index], Form]) -> Array:
    """Second variation by pairs of control points.

    Parameters
    ----------
    form : coefficients of some elements, by their numbers.

    Returns
    -------
    (9, elements, pairs)
        The numbers of S as in :data:`COMPONENTS`, then k, for local functions A <= B in the order
        of ``numpy.triu_indices``; half of them for A = B, so that all pairs with their transposes
        add up to the whole.
    """
    elements, local = table.functions.shape
    out = np.empty((9, elements, local * (local + 1) // 2))
    for alike in _chunks(table):
        some = alike.ravel()
        at = form(some)
        rows = [row[alike[:, 0]] for row in (table.values, table.d1, table.d2)]
        for first, coefficients, pairs in ((0, at.symmetric, SYMMETRIC), (6, at.skew, SKEW)):
            products = _products(rows, pairs[: coefficients.shape[2]])
            numbers = coefficients.reshape(len(coefficients), *alike.shape, -1) @ products
            out[first : first + len(numbers), some] = numbers.reshape(len(numbers), len(some), -1)
    return out


def _products(rows: list[Array], pairs: tuple[tuple[int, int], ...]) -> Array:
    """(kinds, a points, pairs) products of functions; the skew ones have no pair (1, 1)."""
    a, b = np.triu_indices(rows[0].shape[-1])
    sign = 1.0 if pairs[0] == (1, 1) else -1.0
    products = []
    for i, j in pairs:
        one = rows[i][..., a] * rows[j][..., b]
        products.append(one if i == j else one + sign * rows[j][..., a] * rows[i][..., b])
    return np.concatenate(products, axis=1) * np.where(a == b, 0.5, 1.0)


def _chunks(table: Table) -> Iterator[Index]:
    """Elements (kinds, n) that share their functions along the second axis."""
    points = table.weights.shape[1]
    for alike in table.alike:
        kinds = max(1, POINTS // (points * alike.shape[1]))
        wide = max(1, POINTS // points)
        for k in range(0, len(alike), kinds):
            for n in range(0, alike.shape[1], wide):
                yield alike[k : k + kinds, n : n + wide]
