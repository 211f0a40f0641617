"""The commands and options of `sie`, and the message for each mistake."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from sie import __version__
from sie.arguments import nearest
from sie.io.mesh_files.names import BODIES, QUANTITIES
from sie.problem.request import GRID, POINTS, UNASKED, WANTS

from .streams import print_text

COMMANDS = {
    "solve": "solve a scene and print, draw or write the answer",
    "compare": "a mesh result against the exact one: error norms, peaks, a picture",
    "plan": "what would be computed, what would be skipped, and why",
    "live": "serve a page with sliders: the contact of a scene, or of an example",
    "example": "print a commented scene file to start from",
    "export-boundary": "exact displacements or forces for the boundary nodes of a mesh",
    "benchmark-set": "write contacts with exact references, by which other codes are measured",
    "schema": "print the JSON Schema of scene files, by which an editor completes their keys",
}
# What has the name of a file or a folder, as a refusal says it.
NAMED = {
    "scene": "the scene file",
    "mesh": "the mesh result",
    "nodes": "the file of nodes",
    "folder": "the directory",
    **{name: f"the file after --{name}" for name in ("plot", "csv", "json", "field")},
}
EXIT_CODES = """exit codes:
  0    solved
  1    solved, but the certificate is not met, or the mesh result differs by
       more than --tol
  2    refused, with one sentence on standard error and no file written
  130  interrupted
  141  nobody reads the output any more; the files are written"""
STANDARD = "-"
MOST_POINTS, MOST_PORTS = 10**6, 65535
COLUMNS = ("x", "y", *QUANTITIES)
TOL, MESH_TOL = 1e-13, 1e-2


class _Parser(argparse.ArgumentParser):
    """Raises ValueError for a mistake, in place of an exit, and OSError for unprintable help."""

    def error(self, message: str) -> NoReturn:
        _, lacks, names = message.partition("arguments are required: ")
        if lacks:
            message = f"{self.prog} needs {names}: write files first, then options"
        raise ValueError(f"{message}; `{self.prog} --help` explains")

    def _print_message(self, message: str, file: Any = None) -> None:
        print_text(message)


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """The arguments of the command line. Raises ValueError for a mistake."""
    if argv and not argv[0].startswith("-") and argv[0] not in COMMANDS:
        near = nearest(argv[0], COMMANDS)
        remedy = f"did you mean {near}?" if near else "`sie --help` lists them, like sie solve"
        raise ValueError(
            f'there is no command "{argv[0]}": {remedy}{"" if near else " " + argv[0]}'
        )
    arguments, unknown = parser().parse_known_args(argv)
    for name, what in NAMED.items():
        if getattr(arguments, name, None) == "":
            raise ValueError(f"the name of {what} is empty: give one")
    if unknown:
        near = nearest(unknown[0], [f"--{name.replace('_', '-')}" for name in vars(arguments)])
        remedy = f"did you mean {near}?" if near else f"`sie {arguments.command} --help` explains"
        raise ValueError(f'"{unknown[0]}" is not understood: {remedy}')
    return arguments


def parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    common: dict[str, Any] = {
        "allow_abbrev": False,
        "epilog": EXIT_CODES,
        "formatter_class": argparse.RawDescriptionHelpFormatter,
    }
    about = "Plane elastic contact: edges, pressure, gap and stress, and how exact they are."
    whole = _Parser(prog="sie", description=about, **common)
    whole.add_argument("--version", action="version", version=f"sie {__version__}")
    commands = whole.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, about in COMMANDS.items():
        command = commands.add_parser(name, help=about, description=about, **common)
        for option, (metavar, meaning, given) in _options(name).items():
            named: dict[str, Any] = {"metavar": metavar} if metavar else {}
            command.add_argument(option, help=meaning, **named, **given)
    return whole


Option = tuple[str, str, dict[str, Any]]  # name of its value, what it means, what argparse is told


def _options(command: str) -> dict[str, Option]:
    """The files and options of a command."""
    scene: Option = ("scene.toml", "the scene file; - is standard input", {})
    want = f"what to answer: {', '.join(WANTS)} ({', '.join(UNASKED)})"
    wanted: Option = ("WHAT", want, {"nargs": "+", "action": "extend"})
    if command == "solve":
        return {"scene": scene, "--want": wanted, **_of_solve()}
    if command == "compare":
        return {"scene": scene, **_of_compare()}
    if command == "export-boundary":
        return {"scene": scene, **_of_boundary()}
    kind, folder = "the kind of profile; without it, the list", "where: a new or an empty directory"
    port: Option = ("N", "the port (a free one)", {"type": _whole(0, MOST_PORTS), "default": 0})
    silent = "print the page's address, and open no browser"
    others: dict[str, dict[str, Option]] = {
        "plan": {"scene": scene, "--want": wanted},
        "live": {
            "scene": (*scene[:2], {"nargs": "?"}),
            "--port": port,
            "--no-browser": ("", silent, {"action": "store_true"}),
        },
        "example": {"name": ("NAME", kind, {"nargs": "?"})},
        "benchmark-set": {"folder": ("DIR", folder, {})},
    }
    return others.get(command, {})


QUIET: Option = (
    "",
    "print no report, only what goes to standard output by -",
    {"action": "store_true"},
)


def _of_solve() -> dict[str, Option]:
    plot = "draw pressure, gap and shear, or with --want stress its contours: .png ..."
    everything = "write all that is wanted; without FILE, print it"
    table = "write x, pressure, gap, shear, slip, at every point of a load path"
    points = {"type": _whole(2, MOST_POINTS), "default": POINTS}
    return {
        "--plot": ("FILE", f"{plot} (needs Matplotlib)", {}),
        "--csv": ("FILE", table, {}),
        "--json": ("FILE", everything, {"nargs": "?", "const": STANDARD}),
        "--field": ("FILE", "write the stress on a grid as a table", {}),
        "--grid": ("NXxNY", f"points of that grid ({GRID[0]}x{GRID[1]})", {"type": _grid}),
        "--points": ("N", "points in the contact, about (%(default)s)", points),
        "--tol": (
            "T",
            "relative accuracy to certify (%(default)s)",
            {"type": float, "default": TOL},
        ),
        "--quiet": QUIET,
    }


def _of_compare() -> dict[str, Option]:
    formats = "CalculiX .frd, Ansys PRNSOL, Abaqus .rpt, what meshio reads, or a table of text"
    nodes = "coordinates of nodes that the result lacks: NLIST of Ansys, a deck, CSV"
    columns = "which columns hold what, by name or by number from 0: x=distance,p=load"
    tol = "l2 error, relative, that is let pass (%(default)s)"
    return {
        "mesh": ("fem.csv", f"a mesh result: {formats} with x and p, q, sxx, ...", {}),
        "--nodes": ("FILE", nodes, {}),
        "--columns": ("NAMES", columns, {"type": _columns}),
        "--surface": ("Y", "the height of the surface in the file (found)", {"type": _height}),
        "--body": (
            "SIDE",
            "the body that is compared: below or above (below)",
            {"choices": BODIES},
        ),
        "--tol": ("T", tol, {"type": float, "default": MESH_TOL}),
        "--plot": ("FILE", "draw both and their difference (needs Matplotlib)", {}),
        "--json": (
            "FILE",
            "write the norms; without FILE, print them",
            {"nargs": "?", "const": STANDARD},
        ),
        "--quiet": QUIET,
    }


def _of_boundary() -> dict[str, Option]:
    nodes = "the mesh: a deck of Abaqus or CalculiX, or what meshio reads"
    kinds = {"choices": ("displacement", "traction"), "default": "displacement"}
    surface = {"type": _height, "default": 0.0}
    body = "the body of the nodes, below or above the surface (%(default)s)"
    zero = "the point, in the axes of the mesh, that keeps its place"
    return {
        "--nodes": ("FILE", nodes, {"required": True}),
        "--set": ("NAME", "the node set on the boundary", {"required": True}),
        "--kind": ("KIND", "displacement or traction (as nodal forces) (%(default)s)", kinds),
        "--surface": ("Y", "the height of the surface in the mesh (0)", surface),
        "--body": ("SIDE", body, {"choices": BODIES, "default": "below"}),
        "--zero": ("X,Y", zero, {"type": _place}),
        "--csv": ("FILE", "write a table, too", {}),
        "--quiet": QUIET,
    }


# -- values ----------------------------------------------------------------------------------------


def _place(text: str) -> tuple[float, float]:
    try:
        x, y = map(float, text.split(","))
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise argparse.ArgumentTypeError(f"{text} is not a point: give X,Y, like 0,-10")
    return x, y


def _height(text: str) -> float:
    try:
        return _place(f"0,{text}")[1]
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{text} is not a height: give y of the surface") from None


def _columns(text: str) -> dict[str, str]:
    """Names of columns by what they hold; a name may contain commas."""
    pairs = re.split(rf",(?=\s*(?:{'|'.join(COLUMNS)})\s*=)", text)
    columns = {
        key.strip(): name.strip() for key, _, name in (pair.partition("=") for pair in pairs)
    }
    if not set(columns) <= set(COLUMNS) or not all(columns.values()):
        raise argparse.ArgumentTypeError(
            f"{text} names no columns: give {', '.join(COLUMNS)}, like x=distance,p=load"
        )
    return columns


def _grid(text: str) -> tuple[int, int]:
    try:
        nx, ny = map(int, text.lower().split("x"))
    except ValueError:
        nx = ny = 0
    if min(nx, ny) < 2 or nx * ny > MOST_POINTS:
        raise argparse.ArgumentTypeError(
            f"{text} is not a grid of at least 2x2 and at most {MOST_POINTS} points, like 201x101"
        )
    return nx, ny


def _whole(least: int, most: int) -> Callable[[str], int]:
    """What reads a whole number from `least` to `most`."""

    def read(text: str) -> int:
        if not text.isdigit() or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"{text} is not a whole number from {least} to {most}")
        return int(text)

    return read
