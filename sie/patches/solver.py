"""The patches of a load, their number included.

A grid gives a first guess; Newton's method finds the edges; bounds verify the inequalities. Where
they fail, a patch is cut where it is in tension, added where the bodies overlap, or merged with the
next where a whole gap overlaps, and Newton's method starts again. Nothing is returned uncertified.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError, LoadError, ResolutionError
from sie.profiles.look import beside, narrow_parts
from sie.progress_bar import reported

from . import newton
from .bounds import tensions
from .gap import overlaps
from .of_scene import (
    COARSE,
    WIDENED,
    Problem,
    fitted_window,
    levels,
    refuse_light,
    refuse_unknown_ends,
    unsettled,
    whole_window,
    widened,
)
from .operator import Found, Operator, operator_of
from .panels import Patches
from .repairs import after, apart, bounded, mended, one_period
from .start import Grid, cells_of
from .state import SAME, Event, Findings, Given, State, balances

if TYPE_CHECKING:
    from sie.numerics.chord import Chord
    from sie.profiles.pieces import Pieces

Array = NDArray[np.float64]

ROUNDS, STALLS = 30, 1  # the most rounds, and those that end without edges or an event
# of the largest D: tension that is accepted beside a merger, where no arithmetic tells more
NEARLY = 1e-7
PER_BREAK, PER_VALLEY = 6.0, 64.0  # cells for each in the window: the fewer of both
FEWEST_CELLS, MOST_CELLS = 2048, 1 << 18  # of a period, and of all
FINER = 8  # a second grid, if the first as a start leads nowhere
BEYOND = 0.9  # of a cell: an edge is no farther from the middle of the outer cell


@reported("patches of contact, step")
def contact(problem: Problem) -> Found:
    """The patches of a problem. Raises ContactError where none are certified."""
    window = fitted_window(problem)
    for _ in range(WIDENED):
        found = _within(problem, window)
        beyond = widened(found.state.patches, problem, window)
        if beyond == window:
            found = _in_one_period(_with_far_valleys(found, problem), problem)
            refuse_light(found, problem)
            return found
        window = beyond
    raise LoadError(
        f"the load {problem.load:.6g} makes contact reach beyond [{window[0]:.6g}, "
        f"{window[1]:.6g}]: the slope rises too little, give a domain"
    )


def _in_one_period(found: Found, problem: Problem) -> Found:
    """The same contact; per period the first patch begins in that of the profile.

    The widest gap follows the last patch, of equal ones the first. Sharp edges stay on the ends of
    the indenter, and patches about to merge are left where they are.
    """
    state, P, period = found.state, found.state.patches, problem.chord.period
    if not P.chord.periodic:
        return found
    start = problem.domain[0]
    first = np.roll(P.a, -1) - start
    first -= period * np.floor(first / period + SAME)
    widest = P.gaps >= (1.0 - SAME) * P.gaps.max()
    turn = (int(np.argmin(np.where(widest, first, np.inf))) + 1) % P.number
    a, b = (np.append(e[turn:], e[:turn] + period) for e in (P.a, P.b))
    turns = np.floor((a[0] - start) / period + SAME) * period
    if turn == 0 and turns == 0.0:
        return found
    sharp, charge = np.roll(state.sharp, -2 * turn), np.roll(state.charge, -2 * turn)
    lo, hi = found.operator.pieces.solid_around(0.5 * (a + b) - turns)
    a, b = np.where(sharp[::2], lo, a - turns), np.where(sharp[1::2], hi, b - turns)
    turned = State(Patches(a, b, P.chord), sharp, charge, state.tilt)
    return attempted(lambda: turned, found.operator.pieces, problem) or found


def _within(problem: Problem, window: tuple[float, float]) -> Found:
    given, chord, pieces = problem.given, problem.chord, problem.pieces(window)
    tilts = (given.tilt,) * 2 if given.moment is None else levels(problem, window)

    def of_grid(tilt: float, cells: int) -> State:
        return touched(problem.grid(tilt, window, cells), pieces, chord, tilt)

    def start(cells: int) -> State:
        state = of_grid(0.5 * (tilts[0] + tilts[1]), cells)
        if balances(state, given):
            return state
        # at this tilt the contact changes from one indenter to another: both carry the load
        both = [of_grid(t, COARSE).patches for t in tilts]
        a, b = apart([e for P in both for e in P.zones])
        return bounded(a, b, pieces, chord, state.tilt)

    cells = _cells(problem, 0.5 * (tilts[0] + tilts[1]), window)
    for number in (cells, min(FINER * cells, MOST_CELLS)):
        found = attempted(lambda cells=number: start(cells), pieces, problem)  # type: ignore[misc]
        if found is not None:
            refuse_unknown_ends(found.state, problem)
            return found
    raise unsettled(problem, 0)


def _cells(problem: Problem, tilt: float, window: tuple[float, float]) -> int:
    """The cells of the grid for a first guess: few where a coarse one shows one patch.

    Patches that it does not show are added.
    """
    breaks, fewest = np.asarray(problem.profile.breaks), FEWEST_CELLS
    inside = np.count_nonzero((breaks > window[0]) & (breaks < window[1]))
    if not problem.chord.periodic:
        coarse, fewest = problem.grid(tilt, window, COARSE), COARSE
        if np.count_nonzero(np.diff(coarse.p > 0.0, prepend=False, append=False)) == 2:
            return COARSE
    valleys = problem.pieces(window).valleys(tilt, *window)
    wanted = min(PER_BREAK * inside, PER_VALLEY * valleys)
    return cells_of(min(max(wanted, fewest), MOST_CELLS))


def touched(grid: Grid, pieces: Pieces, chord: Chord, tilt: float) -> State:
    """The patches on a grid; per period they begin where the pressure is least.

    Edges are where p², linear next to a smooth edge, reaches zero.
    """
    p, turn = grid.p, 0
    if grid.periodic:
        turn = int(np.argmin(p))
        p = np.roll(p, -turn)
        p[0] = 0.0  # a gap may be narrower than a cell
    x = grid.x + grid.dx * turn
    ends = np.flatnonzero(np.diff(p > 0.0, prepend=False, append=False))
    first, last = ends[::2], ends[1::2] - 1
    a = x[first] - grid.dx * _beyond(p[first], p[np.minimum(first + 1, last)])
    b = x[last] + grid.dx * _beyond(p[last], p[np.maximum(last - 1, first)])
    if chord.periodic:
        a, b = one_period(a, b, chord.period)
    return bounded(a, b, pieces, chord, tilt)


def _beyond(outer: Array, inner: Array) -> Array:
    """How many cells from the middle of an outer cell on p², linear to it, is zero."""
    rise = inner**2 - outer**2
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(rise > 0.0, np.minimum(outer**2 / rise, BEYOND), 0.5)


def attempted(start: Callable[[], State], pieces: Pieces, problem: Problem) -> Found | None:
    """The certified answer near a start; None where the search goes astray."""
    try:
        return settled(start(), pieces, problem)
    except (ContactError, ArithmeticError, np.linalg.LinAlgError):
        return None


def _with_far_valleys(found: Found, problem: Problem) -> Found:
    """The same contact, or that in which valleys touch as well that its pieces do not show.

    They are all looked at, unless the function has more features than can be resolved.
    """
    state, o = found.state, found.operator
    window, wide = o.pieces.domain, whole_window(problem)
    if not problem.chord.periodic:
        wide = min(window[0], wide[0]), max(window[1], wide[1])
    narrow, missed = np.zeros(0), False
    if problem.by_slope:
        x = np.concatenate(beside((o.patches.edges[0], o.patches.edges[-1]), problem.slope))
        x = x[(x >= wide[0]) & (x <= wide[1])]
        narrow = narrow_parts(problem.slope, x)
        missed = o.pieces.missed(problem.slope, narrow).size > 0
    if (problem.chord.periodic or wide == window) and not missed:
        return found
    try:
        pieces = problem.pieces(
            wide, np.union1d(np.clip(window, *wide), narrow) if missed else np.array(window)
        )
    except ResolutionError:
        return found
    seen = findings(Operator(state.patches, pieces, o.Y), state.tilt, problem.given.load)
    if seen.overlap or missed:
        start = mended(state, replace(seen, tension=()), pieces) if seen.overlap else state
        return settled(start, pieces, problem)
    return replace(found, findings=replace(found.findings, doubt=seen.doubt, place=seen.place))


# -- Newton's method and repairs -------------------------------------------------------------------


def settled(state: State, pieces: Pieces, problem: Problem) -> Found:
    """The certified answer near a start."""
    steps, stalls, nearly = 0, 0, None
    seen: set[tuple[object, ...]] = set()
    for _ in range(ROUNDS):
        start, number = state.rounded, state.patches.number
        longest = problem.effort.steps(number)
        # the same start ends the same again
        if start in seen or longest < 1 or not (state.patches.gaps > 0.0).all():
            break
        seen.add(start)
        state, event, count = newton.solve(state, pieces, problem.given, longest)
        problem.effort.spend(count, number)
        steps += count
        if event is not None:
            stalls += event.kind == "stall"
            if stalls > STALLS:
                break
            state = _after(event, state, pieces, problem.given)
            continue
        o = operator_of(state, pieces)
        shown = overlaps(o, state.tilt, problem.given.load)
        # with one patch more the pressure is another
        shown = shown if shown.overlap else _with_tension(o, shown)
        found = Found(state, o, problem.given, shown, steps)
        if found.findings.ok:
            return found
        if not found.findings.overlap and found.findings.lowest > -NEARLY:
            nearly = found
        state = mended(state, found.findings, pieces)
    if nearly is not None:
        return nearly
    raise unsettled(problem, state.patches.number)


def findings(o: Operator, tilt: float, load: float) -> Findings:
    """What the bounds of pressure and gap find."""
    return _with_tension(o, overlaps(o, tilt, load))


def _with_tension(o: Operator, seen: Findings) -> Findings:
    tension, lowest = tensions(o)
    return replace(seen, tension=tension, lowest=lowest)


def _after(event: Event, state: State, pieces: Pieces, given: Given) -> State:
    # a cut may leave the end without pull; an edge that stalls at a concave corner asks for contact
    # beyond it
    if event.kind in ("smooth", "stall"):
        found = findings(operator_of(state, pieces), state.tilt, given.load)
        if found.tension or (event.kind == "stall" and found.overlap):
            return mended(state, found, pieces)
    left = after(event, state, pieces)
    # no pressure on what is left has the moment: the patches that shrink go on to shrink
    return left if balances(left, given) else state
