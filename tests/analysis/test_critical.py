"""Critical contact angles and the largest Bond numbers with lift-off, against references."""

import json
from pathlib import Path

import pytest
from helpers import particle_sheet, some

import iga_membrane as iga

CASES = json.loads(
    (Path(__file__).parents[1] / "verification" / "critical_angles.json").read_text()
)
MEASURES = {
    "physical": lambda s: s.forces[0].effective[2],
    "paper_up": lambda s: s.forces[0].paper["F_e_up"],
    "paper_down": lambda s: s.forces[0].paper["F_e_down"],
}


def sheet(angle, bond, d=0.0, weight=False):
    return particle_sheet(angle, center=(0, 0, d - 1), gravity=bond, liquid_weight=weight)


def critical(case, name, low=1.0, high=175.0):
    p = case["params"]
    return iga.critical_value(
        lambda angle: sheet(angle, p["Bp"], p["d"], p["gravity_on_sheet"]),
        MEASURES[name],
        low,
        high,
    )


@pytest.mark.parametrize("case", some((CASES[0], CASES[2]), {0}), ids=["weak", "above"])
def test_critical_angles(case):
    (angle,) = case["values"]["physical"]
    found = critical(case, "physical")
    assert found.value == pytest.approx(angle, abs=1e-3)
    assert not found.rising
    assert found.solution.success
    assert abs(MEASURES["physical"](found.solution)) <= 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(CASES)))
@pytest.mark.parametrize("name", MEASURES)
def test_all_critical_angles(number, name):
    case = CASES[number]
    for angle in case["values"].get(name, ()):
        assert critical(case, name).value == pytest.approx(angle, abs=1e-3)


def test_without_a_change_of_sign_both_values_are_named():
    with pytest.raises(iga.SceneError) as caught:
        critical(CASES[1], "paper_down", 20.0, 160.0)
    ends = [MEASURES["paper_down"](iga.solve(sheet(angle, 1.0))) for angle in (20.0, 160.0)]
    assert all(f"{force:.6g}" in str(caught.value) for force in ends)
    assert "low, high = 20, 160" in str(caught.value)


def test_ends_in_the_wrong_order_are_refused():
    with pytest.raises(iga.SceneError, match="high"):
        critical(CASES[0], "physical", 170.0, 10.0)


def test_a_critical_value_of_a_closed_form():
    """The pressure at which a cap on a circle of radius 1 holds a given volume."""
    depth = 0.5
    found = iga.critical_value(
        lambda p: iga.liquid_sheet(size=2.0, boundary="circle", pressure=p),
        lambda s: s.measures["sag"] - depth,
        0.5,
        1.9,
    )
    assert found.value == pytest.approx(4 * depth / (1 + depth**2), rel=1e-8)
    assert found.rising


@pytest.mark.parametrize(
    ("name", "angle", "bond"),
    [
        ("physical", 1.0, 1.17),
        pytest.param("paper_up", 1.0, 4.57, marks=pytest.mark.slow),
        pytest.param("paper_down", 27.0, 0.86, marks=pytest.mark.slow),
    ],
)
def test_largest_bond_number_with_lift_off(name, angle, bond):
    found = iga.critical_value(
        lambda b: sheet(angle, b), MEASURES[name], 0.5 * bond, 2.0 * bond, tolerance=1e-6
    )
    assert found.value == pytest.approx(bond, rel=2e-2)
    assert not found.rising


@pytest.mark.slow
def test_the_downward_reading_lifts_best_near_27_degrees():
    best = [
        iga.critical_value(lambda b, a=a: sheet(a, b), MEASURES["paper_down"], 0.1, 3.0).value
        for a in (15.0, 27.0, 40.0)
    ]
    assert best[1] == max(best)
