"""How the edges and planes of a surface restrict its motion: plain data, read by the motion."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal, Protocol

from ..arguments import checked
from ..checks import NOT_NEGATIVE, items, number, words
from ..solids import Plane, Solid, Sphere
from ..splines import EDGE


def _reach(field: str, value: Any) -> float:
    """A length > 0, which may be infinite."""
    endless = isinstance(value, float) and value == float("inf")
    return value if endless else number(field, value, above=0.0)


Model = Literal["full", "half", "quarter", "eighth"]
"""How much of a patch is computed."""


class Frame(Protocol):
    """Units and axes of a scene, as supports need them (:class:`..terms.Scale`)."""

    @property
    def length(self) -> float: ...

    def local_sphere(self, sphere: Sphere) -> Sphere: ...


class Restrictable(Protocol):
    """What a support may ask of a motion (:class:`.restrictions.Restrictions`)."""

    def fix(self, edge: str) -> None: ...

    def slide(self, support: Sliding) -> None: ...

    def mirror_in(self, axis: str) -> None: ...

    def stand(self, edge: str) -> None: ...

    def join(self, edges: tuple[str, str]) -> None: ...

    def compute(self, sector: Sector) -> None: ...

    def shift(self, axes: str, above: float) -> None: ...


@dataclass(frozen=True)
@checked(edge=EDGE)
class Fixed:
    """An edge whose control points do not move: a rim.

    Attributes
    ----------
    edge : "xi1=0", "xi1=1", "xi2=0" or "xi2=1".
    """

    edge: str
    kind = "fixed"

    def scaled(self, scale: Frame) -> Fixed:
        """In the units of a scale."""
        return self

    def restrict(self, motion: Restrictable) -> None:
        """Restrict a motion."""
        motion.fix(self.edge)


@dataclass(frozen=True)
@checked(edge=EDGE, reach=_reach)
class Sliding:
    """An edge that slides on a solid: a contact line.

    Attributes
    ----------
    edge : as for :class:`Fixed`.
    solid : what it slides on; None is a plane of constant z.
    level : height of that plane in the frame of the scene.
    reach : distance, over the scene's length, over which the directions of the edge fade; they fade
        towards the other end of the patch as well.
    """

    edge: str = "xi2=0"
    solid: Sphere | None = None
    reach: float = float("inf")
    level: float = 0.0
    kind = "sliding"

    def scaled(self, scale: Frame) -> Sliding:
        """In the units of a scale."""
        if self.solid is None:
            return replace(self, level=self.level / scale.length) if self.level else self
        return replace(self, solid=scale.local_sphere(self.solid))

    def restrict(self, motion: Restrictable) -> None:
        """Restrict a motion."""
        motion.slide(self)

    @property
    def on(self) -> Solid:
        """The solid, be it the plane."""
        return self.solid or Plane(90.0, (0.0, 0.0, self.level))


@dataclass(frozen=True)
@checked()
class Symmetry:
    """A mirror plane through the origin, normal to an axis; edges that lie in it stay in it.

    The surface meets it at the angle at which it starts, a right one in a smooth whole.

    Attributes
    ----------
    axis : "x", "y" or "z".
    """

    axis: Literal["x", "y", "z"]
    kind = "mirrors"

    def scaled(self, scale: Frame) -> Symmetry:
        """In the units of a scale."""
        return self

    def restrict(self, motion: Restrictable) -> None:
        """Restrict a motion."""
        motion.mirror_in(self.axis)


@dataclass(frozen=True)
@checked(edge=EDGE)
class Mirror:
    """An edge in a vertical mirror plane, which the surface meets at a right angle: a cell's wall.

    Attributes
    ----------
    edge : of the surface; its control points and those next to it move together.
    """

    edge: str
    kind = "walls"

    def scaled(self, scale: Frame) -> Mirror:
        """In the units of a scale."""
        return self

    def restrict(self, motion: Restrictable) -> None:
        """Restrict a motion."""
        motion.stand(self.edge)


@dataclass(frozen=True)
@checked(edges=partial(items, each=EDGE, count=2))
class Joint:
    """Two edges of equal control points that move together: the seam between patches.

    Attributes
    ----------
    edges : the two edges.
    """

    edges: tuple[str, str] = ("xi1=0", "xi1=1")
    kind = "joints"

    def scaled(self, scale: Frame) -> Joint:
        """In the units of a scale."""
        return self

    def restrict(self, motion: Restrictable) -> None:
        """Restrict a motion."""
        motion.join(self.edges)


@dataclass(frozen=True)
@checked()
class Sector:
    """The part of a ring or square patch that is computed; the rest are mirror images of it.

    "half": mirror plane y = 0; "quarter": x = 0 too; "eighth": x = y too. Every control point of
    the whole patch is kept, so all models share one spline space and give the same numbers.

    Attributes
    ----------
    model : "full", "half", "quarter" or "eighth".
    """

    model: Model = "full"
    kind = "sectors"

    def scaled(self, scale: Frame) -> Sector:
        """In the units of a scale."""
        return self

    def restrict(self, motion: Restrictable) -> None:
        """Restrict a motion."""
        motion.compute(self)

    @property
    def copies(self) -> int:
        """How many sectors make the whole."""
        return {"full": 1, "half": 2, "quarter": 4, "eighth": 8}[self.model]

    @property
    def mirrored(self) -> str:
        """Axes along which nothing can move as a whole."""
        return {"full": "", "half": "y"}.get(self.model, "xy")


@dataclass(frozen=True)
@checked(axes=words("x", "y", "xy"), above=NOT_NEGATIVE)
class Shift:
    """A body that lies on a solid may also be shifted along some axes as a whole, but for its foot.

    Given directions that are vertical in the foot follow a shift only so far. It is an unknown of
    its own, in which every control point takes part by its height at the start, over ``above``; the
    control points' own steps then leave their mean place alone.

    Attributes
    ----------
    axes : "x", "y" or "xy"; none that a mirror plane fixes.
    above : height in the scene's scale up to which control points take no part.
    """

    axes: str
    above: float = 0.0
    kind = "shifts"

    def scaled(self, scale: Frame) -> Shift:
        """In the units of a scale."""
        return self

    def restrict(self, motion: Restrictable) -> None:
        """Restrict a motion."""
        motion.shift(self.axes, self.above)


Support = Fixed | Sliding | Symmetry | Mirror | Joint | Sector | Shift


class Supports(tuple[Support, ...]):
    """How a membrane is held, in its order and by kind.

    Attributes
    ----------
    fixed, sliding, mirrors, walls, joints, sectors, shifts : supports of each kind.
    """

    fixed: list[Fixed]
    sliding: list[Sliding]
    mirrors: list[Symmetry]
    walls: list[Mirror]
    joints: list[Joint]
    sectors: list[Sector]
    shifts: list[Shift]

    def __new__(cls, supports: Iterable[Support] = ()) -> Supports:
        self = super().__new__(cls, supports)
        for kind in cls.__annotations__:
            setattr(self, kind, [])
        for support in self:
            getattr(self, support.kind).append(support)
        return self

    @property
    def sector(self) -> Sector:
        """The part of a closed patch that is computed."""
        return next(iter(self.sectors), Sector())

    @property
    def held(self) -> list[str]:
        """Edges that are fixed or slide on a solid."""
        return [s.edge for s in self.fixed] + [s.edge for s in self.sliding]

    @property
    def on_spheres(self) -> list[tuple[str, Sphere]]:
        """Edges that slide on spheres, with these."""
        return [(s.edge, s.solid) for s in self.sliding if s.solid is not None]

    @property
    def on_plane(self) -> list[str]:
        """Edges that slide on the plane z = 0."""
        return [s.edge for s in self.flat if not s.level]

    @property
    def flat(self) -> list[Sliding]:
        """Those that slide on planes."""
        return [s for s in self.sliding if s.solid is None]
