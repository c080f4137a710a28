"""What solids carry that a membrane passes through: integrals along contact lines and over caps."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..terms import BodyDensity, TrimmedContactLine
from ..terms.trimmed import CapDensity, Line, line_density, wet_integral
from .patches import ContactPatches


class Spots:
    """Wetted spots of a membrane that passes through its solids, each inside its contact line; the
    mirror images of a sector are unfolded.

    Attributes
    ----------
    line : the contact lines of one sector, in pieces; term : what they cost.
    which : (k,) numbers of the wet spheres.
    """

    def __init__(self, line: Line, term: TrimmedContactLine, images: list[Array]) -> None:
        self.line, self.term = line, term
        self._images = images
        first = self.line.x[:, 0]
        owner = np.concatenate([term.solid.nearest(first @ m).which for m in images])
        self.which, self._place = np.unique(owner, return_inverse=True)

    def cap(self, density: CapDensity) -> Array:
        """(pieces,) integrals over the wetted surface of one sector."""
        return wet_integral(self.line, density)

    def total(self, values: Array) -> Array:
        """(k,) sums of pieces (pieces,) on each sphere."""
        tiled = np.tile(values, len(self._images))
        return np.bincount(self._place, tiled, len(self.which)).astype(float)

    def vectors(self, values: Array) -> Array:
        """(k, 3) sums of vectors (pieces, 3) on each sphere."""
        sums = np.zeros((len(self.which), 3))
        np.add.at(sums, self._place, np.concatenate([values @ m for m in self._images]))
        return sums


def patches_of(spots: Spots, tension: float, body: BodyDensity) -> ContactPatches:
    """Contact solid by solid, from the contact lines.

    Notes
    -----
    The force on a sphere is minus the energy's derivative by its place, ``oint q do / |g_h|`` along
    its line (:mod:`iga_membrane.terms.trimmed`) and ``int grad(Q) N_z dA`` over its wetted cap.
    """
    line, cap = spots.line, spots.cap
    pull = line_density(line, tension, body)
    pieces = (pull * (line.table.weights / np.abs(line.gh))[..., None]).sum(axis=1)
    ex, ey, ez = body.gradient

    pieces[:, 2] += cap(lambda x, n, which: n[..., 2] * (
        body.constant + ex * x[..., 0] + ey * x[..., 1] + ez * x[..., 2]
    ))  # fmt: skip
    if ex or ey:
        level = cap(lambda x, n, which: x[..., 2] * n[..., 2])
        pieces[:, :2] += level[:, None] * [ex, ey]
    projected = cap(lambda x, n, which: (n * spots.term.axis(which)).sum(axis=-1))
    areas = cap(lambda x, n, which: np.ones(which.shape))
    arc = np.linalg.norm(line.tangent, axis=-1) * line.table.weights
    axis = spots.term.axis(line.at.which)
    along = np.einsum("kqi,kqi->kq", line.at.normal, axis)
    polar = np.arctan2(np.linalg.norm(np.cross(line.at.normal, axis), axis=-1), along)
    cosine = np.einsum("kqi,kqi->kq", line.at.normal, line.m) / line.area
    angle = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    means = [arc.sum(axis=1), *((v * arc).sum(axis=1) for v in (polar, line.x[..., 2], angle))]
    length, *sums = (spots.total(mean) for mean in means)
    polar, heights, angles = (value / length for value in sums)
    which, solid = spots.which, spots.term.solid
    return ContactPatches(
        which,
        solid.center_of(which),
        spots.vectors(pieces),
        solid.radius_of(which),
        spots.total(projected),
        spots.total(areas),
        polar,
        heights,
        angles,
    )
