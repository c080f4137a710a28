"""What acts on the membrane's edges: contact lines, and curved solids that hold an edge."""

from __future__ import annotations

from copy import copy

import numpy as np

from ..arrays import Array, Index
from ..dofs.dof_map import FirstOrder, Rows
from ..linalg.bordered import Matrix
from ..problems.scene import Scene
from ..splines import EdgeTable, Space
from ..terms import BodyDensity
from ..terms.edge_gap import EdgeGap


class EdgeLines:
    """Line terms and gap constraints of a scene along the edges of its membrane, on one sector.

    Parameters
    ----------
    scene, space : whose terms and supports name the edges.
    points : Gauss points along an edge.
    ring : elements of the sector along an edge.
    rows : of the motion.

    Attributes
    ----------
    lines : line terms, each with the functions of its edge; wetted : those of contact lines;
        on_spheres : those of them on spheres.
    gaps : gaps to curved solids, each with the functions of its edge.
    """

    def __init__(self, scene: Scene, space: Space, points: int, ring: Index, rows: Rows) -> None:
        def edge(name: str) -> EdgeTable:
            return space.edge_table(name, points, ring)

        self._rows = rows
        terms, on_spheres = scene.local_terms(), scene.local_supports().on_spheres
        self.lines = [(term, edge(term.edge)) for term in terms.lines]
        self.wetted = [(term, edge(term.edge)) for term in terms.wetting]
        self.on_spheres = [(term, edge(term.edge)) for term in terms.on_spheres]
        self.gaps = [(EdgeGap(sphere, name), edge(name)) for name, sphere in on_spheres]

    def by(self, rows: Rows) -> EdgeLines:
        """The same by the unknowns of other rows."""
        other = copy(self)
        other._rows = rows
        return other

    @property
    def gap_count(self) -> int:
        """Number of gap constraints."""
        return int(self._rows.spines.held.max(initial=-1)) + 1

    def wetting(self, points: Array) -> tuple[float, float]:
        """Energy of the wetted surface inside the lines and its area."""
        none = BodyDensity()
        energy = sum(t.energy(edge, points, t.strength, none) for t, edge in self.wetted)
        return energy, sum(self.wet_areas(points))

    def wet_areas(self, points: Array) -> list[float]:
        """Area inside each contact line."""
        return [t.energy(edge, points, 1.0, BodyDensity()) for t, edge in self.wetted]

    def gap_values(self, points: Array) -> Array:
        """(gap_count,) gap integrals by number."""
        total = np.zeros(self.gap_count + 1)
        for gap, edge in self.gaps:
            np.add.at(total, self._rows.held(edge) + 1, gap.values(edge, points))
        return total[1:]

    def add_forces(
        self, total: FirstOrder, points: Array, body: BodyDensity, held: list[BodyDensity]
    ) -> None:
        """Add the lines' part of the energy's gradient and of those of the body integrals ``held``,
        and the gradients of the gaps, whose columns come after them."""
        for term, edge in self.lines:
            line = self._rows.edge(edge)
            forces = term.forces(edge, points, term.strength, body)
            total.add(_again(forces, line), line.functions)
            for k, density in enumerate(held):
                forces = term.forces(edge, points, 0.0, density)
                total.constrain(k, _again(forces, line), line.functions)
        for gap, edge in self.gaps:
            line = self._rows.edge(edge)
            numbers = self._rows.held(edge)
            gradients = gap.gradients(edge, points)
            for k in range(edge.functions.shape[1]):
                work = total.work(_again(gradients[:, k], line), line.functions)
                into = np.broadcast_to(numbers[:, k, None], work.shape)
                where = self._rows.unknowns(line.functions)
                keep = (into >= 0) & (where >= 0)
                np.add.at(total.columns, (where[keep], len(held) + into[keep]), work[keep])

    def add_hessian(
        self, matrix: Matrix, directions: Array, points: Array, body: BodyDensity, loads: Array
    ) -> None:
        """Add second derivatives of the lines, and of the gaps times minus ``loads`` (count,)."""
        for term, edge in self.lines:
            self._add(matrix, directions, edge, term.hessian(edge, points, term.strength, body))
        for gap, edge in self.gaps:
            load = -loads[edge.functions]
            self._add(matrix, directions, edge, gap.hessian(edge, points, load))

    def _add(self, matrix: Matrix, directions: Array, edge: EdgeTable, blocks: Array) -> None:
        """Add edge blocks (elements, local, 3, local, 3) along directions."""
        line = self._rows.edge(edge)
        columns = _columns(line)
        d = directions[line.functions]
        blocks = blocks[:, columns][:, :, :, columns]
        matrix.add(
            self._rows.unknowns(line.functions),
            np.einsum("eai,eaibj,ebj->eab", d, blocks, d, optimize=True),
        )

    def push(self, name: str, points: Array, loads: Array) -> Array:
        """(3,) force of the line loads (count,) on the solid that holds an edge (one sector)."""
        total = np.zeros(3)
        for gap, edge in self.gaps:
            if gap.edge != name:
                continue
            push = gap.gradients(edge, points).sum(axis=2)
            total -= np.einsum("ek,eki->i", loads[edge.functions], push)
        return total


def _columns(line: EdgeTable) -> Index:
    """Which function of the edge belongs to each of its rows."""
    local = line.functions.shape[1] - len(line.repeated)
    return np.concatenate([np.arange(local), line.repeated])


def _again(forces: Array, line: EdgeTable) -> Array:
    """Forces by function, repeated for the second rows."""
    return forces[:, _columns(line)]
