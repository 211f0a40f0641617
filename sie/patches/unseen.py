"""What a function does between the places that the search for patches has looked at.

The pieces that resolved it are compared with it at places of the certificate's own: in the patches
at those of a low-discrepancy sequence, beside them where its slope turns. Where they differ it is
resolved anew, and the bounds of the gap are computed with that.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.errors import ResolutionError
from sie.numerics.interval import EPS, Interval
from sie.profiles.look import (
    FINER,
    MOST,
    across,
    beside,
    closer,
    falls,
    may_touch,
    narrow_parts,
    turns,
    values,
)
from sie.profiles.unresolved import misfit, start_of

from .gap import overlaps
from .of_scene import Problem, whole_window
from .operator import Found, Operator
from .state import Unseen

Array = NDArray[np.float64]

MISFIT = 64.0 * EPS  # of a slope: what a patch's own window leaves out of it
MARGIN = 0.1  # of the way to a place beyond the window, by which a window has to hold it
SCALE = 1e-3  # of the load over E*/2: the least length that a gap is compared with


def unseen(found: Found, problem: Problem) -> Unseen:
    """What the pieces of a contact have missed; nothing of a profile that is no function."""
    if not problem.by_slope:
        return Unseen()
    o, P, slope = found.operator, found.state.patches, problem.slope
    edges = float(P.a[0]), float(P.b[-1])
    x = _places(problem, edges)
    turn = turns(slope, x)
    missed = o.pieces.missed(slope, turn)
    beyond = _beyond(found, problem, x)
    resolution = _misfit(found, problem)
    if not missed.size and not beyond.size:
        return Unseen(resolution)
    narrow = narrow_parts(slope, x)
    narrow = narrow if narrow.size else missed[:MOST]
    window = whole_window(problem) if problem.chord.periodic else o.pieces.domain
    if beyond.size:
        away = MARGIN * np.ptp(np.append(beyond, edges))
        lo, hi = float(beyond.min()) - away, float(beyond.max()) + away
        window = max(min(window[0], lo), x[0]), min(max(window[1], hi), x[-1])
    try:
        pieces = problem.pieces(window, narrow)
        seen = overlaps(Operator(P, pieces, o.Y), found.state.tilt, problem.given.load).overlap
    except ResolutionError:  # of waves without end
        return Unseen(resolution)
    least = SCALE * problem.given.load
    lowest = min((-v.depth / max(v.largest, least) for v in seen), default=0.0)
    return Unseen(resolution, lowest, seen)


def _places(problem: Problem, edges: tuple[float, float]) -> Array:
    """The places of the certificate, on the whole indenter or on a period."""
    slope, start = problem.slope, start_of(edges)
    if problem.chord.periodic:
        return across(slope, whole_window(problem), start)
    left, right = beside(edges, slope, FINER, start)
    x = np.concatenate((left, across(slope, edges, start), right))
    return np.unique(x[np.isfinite(x)])


def _beyond(found: Found, problem: Problem, x: Array) -> Array:
    """The places among x, and closer ones, beyond the window where the bodies may touch."""
    P, (lo, hi), places = found.state.patches, found.operator.pieces.domain, []
    for side, edge, end in ((-1.0, float(P.a[0]), lo), (1.0, float(P.b[-1]), hi)):
        distance = side * (x - edge)
        out = np.sort(distance[distance > 0.0])
        if problem.chord.periodic or not out.size or side * (end - edge) >= out[-1]:
            continue
        out = closer(out, falls(side * values(problem.slope, edge + side * out)))
        H = side * (values(problem.slope, edge + side * out) + found.state.tilt)
        low = may_touch(out, H, float(P.r.min()), problem.given.load)
        places.append(edge + side * out[low & (out > side * (end - edge))])
    return np.concatenate((*places, np.zeros(0)))


def _misfit(found: Found, problem: Problem) -> float:
    """The largest difference between a function and its pieces, beyond rounding, on the patches."""
    pieces, P = found.operator.pieces, found.state.patches
    largest = 0.0
    for a, b in zip(P.a.tolist(), P.b.tolist(), strict=True):
        if problem.domain[0] <= a and b <= problem.domain[1]:
            _, missed = misfit(problem.slope, (pieces.H,), Interval(a, b), MISFIT)
            largest = max(largest, float(missed.max(initial=0.0)))
    return largest
