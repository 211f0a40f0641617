"""Further races: the potential in the body, the shear of partial slip, and sampled profiles."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np

import sie
from analytic import cattaneo_rounded, rounded_flat
from oracles.principal_value import context
from validation.harness.records import Doing, Record, checked
from validation.harness.timing import compared
from validation.rivals import solvers
from validation.rivals.race import PATIENCE, PROMISE, Point, closed_form, curve

DEPTH = 0.01  # half-widths
NODES = (8, 32, 128, 512, 2048)
FORM: dict[str, Any] = {"half_flat": 0.5, "half_width": 1.0, "radius": 1.0, "modulus": 1.0}
Runner = Callable[[int], Callable[[], Any]]
mp = context(25)


def further(quick: bool) -> Iterator[Record]:
    yield from interior(quick)
    yield from partial_slip(quick)
    yield from sampled(quick)


def _points(make: Runner, sizes: Sequence[int], error: Callable[[Any], float]) -> list[Point]:
    found = []
    for n in sizes:
        run = make(n)
        found.append((n, error(run()), *compared(run, closed_form, PATIENCE / 3)))
    return found


def interior(quick: bool) -> Iterator[Record]:
    """The potential F of the rounded punch at a depth of 0.01 b, by three methods.

    They are a closed form in each panel, quadrature, and the paper's series.
    """
    yield Doing("interior")
    density = sie.solve(
        sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, half_width=1.0)
    ).pressure
    z = np.linspace(-1.2, 1.2, 1001) + 1j * DEPTH
    truth = np.array(
        [complex(rounded_flat.potential(mp.mpc(v), **FORM, lib=mp)) for v in z[::40].tolist()]
    )

    def error(values: Any) -> float:
        return float(np.abs(values[::40] - truth).max() / np.abs(truth).max())

    quadrature, series = partial(_by_quadrature, density, z), partial(_by_series, z)
    name = "race: interior, depth 0.01 b"
    says = "Potential F(z) of the rounded punch at 1001 points, a/b = 0.5"
    nodes = NODES[: 4 if quick else 5]
    yield curve(
        name, "this package", _points(lambda n: lambda: density.cauchy(z), (0,), error), says=says
    )
    yield curve(
        name, "Gauss quadrature of the potential", _points(quadrature, nodes, error), says=says
    )
    yield curve(name, "the series (22), (23)", _points(series, nodes[:4], error), says=says)
    yield checked(
        error, density.cauchy(z), quadrature(64)(),
        what="potential at a depth of 0.01 b: error over its largest value",
        by="README: to machine precision", named="Gauss quadrature with 64 nodes", high=PROMISE,
    )  # fmt: skip


def _by_quadrature(density: sie.Density, z: Any, n: int) -> Callable[[], Any]:
    theta = np.arange(1, n + 1) * np.pi / (n + 1)
    t, weight = np.cos(theta), np.sin(theta) / (n + 1)
    return lambda: (1 / (z[:, None] - t)) @ (density(t) * weight)


def _by_series(z: Any, n: int) -> Callable[[], Any]:
    def run() -> Any:
        b = rounded_flat.chebyshev_coefficients(n, **FORM)
        R = 1 / (z + np.sqrt(z - 1) * np.sqrt(z + 1))
        return R * np.polynomial.polynomial.polyval(R * R, b)

    return run


def partial_slip(quick: bool) -> Iterator[Record]:
    """The shear q = f (p_b - p_c) of the rounded punch, Q = 0.6 f P.

    Each method computes the zones and two pressures.
    """
    yield Doing("partial slip")
    scene = sie.Scene(
        profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.3, friction=0.5,
        tangential_load=0.09,
    )  # fmt: skip
    solution = sie.solve(scene)
    b = solution.half_width
    samples = b * np.array([-0.97, -0.8, -0.51, -0.2, 0.05, 0.33, 0.62, 0.9, 0.99])
    x = np.concatenate((samples, np.linspace(-b, b, 994)[1:-1]))
    given = {"normal_load": 0.3, "friction": 0.5, "tangential_load": 0.09} | {
        "half_flat": 0.5, "radius": 1.0, "modulus": 1.0, "lib": mp
    }  # fmt: skip
    truth = np.array([float(cattaneo_rounded.shear(mp.mpf(v), **given)) for v in samples.tolist()])

    def error(values: Any) -> float:
        return float(np.abs(values[: len(samples)] - truth).max() / truth.max())

    def package(n: int) -> Callable[[], Any]:
        return lambda: sie.solve(scene).shear(x)

    series = partial(_two_series, solution, x)
    name = "race: partial slip"
    says = "Shear of the rounded punch, a = 1/2, R = 1, Q = 0.6 f P, at 1001 points"
    sizes = NODES[:3] if quick else (*NODES, 8192)
    yield curve(name, "this package", _points(package, (0,), error), says=says)
    yield curve(name, "Gauss-Chebyshev, one series", _points(series, sizes, error), says=says)
    yield checked(
        error, package(0)(), series(32)(), what="partial slip: error of the shear over its peak",
        by="README: to machine precision",
        named="two Chebyshev series of 32 terms", high=PROMISE,
    )  # fmt: skip


def _two_series(solution: sie.Solution, x: Any, n: int) -> Callable[[], Any]:
    """The shear at x by Gauss-Chebyshev series of n terms on the contact and on the stick zone."""
    scene, b, c = solution.scene, solution.half_width, solution.stick[0][1]
    slope, inside = scene.profile.slope, np.abs(x) < c

    def run() -> Any:
        q = solvers.gauss_chebyshev(slope, -b, b, n, x)
        q[inside] -= solvers.gauss_chebyshev(slope, -c, c, n, x[inside])
        return scene.friction * q

    return run


def sampled(quick: bool) -> Iterator[Record]:
    """A profile given at n points: the error is that of the interpolation, or of the elements."""
    yield Doing("sampled")
    load = np.pi / 4
    smooth = sie.FromFunction(np.sinh, domain=(-20.0, 20.0), parity="even")
    exact = sie.solve(sie.Scene(profile=smooth, modulus=1.0, normal_load=load))
    x = np.linspace(-0.95, 0.95, 1001) * exact.half_width
    truth = exact.pressure(x)

    def profile(n: int) -> tuple[Any, Any]:
        t = 3.2 * ((np.arange(n) + 0.5) / n - 0.5)
        return t, np.cosh(t) - 1.0

    def package(n: int) -> Callable[[], Any]:
        t, h = profile(n)
        return lambda: sie.solve(
            sie.Scene(profile=sie.Sampled(t, h), modulus=1.0, normal_load=load)
        ).pressure(x)

    def elements(n: int) -> Callable[[], Any]:
        t, h = profile(n)
        return lambda: np.interp(x, t, solvers.boundary_elements(h, float(t[1] - t[0]), load))

    def error(values: Any) -> float:
        return float(np.abs(values - truth).max() / truth.max())

    name, says = (
        "race: sampled",
        "Profile h = cosh x - 1 known at n points; truth: the profile as a function, itself held "
        "to 40 digits above",
    )
    sizes = (16, 64) if quick else (16, 32, 64, 128, 256)
    ours, theirs = _points(package, sizes, error), _points(elements, sizes, error)
    yield curve(name, "this package", ours, says=says)
    yield curve(name, "FFT boundary elements", theirs, says=says)
    yield checked(
        lambda errors: errors[1] / errors[0], (ours[-1][1], theirs[-1][1]),
        (theirs[-1][1], ours[-1][1]),
        what=f"sampled at {sizes[-1]} points: the elements' error over this package's",
        by="this project: what no peer has",
        named="the two exchanged", low=100.0,
    )  # fmt: skip
