"""The valleys of a profile, and a first guess of the patches under a load that they carry lightly.

A light load presses each valley like a parabola of its curvature κ, and the others like a force:
with all lengths in units of E*/2, a valley of depth z under the load l at x has

    z + θ x + l/π (ln(2/r) + ½) - Σ_other l_j/π ln d(x, x_j) = the approach,      l = πκr²/2

or lies higher if it carries nothing. So the depths decide, however far the valleys are from each
other, and no grid has to resolve them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .bounds import DEEPEST, NODES, halves, lower_bound
from .chord import Chord
from .pieces import Pieces

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Runs = tuple[Index, Array, Array]

HALVINGS = 70
REACH = 2.0  # of the load and its logarithm: depths beyond carry nothing
MANY = 200  # valleys within reach of a load: a grid resolves them
ROUNDS = 60  # changes of the valleys that carry load
SETTLED = 1e-13  # of the load
LIGHT = 0.05  # of the distance of two valleys: half-widths up to there press like forces
NEAR, GROWTH = 4.0, 16.0  # half-widths: of the first part about a patch, and times each next one
BENT = 0.3  # part by which H may differ from that of a parabola at the distance of two half-widths


class Valleys(NamedTuple):
    """Places x where h + θ x is least about them, its depths z there, and its curvatures."""

    x: Array
    z: Array
    curvature: Array

    def chosen(self, kept: NDArray[np.bool_]) -> Valleys:
        return Valleys(*(v[kept] for v in self))


def valleys(pieces: Pieces, window: tuple[float, float], tilt: float) -> Valleys:
    """The valleys of a profile in a window, which may have no ends; ascending.

    The curvature is infinite at a corner and at the end of an indenter, and 0 on a flat part.
    """
    reach = 2.0 * pieces.horizon(tilt, np.zeros(1)) or 1.0
    bounds = max(window[0], -reach), min(window[1], reach)
    lo, hi = np.maximum(pieces.ends[:-1], bounds[0]), np.minimum(pieces.ends[1:], bounds[1])
    kept = np.flatnonzero((hi > lo) & ~pieces.void)
    lo, hi = lo[kept], hi[kept]
    place, piece = _roots(pieces, _rising(pieces, bounds, tilt), tilt)
    curved = np.maximum(pieces.curvature(piece, place), 0.0)
    # where H jumps from one piece to the next, and at the ends of the indenter
    first, last = (pieces.value(kept, x, 0.0) + tilt for x in (lo, hi))
    joined = np.append(lo[1:] == hi[:-1], False)
    corner = (last < 0.0) & (~joined | (np.append(first[1:], np.inf) >= 0.0))
    begun = np.append(True, ~joined[:-1]) & (first >= 0.0)
    corners = np.concatenate((hi[corner], lo[begun]))
    every = np.concatenate((place, corners))
    order = np.argsort(every, kind="stable")
    curvature = np.concatenate((curved, np.full(len(corners), np.inf)))[order]
    every = every[order]
    if not every.size:
        return Valleys(every, every, curvature)
    start = np.full(every.shape, every[0])
    z = pieces.rises(start, every) + tilt * (every - every[0])
    return Valleys(every, z, curvature)


def within_reach(found: Valleys, load: float, pieces: Pieces, chord: Chord) -> Valleys:
    """The valleys that a load may press, or that the rounding of h does not tell from them."""
    x, z, curvature = found
    if not x.size:
        return found
    curvature = curvature[np.isfinite(curvature)]
    hull = chord.period if chord.periodic else float(np.ptp(x))
    size = load / (1.0 + hull * hull * float(curvature.max(initial=0.0)))
    deepest = np.full(x.shape, x[int(np.argmin(z))])
    unknown = pieces.rounding(np.minimum(x, deepest), np.maximum(x, deepest))
    return found.chosen(z - z.min() <= REACH * load * (1.0 - np.log(size)) + unknown)


def graded_about(x: Array, r: Array, window: tuple[float, float], chord: Chord) -> Array:
    """Places about patches x of half-widths r, which cut a window into parts that shrink to them.

    A function that is resolved on each of them keeps its digits in the patches.
    """
    ends = np.concatenate((window[:1], x, window[1:]))
    if chord.periodic:  # a patch may be at the cut of the period
        x, r = (
            np.concatenate([v + k * p for k in (-1.0, 0.0, 1.0)])
            for v, p in ((x, chord.period), (r, 0.0))
        )
        ends = np.concatenate((x[:1] - chord.period, x, x[-1:] + chord.period))
    room = np.minimum(x - ends[:-2], ends[2:] - x)
    cuts = []
    for place, first, most in zip(x.tolist(), r.tolist(), room.tolist(), strict=True):
        count = int(np.log(max(0.4 * most / (NEAR * first), 1.0)) / np.log(GROWTH)) + 1
        away = NEAR * first * GROWTH ** np.arange(count)
        cuts += [place - away, place + away]
    return np.unique(np.concatenate(cuts))


def _rising(pieces: Pieces, bounds: tuple[float, float], tilt: float) -> Runs:
    """Intervals of pieces on which H rises through -tilt: (piece, lo, hi) of each.

    Parts are halved until bounds show that H has one sign there, or that it rises or falls.
    """
    cuts = np.concatenate(
        (bounds, pieces.cuts[(pieces.cuts > bounds[0]) & (pieces.cuts < bounds[1])])
    )
    cuts = np.unique(cuts)
    lo, hi = cuts[:-1], cuts[1:]
    piece = pieces.locate(0.5 * (lo + hi))
    solid = ~pieces.void[piece]
    piece, lo, hi = piece[solid], lo[solid], hi[solid]
    g, _ = chebyshev.gauss_legendre(NODES)
    found: list[Runs] = []
    for _ in range(DEEPEST):
        x = lo[:, None] + (hi - lo)[:, None] * g
        H = pieces.value(piece[:, None], x, 0.0) + tilt
        bent = pieces.derivative.value(piece[:, None], x, 0.0)
        one_sign = (lower_bound(H) > 0.0) | (lower_bound(-H) > 0.0)
        rises = ~one_sign & (lower_bound(bent) >= 0.0)
        found.append((piece[rises], lo[rises], hi[rises]))
        open_ = ~(one_sign | rises | (lower_bound(-bent) >= 0.0))
        piece, (lo, hi) = np.tile(piece[open_], 2), halves(lo[open_], hi[open_])
        if not lo.size:
            break
    found.append((piece, lo, hi))
    return tuple(np.concatenate(v) for v in zip(*found, strict=True))  # type: ignore[return-value]


def _roots(pieces: Pieces, rising: Runs, tilt: float) -> tuple[Array, Index]:
    """The places where H + tilt changes from negative to positive, and their pieces."""
    k, lo, hi = rising
    low, high = (pieces.value(k, x, 0.0) + tilt for x in (lo, hi))
    turns = (low < 0.0) & (high >= 0.0)
    k, lo, hi = k[turns], lo[turns], hi[turns]
    for _ in range(HALVINGS if k.size else 0):
        middle = 0.5 * (lo + hi)
        falls = pieces.value(k, middle, 0.0) + tilt < 0.0
        lo, hi = np.where(falls, middle, lo), np.where(falls, hi, middle)
    return hi, k


def pressed(found: Valleys, load: float, chord: Chord) -> tuple[Valleys, Array] | None:
    """The valleys that carry a load, and their half-widths; None if it is not light."""
    x, z, curvature = found
    if not 0 < x.size <= MANY:
        return None
    z = z - z.min()
    carries = z == 0.0
    loads = np.where(carries, load / np.count_nonzero(carries), 0.0)
    apart = np.abs(chord.apart(x[:, None] - x)) + np.eye(len(x))
    far = -np.log(apart) / np.pi
    for _ in range(ROUNDS):
        before = loads
        own = loads + (~carries) * 1e-6 * load
        with np.errstate(divide="ignore"):
            r = np.sqrt(2.0 * own / (np.pi * curvature))
            stiff = (np.log(2.0 / r) + 0.5) / np.pi
        if not np.isfinite(stiff[carries]).all():
            return None
        loads, approach = _shared(far + np.diag(stiff), z, carries, load)
        if (loads < 0.0).any():
            carries = carries & (loads > 0.0)
            loads = np.maximum(before, 0.0)
            continue
        above = z + far @ loads
        lower = ~carries & (above < approach)
        if lower.any():
            carries = carries | lower
            loads = np.where(lower, 1e-3 * load, loads)
        elif np.abs(loads - before).max() <= SETTLED * load:
            break
    kept = carries & (loads > 0.0)
    return Valleys(x, z, curvature).chosen(kept), r[kept]


def _shared(A: Array, z: Array, carries: NDArray[np.bool_], load: float) -> tuple[Array, float]:
    """The loads of the valleys that carry, and the approach."""
    k = np.flatnonzero(carries)
    n = len(k)
    matrix = np.zeros((n + 1, n + 1))
    matrix[:n, :n], matrix[:n, n], matrix[n, :n] = A[np.ix_(k, k)], -1.0, 1.0
    solution = np.linalg.solve(matrix, np.append(-z[k], load))
    loads = np.zeros(len(z))
    loads[k] = solution[:n]
    return loads, float(solution[n])


def is_light(found: Valleys, r: Array, pieces: Pieces, tilt: float, chord: Chord) -> bool:
    """Whether valleys under half-widths r press like parabolas far from each other."""
    x = found.x
    if len(x) > 1 or chord.periodic:
        gaps = np.diff(np.append(x, x[0] + chord.period)) if chord.periodic else np.diff(x)
        if not r.max() <= LIGHT * gaps.min():
            return False
    for side in (-2.0, 2.0):
        place = x + side * r
        H = pieces.value(pieces.locate(place), place, 0.0) + tilt
        straight = side * r * found.curvature
        if not (np.abs(H - straight) <= BENT * np.abs(straight)).all():
            return False
    return True
