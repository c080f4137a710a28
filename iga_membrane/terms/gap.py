"""An energy of one's own: a law of the gap between the membrane and a solid."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..own import answer_of, called, note_bad
from ..solids import Nearest, Solid
from ..splines import Table
from .term import BodyDensity, LocalSolid, Scale, Term
from .variations import ElementPoints, cross
from .variations import forces as area_forces
from .variations import hessian as area_hessian


class GapTerm(Term):
    """Energy per area of the membrane that depends on its gap to a solid: ``int f(gap) dA``.

    A subclass is a frozen dataclass with a field ``solid`` and the method :meth:`law`; a field
    ``name`` of its own is needed only where a scene has two. Variations, Newton's method, stability
    and audit follow from the law.

    Attributes
    ----------
    solid : the body from which the gap is measured, in world coordinates.
    """

    solid: Solid
    name = "gap"
    forms = ("laws",)

    @abstractmethod
    def law(self, gap: Array) -> tuple[Array, Array, Array]:
        """Energy per area ``f``, and its first and second derivative by the gap.

        Parameters
        ----------
        gap : (...) in the user's units, positive outside of the solid: paper eq. (24).

        Returns
        -------
        f, slope, curvature : three arrays (...).
        """

    def scaled(self, scale: Scale) -> LocalGap:
        """The term in a scene's units; laws stay in the user's."""
        return LocalGap(self, scale)


@dataclass(frozen=True)
class Law:
    """A law at points (...), dimensionless.

    Attributes
    ----------
    value, slope, curvature : energy per area and its derivatives by the gap.
    at : nearest surfaces.
    """

    value: Array
    slope: Array
    curvature: Array
    at: Nearest

    @property
    def pull(self) -> Array:
        """(..., 3) gradient of the energy per area."""
        return np.asarray(self.slope[..., None] * self.at.normal)


@dataclass(frozen=True)
@checked()
class LocalGap(Term):
    """A law of the gap in the scale and frame of a scene.

    Attributes
    ----------
    term : the law and its solid, in the user's units.
    scale : of the scene.
    """

    term: GapTerm
    scale: Scale
    forms = ("gaps",)

    @property
    def name(self) -> str:  # type: ignore[override]
        """That of the law."""
        return self.term.name

    @property
    def solids(self) -> tuple[Solid, ...]:
        return (LocalSolid(self.term.solid, self.scale),)

    def scaled(self, scale: Scale) -> LocalGap:
        return LocalGap(self.term, scale)

    def at(self, points: Array) -> Law:
        """The law at local points (..., 3)."""
        unit = self.scale.length
        found = LocalSolid(self.term.solid, self.scale).nearest(points)
        gap, law = found.gap * unit, self.term.law
        names = ("f", "slope", "curvature")
        answers = answer_of(law, called(law, gap), names, gap.shape, finite=False)
        for name, values in zip(names, answers, strict=True):
            note_bad(law, name, values, gap, "gap")
        f, slope, curvature = answers
        per = 1.0 / self.scale.tension
        return Law(f * per, slope * (unit * per), curvature * (unit**2 * per), found)


def energy(table: Table, at: ElementPoints, law: Law) -> float:
    """``int f dA``"""
    return float((law.value * at.area * table.weights).sum())


def forces(table: Table, at: ElementPoints, law: Law) -> Array:
    """(elements, local, 3) derivative by the local control points, ``int f' n . u + f a^b . u_,b
    dA`` with the gap's gradient n."""
    area = area_forces(table.weighted(law.value), at, 1.0, BodyDensity())
    push = law.pull * (at.area * table.weights)[..., None]
    return np.asarray(area + table.values.transpose(0, 2, 1) @ push)


def hessian(
    table: Table, at: ElementPoints, law: Law, directions: Array, kernels: Any = None
) -> Array:
    """(elements, local, local) second derivative along given directions.

    Notes
    -----
    ``int [f'' (n . u)(n . v) + f' u . n_grad v] dA`` with the gap's Hessian ``n_grad``, the mixed
    part ``f' (n . u) dJ(v)`` with ``dJ(v) = v_,1 . (a_2 x N) + v_,2 . (N x a_1)``, and ``f`` times
    the second variation of the area.
    """
    along = directions.transpose(0, 2, 1)
    normal = at.c / at.area[..., None]
    stretch = table.d1 * (cross(at.a2, normal) @ along)
    stretch += table.d2 * (cross(normal, at.a1) @ along)
    u = table.values * (law.at.normal @ along)
    w = table.weights
    wj = w * at.area
    bent = wj * law.slope * law.at.bend
    half = (0.5 * (wj * law.curvature - bent))[..., None] * u + (w * law.slope)[..., None] * stretch
    mixed = u.transpose(0, 2, 1) @ half
    blocks = mixed + mixed.transpose(0, 2, 1)
    even = (table.values * bent[..., None]).transpose(0, 2, 1) @ table.values
    blocks += even * (directions @ along)
    if law.at.ridge is not None:
        across = table.values * (law.at.ridge @ along)
        blocks += across.transpose(0, 2, 1) @ (across * (wj * law.slope)[..., None])
    area = area_hessian(table.weighted(law.value), at, 1.0, BodyDensity(), directions, kernels)
    return np.asarray(blocks + area)
