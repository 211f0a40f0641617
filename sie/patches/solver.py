"""The patches of a load, their number included.

A grid gives a first guess; Newton's method finds the edges; bounds verify the inequalities. Where
they fail, a patch is cut where it pulls, added where the bodies overlap, or merged with the next
where a whole gap overlaps, and Newton's method starts again. Nothing is returned uncertified.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError, LoadError

from . import newton
from .admissible import Findings, Found, Overlap, findings, gap
from .chord import Chord
from .newton import Event, State
from .of_scene import Problem
from .operator import Operator
from .panels import Patches
from .pieces import Pieces
from .start import FEW, Grid, Patch, grid_pressure, patches_on

Array = NDArray[np.float64]

ROUNDS = 30
FEWEST_CELLS, MOST_CELLS = 2048, 65536
CELLS = 1.5  # for each break in the window
NARROWEST = 0.02  # of the window: what contact takes at least of a window that fits
COARSE = 512  # cells of a grid that looks for the window
WINDOWS = 200
WIDENED = 12  # times a window is widened, before the slope is said to rise too little
FAR, LOOKED_AT = (
    1e3,
    4000,
)  # windows beyond a window, and places there, at which the bodies must not overlap
# of the largest D: tension that is accepted beside a merger, where no arithmetic tells more
NEARLY = 1e-7


def contact(problem: Problem) -> Found:
    """The patches of a problem. Raises ContactError where none are certified."""
    window = fitted_window(problem)
    for _ in range(WIDENED):
        found = _within(problem, window)
        beyond = _overlap_beyond(found, problem, window)
        if beyond == window:
            return found
        window = beyond
    raise LoadError(
        f"contact goes on beyond [{window[0]:.6g}, {window[1]:.6g}]: the slope rises too little; "
        "give a domain"
    )


def _within(problem: Problem, window: tuple[float, float]) -> Found:
    tilt = problem.given.tilt
    if problem.given.moment is not None:
        tilt = _level(problem, window)
    cells = FEWEST_CELLS
    inside = np.count_nonzero((problem.breaks > window[0]) & (problem.breaks < window[1]))
    while cells < min(CELLS * inside, MOST_CELLS // 4):
        cells *= 2
    last: ContactError | None = None
    pieces = problem.pieces(window)
    height = problem.tilted(tilt, window)
    while cells <= MOST_CELLS:
        grid = grid_pressure(height, window, cells, problem.given.load, problem.chord.periodic)
        try:
            found = settled(start_of(grid, pieces, problem, tilt), pieces, problem)
        except ContactError as error:
            last = error
        else:
            refuse_unknown_ends(found.state, problem)
            return found
        cells *= 8
    assert last is not None
    raise last


def _overlap_beyond(
    found: Found, problem: Problem, window: tuple[float, float]
) -> tuple[float, float]:
    """A wider window where contact reaches the end of this one, or the bodies overlap beyond it,
    where the load is a force.
    """
    lo, hi = found.operator.pieces.domain
    if problem.chord.periodic or (lo, hi) == problem.domain:
        return window
    P = found.state.patches
    a, b = float(P.a[0]), float(P.b[-1])
    wider = [lo, hi]
    for k, (end, limit, side) in enumerate(
        ((lo, problem.domain[0], -1.0), (hi, problem.domain[1], 1.0))
    ):
        if end == limit:
            continue
        if end == (a, b)[k]:
            wider[k] = end + side * 4.0 * (hi - lo)
            continue
        distance = (hi - lo) * np.geomspace(1e-3, FAR, LOOKED_AT)
        x = np.clip(end + side * distance, min(end, limit), max(end, limit))
        with np.errstate(all="ignore"):
            H = problem.slope(x) + found.state.tilt
            rise = np.cumsum(side * 0.5 * (H[1:] + H[:-1]) * np.abs(np.diff(x)))
            middle = 0.5 * (a + b)
            opened = float(gap(found.operator, np.array([end]))[0])
            g = (
                opened
                + rise
                - problem.given.load / np.pi * np.log(np.abs((x[1:] - middle) / (x[0] - middle)))
            )
            below = np.flatnonzero(g < -1e-3 * max(opened, 0.0))
        if below.size:
            wider[k] = float(x[1:][below[0]]) + side * 2.0 * (hi - lo)
    return max(wider[0], problem.domain[0]), min(wider[1], problem.domain[1])


def refuse_unknown_ends(state: State, problem: Problem) -> None:
    """Raises LoadError where contact reaches an end beyond which the indenter is not known."""
    edges = zip(state.patches.edges[[0, -1]].tolist(), problem.domain, problem.corners, strict=True)
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


# -- the window ------------------------------------------------------------------------------------


def fitted_window(problem: Problem) -> tuple[float, float]:
    """The interval of possible contact: the domain, or a part of it found on a coarse grid."""
    if problem.chord.periodic:
        return problem.domain[0], problem.domain[0] + problem.chord.period
    lo, hi = _first_window(problem)
    widened = 0
    for _ in range(WINDOWS):
        height = problem.tilted(problem.given.tilt, (lo, hi))
        grid = grid_pressure(height, (lo, hi), COARSE, problem.given.load, False)
        x = grid.x[grid.p > 0.0]
        a, b = x[0] - 0.5 * grid.dx, x[-1] + 0.5 * grid.dx
        left, right = (
            a - lo < 2.0 * grid.dx and lo > problem.domain[0],
            hi - b < 2.0 * grid.dx and hi < problem.domain[1],
        )
        if left or right:
            widened += 1
            if widened > WIDENED:
                break
            lo, hi = (lo - 2.0 * (hi - lo) if left else lo), (hi + 2.0 * (hi - lo) if right else hi)
            lo, hi = max(lo, problem.domain[0]), min(hi, problem.domain[1])
        elif b - a < NARROWEST * (hi - lo):
            margin = 2.0 * (b - a)
            lo, hi = max(lo, a - margin), min(hi, b + margin)
        else:
            return lo, hi
    raise LoadError(
        f"normal_load over E*/2 = {problem.given.load:.6g} makes contact reach beyond [{lo:.6g}, "
        f"{hi:.6g}]: "
        "the slope rises too little, give a domain"
    )


def _first_window(problem: Problem) -> tuple[float, float]:
    """The domain where it is bounded; otherwise about the breaks as far as the slope has to rise to
    carry the load.
    """
    lo, hi = problem.domain
    if np.isfinite(lo) and np.isfinite(hi):
        return lo, hi
    finite = problem.breaks[np.isfinite(problem.breaks)]
    first, last = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    sizes = np.geomspace(1e-140, 1e140, 561)
    with np.errstate(all="ignore"):
        # a contact of half-width w under slopes of the size H carries about w H
        right = sizes * (problem.slope(np.clip(last + sizes, lo, hi)) + problem.given.tilt)
        left = -sizes * (problem.slope(np.clip(first - sizes, lo, hi)) + problem.given.tilt)
        enough = [np.flatnonzero(force >= problem.given.load) for force in (right, left)]
    size = max((float(sizes[k[0]]) for k in enough if k.size), default=1.0)
    return max(lo, first - 4.0 * size), min(hi, last + 4.0 * size)


def _level(problem: Problem, window: tuple[float, float]) -> float:
    """The tilt whose load has the given moment, on a coarse grid: M falls as the tilt grows."""
    assert problem.given.moment is not None
    lo, hi = window

    def moment(tilt: float) -> float:
        grid = grid_pressure(
            problem.tilted(tilt, window), window, COARSE, problem.given.load, False
        )
        return float((grid.p * grid.x).sum() * grid.dx) - problem.given.moment  # type: ignore[operator]

    size = problem.given.load / (hi - lo)
    now = moment(0.0)
    if now == 0.0:
        return 0.0
    sign = np.sign(now)
    near, far = 0.0, sign * size
    for _ in range(60):
        if moment(far) * sign <= 0.0:
            break
        near, far = far, 2.0 * far
    for _ in range(24):
        middle = 0.5 * (near + far)
        if moment(middle) * sign > 0.0:
            near = middle
        else:
            far = middle
    return 0.5 * (near + far)


# -- from a grid to patches ------------------------------------------------------------------------


def start_of(grid: Grid, pieces: Pieces, problem: Problem, tilt: float) -> State:
    """The patches on a grid, those of a few cells as parabolas under their load."""
    patches = patches_on(grid)
    rivals = Rivals(
        np.array([p.load for p in patches]),
        np.array([p.centre for p in patches]),
        problem.chord,
        tilt,
        grid.dx,
    )
    if not patches:
        raise LoadError("no contact is found on a grid: choose other units, or give a domain")
    ends = [
        _small(n, patch, rivals, pieces) or (patch.a, patch.b) for n, patch in enumerate(patches)
    ]
    a, b = np.array(_apart(ends)).T
    if problem.chord.periodic:
        a, b = _one_period(a, b, problem.chord.period)
    return bounded(a, b, pieces, problem.chord, tilt)


class Rivals(NamedTuple):
    """Loads and centres of all patches on a grid of cells dx: what presses beside a small one."""

    loads: Array
    centres: Array
    chord: Chord
    tilt: float
    dx: float


def _small(n: int, patch: Patch, all_: Rivals, pieces: Pieces) -> tuple[float, float] | None:
    """The edges of patch n of a few cells; None if the grid tells them better."""
    if patch.cells >= FEW:
        return None
    x, half = patch.centre, 0.5 * all_.dx * patch.cells
    others = np.arange(len(all_.loads)) != n
    loads, centres, chord = all_.loads[others], all_.centres[others], all_.chord
    for _ in range(8):
        d = chord.apart(x - centres)
        k = int(pieces.locate(x))
        pull = float((loads * chord.cosine(x - centres) / d).sum()) / np.pi
        steepness = float(pieces.curvature(k, x)) + float((loads / d**2).sum()) / np.pi
        if not steepness > 0.0:
            return None
        step = (pull - float(pieces.value(k, x, 0.0)) - all_.tilt) / steepness
        if abs(x + step - patch.centre) > half + all_.dx:
            break
        x += step
    curvature = float(pieces.curvature(int(pieces.locate(x)), x))
    if not curvature > 0.0:
        return None
    r = np.sqrt(2.0 * patch.load / (np.pi * curvature))
    return (x - r, x + r) if r < half + all_.dx else None


def _apart(ends: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Patches that overlap as one."""
    found: list[tuple[float, float]] = []
    for a, b in sorted(ends):
        if found and a <= found[-1][1]:
            found[-1] = found[-1][0], max(b, found[-1][1])
        else:
            found.append((a, b))
    return found


