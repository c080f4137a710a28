"""Files of a solution come back from other programs with the same shape, areas and forces."""

import csv

import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.surface.bezier import bezier_net
from iga_membrane.view.vtu import grid


def rows(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def numbers(table, *names):
    return np.array([[float(row[name]) for name in names] for row in table])


def test_bezier_cells_lie_on_the_surface():
    surface = iga.cap(1.0, 120.0)
    cells = bezier_net(surface)
    corners = cells[:, [0, 0, -1, -1], [0, -1, 0, -1]]
    radius = np.linalg.norm(corners[..., :3] / corners[..., 3:] + [0, 0, -0.5], axis=-1)
    assert radius == pytest.approx(1.0, abs=1e-12)


def test_vtu_round_trip_keeps_degrees_weights_and_shape(solution, tmp_path):
    pv = pytest.importorskip("pyvista")
    path = tmp_path / "drop.vtu"
    solution.save(path)
    back = pv.read(path)
    assert back.n_cells == solution.surface.space.elements
    assert back.cell_data["HigherOrderDegrees"][0].tolist() == [4, 4, 0]
    assert back.point_data["RationalWeights"] == pytest.approx(1.0)
    sphere = grid(iga.sphere(1.0))
    assert sphere.point_data["RationalWeights"].min() < 0.75
    fine = sphere.extract_surface(nonlinear_subdivision=4, algorithm=None)
    assert np.linalg.norm(fine.points, axis=1) == pytest.approx(1.0, abs=1e-6)
    assert fine.area == pytest.approx(4 * np.pi, rel=5e-3)


def test_area_of_the_refined_cells_is_that_of_the_drop(solution, tmp_path):
    """Triangles miss a fourth of the area error at each halving; what is left is extrapolated."""
    pv = pytest.importorskip("pyvista")
    solution.save(tmp_path / "drop.vtu")
    back = pv.read(tmp_path / "drop.vtu")
    coarse, fine = (
        back.extract_surface(nonlinear_subdivision=level, algorithm=None).triangulate().area
        for level in (2, 3)
    )
    exact = solution.measures["A_LG"]
    assert abs(fine / exact - 1.0) < 0.3 * abs(coarse / exact - 1.0) < 3e-5
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, rel=1e-7)


@pytest.mark.parametrize("space", ["bspline", "nurbs"])
def test_fields_of_the_vtu_file_are_those_of_the_solution(space, tmp_path):
    pv = pytest.importorskip("pyvista")
    mesh = iga.Discretization(space, degree=3, elements=8)
    drop = iga.solve(
        iga.sessile_droplet(iga.Plane(120.0), volume=2.0, gravity=0.7, discretization=mesh)
    )
    drop.save(tmp_path / "drop.vtu")
    back = pv.read(tmp_path / "drop.vtu")
    assert back.point_data["RationalWeights"].min() > 0
    if space == "nurbs":
        assert np.ptp(back.point_data["RationalWeights"]) > 1e-2
    fine = back.extract_surface(nonlinear_subdivision=2, algorithm=None)
    height = fine.points[:, 2].astype(float)
    assert fine["gap"] == pytest.approx(height, abs=1e-6)
    pressure = drop.measures["p_base"] - 0.7 * height
    assert fine["pressure"] == pytest.approx(pressure, rel=1e-6)
    # 2 H gamma + p is an error that is small beside the pressure, and not zero
    assert 1e-9 < abs(fine["residual"]).max() < 0.05 * pressure.max()
    curvature = 0.5 * (fine["residual"] - fine["pressure"])
    assert fine["mean_curvature"] == pytest.approx(curvature, abs=1e-5 * abs(curvature).max())


