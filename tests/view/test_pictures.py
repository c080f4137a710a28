import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from helpers import droplet

import iga_membrane as iga
from iga_membrane.view import drawing, picture
from iga_membrane.view.mesh import membrane, outside


@pytest.fixture
def drawn():
    if not drawing.can_draw():
        pytest.skip(f"no rendering here: {drawing.REMEDY}")


def shown(path):
    """(height, width, 3) colours of a picture, 0 to 1."""
    from matplotlib.image import imread

    return imread(path)[..., :3]


def liquid_of(image):
    """Pixels that are blue: plain liquid."""
    red, _, blue = np.moveaxis(image, -1, 0)
    return blue > 1.15 * red + 0.02


def solid_of(image):
    """Pixels that are brownish: dry solid."""
    red, _, blue = np.moveaxis(image, -1, 0)
    return red > 1.05 * blue + 0.01


def test_picture_shows_a_coloured_drop_on_its_plane(drawn, solution, tmp_path):
    path = tmp_path / "drop.png"
    solution.plot(path, size=(400, 300), resolution=65)
    image = shown(path)
    assert image.shape == (300, 400, 3)
    middle = image[100:200, 150:250].reshape(-1, 3)
    assert middle.std(axis=0).max() > 0.02, "the drop has one flat colour"
    assert not np.allclose(middle.mean(axis=0), image[5, 5], atol=0.05), "the frame is empty"


def test_picture_of_asperities_shows_the_wet_ones_in_red(drawn, rough, tmp_path):
    assert rough.contact["wet_solids"] >= 5

    def red_part(**options):
        path = tmp_path / "rough.png"
        rough.plot(path, size=(400, 300), resolution=65, view=(1, -2, 0.05), **options)
        red, green, blue = np.moveaxis(shown(path), -1, 0)
        return ((red > 1.6 * green) & (red > 1.6 * blue)).mean()

    whole = red_part(color="none")
    assert whole > 1e-3
    assert red_part(color="none", zoom=2.5, focus=(0.0, 0.0, 0.0)) > 2.0 * whole


def test_picture_leaves_out_the_membrane_inside_its_sphere(cell):
    """What is drawn has the liquid-gas surface's area."""
    whole = membrane(cell, 129)
    outer = outside(cell.scene.substrate, whole)
    assert outer.area == pytest.approx(cell.measures["A_LG"], rel=1e-3)
    assert whole.area > 1.1 * outer.area


def test_a_machine_that_cannot_draw_is_told_what_to_install(solution, tmp_path, monkeypatch):
    monkeypatch.setattr(drawing, "can_draw", lambda: False)
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


@pytest.mark.parametrize("angle", [60.0, 120.0, 150.0])
def test_silhouette_of_a_spherical_cap_is_its_sphere(drawn, tmp_path, angle):
    """Seen from the side without perspective, every edge of the liquid is where it should be."""
    cap = iga.solve(droplet(angle))
    cap.plot(tmp_path / "cap.png", color="none", view="side", size=(600, 500), resolution=65)
    image = shown(tmp_path / "cap.png")
    liquid, solid = liquid_of(image), solid_of(image)
    assert liquid.mean() > 0.05
    assert solid.mean() > 0.005
    pixel = 2.0 * picture.HALF_HEIGHT * picture.extent(cap)[1] / 500
    m = cap.measures
    sphere = m["height"] / (1.0 - np.cos(np.radians(angle)))
    rows, columns = np.flatnonzero(liquid.any(axis=1)), np.flatnonzero(liquid.any(axis=0))
    widest = 2.0 * (sphere if angle > 90.0 else m["contact_radius"])
    assert len(columns) * pixel == pytest.approx(widest, abs=2.5 * pixel)
    top = rows[0]
    assert (np.flatnonzero(solid.any(axis=1))[0] - top) * pixel == pytest.approx(
        m["height"], abs=4.0 * pixel
    )
    # the circle through the apex, half way down
    depth = 0.5 * m["height"]
    row = liquid[top + round(depth / pixel)]
    chord = 2.0 * np.sqrt(2.0 * sphere * depth - depth**2)
    assert row.sum() * pixel == pytest.approx(chord, abs=3.5 * pixel)


def test_a_picture_shows_liquid_solid_wet_spot_line_and_tractions(drawn, solution, tmp_path):
    plain, marked = tmp_path / "plain.png", tmp_path / "marked.png"
    options = {"color": "none", "size": (400, 300), "resolution": 65}
    solution.plot(plain, **options)
    solution.plot(marked, traction=True, opacity=0.3, **options)
    assert liquid_of(shown(plain)).mean() > 0.1
    assert solid_of(shown(plain)).mean() > 0.05
    red, green, blue = np.moveaxis(shown(marked), -1, 0)
    assert ((blue > 2.5 * red) & (blue > 1.5 * green)).mean() > 2e-3, "arrows"
    wet = (red > 1.4 * green) & (red < 0.7)
    assert wet.mean() > 0.02, "the wet spot does not show through"


