"""Quadrature of elements that a level line cuts: of their positive part, and of the line itself.

Boxes are quartered until the line is a graph ``u_h(u_o)`` of one coordinate over the other in each.
Its ends on the sides ``u_h = const`` divide the other coordinate into pieces, on which everything
is smooth: Gauss rules on the pieces have the full order (Saye, doi 10.1137/140966290).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index, Mask
from ..quadrature import gauss

Level = Callable[[Index, Array], tuple[Array, Array, Index]]
"""Level function: rows (r,) and local points (r, q, 2) in [0, 1]^2 to values (r, q), gradients by
local coordinates (r, q, 2) and the number (r, q) of the line near each point."""


@dataclass(frozen=True, eq=False)
class Points:
    """Quadrature points by pieces, in local coordinates of their elements.

    Attributes
    ----------
    rows : (k,) the element of each piece.
    u : (k, q, 2) points; weights : (k, q).
    """

    rows: Index
    u: Array
    weights: Array

    def part(self, some: Mask) -> Points:
        """Some of the pieces."""
        return Points(self.rows[some], self.u[some], self.weights[some])


@dataclass(frozen=True, eq=False)
class Cut:
    """What a level line makes of some elements.

    Attributes
    ----------
    sign : (rows,) 1 where an element is positive, -1 where negative, 0 where cut.
    area : the positive part of the cut elements.
    line : the level line; weights are those of the coordinate along it.
    across : (lines,) 0 or 1, the coordinate that the line is a graph of.
    rising : (lines,) sign of the level's slope across the line.
    ends : where lines end on sides that their graph crosses; weights are +1 on upper sides, -1 on
        lower ones.
    ends_line : (ends,) the piece of the line that each belongs to: its ``across`` and ``rising``.
    """

    sign: Index
    area: Points
    line: Points
    across: Index
    rising: Index
    ends: Points
    ends_line: Index


SAMPLES = 4
"""Points along a box that decide how it is cut."""
STEEP = 0.6
"""Least slope across a graph over the largest along it."""
DEEPEST = 7
"""Quarterings at most."""
CLOSE, BISECTIONS = 1e-11, 50
"""Last step of Newton's method for a root, whose error is its square, and steps at most."""
ALONG = 8
"""Intervals of a box's side in which the line's ends are sought."""


def cut(level: Level, count: int, points: int) -> Cut:
    """Cut elements ``0 .. count - 1`` with Gauss rules of ``points`` per direction."""
    rows, low, size = np.arange(count), np.zeros((count, 2)), 1.0
    sign = np.zeros(count, int)
    whole: list[tuple[Index, Array, float]] = []
    boxes: list[tuple[Index, Array, float, Index]] = []
    grid = (np.arange(SAMPLES) + 0.5) / SAMPLES
    samples = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1).reshape(-1, 2)
    for depth in range(DEEPEST + 1):
        value, slope, which = level(rows, low[:, None] + size * samples)
        vary = _variation(slope)
        reach = (0.5 * size / SAMPLES) * (np.abs(slope) + vary[:, None])
        near = np.abs(value) <= reach.sum(axis=-1)
        positive = value[:, 0] > 0
        clear = ~near.any(axis=1) & (positive[:, None] == (value > 0)).all(axis=1)
        if depth == 0:
            sign[clear] = np.where(positive[clear], 1, -1)
        elif depth == DEEPEST:
            clear[:], positive = True, value.mean(axis=1) > 0
        if depth:
            whole.append((rows[clear & positive], low[clear & positive], size))
        across = _graph_axis(slope, vary, near, which)
        taken = ~clear & (across >= 0)
        boxes.append((rows[taken], low[taken], size, across[taken]))
        left = ~clear & ~taken
        rows, low, size = np.repeat(rows[left], 4), np.repeat(low[left], 4, axis=0), 0.5 * size
        low = low + size * np.tile([[0, 0], [0, 1], [1, 0], [1, 1]], (int(left.sum()), 1))
        if not len(rows):
            break
    return _pieces(level, sign, whole, boxes, points)


def _variation(slope: Array) -> Array:
    """(rows, 2) how much each slope may vary round a sample."""
    grid = slope.reshape(-1, SAMPLES, SAMPLES, 2)
    steps = [np.abs(np.diff(grid, axis=k)).max(axis=(1, 2)) for k in (1, 2)]
    return np.asarray(0.5 * (steps[0] + steps[1]))


