"""What a command is asked for, checked before anything is computed or written.

The scene file, the files that are written, and that none of them is a file that is read.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import sys
from dataclasses import replace
from itertools import combinations
from types import ModuleType

from sie import files
from sie.arguments import choices
from sie.io import scene_file
from sie.io.answers import wanted
from sie.io.scene_file import SceneFile
from sie.io.scene_tables import wants
from sie.problem.request import WANTS

from .parser import STANDARD

OUTPUTS = ("plot", "csv", "json", "field")


def scene_of(arguments: argparse.Namespace) -> SceneFile:
    """The scene file, with --want in place of the file's own `want`."""
    words = getattr(arguments, "want", None) or ()
    want = wants("--want", [name for name in ",".join(words).split(",") if name])
    if words and not want:
        raise ValueError(f"--want names nothing: give {choices(WANTS)}")
    standard = arguments.scene == STANDARD
    file = (
        scene_file.parse(_standard_input(), "standard input")
        if standard
        else scene_file.read(arguments.scene)
    )
    return replace(file, want=want or wanted(file))


def _standard_input() -> bytes:
    if sys.stdin is None:
        raise ValueError("standard input is closed: give the scene a file")
    return sys.stdin.buffer.read(scene_file.MOST_BYTES + 1)


def outputs_of(arguments: argparse.Namespace) -> dict[str, pathlib.Path]:
    """The destination of each kind of output. ValueError unless all can be written."""
    given = ((kind, getattr(arguments, kind, None)) for kind in OUTPUTS)
    outputs = {kind: pathlib.Path(name) for kind, name in given if name is not None}
    known = {"plot": picture_style().suffixes() if "plot" in outputs else (), "field": ("csv",)}
    for kind in known.keys() & outputs.keys():
        if outputs[kind].suffix[1:].lower() not in known[kind]:
            raise ValueError(
                f'--{kind} {outputs[kind]} has the suffix "{outputs[kind].suffix}": '
                f"use .{', .'.join(known[kind])}"
            )
    for (first, path), (second, other) in combinations(outputs.items(), 2):
        if path == other == pathlib.Path(STANDARD):
            raise ValueError(
                f"--{first} and --{second} cannot both go to standard output: give one of them a "
                "file"
            )
        if files.same(_place(path), _place(other)):
            raise ValueError(
                f"--{second} {other} would overwrite what --{first} writes: give another name"
            )
    for path in outputs.values():
        if path != pathlib.Path(STANDARD):
            files.writable(path)
    return outputs


def _place(path: pathlib.Path) -> int | pathlib.Path:
    """The path, or the descriptor of standard output."""
    return 1 if path == pathlib.Path(STANDARD) else path


def refuse_overwriting(
    arguments: argparse.Namespace, outputs: dict[str, pathlib.Path], file: SceneFile
) -> None:
    """ValueError if an output, or what is printed, would go into a file that is read."""
    scene = 0 if arguments.scene == STANDARD else pathlib.Path(arguments.scene)
    read: dict[int | pathlib.Path, str] = {scene: "the scene file"}
    read |= dict.fromkeys(file.reads, "a trace that the scene reads")
    for name, what in (("mesh", "the mesh result"), ("nodes", "the file of nodes")):
        if getattr(arguments, name, None) is not None:
            read[pathlib.Path(getattr(arguments, name))] = what
    written = {f"--{kind} {path}": _place(path) for kind, path in outputs.items()}
    for place, what in read.items():
        for name, target in (written | {"standard output": 1}).items():
            if os.path.isfile(place) and files.same(target, place):
                raise ValueError(f"{name} would overwrite {what}: give another name")


def picture_style() -> ModuleType:
    """The module of the pictures' style; its import shows whether Matplotlib is installed."""
    try:
        from sie.plots import style
    except ImportError:
        raise ValueError('--plot needs Matplotlib: pip install "plane-contact[plot]"') from None
    return style
