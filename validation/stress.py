"""Accuracy and speed of the stress: the error against 40 digits at five depths, the cost against logarithms in the same run.

error   largest error of xx, yy, xy in full sliding, f = 0.3, over the peak pressure: under the centre's side, beside the contact, straight
        under kinks and edges (there the reference has the edges beyond double precision)
ratio   xx, yy, xy on a 200 x 200 grid, over two complex logarithms and one complex square root of that grid: medians of interleaved repeats
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .cases import SMOOTH_CASES, Case, exact, solved
from .pressure import compared
from .reference import mp
from .stress_reference import stresses

FRICTION = 0.3
DEPTHS = (1e-10, 1e-6, 1e-2, 1.0, 1e3)
QUICK = ("parabola", "rounded", "sinh", "six")
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
        if quick and (case.name not in QUICK or case.name in seen):
            continue
        seen.add(case.name)
        yield row(case)


def row(case: Case) -> Row:
    errors = tuple(error(case, depth) for depth in DEPTHS)
    solution = sliding(case)
    x, y = solution.centre + solution.half_width * _X, solution.half_width * _Y
    z = (x + 1j * y).ravel()

    def run() -> Any:
        s = solution.stress(x, y)
        return s.xx, s.yy, s.xy

    seconds, ratio = compared(run, lambda: (np.log(z), np.log(z), np.sqrt(z)), loops=3)
    return Row(str(case), errors, 1e3 * seconds, ratio)


def sliding(case: Case) -> Any:
    solution = solved(case)
    return solution.with_(friction=FRICTION, tangential_load=FRICTION * solution.normal_load)


def error(case: Case, depth: float) -> float:
    solution, truth = sliding(case), exact(case)
    (x1, x2), r, m = solution.edges, solution.half_width, solution.centre
    p = solution.pressure(np.linspace(x1, x2, 2003)[1:-1])
    inner = [b for b in case.profile.breaks if x1 < b < x2]
    places = [(x, mp.mpf(x)) for x in (m + 0.31 * r, x2 + 0.4 * r, *inner)] + [(x1, truth.x1), (x2, truth.x2)]
    worst = 0.0
    for x, x_exact in places:
        found, reference = solution.stress(x, depth * r), stresses(truth, x_exact, depth * r, FRICTION)
        for name in ("xx", "yy", "xy"):
            worst = max(worst, abs(float(mp.mpf(float(getattr(found, name))) - getattr(reference, name))))
    return worst / float(p[np.isfinite(p)].max())


def table(found: list[Row]) -> str:
    """Markdown."""
    lines = [
        f"| case (E* = 1) | {' | '.join(f'{d:g} b deep' for d in DEPTHS)} | 200 x 200 | ratio |",
        f"| --- |{' --- |' * (len(DEPTHS) + 2)}",
    ]
    for r in found:
        cells = (r.case.replace("|", r"\|"), *(f"{e:.1e}" for e in r.errors), f"{r.milliseconds:.1f} ms", f"{r.ratio:.1f}")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def as_json(found: list[Row]) -> list[dict[str, Any]]:
    return [asdict(r) for r in found]
