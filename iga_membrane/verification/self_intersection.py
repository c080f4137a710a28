"""Does a membrane cross itself? Two places of its parameters at one point of space.

Samples that are near in space while their normals differ by more than those of neighbours do are
candidates; from each of them ``x(u) = x(v)`` is solved by Gauss-Newton. Layers that are apart, by
however little, have no such pair. Not seen is what crosses within a few samples, or at an angle by
which the normal turns between samples.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Index
from ..surface.surface import Surface

SAMPLES = 96, 64
"""Round a ring, or across, and along the other direction."""
COARSE = 33, 24
"""The same, to rule most membranes out."""
TURN = 3.0, 0.1
"""Angle between normals that makes a pair: so many times that between neighbours, plus radians."""
MOST = 200
"""Pairs that are solved for, evenly chosen."""
MEET, APART = 1e-10, 1e-2
"""Distance over the surface's size at which two places are one point, and the angle between their
normals by which they are two layers."""


def crossing(surface: Surface) -> Array | None:
    """(3,) a point at which a membrane crosses or touches itself, or None."""
    if _is_plain(surface):
        return None
    one, two = surface.space.bases
    ends = np.array([[b.breaks[0], b.breaks[-1]] for b in (one, two)])
    u = np.linspace(ends[0, 0], ends[0, 1], SAMPLES[0] + 1)[: SAMPLES[0] + (not one.periodic)]
    v = np.linspace(ends[1, 0], ends[1, 1], SAMPLES[1] + 2)[1:-1]
    places = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)
    k = surface.at(places, 1)
    pairs = _candidates(k.position, k.normal, bool(one.periodic))
    if not len(pairs):
        return None
    pairs = pairs[:: -(-len(pairs) // MOST)]
    return _meeting(surface, places.reshape(-1, 2)[pairs], ends, bool(one.periodic))


def _is_plain(surface: Surface) -> bool:
    """Whether a membrane shows one side only to a direction or to its middle: such a one crosses
    itself only where it winds round twice."""
    k = surface.grid(*COARSE, 1)
    vectors = k.area_vector.reshape(-1, 3)
    x = k.position.reshape(-1, 3)
    across = vectors @ vectors.sum(axis=0)
    out = np.einsum("ni,ni->n", vectors, x - 0.5 * (x.min(axis=0) + x.max(axis=0)))
    return any(bool(some.min() >= -1e-9 * some.max()) for some in (across, out, -out))


def _candidates(x: Array, normal: Array, ring: bool) -> Index:
    """(n, 2) numbers of samples that are near in space but not on the membrane."""
    from scipy.spatial import cKDTree

    step, turn = np.zeros(x.shape[:2]), np.zeros(x.shape[:2])
    for axis in (0, 1):
        away = np.linalg.norm(np.diff(x, axis=axis), axis=-1)
        bend = np.linalg.norm(np.diff(normal, axis=axis), axis=-1)
        first = [slice(None)] * 2
        last = [slice(None)] * 2
        first[axis], last[axis] = slice(None, -1), slice(1, None)
        for some in (tuple(first), tuple(last)):
            step[some] = np.maximum(step[some], away)
            turn[some] = np.maximum(turn[some], bend)
    if ring:
        away = np.linalg.norm(x[0] - x[-1], axis=-1)
        step[[0, -1]] = np.maximum(step[[0, -1]], away)
    points, normals = x.reshape(-1, 3), normal.reshape(-1, 3)
    reach, most = step.ravel(), TURN[0] * turn.ravel() + TURN[1]
    near = cKDTree(points).query_ball_point(points, reach)
    i = np.repeat(np.arange(len(points)), [len(some) for some in near])
    j = np.concatenate([np.asarray(some, int) for some in near])
    other = np.linalg.norm(normals[i] - normals[j], axis=-1) > np.maximum(most[i], most[j])
    return np.stack([i[other], j[other]], axis=1)


def _meeting(surface: Surface, pairs: Array, ends: Array, ring: bool) -> Array | None:
    """A point where two places of some pair meet."""
    for _ in range(12):
        k = surface.at(pairs, 1)
        gap = k.position[:, 0] - k.position[:, 1]
        slope = np.concatenate([k.tangents[:, 0], -k.tangents[:, 1]], axis=1)
        step = np.einsum("nij,nj->ni", np.linalg.pinv(slope.transpose(0, 2, 1)), gap)
        pairs = pairs - step.reshape(-1, 2, 2)
        if ring:
            pairs[..., 0] = ends[0, 0] + np.mod(pairs[..., 0] - ends[0, 0], np.ptp(ends[0]))
        pairs = np.clip(pairs, ends[:, 0], ends[:, 1])
    k = surface.at(pairs, 1)
    gap = np.linalg.norm(k.position[:, 0] - k.position[:, 1], axis=1)
    with np.errstate(invalid="ignore"):  # a pole has no normal
        layers = np.linalg.norm(k.normal[:, 0] - k.normal[:, 1], axis=1) > APART
    met = np.flatnonzero((gap < MEET * surface.size) & layers)
    return np.asarray(k.position[met[0], 0]) if len(met) else None
