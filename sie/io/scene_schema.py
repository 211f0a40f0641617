"""The JSON Schema of scene files, made from the table of their keys (`scene_keys`).

It has the names of all keys, the types of their values and what must be given together, with the
descriptions of the parameters' docstrings. An editor completes and checks by it a file whose first
line is

    #:schema scene.schema.json

Numbers that make no contact problem are refused when the file is read.
"""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Iterable
from typing import Any

from sie.problem.material import Elastic
from sie.problem.request import WANTS
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.kinds import KINDS
from sie.profiles.row import Periodic
from sie.profiles.sampled import Sampled

from .beside_scene import Crack, Fatigue
from .scene_keys import BESIDE, LOADS, MODIFIERS, PERIOD, REQUIRED, TABLES, Form, Keys, forms_of
from .scene_values import TEXT, Shape

# Whose docstrings describe the keys of each table; of the others it is the scene's.
DESCRIBED = {"fatigue": Fatigue, "crack": Crack, "body": Elastic}
TERMS = {"type": "array", "items": {"$ref": "#/definitions/term"}}


def schema_text() -> str:
    """The schema as JSON text."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def schema() -> Shape:
    """The schema of a scene file, by draft 7, which editors know."""
    body = {"$ref": "#/definitions/body"}
    whole = {"plus": TERMS} | _values(PERIOD, Periodic)
    properties = {
        "title": TEXT,
        "want": {"type": "array", "items": {"enum": [*WANTS]}},
        "profile": {"anyOf": _kinds(whole)},
        **{name: _table(name) for name in TABLES},
        "load": _load(),
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


def _table(name: str) -> Shape:
    table = _object(_values(TABLES[name], DESCRIBED.get(name, Scene)), REQUIRED.get(name, ()))
    beside = {key: [other] for key, other in BESIDE.get(name, {}).items()}
    return table | ({"dependencies": beside} if beside else {})


def _body() -> Shape:
    given = [_all_of(("young", "poisson")), _all_of(("rigid",), {"rigid": {"const": True}})]
    return {"anyOf": [{"const": "rigid"}, _table("body") | {"anyOf": given}]}


def _load() -> Shape:
    """One of a load, a width and a path; a path takes the place of all loads."""
    table, no_path = _table("load"), {"not": _all_of(("path",))}
    return table | {
        "oneOf": [_all_of((name,)) for name in ("normal_load", "half_width", "path")],
        "dependencies": dict.fromkeys(LOADS, no_path) | table["dependencies"],
    }


def _kinds(more: Shape) -> list[Shape]:
    """The tables of all kinds of profile, each with more keys."""
    moved = more | _values(MODIFIERS, Profile)
    tables = [_kind(name, form, moved) for name in KINDS for form in forms_of(name)]
    of = TERMS | {"minItems": 1}
    return [*tables, _object({"kind": {"const": "row"}, "of": of, **moved}, ("kind", "of"))]


def _kind(name: str, form: Form, more: Shape) -> Shape:
    keys = {"kind": {"const": name}, **_values(form.keys, form.make), **more}
    return _object(keys | _values(form.treatments, Sampled), ("kind", *form.required))


# -- parts of a schema ---------------------------------------------------------------------------


def _object(properties: Shape, required: tuple[str, ...] = ()) -> Shape:
    more = {"required": [*required]} if required else {}
    return {"type": "object", "properties": properties, "additionalProperties": False, **more}


def _all_of(names: Iterable[str], properties: Shape | None = None) -> Shape:
    return {"required": [*names]} | ({"properties": properties} if properties else {})


def _any_of(names: Iterable[str]) -> Shape:
    return {"anyOf": [_all_of((name,)) for name in names]}


def _values(keys: Keys, described: Any) -> Shape:
    """What each key takes, and what the docstring of the parameter or the method says of it."""
    text = inspect.getdoc(described) or ""
    section = re.search(r"Parameters\n-+\n(.*?)(\n\n\w+\n--|\Z)", text, re.DOTALL)
    entries = re.findall(
        r"^(\w.*?) : .*\n((?:    .*\n?)+)", section[1] if section else "", re.MULTILINE
    )
    told = {name: " ".join(words.split()) for names, words in entries for name in names.split(", ")}
    for name in keys.keys() - told:
        method = inspect.getdoc(getattr(described, name, None)) or ""
        told |= {name: method.split("\n")[0]} if method else {}
    notes = {name: {"description": told[name]} for name in keys if name in told}
    return {name: shape | notes.get(name, {}) for name, shape in keys.items()}
