"""The command line; `sie --help` lists the commands, `sie COMMAND --help` the options of one.

`python -m sie` is the same. In place of a file, - is standard input (the scene) or standard output
(--csv, --json). No file that a scene or a command reads is written to. The exit codes are those of
`parser.EXIT_CODES`.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Iterable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from sie import files
from sie.arguments import WIDE, with_short_words
from sie.errors import ContactError
from sie.io import scene_file
from sie.io.scene_file import SceneFile
from sie.problem.coverage import refuse_unknown_poisson
from sie.problem.request import GRID
from sie.progress_bar import Progress
from sie.solution import Solution, solve

from .parser import STANDARD, TOL, parse
from .requests import outputs_of, picture_style, refuse_overwriting, scene_of
from .streams import broken, discard_output, print_error, print_text, terminal_width

CERTIFIED, NOT_CERTIFIED, REFUSED, INTERRUPTED, UNREAD = 0, 1, 2, 130, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code, and raises nothing for bad input."""
    try:
        arguments = parse(sys.argv[1:] if argv is None else argv)
        return COMMANDS[arguments.command](arguments)
    except SystemExit as done:  # --help and --version
        return int(done.code or 0)
    except BrokenPipeError:
        discard_output()
        return UNREAD
    except KeyboardInterrupt as stopped:
        return _ended(str(stopped) or "interrupted by Ctrl-C", INTERRUPTED)
    except (ValueError, ContactError, OSError) as problem:
        return _ended(with_short_words(_sentence(problem)), REFUSED)
    except MemoryError:
        return _ended(
            "the memory does not suffice: ask for fewer points, or thin out what is read", REFUSED
        )


def _ended(sentence: str, status: int) -> int:
    discard_output()
    print_error(" ".join(sentence.split()))
    return status


def _sentence(problem: Exception) -> str:
    if isinstance(problem, OSError) and problem.strerror:
        return f"{problem.filename or 'standard output'}: {problem.strerror}"
    return str(problem)


# -- commands ------------------------------------------------------------------------------------


def _solve(arguments: argparse.Namespace) -> int:
    """Check all requests, then compute all answers, then write the files."""
    outputs, file = _asked(arguments)
    if arguments.grid and not arguments.field:
        raise ValueError(
            "--grid is the number of points that --field writes: give --field FILE too"
        )
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
        certified = "check" not in file.want or solution.check().ok
        _give(arguments, contents, lambda: _report(solution, file, more))
    if not certified:
        print_error(
            f"the certificate is not met to {solution.tol:.0e}: "
            "the answer is less accurate, see --want check"
        )
    return CERTIFIED if certified else NOT_CERTIFIED


def _compare(arguments: argparse.Namespace) -> int:
    from sie.io.export import strict_json
    from sie.io.mesh_comparison import compare
    from sie.io.mesh_result import read_mesh

    if not 0.0 < arguments.tol < math.inf:
        raise ValueError(
            f"tol = {arguments.tol:g} is no positive number: "
            "give the l2 error that is let pass, relative"
        )
    outputs, file = _asked(arguments)
    names = arguments.nodes, arguments.surface, arguments.body or "", arguments.columns
    with _progress(arguments):
        mesh = read_mesh(arguments.mesh, *names)
        solution = _solution(file, TOL)
        found = compare(solution, mesh, arguments.tol)
        contents = {}
        if "json" in outputs:
            contents[outputs["json"]] = strict_json(found.as_dict()).encode()
        if "plot" in outputs:
            from sie.plots.comparison_plot import overlay

            figure = overlay(solution, found, file.units, file.title)
            contents[outputs["plot"]] = _bytes(figure, outputs["plot"])
    _give(arguments, contents, lambda: str(found))
    return CERTIFIED if found.ok else NOT_CERTIFIED


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

    scene, units = (file.scene, file.units) if file else (None, None)
    serve(scene, arguments.port, announce, units)
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
    from sie.io.mesh_files.node_lists import nodes_of_set

    outputs, file = _asked(arguments)
    labels, mesh = nodes_of_set(arguments.nodes, arguments.set)
    points = mesh.in_axes_of_depth(labels.tolist(), arguments.surface)
    zero = arguments.zero and (arguments.zero[0], arguments.surface - arguments.zero[1])
    body = "body" if arguments.body == "below" else "indenter"
    with _progress(arguments):
        data = _solution(file, TOL).boundary_data(
            points, kind=arguments.kind, body=body, labels=labels, zero=zero
        )
    contents = {path: data.csv().encode() for path in outputs.values()}
    _give(arguments, contents, data.keywords)
    return CERTIFIED


