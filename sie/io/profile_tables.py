"""The profile of a scene file, from [profile], [[profile.plus]] and [[profile.of]]."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from sie.arguments import choices, nearest
from sie.profiles.base import Profile
from sie.profiles.kinds import KINDS
from sie.profiles.row import Periodic, Row
from sie.profiles.sampled import Sampled

from .scene_keys import MODIFIERS, PERIOD, forms_of, naming, read_values, require
from .scene_values import TEXT, choice, refuse_unread, table_of, value_of

KIND = {"kind": TEXT}


@dataclass
class Files:
    """The files that a scene file names.

    folder    where the scene file is
    length    the unit of its lengths, to which a trace with units is converted
    read      those that were asked for
    """

    folder: pathlib.Path
    length: str
    read: list[pathlib.Path] = field(default_factory=list)

    def place(self, name: str) -> pathlib.Path:
        """The place of a file that is read."""
        self.read.append(self.folder / name)
        return self.read[-1]


def profile_of(value: Any, beside: Files) -> Profile:
    """The profile that a [profile] table describes. ValueError for a bad table."""
    first = dict(table_of("profile", value))
    plus = _tables("plus", first.pop("plus", []))
    whole = {name: first.pop(name) for name in PERIOD if name in first}
    total = _term("[profile]", first, beside)
    for k, term in enumerate(plus, start=1):
        number = f" number {k}" if len(plus) > 1 else ""
        total = total + _term(f"[[profile.plus]]{number}", term, beside)
    if not whole:
        return total
    values = read_values("[profile]", whole, PERIOD)
    with naming("[profile]"):
        return Periodic(total, **values)


def _tables(name: str, value: Any) -> list[dict[str, Any]]:
    if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
        raise ValueError(
            f"profile.{name} is not a list of tables: write the header [[profile.{name}]], in "
            "double brackets, before each"
        )
    return value


def _term(where: str, table: dict[str, Any], beside: Files) -> Profile:
    """One term of the profile: its kind, then mirrored, tilted, shifted, raised."""
    if "kind" not in table:
        meant = next((key for key in table if nearest(key, KIND)), "")
        raise ValueError(
            f'{where} has no key "{meant}": did you mean "kind"?'
            if meant
            else f"{where} lacks kind: give kind = {choices([*KINDS, 'row'])}"
        )
    kind = value_of(f"{where} kind", table["kind"], choice([*KINDS, "row"]))
    if kind == "row":
        return _row(where, table, beside)
    first, *others = forms_of(kind)
    form = next((f for f in others if table.keys() & (f.keys.keys() - first.keys.keys())), first)
    keys = {**KIND, **form.keys, **form.treatments, **MODIFIERS}
    values = read_values(where, table, keys, kind=f' of kind "{kind}"')
    require(f'{where} of kind "{kind}"', values, form.required)
    make = form.make if form is first else partial(_trace, beside)
    with naming(where):
        made = make(**{name: v for name, v in values.items() if name in form.keys})
        return _moved(_treated(made, values), values)


def _treated(profile: Profile, values: Mapping[str, Any]) -> Profile:
    """A trace without its outliers, and level, where the table asks for that."""
    if not isinstance(profile, Sampled):
        return profile
    trace = profile.without_outliers() if values.get("without_outliers") else profile
    level = values.get("levelled", False)
    return (trace.levelled() if level is True else trace.levelled(level)) if level else trace


def _moved(profile: Profile, values: Mapping[str, Any]) -> Profile:
    profile = profile.mirrored() if values.get("mirrored") else profile
    moved = profile.tilted(values.get("tilted", 0.0)).shifted(values.get("shifted", 0.0))
    return moved.raised(values.get("raised", 0.0))


def _row(where: str, table: dict[str, Any], beside: Files) -> Profile:
    """Indenters on one holder, each a table under [[profile.of]]."""
    indenters = _tables("of", table.get("of", []))
    require(f'{where} of kind "row"', {"of": 1} if indenters else {}, ["of"])
    own = {key: value for key, value in table.items() if key != "of"}
    values = read_values(where, own, {**KIND, **MODIFIERS}, kind=' of kind "row"')
    profiles = [
        _term(f"[[profile.of]] number {k}", one, beside) for k, one in enumerate(indenters, 1)
    ]
    with naming(where):
        return _moved(Row(profiles), values)


def _trace(beside: Files, path: str, **options: Any) -> Sampled:
    """A trace in a file, which is named from the scene file's folder."""
    try:
        return Sampled.read(beside.place(path), length=beside.length, **options)
    except OSError as problem:
        refuse_unread(path, problem, "the trace's file")
