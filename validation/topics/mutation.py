"""Wrong programs, which the checks must catch, at errors from 1 to 1e-12 of the pressure.

The certificate catches answers that do not satisfy the equations. A wrong input (a constant, the
sign of β) satisfies wrong equations perfectly, and only a closed form that shares no code shows the
error.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from validation.harness.records import Claim, Curve, Doing, Record, Table
from validation.wrong_programs.mutants import BAR, MUTANTS

TITLE = "Mutation: wrong programs, and what catches them"
SECONDS = (1.0, 2.5)
TIMED = False


def compute(quick: bool) -> Iterator[Record]:
    rows = []
    for mutant in MUTANTS:
        yield Doing(mutant.name)
        right, wrong = mutant.number(False), mutant.number(True)
        rows.append(
            (
                mutant.name,
                mutant.says,
                mutant.checker,
                wrong,
                right,
                "caught" if wrong > BAR >= right else "NOT caught",
            )
        )
        yield Claim(
            f"{mutant.name}: what the {mutant.checker} measures",
            "this project: each must be caught", wrong, right,
            "the right program, which must not be caught", low=float(np.nextafter(BAR, 1.0)),
        )  # fmt: skip
    yield Table(
        "Wrong programs",
        ("name", "what is wrong", "caught by", "measured", "of the right program", "verdict"),
        rows,
    )
    index = list(range(len(rows)))
    yield Curve(
        "mutants",
        "wrong program",
        index,
        [r[3] for r in rows],
        "points",
        {"names": [r[0] for r in rows]},
    )
    yield Curve("mutants", "right program", index, [r[4] for r in rows], "points")
