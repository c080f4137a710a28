"""The paper's droplet on spherical asperities at 180 degrees: R = 1, Bo = 1, r_s = 0.05."""

import json
from functools import cache
from time import process_time

import numpy as np
import pytest
from helpers import UNIT_VOLUME, some

import iga_membrane as iga
from iga_membrane.cli import main
from iga_membrane.reference import drop_on_plane

RADIUS, SPACING = 0.05, 0.2
# from meshes of 75 to 200 elements
HEIGHT, ENERGY, PRESSURE = 1.4325, 15.6514, 2.9052


@cache
def rough(arrangement="square", offset=(0.0, 0.0), elements=None, model=None, hold="xy", **options):
    scene = iga.sessile_droplet(
        iga.SphereLattice(180.0, RADIUS, SPACING, arrangement, offset),
        volume=UNIT_VOLUME,
        gravity=1.0,
        hold=hold,
        discretization=iga.Discretization(elements=elements, model=model),
        **options,
    )
    return iga.solve(scene, on_fail="return")


def check_forces(solution, allowed=1e-3):
    """Every wet asperity is pushed, down and without a net pull sideways; together the weight."""
    assert solution.success, solution.message
    vectors = np.array([a["force_vector"] for a in solution.contact["asperities"]])
    assert (vectors[:, 2] < 0).all()
    assert all(a["force"] > 0 for a in solution.contact["asperities"])
    carried = np.array([0.0, 0.0, -UNIT_VOLUME]) + solution.hold_force
    assert vectors.sum(axis=0) == pytest.approx(carried, abs=allowed * UNIT_VOLUME)
    assert solution.contact["max_penetration"] <= 1e-2 * RADIUS


