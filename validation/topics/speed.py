"""The time of `solve` and 1001 pressures of each case, over NumPy's evaluation of the rounded
punch's closed form at as many points.

The closed form is eq. (32) of Ciavarella, Hills & Monno (1998), as printed. Both are timed in
turns, so that a busy machine slows both; the claim is of the steps of both, which are counted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import sie
from validation.cases import CASES, Case, chosen, solved
from validation.harness.counting import work
from validation.harness.records import Claim, Curve, Doing, Record, Table, checked
from validation.harness.timing import compared

TITLE = "Time of a pressure over that of its closed form"
SECONDS = (1.5, 7.0)
TIMED = True

POINTS = 1001
BAR = 4.0  # times the steps of the closed form: the rounded punch
TABLE = "Each case"
HEADER = ("case (E* = 1)", "solve + 1001 p [ms]", "ratio to the closed form")


def compute(quick: bool) -> Iterator[Record]:
    rows = []
    for case in chosen(quick):
        yield Doing(str(case))
        seconds, ratio = cost(case)
        rows.append((str(case), 1e3 * seconds, ratio))
    yield claim()
    yield Table(TABLE, HEADER, rows, "Profile and scene stand; each call solves anew. Medians.")
    yield Curve(
        "ratio",
        "solve + 1001 pressures",
        [r[2] for r in rows],
        list(range(len(rows))),
        "points",
        {"names": [r[0] for r in rows]},
    )


def claim() -> Claim:
    """The bar of the whole design, as a ratio in one run."""
    case = next(c for c in CASES if c.name == "rounded" and c.width is not None)
    return checked(
        lambda times: work(program(case, times)).steps / work(closed_form).steps, 1, 3,
        what="rounded punch: steps of solve and 1001 pressures over those of NumPy's closed form "
             "(32) at the same points",
        by="this project: at most 4", named="a program that does it three times", high=BAR,
    )  # fmt: skip


def cost(case: Case) -> tuple[float, float]:
    """(seconds of solve and 1001 pressures, ratio to the closed form)."""
    return compared(program(case), closed_form)


def program(case: Case, times: int = 1) -> Callable[[], None]:
    """Solve and 1001 pressures; done `times` over, for the control."""
    x = np.linspace(*solved(case).edges, POINTS)
    scene = case.scene

    def run() -> None:
        for _ in range(times):
            sie.solve(scene).pressure(x)

    return run


_X = np.linspace(-0.9995, 0.9995, POINTS)


def closed_form(a: float = 0.5, x: Any = _X) -> np.ndarray:
    """Eq. (32) with b = R = E* = 1, in as few NumPy calls as it takes."""
    phi, phi0 = np.arcsin(x), np.arcsin(a)
    logarithms = x * np.log(np.abs(np.sin(phi + phi0) / np.sin(phi - phi0))) + a * np.log(
        np.abs(np.tan((phi + phi0) / 2) * np.tan((phi - phi0) / 2))
    )
    return ((np.pi - 2 * phi0) * np.cos(phi) + logarithms) / (2 * np.pi)
