"""Normal part of the load along a contact line inside the membrane (paper eqs 31, 32)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..solids import Plane, Sphere
from ..splines import EdgeTable, line
from .term import BodyDensity, LineTerm, Scale


@dataclass(frozen=True)
@checked(gamma="liquid.surface_tension", edge=line)
class NormalLineLoad(LineTerm):
    """The load ``q_n = gamma sin(theta)`` that presses a contact line onto its solid against the
    normal pull of the liquid-gas surface, paper eq. (31).

    Its energy is ``q_n oint g ds`` with the gap g. The force is ``-q_n n_c`` per length, and a part
    proportional to the gap itself, which vanishes with it.

    Attributes
    ----------
    gamma : surface tension.
    solid : plane z = 0 or sphere, with its contact angle.
    edge : line of the membrane, "xi2=0.25".
    """

    gamma: float
    solid: Plane | Sphere
    edge: str
    name = "line_load"
    forms = ("lines", "pressed")

    @property
    def strength(self) -> float:
        """``q_n``"""
        return float(self.gamma * np.sin(np.radians(self.solid.contact_angle)))

    def scaled(self, scale: Scale) -> NormalLineLoad:
        solid = scale.local_solid(self.solid)
        assert isinstance(solid, (Plane, Sphere))
        return NormalLineLoad(self.gamma / scale.tension, solid, self.edge)

    def energy(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> float:
        x, _, length = _curve(table, points)
        total: float = (self.solid.nearest(x).gap * length * table.weights).sum()
        return strength * total

    def forces(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        x, t, length = _curve(table, points)
        at, w = self.solid.nearest(x), strength * table.weights
        push = at.normal * (length * w)[..., None]
        pull = t * (at.gap * w)[..., None]
        return np.asarray(
            table.values.transpose(0, 2, 1) @ push + table.d.transpose(0, 2, 1) @ pull
        )

    def hessian(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        x, t, length = _curve(table, points)
        at, w = self.solid.nearest(x), strength * table.weights
        n, d = table.values, table.d
        normals = at.normal[..., :, None] * at.normal[..., None, :]
        bent = (np.eye(3) - normals) * (at.bend * length * w)[..., None, None]
        mixed = at.normal[..., :, None] * t[..., None, :] * w[..., None, None]
        across = np.eye(3) - t[..., :, None] * t[..., None, :]
        across = across * (at.gap * w / length)[..., None, None]
        half = np.einsum("eqa,eqb,eqij->eaibj", n, d, mixed, optimize=True)
        return np.asarray(
            np.einsum("eqa,eqb,eqij->eaibj", n, n, bent, optimize=True)
            + np.einsum("eqa,eqb,eqij->eaibj", d, d, across, optimize=True)
            + half
            + half.transpose(0, 3, 4, 1, 2)
        )


def _curve(table: EdgeTable, points: Array) -> tuple[Array, Array, Array]:
    """Position, unit tangent and speed along the line."""
    local = points[table.functions]
    x, d = table.values @ local, table.d @ local
    length = np.linalg.norm(d, axis=-1)
    return x, d / length[..., None], length
