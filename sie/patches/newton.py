"""Newton's method for the edges of N patches, with the derivatives in closed form.

    C_j = ∫ H cos(π(t - c_j)/λ) dν_j = 0          K_i = ∫_{gap i} g' dx = 0
    P = G ∫ H d(t, c_j) dν_j                      M = G ∫ H t d(t, c_j) dν_j

An edge that moves is a point charge there. The conditions are linear in such charges, and
`edge_charges` solves them for C_1..N, K_1..N-1, P and M. One of these may give way to another:

    C_m to K_N where a period is closing, m its widest patch: ∫ g' dx over a period is a sum of all
    C_j, and rounding in them moves the middle of a gap s by 1/s² times as much as rounding in its
    own condition.

The answer is then that to the other conditions, and so much of the answer to a unit change of C_m
alone as the condition in its place asks for.

At a sharp edge, the end of the indenter, the unknown is the charge itself.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import EPS
from sie.profiles.pieces import Pieces
from sie.progress_bar import step_done

from .edge_charges import EdgeCharges
from .measure import edge_ratio
from .operator import Found, Operator, at_edges, gap_values, operator_of
from .repairs import after
from .state import (
    INSISTS,
    INWARD,
    QUADRATIC,
    Damping,
    Event,
    Given,
    State,
    balances,
    event_of,
    moved,
    turning_smooth,
)

Array = NDArray[np.float64]

SMALL = 1e-3  # of the mean: no intensity counts for less
TINY = 1e-200
MOST_STEPS = 60
SETTLED = 1e-11  # half-widths of its patch: steps below, that stop shrinking, are rounding
FINAL = 4e-15  # half-widths that the last step may have
ULPS = 8.0  # of an edge and of the load: no step tells less
NARROW = 1e-5  # half-widths: steps are told from this width of a gap on
# times that an edge is asked back, and the part of the mean: only clear tension counts from then on
TURNS, CLEARLY = 3, 0.03


def solve(
    state: State, pieces: Pieces, given: Given, longest: int
) -> tuple[State, Event | None, int]:
    """Edges that meet the conditions, or the event that stopped the search on its way.

    The number of steps comes with them; `longest` is the most.
    """
    damping = Damping.none(2 * state.patches.number)
    sizes: list[float] = []
    for step in range(min(MOST_STEPS * (1 + state.patches.number), longest)):
        if len(sizes) == MOST_STEPS:  # since the last event
            break
        step_done()
        o = operator_of(state, pieces)
        linear = conditions(state, o, given)
        changes = -missed(state, o, given, linear), loaded(state, given.load)
        y, by_load = linear.charged(np.column_stack(changes)).T
        asked = wished(state, linear, y, damping.turns)
        # D depends on the charges: they first
        unknown = state.sharp.any() and not state.charge.any()
        damping = damping.limited(state, 0.0 * asked if unknown else asked, pieces.concave)
        size = relative_size(state, y, _told(state, asked, linear, by_load))
        size = max(size - state.patches.unknown_share(pieces, given.load), 0.0)
        limits = pieces.solid_around(state.patches.c), given.moment is not None
        state, clipped = moved(state, damping.moved, y, limits)
        sizes.append(np.inf if clipped else size)
        whole = np.array_equal(asked, damping.moved)
        if _settled(sizes, whole, state.sharp.any()):
            return state, turning_smooth(state), step + 1
        event = event_of(state, asked, damping.insists, pieces)
        if event is not None:
            fewer = after(event, state, pieces)
            if fewer.patches.number >= state.patches.number or not balances(fewer, given):
                return state, event, step + 1
            # what the other edges ask for is not changed by an event far from them
            damping, state = damping.carried(state, fewer)
            sizes = []
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


def _told(state: State, asked: Array, linear: Linear, by_load: Array) -> Array:
    """The moves of edges, less what doubles of the edges and of the load do not resolve.

    `by_load`: the charges of the load.
    """
    moves = np.abs(linear.moves(state, by_load))
    resolved = EPS * np.where(np.isfinite(moves), moves, 0.0)
    least = np.spacing(np.abs(state.patches.edges)) + resolved
    return np.maximum(np.abs(asked) - ULPS * least, 0.0)


def relative_size(state: State, y: Array, told: Array) -> float:
    """The largest move of an edge or change of a charge, as a fraction.

    Moves are divided by the half-width or a narrower gap, changes by the largest charge.
    """
    P, sharp = state.patches, state.sharp
    r = np.repeat(P.r, 2)
    size = np.clip(P.beside, NARROW * r, r)
    change = y[: len(sharp)][sharp]
    largest = np.abs(state.charge[sharp] + change).max(initial=0.0)
    return max(
        float((told / size).max()),
        float(np.abs(change).max(initial=0.0) / max(largest, TINY)),
    )


def _settled(sizes: list[float], whole: bool, sharp: np.bool_) -> bool:
    """Whether the last step is small enough.

    It is so too if what follows is, by the steps' quadratic decrease where it was done as a
    `whole`, or if only rounding is left. Beside sharp edges a move is wrong as far as the charges
    before it were.
    """
    last, before = sizes[-1], sizes[-2] if len(sizes) > 1 else np.inf
    if last < FINAL:
        return True
    rate = before if sharp else (last / before) ** 2
    decreased = last < QUADRATIC and before < QUADRATIC and last * rate < FINAL
    return (decreased and whole) or (last < SETTLED and last >= 0.5 * before)


# -- the conditions --------------------------------------------------------------------------------


class Linear(NamedTuple):
    """How the conditions at a state change.

    charges     the charges at the edges that change C, K, P and M
    intensity   D at the edges, (2N,); 0 at sharp ones
    replaced    the numbers of those that gave way to others, (R,)
    rows        the derivatives of the others by the charges, (R, 2N)
    """

    charges: EdgeCharges
    intensity: Array
    replaced: list[int]
    rows: Array

    def charged(self, changes: Array) -> Array:
        """Charges and the change of the tilt, (2N + 1, m), by changes of the conditions."""
        R = len(self.replaced)
        if not R:
            return self.charges.of(changes)
        kept, alone = changes.copy(), np.zeros((len(changes), R))
        kept[self.replaced], alone[self.replaced, np.arange(R)] = 0.0, 1.0
        y = self.charges.of(np.column_stack((kept, alone)))
        y, alone = y[:, :-R], y[:, -R:]
        matrix, right = self.rows @ alone[:-1], changes[self.replaced] - self.rows @ y[:-1]
        size = np.abs(matrix).max(axis=1, keepdims=True)
        return np.asarray(y + alone @ np.linalg.solve(matrix / size, right / size))

    def moves(self, state: State, y: Array) -> Array:
        """The moves of the edges (2N,) by charges; those of sharp ones are 0."""
        with np.errstate(divide="ignore", invalid="ignore"):
            moved = 2.0 * y[: len(state.sharp)] / np.where(state.sharp, 1.0, self.intensity)
        return np.where(state.sharp, 0.0, moved)

    def growth(self, state: State, size: float) -> Array:
        """The derivatives of the edges (2N,) by ln P, or by that of the half-width in its place."""
        return self.moves(state, self.charged(loaded(state, size))[:, 0])


def loaded(state: State, size: float) -> Array:
    """The change of the conditions by a load, or by a width in its place, (2N + 1, 1)."""
    changes = np.zeros((2 * state.patches.number + 1, 1))
    changes[-2] = size
    return changes


def edge_charges(o: Operator, moment: bool) -> EdgeCharges:
    """The charges at the edges of an operator; `moment`: whether that is given, not the tilt."""
    about = float((o.b * o.panels.points.x).sum()) if moment else None
    _, plain = o.closures
    inner = slice(_last_panels(o).start)
    gaps, roots = o.gaps[inner], o.gap_roots[0][inner]
    return EdgeCharges(o.patches, gaps, roots, o.S, plain, float(o.b.sum()), about)


def conditions(state: State, o: Operator, given: Given) -> Linear:
    """How the conditions of patches, of the gaps between, of the load and the moment change."""
    P = state.patches
    intensity = np.where(state.sharp, 0.0, at_edges(o))
    replaced, rows = [], []
    if P.closing:
        replaced, rows = [int(np.argmax(P.r))], [_last_gap(o)]
    charges = edge_charges(o, given.moment is not None)
    return Linear(charges, intensity, replaced, np.array(rows))


def conditions_of(found: Found) -> Linear:
    """The same at an answer."""
    return conditions(found.state, found.operator, found.given)


def response(found: Found, pieces: Pieces, changes: Array) -> tuple[Operator, float, Array]:
    """The changes of an answer by those of H, of P and of M, or of the tilt where that is given.

    They are the operator of the change of p, that of the tilt, and the moves of the edges (2N,).
    All conditions are linear in H and in the charges at the edges: those make up for what the
    inversion of the change of H misses, beside `changes` (2N + 1,).
    """
    state, P, linear = found.state, found.state.patches, conditions_of(found)
    inverted = Operator(P, pieces, np.zeros(2 * P.number))
    left = changes - values(inverted, 0.0, linear, found.given.moment is not None)
    y = linear.charged(left[:, None])[:, 0]
    return Operator(P, pieces, y[:-1]), float(y[-1]), linear.moves(state, y)


def values(o: Operator, tilt: float, linear: Linear, moment: bool) -> Array:
    """C, K, P and M, or 0 where that is not given, (2N + 1,)."""
    N, K = o.patches.number, closed(o)
    C, plain = o.closures
    load, turned = o.resultants(tilt)
    # D contains what charges change in the gaps
    out = np.concatenate((C + (tilt + o.H0) * plain, K[: N - 1], (load, turned if moment else 0.0)))
    if o.patches.closing:
        out[linear.replaced[0]] = K[-1]
    return out


def missed(state: State, o: Operator, given: Given, linear: Linear) -> Array:
    """What the conditions miss, (2N + 1,)."""
    out = values(o, state.tilt, linear, given.moment is not None)
    out[-2:] -= given.load, given.moment or 0.0
    return out


def _last_panels(o: Operator) -> slice:
    """The panels of the last gap of a period that is closing, which follow all others."""
    return slice(int(np.searchsorted(o.gaps.gap, o.patches.number - 1)), None)


def _last_gap(o: Operator) -> Array:
    """The derivatives of K_N by the charges, (2N,): -(1/π) ρ_N(e) ∫ T_N/d(x, e) dx."""
    P, last = o.patches, _last_panels(o)
    x, T = o.gaps.points[last], o.gap_roots[0][last] * o.gaps.dx[last]
    apart = P.chord.apart(x.anchor[..., None] - P.edges, x.offset[..., None])
    ratio = edge_ratio(P, np.array([P.number - 1]))[0]
    return np.asarray(-ratio / np.pi * (T[..., None] / apart).sum(axis=(0, 1)))


def closed(o: Operator) -> Array:
    """K_i of the N - 1 inner gaps; that of the last gap is added where a period is closing."""
    P, pieces, k = o.patches, o.pieces, o.gaps
    n = P.number - 1 + P.closing
    if not n:
        return np.zeros(0)
    reference, T, D = gap_values(o)
    b, a = P.b[:n], np.append(P.a[1:], P.a[0] + P.chord.period)[:n]
    own, next_ = pieces.locate(b, "left"), pieces.locate(a)
    base = pieces.value(own, b, 0.0)
    # on one piece from either edge to the middle the reference is H itself, but for a break between
    simple = (next_ - own <= 1) & (np.bincount(k.gap, ~k.follows, n) == 0.0)
    broken = simple & (next_ > own)
    reference = np.where(simple[k.gap, None], 0.0, reference - base[k.gap, None])
    excess = (reference - T * D / np.pi) * k.dx
    width = np.bincount(k.gap, k.dx.sum(axis=1), n)
    integral = np.bincount(k.gap, excess.sum(axis=1), n)
    risen = np.where(simple, 0.0, pieces.rises(b, a, walls=True) - base * width)
    break_, middle = (pieces.breaks[next_[broken]], 0.0), (b[broken], 0.5 * (a - b)[broken])
    risen[broken] = pieces.rise(next_[broken], break_, middle)
    risen[broken] -= pieces.rise(own[broken], break_, middle)
    return np.asarray(risen - integral)
