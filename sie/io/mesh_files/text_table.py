"""Tables of text: CSV files, and what Ansys, Code_Aster, COMSOL, MOOSE and ParaView export.

The header is the line nearest above the numbers that names a column and has as many names as there
are columns, a comment (# or %) or not. COMSOL and Code_Aster separate names by blanks and write
units, with a blank before, into them; a line of units below the names is passed over.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from sie.arguments import nearest, shortened
from sie.profiles.trace_files import MESH, Table, read_table

from .names import QUANTITIES, WORDS, Meaning, meaning, negative_in_compression, spelling
from .raw import Raw

LARGEST = 1e100  # of a column: no length or stress, and its square is finite


def read(path: Path, means: Meaning) -> Raw:
    """The columns whose names are known; x and p without a header."""
    table = read_table(path, MESH)
    header = _header(table, means)
    names = header or ["x", "p"]
    names += map(str, range(len(names), table.width))  # of columns without a name
    indices = _indices(table.file, names, bool(header), means)
    columns = dict(zip(indices, table.columns(tuple(indices.values())), strict=True))
    for name, values in columns.items():
        largest = float(np.abs(values).max())
        if largest > LARGEST:
            raise ValueError(
                f"{table.file} has {name} up to {largest:g}, as what is missing may be marked: "
                "delete such lines"
            )
    notes = []
    for name, k in indices.items():
        if negative_in_compression(names[k]) and columns[name].sum() < 0.0:
            columns[name] = -columns[name]
            notes.append(f"{name} is -{names[k]}, which is negative in compression")
    used = set(indices.values())
    others = tuple(name for k, name in enumerate(names) if name and k not in used)
    return Raw(table.file, (columns,), others, tuple(notes))


def _indices(file: str, names: list[str], named: bool, means: Meaning) -> dict[str, int]:
    """The first column of each meaning, found by its name or its number.

    ValueError unless there are x and a quantity.
    """
    indices: dict[str, int] = {}
    for k, name in enumerate(names):
        if means(name) or means(str(k)):
            indices.setdefault(means(name) or means(str(k)), k)
    if "x" in indices and set(indices) & set(QUANTITIES):
        return indices
    wanted = {"x"} if "x" not in indices else set(QUANTITIES)
    words = [word for word in WORDS if meaning(word) in wanted]
    unknown = [name for name in names if named and not meaning(name)]
    near = next((name for name in unknown if nearest(spelling(name), words)), "")
    hint = f' (is "{near}" meant as "{nearest(spelling(near), words)}"?)' if near else ""
    raise ValueError(
        f"{file} has the columns {', '.join(names)}{hint}: "
        f"say which hold x and {' or '.join(QUANTITIES)}, like --columns x=distance,p=load"
    )


def _header(table: Table, means: Meaning) -> list[str]:
    """The names of the columns, none where no line above them is a header.

    ValueError for a header whose number of names is another.
    """
    lines = [line for line in reversed(table.before) if re.search(r"\w", line)]
    readings = [(line, _readings(line, table.separator)) for line in lines]
    for _, splits in readings:
        for names in splits:
            if len(names) == table.width and any(map(means, names)):
                return [_shown(name) for name in names]
    for line, splits in readings:
        known = any(means(name) for names in splits for name in names)
        if not known and line.lstrip().startswith(("#", "%")):
            continue
        if len(splits[0]) == table.width:
            return [_shown(name) for name in splits[0]]
        raise ValueError(
            f'{table.file} has {table.width} columns, and the header "{shortened(line.strip())}" '
            f"names {len(splits[0])}: give every column one name, in one line above the numbers"
        )
    return []


def _readings(line: str, separator: str) -> list[list[str]]:
    """The names in a line, separated as the numbers are, by other marks, and by two blanks."""
    bare = line.strip().lstrip("#% ").strip()
    if separator:
        return [[cell.strip().strip('"') for cell in bare.split(separator)]]
    joined = re.sub(r"\s+([\[(])", r"\1", bare)
    marks = [[cell.strip().strip('"') for cell in bare.split(mark)] for mark in (",", ";", "\t")]
    return [joined.split(), re.split(r"\s{2,}|\t", bare), *(m for m in marks if len(m) > 1)]


def _shown(name: str) -> str:
    """A name as messages show it: in lower case, without a unit in brackets."""
    return re.sub(r"[\[(].*", "", name).strip().lower() or name
