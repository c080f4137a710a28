"""Which control point moves along which direction with which unknown.

A liquid membrane resists only normal motion, so one scalar unknown per control point is enough
("spines"): ``x_i = X_i + s_i d_i``, directions re-based on the current surface before every
Newton step. Poles, mirror images, joints, fixed rims and sliding edges are all entries of the
same table: points that share an unknown, points without one, directions in a plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import array, integer, ndarray
from ..errors import GeometryError
from ..overview import brief_repr
from ..splines import Space, net_of
from ..splines.space import EDGES
from ..surface.surface import Surface
from .boundary_conditions import Sliding, Support
from .parity import ODD, Parity, parts
from .restrictions import Restrictions
from .symmetry import FOLDS

CORNER = 0.2
"""Reach of a rim's corner over the rim's side; 0.15 to 0.45 take the same Newton iterations."""


@dataclass(frozen=True, eq=False)
@checked(
    directions=partial(ndarray, shape=(None, 3)),
    size=partial(integer, least=0),
    shifts=partial(ndarray, shape=(None, 3)),
)
class Motion:
    """Linear map from unknowns to displacements of control points: rows (point, direction,
    unknown), and shifts in which many points take part.

    Attributes
    ----------
    points : (rows,) control point of each row; row ``i < count`` belongs to control point ``i``.
    directions : (rows, 3) its displacement per unit of the unknown.
    unknowns : (rows,) number of the unknown, -1 where there is none.
    size : number of unknowns.
    shifts : (k, 3) displacement per unit of each of the last k unknowns; their rows come last.
    share : (count,) part in the shifts that each control point takes.
    """

    points: Index
    directions: Array
    unknowns: Index
    size: int
    shifts: Array
    share: Array

    __repr__ = brief_repr

    def displacement(self, step: Array) -> Array:
        """(count, 3) displacements for unknowns (size,)."""
        padded = np.append(step, 0.0)
        own = len(self.points) - len(self.shifts)
        moves = padded[self.unknowns[:own]][:, None] * self.directions[:own]
        total = self.share[:, None] * (step[self.size - len(self.shifts) :] @ self.shifts)
        np.add.at(total, self.points[:own], moves)
        return np.asarray(total)


@dataclass(frozen=True, eq=False)
class Block:
    """Motions of one parity, by their own unknowns.

    Attributes
    ----------
    parity : theirs.
    factors : (images, rows) part that each row of the motion takes in its unknown, on each of the
        parity's images of the computed part.
    unknowns : (images, rows) its unknown, -1 where there is none; size : their number.
    gaps : (images, rows) number of the gap constraint of a second row, else -1.
    """

    parity: Parity
    factors: Array
    unknowns: Index
    size: int
    gaps: Index

    @property
    def own(self) -> bool:
        """Whether they are those of the computed model itself."""
        return -1 not in self.parity.signs

    @property
    def moves(self) -> bool:
        """Whether there are any."""
        return bool(self.factors[self.unknowns >= 0].any())


class Spines:
    """The spine motion of a surface: a fixed numbering of unknowns, directions on demand.

    Every control point has one row. An edge that slides on a curved solid has a second row for
    each of its points, along the solid's normal: the edge is held on the solid by a constraint,
    not by its directions.

    Parameters
    ----------
    surface : its points tell which edges lie in symmetry planes.
    supports : what restricts the motion.
    directions : (count, 3) of the control points, the same at every step; if None the surface's
        normals, blended into sliding edges.

    Attributes
    ----------
    model : what part of the patch is computed.
    points, unknowns, size, shifts, share : as in :class:`Motion`.
    spare : number of a row without an unknown.
    second : (count,) the second row of each control point, or the spare row.
    held : (rows,) number of the gap constraint that belongs to a second row, else -1.
    extra : arrays (count,) of the rows of each control point after its first, or the spare row.
    by_pairs : whether Hessians are summed by pairs of control points first, which have many
        unknowns.
    """

    by_pairs = False

    @checked(directions=partial(array, shape=(None, 3)))
    def __init__(
        self,
        surface: Surface,
        supports: Sequence[Support] = (),
        directions: Array | None = None,
    ) -> None:
        space = surface.space
        self._given = directions
        self._start = surface.points
        self.space = space
        held = Restrictions(surface, supports)
        self._sliding, self.model = held.sliding, held.model
        self._mirrors, self._upright, self._seams = held.mirrors, held.upright, held.seams
        self.shifts, self.share = held.shifts, held.share
        owner, fixed = held.owner, held.fixed
        self._curved = [
            (s, space.edge_functions(s.edge)) for s in self._sliding if s.solid is not None
        ]
        edge = np.concatenate([np.zeros(0, int), *(points for _, points in self._curved)])
        self._fixed, self._edge = fixed, edge
        numbers = _ranked(np.where(fixed[owner], -1, owner))
        seconds = _ranked(owner[edge])
        primary = int(numbers.max(initial=-1)) + 1
        own = primary + int(seconds.max(initial=-1)) + 1
        self.spare = spare = space.count + len(edge)
        last: Index = np.arange(len(self.shifts))
        self.size = own + len(last)
        self.points: Index = np.concatenate([np.arange(space.count), edge, [0], 0 * last])
        self.unknowns: Index = np.concatenate([numbers, primary + seconds, [-1], own + last])
        self.held: Index = np.concatenate([np.full(space.count, -1), seconds, [-1], -1 - 0 * last])
        self.second: Index = np.full(space.count, spare)
        self.second[edge] = space.count + np.arange(len(edge))
        self.extra: list[Index] = [self.second]

    def on(self, surface: Surface) -> Motion:
        """Directions re-based on a surface: its normals, blended into a sliding edge's plane.

        Towards the corners of a rim with joints they turn to the normal of its plane, in which the
        membrane lies there: normals turn by a right angle between control points that crowd in a
        corner, and a step along them would fold the mesh.

        The blend ``d = (1 - w) m + w n``, with ``1 - w`` the parametric distance from the other
        end, is one smooth field over the patch; a jump in it would cost orders of magnitude.
        """
        if self._given is not None:
            rows = np.concatenate([self._given, np.zeros((1, 3)), self.shifts])
            return self._motion(rows)
        space = surface.space
        normals = self._normals(surface)
        if space.bases[0].joints:
            part, up = self._corners
            normals = normals - part * (normals - (normals @ up)[..., None] * up)
            normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        for support in self._sliding:
            along, end = EDGES[support.edge]
            basis = space.bases[1 - along]
            parameter = (basis.abscissae - basis.breaks[0]) / (basis.breaks[-1] - basis.breaks[0])
            carried = np.expand_dims(1.0 - np.abs(parameter - end), along)[..., None]
            carried = carried * _near(surface, support)
            rim = np.expand_dims(_conormals(surface, support), 1 - along)
            normals = carried * rim + (1.0 - carried) * normals
        directions = _points_of_field(space, normals)
        for first, second in self._seams:
            mean = directions[first] + directions[second]
            mean /= np.linalg.norm(mean, axis=1, keepdims=True)
            directions[first] = directions[second] = mean
        for points, axis in self._mirrors:
            directions[points, axis] = 0.0
            length = np.linalg.norm(directions[points], axis=1, keepdims=True)
            directions[points] /= np.where(length > 0, length, 1.0)
        for wall, near in 2 * self._upright:
            directions[near] = directions[wall]
        normals_of_solids = [
            support.solid.normal(surface.points[points])
            for support, points in self._curved
            if support.solid is not None
        ]
        rows = np.concatenate([directions, *normals_of_solids, np.zeros((1, 3))])
        return self._motion(rows)

    @property
    def whole(self) -> bool:
        """Whether the blocks are all motions of the whole patch."""
        return True

    @property
    def blocks(self) -> list[Block]:
        """Motions of the whole patch by their parity, these unknowns' own first."""
        ones = np.ones((1, len(self.points)))
        own = Parity(self.model, (1,) * len(FOLDS[self.model]), within=self.model)
        first = Block(own, ones, self.unknowns[None], self.size, self.held[None])
        return [first, *(self._block(parity) for parity in ODD[self.model])]

    def _block(self, parity: Parity) -> Block:
        """Motions of a parity that the model's own do not have. Of its own mirror group they take
        its unknowns, those that rest with factor 0, so that matrices keep their sparsity. Nothing
        is shifted as a whole: spines that may follow a shift only so far are no limit to small
        motions."""
        leaders, factors = parts(self.space, parity, self.model)
        for first, second in self._seams + 2 * self._upright:
            leaders[:, second], factors[:, second] = leaders[:, first], factors[:, first]
        none = np.zeros((len(leaders), 1 + len(self.shifts)))
        factors = np.concatenate([factors, factors[:, self._edge], none], axis=1)
        if parity.model == self.model:
            return Block(parity, factors, self.unknowns[None], self.size, self.held[None])
        seconds = _ranked(leaders[:, self._edge])
        firsts = _ranked(np.where(self._fixed, -1, leaders))
        primary, gaps = int(firsts.max(initial=-1)) + 1, int(seconds.max(initial=-1)) + 1
        none = np.full(none.shape, -1)
        held = np.concatenate([np.full_like(firsts, -1), seconds, none], axis=1)
        moved = np.where(seconds >= 0, primary + seconds, -1)
        unknowns = np.concatenate([firsts, moved, none], axis=1)
        return Block(parity, factors, unknowns, primary + gaps, held)

    def released(self) -> Spines:
        """The same directions with an unknown for every row."""
        free = copy(self)
        free.size = len(self.points)
        free.unknowns = np.arange(free.size)
        free.held = np.where(self.held >= 0, free.unknowns - self.space.count, -1)
        for name in ("gauge", "places"):
            free.__dict__.pop(name, None)
        return free

    def _motion(self, rows: Array) -> Motion:
        return Motion(self.points, rows, self.unknowns, self.size, self.shifts, self.share)

    @cached_property
    def places(self) -> Array:
        """(n, 3) where the first control point of each unknown starts; 0 for shifts."""
        return self.places_of(self.unknowns, self.size)

    def places_of(self, unknowns: Index, size: int) -> Array:
        """(size, 3) the same for other unknowns (rows,)."""
        places = np.zeros((size + 1, 3))
        own = len(self.points) - len(self.shifts)
        places[unknowns[:own][::-1]] = self._start[self.points[:own][::-1]]
        return places[:-1]

    def lag(self, surface: Surface) -> Array:
        """(3,) way by which the top, which takes part in shifts, is ahead of the foot."""
        if not len(self.shifts):
            return np.zeros(3)
        return self._way(surface, int(self.share.argmax())) - self._way(
            surface, int(self.share.argmin())
        )

    def anew(self, surface: Surface) -> Surface:
        """The start, as far away as the top of a surface has been shifted."""
        return surface.moved(self._start + self._way(surface, int(self.share.argmax())))

    def _way(self, surface: Surface, point: int) -> Array:
        """(3,) way of a control point along the shifts."""
        moved = surface.points[point] - self._start[point]
        return np.asarray(moved @ self.shifts.T @ self.shifts)

    @cached_property
    def gauge(self) -> Array:
        """(n, k) columns of what the steps of the control points may not change: the mean place of
        those that take part in a shift, which is the shift's own."""
        columns = np.zeros((self.size + 1, len(self.shifts)))
        if len(self.shifts):
            assert self._given is not None
            along = self.share[:, None] * (self._given @ self.shifts.T)
            np.add.at(columns, self.unknowns[: self.space.count], along)
        return columns[:-1]

    @cached_property
    def _corners(self) -> tuple[Array, Array]:
        """How near (n1, n2, 1) control points start to the corners of a rim ``xi2 = 1``, and the
        unit normal (3,) of its plane."""
        ring, net = self.space.bases[0], net_of(self.space, self._start)
        corners = np.tensordot(ring.matrix(ring.joints), net[:, -1], axes=1)
        up = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        away = np.linalg.norm(net[:, :, None] - corners, axis=-1)
        reach = CORNER * np.linalg.norm(corners[1] - corners[0])
        near = np.exp(-((away / reach) ** 2)).sum(axis=-1, keepdims=True)
        return np.minimum(near, 1.0), up / np.linalg.norm(up)

    @cached_property
    def _derivative_matrices(self) -> tuple[Array, Array, Array, Array]:
        one, two = self.space.bases
        return (
            one.matrix(one.abscissae),
            one.derivative_at_abscissae(),
            two.matrix(two.abscissae),
            two.derivative_at_abscissae(),
        )

    def _normals(self, surface: Surface) -> Array:
        """(n1, n2, 3) unit normals at the abscissae of the net."""
        v1, d1, v2, d2 = self._derivative_matrices
        net, weights = net_of(surface.space, surface.points), surface.space.weights
        if weights is None:
            a1, a2 = along_net(d1, v2, net), along_net(v1, d2, net)
        else:
            k = surface.at(surface.space.abscissae, 1)
            a1, a2 = k.tangents[..., 0, :], k.tangents[..., 1, :]
        c = np.cross(a1, a2)
        if surface.space.pole is not None:
            # at the pole a1 = 0: the normal is that of the ring next to it
            ring = net[:, -2] - net[:, -1]
            c[:, -1] = np.cross(ring, np.roll(ring, -1, axis=0)).sum(axis=0)
        length = np.linalg.norm(c, axis=-1, keepdims=True)
        if not (length > 0).all():
            i, j = np.argwhere(length[..., 0] <= 0)[0]
            raise GeometryError(
                f"the surface has no normal at control point ({i}, {j}): its tangents are "
                "parallel or zero; start from a regular parametrization"
            )
        return np.asarray(c / length)


