"""Quantities as text, and the same droplet in SI and without dimensions (I12)."""

import json

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


DIMENSIONS = {
    "A_LG": 2, "A_wet": 2, "volume": 3, "height": 1, "equator_radius": 1, "contact_radius": 1,
    "contact_angle_measured": 0,
}  # fmt: skip
"""Power of the length in a measure; energies and pressures have their own units."""


@pytest.mark.parametrize("liquid", [iga.Liquid.water(), iga.Liquid.mercury()])
def test_si_and_dimensionless_input_agree(liquid):
    """Every measure, and the numbers without units, to 1e-9."""
    volume = iga.si("1 uL")
    plane = iga.Plane(contact_angle=140)
    solution = iga.solve(
        iga.sessile_droplet(plane, volume=volume, liquid=liquid, gravity=iga.si("9.81 m/s^2"))
    )
    length = (3.0 * volume / (4.0 * np.pi)) ** (1.0 / 3.0)
    tension = liquid.surface_tension
    bond = liquid.density * 9.81 * length**2 / tension
    unit = iga.solve(iga.sessile_droplet(plane, volume=4.0 * np.pi / 3.0, gravity=bond))
    energy, pressure = tension * length**2, tension / length
    for name, value in unit.measures.items():
        size = energy if name.lower().startswith("e") and name != "equator_radius" else pressure
        size = length ** DIMENSIONS[name] if name in DIMENSIONS else size
        assert solution.measures[name] / size == pytest.approx(value, rel=1e-9), name
    assert solution.dimensionless == pytest.approx(unit.dimensionless, rel=1e-9)
    assert unit.dimensionless["bond_number"] == pytest.approx(bond, rel=1e-12)


def test_numbers_without_units_stand_beside_the_results(tmp_path):
    drop = iga.solve(
        iga.sessile_droplet(
            iga.Plane(contact_angle=110),
            volume=iga.si("2 uL"),
            liquid=iga.Liquid.water(),
            gravity=9.81,
        )
    )
    length = (3.0 * 2e-9 / (4.0 * np.pi)) ** (1.0 / 3.0)
    numbers = drop.dimensionless
    assert numbers["bond_number"] == pytest.approx(998.0 * 9.81 * length**2 / 72.8e-3, rel=1e-12)
    assert numbers["apparent_angle"] == pytest.approx(110.0, abs=1e-4)
    assert numbers["wetted_fraction"] == pytest.approx(1.0, rel=1e-9)
    assert f"bond number {numbers['bond_number']:.6g}" in drop.summary()
    drop.save(tmp_path / "result.json")
    assert json.loads((tmp_path / "result.json").read_text())["dimensionless"] == numbers
