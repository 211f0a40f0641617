"""Maps of [-1, 1] on an interval: affine, or graded logarithmically towards close neighbours.

A density next to a gap of width δ is a function of distance/δ, and a polynomial in x would need
sqrt(length/δ) terms. With the ends A and B of the neighbours on the left and right (or, where there
is none that close, a length away)

    v = ln((x - A)/(B - x)) = hs + const

any power of B - x is entire in v: the number of terms grows like ln(length/δ) only. The Cauchy
kernel stays a Cauchy kernel, plus 1/2 coth(y/2) - 1/y, which is smooth; the neighbours lie on Im v
= ±π, so that no integral over them is nearly singular.

The series is that of φ times a factor ρ, and its error is rounding of the largest value of φ ρ
anywhere. So ρ determines where φ is accurate. Next to a gap between singular ends φ grows like 1/(x
- A), and ρ ~ x - A compensates it. Where one of them is bounded φ does not grow, and with ρ ~ 1 the
coefficient of the bounded end keeps digits that a factor of δ would lose. With p, q = 1 towards
singular gaps, 0 towards others:

    ρ ~ (x - A)^p (B - x)^q,      ρ(u)/ρ(v) x'(v) / (x(v) - x(u)) = 1/2 coth((v - u)/2) + c
    c = 1/2 tanh(u/2) for p = q = 1,   -1/2 tanh(v/2) for p = q = 0,   (q - p)/2 otherwise

Points are given by their distances from both ends: `right` = 1 - s and `left` = 1 + s on [-1, 1],
`to_right` = x2 - x and `to_left` = x - x1 on the interval. They may be complex.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.lerch import log1p

if TYPE_CHECKING:
    from sie.numerics.jacobi_weight import Weight

Array = NDArray[Any]

# No grading towards a neighbour that is further than this times the interval's length.
FAR = 0.6
# Below this |y| the smooth part of coth is its Taylor series.
SMALL = 0.3
SMOOTH = (
    1 / 12,
    -1 / 720,
    1 / 30240,
    -1 / 1209600,
    1 / 47900160,
    -691 / 1307674368000,
    1 / 74724249600,
)


@dataclass(frozen=True)
class Affine:
    """x = m + r s."""

    x1: float
    x2: float

    @property
    def r(self) -> float:
        """Half the length of the interval."""
        return 0.5 * (self.x2 - self.x1)

    @property
    def is_even(self) -> bool:
        """Whether ρ is dx/ds."""
        return True

    def distances(self, right: Array, left: Array) -> tuple[Array, Array, Array, Array]:
        """(x2 - x, x - x1, ρ, dx/ds / ρ) at points of [-1, 1]."""
        return self.r * right, self.r * left, np.full_like(right, self.r), np.ones_like(right)

    def inverse(self, to_right: Array, to_left: Array) -> tuple[Array, Array, Array]:
        """(1 - s, 1 + s, ρ) at points of the plane."""
        return to_right / self.r, to_left / self.r, np.full_like(to_right, self.r)

    def steepening(self, left: Array) -> Array:
        """d ln ρ / ds."""
        return np.zeros_like(left)

    def smooth(self, sigma: Array, right: Array, left: Array) -> Array | None:
        """ρ(s)/ρ(σ) x'(σ)/(x(σ) - x(s)) - 1/(σ - s), shape s by σ; None where it is zero."""
        return None


