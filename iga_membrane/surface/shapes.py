"""Surfaces to start from: exact quadrics (NURBS), flat sheets, axisymmetric drops."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import SceneError
from ..splines import (
    Basis,
    Space,
    bspline_basis,
    close_pole,
    line_basis,
    open_knots,
    points_of,
    ring_angles,
    ring_basis,
    tensor_space,
)
from .surface import Surface


def arc(start: float, end: float) -> tuple[Basis, Array, Array]:
    """Exact circular arc of unit radius as a quadratic NURBS in pieces of at most 90 degrees.

    Parameters
    ----------
    start, end : angles in radians.

    Returns
    -------
    basis, points (n, 2), weights (n,)
    """
    pieces = max(1, int(np.ceil(abs(end - start) / (0.5 * np.pi) - 1e-12)))
    angles = np.linspace(start, end, 2 * pieces + 1)
    half = 0.5 * (end - start) / pieces
    weights = np.where(np.arange(2 * pieces + 1) % 2, np.cos(half), 1.0)
    points = np.stack([np.cos(angles), np.sin(angles)], axis=1) / weights[:, None]
    knots = open_knots(np.linspace(0.0, 1.0, pieces + 1), 2, continuity=0)
    return bspline_basis(knots, 2, continuity=0), points, weights


def revolution(basis: Basis, profile: ArrayLike, weights: Array) -> Surface:
    """Exact surface of revolution of a NURBS profile about the z axis.

    Parameters
    ----------
    profile : (n, 2) control points (r, z); the normal points to the right of its sense, away from
        the axis for a profile that goes up.
    """
    ring, circle, ring_weights = arc(0.0, 2.0 * np.pi)
    r, z = np.asarray(profile, float).T
    space = tensor_space(ring, basis, np.outer(ring_weights, weights))
    net = np.stack([np.outer(circle[:, 0], r), np.outer(circle[:, 1], r),
                    np.broadcast_to(z, (len(circle), len(z)))], axis=-1)  # fmt: skip
    return Surface(space, net.reshape(-1, 3))


def sphere(radius: float = 1.0) -> Surface:
    """Exact sphere about the origin, outward normal, poles on the z axis."""
    basis, points, weights = arc(-0.5 * np.pi, 0.5 * np.pi)
    return revolution(basis, radius * points, weights)


def cap(radius: float, contact_angle: float) -> Surface:
    """Exact spherical cap on z = 0 that meets the plane at ``contact_angle`` (degrees, inside).

    Parameters
    ----------
    radius : of the sphere.
    """
    theta = np.radians(contact_angle)
    basis, points, weights = arc(0.5 * np.pi - theta, 0.5 * np.pi)
    return revolution(basis, radius * (points - [0.0, np.cos(theta)]), weights)


def cylinder(radius: float, height: float) -> Surface:
    """Exact open cylinder about the z axis from z = 0 to ``height``, outward normal."""
    basis = bspline_basis([0.0, 0.0, 1.0, 1.0], 1, continuity=0)
    return revolution(basis, [[radius, 0.0], [radius, height]], np.ones(2))


def disc(radius: float) -> Surface:
    """Exact flat disc in z = 0, normal up."""
    basis = bspline_basis([0.0, 0.0, 1.0, 1.0], 1, continuity=0)
    return revolution(basis, [[radius, 0.0], [0.0, 0.0]], np.ones(2))


def sheet(size: float, *, elements: int = 8, degree: int = 3, space: str = "bspline") -> Surface:
    """Flat square sheet centred in z = 0, normal up, edges parallel to x and y.

    Parameters
    ----------
    size : edge length.
    """
    basis = line_basis(space, elements, degree)
    product = tensor_space(basis, basis)
    flat = size * (product.abscissae.reshape(-1, 2) - 0.5)
    return Surface(product, np.column_stack([flat, np.zeros(len(flat))]))


def drop_space(
    kind: str,
    degree: int,
    elements: int,
    sectors: int = 8,
    *,
    angle: float | None = None,
) -> Space:
    """Ring patch closed by a pole: ``xi1`` is the azimuth, ``xi2`` runs from the rim (0) to the
    pole (1).

    Parameters
    ----------
    kind : "bspline", "nurbs" or "lagrange".
    elements : along the meridian; the ring has twice as many, rounded up to whole sectors.
    sectors : the ring's elements are a multiple of it.
    angle : "nurbs": half opening angle (radians) of the cap that the weights make exact along the
        meridian.
    """
    around = sectors * max(1, -(-2 * elements // sectors))
    polynomial = "lagrange" if kind == "lagrange" else "bspline"
    if polynomial == "bspline":
        around = max(around, sectors * -(-(degree + 1) // sectors))
    ring = ring_basis(polynomial, around, degree, 2.0 * np.pi)
    meridian = line_basis(polynomial, elements, degree)
    weights = None
    if kind == "nurbs":
        weights = np.broadcast_to(
            arc_weights(meridian, angle or 0.5 * np.pi), (ring.count, meridian.count)
        )
    return close_pole(tensor_space(ring, meridian, weights))


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


def axisymmetric(space: Space, profile: Callable[[Array], tuple[Array, Array, Array]]) -> Surface:
    """Interpolate a surface of revolution in a ring space closed by a pole.

    Parameters
    ----------
    profile : ``t -> (r, z, dr/dt)`` with the rim at t = 0 and the pole at t = 1, where ``r = 0``
        and ``dz/dt = 0``.

    Raises
    ------
    SceneError
        If the space has no pole.
    """
    if space.pole is None:
        raise SceneError("axisymmetric: a space closed by a pole is needed")
    points, matrix = meridian_interpolation(space)
    r, z, slope = (np.array(values, float) for values in profile(points))
    if space.pole == 1:
        r[-2], z[-2] = slope[-2], 0.0
    r, z = np.linalg.solve(matrix, np.stack([r, z], axis=1)).T
    ring = space.bases[0]
    angles = ring_angles(space)
    # Interpolation of cos on a uniform ring: its coefficients are cos at the abscissae over
    # the amplitude with which the basis reproduces them.
    amplitude = (ring.matrix(ring.abscissae[:1]) @ np.cos(angles - angles[0]))[0]
    r = r / amplitude
    net = np.stack([np.outer(np.cos(angles), r), np.outer(np.sin(angles), r),
                    np.broadcast_to(z, (len(angles), len(z)))], axis=-1)  # fmt: skip
    return Surface(space, points_of(space, net))
