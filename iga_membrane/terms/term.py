"""What a membrane pays for: three forms of energy, each varied once for all terms of its form.

- area: ``int f dA`` over the membrane (surface tension),
- body: ``int e(x) dV`` over the liquid, ``e`` affine in position (gravity, pressure, and the
  functionals that constraints prescribe),
- line: an integral along an edge of the membrane (contact line).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array, Index, Mask
from ..checks import POSITIVE, array, items, real, refusal
from ..errors import SceneError
from ..solids import Nearest, Plane, Solid, Sphere, SphereLattice, Spheres
from ..solids.fan import Fan, fan_of
from ..solids.own import nearest_of
from ..solids.wettability import local_angle

if TYPE_CHECKING:
    from ..splines import EdgeTable


def _rotation(field: str, value: Any) -> tuple[tuple[float, ...], ...]:
    """Three unit vectors at right angles."""
    turn = array(field, value, shape=(3, 3))
    if np.abs(turn.T @ turn - np.eye(3)).max() > 1e-9:
        raise refusal(
            field, value, "must be a rotation", "give it columns of length 1 at right angles"
        )
    return tuple(tuple(float(a) for a in row) for row in turn)


ROOM = 1e150
"""Sizes of the units of a scene: their squares are doubles."""
FAR = 1e9
"""Lengths of a scene over its own: a gap there has the rounding 1e-7, as large as tolerances."""


@dataclass(frozen=True)
@checked(length=POSITIVE, tension=POSITIVE, rotation=_rotation)
class Scale:
    """Units in which a scene is solved: a length, a tension, and a frame.

    Local coordinates are ``rotation.T @ (x - origin) / length``.

    Attributes
    ----------
    length, tension : the units.
    origin : (3,) of the frame, in world coordinates.
    rotation : (3, 3) its columns are the frame's axes.
    """

    length: float = 1.0
    tension: float = 1.0
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: tuple[tuple[float, ...], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

    def __post_init__(self) -> None:
        length, tension = self.length, self.tension
        units = {"length^3": length**3, "tension length^2": tension * length**2,
                 "tension / length": tension / length}  # fmt: skip
        for name, size in units.items():
            if not 1.0 / ROOM < size < ROOM:
                raise SceneError(
                    f"scale: length = {length:g}, tension (liquid.surface_tension) = {tension:g}: "
                    f"their {name} = {size:g} must be from {1.0 / ROOM:g} to {ROOM:g}; beyond it "
                    "double precision has no room; choose other units"
                )
        self.check_lengths("scale: origin", self.origin, least=0.0)

    def check_lengths(self, field: str, values: ArrayLike, least: float = 1.0 / FAR) -> None:
        """Refuse lengths that lose their digits beside the scene's own, or its own beside them.

        Raises
        ------
        SceneError
        """
        found = np.abs(np.atleast_1d(np.asarray(values, float))) / self.length
        wrong = found[(found > FAR) | (found < least)]
        if wrong.size:
            raise SceneError(
                f"{field}: {wrong[0] * self.length:g} given, {wrong[0]:.3g} times the scene's own "
                f"length {self.length:g} (of a droplet the radius of a ball of its volume): must "
                f"be {least:g} to {FAR:g} times, or double precision cannot tell them apart; "
                "choose sizes and places nearer to it"
            )

    @property
    def force(self) -> float:
        """Unit: tension times length."""
        return self.tension * self.length

    @property
    def energy(self) -> float:
        """Unit: tension times squared length."""
        return self.tension * self.length**2

    @property
    def pressure(self) -> float:
        """Unit: tension over length."""
        return self.tension / self.length

    @property
    def axes(self) -> Array:
        """(3, 3) columns are the local axes in world coordinates."""
        return np.array(self.rotation)

    def to_world(self, points: Array) -> Array:
        """World coordinates of local, dimensionless points (..., 3)."""
        return np.asarray(np.array(self.origin) + self.length * (points @ self.axes.T))

    def local_sphere(self, sphere: Sphere) -> Sphere:
        """A sphere in local, dimensionless coordinates."""
        self.check_lengths("radius", sphere.radius)
        self.check_lengths("center", sphere.center, least=0.0)
        x, y, z = (float(c) for c in self.to_local(np.array(sphere.center)))
        return Sphere(sphere.contact_angle, sphere.radius / self.length, (x, y, z))

    def local_solid(self, solid: Solid) -> Solid:
        """A substrate in local, dimensionless coordinates.

        The frame is that of a plane; lattices and lists keep theirs: scenes with them are not
        turned or shifted.
        """
        unit = self.length
        match solid:
            case Plane():
                return Plane(local_angle(solid.contact_angle, self))
            case Sphere():
                return self.local_sphere(solid)
            case SphereLattice():
                self.check_lengths("substrate.radius", solid.radius)
                return replace(
                    solid,
                    radius=solid.radius / unit,
                    spacing=solid.spacing / unit,
                    offset=(solid.offset[0] / unit, solid.offset[1] / unit),
                    base=None if solid.base is None else solid.base / unit,
                )
            case Spheres():
                self.check_lengths("substrate.radii", solid.radii)
                self.check_lengths("substrate.centers", solid.centers, least=0.0)
                return Spheres(
                    solid.contact_angle,
                    np.asarray(solid.centers) / unit,
                    np.asarray(solid.radii) / unit,
                    None if solid.base is None else solid.base / unit,
                )
            case _:
                return LocalSolid(solid, self)

    def to_local(self, points: Array) -> Array:
        """Local, dimensionless coordinates of world points (..., 3)."""
        return np.asarray((points - np.array(self.origin)) @ self.axes / self.length)


@dataclass(frozen=True)
class LocalSolid:
    """Any solid, seen in the units and the frame of a scale.

    Attributes
    ----------
    solid : in world coordinates.
    view : the scale.
    """

    solid: Solid
    view: Scale

    @property
    def contact_angle(self) -> Any:
        return local_angle(self.solid.contact_angle, self.view)

    @property
    def scale(self) -> float:
        return self.solid.scale / self.view.length

    def nearest(self, points: Array) -> Nearest:
        at = nearest_of(self.solid, self.view.to_world(points))
        unit, axes = self.view.length, self.view.axes
        ridge = None if at.ridge is None else at.ridge @ axes * np.sqrt(unit)
        turn = None if at.turn is None else axes.T @ at.turn @ axes * unit
        return Nearest.computed(
            at.gap / unit, at.normal @ axes, at.bend * unit, at.which, ridge, turn
        )

    def knows(self, points: Array) -> Mask:
        known = getattr(self.solid, "knows", None)
        found = np.ones(points.shape[:-1], bool)
        return found if known is None else np.asarray(known(self.view.to_world(points)))

    def fan(self, points: Array, tangents: Array) -> Fan:
        unit, axes = self.view.length, self.view.axes
        found = fan_of(self.solid, self.view.to_world(points), tangents @ axes.T * unit)
        points = self.view.to_local(found.points)
        return Fan(points, found.normals @ axes, found.weights / unit**2)

    def center_of(self, which: Index) -> Array:
        return self.view.to_local(self.solid.center_of(which))

    def radius_of(self, which: Index) -> Array:
        return self.solid.radius_of(which) / self.view.length


@dataclass(frozen=True)
@checked(constant=real, gradient=partial(items, each=real, count=3))
class BodyDensity:
    """Energy per volume of liquid, ``constant + gradient . x``."""

    constant: float = 0.0
    gradient: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def at(self, points: Array) -> Array:
        """(...) at points (..., 3)."""
        return np.asarray(self.constant + points @ np.array(self.gradient))

    def __add__(self, other: BodyDensity) -> BodyDensity:
        x, y, z = (a + b for a, b in zip(self.gradient, other.gradient, strict=True))
        return BodyDensity(self.constant + other.constant, (x, y, z))

    def __mul__(self, factor: float) -> BodyDensity:
        x, y, z = (factor * a for a in self.gradient)
        return BodyDensity(factor * self.constant, (x, y, z))


class Term(ABC):
    """Something the membrane pays for.

    Attributes
    ----------
    name : its key in a solution's energies.
    forms : lists of :class:`.terms.Terms` in which it counts.
    """

    name: str
    forms: ClassVar[tuple[str, ...]] = ()

    @property
    def solids(self) -> tuple[Solid, ...]:
        """Bodies from which it is measured: a rigid motion that carries them into themselves leaves
        its energy alone."""
        return ()

    @abstractmethod
    def scaled(self, scale: Scale) -> Term:
        """The same term in the units of a scale."""


class AreaTerm(Term):
    """Energy per area of the membrane."""

    forms: ClassVar[tuple[str, ...]] = ("areas",)

    @abstractmethod
    def tension(self) -> float:
        """Energy per area."""


class BodyTerm(Term):
    """Energy per volume of liquid."""

    forms: ClassVar[tuple[str, ...]] = ("bodies",)

    @abstractmethod
    def density(self) -> BodyDensity:
        """Energy per volume."""


class Constraint(BodyTerm):
    """A body integral that is held at a value by a multiplier.

    ``density`` is the integrand; the membrane's energy gets ``-multiplier * density``.
    """

    forms: ClassVar[tuple[str, ...]] = ("constraints",)

    @property
    @abstractmethod
    def target(self) -> float:
        """Value of the integral over the membrane's side of the liquid."""


