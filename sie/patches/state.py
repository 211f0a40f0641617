"""A state of the search for patches, the moves of its edges, events, and what bounds find."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .panels import Patches

if TYPE_CHECKING:
    from sie.profiles.pieces import Pieces

Array = NDArray[np.float64]

MOST_EFFORT = 1500.0
SAME = 1e-9  # half-widths: by which starts differ that do not lead to the same
# half-widths of the narrower patch beside it: a gap that edges in doubles do not tell from none
CLOSED = 2.5e-11
# The most that an edge moves out: half-widths of its patch, widths of its gap
OUTWARD, INTO_GAP = 2.0, 0.4
TO_CORNER = 0.9  # of the way to a concave corner
INWARD, WIDTHS = 0.4, 4.0  # most that it moves in: half-widths, widths of its gap
QUADRATIC = 1e-3  # of its patch or a narrower gap: such steps decrease quadratically
ROUNDED = 1e-7  # of the same: shorter steps back are rounding, and no kink of h'
GROWTH = 3.0  # of moves after one that went too far: slower after every such one, so that it ends
TOGETHER = 4  # steps in a row: both edges of a patch or of a gap ask for more
CLEAR = 10.0  # times what is allowed: such a step outwards counts twice
INSISTS = 12  # steps in a row that a damped edge asks for more: an event


class Given(NamedTuple):
    """The given load, and tilt or moment, in units of E*/2."""

    load: float
    tilt: float
    moment: float | None


@dataclass(frozen=True, eq=False)
class State:
    """Patches, charges of sharp edges (0 at smooth ones), and the tilt."""

    patches: Patches
    sharp: NDArray[np.bool_]  # (2N,)
    charge: Array  # (2N,)
    tilt: float

    @property
    def outward(self) -> Array:
        """-1 at a, 1 at b."""
        return np.tile([-1.0, 1.0], self.patches.number)

    @property
    def rounded(self) -> tuple[object, ...]:
        """What tells a start of Newton's method from another: edges, and which are sharp."""
        digits = SAME * np.repeat(self.patches.r, 2)
        return self.tilt, self.sharp.tobytes(), np.rint(self.patches.edges / digits).tobytes()


def balances(state: State, given: Given) -> bool:
    """Whether the given load acts between the outermost edges, as that of a pressure does."""
    P = state.patches
    return given.moment is None or bool(P.a[0] < given.moment / given.load < P.b[-1])


@dataclass
class Effort:
    """The effort of one search.

    A step of Newton's method with N patches is an effort of 1 + N/100: that of one patch takes
    milliseconds, and that of 1500 patches a second.
    """

    spent: float = 0.0

    def steps(self, patches: int) -> int:
        """How many steps are left."""
        return int((MOST_EFFORT - self.spent) / self._of_step(patches))

    def spend(self, steps: int, patches: int) -> None:
        self.spent += steps * self._of_step(patches)

    @staticmethod
    def _of_step(patches: int) -> float:
        return 1.0 + patches / 100.0


class Event(NamedTuple):
    """The event that stopped the search.

    It is "vanish" and patch k, "merge" and the gap after patch k, "sharp" or "smooth" and edge k.
    """

    kind: str
    number: int
    others: tuple[int, ...] = ()  # all patches that vanish, gaps that merge, the other such edges


class Tension(NamedTuple):
    """An interval with tension: [lo, hi] of patch k."""

    patch: int
    lo: float
    hi: float


class Overlap(NamedTuple):
    """An overlap of the bodies: [lo, hi] in gap k, most at x by `depth`.

    `largest` is the largest g of that gap.
    """

    gap: int
    lo: float
    hi: float
    x: float
    depth: float
    largest: float


class Unseen(NamedTuple):
    """What the pieces of a function have missed.

    resolution   the largest difference from it on the patches, a slope
    lowest_gap   the lowest gap over the largest one of the same gap, 0 where none is negative
    overlap      where the bodies overlap
    """

    resolution: float = 0.0
    lowest_gap: float = 0.0
    overlap: tuple[Overlap, ...] = ()


@dataclass(frozen=True)
class Findings:
    """The violations of the inequalities; none if the patches are the answer.

    lowest      the lowest bound of D over the largest D
    doubt       the largest rounding of h, a length, at a place where it hides whether the bodies
                overlap; place: where that is
    """

    tension: tuple[Tension, ...] = ()
    overlap: tuple[Overlap, ...] = ()
    lowest: float = 0.0
    doubt: float = 0.0
    place: float = 0.0

    @property
    def ok(self) -> bool:
        return not self.tension and not self.overlap


# -- a step of Newton's method ---------------------------------------------------------------------


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
        gaps = P.beside
        most = np.where(
            asked * outward > 0.0,
            np.minimum(np.minimum(OUTWARD * r, INTO_GAP * gaps), TO_CORNER * room(P, corners)),
            np.minimum(INWARD * r, WIDTHS * gaps),
        )
        least = np.maximum(0.5 * np.abs(self.moved), ROUNDED * P.narrower)
        back = (asked * self.moved < 0.0) & (np.abs(asked) > least)
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


def turning_smooth(state: State) -> Event | None:
    """The event of sharp edges whose charges pull."""
    wrong = np.flatnonzero(state.sharp & (state.charge * state.outward < 0.0)).tolist()
    return Event("smooth", wrong[0], tuple(wrong[1:])) if wrong else None


def event_of(state: State, asked: Array, insists: Array, pieces: Pieces) -> Event | None:
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
