"""Edges on and beside the kinks of a slope, against 100 digits.

A contact is drawn whose right edge lies on a break of the slope: where h'' jumps, or h' itself. The
load at which that is so, or the half-width, is then missed by a relative 1e-15 to 1e-4 to either
side, and the scene is given with its tilt or with its moment. Its pieces are polynomials, whose
integrals over a contact are exact (`oracles.polynomial_pieces`).

The edges are the roots of the conditions in 100 digits, by Newton's method from those of the
solver, with what is left of them verified; the root of the distance from the break stands for the
distance where h' jumps.

`python -m validation.topics.kinks 3000` prints the table of so many contacts.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import sie
from oracles.polynomial_pieces import Exact, Number, Rows, mp
from sie.contact.edge_refinement import MAX_POLISHING
from sie.numerics.interval import Interval
from validation.harness.measures import largest
from validation.harness.records import Claim, Doing, Record, Table

TITLE = "Edges on the kinks of a slope"
SECONDS = (6.0, 70.0)
TIMED = False

PROMISE = 1e-12  # of the half-width and of the peak pressure
SPOILED = 1e-10  # an answer off by so much must be detected
LEFT = mp.mpf(10) ** -45  # of the conditions, relative
PLACES = (-0.999999, -0.999, -0.7, -0.31, 0.013, 0.43, 0.81, 0.999, 0.999999)
BESIDE = (1e-9, 1e-6, 1e-3)  # of r, from every break
EPS = float(np.finfo(float).eps)
# Of what is given: each of the numbers may be half of one off in the answer and in the scene
ULPS = 4.0
MOST = 60  # evaluations of the edge integrals
SCANNED = 60  # points where the sign of the pressure is tested
CLOSED = 1e-3  # of the slopes in the contact times r: a smaller gap beside it may be none


# -- scenes whose right edge is on a break --------------------------------------------------------


@dataclass(frozen=True)
class Shape:
    """A profile of the package, its slope in exact numbers, and where h' jumps."""

    profile: sie.Profile
    breaks: tuple[Number, ...]
    rows: Rows
    jumps: frozenset[float] = frozenset()
    symmetric: bool = False

    def contact(self, x1: Number, x2: Number, tilt: Number = 0) -> Exact:
        rows = tuple((origin, (row[0] + tilt, *row[1:])) for origin, row in self.rows)
        return Exact(self.breaks, rows, x1, x2)


def rounded(rng: np.random.Generator) -> Shape:
    a, R = 10.0 ** rng.uniform(-1, 0.5, 2)
    profile = sie.RoundedFlat(a, R)
    rim, e = (mp.zero, 1 / mp.mpf(R)), mp.mpf(a)
    return Shape(profile, (-e, e), ((-e, rim), (mp.zero, (mp.zero,)), (e, rim)))


def chain(rng: np.random.Generator, *, degree: int = 1, jumps: bool = False) -> Shape:
    """2 to 6 pieces of random polynomials, that meet but for rounding, or jump upwards; the outer
    two are steep straight lines.
    """
    n = int(rng.integers(2, 7))
    breaks = np.sort(rng.uniform(-1.5, 1.5, n - 1)).tolist()
    rows: list[list[float]] = []
    value = -rng.uniform(0.0, 1.0)
    jumping = []
    for k in range(n):
        outer = k in (0, n - 1)
        c = [rng.uniform(0.3, 3.0)] if outer else [rng.choice([0.0, rng.uniform(0.0, 3.0)])]
        if not outer and degree > 1:
            c = [c[0], *rng.normal(0.0, 1.0, degree - 1)]
        b = breaks[0] if k == 0 else breaks[k - 1]
        if k and jumps and rng.random() < 0.6:
            value += rng.uniform(0.01, 1.0)
            jumping.append(b)
        rows.append(_through(b, value, c))
        if 0 < k < n - 1:
            value = float(np.polynomial.polynomial.polyval(breaks[k], rows[-1]))
    exact = tuple((mp.zero, tuple(map(mp.mpf, row))) for row in rows)
    return Shape(sie.Piecewise(breaks, rows), tuple(map(mp.mpf, breaks)), exact, frozenset(jumping))