def test_flat_cells_are_read_by_meshio(solution, tmp_path):
    """Area and fields of the droplet, by quadrilaterals that every program knows."""
    meshio = pytest.importorskip("meshio")
    solution.save(tmp_path / "drop.linear.vtu")
    mesh = meshio.read(tmp_path / "drop.linear.vtu")
    assert {cells.type for cells in mesh.cells} <= {"quad", "triangle"}
    area = 0.0
    for cells in mesh.cells:
        x = mesh.points[cells.data]
        across = np.cross(x[:, 2] - x[:, 0], x[:, -1] - x[:, 1])
        area += 0.5 * np.linalg.norm(across, axis=1).sum()
    assert area == pytest.approx(solution.measures["A_LG"], rel=1e-3)
    pressure = solution.pressure(mesh.points)
    assert mesh.point_data["pressure"].ravel() == pytest.approx(pressure, rel=1e-5)
    assert "<!-- units: dimensionless -->" in (tmp_path / "drop.linear.vtu").read_text()[:200]
    assert set(mesh.point_data) >= {"mean_curvature", "pressure", "gap", "residual"}


@pytest.mark.parametrize("ending", ["stl", "obj", "ply"])
def test_the_shape_of_a_drop_on_a_plane_is_closed_and_holds_its_volume(solution, tmp_path, ending):
    pv = pytest.importorskip("pyvista")
    path = tmp_path / f"drop.{ending}"
    solution.save(path)
    body = pv.read(path).triangulate().clean()
    assert body.n_open_edges == 0
    assert body.volume == pytest.approx(solution.measures["volume"], rel=1e-3)
    areas = solution.measures["A_LG"] + solution.measures["A_wet"]
    assert body.area == pytest.approx(areas, rel=1e-3)
    faces = body.compute_normals(point_normals=False, auto_orient_normals=False)
    flux = (faces.cell_centers().points * faces.cell_data["Normals"]).sum(axis=1)
    assert flux @ faces.compute_cell_sizes()["Area"] > 0, "normals point into the liquid"


def test_the_shape_at_asperities_ends_at_its_contact_lines(cell, tmp_path):
    pv = pytest.importorskip("pyvista")
    cell.save(tmp_path / "cell.stl")
    assert pv.read(tmp_path / "cell.stl").area == pytest.approx(cell.measures["A_LG"], rel=1e-3)


def test_a_geomdl_file_holds_the_surface(solution, tmp_path):
    from geomdl import exchange

    solution.save(tmp_path / "drop.geomdl.json")
    (other,) = exchange.import_json(str(tmp_path / "drop.geomdl.json"))
    xi = np.array([[0.1, 0.0], [0.45, 0.3], [0.8, 0.9]])
    ours = solution.surface.at(xi * [2.0 * np.pi, 1.0], 1).position
    assert np.array(other.evaluate_list(xi.tolist())) == pytest.approx(ours, abs=1e-12)


def test_contact_lines_as_a_table_hold_the_drop(solution, tmp_path):
    """Its weight is what the pressure on the wet area and the line carry."""
    solution.save(tmp_path / "drop.lines.csv")
    table = rows(tmp_path / "drop.lines.csv")
    m = solution.measures
    x = numbers(table, "x", "y", "z")
    arc, angle, pull = numbers(table, "arc", "contact_angle", "conormal_z").T
    assert np.hypot(x[:, 0], x[:, 1]) == pytest.approx(m["contact_radius"], rel=1e-6)
    assert arc.sum() == pytest.approx(2.0 * np.pi * m["contact_radius"], rel=1e-9)
    assert angle == pytest.approx(150.0, abs=1e-3)
    weight = m["p_base"] * m["A_wet"] + pull @ arc
    assert weight == pytest.approx(m["volume"], rel=1e-6)


def test_a_line_inside_the_membrane_lies_on_its_sphere_and_goes_round_once(cell):
    (found,) = iga.contact_lines(cell)
    x, sphere = found.line.position, cell.scene.substrate
    assert found.solid == 0
    assert abs(sphere.gap(x)).max() < 1e-6 * sphere.radius
    closed = np.linalg.norm(np.diff(np.vstack([x, x[:1]]), axis=0), axis=1)
    assert closed.sum() == pytest.approx(found.line.arc.sum(), rel=1e-3)
    assert found.line.arc.sum() == pytest.approx(
        2.0 * np.pi * cell.measures["contact_radius"], rel=1e-3
    )
    angle = np.degrees(found.line.angle @ found.line.arc / found.line.arc.sum())
    assert angle == pytest.approx(cell.measures["contact_angle_measured"], rel=1e-9)


