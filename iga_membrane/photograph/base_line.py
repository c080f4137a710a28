"""Where a droplet in a photograph stands or hangs: on a dark solid, on nothing that is seen, on its
mirror image, on a needle."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from ..arrays import Array, Mask
from ..errors import SceneError
from ..overview import brief_repr
from .shadow import CLEAR, LEVEL, Shadow, edge_near

MARGIN = 2.5
"""Pixels from the base line within which its own blur covers the droplet's edge."""
FOOT = 8
"""Pixels beside a droplet's foot within which a solid is not asked where its surface is."""
NEAR = 3.0
"""Pixels within which a column's edge belongs to a line that is nearly known."""
ROWS = 5
"""Rows next to the base that tell where the middle of the foot is."""
LOCAL = 25
"""Rows on either side of a mirror line that tell where the outline has its kink."""


@dataclass(frozen=True, eq=False)
class BaseLine:
    """The line that a droplet stands on or hangs from, in columns and rows of the image.

    Attributes
    ----------
    height : its row at column 0; slope : rows per column, positive where it falls to the right.
    error : standard error of its row at the droplet.
    body : (rows, columns) the droplet's pixels.
    hangs : whether it hangs.
    """

    height: float
    slope: float
    error: float
    body: Mask
    hangs: bool = False

    __repr__ = brief_repr

    @property
    def tilt(self) -> float:
        """Against the rows (radians)."""
        return float(np.arctan(self.slope))

    def row(self, column: float) -> float:
        """Of the line at a column."""
        return self.height + self.slope * column

    def is_clear(self, row: int, columns: Iterable[float]) -> bool:
        """Whether places in a row are off the line's blur."""
        return all(abs(row - self.row(column)) > MARGIN for column in columns)

    def foot(self, edges: Array) -> float:
        """Column of the middle of the foot, of edges (n, 2) with their rows."""
        away = np.abs(edges[:, 1] - self.row(0.0) - self.slope * edges[:, 0])
        near = edges[np.argsort(away, kind="stable")[: 4 * ROWS]]
        middle = near[:, 0].mean()
        sides = near[near[:, 0] < middle, 0], near[near[:, 0] >= middle, 0]
        return float(0.5 * sum(side.mean() for side in sides if len(side)))


