"""A scene as the tables of a scene file, values for JSON, and the arguments of a scene from them.

Reading the tables of a scene gives an equal one, to the last digit. The heights of a trace stand in
the tables, not the name of its file.

>>> from sie import Parabola, Scene
>>> tables_of(Scene(profile=Parabola(100.0), modulus=80e3, normal_load=50.0))["profile"]
{'kind': 'parabola', 'radius': 100.0}
"""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from sie.arguments import suggestion
from sie.problem.material import RIGID, Body, Elastic
from sie.problem.request import WANTS
from sie.profiles.base import Placed, Profile, parts_of
from sie.profiles.expression import Expression
from sie.profiles.from_function import FromFunction
from sie.profiles.kinds import KINDS
from sie.profiles.polynomials import Piecewise
from sie.profiles.row import Periodic, Row
from sie.profiles.sampled import Sampled
from sie.profiles.shapes import Wedge

from .beside_scene import Crack, Fatigue, Units
from .profile_tables import Files, profile_of
from .scene_keys import TABLES, TOP, naming, remedy, require, values_of
from .scene_values import TEXT, TEXTS, value_of

Tables = dict[str, Any]

INFINITIES = ("Infinity", "-Infinity")

# The attributes of a profile that hold parameters of another name.
HELD_BY: Mapping[type, Mapping[str, str]] = {
    Piecewise: {"breaks": "ends", "pieces": "coefficients"},
    FromFunction: {"slope": "function", "breaks": "declared", "domain": "ends"},
    Sampled: {"x": "points", "h": "heights"},
    Wedge: {"slope": "rise"},
}


