"""Traces in files: columns of numbers as text, or a profilometer's format.

Text is read with a comma, semicolon, tab or blanks between the columns; with a decimal comma where
commas do not separate columns; with comments after # or %, and with header lines before the first
number. After that a cell without a number is a missing value, which is reported with its line
number.
Other formats are read by SurfaceTopography (the extra `traces`).
"""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass
from numbers import Integral
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments, files

from .trace_units import unit_named, units_of_head

Array = NDArray[np.float64]
Column = int | str


class Limit(NamedTuple):
    """The largest size of a file."""

    size: int  # bytes
    lines: int


# A trace within this limit is read within a second, a mesh result within ten.
TRACE, MESH = Limit(4 * 10**6, 10**5), Limit(64 * 10**6, 5 * 10**5)
# Suffixes of text; files with any other suffix are left to SurfaceTopography.
TEXT = ("", ".csv", ".txt", ".dat", ".tsv", ".asc", ".prn", ".prf", ".xy")
MISSING = {
    "", "nan", "na", "n/a", "null", "none", "-", "--", "---", "*", "*****",
    "inf", "-inf", "+inf", "bad",
}  # fmt: skip
NAMED = 5  # lines that a message names
DECIMAL_COMMA = r"[-+]?\d*(,\d+)?([eE][-+]?\d+)?"


def read_trace(
    path: str | Path, columns: tuple[Column, ...], skip: int = 0, keep_missing: bool = False
) -> tuple[Array, Array, tuple[str, str]]:
    """The points x and heights h of a trace, and the units of both where the file has them.

    `columns` and `skip` are those of a text file.

    Raises ValueError where the file holds no trace, and OSError where it cannot be read.
    """
    if not isinstance(path, (str, PathLike)):
        raise ValueError(f"path = {path!r} is not the name of a file: give a string or a Path")
    path = files.named(path)
    pair = arguments.listed("columns", columns, "those of x and of h")
    if len(pair) != 2 or not all(isinstance(column, (Integral, str)) for column in pair):
        raise ValueError(f"columns = {columns!r} is not a pair: give the columns of x and of h")
    if isinstance(skip, bool) or not isinstance(skip, Integral) or skip < 0:
        raise ValueError(f"skip = {skip!r} is not a number of lines: give 0 or more")
    data = files.content(path, TRACE.size)
    if path.suffix.lower() not in TEXT:
        return _line_scan(path)
    table = _table(path.name, data, int(skip), TRACE)
    x, h = table.columns(pair, keep_missing)
    return x, h, table.units(pair)


def read_table(path: str | Path, limit: Limit = TRACE) -> Table:
    """The table in a text file. Raises ValueError where there is none, and OSError."""
    path = Path(path)
    return _table(path.name, files.content(path, limit.size), 0, limit)


def text_lines(path: Path, limit: Limit) -> list[str]:
    """The lines of a text file. Raises ValueError where it is none or too long, and OSError."""
    return _text(path.name, files.content(path, limit.size), limit.lines).splitlines()


@dataclass(frozen=True, eq=False)
class Table:
    """The columns of a text file.

    file         the name of the file
    rows         (number of the line, its cells) from the first line with numbers on
    header       names of the columns in lower case without their units; empty without a header
    separator    what separates the cells, "" for blanks
    before       the lines before the first one with numbers, those that are skipped too
    """

    file: str
    rows: tuple[tuple[int, list[str]], ...]
    header: tuple[str, ...]
    separator: str
    before: tuple[str, ...] = ()

    @property
    def width(self) -> int:
        """The number of columns."""
        return len(self.rows[0][1])

    def columns(self, wanted: tuple[Column, ...], keep_missing: bool = False) -> tuple[Array, ...]:
        """The columns by number (the first is 0) or by name.

        A missing value is nan if `keep_missing` is true, else it raises ValueError with its line.
        """
        indices = [self._index(column) for column in wanted]
        values = [
            [_value(cells[j], self.separator) if j < len(cells) else math.nan for j in indices]
            for _, cells in self.rows
        ]
        strange = [line for (line, _), row in zip(self.rows, values, strict=True) if None in row]
        if strange:
            raise ValueError(
                f"{self.file} has text where a number is wanted, in {_named(strange)}: "
                "mend the file, or choose other columns"
            )
        numbers = np.array(values, dtype=float)
        bad = ~np.isfinite(numbers).all(axis=1)
        if bad.any() and not keep_missing:
            lacking = [self.rows[k][0] for k in np.flatnonzero(bad)]
            raise ValueError(
                f"{self.file} lacks a value in {_named(lacking)}: "
                "delete such lines (for a trace, mend = true passes over them)"
            )
        return tuple(numbers.T)

    def units(self, wanted: tuple[Column, ...]) -> tuple[str, str]:
        """The units of length of two columns by the lines before the numbers, "" where none."""
        indices = tuple(map(self._index, wanted))
        return units_of_head(list(self.before), self.separator, self.width, indices)

    def _index(self, column: Column) -> int:
        last = self.width - 1
        if isinstance(column, str):
            name = _bare_name(column)
            if name not in self.header:
                names = ", ".join(self.header)
                known = f"its header names {names}" if names else "it has no header"
                raise ValueError(
                    f"{self.file} has no column {column!r}, {known}: "
                    f"give a name, or a number from 0 to {last}"
                )
            return self.header.index(name)
        whole = isinstance(column, Integral) and not isinstance(column, bool)
        if not whole or not 0 <= column <= last:
            raise ValueError(
                f"{self.file} has no column {column!r}: it has {self.width}, "
                f"give numbers from 0 to {last}, or names of its header"
            )
        return int(column)


