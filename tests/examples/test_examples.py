"""Every example runs and returns the physics it claims."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from helpers import EXAMPLES
from helpers import example as load
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

import iga_membrane as iga


def test_every_example_has_a_test():
    names = {path.stem for path in EXAMPLES.glob("*.py")}
    assert all(f"def test_{name}" in Path(__file__).read_text() for name in names)


def test_droplet_on_plane():
    rows = load("droplet_on_plane").main(angles=(60.0, 150.0, 175.0))
    assert max(row["error"] for row in rows) < 1e-6
    assert np.all(np.diff([row["height"] for row in rows]) > 0)
    assert np.all(np.diff([row["contact_radius"] for row in rows]) < 0)


def test_goniometer(tmp_path):
    found = load("goniometer").main(tmp_path, seed=3)
    assert found["contact_angle"] == pytest.approx(105.0, abs=0.15)
    assert found["volume"] == pytest.approx(4e-9, rel=3e-3)
    assert found["solved_radius"] == pytest.approx(found["contact_radius"], rel=1e-3)
    assert (tmp_path / "goniometer.png").exists()


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


@pytest.mark.slow
def test_paper_figures():
    found = load("paper_figures").main(
        radius=0.1, load_steps=3, elements=40, only=("5", "6", "7", "10c")
    )
    for one in found:
        for name in one.figure.measures if one.paper else ():
            assert one.paper.measures[name] == pytest.approx(one.ours.measures[name], rel=5e-3)
        assert all(row.count("|") == 8 for row in one.rows())
    # the paper's penalty lets the droplet sink into asperities
    sunk = next(one for one in found if one.figure.name == "6")
    assert sunk.paper.measures["height"] < sunk.ours.measures["height"]


@pytest.mark.slow
def test_figure11():
    example = load("figure11")
    curves = example.main(angles=(30.0, 90.0, 170.0), bonds=(0.1, 1.0))
    assert all(np.all(np.diff(curve["F_e"]) < 0) for curve in curves.values())
    assert example.critical_angle(0.1) == pytest.approx(144.05640220715, abs=1e-5)
    assert example.critical_angle(1.0, name="F_e_down") is None
    assert example.largest_bond(1.0) == pytest.approx(1.17, rel=2e-2)


@pytest.mark.slow
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


@pytest.mark.slow  # tests/verification has contact lines on droplets among the default tests
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


@pytest.mark.slow
def test_cassie_limit():
    example = load("cassie_limit")
    (row,) = example.main(angles=(130.0,), shapes=("circle",), per_radius=4)
    assert row["low"] < row["high"] < 1.001 * row["low"]
    assert row["low"] == pytest.approx(row["level_line"], rel=1e-3)
    assert row["polar"] > 90.0
    assert example.level_line(180.0, 0.04) == pytest.approx(0.1 * np.pi / (0.04 - np.pi * 0.05**2))


@pytest.mark.slow  # tests/verification has one particle on asperities among the default tests
def test_whole_system():
    found = load("whole_system").main(elements=64)
    weight = np.linalg.norm(found["weight"])
    assert np.abs(found["missing"]).max() < 1e-3 * weight
    # the droplet pushes all three outwards
    assert found["particle 0"][0] > 0.02 > -0.02 > found["particle 1"][0]
    assert all(found[f"particle {k}"][2] > 0.05 for k in range(3))


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


SCRIPTS = (
    "own_substrate", "own_energy", "own_space", "own_scene", "parameter_sweep", "critical_angle",
    "convergence_study",
)  # fmt: skip


@pytest.mark.parametrize("name", SCRIPTS)
def test_scripts_have_at_most_twenty_lines(name):
    lines = (EXAMPLES / f"{name}.py").read_text().splitlines()[1:]
    assert sum(bool(line.strip()) for line in lines) <= 20


@pytest.mark.slow
def test_textures(tmp_path):
    example = load("textures")
    drops = example.main(tmp_path)
    assert all(drop.success for drop in drops.values())
    carton = drops["egg carton"]
    foot = carton.measures["contact_radius"]
    wenzel = carton.measures["A_wet"] / (np.pi * foot**2) * np.cos(np.radians(105.0))
    angle = example.cap_angle(foot, carton.measures["volume"])
    assert np.cos(np.radians(angle)) == pytest.approx(wenzel, abs=0.05)


@pytest.mark.slow
def test_pillars():
    example = load("pillars")
    round_, flat = example.main(rims=(0.15, 0.1), radius=0.15, elements=48)
    spheres = example.droplet(iga.SphereLattice(180.0, 0.15, 0.6), elements=48)
    for name in ("height", "pressure"):
        assert round_[name] == pytest.approx(spheres.measures[name], rel=1e-10)
    assert round_["A_wet"] == pytest.approx(spheres.measures["A_wet"], rel=2e-2)
    assert round_["pillars"] == spheres.contact["wet_solids"]
    for row in (round_, flat):
        assert row["carried"] == pytest.approx(1.0, abs=1e-4)
    assert flat["A_wet"] > round_["A_wet"]
    assert flat["height"] > round_["height"]


def test_own_substrate():
    drop, (across, along, height) = load("own_substrate").main()
    assert drop.success
    assert along > 1.003 * across
    assert height < across
    weight = drop.measures["volume"]
    assert drop.contact["support_force"] == pytest.approx(weight, rel=1e-4)
    # tangent to round ridges, the force over p + gamma / r is the wet area's projection
    pressure, radius = drop.measures["p_base"], 0.15
    forces = sum(each["force"] for each in drop.contact["asperities"])
    assert 1.0 < drop.measures["A_wet"] / (forces / (pressure + 1.0 / radius)) < 1.06


def film_middle(load_, height):
    """Height of the middle of the film, by shooting along its meridian from there."""
    strength = load_ * height**3

    def rates(r, y):
        z, pull = y  # pull = (1 + f) r sin(slope)
        gap = z + height
        sine = pull / r / (1.0 - strength / gap)
        long = 1.0 / np.sqrt(1.0 - sine**2)
        return [sine * long, strength / gap**2 * r * long]

    def edge(middle):
        start = 1e-6
        pull = 0.5 * strength / (middle + height) ** 2 * start**2
        ends = {"rtol": 1e-11, "atol": 1e-14}
        return solve_ivp(rates, (start, 1.0), [middle, pull], **ends).y[0, -1]

    return brentq(edge, -0.44 * height, 0.0, xtol=1e-12)


@pytest.mark.slow
def test_own_energy():
    path = load("own_energy").main(loads=(0.7, 0.8))
    for value, solution in zip(path.values, path.solutions, strict=True):
        middle = solution.surface.at([0.0, 1.0]).position[2]
        assert middle == pytest.approx(film_middle(value, 0.05), rel=1e-7)
    assert path.end.status is iga.Status.LIMIT_POINT
    # the pull-in load of a disc, 0.789 where the film is nearly flat
    assert 0.99 * 0.789 < path.bracket.lo < path.bracket.hi < 0.789


def test_own_space():
    study = load("own_space").main(elements=(4, 8))
    smooth, rough = study.of("bspline", 3), study.of("rough", 3)
    assert rough[-1].unknowns > 1.5 * smooth[-1].unknowns
    assert study.rates("rough", 3, "energy")[0] > 5.5
    assert abs(rough[-1].errors["energy"]) < 5e-8


def hanging_volume(pressure):
    """Volume of the drop of Bond number 1 that hangs from a ring of radius 1, integrated from its
    lowest point, where the pressure is given."""

    def rates(s, y):
        r, z, psi, _ = y
        around = np.sin(psi) / r if r > 1e-9 else 0.5 * pressure
        return [np.cos(psi), np.sin(psi), pressure - z - around, np.pi * r**2 * np.sin(psi)]

    def at_ring(s, y):
        return y[0] - 1.0

    start = [1e-10, 0.0, 0.0, 0.0]
    tight = {"rtol": 1e-9, "atol": 1e-11}
    return solve_ivp(rates, (0.0, 6.0), start, events=at_ring, **tight).y_events[0][0][3]


def test_own_scene():
    path = load("own_scene").main(volumes=(2.0, 6.0))
    assert path.end.status is iga.Status.LIMIT_POINT
    most = -minimize_scalar(lambda p: -hanging_volume(p), (2.5, 2.65, 2.8)).fun
    assert path.bracket.lo <= 1.0002 * most
    assert path.bracket.hi >= 0.9998 * most
    assert path.bracket.hi - path.bracket.lo < 1e-3 * most


def test_parameter_sweep(tmp_path):
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(1) as executor:
        found = load("parameter_sweep").main(
            angles=(60.0, 150.0), bonds=(0.5, 2.0), out=tmp_path, executor=executor
        )
    heights = found.column("height").reshape(2, 2)
    assert np.all(heights[1] > heights[0])
    assert np.all(heights[:, 0] > heights[:, 1])


@pytest.mark.slow
def test_critical_angle():
    assert load("critical_angle").main().value == pytest.approx(144.05640220715, abs=1e-5)


@pytest.mark.slow
def test_critical_tilt():
    """Stable up to a limit point; until then the particle carries what pulls the droplet down."""
    path = load("critical_tilt").main(elements=8)
    assert path.end.status is iga.Status.LIMIT_POINT
    assert (path.bracket.index_lo, path.bracket.index_hi) == (0, 1)
    assert 5.0 < path.bracket.lo < path.bracket.hi < 1.02 * path.bracket.lo
    for tilt, solution in zip(path.values, path.solutions, strict=True):
        pull = 0.5 * 4.0 / 3.0 * np.pi * np.sin(np.radians(tilt))
        assert solution.forces[0].effective[0] == pytest.approx(pull, abs=2e-3)
        assert solution.hold_force == (0.0, 0.0, 0.0)


@pytest.mark.slow
def test_critical_tilt_converges():
    coarse, middle, fine = (load("critical_tilt").main(n).bracket.lo for n in (8, 12, 18))
    assert abs(fine - middle) < 0.5 * abs(middle - coarse)
    assert fine == pytest.approx(middle, rel=1e-2)


def test_convergence_study():
    study = load("convergence_study").main(elements=(8, 16))
    assert study.rates("bspline", 3, "energy")[0] > 5.5
    assert study.rates("bspline", 2, "energy")[0] > 4.0
    splines, lagrange = (study.of(name, 2)[-1] for name in ("bspline", "lagrange"))
    assert splines.unknowns < 0.3 * lagrange.unknowns
    assert abs(splines.errors["energy"]) < 5e-8


@pytest.mark.slow
def test_jobs_of_a_first_day():
    """All commands end with code 0, in empty folders."""
    spent = load("../benchmarks/first_day").main(here=True)
    assert len(spent) == 5
    assert max(cpu for cpu, _ in spent.values()) < 60.0


@pytest.mark.slow
def test_capillary_bridge():
    example = load("capillary_bridge")
    curves = example.main(part=(0.1, 0.5, 1.3))
    for one in curves.values():
        assert np.all(np.diff(one.forces) < 0.0)
        assert one.rupture is not None
        assert one.rupture[1] - one.rupture[0] < 1e-3 * one.rupture[1]
    spheres = curves["spheres"]
    fits = [example.willett(gap) for gap in spheres.gaps]
    assert spheres.forces == pytest.approx(fits, rel=0.04)
    assert spheres.rupture[0] == pytest.approx(example.lian(), rel=0.05)