def mirrored(rng: np.random.Generator) -> Shape:
    """A symmetric profile of straight pieces, whose edges leave two breaks at once; h' may jump
    there.
    """
    breaks = np.sort(rng.uniform(0.1, 1.5, int(rng.integers(1, 4)))).tolist()
    value, jumping = 0.0, []
    rows = [[0.0, rng.uniform(0.0, 1.0)]]
    for b in breaks:
        value = float(np.polynomial.polynomial.polyval(b, rows[-1]))
        if rng.random() < 0.5:
            value += rng.uniform(0.01, 1.0)
            jumping += [b, -b]
        rows.append(_through(b, value, [rng.uniform(0.1, 3.0)]))
    pieces = [[-row[0], row[1]] for row in rows[:0:-1]] + rows
    ends = [-b for b in breaks[::-1]] + breaks
    exact = tuple((mp.zero, tuple(map(mp.mpf, row))) for row in pieces)
    return Shape(
        sie.Piecewise(ends, pieces),
        tuple(map(mp.mpf, ends)),
        exact,
        frozenset(jumping),
        symmetric=True,
    )


def _through(b: float, value: float, c: Sequence[float]) -> list[float]:
    """Coefficients in x of value + Σ c_j (x - b)^(j+1)."""
    p = np.polynomial.Polynomial([value, *c])(np.polynomial.Polynomial([-b, 1.0]))
    return [float(v) for v in p.coef]


KINDS: dict[str, Callable[[np.random.Generator], Shape]] = {
    "rounded flat": rounded,
    "straight pieces": chain,
    "straight pieces, jumps of h'": lambda rng: chain(rng, jumps=True),
    "cubic pieces": lambda rng: chain(rng, degree=3),
    "quadratic pieces, jumps of h'": lambda rng: chain(rng, degree=2, jumps=True),
    "symmetric pieces": mirrored,
}
GIVEN = ("load, tilt", "load, moment", "half-width, tilt")
ASKED = (
    *((kind, given) for kind in KINDS for given in GIVEN if kind != "symmetric pieces"),
    ("symmetric pieces", "load, tilt"),
)


@dataclass(frozen=True)
class Trial:
    """A scene, and the break beside which its right edge lies."""

    shape: Shape
    scene: sie.Scene
    at: float
    # The relative distance of the load or half-width from the one that puts the edge on the break
    missed: float


def trial(rng: np.random.Generator, shape: Shape, given: str) -> Trial | None:
    """None where one patch with that edge would be in tension or would need no load."""
    at = float(rng.choice([float(b) for b in shape.breaks if b > 0 or not shape.symmetric]))
    left = -at if shape.symmetric else at - 10.0 ** rng.uniform(-1.5, 0.7)
    bare = shape.contact(mp.mpf(left), mp.mpf(at))
    tilt = 0.0 if shape.symmetric else float(-bare.integral((1,))[0] / mp.pi)
    if bare.integral((0, 1))[0] <= 0.0:
        return None
    x1 = (
        mp.mpf(left)
        if shape.symmetric
        else _left_edge(shape, mp.mpf(left), mp.mpf(at), mp.mpf(tilt))
    )
    touched = shape.contact(x1, mp.mpf(at), mp.mpf(tilt))
    modulus = float(10.0 ** rng.uniform(-2, 2))
    G = mp.mpf(modulus) / 2
    I1, C2 = touched.integral((0, 1), (1, 0, -1))
    load = G * touched.r * I1
    moment = touched.m * load - G * touched.r**2 * C2
    if load <= 0 or not _presses(touched):
        return None
    missed = float(rng.choice((-1, 1)) * 10.0 ** rng.uniform(-15, -4))
    scene: dict[str, Any] = {
        "load, tilt": {"normal_load": float(load * (1 + missed)), "tilt": tilt},
        "load, moment": {"normal_load": float(load * (1 + missed)), "moment": float(moment)},
        "half-width, tilt": {"half_width": float(touched.r * (1 + missed)), "tilt": tilt},
    }[given]
    return Trial(shape, sie.Scene(profile=shape.profile, modulus=modulus, **scene), at, missed)


