"""Droplets with particles: all solids that the membrane meets, and a patch round a particle.

A droplet on a plane is a disc. The map ``zeta = (w - b) / (1 - b* w)`` of the unit disc, ``w`` the
conformal place on the droplet (1 on its contact line) and ``b`` that of a particle, keeps the line
a circle and makes the particle's another: rings of ``zeta`` fit both, and elements shrink towards
the particle by themselves.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..checks import record
from ..errors import SceneError
from ..solids import Sphere, SphereLattice, Spheres
from ..splines import ring_angles
from ..surface.closed import Meridian
from ..surface.reparametrize import interpolated
from ..surface.ring import drop_space, meridian_interpolation
from ..surface.surface import Surface
from .liquid import MODELS, Mesh, Model
from .start import Pancake

REACH = 2.0
"""Distance from the axis, over the droplet's length, within which asperities of a lattice count."""
FAR = 0.3
"""Gap between a particle and the start, over the droplet's length, that no meniscus spans."""
ROUND, ALONG = 48, 18
"""Elements round a particle, and from the droplet's line to the particle at least."""
ACROSS = 3.0
"""Elements at least across the radius of a particle that does not hold the patch's pole."""


def check_particles(particles: Sequence[Sphere]) -> tuple[Sphere, ...]:
    """Particles of a droplet, apart from each other.

    Raises
    ------
    SceneError
        Something else than spheres, an angle of 180 degrees, two that overlap.
    """
    for i, each in enumerate(particles):
        record(f"particle[{i}]", each, Sphere)
        if each.contact_angle == 180.0:
            raise SceneError(
                f"particle[{i}].contact_angle = 180: nothing holds such a particle to a droplet; "
                "give an angle below 180"
            )
        for j, other in enumerate(particles[:i]):
            away = float(np.linalg.norm(np.subtract(each.center, other.center)))
            if away < each.radius + other.radius:
                raise SceneError(
                    f"particle[{j}], particle[{i}]: their centres are {away:g} apart, less than "
                    f"the sum of their radii {each.radius + other.radius:g}: they overlap"
                )
    return tuple(particles)


def crowd(
    asperities: SphereLattice | Spheres | None, particles: Sequence[Sphere], length: float
) -> Spheres:
    """Asperities within reach of a droplet, then its particles, as one list."""
    centers = [np.array([each.center for each in particles]).reshape(-1, 3)]
    radii = [np.array([each.radius for each in particles])]
    angles = [np.array([each.contact_angle for each in particles])]
    if asperities is not None:
        if isinstance(asperities, SphereLattice):
            near = asperities.within(REACH * length)
            angle = np.full(len(near), asperities.contact_angle)
        else:
            near = np.arange(len(asperities.centers))
            angle = np.asarray(asperities.contact_angle)
        centers.insert(0, asperities.center_of(near))
        radii.insert(0, asperities.radius_of(near))
        angles.insert(0, angle)
    return Spheres(np.concatenate(angles), np.concatenate(centers), np.concatenate(radii))


def towards_liquid(start: Surface, particles: Sequence[Sphere], length: float) -> Array:
    """(n, 3) from each particle into the liquid: about against the normal where the start is
    nearest.

    Parameters
    ----------
    start : in the particles' coordinates; length : of the droplet.

    Raises
    ------
    SceneError
        If a particle is farther from the start than a meniscus reaches.
    """
    one, two = (np.linspace(b.breaks[0], b.breaks[-1], 161)[1:-1] for b in start.space.bases)
    k = start.at(np.stack(np.meshgrid(one, two, indexing="ij"), axis=-1), 1)
    x, normals = k.position.reshape(-1, 3), k.normal.reshape(-1, 3)
    axes = []
    for i, each in enumerate(particles):
        distance = np.linalg.norm(x - np.array(each.center), axis=1)
        nearest = int(distance.argmin())
        gap = float(distance[nearest]) - each.radius
        if gap > FAR * length:
            raise SceneError(
                f"particle[{i}].center = {list(each.center)}: {gap:g} away from the droplet's "
                "surface, farther than a meniscus reaches; move it to the surface"
            )
        # in a mirror plane of the particle's own the sample may lie on either side
        axis = np.where(np.abs(each.center) > 1e-9 * length, -normals[nearest], 0.0)
        axes.append(axis / np.linalg.norm(axis))
    return np.array(axes)


