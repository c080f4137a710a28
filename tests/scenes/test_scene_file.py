"""The scene file's contract: what is refused, and how it is said (I1-I5, I8, I12, I13, X5, X7)."""

import copy
import json
import re
import tomllib

import numpy as np
import pytest
from helpers import EXAMPLES, UNIT_VOLUME, within
from hypothesis import given, settings
from hypothesis import strategies as st

import iga_membrane as iga
from iga_membrane.cli import main

GOOD = {
    "scene": "sessile_droplet",
    "liquid": {"surface_tension": 1.0, "density": 1.0, "volume": UNIT_VOLUME},
    "gravity": {"acceleration": 1.0, "direction": [0, 0, -1]},
    "substrate": {"kind": "plane", "contact_angle": 150.0},
    "droplet": {"hold": "none"},
    "discretization": {"space": "bspline", "degree": 3, "elements": 8, "model": "eighth"},
    "solver": {"max_cpu_s": 60.0, "max_memory_gb": 1.0, "follow_instability": True},
}


def changed(path, value):
    data = copy.deepcopy(GOOD)
    *tables, key = path.split(".")
    place = data
    for table in tables:
        place = place.setdefault(table, {})
    place[key] = value
    return data


def refusal(data):
    with within(0.05), pytest.raises(iga.SceneError) as caught:
        iga.read_scene(data)
    return str(caught.value)


def test_the_good_scene_is_read():
    file = iga.read_scene(GOOD)
    assert file.scene.kind == "sessile_droplet"
    limits = {"max_cpu_s": 60.0, "max_memory_gb": 1.0, "follow_instability": True}
    assert file.solver == limits
    assert file.scene.description["substrate"]["contact_angle"] == 150.0


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("liquid.volume", 0.0, "volume must be > 0"),
        ("liquid.volume", -1e-9, "liquid.volume = -1e-09: volume must be > 0"),
        ("liquid.surface_tension", 0.0, "surface_tension must be > 0"),
        ("gravity.acceleration", -9.81, "acceleration must be >= 0"),
        ("gravity.direction", [0, 0, 0], "must not be zero"),
        ("gravity.direction", [0, 1], "three numbers"),
        ("substrate.contact_angle", 0.0, "contact_angle must be > 0 and <= 180"),
        ("substrate.contact_angle", 200.0, "substrate.contact_angle = 200.0"),
        ("substrate.kind", "plain", 'did you mean "plane"'),
        ("discretization.degree", 1, "C1 needed"),
        ("discretization.degree", 5, "from 1 to 4"),
        ("discretization.degree", 3.0, "whole number"),
        ("discretization.elements", 2, "from 3"),
        ("discretization.space", "splines", "must be one of"),
        ("discretization.model", "third", "must be one of"),
        ("solver.max_cpu_s", 0.0, "max_cpu_s must be > 0"),
        ("solver.penalty", -1.0, "penalty must be > 0"),
        ("solver.stabilization", -0.1, "stabilization must be > 0"),
        ("droplet.hold", "yx", "must be one of"),
        ("scene", "sesile_droplet", 'did you mean "sessile_droplet"'),
        ("schema", 2, "schema = 2: this version reads schema 1; leave the key out or convert"),
        ("schema", 0, "schema = 0: this version reads schema 1"),
        ("particle", {"radius": 1.0}, "list of tables"),
    ],
)
def test_values_out_of_range_are_named(path, value, said):
    message = refusal(changed(path, value))
    assert said in message
    assert path.split(".")[-1] in message


@pytest.mark.parametrize(
    "text", ["72 mm", "72", "1 nm", "1 banana", "__import__('os').system('true')"]
)
@pytest.mark.parametrize(
    "path", ["liquid.surface_tension", "liquid.volume", "gravity.acceleration"]
)
def test_text_is_only_read_as_a_quantity_of_what_the_field_is(path, text):
    message = refusal(changed(path, text))
    assert path in message
    said = "has no unit", "unknown unit", "must be a quantity of", "must begin with a number"
    assert any(each in message for each in said)


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("substrate.tehta", "substrate.tehta: unknown key"),
        ("substrate.contact_angel", 'did you mean "contact_angle"'),
        ("likwid", "likwid: unknown key"),
        ("liquid.volumen", 'did you mean "volume"'),
    ],
)
def test_misspelt_keys_are_refused(path, said):
    assert said in refusal(changed(path, 1.0))


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("substrate.kind", "spheres", "substrate.centers: missing"),
        (
            "substrate.kind",
            "none",
            'substrate.contact_angle: substrate.kind = "none" has no such field',
        ),
        ("substrate.kind", "sphere", "substrate.radius: missing"),
        ("scene", "asperity_cell", "gravity: does not belong"),
        ("scene", "liquid_sheet", "substrate: does not belong"),
        ("particle", [{"radius": 1.0}], "particle[0].center: missing"),
        (
            "particle",
            [{"radius": 0.2, "center": [0, 0, 1.5], "contact_angle": 90, "motion": "sideways"}],
            "particle[0].motion = 'sideways'",
        ),
        (
            "particle",
            [{"radius": 0.2, "center": [0, 0, 0.1], "contact_angle": 90}],
            "it reaches 0.1 into the substrate",
        ),
        ("solver.contact", "penalty", "not available yet"),
        ("solver.contact_line", "adhesion", "not available here"),
        ("solver.start", "flat", "only at 180 degrees"),
        ("substrate.base", -0.1, 'substrate.kind = "plane" has no such field'),
        ("sheet", {"size": 5.0}, "does not belong"),
    ],
)
def test_what_is_not_built_or_does_not_belong_is_refused_by_name(path, value, said):
    assert said in refusal(changed(path, value))


