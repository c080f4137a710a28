"""A solid of the user's own: its answers checked, its errors blamed on it."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..checks import POSITIVE, contact_angle, name_of, one_or_more, shown
from ..errors import SceneError
from ..own import answer_of, called, check_slopes, note_bad
from .nearest import Nearest, Solid

POINTS = 60
"""Places round the scene at which a solid is asked before any work."""


def nearest_of(solid: Solid, points: Array) -> Nearest:
    """What a user's solid says of points (..., 3).

    Raises
    ------
    SceneError
        No :class:`Nearest`, or arrays of other shapes.
    """
    call = solid.nearest
    found = called(call, points)
    if not isinstance(found, Nearest):
        raise SceneError(f"{name_of(call)}: returned {shown(found)}, expected a Nearest")
    flat = points.shape[:-1]
    for name, shape in (("gap", flat), ("normal", points.shape), ("bend", flat), ("which", flat)):
        answer_of(call, [getattr(found, name)], [name], shape, finite=False)
    if found.ridge is not None:
        answer_of(call, [found.ridge], ["ridge"], points.shape, finite=False)
    for name in ("gap", "normal", "bend"):
        note_bad(call, name, getattr(found, name), points, "point")
    return found


def places_of(solid: Solid, which: Index) -> tuple[Array, Array]:
    """(..., 3) points inside the bodies of a user's solid, and their (...) radii.

    Raises
    ------
    SceneError
        Arrays of other shapes.
    """
    shape = np.shape(which)
    place, radius = solid.center_of, solid.radius_of
    (centers,) = answer_of(place, [called(place, which)], ["center"], (*shape, 3), finite=False)
    (radii,) = answer_of(radius, [called(radius, which)], ["radius"], shape, finite=False)
    return centers, radii


def check_solid(solid: Solid, origin: tuple[float, float, float], length: float) -> None:
    """Ask a user's solid at places round a scene: shapes, and the derivatives of its gap.

    Parameters
    ----------
    origin, length : of the scene.

    Raises
    ------
    SceneError
        The message names the method that is wrong, what it returned and what is expected.
    """
    told = name_of(solid)
    one_or_more(f"{told}.contact_angle", solid.contact_angle, each=contact_angle)
    short = min(POSITIVE(f"{told}.scale", solid.scale), length)
    rng = np.random.default_rng(0)
    points = np.array(origin) + length * rng.uniform(-1.5, 1.5, (POINTS, 3))
    at = nearest_of(solid, points)
    places_of(solid, at.which)
    outside = np.isfinite(at.gap) & (at.gap > 0.0)
    if not outside.any():
        return
    points = points[outside]
    at = nearest_of(solid, points)
    size = np.linalg.norm(at.normal, axis=1)
    if np.abs(size - 1.0).max() > 1e-6:
        raise SceneError(
            f"{told}.nearest: normal has the length {size[np.argmax(np.abs(size - 1.0))]:.6g}, "
            "expected 1: the gradient of a distance"
        )
    way = rng.normal(size=points.shape)
    way /= np.linalg.norm(way, axis=1)[:, None]

    def there(step: Array) -> Nearest:
        return nearest_of(solid, points + step[:, None] * way)

    slope = np.einsum("ki,ki->k", at.normal, way)
    check_slopes(
        solid.nearest, ("normal . direction", "gap"), lambda h: there(h).gap, slope, short, 1.0
    )
    bend = np.einsum("kij,kj->ki", at.hessian(), way)
    names = "(bend, ridge) . direction", "normal"
    check_slopes(solid.nearest, names, lambda h: there(h).normal, bend, short, 0.1 / short)