def _benchmark_set(arguments: argparse.Namespace) -> int:
    """Write the set into a new or an empty folder: all of its files, or none."""
    from sie.io.benchmark_set import benchmark_set

    folder = files.empty_folder(arguments.folder)
    contents = {folder / name: data for name, data in benchmark_set(_solution).items()}
    for path in contents:
        path.parent.mkdir(parents=True, exist_ok=True)
    with files.writing(contents):
        print_text(f"wrote {len(contents)} files, see {folder / 'README.md'}\n")
    return CERTIFIED


def _schema(_arguments: argparse.Namespace) -> int:
    from sie.io.scene_schema import schema_text

    print_text(schema_text())
    return CERTIFIED


COMMANDS: dict[str, Callable[[argparse.Namespace], int]] = {
    "solve": _solve,
    "compare": _compare,
    "plan": _plan,
    "live": _live,
    "example": _example,
    "export-boundary": _export_boundary,
    "benchmark-set": _benchmark_set,
    "schema": _schema,
}


# -- what is asked for -----------------------------------------------------------------------------


def _asked(arguments: argparse.Namespace) -> tuple[dict[str, Path], SceneFile]:
    """The files that are written, by kind, and the scene; none of them is a file that is read."""
    outputs = outputs_of(arguments)
    file = scene_of(arguments)
    refuse_overwriting(arguments, outputs, file)
    return outputs, file


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


def _progress(arguments: argparse.Namespace) -> Progress:
    return Progress(f"sie {arguments.command}", shown=not arguments.quiet)


def _solution(file: SceneFile, tol: float = TOL) -> Solution:
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
        from sie.io.cycle_answer import crack_answer

        out["crack"] = crack_answer(solution, file)
    return out


# -- output --------------------------------------------------------------------------------------


def _content(
    kind: str,
    path: Path,
    solution: Solution,
    file: SceneFile,
    arguments: argparse.Namespace,
    *,
    more: dict[str, Any],
) -> bytes:
    """The content of a file that `sie solve` writes."""
    if kind == "plot":
        return _bytes(_picture(solution, file), path)
    from sie.io import export

    if kind == "field":
        return export.grid_csv(solution, file, *(arguments.grid or GRID)).encode()
    if kind == "csv":
        return export.csv_text(solution, file, arguments.points).encode()
    return export.json_text(solution, file, arguments.points, more).encode()


def _picture(solution: Solution, file: SceneFile) -> Any:
    """The picture of the contact; contours of the stress if that is wanted."""
    if {"stress", "yield"} & set(file.want):
        from sie.plots.stress_plot import contours

        return contours(solution, file.units, file.title)
    from sie.plots.contact_plot import picture

    return picture(solution, file.units, file.title)


def _bytes(figure: Any, path: Path) -> bytes:
    content: bytes = picture_style().picture_bytes(figure, path.suffix[1:].lower())
    return content


def _report(solution: Solution, file: SceneFile, more: dict[str, Any]) -> str:
    from sie.io.report import summary

    return summary(solution, file, more, terminal_width())


def _give(
    arguments: argparse.Namespace, contents: dict[Path, bytes], report: Callable[[], str]
) -> None:
    """Write the files, and print the report or what goes to standard output: both, or neither."""
    written = dict(contents)
    shown = written.pop(Path(STANDARD), None)
    text = shown.decode() if shown is not None else ""
    if shown is None and not arguments.quiet:
        text = report()
        if arguments.command != "export-boundary":
            text = _fitted([text, "\n".join(f"wrote {path}" for path in written)])
    with files.writing(written):
        print_text(text)


def _fitted(paragraphs: Iterable[str]) -> str:
    """The paragraphs of a report, in lines of 80 columns, or as many as a wider terminal has."""
    text = "\n\n".join(paragraph for paragraph in paragraphs if paragraph)
    return broken(text, max(WIDE, terminal_width())) + "\n"
