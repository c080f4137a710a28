"""The load of a wet spot on a small sphere: closed forms, and the work done on it."""

import numpy as np
import pytest

from iga_membrane.solids.wet_spot import WetSpots, held, spot_radius

ANGLES = [180.0, 170.0, 150.0, 110.0, 60.0]


def spots(angle, depth, cutoff=0.7, ring=0.4, pressure=0.05):
    psi = np.radians(180.0 - angle)
    return WetSpots(*(np.full(np.shape(depth), v) for v in (psi, cutoff, ring, pressure)))


@pytest.mark.parametrize("angle", ANGLES)
def test_load_and_stiffness_are_derivatives_of_the_work(angle):
    one = spots(angle, 0.0)
    depth = np.linspace(float(one.lowest) - 0.05, float(one.lowest) + 1.2, 41)
    law = spots(angle, depth)
    errors = []
    for step in (1e-3, 5e-4):
        below, at, above = (law.carried(depth + k * step) for k in (-1, 0, 1))
        slope = (above.work - below.work) / (2.0 * step)
        errors.append(np.median(np.abs(slope - at.load)))
        inside = depth > one.lowest + 0.05
        stiff = (above.load - below.load) / (2.0 * step)
        assert stiff[inside] == pytest.approx(at.stiffness[inside], rel=2e-2, abs=1e-4)
    assert errors[1] < 0.3 * errors[0] + 1e-10
    assert errors[1] < 1e-5


@pytest.mark.parametrize("angle", ANGLES)
def test_the_largest_pull_is_that_of_a_sphere_at_a_film(angle):
    """2 pi gamma r sin(psi / 2)^2 without pressure."""
    depth = np.linspace(-0.6, 1.5, 400)
    load = spots(angle, depth, pressure=0.0).carried(depth).load
    assert load.min() == pytest.approx(-(np.sin(0.5 * np.radians(180.0 - angle)) ** 2), abs=1e-10)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_spot_that_carries_nothing_lies_at_youngs_angle(angle):
    """A flat membrane meets the sphere at the contact angle where it is r (1 + cos(theta)) deep."""
    psi = np.radians(180.0 - angle)
    assert spot_radius(0.0, psi, 0.0) == pytest.approx(np.sin(psi), abs=1e-8)
    depth = np.array(1.0 - np.cos(psi))
    if angle > 90.0:
        assert spots(angle, depth, pressure=0.0).carried(depth).load == pytest.approx(0.0, abs=1e-9)


def test_at_180_degrees_a_small_load_spreads_as_its_square_root():
    """a^2 = f r / 2 pi gamma, so u = (a / r)^2 in a depth a^2 / 2 r (1 + 2 log(b / a))."""
    a, b = 0.02, 0.3
    depth = np.array(0.5 * a**2 * (1.0 + 2.0 * np.log(b / a)))
    load = spots(180.0, depth, cutoff=b, pressure=0.0).carried(depth).load
    assert load == pytest.approx(a**2, rel=1e-3)


def test_the_pressure_over_a_spot_counts():
    """sin(phi) sin(phi - psi) + q sin(phi)^2 = u."""
    psi, q, phi = 0.4, 0.2, 0.7
    load = np.sin(phi) * np.sin(phi - psi) + q * np.sin(phi) ** 2
    assert spot_radius(load, psi, q) == pytest.approx(np.sin(phi), rel=1e-12)


def test_a_sphere_is_wet_from_when_it_is_met_until_it_is_torn_off():
    depth, before = np.array([0.1, -0.1, -0.1, -0.3]), np.array([False, False, True, True])
    lowest = np.full(4, -0.2)
    assert held(depth, 0.0 * depth, lowest, before).tolist() == [True, False, True, False]
