"""Arc-length parametrization: the same shape with control points spread as asked.

Lines of constant ``xi1`` are walked by their mean arc length. One reparametrization of ``xi2``
serves all of them, so the polar form of a pole is kept and the map is linear in the control net.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..splines import Grading, net_of, points_of
from ..splines.quadrature import gauss
from .ring import meridian_interpolation, rational_matrix
from .surface import Surface


class MeridianLength:
    """Mean arc length ``s(t)`` of the lines of constant ``xi1``, with its exact derivative."""

    def __init__(self, surface: Surface, lines: slice = slice(None)) -> None:
        space = surface.space
        ring = space.bases[0]
        on_ring = ring.matrix(ring.abscissae[lines])
        self._space = space
        self._coefficients = np.tensordot(on_ring, surface.net, axes=1)
        self._breaks = space.bases[1].breaks
        self._u, self._w = gauss(space.degree + 3)
        pieces = self._piece(self._breaks[:-1], self._breaks[1:])
        self._cumulated = np.concatenate([[0.0], np.cumsum(pieces)])

    @property
    def total(self) -> float:
        """Length from the rim to the end."""
        return float(self._cumulated[-1])

    def speed(self, t: Array) -> Array:
        """Mean of ``|dx/dt|`` over the lines."""
        rows = rational_matrix(self._space, t, 1)
        velocity = np.tensordot(rows, self._coefficients, axes=(1, 1))
        return np.asarray(np.linalg.norm(velocity, axis=-1).mean(axis=1))

    def __call__(self, t: Array) -> Array:
        element = np.clip(np.searchsorted(self._breaks, t, "right") - 1, 0, len(self._breaks) - 2)
        return np.asarray(self._cumulated[element] + self._piece(self._breaks[element], t))

    def inverse(self, s: Array) -> Array:
        """Parameters at arc lengths ``s``, by Newton's method."""
        t = np.interp(s, self._cumulated, self._breaks)
        for _ in range(30):
            step = (self(t) - s) / self.speed(t)
            t = np.clip(t - step, self._breaks[0], self._breaks[-1])
            if np.abs(step).max() <= 1e-13:
                break
        return t

    def _piece(self, start: Array, end: Array) -> Array:
        t = start[:, None] + (end - start)[:, None] * self._u
        speed = self.speed(t.ravel()).reshape(t.shape)
        return np.asarray((end - start) * (speed @ self._w))


def distortion(
    surface: Surface, grading: Grading | None = None, lines: slice = slice(None)
) -> float:
    """How far the meridians are from (graded) arc length: largest relative error of the speed."""
    grading = grading or Grading()
    length = MeridianLength(surface, lines)
    t = surface.space.bases[1].abscissae
    return float(np.abs(length.speed(t) / (length.total * grading.slope(t)) - 1.0).max())


def arc_length(
    surface: Surface, grading: Grading | None = None, lines: slice = slice(None)
) -> Surface:
    """The same shape, its meridians walked by (graded) arc length.

    Parameters
    ----------
    surface : of a ring space closed by a pole.
    grading : fraction of the arc length against ``xi2``; uniform if omitted.
    lines : which lines ``xi1 = abscissa`` count for the mean; enough for one sector.

    Notes
    -----
    Interpolation, so the shape is kept to the order of the space.
    """
    grading = grading or Grading()
    space = surface.space
    length = MeridianLength(surface, lines)
    points, matrix = meridian_interpolation(space)
    old = length.inverse(grading.fraction(points) * length.total)
    rows = rational_matrix(space, old)
    if space.pole == 1:
        # chain rule at the pole: d/dt_new = (ds/dt_new) / (ds/dt_old) d/dt_old
        end = points[-1:]
        factor = grading.slope(end) * length.total / length.speed(end)
        rows[-2] = factor * rational_matrix(space, end, 1)[0]
    net = np.einsum("jk,ikc->ijc", np.linalg.solve(matrix, rows), net_of(space, surface.points))
    return surface.moved(points_of(space, net))
