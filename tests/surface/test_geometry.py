"""Geometry against identities that hold for every smooth surface (Q11-Q14, Q18)."""

import numpy as np
import pytest

import iga_membrane as iga

SEEDS = range(25)


def dented(surface, seed=0):
    """Smooth image of a sphere without symmetry: every control net keeps its C1 seams."""
    rng = np.random.default_rng(seed)
    stretch = np.eye(3) + 0.15 * rng.uniform(-1.0, 1.0, (3, 3))
    return surface.transformed(rotation=stretch, shift=0.3 * rng.standard_normal(3))


@pytest.fixture(scope="module", params=SEEDS)
def closed(request):
    """A stretched exact sphere, refined, with its geometry at quadrature points."""
    surface = iga.refined(dented(iga.sphere(1.3), request.param), *(np.arange(1, 16, 2) / 16,) * 2)
    table = surface.space.table(6, second=True)
    k = surface.on(table)
    return k, k.area_element * table.weights


def integral(field, weights):
    return np.einsum("eq...,eq->...", field, weights)


def test_sphere_has_its_curvatures_everywhere():
    k = iga.sphere(2.0).at(np.random.default_rng(0).uniform(0.05, 0.95, (50, 2)))
    assert k.mean_curvature == pytest.approx(-0.5, abs=1e-12)
    assert k.gauss_curvature == pytest.approx(0.25, abs=1e-12)
    assert k.normal == pytest.approx(k.position / 2.0, abs=1e-12)


@pytest.mark.parametrize(
    ("surface", "area"),
    [
        (iga.sphere(2.0), 16 * np.pi),
        (iga.cap(1.0, 150.0), 2 * np.pi * (1 + np.cos(np.pi / 6))),
        (iga.disc(3.0), 9 * np.pi),
        (iga.cylinder(0.5, 2.0), 2 * np.pi),
        (iga.sheet(2.0), 4.0),
    ],
    ids=["sphere", "cap", "disc", "cylinder", "sheet"],
)
def test_factories_have_the_exact_area(surface, area):
    assert surface.area(12) == pytest.approx(area, rel=1e-11)


def test_tensors_obey_their_definitions():
    k = dented(iga.cap(1.0, 100.0)).at(np.random.default_rng(1).uniform(0.1, 0.9, (9, 2)))
    eye = np.broadcast_to(np.eye(2), k.metric.shape)
    assert k.inverse_metric @ k.metric == pytest.approx(eye, abs=1e-12)
    assert k.dual_tangents @ np.swapaxes(k.tangents, -1, -2) == pytest.approx(eye, abs=1e-12)
    # Gauss: a_alpha,beta = Gamma^gamma a_gamma + b n
    rebuilt = np.einsum("tabc,tci->tabi", k.christoffel, k.tangents)
    rebuilt += k.curvature_tensor[..., None] * k.normal[:, None, None]
    assert rebuilt == pytest.approx(k.second, abs=1e-11)


def test_closed_surface_has_no_net_normal(closed):
    k, w = closed
    assert np.abs(integral(k.normal, w)).max() <= 1e-8 * w.sum()


@pytest.mark.parametrize("seed", SEEDS)
def test_closed_bspline_surface_has_no_net_normal_to_rounding(seed):
    """Q11: its rule is exact."""
    ball = iga.sessile_droplet(
        iga.SphereLattice(180.0, 0.4, 1.2), volume=4.0, gravity=1.0,
        discretization=iga.Discretization(elements=6, model="full"),
    ).surface  # fmt: skip
    rng = np.random.default_rng(seed)
    surface = ball.moved(ball.points + 0.05 * rng.standard_normal(ball.points.shape))
    table = surface.space.table(surface.space.degree + 1)
    k = surface.on(table)
    w = k.area_element * table.weights
    assert np.abs(integral(k.normal, w)).max() <= 1e-12 * w.sum()


def test_closed_membrane_pulls_nowhere_and_turns_nothing(closed):
    k, w = closed
    pull = 2 * k.mean_curvature[..., None] * k.normal
    assert np.abs(integral(pull, w)).max() <= 1e-5
    assert np.abs(integral(np.cross(k.position, pull), w)).max() <= 1e-5


def test_a_kink_shows_as_a_net_pull():
    surface = iga.refined(iga.sphere(1.0), [0.1, 0.3, 0.6, 0.9], [0.1, 0.3, 0.6, 0.9])
    net = surface.net.copy()
    net[4:7, 5] *= 1.01  # breaks the tangent plane at a knot of the seam
    kinked = surface.moved(net.reshape(-1, 3))
    table = kinked.space.table(8, second=True)
    k = kinked.on(table)
    pull = integral(2 * k.mean_curvature[..., None] * k.normal, k.area_element * table.weights)
    assert np.abs(pull).max() >= 1e-3


def test_gauss_bonnet_on_a_closed_surface(closed):
    k, w = closed
    assert integral(k.gauss_curvature, w) == pytest.approx(4 * np.pi, abs=1e-6)


@pytest.mark.parametrize("angle", [40.0, 90.0, 130.0, 165.0])
def test_gauss_bonnet_on_a_droplet_with_its_contact_line(angle):
    surface = iga.cap(1.0, angle)
    fine = iga.refined(surface, np.arange(1, 16, 2) / 16, np.arange(1, 12, 2) / 12)
    table = fine.space.table(8, second=True)
    k = fine.on(table)
    inside = integral(k.gauss_curvature, k.area_element * table.weights)
    # the rim is a circle of radius sin(angle), geodesic curvature cos / sin towards the cap
    theta = np.radians(angle)
    assert inside + 2 * np.pi * np.cos(theta) == pytest.approx(2 * np.pi, abs=1e-6)


def test_minkowski_formulas(closed):
    k, w = closed
    support = np.einsum("eqi,eqi->eq", k.position, k.normal)
    assert integral(-k.mean_curvature * support, w) == pytest.approx(w.sum(), rel=1e-6)
    assert integral(k.mean_curvature, w) == pytest.approx(
        -integral(k.gauss_curvature * support, w), rel=1e-6
    )


@pytest.mark.parametrize(
    "finer",
    [
        lambda s: iga.refined(s, [0.1, 0.35, 0.35], [0.2, 0.7]),
        lambda s: iga.elevated(s, 1),
        lambda s: iga.elevated(s, 2),
    ],
    ids=["knots", "degree + 1", "degree + 2"],
)
@pytest.mark.parametrize("seed", SEEDS)
def test_refinement_leaves_geometry_and_energy(finer, seed):
    surface = dented(iga.cap(1.0, 40.0 + 5.0 * seed), seed)
    fine = finer(surface)
    xi = np.random.default_rng(3).random((100, 2))
    assert fine.at(xi).position == pytest.approx(surface.at(xi).position, abs=1e-12)
    assert fine.at(xi).mean_curvature == pytest.approx(surface.at(xi).mean_curvature, abs=1e-9)
    assert fine.area(14) == pytest.approx(surface.area(14), rel=1e-12)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (lambda n: np.zeros((n, 2)), "shape"),
        (lambda n: np.zeros((n, 3), object), "dtype object"),
        (lambda n: np.zeros((n, 3), complex), "dtype complex"),
        (lambda n: np.full((n, 3), np.nan), "control point 0"),
    ],
)
def test_bad_control_nets_are_refused(points, message):
    space = iga.sheet(1.0).space
    with pytest.raises(iga.GeometryError, match=message):
        iga.Surface(space, points(space.count))
