"""The reader of a file, by its suffix and its first lines."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from sie import files
from sie.profiles.trace_files import MESH

from . import abaqus_report, by_meshio, calculix_frd, node_lists, text_table
from .names import chosen
from .raw import Raw

# CalculiX: "contact stress (slave node,press,tang1,tang2) for all contact elements and time 1.0".
_PRINTED = re.compile(r"^ [a-z ]+\([^)\n]*\).* for .*\btime\b", re.MULTILINE)


def read(
    path: str | Path, nodes: str | Path | None = None, columns: Mapping[str, str] | None = None
) -> Raw:
    """What the file holds.

    `nodes` is the file that lists coordinates, where the first one has none, and `columns` the
    names of columns by what they hold. ValueError where the file cannot be compared, and OSError
    where it cannot be read.
    """
    path, columns = Path(path), columns or {}
    raw = _read(path, None if nodes is None else Path(nodes), columns)
    for quantity, name in columns.items():
        if not any(quantity in group for group in raw.groups):
            raise ValueError(
                f'{path.name} has no column "{name}" for {quantity}: '
                "give the name as it stands in the file"
            )
    return raw


def _read(path: Path, nodes: Path | None, columns: Mapping[str, str]) -> Raw:
    means = chosen(columns)
    mesh = None if nodes is None else node_lists.coordinates(nodes)
    suffix = path.suffix.lower()
    if suffix == ".frd":
        return calculix_frd.read(path, means)
    if suffix in by_meshio.SUFFIXES:
        return by_meshio.read(path, means)
    text = files.content(path, MESH.size).decode("latin-1")
    if _PRINTED.search(text):
        raise ValueError(
            f"{path.name} is printed output of CalculiX, without coordinates: have a .frd written, "
            "by *CONTACT FILE with CSTR and *EL FILE with S, and compare that"
        )
    if abaqus_report.TITLE in text:
        return abaqus_report.read(path, mesh, means)
    return node_lists.read(path, mesh, means) or text_table.read(path, means)