def mirrored_model(particles: Sequence[Sphere], smallest: Model) -> Model:
    """The smallest model whose mirror planes the particles have too, none smaller than another's.

    Mirror planes of the models: y = 0, then x = 0, then x = y.
    """
    rows = np.array([[*p.center, p.radius, p.contact_angle, p.density] for p in particles])
    scale = np.abs(rows).max(axis=0) + 1e-300

    def same(image: Array) -> bool:
        off = np.abs(rows[:, None] - image[None]) / scale
        return bool((off.max(axis=2).min(axis=1) <= 1e-9).all())

    images = (rows * [1, -1, 1, 1, 1, 1], rows * [-1, 1, 1, 1, 1, 1], rows[:, [1, 0, 2, 3, 4, 5]])
    kept = 0
    while kept < 3 and same(images[kept]):
        kept += 1
    return MODELS[min(kept, MODELS.index(smallest))]


def patch_round(pancake: Pancake, particles: Sequence[Sphere], mesh: Mesh, sectors: int) -> Surface:
    """A droplet on the plane z = 0, the pole of its patch in the smallest of the particles.

    Parameters
    ----------
    pancake, particles : in the droplet's scale.
    mesh : its ``elements`` lie between the droplet's line and the pole; -1 chooses.
    """
    meridian = _meridian(pancake)
    places = [_place(meridian, each) for each in particles]
    least = int(np.argmin([each.radius for each in particles]))
    pole = places[least]

    def at(zeta: Array) -> Array:
        w = (zeta + pole) / (1.0 + np.conj(pole) * zeta)
        size = np.maximum(np.abs(w), 1e-12)
        r, z, _ = meridian(np.exp(meridian.log[0]) / size)
        turn = w / size
        return np.stack([r * turn.real, r * turn.imag, z], axis=-1)

    def scale_at(zeta: complex) -> float:
        beside = 0.999 * zeta + 1e-4  # nearer to the middle of the disc
        one, other = at(np.array([zeta, beside]))
        return float(np.linalg.norm(one - other)) / abs(zeta - beside)

    spot = min(0.5, particles[least].radius / scale_at(0.0))
    span = float(np.arcsinh(1.0 / spot))
    along, around = mesh.elements, ROUND
    if along < 0:
        along = max(ALONG, int(np.ceil(ROUND * span / (2.0 * np.pi))))
        for each, place in zip(particles, places, strict=True):
            zeta = (place - pole) / (1.0 - np.conj(pole) * place)
            size = max(abs(zeta), spot) * scale_at(zeta) * span
            along = max(along, int(np.ceil(ACROSS * size / each.radius)) if abs(zeta) else 0)
    around = int(np.ceil(along * 2.0 * np.pi / span / sectors)) * sectors
    space = drop_space("bspline", mesh.degree, along, sectors, around=around)
    points, matrix = meridian_interpolation(space)
    turn = np.exp(1j * ring_angles(space))[:, None]
    values = at(spot * np.sinh(span * (1.0 - points)) * turn)
    values[:, 0, 2] = 0.0
    # in its place the derivative at the pole, against which the ring shrinks
    step = 1e-3 * spot
    values[:, -2] = (at(np.zeros(1)) - at(step * turn[:, 0])) * (spot * span / step)
    return interpolated(space, values, matrix)


def _meridian(pancake: Pancake) -> Meridian:
    """From the pancake's contact line to a small circle at its top."""
    r, z = pancake(np.linspace(0.0, 1.0, 4001)[:-1])
    slope = np.gradient(np.stack([r, z], axis=1), axis=0)
    normal = np.stack([slope[:, 1], -slope[:, 0]], axis=1)
    return Meridian(r, z, normal / np.linalg.norm(normal, axis=1, keepdims=True))


def _place(meridian: Meridian, particle: Sphere) -> complex:
    """Conformal place of the point of a droplet that is nearest to a particle, 0 at the top."""
    x, y, z = particle.center
    nearest = int(np.hypot(meridian.r - np.hypot(x, y), meridian.z - z).argmin())
    size = float(meridian.log[0] - meridian.log[nearest])
    return complex(np.exp(size + 1j * np.arctan2(y, x)))
