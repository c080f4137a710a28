"""Every surface that the unknowns can reach is C1: round each point of the membrane its normals, at
parameter distances down to 1e-7, have one limit."""

from functools import cache

import numpy as np
import pytest
from helpers import UNIT_VOLUME

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly

DISTANCES = (1e-3, 1e-5, 1e-7)
MODELS = ("full", "half", "quarter", "eighth")


def mesh(degree, elements, model=None, space="bspline"):
    return iga.Discretization(space=space, degree=degree, elements=elements, model=model)


def on_asperities(angle, degree, model, elements=20):
    solid = iga.SphereLattice(angle, 0.2, 0.5, "square", (0.0, 0.0))
    return iga.sessile_droplet(
        solid, volume=UNIT_VOLUME, gravity=0.3, discretization=mesh(degree, elements, model)
    )


@cache
def perturbed(kind, *arguments, amount=2e-3):
    """The start of a scene, moved by a random step of its unknowns."""
    scene = kind(*arguments)
    assembly, surface = Assembly(scene), scene.local_surface()
    step = np.random.default_rng(1).uniform(-amount, amount, assembly.size)
    moved = assembly.motion(surface).displacement(step)
    assert np.abs(moved).max() > 0.5 * amount
    return surface.moved(surface.points + moved)


def spread(surface, copies, distance):
    """Angle in degrees within which the normals lie that are a distance in parameters away from a
    point, which a closed patch may have at several places ``copies``."""
    turn = 0.1 + 2.0 * np.pi * np.arange(16) / 16.0
    circle = distance * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    xi = (np.array(copies)[:, None] + circle).reshape(-1, 2)
    for along, basis in enumerate(surface.space.bases):
        if not basis.periodic:
            first, last = basis.breaks[[0, -1]]
            xi = xi[(first <= xi[:, along]) & (xi[:, along] <= last)]
    normals = surface.at(xi, 1).normal
    chords = np.linalg.norm(normals[:, None] - normals, axis=-1)
    return float(np.degrees(2.0 * np.arcsin(0.5 * chords.max())))


def check_smooth(surface, points, distances=DISTANCES):
    """Normals close in on one with the distance, for lists of the places of a point; curvature
    lets the rate change a little."""
    found = np.array([[spread(surface, copies, d) for d in distances] for copies in points])
    rate = found[:, 0].max() / distances[0]
    assert 0.0 < rate < 1e6
    for distance, angles in zip(distances, found.T, strict=True):
        assert angles.max() <= 1.5 * rate * distance + 1e-6, distance