def _graph_axis(slope: Array, vary: Array, near: Mask, which: Index) -> Index:
    """(rows,) coordinate of which the line is a graph in each box, -1 for neither."""
    some = near[..., None]
    lowest = np.where(some, slope, np.inf).min(axis=1) - vary
    highest = np.where(some, slope, -np.inf).max(axis=1) + vary
    least = np.maximum(lowest, -highest)  # negative where the slope changes its sign
    most = np.maximum(highest, -lowest)
    ratio = least / np.maximum(most[:, ::-1], 1e-300)
    first = which[np.arange(len(near)), near.argmax(axis=1)]
    single = ((which == first[:, None]) | ~near).all(axis=1)
    best = ratio.argmax(axis=1)
    return np.where(single & (ratio.max(axis=1) > STEEP), best, -1)


def _pieces(
    level: Level,
    sign: Index,
    whole: list[tuple[Index, Array, float]],
    boxes: list[tuple[Index, Array, float, Index]],
    points: int,
) -> Cut:
    """Rules on all boxes."""
    nodes, weights = gauss(points)
    square = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
    rows = np.concatenate([b[0] for b in boxes])
    low = np.concatenate([b[1] for b in boxes])
    size = np.concatenate([np.full(len(b[0]), b[2]) for b in boxes])
    across = np.concatenate([b[3] for b in boxes])

    def at(box: Index, o: Array, h: Array) -> tuple[Array, Array, Array]:
        """Level, its slopes along and across, where coordinates (k, q) of boxes are given."""
        first = (across[box] == 0)[:, None]
        u = np.stack([np.where(first, h, o), np.where(first, o, h)], axis=-1)
        value, slope, _ = level(rows[box], u)
        along, over = (
            np.where(first, slope[..., 1], slope[..., 0]),
            np.where(first, slope[..., 0], slope[..., 1]),
        )
        return value, along, over

    number = np.arange(len(rows))
    start = low[number, 1 - across] if len(rows) else np.zeros(0)
    bottom = low[number, across] if len(rows) else np.zeros(0)
    side_box, side_end, side_o = _side_roots(at, number, start, bottom, size)
    # breaks along each box
    box = np.concatenate([number, number, side_box])
    place = np.concatenate([start, start + size, side_o])
    order = np.lexsort((place, box))
    box, place = box[order], place[order]
    inside = (box[1:] == box[:-1]) & (np.diff(place) > 1e-13)
    box, first, last = box[:-1][inside], place[:-1][inside], place[1:][inside]
    middle = 0.5 * (first + last)[:, None]
    lower = at(box, middle, bottom[box][:, None])[0][:, 0] > 0
    upper = at(box, middle, (bottom + size)[box][:, None])[0][:, 0] > 0
    full, divided = lower & upper, lower != upper
    area = [
        Points(r, lo[:, None] + s * square, np.tile(s * s * np.outer(weights, weights).ravel(),
                                                    (len(r), 1)))
        for r, lo, s in whole
    ]  # fmt: skip

    def strip(some: Index, o: Array, wo: Array, h0: Array, h1: Array) -> Points:
        """Rule between two graphs (k, q) over points along."""
        h = h0[..., None] + (h1 - h0)[..., None] * nodes
        w = wo[..., None] * (h1 - h0)[..., None] * weights
        along = np.broadcast_to(o[..., None], h.shape)
        over = (across[some] == 0)[:, None, None]
        u = np.stack([np.where(over, h, along), np.where(over, along, h)], axis=-1)
        return Points(
            rows[some], u.reshape(len(some), points**2, 2), w.reshape(len(some), points**2)
        )

    def spread(chosen: Mask) -> tuple[Index, Array, Array, Array, Array]:
        some, a, b = box[chosen], first[chosen], last[chosen]
        o = a[:, None] + (b - a)[:, None] * nodes
        base = np.broadcast_to(bottom[some][:, None], o.shape)
        return some, o, (b - a)[:, None] * weights, base, base + size[some][:, None]

    some, o, wo, h0, h1 = spread(full)
    area.append(strip(some, o, wo, h0, h1))
    some, o, wo, h0, h1 = spread(divided)
    root = _roots(lambda h: at(some, o, h)[::2], h0, h1)
    rising = np.where(upper[divided], 1, -1)
    up = (rising > 0)[:, None]
    area.append(strip(some, o, wo, np.where(up, root, h0), np.where(up, h1, root)))
    over = (across[some] == 0)[:, None]
    u = np.stack([np.where(over, root, o), np.where(over, o, root)], axis=-1)
    line = Points(rows[some], u, wo)
    # the ends of each piece that lie on the sides which its graph crosses
    height = bottom[side_box] + size[side_box] * side_end
    over = across[side_box] == 0
    u = np.stack([np.where(over, height, side_o), np.where(over, side_o, height)], axis=-1)
    owner = np.full(len(rows), -1)
    owner[some] = np.arange(len(some))
    ends = Points(rows[side_box], u[:, None], np.where(side_end > 0, 1.0, -1.0)[:, None])
    kept = owner[side_box] >= 0
    every = Points(
        *(np.concatenate([getattr(p, n) for p in area]) for n in ("rows", "u", "weights"))
    )
    return Cut(sign, every, line, across[some], rising, ends.part(kept), owner[side_box][kept])


