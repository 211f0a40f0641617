"""The records of a topic: claims with a verdict, tables, curves and maps.

They are values that JSON can hold; nothing here computes or draws.

A topic is a module of `validation.topics` with

    TITLE                         the heading; its docstring is the introduction
    SECONDS                       about how long (quick, whole) takes, for the progress bar
    compute(quick) -> records     an iterator; a `Doing` names the next work and is not kept

and may have a module of the same name in `validation.topics.figures` with

    figures(found) -> figures     drawn from the records alone (see `validation.harness.drawing`)
"""

from __future__ import annotations

import math
import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from numpy.typing import NDArray

Numbers = Sequence[float] | NDArray[Any]


@dataclass(frozen=True)
class Claim:
    """One claim with its source, the number measured in this run, its bar, and a control.

    The control proves that the measure can fail.

    low, high   the bar: it holds if low <= measured <= high
    control     the same measure on a wrong input, which `wrong` names: it must miss the bar,
                by a number: nan proves nothing
    erratum     the correct statement, for a claim that this project refutes: then the
                measure must miss the bar, and the control, the corrected input, must meet it
    """

    what: str
    by: str
    measured: float
    control: float
    wrong: str
    low: float = -math.inf
    high: float = math.inf
    erratum: str = ""

    def within(self, value: float) -> bool:
        return self.low <= value <= self.high  # False for nan

    @property
    def verdict(self) -> str:
        """holds, refuted (a listed erratum), fails, or blind (the control passed).

        A measure that its control passes proves nothing.
        """
        if math.isnan(self.control) or self.within(self.control) != bool(self.erratum):
            return "blind"
        if math.isnan(self.measured) or self.within(self.measured) == bool(self.erratum):
            return "fails"
        return "refuted" if self.erratum else "holds"

    @property
    def ok(self) -> bool:
        return self.verdict in ("holds", "refuted")

    @property
    def bar(self) -> str:
        if self.low == -math.inf:
            return f"≤ {self.high:.4g}"
        if self.high == math.inf:
            return f"≥ {self.low:.4g}"
        return f"{self.low:.6g} … {self.high:.6g}"


def checked(
    measure: Callable[[Any], float],
    right: Any,
    wrong: Any,
    *,
    what: str,
    by: str,
    named: str,
    **bar: Any,
) -> Claim:
    """A claim whose number and control are one function of a right and of a wrong input.

    `named` describes the wrong input.
    """
    return Claim(what, by, float(measure(right)), float(measure(wrong)), named, **bar)


@dataclass(frozen=True)
class Table:
    """Rows of text and numbers under a title."""

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[Any]]
    note: str = ""


@dataclass(frozen=True)
class Curve:
    """Points (x, y) of the figure named `figure`.

    `style` is "line", "points" (of another origin, on top of a line) or "both".
    """

    figure: str
    label: str
    x: Numbers
    y: Numbers
    style: str = "line"
    about: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Map:
    """values[i][j] over x[j], y[i]."""

    figure: str
    x: Numbers
    y: Numbers
    values: Sequence[Numbers] | NDArray[Any]
    about: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Doing:
    """The next work, for the progress bar."""

    what: str


Record = Claim | Table | Curve | Map | Doing


def in_turn(*parts: tuple[str, Iterator[Record]]) -> Iterator[Record]:
    """The records of the parts of a topic, each announced to the progress bar."""
    for name, records in parts:
        yield Doing(name)
        yield from records


BROKEN = "the topic runs to its end; it broke off with"


class Found(list[Record]):
    """The records of a topic."""

    @property
    def broken(self) -> bool:
        return any(c.what.startswith(BROKEN) for c in self.claims)

    @property
    def claims(self) -> list[Claim]:
        return [r for r in self if isinstance(r, Claim)]

    @property
    def tables(self) -> list[Table]:
        return [r for r in self if isinstance(r, Table)]

    def curves(self, figure: str) -> list[Curve]:
        return [r for r in self if isinstance(r, Curve) and r.figure == figure]

    def keys(self, beginning: str = "") -> list[str]:
        """The names of the figures that have curves, in the order of the curves."""
        return list(
            dict.fromkeys(
                r.figure for r in self if isinstance(r, Curve) and r.figure.startswith(beginning)
            )
        )

    def maps(self, figure: str) -> list[Map]:
        return [r for r in self if isinstance(r, Map) and r.figure == figure]

    def as_json(self) -> list[dict[str, Any]]:
        """Every number; claims with their verdicts."""
        rows = []
        for r in self:
            row: dict[str, Any] = {"kind": type(r).__name__.lower()} | plain(asdict(r))
            if isinstance(r, Claim):
                row |= {"bar": r.bar, "verdict": r.verdict}
            rows.append(row)
        return rows


def plain(value: Any) -> Any:
    """The value in types of JSON: arrays as lists, NumPy's numbers as Python's, inf and nan as
    text.
    """
    if isinstance(value, dict):
        return {k: plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def kept(records: Iterator[Record], tell: Callable[[str], None]) -> Found:
    """All records but the `Doing`s, which the progress bar shows.

    A topic that raises an error keeps its records so far, and gets a claim that fails.
    """
    found = Found()
    try:
        for record in records:
            if isinstance(record, Doing):
                tell(record.what)
            else:
                found.append(record)
    except Exception as error:  # the other topics are reported all the same
        traceback.print_exc()
        found.append(
            Claim(
                f"{BROKEN} {type(error).__name__}: {error}",
                "this page",
                1,
                math.inf,
                "without end",
                high=0,
            )
        )
    return found
