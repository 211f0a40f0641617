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
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from sie.profiles.trace_files import MESH, text_lines

from .names import QUANTITIES, Meaning
from .raw import Columns, MeshGeometry, Raw, row_means

TITLE = "Field Output Report"
_LABELS = (
    "node", "element", "int", "label", "pt", "int pt", "part", "instance", "part instance",
)  # fmt: skip


def read(path: Path, mesh: MeshGeometry | None, means: Meaning) -> Raw:
    """The tables of all parts, each as a body of its own. ValueError without x and a quantity."""
    tables = [
        (names, rows) for names, rows in _tables(path) if {*map(means, names)} & {*QUANTITIES}
    ]
    if not tables:
        raise ValueError(
            f"{path.name} has no table with one of {', '.join(QUANTITIES)}: "
            "write a field output report with CPRESS, CSHEAR1 or S, and with COORD"
        )
    groups = [_columns(path.name, mesh, means, names, rows) for names, rows in tables]
    listed = dict.fromkeys(name for names, _ in tables for name in names)
    others = tuple(n for n in listed if not means(n) and n.lower() not in _LABELS)
    averaged = any(_of_elements(names) for names, _ in tables)
    notes = ("values at integration points are averaged over each element",) * averaged
    if not all("y" in group for group in groups):
        return Raw(path.name, tuple(groups), others, notes)
    if len(groups) > 1:  # a body for each part, the lowest first
        groups.sort(key=lambda group: float(group["y"].mean()))
        groups = [g | {"body": np.full(len(g["x"]), float(k))} for k, g in enumerate(groups)]
    tops = tuple(float(group["y"].max()) for group in groups)
    return Raw(path.name, tuple(groups), others, notes, tops)


def _of_elements(names: list[str]) -> bool:
    return any(name.lower().startswith("element") for name in names)


def _columns(
    file: str, mesh: MeshGeometry | None, means: Meaning, names: list[str], rows: list[list[str]]
) -> Columns:
    """What is known of a table, with the places."""
    known = {means(name): k for k, name in reversed(list(enumerate(names))) if means(name)}
    labelled = next((k for k, n in enumerate(names) if re.match("node|element", n.lower())), None)
    values = np.array([[float(row[k]) for k in known.values()] for row in rows])
    keys = [int(row[labelled]) if labelled is not None else k for k, row in enumerate(rows)]
    if _of_elements(names):
        _, values = row_means(keys, values)
    columns = dict(zip(known, values.T, strict=True))
    if "x" in columns:
        return columns
    if mesh is None or labelled is None or _of_elements(names):
        raise ValueError(
            f"{file} has no coordinates: write COORD into the report, "
            "or, of values at nodes, give the input deck, --nodes job.inp"
        )
    return mesh.columns(keys, columns, {})


def _tables(path: Path) -> Iterator[tuple[list[str], list[list[str]]]]:
    """Names and rows of each table, which stand above and below a line of hyphens."""
    lines = text_lines(path, MESH)
    blank = [k for k, line in enumerate(lines) if not line.strip()]
    for k, line in enumerate(lines):
        if re.fullmatch(r"\s*-{20,}\s*", line):
            start = max((b for b in blank if b < k), default=-1) + 1
            stop = next((b for b in blank if b > k), len(lines))
            rows = [row.split() for row in lines[k + 1 : stop]]
            if rows and start < k:
                yield _names(path.name, lines[start], len(rows[0])), rows


def _names(file: str, head: str, width: int) -> list[str]:
    """The names in the line, without the pairs of surfaces that contact output has behind it."""
    for names in (re.split(r"\s{2,}", head.strip()), head.split()):
        for kept in (names, [name for name in names if "/" not in name]):
            if len(kept) == width:
                return kept
    raise ValueError(
        f"{file} has {width} columns below a header of {len(head.split())} names, "
        f'"{" ".join(head.split())[:60]}": write one report for each variable, with COORD'
    )
