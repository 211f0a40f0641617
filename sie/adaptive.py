"""Pieces on which a function is resolved by Chebyshev series: chop where the coefficients decay, split where they do not.

All open intervals are sampled in one call of the function, level by level. Halving towards a point where the function behaves like |x|^s
grades the pieces geometrically by itself; a jump or a kink that was not declared is closed in to rounding.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from . import chebyshev
from .errors import ResolutionError
from .interval import EPS
from .slope import Slope

Array = NDArray[np.float64]

SIZES = (17, 33)  # points a piece is tried with before it is split
TAIL = 3  # the last coefficients that must have decayed
MAX_PIECES = 20_000


def resolved(function: Callable[[Array], Array], breaks: Array, tol: float) -> tuple[Array, NDArray[np.int64]]:
    """Breaks (a refinement of `breaks`) and the Chebyshev degree that resolves each piece to tol times the largest |value|.

    `function` takes and returns arrays (K, n). Raises ValueError if it returns nan or infinities, ResolutionError if it does not settle.
    """
    lo, hi = breaks[:-1].copy(), breaks[1:].copy()
    done: list[tuple[float, float, int]] = []
    scale = 0.0
    while lo.size:
        failed = np.ones(len(lo), dtype=bool)
        for n in SIZES:
            open_ = np.flatnonzero(failed)
            x = 0.5 * (lo[open_] + hi[open_])[:, None] + 0.5 * (hi[open_] - lo[open_])[:, None] * chebyshev.points(n)
            values = function(x)
            _refuse_non_finite(x, values)
            scale = max(scale, float(np.abs(values).max()))
            c = np.abs(chebyshev.transform(values))
            # a few ulp of x move the value by rounding of its own: no series can do better
            noise = EPS * (np.abs(x).max(axis=1) * np.ptp(values, axis=1) / (hi[open_] - lo[open_]))
            floor = np.maximum(tol * scale, noise)
            settled = c[:, -TAIL:].max(axis=1) <= floor
            settled |= hi[open_] - lo[open_] <= 4.0 * np.spacing(np.maximum(np.abs(lo[open_]), np.abs(hi[open_])))
            for i in np.flatnonzero(settled):
                at = open_[i]
                done.append((lo[at], hi[at], chebyshev.chopped_length(c[i], 0.5 * tol * scale) - 1))
            failed[open_[settled]] = False
            if not failed.any():
                break
        lo, hi = lo[failed], hi[failed]
        middle = 0.5 * (lo + hi)
        lo, hi = np.concatenate((lo, middle)), np.concatenate((middle, hi))
        if len(done) + len(lo) > MAX_PIECES:
            worst = float(middle[0]) if middle.size else float("nan")
            raise ResolutionError(
                f"the slope does not settle: {MAX_PIECES} pieces were not enough, near x = {worst:.6g} it still changes; "
                "declare its breaks, narrow the domain, or smooth the noise",
                x=worst,
            )
    done.sort()
    return np.array([p[0] for p in done] + [done[-1][1]]), np.array([p[2] for p in done], dtype=np.int64)


def _refuse_non_finite(x: Array, values: Array) -> None:
    bad = ~np.isfinite(values)
    if bad.any():
        raise ValueError(
            f"the slope returned {values[bad][0]} at x = {x[bad][0]:.6g}: it must be finite inside its domain; narrow the domain"
        )


def refined(slope: Slope, lo: float, hi: float, tol: float) -> Slope:
    """The slope on [lo, hi], its functions resolved to tol times the largest |H| there; a slope without functions is returned as it is."""
    if not slope.functions:
        return slope
    inner = slope.breaks[(slope.breaks > lo) & (slope.breaks < hi)]
    breaks, degrees = resolved(slope.inside, np.concatenate(([lo], inner, [hi])), tol)
    k = np.clip(np.searchsorted(slope.breaks, breaks[:-1], side="right") - 1, 0, len(slope.origins) - 1)
    return Slope(breaks, slope.origins[k], slope.coefficients[k], np.maximum(degrees, slope.degrees[k]), slope.functions)


def integral(slope: Slope, start: float, x: Array) -> Array:
    """∫ H from start to each x (any shape), by resolved pieces; inf beyond the ends of the indenter."""
    lo, hi = slope.domain
    inside = np.clip(x, lo, hi)
    out = np.zeros(np.shape(x))
    for sign in (-1.0, 1.0):
        ahead = sign * (inside - start)
        if ahead.size == 0 or ahead.max() <= 0.0:
            continue
        end = start + sign * float(ahead.max())
        pieces = refined(slope, min(start, end), max(start, end), EPS)
        out = np.where(ahead > 0.0, _antiderivative(pieces, start, inside), out)
    return np.where((x < lo) | (x > hi), np.inf, out)


def _antiderivative(pieces: Slope, start: float, x: Array) -> Array:
    """∫ H from start, on the resolved pieces (start is one of their ends)."""
    k = np.arange(len(pieces.degrees))
    lo, length = pieces.breaks[:-1], np.diff(pieces.breaks)
    n = int(pieces.degrees.max()) + 1
    c = chebyshev.transform(pieces.local(k, lo, np.zeros(len(k)), 0.5 * length[:, None] * (1.0 + chebyshev.points(n))))
    primitive = chebyshev.antiderivative(c) * (0.5 * length)[:, None]
    at = np.concatenate(([0.0], np.cumsum(primitive.sum(axis=1))))
    at -= at[int(np.searchsorted(pieces.breaks, start))]
    flat = x.ravel()
    j = np.clip(np.searchsorted(pieces.breaks, flat, side="right") - 1, 0, len(k) - 1)
    s = np.clip((flat - lo[j]) / (0.5 * length[j]) - 1.0, -1.0, 1.0)
    values = at[j] + np.array([chebyshev.evaluate(primitive[a], b) for a, b in zip(j, s, strict=True)])
    return values.reshape(x.shape)
