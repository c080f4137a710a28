"""Knot vectors: construction, validation, Greville points, insertion."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array
from ..checks import array, integer, refusal
from ..errors import SceneError

DEGREE = partial(integer, least=1, most=32)
"""Rule of a degree: beyond, Bernstein polynomials lose more digits than a degree gains."""
ELEMENTS = partial(integer, least=1, most=65_536)
"""Rule of a number of elements in one direction."""

PATCH = partial(integer, least=1, most=4096)
"""Rule of a number of elements of both directions of a patch."""


def increasing(field: str, value: Any) -> Array:
    """Two or more numbers, each larger than the one before."""
    found = array(field, value, shape=(None,))
    if len(found) < 2 or not (np.diff(found) > 0.0).all():
        raise refusal(field, value, "two or more increasing numbers are needed", "sort them")
    return found


@checked(
    breaks=increasing,
    degree=partial(integer, least=0, most=32),
    continuity=partial(integer, least=-1),
)
def open_knots(breaks: ArrayLike, degree: int, continuity: int | None = None) -> Array:
    """Knot vector clamped at both ends with interior knots of equal smoothness.

    Parameters
    ----------
    breaks : (m + 1,) increasing element boundaries.
    degree : polynomial degree.
    continuity : number of continuous derivatives at interior knots, ``degree - 1`` if omitted.

    Returns
    -------
    knots : (m - 1) * (degree - continuity) + 2 * (degree + 1) values.

    Raises
    ------
    SceneError
        Breaks that do not increase; a continuity that is not below the degree.
    """
    t = np.asarray(breaks, float)
    if continuity is not None:
        integer("continuity", continuity, least=-1, most=degree - 1)
    multiplicity = 1 if continuity is None else degree - continuity
    interior = np.repeat(t[1:-1], multiplicity)
    return np.concatenate([np.repeat(t[:1], degree + 1), interior, np.repeat(t[-1:], degree + 1)])


def check_knots(knots: ArrayLike, degree: int, continuity: int = 1) -> Array:
    """Validated copy of a clamped knot vector.

    Raises
    ------
    SceneError
        With the index of the first bad knot: not finite, unsorted, too few, not clamped, repeated
        beyond the degree, or an interior knot smoother than asked is missing ("C1 needed").
    """
    t, p = np.array(knots, float), degree
    _check_order(t, p)
    values, first, counts = np.unique(t, return_index=True, return_counts=True)
    for value, index, count in zip(values, first, counts, strict=True):
        end = value in (t[0], t[-1])
        if count > p + 1 or (count > p and not end):
            raise SceneError(
                f"knots[{index}] = {value:g} is repeated {count} times; at most "
                f"{p + 1 if end else p} for degree {p}"
            )
        if not end and p - count < continuity:
            raise SceneError(
                f"knots[{index}] = {value:g} is repeated {count} times: the spline is C{p - count} "
                f"there, C{continuity} needed; at most {p - continuity} for degree {p}"
            )
    return t


def _check_order(t: Array, p: int) -> None:
    """Refuse knots that are too few, not finite, unsorted or not clamped."""
    if t.ndim != 1 or t.size < 2 * (p + 1):
        raise SceneError(
            f"knots: {t.size} values are too few; degree {p} needs at least {2 * (p + 1)}"
        )
    bad = np.flatnonzero(~np.isfinite(t))
    if bad.size:
        raise SceneError(f"knots[{bad[0]}] = {t[bad[0]]}: knots must be finite numbers")
    bad = np.flatnonzero(np.diff(t) < 0) + 1
    if bad.size:
        raise SceneError(
            f"knots[{bad[0]}] = {t[bad[0]]:g} is smaller than the knot before it "
            f"({t[bad[0] - 1]:g}): sort the knots"
        )
    for index, clamped in ((p, t[: p + 1]), (t.size - p - 1, t[-p - 1 :])):
        if clamped[0] != clamped[-1]:
            raise SceneError(
                f"knots[{index}] = {t[index]:g}: the first and the last {p + 1} knots must be "
                f"equal for degree {p} (a clamped knot vector)"
            )


def greville(knots: Array, degree: int) -> Array:
    """Greville points: means of ``degree`` consecutive knots, one per basis function."""
    count = len(knots) - degree - 1
    return np.array([knots[i + 1 : i + degree + 1].mean() for i in range(count)])


def insertion_matrix(knots: Array, degree: int, new: ArrayLike) -> tuple[Array, Array]:
    """Knot insertion (Boehm): the finer knots and the matrix that carries control points over.

    Parameters
    ----------
    knots : clamped knot vector with ``n`` functions.
    new : knots to insert, inside the domain.

    Returns
    -------
    finer : knot vector with ``n + len(new)`` functions.
    matrix : (n + len(new), n); ``matrix @ control_points`` leaves the curve unchanged. For a
        rational spline it acts on homogeneous control points.
    """
    t = np.asarray(knots, float)
    p = degree
    matrix = np.eye(len(t) - p - 1)
    for value in np.sort(np.asarray(new, float)):
        k = int(np.searchsorted(t, value, side="right")) - 1
        step = np.zeros((matrix.shape[0] + 1, matrix.shape[0]))
        for i in range(step.shape[0]):
            if i <= k - p:
                step[i, i] = 1.0
            elif i <= k:
                a = (value - t[i]) / (t[i + p] - t[i])
                step[i, i - 1 : i + 1] = 1.0 - a, a
            else:
                step[i, i - 1] = 1.0
        matrix = step @ matrix
        t = np.insert(t, k + 1, value)
    return t, matrix