LINE_EDGES = ("xi2=0",)
"""Edges that can carry a contact line: wetted areas are counted counterclockwise inside them."""
CEILING_EDGES = ("xi2=1",)
"""Edges that can carry one on a plane above the liquid."""


class LineTerm(Term):
    """An energy along an edge of the membrane, its own number ``strength`` times a functional of
    the edge, and the part of body integrals that the flux through the membrane leaves out there.

    All methods take ``strength`` and ``body`` so that one line serves the energy (its own strength,
    the sum of bodies) and every constraint (no strength, the constraint's density).
    """

    edge: str
    forms: ClassVar[tuple[str, ...]] = ("lines", "others")
    holds: ClassVar[bool] = False
    """Whether it keeps a droplet from sliding."""

    @property
    @abstractmethod
    def strength(self) -> float:
        """Energy per unit of the functional: per length for a line tension."""

    @abstractmethod
    def energy(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> float:
        """Value on the edge's elements for control points (count, 3)."""

    @abstractmethod
    def forces(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        """(elements, local, 3) derivative by each local control point."""

    @abstractmethod
    def hessian(self, table: EdgeTable, points: Array, strength: float, body: BodyDensity) -> Array:
        """(elements, local, 3, local, 3) second derivative."""


class WettingLine(LineTerm):
    """A contact line: the functional is the area wetted inside it, and ``strength`` its energy per
    area, ``-gamma cos(theta)``; the body integrals are those under the wetted area.

    Attributes
    ----------
    gamma : surface tension.
    covered : whether the membrane covers the wetted area, too.
    toward : unit vector out of the solid to the liquid.
    level : of a plane, its height.
    pinned : whether it rests on a rim, with an angle of its own.
    """

    gamma: float
    covered: bool = False
    level: float = 0.0
    pinned: ClassVar[bool] = False
    toward = (0.0, 0.0, 1.0)
    forms: ClassVar[tuple[str, ...]] = ("lines", "wetting")

    @property
    def ball(self) -> Sphere | None:
        """The sphere on which it lies; None on a plane."""
        return None

    @property
    @abstractmethod
    def face(self) -> Plane | Sphere:
        """The solid on which it lies."""

    def normal(self, points: Array) -> Array:
        """(..., 3) unit normals of its solid at points (..., 3) of it."""
        return np.broadcast_to([0.0, 0.0, 1.0], points.shape)

    @property
    def repels(self) -> bool:
        """Whether the solid is flat and not wetted at all."""
        return self.ball is None and not self.covered and self.strength >= self.gamma

    @property
    def turn(self) -> float:
        """1 where the edge runs counterclockwise about the solid's normal, else -1."""
        return 1.0
