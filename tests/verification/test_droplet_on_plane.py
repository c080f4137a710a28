"""Droplets on a plane through the command line, at the default discretization."""

import json
from pathlib import Path

import numpy as np
import pytest
from helpers import MEASURES, UNIT_VOLUME, droplet, slopes, solved, some, worst

import iga_membrane as iga
from iga_membrane.cli import main
from iga_membrane.reference import drop_on_plane

CASES = json.loads((Path(__file__).parent / "sessile_drops.json").read_text())
BELOW_180 = [case for case in CASES if case["contact_angle"] < 180]


@pytest.mark.parametrize(
    "case",
    some(BELOW_180, range(0, len(BELOW_180), 3)),
    ids=lambda c: f"Bo{c['bond']}-{c['contact_angle']}",
)
def test_published_drops_through_the_command_line(case, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'scene = "sessile_droplet"\n'
        f"[liquid]\nsurface_tension = 1.0\ndensity = 1.0\nvolume = {UNIT_VOLUME!r}\n"
        f"[gravity]\nacceleration = {float(case['bond'])!r}\n"
        f'[substrate]\nkind = "plane"\ncontact_angle = {float(case["contact_angle"])!r}\n'
    )
    assert main(["solve", str(scene), "--out", str(tmp_path / "out")]) == 0
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["status"] == "CONVERGED_STABLE"
    extreme = not 10 < case["contact_angle"] < 170 or case["bond"] >= 60
    assert worst(result["measures"], case["values"]) <= (1e-3 if extreme else 1e-6)
    assert result["newton_iterations"] <= 15
    assert result["load_steps"] == 1


FAMILY = [(angle, bond) for bond in (0, 0.05, 0.7, 5, 30, 100)
          for angle in (3, 10, 45, 90, 135, 160, 175, 177, 179)]  # fmt: skip
QUICK = {0: (10, 179), 0.05: (177,), 0.7: (45,), 5: (160,), 30: (3, 90), 100: (179,)}
"""Angles of those among the default tests, by their Bond numbers."""


@pytest.mark.parametrize(
    ("angle", "bond"),
    [
        pytest.param(*one, marks=[] if one[0] in QUICK[one[1]] else [pytest.mark.slow])
        for one in FAMILY
    ],
)
def test_other_drops_of_the_family(angle, bond):
    solution = solved(angle, bond)
    extreme = not 10 < angle < 170 or bond >= 60
    assert worst(solution.measures, drop_on_plane(bond, angle)) <= (1e-3 if extreme else 1e-6)
    if 10 <= angle <= 175 and bond <= 5:
        assert solution.newton_iterations <= 15
        assert len(solution.load_steps) == 1


RATES = [("bspline", 2), ("bspline", 3), ("bspline", 4), ("nurbs", 2), ("nurbs", 3)]
RATES += [("lagrange", 2), ("lagrange", 3), ("lagrange", 4)]
ELEMENTS = {2: (8, 16, 32, 64), 3: (8, 16, 32), 4: (4, 8, 16)}


@pytest.mark.parametrize(("space", "degree"), some(RATES, {0, 2, 4, 6}))
def test_pressure_and_energy_superconverge(space, degree):
    exact = drop_on_plane(1.0, 120.0)
    errors = {"p_base": [], "energy": []}
    for elements in ELEMENTS[degree]:
        m = iga.solve(
            droplet(120, 1.0, space=space, degree=degree, elements=elements), on_fail="return"
        ).measures
        for name, found in errors.items():
            found.append(m[name] / exact[name] - 1.0)
    for name, found in errors.items():
        rate = slopes(found).mean()
        asked = 2 * degree - (1.0 if space == "nurbs" else 0.5)
        assert rate >= min(asked, 7.0), (name, found)
        assert abs(found[-1]) < {2: 1e-6, 3: 1e-8, 4: 1e-9}[degree], name


@pytest.mark.parametrize("space", ["bspline", "lagrange"])
@pytest.mark.parametrize("degree", [2, 3, 4])
@pytest.mark.parametrize(
    "meshes", [(4, 8, 16), pytest.param((4, 8, 16, 32), marks=pytest.mark.slow)]
)
def test_shape_and_curvature_converge_at_the_order_of_the_space(space, degree, meshes):
    """Without gravity the drop is a sphere. Even degrees gain an order on its equal knots."""
    exact = drop_on_plane(0.0, 120.0)
    radius = exact["sphere_radius"]
    centre = [0.0, 0.0, exact["height"] - radius]
    shape, curvature = [], []
    for elements in meshes:
        scene = droplet(120, 0.0, space=space, degree=degree, elements=elements)
        solution = iga.solve(scene, on_fail="return")
        table = solution.surface.space.table(degree + 3, second=True)
        k = solution.surface.on(table)
        w = k.area_element * table.weights
        distance = np.linalg.norm(k.position - centre, axis=-1) - radius
        shape.append(np.sqrt((distance**2 * w).sum()))
        curvature.append(np.sqrt(((k.mean_curvature + 1 / radius) ** 2 * w).sum()))
    assert slopes(shape)[1:] == pytest.approx(2 * (degree // 2) + 2, abs=0.15)
    assert slopes(curvature)[-1] >= degree - 1.2
    assert shape[-1] < {2: 1e-4, 3: 1e-5, 4: 1e-6}[degree]
    assert curvature[-1] < {2: 5e-2, 3: 5e-3, 4: 5e-4}[degree]


def test_models_give_the_same_numbers():
    base = solved(150, 1.0, model="quarter")
    for model in ("eighth", "half", "full"):
        other = solved(150, 1.0, model=model)
        for name in MEASURES:
            assert other.measures[name] == pytest.approx(base.measures[name], rel=1e-10), name


def test_contact_angle_and_laplace_residual_show_the_error():
    rms = []
    for elements in (8, 16, 32):
        solution = iga.solve(droplet(120, 1.0, degree=3, elements=elements), on_fail="return")
        table = solution.surface.space.table(second=True)
        k = solution.surface.on(table)
        w = k.area_element * table.weights
        residual = solution.laplace_residual(k) / solution.measures["p_base"]
        rms.append(np.sqrt((residual**2 * w).sum() / w.sum()))
        if elements == 32:
            off = np.abs(solution.mean_curvature(k) - k.mean_curvature)
            assert np.sqrt((off**2 * w).sum() / w.sum()) < 1e-3
            assert np.abs(solution.in_plane_residual(k)).max() < 1e-8
    assert slopes(rms).min() >= 1.8
    solution = solved(120, 1.0)
    table = solution.surface.space.table(second=True)
    k = solution.surface.on(table)
    w = k.area_element * table.weights
    residual = solution.laplace_residual(k) / solution.measures["p_base"]
    assert np.sqrt((residual**2 * w).sum() / w.sum()) <= 1e-3
    assert solution.measures["contact_angle_measured"] == pytest.approx(120.0, abs=0.1)
