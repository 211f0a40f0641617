"""A self-affine profile, repeated: this package, and codes that work on grids.

The codes are the FFT boundary elements of `solvers`, and those that are installed
(pip install -e ".[peers]"). Each has its time and its largest error, on several grids.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

import sie
from validation.harness.records import Claim, Curve, Doing, Record, Table
from validation.rivals import solvers

Array = NDArray[np.float64]
Code = Callable[[Array, float, float], Array]
AHEAD = 1e6  # largest error of the best grid over that of this package
LOADS = 1e-12  # of the load
POINTS = (1024, 16384)
SHORTEST, SLOPE = 64, 0.1  # points on the shortest wave, and the rms slope
GRIDS = ((1024, 4096), (1024, 4096, 16384, 65536))
MEAN = 0.01  # mean pressure, under which about a fifth touches
SEED = 20260711


def rough(n: int) -> sie.Profile:
    """A self-affine profile of Hurst exponent 0.8 through n points, repeated with period 1."""
    rng = np.random.default_rng(SEED)
    k, spectrum = np.arange(4, n // SHORTEST + 1), np.zeros(n // 2 + 1, dtype=complex)
    spectrum[k] = k**-1.3 * np.exp(2j * np.pi * rng.uniform(size=len(k)))
    slope = np.fft.irfft(2j * np.pi * np.arange(n // 2 + 1) * spectrum, n)
    h = np.fft.irfft(spectrum, n) * SLOPE / slope.std()
    turned = np.roll(h, -int(np.argmax(h)))  # the period begins in a valley
    return sie.Periodic(sie.Sampled(np.arange(n + 1) / n, np.append(turned, turned[0])), 1.0)


def grid_codes() -> dict[str, Code]:
    codes: dict[str, Code] = {
        "FFT boundary elements": partial(solvers.boundary_elements, periodic=True)
    }
    for name, (module, solver) in solvers.INSTALLABLE.items():
        if solvers.installed(module):
            codes[name] = solver
    return codes


def timed(profile: sie.Profile, clock: Callable[[], float]) -> tuple[sie.Solution, int, float]:
    """The solution under the mean pressure, the number of its patches, and the seconds."""
    scene = sie.Scene(profile=profile, modulus=1.0, normal_load=MEAN)
    start = clock()
    solution = sie.solve(scene)
    number = len(solution.patches)
    return solution, number, clock() - start


def roughness(quick: bool) -> Iterator[Record]:
    n = POINTS[not quick]
    yield Doing(f"rough profile, {n} points")
    solution, number, ours = timed(rough(n), perf_counter)
    start = perf_counter()
    scene, error = solution.scene, solution.check().error
    checked = ours + perf_counter() - start
    rows: list[tuple[Any, ...]] = [("this package", None, error, 1e3 * ours)]
    yield Curve("rough: race", "this package", [ours], [error], "points",
                {"strong": True, "colour": "black"})  # fmt: skip
    for name, code in grid_codes().items():
        yield Doing(f"rough profile, {name}")
        found = [raced(code, solution, cells) for cells in GRIDS[not quick]]
        yield Curve("rough: race", name, [t for t, _ in found], [e for _, e in found], "both")
        rows += [(name, c, e, 1e3 * t) for c, (t, e) in zip(GRIDS[not quick], found, strict=True)]
    best = min(row[2] for row in rows[1:])
    rows.insert(1, ("this package and its check", None, error, 1e3 * checked))
    yield Claim(
        f"rough profile in {number} patches: largest error of the best grid over the certified "
        "error of this package",
        "this project: what no peer has", best / error, 1.0,
        "the grid's own error", low=AHEAD,
    )  # fmt: skip
    yield Claim(
        "rough profile: loads of the patches, added, less the load, over it",
        "this project: to machine precision", abs(sum(solution.patch_loads) / MEAN - 1.0),
        abs(sum(solution.patch_loads[1:]) / MEAN - 1.0), "one patch left out", high=LOADS,
    )  # fmt: skip
    absent = [
        name for name, (code, _) in solvers.INSTALLABLE.items() if not solvers.installed(code)
    ]
    yield Table(
        f"A rough profile of {n} points in {number} patches, mean pressure {MEAN:g} E*",
        ("method", "cells", "largest error / peak", "time [ms]"),
        rows,
        "Of this package the error is the certified one, the time that of the patches and their "
        "edges. Not raced here: " + (", ".join(f"{a} (not installed)" for a in absent) or "none"),
    )
    yield from _drawn(solution, scene, quick)


def raced(code: Code, solution: sie.Solution, cells: int) -> tuple[float, float]:
    """Seconds of a grid code, and its largest error over the peak pressure."""
    x = (np.arange(cells) + 0.5) / cells
    h = solution.scene.profile.height(x)
    code(h[: cells // 16], 1.0 / cells, MEAN)  # imports and tables of transforms are not timed
    start = perf_counter()
    p = code(h, 1.0 / cells, MEAN)
    seconds, exact = perf_counter() - start, solution.pressure(x)
    return seconds, float(np.abs(p - exact).max() / exact.max())


def _drawn(solution: sie.Solution, scene: sie.Scene, quick: bool) -> Iterator[Record]:
    x = np.linspace(0.0, 1.0, 4001)
    h = scene.profile.height(x)
    # the surface of the half-plane, in the frame of the indenter
    yield Curve("rough", "indenter", x, h - h.min())
    gap = solution.gap(x)
    yield Curve("rough", "surface of the half-plane", x, h - h.min() - gap)
    yield Curve("rough: pressure", "this package", x, solution.pressure(x))
    cells = GRIDS[not quick][0]
    at = (np.arange(cells) + 0.5) / cells
    grid = solvers.boundary_elements(scene.profile.height(at), 1.0 / cells, MEAN, periodic=True)
    k = int(np.argmax(solution.patch_loads))
    (a, b), period = solution.patches[k], 1.0
    near = np.linspace(a, b, 801)
    yield Curve("rough: patch", "this package", near, solution.pressure(near))
    turned = at + period * np.round((0.5 * (a + b) - at) / period)
    some = (turned >= a) & (turned <= b)
    yield Curve("rough: patch", f"FFT boundary elements, {cells} cells", turned[some], grid[some],
                "points")  # fmt: skip
