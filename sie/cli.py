"""The command line.

    sie solve scene.toml [--want ...] [--plot FILE] [--csv FILE] [--json [FILE]] [--field FILE] [--grid NXxNY] [--points N] [--tol T]
    sie compare scene.toml fem.csv [--tol T] [--plot FILE] [--json [FILE]]      a mesh result against the exact one: error norms, shift
    sie plan scene.toml [--want ...]          what would be computed, what would be skipped, and why
    sie example [NAME]                        a commented scene file to start from; without NAME, the list of them

`python -m sie` is the same. In place of a file, - is standard input (the scene) or standard output (--csv, --json).

Exit codes: 0 solved; 1 solved, but the certificate is not met, or the mesh result differs by more than --tol; 2 refused, with one sentence
on standard error and no file touched; 130 interrupted; 141 nobody reads the output any more (what was to be written to files is there).
No file that a scene or a command reads is ever written to.
"""

from __future__ import annotations

import argparse
import contextlib
import math
import os
import pathlib
import sys
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import combinations
from types import ModuleType
from typing import Any, NoReturn

from . import __version__, interrupt
from .errors import ContactError
from .history import follow
from .interrupt import INTERRUPTED
from .io import export, files, scene_file
from .io.mesh_comparison import Comparison, compare, read_mesh
from .io.report import summary
from .io.sample_points import POINTS
from .io.scene_file import SceneFile
from .io.stress_grid import SIZE, SUFFIXES, Grid, file_bytes
from .io.toml_values import nearest, told
from .plan import plan
from .problem.load_path import Path
from .problem.request import UNASKED, WANTS
from .solution import Solution, solve

