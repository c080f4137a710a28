"""Sheets where they could go wrong (P15, P19, Q16, Q21): at a sphere's centre, on large particles,
near the rim; and what a contact line must balance."""

import numpy as np
import pytest
from helpers import particle_sheet, some

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.solvers.newton import NewtonOptions, newton
from iga_membrane.splines import points_of


@pytest.fixture(scope="module")
def sheet():
    return iga.solve(particle_sheet(90, elements=6)).surface


def with_inner_edge(surface, move):
    net = surface.net.copy()
    net[:, 0] = move(net[:, 0])
    return surface.moved(points_of(surface.space, net))


def test_a_contact_line_at_the_centre_of_its_sphere_is_refused(sheet):
    start = with_inner_edge(sheet, lambda edge: np.broadcast_to([0.0, 0.0, -1.0], edge.shape))
    with pytest.raises(iga.SceneError, match="inner edge is a point"):
        particle_sheet(90, elements=6, start=start)


def test_a_contact_line_at_the_dry_end_of_its_sphere_has_no_energy(sheet):
    scene = particle_sheet(90, elements=6)
    shrunk = with_inner_edge(sheet, lambda edge: np.broadcast_to([0.0, 0.0, -2.0], edge.shape))
    with pytest.raises(iga.GeometryError, match="dry end"):
        Assembly(scene).energies(shrunk)


def test_a_contact_line_folded_into_a_plane_is_no_success(sheet):
    start = with_inner_edge(sheet, lambda edge: edge * [1.0, 0.0, 1.0])
    scene = particle_sheet(90, elements=6, model="full", start=start)
    solution = iga.solve(scene, on_fail="return")
    assert not solution.success
    assert np.all(np.isfinite(solution.surface.points))


def test_a_control_point_at_the_centre_of_the_sphere_is_named_and_leaves_no_nan(sheet):
    def to_the_centre(edge):
        moved = edge.copy()
        moved[0] = [0.0, 0.0, -1.0]
        return moved

    start = with_inner_edge(sheet, to_the_centre)
    scene = particle_sheet(90, elements=6, model="full", start=start)
    solution = iga.solve(scene, on_fail="return")
    assert solution.status is iga.Status.NONFINITE
    assert "centre" in solution.message
    assert np.all(np.isfinite(solution.surface.points))
    assert np.all(np.isfinite(list(solution.measures.values())))
    assert np.all(np.isfinite(solution.forces[0].effective))


@pytest.mark.parametrize("points", [[0.1, -0.2, 0.3], [[1.0, 0.0, 0.0], [0.1, -0.2, 0.3]]])
def test_a_sphere_has_no_normal_at_its_centre(points):
    sphere = iga.Sphere(contact_angle=90, radius=1.0, center=(0.1, -0.2, 0.3))
    for ask in (sphere.normal, sphere.gap_hessian, sphere.closest_point):
        with pytest.raises(iga.GeometryError, match="centre"):
            ask(points)
    assert np.min(sphere.gap(points)) == pytest.approx(-1.0)


def test_a_line_start_deep_inside_the_particle_comes_back_to_its_surface(sheet):
    start = with_inner_edge(sheet, lambda e: [0.0, 0.0, -1.0] + 0.2 * (e - [0.0, 0.0, -1.0]))
    found = iga.solve(particle_sheet(90, elements=6, start=start)).measures
    direct = iga.solve(particle_sheet(90, elements=6)).measures
    assert found["F_CL"] == pytest.approx(direct["F_CL"], rel=1e-8)


@pytest.mark.parametrize("boundary", ["circle", "square"])
def test_a_centred_sheet_is_the_same_in_quarter_and_full_model(boundary):
    quarter, full = (
        iga.solve(
            particle_sheet(75, boundary=boundary, pressure=0.2, elements=5, model=model)
        ).measures
        for model in ("quarter", "full")
    )
    assert quarter == pytest.approx(full, rel=1e-9, abs=1e-10)


WIDE = [(1.9, 150), (1.5, 90), (1.2, 30), (0.7, 45)]


@pytest.mark.parametrize(("size", "angle"), WIDE)
def test_a_particle_wider_than_a_circular_sheet_hangs_on_a_catenoid(size, angle):
    m = iga.solve(particle_sheet(angle, size=size)).measures
    neck = m["F_CL"] / (2.0 * np.pi)
    rim, line = neck * np.arccosh(np.array([0.5 * size, m["contact_radius"]]) / neck)
    # heights above the neck, which may lie between rim and line
    depth = -m["z_contact"]
    assert min(abs(abs(rim - line) - depth), abs(rim + line - depth)) <= 1e-6 * depth


@pytest.mark.parametrize(("size", "angle"), some(WIDE, {0, 3}))
def test_a_particle_wider_than_a_square_sheet_touches_it_on_its_surface(size, angle):
    solution = iga.solve(particle_sheet(angle, boundary="square", size=size))
    m = solution.measures
    circle = iga.solve(particle_sheet(angle, size=size)).measures
    around = iga.solve(particle_sheet(angle, size=size * np.sqrt(2.0))).measures
    assert circle["phi_deg"] < m["phi_deg"] < around["phi_deg"]
    assert solution.audit.penetration < 1e-6