def _near(surface: Surface, support: Sliding) -> Array:
    """(n1, n2, 1) falls from 1 at a sliding edge over its reach."""
    along, end = EDGES[support.edge]
    net = surface.net if end == 0 else np.flip(surface.net, 1 - along)
    steps = np.linalg.norm(np.diff(net, axis=1 - along), axis=-1, keepdims=True)
    away = np.insert(np.cumsum(steps, axis=1 - along), 0, 0.0, axis=1 - along)
    near = np.exp(-((away / support.reach) ** 2))
    return near if end == 0 else np.flip(near, 1 - along)


def _conormals(surface: Surface, support: Sliding) -> Array:
    """(n, 3) unit vectors in the solid's surface that point out of the membrane's edge at its
    abscissae: ``a_c x n_c`` of paper eq. (34)."""
    along, end = EDGES[support.edge]
    net = surface.net
    row = net[:, -end] if along == 0 else net[-end]
    basis = surface.space.bases[along]
    tangent = basis.derivative_at_abscissae() @ row
    # the second edge of a bridge lies on a plane above it
    normal = np.array([[0.0, 0.0, 1.0 - 2.0 * end]])
    if support.solid is not None:
        normal = support.solid.normal(basis.matrix(basis.abscissae) @ row)
    outward = np.cross(tangent, normal)
    if (along == 0) == (end == 1):
        outward = -outward
    return np.asarray(outward / np.linalg.norm(outward, axis=1, keepdims=True))


def _ranked(leaders: Index) -> Index:
    """Consecutive numbers of leaders, -1 where there is none."""
    kept = np.unique(leaders[leaders >= 0])
    return np.where(leaders >= 0, np.searchsorted(kept, leaders), -1)


def along_net(one: Array, two: Array, net: Array) -> Array:
    """(a, b, 3) a net (n1, n2, 3) times one matrix (a, n1) and the other (b, n2)."""
    return np.tensordot(one, two @ net, axes=1)


def _points_of_field(space: Space, net: Array) -> Array:
    """Control points' values of a field given on the net; at a pole its value there."""
    if space.pole is None:
        return net.reshape(-1, 3)
    corners = np.repeat(net[:1, -1], 3 if space.pole else 1, axis=0)
    return np.concatenate([net[:, : net.shape[1] - space.joined_rings].reshape(-1, 3), corners])
