"""Differential geometry of a surface at points: paper equations (1)-(14).

Axis order everywhere (..., direction, component); Greek indices of the paper are the axes named
``direction``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import ndarray
from ..overview import brief_repr


@dataclass(frozen=True, eq=False)
@checked(
    position=partial(ndarray, shape=(3,)),
    tangents=partial(ndarray, shape=(2, 3)),
    second=partial(ndarray, shape=(2, 2, 3)),
)
class Kinematics:
    """Position and derivatives of a surface at any set of points; the rest follows on demand.

    Attributes
    ----------
    position : (..., 3)
    tangents : (..., 2, 3) ``a_alpha``, eq. (1).
    second : (..., 2, 2, 3) ``x_,alpha beta``, eq. (13), or None where not asked for.
    """

    position: Array
    tangents: Array
    second: Array | None = field(default=None, repr=False)

    __repr__ = brief_repr

    @cached_property
    def area_vector(self) -> Array:
        """(..., 3) ``a_1 x a_2``: the normal times the area element."""
        return np.cross(self.tangents[..., 0, :], self.tangents[..., 1, :])

    @cached_property
    def area_element(self) -> Array:
        """(...) square root of the metric's determinant."""
        return np.linalg.norm(self.area_vector, axis=-1)

    @cached_property
    def normal(self) -> Array:
        """(..., 3) unit normal, eq. (4); out of the liquid for the surfaces of this package."""
        return np.asarray(self.area_vector / self.area_element[..., None])

    @cached_property
    def metric(self) -> Array:
        """(..., 2, 2) ``a_alpha beta``, eq. (2)."""
        return np.asarray(self.tangents @ np.swapaxes(self.tangents, -1, -2))

    @cached_property
    def inverse_metric(self) -> Array:
        """(..., 2, 2) contravariant metric, eq. (3)."""
        a = self.metric
        adjoint = np.stack([a[..., 1, 1], -a[..., 0, 1], -a[..., 1, 0], a[..., 0, 0]], axis=-1)
        return np.asarray((adjoint / self.area_element[..., None] ** 2).reshape(a.shape))

    @cached_property
    def dual_tangents(self) -> Array:
        """(..., 2, 3) ``a^alpha``, eq. (5)."""
        return np.asarray(self.inverse_metric @ self.tangents)

    def _second(self) -> Array:
        if self.second is None:
            raise ValueError("second derivatives were not evaluated: ask for two orders")
        return self.second

    @cached_property
    def christoffel(self) -> Array:
        """(..., 2, 2, 2) ``Gamma^gamma_alpha beta``, last axis gamma, of eq. (14)."""
        return np.einsum("...abi,...ci->...abc", self._second(), self.dual_tangents)

    @cached_property
    def curvature_tensor(self) -> Array:
        """(..., 2, 2) ``b_alpha beta = n . a_alpha,beta``, eq. (12)."""
        return np.einsum("...abi,...i->...ab", self._second(), self.normal)

    @cached_property
    def mean_curvature(self) -> Array:
        """(...) ``H = a^alpha beta b_alpha beta / 2``: -1/R on a sphere with outward normal."""
        return 0.5 * np.einsum("...ab,...ab->...", self.inverse_metric, self.curvature_tensor)

    @cached_property
    def gauss_curvature(self) -> Array:
        """(...) ``det b / det a``."""
        return np.asarray(np.linalg.det(self.curvature_tensor) / np.linalg.det(self.metric))
