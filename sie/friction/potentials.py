"""Rates of pressure and of shear in closed form, for any intervals on which they are unknown.

The unknown density ρ lives on N intervals [a_k, b_k]; beside them densities d are given. Asked is

    1/π PV∫ (ρ + d)/(x - ξ) dξ = B  on the intervals,      ∫ (ρ + d) dx = A,

and that the ends of every gap between neighbouring intervals keep their distance:

    pressure    intervals: patches       A = dP, B = (E*/2) d tilt      nothing is given
    shear       intervals: stick zones   A = dQ, B = dσ/4               d = s f dp in slip

With W = Π sqrt(z - a_k) sqrt(z - b_k) and the intervals' centres μ_k the potential of ρ + d is

    Φ = B + n/W,     n = -B Π(z - μ_k) + Σ_j α_j Π_{i≠j}(z - μ_i) + 1/π ∫ d W/(z - ξ) dξ,

where Σ α_j = A/π and Re ∫ n/W dz = 0 on the half-circle above each gap. On an interval the density
is -Im n/W, beside the intervals Re n/W = (E*/2) dg', the rate at which the slope of the gap changes
(Muskhelishvili 1953, chapter 11). At an end the density is K/sqrt(distance).

A given density is a Chebyshev series of W d sqrt(1 - t²), t in [-1, 1] on its piece: W d has a root
at an end that an interval shares and 1/root at a contact edge, so that the series converges
geometrically. With it the integral is Σ c_n v^n/sqrt(t² - 1), v = t - sqrt(t² - 1), beside the
piece and -Σ c_n U_{n-1}(t) on it: no principal value is found by subtraction.

Per period λ every difference is the chord (λ/π) sin(π(x - y)/λ), the term of α_j has a factor
cos(π(z - μ_j)/λ), B = 0, and 1/(z - ξ) is (π/λ) csc for odd N, for which W changes its sign over a
period, and (π/λ) cot for even N. The variable of a piece is t ~ tan(π(x - c)/λ), c its centre.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.chord import Chord
from sie.numerics.graded_rule import graded_angle

Array = NDArray[np.float64]
Zones = Sequence[tuple[float, float]]
# Arrays of places between lo and hi with both distances, from_lo and from_hi, exact: a `Between`,
# or a rule of the same four fields. Complex ones lie above the axis.
Places = Any
Density = Callable[[Places], Any]

NODES, MOST_NODES = 48, 6144
SETTLED = 1e-13  # of the largest coefficient: the tail of a series
TAIL = 6  # coefficients in it


@dataclass(frozen=True)
class Between:
    """Places lo + from_lo = hi - from_hi."""

    lo: Any
    hi: Any
    from_lo: Any
    from_hi: Any


def in_angle(lo: float, hi: float, v: Any) -> Between:
    """Places lo + (hi - lo) sin²(πv/2): roots of both distances are smooth functions of v."""
    half = 0.5 * np.pi * np.asarray(v)
    return Between(lo, hi, (hi - lo) * np.sin(half) ** 2, (hi - lo) * np.cos(half) ** 2)


def settled_series(values: Callable[[Array], Array]) -> Array:
    """The series through values at NODES points, doubled until its tail has settled."""
    n = NODES
    while True:
        series = chebyshev.transform(values(chebyshev.points(n)))
        if np.abs(series[-TAIL:]).max() <= SETTLED * np.abs(series).max() or n >= MOST_NODES:
            return series
        n *= 2


@lru_cache(maxsize=1)
def _half_circle() -> tuple[Any, Any, Any]:
    """(z - 0, 1 - z, dz) at nodes of the half-circle above [0, 1], graded to both ends."""
    near, far, weight = graded_angle()
    turn = np.exp(-0.5j * np.pi * near)
    step = 0.5j * np.pi * turn * turn * weight
    return 1j * np.sin(0.5 * np.pi * near) * turn, np.sin(0.5 * np.pi * far) * turn, step


def above_gap(lo: float, hi: float) -> tuple[Between, Any]:
    """Places on the half-circle from lo to hi above the axis, and dz."""
    from_lo, from_hi, step = _half_circle()
    length = hi - lo
    return Between(lo, hi, length * from_lo, length * from_hi), length * step


@dataclass(frozen=True)
class Frame:
    """Differences and roots over the intervals, lengths in a quarter of their span."""

    intervals: tuple[tuple[float, float], ...]
    chord: Chord

    @cached_property
    def unit(self) -> float:
        if self.chord.periodic:
            return self.chord.period / np.pi
        return 0.25 * (self.intervals[-1][1] - self.intervals[0][0])

    @property
    def wave(self) -> float:
        return np.pi / self.chord.period

    @property
    def odd(self) -> bool:
        return len(self.intervals) % 2 == 1

    def parts(self, x: Places, e: float) -> tuple[Any, Any]:
        """X - e as the difference of two anchors and the distance from the nearer one."""
        low = np.abs(x.from_lo) <= np.abs(x.from_hi)
        return np.where(low, x.lo, x.hi) - e, np.where(low, x.from_lo, -x.from_hi)

    def apart(self, x: Places, e: float) -> Any:
        return self.chord.apart(*self.parts(x, e)) / self.unit

    def cosine(self, x: Places, e: float) -> Any:
        return self.chord.cosine(*self.parts(x, e))

    def root(self, x: Places, e: float) -> Any:
        """The root of the chord, analytic above the axis and positive just right of e."""
        if not self.chord.periodic:
            return np.sqrt(self.apart(x, e) + 0j)
        step, offset = self.parts(x, e)
        angle = self.wave * (step + offset)
        sine = self.chord.apart(step, offset) / self.unit
        return np.exp(0.25j * np.pi - 0.5j * angle) * np.sqrt(-1j * np.exp(1j * angle) * sine)

    def W(self, x: Places) -> Any:
        return np.prod([self.root(x, e) for pair in self.intervals for e in pair], axis=0)

    @cached_property
    def at_ends(self) -> tuple[Between, Any]:
        """The ends, and -i W at each without the root of the distance from it."""
        ends = np.array(self.intervals).ravel()
        x = Between(ends, ends, np.zeros_like(ends), np.zeros_like(ends))
        roots = np.array([self.root(x, e) for e in ends])
        # the root of x - e is that of the distance at a left end, i times that at a right one
        np.fill_diagonal(roots, np.where(np.arange(ends.size) % 2, 1j, 1.0))
        return x, -1j * np.prod(roots, axis=0)

    def product(self, x: Places) -> Any:
        """Π(x - μ_k)."""
        return np.prod([self.apart(x, 0.5 * (a + b)) for a, b in self.intervals], axis=0)

    def basis(self, x: Places) -> Any:
        """Π_{i≠j}(x - μ_i) for each j, over the unit of length; stacked along a new first axis."""
        middles = [0.5 * (a + b) for a, b in self.intervals]
        factors = np.array([self.apart(x, m) for m in middles])
        ones = np.ones_like(factors[:1])
        ahead = np.cumprod(np.concatenate((ones, factors[:-1])), axis=0)
        behind = np.cumprod(np.concatenate((ones, factors[:0:-1])), axis=0)[::-1]
        return ahead * behind * np.array([self.cosine(x, m) for m in middles]) / self.unit


@dataclass(frozen=True)
class Given:
    """A density beside the intervals: the series of W d sqrt(1 - t²) on [lo, hi]."""

    frame: Frame
    lo: float
    hi: float
    series: Array
    even: float = 0.0  # what the cotangent adds to the kernel 1/(t_x - t)

    @classmethod
    def fitted(cls, frame: Frame, lo: float, hi: float, density: Density) -> Given:
        """The series at NODES points, doubled until its tail has settled."""
        n = NODES
        while n <= MOST_NODES:
            s = chebyshev.points(n)
            sine, cosine = np.sqrt(0.5 * (1.0 + s)), np.sqrt(0.5 * (1.0 - s))
            x, stretch, even = on_piece(frame, lo, hi, sine, cosine)
            values = (frame.W(x) * density(x)).real * stretch * 2.0 * sine * cosine
            series = chebyshev.transform(values)
            if np.abs(series[-TAIL:]).max() <= SETTLED * np.abs(series).max():
                kept = chebyshev.chopped_length(series, 1e-17 * np.abs(series).max())
                return cls(frame, lo, hi, series[:kept], float(np.mean(values * even)))
            n *= 2
        raise ContactError(
            f"The slip zone [{lo:g}, {hi:g}] is too long for the stick zone beside it: "
            f"{MOST_NODES} terms do not settle its rate"
        )

    def integral(self, x: Places) -> Any:
        """1/π ∫ d W/(x - ξ) dξ beside the piece and on it."""
        left, right, cosine = beyond_piece(self.frame, self.lo, self.hi, x)
        scale = 1.0 / cosine if self.frame.odd else 1.0
        on_it = np.isrealobj(left) & (left >= 0.0).real & (right <= 0.0).real
        root = np.sqrt(left + 0j) * np.sqrt(right + 0j)
        t = 0.5 * (left + right)
        v = 1.0 / np.where(on_it, 1.0, t + root)
        beside = np.polynomial.polynomial.polyval(v, self.series) / np.where(on_it, 1.0, root)
        inside = np.clip(t.real, -1.0, 1.0)
        on = -chebyshev.evaluate_second_kind(self.series[1:], inside)
        return scale * np.where(on_it, on, beside) + self.even


def beyond_piece(frame: Frame, lo: float, hi: float, x: Places) -> tuple[Any, Any, Any]:
    """(t + 1, t - 1) of places anywhere, and cos(π(x - c)/λ), which is 1 on the line."""
    middle = 0.5 * (lo + hi)
    half = frame.chord.apart(hi - middle) / frame.unit
    cosine = frame.cosine(x, middle)
    scale = half * cosine
    return frame.apart(x, lo) / scale, frame.apart(x, hi) / scale, cosine


def on_piece(
    frame: Frame, lo: float, hi: float, sine: Array, cosine: Array
) -> tuple[Between, Array, Array]:
    """Places where 1 + t, 1 - t are 2 sin², 2 cos²; what d W is stretched by there; `even`."""
    if not frame.chord.periodic:
        length, ones = hi - lo, np.ones_like(sine)
        return Between(lo, hi, length * sine**2, length * cosine**2), ones, 0.0 * ones
    wave = frame.wave
    half = 0.5 * wave * (hi - lo)
    tangent = np.tan(half) * (sine**2 - cosine**2)
    angle = np.arctan(tangent)
    near = 2.0 * np.sin(half) * np.cos(angle)
    from_lo = np.arctan2(near * sine**2, np.cos(angle + half)) / wave
    from_hi = np.arctan2(near * cosine**2, np.cos(angle - half)) / wave
    x = Between(lo, hi, from_lo, from_hi)
    if frame.odd:
        return x, np.cos(angle), 0.0 * angle
    return x, np.ones_like(angle), np.sin(angle) * np.cos(angle) * np.tan(half)


@dataclass(frozen=True)
class Potential:
    """Φ of one rate: the densities on its intervals, K at their ends, strain beside them."""

    frame: Frame
    B: float
    alpha: Array
    given: tuple[Given, ...] = ()

    @classmethod
    def solved(cls, frame: Frame, A: float, B: float, given: tuple[Given, ...] = ()) -> Potential:
        """The α_j of loads and gaps: N equations."""
        n = len(frame.intervals)
        matrix, right = np.ones((n, n)), np.full(n, A / np.pi)
        without = cls(frame, B, np.zeros(n), given)
        for k in range(n - 1):
            x, dz = above_gap(frame.intervals[k][1], frame.intervals[k + 1][0])
            matrix[k] = (frame.basis(x) / frame.W(x) @ dz).real
            right[k] = -(without.numerator(x) / frame.W(x) @ dz).real
        return cls(frame, B, np.linalg.solve(matrix, right), given)

    def numerator(self, x: Places) -> Any:
        """The function n."""
        own = np.tensordot(self.alpha, self.frame.basis(x), 1)
        if self.B:
            own = own - self.B * self.frame.product(x)
        return own + sum(piece.integral(x) for piece in self.given)

    def value(self, x: Places) -> Any:
        """n/W above the axis: strain - i density."""
        return self.numerator(x) / self.frame.W(x)

    def density(self, x: Places) -> Any:
        return -self.value(x).imag

    def strain(self, x: Places) -> Any:
        return self.value(x).real

    @cached_property
    def K(self) -> Array:
        """The density's coefficient of 1/sqrt(distance) at each end, (N, 2)."""
        x, rest = self.frame.at_ends
        found: Array = (self.numerator(x) / rest).real * np.sqrt(self.frame.unit)
        return found.reshape(-1, 2)

    @cached_property
    def moment(self) -> float:
        """∫ x ρ dx on the line where nothing is given, from Φ at infinity."""
        ends = np.array(self.frame.intervals)
        middles, halves = ends.mean(axis=1), 0.5 * np.diff(ends, axis=1).ravel()
        return float(np.pi * (self.alpha @ middles - 0.5 * self.B * np.sum(halves**2)))

    def between(self, lo: float, hi: float) -> float:
        """∫ Re n/W dx from lo to hi, beside the intervals, over the half-circle."""
        x, dz = above_gap(lo, hi)
        return float((self.value(x) @ dz).real)


def pressure_rate(edges: Zones, dP: float, B: float, period: float = np.inf) -> Potential:
    """The rate of pressure on the patches for a rate of load, B = (E*/2) d tilt."""
    return Potential.solved(Frame(tuple(edges), Chord(period)), dP, B)


def pressure_rate_of_moment(edges: Zones, dP: float, dM: float) -> Potential:
    """The rate of pressure where not the tilt but the moment about x = 0 is given."""
    load, turn = pressure_rate(edges, dP, 0.0), pressure_rate(edges, 0.0, 1.0)
    return pressure_rate(edges, dP, (dM - load.moment) / turn.moment)
