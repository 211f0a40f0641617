"""The nodes of a set in a mesh: input decks of Abaqus and CalculiX, and what meshio reads.

*NSET, NSET=OUTER          labels or names of sets, several in a line
*NSET, NSET=OUTER, GENERATE          first, last, step
*NODE, NSET=OUTER          the nodes below are its nodes
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie import files
from sie.arguments import suggestion
from sie.profiles.trace_files import MESH, text_lines

from . import by_meshio, node_lists
from .raw import MeshGeometry

Labels = NDArray[np.int64]


def nodes_of_set(path: str | Path, name: str) -> tuple[Labels, MeshGeometry]:
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
        geometry, sets = node_lists.coordinates(path), dict(_of_deck(path))
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
            card, *parameters = (part.strip() for part in text.split(","))
            given = dict(_pair(parameter) for parameter in parameters)
            of_nodes, generate = card == "*NODE", "GENERATE" in given
            current = given.get("NSET") if card in ("*NODE", "*NSET") else None
            sets |= {current: sets.get(current, [])} if current else {}
        elif current:
            cells = [cell.strip() for cell in text.split(",") if cell.strip()]
            sets[current] += _labels(cells[:1] if of_nodes else cells, sets, generate)
    return sets


def _pair(parameter: str) -> tuple[str, str]:
    key, _, value = parameter.partition("=")
    return key.strip(), value.strip()


def _labels(cells: list[str], sets: dict[str, list[int]], generate: bool) -> Iterator[int]:
    """The labels that a line of a set names."""
    if generate:
        first, last, step = (*map(int, cells), 1)[:3]
        yield from range(first, last + 1, step)
        return
    for cell in cells:
        yield from sets.get(cell, []) if not cell.isdigit() else (int(cell),)
