"""Contact areas at 180 degrees: drops on a plane, sheets on a particle, cells of rough surfaces."""

import json
from pathlib import Path

import numpy as np
import pytest
from helpers import UNIT_VOLUME, some

import iga_membrane as iga
from iga_membrane.cli import main
from iga_membrane.reference import drop_on_plane

CASES = json.loads((Path(__file__).parent / "contact_areas.json").read_text())
SHEETS = [c for c in CASES if c["family"] in ("F2", "F3")]
CELLS = [c for c in CASES if c["family"] == "F5"]
RADIUS, SIZE, PRESSURE = 0.05, 0.2, 3.5


def solved_by_command(text, tmp_path):
    """Exit code and result file of a scene file."""
    scene = tmp_path / "scene.toml"
    scene.write_text(text)
    code = main(["solve", str(scene), "--out", str(tmp_path / "out")])
    return code, json.loads((tmp_path / "out" / "result.json").read_text())


def cell(shape, elements, center=(0.0, 0.0, -RADIUS), model=None, pressure=PRESSURE):
    mesh = iga.Discretization(elements=elements, model=model)
    sphere = iga.Sphere(180.0, RADIUS, center)
    return iga.solve(
        iga.asperity_cell(sphere, size=SIZE, pressure=pressure, shape=shape, discretization=mesh)
    )


@pytest.mark.parametrize("bond", some((0.01, 0.3, 1.0, 10.0, 100.0), {0, 2, 4}))
def test_drops_on_a_plane_rest_on_a_flat_spot(bond, tmp_path):
    code, result = solved_by_command(
        f'scene = "sessile_droplet"\n[liquid]\nvolume = {UNIT_VOLUME!r}\n'
        f"[gravity]\nacceleration = {bond!r}\n[substrate]\ncontact_angle = 180.0\n",
        tmp_path,
    )
    assert code == 0
    found, exact = result["measures"], drop_on_plane(bond, 180.0)
    for name in ("height", "p_base", "energy"):
        assert found[name] == pytest.approx(exact[name], rel=1e-5), name
    assert found["contact_radius"] == pytest.approx(exact["contact_radius"], rel=1e-3)
    # the spot carries the weight: nothing pulls along its edge
    assert np.pi * found["contact_radius"] ** 2 * found["p_base"] == pytest.approx(
        bond * UNIT_VOLUME, rel=1e-3
    )


@pytest.mark.parametrize("case", SHEETS, ids=lambda c: c["family"])
def test_sheets_leave_a_particle_tangentially(case, tmp_path):
    p = case["params"]
    code, result = solved_by_command(
        'scene = "liquid_sheet"\n'
        f"[[particle]]\nradius = {float(p['rp'])!r}\ncenter = [0.0, 0.0, {p['d'] - p['rp']!r}]\n"
        f'contact_angle = 180.0\n[sheet]\nboundary = "circle"\nsize = {2.0 * p["Rb"]!r}\n'
        f"pressure = {float(p['p'])!r}\n",
        tmp_path,
    )
    assert code == 0
    found = result["measures"]
    for name in ("phi_deg", "contact_radius", "z_contact", "F_CL", "F_P", "F_total", "energy"):
        value = case["values"][name]
        assert found[name] == pytest.approx(value, rel=1e-6, abs=1e-7), name
    assert found["psi_deg"] == pytest.approx(-found["phi_deg"], abs=1e-6)


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(
            case,
            marks=[] if case["exists"] else [pytest.mark.slow],
            id=f"p{case['params']['p']}",
        )
        for case in CELLS
    ],
)
def test_round_cells_of_a_rough_surface(case, tmp_path):
    p = case["params"]
    code, result = solved_by_command(
        'scene = "asperity_cell"\n'
        f'[substrate]\nkind = "sphere"\nradius = {p["rs"]!r}\ncontact_angle = 180.0\n'
        f'[cell]\nshape = "circle"\nsize = {2.0 * p["Rc"]!r}\npressure = {float(p["p"])!r}\n',
        tmp_path,
    )
    if not case["exists"]:
        # the wet spot cannot pass the sphere's equator: 2 pi r gamma / (area - pi r^2)
        limit = 2.0 * np.pi * p["rs"] / (np.pi * (p["Rc"] ** 2 - p["rs"] ** 2))
        bracket = result["bracket"]
        assert code == 3
        assert result["status"] == "LIMIT_POINT"
        assert bracket["lo"] < limit <= bracket["hi"]
        assert bracket["hi"] - bracket["lo"] < 0.012 * limit
        return
    assert code == 0
    found, exact = result["measures"], case["values"]
    for name, allowed in {
        "energy": 1e-5 * RADIUS,
        "F_sphere": 1e-8,
        "contact_radius": 1e-8,
        "phi_deg": 1e-5,
        "F_press": 1e-8,
        "F_line": 1e-8,
        "sag": 1e-3 * RADIUS,
        "z_edge": 1e-3 * RADIUS,
    }.items():
        assert abs(found[name] - exact[name]) <= allowed, name