def test_missing_fields_are_named():
    for field in ("liquid.volume", "substrate.contact_angle", "scene"):
        data = copy.deepcopy(GOOD)
        *tables, key = field.split(".")
        place = data[tables[0]] if tables else data
        del place[key]
        assert f"{field}: missing" in refusal(data)


def test_a_model_with_a_mirror_that_gravity_lacks_is_refused():
    data = changed("gravity.direction", [0.1, 0, -1])
    message = refusal(data)
    assert 'discretization.model = "eighth"' in message
    assert '"half"' in message
    del data["discretization"]["model"]
    assert iga.read_scene(data).scene.sector.model == "half"


@pytest.mark.parametrize("angle", [1e-3, 1.0, 2.6, 3.14159])
def test_an_angle_in_radians_gets_a_hint_not_an_error(angle):
    scene = iga.read_scene(changed("substrate.contact_angle", angle)).scene
    assert "degrees?" in scene.warnings[0]


def test_an_angle_that_can_only_be_degrees_gets_no_hint():
    assert not iga.read_scene(changed("substrate.contact_angle", 3.15)).scene.warnings


ROW = [[-1.5, 0.0, -0.5], [1.5, 0.0, -0.5], [0.0, 0.0, -0.5]]


@pytest.mark.parametrize(
    ("substrate", "down", "body"),
    [
        (iga.Plane(120), 0.25, "0"),
        (iga.Plane(150), 0.05, "0"),
        (iga.Sphere(120, 1.0, (0.0, 0.0, -1.0)), 0.3, "0"),
        (iga.Spheres(180, ROW, 0.5), 0.4, "2"),
        (iga.SphereLattice(180, 0.4, 1.2), 0.4, r"\d+"),
    ],
)
def test_a_start_below_the_substrate_is_refused_with_depth_body_and_lift(substrate, down, body):
    """I5"""
    options = {"volume": 4.0, "gravity": 0.1}
    own = iga.sessile_droplet(substrate, **options).surface
    start = own.transformed(shift=[0, 0, -down])
    words = rf"up to (\S+) below the substrate \(solid {body}\) at .*; lift it by at least (\S+) "
    with pytest.raises(iga.SceneError, match=words) as caught:
        iga.sessile_droplet(substrate, start=start, **options)
    depth, lift = map(float, re.search(words, str(caught.value)).groups())
    assert 0.7 * down <= depth <= down  # along the normal of the solid, at a sample
    assert 0.3 * down <= lift <= depth
    assert iga.sessile_droplet(substrate, start=own, **options).kind == "sessile_droplet"


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("scene.json", '{"scene": "a", "scene": "b"}', "scene: given 2 times"),
        ("scene.json", '{"liquid": {"volume": NaN}, "scene": "sessile_droplet"}', "liquid.volume"),
        ("scene.json", "[" * 100_000, "not a scene file"),
        ("scene.toml", "scene = ", "not a scene file"),
        ("scene.toml", 'scene = "sessile_droplet"\nscene = "b"', "not a scene file"),
    ],
)
def test_bad_files_are_refused(tmp_path, name, text, said):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(iga.SceneError, match=said):
        iga.load_scene(path)


def test_files_that_cannot_be_read_are_named(tmp_path):
    with pytest.raises(iga.SceneError, match=r"missing\.toml"):
        iga.load_scene(tmp_path / "missing.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(iga.SceneError, match="cannot be read"):
        iga.load_scene(tmp_path / "binary.toml")


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.integers(0, 10**9))
def test_mutated_files_give_typed_errors_or_valid_scenes(seed):
    rng = np.random.default_rng(seed)
    text = bytearray(json.dumps(GOOD).encode())
    for _ in range(rng.integers(1, 4)):
        text[rng.integers(len(text))] = rng.integers(32, 127)
    try:
        data = json.loads(text)
    except json.JSONDecodeError:
        return
    try:
        iga.read_scene(data)
    except iga.SceneError:
        return


PATHS = {
    "substrate.contact_angle": ("""
scene = "sessile_droplet"
[liquid]
volume = 4.1887902047863905
[gravity]
acceleration = 1.0
[substrate]
contact_angle = 90.0
""", (90, 120, 150), "height"),
    "particle[0].center[2]": ("""
scene = "liquid_sheet"
[[particle]]
radius = 1.0
center = [0.0, 0.0, -1.0]
contact_angle = 90.0
[sheet]
size = 5.0
""", (-1.3, -1.0, -0.8), "z_contact"),
    "rings.volume": ("""
scene = "film_between_rings"
[rings]
half_height = 0.5
""", (2.0, 3.0), "neck_radius"),
}  # fmt: skip


