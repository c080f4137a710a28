"""Ring patches: an azimuth ``xi1`` and meridians ``xi2``, open or closed by a pole.

Surfaces of revolution are interpolated along the meridian. Round the ring their circles are
approximated so that the mean radius is exact: the ripple that is left averages to zero, and
energies feel only its square.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import either, function, integer, number, words
from ..errors import SceneError
from ..own import answer_of, called
from ..quadrature import gauss
from ..splines import (
    DEGREE,
    PATCH,
    POLYNOMIALS,
    Basis,
    BasisOf,
    Space,
    bspline_basis,
    close_pole,
    lagrange_basis,
    line_basis,
    open_knots,
    points_of,
    ring_basis,
    tensor_space,
)
from .surface import Surface

PATCHES: dict[str, Any] = {
    "kind": either(words(*POLYNOMIALS, "nurbs"), partial(function, arguments=2)),
    "degree": DEGREE,
    "elements": PATCH,
    "sectors": PATCH,
    "angle": partial(number, above=0.0, most=2.0 * np.pi),
    "around": PATCH,
}
"""Rules of the arguments of ring patches."""


@checked(**PATCHES)
def ring_space(
    kind: str | BasisOf,
    degree: int,
    elements: int,
    sectors: int = 8,
    *,
    angle: float = 0.5 * np.pi,
    corners: bool = False,
    around: int | None = None,
    kink: int | None = None,
) -> Space:
    """Open ring patch.

    Parameters
    ----------
    degree : of both directions.
    kind : "bspline", "nurbs" or "lagrange", or a basis of your own for the meridian
        (:func:`line_basis`); the ring is then of B-splines.
    elements : along the meridian; the ring has twice as many, rounded up to whole sectors.
    sectors : the ring's elements are a multiple of it.
    angle : "nurbs": opening (radians) of the arc that the weights make exact along the meridian.
    corners : four patches that meet on the diagonals with continuity 1, for a square rim; each
        eighth of the ring then has ``elements`` elements.
    around : elements round the ring, instead.
    kink : element along the meridian at whose start splines have continuity 0: a contact line
        inside the patch.
    """
    if kink is not None:
        integer("kink", kink, least=1, most=elements - 1)
    if around is None:
        around = 8 * elements if corners else 2 * elements
    around = sectors * max(1, -(-around // sectors))
    polynomial = "lagrange" if kind == "lagrange" else "bspline"
    if polynomial == "bspline":
        around = max(around, sectors * -(-(degree + 1) // sectors))
    joints = [around // 8 * k for k in (1, 3, 5, 7)] if corners else []
    ring = ring_basis(polynomial, around, degree, 2.0 * np.pi, joints)
    along = kind if callable(kind) else polynomial
    meridian = line_basis(along, elements, degree, () if kink is None else (kink,))
    weights = None
    if kind == "nurbs":
        weights = np.broadcast_to(arc_weights(meridian, angle), (ring.count, meridian.count))
    return tensor_space(ring, meridian, weights)


@checked(**PATCHES)
def drop_space(
    kind: str | BasisOf,
    degree: int,
    elements: int,
    sectors: int = 8,
    *,
    angle: float = 0.5 * np.pi,
    around: int | None = None,
    kink: int | None = None,
) -> Space:
    """Ring patch closed by a pole: ``xi2`` runs from the rim (0) to the pole (1).

    Parameters are those of :func:`ring_space`.
    """
    return close_pole(
        ring_space(kind, degree, elements, sectors, angle=angle, around=around, kink=kink)
    )


def arc_weights(meridian: Basis, angle: float) -> Array:
    """(n,) weights of the arc of opening ``angle`` in a spline basis on [0, 1].

    The denominator of the rational quadratic arc, ``1 - 2 (1 - cos(angle / 2)) t (1 - t)``, is a
    polynomial of the spline space, so interpolation gives its coefficients.
    """
    t = meridian.abscissae
    values = 1.0 - 2.0 * (1.0 - np.cos(0.5 * angle)) * t * (1.0 - t)
    return np.linalg.solve(meridian.matrix(t), values)


def meridian_interpolation(space: Space) -> tuple[Array, Array]:
    """Interpolation along ``xi2`` that keeps a C1 pole.

    Returns
    -------
    points : (n2,) where the values are taken; at a C1 pole the last but one is replaced by the
        derivative at the pole.
    matrix : (n2, n2) rows acting on the coefficients, in the same order.
    """
    basis = space.bases[1]
    points = basis.abscissae.copy()
    matrix = rational_matrix(space, points)
    if space.pole == 1:
        points[-2] = basis.breaks[-1]
        matrix[-2] = rational_matrix(space, points[-2:-1], 1)[0]
    return points, matrix


def rational_matrix(space: Space, t: Array, derivative: int = 0) -> Array:
    """Collocation matrix (len(t), n2) of the meridian basis, with the space's weights."""
    basis = space.bases[1]
    matrix = basis.matrix(t, derivative)
    if space.weights is None:
        return matrix
    w = space.weights[0]
    total = basis.matrix(t) @ w
    if derivative == 0:
        return np.asarray(matrix * w / total[:, None])
    slope = matrix @ w
    return np.asarray((matrix - basis.matrix(t) * (slope / total)[:, None]) * w / total[:, None])


