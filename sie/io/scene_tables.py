"""The keys of each table of a scene file, and the remedy for a key that it may not hold.

The keys of [profile] are the parameters of the kind of profile: its signature gives their names,
their types and which of them are optional.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal, NamedTuple

from numpy.typing import ArrayLike

from sie.arguments import choices, nearest, suggestion
from sie.profiles.base import Parity
from sie.profiles.kinds import KINDS
from sie.profiles.sampled import Sampled
from sie.profiles.slope import Vectorised
from sie.profiles.trace_files import Column
from sie.profiles.trace_units import Side
from sie.profiles.trace_values import Smoothing

from .toml_values import (
    Reader,
    columns,
    flag,
    flag_or_pair,
    number,
    number_or_pair,
    number_or_text,
    numbers,
    rows,
    rows_or_text,
    table_of,
    text,
    text_or_pair,
    texts,
    whole,
)

# The reader of a parameter of each type.
READERS: dict[Any, Reader] = {
    bool: flag,
    int: whole,
    float: number,
    str: text,
    float | tuple[float, float] | None: number_or_pair,
    str | tuple[str, str]: text_or_pair,
    Side | Literal[""]: text,
    tuple[float, float]: numbers,
    tuple[float, ...]: numbers,
    Sequence[float]: numbers,
    ArrayLike: numbers,
    Sequence[Sequence[float]]: rows,
    str | Path: text,
    Parity: text,
    Vectorised | str: text,
    Smoothing: number_or_text,
    tuple[Column, Column]: columns,
}


class Entries(NamedTuple):
    """The keys of a table with their readers, and the names of those that must be given."""

    readers: Mapping[str, Reader]
    required: tuple[str, ...] = ()


@lru_cache(maxsize=64)
def entries_of(make: Callable[..., Any]) -> Entries:
    """The parameters of a class or function as the entries of a table."""
    parameters = inspect.signature(make, eval_str=True).parameters.values()
    return Entries(
        {p.name: READERS[p.annotation] for p in parameters},
        tuple(p.name for p in parameters if p.default is p.empty),
    )


def entries_of_file() -> Entries:
    """The keys of a trace in a file, which stand in place of x and h; [units] has its length."""
    readers, required = entries_of(Sampled.read)
    return Entries({key: read for key, read in readers.items() if key != "length"}, required)


BODY: dict[str, Reader] = {"young": number, "poisson": number, "plane": text, "rigid": flag}
LOADS = ("normal_load", "half_width", "tangential_load", "sliding", "bulk_stress")
TABLES: dict[str, Mapping[str, Reader]] = {
    "units": {"length": text, "force": text, "stress": text, "checked": flag},
    "body": BODY,
    "indenter": BODY,
    "pair": {"modulus": number, "dundurs": number, "poisson": number, "coupling": text},
    "fatigue": dict.fromkeys(("findley_k", "shear_limit", "fatemi_socie_k", "yield_stress"), number)
    | {"depth": number_or_pair, "parts": whole},
    "load": dict.fromkeys((*LOADS, "tilt", "moment", "friction"), number)
    | {"path": rows_or_text, "columns": texts},
}
TOP: tuple[str, ...] = ("title", "want", "profile", *TABLES)
MODIFIERS: dict[str, Reader] = {
    "mirrored": flag,
    "tilted": number,
    "shifted": number,
    "raised": number,
}
# Keys of [profile] itself that none of its kinds has.
ELSEWHERE = {
    "plus": "terms are not nested, write one [[profile.plus]] after the other",
    "of": 'it belongs to kind "row"',
    "period": "it belongs in [profile], and repeats the whole of it",
}
# Keys that users write for others.
SYNONYMS = {
    **dict.fromkeys(("file", "filename", "csv"), "path"),
    **dict.fromkeys(("mu", "cof"), "friction"),
    **dict.fromkeys(("force", "load"), "normal_load"),
    **dict.fromkeys(("e", "youngs_modulus"), "young"),
    **dict.fromkeys(("nu", "poisson_ratio"), "poisson"),
    "profile": "kind",
}
# Modifiers of a trace, applied in this order before the others.
TREATMENTS: dict[str, Reader] = {"without_outliers": flag, "levelled": flag_or_pair}


def values_of(name: str, value: Any) -> dict[str, Any]:
    """The values of the table [name], none unknown, each of its type."""
    return read_values(f"[{name}]", table_of(name, value), TABLES[name])


def read_values(
    where: str, table: Mapping[str, Any], readers: Mapping[str, Reader], kind: str = ""
) -> dict[str, Any]:
    """The values of a table by its readers. ValueError with a remedy for a key that has none."""
    for key in table:
        if key not in readers:
            raise ValueError(f'{where}{kind} has no key "{key}": {remedy(key, readers, where)}')
    return {key: readers[key](f"{where} {key}", value) for key, value in table.items()}


def require(where: str, values: Mapping[str, Any], names: Iterable[str]) -> None:
    """ValueError unless all names have a value."""
    missing = [name for name in names if name not in values]
    if missing:
        given = " and ".join(f"{name} = ..." for name in missing)
        raise ValueError(f"{where} lacks {' and '.join(missing)}: give {given}")


def remedy(key: str, known: Iterable[str], here: str) -> str:
    """The remedy for a key that its table may not hold.

    The key is near a known one, belongs in another table, whose header may have been forgotten, or
    belongs to another kind of profile.
    """
    known, of_profile = tuple(known), here.startswith(("[profile]", "[[profile"))
    meant = SYNONYMS.get(key.lower(), "")
    if here == f"[{key}]" and not meant:
        return suggestion(key, known)
    of_trace = meant == "path" and "smoothing" in known
    if meant in known or of_trace or (of_profile and meant == "kind"):
        return f'did you mean "{meant}"?'
    key = meant if meant and key not in TOP else key
    if here and (elsewhere := _elsewhere(key)):
        return elsewhere
    if not nearest(key, known):
        kinds = [kind for kind in KINDS if key in _readers_of(kind)]
        if of_profile and kinds:
            return f"it belongs to kind {choices(kinds)}"
        homes = [f"[{table}]" for table, readers in TABLES.items() if key in readers]
        homes += ["[profile]"] if key == "kind" or kinds or key in MODIFIERS else []
        if homes:
            return f"it belongs in {' or '.join(homes)}"
    return suggestion(key, known)


def _elsewhere(key: str) -> str:
    """The place of a key that no table may hold, "" for other keys."""
    if key in ("title", "want"):
        return "it stands at the top of the file, before the first [table]"
    if key in TOP:
        return f"it is a table of its own, write the header [{key}] and its keys below it"
    return ELSEWHERE.get(key, "")


def _readers_of(kind: str) -> Mapping[str, Reader]:
    """All keys of a kind of profile: of a trace also those of a file."""
    readers = entries_of(KINDS[kind]).readers
    of_traces = {**entries_of_file().readers, **TREATMENTS}
    return {**readers, **of_traces} if KINDS[kind] is Sampled else readers


class Naming:
    """Puts the name of the table in front of the message that refuses one of its values."""

    def __init__(self, where: str) -> None:
        self.where = where

    def __enter__(self) -> None: ...

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: object
    ) -> None:
        if isinstance(problem, ValueError):
            raise ValueError(f"{self.where} {problem}") from None
