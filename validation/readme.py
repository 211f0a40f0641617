"""The tables of accuracy and speed in the README and on the page of the validation.

`python -m validation --readme` writes them, with the numbers of that run. These are kept in
validation/readme.json, so that a test can compare them.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from validation import cases
from validation.topics import pressure, speed

ROOT = Path(__file__).parent.parent
KEPT = Path(__file__).parent / "readme.json"
README, PAGE = ROOT / "README.md", ROOT / "docs" / "validation.md"
BEGIN, END = (
    "<!-- from validation/readme.json by `python -m validation --readme` -->\n",
    "<!-- end -->\n",
)
FORMATS = ("{}", "{:.1e}", "{:.1e}", "{:.1e}", "{}", "{:.2f} ms", "{:.1f}")
HEADER = (*pressure.HEADER, "solve + 1001 p", "ratio")
SHOWN = cases.QUICK
IN_README = ("parabola", "rounded", "eight")  # the least, the paper's, the slowest
TOPICS = ("pressure", "speed")  # that the table is made of


def rows(report: Mapping[str, Any]) -> list[list[Any]]:
    """The README's rows from the JSON of a report: errors and counts, then times.

    They are the first case of each kind.
    """
    errors, times = (
        first_of_each_kind(report, *of)
        for of in zip(TOPICS, (pressure.TABLE, speed.TABLE), strict=True)
    )
    return [[*errors[name], *times[name][1:]] for name in SHOWN]


def first_of_each_kind(report: Mapping[str, Any], name: str, title: str) -> dict[str, list[Any]]:
    """Rows of a topic's table, by the kind of case."""
    topic = report["topics"].get(name)
    if topic is None:
        raise ValueError(
            f"the report has no topic `{name}`, of which the README's table is made: run it "
            f"without --only, or with it"
        )
    table = next(r for r in topic if r["kind"] == "table" and r["title"] == title)
    first: dict[str, list[Any]] = {}
    for row in table["rows"]:
        first.setdefault(kind(row[0]), row)
    return first


def markdown(rows: list[list[Any]]) -> str:
    lines = [
        HEADER,
        ("---",) * len(HEADER),
        *(
            [f.format(v).replace("|", r"\|") for f, v in zip(FORMATS, row, strict=True)]
            for row in rows
        ),
    ]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def tables(rows: list[list[Any]]) -> dict[Path, str]:
    """The table of each document: some rows in the README, all on the page of the validation."""
    few = [row for row in rows if kind(row[0]) in IN_README]
    return {README: markdown(few), PAGE: markdown(rows)}


def kind(case: str) -> str:
    """The kind of case that a row is about: its name without a load or a width."""
    return re.split(r"-[Pr]=", case)[0]


def with_table(text: str, table: str) -> str:
    """A document with another table between its marks."""
    before, rest = text.split(BEGIN)
    return before + BEGIN + table + END + rest.split(END)[1]


def files(report: Mapping[str, Any]) -> dict[Path, bytes]:
    """The files to be written: the documents, and the numbers of their tables."""
    found = rows(report)
    kept = (
        json.dumps({"machine": report["machine"], "rows": found}, indent=1, ensure_ascii=False)
        + "\n"
    )
    documents = {
        path: with_table(path.read_text(encoding="utf-8"), table).encode()
        for path, table in tables(found).items()
    }
    return {KEPT: kept.encode(), **documents}
