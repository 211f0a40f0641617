"""The stress inside against 40 digits at five depths, and its cost against logarithms in the same
run.

The error is the largest of xx, yy, xy in full sliding, f = 0.3, over the peak pressure: under the
centre's side, beside the contact, straight under kinks and edges (there the reference has the edges
beyond double precision). The ratio is the time of xx, yy, xy on a 200 x 200 grid over that of two
complex logarithms and one complex square root of that grid, medians in turns.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from oracles.half_plane_stress import stresses
from oracles.normal_contact import mp
from validation.cases import SMOOTH_CASES, Case, exact, solved
from validation.harness.counting import work
from validation.harness.measures import largest
from validation.harness.records import Claim, Curve, Doing, Record, Table
from validation.harness.timing import compared

TITLE = "The stress inside, against 40 digits"
SECONDS = (2.0, 29.0)
TIMED = False
BAR = 1e-13
SPEED = 6.0  # times the steps of two logarithms and one root, on the rounded punch
SPOILED = 1e-11

FRICTION = 0.3
DEPTHS = (1e-10, 1e-6, 1e-2, 1.0, 1e3)
QUICK = ("rounded", "sinh")
_X, _Y = np.linspace(-2.0, 2.0, 200), np.linspace(0.01, 3.0, 200)[:, None]


@dataclass(frozen=True)
class Row:
    case: str
    errors: tuple[float, ...]
    milliseconds: float
    ratio: float


def rows(quick: bool = False) -> Iterator[Row]:
    seen: set[str] = set()
    for case in SMOOTH_CASES:
        if case.name in seen or (quick and case.name not in QUICK):
            continue
        seen.add(case.name)
        yield row(case)


def row(case: Case) -> Row:
    errors = tuple(error(case, depth) for depth in DEPTHS)
    seconds, ratio = compared(*programs(case))
    return Row(str(case), errors, 1e3 * seconds, ratio)


def programs(case: Case, times: int = 1) -> tuple[Callable[[], Any], Callable[[], Any]]:
    """The stress on a grid, done `times` over for the control; two logarithms and one root."""
    solution = sliding(case)
    x, y = solution.centre + solution.half_width * _X, solution.half_width * _Y
    z = (x + 1j * y).ravel()

    def run() -> Any:
        for _ in range(times):
            s = solution.stress(x, y)
            _ = s.xx, s.yy, s.xy

    return run, lambda: (np.log(z), np.log(z), np.sqrt(z))


def steps(case: Case, times: int = 1) -> float:
    """The steps of the one over those of the other."""
    ours, other = (work(run).steps for run in programs(case, times))
    return ours / other


def sliding(case: Case) -> Any:
    solution = solved(case)
    return solution.with_(friction=FRICTION, tangential_load=FRICTION * solution.normal_load)


def error(case: Case, depth: float, spoiled: float = 0.0) -> float:
    solution, truth = sliding(case), exact(case)
    (x1, x2), r, m = solution.edges, solution.half_width, solution.centre
    p = solution.pressure(np.linspace(x1, x2, 2003)[1:-1])
    inner = [b for b in case.profile.breaks if x1 < b < x2]
    places = [(x, mp.mpf(x)) for x in (m + 0.31 * r, x2 + 0.4 * r, *inner)] + [
        (x1, truth.x1),
        (x2, truth.x2),
    ]
    worst = 0.0
    for x, x_exact in places:
        found, reference = (
            solution.stress(x, depth * r),
            stresses(truth, x_exact, depth * r, FRICTION),
        )
        for name in ("xx", "yy", "xy"):
            worst = largest(
                (
                    worst,
                    abs(
                        mp.mpf(float(getattr(found, name)) * (1 + spoiled))
                        - getattr(reference, name)
                    ),
                )
            )
    return worst / float(p[np.isfinite(p)].max())


def compute(quick: bool = False) -> Iterator[Record]:
    found = []
    for r in rows(quick):
        yield Doing(r.case)
        found.append(r)
    worst = largest(e for r in found for e in r.errors)
    spoiled = min(error(case, 1e-2, SPOILED) for case in SMOOTH_CASES[:1])
    yield Claim(
        "largest error of the stress over the peak pressure",
        "README: 1e-13 at any depth",
        worst,
        spoiled,
        "off by 1e-11",
        high=BAR,
    )
    punch = next(case for case in SMOOTH_CASES if case.name == "rounded" and case.width is not None)
    yield Claim(
        "rounded punch: steps of the stress on a 200 x 200 grid over two logarithms and one root",
        "this project: at most 6",
        steps(punch), steps(punch, times=4), "a program that does it four times", high=SPEED,
    )  # fmt: skip
    header = ("case (E* = 1)", *(f"{d:g} b deep" for d in DEPTHS), "200 x 200 [ms]", "ratio")
    yield Table("Each case", header, [(r.case, *r.errors, r.milliseconds, r.ratio) for r in found])
    for r in found:
        yield Curve("depth", r.case, DEPTHS, r.errors, "both")
