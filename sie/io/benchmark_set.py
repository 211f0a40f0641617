"""Contacts with exact references, by which other codes are measured.

The folder `sie/benchmark_set` has a scene file for each case, and a README that describes the set.
The references are computed when the set is asked for, with all digits of a double.

>>> case_names()
('cattaneo', 'hertz', 'rounded-flat', 'spence', 'two-parabolas')
"""

from __future__ import annotations

from importlib import resources

from sie import __version__
from sie.progress_bar import counted
from sie.solution import Solution, solve

from .export import csv_text, json_text
from .sample_points import peak
from .scene_file import parse

SET = resources.files("sie") / "benchmark_set"


def case_names() -> tuple[str, ...]:
    """The names of the cases, in the order of the alphabet."""
    return tuple(sorted(file.name[:-5] for file in SET.iterdir() if file.name.endswith(".toml")))


def benchmark_set() -> dict[str, str]:
    """The text of every file of the set."""
    texts: dict[str, str] = {}
    rows = ["| case | quantity | value |", "| --- | --- | --- |"]
    names = case_names()
    for name in counted("cases", names, len(names)):
        scene = (SET / f"{name}.toml").read_text(encoding="utf-8")
        file = parse(scene, f"{name}.toml")
        solution = solve(file.scene)
        texts[f"{name}.toml"] = scene
        texts |= {
            f"{name}.csv": csv_text(solution, file),
            f"{name}.json": json_text(solution, file),
        }
        rows += [f"| {name} | {quantity} | {value!r} |" for quantity, value in _chief(solution)]
    readme = (SET / "README.md").read_text(encoding="utf-8")
    texts["README.md"] = readme + "\n".join([*rows, "", f"Computed by sie {__version__}.", ""])
    return texts


def _chief(solution: Solution) -> list[tuple[str, float]]:
    """The quantities by which a code is judged first; of a symmetric contact those on x > 0."""
    (inner, outer), (height, places) = solution.patches[-1], peak(solution)
    quantities = [("inner edge, mm", inner)] if inner > 0.0 else []
    quantities += [("edge of the contact, mm", outer)]
    quantities += [("peak pressure, MPa", height), ("its place, mm", places[-1])]
    if solution.carries_shear:
        quantities += [("edge of the stick zone, mm", solution.stick[-1][1])]
        quantities += [("energy lost, N", solution.energy_lost)]
    return quantities
