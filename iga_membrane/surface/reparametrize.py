"""Arc-length parametrization: the same shape with control points spread as asked.

Lines of constant ``xi1`` are walked by their mean arc length. One reparametrization of ``xi2``
serves all of them, so the polar form of a pole is kept and the map is linear in the control net.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..quadrature import gauss
from ..splines import Grading, Space, net_of, points_of
from .ring import meridian_interpolation, rational_matrix
from .surface import Surface


class MeridianLength:
    """Mean arc length ``s(t)`` of the lines of constant ``xi1``, with its exact derivative."""

    def __init__(self, surface: Surface, lines: slice = slice(None)) -> None:
        space = surface.space
        ring = space.bases[0]
        on_ring = ring.matrix(ring.abscissae[lines])
        self._space = space
        self._coefficients = np.tensordot(on_ring, surface.net, axes=1)
        self._breaks = space.bases[1].breaks
        self._u, self._w = gauss(space.degree + 3)
        pieces = self._piece(self._breaks[:-1], self._breaks[1:])
        self._cumulated = np.concatenate([[0.0], np.cumsum(pieces)])

    @property
    def total(self) -> float:
        """Length from the rim to the end."""
        return float(self._cumulated[-1])

    def speed(self, t: Array) -> Array:
        """Mean of ``|dx/dt|`` over the lines."""
        rows = rational_matrix(self._space, t, 1)
        velocity = np.tensordot(rows, self._coefficients, axes=(1, 1))
        return np.asarray(np.linalg.norm(velocity, axis=-1).mean(axis=1))

    def __call__(self, t: Array) -> Array:
        element = np.clip(np.searchsorted(self._breaks, t, "right") - 1, 0, len(self._breaks) - 2)
        return np.asarray(self._cumulated[element] + self._piece(self._breaks[element], t))

    def inverse(self, s: Array) -> Array:
        """Parameters at arc lengths ``s``, by Newton's method."""
        t = np.interp(s, self._cumulated, self._breaks)
        for _ in range(30):
            step = (self(t) - s) / self.speed(t)
            t = np.clip(t - step, self._breaks[0], self._breaks[-1])
            if np.abs(step).max() <= 1e-13:
                break
        return t

    def _piece(self, start: Array, end: Array) -> Array:
        t = start[:, None] + (end - start)[:, None] * self._u
        speed = self.speed(t.ravel()).reshape(t.shape)
        return np.asarray((end - start) * (speed @ self._w))


def distortion(
    surface: Surface, grading: Grading | None = None, lines: slice = slice(None)
) -> float:
    """How far the meridians are from (graded) arc length: largest relative error of the speed."""
    grading = grading or Grading()
    length = MeridianLength(surface, lines)
    t = surface.space.bases[1].abscissae
    return float(np.abs(length.speed(t) / (length.total * grading.slope(t)) - 1.0).max())


def arc_length(
    surface: Surface, grading: Grading | None = None, lines: slice = slice(None)
) -> Surface:
    """The same shape, its meridians walked by (graded) arc length.

    Parameters
    ----------
    surface : of a ring space closed by a pole.
    grading : fraction of the arc length against ``xi2``; uniform if omitted.
    lines : which lines ``xi1 = abscissa`` count for the mean; enough for one sector.

    Notes
    -----
    Interpolation, so the shape is kept to the order of the space.
    """
    grading = grading or Grading()
    space = surface.space
    length = MeridianLength(surface, lines)
    points, matrix = meridian_interpolation(space)
    old = length.inverse(grading.fraction(points) * length.total)
    rows = rational_matrix(space, old)
    if space.pole == 1:
        # chain rule at the pole: d/dt_new = (ds/dt_new) / (ds/dt_old) d/dt_old
        end = points[-1:]
        factor = grading.slope(end) * length.total / length.speed(end)
        rows[-2] = factor * rational_matrix(space, end, 1)[0]
    net = np.einsum("jk,ikc->ijc", np.linalg.solve(matrix, rows), net_of(space, surface.points))
    return surface.moved(points_of(space, net))


def regridded(surface: Surface, grading: Grading) -> Surface:
    """The same shape, walked by arc length along meridians and, where a ring has joints, by
    azimuth round it."""
    if not surface.space.bases[0].joints:
        return arc_length(surface, grading)
    return each_arc_length(straightened(surface, grading), grading)


