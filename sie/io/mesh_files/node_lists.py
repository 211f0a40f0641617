"""Lists by node number: what PRNSOL of Ansys prints, with the coordinates that NLIST prints.

    NODE     PRES         SFRIC               NODE        X             Y             Z
       1   530.12       0.90221E-01              1  -1.0000        0.0000        0.0000

A line of names begins a list, other text ends it, and both repeat on every page. Commas, semicolons
or tabs may separate the cells. The lines below *NODE in an input deck list coordinates too. Both
lists may stand in one file. Sets of nodes are those of a deck, or of a mesh that meshio reads:

    *NSET, NSET=OUTER                    labels or names of sets, several in a line
    *NSET, NSET=OUTER, GENERATE          first, last, step
    *NODE, NSET=OUTER                    the nodes below are its nodes
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import files
from sie.arguments import shortened, suggestion
from sie.profiles.trace_files import MESH, text_lines

from . import by_meshio
from .names import QUANTITIES, Meaning, meaning, spelling
from .raw import Columns, MeshGeometry, Raw

_LABELS = ("node", "node_number", "node_label", "node_id", "knoten", "knotennummer")
_BEGINS = re.compile(r"\s*[\"']?(node|knoten)", re.IGNORECASE)
_DECK = re.compile(r"\*NODE\s*(,|$)", re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[Ee][-+]?\d+)?")  # two may stand without a blank


class _Row(NamedTuple):
    """The numbers in one line, by what they mean, "" for what is not known."""

    label: int
    columns: dict[str, float]


def read(path: Path, nodes: MeshGeometry | None, means: Meaning) -> Raw | None:
    """The quantities at the nodes; None where the file lists none, or x beside them.

    The coordinates are those that are given, or stand in a list of the same file.
    """
    rows = [*_rows(path, means)]
    found: dict[str, dict[int, float]] = {}
    again = False
    for label, columns in rows:
        for name in set() if "x" in columns else columns.keys() & set(QUANTITIES):
            again = again or label in found.get(name, {})
            found.setdefault(name, {})[label] = columns[name]
    if not found:
        return None
    nodes = nodes or _geometry(path.name, rows)
    if not nodes.nodes:
        raise ValueError(
            f"{path.name} has values by node and no coordinates: list these, in Ansys by NLIST, "
            "and give that file, --nodes nlist.lis"
        )
    groups: dict[tuple[int, ...], Columns] = {}
    for name, values in found.items():
        group = groups.setdefault((*values,), nodes.columns([*values], {}, {}))
        group[name] = np.array([*values.values()])
    notes = ("nodes are listed more than once: their last values are read",) if again else ()
    return Raw(path.name, tuple(groups.values()), notes=notes)


def coordinates(path: Path) -> MeshGeometry:
    """The nodes that a file lists. ValueError without any, or for one at two places."""
    nodes = _geometry(path.name, _rows(path, meaning))
    if not nodes.nodes:
        raise ValueError(
            f"{path.name} lists no coordinates of nodes: give what NLIST prints, a table with the "
            "columns node, x and y, or an input deck with *NODE lines"
        )
    return nodes


def _geometry(file: str, rows: Iterator[_Row] | list[_Row]) -> MeshGeometry:
    nodes: dict[int, tuple[float, float]] = {}
    for label, columns in rows:
        if "x" not in columns:
            continue
        place = (columns["x"], columns.get("y", 0.0))
        if nodes.setdefault(label, place) != place:
            raise ValueError(
                f"{file} lists node {label} at two places, as a deck of several parts does: "
                "write the coordinates beside the results"
            )
    return MeshGeometry(file, nodes, {})


def _rows(path: Path, means: Meaning) -> Iterator[_Row]:
    """The lines of all lists. ValueError for one with another number of cells than names."""
    names: list[str] = []
    deck = complete = False
    for number, line in enumerate(text_lines(path, MESH), 1):
        if not line.strip() or line.lstrip().startswith("**"):
            continue
        if _DECK.match(line) or _BEGINS.match(line):
            deck = line.startswith("*")
            names = ["x", "y", "z"] if deck else _names(line)
            known = {*map(means, names)}
            complete = "x" in known and not known.isdisjoint(QUANTITIES)  # a table of text
            continue
        numbers = _numbers(line) if names else []
        if len(numbers) == 1:
            continue  # the mark of a page
        if numbers and (deck or len(numbers) == len(names) + 1):
            columns = dict(zip(map(means, names), map(float, numbers[1:]), strict=False))
            yield _Row(int(numbers[0]), columns)
        elif names and not complete and line.lstrip()[0].isdigit():
            raise ValueError(
                f"{path.name} has {shortened(line.strip())!r} in line {number}, below "
                f"{len(names) + 1} names: list every node with all its numbers"
            )
        else:
            names = []


def _names(line: str) -> list[str]:
    """The names behind that of the node number; none where it is no line of names."""
    marked = re.search(r"[,;\t]", line)
    cells = re.split(r"[,;\t]" if marked else r"\s+", line.strip())
    label, *names = (cell.strip().strip("\"'") for cell in cells)
    listed = spelling(label) in _LABELS and not any(map(_NUMBER.fullmatch, names))
    return names if listed else []


def _numbers(line: str) -> list[str]:
    """The cells of a line of numbers, of which the first is whole; [] of other lines."""
    bare = line.replace(",", ".") if re.search(r"[;\t]", line) else line
    numbers = _NUMBER.findall(bare)
    other = re.search(r"[^\s,;]", _NUMBER.sub("", bare))
    return [] if other or not numbers or not numbers[0].isdigit() else numbers


# -- sets of nodes ---------------------------------------------------------------------------------


def nodes_of_set(path: str | Path, name: str) -> tuple[NDArray[np.int64], MeshGeometry]:
    """The labels of the nodes in a set, and the mesh. ValueError where there is no such set."""
    path = Path(path)
    if path.suffix.lower() in by_meshio.SUFFIXES:
        mesh = by_meshio.opened(path)
        geometry = by_meshio.geometry(path.name, mesh)
        sets: dict[str, Any] = {key: np.asarray(nodes) for key, nodes in mesh.point_sets.items()}
        for key, blocks in mesh.cell_sets.items():  # a physical group of Gmsh
            cells = [block.data[chosen] for block, chosen in zip(mesh.cells, blocks, strict=True)]
            sets.setdefault(key, np.concatenate([c.ravel() for c in cells]))
    else:
        files.content(path, MESH.size)
        geometry, sets = coordinates(path), dict(_of_deck(path))
    known = {key.upper(): np.unique(nodes) for key, nodes in sets.items()}
    if name.upper() not in known:
        raise ValueError(f"{path.name} has no node set {name!r}: {suggestion(name, sorted(sets))}")
    return known[name.upper()].astype(np.int64), geometry


def _of_deck(path: Path) -> dict[str, list[int]]:
    """The labels in every set of a deck, by its name in upper case."""
    sets: dict[str, list[int]] = {}
    current, generate, of_nodes = None, False, False
    for line in text_lines(path, MESH):
        text = line.strip().upper()
        if not text or text.startswith("**"):
            continue
        if text.startswith("*"):
            card, *parameters = re.split(r"\s*,\s*", text)
            given = dict(re.split(r"\s*=\s*|$", parameter, maxsplit=1) for parameter in parameters)
            of_nodes, generate = card == "*NODE", "GENERATE" in given
            current = given.get("NSET") if card in ("*NODE", "*NSET") else None
            sets |= {current: sets.get(current, [])} if current else {}
        elif current:
            cells = [cell.strip() for cell in text.split(",") if cell.strip()]
            sets[current] += _labels(cells[:1] if of_nodes else cells, sets, generate)
    return sets


def _labels(cells: list[str], sets: dict[str, list[int]], generate: bool) -> Iterator[int]:
    """The labels that a line of a set names."""
    if generate:
        first, last, step = (*map(int, cells), 1)[:3]
        yield from range(first, last + 1, step)
        return
    for cell in cells:
        yield from sets.get(cell, []) if not cell.isdigit() else (int(cell),)
