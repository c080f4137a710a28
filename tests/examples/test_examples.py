"""Every example runs and returns the physics it claims."""

import importlib.util
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_example_has_a_test():
    names = {path.stem for path in EXAMPLES.glob("*.py")}
    assert all(f"def test_{name}" in Path(__file__).read_text() for name in names)


def test_droplet_on_plane():
    rows = load("droplet_on_plane").main(angles=(60.0, 150.0, 175.0))
    assert max(row["error"] for row in rows) < 1e-6
    assert np.all(np.diff([row["height"] for row in rows]) > 0)
    assert np.all(np.diff([row["contact_radius"] for row in rows]) < 0)


def test_film_limit():
    rows, (low, high) = load("film_limit").main(heights=(0.4, 0.65), too_far=0.68)
    assert max(row["area_error"] for row in rows) < 1e-8
    assert rows[0]["smallest_eigenvalue"] > rows[1]["smallest_eigenvalue"] > 0
    assert low <= 0.6627435
    assert high >= 0.6627434
    assert high - low < 1e-3


def test_sheet_and_particle():
    solutions = load("sheet_and_particle").main(angles=(150.0, 120.0, 30.0))
    assert all(s.success for s in solutions)
    lines = [s.measures["F_CL"] for s in solutions]
    assert lines == sorted(lines)
    assert lines[0] > 0


def test_figure11():
    example = load("figure11")
    curves = example.main(angles=(30.0, 90.0, 170.0), bonds=(0.1, 1.0))
    assert all(np.all(np.diff(curve["F_e"]) < 0) for curve in curves.values())
    assert example.critical_angle(0.1) == pytest.approx(144.05640220715, abs=1e-5)
    assert example.critical_angle(1.0, name="F_e_down") is None
    assert example.largest_bond(1.0) == pytest.approx(1.17, rel=2e-2)


def test_self_cleaning_map():
    example = load("self_cleaning_map")
    with ThreadPoolExecutor(1) as executor:
        found, critical = example.main((60.0, 120.0), (0.2, 0.6), executor=executor)
    assert found.column("lifts").tolist() == [1.0, 1.0, 1.0, 0.0]
    assert example.answer(120.0, 0.6) == "stays"
    # a weightless sheet: the force falls linearly with the Bond number
    force = found.column("F_e_z").reshape(2, 2)
    assert critical == pytest.approx(0.2 + 0.4 * force[:, 0] / (force[:, 0] - force[:, 1]))


def test_droplet_on_asperities():
    found = load("droplet_on_asperities").main(radius=0.1)
    assert found["height_rough"] < found["height_flat"]
    assert found["wet_rough"] < 0.3 * found["wet_flat"]
    assert found["carried"] == pytest.approx(1.0, abs=1e-4)
    assert found["asperities"] == 21
    assert 0 < found["smallest_force"] < found["largest_force"] < 1.0
    assert found["penetration"] < 1e-3


def test_lotus_leaf():
    found = load("lotus_leaf").main(spacings=(0.1, 0.05))
    coarse, fine = found[0.1], found[0.05]
    assert fine["asperities"] > 3.0 * coarse["asperities"]
    for row in found.values():
        assert row["carried"] == pytest.approx(1.0, abs=1e-4)
        assert row["smallest_force"] > 0
        assert 0.55 < row["lower_by"] / row["sag"] < 0.75
    # the wetted part of the foot falls with the asperities' radius
    assert fine["wet_fraction"] == pytest.approx(0.5 * coarse["wet_fraction"], rel=0.15)


def test_contact_angles_on_asperities():
    found = load("contact_angles_on_asperities").main(
        angles=(180.0, 150.0), radius=0.1, elements=60
    )
    flat, steep = found[180.0], found[150.0]
    assert steep["height"] == pytest.approx(flat["height"], rel=2e-2)
    assert steep["equator_radius"] == pytest.approx(flat["equator_radius"], rel=5e-3)
    assert steep["A_wet"] > 1.5 * flat["A_wet"]
    assert steep["energy"] < flat["energy"]
    assert steep["asperities"] >= flat["asperities"]
    assert 149.0 < steep["smallest_angle"] < steep["largest_angle"] < 151.0
    assert steep["carried"] == pytest.approx(1.0, abs=1e-4)


def test_cassie_limit():
    example = load("cassie_limit")
    (row,) = example.main(angles=(130.0,), shapes=("circle",), per_radius=4)
    assert row["low"] < row["high"] < 1.001 * row["low"]
    assert row["low"] == pytest.approx(row["level_line"], rel=1e-3)
    assert row["polar"] > 90.0
    assert example.level_line(180.0, 0.04) == pytest.approx(0.1 * np.pi / (0.04 - np.pi * 0.05**2))


def test_particle_on_droplet():
    rows = load("particle_on_droplet").main(polar=(60.0, 90.0), elements=16)
    for row in rows:
        assert np.hypot(row["normal"], row["tangential"]) == pytest.approx(
            np.hypot(row["F_x"], row["F_z"])
        )
        assert row["hold"] == pytest.approx(row["F_x"], rel=5e-3)
        assert row["tangential"] < 0 < row["normal"]
    assert rows[0]["F_z"] > rows[1]["F_z"]
    assert rows[0]["F_x"] < rows[1]["F_x"]
