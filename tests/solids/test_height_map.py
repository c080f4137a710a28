"""Surfaces over the plane, fibres and fields of contact angles: derivatives, and fans over them."""

import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.solids.fan import fan_of, on_surface
from iga_membrane.solids.shapes import Grid

GRID = np.linspace(-2.0, 2.0, 41)
MEASURED = 0.1 * np.cos(GRID[:, None]) * np.sin(1.3 * GRID + 0.2)
SURFACES = {
    "bump": iga.HeightMap.bump(0.3, 0.6, contact_angle=90.0),
    "egg carton": iga.HeightMap.egg_carton(0.05, 0.7, contact_angle=90.0),
    "grooves": iga.HeightMap.grooves(0.05, 0.7, contact_angle=90.0),
    "two levels": iga.HeightMap.two_level([0.05, 0.01], [0.9, 0.3], contact_angle=90.0),
    "pillars": iga.HeightMap.pillars(0.2, 0.1, 0.7, 0.07, contact_angle=90.0, offset=(0.1, 0.0)),
    "hexagonal pillars": iga.HeightMap.pillars(
        0.2, 0.1, 0.7, 0.07, contact_angle=90.0, arrangement="hexagonal"
    ),
    "measured": iga.HeightMap.from_grid(GRID, GRID, MEASURED, contact_angle=90.0, scale=0.3),
}
FIELDS = {
    "stripes": iga.stripes(60.0, 120.0, 0.6, 0.1),
    "patch": iga.patch(110.0, 70.0, 0.8, 0.15),
    "own": iga.Wettability(lambda x: (0.3 * np.sin(x[..., 0]),
                                      0.3 * np.cos(x[..., :1]) * [1.0, 0.0, 0.0])),
}  # fmt: skip
STEPS = (1e-3, 1e-4, 1e-5)


def slope_errors(value, slope, way, x):
    """Least error of a slope (..., 3) along ways, over its size."""
    exact = np.einsum("k...i,ki->k...", slope, way)
    size = np.abs(exact).max() + 1e-12
    return min(
        np.abs((value(x + h * way) - value(x - h * way)) / (2.0 * h) - exact).max() / size
        for h in STEPS
    )


@pytest.fixture
def places():
    rng = np.random.default_rng(5)
    return rng.uniform(-1.2, 1.2, (50, 3)), rng.standard_normal((50, 3))


@pytest.mark.parametrize("name", SURFACES)
def test_the_height_and_its_normal_have_exact_derivatives(name, places):
    solid, (x, way) = SURFACES[name], places
    solid.check((0.0, 0.0, 0.0), 1.0)
    turn = solid.nearest(x).hessian()
    assert slope_errors(lambda y: solid.nearest(y).normal, turn, way, x) < 1e-6
    on, normal, found = on_surface(solid, x)
    assert found.all()
    at = solid.nearest(on)
    assert np.abs(at.gap).max() < 1e-12
    assert np.abs(np.linalg.norm(normal, axis=1) - 1.0).max() < 1e-14
    # on the surface the level's gradient is the normal
    assert slope_errors(lambda y: solid.nearest(y).gap, at.normal, way, on) < 1e-6


@pytest.mark.parametrize("name", FIELDS)
def test_fields_of_contact_angles_have_exact_gradients(name, places):
    field, (x, way) = FIELDS[name], places
    assert slope_errors(lambda y: field.at(y)[0], field.at(x)[1], way, x) < 1e-6


def test_a_wrong_height_is_blamed_before_the_solve():
    wrong = iga.HeightMap(lambda x, y: (x**2, x, 0 * x, 2 + 0 * x, 0 * x, 0 * x),
                          contact_angle=90.0, scale=1.0)  # fmt: skip
    with pytest.raises(iga.SceneError, match=r"h_x = .* is not the derivative of h"):
        iga.sessile_droplet(wrong, volume=1.0)


def ring(radius, solid):
    """A circle over a surface, its points and tangents by the angle."""
    t = 2.0 * np.pi * (np.arange(400) + 0.5) / 400

    def at(t):
        flat = radius * np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=-1)
        return on_surface(solid, flat)[0]

    return at(t)[:, None], ((at(t + 1e-5) - at(t - 1e-5)) / 2e-5)[:, None], 2.0 * np.pi / 400


