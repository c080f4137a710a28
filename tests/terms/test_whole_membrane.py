"""Terms and motion of the paper's formulation: exact derivatives, what they hold and what not."""

from dataclasses import replace

import numpy as np
import pytest
from helpers import UNIT_VOLUME
from taylor import lagrangian_slopes, remainder_slopes

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.splines import line_basis
from iga_membrane.terms import NormalLineLoad, PlaneContactLine, SphereContactLine
from iga_membrane.terms import stabilization as stable
from iga_membrane.terms.stabilization import PreviousMetric
from iga_membrane.terms.variations import element_points

NONE = iga.terms.BodyDensity()


def sheet(angle=100.0, model="eighth", boundary="circle", **how):
    particle = iga.Sphere(angle, 1.0, (0.0, 0.0, -1.0))
    mesh = iga.Discretization(degree=2, elements=6, model=model)
    return iga.liquid_sheet(
        particle, size=5.0, boundary=boundary, discretization=mesh,
        membrane=iga.WholeMembrane(**how),
    )  # fmt: skip


def drop(angle=100.0, model="eighth"):
    mesh = iga.Discretization(degree=3, elements=8, model=model)
    return iga.sessile_droplet(
        iga.Plane(angle), volume=UNIT_VOLUME, gravity=1.0, discretization=mesh,
        membrane=iga.WholeMembrane(penalty=30.0),
    )  # fmt: skip


def state(scene, seed=0):
    """An assembly in a load step, a state away from its start, multipliers and a direction."""
    rng = np.random.default_rng(seed)
    assembly = Assembly(scene)
    start = scene.local_surface()
    term = next(t for t in scene.local_terms() if isinstance(t, iga.Stabilization))
    assembly.begin_step(start, term)
    motion = assembly.spines.on(start)
    surface = start.moved(
        start.points + motion.displacement(0.01 * rng.standard_normal(assembly.size))
    )
    multipliers = rng.uniform(0.5, 2.0, assembly.multipliers)
    direction = 0.01 * rng.standard_normal(assembly.size)
    return assembly, surface, multipliers, direction, assembly.spines.on(surface)


@pytest.mark.parametrize(
    "scene",
    [sheet(), sheet(model="quarter"), sheet(boundary="square"), drop(), drop(model="quarter")],
)
def test_taylor_remainders_of_the_whole_formulation_fall_at_their_order(scene):
    contact = next(t for t in scene.terms if t.name == "contact")
    # a soft penalty: at its edge it is only once differentiable
    scene = replace(scene, terms=[t for t in scene.terms if t is not contact])
    assembly, surface, multipliers, direction, motion = state(scene)
    first, second = lagrangian_slopes(assembly, surface, multipliers, motion, direction)
    assert 1.9 <= first < 2.5
    assert second >= 2.9


@pytest.mark.parametrize("scene", [sheet(penalty=5.0), drop()])
def test_penalty_acts_on_all_three_unknowns(scene):
    assembly, surface, multipliers, direction, motion = state(scene)
    first, _ = lagrangian_slopes(assembly, surface, multipliers, motion, direction)
    assert 1.9 <= first < 2.5


@pytest.mark.parametrize("solid", [iga.Plane(70.0), iga.Sphere(130.0, 1.3, (0.1, 0.0, -1.0))])
def test_taylor_remainders_of_the_normal_line_load(solid):
    surface = sheet().local_surface()
    line = NormalLineLoad(1.2, solid, "xi2=0.3333333333333333")
    table = surface.space.edge_table(line.edge)
    d = 0.1 * np.random.default_rng(1).standard_normal(surface.points.shape)

    def value(step):
        return line.energy(table, surface.points + step * d, line.strength, NONE)

    local = d[table.functions]
    gradient = (line.forces(table, surface.points, line.strength, NONE) * local).sum()
    blocks = line.hessian(table, surface.points, line.strength, NONE)
    first, second = remainder_slopes(
        value, gradient, np.einsum("eai,eaibj,ebj->", local, blocks, local)
    )
    assert 1.9 <= first < 2.5
    assert second >= 2.9


