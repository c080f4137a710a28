"""How wide a point load is to splines on equal square elements.

The potential of a point force in the plane, ``-log(r) / 2 pi``, is infinite at the force; that of a
spline space is finite there, as if it were cut off at an effective radius.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..quadrature import gauss
from .basis import uniform_basis

ROBIN = 1.3105329259115094
"""``log(2 pi eta(i)^2)`` with Dedekind's eta: a unit force on a unit square that repeats, balanced
by an even load, has the potential ``(-log(r) - ROBIN) / 2 pi`` of mean zero near it."""
TORUS = 32
"""Elements along the side of the square that repeats; 64 change the radius by 4e-8."""


def effective_radius(degree: int, places: Array) -> Array:
    """Radius over the element's size at which the potential of a load is cut off, seen by the load.

    Parameters
    ----------
    degree : of both directions.
    places : (k, n, 2) points that share each load evenly, in elements from a corner of one.

    Returns
    -------
    (k,)

    Notes
    -----
    Mean potential at the load's own points on a torus of n x n elements, by Fourier's series over
    the symbols of mass and stiffness, against the exact one of :data:`ROBIN`, which rises with the
    square of the distance from the load as the balancing load is even.
    """
    line = uniform_basis(0.0, 1.0, 1, degree)
    turn = 2.0 * np.pi / TORUS * np.arange(TORUS)
    wave = np.exp(1j * np.multiply.outer(np.arange(degree + 1), turn))
    u, w = gauss(degree + 1)
    mass, stiffness = (w @ np.abs(line.on_elements(u, k)[0] @ wave) ** 2 for k in (0, 1))
    symbol = np.multiply.outer(stiffness, mass) + np.multiply.outer(mass, stiffness)
    symbol[0, 0] = np.inf
    elements = np.floor(places)
    within = (places - elements).reshape(-1, 2).T
    one, two = (
        (line.on_elements(p)[0] @ wave).reshape(*elements.shape[:2], TORUS)
        * np.exp(1j * np.multiply.outer(elements[..., axis], turn))
        for axis, p in enumerate(within)
    )
    # load by load: all modes of thousands at once are too many
    modes = (np.abs(a.T @ b / len(a)) ** 2 / symbol for a, b in zip(one, two, strict=True))
    potential = np.array([mode.sum() for mode in modes]) / TORUS**2
    # mean of the squared distances of all pairs of points
    apart = 2.0 * places.var(axis=1).sum(axis=-1)
    rise = 0.5 * np.pi * apart / TORUS**2
    return np.asarray(TORUS * np.exp(rise - 2.0 * np.pi * potential - ROBIN))