@pytest.mark.slow
def test_the_papers_droplet_through_the_command_line(tmp_path):
    (tmp_path / "scene.toml").write_text(
        f'scene = "sessile_droplet"\n[liquid]\nvolume = {UNIT_VOLUME!r}\n'
        '[gravity]\nacceleration = 1.0\n[substrate]\nkind = "sphere_lattice"\n'
        f"contact_angle = 180.0\nradius = {RADIUS}\nspacing = {SPACING}\n"
        '[droplet]\nhold = "xy"\n'
    )
    assert main(["solve", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")]) == 0
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["status"] == "CONVERGED_STABLE"
    assert abs(result["measures"]["height"] - HEIGHT) < 5e-4
    assert result["contact"]["wet_solids"] == 45


@pytest.mark.slow
def test_a_finer_mesh_is_nearer_to_the_limit():
    coarse, fine = rough(elements=48), rough()
    for name, final in (("height", HEIGHT), ("energy", ENERGY), ("p_base", PRESSURE)):
        errors = [abs(s.measures[name] / final - 1.0) for s in (coarse, fine)]
        assert errors[1] < 0.5 * errors[0], name
        assert errors[1] < 3e-4, name


def test_the_papers_droplet():
    solution = rough()
    check_forces(solution)
    m = solution.measures
    assert abs(m["height"] - HEIGHT) < 5e-4
    assert m["energy"] == pytest.approx(ENERGY, rel=2e-4)
    assert m["p_base"] == pytest.approx(PRESSURE, rel=2e-4)
    asperities = solution.contact["asperities"]
    assert len(asperities) == solution.contact["wet_solids"] == 45
    # tops are level with the plane: the liquid sags between them, so the droplet stands lower
    flat = drop_on_plane(1.0, 180.0)
    assert 1e-2 < flat["height"] - m["height"] < RADIUS
    assert m["A_wet"] < 0.1 * flat["A_wet"]
    # p_c = p + 2 gamma / r presses on each spot
    share = np.array([a["force"] for a in asperities]) / (m["p_base"] + 2.0 / RADIUS)
    caps = 2.0 * np.pi * RADIUS**2 * (1.0 - np.sqrt(1.0 - share / (np.pi * RADIUS**2)))
    assert m["A_wet"] == pytest.approx(caps.sum(), rel=1e-6)


@pytest.mark.slow
def test_height_energy_and_forces_settle_with_the_mesh():
    coarse, middle, fine = (rough(elements=n) for n in (48, 75, 125))
    for name, final in (("height", HEIGHT), ("energy", ENERGY), ("p_base", PRESSURE)):
        errors = [abs(s.measures[name] / final - 1.0) for s in (coarse, middle, fine)]
        assert errors[1] < 0.5 * errors[0], name
        assert errors[2] < 0.5 * errors[1], name
        assert errors[2] < 2e-5, name
    missing = [
        abs(sum(a["force_vector"][2] for a in s.contact["asperities"]) / UNIT_VOLUME + 1.0)
        for s in (coarse, middle, fine)
    ]
    assert missing[2] < 0.5 * missing[0] < 1e-5
    assert missing[2] < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("start", ["above", pytest.param("touching", marks=pytest.mark.slow)])
def test_every_start_ends_in_the_same_state(start):
    base, other = rough(), rough(start=start)
    assert other.success
    for name in ("height", "energy", "p_base", "contact_radius"):
        assert other.measures[name] == pytest.approx(base.measures[name], rel=1e-4), name


@pytest.mark.slow
def test_a_penalty_sinks_by_the_pressure_over_it():
    penalty = 2e4
    solution = rough(penalty=penalty, penetration_tolerance=0.2)
    assert solution.success
    sunk = (solution.measures["p_base"] + 2.0 / RADIUS) / penalty
    assert sunk < 0.05 * RADIUS
    assert solution.contact["max_penetration"] == pytest.approx(sunk, rel=0.2)
    # the default tolerance does not let it pass
    refused = rough(penalty=penalty)
    assert refused.status is iga.Status.PENETRATION
    assert "penetration_tolerance" in refused.message


@pytest.mark.parametrize("penalty", some((5e4, 1e6, 1e9), {0}))
def test_a_hard_penalty_sinks_by_the_pressure_over_it_on_the_same_mesh(penalty):
    solution = rough(penalty=penalty, penetration_tolerance=0.2)
    assert solution.success, solution.message
    sunk = (solution.measures["p_base"] + 2.0 / RADIUS) / penalty
    assert solution.contact["max_penetration"] == pytest.approx(sunk, rel=0.2)
    assert solution.contact["law"] == "penalty"
    elements = [
        each.scene.description["discretization"]["elements"] for each in (solution, rough())
    ]
    assert elements[0] == elements[1]
    assert abs(solution.measures["height"] - HEIGHT) < 8e-4


def test_the_papers_penalty_lowers_the_droplet():
    solution = rough(penalty=1e4, penetration_tolerance=0.2)
    assert solution.success
    assert HEIGHT - solution.measures["height"] == pytest.approx(2.2e-3, rel=0.1)


def test_a_penalty_that_drowns_the_asperities_is_no_success():
    solution = rough(elements=38, penalty=1e2)
    assert solution.status is iga.Status.PENETRATION


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arrangement", "offset", "model", "wet"),
    some([("hexagonal", (0.0, 0.0), "quarter", 55), ("square", (0.1, 0.1), "eighth", 52)], {0}),
)
def test_other_lattices_take_the_model_of_their_mirror_planes(arrangement, offset, model, wet):
    solution = rough(arrangement, offset, elements=60)
    assert solution.scene.sector.model == model
    check_forces(solution)
    assert solution.contact["wet_solids"] == wet
    # as many asperities per area carry as much
    assert abs(solution.measures["height"] - HEIGHT) < 5e-3


@pytest.mark.slow
def test_a_droplet_off_a_lattice_site_rests_too():
    solution = rough("square", (0.03, 0.0), elements=60)
    assert solution.scene.sector.model == "half"
    check_forces(solution)
    assert abs(solution.measures["height"] - HEIGHT) < 4e-3


@pytest.mark.slow
def test_large_asperities_far_apart_cannot_carry_the_pressure():
    radius, spacing = 0.2, 0.8
    most = 2.0 * np.pi * radius / (spacing**2 - np.pi * radius**2)
    lattice = iga.SphereLattice(180.0, radius, spacing)

    def at(bond):
        scene = iga.sessile_droplet(lattice, volume=UNIT_VOLUME, gravity=bond, hold="xy")
        return iga.solve(scene, on_fail="return")

    light = at(0.3)
    assert light.success
    assert light.contact["max_penetration"] <= 1e-2 * radius
    assert light.measures["p_base"] < most < drop_on_plane(1.0, 180.0)["p_base"]
    heavy = at(1.0)
    assert not heavy.success
    assert f"carries {most:.4g} at most" in heavy.message
    assert "carries" not in light.message


def scattered(sizes, apart=0.35, reach=1.5, seed=5):
    """Spheres at random, their tops in z = 0, no two closer than a distance."""
    rng, places = np.random.default_rng(seed), []
    for place in rng.uniform(-reach, reach, (20_000, 2)):
        if all(np.hypot(*(place - other)) >= apart for other in places):
            places.append(place)
    radii = rng.choice(sizes, len(places))
    return iga.Spheres(180.0, np.column_stack([places, -radii]), radii)


@pytest.mark.slow
@pytest.mark.parametrize("sizes", [(0.1,), (0.1, 0.15)], ids=["one size", "two sizes"])
def test_random_asperities_in_the_full_model(sizes):
    scene = iga.sessile_droplet(scattered(sizes), volume=UNIT_VOLUME, gravity=1.0)
    assert scene.sector.model == "full"
    solution = iga.solve(scene)
    vectors = np.array([a["force_vector"] for a in solution.contact["asperities"]])
    assert len(vectors) >= 10
    assert (vectors[:, 2] < 0).all()
    total = vectors.sum(axis=0) / UNIT_VOLUME
    assert total[2] == pytest.approx(-1.0, abs=1e-3)
    # sideways the tractions balance as far as the edges of the wet spots are resolved
    assert np.abs(total[:2]).max() < 5e-3
    assert solution.contact["max_penetration"] <= 1e-2 * min(sizes)


@pytest.mark.slow
def test_ten_thousand_asperities_cost_no_more_than_four_hundred():
    from iga_membrane.assembly.lagrangian import Assembly

    foot = np.pi * drop_on_plane(1.0, 180.0)["contact_radius"] ** 2

    def seconds(count):
        spacing = float(np.sqrt(foot / count))
        lattice = iga.SphereLattice(180.0, 0.25 * spacing, spacing)
        listed = iga.Spheres(180.0, lattice.center_of(lattice.within(1.2)), lattice.radius)
        assert len(lattice.within(np.sqrt(foot / np.pi))) == pytest.approx(count, rel=0.05)
        scene = iga.sessile_droplet(
            listed,
            volume=UNIT_VOLUME,
            gravity=1.0,
            discretization=iga.Discretization(elements=75, model="eighth"),
        )
        # what an iteration evaluates; how often its line search halves is another matter
        assembly, surface = Assembly(scene), scene.local_surface()
        directions = assembly.spines.on(surface).directions
        started = process_time()
        for depth in np.linspace(0.0, 0.02 * lattice.radius, 5):
            moved = surface.moved(surface.points - [0.0, 0.0, depth])
            assembly.energies(moved)
            assembly.system(moved, directions, np.zeros(assembly.multipliers))
        return process_time() - started

    few, many = ([seconds(count) for _ in range(4)] for count in (400, 10_000))
    assert min(many[1:]) <= 1.5 * min(few[1:])