@pytest.mark.slow
def test_sag_and_energy_of_a_round_cell_converge():
    """The spot's edge falls anywhere in an element, so errors change sign from mesh to mesh: the
    mean over neighbouring meshes is what converges."""
    exact = next(c["values"] for c in CELLS if c["params"]["p"] == PRESSURE)
    groups = ((8, 9, 10, 11, 12), (16, 18, 20, 22, 24), (32, 36, 40, 44, 48))
    mean = {
        name: [
            np.mean([abs(cell("circle", n).measures[name] - exact[name]) for n in group])
            for group in groups
        ]
        for name in ("sag", "energy")
    }
    for errors, allowed in ((mean["sag"], 3e-4 * RADIUS), (mean["energy"], 3e-5 * RADIUS**2)):
        assert 0.5 * np.log2(errors[0] / errors[-1]) >= 1.8
        assert errors[-1] < allowed


@pytest.mark.parametrize("elements", [16, 24])
def test_the_sphere_of_a_square_cell_carries_all_the_pressure(elements):
    m = cell("square", elements).measures
    total = PRESSURE * SIZE**2
    assert m["F_sphere"] == pytest.approx(total, rel=1e-6)
    # the membrane follows the sphere, so it presses with p + 2 gamma / r
    spot = total / (PRESSURE + 2.0 / RADIUS)
    assert np.pi * m["contact_radius"] ** 2 == pytest.approx(spot, rel=1e-6)
    assert m["F_press"] == pytest.approx(PRESSURE * spot, rel=1e-6)
    assert m["z_edge"] > m["z_corner"]


def test_sag_of_a_square_cell_settles():
    means = [
        np.mean([cell("square", n).measures["sag"] for n in group])
        for group in ((8, 10, 12), (16, 20, 24), (32, 40, 48))
    ]
    assert abs(means[1] - means[0]) > 3.0 * abs(means[2] - means[1])
    assert abs(means[2] - means[1]) < 2e-3 * RADIUS


def test_a_sphere_off_the_middle_is_drawn_to_its_mirror_image():
    half, full = (cell("square", 16, (0.02, 0.0, -RADIUS), model) for model in ("half", "full"))
    for name, value in half.measures.items():
        assert full.measures[name] == pytest.approx(value, rel=1e-8), name
    skew = cell("square", 16, (0.02, -0.01, -RADIUS))
    assert skew.scene.sector.model == "full"
    total = PRESSURE * SIZE**2
    for solution, signs in ((half, (1, 0)), (skew, (1, -1))):
        (asperity,) = solution.contact["asperities"]
        x, y, z = asperity["force_vector"]
        assert z == pytest.approx(-total, rel=1e-6)
        assert solution.measures["F_sphere"] == pytest.approx(total, rel=1e-6)
        assert [np.sign(round(v, 9)) for v in (x, y)] == list(signs)
    # the force is minus the slope of the energy, so the energy is lower there
    assert half.measures["energy"] < (1.0 - 1e-3) * cell("square", 16).measures["energy"]


def test_a_sphere_carries_no_more_than_its_section():
    """The membrane hangs from the equator at most: p s^2 = (p + 2 gamma / r) pi r^2."""
    most = 2.0 * np.pi * RADIUS / (SIZE**2 - np.pi * RADIUS**2)
    below = cell("square", 16, pressure=0.9 * most)
    assert 65.0 < below.measures["phi_deg"] < 90.0
    sphere = iga.Sphere(180.0, RADIUS, (0.0, 0.0, -RADIUS))
    mesh = iga.Discretization(elements=8)
    above = iga.asperity_cell(sphere, size=SIZE, pressure=1.05 * most, discretization=mesh)
    assert not iga.solve(above, on_fail="return").success


