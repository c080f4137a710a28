"""Every public field with a wrong type, a value out of range and one that is not finite; wrong
objects in Python; paths, options and nets (I3, I4, I7, I9-I11, I14-I18, X5, X7)."""

import contextlib
import json
import tomllib

import numpy as np
import pytest
from helpers import droplet, within

import iga_membrane as iga
from iga_membrane.checks import wet_angle
from iga_membrane.fields import FIELDS as RULES
from iga_membrane.io.scene_keys import KEYS

DROPLET = """
scene = "sessile_droplet"
[liquid]
surface_tension = 1.0
density = 1.0
volume = 4.1887902047863905
[gravity]
acceleration = 1.0
direction = [0, 0, -1]
[substrate]
kind = "sphere_lattice"
contact_angle = 180.0
radius = 0.4
spacing = 1.2
arrangement = "square"
offset = [0.0, 0.0]
base = -0.8
[droplet]
hold = "none"
[discretization]
space = "bspline"
degree = 2
elements = 8
model = "eighth"
[solver]
motion = "spines"
contact = "penalty"
penalty = 1.0e4
penetration_tolerance = 1.0e-2
start = "flat"
max_cpu_s = 60.0
"""
SHEET = """
scene = "liquid_sheet"
[liquid]
surface_tension = 1.0
[[particle]]
radius = 1.0
center = [0.0, 0.0, -1.0]
density = 1.0
contact_angle = 90.0
motion = "fixed"
[sheet]
boundary = "circle"
size = 5.0
pressure = 0.1
liquid_weight = false
[[path]]
parameter = "sheet.pressure"
values = [0.1, 0.2]
"""


CELL = """
scene = "asperity_cell"
[substrate]
kind = "sphere"
contact_angle = 180.0
radius = 1.0
[cell]
shape = "square"
size = 4.0
pressure = 0.5
"""
FILM = """
scene = "film_between_rings"
[rings]
radius = 1.0
half_height = 0.5
volume = 3.0
"""
LIST = """
scene = "sessile_droplet"
[liquid]
volume = 4.1887902047863905
[substrate]
kind = "spheres"
contact_angle = 180.0
centers = [[0.0, 0.0, -1.0]]
radii = [1.0]
"""
BRIDGE = """
scene = "capillary_bridge"
[liquid]
volume = 0.5
[lower]
kind = "disc"
radius = 0.6
contact_angle = 60.0
edge = 90.0
[upper]
kind = "disc"
radius = 0.6
contact_angle = 60.0
edge = 90.0
[gap]
distance = 0.3
"""
WITH = {"lower": BRIDGE, "upper": BRIDGE, "gap": BRIDGE,
        "particle": SHEET, "sheet": SHEET, "path": SHEET, "cell": CELL, "rings": FILM,
        "centers": LIST, "radii": LIST}  # fmt: skip
"""A scene to which a table or a field belongs, where it is not the droplet."""


def tables(text):
    return tomllib.loads(text)


def with_value(table, key, value):
    data = tables(WITH.get(key, WITH.get(table, DROPLET)))
    place = data[table]
    (place[0] if isinstance(place, list) else place)[key] = value
    return data


def label(table, key):
    return f"{table}[0].{key}" if table in ("particle", "path") else f"{table}.{key}"


@pytest.fixture(scope="module", autouse=True)
def _imported():
    """Every scene can be read, and what reading needs is imported before it is timed."""
    for text in (DROPLET, SHEET, CELL, FILM, LIST, BRIDGE):
        iga.read_scene(tables(text))


def refused(read, table, key, value):
    """Before any assembly, within 50 ms, by the field's path, the value and what is allowed."""
    with within(0.05), pytest.raises(iga.SceneError) as caught:
        read()
    said = str(caught.value)
    assert label(table, key) in said
    assert any(word in said for word in ("must ", "needed", "needs", "not available", "the same"))
    if not (isinstance(value, list) or (key in TABLES and isinstance(value, dict))):
        # of a list the bad item is named, of a table the bad key
        assert repr(value) in said or repr(float(value)) in said


