"""What a droplet's outline tells: contact angle, volume, tension, with standard errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import checked
from ..arrays import Array, Mask
from ..checks import array, items, words
from ..driver.solution import Solution
from ..driver.solve import solve
from ..errors import SceneError
from ..fields import as_acceleration
from ..initial.liquid import Liquid
from ..lazy import part
from ..overview import Overview, Told
from ..problems.droplet import sessile_droplet
from ..problems.scene import Scene
from ..quantities import DIMENSIONLESS, SI, Quantity, has_units, unit_of
from ..solids import Plane
from ..solids.disc import Disc
from .axisymmetric import Fit, Profile, nearest_profile
from .cut import APEX, BASE, MIDDLE, RADIUS, WEIGHT, cut
from .local_angles import side_angles
from .outline import Camera, Outline

NAMES = ("contact_angle", "volume", "surface_tension", "base")
"""What can be sought; angle and volume are two numbers of every profile that is cut by its base."""
FEWEST = 12
"""Points at least, three for each number of a profile."""
LEANS = 4.0
"""Difference of the angles left and right, over its standard error, from which a droplet leans."""
BARELY = 1.0
"""Degrees of the mouth of a needle that water wets, and short of its side: its rim holds the line
at any angle between."""
LEANS_AT_LEAST = 1.0
"""Degrees of that difference at least: cubics are wrong by a tenth of them."""
WEIGHTS = (1.0, 0.25, 4.0)
"""Factors of the weight over the tension from which a tension is sought."""


@dataclass(frozen=True, eq=False, repr=False)
class ProfileFit(Told):
    """A profile through the points of an outline.

    Attributes
    ----------
    values : by name: ``contact_angle`` (degrees), ``volume``, ``contact_radius``, ``height``,
        and where they were sought ``surface_tension`` and ``base``, the
        height of the base line over the one given; ``angle_left`` and ``angle_right`` by local
        fits, of a droplet under a lateral force ``angle_front`` and ``angle_rear`` instead and none
        of the others.
    standard_errors : of the values, by the same names.
    residuals : (n,) distances of the points from the profile, positive outside.
    points : (n, 2) the points; used : (n,) those that counted, without dust.
    curve : (k, 2) the profile from the contact line left over the apex to the one right.
    liquid : with the tension that was found; gravity : (3,) acceleration.
    units : of all numbers, "SI" or "dimensionless"; warnings : what the user should know.
    """

    values: Mapping[str, float]
    standard_errors: Mapping[str, float]
    residuals: Array
    points: Array
    used: Mask
    curve: Array
    liquid: Liquid
    gravity: tuple[float, float, float]
    units: str
    warnings: tuple[str, ...] = ()
    camera: Camera | None = field(default=None, repr=False)

    @cached_property
    def scene(self) -> Scene:
        """The droplet with these values, to be solved, changed or put on other solids: on a plane
        with its contact angle, or hanging from a needle whose rim holds it.

        Raises
        ------
        SceneError
            Of a droplet under a lateral force, whose volume one outline does not tell.
        """
        if "volume" not in self.values:
            raise SceneError("fit: one outline of a leaning droplet does not tell its volume")
        hangs = float(np.mean(self.curve[:, 1])) < 0.0
        way = -1.0 if hangs else 1.0  # the frame's z points from the base into the liquid
        volume = self.values["volume"]
        held = Disc(BARELY, radius=self.values["contact_radius"], edge=180.0 - 2.0 * BARELY)
        return sessile_droplet(
            held if hangs else Plane(contact_angle=self.values["contact_angle"]),
            volume=Quantity(volume, "volume") if self.units == SI else volume,
            liquid=self.liquid,
            gravity=[0.0, 0.0, way * self.gravity[2]],
        )

    @cached_property
    def solution(self) -> Solution:
        """That droplet in equilibrium, solved when it is first asked for.

        Raises
        ------
        SceneError, SolveError
        """
        return solve(self.scene)

    def overview(self) -> Overview:
        """The values with their standard errors and units."""
        rows = [(name, self.told(name)) for name in self.values]
        rms = float(np.sqrt(np.mean(self.residuals[self.used] ** 2)))
        unit = unit_of("height", self.units)
        told = f"{int(self.used.sum())} of {len(self.points)}, {rms:.3g} {unit} off".rstrip()
        rows += [("points", told), *(("warning", text) for text in self.warnings)]
        return Overview(f"profile through an outline, {self.units}", rows)

    def record(self) -> dict[str, Any]:
        """Values, standard errors, units and warnings as plain data, for a file."""
        return {
            "units": self.units,
            "values": {name: float(value) for name, value in self.values.items()},
            "standard_errors": {name: float(v) for name, v in self.standard_errors.items()},
            "unit_of": {n: unit_of(n, self.units) or DIMENSIONLESS for n in self.values},
            "points": len(self.points),
            "points_used": int(self.used.sum()),
            "warnings": list(self.warnings),
        }

    def portrait(self) -> bytes | None:
        """The profile over its photograph (PNG)."""
        return part("view.portrait", "fit_portrait")(self)

    def told(self, name: str) -> str:
        """A value with its standard error and unit."""
        error = self.standard_errors[name]
        return f"{self.values[name]:.6g} +- {error:.2g} {unit_of(name, self.units)}".rstrip()


def _points(field: str, value: Any) -> Any:
    """(n, 2) finite numbers; those of a camera keep it."""
    array(field, value, shape=(None, 2))
    return value


@checked(
    points=_points,
    gravity=as_acceleration,
    fit=partial(items, each=words(*NAMES), least=1),
)
def fit_profile(
    points: ArrayLike,
    *,
    liquid: Liquid | None = None,
    gravity: float | Sequence[float] = 0.0,
    fit: Sequence[str] = ("contact_angle", "volume"),
) -> ProfileFit:
    """The profile of Young and Laplace through the outline of a droplet.

    Parameters
    ----------
    points : (n, 2) points of the outline: x along the base line, z up from it, of a hanging droplet
        negative. Those of :func:`silhouette` know how well their base line is known.
    liquid : its density over that of its surroundings, and its tension, where that is not sought.
    gravity : acceleration along -z, or the vector; x is the direction along the base line.
    fit : what is sought: "contact_angle" and "volume", which every profile has; "surface_tension"
        too, of a droplet that its weight deforms; "base", a shift of the base line, where points
        beyond it show the droplet's mirror image.

    Returns
    -------
    ProfileFit
        Values with standard errors, residuals, and the solution of a droplet like that. Under a
        lateral force angles at the front and the rear, by local fits.

    Raises
    ------
    SceneError
        Too few points; a tension without weight; a base that no points show.

    Notes
    -----
    Along the arc from the apex ``r' = cos(phi)``, ``z' = -sin(phi)``, ``phi' = 2 / R + rho g (z_0 -
    z) / gamma - sin(phi) / r`` (Bashforth and Adams 1883; Rotenberg, Boruvka and Neumann 1983).
    Place of the apex and its radius R are sought, and the weight over the tension if it is.
    Standard errors are those of least squares, with that of the base line where it is known.
    """
    liquid = Liquid() if liquid is None else liquid
    outline = np.asarray(points, float)
    camera = points.camera if isinstance(points, Outline) else None
    in_si = has_units([liquid, gravity]) or (camera is not None and camera.units == SI)
    pull = np.array(gravity, float)
    made = partial(
        ProfileFit, points=outline, liquid=liquid, camera=camera,
        units=SI if in_si else DIMENSIONLESS,
        gravity=(float(pull[0]), float(pull[1]), float(pull[2])),
    )  # fmt: skip
    hangs = float(np.median(outline[:, 1])) < 0.0 if camera is None else camera.hangs
    way = -1.0 if hangs else 1.0
    x, y = outline[:, 0], way * outline[:, 1]
    above = y > 0.0
    if int(above.sum()) < FEWEST:
        raise SceneError(
            f"points: {int(above.sum())} of them lie on one side of the base line z = 0, {FEWEST} "
            "are needed"
        )
    left, right = side_angles(x[above], y[above])
    if abs(pull[0]) > LATERAL * float(np.linalg.norm(pull)):
        front, rear = (right, left) if pull[0] > 0.0 else (left, right)
        return made(
            values={"angle_front": front.degrees, "angle_rear": rear.degrees},
            standard_errors={"angle_front": front.error, "angle_rear": rear.error},
            residuals=np.zeros(len(x)), used=above, curve=np.zeros((0, 2)),
            warnings=("a lateral force: angles are those of local fits, there is no volume",),
        )  # fmt: skip
    found, tension = _nearest(x, y, liquid, -way * float(pull[2]), fit)
    piece = cut(found, tension)
    values = piece.values | {"angle_left": left.degrees, "angle_right": right.degrees}
    errors = piece.errors(found, camera.base_error if camera is not None else 0.0)
    errors |= {"angle_left": left.error, "angle_right": right.error}
    return made(
        values=values, standard_errors=errors, residuals=found.off, used=found.used,
        curve=piece.curve * [1.0, way], liquid=replace(liquid, surface_tension=tension),
        warnings=_warnings(values, errors),
    )  # fmt: skip


LATERAL = 1e-9
"""Part of gravity along the base line up to which it is rounding."""


def _nearest(
    x: Array, y: Array, liquid: Liquid, down: float, names: Sequence[str]
) -> tuple[Fit, float]:
    """The nearest profile, and the tension that belongs to it."""
    free = [MIDDLE, APEX, RADIUS]
    mirrored = y < 0.0
    counts = np.ones(len(x), bool) if "base" in names else ~mirrored
    if "base" in names:
        if int(mirrored.sum()) < FEWEST:
            raise SceneError(
                'fit: "base" is not in the points: none of them lies beyond the base line, where '
                "the droplet's mirror image would be; leave it out"
            )
        free.append(BASE)
    weight = liquid.density * down / liquid.surface_tension
    factors: tuple[float, ...] = (1.0,)
    if "surface_tension" in names:
        if weight == 0.0:
            raise SceneError(
                'fit: "surface_tension" needs a weight, which deforms the droplet: give the '
                "density of the liquid and gravity"
            )
        free.append(WEIGHT)
        factors = WEIGHTS
    x, y, mirrored = x[counts], y[counts], mirrored[counts]
    first = _start(x[~mirrored], y[~mirrored])
    best = _best([replace(first, weight=factor * weight) for factor in factors],
                 x, y, mirrored, tuple(sorted(free)))  # fmt: skip
    off, used = np.zeros(len(counts)), np.zeros(len(counts), bool)
    off[counts], used[counts] = best.off, best.used
    tension = float(liquid.surface_tension) * weight / best.profile.weight if weight else float(
        liquid.surface_tension
    )  # fmt: skip
    return replace(best, off=off, used=used), tension


def _best(
    starts: Sequence[Profile], x: Array, y: Array, mirrored: Mask, free: tuple[int, ...]
) -> Fit:
    """The nearest profile from the first start that leads to one that is near, or from any."""
    fits: list[tuple[float, Fit]] = []
    for k, start in enumerate(starts):
        try:
            fit = nearest_profile(start, x, y, mirrored, free)
        except SceneError:
            if not fits and k == len(starts) - 1:
                raise
            continue
        off = float(np.sqrt(np.mean(fit.off[fit.used] ** 2))) / fit.profile.radius
        fits.append((off, fit))
        if off < NEAR:
            break
    return min(fits, key=lambda each: each[0])[1]


NEAR = 1e-2
"""Distance of points from a profile (root mean square), over its radius, up to which no other start
is tried: noise of half a pixel at 50 pixels, while wrong branches are off by a tenth."""


def _start(x: Array, y: Array) -> Profile:
    """The circle through the upper part of an outline."""
    top = float(y.max())
    upper = y > top - UPPER * max(top - float(y.min()), 1e-300)
    if int(upper.sum()) < FEWEST:
        upper = np.argsort(-y, kind="stable") < FEWEST
    u, v = x[upper], y[upper]
    size = float(np.ptp(u)) or 1.0
    middle, up = float(u.mean()), float(v.mean())
    a = np.stack([(u - middle) / size, (v - up) / size, np.ones(len(u))], axis=1)
    (p, q, s), *_ = np.linalg.lstsq(a, a[:, 0] ** 2 + a[:, 1] ** 2, rcond=None)
    radius = size * float(np.sqrt(max(s + 0.25 * (p * p + q * q), 1e-6)))
    return Profile(middle + 0.5 * size * float(p), top, radius, 0.0)


UPPER = 0.4
"""Part of an outline's height through which the first circle is laid."""


def _warnings(values: Mapping[str, float], errors: Mapping[str, float]) -> tuple[str, ...]:
    """Of a droplet that leans though nothing pulls it sideways."""
    apart = abs(values["angle_left"] - values["angle_right"])
    error = float(np.hypot(errors["angle_left"], errors["angle_right"]))
    if not apart > max(LEANS * error, LEANS_AT_LEAST):
        return ()
    return (
        f"the angles left and right differ by {apart:.2g} degrees: the droplet leans, is not round "
        "or the base line is tilted against it; contact_angle is that of the axisymmetric profile",
    )
