"""Newton's method for the edges of N patches, with a Jacobian in closed form (`conditions`).

At a sharp edge, the end of the indenter, the unknown is the charge of the edge itself.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS
from sie.progress_bar import step_done

from .bounds import CLOSED
from .conditions import BLURRED, Linear, conditions, loaded
from .panels import Patches
from .pieces import Pieces
from .repairs import after
from .state import Event, Given, State, balances

Array = NDArray[np.float64]

# The most that an edge moves out: half-widths of its patch, widths of its gap
OUTWARD, INTO_GAP = 2.0, 0.4
TO_CORNER = 0.9  # of the way to a concave corner
INWARD, WIDTHS = 0.4, 4.0  # most that it moves in: half-widths, widths of its gap
SMALL = 1e-3  # of the mean: no intensity counts for less
TINY = 1e-200
MOST_STEPS = 60
SETTLED = 1e-11  # half-widths of its patch: steps below, that stop shrinking, are rounding
FINAL = 4e-15
QUADRATIC = 1e-3  # half-widths: the steps decrease quadratically from here on
ULPS = 8.0  # of an edge and of the load: no step tells less
NARROW = 1e-5  # half-widths: steps are told from this width of a gap on
# times that an edge is asked back, and the part of the mean: only clear tension counts from then on
TURNS, CLEARLY = 3, 0.03
GROWTH = 3.0  # of moves after one that went too far: slower after every such one, so that it ends
TOGETHER = 4  # steps in a row: both edges of a patch or of a gap ask for more
CLEAR = 10.0  # times what is allowed: such a step outwards counts twice
INSISTS = 12  # steps in a row that a damped edge asks for more: an event


class Damping(NamedTuple):
    """What limits the next moves of the edges, (2N,) each.

    trust      the most that an edge moves after it was asked back
    moved      its last move
    insists    steps in a row in which it was asked for more than is allowed
    turns      how often it was asked back
    """

    trust: Array
    moved: Array
    insists: Array
    turns: Array

    def limited(self, state: State, asked: Array, corners: Array) -> Damping:
        """Those after a step that asks for moves; no edge moves out over a concave corner."""
        P, outward = state.patches, state.outward
        r = np.repeat(P.r, 2)
        gaps = np.stack((np.concatenate((P.gaps[-1:], P.gaps[:-1])), P.gaps), axis=1).ravel()
        most = np.where(
            asked * outward > 0.0,
            np.minimum(np.minimum(OUTWARD * r, INTO_GAP * gaps), TO_CORNER * room(P, corners)),
            np.minimum(INWARD * r, WIDTHS * gaps),
        )
        back = (asked * self.moved < 0.0) & (np.abs(asked) > 0.5 * np.abs(self.moved))
        turns, last = self.turns + back, np.abs(self.moved)
        growth = 1.0 + GROWTH / (1.0 + turns**2)
        trust = np.where(back, 0.5 * last, np.maximum(growth * last, self.trust))
        allowed = np.minimum(most, trust)
        more = np.abs(asked) / most
        counted = 1 + ((more > CLEAR) & (asked * outward > 0.0))
        insists = np.where((more > 1.0) & ~back, self.insists + counted, 0)
        return Damping(trust, np.clip(asked, -allowed, allowed), insists, turns)

    def carried(self, before: State, after: State) -> tuple[Damping, State]:
        """The same, and the charges, of the edges that were there before; others begin anew."""
        old, edges = before.patches.edges, after.patches.edges
        k = np.minimum(np.searchsorted(old, edges), len(old) - 1)
        same = old[k] == edges
        new = Damping.none(len(edges))
        charge = np.where(same & after.sharp, before.charge[k], 0.0)
        return Damping(*(np.where(same, v[k], w) for v, w in zip(self, new, strict=True))), replace(
            after, charge=charge
        )

    @classmethod
    def none(cls, n: int) -> Damping:
        return cls(np.full(n, np.inf), *np.zeros((3, n)))


def room(patches: Patches, corners: Array) -> Array:
    """The distances of the edges (2N,) from the next corner outwards; inf where there is none."""
    lower, upper = np.append(-np.inf, corners), np.append(corners, np.inf)
    behind = patches.a - lower[np.searchsorted(corners, patches.a)]
    ahead = upper[np.searchsorted(corners, patches.b, side="right")] - patches.b
    return np.stack((behind, ahead), axis=1).ravel()


def solve(
    state: State, pieces: Pieces, given: Given, accuracy: tuple[float, int], longest: int
) -> tuple[State, Event | None, int]:
    """Edges that meet the conditions, or the event that stopped the search on its way.

    The number of steps comes with them. `accuracy`: half-widths that the last step may have, and
    the most steps since the last event. `longest`: the most of all.
    """
    enough, most = accuracy
    damping = Damping.none(2 * state.patches.number)
    sizes: list[float] = []
    for step in range(min(most + MOST_STEPS * state.patches.number, longest)):
        if len(sizes) == most:
            break
        step_done()
        _, linear = conditions(state, pieces, given)
        changes = -linear.missed, loaded(state, given.size), linear.roundings(BLURRED * given.load)
        y, by_load, by_rounding = linear.charged(np.column_stack(changes)).T
        asked = wished(state, linear, y, damping.turns)
        # D depends on the charges: they first
        unknown = state.sharp.any() and not state.charge.any()
        damping = damping.limited(state, 0.0 * asked if unknown else asked, pieces.concave)
        size = relative_size(state, y, _told(state, asked, linear, (by_load, by_rounding)))
        limits = pieces.solid_around(state.patches.c), given.moment is not None
        state, clipped = moved(state, damping.moved, y, limits)
        sizes.append(np.inf if clipped else size)
        whole = np.array_equal(asked, damping.moved)
        if _settled(sizes, enough, whole, state.sharp.any()):
            return state, _turning_smooth(state), step + 1
        event = _event(state, asked, damping.insists, pieces)
        if event is not None:
            fewer = after(event, state, pieces)
            if fewer.patches.number >= state.patches.number or not balances(fewer, given):
                return state, event, step + 1
            # what the other edges ask for is not changed by an event far from them
            damping, state = damping.carried(state, fewer)
            sizes = sizes[:-1] if most < MOST_STEPS else []
        elif damping.insists.max() >= INSISTS:
            damping.insists[:] = 0
    return state, Event("stall", -1), step + 1


def wished(state: State, linear: Linear, y: Array, turns: Array) -> Array:
    """The moves that the edges are asked for, (2N,)."""
    N = state.patches.number
    smooth = ~state.sharp
    mean = np.abs(linear.intensity[smooth]).mean() if smooth.any() else 1.0
    # next to a concave corner D is larger by orders than elsewhere: one floor is not for all
    D = np.where(linear.intensity > 0.0, linear.intensity, SMALL * mean) + TINY
    D = np.where(smooth, D, 1.0)
    # where the pressure beside an edge is negative the edge has to move in
    threshold = np.where(turns < TURNS, SMALL, CLEARLY) * mean
    pulls = (linear.intensity < -threshold) & smooth
    inward = -INWARD * state.outward * np.repeat(state.patches.r, 2)
    return np.where(pulls, inward, np.where(smooth, 2.0 * y[: 2 * N] / D, 0.0))


def _told(state: State, asked: Array, linear: Linear, charges: tuple[Array, Array]) -> Array:
    """The moves of edges, less what doubles of the edges, of the load and of h do not resolve.

    `charges`: those of the load, and of the rounding of h.
    """
    by_load, by_rounding = (np.abs(linear.moves(state, y)) for y in charges)
    resolved = EPS * np.where(np.isfinite(by_load), by_load, 0.0)
    least = np.spacing(np.abs(state.patches.edges)) + resolved
    blurred = np.nan_to_num(by_rounding)
    return np.maximum(np.abs(asked) - np.maximum(ULPS * least, blurred), 0.0)


def relative_size(state: State, y: Array, told: Array) -> float:
    """The largest move of an edge or change of a charge, as a fraction.

    Moves are divided by the half-width or a narrower gap, changes by the largest charge.
    """
    P, sharp = state.patches, state.sharp
    gaps = np.stack((np.concatenate((P.gaps[-1:], P.gaps[:-1])), P.gaps), axis=1).ravel()
    r = np.repeat(P.r, 2)
    size = np.clip(gaps, NARROW * r, r)
    change = y[: len(sharp)][sharp]
    largest = np.abs(state.charge[sharp] + change).max(initial=0.0)
    return max(
        float((told / size).max()),
        float(np.abs(change).max(initial=0.0) / max(largest, TINY)),
    )


def moved(state: State, move: Array, y: Array, limits: tuple[Any, bool]) -> tuple[State, bool]:
    """The state after a step, and whether edges became sharp at the ends of the indenter."""
    (low, high), turns = limits
    low, high = np.repeat(low, 2), np.repeat(high, 2)
    n, outward, sharp = len(move), state.outward, state.sharp
    e = state.patches.edges + move
    charge = np.where(sharp, state.charge + y[:n], 0.0)
    ends = ((e <= low) & (outward < 0.0)) | ((e >= high) & (outward > 0.0))
    clipped = bool((ends & ~sharp).any())
    if clipped:
        e, sharp = np.where(ends, np.where(outward < 0.0, low, high), e), sharp | ends
    tilt = state.tilt + float(y[n]) if turns else state.tilt
    return State(Patches(e[::2], e[1::2], state.patches.chord), sharp, charge, tilt), clipped


def _settled(sizes: list[float], enough: float, whole: bool, sharp: np.bool_) -> bool:
    """Whether the last step is small enough.

    It is so too if what follows is, by the steps' quadratic decrease where it was done as a
    `whole`, or if only rounding is left. Beside sharp edges a move is wrong as far as the charges
    before it were.
    """
    last, before = sizes[-1], sizes[-2] if len(sizes) > 1 else np.inf
    if last < enough:
        return True
    rate = before if sharp else (last / before) ** 2
    decreased = last < QUADRATIC and before < QUADRATIC and last * rate < enough
    return (decreased and whole) or (last < SETTLED and last >= 0.5 * before)


def _turning_smooth(state: State) -> Event | None:
    """The event of sharp edges whose charges pull."""
    wrong = np.flatnonzero(state.sharp & (state.charge * state.outward < 0.0)).tolist()
    return Event("smooth", wrong[0], tuple(wrong[1:])) if wrong else None


def _event(state: State, asked: Array, insists: Array, pieces: Pieces) -> Event | None:
    """The event of patches whose edges are asked to pass each other, or of gaps asked to close.

    They are so several times in a row. The same holds of a single edge.
    """
    P, out = state.patches, asked * state.outward > 0.0
    single = insists >= INSISTS
    both = (insists >= TOGETHER).reshape(-1, 2) & ~out.reshape(-1, 2)
    shrinking = both.all(axis=1) | (single & ~out).reshape(-1, 2).any(axis=1)
    growing = out & (insists >= TOGETHER)
    closing = growing[1::2] & np.roll(growing[::2], -1)
    outward = single & out
    closing |= outward[1::2] | np.roll(outward[::2], -1)
    closed = P.gaps < CLOSED * np.minimum(P.r, np.roll(P.r, -1))
    if not P.chord.periodic:
        closing[-1] = closed[-1] = False
    kept = np.flatnonzero(closing & ~closed)
    if kept.size:
        closing[sorted(held_open(P, pieces).intersection(kept.tolist()))] = False
    vanished, merged = np.flatnonzero(shrinking), np.flatnonzero(closing | closed)
    if merged.size and P.number > 1:  # full contact is no event: it is ruled out before
        return Event("merge", int(merged[0]), tuple(merged.tolist()))
    if vanished.size:
        return Event("vanish", int(vanished[0]), tuple(vanished.tolist()))
    return None


def held_open(patches: Patches, pieces: Pieces) -> set[int]:
    """The gaps that never close."""
    lo, hi = patches.b, patches.b + patches.gaps
    places = pieces.never_closed
    return set(
        np.flatnonzero(np.searchsorted(places, hi, "right") > np.searchsorted(places, lo)).tolist()
    )
