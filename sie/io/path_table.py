"""The load path of a scene file, in rows of its own or in the columns of a text file.

path = [[P, Q, σ], ...]              turning points; σ may be left out
path = "cycle.csv"                   a file beside the scene file, whose header names P, Q,
                                     sigma, tilt or moment; other columns are passed over
columns = ["P", "Q", "sigma", ...]   what the numbers of each row or line are, in order; "" for
                                     one that is passed over
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import zip_longest
from pathlib import Path as File
from typing import Any

from sie.arguments import suggestion
from sie.problem.load_path import Path
from sie.profiles.trace_files import read_table

from .profile_tables import Surroundings
from .quantities import ANGLE, FORCE, MOMENT, STRESS
from .toml_values import NUMBER, refuse_unread

# Each point is solved and listed, all of them within seconds.
MOST_POINTS = 2000
LOADS = ("P", "Q", "sigma")
DIMENSIONS = {"P": FORCE, "Q": FORCE, "sigma": STRESS, "tilt": ANGLE, "moment": MOMENT}
# Names in lower case, as in a header, and the quantities.
NAMES = {name.lower(): name for name in DIMENSIONS} | {
    "σ": "sigma",
    "normal_load": "P",
    "tangential_load": "Q",
    "bulk_stress": "sigma",
}


def path_of(
    rows: str | Sequence[Sequence[Any]], columns: Sequence[str] | None, around: Surroundings
) -> Path:
    """The path of [load] path and [load] columns, their cells numbers or quantities with a unit.

    Raises ValueError where they make none.
    """
    named = None if columns is None else [_quantity(name) for name in columns]
    if isinstance(rows, str):
        return _path(_of_file(rows, named, around.place(rows)))
    if len(rows) > MOST_POINTS:
        raise ValueError(
            f"path has {len(rows)} points, more than {MOST_POINTS}: "
            "follow it in Python, by sie.follow"
        )
    for k, row in enumerate(rows if named else ()):
        if len(row) != len(named or ()):
            raise ValueError(
                f"path[{k}] has {len(row)} numbers for {len(columns or ())} columns: give one for "
                "each"
            )
    values = [_numbers(f"path[{k}]", row, named or LOADS, around) for k, row in enumerate(rows)]
    if named is None:
        return Path(values)
    return _path(_chosen(named, list(zip(*values, strict=True))))


def _numbers(
    where: str, row: Sequence[Any], named: Sequence[str], around: Surroundings
) -> list[float]:
    """The cells of a row as numbers in the units of the file."""
    cells = []
    for j, (cell, name) in enumerate(zip_longest(row, named[: len(row)], fillvalue="")):
        place = f"{where}[{j}]"
        number = around.convert.number(place, cell, DIMENSIONS[name]) if name else cell
        cells.append(NUMBER.read(place, number))
    return cells


def _path(values: Mapping[str, Sequence[float]]) -> Path:
    """The path of columns. Raises ValueError if P or Q is not among them."""
    missing = [name for name in ("P", "Q") if name not in values]
    if missing:
        raise ValueError(
            f"path has no column {' and no column '.join(missing)}: "
            'name what each column is, columns = ["P", "Q", "sigma"]'
        )
    none = [0.0] * len(values["P"])
    points = zip(*(values.get(name, none) for name in LOADS), strict=True)
    return Path(points, tilt=values.get("tilt", ()), moment=values.get("moment", ()))


def _quantity(name: str) -> str:
    """The quantity that a name of [load] columns stands for, "" for none."""
    if name and name.lower() not in NAMES:
        known = suggestion(name, DIMENSIONS)
        raise ValueError(f'columns "{name}" is not known: {known}, or "" to pass a column over')
    return NAMES[name.lower()] if name else ""


def _chosen(named: Sequence[str], columns: Sequence[Any]) -> dict[str, Any]:
    """The columns that hold a quantity. Raises ValueError if two hold the same one."""
    twice = next((name for name in named if name and named.count(name) > 1), None)
    if twice:
        raise ValueError(f'two columns are named {twice}: name the other one ""')
    return {name: column for name, column in zip(named, columns, strict=False) if name}


def _of_file(name: str, named: Sequence[str] | None, file: File) -> dict[str, Any]:
    try:
        table = read_table(file)
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
    values = [column.tolist() for column in table.columns(tuple(kept))]
    return _chosen([named[k] for k in kept], values)
