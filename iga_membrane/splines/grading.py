"""Grading of a parametrization towards a boundary layer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array
from ..checks import POSITIVE, number


@dataclass(frozen=True)
@checked(first=POSITIVE, even=partial(number, least=0.0, most=0.99))
class Grading:
    """Smooth map of [0, 1] to itself with ``s' ~ 1 / (exp(-a t) + exp(-a (1 - even)))``.

    Steps grow from ``s = 0`` on, and are equal over the last part of them: a layer much narrower
    than the rest does not make that coarse. Without such a part it is
    ``s(t) = (exp(a t) - 1) / (exp(a) - 1)``. Analytic, so splines on uniform knots in ``t`` resolve
    a boundary layer at ``s = 0`` without losing their order.

    Attributes
    ----------
    first : ``s'(0)``, the length of the first of many equal steps over the mean; 1 is uniform.
    even : part of the steps that are equal, 0 to 0.99.
    """

    first: float = 1.0
    even: float = 0.0

    @cached_property
    def rate(self) -> float:
        """The exponent ``a``, for which ``s'(0)`` is ``first``."""
        if self.first >= 1.0:
            return 0.0
        start = np.array(0.0)
        low, high = 1e-12, (2.0 * float(np.log(1.0 / self.first)) + 2.0) / (1.0 - self.even)
        # halved to the last bit, in less than a millisecond: importing a root finder takes hundreds
        while low < (a := 0.5 * (low + high)) < high:
            low, high = (a, high) if self._slope(start, a) > self.first else (low, a)
        return a

    def fraction(self, t: ArrayLike) -> Array:
        """``s(t)``"""
        t = np.asarray(t, float)
        return self._fraction(t, self.rate) if self.rate else t.copy()

    def slope(self, t: ArrayLike) -> Array:
        """``ds/dt``"""
        t = np.asarray(t, float)
        return self._slope(t, self.rate) if self.rate else np.ones_like(t)

    def _walked(self, t: Array, a: float) -> Array:
        """``s(t)`` up to a factor."""
        if not self.even:
            return np.asarray(np.expm1(a * t))
        turn = np.exp(-a * (1.0 - self.even))
        # log(1 + turn exp(a t)) - log(1 + turn)
        return np.asarray(np.log1p(turn * np.expm1(a * t) / (1.0 + turn)))

    def _fraction(self, t: Array, a: float) -> Array:
        return np.asarray(self._walked(t, a) / self._walked(np.array(1.0), a))

    def _slope(self, t: Array, a: float) -> Array:
        rise = a * np.exp(a * t)
        if self.even:
            turn = np.exp(-a * (1.0 - self.even))
            rise = rise * turn / (1.0 + turn * np.exp(a * t))
        return np.asarray(rise / self._walked(np.array(1.0), a))