@checked()
def axisymmetric(space: Space, profile: Callable[[Array], tuple[Array, Array, Array]]) -> Surface:
    """Interpolate a surface of revolution in a ring space.

    Parameters
    ----------
    space : of a ring patch, open or closed by a pole.
    profile : ``t -> (r, z, dr/dt)`` along ``xi2``; at a pole (t = 1) ``r = 0`` and ``dz/dt = 0``.

    Raises
    ------
    SceneError
        A space that is no ring; a profile that does not return three arrays as long as its own.
    """
    if not space.bases[0].periodic:
        raise SceneError("space: a surface of revolution needs a ring, build it by ring_space")
    points, matrix = meridian_interpolation(space)
    r, z, slope = answer_of(profile, called(profile, points), ("r", "z", "dr/dt"), points.shape)
    if space.pole == 1:
        r[-2], z[-2] = slope[-2], 0.0
    r, z = np.linalg.solve(matrix, np.stack([r, z], axis=1)).T
    ring = circle(space.bases[0])
    net = ring[:, None] * r[:, None] + np.outer(z, [0.0, 0.0, 1.0])
    return Surface(space, points_of(space, net))


def circle(ring: Basis) -> Array:
    """(n1, 3) control points of the unit circle: its mean radius is exact, the ripple small."""
    turn = 2.0 * np.pi / (ring.breaks[-1] - ring.breaks[0])
    angles = turn * ring.abscissae
    values = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    points = np.linalg.solve(ring.matrix(ring.abscissae), values)
    u, w = gauss(ring.degree + 4)
    t = (ring.breaks[:-1, None] + ring.sizes[:, None] * u).ravel()
    weights = (ring.sizes[:, None] * w).ravel() * turn / np.pi
    amplitude = (ring.matrix(t) @ points[:, 0]) * np.cos(turn * t) @ weights
    return np.asarray(points / amplitude)


def square(ring: Basis) -> Array:
    """(n1, 3) control points of the square with corners (+-1, +-1), for a ring with joints on the
    diagonals; ``xi1`` is the azimuth of the sides' middles.

    Two control points meet in each corner: the curve is C1 by its parameter and comes to rest
    there, so that surfaces which end on it are C1 inside.
    """
    side = _side(ring)
    turns = 4.0 * ring.abscissae / (ring.breaks[-1] - ring.breaks[0])
    which = np.floor(turns + 0.5)
    k = np.abs(side.abscissae[:, None] - 2.0 * (turns - which)).argmin(axis=0)
    t = side.abscissae
    # at rest in the corners, as even as a fifth power allows
    matrix, values = side.matrix(t), 0.25 * (5.0 * t - t**5)
    if side.continuity:
        matrix[[1, -2]], values[[1, -2]] = side.matrix([-1.0, 1.0], 1), 0.0
    along = np.linalg.solve(matrix, values)[k]
    cosine, sine = np.round([np.cos(0.5 * np.pi * which), np.sin(0.5 * np.pi * which)])
    x, y = cosine - along * sine, sine + along * cosine
    return np.stack([x, y, np.zeros_like(x)], axis=1)


def _side(ring: Basis) -> Basis:
    """The basis on one side of a square, from -1 to 1, clamped at the corners."""
    breaks = np.linspace(-1.0, 1.0, ring.elements // 4 + 1)
    if ring.continuity == 0:
        return lagrange_basis(breaks, ring.degree)
    return bspline_basis(open_knots(breaks, ring.degree), ring.degree)
