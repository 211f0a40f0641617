"""Bracketed roots of functions of one variable.

    false_position      a sign change between two places, by false position and bisection
    false_positions     the same in many brackets at once, in arrays
    logarithmic_root    of a function that is nearly a power, by Newton's method in logarithms
    Bracket             keeps the steps of another method between the bounds that are known

SciPy's `brentq` takes a bracket too, but to import it takes longer than a solve.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import step_done

from .interval import EPS, two_sum

Array = NDArray[np.float64]

# -- false position -------------------------------------------------------------------------------

MAX_BISECTIONS = 2000  # from 1 down to the smallest double takes half of these


def false_position(
    function: Callable[[float], float],
    a: float,
    b: float,
    ends: tuple[float, float],
    settled: Callable[[float, float, float], bool],
) -> float:
    """The place between a and b where the function changes sign, given its values there.

    The weight of an end that is kept twice is halved (Illinois), and the bracket is halved whenever
    two steps have not done so. It ends at `settled(a, b, value)`, or where the bracket is rounding.
    """
    at_a, at_b = ends
    u, widths = 0.5 * (a + b), [math.inf, math.inf]
    kept = 0  # how often b was kept in a row, or a if it is negative
    for _ in range(MAX_BISECTIONS):
        step_done(0)
        widths.append(b - a)
        if b - a <= 4.0 * math.ulp(max(abs(a), abs(b))):
            return 0.5 * (a + b)
        u = (a * at_b - b * at_a) / (at_b - at_a)
        if not a < u < b or widths[-1] > 0.5 * widths[-3]:
            u = 0.5 * (a + b)
        value = function(u)
        if value == 0.0 or settled(a, b, value):
            break
        if (value < 0.0) == (ends[0] < 0.0):
            a, at_a, kept = u, value, kept + 1 if kept > 0 else 1
            at_b = 0.5 * at_b if kept > 1 else at_b
        else:
            b, at_b, kept = u, value, kept - 1 if kept < 0 else -1
            at_a = 0.5 * at_a if kept < -1 else at_a
    return u


MOST_STEPS, BISECT_AFTER = 80, 12
# of the bracket: the last step of a method of superlinear convergence leaves much less
STEP_SETTLED = 1e-9


def false_positions(function: Callable[[Array], Array], lo: Array, hi: Array) -> Array:
    """The places between lo and hi where the function falls through 0; only pairs that have one."""
    a, b = lo, hi
    fa, fb = function(np.stack((a, b)).ravel()).reshape(2, -1)
    falls = (fa > 0.0) & (fb < 0.0)
    a, b, fa, fb = a[falls], b[falls], fa[falls], fb[falls]
    x, enough, last = 0.5 * (a + b), STEP_SETTLED * (b - a), np.zeros(a.shape)
    for k in range(MOST_STEPS if x.size else 0):
        step_done(0)
        before = x
        middle, secant = 0.5 * (a + b), b - fb * (b - a) / (fb - fa)
        x = np.where(
            (secant > a) & (secant < b) & ((k < BISECT_AFTER) | (k % 2 == 0)), secant, middle
        )
        f = function(x)
        up = f > 0.0
        side = np.where(up, 1.0, -1.0)
        again = np.where(last == side, 0.5, 1.0)  # an end kept twice loses weight
        fb, fa, last = np.where(up, again * fb, f), np.where(up, f, again * fa), side
        a, b = np.where(up, x, a), np.where(up, b, x)
        if ((np.abs(x - before) <= enough) | (f == 0.0)).all():
            break
    return x


# -- from a guess ----------------------------------------------------------------------------------

MAX_STEPS = 200
# The logarithmic search ends at this relative error of the value, after one more step.
ROUGH = 1e-2
# This step is not worth another evaluation: Newton's next one from u reaches rounding.
SHORT_STEP = 1e-9
# Steps are at most a factor e^20, so that one bad derivative cannot move the search out of range.
MAX_LOG_STEP = 20.0
SMALLEST = 1e-300
LEAP = 1e12  # where a value underflows, or falls before it was ever large enough
# While the root is not bracketed and the value is wrong by more than the factor OPEN, a step is at
# least the factor OPEN_STEP.
OPEN = 0.1
OPEN_STEP = 4.0


def logarithmic_root(
    function: Callable[[float], tuple[float, float]],
    target: float,
    guess: float,
    limit: float,
    error: Callable[[float, float], Exception],
    *,
    rough: float = ROUGH,
) -> float:
    """u in (0, limit) with f(u) = target, to `rough`, by Newton in ln u and ln f in a bracket.

    `function` returns (f, u f'). It may fall again beyond a largest value, which a negative
    derivative shows; if the target exceeds that value, `error(u, f)` is raised with the best that
    was found.
    """
    low, high, steps = 0.0, limit, [np.inf, np.inf]
    u, best, best_u = guess, 0.0, guess
    for _ in range(MAX_STEPS):
        step_done(0)
        f, slope = function(u)
        if f > best or f >= target:  # the last that is enough, or else the largest
            best, best_u = f, u
        rising = 0.0 < f < math.inf and slope > 0.0
        if rising and not 0.0 < target / f < math.inf:
            raise OverflowError("the ratio is no double")
        step = math.log(target / f) * f / slope if rising else np.inf
        if rising and abs(math.log(f / target)) <= rough:
            return min(u * math.exp(step), limit) if abs(step) > SHORT_STEP else u
        if f < target and (rising or (f == 0.0 and slope >= 0.0)):  # zero: it underflows
            low = u
        else:
            high = u
        if u <= SMALLEST or (math.isfinite(high) and high - low <= 4.0 * EPS * high):
            break
        far = not OPEN * target < f < target / OPEN
        open_ended = low == 0.0 or not math.isfinite(high)
        new = u * math.exp(min(max(step, -MAX_LOG_STEP), MAX_LOG_STEP))
        if rising and far and open_ended:
            # Newton is slow without a bracket: f is steep at a small u, and flat at a large one
            new = max(new, u * OPEN_STEP) if f < target else min(new, u / OPEN_STEP)
        if not low < new < high or (not open_ended and abs(math.log(new / u)) > 0.5 * steps[-2]):
            new = _between(low, high, u)  # Newton diverges, or oscillates across a kink
        steps.append(abs(math.log(new / u)))
        u = new
    if best >= target * (1.0 - rough):
        return best_u
    raise error(best_u, best)


def _between(low: float, high: float, u: float) -> float:
    """A point inside the bracket: the geometric mean, or a large step where one end is open."""
    if not math.isfinite(high):
        return u * LEAP
    return float(np.sqrt(low) * np.sqrt(high)) if low > 0.0 else high / 8.0


# -- bounds for another method ---------------------------------------------------------------------

Place = tuple[float, float]  # a sum of two doubles; such pairs are ordered as their sums are


@dataclass
class Bracket:
    """low < root < high; `cuts` marks the bounds that a value has confirmed.

    `missed` are the sizes of what the steps before have missed.
    """

    low: Place
    high: Place
    cuts: tuple[bool, bool] = (False, False)
    missed: list[float] = field(default_factory=lambda: [math.inf, math.inf])

    def cut(self, at: Place, above: bool) -> None:
        """Use that the root is above `at`, or below."""
        if above:
            self.low, self.cuts = max(self.low, at), (True, self.cuts[1])
        else:
            self.high, self.cuts = min(self.high, at), (self.cuts[0], True)

    def place(self, wanted: Place, missed: float, here: Place | None = None) -> Place:
        """The place itself, or the middle of the bracket.

        It is the middle if the place is out of bounds, or if two steps have not halved what is
        missed and both bounds are known. Where one bound is infinite, it is the middle between the
        other one and `here`.
        """
        low, high, slow = self.low, self.high, missed > 0.5 * self.missed[-2]
        self.missed.append(missed)
        inside = low < wanted < high
        if inside and not (slow and all(self.cuts)):
            return wanted
        if math.isfinite(low[0] + high[0]):
            return self.middle()
        if here is None or inside:
            return wanted
        return _middle(low, here) if wanted <= low else _middle(here, high)

    def middle(self) -> Place:
        return _middle(self.low, self.high)


def _middle(low: Place, high: Place) -> Place:
    return two_sum(low[0], 0.5 * ((high[0] - low[0]) + (high[1] - low[1])) + low[1])
