"""Contact in the unknowns: exact by multipliers, or the paper's penalty.

Exact contact holds the gap of one point of every element, its middle, at zero or above: as many
points as control points, so the tractions there are determined. Where the membrane still dips into
the solid beside that point, by more than is allowed, the point is lifted by the depth. The
augmented Lagrangian

    sum_q w_q / 2 ((delta + c) t_q^2 - delta lambda_q^2),
    t_q = (delta lambda_q - g_q)_+ / (delta + c),

is once differentiable, so Newton's method with a line search serves from any start; its active set
is ``delta lambda_q > g_q``. Multipliers are updated and ``delta`` is reduced as the steps become
small, in the manner of the primal-dual active set method (Hueber, Wohlmuth,
doi 10.1016/j.cma.2004.08.011). Exact contact has no compliance ``c``; a
hard penalty is one, by which each point sinks. A soft penalty is the same without multipliers, at
all quadrature points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeGuard

import numpy as np

from ..arrays import Array, Index
from ..dofs.dof_map import FirstOrder, Rows
from ..linalg.bordered import Matrix
from ..problems.scene import Scene
from ..solids import Nearest, Plane, Spheres
from ..splines import Space, Table
from ..surface.surface import Surface
from ..terms import BodyDensity, Contact
from ..terms.variations import element_points
from .laws import law_of, same_law
from .model import ContactModel, another_way
from .obstacle_patches import patches_of
from .patches import ContactPatches, behind
from .touch import Touch

SOFT = 0.025
"""First ``delta`` over the squared contact length: sinks about a twentieth of an asperity."""
HARDER = 0.03
"""Factor of one tightening."""
HARD = 0.01
"""Last ``delta`` over the area of the element: a tenth of what the membrane itself gives on the
scale of an element, so that the multipliers of its shortest waves settle too."""
SAMPLES = 12
"""Points along an element at which the membrane's depth is sampled."""
LIFTS = 20
"""How often the contact points are lifted at most."""
RANGE = 1.0
"""Range of adhesion over the gap at which a membrane has left the solid after one element."""
ACROSS = 4
"""Elements across a wet asperity that resolve it."""
HIGH = 4.0
"""Height above spheres, over the contact length, from which they are not searched."""
POINTS = 6
"""Quadrature points in contact on every wet asperity, in the mean, that resolve its spot."""
STEADY = 0.5
"""Part of the depth that a contact gives way, as the largest step before it is made harder."""
SETTLED = 1e-6
"""Gap of an active point over the contact length that counts as none."""
LIES = 2e-4
"""Gap of a start that lies on its solid, over the contact length: what its spline misses there."""
TINY = 1e-300
GIVEN = 3e-5
"""Depth by compliance over the contact length below which gaps count as none by the depth."""


