"""What holds a contact line where it is: hysteresis as the energy of one step.

The line stays while the cosine of its angle is between those of the advancing and the receding
angle (DeSimone, Grunewald and Otto 2007; Alberti and DeSimone 2011). In a step from a line ``x0``
the incremental energy is ``-gamma int (C(d) / d - cos(theta_Y)) a ds`` beside Young's: ``d`` is the
way of a point of the line along the old line's normal, ``a = (x - x0) x (x0' + x') / 2`` the area
that it sweeps per parameter, which is exact, and ``C`` the integral of the elastic and plastic law
``c(d) = clip(lambda - k d, cos_A, cos_R)``. With ``lambda`` taken over from what ``c`` came to, the
elastic way of lines that stay vanishes (augmented Lagrangian).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import POSITIVE, number
from ..splines import EdgeTable, line
from .term import BodyDensity, LineTerm, Scale


@dataclass(frozen=True, eq=False)
@checked(gamma="liquid.surface_tension", edge=line, stiffness=POSITIVE, advancing=number,
         receding=number)  # fmt: skip
class LineFriction(LineTerm):
    """Hysteresis of a contact line on the plane z = 0, beside a :class:`PlaneContactLine` at the
    angle of the mean cosine.

    Attributes
    ----------
    gamma : surface tension.
    advancing, receding : cosines of the angles, the first the smaller one.
    points : (count, 3) control points of the membrane where the step began.
    held : (count,) cosines ``lambda`` at which the line is held, by control point.
    stiffness : ``k``, change of cosine per length by which the line gives way.
    edge : of the membrane.
    """

    gamma: float
    advancing: float
    receding: float
    points: Array = field(repr=False)
    held: Array = field(repr=False)
    stiffness: float
    edge: str = "xi2=0"
    name = "friction"
    holds = True

    @property
    def strength(self) -> float:
        return -self.gamma

    def scaled(self, scale: Scale) -> LineFriction:
        return replace(
            self,
            gamma=self.gamma / scale.tension,
            points=scale.to_local(self.points),
            stiffness=self.stiffness * scale.length,
        )

    def energy(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> float:
        at = self._at(table, points)
        total: float = (at.excess * at.swept * table.weights).sum()
        return strength * total

    def forces(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        at, w = self._at(table, points), strength * table.weights
        moved = (at.slope * at.swept * w)[..., None] * at.normal
        moved += (at.excess * w)[..., None] * 0.5 * _turned(at.chord)
        turned = -(at.excess * w)[..., None] * 0.5 * _turned(at.way)
        forces = np.zeros((*table.functions.shape, 3))
        forces[..., :2] = (
            table.values.transpose(0, 2, 1) @ moved + table.d.transpose(0, 2, 1) @ turned
        )
        return forces

    def hessian(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        at, w = self._at(table, points), strength * table.weights
        n, d = table.values, table.d
        # first variations of way and swept area by local control points
        way = n[..., None] * at.normal[..., None, :]
        swept = 0.5 * (
            n[..., None] * _turned(at.chord)[..., None, :]
            - d[..., None] * _turned(at.way)[..., None, :]
        )
        mixed = np.einsum("eq,eqai,eqbj->eaibj", w * at.slope, way, swept)
        bent = np.einsum("eq,eqai,eqbj->eaibj", w * at.bend * at.swept, way, way)
        skew = np.einsum("eq,eqa,eqb->eab", 0.5 * w * at.excess, n, d)
        skew = skew - skew.transpose(0, 2, 1)
        elements, local = table.functions.shape
        hessian = np.zeros((elements, local, 3, local, 3))
        hessian[:, :, :2, :, :2] = mixed + mixed.transpose(0, 3, 4, 1, 2) + bent
        hessian[:, :, 0, :, 1] += skew
        hessian[:, :, 1, :, 0] -= skew
        return hessian

    def cosines(self, table: EdgeTable, points: Array) -> Array:
        """(elements, points) what ``c`` has come to: cosines at which the line is held now."""
        at = self._at(table, points)
        return np.clip(at.held - self.stiffness * at.along, self.advancing, self.receding)

    def swept(self, table: EdgeTable, points: Array) -> Array:
        """(elements, points) area that the line has swept per parameter, outwards positive."""
        return self._at(table, points).swept

    def _at(self, table: EdgeTable, points: Array) -> _Step:
        local = self.points[table.functions]
        old, tangent = table.values @ local, table.d @ local
        here = points[table.functions]
        way = (table.values @ here - old)[..., :2]
        chord = (table.d @ here + tangent)[..., :2]
        normal = _turned(tangent[..., :2])
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        along = np.einsum("eqi,eqi->eq", way, normal)
        held = np.einsum("eqa,ea->eq", table.values, self.held[table.functions])
        held = np.clip(held, self.advancing, self.receding)
        mean, slope, bend = self._mean(along, held)
        swept = 0.5 * (way[..., 0] * chord[..., 1] - way[..., 1] * chord[..., 0])
        young = 0.5 * (self.advancing + self.receding)
        return _Step(way, chord, normal, along, held, swept, mean - young, slope, bend)

    def _mean(self, d: Array, held: Array) -> tuple[Array, Array, Array]:
        """``C(d) / d`` and its first two derivatives: linear while elastic, beyond it the bound and
        what the elastic part has cost, over d."""
        k = self.stiffness
        mean, slope, bend = held - 0.5 * k * d, np.full_like(d, -0.5 * k), np.zeros_like(d)
        for bound, beyond in (
            (self.advancing, held - k * d < self.advancing),
            (self.receding, held - k * d > self.receding),
        ):
            far = d[beyond]
            cost = (held[beyond] - bound) ** 2 / (2.0 * k)
            mean[beyond] = bound + cost / far
            slope[beyond] = -cost / far**2
            bend[beyond] = 2.0 * cost / far**3
        return mean, slope, bend


@dataclass(frozen=True, eq=False)
class _Step:
    """A step at quadrature points of the line.

    Attributes
    ----------
    way, chord : (..., 2) ``x - x0`` and ``x0' + x'``; normal : out of the old line.
    along : way along it; held : cosine at its beginning; swept : area per parameter.
    excess, slope, bend : ``C / d - cos(theta_Y)`` and its derivatives by the way.
    """

    way: Array
    chord: Array
    normal: Array
    along: Array
    held: Array
    swept: Array
    excess: Array
    slope: Array
    bend: Array


def _turned(vector: Array) -> Array:
    """(..., 2) turned by a right angle clockwise: of a tangent, the normal out of the line."""
    return np.stack([vector[..., 1], -vector[..., 0]], axis=-1)
