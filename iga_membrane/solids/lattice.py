"""Asperities: spheres on a lattice, or anywhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array, Index
from ..checks import POSITIVE, Rule, array, contact_angle, items, listed, number, refusal, vector
from ..errors import SceneError
from ..overview import brief_repr
from .nearest import Nearest, closer, nearest_of_balls


@dataclass(frozen=True)
@checked("substrate", contact_angle=contact_angle, base=partial(number, most=0.0))
class SphereLattice:
    """Equal spheres on an unbounded lattice, their tops in z = 0.

    Attributes
    ----------
    contact_angle : Young's angle in degrees, through the liquid.
    radius : of the spheres.
    spacing : between the centres of neighbours, >= 2 radius.
    arrangement : "square", or "hexagonal" with neighbours along x.
    offset : a sphere stands at x, y = offset.
    base : height of a plane under the asperities, or None.
    """

    contact_angle: float
    radius: float
    spacing: float
    arrangement: str = "square"
    offset: tuple[float, float] = (0.0, 0.0)
    base: float | None = None

    def __post_init__(self) -> None:
        number("substrate.spacing", self.spacing, least=2.0 * self.radius, unit="twice the radius")

    @property
    def scale(self) -> float:
        """Length over which contact changes."""
        return self.radius

    def radius_of(self, which: Index) -> Array:
        """(...) radii of spheres by their numbers."""
        return np.full(np.shape(which), self.radius)

    def angle_of(self, which: Index) -> Array:
        """(...) contact angles in degrees of spheres by their numbers."""
        return np.full(np.shape(which), self.contact_angle)

    @property
    def area_per_sphere(self) -> float:
        """Of the lattice's cell."""
        return float(self.spacing**2 * (1.0 if self.arrangement == "square" else np.sqrt(0.75)))

    def nearest(self, points: Array) -> Nearest:
        """Gap and its derivatives, by rounding to lattice sites: the cost of a point does not
        depend on the number of asperities."""
        i, j = self._site(points[..., 0] - self.offset[0], points[..., 1] - self.offset[1])
        which = np.asarray((i + HALF) * (2 * HALF) + (j + HALF))
        found = nearest_of_balls(points, self._place(i, j), np.asarray(self.radius), which)
        return found if self.base is None else closer(found, plane_below(points, self.base))

    def center_of(self, which: Index) -> Array:
        """(..., 3) centres of spheres by their numbers."""
        i, j = np.divmod(np.asarray(which), 2 * HALF)
        return self._place(i - HALF, j - HALF)

    def within(self, reach: float) -> Index:
        """Numbers of the spheres whose centres lie within a distance of the z axis."""
        steps = int(np.ceil((reach + np.abs(self.offset).max()) / (0.8 * self.spacing))) + 1
        i, j = np.meshgrid(np.arange(-steps, steps + 1), np.arange(-steps, steps + 1))
        place = self._place(i, j)
        inside = np.hypot(place[..., 0], place[..., 1]) <= reach
        return np.asarray((i[inside] + HALF) * (2 * HALF) + (j[inside] + HALF))

    def _site(self, x: Array, y: Array) -> tuple[Index, Index]:
        """Lattice numbers of the nearest centre in the plane."""
        if self.arrangement == "square":
            i, j = np.rint(x / self.spacing), np.rint(y / self.spacing)
            return i.astype(int), j.astype(int)
        rise = np.sqrt(0.75) * self.spacing
        best, site = np.full(np.shape(x), np.inf), None
        for offset in (0.0, 0.5):
            # the hexagonal lattice is two rectangular ones
            j = 2.0 * np.rint(0.5 * (y / rise) - offset) + 2.0 * offset
            i = np.rint(x / self.spacing - 0.5 * j)
            square = (x - self.spacing * (i + 0.5 * j)) ** 2 + (y - rise * j) ** 2
            wins = square < best
            site = (i, j) if site is None else (np.where(wins, i, site[0]),
                                                np.where(wins, j, site[1]))  # fmt: skip
            best = np.where(wins, square, best)
        assert site is not None
        return site[0].astype(int), site[1].astype(int)

    def _place(self, i: Index, j: Index) -> Array:
        if self.arrangement == "square":
            x, y = self.spacing * i, self.spacing * j
        else:
            x, y = self.spacing * (i + 0.5 * j), np.sqrt(0.75) * self.spacing * j
        return np.stack(
            [x + self.offset[0], y + self.offset[1], np.full(np.shape(x), -self.radius)], axis=-1
        )


MOST = 1_000_000
"""Spheres of a list at most: about 200 MB with their tree."""
HALF = 1 << 20
"""Lattice sites are numbered from minus to plus this."""


def _each(field: str, value: Any, *, rule: Rule) -> Array:
    """() or (n,) numbers that keep a rule."""
    if not listed(value):
        return np.asarray(rule(field, value))
    numbers = array(field, value, shape=(None,))
    kinds, first = np.unique(numbers, return_index=True)
    for k in np.argsort(first):
        rule(f"{field}[{first[k]}]", float(kinds[k]))
    return numbers


