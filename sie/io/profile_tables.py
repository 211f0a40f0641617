"""The profile of a scene file, from [profile], [[profile.plus]] and [[profile.of]]."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

from sie.arguments import choices, nearest, suggestion
from sie.profiles.base import Profile
from sie.profiles.kinds import KINDS
from sie.profiles.row import Periodic, Row
from sie.profiles.sampled import Sampled

from .scene_tables import (
    MODIFIERS,
    TREATMENTS,
    Entries,
    Naming,
    entries_of,
    entries_of_file,
    read_values,
    require,
)
from .toml_values import number, refuse_unread, table_of, text


class TraceFiles(NamedTuple):
    """Where the files of traces are, and to what they are converted.

    folder    where the scene file is
    length    the scene's unit of length
    ask       whether a file without units is refused, as the scene uses units
    """

    folder: pathlib.Path
    length: str
    ask: bool


def profile_of(value: Any, files: TraceFiles) -> Profile:
    """The profile that a [profile] table describes. ValueError for a bad table."""
    first = dict(table_of("profile", value))
    plus = first.pop("plus", [])
    period = first.pop("period", None)
    if not isinstance(plus, list) or not all(isinstance(term, dict) for term in plus):
        raise ValueError(
            "profile.plus is not a list of tables: "
            "write the header [[profile.plus]], in double brackets, before each term"
        )
    total = _term("[profile]", first, files)
    for k, term in enumerate(plus, start=1):
        total = total + _term(
            "[[profile.plus]]" if len(plus) == 1 else f"[[profile.plus]] number {k}", term, files
        )
    if period is None:
        return total
    with Naming("[profile]"):
        return Periodic(total, number("period", period))


def _term(where: str, table: dict[str, Any], files: TraceFiles) -> Profile:
    """One term of the profile: its kind, then mirrored, tilted, shifted, raised."""
    if table.get("kind") == "row":
        return _row(where, dict(table), files)
    kind = _kind(where, table)
    make, entries = _maker(kind, table, files)
    treatments = TREATMENTS if KINDS[kind] is Sampled else {}
    readers = {"kind": text, **entries.readers, **treatments, **MODIFIERS}
    values = read_values(where, table, readers, kind=f' of kind "{kind}"')
    require(f'{where} of kind "{kind}"', values, entries.required)
    given = {name: v for name, v in values.items() if name in entries.readers}
    with Naming(where):
        return _moved(_treated(make(**given), values), values)


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


def _row(where: str, table: dict[str, Any], files: TraceFiles) -> Profile:
    """Indenters on one holder, each a table under [[profile.of]]."""
    indenters = table.pop("of", [])
    tables = isinstance(indenters, list) and all(isinstance(one, dict) for one in indenters)
    if not tables or not indenters:
        raise ValueError(
            f'{where} of kind "row" lacks its indenters: '
            "write the header [[profile.of]], in double brackets, before each"
        )
    values = read_values(where, table, {"kind": text, **MODIFIERS}, kind=' of kind "row"')
    profiles = [
        _term(f"[[profile.of]] number {k}", dict(one), files)
        for k, one in enumerate(indenters, start=1)
    ]
    with Naming(where):
        return _moved(Row(profiles), values)


def _kind(where: str, table: dict[str, Any]) -> str:
    if "kind" not in table:
        meant = next((key for key in table if nearest(key, ["kind"])), "")
        raise ValueError(
            f'{where} has no key "{meant}": did you mean "kind"?'
            if meant
            else f"{where} lacks kind: give kind = {choices([*KINDS, 'row'])}"
        )
    kind = text(f"{where} kind", table["kind"])
    if kind not in KINDS:
        known = [*KINDS, "row"]
        raise ValueError(f'{where} kind = "{kind}" is not known: {suggestion(kind, known)}')
    return kind


def _maker(
    kind: str, table: dict[str, Any], files: TraceFiles
) -> tuple[Callable[..., Profile], Entries]:
    """The function that makes a profile of the kind, and its parameters; a trace may be a file."""
    make = KINDS[kind]
    entries, of_file = entries_of(make), entries_of_file()
    if make is Sampled and table.keys() & (of_file.readers.keys() - entries.readers.keys()):
        return partial(_trace, files), of_file
    return make, entries


def _trace(files: TraceFiles, path: str, **options: Any) -> Sampled:
    """A trace in a file, which is named from the scene file's folder."""
    try:
        trace = Sampled.read(files.folder / path, length=files.length, **options)
    except OSError as problem:
        refuse_unread(path, problem, "the trace's file")
    if files.ask and not any(trace.reading.units) and "scale" not in options:
        raise ValueError(
            f'path = "{path}" states no units of its columns, in a scene that uses units: give '
            f'units = "{files.length}" or another, or scale'
        )
    return trace