FIELDS = [(table, key) for table in KEYS if table for key in KEYS[table]]
TEXTS = ("kind", "arrangement", "motion", "hold", "boundary", "shape", "space", "model",
         "contact", "contact_line", "start", "parameter")  # fmt: skip
TABLES = ("wettability",)
EXPRESSION = "__import__('os').system('touch evaluated')"


@pytest.mark.parametrize(("table", "key"), FIELDS)
def test_every_field_refuses_a_wrong_type(table, key, tmp_path, monkeypatch):
    """Text without a unit, with one of what the field is not, or to be evaluated (X5), is no
    number; a number is no text."""
    monkeypatch.chdir(tmp_path)
    if key in (*TEXTS, "file"):
        wrong = [5, True]
    elif key in ("liquid_weight", "follow_instability"):
        wrong = [1, "true"]
    else:
        wrong = ["1", "72 N m", "1 MN/m", "1 banana", EXPRESSION, True]
    for value in (*wrong, {"a": 1}, None, [[[]]]):
        refused(lambda v=value: iga.read_scene(with_value(table, key, v)), table, key, value)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("table", "key"), FIELDS)
def test_every_field_refuses_what_is_not_finite(table, key):
    for value in (float("nan"), float("inf"), -float("inf"), 1e999):
        refused(lambda v=value: iga.read_scene(with_value(table, key, v)), table, key, value)


@pytest.mark.parametrize(("table", "key"), FIELDS)
def test_every_field_of_a_file_refuses_what_is_not_finite(table, key, tmp_path):
    """I3: JSON readers take NaN, and 1e999 as infinite."""
    path = tmp_path / "scene.json"
    for text, value in (("NaN", float("nan")), ("1e999", float("inf"))):
        path.write_text(json.dumps(with_value(table, key, "here")).replace('"here"', text))
        refused(lambda: iga.load_scene(path), table, key, value)


OUT = {
    "degree": (0, 1, 5),
    "elements": (0, 1, 2, 4097),
    "spacing": (0.0, -1.0, 0.79),
    "base": (0.1,),
    "penalty": (0.0, -1.0),
    "stabilization": (0.0, -1.0),
    "penetration_tolerance": (0.0, -1e-2),
    "max_cpu_s": (0.0, -1.0),
    "max_memory_gb": (0.0,),
    "direction": ([0, 0, 0], [1, 2], []),
    "center": ([0, 0], [9.0, 0, -1]),
    "centers": ([], [[0, 0]]),
    "offset": ([0],),
    "values": ([], [1.0], [1.0, 1.0], [0.1] * 10_001),
    "liquid_weight": ("yes",),
    "follow_instability": ("yes",),
    "parameter": ("sheet", "sheet.pressur"),
    "axis": ([0, 0, 0], [1, 2], []),
    "amplitudes": ([], [1.0, "1"]),
    "wettability": ({"kind": "dots"}, {"border": 0.0}, {"angles": [90.0, 181.0]}),
    "file": ("", "\0"),
} | {key: ("no such word",) for key in TEXTS if key != "parameter"}
FREE = {("sheet", "pressure"), ("sheet", "volume"), ("cell", "pressure"), ("rings", "pressure"),
        ("substrate", "amplitude"), ("substrate", "height"), ("liquid", "density")}  # fmt: skip
"""Fields of which any finite number is right: the volume of a sheet has a sign, a dimple's height
and the density of a liquid that is lighter than its surroundings too."""


def below(rule):
    rule = getattr(rule, "keywords", {}).get("each", rule)
    limits = {"least": 0.0, "most": 180.0} if rule is wet_angle else rule.keywords
    least = limits.get("above", limits.get("least", 0.0))
    values = [least - 1.0] + ([least, least - 1e-9] if "above" in limits else [])
    return values + ([1.01 * limits["most"], 200.0] if "most" in limits else [])


@pytest.mark.parametrize(("table", "key"), [field for field in FIELDS if field not in FREE])
def test_every_field_refuses_what_is_out_of_range(table, key):
    for value in OUT.get(key) or below(RULES[f"{table}.{key}"]):
        refused(lambda v=value: iga.read_scene(with_value(table, key, v)), table, key, value)