def _one_period(a: Array, b: Array, period: float) -> tuple[Array, Array]:
    """Cut where the gap is widest."""
    gaps = np.append(a[1:], a[0] + period) - b
    k = (int(np.argmax(gaps)) + 1) % len(a)
    return np.append(a[k:], a[:k] + period), np.append(b[k:], b[:k] + period)


def bounded(a: Array, b: Array, pieces: Pieces, chord: Chord, tilt: float) -> State:
    """Patches whose edges stay on the indenter: sharp where they reach its ends."""
    a, b = _at_walls(a, b, pieces)
    lo, hi = pieces.solid_around(0.5 * (a + b))
    sharp = np.stack((a <= lo, b >= hi), axis=1).ravel()
    a, b = np.maximum(a, lo), np.minimum(b, hi)
    kept = b > a
    state = Patches(a[kept], b[kept], chord)
    sharp = sharp.reshape(-1, 2)[kept].ravel()
    return State(state, sharp, np.zeros(len(sharp)), tilt)


def _at_walls(a: Array, b: Array, pieces: Pieces) -> tuple[Array, Array]:
    """Patches that reach across walls, cut there."""
    void = np.flatnonzero(pieces.void)
    if not void.size:
        return a, b
    lo, hi = pieces.ends[void], pieces.ends[void + 1]
    ends: list[list[float]] = []
    for start, stop in zip(a.tolist(), b.tolist(), strict=True):
        crossed = (lo > start) & (hi < stop)
        ends += map(
            list, zip([start, *hi[crossed].tolist()], [*lo[crossed].tolist(), stop], strict=True)
        )
    cut = np.array(ends)
    return cut[:, 0], cut[:, 1]


