"""What holds the control points that the liquid does not: those inside a solid or nearly so.

Control points without any part outside follow their neighbours harmonically; those with a little
part outside are tied to them by the jump of the highest derivative.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array, Index, Mask
from ..splines import Faces, Space, jumps

STRENGTH = 0.001, 0.02
"""Factor of the jumps' energy over the tension: least, and at 45 degrees to the solid on a coarse
mesh, where it is steadier. It falls with the fourth power of a smaller angle: the error of a line's
angle grows with it over that angle's square, and flat spots are steady with less."""
AT_PARTICLES = 0.1
"""The same at particles: the start may be far away, and along the smooth spines of a droplet ties
cost the angle nothing."""
COARSE = 0.3
"""Element over the contact length of a coarse mesh."""
FREE = 5
"""Iterations after which elements stay tied that no longer need it: they could alternate for
ever."""


class Ties:
    """Ties across the faces of some elements.

    Parameters
    ----------
    elements, portion : (elements,) of the space, and the portion of each that is in the sector.
    faces : between them.
    unknowns : (control points,) unknown of each, -1 for none; size : their number.

    Attributes
    ----------
    strength : factor of the jumps' energy over the tension, but at particles.
    firmness : by which it is larger than usual.
    """

    strength: float = STRENGTH[0]
    firmness: float = 1.0

    def __init__(
        self,
        space: Space,
        elements: Index,
        portion: Array,
        faces: Faces,
        unknowns: Index,
        size: int,
    ) -> None:
        self._space, self._elements, self._portion = space, elements, portion
        self._faces, self._of_points, self._size = faces, unknowns, size
        self._unknowns = unknowns[space.functions[elements]]
        self._factor: tuple[Array, Any] | None = None

    def begin(self, steepness: float, element: float) -> None:
        """Free to choose again, for a membrane that meets its solid at an angle (radians), with
        elements of a size over the contact length."""
        steep = min(steepness / (0.25 * np.pi), 1.0)
        wanted = STRENGTH[1] * steep**4 * (element / COARSE) ** 2
        self.strength = float(np.clip(wanted, *STRENGTH))
        none = np.zeros(len(self._elements), bool)
        self._held, self._touched, self._last = none, none, (none, none)
        self._strength: Array = np.zeros(len(none))
        self._calls = 0

    def hold(self, active: Mask, touched: Mask, on_particle: Mask) -> None:
        """Choose for a state whose ``active`` elements have a part outside, the ``touched`` ones
        another inside; what is nearest to some of them is a particle."""
        self._calls += 1
        before, self._last = self._last, (active, touched)
        held = active
        if self._calls > FREE:
            if not (active & ~self._held).any() and not (touched & ~self._touched).any():
                return
            held, touched = active | before[0], touched | before[1]
        if np.array_equal(held, self._held) and np.array_equal(touched, self._touched):
            return
        self._held, self._touched = held, touched
        self._strength = self.firmness * np.where(on_particle, AT_PARTICLES, self.strength)
        for name in ("across", "idle", "_graph"):
            self.__dict__.pop(name, None)
        self._factor = None

    @cached_property
    def across(self) -> tuple[Index, Array, Array]:
        """Functions (k, 2 local), jumps (k, q, 2 local) and weights (k, q) of the tied faces, their
        strength included."""
        f = self._faces
        first, second = self._held[f.first], self._held[f.second]
        cuts = self._touched[f.first] | self._touched[f.second]
        tied = f.part(first & second & cuts)
        functions, rows, weights = jumps(self._space, self._elements, tied)
        portion = np.minimum(self._portion[tied.first], self._portion[tied.second])
        strength = np.maximum(self._strength[tied.first], self._strength[tied.second])
        return functions, rows, weights * (portion * strength)[:, None]

    def energy(self, points: Array) -> float:
        """Energy of the ties, tension 1."""
        functions, rows, weights = self.across
        jump = rows @ points[functions]
        return float(0.5 * ((jump**2).sum(axis=-1) * weights).sum())

    def forces(self, points: Array) -> Array:
        """(faces, 2 local, 3)"""
        functions, rows, weights = self.across
        jump = rows @ points[functions]
        return np.asarray(rows.transpose(0, 2, 1) @ (jump * weights[..., None]))

    def hessian(self, directions: Array) -> Array:
        """(faces, 2 local, 2 local) along directions (control points, 3)."""
        functions, rows, weights = self.across
        d = directions[functions]
        blocks = rows.transpose(0, 2, 1) @ (rows * weights[..., None])
        return np.asarray(blocks * (d @ d.transpose(0, 2, 1)))

    @cached_property
    def idle(self) -> Index:
        """Unknowns of which nothing lies outside."""
        lonely = np.zeros(self._size + 1, bool)
        lonely[self._unknowns] = True
        lonely[self._unknowns[self._held]] = False
        return np.flatnonzero(lonely[:-1])

    def extended(self, vectors: Array, directions: Array) -> Array:
        """Positions or displacements (count, 3) of the control points, the idle ones changed along
        their directions (count, 3) until they are harmonic in these."""
        if not len(self.idle):
            return vectors
        from scipy.sparse import coo_array
        from scipy.sparse.linalg import splu

        idle, graph = self._graph
        d = directions[idle]
        if self._factor is None or not np.array_equal(self._factor[0], d):
            inner = graph[:, idle].tocoo()
            turned = inner.data * np.einsum("ki,ki->k", d[inner.row], d[inner.col])
            matrix = coo_array((turned, (inner.row, inner.col)), inner.shape)
            self._factor = d, splu(matrix.tocsc())
        out = np.einsum("ki,ki->k", graph @ vectors, d)
        full = vectors.copy()
        full[idle] -= self._factor[1].solve(out)[:, None] * d
        return full

    @cached_property
    def _graph(self) -> tuple[Index, Any]:
        """The idle control points of the whole body, and their rows of the Laplacian of the graph
        of all control points."""
        from scipy.sparse import coo_array, diags_array

        lonely = np.zeros(self._size + 1, bool)
        lonely[self.idle] = True
        idle = lonely[self._of_points]
        f, size = self._space.functions, self._space.count
        real = np.ones(f.shape, bool)
        if len(self._space.near):
            # at poles and folds some functions are empty
            real[self._space.near] = self._space.combine.any(axis=2)
        near = idle[f].any(axis=1)
        f, real = f[near], real[near]
        pairs = real[:, :, None] & real[:, None, :]
        i, j = (a[pairs] for a in np.broadcast_arrays(f[:, :, None], f[:, None, :]))
        links = coo_array((np.ones(len(i)), (i, j)), (size, size)).tocsr()
        graph = (diags_array(links.sum(axis=1)) - links).tocsr()
        return np.flatnonzero(idle), graph[idle]
