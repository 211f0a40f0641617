"""The profile of a scene file, from [profile], [[profile.plus]] and [[profile.of]]."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from sie.arguments import choices, nearest, suggestion
from sie.profiles.base import Profile
from sie.profiles.kinds import KINDS
from sie.profiles.row import Periodic, Row
from sie.profiles.sampled import Sampled

from .quantities import Converter
from .scene_keys import (
    MODIFIERS,
    PERIOD,
    Key,
    forms_of,
    naming,
    read_values,
    require,
)
from .toml_values import TEXT, refuse_unread, table_of

KIND = {"kind": Key(TEXT)}


@dataclass
class Surroundings:
    """What surrounds the tables of a scene file.

    folder        where the file is
    convert       to its units
    reads         the files that it names
    unmeasured    those traces among them that state no units
    """

    folder: pathlib.Path
    convert: Converter
    reads: list[pathlib.Path] = field(default_factory=list)
    unmeasured: list[str] = field(default_factory=list)

    def place(self, name: str) -> pathlib.Path:
        """The place of a file that is read."""
        self.reads.append(self.folder / name)
        return self.reads[-1]

    def refuse_traces_without_units(self) -> None:
        """ValueError if a trace states no units, and anything else in the file has them."""
        if self.unmeasured and self.convert.registry is not None:
            raise ValueError(
                f'[profile] path = "{self.unmeasured[0]}" states no units of its columns, in a '
                f'scene that uses units: give units = "{self.convert.labels["length"]}" or '
                "another, or scale"
            )


def profile_of(value: Any, around: Surroundings) -> Profile:
    """The profile that a [profile] table describes. ValueError for a bad table."""
    first = dict(table_of("profile", value))
    plus = first.pop("plus", [])
    whole = {name: first.pop(name) for name in PERIOD if name in first}
    if not _are_tables(plus):
        raise ValueError(
            "profile.plus is not a list of tables: "
            "write the header [[profile.plus]], in double brackets, before each term"
        )
    total = _term("[profile]", first, around)
    for k, term in enumerate(plus, start=1):
        number = f" number {k}" if len(plus) > 1 else ""
        total = total + _term(f"[[profile.plus]]{number}", term, around)
    if not whole:
        return total
    values = read_values("[profile]", whole, PERIOD, around.convert)
    with naming("[profile]"):
        return Periodic(total, **values)


def _are_tables(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(one, dict) for one in value)


def _term(where: str, table: dict[str, Any], around: Surroundings) -> Profile:
    """One term of the profile: its kind, then mirrored, tilted, shifted, raised."""
    if table.get("kind") == "row":
        return _row(where, dict(table), around)
    kind = _kind(where, table)
    first, *others = forms_of(kind)
    form = next((f for f in others if table.keys() & (f.keys.keys() - first.keys.keys())), first)
    keys = {**KIND, **form.keys, **form.treatments, **MODIFIERS}
    values = read_values(where, table, keys, around.convert, kind=f' of kind "{kind}"')
    require(f'{where} of kind "{kind}"', values, form.required)
    make = form.make if form is first else partial(_trace, around)
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


def _row(where: str, table: dict[str, Any], around: Surroundings) -> Profile:
    """Indenters on one holder, each a table under [[profile.of]]."""
    indenters = table.pop("of", [])
    if not indenters or not _are_tables(indenters):
        raise ValueError(
            f'{where} of kind "row" lacks its indenters: '
            "write the header [[profile.of]], in double brackets, before each"
        )
    keys = {**KIND, **MODIFIERS}
    values = read_values(where, table, keys, around.convert, kind=' of kind "row"')
    profiles = [
        _term(f"[[profile.of]] number {k}", dict(one), around)
        for k, one in enumerate(indenters, start=1)
    ]
    with naming(where):
        return _moved(Row(profiles), values)


def _kind(where: str, table: dict[str, Any]) -> str:
    if "kind" not in table:
        meant = next((key for key in table if nearest(key, ["kind"])), "")
        raise ValueError(
            f'{where} has no key "{meant}": did you mean "kind"?'
            if meant
            else f"{where} lacks kind: give kind = {choices([*KINDS, 'row'])}"
        )
    kind: str = TEXT.read(f"{where} kind", table["kind"])
    if kind not in KINDS:
        known = [*KINDS, "row"]
        raise ValueError(f'{where} kind = "{kind}" is not known: {suggestion(kind, known)}')
    return kind


def _trace(around: Surroundings, path: str, **options: Any) -> Sampled:
    """A trace in a file, which is named from the scene file's folder."""
    try:
        length = around.convert.labels["length"]
        trace = Sampled.read(around.place(path), length=length, **options)
    except OSError as problem:
        refuse_unread(path, problem, "the trace's file")
    if not any(trace.reading.units) and "scale" not in options:
        around.unmeasured.append(path)
    return trace