def _left_edge(shape: Shape, x1: Number, x2: Number, tilt: Number) -> Number:
    """x1 with ∫H dφ = 0, next to the given one: the tilt was rounded."""
    return mp.findroot(
        lambda x: shape.contact(x, x2, tilt).integral((1,))[0],
        (x1, x1 + (x2 - x1) * mp.mpf(10) ** -15),
        tol=LEFT**2,
    )


def _presses(contact: Exact) -> bool:
    """Whether p > 0 across the contact and the gap is open beside it, as one patch requires."""
    m, r = float(contact.m), float(contact.r)
    s = np.cos(np.pi * (np.arange(SCANNED) + 0.5) / SCANNED)
    if not all(contact.pressure(m + r * float(v), mp.mpf(1)) > 0 for v in s):
        return False
    reach = 2.0 * max(abs(float(b) - m) for b in contact.breaks) + r
    d = np.geomspace(1e-3 * r, reach, 10 * SCANNED)
    return all(bool((_gap(contact, m + side * (r + d)) > 0.0).all()) for side in (-1.0, 1.0))


def _gap(contact: Exact, x: np.ndarray) -> np.ndarray:
    """∫ g' dx outwards along ascending distances, g' = H + R/π ∫H/(t - x) dφ; to a few digits."""
    m, r = float(contact.m), float(contact.r)
    g, w = np.polynomial.legendre.leggauss(40)
    total = np.zeros_like(x)
    for lo, hi, c in contact.parts():
        phi = 0.5 * float(lo + hi) + 0.5 * float(hi - lo) * g
        s = np.sin(phi)
        H = np.polynomial.polynomial.polyval(s, [float(v) for v in c])
        total += (0.5 * float(hi - lo) * w * H) @ (1.0 / ((m + r * s)[:, None] - x))
    R = np.sign(x - m) * np.sqrt((x - m - r) * (x - m + r))
    k = np.searchsorted([float(b) for b in contact.breaks], x)
    scale = float(contact.integral((0, 1))[0]) / np.pi
    rows = [[float(c) for c in row] for _, row in contact.rows]
    H = np.array(
        [
            np.polynomial.polynomial.polyval(v - float(contact.rows[j][0]), rows[j])
            for v, j in zip(x, k, strict=True)
        ]
    )
    rises = np.append(0.0, H + R / np.pi * total)
    steps = np.diff(x, prepend=m + np.sign(x[0] - m) * r)
    return np.cumsum(0.5 * (rises[1:] + rises[:-1]) * steps) - CLOSED * scale * r * (
        np.abs(x - m) > 1.5 * r
    )


# -- the truth, next to the answer ----------------------------------------------------------------


