"""The commands and options of `sie`, and the message for each mistake."""

from __future__ import annotations

import argparse
import math
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

from sie import __version__
from sie.arguments import nearest
from sie.io.mesh_files.names import BODIES, QUANTITIES
from sie.problem.request import GRID, POINTS, UNASKED, WANTS

from .streams import print_text

COMMANDS = {
    "solve": "solve a scene and print, draw or write the answer",
    "compare": "a mesh result against the exact one: error norms, best shift, a picture",
    "plan": "what would be computed, what would be skipped, and why",
    "live": "serve a page with sliders: the contact of a scene, or of an example",
    "example": "print a commented scene file to start from",
    "export-boundary": "exact displacements or forces for the boundary nodes of a mesh",
    "benchmark-set": "write contacts with exact references, by which other codes are measured",
    "schema": "print the JSON Schema of scene files, by which an editor completes their keys",
    "completion": "print a script by which a shell completes commands, options and files",
}
# The files that a command reads, in the order of the command line.
FILES = {
    "solve": ("scene",),
    "plan": ("scene",),
    "compare": ("scene", "mesh"),
    "live": ("scene",),
    "export-boundary": ("scene",),
}
# What has the name of a file or a folder, as a refusal says it.
NAMED = {
    "scene": "the scene file",
    "mesh": "the mesh result",
    "nodes": "the file of nodes",
    "folder": "the directory",
    **{name: f"the file after --{name}" for name in ("plot", "csv", "json", "field")},
}
POSITIONAL = ("command", "scene", "mesh", "name", "shell")
LEVELS = ("info", "debug")
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
        raise ValueError(f"{message}; `{self.prog} --help` explains")

    def _print_message(self, message: str, file: Any = None) -> None:
        print_text(message)


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """The arguments of the command line. Raises ValueError for a mistake."""
    if argv and not argv[0].startswith("-") and argv[0] not in COMMANDS:
        near = nearest(argv[0], COMMANDS)
        remedy = (
            f"did you mean {near}?" if near else f"say what to do with it, like sie solve {argv[0]}"
        )
        raise ValueError(f'there is no command "{argv[0]}": {remedy}')
    arguments, unknown = parser().parse_known_args(argv)
    _order_files(arguments, argv, unknown)
    for name, what in NAMED.items():
        if getattr(arguments, name, None) == "":
            raise ValueError(f"the name of {what} is empty: give one")
    if unknown:
        near = nearest(unknown[0], _options(arguments))
        remedy = f"did you mean {near}?" if near else f"`sie {arguments.command} --help` explains"
        raise ValueError(f'"{unknown[0]}" is not understood: {remedy}')
    return arguments


def _order_files(arguments: argparse.Namespace, argv: Sequence[str], unknown: list[str]) -> None:
    """Give the command its files, those too that --want or --json took or that stand apart."""
    names = FILES.get(arguments.command, ())
    given = [getattr(arguments, name) for name in names]
    files = [file for file in given if file is not None]
    while unknown and len(files) < len(names) and not unknown[0].startswith("-"):
        files.append(unknown.pop(0))
    words, output = getattr(arguments, "want", None) or [], getattr(arguments, "json", None) or ""
    taken = [word for word in words if _names_a_file(word)]
    if len(files) < len(names) and len(words) > 1 and taken:
        files.append(taken[-1])
        words.remove(taken[-1])
    if len(files) < len(names) and _names_a_file(output) and not output.endswith(".json"):
        files.append(output)
        arguments.json = STANDARD
    for name, file in zip(names, sorted(files, key=list(argv).index), strict=False):
        setattr(arguments, name, file)


def _options(arguments: argparse.Namespace) -> list[str]:
    """The options of the command that was given."""
    names = [name for name in vars(arguments) if name not in POSITIONAL]
    return [f"--{name.replace('_', '-')}" for name in (*names, "help")]


def _names_a_file(word: str) -> bool:
    toml = word == STANDARD or word.lower().endswith(".toml")
    return word not in WANTS and (toml or os.path.isfile(word))


def parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    common: dict[str, Any] = {
        "allow_abbrev": False,
        "epilog": EXIT_CODES,
        "formatter_class": argparse.RawDescriptionHelpFormatter,
    }
    about = "Plane elastic contact: edges, pressure, gap and stress, and how exact they are."
    parser = _Parser(prog="sie", description=about, **common)
    parser.add_argument("--version", action="version", version=f"sie {__version__}")
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    commands = {
        name: subparsers.add_parser(name, help=about, description=about, **common)
        for name, about in COMMANDS.items()
    }
    for name in FILES:
        commands[name].add_argument(
            "scene", nargs="?", metavar="scene.toml", help="the scene file; - is standard input"
        )
        about = "say on standard error what is read, computed and written: info or debug"
        commands[name].add_argument("--log", metavar="LEVEL", choices=LEVELS, help=about)
    _add_options(commands)
    return parser


