"""Numbers that double precision cannot hold together are refused at once, by name; numbers that are
hard to believe are a warning that says what they would mean."""

import re

import numpy as np
import pytest
from helpers import within

import iga_membrane as iga

WATER = iga.Liquid.water()
PLANE = iga.Plane(90.0)


def ball(radius):
    return iga.Sphere(120.0, radius, (0.0, 0.0, -radius))


def droplet(substrate=PLANE, *, volume=1.0, tension=1.0, density=1.0, gravity=0.0):
    return iga.sessile_droplet(
        substrate, volume=volume, liquid=iga.Liquid(tension, density), gravity=gravity
    )


@pytest.mark.parametrize(
    ("make", "names"),
    [
        (lambda: droplet(tension=1e-300), ["surface_tension"]),
        (lambda: droplet(tension=1e80), ["surface_tension"]),
        (lambda: droplet(density=1e308), ["density"]),
        (lambda: droplet(volume=1e-200), ["volume"]),
        (lambda: droplet(gravity=1e-310), ["acceleration"]),
        (lambda: droplet(iga.Plane(1e-300)), ["contact_angle", ">= 0.001"]),
        (lambda: droplet(iga.Plane(3e-4)), ["contact_angle", ">= 0.001"]),
        (lambda: droplet(tension=1e-60, density=1e60, gravity=1e60),
         ["Bond number", "volume", "density", "gravity", "surface_tension"]),
        (lambda: droplet(iga.Plane(90.0, (0.0, 1e13, 0.0))), ["origin"]),
        (lambda: droplet(ball(1e14)), ["radius"]),
        (lambda: droplet(ball(1e-20)), ["radius"]),
        (lambda: droplet(iga.Spheres(180.0, [[0.0, 1e40, 0.0]], 0.1)), ["centers"]),
        (lambda: iga.liquid_sheet(size=1e308), ["size"]),
        (lambda: iga.liquid_sheet(size=1e60), ["length", "choose other units"]),
        (lambda: iga.liquid_sheet(ball(1e-30), size=1.0), ["size"]),
        (lambda: iga.liquid_sheet(size=1.0, pressure=1e50, liquid=iga.Liquid(1e-50)), ["pressure"]),
        (lambda: iga.film_between_rings(half_height=1e-30), ["half_height"]),
        (lambda: iga.asperity_cell(iga.Sphere(180.0, 1.0), size=1e20, pressure=1.0), ["size"]),
        (lambda: iga.Scale(1e50, 1e70), ["length", "tension", "choose other units"]),
    ],
)  # fmt: skip
def test_numbers_that_leave_double_precision_are_refused_at_once(make, names):
    with within(0.5), pytest.raises(iga.SceneError) as caught:
        make()
    for name in names:
        assert name in str(caught.value)


@pytest.mark.parametrize("volume", [1e-27, 1e12])
@pytest.mark.parametrize("angle", [30.0, 150.0])
def test_any_usual_unit_is_taken_without_a_word(volume, angle):
    """From cubic nanometres to a litre in cubic micrometres."""
    assert not droplet(iga.Plane(angle), volume=volume).warnings


@pytest.mark.parametrize(
    ("angle", "volume", "gravity", "said"),
    [(111.0, 5.0, 9.81, ("4.5 mm", "38 m")), (60.0, 8.0, 9.8, ("2.7 mm", "61 m"))],
)
def test_a_large_bond_number_says_the_puddle_that_it_means(angle, volume, gravity, said):
    """Microlitres given as cubic metres."""
    scene = iga.sessile_droplet(iga.Plane(angle), volume=volume, liquid=WATER, gravity=gravity)
    text = next(text for text in scene.warnings if "Bond number" in text)
    assert f"{said[0]} high and {said[1]} wide" in text
    assert any("liquid.volume" in each and "m^3" in each for each in scene.warnings)


def test_a_puddle_has_the_height_and_the_volume_of_the_theory():
    angle, volume, weight, tension = 75.0, 3e3, 400.0, 2.0
    text = " ".join(
        droplet(iga.Plane(angle), volume=volume, tension=tension, gravity=weight).warnings
    )
    bond, high, wide = (float(x) for x in re.search(
        r"Bond number (\S+): .* puddle (\S+) high and (\S+) wide", text).groups())  # fmt: skip
    assert bond == pytest.approx(weight * (volume / (4 / 3 * np.pi)) ** (2 / 3) / tension, rel=0.05)
    # balance of a wide puddle's forces: rho g h^2 / 2 = gamma (1 - cos(theta))
    assert 0.5 * weight * high**2 == pytest.approx(
        tension * (1 - np.cos(np.radians(angle))), rel=0.1
    )
    assert np.pi * wide**2 / 4 * high == pytest.approx(volume, rel=0.1)


def test_droplets_and_puddles_up_to_ten_thousand_are_no_warning():
    length_squared = (1.0 / (4 / 3 * np.pi)) ** (2 / 3)
    assert not droplet(gravity=0.99e4 / length_squared).warnings
    assert droplet(gravity=1.01e4 / length_squared).warnings


@pytest.mark.parametrize(
    ("changed", "field"),
    [
        ({"surface_tension": 72.8}, "liquid.surface_tension = 72.8"),
        ({"surface_tension": 7e-5}, "liquid.surface_tension = 7e-05"),
        ({"density": 0.01}, "liquid.density = 0.01"),
        ({"density": 9.98e5}, "liquid.density = 998000"),
        ({"volume": 2e-3}, "liquid.volume = 0.002"),
    ],
)
def test_what_is_hard_to_believe_in_si_is_named(changed, field):
    given = {"surface_tension": 72.8e-3, "density": 998.0, "volume": 1e-9} | changed
    volume = given.pop("volume")
    for scene in (
        iga.sessile_droplet(PLANE, volume=volume, liquid=iga.Liquid(**given), gravity=9.81),
        iga.liquid_sheet(size=0.1, volume=-volume, liquid=iga.Liquid(**given), gravity=9.75),
    ):
        assert any(field in text or field.replace("= ", "= -") in text for text in scene.warnings)
    # nothing says that other accelerations are SI
    assert not iga.liquid_sheet(size=0.1, liquid=iga.Liquid(**given), gravity=1.0).warnings


def test_water_in_si_is_believed():
    for volume in (1e-15, 1e-9, 1e-6):
        assert not iga.sessile_droplet(
            iga.Plane(100.0), volume=volume, liquid=WATER, gravity=9.81
        ).warnings


def test_perfectly_wet_solids_are_not_asked_for_degrees():
    pair = [iga.Sphere(0.0, 1.0, (0.0, 0.0, z)) for z in (-1.05, 1.05)]
    scene = iga.sessile_droplet(None, volume=0.05, particles=pair)
    assert scene.warnings == ()
