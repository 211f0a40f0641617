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

from .scene_values import (
    FLAG,
    NUMBER,
    NUMBERS,
    POSITIVE,
    TEXT,
    TEXTS,
    TWO,
    WHOLE,
    Shape,
    choice,
    either,
    in_range,
    list_of,
    table_of,
    value_of,
)

Keys = Mapping[str, Shape]
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
    "sliding": NUMBER | {"enum": [-1, 0, 1]},
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
        "findley_k": POSITIVE,
        "shear_limit": POSITIVE,
        "fatemi_socie_k": POSITIVE,
        "yield_stress": POSITIVE,
        "depth": either(list_of(POSITIVE), POSITIVE),
        "parts": WHOLE,
    },
    "crack": {
        "at": either(choice(EDGES), NUMBER),
        "depths": list_of(POSITIVE),
        "threshold": POSITIVE,
        "fatigue_limit": POSITIVE,
        "friction": in_range(minimum=0.0),
    },
    "load": {
        **LOADS,
        "tilt": NUMBER,
        "moment": NUMBER,
        "friction": in_range(minimum=0.0),
        "path": either(TEXT, list_of(NUMBERS)),
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
TREATMENTS: Keys = {"without_outliers": FLAG, "levelled": either(list_of(NUMBER, **TWO), FLAG)}
PERIOD: Keys = {"period": POSITIVE}
# Parameters of profiles with a limit; those of the same name are alike.
PARAMETERS: Keys = {
    **dict.fromkeys(("radius", "half_flat", "half_width", "coefficient"), POSITIVE),
    "exponent": in_range(minimum=1.0),
}
# The shape of any other parameter, by its type.
ANNOTATED: Mapping[Any, Shape] = {
    bool: FLAG,
    int: WHOLE,
    float: NUMBER,
    str: TEXT,
    str | Path: TEXT,
    Vectorised | str: TEXT,
    float | tuple[float, float] | None: either(list_of(NUMBER, **TWO), NUMBER),
    str | tuple[str, str]: either(TEXTS, TEXT),
    Side | Literal[""]: choice(SIDES),
    Parity: choice(get_args(Parity)),
    tuple[float, float]: NUMBERS,
    tuple[float, ...]: NUMBERS,
    Sequence[float]: NUMBERS,
    ArrayLike: NUMBERS,
    Sequence[Sequence[float]]: list_of(NUMBERS),
    Smoothing: either(choice(["gcv"]), NUMBER),
    tuple[Column, Column]: list_of(either(TEXT, WHOLE), **TWO),
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
    return {name: value_of(f"{where} {name}", value, keys[name]) for name, value in table.items()}


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
TOP_OF_FILE = "it stands at the top of the file, before the first [table]"
ELSEWHERE = {
    **dict.fromkeys(("title", "want"), TOP_OF_FILE),
    "of": 'it belongs to kind "row"',
    "period": "it belongs in [profile], and repeats the whole of it",
    "file": "a file is named by path",
    "checked": "units are labels, and nothing is converted: leave it out",
}


def remedy(key: str, known: Iterable[str], here: str) -> str:
    """The remedy for a key that its table may not hold.

    The key is near a known one, or belongs to another table or to another kind of profile.
    """
    known, elsewhere = tuple(known), here not in ("", f"[{key}]")
    if elsewhere and key in ELSEWHERE:
        return ELSEWHERE[key]
    if elsewhere and key in TOP:
        return f"it is a table of its own, write the header [{key}] and its keys below it"
    homes = [f"[{table}]" for table, keys in TABLES.items() if key in keys]
    kinds = [
        kind for kind in KINDS if any(key in {**f.keys, **f.treatments} for f in forms_of(kind))
    ]
    if here == f"[{key}]" or nearest(key, known) or not (homes or kinds or key == "kind"):
        return suggestion(key, known)
    if kinds and here.startswith(("[profile]", "[[profile")):
        return f"it belongs to kind {choices(kinds)}"
    homes += ["[profile]"] if kinds or key == "kind" else []
    return f"it belongs in {' or '.join(homes)}"
