"""What the solids under a membrane carry: forces, wet areas and angles, asperity by asperity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index
from ..scenes.scene import Scene
from ..surface.sector import mirrors
from ..surface.surface import Surface
from ..terms import BodyDensity
from ..terms.variations import element_points
from .assembly import Assembly


@dataclass(frozen=True, eq=False)
class Footing:
    """Contact of the whole body, in the scene's scale.

    Attributes
    ----------
    which : (k,) numbers of the wet spheres, -1 for a plane.
    centers : (k, 3) of the spheres.
    forces : (k, 3) of the membrane on them.
    radii : (k,)
    projected, areas : (k,) area of each wet spot, projected along its force and on the sphere.
    """

    which: Index
    centers: Array
    forces: Array
    radii: Array
    projected: Array
    areas: Array

    @property
    def total(self) -> Array:
        """(3,) force on all of them."""
        return np.asarray(self.forces.sum(axis=0))


def footing(scene: Scene, assembly: Assembly, surface: Surface, body: BodyDensity) -> Footing:
    """Sum the tractions by solid; unfolds the mirror images of a sector.

    Notes
    -----
    At 180 degrees the membrane follows the sphere in its wet spot with curvature ``2 / r``, so the
    traction there is ``p + 2 gamma / r`` and the spot's projected area the force over it: far more
    accurate than counting points.
    """
    contact = assembly.contact
    assert contact is not None
    touch = contact.touch(surface.points)
    wet = touch.traction > 0
    x = (contact.table.values @ surface.points[contact.table.functions])[wet]
    push = -(touch.traction * contact.area)[wet][:, None] * touch.at.normal[wet]
    images = mirrors(scene.sector)
    places = np.concatenate([x @ m for m in images])
    pushes = np.concatenate([push @ m for m in images])
    owner = contact.solid.nearest(places).which
    which, inverse = np.unique(owner, return_inverse=True)
    forces = np.zeros((len(which), 3))
    np.add.at(forces, inverse, pushes)
    on_sphere = which >= 0
    centers, radii = np.zeros((len(which), 3)), np.full(len(which), np.inf)
    if on_sphere.any():
        centers[on_sphere] = contact.solid.center_of(which[on_sphere])
        radii[on_sphere] = contact.solid.radius_of(which[on_sphere])
    size = np.linalg.norm(forces, axis=1)
    level = centers[:, 2] + np.where(on_sphere, radii, 0.0)
    pressure = -(body.constant + body.gradient[2] * level)
    projected = size / (pressure + np.where(on_sphere, 2.0 * assembly.tension / radii, 0.0))
    share = np.clip(projected / (np.pi * radii**2), 0.0, 1.0)
    areas = np.where(on_sphere, 2.0 * np.pi * np.where(on_sphere, radii, 0.0) ** 2, 0.0) * (
        1.0 - np.sqrt(1.0 - share)
    )
    areas = np.where(on_sphere, areas, projected)
    return Footing(which, centers, forces, radii, projected, areas)


def engulfed(scene: Scene, assembly: Assembly, surface: Surface) -> int:
    """How many spheres near the wet ones have their centre inside the liquid.

    The solid angle of a closed membrane from a point is 4 pi inside and 0 outside; an open
    membrane over a cell must lie above the centre.
    """
    contact = assembly.contact
    assert contact is not None
    touch = contact.touch(surface.points)
    close = touch.at.which[touch.at.gap < 2.0 * contact.length]
    near = np.unique(close[close >= 0])
    if not len(near):
        return 0
    centers = np.asarray(contact.solid.center_of(near)).reshape(-1, 3)
    at = element_points(assembly.table, surface.points)
    x, c = at.x.reshape(-1, 3), (at.c * assembly.table.weights[..., None]).reshape(-1, 3)
    count = 0
    for center in centers:
        angle = 0.0
        for m in mirrors(scene.sector):
            away = x - center @ m
            distance = np.sqrt(np.einsum("ki,ki->k", away, away))
            angle += float((np.einsum("ki,ki->k", away, c) / distance**3).sum())
        count += angle > 2.0 * np.pi
    return count
