"""Contact angles at asperities: cells against closed forms, droplets by balances and refinement."""

from functools import cache, partial

import numpy as np
import pytest
import round_cell
from helpers import some

import iga_membrane as iga

RADIUS = 0.05


exact_cell = partial(round_cell.exact, outer=0.1, radius=RADIUS)
largest_pressure = partial(round_cell.largest_pressure, outer=0.1, radius=RADIUS)


def cell(angle, pressure, *, shape="circle", place=(0.0, 0.0), degree=2, elements=None):
    sphere = iga.Sphere(angle, RADIUS, (*place, -RADIUS))
    mesh = iga.Discretization(degree=degree, elements=elements)
    return iga.asperity_cell(
        sphere, size=0.2, pressure=pressure, shape=shape, discretization=mesh,
        contact_line="trimmed",
    )  # fmt: skip


SCALES = {"phi_deg": np.degrees(1.0), "A_wet": RADIUS**2, "F_sphere": RADIUS, "F_press": RADIUS}


def errors(solution, exact):
    return {k: abs(solution.measures[k] - v) / SCALES.get(k, RADIUS) for k, v in exact.items()}


@pytest.mark.parametrize("share", some((0.1, 0.5, 0.95), {0, 2}))
@pytest.mark.parametrize("angle", some((90.0, 105.0, 120.0, 135.0, 150.0, 160.0), {0, 2, 4, 5}))
def test_a_round_cell_agrees_with_its_closed_form(angle, share):
    pressure = share * largest_pressure(angle)
    solution = iga.solve(cell(angle, pressure, elements=16))  # h = r / 8
    assert max(errors(solution, exact_cell(angle, pressure)).values()) < 1e-4
    assert solution.measures["contact_angle_measured"] == pytest.approx(angle, abs=1.0)


@pytest.mark.parametrize("angle", [165.0, 170.0])
def test_a_round_cell_near_180_degrees(angle):
    pressure = 0.3 * largest_pressure(angle)
    solution = iga.solve(cell(angle, pressure, elements=16))
    assert max(errors(solution, exact_cell(angle, pressure)).values()) < 1e-3


@pytest.mark.parametrize(("degree", "rate", "last"), [(2, 2.5, 3e-7), (3, 3.0, 1e-8)])
def test_contact_lines_converge_with_the_degree(degree, rate, last):
    exact = exact_cell(150.0, 2.0)
    found = [
        errors(iga.solve(cell(150.0, 2.0, degree=degree, elements=n)), exact) for n in (8, 16, 32)
    ]
    for name in ("phi_deg", "z_edge", "A_wet"):
        first, _, third = (e[name] for e in found)
        assert np.log2(first / third) / 2.0 > rate, name
        assert third < last, name


@pytest.mark.parametrize("place", some([((0.0, 0.0),), ((0.02, 0.0),), ((0.02, 0.01),)], {2}))
def test_a_square_cell_carries_its_pressure_and_converges(place):
    coarse, fine = (
        iga.solve(cell(150.0, 2.0, shape="square", place=place, elements=n)) for n in (24, 40)
    )
    assert fine.measures["F_sphere"] == pytest.approx(2.0 * 0.2**2, rel=1e-9)
    for name in ("phi_deg", "sag", "z_edge", "z_corner", "A_wet"):
        scale = SCALES.get(name, RADIUS)
        assert abs(fine.measures[name] - coarse.measures[name]) / scale < 3e-5, name
    sideways = np.array(fine.contact["asperities"][0]["force_vector"][:2])
    # the nearer wall pulls the sphere's membrane less: none in the middle
    assert (np.abs(sideways) < 1e-9).all() if place == (0.0, 0.0) else sideways[0] > 1e-3


@pytest.mark.slow  # examples/cassie_limit.py brackets one among the default tests
@pytest.mark.parametrize("angle", [120.0, 150.0])
def test_beyond_the_largest_pressure_a_cell_is_lost(angle):
    most = largest_pressure(angle)
    assert iga.solve(cell(angle, 0.99 * most, elements=10)).success
    lost = iga.solve(cell(angle, 1.02 * most, elements=10), on_fail="return")
    assert lost.status is iga.Status.LIMIT_POINT
    assert lost.bracket.lo == pytest.approx(most, rel=5e-3)
    assert lost.bracket.hi == pytest.approx(most, rel=5e-3)
    assert (lost.bracket.index_lo, lost.bracket.index_hi) == (0, 1)


def papers_droplet(angle, elements=None, **lattice):
    asperities = iga.SphereLattice(angle, RADIUS, 0.2, **lattice)
    mesh = iga.Discretization(elements=elements)
    return iga.sessile_droplet(
        asperities, volume=4.0 * np.pi / 3.0, gravity=1.0, hold="xy", discretization=mesh
    )


@cache
def papers_solution(angle):
    """On the default mesh."""
    return iga.solve(papers_droplet(angle))


def assert_balanced(solution, angle):
    assert solution.contact["support_force"] == pytest.approx(4.0 * np.pi / 3.0, rel=1e-5)
    for asperity in solution.contact["asperities"]:
        assert asperity["contact_angle"] == pytest.approx(angle, abs=1.0)


def test_the_same_cell_twice_is_the_same_to_the_last_digit():
    scene = cell(150.0, 2.0, elements=16)
    assert iga.solve(scene).measures == iga.solve(scene).measures


@pytest.mark.slow
def test_the_same_droplet_twice_is_the_same_to_the_last_digit():
    assert iga.solve(papers_droplet(150.0)).measures == papers_solution(150.0).measures


