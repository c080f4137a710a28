"""Faces between elements, and the jump of the highest derivative across them.

Between splines of degree p and full smoothness only the p-th derivative jumps. Penalizing the jump
next to a cut ties functions with little support inside to their neighbours, without a bias of lower
order than the spline's own error (ghost penalty, Burman, doi 10.1016/j.crma.2010.10.006).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index, Mask
from ..quadrature import gauss
from .space import Rows, Space


@dataclass(frozen=True, eq=False)
class Faces:
    """Faces between the elements of a list.

    Attributes
    ----------
    first, second : (k,) places in the list of the elements before and after each face.
    axis : (k,) 0 or 1, the parameter across it.
    """

    first: Index
    second: Index
    axis: Index

    def part(self, some: Mask) -> Faces:
        """Some of the faces."""
        return Faces(self.first[some], self.second[some], self.axis[some])


def faces_between(space: Space, elements: Index) -> Faces:
    """All faces between elements of a list."""
    n1, n2 = (basis.elements for basis in space.bases)
    place = np.full(space.elements, -1)
    place[elements] = np.arange(len(elements))
    e1, e2 = np.divmod(elements, n2)
    found = []
    for axis, (a, b) in enumerate(((e1 + 1, e2), (e1, e2 + 1))):
        if axis == 0 and space.bases[0].periodic:
            a = a % n1
        inside = (a < n1) & (b < n2)
        other = place[np.where(inside, a * n2 + b, 0)]
        inside &= other >= 0
        count = int(inside.sum())
        found.append((np.flatnonzero(inside), other[inside], np.full(count, axis)))
    return Faces(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def folded_pairs(space: Space, elements: Index) -> tuple[Index, Index]:
    """(k,), (k,) places in a list of elements that meet where the sides of a square are folded at
    their middles; none on other patches."""
    if space.shared is None:
        return np.zeros(0, int), np.zeros(0, int)
    n1, n2 = (basis.elements for basis in space.bases)
    place = np.full(space.elements, -1)
    place[elements] = np.arange(len(elements))
    one, two = np.arange(n1), np.arange(n2)
    sides = [(one * n2 + j, one[::-1] * n2 + j) for j in (0, n2 - 1)]
    sides += [(i * n2 + two, i * n2 + two[::-1]) for i in (0, n1 - 1)]
    first, second = (place[np.concatenate(part)] for part in zip(*sides, strict=True))
    known = (first >= 0) & (second >= 0)
    return first[known], second[known]


def jumps(space: Space, elements: Index, faces: Faces) -> tuple[Index, Array, Array]:
    """The p-th derivative across faces by local coordinates, over p factorial, after minus before.

    Returns
    -------
    functions : (k, 2 local) of both elements.
    rows : (k, q, 2 local); weights : (q,) along a face of unit length.
    """
    nodes, weights = gauss(max(basis.degree for basis in space.bases) + 1)
    pairs = elements[faces.first], elements[faces.second]
    local = space.functions.shape[1]
    rows = np.zeros((len(faces.axis), len(nodes), 2 * local))
    for axis in (0, 1):
        some = np.flatnonzero(faces.axis == axis)
        across, along = space.bases[axis], space.bases[1 - axis]
        p = across.degree
        for k, (side, sign) in enumerate(((1.0, -1.0), (0.0, 1.0))):
            chosen = pairs[k][some]
            e = np.divmod(chosen, space.bases[1].elements)
            size = across.sizes[e[axis]][:, None, None] ** p
            top = across.inside(e[axis], np.full((len(some), 1), side), p) * size
            base = along.inside(e[1 - axis], np.broadcast_to(nodes, (len(some), len(nodes))))
            parts = (top, base) if axis == 0 else (base, top)
            product = parts[0][..., :, None] * parts[1][..., None, :]
            flat: Rows = {(0, 0): product.reshape(len(some), len(nodes), local)}
            factorial = float(np.prod(np.arange(1, p + 1)))
            rows[some, :, k * local : (k + 1) * local] = (
                sign / factorial * space.finished(flat, chosen)[0, 0]
            )
    functions = np.hstack([space.functions[pairs[0]], space.functions[pairs[1]]])
    return functions, rows, weights
