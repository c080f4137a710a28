"""Quantities as text and of pint, units through to the results, and the same droplet in SI and
without dimensions (I12)."""

import json
from functools import cache

import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.quantities import SIZES, UNITS, Quantity, dimension_of, unit_of


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


WATER = {"surface_tension": 0.0728, "density": 998.0}
FILES = [
    {
        "scene": "sessile_droplet",
        "liquid": WATER | {"volume": 3e-9},
        "gravity": {"acceleration": 9.81},
        "substrate": {"kind": "plane", "contact_angle": 90.0},
        "particle": [
            {"radius": 3e-4, "center": [0.0, 0.0, 1.1e-3], "density": 1500.0, "contact_angle": 90.0}
        ],
        "discretization": {"elements": 6},
    },
    {
        "scene": "sessile_droplet",
        "liquid": WATER | {"volume": 3e-9},
        "substrate": {
            "kind": "height_map", "contact_angle": 115.0, "shape": "two_level",
            "amplitudes": [1e-5, 5e-6], "periods": [1e-3, 4e-4],
        },
        "discretization": {"elements": 6},
    },
    {
        "scene": "sessile_droplet",
        "liquid": WATER | {"volume": 3e-9},
        "substrate": {
            "kind": "sphere_lattice", "contact_angle": 120.0, "radius": 1e-5, "spacing": 3e-4,
            "offset": [1e-5, 0.0], "base": -1e-4,
        },
        "discretization": {"elements": 6},
    },
    {
        "scene": "film_between_rings",
        "liquid": WATER,
        "rings": {"radius": 1e-3, "half_height": 4e-4, "volume": 2e-9},
        "discretization": {"elements": 6},
    },
    {
        "scene": "asperity_cell",
        "liquid": WATER,
        "substrate": {"kind": "sphere", "contact_angle": 110.0, "radius": 1e-5},
        "cell": {"size": 4e-5, "pressure": 100.0},
        "discretization": {"elements": 6},
    },
    {
        "scene": "liquid_sheet",
        "liquid": WATER,
        "sheet": {"size": 5e-3, "pressure": 3.0},
        "discretization": {"elements": 6},
    },
]  # fmt: skip


def in_unit(field, value, unit):
    """A file's value with the numbers of a dimension as text in one of its units."""
    if isinstance(value, dict):
        return {key: in_unit(f"{field}.{key}", item, unit) for key, item in value.items()}
    if isinstance(value, list):
        return [in_unit(field, item, unit) for item in value]
    size, dimension = UNITS[unit]
    if isinstance(value, float) and dimension_of(field) == dimension:
        return f"{value / size!r} {unit}"
    return value


def leaves(value):
    """The numbers and words of nested tables in order."""
    if isinstance(value, dict):
        return [leaf for item in value.values() for leaf in leaves(item)]
    if isinstance(value, (list, tuple)):
        return [leaf for item in value for leaf in leaves(item)]
    return [value]


@cache
def plain(number):
    return iga.read_scene(FILES[number] | {"units": "SI"}).scene


@pytest.mark.parametrize("unit", ["um", "ul", "mN/m", "g/cm^3", "cm/s^2", "kPa", "deg"])
def test_a_field_in_any_of_its_units_is_the_field_in_si(unit):
    """The same scene to rounding, whichever table the number stands in."""
    met = 0
    for number, file in enumerate(FILES):
        asked = in_unit("", file, unit)
        if asked == file:
            continue
        met += 1
        scene = iga.read_scene(asked | {"units": "SI"}).scene
        assert scene.unit_system == plain(number).unit_system == "SI"
        both = leaves(scene.description), leaves(plain(number).description)
        for one, two in zip(*both, strict=True):
            assert one == (pytest.approx(two, rel=1e-12) if isinstance(two, float) else two)
    assert met


def test_degrees_alone_do_not_make_a_scene_si():
    scene = iga.sessile_droplet(
        iga.Plane(contact_angle="115 deg"),
        volume=1.0,
        discretization=iga.Discretization(elements=6),
    )
    assert scene.unit_system == "dimensionless"


@pytest.mark.parametrize("given", [{}, {"liquid": iga.Liquid(1.0, 998.0)}])
def test_a_tension_left_out_beside_units_is_refused(given):
    """It would be one newton per metre."""
    with pytest.raises(
        iga.SceneError, match=r"surface_tension = 1\.0: was left out or has no unit"
    ):
        iga.sessile_droplet(iga.Plane(contact_angle=90), volume="1 uL", **given)