def line_extent(surface, boundary):
    """Largest reach of the contact line, in the measure of the rim."""
    line = iga.contact_line(surface).position[:, :2]
    reach = np.abs(line).max(axis=1) if boundary == "square" else np.linalg.norm(line, axis=1)
    return reach.max()


@pytest.mark.parametrize("boundary", ["circle", pytest.param("square", marks=pytest.mark.slow)])
def test_a_line_at_the_rim_is_a_change_of_topology(boundary):
    scene = particle_sheet(150, boundary=boundary, center=(2.45, 0, -1), elements=6)
    solution = iga.solve(scene, on_fail="return")
    assert solution.status is iga.Status.TOPOLOGY_CHANGE
    assert solution.kind == "reaches boundary"
    assert "reaches the rim" in solution.message


@pytest.mark.slow
@pytest.mark.parametrize("boundary", ["circle", "square"])
@pytest.mark.parametrize("angle", [60, 90, 120, 150])
def test_a_particle_moved_to_the_rim_is_never_a_success_beyond_it(boundary, angle):
    path = iga.trace(
        lambda x: particle_sheet(
            angle, boundary=boundary, center=(x, 0, -1), elements=6, model="half"
        ),
        (0.5, 1.0, 1.4, 2.0, 2.45),
        parameter="particle[0].center[0]",
        on_fail="return",
    )
    assert not path.success
    assert path.end.status in (iga.Status.TOPOLOGY_CHANGE, iga.Status.STALLED)
    assert len(path.solutions) >= 3
    for solution in path.solutions:
        assert solution.success
        assert line_extent(solution.surface, boundary) < 2.5


@pytest.mark.slow
def test_a_path_to_the_rim_names_it():
    path = iga.trace(
        lambda x: particle_sheet(120, center=(x, 0, -1), elements=6),
        (2.0, 2.45),
        parameter="particle[0].center[0]",
        on_fail="return",
    )
    assert path.values == (2.0,)
    assert path.end.status is iga.Status.TOPOLOGY_CHANGE
    assert path.end.kind == "reaches boundary"


@pytest.mark.parametrize("place", [(2.5, 0.0), (1.8, 1.8)])
def test_a_particle_whose_middle_is_not_inside_the_rim_is_refused(place):
    with pytest.raises(iga.SceneError, match="must lie inside the rim"):
        particle_sheet(90, center=(*place, -1.0))
    inside = max(place) < 2.5
    if inside:  # the corner of a square reaches further than the circle
        assert particle_sheet(90, boundary="square", center=(*place, -1.0)).kind == "liquid_sheet"


@pytest.mark.parametrize(
    ("boundary", "elements", "angles", "allowed"),
    [("circle", 20, (30, 90, 150), 1e-8), ("square", 8, (60, 90, 120), 1e-7)],
)
def test_the_particle_carries_the_normal_part_of_the_tension(boundary, elements, angles, allowed):
    """Paper eq. (31): the line load of the solid is gamma sin(theta) per length."""
    for angle in angles:
        scene = particle_sheet(angle, boundary=boundary, elements=elements)
        assembly = Assembly(scene)
        state = newton(
            assembly, scene.local_surface(), None, scene.meridian_grading, NewtonOptions()
        )
        assert state.status is None
        space = state.surface.space
        ring = space.bases[0]
        u = (np.arange(7) + 0.5) / 7
        xi1 = (ring.breaks[:-1, None] + ring.sizes[:, None] * u).ravel()
        load = (
            ring.matrix(xi1) @ assembly.line_load(state.multipliers)[space.edge_functions("xi2=0")]
        )
        at = state.surface.at(np.column_stack([xi1, np.zeros_like(xi1)]), 1)
        speed = np.linalg.norm(at.tangents[:, 0], axis=1)
        exact = np.sin(np.radians(angle))
        share = speed / speed.sum()
        assert np.sqrt(share @ (np.abs(load / speed) / exact - 1.0) ** 2) <= 1e-3
        assert abs(load.sum()) / speed.sum() == pytest.approx(exact, rel=allowed)


@pytest.mark.parametrize("boundary", ["circle", "square"])
@pytest.mark.parametrize("angle", [15, 60, 120, 170])
def test_the_line_force_is_that_of_its_place_on_the_sphere(boundary, angle):
    m = iga.solve(particle_sheet(angle, boundary=boundary)).measures
    theta, phi = np.radians([angle, m["phi_deg"]])
    share = m["F_CL"] / (2.0 * np.pi)
    assert share == pytest.approx(np.sin(phi) * np.sin(phi + theta), abs=1e-4)
    assert -(np.sin(0.5 * theta) ** 2) <= share <= np.cos(0.5 * theta) ** 2
