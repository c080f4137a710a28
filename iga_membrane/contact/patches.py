"""What the solids under a membrane carry, solid by solid: a record."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..arrays import Array, Index, Mask
from ..solids import Nearest
from ..terms.variations import ElementPoints


@dataclass(frozen=True, eq=False)
class ContactPatches:
    """Contact of the whole body, in the scene's scale.

    Attributes
    ----------
    which : (k,) numbers of the wet spheres, -1 for a plane.
    centers : (k, 3) of the spheres.
    forces : (k, 3) of the membrane on them.
    radii : (k,)
    projected, areas : (k,) area of each wet spot, projected along its force and on the sphere.
    polar, heights : (k,) mean polar angle (radians) from the sphere's axis towards the liquid, its
        top on asperities, and height, of its edge.
    angles : (k,) mean contact angle in degrees.
    """

    which: Index
    centers: Array
    forces: Array
    radii: Array
    projected: Array
    areas: Array
    polar: Array
    heights: Array
    angles: Array

    @property
    def total(self) -> Array:
        """(3,) force on all of them."""
        return np.asarray(self.forces.sum(axis=0))

    def part(self, some: Mask) -> ContactPatches:
        """Some of the solids."""
        return ContactPatches(*(getattr(self, each.name)[some] for each in fields(self)))

    @classmethod
    def none(cls) -> ContactPatches:
        """Of a membrane that nothing carries but its edges."""
        flat, vectors = np.zeros(0), np.zeros((0, 3))
        return cls(np.zeros(0, int), vectors, vectors, flat, flat, flat, flat, flat, flat)


def behind(beside: Nearest, at: ElementPoints, near: float) -> Index:
    """Numbers of the spheres near a membrane that have their centre inside the liquid.

    Seen from its nearest point of the membrane, a centre outside the liquid lies on the side of the
    normal; for centres in the sector that point is there, too.

    Parameters
    ----------
    beside : nearest surfaces at points of the membrane, at : its geometry there.
    near : gap up to which a sphere is near.
    """
    wrong = (beside.normal * at.c).sum(axis=-1) > 0.0
    order = np.lexsort((beside.gap.ravel(), beside.which.ravel()))
    which, first = np.unique(beside.which.ravel()[order], return_index=True)
    nearest = order[first]
    close = (which >= 0) & (beside.gap.ravel()[nearest] < near)
    return np.asarray(which[close & wrong.ravel()[nearest]])
