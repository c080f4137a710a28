"""What the supports of a surface say about its control points, gathered."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, Index
from ..splines import Space, net_of
from ..splines.space import EDGES
from ..surface.surface import Surface
from .boundary_conditions import Model, Sector, Sliding, Support
from .symmetry import check_symmetric, sector_images


class Restrictions:
    """Restrictions of the motion of a surface, in the order in which its supports are given.

    Attributes
    ----------
    owner : (count,) the control point that each one follows.
    fixed : (count,) whether it does not move.
    model : what part of the patch is computed.
    sliding : supports along whose edges the directions lie in a solid's surface.
    mirrors : control points in a symmetry plane, and its axis.
    upright : control points of an edge, and those of the row next to it, that move together.
    seams : control points of edges that move together.
    shifts : (k, 3) along which the body may also be shifted as a whole.
    share : (count,) part in the shifts that each control point takes.
    """

    def __init__(self, surface: Surface, supports: Sequence[Support]) -> None:
        self._surface, self._space = surface, surface.space
        count = self._space.count
        self.owner: Index = np.arange(count)
        self.fixed = np.zeros(count, bool)
        self.model: Model = Sector().model
        self.sliding: list[Sliding] = []
        self.mirrors: list[tuple[Index, int]] = []
        self.upright: list[tuple[Index, Index]] = []
        self.seams: list[tuple[Index, Index]] = []
        self.shifts: Array = np.zeros((0, 3))
        self.share: Array = np.zeros(count)
        for support in supports:
            support.restrict(self)
        for wall, near in 2 * self.upright:  # twice, for corners
            self.owner[near] = self.owner[wall]

    def fix(self, edge: str) -> None:
        """Hold an edge."""
        self.fixed[self._space.edge_functions(edge)] = True

    def slide(self, support: Sliding) -> None:
        """Let an edge slide on a solid."""
        self.sliding.append(support)

    def mirror_in(self, axis: str) -> None:
        """Keep what lies in a plane through the origin in it."""
        k = "xyz".index(axis)
        on_plane = np.abs(self._surface.points[:, k]) <= 1e-12 * self._surface.size
        self.mirrors.append((np.flatnonzero(on_plane), k))
        rows = [_next_to(self._space, edge) for edge in self._space.open_edges]
        self.upright += [row for row in rows if on_plane[row[0]].all()]

    def stand(self, edge: str) -> None:
        """Let the surface meet a vertical mirror plane in an edge at a right angle."""
        self.upright.append(_next_to(self._space, edge))

    def join(self, edges: tuple[str, str]) -> None:
        """Let two edges move together."""
        first, second = (self._space.edge_functions(edge) for edge in edges)
        self.owner[second] = self.owner[first]
        self.seams.append((first, second))

    def compute(self, sector: Sector) -> None:
        """Let the rest of the patch be mirror images of a part."""
        self.model = sector.model
        if sector.model != "full":
            self.owner = sector_images(self._space, sector)[self.owner]
            check_symmetric(self._surface, sector)

    def shift(self, axes: str, above: float) -> None:
        """Let the body be shifted as a whole, but for what lies low."""
        self.shifts = np.eye(3)[["xyz".index(axis) for axis in axes]]
        height = np.maximum(self._surface.points[:, 2] - above, 0.0)
        self.share = height / height.max()


def _next_to(space: Space, edge: str) -> tuple[Index, Index]:
    """Control points of an edge, and those of the row next to it."""
    along, end = EDGES[edge]
    net = net_of(space, np.arange(float(space.count))[:, None])[..., 0]
    rows = np.moveaxis(net, 1 - along, 0)
    first, second = rows[[-1, -2]] if end else rows[[0, 1]]
    return np.asarray(first, int), np.asarray(second, int)
