"""The command line.

    sie solve scene.toml            solve a scene, and print, draw or write the answer
        [--want WHAT ...] [--plot FILE] [--csv FILE] [--json [FILE]]
        [--field FILE] [--grid NXxNY] [--points N] [--tol T] [--quiet] [--log LEVEL]
    sie compare scene.toml fem.csv  a mesh result against the exact one: error norms, shift
        [--nodes FILE] [--columns NAMES] [--surface Y] [--body SIDE] [--tol T]
        [--plot FILE] [--json [FILE]]
    sie plan scene.toml             what would be computed, what would be skipped, and why
        [--want WHAT ...]
    sie live [scene.toml]           a page with sliders, served on this machine
        [--port N] [--no-browser]
    sie example [NAME]              a commented scene file; without NAME, the list of them
    sie export-boundary scene.toml --nodes deck.inp --set NAME     lines for the deck: exact
        [--kind KIND] [--surface Y]      displacements or forces on the boundary of a mesh
        [--body SIDE] [--zero X,Y] [--csv FILE]
    sie benchmark-set DIR           contacts with exact references, to measure other codes by
    sie schema                      the JSON Schema of scene files, for editors
    sie completion bash             a script by which the shell completes commands (needs shtab)

`python -m sie` is the same. In place of a file, - is standard input (the scene) or standard output
(--csv, --json). No file that a scene or a command reads is written to. The exit codes
are those of `command_parser.EXIT_CODES`.
"""

from __future__ import annotations

import argparse
import math
import pathlib
import sys
from collections.abc import Iterable, Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from sie import __version__, files, interrupt
from sie.arguments import WIDE, with_short_words
from sie.errors import ContactError
from sie.interrupt import INTERRUPTED, SENTENCE
from sie.io import scene_file
from sie.io.scene_file import SceneFile
from sie.problem.request import GRID, refuse_unknown_poisson
from sie.progress_bar import Progress
from sie.solution import Solution, solve
from sie.stages import LOG

from .parser import STANDARD, TOL, parse
from .requests import outputs_of, picture_style, refuse_overwriting, scene_of
from .streams import (
    broken,
    discard_output,
    logged,
    print_error,
    print_text,
    terminal_width,
)

if TYPE_CHECKING:  # a command imports what it does when it runs
    from sie.io.mesh_difference import Comparison

