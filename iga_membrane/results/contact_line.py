"""Geometry of a contact line and the forces that follow from the line alone (paper eqs 33-34)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import integer
from ..contact.unfitted import Unfitted
from ..overview import brief_repr
from ..quadrature import gauss
from ..solids import Plane, Sphere
from ..splines.space import EDGES, line
from ..surface.surface import Surface
from ..terms import BodyDensity


@dataclass(frozen=True, eq=False)
class ContactLine:
    """Geometry along a contact line, at quadrature points of the whole line.

    Attributes
    ----------
    position, tangent, conormal : (k, 3); unit tangent ``a_c`` that has the membrane to its left as
        seen from its normal's side, unit conormal tangent to the membrane and out of it.
    angle : (k,) between membrane and solid through the liquid, radians.
    arc : (k,) quadrature weights of arc length.
    """

    position: Array
    tangent: Array
    conormal: Array
    angle: Array
    arc: Array

    __repr__ = brief_repr


@checked(edge=line, points=partial(integer, least=1, most=64))
def contact_line(
    surface: Surface,
    edge: str = "xi2=0",
    points: int | None = None,
    solid: Plane | Sphere | None = None,
) -> ContactLine:
    """Line geometry from exact spline tangents (paper eqs 33-34).

    Parameters
    ----------
    surface : of a solution, in world coordinates.
    edge : of the patch, or a line inside it ("xi2=0.25"), there of the part behind it.
    solid : what the edge lies on; None is the plane z = 0.
    points : Gauss points along each element of the edge.
    """
    space = surface.space
    along, place = space.edge_place(edge)
    end = EDGES[edge][1] if edge in EDGES else 0
    basis = space.bases[along]
    u, w = gauss(space.degree + 1 if points is None else points)
    t = (basis.breaks[:-1, None] + basis.sizes[:, None] * u).ravel()
    xi = np.empty((len(t), 2))
    xi[:, along] = t
    xi[:, 1 - along] = place
    k = surface.at(xi, 1)
    speed = np.linalg.norm(k.tangents[:, along], axis=1)
    left = 1.0 if (along == 0) == (end == 0) else -1.0
    tangent = left * k.tangents[:, along] / speed[:, None]
    conormal = np.cross(tangent, k.normal)
    up = np.array([[0.0, 0.0, 1.0]]) if solid is None else solid.nearest(k.position).normal
    # atan2 keeps its digits where the membrane is nearly tangent to the solid
    tilt = np.linalg.norm(np.cross(k.normal, up), axis=1)
    angle = np.arctan2(tilt, np.einsum("ki,ki->k", k.normal, np.broadcast_to(up, k.normal.shape)))
    weights = speed * (basis.sizes[:, None] * w).ravel()
    return ContactLine(k.position, tangent, conormal, angle, weights)


def trimmed_line(unfitted: Unfitted, surface: Surface, images: list[Array]) -> ContactLine:
    """Line geometry on solids that the membrane passes through, whole and counterclockwise.

    Parameters
    ----------
    images : matrices (3, 3) that carry the sector to each of its images.
    """
    line = unfitted.on_line(surface.points)
    normal = (line.m / line.area[..., None]).reshape(-1, 3)
    solid = line.at.normal.reshape(-1, 3)
    tangent = line.tangent.reshape(-1, 3)
    speed = np.linalg.norm(tangent, axis=1)
    x = line.x.reshape(-1, 3)
    arc = speed * line.table.weights.ravel()
    # the wetted side lies to the left
    turn = np.repeat(line.left, line.x.shape[1])
    tangent = tangent * (turn / speed)[:, None]
    conormal = np.cross(tangent, normal)
    inward = np.einsum("ki,ki->k", conormal, solid)
    conormal = np.where((inward > 0)[:, None], -conormal, conormal)
    tilt = np.linalg.norm(np.cross(normal, solid), axis=1)
    angle = np.arctan2(tilt, np.einsum("ki,ki->k", normal, solid))

    def whole(vectors: Array) -> Array:
        return np.concatenate([vectors @ m for m in images])

    around = [np.sign(np.linalg.det(m)) * tangent @ m for m in images]
    copies = len(images)
    return ContactLine(
        whole(x), np.concatenate(around), whole(conormal), np.tile(angle, copies),
        np.tile(arc, copies),
    )  # fmt: skip


@dataclass(frozen=True)
class VerticalForces:
    """What acts on the wetted part of the plane z = 0, positive downwards (dimensionless).

    Attributes
    ----------
    wet_area : inside the line.
    push : of the pressure on it.
    line : pull of the membrane upwards with Young's angle; measured : with the spline's tangents.
    """

    wet_area: float
    push: float
    line: float
    measured: float


def vertical_forces(
    line: ContactLine, body: BodyDensity, tension: float, contact_angle: float
) -> VerticalForces:
    """Forces on the wetted plane from the line alone, by Green's theorem (counterclockwise)."""
    x, y = line.position[:, 0], line.position[:, 1]
    nx, ny = line.tangent[:, 1] * line.arc, -line.tangent[:, 0] * line.arc
    wet = float(0.5 * (x @ nx + y @ ny))
    mx, my = float(0.5 * (x * x) @ nx), float(0.5 * (y * y) @ ny)
    gx, gy, _ = body.gradient
    push = -(body.constant * wet + gx * mx + gy * my)
    young = tension * np.sin(np.radians(contact_angle)) * float(line.arc.sum())
    measured = -tension * float(line.conormal[:, 2] @ line.arc)
    return VerticalForces(wet, push, young, measured)
