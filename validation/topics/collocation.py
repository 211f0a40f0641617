"""The general solver of Cauchy equations, for equations that the contact's panels do not solve.

Ligament: two collinear cracks of length 1 under unit pressure, the ligament between them shrinking;
the largest relative error of the four stress intensity factors against Willmore's elliptic
integrals (1949) in 40 digits. Closed: sliding parabola and bonded flat punch: largest error of the
traction over the closed form. Growth: a crack with a kernel as narrow as a thin layer's, n
doubling; seconds of the system's solution and its condition number; a last row has the exponent p
of time ~ n^p fitted to it. The kernel is sampled and nodes are made before the clock starts.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np

import sie
from sie.cauchy.system import System
from validation.harness.measures import largest
from validation.harness.records import Claim, Curve, Doing, Record, Table
from validation.rivals.solvers import erdogan_gupta_matrix

mp = mpmath.mp.clone()
mp.dps = 40

TITLE = "Cauchy equations: accuracy and growth of the general solver"
SECONDS = (0.5, 16.0)
TIMED = True

LIGAMENTS = tuple(10.0**-k for k in range(9))
SIZES = (200, 400, 800, 1600)
QUICK_SIZES = (100, 200, 400)
FITTED = 8  # exponents are those of the last eightfold: below, calls cost more than their work
LARGEST_CONDITION = 400  # its singular values cost more than all the rest
REPEATS = 3
ENOUGH = 0.5  # seconds: what takes longer is run once


@dataclass(frozen=True)
class Row:
    case: str
    n: str
    error: float | None = None
    estimated: float | None = None  # the density's own estimate
    condition: float | None = None
    seconds: float | None = None  # the exponent in the last row


def rows(quick: bool = False) -> Iterator[Row]:
    for ligament in LIGAMENTS[::4] if quick else LIGAMENTS:
        yield two_cracks(ligament)
    yield sliding_parabola(0.3)
    yield bonded_punch(0.3)
    yield from growth(QUICK_SIZES if quick else SIZES)


# -- accuracy -------------------------------------------------------------------------------------


def two_cracks(ligament: float, spoiled: float = 0.0) -> Row:
    a = 0.5 * ligament
    density = sie.CauchyEquation(((-1.0 - a, -a), (a, 1.0 + a)), 1.0, total=(0.0, 0.0)).solve()
    inner, outer = (float(K) for K in willmore(a, 1.0 + a))
    exact = np.array([[-outer, inner], [-inner, outer]]) / np.sqrt(2.0 * np.pi)
    error = float(np.abs((1.0 + spoiled) * np.array(density.intensities) / exact - 1.0).max())
    return Row(f"two cracks, ligament {ligament:.0e}", str(density.n), error, density.error)


def willmore(a: float, b: float) -> tuple[Any, Any]:
    """Stress intensity factors at the tips ±a and ±b under unit pressure on a < |x| < b."""
    a, b = mp.mpf(a), mp.mpf(b)
    m = (1 - a / b) * (1 + a / b)
    ratio, root = mp.ellipe(m) / mp.ellipk(m), mp.sqrt((b - a) * (b + a))
    return mp.sqrt(mp.pi / a) * (b * b * ratio - a * a) / root, mp.sqrt(mp.pi * b) * b * (
        1 - ratio
    ) / root


def sliding_parabola(strength: float) -> Row:
    pressure, x, closed = parabola_in_sliding(strength, 1001)
    return Row(
        f"sliding parabola, βf = {strength}",
        str(pressure.n),
        float(np.abs(pressure(x) / closed - 1).max()),
        pressure.error,
    )


def parabola_in_sliding(strength: float, points: int) -> tuple[Any, Any, Any]:
    """The pressure p that solves 1/π PV∫ p/(x - t) dt - β f p = x/2, places, and the closed form.

    β f = strength, E* = R = 1, half-width 1, both ends bounded (Hills, Nowell & Sackfield 1993).
    """
    epsilon = np.arctan(-strength) / np.pi
    c1, c2 = 1.0 - 2.0 * epsilon, 1.0 + 2.0 * epsilon
    pressure = sie.CauchyEquation(
        (-c1, c2), lambda x: 0.5 * x, a=-strength, b=-1.0, ends="bounded"
    ).solve()
    x = np.linspace(-c1, c2, points)[1:-1]
    edges = (c2 - x) ** (0.5 - epsilon) * (c1 + x) ** (0.5 + epsilon)
    return pressure, x, 0.5 * np.cos(np.pi * epsilon) * edges


def bonded_punch(beta: float) -> Row:
    """p + iq under P + iQ = 2 + i (Muskhelishvili 1953, § 114)."""
    eta = np.arctanh(beta) / np.pi
    traction = sie.CauchyEquation((-1.0, 1.0), 0.0, a=1j * beta, b=-1.0, total=2.0 + 1.0j).solve()
    x = np.linspace(-1.0, 1.0, 1001)[1:-1]
    oscillation = np.exp(1j * eta * (np.log1p(x) - np.log1p(-x)))
    closed = (
        (2.0 + 1.0j) / np.pi * np.cosh(np.pi * eta) / np.sqrt((1.0 - x) * (1.0 + x)) * oscillation
    )
    return Row(
        f"bonded punch, β = {beta}",
        str(traction.n),
        float(np.abs(traction(x) / closed - 1).max()),
        traction.error,
    )


# -- growth ---------------------------------------------------------------------------------------


def thin_layer(height: float = 0.02) -> sie.CauchyEquation:
    return sie.CauchyEquation(
        (-1.0, 1.0),
        np.exp,
        k=lambda x, t: 0.5 * height / ((t - x) ** 2 + height**2) / np.pi,
        total=0.0,
    )


def growth(sizes: tuple[int, ...]) -> Iterator[Row]:
    problem, found = thin_layer().problem, []
    for n in sizes:
        system = System(problem, (n,))
        condition = float(np.linalg.cond(system.matrix)) if n <= LARGEST_CONDITION else None
        found.append((n, _seconds(system.solution)))
        yield Row("thin layer", str(n), None, None, condition, found[-1][1])
    measured = np.log([row for row in found if FITTED * row[0] >= sizes[-1]])
    slope = float(np.polyfit(measured[:, 0], measured[:, 1], 1)[0])
    fitted = f"{max(sizes[0], sizes[-1] // FITTED)} to {sizes[-1]}"
    yield Row("exponent of n", fitted, seconds=slope)


def _seconds(run: Callable[[], Any]) -> float:
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
        if times[0] > ENOUGH:
            break
    return min(times)


# -- the page -------------------------------------------------------------------------------------

BAR = 1e-13
SPOILED = 1e-11  # relative error of the control
HEADER = ("case", "n", "error", "estimated", "condition", "time [s]")


def compute(quick: bool = False) -> Iterator[Record]:
    found = []
    for row in rows(quick):
        yield Doing(f"{row.case}, {row.n}")
        found.append(row)
    yield from claims(found)
    yield Table(
        "Accuracy and growth",
        HEADER,
        [(r.case, r.n, r.error, r.estimated, r.condition, r.seconds) for r in found],
    )
    cracks = [r for r in found if r.case.startswith("two cracks")]
    gaps = [float(r.case.split()[-1]) for r in cracks]
    yield Curve(
        "ligament",
        "error of the stress intensity factors",
        gaps,
        [r.error or 0.0 for r in cracks],
        "both",
    )
    yield Curve(
        "ligament",
        "the density's own estimate",
        gaps,
        [r.estimated or 0.0 for r in cracks],
        "dashed",
    )
    layers = [r for r in found if r.case.startswith("thin layer")]
    times = [r.seconds or 0.0 for r in layers]
    yield Curve("layer", "solution", [int(r.n) for r in layers], times, "both")


def claims(found: list[Row]) -> Iterator[Claim]:
    closed = [r for r in found if r.estimated is not None]
    words = f"answers off by {SPOILED:.0e}"
    yield Claim(
        "largest error against elliptic integrals and closed forms", "this project: general solver",
        largest(r.error or 0.0 for r in closed), two_cracks(1.0, SPOILED).error or 0.0, words,
        high=BAR,
    )  # fmt: skip
    conditions = [r.condition for r in found if r.condition is not None]
    dense = np.linalg.cond(erdogan_gupta_matrix(200)[0])
    yield Claim(
        "largest condition number, thin layer",
        "README: 1.7",
        largest(conditions),
        dense,
        "the textbook's unscaled matrix",
        high=2.0,
    )