@pytest.mark.parametrize("name", SURFACES)
def test_fans_integrate_over_the_wetted_surface(name):
    solid, radius = SURFACES[name], 0.9
    fan = fan_of(solid, *ring(radius, solid)[:2])
    found = (fan.weights * fan.points[..., 0] ** 2).sum() * ring(radius, solid)[2]

    nodes, weights = np.polynomial.legendre.leggauss(300)
    r, w = 0.5 * radius * (nodes + 1.0), 0.5 * radius * weights
    t = 2.0 * np.pi * np.arange(600)[:, None] / 600
    x, y = r * np.cos(t), r * np.sin(t)
    h_x, h_y = solid.at(x, y)[1:3]
    exact = (x**2 * np.sqrt(1.0 + h_x**2 + h_y**2) * r * w).sum() * 2.0 * np.pi / 600
    assert found == pytest.approx(exact, rel=3e-5)


def test_the_graph_of_a_fibre_and_its_unrolled_surface_have_the_same_fan():
    fibre = iga.Cylinder(90.0, radius=1.5)
    points, tangents, weight = ring(0.8, fibre)
    unrolled = fibre.fan(points, tangents)

    class Same:
        contact_angle, scale, nearest = 90.0, 1.5, staticmethod(fibre.nearest)

    graph = fan_of(Same(), points, tangents)
    for power in (0, 2):
        both = [(f.weights * f.points[..., 0] ** power).sum() * weight for f in (unrolled, graph)]
        assert both[0] == pytest.approx(both[1], rel=1e-9)
    # x = sin(t) of the fibre: the strip's area exactly
    t = np.arcsin(0.8 / 1.5)
    area = (
        2.0
        * 1.5
        * np.trapezoid(
            2.0 * np.sqrt(np.maximum(0.64 - (1.5 * np.sin(np.linspace(0, t, 200001))) ** 2, 0.0)),
            np.linspace(0, t, 200001),
        )
    )
    assert unrolled.weights.sum() * weight == pytest.approx(area, rel=1e-5)


def test_a_line_beyond_a_measured_map_is_named():
    small = np.linspace(-0.5, 0.5, 9)
    solid = iga.HeightMap.from_grid(small, small, np.zeros((9, 9)), contact_angle=90.0, scale=0.3)
    mesh = iga.Discretization(elements=16)
    drop = iga.solve(iga.sessile_droplet(solid, volume=1.0, discretization=mesh), on_fail="return")
    assert not drop.success
    assert "measured map" in drop.message


def test_a_measured_map_keeps_its_border_beyond_it():
    grid = Grid(GRID, GRID, MEASURED)
    h, h_x, h_y, *_ = grid(np.array([3.0]), np.array([0.1]))
    assert h == pytest.approx(grid(np.array([2.0]), np.array([0.1]))[0])
    assert h_x == h_y == 0.0


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: iga.HeightMap.bump(0.1, 0.0, contact_angle=90.0), "substrate.width = 0"),
        (lambda: iga.HeightMap.bump(0.1, 0.2, contact_angle=180.0), "180: not available yet"),
        (lambda: iga.HeightMap.bump(0.1, 0.2, contact_angle=200.0), "contact_angle = 200"),
        (lambda: iga.HeightMap(3.0, contact_angle=90.0, scale=1.0), "height = 3.0: must be a func"),
        (lambda: iga.HeightMap.two_level([0.1], [1.0, 2.0], contact_angle=90.0), "as many"),
        (lambda: iga.HeightMap.from_grid(GRID[:3], GRID, MEASURED[:3], contact_angle=90.0,
                                         scale=1.0), "four or more"),
        (lambda: iga.HeightMap.from_grid(GRID, GRID, MEASURED[:5], contact_angle=90.0, scale=1.0),
         "must have the shape"),
        (lambda: iga.Cylinder(90.0, radius=-1.0), "radius = -1"),
        (lambda: iga.stripes(60.0, 120.0, 0.6, 0.0), "border = 0"),
        (lambda: iga.patch(60.0, 190.0, 0.6, 0.1), "outside = 190"),
        (lambda: iga.Wettability(3.0), "cosine = 3.0: must be a function"),
    ],
)  # fmt: skip
def test_wrong_surfaces_and_fields_are_named(make, said):
    with pytest.raises(iga.SceneError, match=said):
        make()
