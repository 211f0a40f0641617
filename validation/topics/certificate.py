"""The certificate against the truth: random contacts, right and wrong, with their true errors.

Rounded flats, parabolas, wedges and powers, sliding parabolas and rounded flats of dissimilar
bodies, parabolas known by samples, and the shear of rounded flats in partial slip, of random sizes,
loads and moduli, whose truth is a closed form in 22 digits. Half of the answers are then made
wrong, by an amount between 1e-13 and 1e-2 of the peak and in one of several shapes, of which the
certificate has no information. The estimate must never be smaller than a third of the true error.
The true error is the largest at one to three random places within 0.95 r of the centre, over the
peak (of f p, for a shear), less what one ulp of x and of the edges explains; of a trace also less
what the rounding of its spline explains.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

import sie
from analytic import (
    cattaneo_rounded,
    hertz,
    power,
    rounded_flat,
    sliding_hertz,
    sliding_rounded_flat,
    wedge,
)
from oracles.principal_value import context
from validation.harness.measures import largest, smallest
from validation.harness.records import Claim, Curve, Doing, Record, Table
from validation.wrong_programs.pressures import with_pressure, with_shear

TITLE = "The certificate against the truth, on random contacts"
SECONDS = (1.5, 50.0)
TIMED = False
COUNTS = (100, 2000)
SEED = 20260711
mp = context(22)
SHARE = 1 / 3
REACH = 0.95  # of the half-width
AT = 3  # places in each contact; one where the closed form is an integral or an iteration

Truth = Callable[[Any], Any]


class Judged(NamedTuple):
    kind: str
    true: float
    estimate: float
    wrong: bool


class Contact(NamedTuple):
    """`form` is the truth of `quantity`, a function of an mpmath number; `rounding` what the
    profile's own doubles do to it.
    """

    kind: str
    scene: sie.Scene
    form: Truth
    quantity: str = "pressure"
    rounding: float = 0.0
    places: int = AT


def random_contact(rng: np.random.Generator) -> Contact:
    """A contact of a random kind, with half-width b or under a load."""
    kind = str(rng.choice(list(KINDS), p=list(KINDS.values())))
    b, E, R = (float(10.0 ** rng.uniform(-3, 3)) for _ in range(3))
    return MAKERS[kind](kind, rng, (b, E, R))


def _away(rng: np.random.Generator, b: float) -> float:
    """Half a flat base in a contact of half-width b: next to nothing, or next to all of it."""
    away = float(10.0 ** rng.uniform(-6, -0.3))
    return b * (away if rng.random() < 0.5 else 1.0 - away)


def _pressed(kind: str, rng: np.random.Generator, sizes: tuple[float, float, float]) -> Contact:
    b, E, R = sizes
    if kind == "rounded flat":
        a = _away(rng, b)
        profile: sie.Profile = sie.RoundedFlat(a, R)
        punch = {"half_flat": a, "radius": R, "modulus": E, "half_width": b}
        form = lambda x: rounded_flat.pressure(x, **punch, lib=mp)  # noqa: E731
    elif kind == "parabola":
        profile, form = (
            sie.Parabola(R),
            lambda x: hertz.pressure(x, radius=R, modulus=E, half_width=b, lib=mp),
        )
    elif kind == "wedge":
        profile, form = (
            sie.Wedge(R),
            lambda x: wedge.pressure(x, slope=R, modulus=E, half_width=b, lib=mp),
        )
    else:
        m = int(rng.integers(3, 9))
        profile, form = (
            sie.Power(m, R),
            lambda x: power.pressure(x, exponent=m, coefficient=R, modulus=E, half_width=b, lib=mp),
        )
    return Contact(
        kind,
        sie.Scene(profile=profile, modulus=E, half_width=b),
        form,
        places=1 if kind == "power" else AT,
    )


def _sliding(kind: str, rng: np.random.Generator, sizes: tuple[float, float, float]) -> Contact:
    b, E, R = sizes
    coupling = float(rng.uniform(-0.49, 0.49))
    common: dict[str, Any] = {
        "modulus": E,
        "dundurs": coupling / 2.0,
        "friction": 2.0,
        "sliding": 1,
    }
    if kind == "sliding parabola":
        given = {
            "half_width": b,
            "radius": R,
            "modulus": E,
            "coupling": mp.mpf(coupling),
            "lib": mp,
        }
        return Contact(
            kind,
            sie.Scene(profile=sie.Parabola(R), half_width=b, **common),
            lambda x: sliding_hertz.pressure(x, **given),
        )
    a, P = b * float(rng.uniform(0.1, 0.9)), E * b * b / R * float(10.0 ** rng.uniform(-2, 0))
    given = {
        "normal_load": P,
        "half_flat": a,
        "radius": R,
        "modulus": E,
        "coupling": mp.mpf(coupling),
        "lib": mp,
    }
    scene = sie.Scene(profile=sie.RoundedFlat(a, R), normal_load=P, **common)
    return Contact(kind, scene, lambda x: sliding_rounded_flat.pressure(x, **given), places=1)


def _sampled(kind: str, rng: np.random.Generator, sizes: tuple[float, float, float]) -> Contact:
    """A parabola at random points: its spline is the parabola, but for the rounding of the spline's
    coefficients.
    """
    b, E, _ = sizes
    x = b * np.sort(np.concatenate(([-2.0, 2.0], rng.uniform(-1.9, 1.9, int(rng.integers(8, 30))))))
    x = x[np.concatenate(([True], np.diff(x) > 1e-3 * b))]
    R = b  # so that the heights are of the order of b
    profile = sie.Sampled(x, 0.5 * x * x / R)
    t = np.concatenate([x, x[:-1] + 1e-6 * b, 0.5 * (x[1:] + x[:-1])])
    t = t[(np.abs(t) < b)]
    # p/peak is about twice the change of slope, the peak being E* b/(2R).
    rounding = 2.0 * float(np.abs(profile.slope(t) - t / R).max())
    scene = sie.Scene(profile=profile, modulus=E, half_width=b)
    return Contact(
        kind,
        scene,
        lambda v: hertz.pressure(v, radius=R, modulus=E, half_width=b, lib=mp),
        rounding=rounding,
    )


def _slipping(kind: str, rng: np.random.Generator, sizes: tuple[float, float, float]) -> Contact:
    b, E, R = sizes
    a, P = b * float(rng.uniform(0.05, 0.9)), E * b * b / R * float(10.0 ** rng.uniform(-2, 0))
    f, share = float(rng.uniform(0.1, 1.0)), float(rng.uniform(0.05, 0.95))
    Q = share * f * P
    given = {
        "normal_load": P,
        "half_flat": a,
        "radius": R,
        "modulus": E,
        "friction": f,
        "tangential_load": mp.mpf(Q),
        "lib": mp,
    }
    scene = sie.Scene(
        profile=sie.RoundedFlat(a, R), modulus=E, normal_load=P, friction=f, tangential_load=Q
    )
    return Contact(kind, scene, lambda x: cattaneo_rounded.shear(x, **given), "shear", places=1)


MAKERS: dict[str, Callable[[str, np.random.Generator, tuple[float, float, float]], Contact]] = {
    **dict.fromkeys(("rounded flat", "parabola", "wedge", "power"), _pressed),
    **dict.fromkeys(("sliding parabola", "sliding rounded flat"), _sliding),
    "samples": _sampled,
    "partial slip": _slipping,
}
KINDS = dict(zip(MAKERS, (0.4, 0.05, 0.1, 0.15, 0.1, 0.05, 0.05, 0.1), strict=True))  # how often


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
    made = random_contact(rng)
    solution = sie.solve(made.scene)
    m, r, (x1, x2) = solution.centre, solution.half_width, solution.edges
    x = m + r * rng.uniform(-REACH, REACH, made.places)
    ends = [*made.scene.profile.breaks, *(c for zone in solution.stick for c in zone), 9e99]
    if made.kind != "samples":
        x = x[np.abs(x[:, None] - np.array(ends)).min(axis=1) > 1e-4 * r]
    right = getattr(solution, made.quantity)
    true = [made.form(mp.mpf(v)) for v in x.tolist()]
    peak = peak_of(solution) * (made.scene.friction if made.quantity == "shear" else 1.0)
    values = right
    if wrong:
        size, shape = (
            peak * float(10.0 ** rng.uniform(-13, -2)),
            SHAPES[int(rng.integers(len(SHAPES)))],
        )

        def values(t: Any) -> Any:
            return right(t) + size * shape((t - m) / r)

        solution = (with_shear if made.quantity == "shear" else with_pressure)(made.scene, values)
    ulp = np.spacing(max(abs(x1), abs(x2)))
    explained = (
        np.max([np.abs(right(x + d) - right(x)) for d in (-ulp, ulp)], axis=0)
        + made.rounding * peak
    )
    errors = np.array(
        [abs(float(mp.mpf(float(p)) - t)) for p, t in zip(values(x), true, strict=True)]
    )
    found = solution.check()
    estimate = (
        found.shear.error if made.quantity == "shear" and found.shear is not None else found.error
    )
    return Judged(
        made.kind, float((errors - explained).max(initial=0.0).clip(0.0)) / peak, estimate, wrong
    )


def peak_of(solution: sie.Solution) -> float:
    """The largest pressure, in rounded edges however thin, to within 1e-6 r of the breaks, where it
    may be infinite.
    """
    m, r = solution.centre, solution.half_width
    (x1, x2), breaks = solution.edges, np.array(solution.scene.profile.breaks)
    rims = [b + share * ((x2 if b > m else x1) - b) for b in breaks for share in (0.2, 0.4, 0.6)]
    x = np.concatenate(
        (m + r * np.linspace(-0.999, 0.999, 201), breaks - 1e-6 * r, breaks + 1e-6 * r, rims)
    )
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
        (
            kind,
            "wrong" if wrong else "right",
            len(some),
            largest(j.true for j in some),
            _least(some),
        )
        for kind in dict.fromkeys(j.kind for j in found)
        for wrong in (False, True)
        if (some := [j for j in found if j.kind == kind and j.wrong == wrong])
    ]
    yield Table(
        "By kind of contact",
        ("contact", "answers", "how many", "largest true error", "smallest estimate / true error"),
        rows,
    )


def _least(some: list[Judged]) -> float:
    return smallest(j.estimate / j.true if j.true else float("inf") for j in some)


def claims(found: list[Judged]) -> Iterator[Claim]:
    right, wrong = ([j for j in found if j.wrong == w] for w in (False, True))
    frozen = _least([w._replace(estimate=largest(r.estimate for r in right)) for w in wrong])
    yield Claim(
        f"smallest estimate over true error, {len(found)} random contacts, half of them made wrong",
        "this project: never less than a third", _least(found), frozen,
        "wrong answers with the largest estimate of a right one", low=SHARE,
    )  # fmt: skip
    yield Claim(
        "largest true error of the right answers", "README: to machine precision",
        largest(j.true for j in right), largest(j.true for j in wrong),
        "the wrong answers", high=1e-13,
    )  # fmt: skip
    alarm = [j.estimate / max(j.true, 1e-15) for j in wrong if j.true > 1e-11]
    yield Claim(
        "median of estimate over true error, where the error is above 1e-11",
        "this page",
        float(np.median(alarm)), float(np.median(alarm)) * 1e4,
        "an estimate ten thousand times too large", high=100.0,
    )  # fmt: skip
