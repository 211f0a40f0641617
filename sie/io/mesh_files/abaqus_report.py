"""Field output reports of Abaqus/CAE (.rpt).

Each part has a table: names in a line, "Label" and "@Loc 1" below them, a line of hyphens, then
the rows up to a blank line; after that Minimum, Maximum and Total, which are passed over.

                Node          CPRESS     COORD.COOR1     COORD.COOR2
               Label          @Loc 1          @Loc 1          @Loc 1
    ----------------------------------------------------------------
                   1     269.383E+00    -130.326E-03              0.

Without COORD the coordinates of nodes come from another file, such as the input deck. A row for
each integration point is averaged over the element. XY reports are tables of text (`text_table`).
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sie.profiles.trace_files import MESH, text_lines

from .names import QUANTITIES, Meaning
from .raw import Columns, MeshGeometry, Raw, row_means

Array = NDArray[np.float64]
TITLE = "Field Output Report"
_LABELS = (
    "node", "element", "int", "label", "pt", "int pt", "part", "instance", "part instance",
)  # fmt: skip


def read(path: Path, mesh: MeshGeometry | None, means: Meaning) -> Raw:
    """The tables of all parts, each as a body of its own. ValueError without x and a quantity."""
    groups: list[Columns] = []
    others: dict[str, None] = {}
    averaged = False
    for names, rows in _tables(path):
        group = _group(path.name, mesh, means, (names, rows))
        if group is None:
            continue
        groups.append(group)
        averaged = averaged or not _by_node(names)
        unknown = (name for name in names if not means(name) and name.lower() not in _LABELS)
        others |= dict.fromkeys(unknown)
    if not groups:
        raise ValueError(
            f"{path.name} has no table with one of {', '.join(QUANTITIES)}: "
            "write a field output report with CPRESS, CSHEAR1 or S, and with COORD"
        )
    notes = ("values at integration points are averaged over each element",) if averaged else ()
    if not all("y" in group for group in groups):
        return Raw(path.name, tuple(groups), tuple(others), notes)
    if len(groups) > 1:  # a body for each part, the lowest first
        groups.sort(key=lambda group: float(group["y"].mean()))
        bodies = (np.full(len(group["x"]), float(k)) for k, group in enumerate(groups))
        groups = [g | {"body": body} for g, body in zip(groups, bodies, strict=True)]
    tops = tuple(float(group["y"].max()) for group in groups)
    return Raw(path.name, tuple(groups), tuple(others), notes, tops)


def _by_node(names: list[str]) -> bool:
    return not any(name.lower().startswith("element") for name in names)


def _group(
    file: str, mesh: MeshGeometry | None, means: Meaning, table: tuple[list[str], list[list[str]]]
) -> Columns | None:
    """The table as columns; None where it has no quantity."""
    names, rows = table
    known = {means(name): k for k, name in reversed(list(enumerate(names))) if means(name)}
    if not set(known) & set(QUANTITIES):
        return None
    labelled = next((k for k, n in enumerate(names) if re.match("node|element", n.lower())), None)
    values = np.array([[float(row[k]) for k in known.values()] for row in rows])
    keys = [int(row[labelled]) if labelled is not None else k for k, row in enumerate(rows)]
    if not _by_node(names):
        labels, values = row_means(keys, values)
        keys = labels.tolist()
    columns = dict(zip(known, values.T, strict=True))
    if "x" in columns:
        return columns
    if mesh is None or labelled is None or not _by_node(names):
        raise ValueError(
            f"{file} has no coordinates: write COORD into the report, "
            "or, of values at nodes, give the input deck, --nodes job.inp"
        )
    return mesh.columns(keys, columns, {})


def _tables(path: Path) -> list[tuple[list[str], list[list[str]]]]:
    """Names and rows of each table. ValueError where a table has more or fewer columns."""
    lines = text_lines(path, MESH)
    tables = []
    for k, line in enumerate(lines):
        if not re.fullmatch(r"\s*-{20,}\s*", line) or k + 1 == len(lines):
            continue
        rows = []
        for row in lines[k + 1 :]:
            if not row.strip():
                break
            rows.append(row.split())
        head = _head(lines[:k])
        if rows and head:
            tables.append((_names(path.name, head, len(rows[0])), rows))
    return tables


def _head(lines: list[str]) -> str:
    """The first of the lines that stand together at the end: that of the names."""
    first = ""
    for line in reversed(lines):
        if not line.strip():
            break
        first = line
    return first


def _names(file: str, head: str, width: int) -> list[str]:
    """The names in the line, without the pairs of surfaces that contact output has behind it."""
    names = re.split(r"\s{2,}", head.strip())
    if len(names) != width:
        names = [name for name in names if "/" not in name]
    if len(names) != width:
        names = [name for name in head.split() if "/" not in name]
    if len(names) != width:
        raise ValueError(
            f"{file} has {width} columns below a header of {len(names)} names, "
            f'"{" ".join(head.split())[:60]}": write one report for each variable, with COORD'
        )
    return names
