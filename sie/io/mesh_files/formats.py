"""The reader of a file, by its suffix and its first lines."""

from __future__ import annotations

import re
from pathlib import Path

from sie import files
from sie.profiles.trace_files import MESH

from . import abaqus_report, by_meshio, calculix_dat, calculix_frd, input_deck, text_table
from .raw import MeshGeometry, Raw

# CalculiX: "contact stress (slave node,press,tang1,tang2) for all contact elements and time 1.0".
_PRINTED = re.compile(r"^ [a-z ]+\([^)\n]*\).* for .*\btime\b", re.MULTILINE)


def read(path: str | Path, deck: str | Path | None = None) -> Raw:
    """What the file holds; `deck` is the input deck with nodes and elements, where it needs one.

    ValueError where it cannot be compared, and OSError where it cannot be read.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if deck is not None:
        files.content(Path(deck), MESH.size)  # refuses what is no file, even where none is needed
    if suffix == ".frd":
        return calculix_frd.read(path)
    if suffix in by_meshio.SUFFIXES:
        return by_meshio.read(path)
    text = files.content(path, MESH.size).decode("latin-1")
    if _PRINTED.search(text):
        return calculix_dat.read(path, _mesh(path, deck))
    if abaqus_report.TITLE in text:
        return abaqus_report.read(path, None if deck is None else _mesh(path, deck))
    return text_table.read(path)


def _mesh(path: Path, deck: str | Path | None) -> MeshGeometry:
    """The mesh of the deck that is given, or else of that with the name of the results."""
    if deck is None and not path.with_suffix(".inp").is_file():
        raise ValueError(
            f"{path.name} has no coordinates: give the input deck, --deck job.inp, "
            f"or lay it beside as {path.stem}.inp"
        )
    return input_deck.read(Path(deck) if deck is not None else path.with_suffix(".inp"))