def test_a_line_of_a_leaning_drop_is_given_in_the_world(tmp_path):
    plane = iga.Plane(90.0, (1.0, 2.0, 3.0), (0.3, 0.0, 1.0))
    drop = iga.solve(iga.sessile_droplet(plane, volume=1e-3, gravity=(-0.3, 0.0, -1.0)))
    (found,) = iga.contact_lines(drop)
    assert abs(plane.gap(found.line.position)).max() < 1e-12
    # the membrane stands upright on the plane
    assert found.line.conormal == pytest.approx(
        np.broadcast_to(-plane.unit_normal(), found.line.conormal.shape), abs=1e-3
    )


def test_no_line_where_the_membrane_lies_on_asperities(rough):
    assert rough.contact["wet_solids"] >= 5
    assert iga.contact_lines(rough) == ()


def test_forces_as_a_table_are_those_of_the_solution(sheet, tmp_path):
    sheet.save(tmp_path / "sheet.forces.csv")
    (row,) = rows(tmp_path / "sheet.forces.csv")
    forces = sheet.forces[0]
    assert row["solid"] == "particle"
    assert numbers([row], "x", "y", "z")[0] == pytest.approx([0.3, 0.0, -1.0])
    assert numbers([row], "F_x", "F_y", "F_z")[0] == pytest.approx(forces.effective)
    assert numbers([row], "F_G_x", "F_G_y", "F_G_z")[0] == pytest.approx(forces.weight)
    assert sheet.row()["F_e_z"] == forces.effective[2]
    assert sheet.row()["lifts"] is forces.lifts


def test_forces_as_a_table_carry_the_weight(cell, solution, tmp_path):
    cell.save(tmp_path / "cell.forces.csv")
    asperity = rows(tmp_path / "cell.forces.csv")[0]
    assert float(asperity["F_z"]) == pytest.approx(-cell.measures["F_sphere"], rel=1e-9)
    solution.save(tmp_path / "drop.forces.csv")
    (substrate,) = rows(tmp_path / "drop.forces.csv")
    assert float(substrate["F_z"]) == pytest.approx(-solution.measures["volume"], rel=1e-6)


def caps():
    mesh = iga.Discretization(elements=8)

    def cap(pressure):
        return iga.liquid_sheet(size=2.0, boundary="circle", pressure=pressure, discretization=mesh)

    return iga.trace(cap, [0.5, 1.0, 1.5], parameter="sheet.pressure")


def test_tables_of_a_solution_and_a_path_in_pandas(solution):
    pytest.importorskip("pandas")
    one = solution.to_dataframe()
    assert one["height"].tolist() == [solution.measures["height"]]
    assert one["bond_number"].tolist() == pytest.approx([1.0])
    path = caps()
    frame = path.to_dataframe()
    assert frame["sheet.pressure"].tolist() == [0.5, 1.0, 1.5]
    assert frame["sag"].tolist() == path.column("sag").tolist()
    assert (frame["status"] == "CONVERGED_STABLE").all()


def test_fields_and_paths_in_xarray(solution):
    pytest.importorskip("xarray")
    data = solution.to_xarray(resolution=9)
    assert dict(data.sizes) == {"xi1": 9, "xi2": 9, "axis": 3}
    assert data.position.sel(axis="z").values == pytest.approx(data.gap.values)
    again = data.sel(xi1=data.xi1[2], xi2=data.xi2[4])
    at = solution.surface.at([float(again.xi1), float(again.xi2)])
    assert float(again.mean_curvature) == float(at.mean_curvature)
    path = caps()
    along = path.to_xarray()
    assert along.sag.sel({"sheet.pressure": 1.0}) == path.solutions[1].measures["sag"]
