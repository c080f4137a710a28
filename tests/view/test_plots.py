"""Plots on paper: sections, shadows, curves and phases say what the numbers say."""

import sys
from dataclasses import dataclass

import numpy as np
import pytest
from helpers import droplet

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane, profile_on_plane
from iga_membrane.view.goniometer import _of_line


def shown(path):
    from matplotlib.image import imread

    return imread(path)[..., :3]


@pytest.mark.parametrize(
    ("bond", "angle"), [(0.0, 70.0), (0.5, 100.0), (2.0, 160.0), (30.0, 140.0)]
)
def test_reference_profile_has_the_measures_of_its_drop(bond, angle):
    r, z = profile_on_plane(bond, angle, 3.0, points=4001)
    exact = drop_on_plane(bond, angle, 3.0)
    assert r[-1] == pytest.approx(exact["contact_radius"], rel=1e-9)
    assert z[0] == pytest.approx(exact["height"], rel=1e-9)
    assert r.max() == pytest.approx(max(exact["equator_radius"], r[-1]), rel=1e-6)
    assert np.pi * np.trapezoid(-(r**2), z) == pytest.approx(3.0, rel=1e-6)


def test_section_lies_on_the_axisymmetric_profile(tmp_path):
    """The distance is that of the discretization: fourth order for degree 3, in any units."""
    volume, worst = 1e-9, []
    for elements in (12, 24):
        scene = iga.sessile_droplet(
            iga.Plane(140.0),
            volume=volume,
            gravity=0.8 / volume ** (2.0 / 3.0),
            discretization=iga.Discretization(degree=3, elements=elements),
        )
        worst.append(iga.plot_section(iga.solve(scene), tmp_path / "section.png"))
    assert worst[1] < 1e-6
    assert worst[1] < worst[0] / 2.0**3.5
    assert shown(tmp_path / "section.png").std() > 0.02


def test_section_of_what_has_no_such_profile_is_drawn_alone(sheet, cell, tmp_path):
    for name, solution in (("sheet", sheet), ("cell", cell)):
        assert iga.plot_section(solution, tmp_path / f"{name}.pdf") is None
        assert (tmp_path / f"{name}.pdf").read_bytes().startswith(b"%PDF")


def test_shadow_of_a_cap_is_its_circle_and_its_angle_youngs(tmp_path):
    cap = iga.solve(droplet(120.0))
    angles = iga.plot_side(cap, tmp_path / "side.png")
    assert angles == pytest.approx((120.0, 120.0), abs=1e-3)
    shadow = (shown(tmp_path / "side.png").max(axis=-1) < 0.12).sum(axis=1)
    rows = np.flatnonzero(shadow > 5)
    pixel = cap.measures["height"] / len(rows)
    radius = cap.measures["height"] / 1.5
    assert shadow.max() * pixel == pytest.approx(2.0 * radius, rel=0.02)
    # the liquid fills its circle: no hole, no hairline
    z = radius - np.arange(0.5, len(rows)) * pixel
    area = 2.0 * np.sqrt(np.maximum(radius**2 - z**2, 0.0)).sum() * pixel
    assert shadow[rows].sum() * pixel**2 == pytest.approx(area, rel=0.03)


def test_a_camera_sees_the_angle_between_drop_and_sphere(tmp_path):
    ball = iga.Sphere(100.0, 2.0, (0.0, 0.0, -2.0))
    drop = iga.solve(iga.sessile_droplet(ball, volume=1.0, gravity=0.5, hold="xy"))
    angles = iga.plot_side(drop, tmp_path / "ball.png", azimuth=30.0)
    assert angles == pytest.approx((100.0, 100.0), abs=1e-4)
    # the drawn tangent stands on the wetted side of the sphere at that angle
    polar = np.radians(drop.measures["alpha_deg"])
    for sign, side in zip((-1.0, 1.0), _of_line(drop, np.array([1.0, 0.0, 0.0])), strict=True):
        wetted = np.array([-sign * np.cos(polar), np.sin(polar)])
        assert np.degrees(np.arccos(wetted @ side.way)) == pytest.approx(100.0, abs=0.1)


def test_on_asperities_a_camera_sees_the_apparent_angle(rough, tmp_path):
    angle = rough.measures["apparent_angle"]
    assert iga.plot_side(rough, tmp_path / "rough.png") == pytest.approx((angle, angle), rel=1e-9)