def base_of(shadow: Shadow) -> BaseLine:
    """The base line of the droplet in a photograph.

    Raises
    ------
    SceneError
        There is no droplet, or nothing tells where its base is.
    """
    strip = max(4, shadow.dark.shape[1] // 40)
    if shadow.dark[-1, :strip].all() and shadow.dark[-1, -strip:].all():
        return _whole(_on_solid(shadow, strip))
    body = _largest(shadow.dark)
    if body[0].any():
        return _whole(_on_needle(shadow, body))
    return _whole(_flat_bottom(shadow, body) or _mirror(shadow, body))


def _whole(base: BaseLine) -> BaseLine:
    """A base line whose droplet lies within the picture.

    Raises
    ------
    SceneError
        With the border that it reaches.
    """
    body = base.body
    borders = {"left": body[:, 0], "right": body[:, -1], "upper": body[0], "lower": body[-1]}
    for name, border in borders.items():
        if border.any():
            raise SceneError(
                f"image: the droplet reaches its {name} border; all of it must be seen, without a "
                "needle in a droplet that stands"
            )
    return base


def _largest(dark: Mask) -> Mask:
    """The largest connected part of a shadow."""
    names, count = ndimage.label(dark)
    if not count:
        raise SceneError("image: nothing dark stands out of the base; there is no droplet in it")
    sizes = np.bincount(names.ravel())[1:]
    return np.asarray(names == 1 + int(sizes.argmax()))


def _line_through(columns: Array, rows: Array, at: float) -> tuple[float, float, float]:
    """Height at column 0, slope and the standard error of the row at a column, by least squares."""
    middle = columns.mean()
    away = columns - middle
    spread = float(away @ away)
    slope = float(away @ rows / spread) if spread else 0.0
    height = float(rows.mean() - slope * middle)
    off = rows - height - slope * columns
    noise = float(off @ off) / max(len(rows) - 2, 1)
    error = np.sqrt(noise * (1.0 / len(rows) + ((at - middle) ** 2 / spread if spread else 0.0)))
    return height, slope, float(error)


def _on_solid(shadow: Shadow, strip: int) -> BaseLine:
    """A dark solid from border to border: its surface beside the droplet, column by column."""
    rows, columns = shadow.dark.shape
    bright = ~shadow.dark[::-1]
    # of each column the height of the dark that reaches up from below
    top = rows - np.where(bright.any(axis=0), bright.argmax(axis=0), rows)
    sides = np.r_[:strip, columns - strip : columns]
    height, slope, _ = _line_through(sides.astype(float), top[sides] - 0.5, 0.5 * columns)
    if abs(slope) > STEEPEST:
        raise SceneError(
            "image: the solid's surface is not seen on both sides: the droplet reaches a side "
            "border, or the camera is tilted by more than 10 degrees"
        )
    bare = np.abs(top - 0.5 - height - slope * np.arange(columns)) < NEAR
    left = int((~bare).argmax()) if not bare.all() else columns // 2
    right = columns - int((~bare[::-1]).argmax()) if not bare.all() else columns // 2
    asked = np.r_[: max(left - FOOT, strip), min(right + FOOT, columns - strip) : columns]
    asked = asked[[_open(shadow.dark[:, j], int(top[j])) for j in asked]]
    found = [(j, _surface(shadow.values[:, j], top[j] - 0.5, rows)) for j in asked]
    known = np.array([(j, row) for j, row in found if row is not None])
    if len(known) < strip:
        raise SceneError(
            "image: the surface of the solid has no clear edge beside the droplet; take the "
            "picture so that some of it is seen on both sides"
        )
    height, slope, error = _line_through(known[:, 0], known[:, 1], 0.5 * (left + right))
    off = known[:, 1] - height - slope * known[:, 0]
    if float(np.sqrt(np.mean(off**2))) > STRAIGHT:
        raise SceneError(
            "image: the solid's surface beside the droplet is not straight, or not seen on both "
            "sides; nothing tells where the base line is"
        )
    above = np.arange(rows)[:, None] < height + slope * np.arange(columns) - 0.5
    return BaseLine(height, slope, error, _largest(shadow.dark & above))


STEEPEST = float(np.tan(np.radians(10.0)))
"""Rows per column of a base line at most: nobody tilts a camera by more unseen."""
STRAIGHT = 1.0
"""Pixels by which the surface of a solid may be rough (root mean square)."""


def _open(column: Mask, top: int) -> bool:
    """Whether nothing hangs over a solid's surface where its brightness is asked for."""
    return not column[max(top - CLEAR - LEVEL - 1, 0) : top].any()


def _surface(column: Array, start: float, rows: int) -> float | None:
    return edge_near(column, start, 1, rows - start)


def _flat_bottom(shadow: Shadow, body: Mask) -> BaseLine | None:
    """A droplet that ends in a straight line; None where its lower end is round."""
    rows = len(body)
    bottom = rows - 1 - body[::-1].argmax(axis=0)
    last = int(np.flatnonzero(body.any(axis=1))[-1])
    foot = np.flatnonzero(body[max(last - 2, 0)])
    wide = foot[-1] - foot[0] + 1
    if wide < max(4 * CLEAR, FLAT * int(body[max(last - 2 * FOOT, 0)].sum())):
        return None
    middle = np.arange(foot[0] + wide // 6, foot[-1] + 1 - wide // 6)
    found = [(j, edge_near(shadow.values[:, j], bottom[j] + 0.5, -1, rows / 4)) for j in middle]
    known = np.array([(j, row) for j, row in found if row is not None])
    if len(known) < 0.8 * len(middle):
        return None
    height, slope, error = _line_through(known[:, 0], known[:, 1], float(middle.mean()))
    return BaseLine(height, slope, error, body)


FLAT = 0.6
"""Width two rows above the end of a droplet over that sixteen rows above: a round end has a third,
one cut straight at 30 degrees 0.8."""


def _sides(shadow: Shadow, body: Mask) -> tuple[Array, Array]:
    """Rows of a body, and columns (rows, 2) of its edges there."""
    rows, edges = [], []
    for row in np.flatnonzero(body.any(axis=1)):
        columns = np.flatnonzero(body[row])
        left, right = columns[0] - 0.5, columns[-1] + 0.5
        room = 0.5 * (right - left)
        if room < CLEAR + 2:
            continue
        both = (edge_near(shadow.values[row], left, 1, room),
                edge_near(shadow.values[row], right, -1, room))  # fmt: skip
        if None not in both:
            rows.append(row)
            edges.append(both)
    return np.array(rows, float), np.array(edges, float).reshape(-1, 2)


def _mirror(shadow: Shadow, body: Mask) -> BaseLine:
    """A droplet on a bright solid that mirrors it: its outline and that of its image meet in a
    kink, about which they are symmetric."""
    from scipy.optimize import minimize_scalar

    rows, edges = _sides(shadow, body)
    count = min(LOCAL, len(rows) // 4)
    if count < ROWS:
        raise SceneError("image: the droplet has too few rows of pixels; come closer")
    places = np.arange(count, len(rows) - count)
    lopsided = np.array([_lopsided(edges, int(k), count) for k in places])
    even = places[lopsided < LIKELY * float(lopsided.min())]
    start = rows[max(even, key=lambda k: _kink(rows, edges, k, count))]

    def asymmetry(row: float) -> float:
        reach = min(row - rows[0], rows[-1] - row)
        t = np.arange(MARGIN, reach)
        off = [np.interp(row + t, rows, side) - np.interp(row - t, rows, side) for side in edges.T]
        return float(np.mean(np.square(off)))

    found = minimize_scalar(asymmetry, bounds=(start - NEAR, start + NEAR), method="bounded",
                            options={"xatol": 1e-3})  # fmt: skip
    row = float(found.x)
    # a shift of the line by e moves one outline against the other by 2 e times their slope
    t = np.arange(MARGIN, min(row - rows[0], rows[-1] - row))
    rise = [np.interp(row + t + 1, rows, side) - np.interp(row + t - 1, rows, side)
            for side in edges.T]  # fmt: skip
    known = float(np.sum(np.square(rise)))
    error = np.sqrt(asymmetry(row) / known) if known else np.inf
    return BaseLine(row, 0.0, float(error), body)


LIKELY = 8.0
"""Mean square by which an outline and its image may differ, over the least of all mirror lines."""


def _lopsided(edges: Array, k: int, count: int) -> float:
    """Mean square difference between the edges above a row and those below it, or above and below
    the border to the next row."""
    below = edges[k + 1 : k + count + 1]
    others = edges[k - count : k][::-1], edges[k - count + 1 : k + 1][::-1]
    return min(float(np.mean((above[: len(below)] - below) ** 2)) for above in others)


def _kink(rows: Array, edges: Array, k: int, count: int) -> float:
    """By how much both edges turn at a row, the same way to both sides."""
    turn = 0.0
    for side, sign in zip(edges.T, (-1.0, 1.0), strict=True):
        above = np.polyfit(rows[k - count : k] - rows[k], side[k - count : k], 2)[1]
        below = np.polyfit(rows[k : k + count] - rows[k], side[k : k + count], 2)[1]
        turn += sign * (above - below)
    return abs(float(turn))


def _on_needle(shadow: Shadow, body: Mask) -> BaseLine:
    """A droplet that hangs from a needle: the needle's edges are straight down to its end."""
    rows, edges = _sides(shadow, body)
    if len(rows) < 4 * ROWS:
        raise SceneError("image: what hangs from above has too few rows of pixels; come closer")
    end = _departure(edges - edges[: 2 * ROWS].mean(axis=0), 2.0)
    lines = [np.polyfit(rows[: max(end - ROWS, ROWS)], side[: max(end - ROWS, ROWS)], 1)
             for side in edges.T]  # fmt: skip
    straight = np.stack([np.polyval(line, rows) for line in lines], axis=1)
    end = _departure(edges - straight, 1.0)
    if end >= len(rows) - 2 * ROWS:
        raise SceneError("image: what hangs from above is straight to its end; no droplet is on it")
    lean = float(np.mean([line[0] for line in lines]))
    middle = float(straight[end].mean())
    tip = float(rows[end])
    below = (np.arange(len(body)) > tip)[:, None] & body
    return replace(
        BaseLine(tip, 0.0, 1.0, below, hangs=True), slope=-lean, height=tip + lean * middle
    )


def _departure(off: Array, by: float) -> int:
    """The first of some rows in a sequence in which one of two edges is off by a distance."""
    far = np.abs(off).max(axis=1) > by
    lasting = far[:-2] & far[1:-1] & far[2:]
    return int(lasting.argmax()) if lasting.any() else len(far)