# -- Newton's method and repairs -------------------------------------------------------------------


def settled(state: State, pieces: Pieces, problem: Problem) -> Found:
    """The certified answer near a start."""
    steps = 0
    nearly: Found | None = None
    for round_ in range(ROUNDS):
        if not state.patches.number:
            break
        state, event, count = newton.solve(state, pieces, problem.given)
        steps += count
        if event is not None:
            state = after(event, state, pieces, problem)
            continue
        o = Operator(state.patches, pieces, np.where(state.sharp, state.charge, 0.0))
        found = Found(state, o, findings(o), round_ + 1, steps)
        if found.findings.ok:
            return found
        if not found.findings.overlap and found.findings.lowest > -NEARLY:
            nearly = found
        state = mended(state, found.findings, o)
    if nearly is not None:
        return nearly
    raise LoadError(
        f"the patches of contact do not settle within {ROUNDS} rounds at normal_load over E*/2 = "
        f"{problem.given.load:.6g}: "
        "two of them are about to merge, or one to appear; change the load a little",
        patches=state.patches.number,
    )


def after(event: Event, state: State, pieces: Pieces, problem: Problem) -> State:
    """The patches after an event."""
    P = state.patches
    a, b, sharp = P.a.copy(), P.b.copy(), state.sharp.copy()
    if event.kind == "smooth":
        o = Operator(P, pieces, np.where(sharp, state.charge, 0.0))
        found = findings(o)
        if found.tension:  # a cut may leave the end without pull
            return mended(state, found, o)
        k = event.number // 2
        sharp[event.number] = False
        if event.number % 2:
            b[k] -= 0.1 * P.r[k]
        else:
            a[k] += 0.1 * P.r[k]
        charge = np.where(sharp, state.charge, 0.0)
        return State(Patches(a, b, P.chord), sharp, charge, state.tilt)
    if event.kind == "vanish":
        keep = ~np.isin(np.arange(P.number), (event.number, *event.others))
        if not keep.any():
            keep[np.argmax(P.r)] = True
        return bounded(a[keep], b[keep], pieces, P.chord, state.tilt)
    if event.kind == "merge" and P.number > 1:
        k = event.number
        if k == P.number - 1:  # across the cut of the period
            a[0] = a[k] - P.chord.period
            a, b = a[:-1], b[:-1]
        else:
            a, b = np.delete(a, k + 1), np.delete(b, k)
        return bounded(a, b, pieces, P.chord, state.tilt)
    return state


