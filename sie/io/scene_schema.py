"""The JSON Schema of scene files, made from the tables that read them.

It has the names of all keys, the types of their values and what must be given together, with the
descriptions of the parameters' docstrings. An editor completes and checks by it a file whose first
line is

    #:schema scene.schema.json

Numbers that make no contact problem, and units of another kind, are refused when the file is read.
"""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, get_args

from sie.problem.material import Elastic, Plane
from sie.problem.request import WANTS
from sie.problem.scene import COUPLINGS, Scene
from sie.profiles.base import Parity, Profile
from sie.profiles.kinds import KINDS
from sie.profiles.row import Periodic
from sie.profiles.sampled import Sampled
from sie.profiles.trace_units import SIDES

from . import quantities, toml_values
from .fatigue_table import TOGETHER
from .scene_tables import (
    LOADS,
    MODIFIERS,
    TABLES,
    TREATMENTS,
    Entries,
    entries_of,
    entries_of_file,
)

Json = dict[str, Any]

NUMBER: Json = {"type": "number"}
TEXT: Json = {"type": "string"}
FLAG: Json = {"type": "boolean"}
NUMBERS: Json = {"type": "array", "items": NUMBER}
ROWS: Json = {"type": "array", "items": NUMBERS}
PAIR: Json = {**NUMBERS, "minItems": 2, "maxItems": 2}
COLUMN: Json = {"type": ["integer", "string"]}
# What each reader accepts.
SHAPES: Mapping[toml_values.Reader, Json] = {
    toml_values.number: NUMBER,
    toml_values.text: TEXT,
    toml_values.flag: FLAG,
    toml_values.whole: {"type": "integer"},
    toml_values.numbers: NUMBERS,
    toml_values.rows: ROWS,
    toml_values.texts: {"type": "array", "items": TEXT},
    toml_values.rows_or_text: {"anyOf": [ROWS, TEXT]},
    toml_values.text_or_pair: {"anyOf": [TEXT, {"type": "array", "items": TEXT}]},
    toml_values.number_or_text: {"type": ["number", "string"]},
    toml_values.number_or_pair: {"anyOf": [NUMBER, PAIR]},
    toml_values.flag_or_pair: {"anyOf": [FLAG, PAIR]},
    toml_values.columns: {"type": "array", "items": COLUMN, "minItems": 2, "maxItems": 2},
}
# A number with a unit, which the reader hands to pint, and the keys that may have one.
QUANTITY = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?\s*[^\s\d.,+-]"
DIMENSIONED = {name for table in quantities.TABLES.values() for name in table} | {"path"}
POSITIVE: Json = {"type": "number", "exclusiveMinimum": 0.0}
# The keys of which less is accepted than their reader takes.
LIMITED: Mapping[str, Json] = {
    "plane": {"enum": [*get_args(Plane)]},
    "depth": {"anyOf": [NUMBER, NUMBERS]},
    "parity": {"enum": [*get_args(Parity)]},
    "coupling": {"enum": [*COUPLINGS]},
    "heights": {"enum": [*SIDES]},
    "smoothing": {"anyOf": [NUMBER, {"enum": ["gcv"]}]},
    "sliding": {"enum": [-1, 0, 1]},
    "poisson": {"type": "number", "exclusiveMinimum": -1.0, "maximum": 0.5},
    "friction": {"type": "number", "minimum": 0.0},
    "exponent": {"type": "number", "minimum": 1.0},
    **dict.fromkeys(("young", "modulus", "normal_load", "half_width"), POSITIVE),
    **dict.fromkeys(("half_flat", "radius", "coefficient", "period"), POSITIVE),
}


