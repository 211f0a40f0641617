"""Edges on and beside the kinks of a slope, against 100 digits.

`validation.kinked_contacts` draws contacts whose right edge lies beside a break of the slope: where
h'' jumps, or h' itself. Its pieces are polynomials, whose integrals over a contact are exact
(`oracles.polynomial_pieces`).

The edges are the roots of the conditions in 100 digits, by Newton's method from those of the
solver, with what is left of them verified; the root of the distance from the break stands for the
distance where h' jumps.

`python -m validation.topics.kinks 3000` prints the table of so many contacts.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

import sie
from oracles.polynomial_pieces import Exact, Number, mp
from sie.contact.edge_refinement import MAX_POLISHING
from sie.numerics.interval import Interval
from validation.harness.measures import largest
from validation.harness.records import Claim, Doing, Record, Table
from validation.kinked_contacts import ASKED, LEFT, Trial, drawn

TITLE = "Edges on the kinks of a slope"
SECONDS = (6.0, 70.0)
TIMED = False

PROMISE = 1e-12  # of the half-width and of the peak pressure
SPOILED = 1e-10  # an answer off by so much must be detected
PLACES = (-0.999999, -0.999, -0.7, -0.31, 0.013, 0.43, 0.81, 0.999, 0.999999)
BESIDE = (1e-9, 1e-6, 1e-3)  # of r, from every break
EPS = float(np.finfo(float).eps)
# Ulps of what is given: each number may be half of one off in the answer and in the scene
ULPS = 4.0
MOST = 60  # evaluations of the edge integrals
NAMES = {"edges": "half-width", "pressure": "peak"}


# -- the truth, next to the answer -----------------------------------------------------------------


def truth(trial: Trial, found: Interval) -> tuple[Exact, Number]:
    """The contact in 100 digits, with its tilt."""
    conditions = _Conditions(trial, mp.sqrt(mp.mpf(found.r)))
    v = conditions.unknowns(found)
    for _ in range(40):
        f = conditions(v)
        if max(map(abs, f)) < LEFT:
            return conditions.contact(v)
        columns = []
        for j in range(len(v)):
            h = (abs(v[j]) or mp.mpf(10) ** -20) * mp.mpf(10) ** -18
            moved = [*v]
            moved[j] += h
            columns.append([(a - b) / h for a, b in zip(conditions(moved), f, strict=True)])
        step = mp.lu_solve(mp.matrix(columns).T, -mp.matrix(f))
        v = [a + b for a, b in zip(v, step, strict=True)]
    raise AssertionError(f"the reference did not settle: {trial.scene!r}")


class _Conditions(NamedTuple):
    """The conditions of a trial's edges, as functions of the right edge and, unless the contact is
    symmetric or its half-width is given, the left one.

    `root` is that of the half-width: where h' jumps, the unknown is the root of the distance.
    """

    trial: Trial
    root: Number

    @property
    def rooted(self) -> bool:
        return self.trial.at in self.trial.shape.jumps

    def unknowns(self, found: Interval) -> list[Number]:
        y = mp.mpf(found.x2) - mp.mpf(self.trial.at) + mp.mpf(found.tail2)
        v = [y if not self.rooted else mp.sqrt(y) if y > 0 else y / self.root]
        if self.trial.scene.half_width is None and not self.trial.shape.symmetric:
            v.append(mp.mpf(found.x1) + mp.mpf(found.tail1))
        return v

    def contact(self, v: Sequence[Number]) -> tuple[Exact, Number]:
        scene, shape, y = self.trial.scene, self.trial.shape, v[0]
        x2 = mp.mpf(self.trial.at) + ((y * y if y > 0 else y * self.root) if self.rooted else y)
        tilt = mp.mpf(scene.tilt)
        if scene.half_width is not None:
            return shape.contact(x2 - 2 * mp.mpf(scene.half_width), x2, tilt), tilt
        x1 = -x2 if shape.symmetric else v[1]
        if scene.moment is not None:
            tilt = -shape.contact(x1, x2).integral((1,))[0] / mp.pi
        return shape.contact(x1, x2, tilt), tilt

    def __call__(self, v: Sequence[Number]) -> list[Number]:
        scene, (c, _) = self.trial.scene, self.contact(v)
        I0, I1, C2 = c.integral((1,), (0, 1), (1, 0, -1))
        if scene.half_width is not None:
            return [I0 / I1]
        G, P = mp.mpf(scene.Estar) / 2, mp.mpf(scene.normal_load)
        load = G * c.r * I1 / P - 1
        if self.trial.shape.symmetric:
            return [load]
        if scene.moment is None:
            return [load, I0 / I1]
        return [load, (c.m * P - G * c.r**2 * C2 - mp.mpf(scene.moment)) / (P * c.r)]


@dataclass(frozen=True)
class Outcome:
    """The errors of the edges over r, of the pressure over its peak, evaluations; or the words of
    the refusal.
    """

    edges: float = 0.0
    pressure: float = 0.0
    evaluations: int = 0
    refused: str = ""


def outcome(trial: Trial, spoiled: float = 0.0) -> Outcome:
    solution = sie.solve(trial.scene)
    try:
        found = solution.normal.edges.contact
    except sie.ContactError as error:
        return Outcome(refused=str(error))
    exact, tilt = truth(trial, found)
    r = exact.r
    off = max(
        abs(mp.mpf(x) + mp.mpf(tail) - true)
        for x, tail, true in ((found.x1, found.tail1, exact.x1), (found.x2, found.tail2, exact.x2))
    )
    x = [float(exact.m + r * mp.mpf(s)) for s in PLACES]
    x += [float(b + side * d * r) for b in exact.breaks for d in BESIDE for side in (-1, 1)]
    x = [v for v in x if (1 - abs(mp.mpf(v) - exact.m) / r) > mp.mpf(10) ** -7]
    true = np.array([float(exact.pressure(v, mp.mpf(trial.scene.Estar) / 2)) for v in x])
    # What ulps of what was given change is no error: under a load more by dP the pressure is more
    # by dP/(π w), an edge moves by dP/(G r JR); a slope as large as the tilt carries π G r times
    # itself
    w = np.array([float(mp.sqrt((v - exact.x1) * (exact.x2 - v))) for v in map(mp.mpf, x)])
    given = (
        solution.normal_load
        + abs(trial.scene.moment or 0.0) / float(r)
        + np.pi * float(r * abs(tilt)) * 0.5 * trial.scene.Estar
    )
    ulp = ULPS * EPS * given / (np.pi * w)
    off_x = max(
        float(off - ULPS * EPS * given / (0.5 * trial.scene.Estar * exact.stiffness())), 0.0
    )
    off_p = np.maximum(np.abs(solution.pressure(np.array(x)) * (1.0 + spoiled) - true) - ulp, 0.0)
    return Outcome(
        off_x / float(r) + spoiled,
        float(off_p.max() / true.max()),
        solution.normal.edges.evaluations,
    )


# -- the topic ------------------------------------------------------------------------------------


def compute(quick: bool) -> Iterator[Record]:
    yield from measured(3 if quick else 40)


def measured(number: int) -> Iterator[Record]:
    """The records of that many contacts of each kind."""
    rows, every = [], []
    for j, (kind, given) in enumerate(ASKED):
        yield Doing(f"{kind}: {given}")
        trials = [drawn(number * j + i, kind, given) for i in range(number)]
        found = [outcome(trial) for trial in trials]
        every += found
        rows.append((kind, given, *_row(found)))
    yield from _claims(every, outcome(drawn(0, *ASKED[0]), SPOILED))
    yield Table(
        "Random contacts whose right edge is within 1e-15 to 1e-4 of a break's load",
        ("slope", "given", "contacts", "refused", "edges / r", "p / peak", "most evaluations"),
        rows,
    )


def _row(found: list[Outcome]) -> tuple[Any, ...]:
    answers = [o for o in found if not o.refused]
    if not answers:
        return len(found), len(found), "", "", 0
    edges, pressure = (largest(getattr(o, what) for o in answers) for what in NAMES)
    most = max(o.evaluations for o in answers)
    return len(found), len(found) - len(answers), edges, pressure, most


def _claims(every: list[Outcome], spoiled: Outcome) -> Iterator[Claim]:
    by = "this project: no edge on a kink is refused or wrong"
    refused = sum(bool(o.refused) for o in every)
    yield Claim("contacts refused", by, refused, len(every), "every one refused", high=0)
    for what, name in NAMES.items():
        yield Claim(
            f"largest error of the {what} / {name}, beyond what ulps of what is given explain",
            by,
            largest(getattr(o, what) for o in every if not o.refused),
            getattr(spoiled, what),
            f"answers off by {SPOILED:.0e}",
            high=PROMISE,
        )
    yield Claim(
        "most evaluations of the edge integrals",
        "this project: cost",
        largest(o.evaluations for o in every),
        MAX_POLISHING,
        "the bound of the method",
        high=MOST,
    )


if __name__ == "__main__":
    for record in measured(-(-int(sys.argv[1]) // len(ASKED))):
        if isinstance(record, Claim):
            print(f"{record.verdict:6} {record.what}: {record.measured:.3g}")
        elif isinstance(record, Table):
            for row in record.rows:
                print(*(f"{v:.1e}" if isinstance(v, float) else v for v in row), sep=" | ")
