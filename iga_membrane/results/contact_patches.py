"""What the solids under a membrane carry: forces, wet areas and angles, asperity by asperity."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..arrays import Array, Index, Mask
from ..assembly.lagrangian import Assembly
from ..contact.subgrid import PointSupports
from ..contact.unfitted import Trim
from ..dofs.symmetry import in_sector, mirrors
from ..problems.scene import Scene
from ..surface.surface import Surface
from ..terms import BodyDensity
from ..terms.trimmed import CapDensity, line_density, wet_integral
from ..terms.variations import element_points


@dataclass(frozen=True, eq=False)
class Footing:
    """Contact of the whole body, in the scene's scale.

    Attributes
    ----------
    which : (k,) numbers of the wet spheres, -1 for a plane.
    centers : (k, 3) of the spheres.
    forces : (k, 3) of the membrane on them.
    radii : (k,)
    projected, areas : (k,) area of each wet spot, projected along its force and on the sphere.
    polar, heights : (k,) mean polar angle (radians) from the sphere's axis towards the liquid, its
        top on asperities, and height, of its edge.
    angles : (k,) mean contact angle in degrees.
    """

    which: Index
    centers: Array
    forces: Array
    radii: Array
    projected: Array
    areas: Array
    polar: Array
    heights: Array
    angles: Array

    @property
    def total(self) -> Array:
        """(3,) force on all of them."""
        return np.asarray(self.forces.sum(axis=0))

    def part(self, some: Mask) -> Footing:
        """Some of the solids."""
        return Footing(*(getattr(self, each.name)[some] for each in fields(self)))


def footing(scene: Scene, assembly: Assembly, surface: Surface, body: BodyDensity) -> Footing:
    """Contact with the substrate, solid by solid; particles left out."""
    found = contacts(scene, assembly, surface, body)
    if assembly.trim is None:
        return found
    return found.part(assembly.trim.term.particle(found.which) < 0)


def contacts(scene: Scene, assembly: Assembly, surface: Surface, body: BodyDensity) -> Footing:
    """Contact solid by solid, particles too, the mirror images of a sector unfolded.

    Parameters
    ----------
    body : body density of the Lagrangian, so minus the pressure.
    """
    if assembly.trim is not None:
        return _by_lines(scene, assembly, surface, body)
    return _by_tractions(scene, assembly, surface, body)


def _by_lines(scene: Scene, assembly: Assembly, surface: Surface, body: BodyDensity) -> Footing:
    """From the contact lines on trimmed spheres.

    Notes
    -----
    The force on a sphere is minus the energy's derivative by its place, ``oint q do / |g_h|`` along
    its line (:mod:`iga_membrane.terms.trimmed`) and ``int grad(Q) N_z dA`` over its wetted cap.
    """
    assert assembly.trim is not None
    spots = Spots(assembly.trim, surface, mirrors(scene.sector))
    line, cap = spots.line, spots.cap
    pull = line_density(line, assembly.tension, body)
    pieces = (pull * (line.table.weights / np.abs(line.gh))[..., None]).sum(axis=1)
    ex, ey, ez = body.gradient

    pieces[:, 2] += cap(lambda x, n, which: n[..., 2] * (
        body.constant + ex * x[..., 0] + ey * x[..., 1] + ez * x[..., 2]
    ))  # fmt: skip
    if ex or ey:
        level = cap(lambda x, n, which: x[..., 2] * n[..., 2])
        pieces[:, :2] += level[:, None] * [ex, ey]
    projected = cap(lambda x, n, which: (n * spots.term.axis(which)).sum(axis=-1))
    areas = cap(lambda x, n, which: np.ones(which.shape))
    arc = np.linalg.norm(line.tangent, axis=-1) * line.table.weights
    axis = spots.term.axis(line.at.which)
    along = np.einsum("kqi,kqi->kq", line.at.normal, axis)
    polar = np.arctan2(np.linalg.norm(np.cross(line.at.normal, axis), axis=-1), along)
    cosine = np.einsum("kqi,kqi->kq", line.at.normal, line.m) / line.area
    angle = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    means = [arc.sum(axis=1), *((v * arc).sum(axis=1) for v in (polar, line.x[..., 2], angle))]
    length, *sums = (spots.total(mean) for mean in means)
    polar, heights, angles = (value / length for value in sums)
    which, solid = spots.which, spots.term.solid
    return Footing(
        which,
        solid.center_of(which),
        spots.vectors(pieces),
        solid.radius_of(which),
        spots.total(projected),
        spots.total(areas),
        polar,
        heights,
        angles,
    )


class Spots:
    """Wetted spots of a trimmed membrane, each inside its contact line, the mirror images of a
    sector unfolded.

    Attributes
    ----------
    line : the contact lines of one sector, in pieces; term : what they cost.
    which : (k,) numbers of the wet spheres.
    """

    def __init__(self, trim: Trim, surface: Surface, images: list[Array]) -> None:
        self.line, self.term = trim.on_line(surface.points), trim.term
        self._images = images
        first = self.line.x[:, 0]
        owner = np.concatenate([trim.solid.nearest(first @ m).which for m in images])
        self.which, self._place = np.unique(owner, return_inverse=True)

    def cap(self, density: CapDensity) -> Array:
        """(pieces,) integrals over the wetted surface of one sector."""
        return wet_integral(self.line, self.term, density)

    def total(self, values: Array) -> Array:
        """(k,) sums of pieces (pieces,) on each sphere."""
        tiled = np.tile(values, len(self._images))
        return np.bincount(self._place, tiled, len(self.which)).astype(float)

    def vectors(self, values: Array) -> Array:
        """(k, 3) sums of vectors (pieces, 3) on each sphere."""
        sums = np.zeros((len(self.which), 3))
        np.add.at(sums, self._place, np.concatenate([values @ m for m in self._images]))
        return sums


def _by_tractions(scene: Scene, assembly: Assembly, surface: Surface, body: BodyDensity) -> Footing:
    """From the tractions on spheres that the membrane follows.

    Notes
    -----
    A round spot whose edge the membrane leaves at ``psi = pi - theta`` carries
    ``pi a^2 p + 2 pi a gamma sin(phi - psi)``, ``a = r sin(phi)``; at 180 degrees its projected
    area is the force over ``p + 2 gamma / r``. That is far more accurate than counting points. On
    asperities that are no spheres every point's force counts over ``p`` and ``gamma`` times the sum
    of the surface's curvatures there.
    """
    contact = assembly.contact
    assert contact is not None
    touch = contact.touch(surface.points)
    wet = (touch.traction > 0) | (touch.pull > 0)
    x = (contact.table.values @ surface.points[contact.table.functions])[wet]
    push = -contact.push(touch)[wet]
    images = mirrors(scene.sector)
    places = np.concatenate([x @ m for m in images])
    pushes = np.concatenate([push @ m for m in images])
    owner = contact.solid.nearest(places).which
    which, inverse = np.unique(owner, return_inverse=True)
    forces = np.zeros((len(which), 3))
    np.add.at(forces, inverse, pushes)
    on_sphere = which >= 0
    centers, radii = np.zeros((len(which), 3)), np.full(len(which), np.inf)
    if on_sphere.any():
        centers[on_sphere] = contact.solid.center_of(which[on_sphere])
        radii[on_sphere] = contact.solid.radius_of(which[on_sphere])
    ball = on_sphere & np.isfinite(radii)
    size = np.linalg.norm(forces, axis=1)
    radius = np.where(ball, radii, 0.0)
    level = centers[:, 2] + radius
    pressure = -(body.constant + body.gradient[2] * level)
    psi = np.where(on_sphere, contact.leaving(np.maximum(which, 0), assembly.tension), 0.0)
    carried = np.where(forces[:, 2] > 0, -size, size) / (np.pi * assembly.tension)
    share = np.where(ball, _share(pressure / assembly.tension, radii, carried, psi), 0.0)
    projected = share * np.pi * radius**2
    # an interrupted solve may not know the pressure yet
    np.divide(size, pressure, out=projected, where=~ball & (pressure != 0.0))
    areas = np.where(ball, 2.0 * np.pi * radius**2 * (1.0 - np.sqrt(1.0 - share)), projected)
    if (on_sphere & ~ball).any():
        bent = 2.0 * touch.at.bend[wet]
        if touch.at.ridge is not None:
            bent += (touch.at.ridge[wet] ** 2).sum(axis=-1)
        load = assembly.tension * bent - (body.constant + x @ np.array(body.gradient))
        each = np.tile(np.linalg.norm(push, axis=-1) / load, len(images))
        areas = np.where(on_sphere & ~ball, np.bincount(inverse, each, len(which)), areas)
    polar = np.arcsin(np.sqrt(share))
    heights = centers[:, 2] + radius * np.cos(polar)
    angles = 180.0 - np.degrees(psi)
    return Footing(which, centers, forces, radii, projected, areas, polar, heights, angles)


def _share(pressure: Array, radii: Array, carried: Array, psi: Array) -> Array:
    """(k,) projected area of spots over that of their spheres, ``sin(phi)^2``, by what they carry
    over ``pi gamma``."""
    with np.errstate(invalid="ignore", divide="ignore"):
        half = 0.5 * pressure * radii
        # half (1 - cos 2 phi) + cos psi - cos(2 phi - psi) = carried / r
        size = np.hypot(half + np.cos(psi), np.sin(psi))
        turn = np.arctan2(np.sin(psi), half + np.cos(psi))
        level = (half + np.cos(psi) - carried / radii) / size
        twice = turn + np.arccos(np.clip(level, -1.0, 1.0))
    return np.asarray(np.clip(np.sin(0.5 * twice) ** 2, 0.0, 1.0))


def engulfed(scene: Scene, assembly: Assembly, surface: Surface) -> int:
    """How many spheres near the membrane have their centre inside the liquid; where contact lines
    are inside the membrane, of those that have none.

    Seen from its nearest point of the membrane, a centre outside the liquid lies on the side of the
    normal; for centres in the sector that point is there, too.
    """
    at = element_points(assembly.table, surface.points)
    trim, contact = assembly.trim, assembly.contact
    on = trim or contact
    assert on is not None
    beside = on.solid.nearest(at.x)
    behind = (beside.normal * at.c).sum(axis=-1) > 0.0
    order = np.lexsort((beside.gap.ravel(), beside.which.ravel()))
    which, first = np.unique(beside.which.ravel()[order], return_index=True)
    nearest = order[first]
    close = (which >= 0) & (beside.gap.ravel()[nearest] < 2.0 * on.length)
    if trim is not None:
        close &= ~np.isin(which, trim.on_line(surface.points).at.which)
    wrong = which[close][behind.ravel()[nearest[close]]]
    return _in_sector(scene, assembly, surface, wrong)


def touches_base(scene: Scene, assembly: Assembly, surface: Surface, feet: Footing) -> bool:
    """Whether a membrane on asperities has come down to the plane under them.

    Parameters
    ----------
    feet : what carries it. Where it passes through asperities, or meets them at one place each, it
        does not notice the plane, and its height counts.
    """
    substrate = scene.substrate
    base = None if substrate is None else getattr(scene.units.local_solid(substrate), "base", None)
    if base is None:
        return False
    x = assembly.table.values @ surface.points[assembly.table.functions]
    if assembly.trim is not None:
        x = x[assembly.trim.outside(surface.points).share > 0]
    elif not isinstance(assembly.contact, PointSupports):
        return bool((feet.which < 0).any())
    return bool((x[..., 2] <= base).any())


def unsupported(scene: Scene, assembly: Assembly, surface: Surface) -> int:
    """How many spheres of the sector that are no point supports a membrane on point supports has
    met."""
    contact = assembly.contact
    if not isinstance(contact, PointSupports):
        return 0
    x = assembly.table.values @ surface.points[assembly.table.functions]
    at = contact.solid.nearest(x)
    met = np.setdiff1d(at.which[at.gap < 0.0], contact.which)
    return _in_sector(scene, assembly, surface, met[met >= 0])


def _in_sector(scene: Scene, assembly: Assembly, surface: Surface, which: Index) -> int:
    """How many spheres have their centres in the sector that is computed."""
    on = assembly.trim or assembly.contact
    assert on is not None
    centers = np.asarray(on.solid.center_of(which)).reshape(-1, 3)
    return int(in_sector(surface.space, scene.sector, centers, 1e-9 * on.length).sum())
