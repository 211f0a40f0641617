"""The keys of each table of a scene file: what each may hold, and its dimension.

Reading, writing, the schema, and the conversion of units follow this table. The keys of [profile]
are the parameters of the kind of profile: its signature gives their names, their types and which of
them are optional. What a key means is said by the docstring of the class that takes its value.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

from numpy.typing import ArrayLike

from sie.arguments import choices, nearest, suggestion
from sie.problem.material import Plane
from sie.problem.scene import COUPLINGS
from sie.profiles.base import Parity, Profile
from sie.profiles.functions import Vectorised
from sie.profiles.kinds import KINDS
from sie.profiles.sampled import Sampled
from sie.profiles.trace_files import Column
from sie.profiles.trace_units import SIDES, Side
from sie.profiles.trace_values import Smoothing

from .quantities import ANGLE, FORCE, LENGTH, MOMENT, STRESS, Converter
from .toml_values import (
    CELL,
    CONSTANT,
    FLAG,
    NUMBER,
    NUMBERS,
    PAIR,
    POSITIVE,
    TEXT,
    TEXTS,
    WHOLE,
    Kind,
    by_type,
    choice,
    in_range,
    list_of,
    table_of,
)


class Key(NamedTuple):
    """What a key may hold, and its dimension, "" for none."""

    kind: Kind
    dimension: str = ""


Keys = Mapping[str, Key]
POISSON = Key(in_range(exclusiveMinimum=-1.0, maximum=0.5))
BODY: Keys = {
    "young": Key(POSITIVE, STRESS),
    "poisson": POISSON,
    "plane": Key(choice(get_args(Plane))),
    "rigid": Key(FLAG),
}
# The loads, in place of which a path may stand.
LOADS: Keys = {
    "normal_load": Key(POSITIVE, FORCE),
    "half_width": Key(POSITIVE, LENGTH),
    "tangential_load": Key(NUMBER, FORCE),
    "sliding": Key(Kind(NUMBER.read, {"enum": [-1, 0, 1]})),
    "bulk_stress": Key(NUMBER, STRESS),
}
TABLES: Mapping[str, Keys] = {
    "units": dict.fromkeys(("length", "force", "stress"), Key(TEXT)) | {"checked": Key(FLAG)},
    "body": BODY,
    "indenter": BODY,
    "pair": {
        "modulus": Key(POSITIVE, STRESS),
        "dundurs": Key(NUMBER),
        "poisson": POISSON,
        "coupling": Key(choice(COUPLINGS)),
    },
    "fatigue": {
        "findley_k": Key(CONSTANT),
        "shear_limit": Key(CONSTANT, STRESS),
        "fatemi_socie_k": Key(CONSTANT),
        "yield_stress": Key(CONSTANT, STRESS),
        "depth": Key(by_type(list, list_of(CONSTANT), CONSTANT), LENGTH),
        "parts": Key(WHOLE),
    },
    "crack": {
        "at": Key(by_type(str, TEXT, NUMBER)),
        "depths": Key(list_of(CONSTANT), LENGTH),
        "threshold": Key(CONSTANT),
        "fatigue_limit": Key(CONSTANT, STRESS),
        "friction": Key(in_range(minimum=0.0)),
    },
    "load": {
        **LOADS,
        "tilt": Key(NUMBER, ANGLE),
        "moment": Key(NUMBER, MOMENT),
        "friction": Key(in_range(minimum=0.0)),
        "path": Key(by_type(str, TEXT, list_of(list_of(CELL)))),
        "columns": Key(TEXTS),
    },
}
TOP: tuple[str, ...] = ("title", "want", "profile", *TABLES)

# -- profiles --------------------------------------------------------------------------------------

MODIFIERS: Keys = {
    "mirrored": Key(FLAG),
    "tilted": Key(NUMBER, ANGLE),
    "shifted": Key(NUMBER, LENGTH),
    "raised": Key(NUMBER, LENGTH),
}
# Modifiers of a trace, applied in this order before the others.
TREATMENTS: Keys = {
    "without_outliers": Key(FLAG),
    "levelled": Key(by_type(list, PAIR, FLAG), LENGTH),
}
PERIOD: Keys = {"period": Key(POSITIVE, LENGTH)}
# Parameters of profiles with a dimension or a limit; those of the same name are alike.
PARAMETERS: Keys = {
    **dict.fromkeys(("radius", "half_flat", "half_width"), Key(POSITIVE, LENGTH)),
    **dict.fromkeys(("x", "h", "breaks", "domain"), Key(NUMBERS, LENGTH)),
    "coefficient": Key(POSITIVE),
    "exponent": Key(in_range(minimum=1.0)),
}
COLUMN = by_type(str, TEXT, WHOLE)
# The kind of any other parameter, by its type.
ANNOTATED: Mapping[Any, Kind] = {
    bool: FLAG,
    int: WHOLE,
    float: NUMBER,
    str: TEXT,
    str | Path: TEXT,
    Vectorised | str: TEXT,
    float | tuple[float, float] | None: by_type(list, PAIR, NUMBER),
    str | tuple[str, str]: by_type(list, TEXTS, TEXT),
    Side | Literal[""]: choice(SIDES),
    Parity: choice(get_args(Parity)),
    tuple[float, float]: NUMBERS,
    tuple[float, ...]: NUMBERS,
    Sequence[float]: NUMBERS,
    ArrayLike: NUMBERS,
    Sequence[Sequence[float]]: list_of(NUMBERS),
    Smoothing: by_type(str, choice(["gcv"]), NUMBER),
    tuple[Column, Column]: list_of(COLUMN, "give the columns of x and of h"),
}


class Form(NamedTuple):
    """A form of a kind of profile: by its points a trace, say, or by its file.

    make        the class or the function whose parameters are its keys
    required    the names of those that must be given
    treatments  keys that name methods, which are applied to what was made
    """

    make: Callable[..., Profile]
    keys: Keys
    required: tuple[str, ...]
    treatments: Keys


def forms_of(kind: str) -> tuple[Form, ...]:
    """The forms of a kind of profile."""
    make = KINDS[kind]
    return tuple(map(_form, (Sampled, Sampled.read) if make is Sampled else (make,)))


@lru_cache(maxsize=64)
def _form(make: Callable[..., Profile]) -> Form:
    of_file = make == Sampled.read
    given = inspect.signature(make, eval_str=True).parameters.values()
    parameters = [p for p in given if not of_file or p.name != "length"]  # [units] has that
    return Form(
        make,
        {p.name: PARAMETERS.get(p.name) or Key(ANNOTATED[p.annotation]) for p in parameters},
        tuple(p.name for p in parameters if p.default is p.empty),
        TREATMENTS if of_file or make is Sampled else {},
    )


# -- reading ---------------------------------------------------------------------------------------


def values_of(name: str, value: Any, convert: Converter) -> dict[str, Any]:
    """The values of the table [name], none unknown, each of its kind."""
    return read_values(f"[{name}]", table_of(name, value), TABLES[name], convert)


def read_values(
    where: str, table: Mapping[str, Any], keys: Keys, convert: Converter, kind: str = ""
) -> dict[str, Any]:
    """The values of a table by its keys. ValueError with a remedy for a key that is not known."""
    for name in table:
        if name not in keys:
            raise ValueError(f'{where}{kind} has no key "{name}": {remedy(name, keys, where)}')
    values: dict[str, Any] = {}
    for name, value in table.items():
        key, place = keys[name], f"{where} {name}"
        number = convert.number(place, value, key.dimension) if key.dimension else value
        values[name] = key.kind.read(place, number)
    return values


def require(where: str, values: Mapping[str, Any], names: Iterable[str]) -> None:
    """ValueError unless all names have a value."""
    missing = [name for name in names if name not in values]
    if missing:
        given = " and ".join(f"{name} = ..." for name in missing)
        raise ValueError(f"{where} lacks {' and '.join(missing)}: give {given}")


@contextmanager
def naming(where: str) -> Iterator[None]:
    """Put the name of the table in front of the message that refuses one of its values."""
    try:
        yield
    except ValueError as problem:
        raise ValueError(f"{where} {problem}") from None


# -- keys that are not known -----------------------------------------------------------------------

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
    elsewhere = _elsewhere(key) if here else ""
    if elsewhere or nearest(key, known):
        return elsewhere or suggestion(key, known)
    kinds = [
        kind
        for kind in KINDS
        if any(key in form.keys or key in form.treatments for form in forms_of(kind))
    ]
    if of_profile and kinds:
        return f"it belongs to kind {choices(kinds)}"
    homes = [f"[{table}]" for table, keys in TABLES.items() if key in keys]
    homes += ["[profile]"] if key == "kind" or kinds or key in MODIFIERS else []
    return f"it belongs in {' or '.join(homes)}" if homes else suggestion(key, known)


def _elsewhere(key: str) -> str:
    """The place of a key that no table may hold, "" for other keys."""
    if key in ("title", "want"):
        return "it stands at the top of the file, before the first [table]"
    if key in TOP:
        return f"it is a table of its own, write the header [{key}] and its keys below it"
    return ELSEWHERE.get(key, "")
