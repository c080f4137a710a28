"""What records say of themselves: a few lines, in a notebook a table and a picture, never data."""

import re
from dataclasses import is_dataclass

import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.overview import WIDTH, Overview
from iga_membrane.view import drawing

MESH = iga.Discretization(elements=8)
LINES, CHARACTERS = 14, 1000
"""Of a summary, at most."""


def droplet(angle):
    return iga.sessile_droplet(
        iga.Plane(contact_angle=angle), volume=1.0, gravity=1.0, discretization=MESH
    )


@pytest.fixture(scope="module")
def records():
    """Records of every kind that a user meets, by their names."""
    path = iga.trace(droplet, [90.0, 100.0, 110.0], parameter="substrate.contact_angle")
    drop = path.solutions[0]
    x = np.linspace(-1.0, 1.0, 40)
    grid = iga.HeightMap.from_grid(x, x, np.zeros((40, 40)), contact_angle=90, scale=1.0)
    places = np.stack([np.arange(300.0), np.zeros(300), np.zeros(300)], axis=1)
    surface = drop.surface
    kinematics = surface.grid(20, 20)
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(1) as pool:
        found = iga.sweep(droplet, {"angle": [90.0, 100.0]}, executor=pool)
    return {
        "Scene": drop.scene,
        "Solution": drop,
        "Path": path,
        "Sweep": found,
        "Surface": surface,
        "Space": surface.space,
        "Basis": surface.space.bases[0],
        "Table": surface.space.table(3),
        "Kinematics": kinematics,
        "HeightMap": grid,
        "Spheres": iga.Spheres(150, places, 0.1),
        "Nearest": grid.nearest(places),
        "ContactLine": iga.contact_lines(drop)[0].line,
        "Recipe": drop.scene.recipe,
        "Terms": drop.scene.terms,
    }


NAMES = ("Scene", "Solution", "Path", "Sweep", "Surface", "Space", "Basis", "Table", "Kinematics",
         "HeightMap", "Spheres", "Nearest", "ContactLine", "Recipe", "Terms")  # fmt: skip
NOTEBOOK = ("Scene", "Solution", "Path", "Sweep")


@pytest.mark.parametrize("name", NAMES)
def test_a_record_is_a_few_lines_without_data(records, name):
    said = repr(records[name])
    assert len(said) <= CHARACTERS
    assert len(said.splitlines()) <= LINES
    assert "array(" not in said
    # a row of numbers is data
    assert not re.search(r"(-?\d+\.\d+,?\s+){8}", said)
    assert is_dataclass(records[name]) or isinstance(records[name], tuple)


@pytest.mark.parametrize("name", NOTEBOOK)
def test_a_record_in_a_notebook_is_a_table(records, name):
    html = records[name]._repr_html_()
    text = records[name].overview()
    assert html.count("<tr>") == len(text.rows)
    assert len(re.sub(r"base64,[^']*", "", html)) < 4000
    drawn = name in ("Solution", "Path") and drawing.can_draw()
    assert ("data:image/png;base64," in html) == drawn


def test_a_solution_says_status_units_measures_and_stability(records):
    drop = records["Solution"]
    said = repr(drop)
    assert said.startswith("CONVERGED_STABLE, sessile droplet, dimensionless")
    for word in (f"height {drop.measures['height']:.6g}", "stability index 0", "unknowns"):
        assert word in said.replace("\n ", "")


def test_a_path_and_a_sweep_say_where_they_ran(records):
    assert "contact_angle 90 to 110 deg" in repr(records["Path"])
    assert "2 CONVERGED_STABLE" in repr(records["Sweep"])
    assert "angle 90 to 100" in repr(records["Sweep"])


def test_what_a_table_holds_is_escaped():
    """A name in a scene is not markup of the notebook."""
    html = Overview("<b>", [("<script>", "a & b")]).html()
    assert "<script>" not in html
    assert "&lt;script&gt;" in html
    assert "a &amp; b" in html


def test_no_line_is_longer_than_a_terminal_unless_one_value_is():
    rows = [(f"name {k}", f"{k} m^2") for k in range(40)]
    lines = Overview("title", rows).text().splitlines()
    assert max(map(len, lines)) <= WIDTH + 2
    assert all("name" in line and not line.endswith("name") for line in lines[1:])
