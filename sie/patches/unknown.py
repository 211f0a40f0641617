"""What is not known of an indenter: refusals, and what its pieces do not show of a function.

Beyond the end of a trace nothing is known. And doubles of h tell no difference of two depths below
their rounding: where a load is so light that such a difference decides which valleys touch, or how
they share it, there is no answer. Nor is there one where two patches are about to merge, and the
search for them does not come to rest.

The pieces that resolved a function are compared with it at places of the certificate's own: in the
patches at those of a low-discrepancy sequence, beside them where its slope turns. Where they differ
it is resolved anew, and the bounds of the gap are computed with that.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.errors import LoadError, ResolutionError
from sie.numerics.interval import EPS, Interval
from sie.profiles.look import (
    FINER,
    MOST,
    across,
    beside,
    closer,
    falls,
    may_touch,
    misfit,
    narrow_parts,
    start_of,
    turns,
    values,
)

from .gap import overlaps
from .newton import conditions_of
from .of_scene import Problem, whole_window
from .operator import Found, Operator
from .state import State, Unseen

Array = NDArray[np.float64]

UNKNOWN = 0.01  # part by which the rounding of h may change the load of a patch
MISFIT = 64.0 * EPS  # of a slope: what a patch's own window leaves out of it
MARGIN = 0.1  # of the way to a place beyond the window, by which a window has to hold it
SCALE = 1e-3  # of the load over E*/2: the least length that a gap is compared with


def refuse_unknown_ends(state: State, problem: Problem) -> None:
    """Raises LoadError where contact reaches an end beyond which the indenter is not known."""
    edges = zip(
        state.patches.edges[[0, -1]].tolist(),
        problem.domain,
        problem.profile.ends_are_corners,
        strict=True,
    )
    for edge, end, corner in edges:
        if edge != end or problem.chord.periodic:
            continue
        if not np.isfinite(float(problem.slope(np.array([end]))[0])):
            raise LoadError(
                f"the slope is infinite at the end x = {end:.6g} of its domain, which the "
                "contact comes near: "
                "narrow the domain"
            )
        if not corner:
            raise LoadError(
                f"the contact reaches the end of the trace at x = {end:.6g}, and what the indenter "
                "is like beyond is not known: lower the load or the tilt, repeat the trace by "
                "sie.Periodic(trace, period), or measure further out",
                end=end,
            )


def refuse_unknown_depths(found: Found, problem: Problem) -> None:
    """Raises LoadError where the rounding of h decides which valleys touch, or how they share."""
    P, seen, load = found.state.patches, found.findings, found.given.load

    def refuse(k: int, place: float, known: float, least: float) -> None:
        away = abs(place - P.c[k])
        decides = load / np.pi * (np.log(max(2.0 * away / P.r[k], 1.0)) + 0.5)
        if known > least * decides:
            raise _unknown_depth(problem.load, (float(P.c[k]), place), known, decides)

    if seen.doubt:
        refuse(int(np.argmin(np.abs(P.c - seen.place))), seen.place, seen.doubt, UNKNOWN)
    if P.number == 1:
        return
    linear = conditions_of(found)
    moved = linear.rounded_moves(found.state)  # by the rounding from patch to patch
    if 2.0 * float(np.abs(moved / np.repeat(P.r, 2)).max()) > UNKNOWN:
        k = int(np.argmax(linear.rounding))
        refuse(k, float(P.c[k + 1]), linear.rounding[k], 0.0)


def _unknown_depth(
    load: float, places: tuple[float, float], known: float, decides: float
) -> LoadError:
    x1, x2 = sorted(places)
    return LoadError(
        f"how the valleys at x = {x1:.6g} and {x2:.6g} share normal_load = {load:.6g} "
        f"is decided by a difference of depths of {decides:.2g}, and doubles of h tell "
        f"{known:.2g}: raise the load, or make one valley deeper",
        valleys=(x1, x2),
    )


def unsettled(problem: Problem, patches: int) -> LoadError:
    """The refusal of a load under which the search does not come to rest."""
    other = problem.given.moment is not None
    return LoadError(
        f"the patches of contact do not settle at normal_load = {problem.load:.6g}: two "
        "of them are about to merge, or one to appear; change the load"
        f"{' or the moment' * other} a little",
        patches=patches,
    )


# -- what the pieces do not show -------------------------------------------------------------------


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
            _, missed = misfit(problem.slope, (pieces,), Interval(a, b), MISFIT)
            largest = max(largest, float(missed.max(initial=0.0)))
    return largest
