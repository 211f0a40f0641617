"""The nodes and elements of an input deck of Abaqus or CalculiX (.inp).

*NODE has a label and coordinates a line; *ELEMENT a label and the labels of nodes, which go on in
the next line after a comma at the end. Everything else is passed over. A deck of parts and
instances gives labels more than once: there, and in a deck that includes other files, coordinates
are better written with the results.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from sie.profiles.trace_files import MESH, text_lines

from .raw import MeshGeometry

_PLANE = re.compile(r"TYPE\s*=\s*(CPE|CPS|CAX|M2D)", re.IGNORECASE)


def read(path: Path) -> MeshGeometry:
    """The mesh of a deck. ValueError where it has no nodes, or labels that stand twice."""
    nodes: dict[int, tuple[float, float]] = {}
    elements: dict[int, tuple[int, ...]] = {}
    plane: set[int] = set()
    for number, keyword, line in _data_lines(path):
        try:
            cells = line.rstrip(",").split(",")
            label = int(cells[0])
            if keyword.startswith("*NODE"):
                new = _is_new(nodes, label, (float(cells[1]), float(cells[2])))
            else:
                new = _is_new(elements, label, tuple(map(int, cells[1:])))
                plane.update({label} if _PLANE.search(keyword) else ())
        except (ValueError, IndexError):
            raise ValueError(
                f"{path.name} has neither a node nor an element in line {number}, {line[:60]!r}: "
                "give the input deck as the solver reads it"
            ) from None
        if not new:
            raise ValueError(
                f"label {label} stands twice in {path.name}, as in a deck of several parts: "
                "write the coordinates (COORD) beside the results"
            )
    if not nodes:
        raise ValueError(
            f"{path.name} has no *NODE lines: give the input deck of the mesh, "
            "with its included files written into it"
        )
    return MeshGeometry(path.name, nodes, elements, frozenset(plane))


def _data_lines(path: Path) -> Iterator[tuple[int, str, str]]:
    """Number, keyword line and text of each line of *NODE and *ELEMENT, continued lines joined."""
    keyword, pending = "", ""
    for number, line in enumerate(text_lines(path, MESH), 1):
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            keyword, pending = line.strip().upper(), ""
        elif re.match(r"\*(NODE|ELEMENT)\s*(,|$)", keyword):
            pending += line.strip()
            if not (keyword.startswith("*ELEMENT") and pending.endswith(",")):
                yield number, keyword, pending
                pending = ""


def _is_new(table: dict[int, Any], label: int, value: Any) -> bool:
    """Whether the label had no other value so far; it has this one now."""
    return table.setdefault(label, value) == value