def test_pint_speaks_for_itself():
    unit = pytest.importorskip("pint").UnitRegistry()
    gravity = np.array([0.0, 0.0, -981.0]) * unit.cm / unit.s**2
    scene = iga.sessile_droplet(
        iga.Plane(contact_angle=(np.pi / 2) * unit.rad),
        volume=2 * unit.microliter,
        liquid=iga.Liquid(72.8 * unit.dyne / unit.cm, 0.998 * unit.g / unit.mL),
        gravity=gravity,
        discretization=iga.Discretization(elements=6),
    )
    assert scene.unit_system == "SI"
    liquid = scene.description["liquid"]
    wanted = {"surface_tension": 0.0728, "density": 998.0, "volume": 2e-9}
    assert liquid == pytest.approx(wanted, rel=1e-12)
    assert scene.acceleration == pytest.approx((0.0, 0.0, -9.81), rel=1e-12)
    assert scene.description["substrate"]["contact_angle"] == pytest.approx(90.0, rel=1e-12)
    with pytest.raises(iga.SceneError, match="Cannot convert"):
        iga.Liquid(surface_tension=3 * unit.microliter)
    with pytest.raises(iga.SceneError, match="without a unit"):
        iga.SolverOptions(max_cpu_s=3 * unit.minute)


@pytest.fixture(scope="module")
def in_si():
    return iga.solve(iga.read_scene(in_unit("", FILES[3], "mm")).scene)


def test_units_outlive_a_state_file_and_a_change(in_si, tmp_path):
    in_si.save(tmp_path / "state.npz")
    again = iga.load(tmp_path / "state.npz").scene
    assert again.unit_system == again.at("rings.radius", 1.1e-3).unit_system == "SI"
    assert type(again.recipe.arguments["radius"]) is Quantity


def test_results_tables_and_texts_say_their_units(in_si, tmp_path):
    in_si.save(tmp_path / "result.json")
    in_si.save(tmp_path / "shape.vtu")
    record = json.loads((tmp_path / "result.json").read_text())
    assert record["units"] == record["scene"]["units"] == in_si.row()["units"] == "SI"
    assert record["unit_of"] == {name: unit_of(name, "SI") for name in in_si.measures}
    for name, unit in (("E_surf", "J"), ("A_LG", "m^2"), ("pressure", "Pa"), ("volume", "m^3"),
                       ("neck_radius", "m"), ("force", "N"), ("end_slope_deg", "deg")):  # fmt: skip
        assert record["unit_of"][name] == unit
        assert f"{in_si.measures[name]:.10g} {unit}\n" in in_si.summary()
        assert f"{in_si.measures[name]:.6g} {unit}" in repr(in_si).replace("\n  ", " ")
    assert '"units"' in (tmp_path / "shape.vtu").read_text()
    # what the numbers without dimensions are told by their names says all that SI calls by units
    assert {of for _, of in UNITS.values()} == set(SIZES)


def test_numbers_without_units_say_so():
    film = iga.solve(
        iga.film_between_rings(half_height=0.4, discretization=iga.Discretization(elements=6))
    )
    assert film.row()["units"] == "dimensionless"
    assert "dimensionless" in film.summary()
    assert "dimensionless" in repr(film)
    assert " m" not in repr(film).splitlines()[1]


def test_a_liquid_of_the_table_makes_a_scene_si():
    """Its numbers are in SI, so the scene's are; a changed number is, too, in any unit."""
    mesh = iga.Discretization(elements=6)
    scene = iga.sessile_droplet(
        iga.Plane(contact_angle=90), volume=3e-9, liquid=iga.Liquid.water(), discretization=mesh
    )
    assert scene.unit_system == "SI"
    larger = scene.at("liquid.volume", "4 uL")
    assert larger.unit_system == "SI"
    assert larger.description["liquid"]["volume"] == 4e-9
    tense = iga.sessile_droplet(
        iga.Plane(90), volume=3e-9, liquid=iga.Liquid("50 mN/m", 998.0), discretization=mesh
    )
    assert tense.at("liquid.surface_tension", 0.07).unit_system == "SI"
    with pytest.raises(iga.SceneError, match="quantity of volume"):
        scene.at("liquid.volume", "4 mm")


def test_every_measure_has_a_dimension():
    """A measure that the table of names forgets would have no unit."""
    coarse = {"discretization": iga.Discretization(elements=6, degree=3)}
    scenes = [
        iga.sessile_droplet(iga.Plane(100), volume=1.0, **coarse),
        iga.sessile_droplet(iga.Sphere(100, 2.0, (0.0, 0.0, -2.0)), volume=1.0, **coarse),
        iga.liquid_sheet(iga.Sphere(90, 1.0, (0.0, 0.0, -0.2)), size=5.0, boundary="circle",
                         **coarse),
        iga.film_between_rings(half_height=0.4, **coarse),
        iga.capillary_bridge(iga.Plane(60), iga.Sphere(60, 1.0), gap=0.3, volume=0.3),
        iga.asperity_cell(iga.Sphere(120.0, 1.0), size=4.0, pressure=0.1),
    ]  # fmt: skip
    for scene in scenes:
        measures = iga.solve(scene, on_fail="return").measures
        assert not [name for name in measures if not dimension_of(name)], scene.kind