@pytest.mark.slow
@pytest.mark.parametrize("angle", [160.0, 150.0, 135.0, 120.0])
def test_the_papers_droplet_on_its_default_mesh_is_converged(angle):
    coarse, fine = papers_solution(angle), iga.solve(papers_droplet(angle, elements=96))
    for solution in (coarse, fine):
        assert_balanced(solution, angle)
    assert coarse.contact["wet_solids"] == fine.contact["wet_solids"]
    assert coarse.measures["height"] == pytest.approx(fine.measures["height"], abs=5e-5)
    assert coarse.measures["energy"] == pytest.approx(fine.measures["energy"], rel=5e-6)


@pytest.mark.slow
def test_an_angle_for_each_sphere():
    """Each line meets its own sphere's angle."""
    near, far = 0.15, 0.45
    places = [(near, near), (near, far), (far, near)]
    centers = [[sx * x, sy * y, -0.1] for x, y in places for sx in (1, -1) for sy in (1, -1)]
    angles = [140.0] * 4 + [150.0] * 8
    substrate = iga.Spheres(angles, centers, 0.1)
    solution = iga.solve(
        iga.sessile_droplet(substrate, volume=4.0 * np.pi / 3.0, gravity=1.0, hold="xy"),
        on_fail="return",
    )
    assert solution.success, solution.message
    assert solution.contact["support_force"] == pytest.approx(4.0 * np.pi / 3.0, rel=5e-4)
    for asperity in solution.contact["asperities"]:
        expected = angles[asperity["index"]]
        assert asperity["contact_angle"] == pytest.approx(expected, abs=1.5)


def test_a_penalty_is_refused_where_there_are_contact_lines():
    with pytest.raises(iga.SceneError, match="penalty"):
        iga.asperity_cell(
            iga.Sphere(150.0, 0.05, (0, 0, -0.05)), size=0.2, pressure=2.0, penalty=1e4
        )
    lattice = iga.SphereLattice(150.0, 0.05, 0.2)
    with pytest.raises(iga.SceneError, match="penalty"):
        iga.sessile_droplet(lattice, volume=4.0, gravity=1.0, penalty=1e4)
    with pytest.raises(iga.SceneError, match="conforming"):
        iga.sessile_droplet(lattice, volume=4.0, gravity=1.0, contact_line="conforming")
    with pytest.raises(iga.SceneError, match="no penalty"):
        iga.sessile_droplet(iga.Plane(150.0), volume=4.0, contact_line="trimmed", penalty=1e4)


@pytest.mark.parametrize("angle", [172.0, 176.0, 179.0, 179.9])
def test_adhesion_near_180_degrees_agrees_with_the_closed_form(angle):
    sphere = iga.Sphere(angle, RADIUS, (0.0, 0.0, -RADIUS))
    scene = iga.asperity_cell(
        sphere, size=0.2, pressure=2.0, shape="circle", contact_line="adhesion"
    )
    solution = iga.solve(scene)
    found = errors(solution, exact_cell(angle, 2.0))
    assert found.pop("sag") < 3e-3
    assert found.pop("z_edge") < 3e-3
    assert max(found.values()) < 1e-6


@pytest.mark.slow
def test_angles_near_180_degrees_tend_to_exact_contact():
    whole = papers_solution(180.0).measures
    for angle in (176.0, 177.0, 178.0, 179.0):
        near = iga.solve(papers_droplet(angle)).measures
        # wetting gains int A d cos(theta); A grows like the square root of 1 + cos(theta)
        area = (whole["A_wet"] + 2.0 * near["A_wet"]) / 3.0
        gain = (1.0 + np.cos(np.radians(angle))) * area
        off = whole["energy"] - near["energy"]
        # asperities are resolved to 2e-6 of the energy
        assert off == pytest.approx(gain, rel=0.1, abs=2e-6 * whole["energy"])
        assert near["height"] == pytest.approx(whole["height"], abs=2e-5)
        if angle <= 177.0:
            assert off == pytest.approx(gain, rel=0.1)
    last = iga.solve(papers_droplet(179.9)).measures
    assert last["energy"] == pytest.approx(whole["energy"], abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("angle", "most"), [(150.0, 8.997), (120.0, 6.956), (100.0, 5.245)])
def test_a_square_cell_is_lost_at_the_pressure_of_a_round_line(angle, most):
    """Vertical equilibrium with a round contact line estimates the de-pinning pressure."""
    lost = iga.solve(cell(angle, 1.1 * most, shape="square"), on_fail="return")
    assert lost.status is iga.Status.LIMIT_POINT
    assert lost.bracket.lo == pytest.approx(most, rel=3e-3)
    assert lost.bracket.hi == pytest.approx(most, rel=3e-3)


@pytest.mark.slow
def test_the_liquid_that_comes_down_to_the_base_is_named():
    """Wenzel onset: the membrane between the asperities touches the plane under them."""
    free = papers_solution(150.0)
    x = free.surface.at(
        np.stack(np.meshgrid(*[np.linspace(-0.3, 0.3, 241)] * 2, indexing="ij"), axis=-1), 1
    ).position
    outside = free.scene.substrate.nearest(x).gap > 0
    lowest = float(x[..., 2][outside].min())
    low = iga.solve(papers_droplet(150.0, base=lowest - 1e-3), on_fail="return")
    assert low.success
    high = iga.solve(papers_droplet(150.0, base=lowest + 1e-3), on_fail="return")
    assert high.status is iga.Status.TOPOLOGY_CHANGE
    assert high.kind == "touches_base"
