"""The Bezier patches of a surface: one net for each element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Index
from ..splines.bernstein import bernstein
from .surface import Surface


def bezier_net(surface: Surface, elements: Index | None = None) -> Array:
    """(elements, p1 + 1, p2 + 1, 4) homogeneous Bezier points ``(w x, w)`` of some elements, or of
    all."""
    space, net = surface.space, surface.net
    weights = np.ones(space.net_shape) if space.weights is None else space.weights
    homogeneous = np.concatenate([net * weights[..., None], weights[..., None]], axis=-1)
    one, two = space.bases
    chosen = np.arange(space.elements) if elements is None else elements
    e1, e2 = np.divmod(chosen, two.elements)
    local = homogeneous[one.functions[e1][:, :, None], two.functions[e2][:, None, :]]
    flat = local.reshape(*local.shape[:2], 4 * local.shape[2])
    rows = one.operators[e1].transpose(0, 2, 1) @ flat
    cells = two.operators[e2].transpose(0, 2, 1)[:, None] @ rows.reshape(local.shape)
    return np.asarray(cells)


@dataclass(frozen=True, eq=False)
class BezierPatches:
    """Polynomial patches.

    Attributes
    ----------
    nets : (patches, p1 + 1, p2 + 1, 3)
    """

    nets: Array

    def at(self, patches: Index, u: Array) -> tuple[Array, Array]:
        """Positions (k, q, 3) and derivatives by local coordinates (k, q, 2, 3) of patches (k,) at
        points (k, q, 2) of [0, 1]^2."""
        p1, p2 = self.nets.shape[1] - 1, self.nets.shape[2] - 1
        net = self.nets[patches]
        flat = net.reshape(*net.shape[:2], 3 * (p2 + 1))
        one, d_one = (bernstein(u[..., 0], p1, k) for k in (0, 1))
        two, d_two = (bernstein(u[..., 1], p2, k)[..., None] for k in (0, 1))
        shape = (*u.shape[:2], p2 + 1, 3)
        rows, d_rows = ((b @ flat).reshape(shape) for b in (one, d_one))
        x = (rows * two).sum(axis=2)
        slopes = np.stack([(d_rows * two).sum(axis=2), (rows * d_two).sum(axis=2)], axis=2)
        return x, slopes
