"""The schema accepts what the reader of scene files accepts, and no other tables."""

import copy
import json
import tomllib

import pytest
from scene_texts import ILL_FORMED

from sie.cli import main
from sie.io.scene_file import example, example_names, from_tables
from sie.io.scene_schema import schema

jsonschema = pytest.importorskip("jsonschema")
SCHEMA = jsonschema.Draft7Validator(schema())
EXAMPLES = {name: tomllib.loads(example(name)) for name in example_names()}


def accepts(tables):
    return SCHEMA.is_valid(tables)


def reads(tables):
    try:
        from_tables(tables)
    except ValueError:
        return False
    return True


def places(tables):
    """(table, key) of every key of a scene file, terms and indenters included."""
    for key, value in tables.items():
        yield tables, key
        inner = value if isinstance(value, list) else [value]
        for one in inner:
            if isinstance(one, dict):
                yield from places(one)


def changed(tables, number, change):
    """The tables with one of their keys changed."""
    tables = copy.deepcopy(tables)
    table, key = list(places(tables))[number]
    change(table, key)
    return tables


def misspell(table, key):
    table[f"{key}x"] = table.pop(key)


def mistype(table, key):
    table[key] = {"none": 1} if not isinstance(table[key], dict) else 3


def test_the_schema_is_one():
    SCHEMA.check_schema(schema())


def test_the_command_prints_the_schema(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == schema()


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_accepted_and_its_first_line_names_the_schema(name):
    assert accepts(EXAMPLES[name])
    assert example(name).startswith("#:schema scene.schema.json\n")


@pytest.mark.parametrize("change", [misspell, mistype])
@pytest.mark.parametrize("name", EXAMPLES)
def test_a_misspelt_key_and_a_value_of_another_type_are_refused(name, change):
    for k in range(len(list(places(EXAMPLES[name])))):
        tables = changed(EXAMPLES[name], k, change)
        assert not accepts(tables) and not reads(tables), tables


WEDGE = '[profile]\nkind = "wedge"\nslope = 0.1\n'
PAIR, LOAD = "[pair]\nmodulus = 1.0\n", "[load]\nnormal_load = 1.0\n"
BODY = "[body]\nyoung = 1.0\npoisson = 0.3\n"
ACCEPTED = {
    "a trace in a file": PAIR + LOAD + '[profile]\nkind = "sampled"\npath = "trace.csv"\n',
    "a rigid indenter": 'indenter = "rigid"\n' + BODY + WEDGE + LOAD,
    "a rigid body": "[body]\nrigid = true\n[indenter]\nyoung = 1\npoisson = 0\n" + WEDGE + LOAD,
    "no β": BODY + "[pair]\ndundurs = 0\n" + WEDGE + LOAD,
    "full stick": BODY + WEDGE + LOAD + "friction = inf\n",
    "a path of columns": PAIR
    + WEDGE
    + '[load]\npath = [[1.0, 0.0]]\ncolumns = ["P", "Q"]\nfriction = 0.5\n',
    "a list of depths": PAIR + WEDGE + LOAD + "[fatigue]\ndepth = [0.01, 0.02, 0.05]\n",
    "a sum that repeats": PAIR
    + LOAD
    + WEDGE
    + 'period = 4.0\n[[profile.plus]]\nkind = "parabola"\nradius = 1.0\n',
}


@pytest.mark.parametrize("text", ACCEPTED.values(), ids=ACCEPTED)
def test_what_a_scene_file_may_hold_is_accepted(text):
    assert accepts(tomllib.loads(text))


@pytest.mark.parametrize("text", [text for text, _ in ILL_FORMED])
def test_what_no_scene_file_may_hold_is_refused(text):
    assert not accepts(tomllib.loads(text))