PLANE = iga.Plane(contact_angle=90)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: iga.sessile_droplet("plane", volume=1.0), "substrate = 'plane'"),
        (lambda: iga.sessile_droplet(PLANE, volume=1.0, liquid="water"), "liquid = 'water'"),
        (lambda: iga.sessile_droplet(PLANE, volume=1.0, discretization=8), "discretization = 8"),
        (lambda: iga.sessile_droplet(PLANE, volume=1.0, gravity=[0, 1]), "three numbers"),
        (lambda: iga.sessile_droplet(PLANE, volume=1.0, gravity="g"), "gravity"),
        (lambda: iga.sessile_droplet(PLANE, volume="1 mm"), "liquid.volume = '1 mm'"),
        (lambda: iga.liquid_sheet(3.0, size=5.0), "particle = 3.0"),
        (lambda: iga.liquid_sheet(size=5.0, liquid_weight=1), "liquid_weight = 1"),
        (lambda: iga.liquid_sheet(size=2.0, pressure=1.0, volume=1.0), "pressure, sheet.volume"),
        (lambda: iga.film_between_rings(half_height=0.5, pressure=1.0, volume=1.0),
         "rings.volume, rings.pressure"),
        (lambda: iga.asperity_cell(PLANE, size=1.0, pressure=1.0), "sphere = Plane"),
        (lambda: iga.solve(5), "scene = 5"),
        (lambda: iga.solve(droplet(90), {"tolerance": 1}), "options = {"),
        (lambda: iga.solve(droplet(90), on_fail="ignore"), "on_fail = 'ignore'"),
        (lambda: iga.load_scene(5), "path = 5"),
        (lambda: iga.load(5), "path = 5"),
        (lambda: iga.trace(lambda angle: angle, [90, 120]), "scene_at(90) = 90.0: must be a Scene"),
        (lambda: iga.trace(droplet, 5), "values = 5"),
        (lambda: iga.trace(droplet, []), "two or more"),
        (lambda: iga.trace(droplet, [90, 120, 120]), "values[2] = 120.0: the same as"),
        (lambda: iga.trace(droplet, [90, "120"]), "values[1]"),
        (lambda: iga.trace(droplet, np.arange(1e7)), "10000000 numbers"),
        (lambda: iga.trace(droplet, [90, 120], on_fail="x"), "on_fail = 'x'"),
        (lambda: iga.Spheres(180, [], 1.0), "at least one sphere"),
        (lambda: iga.Spheres(180, 5, 1.0), "substrate.centers = 5"),
        (lambda: iga.Spheres(180, [[0, 0, 0]], "x"), "substrate.radii = 'x'"),
        (lambda: iga.Spheres(180, [[0, 0, 0]], [0.0]), "substrate.radii[0] = 0.0"),
        (lambda: iga.Spheres(180, [[0, 0, np.nan]], 1.0), "substrate.centers[0][2] = nan"),
        (lambda: iga.Spheres(180, np.array([[0, 0, np.inf]]), 1.0), "substrate.centers[0][2]"),
        (lambda: iga.Spheres([180, 90], [[0, 0, 0]], 1.0), "substrate.contact_angle"),
        (lambda: iga.SphereLattice(180, 0.05, 0.09), "spacing must be >= 0.1"),
        (lambda: iga.SolverOptions(tolerance=0), "solver.tolerance = 0.0"),
        (lambda: iga.SolverOptions(tolerance=-1), "solver.tolerance = -1.0"),
        (lambda: iga.SolverOptions(tolerance=9e-15), ">= 1e-14"),
        (lambda: iga.SolverOptions(max_iterations=0), "solver.max_iterations = 0"),
        (lambda: iga.SolverOptions(max_cpu_s=0), "solver.max_cpu_s = 0.0"),
        (lambda: iga.SolverOptions(audit="no"), "solver.audit = 'no'"),
        (lambda: iga.tensor_space(*cap_bases(), np.zeros((9, 3))), "weights[0, 0] = 0.0"),
        (lambda: iga.tensor_space(*cap_bases(), -np.ones((9, 3))), "weights[0, 0] = -1.0"),
        (lambda: iga.tensor_space(*cap_bases(), np.ones((3, 9))), "shape (3, 9) given"),
    ],
)  # fmt: skip
def test_wrong_objects_and_values_in_python_are_named(make, said):
    with within(1.5), pytest.raises(iga.SceneError) as caught:
        make()
    assert said in str(caught.value)