CERTIFIED, NOT_CERTIFIED, REFUSED, UNREAD = 0, 1, 2, 141
COMMANDS = ("solve", "compare", "plan", "example")
OPTIONS = (
    "--want",
    "--plot",
    "--csv",
    "--json",
    "--field",
    "--grid",
    "--points",
    "--tol",
    "--help",
    "--version",
)
STANDARD = "-"
MOST_POINTS = 10**6
TOL = 1e-13
# Letters that are printed at once. Of what is not buffered, Python passes over an error in the midst of one piece.
PIECE = 4096
# For a terminal without block elements.
PLAIN = {
    ord(fancy): plain
    for fancy, plain in zip("▁▂▃▄▅▆▇█│└─↑∫", (*"..::--##|+-^", "int "), strict=True)
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code, and raises nothing for bad input."""
    try:
        interrupt.inside()
        return _run(sys.argv[1:] if argv is None else argv)
    except BrokenPipeError:
        _forget_output()
        return UNREAD
    except KeyboardInterrupt:
        return INTERRUPTED
    except (ValueError, ContactError, OSError) as problem:
        _forget_output()
        _complain(" ".join(told(_sentence(problem)).split()))
        return REFUSED
    except MemoryError:
        _forget_output()
        _complain("the memory does not suffice: ask for fewer points, or thin out what is read")
        return REFUSED
    finally:
        interrupt.outside()


def _run(argv: Sequence[str]) -> int:
    try:
        arguments = _arguments(argv)
        status: int = arguments.run(arguments)
    except SystemExit as done:  # --help and --version
        status = int(done.code or 0)
    if sys.stdout is not None:
        sys.stdout.flush()
    return status


# -- commands ----------------------------------------------------------------------------------------------------------


def _solve(arguments: argparse.Namespace) -> int:
    """Everything is checked, then everything is computed, then the files are written."""
    outputs = _outputs(arguments)
    if arguments.grid and not arguments.field:
        raise ValueError(
            "--grid says how many points --field writes: give --field FILE too, with one of the suffixes .csv, .npz, .vti"
        )
    file = _scene(arguments)
    _refuse_overwriting(arguments, outputs, file)
    solution = _solution(file, arguments.tol)
    contents = {
        path: _content(kind, path, solution, file, arguments) for kind, path in outputs.items()
    }
    shown = contents.pop(pathlib.Path(STANDARD), None)
    text = shown.decode() if shown is not None else _report(solution, file, contents)
    certified = "check" not in file.want or solution.check().ok
    _give(contents, text)
    if not certified:
        _complain(
            f"the certificate is not met to {solution.tol:.0e}: the answer is less accurate, see --want check"
        )
    return CERTIFIED if certified else NOT_CERTIFIED


def _solution(file: SceneFile, tol: float) -> Solution:
    """The solution of the scene, or of the last point of its path."""
    return (
        follow(file.scene, Path(file.path), tol=tol)[-1]
        if file.path
        else solve(file.scene, tol=tol)
    )


def _compare(arguments: argparse.Namespace) -> int:
    if arguments.mesh is None:
        raise ValueError(
            "give the mesh result after the scene: sie compare scene.toml fem.csv, with columns x and p"
        )
    if not 0.0 < arguments.tol < math.inf:
        raise ValueError(
            f"tol = {arguments.tol:g} is no positive number: give the l2 error that is let pass, relative"
        )
    outputs = _outputs(arguments)
    file = _scene(arguments)
    _refuse_overwriting(arguments, outputs, file)
    mesh = read_mesh(arguments.mesh)
    solution = _solution(file, TOL)
    found = compare(solution, mesh, arguments.tol)
    contents = {
        path: _compared(kind, path, solution, found, file) for kind, path in outputs.items()
    }
    shown = contents.pop(pathlib.Path(STANDARD), None)
    _give(
        contents,
        shown.decode()
        if shown is not None
        else "\n\n".join([str(found), *(f"wrote {path}" for path in contents)]) + "\n",
    )
    return CERTIFIED if found.ok else NOT_CERTIFIED


def _compared(
    kind: str, path: pathlib.Path, solution: Solution, found: Comparison, file: SceneFile
) -> bytes:
    if kind == "json":
        return export.strict_json(found.as_dict()).encode()
    return _drawn(lambda: _overlay(solution, found, file), path)


def _overlay(solution: Solution, found: Comparison, file: SceneFile) -> Any:
    from .plots.comparison_plot import overlay  # noqa: PLC0415

    return overlay(solution, found, file.units, file.title)


def _plan(arguments: argparse.Namespace) -> int:
    file = _scene(arguments)
    _solution(file, TOL)  # computes nothing, but refuses what is not covered
    _print(f"{plan(file.scene, file.want)}\n")
    return CERTIFIED


def _example(arguments: argparse.Namespace) -> int:
    if arguments.name is not None:
        _print(scene_file.example(arguments.name))
        return CERTIFIED
    titles = scene_file.examples()
    width = max(map(len, titles))
    lines = [f"{name:<{width}}  {title}" for name, title in titles.items()]
    _print("\n".join([*lines, "", "sie example NAME > scene.toml", ""]))
    return CERTIFIED


# -- what is asked for, each with the sentence that refuses it ---------------------------------------------------------


def _scene(arguments: argparse.Namespace) -> SceneFile:
    """The scene file, with --want in place of what the file wants."""
    want = scene_file.wants(
        "--want",
        [
            name
            for word in getattr(arguments, "want", None) or ()
            for name in word.split(",")
            if name
        ],
    )
    if arguments.scene is None:
        raise ValueError(
            f"give the scene file first: sie {arguments.command} scene.toml; `sie example` lists some to start from"
        )
    standard = arguments.scene == STANDARD
    file = (
        scene_file.parse(_standard_input(), "standard input")
        if standard
        else scene_file.read(arguments.scene)
    )
    return replace(file, want=want or export.wanted(file))


def _standard_input() -> bytes:
    if sys.stdin is None:
        raise ValueError("standard input is closed: give the scene a file")
    return sys.stdin.buffer.read(scene_file.MOST_BYTES + 1)


def _outputs(arguments: argparse.Namespace) -> dict[str, pathlib.Path]:
    """Where each kind of output goes. Raises ValueError unless all of them can be written."""
    given = ((kind, getattr(arguments, kind, None)) for kind in ("plot", "csv", "json", "field"))
    outputs = {kind: pathlib.Path(name) for kind, name in given if name is not None}
    if "plot" in outputs:
        _check_picture(outputs["plot"])
    if "field" in outputs and outputs["field"].suffix[1:].lower() not in SUFFIXES:
        path = outputs["field"]
        raise ValueError(
            f'--field {path} has the suffix "{path.suffix}": use .{", .".join(SUFFIXES)}'
        )
    for (first, path), (second, other) in combinations(outputs.items(), 2):
        if path == other == pathlib.Path(STANDARD):
            raise ValueError(
                "--csv and --json cannot both go to standard output: give one of them a file"
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
    """What the system knows the file by."""
    return 1 if path == pathlib.Path(STANDARD) else path


def _refuse_overwriting(
    arguments: argparse.Namespace, outputs: dict[str, pathlib.Path], file: SceneFile
) -> None:
    """ValueError if an output, or what is printed, would go into a file that is read."""
    scene = 0 if arguments.scene == STANDARD else pathlib.Path(arguments.scene)
    read: dict[int | pathlib.Path, str] = {scene: "the scene file"}
    if getattr(arguments, "mesh", None) is not None:
        read[pathlib.Path(arguments.mesh)] = "the mesh result"
    read |= dict.fromkeys(file.reads, "a trace that the scene reads")
    written = {f"--{kind} {path}": _place(path) for kind, path in outputs.items()} | {
        "standard output": 1
    }
    for place, what in read.items():
        for name, target in written.items():
            if os.path.isfile(place) and files.same(target, place):
                raise ValueError(f"{name} would overwrite {what}: give another name")


def _check_picture(path: pathlib.Path) -> None:
    known = _pictures().suffixes()
    if path.suffix[1:].lower() not in known:
        raise ValueError(
            f'--plot {path} has the suffix "{path.suffix}", which Matplotlib does not write: use .{", .".join(known)}'
        )


def _pictures() -> ModuleType:
    """The module that draws a contact; nothing else needs Matplotlib."""
    try:
        from .plots import contact_plot  # noqa: PLC0415
    except ImportError:
        raise ValueError('--plot needs Matplotlib: pip install "plane-contact[plot]"') from None
    return contact_plot


# -- what is given back ------------------------------------------------------------------------------------------------


def _content(
    kind: str,
    path: pathlib.Path,
    solution: Solution,
    file: SceneFile,
    arguments: argparse.Namespace,
) -> bytes:
    if kind == "csv":
        return export.csv_text(solution, file, arguments.points).encode()
    if kind == "json":
        return export.json_text(solution, file, arguments.points).encode()
    if kind == "field":
        units, (x1, x2) = file.units, solution.edges
        head = (f"{file.title or 'plane contact'} (sie {__version__})", repr(solution.scene), f"lengths in {units.length}, "
                f"stresses in {units.stress}, j2 in its square", f"contact from x1 = {x1!r} to x2 = {x2!r}")  # fmt: skip
        return file_bytes(Grid(solution, *(arguments.grid or SIZE)), path.suffix[1:].lower(), head)
    return _drawn(lambda: _figure(solution, file), path)


def _drawn(make: Callable[[], Any], path: pathlib.Path) -> bytes:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # letters of a title that no font has are drawn as boxes
        data: bytes = _pictures().picture_bytes(make(), path.suffix[1:].lower())
    return data


def _figure(solution: Solution, file: SceneFile) -> Any:
    """The contact, or where the stress is wanted its contours."""
    if {"stress", "yield"} & set(file.want):
        from .plots.stress_plot import contours  # noqa: PLC0415

        return contours(solution, file.units, file.title)
    return _pictures().picture(solution, file.units, file.title)


def _report(solution: Solution, file: SceneFile, written: Iterable[pathlib.Path]) -> str:
    paragraphs = [summary(solution, file), "\n".join(f"wrote {path}" for path in written)]
    return "\n\n".join(p for p in paragraphs if p) + "\n"


def _complain(sentence: str) -> None:
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            print("sie:", sentence, file=sys.stderr, flush=True)


def _print(text: str) -> None:
    if sys.stdout is None:
        raise OSError("standard output is closed: send it to a file, or to the null device")
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        text = text.translate(PLAIN).encode(encoding, "replace").decode(encoding)
    for start in range(0, len(text), PIECE):
        print(text[start : start + PIECE], end="")
    sys.stdout.flush()


def _give(contents: dict[pathlib.Path, bytes], text: str) -> None:
    """Write the files and print the text: both, or neither."""
    with files.writing(contents):
        _print(text)


def _sentence(problem: Exception) -> str:
    if isinstance(problem, OSError) and problem.strerror:
        return f"{problem.filename or 'standard output'}: {problem.strerror}"
    return str(problem)


def _forget_output() -> None:
    """Lets go of an output that cannot be written to (a closed pipe, a full disk): Python would complain about it when it ends."""
    try:
        sys.stdout.flush()
    except (OSError, ValueError, AttributeError):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


# -- the parser --------------------------------------------------------------------------------------------------------


class _Parser(argparse.ArgumentParser):
    """argparse, but a mistake raises ValueError instead of an exit, and help that cannot be printed OSError."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(f"{message}; `{self.prog} --help` explains")

    def _print_message(self, message: str, file: Any = None) -> None:
        _print(message)


def _arguments(argv: Sequence[str]) -> argparse.Namespace:
    if argv and not argv[0].startswith("-") and argv[0] not in COMMANDS:
        near = nearest(argv[0], COMMANDS)
        remedy = (
            f"did you mean {near}?" if near else f"say what to do with it, like sie solve {argv[0]}"
        )
        raise ValueError(f'there is no command "{argv[0]}": {remedy}')
    found, unknown = _parser().parse_known_args(argv)
    if unknown:
        near = nearest(unknown[0], OPTIONS)
        remedy = f"did you mean {near}?" if near else f"`sie {found.command} --help` explains"
        raise ValueError(f'"{unknown[0]}" is not understood: {remedy}')
    words = getattr(found, "want", None) or []
    if len(words) > 1 and found.scene is None and _names_a_scene(words[-1]):
        found.scene = words.pop()  # --want takes all words that follow it, a scene after them too
    return found


def _names_a_scene(word: str) -> bool:
    return word not in WANTS and (
        word == STANDARD or word.lower().endswith(".toml") or os.path.isfile(word)
    )


def _parser() -> argparse.ArgumentParser:
    about = "Plane elastic contact: edges, pressure, gap and stress, with a certificate of their accuracy."
    parser = _Parser(prog="sie", description=about, allow_abbrev=False)
    parser.add_argument("--version", action="version", version=f"sie {__version__}")
    commands = parser.add_subparsers(
        dest="command", required=True, metavar="{solve,compare,plan,example}"
    )
    solving = commands.add_parser(
        "solve", help="solve a scene and print, draw or write the answer", allow_abbrev=False
    )
    comparing = commands.add_parser(
        "compare",
        help="a mesh result against the exact one: error norms, best shift, a picture",
        allow_abbrev=False,
    )
    planning = commands.add_parser(
        "plan", help="what would be computed, what would be skipped, and why", allow_abbrev=False
    )
    showing = commands.add_parser(
        "example", help="print a commented scene file to start from", allow_abbrev=False
    )
    for command in (solving, comparing, planning):
        command.add_argument(
            "scene", nargs="?", metavar="scene.toml", help="the scene file; - is standard input"
        )
    for command in (solving, planning):
        command.add_argument(
            "--want",
            nargs="+",
            metavar="WHAT",
            help=f"what to answer: {', '.join(WANTS)} ({', '.join(UNASKED)})",
        )
    solving.add_argument(
        "--plot",
        metavar="FILE",
        help="draw pressure, gap and shear, or with --want stress its contours: .png ... (needs Matplotlib)",
    )
    solving.add_argument("--csv", metavar="FILE", help="write x, pressure, gap, shear, slip")
    solving.add_argument(
        "--json",
        metavar="FILE",
        nargs="?",
        const=STANDARD,
        help="write all that is wanted; without FILE, print it",
    )
    solving.add_argument(
        "--field", metavar="FILE", help="write the stress on a grid: .csv, .npz or .vti (ParaView)"
    )
    solving.add_argument(
        "--grid", metavar="NXxNY", type=_grid, help=f"points of that grid ({SIZE[0]}x{SIZE[1]})"
    )
    solving.add_argument(
        "--points",
        metavar="N",
        type=_points,
        default=POINTS,
        help="points in the contact, about (%(default)s)",
    )
    solving.add_argument(
        "--tol",
        metavar="T",
        type=float,
        default=TOL,
        help="relative accuracy to certify (%(default)s)",
    )
    comparing.add_argument(
        "mesh",
        nargs="?",
        metavar="fem.csv",
        help="columns x, depth y, and p, q, sxx, syy, sxy, szz or mises, named in the first line",
    )
    comparing.add_argument(
        "--tol",
        metavar="T",
        type=float,
        default=1e-2,
        help="l2 error, relative, that is let pass (%(default)s)",
    )
    comparing.add_argument(
        "--plot", metavar="FILE", help="draw both and their difference (needs Matplotlib)"
    )
    comparing.add_argument(
        "--json",
        metavar="FILE",
        nargs="?",
        const=STANDARD,
        help="write the norms; without FILE, print them",
    )
    showing.add_argument(
        "name", nargs="?", metavar="NAME", help="the kind of profile; without it, the list"
    )
    for command, run in (
        (solving, _solve),
        (comparing, _compare),
        (planning, _plan),
        (showing, _example),
    ):
        command.set_defaults(run=run)
    return parser


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
