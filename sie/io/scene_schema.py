"""The JSON Schema of scene files, made from the table of their keys (`scene_keys`).

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
from collections.abc import Iterable, Mapping
from typing import Any

from sie.problem.material import Elastic
from sie.problem.request import WANTS
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.kinds import KINDS
from sie.profiles.row import Periodic
from sie.profiles.sampled import Sampled

from .crack_table import TOGETHER as OF_CRACK
from .crack_table import Crack
from .fatigue_table import TOGETHER, Fatigue
from .scene_keys import (
    LOADS,
    MODIFIERS,
    PERIOD,
    TABLES,
    Form,
    Keys,
    forms_of,
)
from .toml_values import TEXT, Json

# A number with a unit, which the reader hands to pint.
QUANTITY = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?\s*[^\s\d.,+-]"


def schema_text() -> str:
    """The schema as JSON text."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def schema() -> Json:
    """The schema of a scene file, by draft 7, which editors know."""
    tables = {name: _table(name) for name in TABLES if name not in ("body", "indenter")}
    body = {"$ref": "#/definitions/body"}
    properties = {
        "title": TEXT.shape,
        "want": {"type": "array", "items": {"enum": [*WANTS]}},
        "profile": {"anyOf": _kinds(_of_the_whole())},
        **tables,
        "load": _load(),
        "fatigue": tables["fatigue"] | {"dependencies": {k: [v] for k, v in TOGETHER}},
        "crack": tables["crack"]
        | {"required": ["at", "depths"], "dependencies": {k: [v] for k, v in OF_CRACK}},
        "body": body,
        "indenter": body,
    }
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Scene file of plane-contact",
        "definitions": {"term": {"anyOf": _kinds({})}, "body": _body()},
        **_object(properties, ("profile", "load")),
        "oneOf": [
            _all_of(("pair",), {"pair": _all_of(("modulus",))})
            | {"not": _any_of(("body", "indenter"))},
            _all_of(("body",), {"pair": {"not": _any_of(("modulus", "poisson"))}}),
        ],
    }


# -- the tables ----------------------------------------------------------------------------------


def _table(name: str) -> Json:
    return _object(
        _values(TABLES[name], _descriptions({"fatigue": Fatigue, "crack": Crack}.get(name, Scene)))
    )


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
    return {"plus": plus} | _values(PERIOD, _descriptions(Periodic))


def _kinds(more: Json) -> list[Json]:
    """The tables of all kinds of profile, each with more keys."""
    moved = more | _values(MODIFIERS, _summaries(Profile, MODIFIERS))
    tables = [_kind(name, form, moved) for name in KINDS for form in forms_of(name)]
    indenters = {"type": "array", "minItems": 1, "items": {"$ref": "#/definitions/term"}}
    row = _object({"kind": {"const": "row"}, "of": indenters, **moved}, ("kind", "of"))
    return [*tables, row]


def _kind(name: str, form: Form, more: Json) -> Json:
    keys = {"kind": {"const": name}, **_values(form.keys, _descriptions(form.make)), **more}
    treatments = _values(form.treatments, _summaries(Sampled, form.treatments))
    return _object(keys | treatments, ("kind", *form.required))


# -- parts of a schema ---------------------------------------------------------------------------


def _object(properties: Json, required: tuple[str, ...] = ()) -> Json:
    more = {"required": [*required]} if required else {}
    return {"type": "object", "properties": properties, "additionalProperties": False, **more}


def _all_of(names: tuple[str, ...], properties: Json | None = None) -> Json:
    return {"required": [*names]} | ({"properties": properties} if properties else {})


def _any_of(names: tuple[str, ...]) -> Json:
    return {"anyOf": [_all_of((name,)) for name in names]}


def _values(keys: Keys, descriptions: Mapping[str, str]) -> Json:
    """What each key takes, with its description where there is one."""

    def shape(name: str) -> Json:
        kind, dimension = keys[name]
        quantity = dimension or name == "path"
        return _or_quantity(kind.shape) if quantity else kind.shape

    told = {name: {"description": descriptions[name]} for name in keys if name in descriptions}
    return {name: shape(name) | told.get(name, {}) for name in keys}


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