def each_arc_length(surface: Surface, grading: Grading) -> Surface:
    """The same shape, each meridian of an open ring walked by its own arc length.

    For rims whose corners make meridians of different lengths: a mean, as in :func:`arc_length`,
    would keep the irregularities beside the joints.
    """
    space = surface.space
    ring, meridian = space.bases
    lines = np.tensordot(ring.matrix(ring.abscissae), surface.net, axes=1)
    u, w = gauss(space.degree + 3)

    def speed(t: Array) -> Array:
        rows = rational_matrix(space, t.ravel(), 1).reshape(*t.shape, -1)
        velocity = np.einsum("i...k,ikc->i...c", rows, lines)
        return np.asarray(np.linalg.norm(velocity, axis=-1))

    def walked(start: Array, end: Array) -> Array:
        t = start[..., None] + (end - start)[..., None] * u
        return np.asarray((end - start) * (speed(t) @ w))

    breaks = meridian.breaks
    pieces = walked(*(np.tile(side, (ring.count, 1)) for side in (breaks[:-1], breaks[1:])))
    cumulated = np.concatenate([np.zeros((ring.count, 1)), np.cumsum(pieces, axis=1)], axis=1)
    points, matrix = meridian_interpolation(space)
    wanted = cumulated[:, -1:] * grading.fraction(points)
    t = np.stack([np.interp(s, c, breaks) for s, c in zip(wanted, cumulated, strict=True)])
    for _ in range(30):
        element = np.clip(np.searchsorted(breaks, t, "right") - 1, 0, len(breaks) - 2)
        so_far = np.take_along_axis(cumulated, element, 1) + walked(breaks[element], t)
        step = (so_far - wanted) / speed(t)
        t = np.clip(t - step, breaks[0], breaks[-1])
        if np.abs(step).max() <= 1e-13:
            break
    rows = rational_matrix(space, t.ravel()).reshape(*t.shape, -1)
    values = np.einsum("ijk,ikc->ijc", rows, lines)
    return interpolated(space, values, matrix)


def straightened(surface: Surface, grading: Grading) -> Surface:
    """The same shape, lines of constant ``xi1`` as straight in plan as may be: from the inner edge,
    where ``xi1`` is the azimuth, to the point of the rim that has it already.

    The azimuth is taken about a point that moves with ``xi2`` from the middle of the inner edge to
    that of the outer one; it is that of a straight line between two such edges in one plane, also
    where the membrane is steep or overhangs. Where patches meet on a ring, steps along the spines
    leave bumps of the parametrization beside the joints; without them the space has its full order.
    """
    space = surface.space
    ring, meridian = space.bases
    points, matrix = meridian_interpolation(space)
    xi = np.stack(np.meshgrid(ring.abscissae, points, indexing="ij"), axis=-1)
    ends = np.array([surface.net[:, k, :2].mean(axis=0) for k in (0, -1)])
    part = (points - meridian.breaks[0]) / (meridian.breaks[-1] - meridian.breaks[0])
    middle = (1.0 - part)[:, None] * ends[0] + part[:, None] * ends[1]
    turn = 2.0 * np.pi / (ring.breaks[-1] - ring.breaks[0])
    ray = np.stack([np.cos(turn * ring.abscissae), np.sin(turn * ring.abscissae)], axis=1)
    inner = np.linalg.norm(surface.net[:, 0, :2] - ends[0], axis=1).mean() * ray
    rim = surface.at(xi[:, -1], 1).position[:, :2] - ends[1]
    out = grading.fraction(part)[:, None]
    aim = (1.0 - out) * inner[:, None] + out * rim[:, None]
    for _ in range(20):
        k = surface.at(xi[:, :-1], 1)
        x, y = np.moveaxis(k.position[..., :2] - middle[:-1], -1, 0)
        dx, dy = np.moveaxis(k.tangents[..., 0, :2], -1, 0)
        u, v = np.moveaxis(aim[:, :-1], -1, 0)
        off = np.arctan2(u * y - v * x, u * x + v * y)
        step = off * (x * x + y * y) / (x * dy - y * dx)
        xi[:, :-1, 0] -= step
        if np.abs(step).max() <= 1e-14 * (ring.breaks[-1] - ring.breaks[0]):
            break
    return interpolated(space, surface.at(xi, 1).position, matrix)


def interpolated(space: Space, values: Array, matrix: Array) -> Surface:
    """Surface with given values (n1, n2, 3) at the abscissae of a ring space and, along it, at
    the points of :func:`.ring.meridian_interpolation`, which gives the matrix."""
    ring = space.bases[0]
    along = np.linalg.solve(ring.matrix(ring.abscissae), values.reshape(ring.count, -1))
    net = np.einsum("jk,ikc->ijc", np.linalg.inv(matrix), along.reshape(values.shape))
    return Surface(space, points_of(space, net))
