"""Sampled indenters: the spline's exact pressure, growth with samples, and a noisy trace.

Spline: h at 1000 points, the not-a-knot cubic through them from SciPy; edges by Newton and the
pressure by quadrature, both in 40 digits on that spline, against `sie.Sampled` of the same samples.
Growth: solve, with as many pressures as samples, from 100 to 10^4 of both. Noise: a parabola with
white noise of 1e-4 of its radius; the smoothing is chosen by cross validation, and the half-width
is compared with Hertz. The control is the noise without smoothing, which the package refuses with a
sentence.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from time import perf_counter
from typing import Any
from unittest.mock import patch

import numpy as np
from scipy.interpolate import CubicSpline

import sie
from analytic import hertz
from oracles import normal_contact
from oracles.normal_contact import Pieces, contact, mp
from validation.harness.counting import work
from validation.harness.measures import apart
from validation.harness.records import Claim, Curve, Record, Table, checked, in_turn
from validation.harness.timing import fastest

TITLE = "Sampled profiles: splines, growth, noise"
SECONDS = (3.0, 9.0)
TIMED = False
BAR = 1e-11
SPOILED = 1e-9
# of Gauss-Legendre on each piece of a spline: exact to degree 23, and the pieces are short
NODES = 12
SAMPLES = (150, 1000)
SIZES = ((100, 1000, 3000), (100, 1000, 10_000))
GROWTH = 3.0  # times what is linear: 300 from 100 to 10^4 of pieces and of points
DENSE = 3000
NOISY = (10_000, 100_000)
NOISE = 1e-4  # standard deviation of the heights, R = 1
SEED = 20260711
ONE_PERCENT = 0.01


def compute(quick: bool) -> Iterator[Record]:
    yield from in_turn(
        ("spline in 40 digits", spline(SAMPLES[not quick])),
        ("growth", growth(SIZES[not quick], patience=0.25 if quick else 0.5)),
        ("noise", noise(NOISY[not quick])),
    )


# -- the spline -----------------------------------------------------------------------------------


def heights(x: Any) -> Any:
    """Neither even nor a polynomial, so that no spline is exact."""
    return np.cosh(x) - 1.0 + 0.1 * x**3 + 0.05 * np.abs(x) ** 3


def exact_slope(x: Any, h: Any) -> Pieces:
    """The slope of SciPy's spline through the samples, its doubles taken as exact."""
    spline = CubicSpline(x, h)

    def parabola(origin: Any, c: list[Any], t: Any) -> Any:
        u = t - origin
        return (c[0] * u + c[1]) * u + c[2]

    rows = zip(x.tolist(), spline.derivative().c.T.tolist(), strict=False)
    return Pieces(
        tuple(map(mp.mpf, x.tolist())),
        tuple(partial(parabola, mp.mpf(o), [mp.mpf(v) for v in c]) for o, c in rows),
    )


