"""Residual and Hessian of a scene in its unknowns, with a sparsity that never changes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from time import process_time

import numpy as np

from ..arrays import Array, Index
from ..errors import GeometryError
from ..scenes.scene import Scene
from ..splines import EdgeTable, LineTable, Table
from ..surface.cartesian import Cartesian
from ..surface.motion import Motion, Spines
from ..surface.sector import mirrors, sector_elements, sector_table
from ..surface.supports import Sliding, Support
from ..surface.surface import Surface
from ..terms import (
    AreaTerm,
    BodyDensity,
    BodyTerm,
    Constraint,
    Contact,
    LineTerm,
    Stabilization,
    TrimmedContactLine,
)
from ..terms import variations as vary
from ..terms.edge_gap import EdgeGap
from ..terms.trimmed import end_hessian, line_forces, line_hessian
from .contact import ContactSet
from .linear import DENSE_LIMIT, Matrix, SparsePattern
from .stabilizer import Stabilizer
from .trim import Trim


@dataclass(frozen=True, eq=False)
class Energies:
    """Values of one state (whole body, dimensionless).

    Attributes
    ----------
    total : energy without constraints.
    constraints : (m,) prescribed integrals minus their values.
    area_vectors : (elements, points, 3) ``a_1 x a_2`` at the quadrature points.
    lowest : smallest z at the quadrature points.
    true : whether contact lines inside the membrane lie on their solid.
    """

    total: float
    constraints: Array
    area_vectors: Array
    lowest: float
    true: bool = True

    def regular_after(self, before: Energies) -> bool:
        """Finite, and nowhere folded over against the state before it."""
        dot = np.einsum("eqi,eqi->eq", self.area_vectors, before.area_vectors)
        return bool(self.true and np.isfinite(self.total) and (dot > 0).all())


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
    shifts : how many of the last unknowns are shifts.
    """

    gradient: Array
    constraint_gradients: Array
    constraints: Array
    scale: float
    matrix: Matrix
    shifts: int

    def residual(self, multipliers: Array) -> Array:
        """(n,) out-of-balance forces."""
        return np.asarray(self.gradient - self.constraint_gradients @ multipliers)


