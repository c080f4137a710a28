"""Sheets with a circular rim on a spherical particle: shape, forces, critical angles."""

import json
from pathlib import Path

import pytest
from helpers import slopes, some

import iga_membrane as iga
from iga_membrane.cli import main

HERE = Path(__file__).parent
CASES = json.loads((HERE / "sheets_on_particles.json").read_text())
CRITICAL = json.loads((HERE / "critical_angles.json").read_text())
LISTED = ("phi_deg", "contact_radius", "cap_height", "z_contact", "psi_deg", "F_CL", "F_P",
          "F_total", "A_LG", "A_wet", "V_cap", "V_liq", "E_surf", "energy")  # fmt: skip


def case_id(case):
    p = case["params"]
    return f"{case['family']}-{p['theta_deg']}-d{p['d']}-p{p['p']}-g{p['g']}"


def sheet(angle, d=0.0, *, bond=0.0, weight=False, density=1.0, **options):
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=(0, 0, d - 1), density=density)
    options = {"boundary": "circle", "size": 5.0} | options
    return iga.liquid_sheet(particle, gravity=bond, liquid_weight=weight, **options)


def quick_or_slow(case):
    """A parameter; a third of them are among the default tests, none of the limits that a path has
    to find at 179 degrees."""
    far = case["params"]["theta_deg"] > 175.0 or case["family"] != "F2"
    slow = (not case["exists"] and far) or CASES.index(case) % 3
    return pytest.param(case, marks=[pytest.mark.slow] if slow else [], id=case_id(case))


@pytest.mark.parametrize("case", [quick_or_slow(case) for case in CASES])
def test_sheets_through_the_command_line(case, tmp_path):
    p = case["params"]
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'scene = "liquid_sheet"\n'
        f"[gravity]\nacceleration = {float(p['g'])!r}\n"
        f"[[particle]]\nradius = {float(p['rp'])!r}\ncenter = [0.0, 0.0, {p['d'] - p['rp']!r}]\n"
        f"contact_angle = {float(p['theta_deg'])!r}\n"
        f'[sheet]\nboundary = "circle"\nsize = {2 * p["Rb"]!r}\npressure = {float(p["p"])!r}\n'
        f"liquid_weight = {'true' if p['g'] else 'false'}\n"
    )
    code = main(["solve", str(scene), "--out", str(tmp_path / "out")])
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    if not case["exists"]:
        assert code == 3
        assert result["status"] == "LIMIT_POINT"
        return
    assert code == 0
    allowed = 1e-3 if p["theta_deg"] >= 170 else 1e-6
    for name in LISTED:
        value = case["values"][name]
        assert abs(result["measures"][name] - value) <= allowed * max(abs(value), 1.0), name


@pytest.mark.parametrize("angle", some((5, 20, 45, 75, 105, 135, 165, 175), {0, 2, 5, 7}))
def test_direct_newton_at_every_angle(angle):
    solution = iga.solve(sheet(angle))
    assert solution.newton_iterations <= 16
    assert len(solution.load_steps) == 1


@pytest.mark.parametrize("degree", [2, 3])
def test_variational_force_superconverges(degree):
    exact = next(
        c["values"]["F_total"]
        for c in CASES
        if (c["params"]["theta_deg"], c["params"]["d"], c["params"]["p"]) == (120, 0, 0.1)
    )
    errors = []
    for elements in (8, 16, 32):
        mesh = iga.Discretization("bspline", degree, elements)
        scene = sheet(120, pressure=0.1, discretization=mesh)
        errors.append(iga.solve(scene, on_fail="return").measures["F_total"] / exact - 1.0)
    assert slopes(errors)[-1] >= 2 * degree - 0.5
    assert abs(errors[-1]) < {2: 1e-5, 3: 1e-7}[degree]


@pytest.mark.parametrize(
    "case", some(CRITICAL, {0, 2}), ids=lambda c: f"Bp{c['params']['Bp']}-d{c['params']['d']}"
)
def test_forces_vanish_at_the_critical_angles(case):
    p = case["params"]
    for name, angles in case["values"].items():
        if name == "paper_p0A":
            continue
        for critical in angles:
            found = [
                iga.solve(
                    sheet(critical + off, p["d"], bond=p["Bp"], weight=p["gravity_on_sheet"])
                ).forces[0]
                for off in (-1e-3, 1e-3)
            ]
            below, above = (
                f.effective[2]
                if name == "physical"
                else f.paper["F_e" + name.removeprefix("paper")]
                for f in found
            )
            assert below > 0 > above, name


def test_line_integral_and_variational_force_agree():
    m = iga.solve(sheet(100, pressure=0.2)).measures
    assert m["F_CL_line"] == pytest.approx(m["F_CL"], rel=1e-5)


def test_a_volume_and_its_pressure_give_the_same_sheet():
    base = iga.solve(sheet(110, pressure=0.2)).measures
    held = iga.solve(sheet(110, volume=base["V_liq"])).measures
    assert held["pressure"] == pytest.approx(0.2, rel=1e-8)
    assert held["phi_deg"] == pytest.approx(base["phi_deg"], rel=1e-8)


def test_a_sweep_of_the_angle_comes_back_where_it_started():
    there = [iga.solve(sheet(a)).measures["F_CL"] for a in (150, 120, 90, 60, 30)]
    back = [iga.solve(sheet(a)).measures["F_CL"] for a in (30, 60, 90, 120, 150)]
    assert there == pytest.approx(back[::-1], rel=1e-10)
    assert there == sorted(there)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"center": [2.6, 0, -1]}, "must lie inside the rim"),
        ({"contact_angle": 180.0, "boundary": "square"}, "not available yet"),
        ({"motion": "resting"}, "only on a plane"),
        ({"pressure": 0.1, "volume": 1.0}, "both are prescribed"),
        ({"radius": -1.0}, "radius must be > 0"),
    ],
)
def test_bad_sheets_are_refused(change, said):
    table = {"boundary": "circle", "size": 5.0}
    particle = {"radius": 1.0, "center": [0, 0, -1.0], "contact_angle": 90.0}
    for key, value in change.items():
        (particle if key in ("center", "contact_angle", "motion", "radius") else table)[key] = value
    with pytest.raises(iga.SceneError, match=said):
        iga.read_scene({"scene": "liquid_sheet", "sheet": table, "particle": [particle]})