def arguments_of(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of the scene of tables. ValueError for none, or for a path of loads."""
    if not isinstance(tables, Mapping):
        raise ValueError(f"{tables!r} are no tables: give a dict, like that of Scene.to_dict()")
    try:
        top = _with_infinities(tables)
        refuse_no_question(top)
        loads = values_of("load", top)
        if "path" in loads:
            raise ValueError(
                "[load] has a path, which is more than one scene: give normal_load, "
                "tangential_load and bulk_stress, or read the file by sie.io.scene_file"
            )
        units = beside_problem(top)["units"]
        return indenter_and_bodies(top, Files(Path(), units.length)) | loads
    except RecursionError:
        raise ValueError("the tables are nested too deeply for those of a scene") from None


def refuse_no_question(top: Tables) -> None:
    """ValueError for a table that is not known, and where there is no profile or load."""
    for key in top:
        if key not in TOP:
            raise ValueError(f'there is no key or table "{key}": {remedy(key, TOP, "")}')
    for name, content in (
        ("profile", 'kind = "parabola" or another'),
        ("load", "normal_load or half_width"),
    ):
        if name not in top:
            raise ValueError(f"there is no [{name}]: give [{name}] with {content}")


def beside_problem(top: Tables) -> dict[str, Any]:
    """What stands beside the contact problem: title, units, what is wanted, fatigue, crack."""
    crack = values_of("crack", top)
    return {
        "title": value_of("title", top.get("title", ""), TEXT),
        "units": Units(**values_of("units", top)),
        "want": wants("want", value_of("want", top.get("want", []), TEXTS)),
        "fatigue": Fatigue(**values_of("fatigue", top)),
        "crack": Crack(**crack) if crack else None,
    }


def wants(where: str, names: Iterable[str]) -> tuple[str, ...]:
    """The names, if all of them can be asked for. ValueError, with the nearest name, if not."""
    for name in names:
        if name not in WANTS:
            raise ValueError(f'{where} "{name}" is not known: {suggestion(name, WANTS)}')
    return tuple(names)


def indenter_and_bodies(top: Tables, beside: Files) -> dict[str, Any]:
    """The profile, and body and indenter, or modulus, dundurs and poisson."""
    return {"profile": profile_of(top["profile"], beside), **_bodies(top)}


def _bodies(top: dict[str, Any]) -> dict[str, Any]:
    """The scene's body and indenter, or modulus, dundurs and poisson."""
    pair = values_of("pair", top)
    named = [name for name in ("body", "indenter") if name in top]
    if "pair" in top and named and not pair.keys() <= {"dundurs", "coupling"}:
        raise ValueError(
            f"both [pair] and [{named[0]}] are given: [pair] stands for both bodies, leave one "
            "out; or give dundurs = 0 or coupling alone in it"
        )
    if "body" not in top:
        if "pair" not in top:
            raise ValueError(
                "there is neither [body] nor [pair]: "
                "give [body] with young and poisson, or [pair] with modulus"
            )
        require("[pair]", pair, ["modulus"])
    return {name: _read_body(name, top) for name in named} | pair


def _read_body(name: str, top: dict[str, Any]) -> Body:
    if isinstance(top[name], str):
        if top[name] != "rigid":
            raise ValueError(
                f'{name} = "{top[name]}" is not known: '
                f'write {name} = "rigid", or a table [{name}] with young and poisson'
            )
        return RIGID
    values = values_of(name, top)
    if values.pop("rigid", False):
        if values:
            raise ValueError(f"[{name}] is rigid and has {', '.join(values)}: leave one out")
        return RIGID
    require(f"[{name}]", values, ("young", "poisson"))
    with naming(f"[{name}]"):
        return Elastic(**values)


def _with_infinities(value: Any) -> Any:
    """The same as TOML has it: numbers for JSON's texts of infinity, and lists for arrays."""
    if isinstance(value, Mapping):
        strange = [key for key in value if not isinstance(key, str)]
        if strange:
            raise ValueError(f"the key {strange[0]!r} is not text: give the names of a scene file")
        return {key: _with_infinities(v) for key, v in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_with_infinities(v) for v in value]
    return float(value) if isinstance(value, str) and value in INFINITIES else value


def tables_of(scene: Any) -> Tables:
    """The tables of a `Scene`. ValueError if a scene file cannot name its profile."""
    both = ((f, getattr(scene, f.name)) for f in fields(scene))
    given = {f.name: value for f, value in both if value != f.default}
    if scene.modulus is not None and scene.beta == 0.0:
        del given["dundurs"]  # beside a modulus it is 0 if it is not given
    tables: Tables = {"profile": _profile(scene.profile)}
    if scene.body is not None:
        tables["body"] = _body(scene.body)
        if scene.indenter not in (None, scene.body):
            tables["indenter"] = _body(scene.indenter)
    for name in ("pair", "load"):
        tables[name] = {key: given[key] for key in TABLES[name] if key in given}
    return {name: table for name, table in tables.items() if table}


# -- profiles and bodies -------------------------------------------------------------------------


def _profile(profile: Profile) -> Tables:
    if isinstance(profile, Periodic):
        return {**_profile(profile.profile), "period": profile.repeats}
    first, *others = map(_term, parts_of(profile))
    return {**first, "plus": others} if others else first


def _term(part: Placed) -> Tables:
    """One term of a profile: what it is, then its modifiers."""
    profile = part.profile
    names = zip(("raised", "shifted", "tilted"), (part.rise, part.shift, part.tilt), strict=True)
    modifiers: Tables = {name: value for name, value in names if value}
    if part.sign < 0.0:
        modifiers["mirrored"] = True
    if not isinstance(profile, Row):
        return {**_unmoved(profile), **modifiers}
    for one in profile.profiles:
        if len(parts_of(one)) > 1:
            raise ValueError(
                f"{one!r} cannot be named in a scene file as an indenter of a row: give a profile "
                "that is not a sum"
            )
    indenters = [_term(*parts_of(one)) for one in profile.profiles]
    return {"kind": "row", **modifiers, "of": indenters}


def _unmoved(profile: Profile) -> Tables:
    kind = next((name for name, make in KINDS.items() if type(profile) is make), None)
    if kind is None or not isinstance(getattr(profile, "function", Expression("x")), Expression):
        raise ValueError(
            f"{profile!r} cannot be named in a scene file: give a profile of the kinds that "
            "`sie example` lists, a function as a formula in text"
        )
    table: Tables = {"kind": kind}
    for parameter in inspect.signature(type(profile)).parameters.values():
        held_by = HELD_BY.get(type(profile), {}).get(parameter.name, parameter.name)
        value = _plain(getattr(profile, held_by, parameter.default))
        if value != _plain(parameter.default):
            table[parameter.name] = value
    return table


def _plain(value: Any) -> Any:
    """Lists in place of tuples and arrays, and the text of a formula."""
    if isinstance(value, Expression):
        return value.text
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(v) for v in value] if isinstance(value, (tuple, list)) else value


def _body(body: Body) -> Tables | str:
    if not isinstance(body, Elastic):
        return "rigid"
    plane = {} if body.plane == "strain" else {"plane": body.plane}
    return {"young": body.young, "poisson": body.poisson, **plane}