@dataclass(frozen=True)
class Graded:
    """x = (A + B e^v)/(1 + e^v), with A = x1 - before and B = x2 + behind.

    v is an affine function of s.
    """

    x1: float
    x2: float
    before: float
    behind: float
    powers: tuple[int, int] = (1, 1)  # p and q of the module's docstring

    @cached_property
    def length(self) -> float:
        """The length of the interval."""
        return self.x2 - self.x1

    @cached_property
    def _v1(self) -> float:
        return float(np.log(self.before / (self.length + self.behind)))

    @cached_property
    def h(self) -> float:
        """Half the length in v."""
        return 0.5 * float(
            np.log1p(self.length / self.behind) + np.log1p(self.length / self.before)
        )

    @cached_property
    def _width(self) -> float:
        return self.before + self.length + self.behind

    @property
    def is_even(self) -> bool:
        """Whether ρ is dx/ds."""
        return self.powers == (1, 1)

    def distances(self, right: Array, left: Array) -> tuple[Array, Array, Array, Array]:
        """As of `Affine.distances`, for a graded map."""
        cosh = np.cosh(0.5 * (self._v1 + self.h * left))
        to_right = (
            np.sinh(0.5 * self.h * right)
            * np.sqrt((self.length + self.before) * self.behind)
            / cosh
        )
        to_left = (
            np.sinh(0.5 * self.h * left) * np.sqrt((self.length + self.behind) * self.before) / cosh
        )
        rho, rest = self._split(to_left + self.before, to_right + self.behind)
        return to_right, to_left, rho, rest

    def _split(self, from_A: Array, from_B: Array) -> tuple[Array, Array]:
        """dx/ds = h (x - A)(B - x) / (B - A) as ρ times the rest, which is 1 midway in (A, B)."""
        rho: Any = 0.25 * self.h * self._width
        rest: Any = 1.0
        for power, distance in zip(self.powers, (from_A, from_B), strict=True):
            relative = distance / (0.5 * self._width)
            rho, rest = (rho * relative, rest) if power else (rho, rest * relative)
        return rho + np.zeros_like(from_A), rest + np.zeros_like(from_A)

    def inverse(self, to_right: Array, to_left: Array) -> tuple[Array, Array, Array]:
        """As of `Affine.inverse`, for a graded map."""
        from_A, from_B = to_left + self.before, to_right + self.behind
        right = log1p(to_right / self.behind) + log1p(to_right / from_A)
        left = log1p(to_left / self.before) + log1p(to_left / from_B)
        return right / self.h, left / self.h, self._split(from_A, from_B)[0]

    def steepening(self, left: Array) -> Array:
        """As of `Affine.steepening`, for a graded map."""
        p, q = self.powers
        out: Array = 0.5 * self.h * ((p - q) - (p + q) * np.tanh(0.5 * (self._v1 + self.h * left)))
        return out

    def smooth(self, sigma: Array, right: Array, left: Array) -> Array:
        """As of `Affine.smooth`, for a graded map."""
        s = 0.5 * (left - right)
        p, q = self.powers
        constant: Any = 0.5 * (q - p)
        if p == q:
            at, sign = (left[:, None], 1.0) if p else (1.0 + sigma, -1.0)
            constant = 0.5 * sign * np.tanh(0.5 * (self._v1 + self.h * at))
        out: Array = self.h * (smooth_coth(self.h * (sigma - s[:, None])) + constant)
        return out


Map = Affine | Graded


def smooth_coth(y: Array) -> Array:
    """1/2 coth(y/2) - 1/y, real or complex."""
    near = np.abs(y) < SMALL
    safe = np.where(near, 1.0, y)
    out = 0.5 / np.tanh(0.5 * safe) - 1.0 / safe
    if near.any():
        small = y[near]
        out[near] = small * np.polynomial.polynomial.polyval(small * small, SMOOTH)
    return out


def maps(
    intervals: tuple[tuple[float, float], ...],
    weights: tuple[Weight, ...],
    mouths: tuple[float, float] = (np.inf, np.inf),
) -> tuple[Map, ...]:
    """One map for each of the intervals, which ascend, and their densities' weights.

    `mouths` are left out at the first and the last end, as gaps to the mirror image of a crack.
    """
    first, last = (mouth if np.isfinite(mouth) else 0.0 for mouth in mouths)
    ends = [list(of) for of in intervals]
    ends[0][0] += first
    ends[-1][1] -= last
    intervals = tuple((x1, x2) for x1, x2 in ends)
    gaps = [
        mouths[0],
        *(after[0] - before[1] for before, after in pairwise(intervals)),
        mouths[1],
    ]
    powers = [
        0,
        *(int(before.alpha.real < 0.0 > after.beta.real) for before, after in pairwise(weights)),
        0,
    ]
    sides = list(zip(gaps, powers, strict=True))
    return tuple(
        _map(*ends, *of) for ends, *of in zip(intervals, sides[:-1], sides[1:], strict=True)
    )


def _map(x1: float, x2: float, left: tuple[float, int], right: tuple[float, int]) -> Map:
    length, (before, p), (behind, q) = x2 - x1, left, right
    if min(before, behind) >= FAR * length:
        return Affine(x1, x2)
    # Where no gap is near, either factor serves; the simplest is that of the other side
    powers = (p if before < length else q, q if behind < length else p)
    return Graded(x1, x2, min(before, length), min(behind, length), powers)