def schema_text() -> str:
    """The schema as JSON text."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def schema() -> Json:
    """The schema of a scene file, by draft 7, which editors know."""
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Scene file of plane-contact",
        "definitions": {"term": {"anyOf": _kinds({})}, "body": _body()},
        **_object(
            {
                "title": TEXT,
                "want": {"type": "array", "items": {"enum": [*WANTS]}},
                "profile": {"anyOf": _kinds(_of_the_whole())},
                **{name: _table(name) for name in TABLES if name not in ("body", "indenter")},
                "load": _load(),
                "fatigue": _table("fatigue") | {"dependencies": {k: [v] for k, v in TOGETHER}},
                "body": {"$ref": "#/definitions/body"},
                "indenter": {"$ref": "#/definitions/body"},
            },
            ("profile", "load"),
        ),
        "oneOf": [
            _all_of(("pair",), {"pair": _all_of(("modulus",))})
            | {"not": _any_of(("body", "indenter"))},
            _all_of(("body",), {"pair": {"not": _any_of(("modulus", "poisson"))}}),
        ],
    }


# -- the tables ----------------------------------------------------------------------------------


def _table(name: str) -> Json:
    return _object(_values(TABLES[name], _descriptions(Scene)))


def _body() -> Json:
    table = _object(_values(TABLES["body"], _descriptions(Elastic)))
    given = [_all_of(("young", "poisson")), _all_of(("rigid",), {"rigid": {"const": True}})]
    return {"anyOf": [{"const": "rigid"}, table | {"anyOf": given}]}


def _load() -> Json:
    """One of a load, a width and a path; a path takes the place of all loads."""
    no_path = {"not": _all_of(("path",))}
    return _table("load") | {
        "oneOf": [_all_of((name,)) for name in ("normal_load", "half_width", "path")],
        "dependencies": dict.fromkeys(LOADS, no_path) | {"columns": ["path"]},
    }


# -- profiles ------------------------------------------------------------------------------------


def _of_the_whole() -> Json:
    """The keys of [profile] that its terms do not have."""
    plus = {"type": "array", "items": {"$ref": "#/definitions/term"}}
    return {"plus": plus} | _values({"period": toml_values.number}, _descriptions(Periodic))


def _kinds(more: Json) -> list[Json]:
    """The tables of all kinds of profile, each with more keys."""
    moved = more | _values(MODIFIERS, _summaries(Profile, MODIFIERS))
    tables = [_kind(name, make, entries_of(make), moved) for name, make in KINDS.items()]
    of_file = _kind("sampled", Sampled.read, entries_of_file(), moved)
    indenters = {"type": "array", "minItems": 1, "items": {"$ref": "#/definitions/term"}}
    row = _object({"kind": {"const": "row"}, "of": indenters, **moved}, ("kind", "of"))
    return [*tables, of_file, row]


def _kind(name: str, make: Callable[..., Profile], entries: Entries, more: Json) -> Json:
    keys = {"kind": {"const": name}, **_values(entries.readers, _descriptions(make)), **more}
    treatments = (
        _values(TREATMENTS, _summaries(Sampled, TREATMENTS)) if KINDS[name] is Sampled else {}
    )
    return _object(keys | treatments, ("kind", *entries.required))


# -- parts of a schema ---------------------------------------------------------------------------


def _object(properties: Json, required: tuple[str, ...] = ()) -> Json:
    more = {"required": [*required]} if required else {}
    return {"type": "object", "properties": properties, "additionalProperties": False, **more}


def _all_of(names: tuple[str, ...], properties: Json | None = None) -> Json:
    return {"required": [*names]} | ({"properties": properties} if properties else {})


def _any_of(names: tuple[str, ...]) -> Json:
    return {"anyOf": [_all_of((name,)) for name in names]}


def _values(readers: Mapping[str, toml_values.Reader], descriptions: Mapping[str, str]) -> Json:
    """What each key takes, with its description where there is one."""
    shapes = {name: LIMITED.get(name, SHAPES[reader]) for name, reader in readers.items()}
    return {
        name: (_or_quantity(shape) if name in DIMENSIONED else shape)
        | ({"description": descriptions[name]} if name in descriptions else {})
        for name, shape in shapes.items()
    }


def _or_quantity(shape: Any) -> Any:
    """The shape with a number and its unit in place of any number."""
    if isinstance(shape, list):
        return [_or_quantity(one) for one in shape]
    if shape.get("type") == "number":
        return shape | {"type": ["number", "string"], "pattern": QUANTITY}
    inner = {key: _or_quantity(shape[key]) for key in ("items", "anyOf") if key in shape}
    return shape | inner


def _descriptions(described: Any) -> dict[str, str]:
    """The sentences on each parameter in a docstring."""
    text = inspect.getdoc(described) or ""
    section = re.search(r"Parameters\n-+\n(.*?)(\n\n\w+\n--|\Z)", text, re.DOTALL)
    told = section[1] if section else ""
    found = re.findall(r"^(\w.*?) : .*\n((?:    .*\n?)+)", told, re.MULTILINE)
    return {name: " ".join(words.split()) for names, words in found for name in names.split(", ")}


def _summaries(owner: type, names: Iterable[str]) -> dict[str, str]:
    """The first line of the docstring of each method."""
    return {name: (inspect.getdoc(getattr(owner, name)) or "").split("\n")[0] for name in names}
