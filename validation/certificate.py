"""Does the certificate know? Random contacts, right ones and wrong ones, each with its true error beside the certificate's estimate.

Rounded flats, parabolas, wedges and powers of random sizes, loads and moduli, whose truth is a closed form in 40 digits; half of the
answers are then made wrong, by an amount between 1e-13 and 1e-2 of the peak and in one of several shapes, behind the certificate's back.
The estimate must never be smaller than a third of the true error. That is the largest within 0.95 r of the centre, less what one ulp of x
and of the edges explains.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

import sie
from analytic import hertz, power, rounded_flat, wedge

from .figures import Figure, axes, draw, labelled, legend
from .principal import context
from .records import Claim, Curve, Doing, Found, Record, Table
from .wrong import with_pressure

TITLE = "The certificate against the truth, on random contacts"
SECONDS = (3.0, 30.0)
COUNTS = (120, 2000)
SEED = 20260711
mp = context(40)
SHARE = 1 / 3
PLACES = np.array([-0.93, -0.61, -0.17, 0.08, 0.42, 0.77, 0.949])

Truth = Callable[[Any], Any]


class Judged(NamedTuple):
    kind: str
    true: float
    estimate: float
    wrong: bool


def random_contact(rng: np.random.Generator) -> tuple[str, sie.Scene, Truth]:
    """A scene with half-width b, and its pressure as a function of an mpmath number."""
    kind = str(rng.choice(["rounded flat", "parabola", "wedge", "power"], p=[0.55, 0.1, 0.15, 0.2]))
    b, E, R = (float(10.0 ** rng.uniform(-3, 3)) for _ in range(3))
    if kind == "rounded flat":
        away = float(10.0 ** rng.uniform(-6, -0.3))
        a = b * (away if rng.random() < 0.5 else 1.0 - away)
        profile: sie.Profile = sie.RoundedFlat(a, R)
        form = lambda x: rounded_flat.pressure(x, half_flat=a, radius=R, modulus=E, half_width=b, lib=mp)  # noqa: E731
    elif kind == "parabola":
        profile, form = sie.Parabola(R), lambda x: hertz.pressure(x, radius=R, modulus=E, half_width=b, lib=mp)
    elif kind == "wedge":
        profile, form = sie.Wedge(R), lambda x: wedge.pressure(x, slope=R, modulus=E, half_width=b, lib=mp)
    else:
        m = int(rng.integers(3, 9))
        profile, form = sie.Power(m, R), lambda x: power.pressure(x, exponent=m, coefficient=R, modulus=E, half_width=b, lib=mp)
    return kind, sie.Scene(profile=profile, modulus=E, half_width=b), form


SHAPES: tuple[Callable[[Any], Any], ...] = (
    np.ones_like,
    lambda s: np.sqrt(np.maximum(1 - s * s, 0.0)),
    lambda s: s * np.sqrt(np.maximum(1 - s * s, 0.0)),
    lambda s: np.cos(20 * s),
    lambda s: np.exp(-(((s - 0.31) / 0.05) ** 2)),
    lambda s: 1 / np.sqrt(np.maximum(1 - s * s, 1e-30)),
)


def judged(rng: np.random.Generator, wrong: bool) -> Judged:
    """One contact, solved and judged."""
    kind, scene, form = random_contact(rng)
    solution = sie.solve(scene)
    right, (x1, x2) = solution.pressure, solution.edges
    x = solution.centre + solution.half_width * PLACES
    x = x[[float(np.abs(v - np.array([*scene.profile.breaks, 9e99])).min()) > 1e-4 * solution.half_width for v in x]]
    true = [form(mp.mpf(v)) for v in x.tolist()]
    peak = peak_of(solution)
    values = right
    if wrong:
        size, shape = peak * float(10.0 ** rng.uniform(-13, -2)), SHAPES[int(rng.integers(len(SHAPES)))]
        m, r = solution.centre, solution.half_width

        def values(t: Any) -> Any:
            return right(t) + size * shape((t - m) / r)

        solution = with_pressure(scene, values)
    ulp = np.spacing(max(abs(x1), abs(x2)))
    explained = np.max([np.abs(right(x + d) - right(x)) for d in (-ulp, ulp)], axis=0)
    errors = np.array([abs(float(mp.mpf(float(p)) - t)) for p, t in zip(values(x), true, strict=True)])
    return Judged(kind, float((errors - explained).max().clip(0.0)) / peak, solution.check().error, wrong)


def peak_of(solution: sie.Solution) -> float:
    """The largest pressure, in rims however thin, to within 1e-6 r of the breaks, where it may be infinite."""
    m, r = solution.centre, solution.half_width
    (x1, x2), breaks = solution.edges, np.array(solution.scene.profile.breaks)
    rims = [b + share * ((x2 if b > m else x1) - b) for b in breaks for share in (0.2, 0.4, 0.6)]
    x = np.concatenate((m + r * np.linspace(-0.999, 0.999, 201), breaks - 1e-6 * r, breaks + 1e-6 * r, rims))
    return float(solution.pressure(x[(x > x1) & (x < x2) & ~np.isin(x, breaks)]).max())


def compute(quick: bool) -> Iterator[Record]:
    rng = np.random.default_rng(SEED)
    count = COUNTS[0 if quick else 1]
    found = []
    for k in range(count):
        if k % 50 == 0:
            yield Doing(f"{k} of {count}")
        found.append(judged(rng, wrong=k % 2 == 1))
    yield from claims(found)
    for wrong, label in ((False, "right answers"), (True, "wrong answers")):
        some = [j for j in found if j.wrong == wrong]
        yield Curve("judged", label, [j.true for j in some], [j.estimate for j in some], "points")
    rows = [
        (kind, "wrong" if wrong else "right", len(some), max(j.true for j in some), _least(some))
        for kind in dict.fromkeys(j.kind for j in found)
        for wrong in (False, True)
        if (some := [j for j in found if j.kind == kind and j.wrong == wrong])
    ]
    yield Table("By kind of contact", ("contact", "answers", "how many", "largest true error", "smallest estimate / true error"), rows)


def _least(some: list[Judged]) -> float:
    return min((j.estimate / j.true for j in some if j.true), default=float("inf"))


def claims(found: list[Judged]) -> Iterator[Claim]:
    right, wrong = ([j for j in found if j.wrong == w] for w in (False, True))
    frozen = min(r.estimate for r in right) / max(w.true for w in wrong)
    yield Claim(
        f"smallest estimate over true error, {len(found)} random contacts, half of them made wrong",
        "this project: never less than a third", _least(found), frozen, "the certificate of a right answer on a wrong one", low=SHARE,
    )  # fmt: skip
    yield Claim(
        "largest true error of the right answers", "README: to machine precision", max(j.true for j in right), max(j.true for j in wrong),
        "the wrong answers", high=1e-13,
    )  # fmt: skip
    alarm = [j.estimate / max(j.true, 1e-15) for j in wrong if j.true > 1e-11]
    yield Claim(
        "median of estimate over true error, where the error is above 1e-11: it does not cry wolf", "this page",
        float(np.median(alarm)), float(np.median(alarm)) * 1e4, "an estimate ten thousand times too large", high=100.0,
    )  # fmt: skip


def figures(found: Found) -> Iterator[Figure]:
    drawing, ax = axes()
    curves = found.curves("judged")
    for curve in curves:
        ax.plot(np.maximum(curve.x, 1e-18), curve.y, ".", ms=3, label=curve.label, alpha=0.6, mew=0)
    line = np.array([1e-18, 1e-1])
    draw(ax, [Curve("", "a third of the true error", line, line / 3, "dashed", {"colour": "tab:red"})])
    labelled(ax, "true error of the pressure / peak", "the certificate's estimate", log="xy")
    legend(ax)
    yield Figure(
        "judged", drawing,
        "Each dot is a random contact. Below the line the certificate would have claimed too much. Errors of nothing are drawn at 1e-18.",
    )  # fmt: skip