def _side_roots(
    at: Callable[[Index, Array, Array], tuple[Array, Array, Array]],
    number: Index,
    start: Array,
    bottom: Array,
    size: Array,
) -> tuple[Index, Index, Array]:
    """Boxes, ends (0 lower, 1 upper) and places where lines end on the sides across."""
    steps = np.linspace(0.0, 1.0, ALONG + 1)
    found: list[tuple[Index, Index, Array]] = []
    for end in (0, 1):
        o = start[:, None] + size[:, None] * steps
        h = np.broadcast_to((bottom + end * size)[:, None], o.shape)
        value, along, _ = at(number, o, h)
        a, b = o[:, :-1].ravel(), o[:, 1:].ravel()
        va, vb = value[:, :-1].ravel(), value[:, 1:].ravel()
        da, db = along[:, :-1].ravel(), along[:, 1:].ravel()
        box = np.repeat(number, ALONG)
        # a pair of roots between samples of one sign: an extremum of the other sign
        turning = ((va > 0) == (vb > 0)) & (da * db < 0) & (da * va < 0)
        t = np.flatnonzero(turning)
        if len(t):
            top = a[t] + (b[t] - a[t]) * da[t] / (da[t] - db[t])
            peak = at(box[t], top[:, None], (bottom + end * size)[box[t]][:, None])[0][:, 0]
            crossed = (peak > 0) != (va[t] > 0)
            t, top, peak = t[crossed], top[crossed], peak[crossed]
            box = np.concatenate([box, box[t]])
            a, b = np.concatenate([a, top]), np.concatenate([b, b[t]])
            va, vb = np.concatenate([va, peak]), np.concatenate([vb, vb[t]])
            b[t], vb[t] = top, peak
        hit = np.flatnonzero((va > 0) != (vb > 0))
        box, height = box[hit], (bottom + end * size)[box[hit]][:, None]

        def along_side(o: Array, box: Index = box, height: Array = height) -> tuple[Array, Array]:
            return at(box, o, height)[:2]

        root = _roots(along_side, a[hit][:, None], b[hit][:, None])[:, 0]
        found.append((box, np.full(len(hit), end), root))
    return tuple(np.concatenate(parts) for parts in zip(*found, strict=True))  # type: ignore[return-value]


def _roots(level: Callable[[Array], tuple[Array, Array]], low: Array, high: Array) -> Array:
    """Roots between ends of opposite signs, by Newton's method kept inside the bracket."""
    low, high = low.copy(), high.copy()
    if not low.size:
        return low
    rising = level(high)[0] > 0
    x = 0.5 * (low + high)
    for _ in range(BISECTIONS):
        value, slope = level(x)
        beyond = (value > 0) == rising
        high = np.where(beyond, x, high)
        low = np.where(beyond, low, x)
        with np.errstate(divide="ignore", invalid="ignore"):
            newer = x - value / slope
        inside = (newer >= low) & (newer <= high)
        newer = np.where(inside, newer, 0.5 * (low + high))
        done = np.abs(newer - x).max() <= CLOSE
        x = newer
        if done:
            break
    return x
