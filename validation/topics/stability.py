"""The limits of full accuracy: one number of the contact at a time is taken to its extremes.

Each answer is compared with a closed form in 50 digits, at the very doubles that the solver was
given, and with its own certificate. An answer is full if its error is within the bar; known, if it
was refused, or if the certificate states at least a third of the error; and lost, if digits are
lost and the certificate does not state it. The frontier is where full accuracy ends. The control:
an answer off by 1e-10 must miss the bar.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

import sie
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Doing, Map, Record, Table, checked
from validation.rivals.solvers import erdogan_gupta_matrix
from validation.topics import sweeps
from validation.topics.sweeps import Outcome, Sweep, logit, near_ends

TITLE = "Stability: error maps and the frontier"
SECONDS = (4.0, 25.0)
TIMED = False
BAR = 1e-13
FLATNESS = "decades of (a/b)/(1 - a/b)"


def all_sweeps(quick: bool) -> tuple[Sweep, ...]:
    step = 5 if quick else 1
    shares = near_ends(15, step)
    flat = (*shares, -1e-16, -1e-18, -1e-20)
    decades = np.arange(-15.0, 0.0, 3.0 if quick else 1.0)
    return (
        Sweep("a/b, load given", FLATNESS, lambda v: sweeps.flatness(v, "load"), flat,
              (-15.2, 15.2), decades=logit),
        Sweep("a/b, width given", FLATNESS, lambda v: sweeps.flatness(v, "width"), shares,
              (-15.2, 15.2), decades=logit),
        Sweep("length", "decades of the length", lambda v: sweeps.scale(v, 1.0),
              _powers(-300, 300, 50 if quick else 25), (-100, 100)),
        Sweep("modulus", "decades of E*", lambda v: sweeps.scale(1.0, v),
              _powers(-300, 300, 100 if quick else 50), (-100, 100)),
        Sweep("pieces", "decades of their number", sweeps.pieces, _powers(1, 3 if quick else 5, 1),
              (0, 5)),
        Sweep("depth", "decades of the depth / b", sweeps.depth,
              _powers(-18, 12, 3 if quick else 1), (-15, 6)),
        Sweep("distance to a kink", "decades of the distance / b", sweeps.at_kink,
              _doubles(decades, 0.5), (-16, 0)),
        Sweep("distance to an edge", "decades of the distance / b", sweeps.at_edge,
              _doubles(decades, 1.0), (-16, 0)),
        Sweep(
            "βf", "decades of βf", sweeps.coupling,
            (*_powers(-15, -1, 7 if quick else 2), 0.3, 0.49, *_powers(0, 4, 1)), (-15, -0.3),
        ),
        Sweep(
            "gap between two punches", "decades of the gap / b", sweeps.gap,
            _powers(-16, 0, 4 if quick else 1), (-8, 0), certified=False,
        ),
        Sweep("Q/fP", "decades of (Q/fP)/(1 - Q/fP)", sweeps.partial_slip, near_ends(14, step),
              (-14.2, 14.2), decades=logit),
    )  # fmt: skip


def _powers(lo: int, hi: int, step: int) -> tuple[float, ...]:
    return tuple(float(f"1e{k}") for k in range(lo, hi + 1, step))


def _doubles(decades: Any, at: float) -> tuple[float, ...]:
    """Distances from `at` that doubles have: one, two and four ulp, then decades."""
    ulp = float(at - np.nextafter(at, 0.0))
    return (ulp, 2 * ulp, 4 * ulp, *(float(10.0**d) for d in decades))


def compute(quick: bool) -> Iterator[Record]:
    rows, every = [], []
    for sweep in all_sweeps(quick):
        yield Doing(sweep.name)
        outcomes = [sweep.run(v) for v in sweep.values]
        yield from _promise(sweep, outcomes)
        yield from _drawn(sweep, outcomes)
        every += outcomes if sweep.certified else []
        rows.append(_frontier(sweep, outcomes))
    yield checked(
        unstated, every,
        [Outcome(o.spoiled, estimate=o.estimate) for o in every if not o.refused],
        what="answers that lost digits which the certificate does not state",
        by="this project: stability",
        named=f"answers off by {sweeps.SPOILED:.0e} with the certificates of right ones", high=0,
    )  # fmt: skip
    yield Table(
        "The frontier", ("number", "axis", "promised", "full accuracy found", "beyond"), rows
    )
    yield from maps(quick)
    yield from conditions(quick)


def _drawn(sweep: Sweep, outcomes: list[Outcome]) -> Iterator[Curve]:
    key, x = "sweep: " + sweep.name, [sweep.decades(v) for v in sweep.values]
    states = [o.state(sweep.bar) for o in outcomes]
    about = {"axis": sweep.axis, "states": states, "promised": sweep.promised}
    yield Curve(key, "error", x, [o.error for o in outcomes], "both", about)
    stated = [o.estimate for o in outcomes]
    if any(map(math.isfinite, stated)):
        yield Curve(key, "certificate's estimate", x, stated, "dashed")


def _frontier(sweep: Sweep, outcomes: list[Outcome]) -> tuple[str, ...]:
    """The promised range, that of full accuracy, and the first thing that happens beyond it."""
    states = [o.state(sweep.bar) for o in outcomes]
    full = [sweep.decades(v) for v, s in zip(sweep.values, states, strict=True) if s == "full"]
    words = sorted({o.refused.split(":")[0][:90] for o in outcomes if o.refused})
    return (
        sweep.name,
        sweep.axis,
        f"{sweep.promised[0]:g} … {sweep.promised[1]:g}",
        f"{min(full):.1f} … {max(full):.1f}",
        words[0] if words else _beyond(states),
    )


def _promise(sweep: Sweep, outcomes: list[Outcome]) -> Iterator[Claim]:
    low, high = sweep.promised
    decades = map(sweep.decades, sweep.values)
    inside = [o for o, d in zip(outcomes, decades, strict=True) if low <= d <= high]
    yield Claim(
        f"{sweep.name}: largest error in the promised range", "this project: stability",
        largest(math.inf if o.refused else o.error for o in inside),
        smallest(o.spoiled for o in inside if not o.refused),
        f"answers off by {sweeps.SPOILED:.0e}", high=sweep.bar,
    )  # fmt: skip


def _beyond(states: list[str]) -> str:
    if "lost" in states:
        return "digits are lost, and not stated"
    return "the certificate states it" if "known" in states else "no end was found"


def unstated(outcomes: list[Outcome]) -> int:
    return sum(o.state(BAR) == "lost" for o in outcomes)


def maps(quick: bool) -> Iterator[Record]:
    """Two numbers at a time."""
    yield Doing("maps")
    shares = near_ends(15, 7 if quick else 2)
    near = [-15.65, *range(-15, 0, 5 if quick else 2)]
    values = [[_at_kink(10.0**d, share) for share in shares] for d in near]
    yield Map("map: kink", [logit(s) for s in shares], near, values)
    yield Claim(
        "largest error next to the end of the flat, over distances to it and a/b", "this project",
        largest(v for m in values for v in m),
        sweeps.at_kink(1e-3).spoiled, f"an answer off by {sweeps.SPOILED:.0e}", high=BAR,
    )  # fmt: skip
    lengths = _powers(-100, 100, 100 if quick else 50)
    values = [[_error(lambda v=v, w=w: sweeps.scale(v, w)) for v in lengths] for w in lengths]
    yield Map("map: scale", np.log10(lengths).tolist(), np.log10(lengths).tolist(), values)
    everything = [v for m in values for v in m]
    yield Claim(
        "largest error over lengths and moduli from 1e-100 to 1e100", "this project",
        largest(everything),
        sweeps.scale(1.0, 1.0).spoiled, f"an answer off by {sweeps.SPOILED:.0e}", high=BAR,
    )  # fmt: skip


def _at_kink(distance: float, share: float) -> float:
    ratio = share if share > 0 else 1.0 + share
    return _error(
        lambda: sweeps.at_kink(
            min(distance, 0.9 * (1 - ratio)) if share > 0 else distance * (1 - ratio), ratio
        )
    )


def _error(outcome: Any) -> float:
    try:
        return outcome().error
    except (sie.ContactError, ValueError):
        return math.nan


def conditions(quick: bool) -> Iterator[Record]:
    """Condition numbers of the square systems of this package's Cauchy equations, and of the
    textbook's unscaled matrix, against the number of unknowns.
    """
    yield Doing("condition numbers")
    sizes = (8, 16, 32, 64, 128) if quick else (8, 16, 32, 64, 128, 256, 512)
    singular = [
        np.linalg.cond(sie.CauchyEquation((-1.0, 1.0), g=1.0, total=0.0).system(n)[0])
        for n in sizes
    ]
    coupled = [
        np.linalg.cond(sie.CauchyEquation((-1.0, 1.0), g=1.0, a=0.3, total=0.0).system(n)[0])
        for n in sizes
    ]
    textbook = [np.linalg.cond(erdogan_gupta_matrix(n)[0]) for n in sizes]
    yield Curve("condition", "sie.CauchyEquation, singular ends", sizes, singular, "both")
    yield Curve("condition", "sie.CauchyEquation, a = 0.3", sizes, coupled, "both")
    yield Curve("condition", "Erdogan-Gupta, unscaled", sizes, textbook, "both")
    growth = [np.polyfit(np.log(sizes[-3:]), np.log(c[-3:]), 1)[0] for c in (coupled, textbook)]
    yield Claim(
        "condition number of the scaled system: largest, any number of unknowns",
        "this project: bounded, once scaled",
        max(*singular, *coupled), textbook[-1], "the textbook's unscaled matrix", high=10.0,
    )  # fmt: skip
    yield Claim(
        "growth of the condition number: its exponent in n",
        "this project",
        growth[0],
        growth[1],
        "the unscaled matrix",
        high=0.1,
    )