@pytest.mark.parametrize("kind", ["sessile_droplet", "liquid_sheet", "asperity_cell", "film"])
@pytest.mark.parametrize("elements", [1, 2])
def test_too_few_elements_are_refused_with_the_least(kind, elements):
    """I9, in every kind of scene."""
    data = tables({"liquid_sheet": SHEET, "asperity_cell": CELL, "film": FILM}.get(kind, DROPLET))
    data["discretization"] = {"elements": elements}
    with pytest.raises(iga.SceneError, match=f"elements = {elements}: .* from 3 to 4096"):
        iga.read_scene(data)


def cap_bases():
    return iga.cap(1.0, 60.0).space.bases


@pytest.mark.parametrize(
    "change",
    [
        lambda p: p.T,
        lambda p: p.astype(object),
        lambda p: p.astype(complex),
        lambda p: p.astype(str),
        lambda p: p.astype(int),
        lambda p: p[:-1],
        lambda p: p * np.nan,
    ],
)
def test_a_wrong_control_net_is_refused_with_what_was_expected(change):
    surface = iga.cap(1.0, 60.0)
    with pytest.raises(iga.GeometryError, match=r"expected|not finite"):
        surface.moved(change(surface.points))


def test_single_precision_is_taken_with_a_notice():
    surface = iga.cap(1.0, 60.0)
    with pytest.warns(UserWarning, match="float32 given"):
        raised = surface.moved(surface.points.astype(np.float32))
    assert raised.points.dtype == float


def test_a_far_asperity_and_many_are_no_burden():
    """I17: an asperity 1e6 R away; a hundred thousand in a list; the limit is stated."""
    near = [[0.0, 0.0, -0.5]]
    far = [*near, [1e6, 0.0, -0.5]]
    mesh = iga.Discretization(elements=8, degree=2, model="quarter")
    one, two = (
        iga.solve(
            iga.sessile_droplet(
                iga.Spheres(180, centers, 0.5, base=-3.0), volume=0.5, discretization=mesh
            ),
            on_fail="return",
        )
        for centers in (near, far)
    )
    assert one.status is two.status
    assert one.measures["energy"] == pytest.approx(two.measures["energy"], rel=1e-9)
    many = np.zeros((100_000, 3))
    many[:, 0] = 3.0 * np.arange(100_000)
    with within(2.0):
        spheres = iga.Spheres(180, many, 1.0)
        gap = spheres.nearest(np.array([[2.9e5, 0.0, 2.0]])).gap
    assert gap == pytest.approx(np.hypot(1.0, 2.0) - 1.0)
    with pytest.raises(iga.SceneError, match="at most 1000000"):
        iga.Spheres(180, np.zeros((1_000_001, 3)), 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("text", [DROPLET, SHEET], ids=["droplet", "sheet"])
@pytest.mark.parametrize("ending", ["toml", "json"])
def test_mutated_scene_files_give_typed_errors_or_scenes_and_quickly(tmp_path, text, ending):
    """X7, with the state files of test_state_files: bytes changed, cut out and put in."""
    original = text if ending == "toml" else json.dumps(tables(text))
    rng = np.random.default_rng(3)
    path = tmp_path / f"scene.{ending}"
    read = 0
    for _ in range(500):
        data = bytearray(original.encode())
        for _ in range(rng.integers(1, 4)):
            start = int(rng.integers(len(data)))
            end = start + int(rng.integers(1, 8))
            match int(rng.integers(4)):
                case 0:
                    data[start:end] = rng.bytes(end - start)
                case 1:
                    del data[start:end]
                case 2:
                    data[start : start + 1] = b"0123456789-.e"[rng.integers(13)].to_bytes()
                case 3:
                    data[start:start] = data[: end - start]
        path.write_bytes(data)
        with within(1.0), contextlib.suppress(iga.SceneError, iga.GeometryError):
            read += isinstance(iga.load_scene(path).scene, iga.Scene)
    assert read
