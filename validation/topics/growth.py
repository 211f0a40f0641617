"""Growth of work and memory with pieces, points, patches and steps of a path.

The work is counted in steps; the time is drawn. The pieces are those of the profile, the patches
those of a Cauchy equation. These are coupled by a dense matrix and grow faster
than the rest; no claim is made of them.

Straight lines in a diagram of logarithms; the exponent is that of the last three sizes. The control
is a dense sum.
"""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

import sie
from validation.harness.counting import work
from validation.harness.records import Claim, Curve, Doing, Record
from validation.harness.timing import fastest

TITLE = "Growth with pieces and points"
SECONDS = (2.5, 10.0)
TIMED = True
LINEAR = 1.25  # exponent: linear, and logarithms
SIZES = {
    "pieces": ((100, 300, 1000), (100, 300, 1000, 3000, 10_000)),
    "points": ((100_000, 300_000, 1_000_000), (1000, 10_000, 30_000, 100_000, 300_000, 1_000_000)),
    "patches": ((4, 8, 16), (8, 16, 32, 64)),
    "steps": ((25, 50, 100), (100, 300, 1000)),
    "pairs": ((200, 600, 1800), (200, 600, 1800)),
}


def of_pieces(n: int) -> Callable[[], Any]:
    """Solve, and 101 pressures, with half of n pieces in contact: the corners of a parabola in
    facets of its slope.
    """
    x = np.linspace(-0.99, 0.99, 101)
    breaks = np.linspace(-2.0, 2.0, n + 1)
    rise = np.diff(breaks) * (1.0 + 0.5 * np.sin(np.arange(n)))
    slope = np.concatenate(([0.0], np.cumsum(rise))) - 0.5 * rise.sum()
    curvature = rise / np.diff(breaks)
    rows = np.stack((slope[:-1] - curvature * breaks[:-1], curvature), axis=1)
    profile = sie.Piecewise(breaks.tolist(), rows.tolist())
    scene = sie.Scene(profile=profile, modulus=1.0, normal_load=0.5)
    return lambda: sie.solve(scene).pressure(x)


def of_points(n: int) -> Callable[[], Any]:
    pressure = sie.solve(
        sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, half_width=1.0)
    ).pressure
    x = np.linspace(-1.0, 1.0, n)
    return lambda: pressure(x)


def of_patches(n: int) -> Callable[[], Any]:
    """n like flats in a row, each under 1/n, 8 unknowns a patch."""
    lo = np.arange(n, dtype=float)
    equation = sie.CauchyEquation(
        tuple((float(a), float(a) + 0.5) for a in lo),
        g=0.0,
        b=-1.0,
        ends="singular",
        total=(1.0 / n,) * n,
    )
    return lambda: equation.solve(n=8)


def of_steps(n: int) -> Callable[[], Any]:
    """Stick zones after each of n steps of a cycle of the rounded flat."""
    scene = sie.Scene(
        profile=sie.RoundedFlat(0.7, 1.0), modulus=2.0, normal_load=0.375, friction=0.5
    )
    path = sie.Path(
        [(0.375, 0.15 * float(np.sin(t))) for t in np.linspace(0.0, 2.0 * np.pi, n + 1)[1:]]
    )
    return lambda: [solution.stick for solution in sie.follow(scene, path)]


def of_pairs(n: int) -> Callable[[], Any]:
    """A program without fast sums: a logarithm for each piece and point."""
    e, x = np.linspace(-1.0, 1.0, n), np.linspace(-0.9, 0.9, n)
    return lambda: np.log(np.abs(x[:, None] - e[None, :]) + 1e-300).sum(axis=1)


MEASURED = {
    "pieces": (of_pieces, "solve and 101 pressures, n pieces"),
    "points": (of_points, "n pressures of the rounded punch"),
    "patches": (of_patches, "Cauchy equation on n patches"),
    "steps": (of_steps, "stick zones after n steps of a cycle"),
    "pairs": (of_pairs, "a logarithm for each of n pieces and n points"),
}


def exponent(sizes: Sequence[float], values: Sequence[float]) -> float:
    """The exponent of growth over the last three sizes."""
    return float(np.polyfit(np.log(sizes[-3:]), np.log(values[-3:]), 1)[0])


def peak_memory(run: Callable[[], Any]) -> float:
    """Bytes."""
    tracemalloc.start()
    try:
        run()
        return float(tracemalloc.get_traced_memory()[1])
    finally:
        tracemalloc.stop()


def compute(quick: bool) -> Iterator[Record]:
    steps, memory = {}, {}
    for name, (make, says) in MEASURED.items():
        yield Doing(says)
        sizes = SIZES[name][0 if quick else 1]
        runs = [make(n) for n in sizes]
        seconds = fastest(runs, patience=0.1 if quick else 0.5)
        steps[name] = exponent(sizes, [work(run).steps for run in runs])
        yield Curve("time", says, sizes, [1e3 * s for s in seconds], "both")
        used = [peak_memory(run) for run in runs]
        memory[name] = exponent(sizes, used)
        yield Curve("memory", says, sizes, [u / 2**20 for u in used], "both")
    for name in ("pieces", "points", "steps"):
        what = MEASURED[name][1]
        by, wrong = "this project: close to linear", MEASURED["pairs"][1]
        yield Claim(
            f"{what}: exponent of steps", by, steps[name], steps["pairs"], wrong, high=LINEAR
        )
        yield Claim(
            f"{what}: exponent of memory", by, memory[name], memory["pairs"], wrong, high=LINEAR
        )