STEADY = 0.5
"""Part of the depth that a contact gives way, as the largest step before it is made harder."""
TINY = 1e-12
"""Force over tension below which a residual is nothing: a flat sheet has no forces at all."""


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
        self._mirrored = [axis in sector.mirrored for axis in "xyz"]
        self._supports: tuple[Support, ...] = scene.local_supports()
        self.spines = _motion(scene, surface, self._supports)
        self.size = self.spines.size
        ring = space.bases[0]
        around = max(3, ring.degree) if ring.periodic and ring.smooth else ring.degree + 1
        self.points = (points, points) if points else (around, space.bases[1].degree + 1)
        self.table = sector_table(space, sector, self.points)
        self.seconds = 0.0
        before = process_time()
        self._kernels = vary.compiled_kernels(len(self.table.functions))
        if self._kernels is not None:
            self._kernels.warm_up()
        self.compile_seconds = process_time() - before
        self._ring_elements = np.arange(space.bases[0].elements // sector.copies)
        self._space = space
        self._groups = self._row_groups()
        self._start = surface
        self._law = next((t for t in scene.terms if isinstance(t, Contact)), None)
        self.contact = self._contact(scene, surface)
        self.stabilizer: Stabilizer | None = None
        self._tied: tuple[Index, Array, Array] | None = None
        self.trim = self._trim(scene)
        self.above_plane = any(isinstance(s, Sliding) and s.solid is None for s in scene.supports)
        self.load(scene)

    def _contact(self, scene: Scene, surface: Surface) -> ContactSet | None:
        """The scene's contact; its reference area is that of the scene's start."""
        term = next((t for t in scene.local_terms() if isinstance(t, Contact)), None)
        if term is None:
            return None
        points = (1, 1) if term.penalty is None else self.points
        table = sector_table(surface.space, scene.sector, points)
        area = vary.element_points(table, surface.points).area * table.weights
        elements, _ = sector_elements(surface.space, scene.sector)
        law = term.penalty, term.depth, term.adhesion
        return ContactSet(term.solid, table, area, *law, surface.space, elements)

    def _trim(self, scene: Scene) -> Trim | None:
        """The scene's contact lines inside the membrane."""
        term = next((t for t in scene.local_terms() if isinstance(t, TrimmedContactLine)), None)
        if term is None:
            return None
        elements, portion = sector_elements(self._space, scene.sector)
        unknowns = self.spines.unknowns
        at = vary.element_points(self.table, self._start.points)
        close = (term.solid.nearest(at.x).gap < 2.0 * term.solid.scale).any(axis=1)
        size = np.sqrt((at.area * self.table.weights).sum(axis=1) / portion)
        element = float(np.median(size[close])) / term.solid.scale if close.any() else 1.0
        images = mirrors(scene.sector)
        return Trim(
            term, self._space, self.table, elements, portion, images, element, unknowns,
            self.spines.size,
        )  # fmt: skip

    def load(self, scene: Scene) -> None:
        """Take the terms of another scene of the same space, whose supports move the same edges."""
        terms, supports = scene.local_terms(), scene.local_supports()
        if supports != self._supports:
            self._supports = supports
            self.spines = _motion(scene, scene.local_surface(), supports)
        self.constraints = [t for t in terms if isinstance(t, Constraint)]
        self.tension = sum(t.tension() for t in terms if isinstance(t, AreaTerm))
        self._bodies = [
            t.density() for t in terms if isinstance(t, BodyTerm) and not isinstance(t, Constraint)
        ]
        self._held = [t.density() for t in self.constraints]
        self._targets = np.array([t.target for t in self.constraints]) / self.copies
        self.lines = [(t, self._edge(t.edge)) for t in terms if isinstance(t, LineTerm)]
        self._load_contact(scene)
        self._gaps = [
            (EdgeGap(s.solid, s.edge), self._edge(s.edge))
            for s in scene.local_supports()
            if isinstance(s, Sliding) and s.solid is not None
        ]

    def begin_step(self, surface: Surface, term: Stabilization) -> None:
        """Let a load step of the paper's formulation start from a state: its metric is ``a_pre`` of
        eq. (23), and tractions of the penalty count per area of it."""
        normals = self.spines.on(surface).directions[: self._space.count].copy()
        if self.contact is not None and self.lines:
            # the contact line is a kink, which has no tangent plane
            normals[self._space.edge_functions(self.lines[0][0].edge)] = 0.0
        self.stabilizer = Stabilizer(term, self.table, surface.points, normals)
        if self.contact is not None:
            self.contact.area = self.stabilizer.before.area

    @property
    def conservative(self) -> bool:
        """Whether all forces have an energy, so that descent can be asked for."""
        return self.stabilizer is None or not self.stabilizer.projected

    def _load_contact(self, scene: Scene) -> None:
        """Take the contact of another scene: its solid, its angles, its law.

        Raises
        ------
        GeometryError
            Contact areas in the one, contact lines inside the membrane in the other.
        """
        terms = scene.local_terms()
        lies = any(isinstance(t, Contact) for t in terms)
        line = next((t for t in terms if isinstance(t, TrimmedContactLine)), None)
        if lies != (self.contact is not None) or (line is None) != (self.trim is None):
            raise GeometryError("this scene meets its solid in another way than the one before")
        if self.trim is not None and line is not None:
            self.trim.term = line
            self.trim.forget()
        law = next((t for t in scene.terms if isinstance(t, Contact)), None)
        if self.contact is not None and not _same_contact(law, self._law):
            held = self.contact.multipliers
            self.contact = self._contact(scene, self._start)
            assert self.contact is not None
            self.contact.multipliers = held
            self.__dict__.pop("_contact_rows", None)
        self._law = law

    @property
    def multipliers(self) -> int:
        """Number of multipliers: of the constraints, then of the edges held on solids, then of the
        shifts' gauge."""
        return len(self._held) + self._gap_count + len(self.spines.shifts)

    @property
    def _gap_count(self) -> int:
        return int(self.spines.held.max(initial=-1)) + 1

    def line_load(self, multipliers: Array) -> Array:
        """(count,) coefficients of the load with which a curved solid holds its edge."""
        first = len(self._held)
        loads = np.append(multipliers[first : first + self._gap_count], 0.0)
        return loads[self.spines.held[self.spines.second]]

    @property
    def body(self) -> BodyDensity:
        """Sum of the body densities that are not constraints."""
        return sum(self._bodies, BodyDensity())

    def density(self, multipliers: Array) -> BodyDensity:
        """Body density of the Lagrangian."""
        held = (d * -float(m) for d, m in zip(self._held, multipliers, strict=False))
        return sum(held, self.body)

    def energies(self, surface: Surface) -> Energies:
        """Energy and constraints of a state, without derivatives."""
        start = process_time()
        points = surface.points
        at = vary.element_points(self.table, points)
        total, constraints = self._values(points, at)
        if self.contact is not None:
            total += self.contact.energy(self.contact.touch(points))
        if self.stabilizer is not None:
            total += self.stabilizer.energy(points)
        if self.trim is not None:
            total += self.tension * self.trim.ties.energy(points)
        self.seconds += process_time() - start
        true = self.trim is None or self.trim.true(points)
        return Energies(total, constraints, at.c, float(at.x[..., 2].min()), true)

    def energy(self, surface: Surface) -> float:
        """Energy of the liquid and its contact, without what ties the control points."""
        total = self.energies(surface).total
        return (
            total
            if self.trim is None
            else total - self.tension * self.trim.ties.energy(surface.points)
        )

    def near_contact(self, surface: Surface, displacement: Array) -> float:
        """Largest displacement over the contact length, of control points near the solid."""
        if self.contact is not None:
            near, length = self.contact.near(surface.points), self.contact.length
        elif self.trim is not None:
            near, length = self.trim.near(surface.points), self.trim.length
        else:
            return 0.0
        moved = np.linalg.norm(displacement[self.table.functions[near]], axis=-1)
        return float(moved.max(initial=0.0)) / length

    def relaxed(self, surface: Surface, motion: Motion) -> Surface:
        """The same liquid; what lies inside a solid, and depends on nothing, smoothed."""
        if self.trim is None:
            return surface
        self.trim.hold(surface.points)
        heights = np.einsum("ki,ki->k", surface.points, motion.directions[: len(surface.points)])
        level = np.zeros(self.size + 1)
        level[motion.unknowns[: len(heights)]] = heights
        step = self.trim.ties.extended(level[:-1]) - level[:-1]
        return surface.moved(surface.points + motion.displacement(step))

    def extended(self, step: Array) -> Array:
        """A step in which unknowns that nothing outside a solid depends on follow the others."""
        return step if self.trim is None else self.trim.ties.extended(step)

    @property
    def rounds(self) -> int:
        """How often the multipliers of contact have been updated."""
        return 0 if self.contact is None else self.contact.rounds

    def settled(self, surface: Surface, near: float) -> bool:
        """Whether the multipliers of contact hold the gap; they are updated when the last step
        ``near`` the solid (over the contact length) is small against what the contact still gives.
        """
        if self.contact is None:
            return True
        touch = self.contact.touch(surface.points)
        if near * self.contact.length <= STEADY * self.contact.give(touch):
            self.contact.tighten(touch, surface.points)
            return self.contact.settled
        return False

    def body_integral(self, surface: Surface, density: BodyDensity) -> float:
        """Integral of a density over the liquid of one sector, its part under the foot included."""
        points = surface.points
        at = vary.element_points(self.table, points)
        return float(self._integrals(points, at, 0.0, [density])[1])

    def work(self, surface: Surface, multipliers: Array, displacement: Array) -> float:
        """Derivative of the Lagrangian along any displacement (count, 3) of the control points."""
        points, body = surface.points, self.density(multipliers)
        at = vary.element_points(self.table, points)
        forces = vary.forces(self.table, at, self.tension, body)
        total = float((forces * displacement[self.table.functions]).sum())
        if self.contact is not None:
            push = self.contact.forces(self.contact.touch(points))
            total += float((push * displacement[self.contact.table.functions]).sum())
        for term, edge in self.lines:
            forces = term.forces(edge, points, term.strength, body)
            total += float((forces * displacement[edge.functions]).sum())
        loads = self.line_load(multipliers)
        for gap, edge in self._gaps:
            pull = np.einsum("ekai,ek->eai", gap.gradients(edge, points), loads[edge.functions])
            total -= float((pull * displacement[edge.functions]).sum())
        return total

    def gap_force(self, surface: Surface, multipliers: Array) -> Array:
        """(3,) force of the line loads on their solids (one sector)."""
        loads = self.line_load(multipliers)
        total = np.zeros(3)
        for gap, edge in self._gaps:
            push = gap.gradients(edge, surface.points).sum(axis=2)
            total -= np.einsum("ek,eki->i", loads[edge.functions], push)
        return total

    def contact_force(self, surface: Surface) -> Array:
        """(3,) force of the membrane on the solid it lies on (one sector)."""
        if self.contact is None:
            return np.zeros(3)
        return self.contact.forces(self.contact.touch(surface.points)).sum(axis=(0, 1))

    def whole(self, vector: Array) -> Array:
        """(3,) sum over all sectors of a vector integrated over one."""
        return np.asarray(self.copies * np.where(self._mirrored, 0.0, vector))

    def interface(self, surface: Surface) -> tuple[float, float, float]:
        """Area of the membrane, energy of the wetted surface and its area (one sector)."""
        points, none = surface.points, BodyDensity()
        at = vary.element_points(self.table, points)
        area = sum(vary.energies(rows, part, [])[0] for rows, part in self._parts(points, at))
        if self.trim is not None:
            return area, *self.trim.wetting(points)
        if self.contact is not None and self.contact.adhesion:
            return area, -self.contact.gained(points), 0.0
        return (
            area,
            sum(t.energy(edge, points, t.strength, none) for t, edge in self.lines),
            sum(t.energy(edge, points, 1.0, none) for t, edge in self.lines),
        )

    def _parts(
        self, points: Array, at: vary.ElementPoints
    ) -> list[tuple[Table, vary.ElementPoints]]:
        """Tables by rows of the motion, and the geometry there, that make up the membrane."""
        if self.trim is None:
            return [(rows, at.part(elements)) for elements, rows in self._groups]
        outside = self.trim.outside(points)
        whole, cut = (self._shifted_table.weighted(outside.share), at), outside.area
        return [whole, (cut, vary.element_points(cut, points))] if len(cut.functions) else [whole]

    def _integrals(
        self, points: Array, at: vary.ElementPoints, tension: float, bodies: list[BodyDensity]
    ) -> Array:
        """Energy of the interface and the wetted surface, then the body integrals."""
        total = np.zeros(1 + len(bodies))
        if self.trim is None:
            area, integrals = vary.energies(self.table, at, bodies)
            total[0], total[1:] = tension * area, integrals
        else:
            for rows, part in self._parts(points, at):
                area, integrals = vary.energies(rows, part, bodies)
                total[0] += tension * area
                total[1:] += integrals
            total[0] += self.trim.wetting(points)[0] if tension else 0.0
            total[1:] += [self.trim.under(points, body) for body in bodies]
        for term, edge in self.lines:
            none = BodyDensity()
            total[0] += term.energy(edge, points, term.strength, none) if tension else 0.0
            total[1:] += [term.energy(edge, points, 0.0, body) for body in bodies]
        return total

    def _values(self, points: Array, at: vary.ElementPoints) -> tuple[float, Array]:
        interface, body, *held = self._integrals(points, at, self.tension, [self.body, *self._held])
        gaps = [
            np.bincount(
                self._held_numbers(edge).ravel() + 1,
                gap.values(edge, points).ravel(),
                self._gap_count + 1,
            )[1:]
            for gap, edge in self._gaps
        ]
        # every step keeps to the gauge, which is linear
        gauge = np.zeros(len(self.spines.shifts))
        missing = np.array(held) - self._targets
        return interface + body, np.concatenate([missing, *gaps, gauge])

    def system(self, surface: Surface, directions: Array, multipliers: Array) -> System:
        """Gradient, constraints and Hessian of a state along directions (rows, 3)."""
        start = process_time()
        points = surface.points
        at = vary.element_points(self.table, points)
        _, constraints = self._values(points, at)
        gradient, columns, scale = self._first_order(points, directions, at, multipliers)
        matrix = self._second_order(points, directions, at, multipliers)
        self.seconds += process_time() - start
        size = max(float(np.linalg.norm(scale)), TINY * self.tension)
        return System(gradient, columns, constraints, size, matrix, len(self.spines.shifts))

    def forces(self, surface: Surface, directions: Array) -> tuple[Array, Array]:
        """Gradients of the energy (n,) and of the constraints (n, m), without the Hessian."""
        points, none = surface.points, np.zeros(self.multipliers)
        at = vary.element_points(self.table, points)
        return self._first_order(points, directions, at, none)[:2]

    def _first_order(
        self, points: Array, directions: Array, at: vary.ElementPoints, multipliers: Array
    ) -> tuple[Array, Array, Array]:
        """Gradient (n,), gradients of the constraints (n, m), absolute contributions (n,)."""
        gradient, scale = np.zeros(self.size), np.zeros(self.size)
        columns = np.zeros((self.size, self.multipliers))
        columns[:, self.multipliers - len(self.spines.shifts) :] = self.spines.gauge
        for rows, part in self._parts(points, at):
            work = _along(vary.forces(rows, part, self.tension, self.body), directions, rows)
            gradient += self._gather(work, rows.functions)
            scale += self._gather(np.abs(work), rows.functions)
            for k, held in enumerate(self._held):
                work = _along(vary.forces(rows, part, 0.0, held), directions, rows)
                columns[:, k] += self._gather(work, rows.functions)
        if self.trim is not None:
            inner = self.trim.on_line(points)
            cut = inner.table
            work = _along(line_forces(inner, self.tension, self.body), directions, cut)
            gradient += self._gather(work, cut.functions)
            scale += self._gather(np.abs(work), cut.functions)
            for k, held in enumerate(self._held):
                work = _along(line_forces(inner, 0.0, held), directions, cut)
                columns[:, k] += self._gather(work, cut.functions)
            functions = self.trim.ties.across[0]
            pull = self.tension * self.trim.ties.forces(points)
            work = np.einsum("eai,eai->ea", pull, directions[functions])
            gradient += self._gather(work, functions)
            gradient[self.trim.ties.idle], columns[self.trim.ties.idle] = 0.0, 0.0
        if self.contact is not None:
            rows = self._contact_rows
            push = self.contact.forces(self.contact.touch(points), rows)
            work = _along(push, directions, rows)
            gradient += self._gather(work, rows.functions)
            scale += self._gather(np.abs(work), rows.functions)
        if self.stabilizer is not None:
            rows, hold = self._wide, self.stabilizer.forces(points)
            work = _along(hold[:, self._columns], directions, rows)
            gradient += self._gather(work, rows.functions)
        for term, edge in self.lines:
            line = self._edge_rows(edge)
            forces = _again(term.forces(edge, points, term.strength, self.body), line)
            work = _along(forces, directions, line)
            gradient += self._gather(work, line.functions)
            scale += self._gather(np.abs(work), line.functions)
            for k, held in enumerate(self._held):
                forces = _again(term.forces(edge, points, 0.0, held), line)
                columns[:, k] += self._gather(_along(forces, directions, line), line.functions)
        for gap, edge in self._gaps:
            line = self._edge_rows(edge)
            numbers = self._held_numbers(edge)
            gradients = gap.gradients(edge, points)
            for k in range(edge.functions.shape[1]):
                work = _along(_again(gradients[:, k], line), directions, line)
                into = np.broadcast_to(numbers[:, k, None], work.shape)
                where = self.spines.unknowns[line.functions]
                keep = (into >= 0) & (where >= 0)
                np.add.at(columns, (where[keep], len(self._held) + into[keep]), work[keep])
        scale += np.abs(columns) @ np.abs(multipliers)
        return gradient, columns, scale

    def _second_order(
        self, points: Array, directions: Array, at: vary.ElementPoints, multipliers: Array
    ) -> Matrix:
        """Hessian of the Lagrangian."""
        body = self.density(multipliers)
        matrix = self._matrix()
        for rows, part in self._parts(points, at):
            blocks = vary.hessian(
                rows, part, self.tension, body, directions[rows.functions], self._kernels
            )
            matrix.add(self.spines.unknowns[rows.functions], blocks)
        if self.trim is not None:
            self._add_trim(matrix, points, directions, body)
        if self.contact is not None:
            rows = self._contact_rows
            near, blocks = self.contact.hessian(self.contact.touch(points), directions, rows)
            matrix.add(self.spines.unknowns[rows.functions[near]], blocks)
        if self.stabilizer is not None:
            rows = self._wide
            along = directions[rows.functions]
            blocks = self.stabilizer.hessian(points, rows, self._columns, along)
            matrix.add(self.spines.unknowns[rows.functions], blocks)
        for term, edge in self.lines:
            self._add_edge(
                matrix, directions, edge, term.hessian(edge, points, term.strength, body)
            )
        loads = self.line_load(multipliers)
        for gap, edge in self._gaps:
            load = -loads[edge.functions]
            self._add_edge(matrix, directions, edge, gap.hessian(edge, points, load))
        return matrix

    def _add_trim(
        self, matrix: Matrix, points: Array, directions: Array, body: BodyDensity
    ) -> None:
        """Add contact lines inside the membrane, the ties across cuts, and a unit for idle ones."""
        trim, unknowns = self.trim, self.spines.unknowns
        assert trim is not None
        for at, second in (
            (trim.on_line(points), line_hessian),
            (trim.on_ends(points), end_hessian),
        ):
            functions = at.table.functions
            blocks = second(at, self.tension, body, directions[functions])
            matrix.add(unknowns[functions], blocks)
        ties = trim.ties
        matrix.add(unknowns[ties.across[0]], self.tension * ties.hessian(directions))
        matrix.add(ties.idle[:, None], np.full((len(ties.idle), 1, 1), self.tension))

    def _add_edge(self, matrix: Matrix, directions: Array, edge: EdgeTable, blocks: Array) -> None:
        """Add edge blocks (elements, local, 3, local, 3) along directions."""
        line = self._edge_rows(edge)
        columns = _columns(line)
        d = directions[line.functions]
        blocks = blocks[:, columns][:, :, :, columns]
        matrix.add(
            self.spines.unknowns[line.functions],
            np.einsum("eai,eaibj,ebj->eab", d, blocks, d, optimize=True),
        )

    def mass(self, surface: Surface, directions: Array) -> Matrix:
        """Mass matrix of normal displacement; of all displacement where tangents move too."""
        at = vary.element_points(self.table, surface.points)
        matrix = self._matrix()
        full = self.stabilizer is not None
        for rows, part in self._parts(surface.points, at):
            blocks = vary.mass(rows, part, directions[rows.functions], full=full)
            matrix.add(self.spines.unknowns[rows.functions], blocks)
        return matrix

    def _row_groups(self) -> list[tuple[slice | Index, Table]]:
        """Elements and their tables by rows of the motion; elements at a curved solid have more
        rows than functions, and all have with three unknowns per control point."""
        table, spare = self.table, self.spines.spare
        if len(self.spines.shifts):
            shifted = (self.spines.share[table.functions] != 0.0).any(axis=1)
            moving, still = np.flatnonzero(shifted), np.flatnonzero(~shifted)
            foot = [(still, table.part(still))] if len(still) else []
            return [*foot, (moving, self._with_shifts(table.part(moving)))]
        touching = np.zeros(len(table.functions), bool)
        for extra in self.spines.extra:
            touching |= (extra[table.functions] < spare).any(axis=1)
        if not touching.any():
            return [(slice(None), table)]
        if touching.all():
            return [(slice(None), self._wide)]
        near, rest = np.flatnonzero(touching), np.flatnonzero(~touching)
        edge = table.part(near)
        return [(rest, table.part(rest)), (near, edge.with_columns(*self._extra(edge.functions)))]

    def _extra(self, functions: Index) -> tuple[Index, Index]:
        """Which local functions have further rows of the motion, and those rows."""
        spare = self.spines.spare
        columns, rows = [], []
        for extra in self.spines.extra:
            more = extra[functions]
            own = np.flatnonzero((more < spare).any(axis=0))
            columns.append(own)
            rows.append(more[:, own])
        return np.concatenate(columns), np.hstack(rows)

    @cached_property
    def _wide(self) -> Table:
        """The table with three rows of the motion for every control point."""
        return self.table.with_columns(*self._extra(self.table.functions))

    @property
    def _columns(self) -> Index:
        """Which function belongs to each row of :attr:`_wide`."""
        return np.tile(np.arange(self.table.functions.shape[1]), 3)

    def _with_shifts(self, table: Table) -> Table:
        if not len(self.spines.shifts):
            return table
        rows = self.spines.spare + 1 + np.arange(len(self.spines.shifts))
        return table.with_field(self.spines.share, rows.tolist())

    @cached_property
    def _shifted_table(self) -> Table:
        return self._with_shifts(self.table)

    @cached_property
    def _contact_rows(self) -> Table:
        assert self.contact is not None
        if isinstance(self.spines, Cartesian):
            return self._wide  # a penalty acts at the quadrature points
        return self._with_shifts(self.contact.table)

    def _edge(self, edge: str) -> EdgeTable:
        return self._space.edge_table(edge, self.points[0], self._ring_elements)

    def _edge_rows(self, edge: EdgeTable) -> EdgeTable:
        """An edge's table by rows of the motion."""
        columns, rows = self._extra(edge.functions)
        return edge.with_columns(columns, rows) if len(columns) else edge

    def _held_numbers(self, edge: EdgeTable) -> Index:
        """(elements, local) number of the gap constraint of each function, -1 for none."""
        return self.spines.held[self.spines.second[edge.functions]]

    def _gather(self, values: Array, rows: Index) -> Array:
        """(n,) sums of element contributions by unknown; rows without one are dropped."""
        where = self.spines.unknowns[rows]
        sums = np.bincount(where.ravel() + 1, values.ravel(), self.size + 1)[1:]
        return sums.astype(float, copy=False)

    def _matrix(self) -> Matrix:
        if self.size <= DENSE_LIMIT:
            return Matrix(self.size)
        if self.trim is None:
            return Matrix(self.size, self._pattern)
        if self._tied is not self.trim.ties.across:
            self._tied = self.trim.ties.across
            tables = self._shifted_table.functions, self._tied[0]
            groups = [self.spines.unknowns[functions] for functions in tables]
            self._pattern = SparsePattern(self.size - len(self.spines.shifts), groups)
        return Matrix(self.size, self._pattern)

    @cached_property
    def _pattern(self) -> SparsePattern:
        return SparsePattern(
            self.size - len(self.spines.shifts),
            [self.spines.unknowns[rows.functions] for _, rows in self._groups],
        )


def _motion(scene: Scene, surface: Surface, supports: tuple[Support, ...]) -> Spines:
    """The motion that a scene asks for."""
    if scene.motion == "cartesian":
        return Cartesian(surface, supports)
    return Spines(surface, supports, scene.directions)


def _same_contact(one: Contact | None, other: Contact | None) -> bool:
    """Whether two scenes have the same solid and the same law of contact."""
    if one is None or other is None or type(one.solid) is not type(other.solid):
        return False
    laws = [(c.penalty, c.depth, c.adhesion) for c in (one, other)]
    fields = [vars(c.solid) for c in (one, other)]
    return laws[0] == laws[1] and all(
        np.array_equal(fields[0][key], fields[1][key])
        for key in fields[0]
        if not key.startswith("_")
    )


def _along(forces: Array, directions: Array, rows: Table | EdgeTable | LineTable) -> Array:
    """(elements, local) work of forces along the rows' directions."""
    return np.einsum("eai,eai->ea", forces, directions[rows.functions])


def _columns(line: EdgeTable) -> Index:
    """Which function of the edge belongs to each of its rows."""
    local = line.functions.shape[1] - len(line.repeated)
    return np.concatenate([np.arange(local), line.repeated])


def _again(forces: Array, line: EdgeTable) -> Array:
    """Forces by function, repeated for the second rows."""
    return forces[:, _columns(line)]
