"""Printed results of CalculiX (.dat), with the mesh of its input deck.

A section starts with a line of words such as

    contact stress (slave node,press,tang1,tang2) for all contact elements and time 1.0
    contact stress (slave element+face,press,tang1,tang2) for all contact elements and time 1.0
    stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set SKIN and time 1.0

and has one line a node or an integration point. Values at the integration points of an element, or
of a face of it, are averaged; they belong to its centre. Of each kind the last time is read.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sie.profiles.trace_files import MESH, text_lines

from .names import QUANTITIES, meaning
from .raw import Group, MeshGeometry, Raw, means

Array = NDArray[np.float64]

_TITLE = re.compile(
    r"\s*(?P<kind>contact stress|stresses)\s*\((?P<columns>.*)\) for .*time\s+(?P<time>\S+)"
)
# Corners of the faces of a brick and a wedge. Plane elements become such: their edge n is the
# face n + 2. A tetrahedron has faces of its own.
_BRICK = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (3, 0, 7, 4))
_WEDGE = ((0, 1, 2), (3, 4, 5), (0, 1, 3, 4), (1, 2, 4, 5), (2, 0, 5, 3))
_TETRAHEDRON = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))


def read(path: Path, mesh: MeshGeometry) -> Raw:
    """Contact stress and stress of the last time. ValueError without either, or another mesh."""
    sections = _sections(path)
    bodies = mesh.bodies()
    groups, notes = [], []
    for (kind, columns), (time, rows) in sections.items():
        names = [meaning(name.strip()) for name in columns.split(",")]
        by_node = "node" in columns
        first = next(k for k, name in enumerate(names) if name in QUANTITIES)
        values = np.array([row[-(len(names) - first) :] for row in rows], dtype=float)
        if by_node:
            labels, values = means([int(row[0]) for row in rows], values)
            groups.append(_at_nodes(mesh, bodies, labels.tolist(), names[first:], values))
        else:
            face = kind == "contact stress"
            keys = [10 * int(row[0]) + (int(row[1]) if face else 0) for row in rows]
            labels, values = means(keys, values)
            groups.append(_at_centres(mesh, bodies, labels.tolist(), names[first:], values))
            where = "element faces" if face else "elements"
            notes.append(f"{kind} at integration points is averaged over {len(labels)} {where}")
        notes.append(f"{kind} is read at time {time:g}")
    if not groups:
        raise ValueError(
            f"{path.name} holds no stress: ask CalculiX for *CONTACT PRINT with CSTR, or *EL PRINT "
            "with S, or give its .frd"
        )
    return Raw(path.name, tuple(groups), notes=tuple(notes), tops=mesh.tops(bodies))


def _sections(path: Path) -> dict[tuple[str, str], tuple[float, list[list[str]]]]:
    """Time and rows of the last section of each kind; sets printed at that time are joined."""
    found: dict[tuple[str, str], tuple[float, list[list[str]]]] = {}
    rows: list[list[str]] | None = None
    for number, line in enumerate(text_lines(path, MESH), 1):
        title = _TITLE.match(line)
        if title:
            key, time = (title["kind"], title["columns"]), float(title["time"])
            if key not in found or found[key][0] != time:
                found[key] = (time, [])
            rows = found[key][1]
        elif line.strip() and rows is not None:
            if not re.match(r"\s*\d", line):
                rows = None  # the title of another kind
                continue
            cells = re.findall(r"[-+]?\d\S*?(?:[Ee][-+]?\d+)?(?=[-+\s]|$)", line)
            if len(cells) < 4:
                raise ValueError(
                    f"{path.name} is cut off in line {number}, {line.strip()[:60]!r}: "
                    "give the file as CalculiX wrote it"
                )
            rows.append(cells)
    return {key: (time, rows) for key, (time, rows) in found.items() if rows}


def _columns(points: Array, names: list[str], values: Array) -> dict[str, Array]:
    known = {name: values[:, k] for k, name in enumerate(names) if name in QUANTITIES}
    return {"x": points[:, 0], "y": points[:, 1], **known}


def _at_nodes(
    mesh: MeshGeometry, bodies: dict[int, int], labels: list[int], names: list[str], values: Array
) -> Group:
    part = np.array([bodies.get(label, 0) for label in labels], dtype=np.int64)
    return Group(_columns(mesh.points(labels), names, values), bodies=part)


def _at_centres(
    mesh: MeshGeometry, bodies: dict[int, int], keys: list[int], names: list[str], values: Array
) -> Group:
    """Values at the centres of elements, or of their faces where the last digit names one."""
    corners = [_face(mesh, *divmod(key, 10)) for key in keys]
    places = [mesh.points(nodes) for nodes in corners]
    part = np.array([bodies.get(nodes[0], 0) for nodes in corners], dtype=np.int64)
    widths = np.array([float(np.ptp(place[:, 0])) for place in places])
    centres = np.array([place.mean(axis=0) for place in places])
    return Group(_columns(centres, names, values), widths if keys[0] % 10 else (), part)


def _face(mesh: MeshGeometry, element: int, face: int) -> tuple[int, ...]:
    """The corners of a face of an element; face 0 is the whole element."""
    nodes = mesh.corners(element)
    if face == 0:
        return nodes
    try:
        if element in mesh.plane:
            corners = nodes[: 3 if len(nodes) in (3, 6) else 4]
            return corners[face - 3], corners[(face - 2) % len(corners)]
        kinds = {4: _TETRAHEDRON, 10: _TETRAHEDRON, 6: _WEDGE, 15: _WEDGE}
        return tuple(nodes[k] for k in kinds.get(len(nodes), _BRICK)[face - 1])
    except IndexError:
        raise ValueError(
            f"element {element} of {mesh.file} has no face {face}: "
            "give the input deck of the same run"
        ) from None