@pytest.mark.parametrize("parameter", PATHS)
def test_a_path_is_walked_from_the_command_line(parameter, tmp_path):
    text, values, rising = PATHS[parameter]
    text += "[discretization]\nelements = 6\n"
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(f'{text}[[path]]\nparameter = "{parameter}"\nvalues = {list(values)}\n')
    assert main(["solve", str(scene), "--out", str(out)]) == 0
    result = json.loads((out / "result.json").read_text())
    assert result["scene"]["path"] == [{"parameter": parameter, "values": list(values)}]
    stops = [step for step in result["history"] if step["measures"]]
    assert [step["value"] for step in stops] == list(values)
    found = [step["measures"][rising] for step in stops]
    assert found == sorted(found)
    assert stops[-1]["measures"] == result["measures"]
    direct = iga.read_scene(tomllib.loads(text) | {"path": []}).scene
    assert direct.kind == iga.load_scene(scene).scene.kind


def test_a_path_through_a_limit_exits_with_its_bracket(tmp_path):
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(
        'scene = "liquid_sheet"\n[sheet]\nboundary = "circle"\nsize = 2.0\n'
        "[discretization]\nelements = 8\n"
        '[[path]]\nparameter = "sheet.pressure"\nvalues = [0.0, 1.0, 2.1]\n'
    )
    assert main(["solve", str(scene), "--out", str(out)]) == 3
    result = json.loads((out / "result.json").read_text())
    assert result["status"] == "LIMIT_POINT"
    bracket = result["bracket"]
    assert bracket["parameter"] == "sheet.pressure"
    assert bracket["lo"] <= 2.0 <= bracket["hi"]
    assert bracket["hi"] - bracket["lo"] <= 1e-3
    assert (bracket["index_lo"], bracket["index_hi"]) == (0, 1)
    assert [step["value"] for step in result["history"] if step["measures"]] == [0.0, 1.0]


def test_a_path_off_the_axis_takes_the_largest_model_it_needs():
    data = {
        "scene": "liquid_sheet",
        "sheet": {"size": 5.0},
        "particle": [{"radius": 1.0, "center": [0, 0, -1], "contact_angle": 90.0}],
        "path": [{"parameter": "particle[0].center[0]", "values": [0.3, 0.0]}],
    }
    scene = iga.read_scene(data).scene
    assert scene.sector.model == "half"
    assert [scene.ramp(load).sector.model for load in (0.0, 1.0)] == ["half", "half"]


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ({"values": [1, 2]}, "path[0].parameter: missing"),
        ({"parameter": "substrate.contact_angle"}, "path[0].values: missing"),
        ({"parameter": "substrate.contact_angle", "values": [90]}, "two or more"),
        ({"parameter": "substrate.contact_angle", "values": 90}, "path[0].values = 90"),
        ({"parameter": "substrate.contact_angle", "values": [90, "120"]}, "path[0].values[1]"),
        ({"parameter": "substrate.contact_angle", "values": [90, 200]}, "contact_angle = 200"),
        ({"parameter": "substrate.contact_angel", "values": [90, 120]}, "path[0].parameter"),
        ({"parameter": "contact_angle", "values": [90, 120]}, "path[0].parameter"),
        ({"parameter": "gravity.direction[7]", "values": [0, 1]}, "no such place"),
        ({"parameter": "substrate.contact_angle.x", "values": [0, 1]}, "path[0].parameter"),
        ({"parameter": "particle[0].center[2]", "values": [0, 1]}, "no such place"),
        ({"parameter": "substrate.contact_angle", "values": [90, float("nan")]}, "values[1]"),
        ({"parameter": "substrate.contact_angle", "value": [90, 120]}, "path[0].value"),
        ({"parameter": 3.0, "values": [90, 120]}, "path[0].parameter"),
        ({"parameter": "droplet.hold", "values": [0, 1]}, "hold"),
    ],
)
def test_bad_paths_are_named(path, said):
    assert said in refusal(changed("path", [path]))


def test_a_second_path_is_not_available_yet():
    path = {"parameter": "substrate.contact_angle", "values": [90, 120]}
    assert "2 [[path]] tables: not available yet" in refusal(changed("path", [path, path]))


@pytest.mark.parametrize("ending", [".toml", ".json"])
def test_files_with_the_line_ends_of_windows_are_the_same(ending, tmp_path):
    """A file written there, with its mark of the order of bytes too."""
    text = (EXAMPLES / "droplet.toml").read_text()
    if ending == ".json":
        text = json.dumps(tomllib.loads(text), indent=1)
    scenes = []
    for name, data in (("here", text.encode()), ("there", text.replace("\n", "\r\n").encode()),
                       ("marked", text.replace("\n", "\r\n").encode("utf-8-sig"))):  # fmt: skip
        path = tmp_path / f"{name}{ending}"
        path.write_bytes(data)
        scenes.append(iga.load_scene(path).scene.description)
    assert scenes[0] == scenes[1] == scenes[2]