class Obstacle(ContactModel):
    """The contact of a membrane that lies on a solid, on one sector.

    Parameters
    ----------
    law : with its solid, in the scene's scale.
    table : functions of the membrane at the contact points.
    area : (elements, points) reference area of each contact point.
    space : of the membrane, and elements : (elements,) of it, to sample the depth.
    rows : of the motion.

    Attributes
    ----------
    length : contact length: the smallest radius, at most the scene's own length.
    elements : (elements,) of the space.
    multipliers : (elements, points) tractions, >= 0.
    settled : whether the multipliers hold the gap; rounds : their updates so far.
    asked : the law, in the scene's scale.
    resolves : whether the mesh resolves what the membrane lies on.
    """

    def __init__(
        self,
        law: Contact,
        table: Table,
        area: Array,
        space: Space,
        elements: Index,
        rows: Rows,
    ) -> None:
        solid, penalty, adhesion = law.solid, law.penalty, law.adhesion
        self.asked = law
        self.solid, self.table, self.area = solid, table, area
        self.by(rows)
        self.elements = elements
        self._space, self._depth, self.adhesion = space, law.depth, adhesion
        self._compliance = law.compliance
        self._lift = np.zeros(area.shape)
        self._lifts = LIFTS
        self._known: tuple[Array, Nearest] | None = None
        self.length = min(solid.scale, 1.0)
        self.exact = penalty is None
        self.multipliers: Array = np.zeros(area.shape)
        self._size = area.sum(axis=1)
        self._hard = HARD * self._size[:, None]
        # a membrane that leaves at the angle psi, 1 - cos(psi) = adhesion, is so far off after an
        # element
        self._range = RANGE * np.sqrt(2.0 * adhesion * self._size)[:, None]
        self._soft = np.maximum(SOFT * self.length**2, self._hard)
        if law.traction:
            self._soft = self._hard  # no gap has to be made by giving way
        if isinstance(solid, Plane):
            self._soft = self._hard / HARDER  # a plane has no length; the start lies on it
        self.delta: Array = self._soft if penalty is None else np.array(1.0 / penalty)
        self.settled = not self.exact
        self.rounds = 0

    lies = carries = True
    resolves = True

    def again(self, scene: Scene, made: Callable[[], ContactModel]) -> ContactModel:
        law = law_of(scene)
        if law is None:
            raise another_way()
        if same_law(law, self.asked):
            return self
        new = made()
        new.recall(self.memory)
        return new

    def by(self, rows: Rows) -> None:
        self._rows, self._by_rows = rows, rows.of(self.table)

    @property
    def reach(self) -> float:  # type: ignore[override]
        return self.length

    @property
    def law(self) -> str:  # type: ignore[override]
        """In a word."""
        return "multipliers" if self.exact and not self._compliance else "penalty"

    def leaving(self, which: Index, tension: float) -> Array:
        """Angles in radians at which the membrane leaves spheres, pi minus the contact angles."""
        return np.full(np.shape(which), np.arccos(1.0 - self.adhesion / tension))

    @property
    def memory(self) -> Array:
        """What a solve at the next load needs to know: the multipliers."""
        return self.multipliers.copy()

    def recall(self, memory: Array) -> None:
        """Take the :attr:`memory` of another contact of the same membrane."""
        self.multipliers = memory.copy()

    def begin_step(self, area: Array) -> None:
        self.area = area

    def expect(self, points: Array, traction: float) -> None:
        """Begin with a traction wherever the membrane with these control points lies."""
        if self.exact:
            self.multipliers = np.where(
                self._nearest(points).gap <= LIES * self.length, traction, 0.0
            )

    def begin(self, surface: Surface) -> None:
        """Soft again and without lifts, from the multipliers at hand."""
        self.follow(surface)
        self.rounds = 0
        if self.exact:
            self.delta, self.settled = self._soft, False
            self._lift[:], self._lifts = 0.0, LIFTS

    def touch(self, points: Array) -> Touch:
        """Gaps and tractions for control points (count, 3)."""
        at = self._nearest(points)
        gap = at.gap - self._lift
        give = self.delta + self._compliance
        traction = np.maximum(self.delta * self.multipliers - gap, 0.0) / give
        if not self.adhesion:
            none = np.zeros_like(gap)
            return Touch(at, traction, none, none, none)
        s = np.clip(gap / self._range, 0.0, 1.0)
        inside = (s > 0.0) & (s < 1.0)
        pull = self.adhesion / self._range * 4.0 * s * (1.0 - s**2)
        rise = self.adhesion / self._range**2 * (4.0 - 12.0 * s**2) * inside
        return Touch(at, traction, (1.0 - s**2) ** 2, pull, rise)

    def _nearest(self, points: Array) -> Nearest:
        """Nearest surfaces at the contact points, known for the last control points."""
        if self._known is None or self._known[0] is not points:
            x = self.table.values @ points[self.table.functions]
            self._known = points, self._nearest_of(x)
        return self._known[1]

    def _nearest_of(self, x: Array) -> Nearest:
        """Exact for points (..., 3) near spheres; high above them only their height counts, since
        searching there costs far more than near them."""
        if not isinstance(self.solid, Spheres):
            return self.solid.nearest(x)
        top = float((np.asarray(self.solid.centers)[:, 2] + self.solid.radii).max())
        low = x[..., 2] <= top + HIGH * self.length
        up, none = np.zeros_like(x), np.zeros(x.shape[:-1])
        up[..., 2] = 1.0
        at = Nearest(x[..., 2] - top, up, none, np.full(x.shape[:-1], -1))
        near = self.solid.nearest(x[low])
        for name in ("gap", "normal", "bend", "which"):
            getattr(at, name)[low] = getattr(near, name)
        return at

    def wetting(self, points: Array) -> tuple[float, float]:
        """Energy that adhesion gains, and no area inside lines."""
        if not self.adhesion:
            return 0.0, 0.0
        return -float(self.adhesion * (self.touch(points).gain * self.area).sum()), 0.0

    def loads(self, points: Array) -> Iterator[tuple[Table, Array]]:
        yield self.table, self.push(self.touch(points))

    def push(self, touch: Touch) -> Array:
        """(elements, points, 3) forces of the solid on the membrane."""
        load = (touch.traction - touch.pull) * self.area
        return np.asarray(load[..., None] * touch.at.normal)

    def energy(self, points: Array) -> float:
        """Energy of the penalty or of the augmented Lagrangian."""
        touch = self.touch(points)
        taken, known = touch.traction**2, self.multipliers**2
        square = self.delta * (taken - known) + self._compliance * taken
        held = 0.5 * (square * self.area).sum()
        return float(held - self.adhesion * (touch.gain * self.area).sum())

    def forces(self, touch: Touch, table: Table | None = None) -> Array:
        """(elements, local, 3) derivative of the energy by the local control points, or by the
        local functions of another table at the contact points."""
        table = self.table if table is None else table
        return np.asarray(table.values.transpose(0, 2, 1) @ -self.push(touch))

    def hessian(
        self, touch: Touch, directions: Array, table: Table | None = None
    ) -> tuple[Index, Array]:
        """Elements in contact and the second derivative along directions of the table's rows."""
        table = self.table if table is None else table
        near = np.flatnonzero((touch.traction + np.abs(touch.rise) > 0).any(axis=1))
        rows, at = table.values[near], touch.at
        d = directions[table.functions[near]]
        bent = self.area[near] * (touch.traction - touch.pull)[near] * at.bend[near]
        stiff = (self.area * self.stiffness(touch))[near]
        u = rows * (at.normal[near] @ d.transpose(0, 2, 1))
        blocks = (u * (stiff + bent)[..., None]).transpose(0, 2, 1) @ u
        blocks -= (rows * bent[..., None]).transpose(0, 2, 1) @ rows * (d @ d.transpose(0, 2, 1))
        if at.ridge is not None:
            across = rows * (at.ridge[near] @ d.transpose(0, 2, 1))
            load = (self.area * (touch.traction - touch.pull))[near]
            blocks -= (across * load[..., None]).transpose(0, 2, 1) @ across
        return near, blocks

    def add_forces(
        self,
        total: FirstOrder,
        points: Array,
        tension: float,
        body: BodyDensity,
        held: list[BodyDensity],
    ) -> None:
        rows = self._by_rows
        total.add(self.forces(self.touch(points), rows), rows.functions)

    def add_hessian(
        self,
        matrix: Matrix,
        rows: Rows,
        points: Array,
        directions: Array,
        tension: float,
        body: BodyDensity,
    ) -> None:
        own = self._by_rows
        near, blocks = self.hessian(self.touch(points), directions, own)
        matrix.add(rows.unknowns(own.functions[near]), blocks)

    def patches(
        self, surface: Surface, images: list[Array], tension: float, body: BodyDensity
    ) -> ContactPatches:
        touch = self.touch(surface.points)
        wet = (touch.traction > 0) | (touch.pull > 0)
        x = (self.table.values @ surface.points[self.table.functions])[wet]
        push = -self.push(touch)[wet]
        at = touch.at.part(wet)
        return patches_of(self.solid, at, x, push, self.leaving, images, tension, body)

    def behind(self, table: Table, surface: Surface) -> Array:
        at = element_points(table, surface.points)
        return self.solid.center_of(behind(self.solid.nearest(at.x), at, 2.0 * self.length))

    def reaches(self, base: float, table: Table, points: Array, which: Index) -> bool:
        return bool((which < 0).any())

    def stiffness(self, touch: Touch) -> Array:
        """(elements, points) derivative of the traction by the depth."""
        return np.asarray((touch.traction > 0) / (self.delta + self._compliance) + touch.rise)

    def objection(self, points: Array) -> str | None:
        touch = self.touch(points)
        across = self.across(touch)
        if across < ACROSS:
            return (
                f"a wet asperity has {across:.1f} elements across, {ACROSS} are needed: take more "
                "discretization.elements"
            )
        held = touch.traction > 0.0
        if self.exact or not (touch.at.which[held] >= 0).any():
            return None
        each = held.sum() / len(np.unique(touch.at.which[held]))
        if each < POINTS:
            return (
                f"a wet spot has {each:.1f} quadrature points in the mean, {POINTS} are needed: "
                "take more discretization.elements, or fewer, for point supports"
            )
        return None

    def across(self, touch: Touch) -> float:
        """Fewest elements across the smallest asperity, where the membrane lies on one."""
        wet = (touch.traction > 0).any(axis=1) & (touch.at.which >= 0).any(axis=1)
        if not wet.any():
            return np.inf
        step = float(np.sqrt(self._size[wet].max()))
        return 2.0 * self.solid.scale / step

    def give(self, touch: Touch) -> float:
        """Depth by which the stiffest contact would give way without multipliers."""
        return float((self.delta * touch.traction).max(initial=0.0))

    def near(self, points: Array) -> Index:
        """(k, local) functions of the elements near the solid."""
        close = (self.touch(points).at.gap < 2.0 * self.length).any(axis=1)
        return self.table.functions[close]

    def near_contact(self, table: Table, points: Array, displacement: Array) -> float:
        moved = displacement[self.near(points)]
        return float(np.linalg.norm(moved, axis=-1).max(initial=0.0)) / self.length

    def settled_at(self, surface: Surface, near: float) -> bool:
        if not self.exact:
            return True
        touch = self.touch(surface.points)
        if near * self.length <= STEADY * self.give(touch):
            self.tighten(touch, surface.points)
            return self.settled
        return False

    def tighten(self, touch: Touch, points: Array) -> None:
        """Take the tractions as multipliers and reduce ``delta``; lift points that dip too deep."""
        if not self.exact:
            return
        self.rounds += 1
        change = self.delta * np.abs(touch.traction - self.multipliers)
        sunk = self._compliance * touch.traction.max(initial=0.0)
        least = min(self.length, sunk / GIVEN) if sunk else self.length
        self.settled = bool(change.max(initial=0.0) <= SETTLED * least)
        if (self.delta <= self._hard).all() and self._lifts:
            self.settled &= not self._lift_points(touch, points)
        if self.settled:
            return  # these tractions are the ones in balance
        self.multipliers = touch.traction
        self.delta = np.maximum(HARDER * self.delta, self._hard)

    def _lift_points(self, touch: Touch, points: Array) -> bool:
        """Lift the contact points of elements that lie too deep; whether there were any."""
        self._lifts -= 1
        near = np.flatnonzero((touch.at.gap < 0.5 * self.length).any(axis=1))
        dense = self._space.table(SAMPLES, self.elements[near])
        gap = self.solid.nearest(dense.values @ points[dense.functions]).gap
        depth = -gap.min(axis=1)[:, None]
        sunk = self._compliance * touch.traction[near]
        aim, most = 0.5 * self._depth * self.length, 0.8 * self._depth * self.length
        off = depth > most
        if self._compliance:
            # nowhere deeper than by the traction inside the spots
            load = touch.traction * self.area
            aim = self._compliance * (load * touch.traction).sum() / max(load.sum(), TINY)
            off = depth > 1.05 * aim
        lifted = touch.at.gap[near] + depth - aim + sunk
        self._lift[near] = np.where(off, lifted, self._lift[near])
        return bool(off.any())


def is_obstacle(model: ContactModel) -> TypeGuard[Obstacle]:
    """Whether a model has a membrane that lies on its solid."""
    return isinstance(model, Obstacle)
