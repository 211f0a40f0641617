"""The keys of each table of a scene file, and what each may hold.

Reading, writing and the schema follow this one declaration. The keys of [profile] are the
parameters of the kind of profile: its signature gives their names, their types and which of them
are optional. What a key means is said by the docstring of the class that takes its value.
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
from sie.problem.material import COUPLINGS, Plane
from sie.profiles.base import Profile
from sie.profiles.functions import Vectorised
from sie.profiles.indenter import Parity
from sie.profiles.kinds import KINDS
from sie.profiles.sampled import Sampled
from sie.profiles.trace_files import Column
from sie.profiles.trace_units import SIDES, Side
from sie.profiles.trace_values import Smoothing

from .toml_values import (
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

Keys = Mapping[str, Kind]
EDGES = ("trailing edge", "leading edge")
POISSON = in_range(exclusiveMinimum=-1.0, maximum=0.5)
BODY: Keys = {
    "young": POSITIVE,
    "poisson": POISSON,
    "plane": choice(get_args(Plane)),
    "rigid": FLAG,
}
# The loads, in place of which a path may stand.
LOADS: Keys = {
    "normal_load": POSITIVE,
    "half_width": POSITIVE,
    "tangential_load": NUMBER,
    "sliding": Kind(NUMBER.read, {"enum": [-1, 0, 1]}),
    "bulk_stress": NUMBER,
}
TABLES: Mapping[str, Keys] = {
    "units": dict.fromkeys(("length", "force", "stress"), TEXT),
    "body": BODY,
    "indenter": BODY,
    "pair": {
        "modulus": POSITIVE,
        "dundurs": NUMBER,
        "poisson": POISSON,
        "coupling": choice(COUPLINGS),
    },
    "fatigue": {
        "findley_k": CONSTANT,
        "shear_limit": CONSTANT,
        "fatemi_socie_k": CONSTANT,
        "yield_stress": CONSTANT,
        "depth": by_type(list, list_of(CONSTANT), CONSTANT),
        "parts": WHOLE,
    },
    "crack": {
        "at": by_type(str, choice(EDGES), NUMBER),
        "depths": list_of(CONSTANT),
        "threshold": CONSTANT,
        "fatigue_limit": CONSTANT,
        "friction": in_range(minimum=0.0),
    },
    "load": {
        **LOADS,
        "tilt": NUMBER,
        "moment": NUMBER,
        "friction": in_range(minimum=0.0),
        "path": by_type(str, TEXT, list_of(NUMBERS)),
        "columns": TEXTS,
    },
}
TOP: tuple[str, ...] = ("title", "want", "profile", *TABLES)
# Keys that need another one of their table beside them, and those that a table must have.
BESIDE: Mapping[str, Mapping[str, str]] = {
    "fatigue": {
        "shear_limit": "findley_k",
        "fatemi_socie_k": "yield_stress",
        "yield_stress": "fatemi_socie_k",
    },
    "crack": {"threshold": "fatigue_limit", "fatigue_limit": "threshold"},
    "load": {"columns": "path"},
}
REQUIRED: Mapping[str, tuple[str, ...]] = {"crack": ("at", "depths")}

# -- profiles --------------------------------------------------------------------------------------

MODIFIERS: Keys = {"mirrored": FLAG} | dict.fromkeys(("tilted", "shifted", "raised"), NUMBER)
# Modifiers of a trace, applied in this order before the others.
TREATMENTS: Keys = {"without_outliers": FLAG, "levelled": by_type(list, PAIR, FLAG)}
PERIOD: Keys = {"period": POSITIVE}
# Parameters of profiles with a limit; those of the same name are alike.
PARAMETERS: Keys = {
    **dict.fromkeys(("radius", "half_flat", "half_width", "coefficient"), POSITIVE),
    "exponent": in_range(minimum=1.0),
}
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
    tuple[Column, Column]: list_of(by_type(str, TEXT, WHOLE), "give the columns of x and of h"),
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
        {p.name: PARAMETERS.get(p.name) or ANNOTATED[p.annotation] for p in parameters},
        tuple(p.name for p in parameters if p.default is p.empty),
        TREATMENTS if of_file or make is Sampled else {},
    )


# -- reading ---------------------------------------------------------------------------------------


def values_of(name: str, top: Mapping[str, Any]) -> dict[str, Any]:
    """The values of the table [name], none unknown, each of its kind; {} without the table."""
    where = f"[{name}]"
    values = read_values(where, table_of(name, top.get(name, {})), TABLES[name])
    for key, other in BESIDE.get(name, {}).items():
        if key in values and other not in values:
            raise ValueError(f"{where} has {key} without {other}: give {other} = ... too")
    if name in top:
        require(where, values, REQUIRED.get(name, ()))
    return values


def read_values(where: str, table: Mapping[str, Any], keys: Keys, kind: str = "") -> dict[str, Any]:
    """The values of a table by its keys. ValueError with a remedy for a key that is not known."""
    for name in table:
        if name not in keys:
            raise ValueError(f'{where}{kind} has no key "{name}": {remedy(name, keys, where)}')
    return {name: keys[name].read(f"{where} {name}", value) for name, value in table.items()}


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

# What is said of keys that no table, or only one kind of table, has.
ELSEWHERE = {
    **dict.fromkeys(
        ("title", "want"), "it stands at the top of the file, before the first [table]"
    ),
    "plus": "terms are not nested, write one [[profile.plus]] after the other",
    "of": 'it belongs to kind "row"',
    "period": "it belongs in [profile], and repeats the whole of it",
    **dict.fromkeys(("file", "filename", "csv"), "a file is named by path"),
    "checked": "units are labels, and nothing is converted: leave it out",
}


def remedy(key: str, known: Iterable[str], here: str) -> str:
    """The remedy for a key that its table may not hold.

    The key is near a known one, belongs in another table, whose header may have been forgotten, or
    belongs to another kind of profile.
    """
    known, of_profile = tuple(known), here.startswith(("[profile]", "[[profile"))
    if here not in ("", f"[{key}]"):
        if key in ELSEWHERE:
            return ELSEWHERE[key]
        if key in TOP:
            return f"it is a table of its own, write the header [{key}] and its keys below it"
    if here == f"[{key}]" or nearest(key, known):
        return suggestion(key, known)
    return _homes(key, of_profile) or suggestion(key, known)


def _homes(key: str, of_profile: bool) -> str:
    """The tables or the kinds of profile that a key belongs to, "" for none."""
    kinds = [
        kind
        for kind in KINDS
        if any(key in form.keys or key in form.treatments for form in forms_of(kind))
    ]
    if of_profile and kinds:
        return f"it belongs to kind {choices(kinds)}"
    homes = [f"[{table}]" for table, keys in TABLES.items() if key in keys]
    homes += ["[profile]"] if key == "kind" or kinds or key in MODIFIERS else []
    return f"it belongs in {' or '.join(homes)}" if homes else ""
