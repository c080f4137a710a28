"""Films and bridges between rings: exact catenoids, and none beyond their limit (L3)."""

import json

import numpy as np
import pytest
from helpers import slopes, some

import iga_membrane as iga
from iga_membrane.cli import main
from iga_membrane.reference import catenoid
from iga_membrane.reference.catenoid import LIMIT


@pytest.mark.parametrize("half_height", [0.1, 0.3, 0.5, 0.6, 0.65, 0.66])
def test_catenoids_are_exact(half_height):
    found = iga.solve(iga.film_between_rings(half_height=half_height)).measures
    exact = catenoid(half_height)
    assert found["A_LG"] == pytest.approx(exact["A_LG"], rel=1e-8)
    for name in ("neck_radius", "force", "volume"):
        assert found[name] == pytest.approx(exact[name], rel=1e-6), name
    assert found["end_slope_deg"] == pytest.approx(exact["end_slope_deg"], rel=1e-5)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_area_superconverges(degree):
    errors = [
        iga.solve(
            iga.film_between_rings(
                half_height=0.55, discretization=iga.Discretization("bspline", degree, elements)
            ),
            on_fail="return",
        ).measures["A_LG"]
        / catenoid(0.55)["A_LG"]
        - 1.0
        for elements in (4, 8, 16)
    ]
    assert slopes(errors).mean() >= min(2 * degree - 0.5, 7)
    assert abs(errors[-1]) < {2: 1e-6, 3: 1e-8, 4: 1e-9}[degree]


@pytest.mark.parametrize(
    ("degree", "elements", "beyond"),
    [
        (2, 8, 1.04),
        (3, 8, 1.02),
        (3, 16, 1.005),
        *(
            pytest.param(degree, elements, beyond, marks=pytest.mark.slow)
            for degree, elements in ((2, 8), (3, 8), (3, 16), (4, 20))
            for beyond in (1.005, 1.02, 1.04)
        ),
    ],
)
def test_no_film_beyond_the_limit_on_any_mesh(degree, elements, beyond):
    scene = iga.film_between_rings(
        half_height=beyond * LIMIT,
        discretization=iga.Discretization("bspline", degree, elements),
    )
    solution = iga.solve(scene, on_fail="return")
    assert solution.status is iga.Status.LIMIT_POINT
    bracket = solution.bracket
    assert bracket.parameter == "rings.half_height"
    assert bracket.lo <= LIMIT * (1 + 1e-4)
    assert bracket.hi >= LIMIT * (1 - 1e-4)
    assert bracket.hi - bracket.lo <= 1e-3
    assert bracket.index_lo == 0


@pytest.mark.parametrize("share", [0.9, 0.99, 0.999, 0.9999])
def test_approach_to_the_limit_stays_accurate(share):
    solution = iga.solve(iga.film_between_rings(half_height=share * LIMIT))
    exact = catenoid(share * LIMIT)
    assert solution.newton_iterations <= 15
    assert solution.measures["neck_radius"] == pytest.approx(exact["neck_radius"], rel=1e-5)


@pytest.mark.parametrize(
    ("half_height", "ratio", "pressure", "force"),
    [(0.5, 0.8, -0.0401, 5.3724), (1.0, 1.5, 1.3513, 0.8689), (2.0, 0.8, 1.0724, 2.8857)],
)
def test_bridges_carry_pressure_and_pull(half_height, ratio, pressure, force):
    volume = ratio * 2 * np.pi * half_height
    solution = iga.solve(iga.film_between_rings(half_height=half_height, volume=volume))
    m = solution.measures
    assert m["volume"] == pytest.approx(volume, rel=1e-10)
    assert m["pressure"] == pytest.approx(pressure, abs=1e-4)
    assert m["force"] == pytest.approx(force, abs=1e-4)
    neck = m["neck_radius"]
    assert 2 * np.pi * neck - np.pi * neck**2 * m["pressure"] == pytest.approx(m["force"], rel=1e-6)


def test_bridge_and_film_under_its_pressure_are_the_same():
    volume = 1.1 * 2 * np.pi * 0.4
    bridge = iga.solve(iga.film_between_rings(half_height=0.4, volume=volume))
    film = iga.solve(iga.film_between_rings(half_height=0.4, pressure=bridge.measures["pressure"]))
    assert film.measures["volume"] == pytest.approx(volume, rel=1e-8)


def test_film_through_the_command_line(tmp_path):
    scene = tmp_path / "film.toml"
    text = 'scene = "film_between_rings"\n[rings]\nradius = 2.0\nhalf_height = {}\n'
    scene.write_text(text.format(1.0))
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 0
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["measures"]["A_LG"] == pytest.approx(4 * catenoid(0.5)["A_LG"], rel=1e-8)
    scene.write_text(text.format(1.4))
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 3
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["status"] == "LIMIT_POINT"
    assert result["bracket"]["lo"] <= 2 * LIMIT <= result["bracket"]["hi"]


@pytest.mark.parametrize(
    ("rings", "said"),
    [
        ({}, "rings.half_height: missing"),
        ({"half_height": -1.0}, "half_height must be > 0"),
        ({"half_height": 0.5, "volume": 1.0, "pressure": 1.0}, "both are prescribed"),
    ],
)
def test_bad_rings_are_refused(rings, said):
    with pytest.raises(iga.SceneError, match=said):
        iga.read_scene({"scene": "film_between_rings", "rings": rings})


@pytest.mark.parametrize(("ratio", "stable"), some([(1.5, True), (4.0, False)], {1}))
def test_swollen_bridge_gives_way_sideways(ratio, stable):
    """Its round state is stable against round disturbances; others are seen by every model."""
    volume, round_only = ratio * np.pi, iga.SolverOptions(stability="model")
    verdicts = []
    for model in ("eighth", None):
        mesh = iga.Discretization(model=model)
        scene = iga.film_between_rings(half_height=0.5, volume=volume, discretization=mesh)
        if model:
            assert iga.solve(scene, round_only).success
        found = iga.solve(scene, on_fail="return")
        assert found.success == stable
        assert stable or found.status is iga.Status.CONVERGED_SADDLE
        verdicts.append((found.index, pytest.approx(found.lambda_min, rel=1e-4)))
    assert verdicts[0] == verdicts[1]
