"""The load path of a scene file, in rows of its own or in the columns of a text file.

path = [[P, Q, σ], ...]              turning points; σ may be left out
path = "cycle.csv"                   a file beside the scene file, whose header names P, Q,
                                     sigma, tilt or moment; other columns are passed over
columns = ["P", "Q", "sigma", ...]   what the numbers of each row or line are, in order; "" for
                                     one that is passed over
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from sie.arguments import suggestion
from sie.problem.load_path import Path
from sie.profiles.trace_files import read_table

from .scene_values import refuse_unread

if TYPE_CHECKING:
    from .profile_tables import Files

# Each point is solved and listed, all of them within seconds.
MOST_POINTS = 2000
LOADS = ("P", "Q", "sigma")
QUANTITIES = (*LOADS, "tilt", "moment")
# Names in lower case, as in a header, and the quantities.
NAMES = {name.lower(): name for name in QUANTITIES} | {
    "σ": "sigma",
    "normal_load": "P",
    "tangential_load": "Q",
    "bulk_stress": "sigma",
}


def path_of(
    rows: str | Sequence[Sequence[float]], columns: Sequence[str] | None, beside: Files
) -> Path:
    """The path of [load] path and [load] columns. ValueError where they make none."""
    named = None if columns is None else [_quantity(name) for name in columns]
    if isinstance(rows, str):
        return _of_file(rows, named, beside)
    if len(rows) > MOST_POINTS:
        raise ValueError(
            f"path has {len(rows)} points, more than {MOST_POINTS}: "
            "follow it in Python, by sie.follow"
        )
    if named is None:
        return Path(rows)
    for k, row in enumerate(rows):
        if len(row) != len(named):
            raise ValueError(
                f"path[{k}] has {len(row)} numbers for {len(named)} columns: give one for each"
            )
    return _path(named, rows)


def _path(named: Sequence[str], rows: Sequence[Sequence[float]]) -> Path:
    """The path of rows of named numbers. ValueError where P or Q lacks, or one is there twice."""
    for name in QUANTITIES:
        if named.count(name) > 1:
            raise ValueError(f'two columns are named {name}: name the other one ""')
    missing = [name for name in ("P", "Q") if name not in named]
    if missing:
        raise ValueError(
            f"path has no column {' and no column '.join(missing)}: "
            'name what each column is, columns = ["P", "Q", "sigma"]'
        )
    values = {name: [row[k] for row in rows] for k, name in enumerate(named) if name}
    none = [0.0] * len(rows)
    points = zip(*(values.get(name, none) for name in LOADS), strict=True)
    return Path(points, tilt=values.get("tilt", ()), moment=values.get("moment", ()))


def _quantity(name: str) -> str:
    """The quantity that a name of [load] columns stands for, "" for none."""
    if name and name.lower() not in NAMES:
        known = suggestion(name, QUANTITIES)
        raise ValueError(f'columns "{name}" is not known: {known}, or "" to pass a column over')
    return NAMES[name.lower()] if name else ""


def _of_file(name: str, named: Sequence[str] | None, beside: Files) -> Path:
    try:
        table = read_table(beside.place(name))
    except OSError as problem:
        refuse_unread(name, problem, "rows [P, Q, σ], or the file of the loads")
    if len(table.rows) > MOST_POINTS:
        raise ValueError(
            f"{table.file} has {len(table.rows)} lines, more than {MOST_POINTS}: keep those at "
            "which the loads turn"
        )
    if named is None:
        named = [NAMES.get(header, "") for header in table.header]
        if not table.header and table.width <= len(LOADS):
            named = LOADS[: table.width]
        if not {"P", "Q"} <= set(named):
            found = f"its header names {', '.join(table.header)}" if table.header else "no header"
            raise ValueError(
                f"{table.file} names no columns P and Q ({found}): say what each column is, "
                'columns = ["", "P", "Q", "sigma"]'
            )
    if len(named) > table.width:
        raise ValueError(
            f"{len(named)} columns are named, and {table.file} has {table.width}: name those, in "
            "order"
        )
    kept = [k for k, quantity in enumerate(named) if quantity]
    rows = np.column_stack(table.columns(tuple(kept))).tolist()
    return _path([named[k] for k in kept], rows)
