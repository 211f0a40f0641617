"""A scene as the tables of a scene file, values for JSON, and the scene of such tables.

The tables are what `scene_file` reads: reading them gives an equal scene, to the last digit. The
heights of a trace stand in the tables, not the name of its file.

>>> from sie import Parabola, Scene
>>> tables_of(Scene(profile=Parabola(100.0), modulus=80e3, normal_load=50.0))["profile"]
{'kind': 'parabola', 'radius': 100.0}
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from sie.problem.material import Body, Elastic
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.derived import Placed, parts_of
from sie.profiles.expression import Expression
from sie.profiles.from_function import FromFunction
from sie.profiles.kinds import KINDS
from sie.profiles.polynomials import Piecewise
from sie.profiles.row import Periodic, Row
from sie.profiles.sampled import Sampled
from sie.profiles.shapes import Wedge

from .scene_file import from_tables
from .scene_keys import TABLES

Tables = dict[str, Any]

INFINITIES = ("Infinity", "-Infinity")

# The attributes of a profile that hold parameters of another name.
HELD_BY: Mapping[type, Mapping[str, str]] = {
    Piecewise: {"breaks": "ends", "pieces": "coefficients"},
    FromFunction: {"slope": "function", "breaks": "declared", "domain": "ends"},
    Sampled: {"x": "points", "h": "heights"},
    Wedge: {"slope": "rise"},
}


def scene_of(tables: Mapping[str, Any]) -> Scene:
    """The scene of tables. ValueError for none, or for a path of loads."""
    if not isinstance(tables, Mapping):
        raise ValueError(f"{tables!r} are no tables: give a dict, like that of Scene.to_dict()")
    try:
        file = from_tables(_with_infinities(tables))
    except RecursionError:
        raise ValueError("the tables are nested too deeply for those of a scene") from None
    if file.load_path:
        raise ValueError(
            "[load] has a path, which is more than one scene: give normal_load, tangential_load "
            "and bulk_stress, or read the file by sie.io.scene_file"
        )
    return file.scene


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


def tables_of(scene: Scene) -> Tables:
    """The tables of a scene. ValueError if a scene file cannot name its profile."""
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
