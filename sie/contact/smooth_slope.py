"""A slope that is one Chebyshev series in the contact: edges by Newton on its coefficients.

With t = m + r sin φ and H = Σ c_n T_n(sin φ) the integrals that fix the edges (`edges`) are
coefficients, and so are their derivatives:

    ∫H dφ = π c_0,   ∫H sin φ dφ = π c_1/2,   ∫H cos²φ dφ = π (c_0 - c_2/2)/2
    r ∫H' (1 ± sin φ) dφ = π Σ (±1)^(n+1) n c_n

so a step costs one call of the slope and one DCT, and the last series is the pressure. The general
search solves all other cases: a sharp edge, a slope that falls somewhere or is no such series,
steps that do not settle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval, interval_about
from sie.profiles.resolution import NOISE, ROUGHEST, rounding_noise
from sie.profiles.slope import Slope
from sie.traction.panels import CHOP

Array = NDArray[np.float64]
Step = Callable[[Array, float], tuple[float, float]]

SIZES = (17, 33, 65, 129, 257)  # points of a series; beyond, pieces are cheaper
TAIL = 3  # the last coefficients that must have decayed
HUGE = 1e280  # slopes that a transform can add up
STALLED = 0.1  # a tail that twice the points do not make smaller than this may be rounding
SETTLED = 1e-9  # of r: what is left after such a step is rounding, as Newton squares the error
MOST_STEPS = 12
LONGEST = 4.0  # of a step in ln r
# Angles on no grid, where the series has to agree with the slope, and half-widths beside the
# contact: at both the slope has to rise.
SCANNED = -np.cos(np.pi * np.sort(np.arange(1, 600) * 0.6180339887498949 % 1.0))
BESIDE = np.concatenate((np.geomspace(1e-6, 1.0, 40), np.geomspace(1.0, 1e3, 80)[1:]))
MISSED = 64.0  # times what the tail may be
FALLS = 8.0 * EPS  # of the largest slope: by less it may fall from point to point
GUESSES = np.geomspace(1e-140, 1e140, 281)  # sizes at which a contact is sought first
SIDES = np.array([[1.0], [-1.0]])


class Smooth(NamedTuple):
    """A contact with smooth edges, the series of the slope there, and how often one was formed."""

    contact: Interval
    series: Array
    evaluations: int


def smooth_contact(
    slope: Slope, load: float | None, half_width: float | None, axis: float | None, tol: float
) -> Smooth | None:
    """The contact with r ∫H sin φ dφ = load, or of this half-width; None if it is not so smooth.

    It is about the axis if there is one. The series may miss `tol` times its largest coefficient.
    """
    if len(slope.origins) > 1 or not (load is None or 0.0 < load < math.inf):
        return None
    samples = _Samples(slope, tol)
    lo, hi = slope.domain
    centre = axis if axis is not None else min(max(0.0, lo), hi)
    if half_width is None:
        assert load is not None
        size = samples.first_size(load, centre)
        guess = interval_about(centre, size)
        if axis is None:
            guess = Interval(max(guess.x1, lo), min(guess.x2, hi))
        contact = _newton(samples, guess, _towards_load(load, axis is not None))
    elif axis is None:
        middle = min(max(centre, lo + half_width), hi - half_width)
        contact = _newton(samples, interval_about(middle, half_width), _towards_balance)
    else:
        contact = samples.inside(interval_about(axis, half_width))
    series = None if contact is None else samples.series(contact)
    return None if series is None or contact is None else Smooth(contact, series, samples.taken)


class _Samples:
    """A slope of one piece, sampled on contacts."""

    def __init__(self, slope: Slope, tol: float) -> None:
        self.slope, self.tol = slope, tol
        self.size, self.taken, self.noise = 0, 0, 0.0

    def at(self, contact: Interval, offset: Array) -> Array:
        """H at x1 + offset."""
        H: Array = self.slope.value(np.array([0]), contact.x1, contact.tail1 + offset)
        return H

    def inside(self, contact: Interval) -> Interval | None:
        """The contact if it ends within the domain."""
        lo, hi = self.slope.domain
        return contact if lo < contact.x1 and contact.x2 < hi else None

    def coefficients(self, contact: Interval, enough: float) -> Array | None:
        """The coefficients, with the last below `enough` times the largest, or rounding."""
        self.taken += 1
        before = math.inf
        while self.size < len(SIZES):
            s = chebyshev.points(SIZES[self.size])
            values = self.at(contact, contact.r * (1.0 + s))
            if not np.abs(values).max() < HUGE:
                return None
            c = chebyshev.transform(values)
            size = np.abs(c)
            scale, tail = float(size.max()), float(size[-TAIL:].max())
            if STALLED * before < tail <= ROUGHEST * scale and not self.noise:
                self.noise = NOISE * rounding_noise(self.slope.inside, contact.x1, contact.x2)
            if tail <= max(enough * scale, self.floor(contact, values, scale)):
                return c
            before = tail
            self.size += 1
        return None

    def floor(self, contact: Interval, values: Array, scale: float) -> float:
        """The allowed error of a series: `tol`, ulps of x, and the slope's own rounding."""
        ulp = EPS * max(abs(contact.x1), abs(contact.x2)) / (2.0 * contact.r)
        rounding = max(ulp * float(values.max() - values.min()), min(self.noise, ROUGHEST * scale))
        return max(self.tol * scale, rounding)

    def series(self, contact: Interval) -> Array | None:
        """The chopped series; None where it misses the slope between its points, or that falls."""
        c = self.coefficients(contact, self.tol)
        if c is None:
            return None
        lo, hi = self.slope.domain
        r, scale = contact.r, float(np.abs(c).max())
        left = np.maximum(-r * BESIDE[::-1], lo - contact.x1)
        right = np.minimum(2.0 * r + r * BESIDE, hi - contact.x1)
        H = self.at(contact, np.concatenate((left, r * (1.0 + SCANNED), right)))
        within = H[len(left) : -len(right)]
        missed = np.abs(c @ _polynomials(len(c)) - within)
        resolved = (missed <= MISSED * self.floor(contact, within, scale)).all()
        if not resolved or not (H[1:] >= H[:-1] - FALLS * scale).all():
            return None
        noise = min(self.noise, ROUGHEST * scale)
        return c[: max(chebyshev.chopped_length(c, max(CHOP * scale, 0.5 * noise)), 2)]

    def first_size(self, load: float, centre: float) -> float:
        """The w at which w H(w), about the load of a half-width w, is enough on both sides."""
        lo, hi = self.slope.domain
        reach = np.minimum(GUESSES, max(hi - centre, centre - lo))
        offset = np.clip(reach * SIDES, lo - centre, hi - centre)
        H = self.at(Interval(centre, centre), offset.ravel()).reshape(offset.shape)
        with np.errstate(over="ignore", invalid="ignore"):  # far out, where it is enough
            force = (reach * SIDES * H).min(axis=0)
        enough = np.flatnonzero(~(force < load))
        k = int(enough[0]) if enough.size else len(reach) - 1
        below, above = float(force[k - 1]), float(force[k])
        if 0.0 < below < load < above < math.inf:  # nearly a power law in between
            fraction = math.log(above / load) / math.log(above / below)
            return float(reach[k] * (reach[k - 1] / reach[k]) ** fraction)
        return float(reach[k])


