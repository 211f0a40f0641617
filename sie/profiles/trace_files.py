"""Traces in files: columns of numbers as text, or what a profilometer writes, read by SurfaceTopography (the extra `traces`).

Text is taken as it comes: comma, semicolon, tab or blanks between the columns, a decimal comma where these leave it free, comments after #
or %, header lines before the first number. What is not a number after that is missing, and reported by its line.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from numbers import Integral
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.io import files

Array = NDArray[np.float64]
Column = int | str

FORMATS = (
    "",
    ".csv",
    ".txt",
    ".dat",
    ".tsv",
    ".asc",
    ".prn",
    ".prf",
    ".xy",
)  # read as text; all others are SurfaceTopography's
# Bytes and lines of a file that is read: a trace within a second, a mesh result within ten.
TRACE, MESH = (4 * 10**6, 10**5), (64 * 10**6, 5 * 10**5)
NAMED = 5  # lines that a message names
MISSING = {
    "",
    "nan",
    "na",
    "n/a",
    "null",
    "none",
    "-",
    "--",
    "---",
    "*",
    "inf",
    "-inf",
    "+inf",
    "bad",
    "*****",
}

DECIMAL_COMMA = r"[-+]?\d*(,\d+)?([eE][-+]?\d+)?"


def read_columns(
    path: str | Path,
    columns: tuple[Column, ...],
    skip: int = 0,
    keep_missing: bool = False,
    most: tuple[int, int] = TRACE,
) -> tuple[Array, ...]:
    """The columns of a text file, given by number (the first is 0) or by the name in the header.

    skip            lines at the top that are no part of the table
    keep_missing    give nan where a line lacks a value
    most            bytes and lines of the file

    Raises ValueError, naming the lines, where a value is missing or is no number; FileNotFoundError, OSError.
    """
    path = Path(path)
    split, start, header, separator = _table(path, skip, most)
    wanted = [_index(path, column, header, len(split[start])) for column in columns]
    rows = [(k + skip + 1, cells) for k, cells in enumerate(split[start:], start) if cells]
    values = [
        [_value(cells[j], separator) if j < len(cells) else math.nan for j in wanted]
        for _, cells in rows
    ]
    strange = [line for (line, _), row in zip(rows, values, strict=True) if None in row]
    if strange:
        raise ValueError(
            f"{path.name} has text where a number is wanted, in {_named(strange)}: mend the file, or choose other columns"
        )
    table = np.array(values, dtype=float)
    bad = ~np.isfinite(table).all(axis=1)
    if bad.any() and not keep_missing:
        lacking = [line for (line, _), is_bad in zip(rows, bad.tolist(), strict=True) if is_bad]
        raise ValueError(
            f"{path.name} lacks a value in {_named(lacking)}: delete such lines (for a trace, mend = true passes over them)"
        )
    return tuple(table.T)


def header_of(
    path: str | Path, skip: int = 0, most: tuple[int, int] = TRACE
) -> tuple[list[str], int]:
    """(names of the columns in lower case and without their units, none if there is no header; how many columns there are)."""
    split, start, header, _ = _table(Path(path), skip, most)
    return header, len(split[start])


def read_topography(path: str | Path) -> tuple[Array, Array]:
    """A line scan in any format that SurfaceTopography knows; lengths and heights in the unit of the file's lengths."""
    path = Path(path)
    files.content(path, TRACE[0])
    try:
        import SurfaceTopography  # noqa: PLC0415 -- an extra
    except ImportError:
        raise ValueError(
            f'{path.name} is no text file by its suffix: SurfaceTopography may read it, pip install "plane-contact[traces]"; '
            f"text has one of the suffixes {', '.join(filter(None, FORMATS))}"
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
            f"{path.name} holds a map, {topography.nb_grid_pts} points: give a line scan, or one line of it as Sampled(x, h)"
        )
    x, h = topography.positions_and_heights()
    return np.asarray(x, dtype=float).ravel(), np.ma.filled(
        np.ma.asarray(h, dtype=float), np.nan
    ).ravel()


def is_text(path: str | Path) -> bool:
    return Path(path).suffix.lower() in FORMATS


def _table(
    path: Path, skip: int, most: tuple[int, int]
) -> tuple[list[list[str]], int, list[str], str]:
    """(cells of every line, the first line with numbers, names of the columns, separator)."""
    lines = _text(path, most).splitlines()[skip:]
    separator = _separator(lines)
    split = [_cells(line, separator) for line in lines]
    start = _first_row(split, separator)
    if start is None:
        raise ValueError(
            f"{path.name} has no line with two numbers: give a text file with columns, or skip fewer lines"
        )
    header: list[str] = []
    for line in lines[:start][
        ::-1
    ]:  # the last line before them that names as many columns, be it a comment
        names = _cells(line.lstrip("#% "), separator)
        if len(names) == len(split[start]):
            header = [_bare_name(name) for name in names]
            break
    return split, start, header, separator


def _first_row(split: list[list[str]], separator: str) -> int | None:
    """The first line with two numbers: a sentence that has two is none, if it has words and another number of cells than most lines."""
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


def _text(path: Path, most: tuple[int, int]) -> str:
    data = files.content(path, most[0])
    if data.count(b"\n") > most[1]:
        raise ValueError(
            f"{path.name} has more than {most[1]} lines: thin the points out, for instance keep every tenth"
        )
    for encoding in (
        ("utf-16",) if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "latin-1")
    ):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise ValueError(
        f"{path.name} is not a text file: export the trace as text, or give it the suffix of its format"
    )


def _separator(lines: list[str]) -> str:
    """Semicolon before tab before comma, as the lines that hold numbers have it; blanks otherwise."""
    body = [_bare(line) for line in lines if re.search(r"\d", _bare(line))]
    for candidate in (";", "\t", ","):
        if sum(candidate in line for line in body) > len(body) // 2:
            return "" if candidate == "," and _decimal_commas(body) else candidate
    return ""


def _decimal_commas(body: list[str]) -> bool:
    """Whether blanks stand between numbers in whose midst a comma stands: "0,5  1,25", but not "0, 5" or "0.5,1.25"."""
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


def _index(path: Path, column: Column, header: list[str], width: int) -> int:
    if isinstance(column, str):
        name = _bare_name(column)
        if name not in header:
            known = f"its header names {', '.join(header)}" if header else "it has no header"
            raise ValueError(
                f"{path.name} has no column {column!r}, {known}: give a name, or a number from 0 to {width - 1}"
            )
        return header.index(name)
    if isinstance(column, bool) or not isinstance(column, Integral) or not 0 <= column < width:
        raise ValueError(
            f"{path.name} has no column {column!r}: it has {width}, give numbers from 0 to {width - 1}, or names of its header"
        )
    return int(column)


def _bare_name(name: str) -> str:
    """A column's name in lower case, without the unit in brackets behind it."""
    return re.sub(r"[\[(].*", "", name).strip().lower()


def _named(lines: list[int]) -> str:
    shown = ", ".join(map(str, lines[:NAMED]))
    more = f" and {len(lines) - NAMED} more" if len(lines) > NAMED else ""
    return f"line {shown}" if len(lines) == 1 else f"lines {shown}{more}"
