"""The commands and options of `sie`, and the message for each mistake."""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Sequence
from typing import Any, NoReturn

from . import __version__
from .io.mesh_result import BODIES
from .messages import nearest
from .problem.request import GRID, POINTS, UNASKED, WANTS
from .streams import print_text

COMMANDS = {
    "solve": "solve a scene and print, draw or write the answer",
    "compare": "a mesh result against the exact one: error norms, best shift, a picture",
    "plan": "what would be computed, what would be skipped, and why",
    "example": "print a commented scene file to start from",
}
OPTIONS = (
    "--want", "--plot", "--csv", "--history", "--json", "--field", "--grid", "--points", "--tol",
    "--deck", "--surface", "--body", "--help", "--version",
)  # fmt: skip
STANDARD = "-"
MOST_POINTS = 10**6
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
    arguments, unknown = _parser().parse_known_args(argv)
    if unknown:
        near = nearest(unknown[0], OPTIONS)
        remedy = f"did you mean {near}?" if near else f"`sie {arguments.command} --help` explains"
        raise ValueError(f'"{unknown[0]}" is not understood: {remedy}')
    words = getattr(arguments, "want", None) or []
    if len(words) > 1 and arguments.scene is None and _names_a_scene(words[-1]):
        arguments.scene = words.pop()  # --want takes all words that follow it, a scene too
    return arguments


def _names_a_scene(word: str) -> bool:
    return word not in WANTS and (
        word == STANDARD or word.lower().endswith(".toml") or os.path.isfile(word)
    )


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="sie",
        description="Plane elastic contact: edges, pressure, gap and stress, "
        "with a certificate of their accuracy.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"sie {__version__}")
    metavar = "{" + ",".join(COMMANDS) + "}"
    subparsers = parser.add_subparsers(dest="command", required=True, metavar=metavar)
    commands = {
        name: subparsers.add_parser(name, help=about, allow_abbrev=False)
        for name, about in COMMANDS.items()
    }
    for name in ("solve", "compare", "plan"):
        commands[name].add_argument(
            "scene", nargs="?", metavar="scene.toml", help="the scene file; - is standard input"
        )
    for name in ("solve", "plan"):
        about = f"what to answer: {', '.join(WANTS)} ({', '.join(UNASKED)})"
        commands[name].add_argument("--want", nargs="+", metavar="WHAT", help=about)
    _add_outputs_of_solve(commands["solve"])
    _add_mesh_and_outputs(commands["compare"])
    commands["example"].add_argument(
        "name", nargs="?", metavar="NAME", help="the kind of profile; without it, the list"
    )
    return parser


def _add_outputs_of_solve(parser: argparse.ArgumentParser) -> None:
    def add(option: str, metavar: str, about: str, **given: Any) -> None:
        parser.add_argument(option, metavar=metavar, help=about, **given)

    plot = "draw pressure, gap and shear, or with --want stress its contours: .png ..."
    everything = "write all that is wanted; without FILE, print it"
    add("--plot", "FILE", f"{plot} (needs Matplotlib)")
    add("--csv", "FILE", "write x, pressure, gap, shear, slip")
    add("--history", "FILE", "write the same at every turning point of a load path")
    add("--json", "FILE", everything, nargs="?", const=STANDARD)
    add("--field", "FILE", "write the stress on a grid: .csv, .npz or .vti (ParaView)")
    add("--grid", "NXxNY", f"points of that grid ({GRID[0]}x{GRID[1]})", type=_grid)
    about = "points in the contact, about (%(default)s)"
    add("--points", "N", about, type=_points, default=POINTS)
    add("--tol", "T", "relative accuracy to certify (%(default)s)", type=float, default=TOL)


def _add_mesh_and_outputs(parser: argparse.ArgumentParser) -> None:
    def add(option: str, metavar: str, about: str, **given: Any) -> None:
        parser.add_argument(option, metavar=metavar, help=about, **given)

    formats = "CalculiX .frd and .dat, Abaqus .rpt, what meshio reads, or a table of text"
    add("mesh", "fem.csv", f"a mesh result: {formats} with x and p, q, sxx, ...", nargs="?")
    add("--deck", "FILE", "the input deck (.inp) with the coordinates that a .dat or .rpt lacks")
    add("--surface", "Y", "the height of the surface in the file (found)", type=_height)
    about = "the body that is compared, below or above it (below)"
    add("--body", "SIDE", about, type=_side)
    about = "l2 error, relative, that is let pass (%(default)s)"
    add("--tol", "T", about, type=float, default=MESH_TOL)
    add("--plot", "FILE", "draw both and their difference (needs Matplotlib)")
    norms = "write the norms; without FILE, print them"
    add("--json", "FILE", norms, nargs="?", const=STANDARD)


def _height(text: str) -> float:
    try:
        height = float(text)
    except ValueError:
        height = math.nan
    if not math.isfinite(height):
        raise argparse.ArgumentTypeError(f"{text} is not a height: give y of the surface")
    return height


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
