"""Asperities so small that their wet spots fall between the mesh's lines: point supports.

Each carries the membrane as its wet spot would (:mod:`iga_membrane.solids.wet_spot`). The force
acts on a ring of a few points round the asperity's axis, as wide as the spot: the mesh, seen by the
ring, cuts the logarithm off near the ring's radius however it lies between the mesh's lines
(:mod:`iga_membrane.splines.point_load`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index
from ..dofs.dof_map import Rows
from ..dofs.symmetry import in_sector, mirrors
from ..errors import GeometryError
from ..problems.scene import Scene
from ..solids import SphereLattice, Spheres
from ..solids.nearest import Asperities, Nearest
from ..solids.wet_spot import WetSpots, held
from ..splines import Table
from ..splines.point_load import effective_radius
from ..surface.surface import Surface
from ..terms import Contact, Ring
from .obstacle import Obstacle
from .touch import Touch

WIDEST = 2.0
"""Radius of a spot over the effective radius up to which sags are right to 5 percent
(docs/results/lotus.md)."""
NEWTON = 30
"""Steps at most that find where in the mesh an axis is."""
STEADY = 0.05
"""Change of the depths, over the spheres' radii, from one state to the next up to which the next
remembers what the one before has wet; farther ones come too far on their way."""
RING = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) / np.sqrt(2.0)
"""Points of a ring of radius 1."""


@dataclass(frozen=True, eq=False)
class Supports:
    """Asperities under a sector of the membrane and where they meet its mesh.

    Attributes
    ----------
    table : functions on the rings, an "element" with one point, the ring's mean, for each.
    which : (k,) numbers of the asperities; share : (k,) part of each that belongs to the sector.
    reach : (k,) effective radius b.
    spacing : of a square lattice with as many asperities.
    """

    table: Table
    which: Index
    share: Array
    reach: Array
    spacing: float


class PointSupports(Obstacle):
    """Contact of a membrane with many small asperities, each a point support.

    Parameters
    ----------
    scene : whose membrane it is.
    law : of contact, with its solid and ring, in the scene's scale.
    solid, ring : asperities, and where they carry the membrane.
    start : surface whose mesh meets the asperities as long as its foot moves vertically only.
    tension : of the membrane.
    elements : of the sector; rows : of the motion.

    Attributes
    ----------
    wet : (k, 1) which asperities are wet: those that the membrane meets, and those that it has met
        and not been torn off by more than the largest pull.
    """

    def __init__(
        self,
        scene: Scene,
        law: Contact,
        solid: Asperities,
        ring: Ring,
        start: Surface,
        tension: float,
        elements: Index,
        rows: Rows,
    ) -> None:
        self._scene, self._tension, self._ring = scene, tension, ring
        supports = supports_of(scene, solid, ring.radius, start)
        area = supports.share[:, None]
        super().__init__(Contact(solid, 1.0), supports.table, area, start.space, elements, rows)
        self.asked = law
        self._take(supports)

    resolves = False

    @property
    def law(self) -> str:  # type: ignore[override]
        return "point supports"

    @property
    def tied(self) -> Index:
        """(k, local) functions that each asperity couples."""
        return self.table.functions

    def leaving(self, which: Index, tension: float) -> Array:
        """Angles in radians at which the membrane leaves spheres, pi minus the contact angles."""
        assert isinstance(self.solid, (SphereLattice, Spheres))
        return np.radians(180.0 - self.solid.angle_of(which))

    def follow(self, surface: Surface) -> None:
        """Find the asperities anew in a mesh that has moved sideways."""
        assert isinstance(self.solid, (SphereLattice, Spheres))
        memory = self.memory
        self._take(supports_of(self._scene, self.solid, self._ring.radius, surface))
        self.recall(memory)

    def _take(self, supports: Supports) -> None:
        assert isinstance(self.solid, (SphereLattice, Spheres))
        self.table, self.area = supports.table, supports.share[:, None]
        self._by_rows = self._rows.of(self.table)
        self.length = supports.spacing
        self._which, self._reach = supports.which[:, None], supports.reach[:, None]
        self._radius = self.solid.radius_of(self._which)
        self._top = self.solid.center_of(self._which)[..., 2] + self._radius
        self._unit = 2.0 * np.pi * self._tension * self._radius
        self._spots = WetSpots(
            self.leaving(self._which, 1.0),
            self._reach / self._radius,
            self._ring.radius / self._radius,
            0.5 * self._ring.pressure * self._radius / self._tension,
        )
        self.wet = np.zeros(self._which.shape, bool)
        self._before = np.full(self._which.shape, np.nan)

    def _sunk(self, points: Array) -> Array:
        x = self.table.values @ points[self.table.functions]
        return np.asarray(self._top - x[..., 2])

    @property
    def memory(self) -> Array:
        """Numbers of the wet asperities."""
        return np.asarray(self._which[self.wet], float)

    def recall(self, memory: Array) -> None:
        """Take the :attr:`memory` of another contact of the same membrane."""
        self.wet = np.isin(self._which, memory)
        self._before = np.full(self._which.shape, np.nan)

    def hold(self, points: Array) -> None:
        """Remember which asperities a state wets."""
        depth, spots = self._sunk(points) / self._radius, self._spots
        # after a recall nothing is known of the state before, which was steady
        steady = not (np.abs(depth - self._before) > STEADY).any()
        self._before = depth
        self.wet = held(depth, spots.touching, spots.lowest, self.wet & steady)

    def touch(self, points: Array) -> Touch:
        """Gaps and forces for control points (count, 3)."""
        depth = self._sunk(points)
        wet = (depth > self._spots.touching * self._radius) | self.wet
        spots = self._spots.carried(depth / self._radius)
        force = np.where(wet, self._unit * spots.load, 0.0)
        up = np.broadcast_to([0.0, 0.0, 1.0], (*depth.shape, 3))
        at = Nearest(-depth, up, np.zeros_like(depth), self._which)
        work = np.where(wet, self._unit * self._radius * spots.work, 0.0)
        stiffness = np.where(wet, self._unit / self._radius * spots.stiffness, 0.0)
        return Touch(at, np.maximum(force, 0.0), -work, np.maximum(-force, 0.0), stiffness)

    def energy(self, points: Array) -> float:
        """Work done on the spots."""
        return -float((self.area * self.touch(points).gain).sum())

    def stiffness(self, touch: Touch) -> Array:
        """(k, 1) derivative of the force by the depth."""
        return touch.rise

    @property
    def which(self) -> Index:
        """(k,) numbers of the supports."""
        return np.asarray(self._which[:, 0])

    def near(self, points: Array) -> Index:
        """Functions at all axes."""
        return self.table.functions

    def reaches(self, base: float, table: Table, points: Array, which: Index) -> bool:
        return bool(((table.values @ points[table.functions])[..., 2] <= base).any())

    def unsupported(self, table: Table, points: Array) -> Array:
        at = self.solid.nearest(table.values @ points[table.functions])
        met = np.setdiff1d(at.which[at.gap < 0.0], self.which)
        return self.solid.center_of(met[met >= 0])

    def objection(self, points: Array) -> str | None:
        touch = self.touch(points)
        load = (touch.traction - touch.pull) / self._unit
        spot = self._spots.size(load) * self._radius
        wide = float((spot / self._reach)[touch.traction > 0.0].max(initial=0.0))
        if wide <= WIDEST:
            return None
        return (
            f"a wet spot is {wide:.2f} times as wide as the mesh makes a point support, "
            f"{WIDEST} is allowed: take fewer discretization.elements, or so many that they "
            "resolve it"
        )


def supports_of(scene: Scene, solid: Asperities, ring: float, surface: Surface) -> Supports:
    """The asperities under the part of a start that moves vertically.

    Parameters
    ----------
    solid, ring, surface : in the scene's scale.

    Raises
    ------
    GeometryError
        If the ring round one of their axes is not found in the mesh.
    """
    from scipy.spatial import cKDTree

    space = surface.space
    assert scene.directions is not None
    upright = np.abs(scene.directions[:, :2]).max(axis=1) < 1e-12
    zone = np.flatnonzero(np.asarray(upright)[space.functions].all(axis=1))
    middle = space.table(1, zone)
    x, *edges = (rows[:, 0, :2] for rows in middle.derivatives(surface.points))
    areas = np.abs(_turned(*edges)) * middle.weights[:, 0]
    within = solid.within(float(np.linalg.norm(x, axis=1).max()))
    centers = solid.center_of(within)
    # an element is less than twice as long as its area says
    away, nearest = cKDTree(x).query(centers[:, :2])
    mine = away <= 2.0 * np.sqrt(areas[nearest])
    mine &= in_sector(space, scene.sector, centers, 1e-9 * solid.scale)
    within, centers, nearest = within[mine], centers[mine], nearest[mine]
    wanted = (centers[:, None, :2] + ring * RING).reshape(-1, 2)
    xi = np.repeat(middle.parameters[nearest, 0], len(RING), axis=0)
    xi = _located(surface, xi, wanted, 1e-12 * surface.size)
    one, two = space.bases
    (e1, u), (e2, v) = one.locate(xi[:, 0]), two.locate(xi[:, 1])
    inside = np.isin(e1 * two.elements + e2, zone).reshape(-1, len(RING)).all(axis=1)
    within, centers = within[inside], centers[inside]
    xi = xi.reshape(-1, len(RING), 2)[inside]
    places = np.stack([e1 + u, e2 + v], axis=-1).reshape(-1, len(RING), 2)[inside]
    table, size = _rings(surface, xi)
    images = np.stack([centers @ m for m in mirrors(scene.sector)], axis=1)
    same = np.linalg.norm(images - centers[:, None], axis=-1) <= 1e-9 * solid.scale
    share = 1.0 / same.sum(axis=1)
    return Supports(
        table, within, share, size * effective_radius(space.degree, places),
        float(np.sqrt(areas.sum() / images.shape[1] / max(1.0, share.sum()))),
    )  # fmt: skip


def _rings(surface: Surface, xi: Array) -> tuple[Table, Array]:
    """Means over rings of points (k, n, 2) in the parameter domain, and (k,) sizes of the elements
    there."""
    space = surface.space
    functions, rows = space.at(xi.reshape(-1, 2), 1)

    def mean(row: Array) -> Array:
        return np.asarray(row.reshape(len(xi), 1, -1) / xi.shape[1])

    table = Table(
        functions.reshape(len(xi), -1), mean(rows[0, 0]), mean(rows[1, 0]), mean(rows[0, 1]),
        np.ones((len(xi), 1)), xi.mean(axis=1)[:, None],
    )  # fmt: skip
    one, two = space.bases
    size = np.abs(_turned(*(a[:, 0, :2] for a in table.derivatives(surface.points)[1:])))
    return table, np.sqrt(size * one.sizes[0] * two.sizes[0])


def _turned(a: Array, b: Array) -> Array:
    """Vector product of vectors in the plane."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _located(surface: Surface, xi: Array, wanted: Array, tolerance: float) -> Array:
    """(k, 2) parameters at which a surface passes vertical axes, by Newton's method.

    Parameters
    ----------
    xi : (k, 2) to start from.
    wanted : (k, 2) the axes.
    """
    for _ in range(NEWTON):
        k = surface.at(xi, 1)
        missing = wanted - k.position[..., :2]
        if np.abs(missing).max(initial=0.0) <= tolerance:
            return xi
        step = np.linalg.solve(np.swapaxes(k.tangents[..., :2], -1, -2), missing[..., None])
        xi = np.clip(xi + step[..., 0], -1.0, 1.0)
    raise GeometryError("the axis of an asperity is not found in the mesh")
