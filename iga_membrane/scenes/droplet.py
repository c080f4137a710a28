"""A droplet at rest on a substrate (paper section 6.1, figure 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import choice, number, vector
from ..errors import SceneError
from ..solids import Plane, Sphere, SphereLattice, Spheres
from ..splines import Grading, points_of
from ..surface.ring import axisymmetric, drop_space
from ..surface.supports import Fixed, Sector, Sliding, Support
from ..surface.surface import Surface
from ..terms import (
    Centroid,
    Contact,
    Gravity,
    LineTerm,
    PlaneContactLine,
    Scale,
    SphereContactLine,
    SurfaceTension,
    Term,
    Volume,
)
from .asperities import estimated_foot, smallest_model, whole_skin
from .liquid import MODELS, Discretization, Liquid, Mesh, Model
from .scene import FreeEdge, Ramp, Scene
from .start import STEEPEST, Pancake, drop_on_sphere, least_energy_pancake

HOLDS = ("none", "x", "xy", "xyz")


def sessile_droplet(
    substrate: Plane | Sphere | SphereLattice | Spheres,
    *,
    volume: float,
    liquid: Liquid | None = None,
    gravity: float | Sequence[float] = 0.0,
    discretization: Discretization | None = None,
    hold: str = "none",
    start: Surface | str | None = None,
    penalty: float | None = None,
    penetration_tolerance: float = 1e-2,
) -> Scene:
    """Droplet of a volume on a plane, on top of a sphere, or on asperities.

    Below 180 degrees it has a contact line; at 180 its foot is a contact area and the whole skin is
    one closed membrane. On asperities only 180 degrees are available yet.

    Parameters
    ----------
    substrate : the solid with its contact angle.
    volume : of liquid, > 0.
    liquid : surface tension and density; both 1 by default.
    gravity : acceleration >= 0 along -z, or a vector.
    discretization : space, degree, elements, model.
    hold : "none", or the axes (of the plane's frame) along which a uniform body force holds the
        centroid: "x", "xy", "xyz".
    start : a surface of the same space to start from, in world coordinates; at 180 degrees also
        "flat", the drop on a plane through the tops, "touching" or "above", a sphere.
    penalty : None for exact contact, else the paper's penalty (eq. 24): traction over depth in
        units of tension over squared length, length that of a ball of the volume.
    penetration_tolerance : depth over the radius of the smallest sphere (plane: over the length)
        that exact contact leaves at most and beyond which a state is no success.

    Raises
    ------
    SceneError
        A value out of its range; a contact angle below 180 degrees on asperities (not available
        yet); a model with a mirror plane that gravity or the substrate does not have; a start below
        the substrate.
    """
    liquid = liquid or Liquid()
    volume = number("liquid.volume", volume, above=0.0)
    choice("droplet.hold", hold, HOLDS)
    acceleration = _acceleration(gravity)
    origin, axes = _frame(substrate)
    length = (3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)
    x, y, z = (tuple(float(a) for a in row) for row in axes)
    scale = Scale(length, liquid.surface_tension, origin, (x, y, z))
    with np.errstate(over="ignore", invalid="ignore"):
        bond = liquid.density * (acceleration @ axes) * length**2 / liquid.surface_tension
    if not (np.isfinite(bond).all() and 0.0 < length**3 < np.inf):
        raise SceneError(
            f"liquid.volume = {volume:g}, density, gravity, surface_tension: their Bond number or "
            "length leaves the range of floating point numbers; choose other units"
        )
    asked = discretization or Discretization()
    terms: list[Term] = [SurfaceTension(liquid.surface_tension), Volume(volume)]
    if bond.any():
        gx, gy, gz = (float(g) for g in acceleration)
        terms.append(Gravity(liquid.density, (gx, gy, gz)))
    law = Contact(
        substrate,
        None if penalty is None else penalty * liquid.surface_tension / length**2,
        penetration_tolerance,
    )
    parts = _Parts(substrate, asked, scale, bond, start, liquid, law)
    built = _built(parts)
    sector = built.sector
    if isinstance(substrate, Plane):
        terms += [Centroid(axis) for axis in {"full": "xy", "half": "x"}.get(sector.model, "")]
    pull = float(np.linalg.norm(acceleration))

    def at(size: float) -> Scene:
        return sessile_droplet(
            substrate,
            volume=volume,
            liquid=liquid,
            gravity=[size / pull * g for g in acceleration],
            discretization=replace(asked, model=sector.model),
            hold=hold,
        )

    described = _describe(substrate, volume, liquid, acceleration, hold)
    scene = Scene(
        built.surface,
        [*terms, *built.terms],
        [*built.supports, sector],
        scale=scale,
        grading=built.grading,
        directions=built.directions,
        ramp=Ramp("gravity.acceleration", (0.0, pull), at)
        if bond.any() and isinstance(substrate, (Plane, Sphere)) and not built.tangent
        else None,
        substrate=substrate,
        hold="" if hold == "none" else hold,
        kind="sessile_droplet",
        description=described | {"discretization": built.mesh.described(sector.model)},
        warnings=_hints(substrate, bond, sector),
    )
    if not built.tangent:
        return scene

    def edge_at(radius: float) -> Scene:
        return replace(scene, surface=_with_rim(built.surface, radius, scale))

    def below(angle: float) -> Scene:
        assert isinstance(substrate, Plane)
        return sessile_droplet(
            replace(substrate, contact_angle=angle),
            volume=volume,
            liquid=liquid,
            gravity=[float(g) for g in acceleration],
            discretization=replace(asked, model=sector.model),
        )

    return replace(scene, free_edge=FreeEdge(edge_at, _rim_radius, below))


@dataclass(frozen=True, eq=False)
class _Parts:
    """What both kinds of foot are built from."""

    substrate: Plane | Sphere | SphereLattice | Spheres
    asked: Discretization
    scale: Scale
    bond: Array
    start: Surface | str | None
    liquid: Liquid
    law: Contact

    @property
    def down(self) -> float:
        """Bond number of gravity's part towards the substrate."""
        return max(0.0, -float(self.bond[2]))


@dataclass(frozen=True, eq=False)
class _Built:
    """Start, support and price of a foot."""

    surface: Surface
    sector: Sector
    mesh: Mesh
    terms: Sequence[Term]
    supports: Sequence[Support] = ()
    grading: Grading = field(default_factory=Grading)
    directions: Array | None = None
    tangent: bool = False


def _built(parts: _Parts) -> _Built:
    """The kind of foot that a substrate and its contact angle make."""
    if not isinstance(parts.substrate, (Plane, Sphere)):
        return _on_an_area(parts)
    if parts.substrate.contact_angle < 180.0:
        return _on_a_line(parts)
    exact = parts.law.penalty is None and parts.start is None
    return _on_the_plane(parts) if isinstance(parts.substrate, Plane) and exact \
        else _on_an_area(parts)  # fmt: skip


def _on_a_line(parts: _Parts) -> _Built:
    """The liquid-gas surface alone, its edge a contact line on a plane or a sphere."""
    substrate, mesh, scale = parts.substrate, parts.asked.mesh(), parts.scale
    assert isinstance(substrate, (Plane, Sphere))
    sector = _sector(mesh, parts.bond)
    foot = _foot(substrate, parts.liquid, scale.length, parts.down)
    bond = abs(float(parts.bond[2]))
    grading = _grading(substrate.contact_angle, bond, foot.pancake.length)
    if parts.law.penalty is not None:
        raise SceneError(
            'solver.contact = "penalty": not available yet with a contact line, only at 180 degrees'
        )
    if isinstance(parts.start, str):
        raise SceneError(f'start = "{parts.start}": only at 180 degrees; leave it out here')
    if parts.start is None:
        start = _start(foot, mesh, grading, scale)
    else:
        start = parts.start
        _check_start(start, mesh, substrate)
    return _Built(start, sector, mesh, [foot.line], [foot.support], grading)


def _on_an_area(parts: _Parts) -> _Built:
    """The whole skin, lying on the solid with its foot."""
    substrate, scale = parts.substrate, parts.scale
    for angle in np.atleast_1d(np.asarray(substrate.contact_angle)):
        if angle < 180.0:
            raise SceneError(
                f"substrate.contact_angle = {angle:g}: not available yet on asperities; 180 is"
            )
    if parts.asked.space != "bspline":
        raise SceneError(
            f'discretization.space = "{parts.asked.space}": a contact area needs "bspline"'
        )
    x, y, _ = (float(b) for b in parts.bond)
    tiny = 1e-14 * float(np.abs(parts.bond).max())
    local = scale.local_solid(substrate)
    lateral = (x if abs(x) > tiny else 0.0, y if abs(y) > tiny else 0.0)
    smallest = smallest_model(local, 1.5, lateral)
    model = parts.asked.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": gravity or the substrate has no such mirror '
            f'planes; "{smallest}" is the smallest model here'
        )
    unit, mesh = 4.0 * np.pi / 3.0, parts.asked.mesh(degree=2, elements=-1)
    length, elements = min(local.scale, COARSEST), max(mesh.elements, 0)
    skin = whole_skin(parts.down, unit, length, mesh.degree, elements, parts.start)
    mesh = replace(mesh, elements=skin.space.bases[0].elements // 2)
    surface = Surface(skin.space, scale.to_world(skin.points))
    if isinstance(parts.start, Surface):
        surface = surface.moved(parts.start.points)
    return _Built(surface, Sector(model), mesh, [parts.law], directions=skin.directions)


COARSEST = 0.2
"""Length over that of the drop which the mesh resolves on large spheres too."""


FIRST = 0.75


def _on_the_plane(parts: _Parts) -> _Built:
    """A flat foot at 180 degrees: the liquid-gas surface alone, which leaves the plane
    tangentially where its edge is found to be."""
    gamma, scale, bond = parts.liquid.surface_tension, parts.scale, parts.down
    mesh, sector = parts.asked.mesh(), _sector(parts.asked.mesh(), parts.bond)
    if not bond > 0 or parts.bond[:2].any():
        raise SceneError(
            "substrate.contact_angle = 180, gravity: on a plane only gravity straight towards it "
            "holds a droplet at 180 degrees; give such gravity or an angle < 180"
        )
    foot = _foot(Plane(STEEPEST), parts.liquid, scale.length, bond)
    length = foot.pancake.length
    rim = estimated_foot(least_energy_pancake(180.0, bond, BALL, steepest=180.0), bond, BALL)
    # the foot bends over its own radius or the capillary length, whichever is shorter
    first = min(3.5 / (np.sqrt(bond) * length), (4.0 * rim / length) ** 0.75)
    grading = Grading(float(min(1.0, first)))
    start = _start(foot, mesh, grading, scale)
    line = PlaneContactLine(gamma, 180.0)
    return _Built(start, sector, mesh, [line], [Fixed("xi2=0")], grading, tangent=True)


BALL = 4.0 * np.pi / 3.0


def _rim_radius(surface: Surface) -> float:
    """Mean radius of the edge xi2 = 0."""
    ring = surface.space.bases[0]
    middle = ring.breaks[:-1] + 0.5 * ring.sizes
    xi = np.column_stack([np.concatenate([ring.breaks[:-1], middle]), np.zeros(2 * len(middle))])
    return float(np.linalg.norm(surface.at(xi, 1).position[:, :2], axis=1).mean())


def _with_rim(surface: Surface, radius: float, scale: Scale) -> Surface:
    """The same surface with another radius of its edge, the change fading towards the pole."""
    local = surface.moved(scale.to_local(surface.points))
    fading = points_of(surface.space, 1.0 - surface.space.abscissae[..., 1:2])
    points = local.points.copy()
    points[:, :2] *= 1.0 + (radius / _rim_radius(local) - 1.0) * fading
    return surface.moved(scale.to_world(points))


def _acceleration(gravity: Any) -> Array:
    if isinstance(gravity, (str, bool)) or np.ndim(gravity) == 0:
        return np.array([0.0, 0.0, -number("gravity.acceleration", gravity, least=0.0)])
    return np.array(vector("gravity", gravity))


def _sector(mesh: Mesh, bond: Array) -> Sector:
    """The model asked for, or the smallest that gravity's direction allows."""
    tiny = 1e-14 * float(np.abs(bond).max())
    along_x, along_y = (abs(float(b)) > tiny for b in bond[:2])
    smallest: Model = "full" if along_y else "half" if along_x else "eighth"
    model = mesh.model or smallest
    if MODELS.index(model) > MODELS.index(smallest):
        raise SceneError(
            f'discretization.model = "{model}": gravity leans to '
            f"{'y' if along_y else 'x'} of the substrate, so the droplet has no such mirror "
            f'planes; "{smallest}" is the smallest model here'
        )
    return Sector(model)


@dataclass(frozen=True, eq=False)
class _Foot:
    """How a drop stands on its substrate.

    Attributes
    ----------
    pancake : free surface of the start (dimensionless); lift : height of its rim.
    line : what the contact line costs; support : on what it slides.
    """

    pancake: Pancake
    lift: float
    line: LineTerm
    support: Sliding


def _frame(
    substrate: Plane | Sphere | SphereLattice | Spheres,
) -> tuple[tuple[float, float, float], Array]:
    """Origin and axes of the scene: on the plane, or at the top of the sphere."""
    if isinstance(substrate, Plane):
        return substrate.point, substrate.axes()
    if not isinstance(substrate, Sphere):
        return (0.0, 0.0, 0.0), np.eye(3)
    x, y, z = substrate.center
    return (x, y, z + substrate.radius), np.eye(3)


def _foot(substrate: Plane | Sphere, liquid: Liquid, length: float, bond: float) -> _Foot:
    gamma, angle, unit = liquid.surface_tension, substrate.contact_angle, 4.0 * np.pi / 3.0
    if isinstance(substrate, Plane):
        pancake = least_energy_pancake(angle, bond, unit)
        return _Foot(pancake, 0.0, PlaneContactLine(gamma, angle), Sliding("xi2=0"))
    radius = substrate.radius / length
    polar, cap = drop_on_sphere(angle, radius, unit)
    line = SphereContactLine(gamma, substrate)
    lift = -2.0 * radius * np.sin(0.5 * polar) ** 2
    return _Foot(cap, float(lift), line, Sliding("xi2=0", substrate))


def _grading(contact_angle: float, bond: float, length: float) -> Grading:
    """Shorter steps near the rim: for the capillary length, and for a foot nearly tangent to the
    substrate. The constants balance the errors of height and rim over the whole family."""
    if bond == 0:
        return Grading()  # a circular arc has no layer
    first = min(1.0, 3.5 / (np.sqrt(bond) * length))
    if contact_angle > 90:
        first = min(first, max(np.sin(np.radians(contact_angle)), 4e-4) ** 0.5)
    return Grading(float(first))


def _start(foot: _Foot, mesh: Mesh, grading: Grading, scale: Scale) -> Surface:
    pancake = foot.pancake

    def profile(t: Array) -> tuple[Array, Array, Array]:
        r, z = pancake(grading.fraction(t))
        return r, z, -pancake.length * grading.slope(t)

    space = drop_space(mesh.space, mesh.degree, mesh.elements, angle=pancake.turn)
    local = axisymmetric(space, profile)
    return local.moved(scale.to_world(local.points + [0.0, 0.0, foot.lift]))


def _check_start(start: Surface, mesh: Mesh, substrate: Plane | Sphere) -> None:
    asked = drop_space(mesh.space, mesh.degree, mesh.elements)
    given = start.space
    if (given.net_shape, given.degree, given.pole) != (asked.net_shape, asked.degree, asked.pole):
        raise SceneError(
            f"start: control net {given.net_shape} of degree {given.degree} given, "
            f"{asked.net_shape} of degree {asked.degree} expected from the discretization"
        )
    table = start.space.table(2)
    depth = -float(substrate.gap(start.on(table).position).min())
    if depth > 1e-6 * start.size:
        raise SceneError(
            f"start: the surface lies up to {depth:g} below the substrate (solid 0); lift it by at "
            f"least {depth:g} along the solid's normal"
        )


def _hints(
    substrate: Plane | Sphere | SphereLattice | Spheres, bond: Array, sector: Sector
) -> tuple[str, ...]:
    texts = []
    angle = float(np.min(substrate.contact_angle))
    if angle <= np.pi:
        texts.append(
            f"substrate.contact_angle = {angle:g}: degrees? An angle below pi degrees is rare; "
            "angles are in degrees through the liquid"
        )
    if isinstance(substrate, Sphere) and sector.model in ("quarter", "eighth"):
        texts.append(
            "a drop on a smooth sphere "
            + ("slides off it" if bond.any() else "rolls on it freely")
            + f": that motion is not in the {sector.model} model, whose stability is judged"
        )
    return tuple(texts)


def _describe(
    substrate: Plane | Sphere | SphereLattice | Spheres,
    volume: float,
    liquid: Liquid,
    acceleration: Array,
    hold: str,
) -> dict[str, Any]:
    """The scene by the names of the scene file."""
    size = float(np.linalg.norm(acceleration))
    direction = acceleration / size if size else np.array([0.0, 0.0, -1.0])
    return {
        "scene": "sessile_droplet",
        "liquid": {
            "surface_tension": liquid.surface_tension,
            "density": liquid.density,
            "volume": volume,
        },
        "gravity": {"acceleration": size, "direction": [float(d) for d in direction]},
        "substrate": _describe_substrate(substrate),
        "droplet": {"hold": hold},
    }


def _describe_substrate(substrate: Plane | Sphere | SphereLattice | Spheres) -> dict[str, Any]:
    match substrate:
        case Sphere():
            size: dict[str, Any] = {
                "kind": "sphere",
                "contact_angle": substrate.contact_angle,
                "radius": substrate.radius,
            }
            top = substrate.center == (0.0, 0.0, -substrate.radius)
            return size if top else size | {"center": list(substrate.center)}
        case Plane():
            plane: dict[str, Any] = {"kind": "plane", "contact_angle": substrate.contact_angle}
            if substrate == Plane(substrate.contact_angle):
                return plane
            return plane | {"point": list(substrate.point), "normal": list(substrate.normal)}
        case SphereLattice():
            lattice = {
                "kind": "sphere_lattice",
                "contact_angle": substrate.contact_angle,
                "radius": substrate.radius,
                "spacing": substrate.spacing,
                "arrangement": substrate.arrangement,
                "offset": list(substrate.offset),
            }
            return lattice if substrate.base is None else lattice | {"base": substrate.base}
        case Spheres():
            spheres = {
                "kind": "spheres",
                "contact_angle": np.asarray(substrate.contact_angle).tolist(),
                "centers": np.asarray(substrate.centers).tolist(),
                "radii": np.asarray(substrate.radii).tolist(),
            }
            return spheres if substrate.base is None else spheres | {"base": substrate.base}
