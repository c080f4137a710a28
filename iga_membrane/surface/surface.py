"""A surface is a space and its control points."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array
from ..checks import anything, shown
from ..errors import GeometryError
from ..splines import Space, Table, net_of
from .kinematics import Kinematics


@dataclass(frozen=True, eq=False)
@checked(points=anything)
class Surface:
    """Parametric surface ``x(xi) = sum_i N_i(xi) X_i``.

    Attributes
    ----------
    space : the functions ``N_i``.
    points : (count, 3) control points ``X_i``.
    """

    space: Space
    points: Array = field(repr=False)

    def __post_init__(self) -> None:
        try:
            points = np.asarray(self.points)
        except ValueError:
            points = np.asarray(None)
        if points.dtype == object or not np.issubdtype(points.dtype, np.floating):
            raise GeometryError(
                f"control points = {shown(self.points)}: dtype {points.dtype} given, float64 "
                f"expected, an array of shape {(self.space.count, 3)}"
            )
        if points.dtype.itemsize < 8:
            warnings.warn(
                f"control points: {points.dtype} given, computed in float64 with its digits",
                stacklevel=3,
            )
        if points.shape != (self.space.count, 3):
            raise GeometryError(
                f"control points: shape {points.shape} given, {(self.space.count, 3)} expected"
            )
        bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
        if bad.size:
            raise GeometryError(f"control point {bad[0]} = {points[bad[0]]} is not finite")
        object.__setattr__(self, "points", points.astype(float))

    def on(self, table: Table) -> Kinematics:
        """Geometry at tabulated quadrature points, arrays (elements, points, ...)."""
        position, a1, a2 = table.derivatives(self.points)
        second = None
        if table.second is not None:
            x11, x12, x22 = table.second @ self.points[table.functions]
            second = np.stack([np.stack([x11, x12], -2), np.stack([x12, x22], -2)], -3)
        return Kinematics(position, np.stack([a1, a2], axis=-2), second)

    def at(self, xi: ArrayLike, orders: int = 2) -> Kinematics:
        """Geometry at any parameters (..., 2), exactly from the spline derivatives."""
        xi = np.asarray(xi, float)
        functions, rows = self.space.at(xi.reshape(-1, 2), orders)
        local, shape = self.points[functions], (*xi.shape[:-1], 3)
        position = np.einsum("ta,tai->ti", rows.pop((0, 0)), local)
        # derivatives do not see where a surface is: taken from the point itself they keep their
        # digits where tangents vanish, at poles and folds
        local = local - position[:, None]
        x = {key: np.einsum("ta,tai->ti", row, local).reshape(shape) for key, row in rows.items()}
        second = None
        if orders == 2:
            second = np.stack(
                [np.stack([x[2, 0], x[1, 1]], -2), np.stack([x[1, 1], x[0, 2]], -2)], -3
            )
        tangents = np.stack([x[1, 0], x[0, 1]], axis=-2)
        return Kinematics(position.reshape(shape), tangents, second)

    def grid(self, n1: int, n2: int, orders: int = 2) -> Kinematics:
        """Geometry on a regular grid of parameters, arrays (n1, n2, ...)."""
        one, two = self.space.bases
        s = np.linspace(one.breaks[0], one.breaks[-1], n1)
        t = np.linspace(two.breaks[0], two.breaks[-1], n2)
        return self.at(np.stack(np.meshgrid(s, t, indexing="ij"), axis=-1), orders)

    def area(self, points: int | None = None) -> float:
        """Area, by Gauss quadrature with ``points`` per direction and element."""
        table = self.space.table(points)
        return float((self.on(table).area_element * table.weights).sum())

    def moved(self, points: Array) -> Surface:
        """The same space with other control points."""
        return replace(self, points=points)

    def transformed(
        self, *, scale: float = 1.0, rotation: Array | None = None, shift: ArrayLike = 0.0
    ) -> Surface:
        """Image under ``x -> scale * rotation x + shift`` (splines are affine invariant)."""
        turned = self.points if rotation is None else self.points @ np.asarray(rotation).T
        return self.moved(scale * turned + np.asarray(shift, float))

    @property
    def net(self) -> Array:
        """(n1, n2, 3) control net, with the rings that a pole joins."""
        return net_of(self.space, self.points)

    @property
    def size(self) -> float:
        """Length of the diagonal of the control points' bounding box."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))