def _add_options(commands: Mapping[str, argparse.ArgumentParser]) -> None:
    """The options and words that some of the commands take."""
    for name in ("solve", "plan"):
        about = f"what to answer: {', '.join(WANTS)} ({', '.join(UNASKED)})"
        commands[name].add_argument(
            "--want", nargs="+", action="extend", metavar="WHAT", help=about
        )
    _add_outputs_of_solve(commands["solve"])
    _add_mesh_and_outputs(commands["compare"])
    for name in ("solve", "compare", "export-boundary"):
        about = "print no report, only what goes to standard output by -"
        commands[name].add_argument("--quiet", action="store_true", help=about)
    _add_boundary(commands["export-boundary"])
    about = "the port of the page (a free one)"
    commands["live"].add_argument("--port", metavar="N", type=_port, default=0, help=about)
    about = "print the page's address, and open no browser"
    commands["live"].add_argument("--no-browser", action="store_true", help=about)
    commands["example"].add_argument(
        "name", nargs="?", metavar="NAME", help="the kind of profile; without it, the list"
    )
    commands["benchmark-set"].add_argument(
        "folder", metavar="DIR", help="where to write them: a new or an empty directory"
    )
    commands["completion"].add_argument(
        "shell", metavar="SHELL", help="bash, zsh or tcsh, and what else shtab knows"
    )


def _add_outputs_of_solve(parser: argparse.ArgumentParser) -> None:
    def add(option: str, metavar: str, about: str, **given: Any) -> None:
        parser.add_argument(option, metavar=metavar, help=about, **given)

    plot = "draw pressure, gap and shear, or with --want stress its contours: .png ..."
    everything = "write all that is wanted; without FILE, print it"
    add("--plot", "FILE", f"{plot} (needs Matplotlib)")
    add("--csv", "FILE", "write x, pressure, gap, shear, slip, at every point of a load path")
    add("--json", "FILE", everything, nargs="?", const=STANDARD)
    add("--field", "FILE", "write the stress on a grid: .csv, .npz or .vti (ParaView)")
    add("--grid", "NXxNY", f"points of that grid ({GRID[0]}x{GRID[1]})", type=_grid)
    about = "points in the contact, about (%(default)s)"
    add("--points", "N", about, type=_points, default=POINTS)
    add("--tol", "T", "relative accuracy to certify (%(default)s)", type=float, default=TOL)


def _add_mesh_and_outputs(parser: argparse.ArgumentParser) -> None:
    def add(option: str, metavar: str, about: str, **given: Any) -> None:
        parser.add_argument(option, metavar=metavar, help=about, **given)

    formats = "CalculiX .frd, Ansys PRNSOL, Abaqus .rpt, what meshio reads, or a table of text"
    add("mesh", "fem.csv", f"a mesh result: {formats} with x and p, q, sxx, ...", nargs="?")
    add(
        "--nodes", "FILE", "coordinates of nodes that the result lacks: NLIST of Ansys, a deck, CSV"
    )
    about = "which columns hold what, by name or by number from 0: x=distance,p=load"
    add("--columns", "NAMES", about, type=_columns)
    add("--surface", "Y", "the height of the surface in the file (found)", type=_height)
    about = "the body that is compared, below or above it (below)"
    add("--body", "SIDE", about, type=_side)
    about = "l2 error, relative, that is let pass (%(default)s)"
    add("--tol", "T", about, type=float, default=MESH_TOL)
    add("--plot", "FILE", "draw both and their difference (needs Matplotlib)")
    norms = "write the norms; without FILE, print them"
    add("--json", "FILE", norms, nargs="?", const=STANDARD)


def _add_boundary(parser: argparse.ArgumentParser) -> None:
    def add(option: str, metavar: str, about: str, **given: Any) -> None:
        parser.add_argument(option, metavar=metavar, help=about, **given)

    add("--nodes", "FILE", "the mesh: a deck of Abaqus or CalculiX, or what meshio reads")
    add("--set", "NAME", "the node set on the boundary")
    about = "displacement or traction (as nodal forces) (%(default)s)"
    add("--kind", "KIND", about, choices=("displacement", "traction"), default="displacement")
    add("--surface", "Y", "the height of the surface in the mesh (0)", type=_height, default=0.0)
    about = "the body that the nodes belong to, below or above the surface (%(default)s)"
    add("--body", "SIDE", about, type=_side, default="below")
    add("--zero", "X,Y", "the point, in the axes of the mesh, that keeps its place", type=_place)
    add("--csv", "FILE", "write a table, too")


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
        height = float(text)
    except ValueError:
        height = math.nan
    if not math.isfinite(height):
        raise argparse.ArgumentTypeError(f"{text} is not a height: give y of the surface")
    return height


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


def _side(text: str) -> str:
    if text not in BODIES:
        raise argparse.ArgumentTypeError(f"{text} is not a side: give {' or '.join(BODIES)}")
    return text


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


def _points(text: str) -> int:
    try:
        points = int(text)
    except ValueError:
        points = 0
    if not 2 <= points <= MOST_POINTS:
        raise argparse.ArgumentTypeError(f"{text} is not a whole number from 2 to {MOST_POINTS}")
    return points


def _port(text: str) -> int:
    if not text.isdigit() or int(text) > MOST_PORTS:
        raise argparse.ArgumentTypeError(f"{text} is not a port from 0 to {MOST_PORTS}")
    return int(text)
