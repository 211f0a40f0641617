"""Changes of patches: after an event of the search, and where they are not admissible."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import LoadError

from .panels import Patches
from .state import Event, Findings, Overlap, State

if TYPE_CHECKING:
    from sie.numerics.chord import Chord
    from sie.profiles.pieces import Pieces

Array = NDArray[np.float64]

SHORT = 0.1  # of a patch


def after(event: Event, state: State, pieces: Pieces) -> State:
    """The patches after an event."""
    P = state.patches
    a, b, sharp = P.a.copy(), P.b.copy(), state.sharp.copy()
    if event.kind == "smooth":
        wrong = np.array([event.number, *event.others])
        left, right = wrong[wrong % 2 == 0] // 2, wrong[wrong % 2 == 1] // 2
        inward = _smoothed(P, state.charge, pieces)
        sharp[wrong] = False
        a[left] += inward[2 * left]
        b[right] -= inward[2 * right + 1]
        charge = np.where(sharp, state.charge, 0.0)
        return State(Patches(a, b, P.chord), sharp, charge, state.tilt)
    if event.kind == "vanish":
        keep = ~np.isin(np.arange(P.number), (event.number, *event.others))
        if not keep.any():
            keep[np.argmax(P.r)] = True
        return bounded(a[keep], b[keep], pieces, P.chord, state.tilt)
    if event.kind == "merge" and P.number > 1:
        gaps = np.array(event.others)
        if P.number - 1 in gaps:  # across the cut of the period
            a[0] = a[-1] - P.chord.period
            a, b = a[:-1], b[:-1]
            gaps = gaps[gaps < P.number - 1]
        gaps = gaps[gaps < len(a) - 1]
        return bounded(np.delete(a, gaps + 1), np.delete(b, gaps), pieces, P.chord, state.tilt)
    return state


def _smoothed(P: Patches, charge: Array, pieces: Pieces) -> Array:
    """How far inside its end a sharp edge of this charge would be smooth, about, (2N,).

    The charge y of an edge that moves by δ is D δ/2, and D is π H' on one patch.
    """
    piece = np.stack((pieces.locate(P.a), pieces.locate(P.b, "left")), axis=1).ravel()
    curvature = np.maximum(pieces.curvature(piece, P.edges), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        inward = np.nan_to_num(2.0 * np.abs(charge) / (np.pi * curvature), nan=np.inf)
    return np.asarray(np.minimum(inward, SHORT * np.repeat(P.r, 2)))


def mended(state: State, found: Findings, pieces: Pieces) -> State:
    """The patches cut where they are in tension, added and merged where the bodies overlap."""
    P = state.patches
    ends = list(zip(P.a.tolist(), P.b.tolist(), strict=True))
    cut: list[tuple[float, float]] = []
    corners = pieces.never_closed
    for k, (a, b) in enumerate(ends):
        start, least = a, 0.01 * (b - a)
        for t in (t for t in found.tension if t.patch == k):
            middle, half = 0.5 * (t.lo + t.hi), max(0.5 * (t.hi - t.lo), 1e-3 * (b - a))
            lo, hi = middle - np.sqrt(2.0) * half, middle + np.sqrt(2.0) * half
            # a short rest beside a cut is rounding, but not where a corner keeps it apart
            apart_ = bool(((corners > lo) & (corners < hi)).any())
            if lo - start > (0.0 if apart_ else least):
                cut.append((start, lo))
            start, least = max(hi, start), 0.0 if apart_ else 0.01 * (b - a)
        if b - start > least:
            cut.append((start, b))
    merged = set()
    added = []
    for overlap in found.overlap:
        k = overlap.gap
        inner = 0 <= k < P.number - 1 or P.chord.periodic
        if inner and overlap.largest < 0.1 * overlap.depth:
            merged.add(k)
        else:
            added.append(_added(overlap, state, pieces))
    for k in sorted(merged):
        if k < P.number - 1:
            cut.append((P.b[k] - 0.01 * P.r[k], P.a[k + 1] + 0.01 * P.r[k + 1]))
        else:
            cut.append((P.a[0] - P.gaps[k] - 0.01 * P.r[k], P.a[0] + 0.01 * P.r[0]))
    a, b = apart(cut + [e for e in added if e is not None])
    if P.chord.periodic:
        a, b = one_period(*_wrapped(a, b, P.chord.period), P.chord.period)
    return bounded(a, b, pieces, P.chord, state.tilt)


def _wrapped(a: Array, b: Array, period: float) -> tuple[Array, Array]:
    """Patches that reach into each other across the cut, as one."""
    while len(a) > 1 and b[-1] >= a[0] + period:
        b[-1] = max(b[-1], b[0] + period)
        a, b = a[1:], b[1:]
    return a, b


def _added(overlap: Overlap, state: State, pieces: Pieces) -> tuple[float, float] | None:
    """A patch where the bodies overlap: as deep as a parabola that its load presses in.

    At a corner of the indenter it is as wide as one that a wedge of that slope presses in.
    """
    P = state.patches
    x = overlap.x
    curvature = float(pieces.curvature(int(pieces.locate(x)), x))
    distance = float(np.abs(P.chord.difference(P.edges - x)).min())
    wide = 0.5 * (overlap.hi - overlap.lo)
    if curvature > 0.0:
        r = np.sqrt(2.0 * overlap.depth / curvature)
        for _ in range(20):
            r = np.sqrt(
                2.0 * overlap.depth / curvature / (np.log(max(2.0 * distance / r, 1.1)) + 0.5)
            )
        wide = min(r, 0.5 * distance)
    elif wide == 0.0:
        slope = abs(float(pieces.value(int(pieces.locate(x)), x, 0.0)) + state.tilt)
        wide = 0.1 * distance
        for _ in range(20):
            deep = 0.5 * slope * (np.log(max(2.0 * distance / wide, 1.1)) + 0.5)
            wide = min(overlap.depth / deep, 0.1 * distance) if deep > 0.0 else wide
    return x - wide, x + wide


# -- the edges of patches -------------------------------------------------------------------------


def apart(ends: list[tuple[float, float]]) -> tuple[Array, Array]:
    """Patches that overlap as one. Raises LoadError where there are none."""
    found: list[tuple[float, float]] = []
    for a, b in sorted(ends):
        if found and a <= found[-1][1]:
            found[-1] = found[-1][0], max(b, found[-1][1])
        else:
            found.append((a, b))
    _refuse_none(len(found))
    starts, stops = np.array(found).T
    return starts, stops


def one_period(a: Array, b: Array, period: float) -> tuple[Array, Array]:
    """Cut where the gap is widest."""
    gaps = np.append(a[1:], a[0] + period) - b
    k = (int(np.argmax(gaps)) + 1) % len(a)
    return np.append(a[k:], a[:k] + period), np.append(b[k:], b[:k] + period)


def bounded(a: Array, b: Array, pieces: Pieces, chord: Chord, tilt: float) -> State:
    """Patches whose edges stay on the indenter: sharp where they reach its ends.

    Raises LoadError where none is left.
    """
    a, b = _off_higher_sides(*_at_walls(a, b, pieces), pieces)
    lo, hi = pieces.solid_around(0.5 * (a + b))
    sharp = np.stack((a <= lo, b >= hi), axis=1).ravel()
    a, b = np.maximum(a, lo), np.minimum(b, hi)
    kept = b > a
    _refuse_none(int(np.count_nonzero(kept)))
    state = Patches(a[kept], b[kept], chord)
    sharp = sharp.reshape(-1, 2)[kept].ravel()
    return State(state, sharp, np.zeros(len(sharp)), tilt)


def _refuse_none(patches: int) -> None:
    if not patches:
        raise LoadError(
            "every patch of contact is narrower than doubles resolve: raise the load, "
            "choose other units, or give a domain"
        )


def _at_walls(a: Array, b: Array, pieces: Pieces) -> tuple[Array, Array]:
    """Patches that reach across walls, cut there."""
    void = np.flatnonzero(pieces.void)
    if not void.size:
        return a, b
    lo, hi = pieces.breaks[void], pieces.breaks[void + 1]
    ends: list[list[float]] = []
    for start, stop in zip(a.tolist(), b.tolist(), strict=True):
        crossed = (lo > start) & (hi < stop)
        ends += map(
            list, zip([start, *hi[crossed].tolist()], [*lo[crossed].tolist(), stop], strict=True)
        )
    cut = np.array(ends)
    return cut[:, 0], cut[:, 1]


def _off_higher_sides(a: Array, b: Array, pieces: Pieces) -> tuple[Array, Array]:
    """Patches of which no two meet at a wall.

    The higher side of it cannot touch there, and what is short on it comes from a grid.
    """
    walls = np.flatnonzero(pieces.void & (np.diff(pieces.breaks) == 0.0))
    a, b = a.copy(), b.copy()
    for x, rise in zip(pieces.breaks[walls].tolist(), pieces.across[walls].tolist(), strict=True):
        before, after = np.flatnonzero(b == x), np.flatnonzero(a == x)
        if not (before.size and after.size):
            continue
        j, k = int(before[0]), int(after[0])
        higher, other = (k, j) if rise > 0.0 else (j, k)
        width = b[higher] - a[higher]
        away = width if width < SHORT * (b[other] - a[other]) else SHORT * width
        if rise > 0.0:
            a[k] += away
        else:
            b[j] -= away
    kept = b > a
    return a[kept], b[kept]