FOLDS = [[(1.0, 0.0)], [(-1.0, 0.0)], [(0.0, 1.0)], [(0.0, -1.0)]]
CORNERS = [[(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]]


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("degree", [2, 3, 4])
@pytest.mark.parametrize("angle", [180.0, 150.0])
def test_the_folded_patch_has_no_cone_at_its_folds(angle, degree, model):
    surface = perturbed(on_asperities, angle, degree, model)
    for fold in FOLDS:
        check_smooth(surface, [fold])


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_the_folded_patch_is_smooth_on_its_seams_and_where_its_corners_meet(degree):
    surface = perturbed(on_asperities, 180.0, degree, "full")
    along = np.random.default_rng(2).uniform(0.05, 0.95, 10)
    check_smooth(surface, CORNERS)
    check_smooth(surface, [[(1.0, t), (1.0, -t)] for t in along])
    check_smooth(surface, [[(t, -1.0), (-t, -1.0)] for t in along])


def on_a_square_rim(degree, model, load="", place=(0.0, 0.0, -1.0)):
    loads = {"pressed": {"pressure": 0.3}, "held": {"membrane": iga.WholeMembrane()}}
    return iga.liquid_sheet(
        iga.Sphere(140.0, 1.0, place),
        size=5.0,
        boundary="square",
        discretization=mesh(degree, 6, model),
        **loads.get(load, {}),
    )


def check_diagonals(surface):
    """No kink where a ring's patches meet. Near the rim's corner, which is one, normals turn within
    a distance that shrinks with that to the corner."""
    ring, meridian = surface.space.bases
    assert len(ring.joints) == 4
    middle, end = np.linspace(meridian.breaks[0] + 0.01, 0.9, 12), np.linspace(0.9, 0.999, 5)
    check_smooth(surface, [[(joint, t)] for joint in ring.joints for t in middle])
    check_smooth(surface, [[(joint, t)] for joint in ring.joints for t in end], (1e-6, 1e-7))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("degree", [2, 3, 4])
@pytest.mark.parametrize("load", ["", "pressed"])
def test_a_sheet_on_a_particle_has_no_kink_on_its_diagonals(degree, model, load):
    surface = perturbed(on_a_square_rim, degree, model, load)
    check_diagonals(surface)


def test_nor_has_one_beside_the_middle_or_the_papers_one_with_its_wetted_part():
    for scene in ((3, "full", "", (0.8, 0.3, -1.0)), (3, "quarter", "held"), (2, "eighth", "held")):
        check_diagonals(perturbed(on_a_square_rim, *scene))


@pytest.mark.parametrize("space", ["bspline", "nurbs", "lagrange"])
@pytest.mark.parametrize("degree", [2, 3, 4])
def test_the_rim_is_a_square_with_corners(degree, space):
    scene = iga.liquid_sheet(
        iga.Sphere(90.0, 1.0, (0.0, 0.0, -1.0)),
        size=5.0,
        boundary="square",
        discretization=mesh(degree, 4, None, space),
    )
    surface = scene.surface
    ring = surface.space.bases[0]
    t = np.linspace(*ring.breaks[[0, -1]], 801)
    k = surface.at(np.stack([t, np.ones_like(t)], axis=1), 1)
    assert np.abs(k.position[:, :2]).max(axis=1) == pytest.approx(2.5, rel=1e-12)
    assert np.abs(k.position[:, 2]).max() < 1e-12
    corner = np.abs(np.abs(k.position[:, :2]).min(axis=1) - 2.5) < 1e-9
    assert corner.sum() == 4
    # forwards along the sides
    x, y = k.position[:, 0], k.position[:, 1]
    assert (x[:-1] * y[1:] - y[:-1] * x[1:] > 0.0).all()


def square_cell(angle, degree, model, place):
    return iga.asperity_cell(
        iga.Sphere(angle, 0.05, (*place, -0.05)),
        size=0.2,
        pressure=2.0,
        discretization=mesh(degree, 12, model),
    )


def quarter(degree):
    """A quarter of a bulged sheet between two mirror planes and two fixed edges."""
    space = iga.tensor_space(*2 * [iga.line_basis("bspline", 6, degree)])
    y, x = np.moveaxis(space.abscissae, -1, 0)
    y, x = (np.where(t == np.unique(t)[1], 0.4 * t, t) for t in (y, x))
    first = np.where(x == np.unique(x)[1], 0.0, x), np.where(y == np.unique(y)[1], 0.0, y)
    z = 0.3 * (1.0 - first[0] ** 2) * (1.0 - first[1] ** 2)
    net = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    mirrors = [iga.Symmetry("x"), iga.Symmetry("y")]
    fixed = [iga.Fixed("xi1=1"), iga.Fixed("xi2=1")]
    terms = [iga.SurfaceTension(1.0), iga.Pressure(0.5)]
    return iga.Scene(iga.Surface(space, net), terms, [*mirrors, *fixed])


def check_upright(surface, edges):
    """Tangent planes contain the normal of the mirror plane in which an edge lies."""
    t = np.random.default_rng(3).uniform(0.0, 1.0, 50)
    for along, end in edges:
        xi = np.empty((50, 2))
        xi[:, along], xi[:, 1 - along] = t, end
        normal = surface.at(xi, 1).normal
        assert np.abs(normal[:, along]).max() < 1e-10
        assert np.abs(normal[:, 1 - along]).max() > 1e-3


@pytest.mark.parametrize(
    ("model", "place"),
    [("eighth", (0, 0)), ("quarter", (0, 0)), ("half", (0.02, 0)), ("full", (0.02, 0.01))],
)
@pytest.mark.parametrize("degree", [2, 3, 4])
@pytest.mark.parametrize("angle", [180.0, 150.0])
def test_a_cell_and_its_mirror_images_are_one_smooth_surface(angle, degree, model, place):
    surface = perturbed(square_cell, angle, degree, model, place)
    # xi1 runs along y: an edge along it lies in a wall x = const
    check_upright(surface, [(0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0)])


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_an_open_patch_and_its_mirror_images_are_one_smooth_surface(degree):
    check_upright(perturbed(quarter, degree), [(0, 0.0), (1, 0.0)])
    solution = iga.solve(quarter(degree))
    assert solution.success
    check_upright(solution.surface, [(0, 0.0), (1, 0.0)])