def truth(trial: Trial, found: Interval) -> tuple[Exact, Number]:
    """The contact in 100 digits, with its tilt, and G r I1 over the load."""
    scene, shape = trial.scene, trial.shape
    G = mp.mpf(scene.Estar) / 2
    at = mp.mpf(trial.at)
    rooted, root = trial.at in shape.jumps, mp.sqrt(mp.mpf(found.r))

    def right(v: Number) -> Number:
        return at + (v * v if rooted and v > 0 else v * root if rooted else v)

    def contact_of(v: Sequence[Number]) -> tuple[Exact, Number]:
        if scene.half_width is not None:
            x2 = right(v[0])
            tilt = mp.mpf(scene.tilt)
            return shape.contact(x2 - 2 * mp.mpf(scene.half_width), x2, tilt), tilt
        x2 = right(v[0])
        x1 = -x2 if shape.symmetric else v[1]
        tilt = (
            mp.mpf(scene.tilt)
            if scene.moment is None
            else -shape.contact(x1, x2).integral((1,))[0] / mp.pi
        )
        return shape.contact(x1, x2, tilt), tilt

    def conditions(v: Sequence[Number]) -> list[Number]:
        c, _ = contact_of(v)
        I0, I1, C2 = c.integral((1,), (0, 1), (1, 0, -1))
        if scene.half_width is not None:
            return [I0 / I1]
        P = mp.mpf(scene.normal_load)
        if shape.symmetric:
            return [G * c.r * I1 / P - 1]
        second = (
            I0 / I1
            if scene.moment is None
            else (c.m * P - G * c.r**2 * C2 - mp.mpf(scene.moment)) / (P * c.r)
        )
        return [G * c.r * I1 / P - 1, second]

    y = mp.mpf(found.x2) - at + mp.mpf(found.tail2)
    v = [y if not rooted else mp.sqrt(y) if y > 0 else y / root]
    if scene.half_width is None and not shape.symmetric:
        v.append(mp.mpf(found.x1) + mp.mpf(found.tail1))
    for _ in range(40):
        f = conditions(v)
        if max(map(abs, f)) < LEFT:
            return contact_of(v)
        columns = []
        for j in range(len(v)):
            h = (abs(v[j]) or mp.mpf(10) ** -20) * mp.mpf(10) ** -18
            moved = [*v]
            moved[j] += h
            columns.append([(a - b) / h for a, b in zip(conditions(moved), f, strict=True)])
        J = mp.matrix(columns).T
        step = mp.lu_solve(J, -mp.matrix(f))
        v = [a + b for a, b in zip(v, step, strict=True)]
    raise AssertionError(f"the reference did not settle: {trial.scene!r}")


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


def drawn(seed: int, kind: str, given: str) -> Trial:
    """The first trial of a seed that has an answer."""
    rng = np.random.default_rng(seed)
    while True:
        asked = trial(rng, KINDS[kind](rng), given)
        if asked is not None:
            return asked


# -- the topic ------------------------------------------------------------------------------------


def compute(quick: bool) -> Iterator[Record]:
    yield from measured(3 if quick else 40)


def measured(number: int) -> Iterator[Record]:
    """The records of that many contacts of each kind."""
    rows = []
    every: list[tuple[Trial, Outcome]] = []
    for j, (kind, given) in enumerate(ASKED):
        yield Doing(f"{kind}: {given}")
        trials = [drawn(number * j + i, kind, given) for i in range(number)]
        found = [(asked, outcome(asked)) for asked in trials]
        every += found
        answers = [o for _, o in found if not o.refused]
        worst = (
            (largest(o.edges for o in answers), largest(o.pressure for o in answers))
            if answers
            else ("", "")
        )
        rows.append(
            (
                kind,
                given,
                len(found),
                len(found) - len(answers),
                *worst,
                max((o.evaluations for o in answers), default=0),
            )
        )
    spoiled = outcome(every[0][0], SPOILED)
    by = "this project: no edge on a kink is refused or wrong"
    yield Claim(
        "contacts refused",
        by,
        sum(bool(o.refused) for _, o in every),
        len(every),
        "every one refused",
        high=0,
    )
    for what in ("edges", "pressure"):
        name = {"edges": "half-width", "pressure": "peak"}[
            what
        ] + ", beyond what ulps of what is given explain"
        worst_of_all = largest(getattr(o, what) for _, o in every if not o.refused)
        yield Claim(
            f"largest error of the {what} / {name}",
            by,
            worst_of_all,
            getattr(spoiled, what),
            f"answers off by {SPOILED:.0e}",
            high=PROMISE,
        )
    most = largest(o.evaluations for _, o in every)
    yield Claim(
        "most evaluations of the edge integrals",
        "this project: cost",
        most,
        MAX_POLISHING,
        "the bound of the method",
        high=MOST,
    )
    yield Table(
        "Random contacts whose right edge is within 1e-15 to 1e-4 of a break's load",
        ("slope", "given", "contacts", "refused", "edges / r", "p / peak", "most evaluations"),
        rows,
    )


if __name__ == "__main__":
    for record in measured(-(-int(sys.argv[1]) // len(ASKED))):
        if isinstance(record, Claim):
            print(f"{record.verdict:6} {record.what}: {record.measured:.3g}")
        elif isinstance(record, Table):
            for row in record.rows:
                print(*(f"{v:.1e}" if isinstance(v, float) else v for v in row), sep=" | ")
