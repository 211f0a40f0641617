"""Accuracy and speed of the normal contact: the error against 40 digits, the cost as a ratio to the closed form in the same run.

error   largest |p - p_ref| over the peak, at points across the contact, next to its breaks and to within 1e-3 r of its edges
load    relative error of P where the half-width is given, of the half-width where P is
time    `solve` and the pressure at 1001 points, over the NumPy evaluation of the rounded punch's closed form at as many points
        (Ciavarella, Hills & Monno 1998, eq. 32, as printed): medians of interleaved repeats, so that a busy machine slows both
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from statistics import median
from typing import Any

import numpy as np

import sie

from .cases import CASES, Case, exact, points, solved

POINTS = 1001
REPEATS, LOOPS = 15, 20
QUICK = ("parabola", "rounded", "sinh", "blunt", "eight", "|x|^2.5", "flat")


@dataclass(frozen=True)
class Row:
    case: str
    error: float
    load: float
    estimated: float  # what the certificate says
    evaluations: int  # of the edge integrals
    milliseconds: float
    ratio: float  # to the closed form


def rows(quick: bool = False) -> Iterator[Row]:
    """One row a case; with `quick` the first of each of a few kinds."""
    seen: set[str] = set()
    for case in CASES:
        if quick and (case.name not in QUICK or case.name in seen):
            continue
        seen.add(case.name)
        yield row(case)


def row(case: Case) -> Row:
    solution, truth = solved(case), exact(case)
    x = points(case)
    reference = np.array([float(truth.pressure(v)) for v in x])
    peak = float(np.abs(reference).max())
    error = float(np.abs(solution.pressure(x) - reference).max()) / peak
    seconds, ratio = cost(case)
    return Row(str(case), error, _load_error(case), solution.check().error, solution.normal.edges.evaluations, 1e3 * seconds, ratio)


def _load_error(case: Case) -> float:
    solution, truth = solved(case), exact(case)
    if case.load is None:
        return abs(float(solution.normal_load / truth.P - 1))
    return abs(float(solution.half_width / truth.r - 1))


def cost(case: Case) -> tuple[float, float]:
    """(seconds of solve and 1001 pressures, ratio to the closed form)."""
    x1, x2 = solved(case).edges
    x = np.linspace(x1, x2, POINTS)
    scene = case.scene
    return compared(lambda: sie.solve(scene).pressure(x), closed_form)


def compared(run: Callable[[], Any], other: Callable[[], Any], loops: int = LOOPS) -> tuple[float, float]:
    """(median seconds of `run`, median ratio to `other`), in turns."""
    run(), other()
    times, ratios = [], []
    for _ in range(REPEATS):
        mine, theirs = _timed(run, loops), _timed(other, loops)
        times.append(mine)
        ratios.append(mine / theirs)
    return median(times), median(ratios)


def _timed(run: Callable[[], Any], loops: int) -> float:
    best = float("inf")
    for _ in range(loops):
        start = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - start)
    return best


_X = np.linspace(-0.9995, 0.9995, POINTS)


def closed_form() -> np.ndarray:
    """Eq. (32) with b = R = E* = 1, a = 1/2, in as few NumPy calls as it takes."""
    phi, phi0 = np.arcsin(_X), np.arcsin(0.5)
    logarithms = _X * np.log(np.abs(np.sin(phi + phi0) / np.sin(phi - phi0))) + 0.5 * np.log(
        np.abs(np.tan((phi + phi0) / 2) * np.tan((phi - phi0) / 2))
    )
    return ((np.pi - 2 * phi0) * np.cos(phi) + logarithms) / (2 * np.pi)


def table(found: list[Row]) -> str:
    """Markdown."""
    lines = [
        "| case (E* = 1) | error of p / peak | error of load or width | certificate | evaluations | solve + 1001 p | ratio |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for r in found:
        cells = (
            r.case,
            f"{r.error:.1e}",
            f"{r.load:.1e}",
            f"{r.estimated:.1e}",
            r.evaluations,
            f"{r.milliseconds:.2f} ms",
            f"{r.ratio:.1f}",
        )
        lines.append("| " + " | ".join(str(c).replace("|", r"\|") for c in cells) + " |")
    return "\n".join(lines)


def as_json(found: list[Row]) -> list[dict[str, Any]]:
    return [asdict(r) for r in found]
