"""The second variation of the whole body at a state, block by block.

The elements of the computed part contribute once, by rows of the motion; every block sums the same
contributions by unknowns of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..assembly.lagrangian import Assembly
from ..dofs.parity import Parity
from ..dofs.spines import Block, Motion
from ..dofs.symmetry import sense
from ..linalg.bordered import DENSE_LIMIT, Contributions, Matrix, SparsePattern
from ..surface.surface import Surface
from ..terms import BodyDensity
from ..terms import variations as vary

AXES = tuple(BodyDensity(0.0, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
"""Densities of the liquid's first moments."""


class SecondVariation:
    """Contributions to the second variation of a state.

    Parameters
    ----------
    assembly : of the scene; surface, multipliers : the state.

    Attributes
    ----------
    motion : directions of the rows.
    rigid : (rows, 6) integrals of the normal displacement of each row times that of the rigid
        motions, three translations and three rotations about the origin.
    normal, size : (6, 6) integrals over the computed part of products of their normal
        displacements, as far as control points follow them, and of the displacements. Of a turn
        about the axis of a body of revolution nothing is followed but rounding, although its
        spline, not quite round, has a ripple that turns.
    moment : (4,) volume of the whole liquid and its first moments.
    """

    def __init__(self, assembly: Assembly, surface: Surface, multipliers: Array) -> None:
        self._assembly, self._surface = assembly, surface
        self.motion = assembly.motion(surface)
        self.sense = sense(surface)
        d = self.motion.directions
        self._free = assembly.released()
        body, load = assembly.density(multipliers), assembly.line_load(multipliers)
        self._hessian = _kept(self._free.hessian(surface, d, body, load))
        self._constraints = len(assembly.held)
        self._free.held = [*assembly.held, *AXES]
        _, self._columns = self._free.forces(surface, d)
        integrals = [assembly.body_integral(surface, one) for one in (BodyDensity(1.0), *AXES)]
        self.moment = np.append(
            assembly.copies * integrals[0], assembly.whole(np.array(integrals[1:]))
        )
        self._patterns: dict[Parity, SparsePattern] = {}
        self._add_rigid_motions()

    def _add_rigid_motions(self) -> None:
        points, d = self._surface.points, self.motion.directions
        at = vary.element_points(self._free.table, points)
        rows = len(d)
        own = rigid_motions(points[self.motion.points])
        length = np.maximum((d**2).sum(axis=1), np.finfo(float).tiny)
        followed = np.einsum("rki,ri->rk", own, d) / length[:, None]
        self.rigid, self.normal, self.size = np.zeros((rows, 6)), np.zeros((6, 6)), np.zeros((6, 6))
        for table, part in self._free.parts(points, at):
            n = part.c / part.area[..., None]
            area = part.area * table.weights
            rigid = normal_motions(part.x, n)
            along = table.values * (n @ d[table.functions].transpose(0, 2, 1))
            work = along.transpose(0, 2, 1) @ (rigid * area[..., None])
            for k in range(6):
                self.rigid[:, k] += np.bincount(table.functions.ravel(), work[..., k].ravel(), rows)
            moved = along @ followed[table.functions]
            self.normal += np.einsum("eqi,eqj,eq->ij", moved, moved, area)
            moves = rigid_motions(part.x)
            self.size += np.einsum("eqki,eqli,eq->kl", moves, moves, area, optimize=True)

    def matrix(self, block: Block) -> Matrix:
        """Hessian of a block; unknowns that move nothing outside solids get a unit of their own."""
        matrix = self._summed(self._hessian, block)
        still = np.flatnonzero(matrix.diagonal() == 0.0)
        unit = np.full((len(still), 1, 1), self._assembly.tension)
        matrix.add(still[:, None], unit)
        return matrix

    def mass(self, block: Block) -> Matrix:
        """Mass matrix of a block's normal displacement."""
        return self._summed(self._mass, block)

    @cached_property
    def _mass(self) -> Contributions:
        return _kept(self._free.mass(self._surface, self.motion.directions))

    def _summed(self, kept: Contributions, block: Block) -> Matrix:
        return kept.summed(self._empty(block), block.factors, block.unknowns)

    def _empty(self, block: Block) -> Matrix:
        if block.parity.model == self._assembly.spines.model:
            return self._assembly.matrix()
        if block.size <= DENSE_LIMIT:
            return Matrix(block.size)
        return Matrix(block.size, self._pattern(block))

    def _pattern(self, block: Block) -> SparsePattern:
        found = self._patterns.get(block.parity)
        if found is not None:
            return found
        groups = [unknown[rows] for rows, _ in self._hessian.kept for unknown in block.unknowns]
        places = self._assembly.spines.places_of(block.unknowns[0], block.size)
        found = SparsePattern(block.size, groups, places)
        self._patterns[block.parity] = found
        return found

    def border(self, block: Block, held: str) -> Array:
        """(n, m) gradients of what a block's motions may not change: all constraints for the
        scene's own unknowns; the centroid along the axes ``held`` and gaps for others."""
        first = self._constraints
        gaps = slice(first + 3, first + 3 + self._free.edges.gap_count)
        columns = [self._gaps(block, self._columns[:, gaps])]
        if block.own:
            own = [*range(first), *range(gaps.stop, self._columns.shape[1])]
            columns += [self._by_unknown(block, [self._columns[:, k]]) for k in own]
        moments = self._columns[:, first : first + 3]
        for axis in held:
            along = np.eye(6)["xyz".index(axis)]
            if np.allclose(self.part(block, along), along):
                images = [moments @ mirrored(m, along)[:3] for m in self.images(block)]
                columns.append(self._by_unknown(block, images))
        return np.column_stack(columns)

    def pin(self, block: Block, motion: Array) -> Array:
        """(n,) what a block's motions have of a rigid one (6,), which is theirs by its parity."""
        images = [self.rigid @ mirrored(m, motion) for m in self.images(block)]
        return self._by_unknown(block, images)

    def part(self, block: Block, motion: Array) -> Array:
        """(6,) the part of a rigid motion that has the parity of a block."""
        for mirror, sign in block.parity.planes(self.sense):
            motion = 0.5 * (motion + sign * mirrored(mirror, motion))
        return motion

    def motion_of(self, block: Block) -> Motion:
        """The rows of the motion with the unknowns of a block."""
        own, m = len(self.motion.points) - len(self.motion.shifts), self.motion
        rows = slice(None) if block.own else slice(own)
        return Motion(
            m.points[rows], m.directions[rows] * block.factors[0, rows, None],
            block.unknowns[0, rows], block.size, m.shifts if block.own else m.shifts[:0], m.share,
        )  # fmt: skip

    def images(self, block: Block) -> list[Array]:
        """Mirror matrices of the images of the computed part that a block needs."""
        return block.parity.images(self._assembly.spines.model, self.sense)

    def _by_unknown(self, block: Block, columns: Sequence[Array]) -> Array:
        """(n,) sums of numbers by rows (rows,), one set for each image."""
        total = np.zeros(block.size + 1)
        for factor, unknown, column in zip(block.factors, block.unknowns, columns, strict=True):
            total += np.bincount(unknown + 1, factor * column, block.size + 1)
        return total[1:]

    def _gaps(self, block: Block, columns: Array) -> Array:
        """(n, gaps) gradients of the gap constraints of a block, from those by rows."""
        count = int(block.gaps.max(initial=-1)) + 1
        total = np.zeros((block.size + 1, count + 1))
        second = slice(self._assembly.spines.space.count, None)
        for factor, unknown, gap in zip(block.factors, block.unknowns, block.gaps, strict=True):
            numbers = gap[second][: columns.shape[1]]
            work = factor[:, None] * columns * factor[second][: columns.shape[1]]
            np.add.at(total, (unknown[:, None], numbers), work)
        work = total[:-1, :-1]
        return np.asarray(work[:, work.any(axis=0)])


def rigid_motions(x: Array) -> Array:
    """(..., 6, 3) displacements of points (..., 3) by the translations and rotations."""
    turns = vary.cross(np.eye(3), x[..., None, :])
    return np.concatenate([np.broadcast_to(np.eye(3), turns.shape), turns], axis=-2)


def normal_motions(x: Array, normal: Array) -> Array:
    """(..., 6) the same along normals (..., 3)."""
    return np.concatenate([normal, vary.cross(x, normal)], axis=-1)


def mirrored(mirror: Array, motion: Array) -> Array:
    """A rigid motion (6,) of the mirror image; rotations are axial vectors."""
    return np.concatenate([mirror @ motion[:3], np.linalg.det(mirror) * (mirror @ motion[3:])])


def _kept(matrix: Matrix) -> Contributions:
    assert isinstance(matrix, Contributions)
    return matrix