def test_forces_on_a_particle_are_arrows_in_their_directions(drawn, sheet, tmp_path):
    options = {"color": "none", "size": (400, 300), "resolution": 33, "view": "side"}
    sheet.plot(tmp_path / "plain.png", **options)
    sheet.plot(tmp_path / "forces.png", forces=True, **options)
    before, after = (shown(tmp_path / f"{name}.png") for name in ("plain", "forces"))
    black = (after.max(axis=-1) < 0.15) & ~(before.max(axis=-1) < 0.15)
    black[: after.shape[0] // 6, : after.shape[1] // 3] = False  # the legend
    assert black.sum() > 100
    rows, columns = np.nonzero(black)
    # F_e points up: its arrow is higher than wide
    assert np.ptp(rows) > 2 * np.ptp(columns)


@pytest.mark.parametrize("color", ["mean_curvature", "pressure", "gap", "residual"])
def test_every_field_has_a_map_with_its_bar(drawn, solution, tmp_path, color):
    path = tmp_path / "map.png"
    solution.plot(path, color=color, size=(400, 300), resolution=33)
    image = shown(path)
    assert image[80:160, 120:240].reshape(-1, 3).std(axis=0).max() > 0.03
    assert image[80:220, 345:370].reshape(-1, 3).std(axis=0).max() > 0.1, "no bar"


def test_a_zoom_on_an_asperity_shows_it_large(drawn, rough, tmp_path):
    path = tmp_path / "asperity.png"
    rough.plot(path, color="none", focus="asperity", size=(400, 300), resolution=65)
    red, green, blue = np.moveaxis(shown(path), -1, 0)
    assert ((red > 1.6 * green) & (red > 1.6 * blue)).mean() > 0.03
    assert liquid_of(shown(path)).mean() > 0.05


def test_words_that_are_none_are_refused_before_drawing(solution, tmp_path):
    for options, said in (
        ({"color": "stress"}, "color = 'stress'"),
        ({"view": "left"}, "view = 'left'"),
        ({"focus": "asperity"}, "no asperity is wet"),
        ({"view": (0, 0, 0)}, "must not be zero"),
    ):
        with pytest.raises(iga.SceneError, match=said):
            solution.plot(tmp_path / "drop.png", **options)
    assert not (tmp_path / "drop.png").exists()


def test_a_film_of_a_path_has_a_frame_for_each_state(drawn, tmp_path):
    from PIL import Image

    path = iga.trace(lambda bond: droplet(120, bond), [0.1, 4.0], parameter="bond")
    options = {"size": (240, 180), "resolution": 33}
    iga.animate(path, tmp_path / "path.gif", **options)
    with Image.open(tmp_path / "path.gif") as film:
        assert film.n_frames == 2
        assert film.size == (240, 180)
    iga.animate(path.solutions, tmp_path / "frames", view="side", **options)
    one, two = (shown(p) for p in sorted((tmp_path / "frames").iterdir()))
    high, wide = (
        [np.flatnonzero(liquid_of(image).any(axis=axis)).size for image in (one, two)]
        for axis in (1, 0)
    )
    heights = [s.measures["height"] for s in path.solutions]
    widths = [s.measures["equator_radius"] for s in path.solutions]
    assert high[0] / high[1] == pytest.approx(heights[0] / heights[1], rel=0.05)
    assert wide[0] / wide[1] == pytest.approx(widths[0] / widths[1], rel=0.05)
    with pytest.raises(iga.OutputError, match=r"must end in \.gif"):
        iga.animate(path, tmp_path / "path.mp4")


def test_a_plotter_can_be_added_to(solution, tmp_path):
    """Without a path nothing is shown or written; what is added is in the picture."""
    pv = pytest.importorskip("pyvista")
    plotter = solution.plot(size=(300, 200), resolution=33, color="none")
    assert isinstance(plotter, pv.Plotter)
    before = len(plotter.actors)
    plotter.add_mesh(pv.Sphere(radius=0.2, center=(0.0, 0.0, 1.5)), color="red")
    assert len(plotter.actors) == before + 1
    plotter.off_screen = True
    image = np.asarray(plotter.screenshot(return_img=True), float)
    plotter.close()
    red = (image[..., 0] > 120) & (image[..., 1] < 60) & (image[..., 2] < 60)
    assert red.sum() > 30


BROWSER = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), ""
)


@pytest.mark.slow
@pytest.mark.skipif(not BROWSER, reason="no browser to look with")
def test_a_page_turns_in_a_browser_and_needs_nothing_else(solution, tmp_path):
    """A browser without a network shows the droplet, blue before white, where it should be."""
    pytest.importorskip("trame_pyvista")
    image_of = pytest.importorskip("PIL.Image")
    page, shot = tmp_path / "drop.html", tmp_path / "shot.png"
    solution.plot(page, color="none", size=(600, 450), resolution=65)
    text = page.read_text()
    assert not re.search(r'(src|href)="https?://', text)
    flags = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--virtual-time-budget=15000", "--window-size=700,500",
             "--proxy-server=127.0.0.1:9", f"--user-data-dir={tmp_path / 'profile'}"]  # fmt: skip
    subprocess.run([BROWSER, *flags, f"--screenshot={shot}", page.as_uri()], check=True,
                   capture_output=True, timeout=120)  # fmt: skip
    seen = np.asarray(image_of.open(shot).convert("RGB"), float)
    blue = (seen[..., 2] > seen[..., 0] + 20) & (seen[..., 2] > 90)
    white = (seen > 240).all(axis=-1)
    assert blue.mean() > 0.03
    assert white.mean() > 0.3
    rows, columns = np.nonzero(blue)
    assert 0.3 < columns.mean() / seen.shape[1] < 0.7
    assert 0.2 < rows.mean() / seen.shape[0] < 0.8
