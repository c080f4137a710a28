"""Residual and Hessian of a scene in its unknowns, with a sparsity that never changes."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from time import thread_time

import numpy as np

from ..arrays import Array, Index
from ..deadline import check_time
from ..dofs.dof_map import FirstOrder, Released
from ..dofs.spines import Motion
from ..linalg.bordered import Matrix
from ..problems.scene import Scene
from ..surface.surface import Surface
from ..terms import BodyDensity, gap, pairs
from ..terms import variations as vary
from .functional import Energies, Functional


@dataclass(frozen=True, eq=False)
class System:
    """Linearization of one state in the unknowns (one sector).

    Attributes
    ----------
    energies : of the state.
    gradient : (n,) derivative of the energy.
    constraint_gradients : (n, m).
    scale : norm of the absolute force contributions, against which a residual is judged.
    matrix : Hessian of the energy minus multipliers times constraints.
    shifts : how many of the last unknowns are shifts.
    """

    energies: Energies
    gradient: Array
    constraint_gradients: Array
    scale: float
    matrix: Matrix
    shifts: int

    @property
    def constraints(self) -> Array:
        """(m,) prescribed integrals minus their values."""
        return self.energies.constraints

    def residual(self, multipliers: Array) -> Array:
        """(n,) out-of-balance forces."""
        return np.asarray(self.gradient - self.constraint_gradients @ multipliers)


TINY = 1e-12
"""Force over tension below which a residual is nothing: a flat sheet has no forces at all."""


class Assembly(Functional):
    """The functional of a scene with its derivatives by the unknowns; parameters are its."""

    def __init__(self, scene: Scene, points: int | None = None) -> None:
        super().__init__(scene, points)
        before = thread_time()
        self._kernels = None
        if not self.spines.by_pairs:
            self._kernels = vary.compiled_kernels(len(self.table.functions))
        if self._kernels is not None:
            self._kernels.warm_up()
        self.compile_seconds = thread_time() - before

    @property
    def conservative(self) -> bool:
        """Whether all forces have an energy, so that descent can be asked for."""
        return not self.stabilizer.projected

    def largest(self, surface: Surface, displacement: Array) -> float:
        """Size of a displacement: of the control points', but of the membrane's own where it passes
        through solids, since some of its control points move it hardly at all."""
        return self.contact.largest(self.table, surface.points, displacement)

    def near_contact(self, surface: Surface, displacement: Array) -> float:
        """Largest displacement over the contact length near the solid: of control points, or as in
        :meth:`largest`."""
        return self.contact.near_contact(self.table, surface.points, displacement)

    def relaxed(self, surface: Surface, motion: Motion) -> Surface:
        """The same liquid; what lies inside a solid, and on which nothing depends, smoothed."""
        self.contact.hold(surface.points)
        points = self.contact.extended(surface.points, motion)
        return surface if points is surface.points else surface.moved(points)

    def displacement(self, motion: Motion, step: Array) -> Array:
        """(count, 3) of the control points; those that nothing outside a solid depends on follow
        the others."""
        return self.contact.extended(motion.displacement(step), motion)

    def system(self, surface: Surface, directions: Array, multipliers: Array) -> System:
        """Gradient, constraints and Hessian of a state along directions (rows, 3)."""
        start = thread_time()
        points = surface.points
        at = vary.element_points(self.table, points)
        energies = self.energies_at(points, at)
        first = self._first_order(points, directions, at)
        load = self.line_load(multipliers)
        matrix = self._second_order(points, directions, at, self.density(multipliers), load)
        self.seconds += thread_time() - start
        scale = first.scale + np.abs(first.columns) @ np.abs(multipliers)
        size = max(float(np.linalg.norm(scale)), TINY * self.tension)
        shifts = len(self.spines.shifts)
        return System(energies, first.gradient, first.columns, size, matrix, shifts)

    def forces(self, surface: Surface, directions: Array) -> tuple[Array, Array]:
        """Gradients of the energy (n,) and of the constraints (n, m), without the Hessian."""
        at = vary.element_points(self.table, surface.points)
        first = self._first_order(surface.points, directions, at)
        return first.gradient, first.columns

    def _first_order(self, points: Array, directions: Array, at: vary.ElementPoints) -> FirstOrder:
        total = FirstOrder(self.rows, directions, self.multipliers)
        for rows, part in self.parts(points, at):
            check_time()
            total.add(vary.forces(rows, part, self.tension, self.body), rows.functions)
            for law in self.gaps:
                total.add(gap.forces(rows, part, law.at(part.x)), rows.functions)
            for k, held in enumerate(self.held):
                total.constrain(k, vary.forces(rows, part, 0.0, held), rows.functions)
        self.contact.add_forces(total, points, self.tension, self.body, self.held)
        self.stabilizer.add_forces(total, points)
        self.edges.add_forces(total, points, self.body, self.held)
        return total

    def hessian(
        self, surface: Surface, directions: Array, body: BodyDensity, load: Array
    ) -> Matrix:
        """Hessian of the Lagrangian with a body density and the line loads (count,) of edges held
        on solids."""
        at = vary.element_points(self.table, surface.points)
        return self._second_order(surface.points, directions, at, body, load)

    def released(self) -> Assembly:
        """The same state by rows of the motion, each an unknown: what the computed part alone
        contributes, to be summed as any motions of the whole ask for it."""
        free = copy(self)
        free.rows = Released(self.rows)
        free.spines = free.rows.spines
        free.edges = self.edges.by(free.rows)
        free.contact = self.contact.released()
        return free

    def _second_order(
        self,
        points: Array,
        directions: Array,
        at: vary.ElementPoints,
        body: BodyDensity,
        load: Array,
    ) -> Matrix:
        """Hessian of the Lagrangian."""
        unknowns = self.rows.unknowns
        check_time()
        matrix = self.matrix()
        if self.spines.by_pairs:
            self._add_by_pairs(matrix, points, directions, at, body)
        else:
            for rows, part in self.parts(points, at):
                check_time()
                along = directions[rows.functions]
                blocks = vary.hessian(rows, part, self.tension, body, along, self._kernels)
                for law in self.gaps:
                    blocks += gap.hessian(rows, part, law.at(part.x), along, self._kernels)
                check_time()
                matrix.add(unknowns(rows.functions), blocks)
        self.contact.add_hessian(matrix, self.rows, points, directions, self.tension, body)
        self.edges.add_hessian(matrix, directions, points, body, load)
        return matrix

    def _add_by_pairs(
        self,
        matrix: Matrix,
        points: Array,
        directions: Array,
        at: vary.ElementPoints,
        body: BodyDensity,
    ) -> None:
        """Where control points have three unknowns: the liquid's Hessian and the stabilizer's."""
        table, sums = self.table, self.rows.pair_sums

        def liquid(some: Index) -> pairs.Form:
            return pairs.liquid(table.weights[some], at.part(some), self.tension, body)

        numbers = pairs.hessian(table, liquid)
        owners = self.spines.points
        self.stabilizer.add_hessian(numbers, matrix, sums, points, directions, owners)
        sums.add(matrix, numbers, directions)

    def mass(self, surface: Surface, directions: Array) -> Matrix:
        """Mass matrix of normal displacement; of all displacement where tangents move too."""
        at = vary.element_points(self.table, surface.points)
        matrix = self.matrix()
        full = self.stabilizer.tangential
        for rows, part in self.parts(surface.points, at):
            blocks = vary.mass(rows, part, directions[rows.functions], full=full)
            matrix.add(self.rows.unknowns(rows.functions), blocks)
        return matrix

    def matrix(self) -> Matrix:
        """An empty matrix of the unknowns."""
        return self.rows.matrix(self.contact.tied)
