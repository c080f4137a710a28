"""Grading of a parametrization towards a boundary layer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array
from ..checks import POSITIVE


@dataclass(frozen=True)
@checked(first=POSITIVE)
class Grading:
    """Smooth map ``s(t) = (exp(a t) - 1) / (exp(a) - 1)`` of [0, 1] to itself.

    Analytic, so splines on uniform knots in ``t`` resolve a boundary layer at ``s = 0`` without
    losing their order.

    Attributes
    ----------
    first : ``s'(0)``, the length of the first of many equal steps over the mean; 1 is uniform.
    """

    first: float = 1.0

    @cached_property
    def rate(self) -> float:
        """The exponent ``a``: ``a / (exp(a) - 1) = first``."""
        if self.first >= 1.0:
            return 0.0
        a = 2.0 * np.log(1.0 / self.first) + 1e-3
        for _ in range(50):
            # Newton on the logarithm of both sides, which is concave and falling
            value = np.log(a) - np.log(np.expm1(a)) - np.log(self.first)
            step = value / (1.0 / a + 1.0 / np.expm1(-a))
            a = max(a - step, 0.1 * a)
            if abs(step) <= 1e-14 * a:
                break
        return float(a)

    def fraction(self, t: ArrayLike) -> Array:
        """``s(t)``"""
        t = np.asarray(t, float)
        if not self.rate:
            return t.copy()
        return np.asarray(np.expm1(self.rate * t) / np.expm1(self.rate))

    def slope(self, t: ArrayLike) -> Array:
        """``ds/dt``"""
        t = np.asarray(t, float)
        if not self.rate:
            return np.ones_like(t)
        return np.asarray(self.rate * np.exp(self.rate * t) / np.expm1(self.rate))
