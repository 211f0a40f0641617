"""The contacts on which the methods race: a scene, the exact pressure at some points, and the cost
of a closed form as the unit of time.

E* = 1. Where a closed form exists it is evaluated in mpmath; else quadrature in 40 digits, or in 25
for sliding.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

import sie
from analytic import rounded_flat, wedge
from oracles.principal_value import context
from validation import cases

Array = np.ndarray[Any, Any]
POINTS = 1001
SAMPLES = 24  # of them, at which the truth is known
mp = context(25)
REACH = 75  # in u, s = tanh u: beyond, less than the 25 digits is left


@dataclass(frozen=True)
class Problem:
    """`scene` for the package, `slope` on [lo, hi] for the peers, and the exact `truth(x)`.

    The truth of a float has more than 16 digits.
    """

    name: str
    says: str
    scene: sie.Scene
    truth: Callable[[float], Any]
    slope: Callable[[Array], Array]
    gap: Callable[[Array], Array] | None = (
        None  # for boundary elements, with `closed` at many points
    )
    closed: Callable[[Array], Array] | None = None
    # whether Gauss-Chebyshev and Erdogan-Gupta apply: not where the exponents leave 1/2
    series: bool = True
    epsilon: float = 0.0
    period: float = 0.0
    places: tuple[float, ...] = field(default=())  # further samples, in s

    @cached_property
    def solution(self) -> sie.Solution:
        return sie.solve(self.scene)

    @cached_property
    def edges(self) -> tuple[float, float]:
        return self.solution.edges

    @cached_property
    def samples(self) -> Array:
        """Points off every grid, to within 1e-3 of the edges, and next to the kinks."""
        s = np.array([*np.cos((np.arange(SAMPLES) + 0.37) * np.pi / (SAMPLES + 0.2)), *self.places])
        return 0.5 * (self.edges[0] + self.edges[1]) + 0.5 * (self.edges[1] - self.edges[0]) * s

    @cached_property
    def x(self) -> Array:
        """The points of the pressure: the samples first, POINTS together."""
        inner = np.linspace(*self.edges, POINTS - len(self.samples) + 2)[1:-1]
        return np.concatenate((self.samples, inner))

    @cached_property
    def expected(self) -> Array:
        return np.array([float(self.truth(x)) for x in self.samples.tolist()])

    def error(self, p: Array) -> float:
        """The largest error over the peak, of pressures at `x`, whose first points are the
        samples.
        """
        return float(np.abs(p[: len(self.samples)] - self.expected).max() / self.expected.max())


def kinked(ratio: float) -> Problem:
    """The rounded punch, a/b = ratio, R = b = 1."""
    punch = {"half_flat": ratio, "half_width": 1.0, "radius": 1.0, "modulus": 1.0}
    profile = sie.RoundedFlat(ratio, 1.0)
    near = (
        ratio,
        ratio + 0.1 * (1 - ratio),
        ratio + 0.6 * (1 - ratio),
        -ratio + 1e-3 * (1 - ratio),
    )
    return Problem(
        f"kinked, a/b = {ratio:g}", "Flat punch with rounded edges, b = R",
        sie.Scene(profile=profile, modulus=1.0, half_width=1.0),
        truth=lambda x: rounded_flat.pressure(x, **punch, lib=mp), slope=profile.slope,
        gap=profile.height,
        closed=lambda x: rounded_flat.pressure(x, **punch), places=near,
    )  # fmt: skip


def _wedge() -> Problem:
    profile = sie.Wedge(0.5)
    return Problem(
        "wedge", "Wedge h = |x|/2, r = 1: h' jumps",
        sie.Scene(profile=profile, modulus=1.0, half_width=1.0),
        truth=lambda x: wedge.pressure(x, slope=0.5, half_width=1.0, modulus=1.0, lib=mp),
        slope=profile.slope, gap=profile.height,
        closed=lambda x: wedge.pressure(x, slope=0.5, half_width=1.0, modulus=1.0),
        places=(0.01, -0.002),
    )  # fmt: skip


def _of_case(name: str, case: cases.Case, says: str) -> Problem:
    """The truth is the 40-digit quadrature."""
    return Problem(
        name,
        says,
        case.scene,
        lambda x: cases.exact(case).pressure(x),
        lambda x: case.profile.slope(x) + case.tilt,
        gap=case.profile.height,
    )


def sliding(coupling: float = 0.3) -> Problem:
    """A rounded flat that slides on a dissimilar body: βf = coupling, a = 1/2, R = 1, half-width
    1.
    """
    profile = sie.RoundedFlat(0.5, 1.0)
    scene = sie.Scene(
        profile=profile,
        modulus=1.0,
        dundurs=0.5 * coupling,
        friction=2.0,
        sliding=1,
        half_width=1.0,
    )
    return Problem(
        f"sliding, βf = {coupling:g}", "Rounded flat on a dissimilar body, a = 1/2, r = R = 1",
        scene, Sliding(coupling).pressure,
        profile.slope, series=False, epsilon=-math.atan(coupling) / math.pi,
    )  # fmt: skip


class Sliding:
    """The sliding rounded flat by quadrature: p = E*/2 cos²(πε)/π w ∫ (H(t) - H_x(x)) / (w (t - x))
    dt, H_x the piece at x, continued.

    With w = (t - x1)^(1/2+ε) (x2 - t)^(1/2-ε); the centre from ∫ H/w dt = 0. (Muskhelishvili 1953,
    §§ 107-113.)
    """

    def __init__(
        self, coupling: float, half_flat: float = 0.5, radius: float = 1.0, half_width: float = 1.0
    ) -> None:
        self.epsilon = -mp.atan(mp.mpf(coupling)) / mp.pi
        self.a, self.R, self.r = mp.mpf(half_flat), mp.mpf(radius), mp.mpf(half_width)
        self._kept: dict[Any, tuple[Any, Any]] = {}
        self.m = mp.findroot(
            self._condition, (mp.mpf(-0.1) * coupling, mp.mpf(0.1) * coupling), tol=1e-40
        )

    def _pieces(self) -> tuple[Callable[[Any], Any], ...]:
        return (
            (lambda t: (t + self.a) / self.R),
            (lambda t: 0 * t),
            (lambda t: (t - self.a) / self.R),
        )

    def _integral(self, f: Callable[[int, Any], Any], m: Any) -> Any:
        """∫ f(piece, t)/w dt in the variable u, s = tanh u, where the ends are exponentially far; s
        from the nearer end.
        """
        total = mp.zero
        cuts = [-mp.inf, mp.atanh((-self.a - m) / self.r), mp.atanh((self.a - m) / self.r), mp.inf]
        for k in range(3):
            # dt/w = ds (1+s)^(-1/2-ε) (1-s)^(-1/2+ε) = sech(u) exp(-2εu) du
            lo, hi = (max(c, -REACH) if k == 0 else c for c in (cuts[k], min(cuts[k + 1], REACH)))
            steps = max(int(mp.ceil((hi - lo) / 2)), 2)
            nodes = mp.linspace(lo, hi, min(steps, 40) + 1)
            total += mp.quad(
                lambda u, k=k: self._weighted(lambda s: f(k, m + self.r * s), u),
                nodes,
                method="gauss-legendre",
            )
        return total

    def _weighted(self, f: Callable[[Any], Any], u: Any) -> Any:
        """f(tanh u) sech(u) exp(-2εu); every pressure uses the same u."""
        if u not in self._kept:
            self._kept[u] = mp.tanh(u), mp.sech(u) * mp.exp(-2 * self.epsilon * u)
        s, weight = self._kept[u]
        return weight * f(s)

    def _condition(self, m: Any) -> Any:
        return self._integral(lambda k, t: self._pieces()[k](t), m)

    def pressure(self, x: float) -> Any:
        x, e = mp.mpf(x), self.epsilon
        here = 0 if x < -self.a else (2 if x > self.a else 1)
        H, slopes = self._pieces()[here](x), (1 / self.R, mp.zero, 1 / self.R)

        def quotient(k: int, t: Any) -> Any:
            return slopes[k] if k == here else (self._pieces()[k](t) - H) / (t - x)

        s = (x - self.m) / self.r
        w = self.r * (1 + s) ** (mp.mpf(1) / 2 + e) * (1 - s) ** (mp.mpf(1) / 2 - e)
        return mp.cos(mp.pi * e) ** 2 / (2 * mp.pi) * w * self._integral(quotient, self.m)


def wavy(height: float = 0.01, share: float = 0.4) -> Problem:
    """Westergaard's wave h = Δ (1 - cos 2πx), period 1, in contact on a share of it.

    With u = tan πx the periodic kernel π cot π(x-ξ) dξ becomes dv/(u - v), but for a constant that
    vanishes by symmetry: the package solves it as a contact with the slope h'(x(u)).
    """
    b = math.tan(0.5 * math.pi * share)

    def slope(u: Any) -> Any:
        return 4.0 * math.pi * height * u / (1.0 + u * u)

    def pressure(u: Any, lib: Any = np) -> Any:
        """2 p̄ cos πx sqrt(sin² πa - sin² πx)/sin² πa, p̄ = π E* Δ sin² πa (Westergaard 1939);
        (b-u)(b+u) keeps the edge's digits.
        """
        edge = lib.sqrt((b - u) * (b + u) / ((1 + u * u) * (1 + b * b)))
        return 2 * lib.pi * height * edge / lib.sqrt(1 + u * u)

    profile = sie.FromFunction(slope, domain=(-3 * b, 3 * b), parity="even")
    return Problem(
        "periodic", "Westergaard's wave, 40 % in contact, by u = tan πx",
        sie.Scene(profile=profile, modulus=1.0, half_width=b),
        truth=lambda u: pressure(mp.mpf(u), mp), slope=slope, closed=pressure, period=1.0,
        gap=lambda x: height * (1.0 - np.cos(2.0 * np.pi * x)), places=(0.1,),
    )  # fmt: skip


def problems(quick: bool) -> Iterator[Problem]:
    named = {str(case): case for case in cases.CASES}
    if not quick:
        yield _of_case("smooth", named["sinh-r=1.5"], "Slope h' = sinh x, half-width 1.5")
    yield kinked(0.5)
    if quick:
        return
    for ratio in (0.9, 0.99, 0.999999):
        yield kinked(ratio)
    yield _wedge()
    yield _of_case(
        "asymmetric", named["corners-P=0.2"], "A flat with corners of radii 2 and 1/2, P = 0.2"
    )
    yield sliding()
    yield wavy()