@lru_cache(maxsize=len(SIZES))
def _polynomials(n: int) -> Array:
    return chebyshev.polynomials(n, SCANNED)


def _newton(samples: _Samples, contact: Interval, step: Step) -> Interval | None:
    """The contact at which the step, (growth of r, shift of the centre), both over r, is zero."""
    length = 1.0
    for _ in range(MOST_STEPS):
        c = samples.coefficients(contact, 0.01 * length * length)
        if c is None:
            return None
        r = contact.r
        grows, shifts = step(c, r)
        if not abs(shifts) <= 1.0:
            return None
        moved = samples.inside(contact.moved(r * (shifts - grows), r * (shifts + grows)))
        length = abs(grows) + abs(shifts)
        if moved is None or length <= SETTLED:
            return moved
        contact = moved
    return None


def _towards_load(load: float, symmetric: bool) -> Step:
    def step(c: Array, r: float) -> tuple[float, float]:
        n = np.arange(len(c))
        odd, even = math.pi * float(n[1::2] @ c[1::2]), math.pi * float(n[::2] @ c[::2])
        carried, askew = 0.5 * math.pi * r * float(c[1]), math.pi * r * float(c[0])
        if not (carried > 0.0 and odd > abs(even)):
            return 0.0, math.nan
        short = load - carried
        right, left = (short - askew) / (r * (odd + even)), -(short + askew) / (r * (odd - even))
        grows = 0.5 * (right - left)
        if abs(short) > SETTLED * carried:  # in logarithms, where a power law is met in one step
            grows *= math.log(load / carried) * carried / short
            grows = math.expm1(min(max(grows, -LONGEST), LONGEST))
        return grows, 0.0 if symmetric else 0.5 * (left + right)

    return step


def _towards_balance(c: Array, r: float) -> tuple[float, float]:
    rise = float(np.arange(1, len(c), 2) @ c[1::2])
    return 0.0, -float(c[0]) / rise if rise > 0.0 else math.nan
