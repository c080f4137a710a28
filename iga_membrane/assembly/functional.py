"""Energy and constraints of a scene: what the solver makes stationary, without derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from time import thread_time

import numpy as np

from ..arrays import Array, Mask
from ..contact.binding import model_of
from ..contact.edge_lines import EdgeLines
from ..deadline import check_time
from ..dofs.boundary_conditions import Supports
from ..dofs.cartesian import Cartesian
from ..dofs.dof_map import Rows
from ..dofs.spines import Motion, Spines
from ..dofs.symmetry import sector_table
from ..problems.scene import Scene
from ..splines import Table
from ..surface.surface import Surface
from ..terms import BodyDensity, Stabilization, gap
from ..terms import variations as vary
from .stabilizer import Stabilizer, Unstabilized


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
    counts : (elements,) whether an element has a part outside the solids.
    """

    total: float
    constraints: Array
    area_vectors: Array
    lowest: float
    true: bool
    counts: Mask

    def regular_after(self, before: Energies) -> bool:
        """Finite, and nowhere folded over against the state before it."""
        both = self.counts & before.counts
        dot = np.einsum("eqi,eqi->eq", self.area_vectors[both], before.area_vectors[both])
        return bool(self.true and np.isfinite(self.total) and (dot > 0).all())


class Functional:
    """Energy and constraints of a scene, on one sector in the scene's scale.

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
        self._supports, self._kind = scene.local_supports(), scene.motion
        self.spines = _motion(scene, surface, self._supports)
        self.size = self.spines.size
        ring = space.bases[0]
        around = max(3, ring.degree) if ring.periodic and ring.smooth else ring.degree + 1
        self.points = (points, points) if points else (around, space.bases[1].degree + 1)
        self.table = sector_table(space, sector, self.points)
        self.rows = Rows(self.spines, self.table)
        self.seconds = 0.0
        self._ring = np.arange(ring.elements // sector.copies)
        self._space, self._start = space, surface
        self.contact = model_of(scene, surface, self.points, self.rows)
        self.stabilizer = Unstabilized()
        self._kept: Motion | None = None
        self.above_plane = bool(scene.by_kind.on_plane)
        self.load(scene)

    def motion(self, surface: Surface) -> Motion:
        """The spines on a surface, or those that are kept."""
        return self._kept or self.spines.on(surface)

    def keep_motion(self, surface: Surface) -> None:
        """From now on move along the spines of a surface: what lies inside solids follows them, so
        they must not follow it."""
        self._kept = self.spines.on(surface)

    def load(self, scene: Scene) -> None:
        """Take the terms of another scene of the same space, whose supports move the same edges,
        and its motion.

        Raises
        ------
        GeometryError
            Contact areas in the one, contact lines inside the membrane in the other.
        """
        terms, supports = scene.local_terms(), scene.local_supports()
        if (supports, scene.motion) != (self._supports, self._kind):
            self.spines = _motion(scene, scene.local_surface(), supports)
            self.size = self.spines.size
            self.rows = Rows(self.spines, self.table)
        if scene.motion != self._kind:
            self.stabilizer, self._start = Unstabilized(), scene.local_surface()
            self.contact = model_of(scene, self._start, self.points, self.rows)
        self._supports, self._kind = supports, scene.motion
        self.constraints = terms.constraints
        self.tension = terms.tension
        self.gaps = terms.gaps
        self._bodies = [term.density() for term in terms.bodies]
        self.held = [t.density() for t in self.constraints]
        self._targets = np.array([t.target for t in self.constraints]) / self.copies
        self.edges = EdgeLines(scene, self._space, self.points[0], self._ring, self.rows)
        self.contact = self.contact.again(
            scene, lambda: model_of(scene, self._start, self.points, self.rows)
        )
        self.contact.by(self.rows)

    def anew(self, surface: Surface) -> Surface:
        """The start, as far away as the top of a surface has been shifted."""
        start = self.spines.anew(surface)
        self.contact.follow(start)
        return start

    def begin_step(self, surface: Surface, term: Stabilization) -> None:
        """Let a load step of the paper's formulation start from a state: its metric is ``a_pre`` of
        eq. (23), and tractions of the penalty count per area of it."""
        normals = self.spines.on(surface).directions[: self._space.count].copy()
        if self.contact.lies and self.edges.wetted:
            # the contact line is a kink, which has no tangent plane
            normals[self._space.edge_functions(self.edges.wetted[0][0].edge)] = 0.0
        stabilizer = Stabilizer(term, self.table, surface.points, normals)
        self.contact.begin_step(stabilizer.before.area)
        self.stabilizer = stabilizer

    @property
    def multipliers(self) -> int:
        """Number of multipliers: of the constraints, then of the edges held on solids, then of the
        shifts' gauge."""
        return len(self.held) + self.edges.gap_count + len(self.spines.shifts)

    def line_load(self, multipliers: Array) -> Array:
        """(count,) coefficients of the load with which a curved solid holds its edge."""
        first = len(self.held)
        loads = np.append(multipliers[first : first + self.edges.gap_count], 0.0)
        return loads[self.spines.held[self.spines.second]]

    @property
    def body(self) -> BodyDensity:
        """Sum of the body densities that are not constraints."""
        return sum(self._bodies, BodyDensity())

    def density(self, multipliers: Array) -> BodyDensity:
        """Body density of the Lagrangian."""
        held = (d * -float(m) for d, m in zip(self.held, multipliers, strict=False))
        return sum(held, self.body)

    def energies(self, surface: Surface) -> Energies:
        """Energy and constraints of a state."""
        start = thread_time()
        points = surface.points
        found = self.energies_at(points, vary.element_points(self.table, points))
        self.seconds += thread_time() - start
        return found

    def energies_at(self, points: Array, at: vary.ElementPoints) -> Energies:
        """The same, its geometry at the quadrature points being known."""
        check_time()
        total, constraints = self.values(points, at)
        total += sum(gap.energy(self.table, at, law.at(at.x)) for law in self.gaps)
        total += self.contact.energy(points) + self.contact.aids(points, self.tension)
        total += self.stabilizer.energy(points)
        true, counts = self.contact.true(points), self.contact.counts(points, len(at.c))
        lowest = float(at.x[counts, :, 2].min(initial=np.inf))
        return Energies(total, constraints, at.c, lowest, true, counts)

    def energy(self, surface: Surface) -> float:
        """Energy of the liquid and its contact, without what ties the control points."""
        return self.energies(surface).total - self.contact.aids(surface.points, self.tension)

    def body_integral(self, surface: Surface, density: BodyDensity) -> float:
        """Integral of a density over the liquid of one sector, its part under the foot included."""
        points = surface.points
        at = vary.element_points(self.table, points)
        return float(self._integrals(points, at, 0.0, [density])[1])

    def interface(self, surface: Surface) -> tuple[float, float, float]:
        """Area of the membrane, energy of the wetted surface and its area (one sector)."""
        points = surface.points
        at = vary.element_points(self.table, points)
        area = sum(vary.energies(rows, part, [])[0] for rows, part in self.parts(points, at))
        energy, wet = self.edges.wetting(points)
        inside = self.contact.wetting(points)
        return area, energy + inside[0], wet + inside[1]

    def whole(self, vector: Array) -> Array:
        """(3,) sum over all sectors of a vector integrated over one."""
        return np.asarray(self.copies * np.where(self._mirrored, 0.0, vector))

    def parts(
        self, points: Array, at: vary.ElementPoints
    ) -> list[tuple[Table, vary.ElementPoints]]:
        """Tables by rows of the motion, and the geometry there, that make up the membrane."""
        return self.contact.parts(points, at, self.rows)

    def values(self, points: Array, at: vary.ElementPoints) -> tuple[float, Array]:
        """Energy of the liquid, and the prescribed integrals minus their values."""
        interface, body, *held = self._integrals(points, at, self.tension, [self.body, *self.held])
        # every step keeps to the gauge, which is linear
        gauge = np.zeros(len(self.spines.shifts))
        missing = np.array(held) - self._targets
        gaps = self.edges.gap_values(points)
        return interface + body, np.concatenate([missing, gaps, gauge])

    def _integrals(
        self, points: Array, at: vary.ElementPoints, tension: float, bodies: list[BodyDensity]
    ) -> Array:
        """Energy of the interface and the wetted surface, then the body integrals."""
        total = np.zeros(1 + len(bodies))
        for rows, part in self.parts(points, at):
            area, integrals = vary.energies(rows, part, bodies)
            total[0] += tension * area
            total[1:] += integrals
        total[0] += self.contact.wetted(points) if tension else 0.0
        total[1:] += [self.contact.under(points, body) for body in bodies]
        for term, edge in self.edges.lines:
            none = BodyDensity()
            total[0] += term.energy(edge, points, term.strength, none) if tension else 0.0
            total[1:] += [term.energy(edge, points, 0.0, body) for body in bodies]
        return total


def _motion(scene: Scene, surface: Surface, supports: Supports) -> Spines:
    """The motion that a scene asks for."""
    if scene.motion == "cartesian":
        return Cartesian(surface, supports, scene.directions)
    return Spines(surface, supports, scene.directions)
