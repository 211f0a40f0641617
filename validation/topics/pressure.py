"""The pressure of normal contact against 40 digits, and its certificate.

The reference is quadrature in 40 digits that shares nothing with the package. The error is the
largest |p - p_ref| over the peak, at points across the contact, next to its breaks and to within
1e-3 r of its edges; that of the load is of P where the half-width is given, of the half-width where
P is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from validation.cases import Case, chosen, exact, points, solved
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Doing, Record, Table

TITLE = "Pressure, edges and load against 40 digits"
SECONDS = (2.5, 13.0)
TIMED = False

PROMISE = 1e-13
EPS = float(np.finfo(float).eps)
SPOILED = 1e-12  # relative change that every checker must detect
TABLE = "Each case, E* = 1"
HEADER = (
    "case (E* = 1)",
    "error of p / peak",
    "error of load or width",
    "certificate",
    "evaluations",
)


@dataclass(frozen=True)
class Row:
    case: str
    error: float
    load: float
    estimated: float  # the certificate's estimate
    evaluations: int  # of the edge integrals
    spoiled_error: float  # the same measures on an answer that is wrong by SPOILED
    spoiled_load: float
    unexplained: float  # of the error, more than the edges' own errors and one ulp of x explain
    spoiled_unexplained: float


def compute(quick: bool) -> Iterator[Record]:
    rows = []
    for case in chosen(quick):
        yield Doing(str(case))
        rows.append(row(case))
    yield from claims(rows)
    yield Table(
        TABLE, HEADER, [(r.case, r.error, r.load, r.estimated, r.evaluations) for r in rows],
        "The certificate is what the solver itself estimates; evaluations are those of the edge "
        "integrals."
    )  # fmt: skip
    index = list(range(1, len(rows) + 1))
    yield Curve("certificate", "true error, 40 digits", index, [r.error for r in rows], "points")
    yield Curve(
        "certificate", "the certificate's estimate", index, [r.estimated for r in rows], "points"
    )


def claims(rows: list[Row]) -> Iterator[Claim]:
    promise: dict[str, Any] = {"by": "README: to machine precision", "high": PROMISE}
    yield Claim(
        "largest error of the pressure, over its peak",
        measured=largest(r.error for r in rows),
        control=smallest(r.spoiled_error for r in rows),
        wrong=f"pressures off by {SPOILED:.0e}",
        **promise,
    )
    yield Claim(
        "largest relative error of the load, or of the half-width",
        measured=largest(r.load for r in rows),
        control=smallest(r.spoiled_load for r in rows),
        wrong=f"loads off by {SPOILED:.0e}",
        **promise,
    )
    yield Claim(
        "smallest certificate's estimate over the true error (what the edges' own errors and one "
        "ulp of x explain is not counted)",
        by="this project: a certificate on every answer",
        measured=smallest(r.estimated / max(r.unexplained, EPS) for r in rows),
        control=smallest(r.estimated / r.spoiled_unexplained for r in rows),
        wrong=f"pressures off by {SPOILED:.0e} after they were certified",
        low=1 / 3,
    )


def row(case: Case) -> Row:
    solution, truth = solved(case), exact(case)
    x = points(case)
    reference = np.array([float(truth.pressure(v)) for v in x])

    astray = max(
        abs(float(found - true))
        for found, true in zip(solution.edges, (truth.x1, truth.x2), strict=True)
    )
    peak, step = np.abs(reference).max(), astray + np.spacing(max(map(abs, solution.edges)))
    explained = np.max(
        [np.abs(solution.pressure(x + d) - solution.pressure(x)) for d in (-step, step)], axis=0
    )

    def errors(factor: float) -> np.ndarray:
        return np.abs(factor * solution.pressure(x) - reference)

    def error(factor: float) -> float:
        return float(errors(factor).max() / peak)

    def unexplained(factor: float) -> float:
        return float((errors(factor) - explained).max().clip(0.0) / peak)

    def load(factor: float) -> float:
        found, true = (
            (solution.normal_load, truth.P) if case.load is None else (solution.half_width, truth.r)
        )
        return abs(float(factor * found / true - 1))

    return Row(
        str(case), error(1.0), load(1.0), solution.check().error, solution.normal.edges.evaluations,
        error(1.0 + SPOILED), load(1.0 + SPOILED), unexplained(1.0), unexplained(1.0 + SPOILED),
    )  # fmt: skip