CERTIFIED, NOT_CERTIFIED, REFUSED, UNREAD = 0, 1, 2, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code, and raises nothing for bad input."""
    try:
        interrupt.inside()
        return _run(sys.argv[1:] if argv is None else argv)
    except BrokenPipeError:
        discard_output()
        return UNREAD
    except KeyboardInterrupt as stopped:
        discard_output()
        print_error(str(stopped) or SENTENCE)
        return INTERRUPTED
    except (ValueError, ContactError, OSError) as problem:
        discard_output()
        print_error(" ".join(with_short_words(_sentence(problem)).split()))
        return REFUSED
    except MemoryError:
        discard_output()
        print_error("the memory does not suffice: ask for fewer points, or thin out what is read")
        return REFUSED
    finally:
        interrupt.outside()


def _run(argv: Sequence[str]) -> int:
    try:
        arguments = parse(argv)
        with logged(getattr(arguments, "log", None)):
            status = COMMANDS[arguments.command](arguments)
    except SystemExit as done:  # --help and --version
        status = int(done.code or 0)
    if sys.stdout is not None:
        sys.stdout.flush()
    return status


# -- commands ------------------------------------------------------------------------------------


def _solve(arguments: argparse.Namespace) -> int:
    """Check all requests, then compute all answers, then write the files."""
    outputs = outputs_of(arguments)
    if arguments.grid and not arguments.field:
        raise ValueError(
            "--grid is the number of points that --field writes: "
            "give --field FILE too, with one of the suffixes .csv, .npz, .vti"
        )
    file = scene_of(arguments)
    refuse_overwriting(arguments, outputs, file)
    _refuse_lacking(file)
    if "yield" in file.want or "field" in outputs:
        refuse_unknown_poisson(file.scene)
    with _progress(arguments):
        solution = _solution(file, arguments.tol)
        more = _more(solution, file)
        contents = {
            path: _content(kind, path, solution, file, arguments, more=more)
            for kind, path in outputs.items()
        }
        shown = contents.pop(pathlib.Path(STANDARD), None)
        text = shown.decode() if shown is not None else _report(solution, file, contents, more)
        certified = "check" not in file.want or solution.check().ok
    _give(contents, "" if arguments.quiet and shown is None else text)
    if not certified:
        print_error(
            f"the certificate is not met to {solution.tol:.0e}: "
            "the answer is less accurate, see --want check"
        )
    return CERTIFIED if certified else NOT_CERTIFIED


def _solution(file: SceneFile, tol: float) -> Solution:
    """The solution of the scene, or of the last point of its path."""
    if not file.load_path:
        return solve(file.scene, tol=tol)
    from sie.paths.history import follow

    return follow(file.scene, file.load_path, tol=tol)[-1]


def _more(solution: Solution, file: SceneFile) -> dict[str, Any]:
    """The answers that belong to a path or to a crack, by name."""
    out = {}
    if "cycle" in file.want:
        from sie.io.cycle_answer import cycle_of

        out["cycle"] = cycle_of(solution, file)
    if "crack" in file.want:
        from sie.io.crack_table import crack_answer

        out["crack"] = crack_answer(solution, file)
    return out


def _progress(arguments: argparse.Namespace) -> Progress:
    """The bar of a command, if neither --quiet nor --log asks for something else."""
    return Progress(f"sie {arguments.command}", shown=not (arguments.quiet or arguments.log))


def _compare(arguments: argparse.Namespace) -> int:
    from sie.io.mesh_comparison import compare
    from sie.io.mesh_result import read_mesh

    if arguments.mesh is None:
        raise ValueError(
            "give the mesh result after the scene: "
            "sie compare scene.toml fem.csv, with columns x and p"
        )
    if not 0.0 < arguments.tol < math.inf:
        raise ValueError(
            f"tol = {arguments.tol:g} is no positive number: "
            "give the l2 error that is let pass, relative"
        )
    outputs = outputs_of(arguments)
    file = scene_of(arguments)
    refuse_overwriting(arguments, outputs, file)
    with _progress(arguments):
        mesh = read_mesh(
            arguments.mesh,
            arguments.nodes,
            arguments.surface,
            arguments.body or "",
            arguments.columns,
        )
        solution = _solution(file, TOL)
        comparison = compare(solution, mesh, arguments.tol)
        contents = {
            path: _compared(kind, path, solution, comparison, file)
            for kind, path in outputs.items()
        }
    shown = contents.pop(pathlib.Path(STANDARD), None)
    paragraphs = [str(comparison), *(f"wrote {path}" for path in contents)]
    report = "" if arguments.quiet else _fitted(paragraphs)
    _give(contents, report if shown is None else shown.decode())
    return CERTIFIED if comparison.ok else NOT_CERTIFIED


def _compared(
    kind: str, path: pathlib.Path, solution: Solution, comparison: Comparison, file: SceneFile
) -> bytes:
    if kind == "json":
        from sie.io import export

        return export.strict_json(comparison.as_dict()).encode()
    from sie.plots.comparison_plot import overlay

    figure = overlay(solution, comparison, file.units, file.title)
    return picture_style().picture_bytes(figure, path.suffix[1:].lower())


def _plan(arguments: argparse.Namespace) -> int:
    file = scene_of(arguments)
    _refuse_lacking(file)
    _solution(file, TOL)  # computes nothing, but refuses a scene that is not covered
    from sie.planning import plan

    print_text(f"{broken(str(plan(file.scene, file.want)), terminal_width())}\n")
    return CERTIFIED


def _live(arguments: argparse.Namespace) -> int:
    """Serve the page until Ctrl-C."""
    file = scene_of(arguments) if arguments.scene is not None else None
    if file is not None and file.load_path:
        raise ValueError("the scene has a load path, which no slider shows: leave [load] path out")
    if find_spec("bokeh") is None:
        raise ValueError('the live page is drawn by Bokeh: pip install "plane-contact[live]"')
    # They take a second, and only this command needs them.
    import webbrowser

    from sie.live.server import serve

    def announce(address: str) -> None:
        print_text(f"{address}  (Ctrl-C ends it)\n")
        if not arguments.no_browser:
            webbrowser.open(address)

    if file is None:
        serve(None, arguments.port, announce)
    else:
        serve(file.scene, arguments.port, announce, file.units)
    return CERTIFIED


def _example(arguments: argparse.Namespace) -> int:
    if arguments.name is not None:
        print_text(scene_file.example(arguments.name))
        return CERTIFIED
    titles = scene_file.examples()
    width = max(map(len, titles))
    lines = [f"{name:<{width}}  {title}" for name, title in titles.items()]
    print_text("\n".join([*lines, "", "sie example NAME > scene.toml", ""]))
    return CERTIFIED


def _export_boundary(arguments: argparse.Namespace) -> int:
    """Print the lines that give the nodes of a set the exact displacements or forces."""
    if arguments.nodes is None or arguments.set is None:
        raise ValueError(
            "give the mesh and its node set: sie export-boundary scene.toml --nodes deck.inp "
            "--set OUTER"
        )
    from sie.io.mesh_files.node_sets import nodes_of_set

    outputs = outputs_of(arguments)
    file = scene_of(arguments)
    refuse_overwriting(arguments, outputs, file)
    labels, mesh = nodes_of_set(arguments.nodes, arguments.set)
    points = mesh.in_axes_of_depth(labels.tolist(), arguments.surface)
    zero = arguments.zero and (arguments.zero[0], arguments.surface - arguments.zero[1])
    with _progress(arguments):
        data = _solution(file, TOL).boundary_data(
            points,
            kind=arguments.kind,
            body="body" if arguments.body == "below" else "indenter",
            labels=labels,
            zero=zero,
        )
        contents = {path: data.csv().encode() for path in outputs.values()}
    shown = contents.pop(pathlib.Path(STANDARD), None)
    lines = data.keywords() if shown is None else shown.decode()
    _give(contents, "" if arguments.quiet and shown is None else lines)
    return CERTIFIED


def _benchmark_set(arguments: argparse.Namespace) -> int:
    """Write the set into a new or an empty folder: all of its files, or none."""
    from sie.io.benchmark_set import benchmark_set

    folder = files.empty_folder(arguments.folder)
    contents = {folder / name: data for name, data in benchmark_set().items()}
    with files.making_folders({path.parent for path in contents} | {folder}):
        _give(contents, f"wrote {len(contents)} files, see {folder / 'README.md'}\n")
    return CERTIFIED


def _schema(_arguments: argparse.Namespace) -> int:
    from sie.io.scene_schema import schema_text

    print_text(schema_text())
    return CERTIFIED


def _completion(arguments: argparse.Namespace) -> int:
    from .completion import script

    print_text(script(arguments.shell))
    return CERTIFIED


COMMANDS = {
    "solve": _solve,
    "compare": _compare,
    "plan": _plan,
    "live": _live,
    "example": _example,
    "export-boundary": _export_boundary,
    "benchmark-set": _benchmark_set,
    "schema": _schema,
    "completion": _completion,
}


def _refuse_lacking(file: SceneFile) -> None:
    """ValueError if a cycle is wanted of a path that does not close, or a crack of no table."""
    if "cycle" in file.want:
        from sie.io.cycle_answer import start_of_cycle

        start_of_cycle(file.load_path)
    if "crack" in file.want and file.crack is None:
        raise ValueError(
            "--want crack needs the table [crack], and the scene has none: give [crack] with at = "
            '"trailing edge" and depths = [0.01, 0.1]'
        )


# -- output --------------------------------------------------------------------------------------


def _content(
    kind: str,
    path: pathlib.Path,
    solution: Solution,
    file: SceneFile,
    arguments: argparse.Namespace,
    *,
    more: dict[str, Any],
) -> bytes:
    if kind == "field":
        from sie.io.stress_grid import Grid, file_bytes

        units, (x1, x2) = file.units, solution.edges
        head = (
            f"{file.title or 'plane contact'} (sie {__version__})",
            repr(solution.scene),
            f"lengths in {units.length}, stresses in {units.stress}, j2 in its square",
            f"contact from x1 = {x1!r} to x2 = {x2!r}",
        )
        return file_bytes(Grid(solution, *(arguments.grid or GRID)), path.suffix[1:].lower(), head)
    if kind in ("csv", "json"):
        from sie.io import export
    if kind == "csv":
        return export.csv_text(solution, file, arguments.points).encode()
    if kind == "json":
        return export.json_text(solution, file, arguments.points, more).encode()
    return _picture(solution, file, path.suffix[1:].lower())


def _picture(solution: Solution, file: SceneFile, suffix: str) -> bytes:
    """The picture of the contact; contours of the stress if that is wanted."""
    if {"stress", "yield"} & set(file.want):
        from sie.plots.stress_plot import contours

        return picture_style().picture_bytes(contours(solution, file.units, file.title), suffix)
    from sie.plots.contact_plot import picture

    return picture_style().picture_bytes(picture(solution, file.units, file.title), suffix)


def _report(
    solution: Solution,
    file: SceneFile,
    written: Iterable[pathlib.Path],
    more: dict[str, Any],
) -> str:
    from sie.io.report import summary

    paragraphs = [
        summary(solution, file, more, terminal_width()),
        "\n".join(f"wrote {path}" for path in written),
    ]
    return _fitted(paragraphs)


def _fitted(paragraphs: Iterable[str]) -> str:
    """The paragraphs of a report, in lines of 80 columns, or as many as a wider terminal has."""
    text = "\n\n".join(paragraph for paragraph in paragraphs if paragraph)
    return broken(text, max(WIDE, terminal_width())) + "\n"


def _give(contents: dict[pathlib.Path, bytes], text: str) -> None:
    """Write the files and print the text: both, or neither."""
    with files.writing(contents):
        print_text(text)
    for path, data in contents.items():
        LOG.info("wrote %s: %d bytes", path, len(data))


def _sentence(problem: Exception) -> str:
    if isinstance(problem, OSError) and problem.strerror:
        return f"{problem.filename or 'standard output'}: {problem.strerror}"
    return str(problem)