def _places(field: str, value: Any) -> Array:
    """(n, 3) centres, as a copy."""
    if isinstance(value, np.ndarray):
        places = array(field, value, shape=(None, 3))
    else:
        places = np.array(items(field, value, each=vector)).reshape(-1, 3)
    if not 1 <= len(places) <= MOST:
        raise refusal(
            field, value, f"at least one sphere is needed, at most {MOST}", "an unbounded lattice "
            'is substrate.kind = "sphere_lattice"',
        )  # fmt: skip
    return np.array(places)


@dataclass(frozen=True, eq=False)
@checked(
    "substrate",
    contact_angle=partial(_each, rule=contact_angle),
    centers=_places,
    radii=partial(_each, rule=POSITIVE),
)
class Spheres:
    """Any spheres.

    Attributes
    ----------
    contact_angle : Young's angle in degrees, one or one per sphere.
    centers : (n, 3).
    radii : (n,) or one for all.
    base : height of a plane under them, or None.
    """

    contact_angle: float | Sequence[float] | Array
    centers: Sequence[Sequence[float]] | Array
    radii: float | Sequence[float] | Array
    base: float | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        count = len(self.centers)
        for name in ("radii", "contact_angle"):
            given = np.asarray(getattr(self, name))
            if given.ndim and given.shape != (count,):
                raise SceneError(
                    f"substrate.{name}: an array of shape {given.shape} given for {count} spheres; "
                    "one number or one per sphere is needed"
                )
            object.__setattr__(self, name, np.array(np.broadcast_to(given, count)))

    @property
    def scale(self) -> float:
        """Length over which contact changes: the smallest radius."""
        return float(np.min(self.radii))

    def radius_of(self, which: Index) -> Array:
        """(...) radii of spheres by their numbers."""
        return np.asarray(self.radii)[which]

    def angle_of(self, which: Index) -> Array:
        """(...) contact angles in degrees of spheres by their numbers."""
        return np.asarray(self.contact_angle)[which]

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        return cKDTree(np.asarray(self.centers))

    @cached_property
    def _sizes(self) -> list[tuple[float, Index, Any]]:
        """Each radius with the numbers of its spheres and their tree; none where radii are many."""
        from scipy.spatial import cKDTree

        radii = np.asarray(self.radii)
        sizes = np.unique(radii)
        if len(sizes) > FEW:
            return []
        groups = [np.flatnonzero(radii == r) for r in sizes]
        centers = np.asarray(self.centers)
        return [(float(r), g, cKDTree(centers[g])) for r, g in zip(sizes, groups, strict=True)]

    def nearest(self, points: Array) -> Nearest:
        """Gap and its derivatives, by a tree."""
        flat = points.reshape(-1, 3)
        centers, radii = np.asarray(self.centers), np.asarray(self.radii)
        if self._sizes:
            which: Index = np.zeros(len(flat), int)
            least = np.full(len(flat), np.inf)
            for radius, group, tree in self._sizes:
                distance, near = tree.query(flat)
                wins = distance - radius < least
                which = np.where(wins, group[near], which)
                least = np.where(wins, distance - radius, least)
        else:
            distance, which = self._tree.query(flat)
            which = self._smallest_gap(flat, distance, which, radii)
        which = which.reshape(points.shape[:-1])
        found = nearest_of_balls(points, centers[which], radii[which], which)
        return found if self.base is None else closer(found, plane_below(points, self.base))

    def _smallest_gap(self, flat: Array, distance: Array, which: Index, radii: Array) -> Index:
        """Among spheres of several sizes the nearest centre need not be the nearest surface."""
        reach = distance - radii[which] + radii.max()
        lists = self._tree.query_ball_point(flat, reach * (1 + 1e-12))
        lengths = np.array([len(each) for each in lists])
        candidates = np.concatenate([np.asarray(each, int) for each in lists])
        owner = np.repeat(np.arange(len(flat)), lengths)
        away = flat[owner] - np.asarray(self.centers)[candidates]
        gap = np.sqrt(np.einsum("ki,ki->k", away, away)) - radii[candidates]
        order = np.lexsort((candidates, gap, owner))
        first = np.searchsorted(owner[order], np.arange(len(flat)))
        return candidates[order][first]

    def center_of(self, which: Index) -> Array:
        """(..., 3) centres of spheres by their numbers."""
        return np.asarray(self.centers)[which]

    def within(self, reach: float) -> Index:
        """Numbers of the spheres whose centres lie within a distance of the z axis."""
        centers = np.asarray(self.centers)
        return np.flatnonzero(np.hypot(centers[:, 0], centers[:, 1]) <= reach)


FEW = 8
"""Radii of a list of spheres up to which each has a tree of its own."""


def plane_below(points: Array, height: float) -> Nearest:
    """The plane z = height as nearest surface."""
    up = np.broadcast_to([0.0, 0.0, 1.0], points.shape)
    shape = points.shape[:-1]
    return Nearest.computed(points[..., 2] - height, up, np.zeros(shape), np.full(shape, -1))
