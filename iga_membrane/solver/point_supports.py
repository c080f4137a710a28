"""Asperities so small that their wet spots fall between the mesh's lines: point supports.

A force f on a membrane of tension gamma leaves a spot of radius a, ``a^2 = f r / 2 pi gamma``, on a
sphere of radius r, and the membrane falls off from it by ``f log(. / a) / 2 pi gamma``. A mesh that
does not resolve the spot cuts the logarithm off at an effective radius b instead
(:mod:`iga_membrane.splines.point_load`). Where the mesh passes the asperity's axis it is then below
the asperity's top by

    d = f / (4 pi gamma) (1 + log(2 pi gamma b^2 / (f r)))

while the membrane it stands for lies on the spot. In ``phi = (a / b)^2`` and ``D = 2 r d / b^2``
that is ``phi (1 - log(phi)) = D``, a spring that stiffens as the spot grows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index
from ..errors import GeometryError
from ..scenes.scene import Scene
from ..solids import SphereLattice, Spheres
from ..solids.nearest import Asperities, Nearest
from ..splines import Table
from ..splines.point_load import effective_radius
from ..surface.sector import in_sector, mirrors
from ..surface.surface import Surface
from .contact import ContactSet, Touch

LARGEST = 0.75
"""``phi`` up to which the spring stiffens; beyond, it goes on with the same stiffness."""
WIDEST = 2.0
"""Radius of a spot over the effective radius up to which sags are right to 5 percent
(docs/results/lotus.md)."""
NEWTON = 30
"""Steps at most that find where in the mesh an axis is."""


@dataclass(frozen=True, eq=False)
class Supports:
    """Asperities under a sector of the membrane and where they meet its mesh.

    Attributes
    ----------
    table : functions at the axes, an "element" with one point for each.
    which : (k,) numbers of the asperities; share : (k,) part of each that belongs to the sector.
    top, radius, reach : (k,) height of the asperity's top, its radius, effective radius b.
    spacing : of a square lattice with as many asperities.
    """

    table: Table
    which: Index
    share: Array
    top: Array
    radius: Array
    reach: Array
    spacing: float


class PointSupports(ContactSet):
    """Contact of a membrane with many small asperities, each a point support.

    Parameters
    ----------
    scene : whose membrane it is.
    solid : in the scene's scale.
    start : surface whose mesh meets the asperities as long as its foot moves vertically only.
    tension : of the membrane.
    elements : of the sector.
    """

    def __init__(
        self, scene: Scene, solid: Asperities, start: Surface, tension: float, elements: Index
    ) -> None:
        self._scene, self._tension = scene, tension
        supports = supports_of(scene, solid, start)
        area = supports.share[:, None]
        super().__init__(solid, supports.table, area, 1.0, np.inf, 0.0, start.space, elements)
        self._take(supports)

    @property
    def law(self) -> str:
        """In a word."""
        return "point supports"

    def follow(self, surface: Surface) -> None:
        """Find the asperities anew in a mesh that has moved sideways."""
        assert isinstance(self.solid, (SphereLattice, Spheres))
        self._take(supports_of(self._scene, self.solid, surface))

    def _take(self, supports: Supports) -> None:
        self.table, self.area = supports.table, supports.share[:, None]
        self.length = supports.spacing
        self._reach, self._radius = supports.reach[:, None], supports.radius[:, None]
        self._which, self._top = supports.which[:, None], supports.top[:, None]
        tension = self._tension
        # force of a spot of the effective radius
        self._unit = 2.0 * np.pi * tension * self._reach**2 / self._radius

    def touch(self, points: Array) -> Touch:
        """Gaps and forces for control points (count, 3)."""
        x = self.table.values @ points[self.table.functions]
        depth = self._top - x[..., 2]
        force = self._unit * spot(2.0 * self._radius * depth / self._reach**2)
        none = np.zeros_like(depth)
        up = np.broadcast_to([0.0, 0.0, 1.0], x.shape)
        at = Nearest(-depth, up, none, self._which)
        return Touch(at, force, none, none, none)

    def energy(self, touch: Touch) -> float:
        """Work done on the springs."""
        phi = touch.traction / self._unit
        small, more = np.clip(phi, 1e-300, LARGEST), np.maximum(phi - LARGEST, 0.0)
        work = 0.5 * small**2 * (0.5 - np.log(small))
        work -= np.log(LARGEST) * (LARGEST * more + 0.5 * more**2)
        return float((self.area * self._unit * self._reach**2 / (2.0 * self._radius) * work).sum())

    def stiffness(self, touch: Touch) -> Array:
        """(k, 1) derivative of the force by the depth, ``4 pi gamma / -log(phi)``."""
        phi = np.clip(touch.traction / self._unit, 1e-300, LARGEST)
        return np.asarray(-4.0 * np.pi * self._tension / np.log(phi) * (touch.traction > 0.0))

    @property
    def which(self) -> Index:
        """(k,) numbers of the supports."""
        return self._which[:, 0]

    def near(self, points: Array) -> Index:
        """Functions at all axes."""
        return self.table.functions

    def objection(self, touch: Touch) -> str | None:
        """Why the mesh does not do for this law, or None."""
        phi = float((touch.traction / self._unit).max(initial=0.0))
        if phi <= WIDEST**2:
            return None
        return (
            f"a wet spot is {np.sqrt(phi):.2f} times as wide as the mesh makes a point support, "
            f"{WIDEST} is allowed: take fewer discretization.elements, or so many that they "
            "resolve it"
        )


def spot(depth: Array) -> Array:
    """``phi`` with ``phi (1 - log(phi)) = depth``, 0 for negative depths."""
    from scipy.special import lambertw

    most = LARGEST * (1.0 - np.log(LARGEST))
    inside = np.clip(depth, 1e-300, most)
    phi = -inside / lambertw(-inside / np.e, -1).real
    beyond = LARGEST + (depth - most) / -np.log(LARGEST)
    return np.where(depth > 0.0, np.where(depth < most, phi, beyond), 0.0)


def supports_of(scene: Scene, solid: Asperities, surface: Surface) -> Supports:
    """The asperities under the part of a start that moves vertically.

    Parameters
    ----------
    solid, surface : in the scene's scale.

    Raises
    ------
    GeometryError
        If the axis of one of them is not found in the mesh.
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
    xi = _located(surface, middle.parameters[nearest, 0], centers[:, :2], 1e-12 * surface.size)
    one, two = space.bases
    (e1, u), (e2, v) = one.locate(xi[:, 0]), two.locate(xi[:, 1])
    inside = np.isin(e1 * two.elements + e2, zone)
    within, centers, xi = within[inside], centers[inside], xi[inside]
    place = np.stack([u, v], axis=-1)[inside]
    functions, rows = space.at(xi, 1)
    table = Table(
        functions, rows[0, 0][:, None], rows[1, 0][:, None], rows[0, 1][:, None],
        np.ones((len(xi), 1)), xi[:, None],
    )  # fmt: skip
    size = np.abs(_turned(*(a[:, 0, :2] for a in table.derivatives(surface.points)[1:])))
    size *= one.sizes[0] * two.sizes[0]
    radius = solid.radius_of(within)
    images = np.stack([centers @ m for m in mirrors(scene.sector)], axis=1)
    same = np.linalg.norm(images - centers[:, None], axis=-1) <= 1e-9 * solid.scale
    share = 1.0 / same.sum(axis=1)
    return Supports(
        table, within, share, centers[:, 2] + radius, radius,
        np.sqrt(size) * effective_radius(space.degree, place),
        float(np.sqrt(areas.sum() / images.shape[1] / max(1.0, share.sum()))),
    )  # fmt: skip


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
