"""The lowest of several profiles at every place: a row of indenters has its height."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from itertools import pairwise
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from .base import Profile
from .slope import Slope

Array = NDArray[np.float64]
Runs = list[tuple[float, float, int]]
INF = float("inf")

SAMPLES = 33  # points between two breaks at which the heights of functions are compared
FAR = 1e6  # how far beyond the breaks two functions may cross, in lengths of what is between
NEAR = 1e-6  # of its distance: by which the root of a polynomial may be off
ULPS = 4.0  # by which the ends of a domain may be off


def finite_ends(profile: Profile) -> tuple[float, ...]:
    """The ends of a profile and of its walls, without infinite ones."""
    ends = (*profile.domain, *(x for wall in profile.walls for x in wall))
    return tuple(x for x in ends if abs(x) < INF)


def inside(profiles: tuple[Profile, ...], domains: Array, x: Array) -> Iterator[tuple[int, slice]]:
    """The profiles, and which of the places x (ascending) are on a domain (n, 2) of each."""
    lo, hi = domains.T
    # the ends are rounded, and a height tells them
    beyond = [ULPS * np.spacing(np.where(np.isfinite(v), v, 0.0)) for v in (lo, hi)]
    lo, hi = lo - np.abs(beyond[0]), hi + np.abs(beyond[1])
    start, stop = np.searchsorted(x, lo), np.searchsorted(x, hi, side="right")
    for k in np.flatnonzero(start < stop).tolist():
        # the rounding of a function depends on the places that are asked for together
        whole = bool(profiles[k].pieces.functions)
        yield k, slice(0, len(x)) if whole else slice(start[k], stop[k])


def lowest_of(profiles: tuple[Profile, ...]) -> Runs:
    """(lo, hi, lowest profile) from one crossing or end of the lowest profiles to the next.

    The profile is -1 where there is none.
    """
    slopes = [profile.pieces for profile in profiles]
    places = [s.breaks for s in slopes] + [finite_ends(p) for p in profiles]
    ends = np.unique(np.concatenate(places))
    found: Runs = []
    pieces = list(pairwise(ends.tolist()))
    inner = np.array([_inner(lo, hi) for lo, hi in pieces])
    active: list[list[int]] = [[] for _ in pieces]
    for k, some in inside(profiles, np.array([p.domain for p in profiles]), inner):
        for j in np.flatnonzero(np.asarray(profiles[k].height(inner[some])) < INF).tolist():
            active[some.start + j].append(k)
    for (lo, hi), here in zip(pieces, active, strict=True):
        runs: list[Runs] = [[(lo, hi, k)] for k in here]
        while len(runs) > 1:  # in pairs, so that few heights are compared
            pairs = zip(runs[::2], runs[1::2], strict=False)
            merged = [_lower(profiles, slopes, one, other) for one, other in pairs]
            runs = merged + runs[2 * len(merged) :]
        for run in runs[0] if runs else [(lo, hi, -1)]:
            _append(found, run)
    return found


def _append(found: Runs, run: tuple[float, float, int]) -> None:
    """Add a run behind others, or to the last one of them where the profile is the same."""
    if found and found[-1][2] == run[2]:
        run = found.pop()[0], run[1], run[2]
    found.append(run)


def _lower(profiles: tuple[Profile, ...], slopes: list[Slope], one: Runs, other: Runs) -> Runs:
    """The lower of two envelopes of the same interval, all heights smooth there."""
    found: Runs = []
    ends = sorted({x for lo, hi, _ in one + other for x in (lo, hi)})
    for lo, hi in pairwise(ends):
        i, j = (runs[bisect_right(runs, lo, key=itemgetter(0)) - 1][2] for runs in (one, other))
        for a, b in pairwise(sorted({lo, hi, *_crossings(profiles, slopes, (i, j), lo, hi)})):
            inner = _inner(a, b)
            k = i if float(profiles[i].height(inner)) <= float(profiles[j].height(inner)) else j
            _append(found, (a, b, k))
    return found


def _inner(lo: float, hi: float) -> float:
    if abs(lo) < INF and abs(hi) < INF:
        return 0.5 * (lo + hi)
    if abs(lo) < INF:
        return lo + max(1.0, abs(lo))
    return hi - max(1.0, abs(hi)) if abs(hi) < INF else 0.0


def _crossings(
    profiles: tuple[Profile, ...], slopes: list[Slope], pair: tuple[int, int], lo: float, hi: float
) -> list[float]:
    """The places between lo and hi where two profiles have the same height."""
    one, other = pair
    inner = _inner(lo, hi)
    if slopes[one].functions or slopes[other].functions:
        return _sampled_crossings(profiles[one], profiles[other], lo, hi)
    rows = []
    for k in (one, other):
        piece = int(np.searchsorted(slopes[k].breaks, inner)) - 1
        width = slopes[k].coefficients.shape[1]
        c = slopes[k].about(np.array([piece]), np.array([inner]), width)[0][0]
        height = float(profiles[k].height(inner))
        rows.append([height, *(c / np.arange(1, width + 1))])
    difference = polynomial.polytrim(polynomial.polysub(*rows))
    n = len(difference)
    half = 0.5 * (hi - lo)
    if half < INF and abs(difference[0]) > np.abs(difference[1:]) @ half ** np.arange(1.0, n):
        return []
    roots = polynomial.polyroots(difference)
    real = roots[np.abs(roots.imag) <= 1e-9 * np.abs(roots)].real + inner
    # from the heights themselves: about a far place their difference is rounding of its terms
    with np.errstate(all="ignore"):
        steep = slopes[one](real) - slopes[other](real)
        step = (profiles[one].height(real) - profiles[other].height(real)) / steep
    real = real - np.where(np.abs(step) <= NEAR * np.abs(real - inner), step, 0.0)
    return [float(x) for x in real if lo < x < hi]


def _sampled_crossings(one: Profile, other: Profile, lo: float, hi: float) -> list[float]:
    from scipy.optimize import brentq  # noqa: PLC0415

    def difference(x: Any) -> Any:
        return one.height(x) - other.height(x)

    centre = _inner(lo, hi)
    left, right = (x if abs(x) < INF else centre + side * FAR for x, side in ((lo, -1), (hi, 1)))
    if abs(lo) < INF and abs(hi) < INF:
        x = left + (right - left) * 0.5 * (1.0 - np.cos(np.pi * np.linspace(0.0, 1.0, SAMPLES)))
    else:
        spread = np.geomspace(1e-3, FAR, 4 * SAMPLES)
        x = np.concatenate((centre - spread[::-1], [centre], centre + spread))
        x = x[(x >= left) & (x <= right)]
    with np.errstate(over="ignore", invalid="ignore"):
        values = difference(x)
    change = np.flatnonzero(
        np.isfinite(values[:-1] * values[1:]) & (values[:-1] * values[1:] < 0.0)
    )

    def root(a: float, b: float) -> float:
        at_a, at_b = difference(a), difference(b)
        # Heights at one point may differ by rounding from those at many; then one end is the root.
        if at_a * at_b > 0.0:
            return a if abs(at_a) < abs(at_b) else b
        return float(brentq(difference, a, b, xtol=1e-300, rtol=8.9e-16))

    return [root(float(x[k]), float(x[k + 1])) for k in change]
