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
from ..solids import Solid
from ..solids.nearest import Asperities
from ..splines import Space, Table
from ..splines.point_load import effective_radius
from ..surface.sector import mirrors
from ..surface.surface import Surface
from .contact import ContactSet, Touch

LARGEST = 0.75
"""``phi`` up to which the spring stiffens; beyond, it goes on with the same stiffness."""
WIDEST = 1.5
"""Radius of a spot over the effective radius up to which sags are right to 3 percent
(docs/results/lotus.md)."""
NEWTON = 30
"""Steps at most that find where in the mesh an axis is."""


@dataclass(frozen=True, eq=False)
class Supports:
    """Asperities under a sector of the membrane and where they meet its mesh.

    Attributes
    ----------
    table : functions at the axes, an "element" with one point for each.
    share : (k,) part of each that belongs to the sector.
    top, radius, reach : (k,) height of the asperity's top, its radius, effective radius b.
    """

    table: Table
    share: Array
    top: Array
    radius: Array
    reach: Array


class PointSupports(ContactSet):
    """Contact of a membrane with many small asperities, each a point support.

    Parameters
    ----------
    supports : where they are.
    tension : of the membrane.
    """

    def __init__(
        self, solid: Solid, supports: Supports, tension: float, space: Space, elements: Index
    ) -> None:
        area = supports.share[:, None]
        super().__init__(solid, supports.table, area, 1.0, np.inf, 0.0, space, elements)
        self._reach, self._radius = supports.reach[:, None], supports.radius[:, None]
        self._tension, self._top = tension, supports.top[:, None]
        # force of a spot of the effective radius
        self._unit = 2.0 * np.pi * tension * self._reach**2 / self._radius

    def touch(self, points: Array) -> Touch:
        """Gaps and forces for control points (count, 3)."""
        x = self.table.values @ points[self.table.functions]
        depth = self._top - x[..., 2]
        force = self._unit * spot(2.0 * self._radius * depth / self._reach**2)
        none = np.zeros_like(depth)
        return Touch(self.solid.nearest(x), force, none, none, none)

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

    def near(self, points: Array) -> Index:
        """Functions at all axes."""
        return self.table.functions

    def objection(self, touch: Touch) -> str | None:
        """Why the mesh is too fine for this law, or None."""
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
    space, images = surface.space, mirrors(scene.sector)
    assert scene.directions is not None
    upright = np.abs(scene.directions[:, :2]).max(axis=1) < 1e-12
    zone = np.flatnonzero(np.asarray(upright)[space.functions].all(axis=1))
    middle = space.table(1, zone)
    x = (middle.values @ surface.points[middle.functions])[:, 0, :2]
    within = solid.within(float(np.linalg.norm(x, axis=1).max()))
    centers = solid.center_of(within)
    mine = _in_sector(centers, scene.sector.model, 1e-9 * solid.scale)
    within, centers = within[mine], centers[mine]
    xi = _located(surface, x, middle.parameters[:, 0], centers[:, :2], 1e-12 * surface.size)
    one, two = space.bases
    (e1, u), (e2, v) = one.locate(xi[:, 0]), two.locate(xi[:, 1])
    inside = np.isin(e1 * two.elements + e2, zone)
    within, centers, xi = within[inside], centers[inside], xi[inside]
    place = np.stack([u, v], axis=-1)[inside]
    functions, rows = space.at(xi, 1)
    a1, a2 = (np.einsum("ka,kai->ki", rows[d], surface.points[functions]) for d in ((1, 0), (0, 1)))
    size = np.abs(a1[:, 0] * a2[:, 1] - a1[:, 1] * a2[:, 0]) * one.sizes[0] * two.sizes[0]
    radius = solid.radius_of(within)
    images_of = np.stack([centers @ m for m in images], axis=1)
    same = np.linalg.norm(images_of - centers[:, None], axis=-1) <= 1e-9 * solid.scale
    plain = np.ones((len(xi), 1))
    table = Table(
        functions, rows[0, 0][:, None], rows[1, 0][:, None], rows[0, 1][:, None], plain, xi[:, None]
    )
    reach = np.sqrt(size) * effective_radius(space.degree, place)
    return Supports(table, 1.0 / same.sum(axis=1), centers[:, 2] + radius, radius, reach)


def _in_sector(centers: Array, model: str, rounding: float) -> Array:
    """Whether places lie in the sector that is computed, or on its edge."""
    x, y = centers[:, 0], centers[:, 1]
    inside = np.ones(len(x), bool)
    if model != "full":
        inside &= y >= -rounding
    if model in ("quarter", "eighth"):
        inside &= x >= -rounding
    if model == "eighth":
        inside &= y >= x - rounding
    return inside


def _located(
    surface: Surface, x: Array, parameters: Array, wanted: Array, tolerance: float
) -> Array:
    """(k, 2) parameters at which a surface passes vertical axes, by Newton's method.

    Parameters
    ----------
    x, parameters : (n, 2) known places and their parameters to start from.
    wanted : (k, 2) the axes.
    """
    from scipy.spatial import cKDTree

    xi = parameters[cKDTree(x).query(wanted)[1]].copy()
    for _ in range(NEWTON):
        k = surface.at(xi, 1)
        missing = wanted - k.position[..., :2]
        if np.abs(missing).max(initial=0.0) <= tolerance:
            return xi
        step = np.linalg.solve(np.swapaxes(k.tangents[..., :2], -1, -2), missing[..., None])
        xi = np.clip(xi + step[..., 0], -1.0, 1.0)
    raise GeometryError("the axis of an asperity is not found in the mesh")
