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
    """Motion with three unknowns per control point, of a ring patch, of a whole open one or of a
    closed one about the z axis, whose directions are given.

    Control points at a pole keep their one unknown along its normal. Points on a mirror plane stay
    in it; images across an odd number of planes turn the other way round the ring. All of them can
    move sideways, so nothing is shifted as a whole.
    """

    by_pairs = True

    def __init__(
        self,
        surface: Surface,
        supports: Sequence[Support] = (),
        directions: Array | None = None,
    ) -> None:
        kinds = Supports(supports)
        still = [support for support in kinds if support not in kinds.shifts]
        super().__init__(surface, still, directions)
        space = surface.space
        copies = kinds.sector.copies
        closed = directions is not None
        if kinds.sliding or (copies > 1 and not space.bases[0].periodic and not closed):
            raise SceneError(
                'solver.motion = "cartesian": needs a ring or a whole patch, any contact line '
                "inside it"
            )
        turn, free = self._about_the_axis() if closed else self._round_the_ring()
        turn = turn * copies
        on_mirror = (np.abs(turn - np.round(turn)) < 1e-9) & (copies > 1)
        sense = np.where(np.floor(turn) % 2 == 0, 1.0, -1.0) if copies > 1 else 1.0
        self._sense = np.where(on_mirror, 0.0, sense * free)
        count = space.count
        spine = self.unknowns[:count]
        rows = [spine]
        for moves in (free != 0.0, self._sense != 0.0):
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

    def _round_the_ring(self) -> tuple[Array, Array]:
        """(count,) place of each control point round the ring, of 1, and whether it has tangents:
        at a pole it has none."""
        space, ring = self.space, self.space.bases[0]
        turn = (ring.abscissae - ring.breaks[0]) / (ring.breaks[-1] - ring.breaks[0])
        free = np.ones(space.net_shape)
        free[:, space.net_shape[1] - space.joined_rings :] = 0.0
        return self._scalar(np.broadcast_to(turn[:, None], space.net_shape)), self._scalar(free)

    def _about_the_axis(self) -> tuple[Array, Array]:
        """The same of a closed patch, by its start; on the axis it has none."""
        x, y, _ = self._start.T
        turn = np.arctan2(y, x) / (2.0 * np.pi) % 1.0
        return turn, (np.hypot(x, y) > 1e-9 * np.ptp(self._start)).astype(float)

    def _scalar(self, net: Array) -> Array:
        """Control points' values of a number given on the net; 0 at a pole."""
        return _points_of_field(self.space, np.repeat(net[..., None], 3, axis=2))[:, 0]

    def on(self, surface: Surface) -> Motion:
        """Frames re-based on a surface: spine, tangent along the meridian, tangent round."""
        normals = super().on(surface).directions[: self.space.count]
        if self._given is not None:
            x, y, _ = self._start.T
            round_axis = np.stack([-y, x, 0.0 * x], axis=1)
            length = np.linalg.norm(round_axis, axis=1, keepdims=True)
            round_axis /= np.where(length > 0.0, length, 1.0)
            return self._framed(normals, np.cross(round_axis, normals))
        v1, _, _, d2 = self._derivative_matrices
        net: Any = net_of(self.space, surface.points)
        along = _points_of_field(self.space, along_net(v1, d2, net))
        along = along - np.einsum("ki,ki->k", along, normals)[:, None] * normals
        length = np.linalg.norm(along, axis=1, keepdims=True)
        return self._framed(normals, along / np.where(length > 0, length, 1.0))

    def _framed(self, normals: Array, along: Array) -> Motion:
        """The motion along normals and two tangents each."""
        around = np.cross(normals, along) * self._sense[:, None]
        rows = np.concatenate([normals, along, around, np.zeros((1, 3))])
        return Motion(self.points, rows, self.unknowns, self.size, self.shifts, self.share)
