"""The lowest points of a profile, where it touches first.

A profile is lowest where its slope changes from negative to positive; a flat base is an interval of
such points, and the end of an indenter can be one. Of several minima the deepest is taken: contact
starts there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import LoadError
from sie.numerics import chebyshev
from sie.numerics.root_finding import false_position

from .pieces import root_bound, without_functions

if TYPE_CHECKING:
    from .slope import Slope

Array = NDArray[np.float64]

SAMPLES = 24  # per piece, besides its degree; a sign change between two samples is then bisected
MANY, FEWER = 100, 3  # a slope of more polynomials than MANY is sampled at FEWER points each
SHORTLIST = 16  # of the minima of a rough trace: the lowest by the samples
BEYOND = 1e-3
ROUNDING = 8.0  # ulp
NEXT = float(np.finfo(float).tiny)  # to the origin of a piece


def lowest_points(slope: Slope) -> tuple[float, float]:
    """[z1, z2] where h is lowest: H <= 0 to the left, H = 0 between, H >= 0 to the right."""
    ends = finite_ends(slope)
    x, H, piece = _samples(slope, ends)
    sign = np.sign(H)
    if sign[0] > 0 and not np.isfinite(slope.breaks[0]):
        raise _without_lowest("left")
    if sign[-1] < 0 and not np.isfinite(slope.breaks[-1]):
        raise _without_lowest("right")
    for end, outer, name in ((0, slope.breaks[0], "left"), (-1, slope.breaks[-1], "right")):
        if sign[end] == 0 and not np.isfinite(outer):
            raise LoadError(
                f"the profile is flat without end to the {name}: its contact has no edge there; "
                "give a profile that rises"
            )
    candidates = _candidates(slope, ends, x, H, piece)
    if len(candidates) == 1:
        z1, z2 = candidates[0]
        return float(z1), float(z2)
    places = np.array([z1 for z1, _ in candidates])
    rises = without_functions(slope).rises(np.full(len(places), places[0]), places)
    z1, z2 = candidates[int(np.argmin(rises))]
    return float(z1), float(z2)


def _without_lowest(side: str) -> LoadError:
    return LoadError(
        f"the profile falls without bound to the {side}: no lowest point, no contact; give a "
        "profile that rises on both sides, such as this one on a domain, or prescribe less tilt",
        falls=side,
    )


def finite_ends(slope: Slope) -> Array:
    """Both ends of every piece (N, 2); for an infinite one a point beyond all roots.

    Fujiwara's bound of the polynomial's roots gives that point.
    """
    ends = np.stack((slope.breaks[:-1], slope.breaks[1:]), axis=1)
    for k, j in np.argwhere(~np.isfinite(ends)):
        bound = root_bound(slope.coefficients[k]) or 1.0
        finite = ends[k][np.isfinite(ends[k])]
        origin = slope.origins[k]
        start = origin if not finite.size else finite[0]
        # Some way beyond the last root, also where that root is next to the other end
        reach = (2.0 * bound + abs(start - origin) + BEYOND * max(abs(start), abs(origin))) or 1.0
        ends[k, j] = origin + (-reach if j == 0 else reach)
    return ends


def _samples(slope: Slope, ends: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Points inside every piece, ascending, the slope there, and the pieces' indices."""
    samples = SAMPLES if slope.functions or len(ends) <= MANY else FEWER
    s = 0.5 * (1.0 + chebyshev.points(samples + slope.degree))
    k = np.arange(len(ends))
    offset = (ends[:, 1] - ends[:, 0])[:, None] * s
    H = slope.value(k[:, None], ends[:, :1], offset)
    H[slope.is_zero] = 0.0
    return (ends[:, :1] + offset).ravel(), H.ravel(), np.repeat(k, len(s))


def _candidates(
    slope: Slope, ends: Array, x: Array, H: Array, piece: NDArray[np.int64]
) -> list[tuple[float, float]]:
    sign = np.sign(H)
    found: list[tuple[float, float]] = []
    moving = np.flatnonzero(sign)
    if not moving.size:
        return [(float(ends[0, 0]), float(ends[-1, 1]))]
    if sign[moving[0]] > 0:
        k = int(piece[moving[0]])
        found.append((float(ends[0, 0]), _root(slope, k, ends[k, 0], x[moving[0]])))
    turn = np.flatnonzero((sign[moving[:-1]] < 0) & (sign[moving[1:]] > 0))
    if len(turn) > SHORTLIST:
        height = np.concatenate(([0.0], np.cumsum(np.diff(x) * 0.5 * (H[1:] + H[:-1]))))
        turn = np.sort(turn[np.argsort(height[moving[turn]], kind="stable")[:SHORTLIST]])
    for i, j in zip(moving[turn].tolist(), moving[turn + 1].tolist(), strict=True):
        found.append(_change(slope, ends, (x[i], int(piece[i])), (x[j], int(piece[j]))))
    if sign[moving[-1]] < 0:
        k = int(piece[moving[-1]])
        found.append((_root(slope, k, x[moving[-1]], ends[k, 1]), float(ends[-1, 1])))
    return found


def _change(
    slope: Slope, ends: Array, before: tuple[float, int], after: tuple[float, int]
) -> tuple[float, float]:
    """The last point with H < 0 and the first with H > 0, between two points (x, piece).

    H is negative at the first point, positive at the second, and changes its sign once between.
    """
    (x, i), (y, j) = before, after
    if i == j:
        z = _root(slope, i, x, y)
        return z, z
    z1, z2 = _root(slope, i, x, ends[i, 1]), _root(slope, j, ends[j, 0], y)
    # A root within rounding of its piece's end is that end: a flat base may begin there
    end, start = float(ends[i, 1]), float(ends[j, 0])
    if z1 < end - ROUNDING * float(np.spacing(abs(end))):
        return z1, z1
    return (z2, z2) if z2 > start + ROUNDING * float(np.spacing(abs(start))) else (end, start)


def _root(slope: Slope, k: int, lo: float, hi: float) -> float:
    """The place in [lo, hi] where H of piece k changes sign; the end, if H jumps there."""
    origin = float(slope.origins[k])

    def H(y: float) -> float:  # from the piece's own origin, so that a root there is met exactly
        return float(slope.value(np.array([k]), origin, np.array([y]))[0])

    a, b = lo - origin, hi - origin
    ends = H(a), H(b)
    if ends[0] >= 0.0 or ends[1] <= 0.0:
        return lo if ends[0] >= 0.0 else hi
    # At the origin, be it a root or a jump: else the bracket would shrink to the smallest doubles
    if a < -NEXT < NEXT < b and (H(0.0) == 0.0 or H(-NEXT) <= 0.0 <= H(NEXT)):
        return origin
    return origin + false_position(H, a, b, ends, lambda *_: False)