def test_line_load_balances_the_tractions_of_a_kink_at_youngs_angle():
    # eqs (29)-(31): on a straight line gamma (1 + cos) outwards and gamma sin downwards hold a
    # membrane that leaves the plane at the contact angle
    angle = np.radians(70.0)
    scene = drop(70.0)
    surface = scene.local_surface()
    wetting, load = (t for t in scene.local_terms() if t.name in ("wetting", "line_load"))
    table = surface.space.edge_table(wetting.edge)
    points, local = surface.points, table.functions
    pull = -(wetting.forces(table, points, wetting.strength, NONE)
             + load.forces(table, points, load.strength, NONE))  # fmt: skip
    curve = table.values @ points[local]
    length = np.linalg.norm(table.d @ points[local], axis=-1) * table.weights
    radius = np.linalg.norm(curve[..., :2], axis=-1)
    # work over a growth of the line, and over a lift
    growth = (pull * points[local] * [1.0, 1.0, 0.0]).sum()
    assert growth == pytest.approx((1.0 + np.cos(angle)) * (radius * length).sum(), rel=1e-4)
    assert pull[..., 2].sum() == pytest.approx(-np.sin(angle) * length.sum(), rel=1e-12)


def test_covered_lines_leave_body_integrals_to_the_membrane():
    sphere = iga.Sphere(100.0, 1.0, (0.0, 0.0, -1.0))
    surface = sheet().local_surface()
    table = surface.space.edge_table("xi2=0.3333333333333333")
    volume = iga.terms.BodyDensity(1.0)
    bare, covered = (SphereContactLine(1.0, sphere, covered=c) for c in (False, True))
    assert bare.energy(table, surface.points, 0.0, volume) != 0.0
    assert covered.energy(table, surface.points, 0.0, volume) == 0.0
    assert covered.strength == pytest.approx(bare.strength - 1.0)
    assert PlaneContactLine(2.0, 60.0, covered=True).strength == pytest.approx(-3.0)


def test_stabilization_is_nothing_at_the_last_load_step_and_grows_from_there():
    surface = sheet().local_surface()
    table = surface.space.table(3)
    at = element_points(table, surface.points)
    before = PreviousMetric.of(table, at)
    assert stable.energy(2.0, before, at) == pytest.approx(0.0, abs=1e-12)
    assert np.abs(stable.forces(2.0, table, before, at)).max() < 1e-12
    stretched = element_points(table, 1.1 * surface.points)
    area = float((at.area * table.weights).sum())
    expected = 0.5 * 2.0 * area * (2 * 1.1**2 - 2 - np.log(1.1**4))
    assert stable.energy(2.0, before, stretched) == pytest.approx(expected, rel=1e-12)


def test_projected_stabilization_does_not_act_along_normals():
    scene = sheet(projected=True)
    assembly, surface, *_ = state(scene)
    n = surface.space.count
    work = assembly.stabilizer.forces(surface.points)
    total = np.zeros((n, 3))
    np.add.at(total, assembly.table.functions, work)
    start = assembly.spines.on(scene.local_surface()).directions[:n]
    away = np.setdiff1d(np.arange(n), surface.space.edge_functions(scene.line_inside))
    along = np.einsum("ki,ki->k", total[away], start[away])
    assert np.abs(along).max() < 1e-12
    assert np.abs(total[away]).max() > 1e-4
    assert not assembly.conservative


def test_three_unknowns_per_point_span_all_symmetric_motions():
    particle = iga.Sphere(100.0, 1.0, (0.0, 0.0, -1.0))
    scene = sheet(model="quarter")
    assembly = Assembly(scene)
    surface = scene.local_surface()
    motion = assembly.spines.on(surface)
    n = surface.space.count
    free = np.ones(n, bool)
    for edge in ("xi2=0", "xi2=1"):
        free[surface.space.edge_functions(edge)] = False
    # a motion with the mirror planes x = 0 and y = 0
    x, y, z = (surface.points - particle.center).T
    wanted = np.stack([0.3 * x + 0.1 * x * z, -0.2 * y, 0.1 * x * x - 0.3 * y * y + z], axis=1)
    wanted[~free] = 0.0
    matrix = np.stack([motion.displacement(row).ravel() for row in np.eye(motion.size)], axis=1)
    step, *_ = np.linalg.lstsq(matrix, wanted.ravel())
    assert np.abs(matrix @ step - wanted.ravel()).max() < 1e-10
    assert np.linalg.matrix_rank(matrix) == motion.size


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_a_kinked_basis_is_smooth_but_at_its_joint(degree):
    basis = line_basis("bspline", 6, degree, (2,))
    joint = 2.0 / 6.0
    assert basis.joints == (pytest.approx(joint),)
    assert basis.count == 6 + degree + degree - 1
    for t, jumps in ((joint, True), (0.5, False)):
        sides = [basis.matrix([t + off], 1) for off in (-1e-9, 1e-9)]
        assert bool(np.abs(sides[0] - sides[1]).max() > 1.0) is jumps
        values = [basis.matrix([t + off]) for off in (-1e-12, 1e-12)]
        assert np.abs(values[0] - values[1]).max() < 1e-9
