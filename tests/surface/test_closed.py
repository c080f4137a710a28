"""Closed surfaces of revolution from one square."""

import numpy as np
import pytest
from helpers import slopes
from scipy.integrate import solve_ivp

from iga_membrane.dofs.boundary_conditions import Sector
from iga_membrane.dofs.symmetry import sector_table
from iga_membrane.initial.closed_droplet import whole_skin
from iga_membrane.initial.resolution import Pattern
from iga_membrane.splines import net_of, pillow_space
from iga_membrane.surface.closed import (
    QUARTER,
    Meridian,
    Stretch,
    closed_surface,
    inverse_lemniscate_sine,
    lemniscate_sine,
)
from iga_membrane.terms import variations as vary

MODELS = ("full", "half", "quarter", "eighth")


def ball(degree, elements, stretch=None):
    """Unit sphere about the origin: space, control points and directions."""
    u = np.linspace(np.pi, 0.0, 20001)[1:-1]
    meridian = Meridian(np.sin(u), np.cos(u), np.stack([np.sin(u), np.cos(u)], -1))
    space = pillow_space(degree, elements)
    return space, *closed_surface(space, meridian, stretch or Stretch())


def integrals(space, points, model="full", center=(0.0, 0.0, 0.0)):
    """Area, volume and solid angle from a point, of the whole body by one sector."""
    sector = Sector(model)
    table = sector_table(space, sector, (4, 4))
    at = vary.element_points(table, points)
    away, c = at.x - center, at.c * table.weights[..., None]
    far = np.linalg.norm(away, axis=-1)
    area = (at.area * table.weights).sum()
    volume = (away * c).sum() / 3.0
    angle = ((away * c).sum(-1) / far**3).sum()
    return sector.copies * np.array([area, volume, angle])


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_area_and_volume_of_a_sphere_converge(degree):
    exact = np.array([4 * np.pi, 4 * np.pi / 3])
    found = [integrals(*ball(degree, n)[:2])[:2] for n in (8, 16, 32)]
    for errors in (np.array(found) / exact - 1.0).T:
        assert slopes(errors)[-1] >= 1.8  # control points on the sphere: inscribed
        assert abs(errors[-1]) < 1e-2


@pytest.mark.parametrize("degree", [2, 3])
def test_a_closed_skin_fills_the_whole_solid_angle_from_within_and_none_from_outside(degree):
    space, points, _ = ball(degree, 16, Stretch(0.75, 0.5))
    for center in ((0.0, 0.0, 0.0), (0.2, -0.3, 0.1)):
        # positive: the normal points out of the body
        inside = integrals(space, points, center=center)[2]
        assert inside == pytest.approx(4 * np.pi, rel=1e-5)
    assert abs(integrals(space, points, center=(1.5, 0.4, 1.0))[2]) < 1e-4


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("elements", [7, 8])
def test_sectors_integrate_the_whole(degree, elements):
    space, points, _ = ball(degree, elements)
    whole = integrals(space, points)
    for model in MODELS[1:]:
        assert integrals(space, points, model) == pytest.approx(whole, rel=1e-12), model


def test_control_points_and_directions_have_the_mirror_planes():
    skin = whole_skin(1.0, 4 * np.pi / 3, Pattern(0.2), 2, 12)
    for field in (skin.points, skin.directions):
        net = net_of(skin.space, field)
        assert net[::-1] == pytest.approx(net * [1, -1, 1], abs=1e-12)
        assert net[:, ::-1] == pytest.approx(net * [-1, 1, 1], abs=1e-12)
        assert net.swapaxes(0, 1) == pytest.approx(net[..., [1, 0, 2]], abs=1e-12)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_directions_at_the_top_and_in_the_middle_of_the_foot_are_vertical(degree):
    _, points, directions = ball(degree, 8)
    on_axis = np.hypot(points[:, 0], points[:, 1]) < 1e-9
    assert on_axis.sum() == (2 if degree % 2 else 0)
    assert np.abs(directions[on_axis, :2]).max(initial=0.0) < 1e-9
    # next to them they lean away from the axis like the control points
    near = np.argsort(np.hypot(points[:, 0], points[:, 1]))[:10]
    assert directions[near] == pytest.approx(points[near], abs=0.02)


def test_the_droplet_starts_with_its_volume_and_an_even_foot():
    skin = whole_skin(1.0, 4 * np.pi / 3, Pattern(0.1), 2, 0)
    assert integrals(skin.space, skin.points)[1] == pytest.approx(4 * np.pi / 3, rel=1e-2)
    table = skin.space.table(1)
    at = vary.element_points(table, skin.points)
    foot = np.sqrt(4.0 / 3.0 / skin.pressure)  # weight over pressure
    under = (np.hypot(at.x[..., 0], at.x[..., 1]) < foot) & (at.x[..., 2] < 0.1)
    size = (np.sqrt(at.area) * np.sqrt(table.weights))[under]
    assert under.sum() > 100
    assert size.max() / size.min() < 1.6
    assert 0.1 / size.max() >= 3.0


def test_the_lemniscate_sine_solves_its_equation():
    # sl'' = -2 sl^3, sl(0) = 0, sl'(0) = 1, along rays of the complex plane
    for angle in np.radians([0.0, 20.0, 45.0, 70.0, 90.0]):
        ray = np.exp(1j * angle)
        reach = 0.95 * QUARTER
        ode = solve_ivp(
            lambda t, y, ray=ray: [ray * y[1], -2.0 * ray * y[0] ** 3],
            (0.0, reach), [0j, 1 + 0j], rtol=1e-12, atol=1e-13, dense_output=True,
        )  # fmt: skip
        t = np.linspace(0.0, reach, 40)
        z = ray * t / QUARTER
        assert lemniscate_sine(z.real, z.imag) == pytest.approx(ode.sol(t)[0], abs=1e-9)


def test_sides_of_the_square_go_to_the_equator_and_corners_to_the_pole():
    one = np.array([1.0])
    assert np.abs(lemniscate_sine(one, 0 * one)) == pytest.approx(1.0, abs=1e-12)
    assert np.abs(lemniscate_sine(one - 1e-6, one - 1e-6))[0] > 1e5
    for value in (0.1, 0.5, 0.9):
        x = np.array([inverse_lemniscate_sine(value)])
        assert lemniscate_sine(x, 0 * x).real == pytest.approx(value, abs=1e-6)


def test_a_stretch_is_odd_smooth_and_keeps_the_square():
    stretch, x, h = Stretch(0.75, 0.4), np.linspace(-1, 1, 401), 1e-6
    y = stretch(x)
    assert y == pytest.approx(-y[::-1], abs=1e-13)
    assert y[[0, -1]] == pytest.approx([-1, 1])
    assert (np.diff(y) > 0).all()
    assert stretch(np.array([0.3])) == pytest.approx(0.12)
    jumps = []
    for steps in (401, 801):  # a slope without jumps changes half as much over half the step
        fine = np.linspace(-1, 1, steps)
        jumps.append(np.abs(np.diff((stretch(fine + h) - stretch(fine - h)) / (2 * h))).max())
    assert jumps[1] < 0.52 * jumps[0]
