"""Results of CalculiX as its pre- and postprocessor reads them (.frd).

Lines of fixed columns (cgx manual, section "Result Format"): nodes from a line 2C, elements from
3C, and one block a result, which starts with 100CL (its time), -4 (its name) and -5 (its
components). " -1" begins a node or an element, " -2" continues it, " -3" ends a block. Numbers of
nodes have 5 columns in the short format and 10 in the long one, values 12.

The last block of STRESS and that of CONTACT are read. The contact pressure stands at the nodes of
the slave surface and is zero at all others.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from sie.profiles.trace_files import MESH, text_lines

from .names import QUANTITIES, Meaning
from .raw import Columns, MeshGeometry, Raw

VALUE = 12  # columns of a number


@dataclass
class _Block:
    """One result: its name, time, components and the values at each node."""

    name: str
    time: float
    components: list[str] = field(default_factory=list)
    values: dict[int, list[float]] = field(default_factory=dict)


def read(path: Path, means: Meaning) -> Raw:
    """Stress and contact at the nodes, of the last step. ValueError without either."""
    mesh, blocks = _blocks(path)
    bodies = mesh.bodies()
    latest = blocks[-1].time if blocks else 0.0
    last = {block.name: block for block in blocks if block.time == latest}.values()
    known = [block for block in last if any(map(means, block.components))]
    listed = [block for block in known if not mesh.nodes.keys().isdisjoint(block.values)]
    notes = [
        f"{block.name} is at nodes that {path.name} does not list: have them written, OUTPUT=3D"
        for block in known
        if block not in listed
    ]
    if notes and not listed:
        raise ValueError(notes[0])
    groups = [_group(mesh, bodies, block, means) for block in listed]
    groups = [group for group in groups if group.keys() & set(QUANTITIES)]
    if not groups:
        found = ", ".join(sorted({block.name for block in blocks})) or "no result"
        raise ValueError(
            f"{path.name} holds {found}, and neither STRESS nor CONTACT: ask CalculiX for "
            "*EL FILE with S, or *CONTACT FILE with CSTR"
        )
    times = sorted({block.time for block in blocks})
    if len(times) > 1:
        notes.append(f"the last of {len(times)} times is read, {times[-1]:g}")
    return Raw(path.name, tuple(groups), notes=tuple(notes), tops=mesh.tops(bodies))


def _group(mesh: MeshGeometry, bodies: dict[int, int], block: _Block, means: Meaning) -> Columns:
    labels = [label for label in block.values if label in mesh.nodes]
    values = np.array([block.values[label] for label in labels], dtype=float).T
    named = zip(map(means, block.components), values, strict=False)
    return mesh.columns(labels, {n: v for n, v in named if n in QUANTITIES}, bodies)


def _blocks(path: Path) -> tuple[MeshGeometry, list[_Block]]:
    """The mesh and all results of the file."""
    mesh = MeshGeometry(path.name, {}, {})
    blocks: list[_Block] = []
    section, time, width, last = "", 0.0, 10, 0
    for number, line in enumerate(text_lines(path, MESH), 1):
        try:
            if line.startswith(("    2C", "    3C", "  100C")):
                section = line[4:6] if line[4] in "23" else ""
                width = _label_width(line, path.name)
                time = float(line[12:24]) if not section else time
            elif line.startswith(" -4"):
                section = "result"
                blocks.append(_Block(line[5:13].strip(), time))
            elif line.startswith(" -5") and section == "result":
                blocks[-1].components.append(line[5:13].strip())
            elif line.startswith(" -3"):
                section = ""
            elif line.startswith((" -1", " -2")) and section:
                last = _record(line, section, width, last, (mesh, blocks))
        except (ValueError, IndexError) as problem:
            if path.name in str(problem):
                raise
            raise ValueError(
                f"{path.name} is cut off or changed in line {number}, {line.strip()[:60]!r}: "
                "give the file as CalculiX wrote it"
            ) from None
    if section:
        raise ValueError(f"{path.name} ends within a block: wait until CalculiX has written it")
    return mesh, blocks


def _label_width(line: str, file: str) -> int:
    """Columns of a label, by the format that ends the line: 0 is short, 1 long, 2 and 3 binary."""
    result = line.startswith("  100C")
    kind = (line[73:75].strip() or "1") if result else line.rsplit(maxsplit=1)[-1]
    if kind in ("2", "3"):
        raise ValueError(f"{file} is written in binary: have it written as text")
    return 5 if kind == "0" else 10


def _record(
    line: str, section: str, width: int, last: int, data: tuple[MeshGeometry, list[_Block]]
) -> int:
    """The node or element that a line is about; what the line says is added to the data."""
    mesh, blocks = data
    start = 3 + width
    label = int(line[3:start]) if line.startswith(" -1") else last
    if section == "3C":
        if line.startswith(" -1"):
            mesh.elements[label] = ()
        else:
            mesh.elements[label] += tuple(map(int, line[3:].split()))
        return label
    text = line[start:].rstrip()
    numbers = [float(text[k : k + VALUE]) for k in range(0, len(text), VALUE)]
    if section == "2C":
        mesh.nodes[label] = (numbers[0], numbers[1])
    else:
        blocks[-1].values.setdefault(label, []).extend(numbers)
    return label