def mended(state: State, found: Findings, o: Operator) -> State:
    """The patches cut where they pull, born and merged where the bodies overlap."""
    P, pieces = state.patches, o.pieces
    ends = list(zip(P.a.tolist(), P.b.tolist(), strict=True))
    cut: list[tuple[float, float]] = []
    for k, (a, b) in enumerate(ends):
        start = a
        for t in (t for t in found.tension if t.patch == k):
            middle, half = 0.5 * (t.lo + t.hi), max(0.5 * (t.hi - t.lo), 1e-3 * (b - a))
            lo, hi = middle - np.sqrt(2.0) * half, middle + np.sqrt(2.0) * half
            if lo - start > 0.01 * (b - a):
                cut.append((start, lo))
            start = max(hi, start)
        if b - start > 0.01 * (b - a):
            cut.append((start, b))
    merged = set()
    born = []
    for overlap in found.overlap:
        k = overlap.gap
        inner = 0 <= k < P.number - 1 or P.chord.periodic
        if inner and overlap.largest < 0.1 * overlap.depth:
            merged.add(k)
        else:
            born.append(_born(overlap, state, pieces))
    for k in sorted(merged):
        if k < P.number - 1:
            cut.append((P.b[k] - 0.01 * P.r[k], P.a[k + 1] + 0.01 * P.r[k + 1]))
        else:
            cut.append((P.a[0] - P.gaps[k] - 0.01 * P.r[k], P.a[0] + 0.01 * P.r[0]))
    a, b = np.array(_apart(cut + [e for e in born if e is not None])).T
    if P.chord.periodic:
        a, b = _one_period(*_wrapped(a, b, P.chord.period), P.chord.period)
    return bounded(a, b, pieces, P.chord, state.tilt)


def _wrapped(a: Array, b: Array, period: float) -> tuple[Array, Array]:
    """Patches that reach into each other across the cut, as one."""
    while len(a) > 1 and b[-1] >= a[0] + period:
        a, b = a[1:], np.append(b[1:-1], b[0] + period) if b[0] + period > b[-1] else b[1:]
    while len(a) > 1 and a[0] + period <= b[-1]:
        a = np.append(a[1:-1], a[-1])
        b = b[1:]
    return a, b


def _born(overlap: Overlap, state: State, pieces: Pieces) -> tuple[float, float] | None:
    """A patch where the bodies overlap: as deep as a parabola that its load presses in."""
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
        wide = 0.1 * distance
    return x - wide, x + wide


def changed(problem: Problem, **changes: Any) -> Problem:
    return replace(problem, given=problem.given._replace(**changes))
