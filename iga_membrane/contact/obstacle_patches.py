"""What solids carry that a membrane lies on: sums of tractions, and closed forms of round spots."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array, Index
from ..solids import Nearest, Solid
from ..terms import BodyDensity
from .patches import ContactPatches


def patches_of(
    solid: Solid,
    at: Nearest,
    x: Array,
    push: Array,
    leaving: Callable[[Index, float], Array],
    images: list[Array],
    tension: float,
    body: BodyDensity,
) -> ContactPatches:
    """Contact solid by solid, from the tractions.

    Parameters
    ----------
    at, x, push : nearest surfaces at the wet contact points (k, 3) and forces (k, 3) on the solid.
    leaving : numbers and tension to the angles in radians at which the membrane leaves spheres.

    Notes
    -----
    A round spot whose edge the membrane leaves at ``psi = pi - theta`` carries
    ``pi a^2 p + 2 pi a gamma sin(phi - psi)``, ``a = r sin(phi)``; at 180 degrees its projected
    area is the force over ``p + 2 gamma / r``. That is far more accurate than counting points. On
    asperities that are no spheres every point's force counts over ``p`` and ``gamma`` times the sum
    of the surface's curvatures there.
    """
    places = np.concatenate([x @ m for m in images])
    pushes = np.concatenate([push @ m for m in images])
    owner = solid.nearest(places).which
    which, inverse = np.unique(owner, return_inverse=True)
    forces = np.zeros((len(which), 3))
    np.add.at(forces, inverse, pushes)
    on_sphere = which >= 0
    centers, radii = np.zeros((len(which), 3)), np.full(len(which), np.inf)
    if on_sphere.any():
        centers[on_sphere] = solid.center_of(which[on_sphere])
        radii[on_sphere] = solid.radius_of(which[on_sphere])
    ball = on_sphere & np.isfinite(radii)
    size = np.linalg.norm(forces, axis=1)
    radius = np.where(ball, radii, 0.0)
    level = centers[:, 2] + radius
    pressure = -(body.constant + body.gradient[2] * level)
    psi = np.where(on_sphere, leaving(np.maximum(which, 0), tension), 0.0)
    carried = np.where(forces[:, 2] > 0, -size, size) / (np.pi * tension)
    share = np.where(ball, _share(pressure / tension, radii, carried, psi), 0.0)
    projected = share * np.pi * radius**2
    # an interrupted solve may not know the pressure yet
    np.divide(size, pressure, out=projected, where=~ball & (pressure != 0.0))
    areas = np.where(ball, 2.0 * np.pi * radius**2 * (1.0 - np.sqrt(1.0 - share)), projected)
    if (on_sphere & ~ball).any():
        bent = 2.0 * at.bend
        if at.ridge is not None:
            bent += (at.ridge**2).sum(axis=-1)
        load = tension * bent - (body.constant + x @ np.array(body.gradient))
        each = np.tile(np.linalg.norm(push, axis=-1) / load, len(images))
        areas = np.where(on_sphere & ~ball, np.bincount(inverse, each, len(which)), areas)
    polar = np.arcsin(np.sqrt(share))
    heights = centers[:, 2] + radius * np.cos(polar)
    angles = 180.0 - np.degrees(psi)
    return ContactPatches(which, centers, forces, radii, projected, areas, polar, heights, angles)


def _share(pressure: Array, radii: Array, carried: Array, psi: Array) -> Array:
    """(k,) projected area of spots over that of their spheres, ``sin(phi)^2``, by what they carry
    over ``pi gamma``."""
    with np.errstate(invalid="ignore", divide="ignore"):
        half = 0.5 * pressure * radii
        # half (1 - cos 2 phi) + cos psi - cos(2 phi - psi) = carried / r
        size = np.hypot(half + np.cos(psi), np.sin(psi))
        turn = np.arctan2(np.sin(psi), half + np.cos(psi))
        level = (half + np.cos(psi) - carried / radii) / size
        twice = turn + np.arccos(np.clip(level, -1.0, 1.0))
    return np.asarray(np.clip(np.sin(0.5 * twice) ** 2, 0.0, 1.0))
