"""Residual and Hessian of a scene in its unknowns, with a sparsity that never changes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from time import process_time

import numpy as np

from ..arrays import Array, Index
from ..scenes.scene import Scene
from ..surface.motion import Spines
from ..surface.sector import sector_elements
from ..surface.supports import Sliding
from ..surface.surface import Surface
from ..terms import AreaTerm, BodyDensity, BodyTerm, Constraint, LineTerm
from ..terms import variations as vary
from .linear import DENSE_LIMIT, Matrix, SparsePattern


@dataclass(frozen=True, eq=False)
class Energies:
    """Values of one state (whole body, dimensionless).

    Attributes
    ----------
    total : energy without constraints.
    constraints : (m,) prescribed integrals minus their values.
    area_vectors : (elements, points, 3) ``a_1 x a_2`` at the quadrature points.
    lowest : smallest z at the quadrature points.
    """

    total: float
    constraints: Array
    area_vectors: Array
    lowest: float

    def regular_after(self, before: Energies) -> bool:
        """Finite, and nowhere folded over against the state before it."""
        dot = np.einsum("eqi,eqi->eq", self.area_vectors, before.area_vectors)
        return bool(np.isfinite(self.total) and (dot > 0).all())


@dataclass(frozen=True, eq=False)
class System:
    """Linearization of one state in the unknowns (one sector).

    Attributes
    ----------
    gradient : (n,) derivative of the energy.
    constraint_gradients : (n, m).
    constraints : (m,) prescribed integrals minus their values.
    scale : norm of the absolute force contributions, against which a residual is judged.
    matrix : Hessian of the energy minus multipliers times constraints.
    """

    gradient: Array
    constraint_gradients: Array
    constraints: Array
    scale: float
    matrix: Matrix

    def residual(self, multipliers: Array) -> Array:
        """(n,) out-of-balance forces."""
        return np.asarray(self.gradient - self.constraint_gradients @ multipliers)


class Assembly:
    """The functions of a scene's unknowns, evaluated on one sector in the scene's scale.

    Parameters
    ----------
    scene : its surface's space and supports fix the numbering; its start is not used.
    points : Gauss points per direction; if omitted ``degree + 1``, but ``degree`` round a smooth
        ring, where the functions are splines on equal knots (docs/results/choices.md).
    """

    def __init__(self, scene: Scene, points: int | None = None) -> None:
        surface = scene.local_surface()
        space, sector = surface.space, scene.sector
        self.copies = sector.copies
        self.spines = Spines(surface, tuple(scene.supports))
        self.size = self.spines.size
        ring = space.bases[0]
        around = max(3, ring.degree) if ring.periodic and ring.continuity else ring.degree + 1
        self.points = (points, points) if points else (around, space.bases[1].degree + 1)
        self.table = space.table(self.points, sector_elements(space, sector))
        self.seconds = 0.0
        before = process_time()
        self._kernels = vary.compiled_kernels(len(self.table.functions))
        if self._kernels is not None:
            self._kernels.warm_up()
        self.compile_seconds = process_time() - before
        self._ring_elements = np.arange(space.bases[0].elements // sector.copies)
        self._space = space
        self._unknowns = self.spines.unknowns[self.table.functions]
        self.above_plane = any(isinstance(s, Sliding) for s in scene.supports)
        self.load(scene)

    def load(self, scene: Scene) -> None:
        """Take the terms of another scene of the same space and supports."""
        terms = scene.local_terms()
        self.constraints = [t for t in terms if isinstance(t, Constraint)]
        self._tension = sum(t.tension() for t in terms if isinstance(t, AreaTerm))
        self._bodies = [
            t.density() for t in terms if isinstance(t, BodyTerm) and not isinstance(t, Constraint)
        ]
        self._held = [t.density() for t in self.constraints]
        self._targets = np.array([t.target for t in self.constraints]) / self.copies
        self.lines = [
            (t, self._space.edge_table(t.edge, self.points[0], self._ring_elements))
            for t in terms
            if isinstance(t, LineTerm)
        ]

    @property
    def body(self) -> BodyDensity:
        """Sum of the body densities that are not constraints."""
        return sum(self._bodies, BodyDensity())

    def density(self, multipliers: Array) -> BodyDensity:
        """Body density of the Lagrangian."""
        held = (d * -float(m) for d, m in zip(self._held, multipliers, strict=True))
        return sum(held, self.body)

    def energies(self, surface: Surface) -> Energies:
        """Energy and constraints of a state, without derivatives."""
        start = process_time()
        at = vary.element_points(self.table, surface.points)
        area, integrals = vary.energies(self.table, at, [self.body, *self._held])
        total = self._tension * area + integrals[0]
        total += sum(term.energy(table, surface.points) for term, table in self.lines)
        self.seconds += process_time() - start
        return Energies(total, integrals[1:] - self._targets, at.c, float(at.x[..., 2].min()))

    def system(self, surface: Surface, directions: Array, multipliers: Array) -> System:
        """Gradient, constraints and Hessian of a state along directions (count, 3)."""
        start = process_time()
        points, table = surface.points, self.table
        along = directions[table.functions]
        at = vary.element_points(table, points)
        _, held = vary.energies(table, at, self._held)
        forces = vary.forces(table, at, self._tension, self.body)
        normal = np.einsum("eai,eai->ea", forces, along)
        gradient, scale = self._gather(normal), self._gather(np.abs(normal))
        matrix = self._matrix(
            vary.hessian(table, at, self._tension, self.density(multipliers), along, self._kernels)
        )
        columns = [
            self._gather(np.einsum("eai,eai->ea", vary.forces(table, at, 0.0, body), along))
            for body in self._held
        ]
        for column, multiplier in zip(columns, multipliers, strict=True):
            scale = scale + np.abs(column * multiplier)
        for term, edge in self.lines:
            unknowns, d = self.spines.unknowns[edge.functions], directions[edge.functions]
            force = np.einsum("eai,eai->ea", term.forces(edge, points), d)
            gradient = gradient + self._gather(force, unknowns)
            scale = scale + self._gather(np.abs(force), unknowns)
            block = np.einsum("eai,eaibj,ebj->eab", d, term.hessian(edge, points), d)
            matrix.add(unknowns, block)
        self.seconds += process_time() - start
        return System(
            gradient,
            np.stack(columns, axis=1) if columns else np.zeros((self.size, 0)),
            held - self._targets,
            float(np.linalg.norm(scale)),
            matrix,
        )

    def mass(self, surface: Surface, directions: Array) -> Matrix:
        """Mass matrix of normal displacement."""
        at = vary.element_points(self.table, surface.points)
        return self._matrix(vary.mass(self.table, at, directions[self.table.functions]))

    def _gather(self, values: Array, unknowns: Index | None = None) -> Array:
        """(n,) sums of element contributions by unknown; fixed points (-1) are dropped."""
        where = self._unknowns if unknowns is None else unknowns
        sums = np.bincount(where.ravel() + 1, values.ravel(), self.size + 1)[1:]
        return sums.astype(float, copy=False)

    def _matrix(self, blocks: Array) -> Matrix:
        matrix = Matrix(self.size, None if self.size <= DENSE_LIMIT else self._pattern)
        matrix.add(self._unknowns, blocks)
        return matrix

    @cached_property
    def _pattern(self) -> SparsePattern:
        return SparsePattern(self.size, self._unknowns)
