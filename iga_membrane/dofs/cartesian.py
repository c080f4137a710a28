"""Three unknowns per control point: along the spine and along two tangents.

They span the same motions as three Cartesian components. The membrane has no stiffness along its
tangents, so this motion needs a stabilization; it is the paper's, kept to be measured against.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import SceneError
from ..splines import net_of
from ..surface.surface import Surface
from .boundary_conditions import Support, Supports
from .spines import Block, Motion, Spines, _points_of_field, along_net


class Cartesian(Spines):
    """Motion with three unknowns per control point, of a ring patch or of a whole open one.

    Control points at a pole keep their one unknown along its normal. Points on a mirror plane stay
    in it; images across an odd number of planes turn the other way round the ring.
    """

    by_pairs = True

    def __init__(self, surface: Surface, supports: Sequence[Support] = ()) -> None:
        super().__init__(surface, supports)
        space = surface.space
        ring = space.bases[0]
        kinds = Supports(supports)
        copies = kinds.sector.copies
        if kinds.sliding or (copies > 1 and not ring.periodic):
            raise SceneError(
                'solver.motion = "cartesian": needs a ring or a whole patch, any contact line '
                "inside it"
            )
        sector = (ring.breaks[-1] - ring.breaks[0]) / copies
        turn = np.broadcast_to((ring.abscissae / sector)[:, None], space.net_shape)
        free = np.ones(space.net_shape)
        free[:, space.net_shape[1] - space.joined_rings :] = 0.0
        on_mirror = (np.abs(turn - np.round(turn)) < 1e-9) & (copies > 1)
        sense = np.where(np.floor(turn) % 2 == 0, 1.0, -1.0) if copies > 1 else 1.0
        around = np.where(on_mirror, 0.0, sense * free)
        count = space.count
        self._sense = self._scalar(around)
        spine = self.unknowns[:count]
        rows = [spine]
        for moves in (self._scalar(free) != 0.0, self._sense != 0.0):
            own = np.where(moves, spine, -1)
            kept = np.unique(own[own >= 0])
            rows.append(np.where(own >= 0, self.size + np.searchsorted(kept, own), -1))
            self.size += len(kept)
        self.points = np.concatenate([np.tile(np.arange(count), 3), [0]])
        self.unknowns = np.concatenate([*rows, [-1]])
        self.held = np.full(3 * count + 1, -1)
        self.spare = 3 * count
        self.second = np.full(count, self.spare)
        self.extra = [count + np.arange(count), 2 * count + np.arange(count)]

    @property
    def whole(self) -> bool:
        return self.model == "full"

    @property
    def blocks(self) -> list[Block]:
        """Those of the model alone."""
        return super().blocks[:1]

    def _scalar(self, net: Array) -> Array:
        """Control points' values of a number given on the net; 0 at a pole."""
        return _points_of_field(self.space, np.repeat(net[..., None], 3, axis=2))[:, 0]

    def on(self, surface: Surface) -> Motion:
        """Frames re-based on a surface: spine, tangent along the meridian, tangent round."""
        normals = super().on(surface).directions[: self.space.count]
        v1, _, _, d2 = self._derivative_matrices
        net: Any = net_of(self.space, surface.points)
        along = _points_of_field(self.space, along_net(v1, d2, net))
        along = along - np.einsum("ki,ki->k", along, normals)[:, None] * normals
        length = np.linalg.norm(along, axis=1, keepdims=True)
        along = along / np.where(length > 0, length, 1.0)
        around = np.cross(normals, along) * self._sense[:, None]
        rows = np.concatenate([normals, along, around, np.zeros((1, 3))])
        return Motion(self.points, rows, self.unknowns, self.size, self.shifts, self.share)
