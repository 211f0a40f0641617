"""Meshes that meshio reads: VTK (.vtu, .vtk), XDMF, MED of Code_Aster, Exodus of MOOSE.

Values at nodes stay there; values of cells belong to the means of the nodes of the cells. An array
of several components is named by letters or, for CalculiX' contact, by their order
(ccx2paraview).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie import files
from sie.profiles.trace_files import MESH

from .names import QUANTITIES, TRACTIONS, Meaning
from .raw import Columns, MeshGeometry, Raw

Array = NDArray[np.float64]

SUFFIXES = (".vtu", ".vtk", ".xdmf", ".med", ".e", ".exo", ".ex2", ".msh")
# The order of components by their number: VTK's symmetric tensors, plane ones, and full ones.
_LETTERS = {
    3: ("xx", "yy", "xy"),
    4: ("xx", "yy", "zz", "xy"),
    6: ("xx", "yy", "zz", "xy", "yz", "xz"),
    9: ("xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"),
}
_CONTACT = ("copen", "cslip1", "cslip2", "cpress", "cshear1", "cshear2")
_TENSORS = ("s", "stress", "sigma", "sig", "cauchy_stress")


def read(path: Path, means: Meaning) -> Raw:
    """All fields whose names are known. ValueError without one, or without meshio."""
    mesh = opened(path)
    nodes = geometry(path.name, mesh)
    bodies = nodes.bodies()
    fields = _fields(mesh.point_data, means)
    on_surface = [{n: v for n, v in fields.items() if (n in TRACTIONS) == on} for on in (1, 0)]
    labels = range(len(mesh.points))
    groups = [nodes.columns(labels, some, bodies) for some in on_surface if some]
    groups += _of_cells(mesh, bodies, means)
    if not groups:
        found = ", ".join([*mesh.point_data, *mesh.cell_data]) or "no field"
        raise ValueError(
            f"{path.name} holds {found}: name one field {' or '.join(QUANTITIES)}, "
            "or as the code names it, like CPRESS"
        )
    return Raw(path.name, tuple(groups), tops=nodes.tops(bodies))


def opened(path: Path) -> Any:
    """The mesh of a file. ValueError where meshio does not read it, or is missing."""
    files.content(path, MESH.size)  # refuses what is no file, or too large
    try:
        import meshio  # noqa: PLC0415 -- an extra
    except ImportError:
        raise ValueError(
            f'{path.name} is read by meshio, which is missing: pip install "plane-contact[mesh]", '
            "or export the points as CSV"
        ) from None
    try:
        return meshio.read(path)
    except (Exception, SystemExit) as problem:  # whatever its many readers raise
        raise ValueError(
            f"{path.name} is not read by meshio ({type(problem).__name__}): "
            "export the points as CSV"
        ) from None


def geometry(file: str, mesh: Any) -> MeshGeometry:
    """The nodes and elements of a mesh, by their indices."""
    nodes = {k: (float(p[0]), float(p[1])) for k, p in enumerate(mesh.points)}
    cells = (tuple(map(int, cell)) for block in mesh.cells for cell in block.data)
    return MeshGeometry(file, nodes, dict(enumerate(cells)))


def _of_cells(mesh: Any, bodies: dict[int, int], means: Meaning) -> Iterator[Columns]:
    """The columns of each block of cells that has a known field."""
    points = np.asarray(mesh.points, dtype=float)
    for k, block in enumerate(mesh.cells):
        fields = _fields({name: data[k] for name, data in mesh.cell_data.items()}, means)
        if fields:
            cells = np.asarray(block.data)
            x, y = points[cells][..., 0], points[cells][..., 1]
            body = np.array([bodies.get(n, 0) for n in cells[:, 0].tolist()], dtype=float)
            yield {"x": x.mean(axis=1), "y": y.mean(axis=1), **fields, "body": body}


def _fields(data: dict[str, Any], means: Meaning) -> dict[str, Array]:
    """The quantities in arrays of one component, and in the components of others."""
    fields: dict[str, Array] = {}
    for name, given in data.items():
        values = np.asarray(given, dtype=float)
        values = values.reshape(len(values), -1)
        count, short = values.shape[1], name.lower()
        components: tuple[str, ...] = (name,) if count == 1 else ()
        if count > 1 and short == "contact":
            components = _CONTACT
        elif count > 1 and short in _TENSORS:
            components = tuple(f"s{pair}" for pair in _LETTERS.get(count, ()))
        for component, column in zip(components, values.T, strict=False):
            if means(component) in QUANTITIES:
                fields.setdefault(means(component), column)
    return fields
