"""The JSON schema of scene files says what their rules say."""

import copy
import json
import tomllib

import fastjsonschema
import pytest
from helpers import EXAMPLES

import iga_membrane as iga
from iga_membrane.cli import main
from iga_membrane.fields import FIELDS
from iga_membrane.io.schema import SEVERAL, schema_of

VALUES = [
    0, 1, 3, 5, -1, 4096, 5000, 0.5, -0.5, 90.0, 180.0, 181.0, 1e-3, "full", "plane", "none", "xy",
    "auto", "square", "fixed", "bspline", "spines", "exact", "state.npz",
    "state.txt", "bump", "", True, False, None, [], [1.0], [1.0, 2.0],
    [1.0, 2.0, 3.0], [[1.0, 2.0, 3.0]], [1.0, "x", 2.0], [[1.0, 2.0]], {}, {"a": 1.0}, [90.0, 0.0],
    [90.0, 200.0],
]  # fmt: skip
"""Of every kind and on both sides of every bound."""
WHOLE = [90.0, 180.0, 181.0]
"""Those that are written with a point, but are whole."""


@pytest.fixture(scope="module")
def valid():
    check = fastjsonschema.compile(iga.scene_schema())

    def whether(data):
        try:
            check(copy.deepcopy(data))
        except fastjsonschema.JsonSchemaValueException:
            return False
        return True

    return whether


@pytest.mark.parametrize("field", FIELDS)
def test_the_schema_of_a_field_allows_what_its_rule_allows(field):
    check, taken = fastjsonschema.compile(schema_of(FIELDS[field])), []
    for value in VALUES:
        try:
            FIELDS[field](field, value)
        except iga.SceneError:
            if schema_of(FIELDS[field]).get("type") == "integer" and value in WHOLE:
                continue  # JSON knows no other whole numbers
            with pytest.raises(fastjsonschema.JsonSchemaValueException):
                check(value)
            continue
        check(value)
        taken.append(value)
    assert 0 < len(taken) < len(VALUES)


def test_files_keep_the_schema(valid):
    data = tomllib.loads((EXAMPLES / "droplet.toml").read_text())
    assert valid(data)
    assert not valid({name: table for name, table in data.items() if name != "scene"})
    assert not valid(data | {"scene": "droplet"})
    assert not valid(data | {"liquit": {}})
    assert not valid(data | {"liquid": {"tension": 1.0}})
    assert not valid(data | {"sheet": {"size": 1.0}})
    assert not valid(data | {"schema": 2})
    assert not valid(data | {"particle": {"radius": 1.0}})
    assert valid(data | {"particle": [{"radius": 1.0}]})


def test_every_table_is_in_the_schema():
    tables = iga.scene_schema()["properties"]
    for field in FIELDS:
        name, _, key = field.partition(".")
        table = tables[name]["items"] if name in SEVERAL else tables[name]
        assert key in table["properties"]


def test_the_command_line_prints_it(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == iga.scene_schema()
