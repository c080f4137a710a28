import subprocess
import sys

import numpy as np
import pytest
from helpers import UNIT_VOLUME, droplet

import iga_membrane as iga
from iga_membrane.view import picture
from iga_membrane.view.vtu import bezier_net, grid


@pytest.fixture(scope="module")
def solution():
    return iga.solve(droplet(150, 1.0))


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


def test_picture_shows_a_coloured_drop_on_its_plane(solution, tmp_path):
    if not picture.can_draw():
        pytest.skip(f"no rendering here: {picture.REMEDY}")
    from matplotlib.image import imread

    path = tmp_path / "drop.png"
    solution.plot(path, size=(400, 300), resolution=65)
    image = imread(path)[..., :3]
    assert image.shape == (300, 400, 3)
    middle = image[100:200, 150:250].reshape(-1, 3)
    assert middle.std(axis=0).max() > 0.02, "the drop has one flat colour"
    assert not np.allclose(middle.mean(axis=0), image[5, 5], atol=0.05), "the frame is empty"


def test_picture_of_asperities_shows_the_wet_ones_in_red(tmp_path):
    if not picture.can_draw():
        pytest.skip(f"no rendering here: {picture.REMEDY}")
    from matplotlib.image import imread

    lattice = iga.SphereLattice(180.0, 0.2, 0.7, base=-0.3)
    scene = iga.sessile_droplet(
        lattice,
        volume=UNIT_VOLUME,
        gravity=1.0,
        discretization=iga.Discretization(elements=16),
        penetration_tolerance=0.1,
    )
    rough = iga.solve(scene, on_fail="return")
    assert rough.contact["wet_solids"] >= 5

    def red_part(**options):
        path = tmp_path / "rough.png"
        rough.plot(path, size=(400, 300), resolution=65, view=(1, -2, 0.05), **options)
        red, green, blue = np.moveaxis(imread(path)[..., :3], -1, 0)
        return ((red > 1.6 * green) & (red > 1.6 * blue)).mean()

    whole = red_part(color="none")
    assert whole > 1e-3
    assert red_part(color="none", zoom=2.5, focus=(0.0, 0.0, 0.0)) > 2.0 * whole


def test_picture_leaves_out_the_membrane_inside_its_sphere():
    """What is drawn has the liquid-gas surface's area, and its lines lie on the sphere."""
    pytest.importorskip("pyvista")
    radius, center = 0.05, np.array([0.0, 0.0, -0.05])
    scene = iga.asperity_cell(
        iga.Sphere(120.0, radius, tuple(center)),
        size=0.2,
        pressure=3.0,
        discretization=iga.Discretization(elements=16),
    )
    found = iga.solve(scene)
    mesh, _ = picture._membrane(found, "none", 129)
    whole = mesh.area
    outer, lines = picture._outside(found.scene.substrate, mesh)
    assert outer.area == pytest.approx(found.measures["A_LG"], rel=1e-3)
    assert whole > 1.1 * outer.area
    away = np.linalg.norm(lines.points - center, axis=1) / radius
    assert abs(away - 1.0).max() < 1.5 * picture.LINE
    assert lines.n_points > 100


def test_a_machine_that_cannot_draw_is_told_what_to_install(solution, tmp_path, monkeypatch):
    monkeypatch.setattr(picture, "can_draw", lambda: False)
    with pytest.raises(iga.OutputError, match="libegl1"):
        solution.plot(tmp_path / "drop.png")


def test_solving_loads_no_plotter():
    code = (
        "import sys, iga_membrane as iga; "
        "iga.solve(iga.sessile_droplet(iga.Plane(contact_angle=90), volume=1.0)); "
        "print(sorted({'vtk', 'pyvista', 'matplotlib', 'numba', 'geomdl'} & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
