"""A closed surface from one square: its sides are folded at their middles.

The square [-1, 1]^2 is one face of a pillow: the point (1, y) is glued to (1, -y), (x, 1) to
(-x, 1), and so on, which closes the square to a sphere. Splines on equal knots cross the seams as
smoothly as any knot: the coefficient at ``(2 - x, -y)`` is that at ``(x, y)``. Only at the middles
of the sides, where the pillow's corners are, the parametrization turns like ``w = z^2``. There a
spline is even in ``z = u + i v``, so it has one tangent plane if its second derivatives are those
of a linear function of ``w``: ``f_uu + f_vv = 0``. The control points next to the fold obey that.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array, Index
from ..errors import SceneError
from .basis import Basis, uniform_basis
from .ruled import Ruled, combined
from .space import Space, tensor_space

HIGHEST = 4
"""Degree above which the functions at a fold no longer find place on every element."""


def pillow_space(degree: int, elements: int, aspect: float = 1.0) -> Space:
    """Closed space, C1 at its folds too.

    Parameters
    ----------
    degree : 2 to 4.
    elements : from the middle of the square to a side; the square has four times their square.
    aspect : of the elements at a fold, length across the side over length along it: there
        ``f_uu + aspect^2 f_vv = 0``, with ``u`` across the side.

    Raises
    ------
    SceneError
        Another degree.
    """
    if not 2 <= degree <= HIGHEST:
        raise SceneError(f"degree {degree}: a folded patch has degree 2 to {HIGHEST}")
    line = uniform_basis(-1.0, 1.0, 2 * elements, degree)
    flat = tensor_space(line, line)
    owner = _glued(degree, elements, line.count)
    rules = [_rule(line, across, side, aspect) for across in (0, 1) for side in (-1, 1)]
    centres, by, share = (np.concatenate(parts) for parts in zip(*rules, strict=True))
    free = np.setdiff1d(owner, owner[centres])
    numbers = np.full(len(owner), -1)
    numbers[free] = np.arange(len(free))
    shared = numbers[owner]
    # a place at a fold is met again wherever it is glued to
    places = np.flatnonzero(shared < 0)
    which = (owner[places][:, None] == owner[centres]).argmax(axis=1)
    ruled = Ruled(places, shared[by[which]], share[which])
    functions, near, combine = combined(flat.functions, shared, ruled)
    return replace(
        flat,
        functions=functions,
        count=len(free),
        near=near,
        combine=combine,
        shared=shared,
        leaders=free,
        ruled=ruled,
    )


def _rule(line: Basis, across: int, side: int, aspect: float) -> tuple[Index, Index, Array]:
    """Places of the net next to the fold in the middle of a side, the places that each follows, and
    their parts.

    ``f_uu + aspect^2 f_vv`` is a sum over the places round the fold. One in the fold itself (odd
    degrees) follows all others. For even degrees the sum over each quarter of them vanishes by
    itself, and the nearest place follows the others of its own: a place that followed one beyond
    its quarter would be alive on elements that have no slot for that.
    """
    p, middle = line.degree, 0.5 * (line.count - 1)
    fold = 0.5 * (p - 1) + (line.elements if side > 0 else 0)
    value, bend = _at_a_knot(line)
    # places from the fold: along a line through it, or along the sides of each quarter
    steps = [np.arange(-1, 2)] if p % 2 else [0.5 + np.arange(2), -0.5 - np.arange(2)]
    first, by, share = [], [], []
    for along in steps:
        inward = np.abs(along) * -side if len(steps) > 1 else along
        u, v = (middle + inward).astype(int), (middle + along).astype(int)
        weight = np.outer(bend[u], value[v]) + aspect**2 * np.outer(value[u], bend[v])
        pair = (fold + inward).astype(int)[:, None], v[None, :]
        places = pair[across] * line.count + pair[1 - across]
        own = np.abs(inward[:, None]) + np.abs(along) == (np.abs(along).min() * 2)
        others = ~own & (np.abs(weight) > 1e-12 * np.abs(weight).max())  # not by rounding
        first.append(places[own])
        by.append(places[others])
        share.append(-weight[others] / weight[own])
    return np.concatenate(first), np.array(by), np.array(share)


def _at_a_knot(line: Basis) -> tuple[Array, Array]:
    """(n,) values and second derivatives, the mean from both sides, of functions at the middle."""
    half = line.elements // 2
    bend = np.zeros(line.count)
    for e, u in ((half - 1, 1.0), (half, 0.0)):
        second = line.inside(np.array([e]), np.array([[u]]), 2)[0, 0]
        bend[line.functions[e]] += 0.5 * second
    return line.matrix([0.0])[0], bend


def _glued(degree: int, elements: int, count: int) -> Index:
    """(count^2,) for each place of the net the first place that has the same coefficient."""
    # function i is centred at i - (degree - 1) / 2 elements from the side
    i, j = np.divmod(np.arange(count * count), count)
    width = 2 * elements
    owner: Index = np.arange(count * count)
    folds = []
    for low in (0, 2 * width):
        across, along = low + degree - 1, width + degree - 1
        folds += [(across - i, along - j), (along - i, across - j)]
    for _ in range(8):
        for k, m in folds:
            inside = (k >= 0) & (k < count) & (m >= 0) & (m < count)
            image = np.where(inside, k * count + m, np.arange(count * count))
            owner = np.minimum(owner, owner[image])
    return owner
