"""The membrane outside its solids: which elements count, and quadrature where lines cut them."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field
from typing import TypeGuard

import numpy as np

from ..arrays import Array, Index, Mask
from ..deadline import check_time
from ..dofs.dof_map import FirstOrder, Rows
from ..dofs.spines import Motion
from ..linalg.bordered import Matrix
from ..problems.scene import Scene
from ..solids import Solid
from ..splines import LineTable, Space, Table, cut, faces_between, folded_pairs
from ..surface.bezier import BezierPatches, bezier_net
from ..surface.surface import Surface
from ..terms import BodyDensity, TrimmedContactLine
from ..terms.trimmed import CapDensity, Line, on_line, wet_integral
from ..terms.variations import ElementPoints, element_points, flux
from .ghost_penalty import Ties
from .laws import line_of
from .model import ContactModel, another_way
from .patches import ContactPatches, behind
from .spot_cores import Cores
from .unfitted_lines import add_forces, add_hessian
from .unfitted_patches import Spots, patches_of

ON_LINE = 1e-7
"""Gap over the contact length that points of a contact line may have."""
SMOOTH = 4.0
"""Factor of the ghost penalty on solids without an inside, over that on asperities: on egg cartons
and grooves 7 iterations instead of 20 to 35, for 6e-5 of the wetted area (10: as many, 2e-4)."""
EXTRA = 4
"""Gauss points beyond the degree in cut elements: the Hessian is that of the exact integrals."""


@dataclass(frozen=True, eq=False)
class Outside:
    """The part of the membrane outside the solid, at one state.

    Attributes
    ----------
    share : (elements,) 1 for elements wholly outside, 0 for others.
    touched : (elements,) whether an element is cut.
    area : functions in the outer parts of cut elements, by pieces.
    line, ends : functions on contact lines and at the ends of their pieces.
    lines : control points with the geometry on their lines, where it has been asked for.
    """

    share: Array
    touched: Mask
    area: Table
    line: LineTable
    ends: LineTable
    lines: list[tuple[Array, Line]] = field(default_factory=list)


class Unfitted(ContactModel):
    """What lies outside the solid of a term, on one sector.

    Parameters
    ----------
    table : functions of the sector's elements at ordinary quadrature points.
    elements, portion : (elements,) of the space, and the portion of each that is in the sector.
    images : matrices (3, 3) that carry the sector to each of its images.
    element : size of the elements at the solid over the contact length.
    unknowns : (rows,) unknown of each control point, -1 for none; size : their number.
    smooth : whether the solid is a surface without an inside, no small body.
    """

    passes = True
    depth_allowed = 1e-3  # lines push it there: near 180 degrees an equilibrium dips by 2e-4

    def __init__(
        self,
        term: TrimmedContactLine,
        space: Space,
        table: Table,
        elements: Index,
        portion: Array,
        images: list[Array],
        element: float,
        unknowns: Index,
        size: int,
        smooth: bool,
    ) -> None:
        self.term, self.space, self.table = term, space, table
        self.elements, self.portion = elements, portion
        self._images, self._element = images, element
        self._smooth = smooth
        self._faces, self._folds = faces_between(space, elements), folded_pairs(space, elements)
        own = unknowns[: space.count]
        self.ties = Ties(space, elements, portion, self._faces, own, size)
        self._points = space.degree + EXTRA
        self.firm(1.0)
        self._known: list[tuple[Array, Outside]] = []
        self._cores = Cores.none()
        self._restart()

    def released(self) -> Unfitted:
        free = copy(self)
        free.ties = copy(self.ties)
        free.ties.idle = np.zeros(0, int)
        return free

    def again(self, scene: Scene, made: Callable[[], ContactModel]) -> ContactModel:
        term = line_of(scene)
        if term is None:
            raise another_way()
        self.term = term
        self._known.clear()
        return self

    def begin(self, surface: Surface) -> None:
        self._restart()
        self.hold(surface.points)

    def wetted(self, points: Array) -> float:
        return self.wetting(points)[0]

    def firm(self, factor: float) -> None:
        self.ties.firmness = factor * (SMOOTH if self._smooth else 1.0)

    def _restart(self) -> None:
        """Free to choose again what is tied; spots are where they were."""
        least = np.min(self.term.angles_of_substrate, initial=180.0)
        self.ties.begin(np.pi - np.radians(float(least)), self._element)
        self._known.clear()

    @property
    def solid(self) -> Solid:
        """That the membrane passes through."""
        return self.term.solid

    @property
    def length(self) -> float:  # type: ignore[override]
        return self.term.solid.scale

    @property
    def tied(self) -> Index:
        return self.ties.across[0]

    @property
    def idle(self) -> Index:
        return self.ties.idle

    def counts(self, points: Array, elements: int) -> Mask:
        at = self.outside(points)
        return np.asarray(at.touched | (at.share > 0))

    def outside(self, points: Array) -> Outside:
        """The outer part for control points (count, 3)."""
        for known, found in self._known:
            if known is points:
                return found
        found = self.cut(points, self._points)
        self._known = [(points, found), *self._known[:2]]
        return found

    def on_line(self, points: Array, outside: Outside | None = None) -> Line:
        """Geometry on the contact lines, with other quadrature if another cut is given."""
        outside = outside or self.outside(points)
        for known, found in outside.lines:
            if known is points:
                return found
        found = on_line(self.term, outside.line, points)
        outside.lines[:] = [(points, found)]
        return found

    def on_ends(self, points: Array) -> Line:
        """Geometry at the ends of their pieces."""
        return on_line(self.term, self.outside(points).ends, points)

    def parts(
        self, points: Array, at: ElementPoints, rows: Rows
    ) -> list[tuple[Table, ElementPoints]]:
        outside = self.outside(points)
        whole, cut = (rows.shifted.weighted(outside.share), at), outside.area
        return [whole, (cut, element_points(cut, points))] if len(cut.functions) else [whole]

    def extended(self, vectors: Array, motion: Motion) -> Array:
        return self.ties.extended(vectors, motion.directions[: len(vectors)])

    def largest(self, table: Table, points: Array, displacement: Array) -> float:
        """Size of a displacement: the membrane's own, since some of its control points move it
        hardly at all."""
        rows = table.part(np.flatnonzero(self.counts(points, len(self.elements))))
        moved = rows.values @ displacement[rows.functions]
        return float(np.linalg.norm(moved, axis=-1).max(initial=0.0))

    def near_contact(self, table: Table, points: Array, displacement: Array) -> float:
        rows = table.part(np.flatnonzero(self.near(points)))
        moved = rows.values @ displacement[rows.functions]
        return float(np.linalg.norm(moved, axis=-1).max(initial=0.0)) / self.length

    def aids(self, points: Array, tension: float) -> float:
        return tension * self.ties.energy(points)

    def add_forces(
        self,
        total: FirstOrder,
        points: Array,
        tension: float,
        body: BodyDensity,
        held: list[BodyDensity],
    ) -> None:
        add_forces(total, self, points, tension, body, held)

    def add_hessian(
        self,
        matrix: Matrix,
        rows: Rows,
        points: Array,
        directions: Array,
        tension: float,
        body: BodyDensity,
    ) -> None:
        add_hessian(matrix, rows, self, points, directions, tension, body)

    def spots(self, surface: Surface, images: list[Array]) -> Spots:
        """The wetted spots of a state."""
        return Spots(self.on_line(surface.points), self.term, images)

    def patches(
        self, surface: Surface, images: list[Array], tension: float, body: BodyDensity
    ) -> ContactPatches:
        return patches_of(self.spots(surface, images), tension, body)

    def on_substrate(self, which: Index) -> Mask:
        return np.asarray(self.term.particle(which) < 0)

    def without_line(self, which: Index, particles: int) -> list[int]:
        own = set(self.term.particle(which).tolist())
        return [k for k in range(particles) if k not in own]

    def objection(self, points: Array) -> str | None:
        known = getattr(self.solid, "knows", None)
        if known is None or known(self.on_line(points).x).all():
            return None
        return "the contact line has left the measured map of the substrate: give a larger one"

    def behind(self, table: Table, surface: Surface) -> Array:
        at = element_points(table, surface.points)
        lines = self.on_line(surface.points).at.which
        which = behind(self.solid.nearest(at.x), at, 2.0 * self.length)
        return self.solid.center_of(np.setdiff1d(which, lines))

    def reaches(self, base: float, table: Table, points: Array, which: Index) -> bool:
        """It does not notice the plane, so its height counts."""
        x = (table.values @ points[table.functions])[self.outside(points).share > 0]
        return bool((x[..., 2] <= base).any())

    def wetting(self, points: Array) -> tuple[float, float]:
        """Energy of the wetted surface and its area."""
        line, term = self.on_line(points), self.term
        area = wet_integral(line, lambda x, normal, which: np.ones(which.shape))
        gain = wet_integral(line, lambda x, normal, which: term.cosine(x, which)[0])
        return float(-term.gamma * gain.sum()), float(area.sum())

    def cap(self, points: Array, density: CapDensity, outside: Outside | None = None) -> float:
        """Integral over the wetted surface."""
        return float(wet_integral(self.on_line(points, outside), density).sum())

    def under(self, points: Array, body: BodyDensity, outside: Outside | None = None) -> float:
        return self.cap(points, lambda x, n, which: -flux(body, x) * n[..., 2], outside)

    def true(self, points: Array) -> bool:
        """Whether contact lines lie on the solid, not on the border of a spot's core."""
        gap = self.on_line(points).at.gap
        return bool((np.abs(gap) <= ON_LINE * self.length).all())

    def near(self, points: Array) -> Array:
        """(elements,) whether an element is near the solid."""
        x = self.table.values @ points[self.table.functions]
        return np.asarray((self.term.solid.nearest(x).gap < self.length).any(axis=1))

    def cut(self, points: Array, count: int) -> Outside:
        """Cut the elements, with ``count`` Gauss points along each piece."""
        x, a1, a2 = self.table.derivatives(points)
        gap = self.term.solid.nearest(x).gap
        sizes = [b.sizes for b in self.space.bases]
        e1, e2 = np.divmod(self.elements, self.space.bases[1].elements)
        reach = np.linalg.norm(a1, axis=-1).max(axis=1) * sizes[0][e1]
        reach = reach + np.linalg.norm(a2, axis=-1).max(axis=1) * sizes[1][e2]
        least, most = gap.min(axis=1), gap.max(axis=1)
        sign = np.where(least > reach, 1, -1)
        near = np.flatnonzero((least <= reach) & (most >= -reach))
        nets = bezier_net(Surface(self.space, points), self.elements[near])
        patches = BezierPatches(nets[..., :3])

        def level(rows: Index, u: Array) -> tuple[Array, Array, Index]:
            check_time()
            x, slopes = patches.at(rows, u)
            at = self.term.solid.nearest(x)
            depth, outward = self._cores.depth(x, at.which, self.term)
            return at.gap - depth, np.einsum("kqci,kqi->kqc", slopes, at.normal + outward), at.which

        made = cut(level, len(near), count)
        sign[near] = made.sign
        whole = self._connected(sign >= 0)
        keep = [whole[near[p.rows]] for p in (made.area, made.line, made.ends)]
        area, line, ends = (
            p.part(k) for p, k in zip((made.area, made.line, made.ends), keep, strict=True)
        )
        owner = made.ends_line[keep[2]]
        return Outside(
            ((sign > 0) & whole).astype(float),
            (sign == 0) & whole,
            self._area_table(near[area.rows], area.u, area.weights),
            self._line_table(
                near[line.rows],
                line.u,
                line.weights,
                made.across[keep[1]],
                made.rising[keep[1]],
                True,
            ),
            self._line_table(
                near[ends.rows], ends.u, ends.weights, made.across[owner], made.rising[owner], False
            ),
        )

    def _find_cores(self, points: Array) -> None:
        """Know the wetted spots of a state, for the next ones."""
        # where a solid has no inside, the membrane cannot come out of it again
        self._cores = (
            Cores.none()
            if self._smooth
            else Cores.inside(self.on_line(points), self.term, self._images)
        )
        self._known.clear()

    def _connected(self, active: Mask) -> Mask:
        """Those of the active elements that hang together with most of them."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        pairs = [(self._faces.first, self._faces.second), self._folds]
        first, second = (np.concatenate(ends) for ends in zip(*pairs, strict=True))
        both, count = active[first] & active[second], len(active)
        graph = coo_array((np.ones(both.sum()), (first[both], second[both])), (count, count))
        _, label = connected_components(graph, directed=False)
        largest = np.bincount(label[active]).argmax() if active.any() else -1
        return np.asarray(active & (label == largest))

    def _area_table(self, rows: Index, u: Array, weights: Array) -> Table:
        chosen = self.elements[rows]
        table = self.space.inside(chosen, u, 1)
        scale = self._sizes(chosen).prod(axis=1) * self.portion[rows]
        return Table(
            self.table.functions[rows],
            table[0, 0],
            table[1, 0],
            table[0, 1],
            weights * scale[:, None],
            u,
        )

    def _line_table(
        self, rows: Index, u: Array, weights: Array, across: Index, rising: Index, along: bool
    ) -> LineTable:
        chosen = self.elements[rows]
        table = self.space.inside(chosen, u, 2)
        scale = self.portion[rows]
        if along:
            scale = scale * self._sizes(chosen)[np.arange(len(rows)), 1 - across]
        keys = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        return LineTable(
            self.table.functions[rows],
            tuple(table[key] for key in keys),
            weights * scale[:, None],
            across,
            rising,
        )

    def _sizes(self, elements: Index) -> Array:
        """(k, 2) sizes of elements in the parameters."""
        e1, e2 = np.divmod(elements, self.space.bases[1].elements)
        return np.stack([self.space.bases[0].sizes[e1], self.space.bases[1].sizes[e2]], axis=1)

    def hold(self, points: Array) -> None:
        """Choose what is tied and what is idle."""
        self._find_cores(points)
        middle = (self.table.values @ points[self.table.functions]).mean(axis=1)
        nearest = self.term.particle(self.term.solid.nearest(middle).which)
        self.ties.hold(
            self.counts(points, len(self.elements)), self.outside(points).touched, nearest >= 0
        )


def is_unfitted(model: ContactModel) -> TypeGuard[Unfitted]:
    """Whether a model has contact lines inside the membrane."""
    return isinstance(model, Unfitted)