def _line_scan(path: Path) -> tuple[Array, Array, tuple[str, str]]:
    """A line scan as SurfaceTopography reads it, heights in the unit of the lengths, and that."""
    try:
        import SurfaceTopography  # noqa: PLC0415 -- an extra
    except ImportError:
        raise ValueError(
            f"{path.name} is no text file by its suffix: SurfaceTopography may read it, "
            'pip install "plane-contact[traces]"; '
            f"text has one of the suffixes {', '.join(filter(None, TEXT))}"
        ) from None
    try:
        topography: Any = SurfaceTopography.read_topography(str(path))
    except OSError:
        raise
    except Exception as problem:  # whatever its many readers raise
        why = type(problem).__name__  # its words are those of all its readers, a line each
        raise ValueError(
            f"{path.name} is not read by SurfaceTopography ({why}): export the trace as text"
        ) from None
    if topography.dim != 1:
        raise ValueError(
            f"{path.name} holds a map, {topography.nb_grid_pts} points: "
            "give a line scan, or one line of it as Sampled(x, h)"
        )
    x, h = topography.positions_and_heights()
    heights: Array = np.ma.filled(np.ma.asarray(h, dtype=float), np.nan)
    unit = unit_named(str(getattr(topography, "unit", None) or ""))
    return np.asarray(x, dtype=float).ravel(), heights.ravel(), (unit, unit)


def _table(file: str, data: bytes, skip: int, limit: Limit) -> Table:
    whole = _text(file, data, limit.lines).splitlines()
    lines = whole[skip:]
    separator = _separator(lines)
    split = [_cells(line, separator) for line in lines]
    start = _first_row(split, separator)
    if start is None:
        raise ValueError(
            f"{file} has no line with two numbers: "
            "give a text file with columns, or skip fewer lines"
        )
    rows = tuple((k + skip + 1, cells) for k, cells in enumerate(split) if k >= start and cells)
    header = _header(lines[:start], separator, len(split[start]))
    return Table(file, rows, header, separator, tuple(whole[: skip + start]))


def _header(lines: list[str], separator: str, width: int) -> tuple[str, ...]:
    """The names in the last of the lines that has as many cells as the table; comments count."""
    for line in reversed(lines):
        names = _cells(line.lstrip("#% "), separator)
        if len(names) == width:
            return tuple(_bare_name(name) for name in names)
    return ()


def _first_row(split: list[list[str]], separator: str) -> int | None:
    """The index of the first line of the table: one with two numbers.

    A sentence may hold two numbers too. It has words, and another number of cells than most lines.
    """
    rows = [k for k, cells in enumerate(split) if sum(_finite(c, separator) for c in cells) >= 2]
    usual = Counter(len(split[k]) for k in rows).most_common(1)
    return next(
        (
            k
            for k in rows
            if len(split[k]) == usual[0][0]
            or all(_value(c, separator) is not None for c in split[k])
        ),
        None,
    )


def _text(file: str, data: bytes, most_lines: int) -> str:
    if data.count(b"\n") > most_lines:
        raise ValueError(
            f"{file} has more than {most_lines} lines: "
            "thin the points out, for instance keep every tenth"
        )
    utf16 = data[:2] in (b"\xff\xfe", b"\xfe\xff")
    for encoding in ("utf-16",) if utf16 else ("utf-8-sig", "latin-1"):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise ValueError(
        f"{file} is not a text file: export the trace as text, or give it the suffix of its format"
    )


def _separator(lines: list[str]) -> str:
    """The first of semicolon, tab and comma that most lines with numbers contain, else blanks."""
    body = [_bare(line) for line in lines if re.search(r"\d", _bare(line))]
    for candidate in (";", "\t", ","):
        if sum(candidate in line for line in body) > len(body) // 2:
            return "" if candidate == "," and _decimal_commas(body) else candidate
    return ""


def _decimal_commas(body: list[str]) -> bool:
    """Whether commas are decimal and blanks separate: "0,5  1,25", but not "0, 5" or "0.5,1.25"."""
    columns = re.compile(rf"{DECIMAL_COMMA}(\s+{DECIMAL_COMMA})+")
    return sum(columns.fullmatch(line) is not None for line in body) > len(body) // 2


def _bare(line: str) -> str:
    if "#" in line or "%" in line:
        line = re.split(r"[#%]", line, maxsplit=1)[0]
    return line.strip()


def _cells(line: str, separator: str) -> list[str]:
    bare = _bare(line)
    if not bare:
        return []
    return (
        [cell.strip().strip('"') for cell in bare.split(separator)] if separator else bare.split()
    )


def _value(cell: str, separator: str) -> float | None:
    """The number in a cell, nan where it is missing, None where there is something else."""
    if cell.lower() in MISSING:
        return math.nan
    try:
        return float(cell.replace(",", ".") if separator != "," else cell)
    except ValueError:
        return None


def _finite(cell: str, separator: str) -> bool:
    value = _value(cell, separator)
    return value is not None and math.isfinite(value)


def _bare_name(name: str) -> str:
    """A column's name in lower case, without the unit in brackets behind it."""
    return re.sub(r"[\[(].*", "", name).strip().lower()


def _named(lines: list[int]) -> str:
    shown = ", ".join(map(str, lines[:NAMED]))
    more = f" and {len(lines) - NAMED} more" if len(lines) > NAMED else ""
    return f"line {shown}" if len(lines) == 1 else f"lines {shown}{more}"