def test_forces_and_sag_do_not_depend_on_units():
    one = cell("square", 12).measures
    sphere = iga.Sphere(180.0, 1e3 * RADIUS, (0.0, 0.0, -1e3 * RADIUS))
    big = iga.solve(
        iga.asperity_cell(
            sphere,
            size=1e3 * SIZE,
            pressure=1e-3 * 0.07 * PRESSURE,
            liquid=iga.Liquid(surface_tension=0.07),
            discretization=iga.Discretization(elements=12),
        )
    ).measures
    assert big["sag"] == pytest.approx(1e3 * one["sag"], rel=1e-9)
    assert big["F_sphere"] == pytest.approx(70.0 * one["F_sphere"], rel=1e-9)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"size": 0.1}, "cell.size"),
        ({"pressure": 0.0}, "cell.pressure"),
        ({"shape": "hexagon"}, "cell.shape"),
        ({"penalty": -1.0}, "solver.penalty"),
    ],
)
def test_bad_cells_are_refused_by_name(values, said):
    good = {"size": SIZE, "pressure": PRESSURE}
    with pytest.raises(iga.SceneError, match=said):
        iga.asperity_cell(iga.Sphere(180.0, RADIUS, (0, 0, -RADIUS)), **(good | values))


def largest_pressure(shape, size):
    """The spot's projected area is at most the sphere's disc: (p + 2 / r) pi r^2 = p A."""
    area = size**2 if shape == "square" else 0.25 * np.pi * size**2
    return 2.0 * np.pi / (area - np.pi)


def cell_at(shape, size, part):
    return iga.asperity_cell(
        iga.Sphere(contact_angle=180.0, radius=1.0, center=(0.0, 0.0, -1.0)),
        size=size,
        shape=shape,
        pressure=part * largest_pressure(shape, size),
    )


@pytest.mark.parametrize(
    ("shape", "size", "part"),
    [("circle", 4.0, 0.99), ("circle", 2.6, 0.97), ("square", 3.4, 0.995), ("circle", 5.0, 0.4)],
)
def test_a_cell_is_solved_up_to_its_largest_pressure(shape, size, part):
    """sin(phi)^2 = p A / (pi r^2 (p + 2 gamma / r)), in round and square cells alike."""
    found = iga.solve(cell_at(shape, size, part))
    pressure = part * largest_pressure(shape, size)
    area = size**2 if shape == "square" else 0.25 * np.pi * size**2
    assert found.measures["F_sphere"] == pytest.approx(pressure * area, rel=1e-9)
    sine = np.sqrt(pressure * area / (np.pi * (pressure + 2.0)))
    assert np.sin(np.radians(found.measures["phi_deg"])) == pytest.approx(sine, rel=1e-6)
    assert len(found.load_steps) == 1


@pytest.mark.parametrize(
    ("shape", "size", "part"),
    [("circle", 4.0, 1.001), ("circle", 3.0, 2.0), ("square", 4.0, 1.2)],
)
def test_a_cell_beyond_its_largest_pressure_is_bracketed_there(shape, size, part):
    found = iga.solve(cell_at(shape, size, part), on_fail="return")
    most = largest_pressure(shape, size)
    assert found.status is iga.Status.LIMIT_POINT
    assert found.bracket.hi == pytest.approx(most, rel=1e-12)
    assert 0.0 < found.bracket.hi - found.bracket.lo <= 1e-3 * most
    assert found.measures["phi_deg"] > 88.0
    assert len(found.load_steps) <= 12


def test_a_path_of_pressures_ends_at_the_largest():
    most = largest_pressure("circle", 4.0)
    values = [0.5 * most, 0.9 * most, 1.3 * most]
    path = iga.trace(
        lambda p: cell_at("circle", 4.0, p / most),
        values,
        parameter="cell.pressure",
        on_fail="return",
    )
    last = path.end
    assert len(path.solutions) == 2
    assert last.status is iga.Status.LIMIT_POINT
    assert last.bracket.lo < most <= last.bracket.hi * (1.0 + 1e-12)
    assert last.bracket.hi - last.bracket.lo <= 1e-3 * most