def spline(n: int) -> Iterator[Record]:
    x = np.linspace(-1.5, 1.6, n)
    solution = sie.solve(
        sie.Scene(profile=sie.Sampled(x, heights(x)), modulus=1.0, normal_load=0.5)
    )
    x1, x2 = solution.edges
    at = np.array([x1 + 1e-3, -0.3, float(x[n // 2]) + 1e-9, 0.123456, x2 - 1e-3])
    with patch.object(
        normal_contact, "gauss_legendre", partial(normal_contact.gauss_legendre, NODES)
    ):
        truth = contact(exact_slope(x, heights(x)), 1.0, solution.edges, load=0.5)
        exact = [truth.pressure(v) for v in at.tolist()]
    compared = (
        ("pressure / peak against 40 digits on the same spline", solution.pressure(at), exact),
        ("edges / half-width", solution.edges, (truth.x1, truth.x2)),
    )
    for what, found, true in compared:
        yield checked(
            partial(apart, found, true),
            1.0,
            1.0 + SPOILED,
            what=f"spline through {n} samples: error of the {what}",
            by="README",
            named=f"answers off by {SPOILED:.0e}",
            high=BAR,
        )
    s = np.linspace(x1, x2, 401)
    yield Curve("spline", f"spline through {n} samples", s, solution.pressure(s))
    yield Curve("spline", "40 digits", at, [float(p) for p in exact], "points")


# -- growth ---------------------------------------------------------------------------------------


def program(n: int) -> Callable[[], Any]:
    """Solve, and n pressures, of n samples."""
    t, at = np.linspace(-1.5, 1.6, n), np.linspace(-0.9, 0.9, n)
    profile = sie.Sampled(t, heights(t))
    _ = profile.pieces  # the spline itself is SciPy's
    return lambda: sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=0.95)).pressure(at)


def dense(n: int) -> Callable[[], Any]:
    """One logarithm for each piece and point."""
    e, x = np.linspace(-1.0, 1.0, n), np.linspace(-0.9, 0.9, n)
    return lambda: np.log(np.abs(x[:, None] - e[None, :] + 1e-9)).sum(axis=1)


def growth(sizes: Sequence[int], patience: float) -> Iterator[Record]:
    ours, others = [program(n) for n in sizes], [dense(sizes[0]), dense(DENSE)]
    times, (few, many) = fastest(ours, patience), fastest(others, patience=0.2)
    yield Curve(
        "growth",
        "this package",
        sizes,
        [1e3 * t for t in times],
        "both",
        {"colour": "black", "strong": True},
    )
    yield Curve(
        "growth",
        "a logarithm for each piece and point",
        (sizes[0], DENSE),
        [1e3 * few, 1e3 * many],
        "both",
    )
    yield Claim(
        f"steps of {sizes[-1]} samples and {sizes[-1]} pressures over those of {sizes[0]} and "
        f"{sizes[0]}",
        "this project: close to linear",
        work(ours[-1]).steps / work(ours[0]).steps,
        work(others[1]).steps / work(others[0]).steps,
        f"a dense sum, at {DENSE} already",
        high=GROWTH * sizes[-1] / sizes[0],
    )


# -- noise ----------------------------------------------------------------------------------------


def noisy(n: int, smoothing: Any) -> sie.Scene:
    x = np.linspace(-2.0, 2.0, n)
    h = 0.5 * x * x + NOISE * np.random.default_rng(SEED).standard_normal(n)
    return sie.Scene(
        profile=sie.Sampled(x, h, smoothing=smoothing), modulus=1.0, normal_load=np.pi / 4
    )


def noise(n: int) -> Iterator[Record]:
    b = float(hertz.half_width(normal_load=np.pi / 4, radius=1.0, modulus=1.0))
    start = perf_counter()
    solution = sie.solve(noisy(n, "gcv"))
    measured = _error_of_width(solution, b)
    x = np.linspace(-1.0, 1.0, 401)
    p = solution.pressure(x)
    seconds = perf_counter() - start
    yield Claim(
        f"trace of {n} points with noise: error of the half-width under a load",
        "this project: within 1 %",
        measured,
        _error_of_width(sie.solve(noisy(3000, 100.0)), b),
        "smoothing by which the curvature is lost too",
        high=ONE_PERCENT,
    )
    smooth: Any = solution.scene.profile
    exact = hertz.pressure(x, radius=1.0, modulus=1.0, half_width=b)
    rms = float(np.sqrt(np.mean((p - exact) ** 2)))
    width = solution.half_width / b - 1.0
    yield Table(
        "A trace with noise",
        ("points", "noise / R", "λ of the smoothing", "misfit / R", "half-width / Hertz - 1",
         "rms of p / peak", "time [s]"),
        [(n, NOISE, smooth.lam, smooth.misfit, width, 2.0 * rms, seconds)],
        "The time is that of smoothing, solving and 401 pressures, once.",
    )  # fmt: skip
    yield Curve("noise", f"{n} points, smoothed by cross validation", x, p)
    yield Curve("noise", "Hertz", x, exact, "dashed")
    some = slice(None, None, n // 200)
    x, parabola = smooth.points[some], 0.5 * smooth.points[some] ** 2
    yield Curve("trace", "less the parabola", x, smooth.heights[some] - parabola, "points")
    yield Curve("trace", "the spline's", x, smooth.height(x) - parabola)


def _error_of_width(solution: sie.Solution, b: float) -> float:
    try:
        return abs(solution.half_width / b - 1.0)
    except sie.ContactError:
        return float("inf")


# -- drawing --------------------------------------------------------------------------------------
