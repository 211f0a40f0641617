"""Pieces on which a function is resolved by Chebyshev series.

A series is chopped where its coefficients decay, and the piece is halved where they do not.

All open intervals are sampled in one call of the function, level by level. Halving towards a point
where the function behaves like |x|^s grades the pieces geometrically by itself; a jump or a kink
that was not declared is bracketed to rounding. At a declared break H may vanish like |x|^s. The
error of a series there is a small jump, and the error of the pressure at the break is
ln(length/piece) times as large. So the tolerance is smaller for pieces that touch a break.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ResolutionError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS

if TYPE_CHECKING:
    from .slope import Slope

Array = NDArray[np.float64]

SIZES = (17, 33)  # points a piece is tried with before it is split
TAIL = 3  # the last coefficients that must have decayed
# Points on no grid, where a settled series is compared with the function, as it is next to the ends
# of a piece. They show most features that lie between the sample points.
PROBES = np.array([-0.913, -0.537, 0.071, 0.467, 0.859])
MISSED = 32.0  # times what the series itself may miss
NEIGHBOURS, CLOSE = 12, 1e-6
NOISE = 8.0  # times the measured roughness: no series has to be more accurate ...
ROUGHEST = 1e-9  # ... but noise above this fraction of the largest value is not rounding
FINER = 1e-3  # of the tolerance: next to a declared break
TINY = float(np.finfo(float).tiny)  # half of a piece next to x = 0 may be no double
MAX_PIECES = 8_000  # of a formula: within seconds
SHORTEST = EPS**6  # of the interval
DEEP = 64  # levels, after which x = 0 is such a break
# A piece at a declared break that has not settled after so many levels is singular there. It is
# then halved so many times at once.
PATIENCE, HALVINGS = 3, 8


def accuracy_for(tol: float) -> float:
    """The relative accuracy of a series, for a tolerance of the answer."""
    return max(EPS, 1e-2 * tol) if tol > 1e-13 else EPS


class Tolerance(NamedTuple):
    """Allowed errors of a series: relative to the largest |value|, absolute, next to breaks."""

    relative: float
    absolute: float
    smooth_between: Array  # the ends of the interval, and the breaks
    shortest: float  # of the pieces: next to x = 0 powers of x are not smooth to the last double

    @property
    def breaks(self) -> Array:
        """The declared breaks."""
        return self.smooth_between[1:-1]

    def of(self, pieces: Array, values: Array, scale: float) -> Array:
        """The tolerance of each piece (K, 2) with values (K, n); `scale` is the largest |value|."""
        enough = np.full(
            len(pieces), max(self.relative * scale, min(self.absolute, ROUGHEST * scale))
        )
        touches = np.isin(pieces, self.breaks).any(axis=1)
        finer = np.maximum(FINER * self.relative * scale, 4.0 * EPS * np.abs(values).max(axis=1))
        enough[touches] = np.minimum(enough, finer)[touches]
        return enough


def resolved(
    function: Callable[[Array], Array], breaks: Array, tol: float, cuts: Array | None = None
) -> tuple[Array, NDArray[np.int64]]:
    """A refinement of `breaks`, and the Chebyshev degree that resolves each piece.

    A series misses at most tol times the largest |value|.

    The function is smooth at the `cuts`, from which the refinement starts.
    `function` takes and returns arrays (K, n). Raises ValueError if it returns nan or infinities,
    ResolutionError if it does not settle.
    """
    ends = breaks
    if cuts is not None:
        ends = np.union1d(breaks, cuts[(cuts > breaks[0]) & (cuts < breaks[-1])])
    open_ = np.stack((ends[:-1], ends[1:]), axis=1)
    noise = NOISE * rounding_noise(function, breaks[0], breaks[-1])
    tolerance = Tolerance(tol, noise, breaks, SHORTEST * (breaks[-1] - breaks[0]))
    done: list[tuple[float, float, int]] = []
    scale, level = 0.0, 0
    while len(open_):
        for n in SIZES:
            degrees, scale = _degrees(function, open_, n, tolerance, scale)
            settled = degrees >= 0
            done += zip(open_[settled, 0], open_[settled, 1], degrees[settled], strict=True)
            open_ = open_[~settled]
            if not len(open_):
                break
        if len(done) + 2 * len(open_) > MAX_PIECES:
            raise _unsettled(float(0.5 * open_[0].sum()))
        level += 1
        graded_towards = tolerance.breaks if level > PATIENCE else breaks[:0]
        if level > DEEP:  # only next to x = 0 are doubles so close
            inside = (open_[:, 0] < 0.0) & (open_[:, 1] > 0.0)
            left, right = open_[inside] * [1.0, 0.0], open_[inside] * [0.0, 1.0]
            open_ = np.concatenate((open_[~inside], left, right))
            graded_towards = np.append(graded_towards, 0.0)
        open_ = _split(open_, graded_towards)
    done.sort()
    return np.array([p[0] for p in done] + [done[-1][1]]), np.array(
        [p[2] for p in done], dtype=np.int64
    )


def _unsettled(x: float) -> ResolutionError:
    return ResolutionError(
        f"the slope does not settle: {MAX_PIECES} pieces were not enough, near x = {x:.6g} it "
        "still changes; declare its breaks, narrow the domain, or smooth the noise",
        x=x,
    )


def _split(pieces: Array, graded_towards: Array) -> Array:
    """Halves of the pieces (K, 2); many halvings at once of those that touch a graded break.

    A piece that has been halved before touches no more than one.
    """
    touches = np.isin(pieces, graded_towards)
    alone = ~touches.any(axis=1)
    lo, hi = pieces[alone].T
    middle = 0.5 * (lo + hi)
    parts = [np.stack((lo, middle), axis=1), np.stack((middle, hi), axis=1)]
    for end in (0, 1):
        origin, length = pieces[touches[:, end], end], np.diff(pieces[touches[:, end]])
        away = length * np.append(0.0, 0.5 ** np.arange(HALVINGS, -1, -1.0)) * (1.0 - 2.0 * end)
        x = origin[:, None] + away
        parts.append(np.sort(np.stack((x[:, :-1], x[:, 1:]), axis=-1).reshape(-1, 2), axis=1))
    halves = np.concatenate(parts)
    return halves[halves[:, 0] < halves[:, 1]]  # the last halvings may be less than an ulp


def _degrees(
    function: Callable[[Array], Array], pieces: Array, n: int, tolerance: Tolerance, scale: float
) -> tuple[NDArray[np.int64], float]:
    """(The degree that resolves each piece (K, 2), -1 if n points do not; the largest |value|)."""
    lo, hi = pieces.T
    middle, half = 0.5 * (lo + hi), 0.5 * (hi - lo)
    s = np.concatenate((chebyshev.points(n), PROBES))
    x = middle[:, None] + half[:, None] * s
    # a jump beside an end shows there, where that is no end of smoothness itself
    ends = np.stack((np.nextafter(lo, hi), np.nextafter(hi, lo)), axis=1)
    values = function(np.concatenate((x, ends), axis=1))
    refuse_non_finite(np.concatenate((x, ends), axis=1), values)
    scale = max(scale, float(np.abs(values).max()))
    c = chebyshev.transform(values[:, :n])
    enough = tolerance.of(pieces, values, scale)
    # a few ulp of x change the value by as much: no series can be more accurate
    floor = np.maximum(
        enough,
        EPS * np.abs(x).max(axis=1) * np.ptp(values, axis=1) / (2.0 * np.maximum(half, TINY)),
    )
    missed = np.abs(c @ _at_probes(n) - values[:, n:])
    missed[:, -2:] *= ~np.isin(pieces, tolerance.smooth_between)
    missed = missed.max(axis=1)
    settled = (np.abs(c[:, -TAIL:]).max(axis=1) <= floor) & (missed <= MISSED * floor)
    ulp = np.spacing(np.abs(pieces).max(axis=1))
    settled |= 2.0 * half <= np.maximum(4.0 * ulp, tolerance.shortest)
    chopped = zip(c, 0.5 * enough, settled, strict=True)
    lengths = [chebyshev.chopped_length(row, by) - 1 if ok else -1 for row, by, ok in chopped]
    return np.array(lengths, dtype=np.int64), scale


@lru_cache(maxsize=len(SIZES))
def _at_probes(n: int) -> Array:
    return chebyshev.polynomials(n, np.append(PROBES, (-1.0, 1.0)))


def rounding_noise(function: Callable[[Array], Array], lo: float, hi: float) -> float:
    """Roughness of the function's values on [lo, hi] by its own rounding, as of exp(x) - 1 near 0.

    No series can be more accurate. It is the residual of a quintic through the values at
    NEIGHBOURS points very close together, as the median over several places.
    """
    middle = 0.5 * (lo + hi) + 0.5 * (hi - lo) * PROBES
    s = chebyshev.points(NEIGHBOURS)
    values = function(middle[:, None] + CLOSE * (hi - lo) * s)
    refuse_non_finite(middle[:, None] + 0.0 * s, values)
    left = values - chebyshev.transform(values)[:, :6] @ chebyshev.polynomials(6, s)
    # Not np.median: it imports numpy.ma, which takes longer than a solve.
    return sorted(np.abs(left).max(axis=1).tolist())[len(PROBES) // 2]


def refuse_non_finite(x: Array, values: Array) -> None:
    """ValueError with the place of the first slope that is nan or infinite."""
    bad = ~np.isfinite(values)
    if bad.any():
        raise ValueError(
            f"the slope returned {values[bad][0]} at x = {x[bad][0]:.6g}: "
            "it must be finite inside its domain; narrow the domain"
        )


def refined(slope: Slope, lo: float, hi: float, tol: float, cuts: Array | None = None) -> Slope:
    """The slope on [lo, hi], its functions resolved to tol times the largest |H| there.

    A slope without functions is returned as it is.
    """
    if not slope.functions:
        return slope
    inner = slope.breaks[(slope.breaks > lo) & (slope.breaks < hi)]
    breaks, degrees = resolved(slope.inside, np.concatenate(([lo], inner, [hi])), tol, cuts)
    k = slope.locate(breaks[:-1])
    return replace(slope.chosen(k, breaks), orders=degrees)
