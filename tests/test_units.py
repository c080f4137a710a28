"""Quantities as text, and the same droplet in SI and without dimensions (I12)."""

import numpy as np
import pytest

import iga_membrane as iga


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("72.8 mN/m", 0.0728),
        ("1 uL", 1e-9),
        ("1 \u00b5L", 1e-9),
        ("1 ul", 1e-9),
        ("1e-3 l", 1e-6),
        ("10 um", 1e-5),
        ("2.5 mm^3", 2.5e-9),
        ("2.5 mm3", 2.5e-9),
        ("998 kg/m^3", 998.0),
        ("1 g/cm\u00b3", 1000.0),
        ("9.81 m/s^2", 9.81),
        ("9.81 m/s2", 9.81),
        ("-2 kPa", -2000.0),
        (".5 mm", 5e-4),
    ],
)
def test_a_quantity_is_its_number_in_si(text, value):
    assert iga.si(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("72", "has no unit"),
        ("1 banana", "unknown unit"),
        ("1 MN/m", "unknown unit"),
        ("mN/m", "must begin with a number"),
        ("nan m", "must begin with a number"),
        ("1e999999 m", "must begin with a number"),
        ("__import__('os') m", "must begin with a number"),
        ("1 km", "unknown unit"),
        (72.8, "must be text"),
    ],
)
def test_what_is_no_quantity_is_refused(text, said):
    with pytest.raises(iga.SceneError, match=said):
        iga.si(text)


@pytest.mark.parametrize("liquid", [iga.Liquid.water(), iga.Liquid.mercury()])
def test_si_and_dimensionless_input_agree(liquid):
    volume = iga.si("1 uL")
    solution = iga.solve(
        iga.sessile_droplet(
            iga.Plane(contact_angle=140), volume=volume, liquid=liquid, gravity=9.81
        )
    )
    length = (3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)
    bond = liquid.density * 9.81 * length**2 / liquid.surface_tension
    unit = iga.solve(
        iga.sessile_droplet(iga.Plane(contact_angle=140), volume=4.0 * np.pi / 3.0, gravity=bond)
    )
    assert solution.measures["height"] / length == pytest.approx(unit.measures["height"], rel=1e-9)
    pressure = liquid.surface_tension / length
    assert solution.measures["p_base"] / pressure == pytest.approx(
        unit.measures["p_base"], rel=1e-9
    )
