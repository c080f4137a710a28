"""The insides of wetted spots, where the spline may rise out of its solid again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index, Mask
from ..terms import TrimmedContactLine
from ..terms.trimmed import Line

CORE = 0.65, 0.85
"""Least and largest part of a spot's radius inside which the membrane counts as deeper than it
lies."""
LOOSE = 0.3
"""The least part of a spot on a particle."""


@dataclass(frozen=True, eq=False)
class Cores:
    """Insides of the wetted spots of the whole body.

    Attributes
    ----------
    numbers : (k,) of the wet spheres; middles : (k, 3) of their spots.
    radii : (k,) well inside the spots.
    """

    numbers: Index
    middles: Array
    radii: Array

    @classmethod
    def none(cls) -> Cores:
        """Of a membrane that wets nothing yet."""
        return cls(np.zeros(0, int), np.zeros((0, 3)), np.zeros(0))

    @classmethod
    def inside(cls, line: Line, term: TrimmedContactLine, images: list[Array]) -> Cores:
        """Inside the contact lines of a state.

        A membrane that leaves the sphere at ``psi = pi - theta`` would, with the curvature it has
        there, meet it again about ``psi r`` farther in.
        """
        solid = term.solid
        speed = np.linalg.norm(line.tangent, axis=-1)
        along = line.tangent / speed[..., None]
        rise = np.sign(line.gh)[..., None] * line.ah
        rise = rise - np.einsum("kqi,kqi->kq", rise, along)[..., None] * along
        x, dry = (np.concatenate([v @ m for m in images]).reshape(-1, 3)
                  for v in (line.x, rise))  # fmt: skip
        arc = np.tile(speed * line.table.weights, (len(images), 1)).ravel()
        numbers: Index
        numbers, place = np.unique(solid.nearest(x).which, return_inverse=True)
        outer: Mask = np.ones(len(x), bool)
        for _ in range(2):
            weight = np.bincount(place, arc * outer)
            middles = np.stack([np.bincount(place, arc * outer * v) / weight for v in x.T], axis=1)
            away = _across(x - middles[place], term.axis(numbers[place]))
            # inside a spot the spline may rise out of its solid again: no contact line
            outer = np.einsum("ki,ki->k", away, dry) > 0.0
            outer |= np.bincount(place, outer)[place] == 0
        radii: Array = np.full(len(numbers), np.inf)
        np.minimum.at(radii, place[outer], np.linalg.norm(away[outer], axis=1))
        psi = np.pi - np.arccos(term.cosine(middles, numbers)[0])
        again = 0.5 * psi * solid.radius_of(numbers)
        # on a particle, which may stand anywhere, a line has farther to go than on an asperity
        least = np.where(term.particle(numbers) >= 0, LOOSE, CORE[0])
        return cls(numbers, middles, np.clip(radii - again, least * radii, CORE[1] * radii))

    def depth(self, x: Array, which: Index, term: TrimmedContactLine) -> tuple[Array, Array]:
        """How much deeper points count than they lie, well inside contact lines, and minus its
        gradient (..., 3): nothing holds the spline there."""
        numbers, middles, radii = self.numbers, self.middles, self.radii
        if not len(numbers):
            return np.zeros(which.shape), np.zeros(x.shape)
        place = np.minimum(np.searchsorted(numbers, which), len(numbers) - 1)
        radius = np.where(numbers[place] == which, radii[place], 0.0) + 1e-300
        away = _across(x - middles[place], term.axis(which))
        level = np.linalg.norm(away, axis=-1)
        inside = np.maximum(1.0 - level / radius, 0.0)
        strength = term.solid.radius_of(which)
        slope = 2.0 * strength * inside / (radius * np.maximum(level, 1e-300))
        return strength * inside**2, slope[..., None] * away


def _across(vectors: Array, axes: Array) -> Array:
    """The part of vectors (..., 3) at right angles to unit axes."""
    along = np.einsum("...i,...i->...", vectors, axes)
    return np.asarray(vectors - along[..., None] * axes)
