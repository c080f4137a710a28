"""Surfaces to start from: exact quadrics (NURBS) and flat sheets."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array
from ..checks import POSITIVE, contact_angle
from ..splines import (
    DEGREE,
    KIND,
    PATCH,
    Basis,
    BasisOf,
    bspline_basis,
    line_basis,
    open_knots,
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


@checked(radius=POSITIVE)
def sphere(radius: float = 1.0) -> Surface:
    """Exact sphere about the origin, outward normal, poles on the z axis.

    Parameters
    ----------
    radius : > 0.
    """
    basis, points, weights = arc(-0.5 * np.pi, 0.5 * np.pi)
    return revolution(basis, radius * points, weights)


@checked(radius=POSITIVE, contact_angle=contact_angle)
def cap(radius: float, contact_angle: float) -> Surface:
    """Exact spherical cap on z = 0 that meets the plane at ``contact_angle`` (degrees, inside).

    Parameters
    ----------
    radius : of the sphere.
    contact_angle : in degrees, inside.
    """
    theta = np.radians(contact_angle)
    basis, points, weights = arc(0.5 * np.pi - theta, 0.5 * np.pi)
    return revolution(basis, radius * (points - [0.0, np.cos(theta)]), weights)


@checked(radius=POSITIVE, height=POSITIVE)
def cylinder(radius: float, height: float) -> Surface:
    """Exact open cylinder about the z axis from z = 0 to ``height``, outward normal.

    Parameters
    ----------
    radius, height : lengths > 0.
    """
    basis = bspline_basis([0.0, 0.0, 1.0, 1.0], 1, continuity=0)
    return revolution(basis, [[radius, 0.0], [radius, height]], np.ones(2))


@checked(radius=POSITIVE)
def disc(radius: float) -> Surface:
    """Exact flat disc in z = 0, normal up.

    Parameters
    ----------
    radius : > 0.
    """
    basis = bspline_basis([0.0, 0.0, 1.0, 1.0], 1, continuity=0)
    return revolution(basis, [[radius, 0.0], [0.0, 0.0]], np.ones(2))


@checked(size=POSITIVE, elements=PATCH, degree=DEGREE, space=KIND)
def sheet(
    size: float, *, elements: int = 8, degree: int = 3, space: str | BasisOf = "bspline"
) -> Surface:
    """Flat square sheet centred in z = 0, normal up, edges parallel to x and y.

    Parameters
    ----------
    size : edge length.
    elements, degree : along both directions.
    space : "bspline" or "lagrange", or a basis of your own (:func:`line_basis`).
    """
    basis = line_basis(space, elements, degree)
    product = tensor_space(basis, basis)
    flat = size * (product.abscissae.reshape(-1, 2) - 0.5)
    return Surface(product, np.column_stack([flat, np.zeros(len(flat))]))