def test_a_shadow_is_of_droplets_only(sheet, tmp_path):
    lying = iga.solve(
        iga.sessile_droplet(
            iga.Sphere(180.0, 2.0, (0.0, 0.0, -2.0)),
            volume=1.0,
            gravity=0.5,
            discretization=iga.Discretization(elements=8),
        ),
        on_fail="return",
    )
    with pytest.raises(iga.SceneError, match="no line has an angle"):
        iga.plot_side(lying, tmp_path / "lying.png")
    with pytest.raises(iga.SceneError, match="droplets"):
        iga.plot_side(sheet, tmp_path / "sheet.png")
    with pytest.raises(iga.OutputError, match="ending must be"):
        iga.plot_section(sheet, tmp_path / "sheet.bmpx")


@dataclass(frozen=True)
class Grid:
    """A table of a force that vanishes on a known line."""

    angles: tuple[float, ...] = tuple(np.linspace(10.0, 170.0, 9).tolist())
    bonds: tuple[float, ...] = tuple(np.linspace(0.1, 1.0, 7).tolist())

    def column(self, name):
        angle, bond = (x.ravel() for x in np.meshgrid(self.angles, self.bonds, indexing="ij"))
        force = 1.0 - bond - angle / 180.0
        columns = {"angle": angle, "bond": bond, "F_e_z": force, "lifts": (force > 0).astype(float)}
        return columns.get(name, np.full(angle.size, np.nan))


@pytest.mark.parametrize("of", ["F_e_z", "lifts"])
def test_phases_take_their_parts_of_the_diagram(tmp_path, of):
    table = Grid()
    iga.plot_phases(table, tmp_path / "phases.png", x="angle", y="bond", of=of)
    image = shown(tmp_path / "phases.png")
    red, _, blue = np.moveaxis(image, -1, 0)
    lifted, stays = blue - red > 0.25, abs(blue - red - 9 / 255) < 0.01
    part = lifted.sum() / (lifted.sum() + stays.sum())
    if of == "lifts":
        exact = table.column("lifts").mean()  # points are cells
    else:  # the triangle below 1 - bond = angle / 180 inside the frame
        angles, bonds = np.meshgrid(np.linspace(10, 170, 801), np.linspace(0.1, 1.0, 801))
        exact = (1.0 - bonds - angles / 180.0 > 0).mean()
    assert part == pytest.approx(exact, abs=0.02)


def test_a_boundary_is_drawn_over_phases_and_does_not_widen_them(tmp_path):
    ends = np.array([0.0, 180.0])
    curve = ("boundary", ends, 1.0 - ends / 180.0)
    seen = []
    for name, drawn in (("with", curve), ("without", None)):
        picture = tmp_path / f"{name}.png"
        iga.plot_phases(Grid(), picture, x="angle", y="bond", of="lifts", curve=drawn)
        red, green, blue = np.moveaxis(shown(picture), -1, 0)
        seen.append([(red - blue > 0.4).sum(), (blue - green > 0.1).sum()])
    (line, lifted), (no_line, lifted_without) = seen
    assert no_line == 0
    assert line > 500
    assert lifted == pytest.approx(lifted_without, rel=0.05)


def test_curves_have_a_colour_for_each_value(tmp_path):
    iga.plot_curves(Grid(), tmp_path / "curves.svg", x="angle", y="F_e_z", by="bond")
    text = (tmp_path / "curves.svg").read_text()
    assert all(f"#{colour}" in text for colour in ("1f77b4", "ff7f0e", "2ca02c", "d62728"))


def test_diagrams_name_what_is_missing(tmp_path):
    with pytest.raises(iga.SceneError, match="'F_x': no column"):
        iga.plot_curves(Grid(), tmp_path / "curves.png", x="angle", y="F_x")
    with pytest.raises(iga.SceneError, match="no grid"):
        iga.plot_phases(Grid(), tmp_path / "phases.png", x="angle", y="lifts", of="F_e_z")


def test_columns_of_a_path_make_its_curve(tmp_path):
    path = iga.trace(lambda bond: droplet(120, bond), [0.5, 1.0], parameter="bond")
    assert path.column("height").tolist() == [s.measures["height"] for s in path.solutions]
    iga.plot_curves(path, tmp_path / "path.png", x="bond", y=["height", "contact_radius"])
    assert shown(tmp_path / "path.png").std() > 0.02


def test_a_missing_matplotlib_is_named_with_the_remedy(solution, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(iga.OutputError, match="pip install matplotlib"):
        iga.plot_section(solution, tmp_path / "section.png")
