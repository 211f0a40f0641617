"""Wrong programs, each run here and caught here: the checks can fail, and do, at errors from 1 down to 1e-12 of the pressure.

The certificate catches what breaks the equations; what is wrong in the question (a constant, the sign of β) satisfies wrong
equations perfectly, and only a closed form that shares no code can tell.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from validation.harness.drawing import Figure, axes, labelled, legend_above
from validation.harness.records import Claim, Curve, Doing, Found, Record, Table
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
            f"{mutant.name}: what the {mutant.checker} measures", "this project: each must be caught", wrong, right,
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


def figures(found: Found) -> Iterator[Figure]:
    wrong, right = found.curves("mutants")
    drawing, ax = axes(height=0.2 * len(wrong.x) + 1.2, head=0.4)
    for curve, marker, colour in ((wrong, "x", "tab:red"), (right, "o", "tab:green")):
        ax.plot(
            np.clip(np.array(curve.y, dtype=float), 1e-17, 1e3),
            curve.x,
            marker,
            color=colour,
            mfc="none",
            label=curve.label,
        )
    ax.set_yticks(wrong.x, wrong.about["names"])
    ax.set_ylim(len(wrong.x) - 0.3, -0.7)
    ax.axvline(BAR, color="black", linewidth=0.8)
    labelled(ax, "what the checker measures", "", log="x")
    ax.set_xticks([1e-15, 1e-10, 1e-5, 1.0])
    legend_above(ax, 2)
    yield Figure(
        "mutants",
        drawing,
        "Each wrong program beside the right one, by the same checker; the line is the bar, 1e-13.",
    )
