"""Newton's method for the edges of N patches, with a Jacobian in closed form.

    C_j = ∫ H cos(π(t - c_j)/λ) dν_j = 0          K_i = ∫_{gap i} g' dx = 0
    P = G ∫ H d(t, c_j) dν_j                      M = G ∫ H t d(t, c_j) dν_j

When an edge e of patch k moves by δ, F changes by (G/2π) D_k(e) T_k(z)/d(z, e) δ: a point charge at
e. With y = D_k(e) δ/2

    ∂C_j = ρ_j(e) cos(π(e - c_j)/λ)               ∂K_i = -(1/π) ρ_i(e) ∫_{gap i} T_i/d(x, e) dx
    ∂P = G d(e, c_k)                              ∂M = G d(e, c_k) e

with ρ_j(e) = d(e, c_k)/d(e, c_j). At a sharp edge, the end of the indenter, the unknown is the
charge itself.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .chord import Points
from .operator import Operator, Targets, edge_ratio
from .panels import GapPanels, Patches
from .pieces import Pieces

Array = NDArray[np.float64]

OUTWARD, INTO_GAP = (
    2.0,
    0.4,
)  # most that an edge moves out: half-widths of its patch, widths of its gap
INWARD, WIDTHS = 0.4, 4.0  # most that it moves in: half-widths, widths of its gap
SMALL = 1e-3  # of the mean: no intensity counts for less
TINY = 1e-200
MOST_STEPS = 60
SETTLED = 1e-11  # half-widths of its patch: steps below, that stop shrinking, are rounding
FINAL = 4e-15
CLOSED = 1e-10  # of the narrowest half-width: a gap that edges in doubles do not tell from none
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


class Event(NamedTuple):
    """What stopped the search: "vanish" and patch k, "merge" and the gap after patch k, "sharp" or
    "smooth" and edge k.
    """

    kind: str
    number: int
    others: tuple[int, ...] = ()  # patches that vanish as well


class Linear(NamedTuple):
    """The conditions at a state: what is missed, the Jacobian, and D at the edges."""

    missed: Array
    matrix: Array
    intensity: Array


def conditions(state: State, pieces: Pieces, given: Given) -> tuple[Operator, Linear]:
    P = state.patches
    o = Operator(P, pieces, np.where(state.sharp, state.charge, 0.0))
    N, chord, e = P.number, P.chord, P.edges
    k = np.repeat(np.arange(N), 2)
    tilt = state.tilt + o.H0
    missed, matrix = np.zeros(2 * N + 1), np.zeros((2 * N + 1, 2 * N + 1))
    intensity = np.empty(2 * N)
    S = o.others(k, Points(e, np.zeros(2 * N)))
    edge_piece = np.where(np.arange(2 * N) % 2 == 0, pieces.locate(e), pieces.locate(e, "left"))
    value = pieces.value(edge_piece, e, 0.0)
    for i, group in o.at_edges():
        own = slice(2 * i, 2 * i + 2)
        C, plain = group.closure()
        missed[i] = C + tilt * plain
        matrix[i, 2 * N] = plain
        smooth = np.flatnonzero(~state.sharp[own]) + 2 * i
        if smooth.size:
            x = Points(e[smooth], np.zeros(len(smooth)))
            intensity[smooth] = group.D(
                Targets(x, value[smooth], edge_piece[smooth], S[smooth], k[smooth])
            )
    ratio = edge_ratio(P, np.arange(N))
    matrix[:N, : 2 * N] = ratio * chord.cosine(e - P.c[:, None])
    K, across = closures(o, ratio)
    missed[N : 2 * N - 1], matrix[N : 2 * N - 1, : 2 * N] = K, across
    arm = chord.apart(e - P.c[k])
    x = o.panels.points.x
    missed[2 * N - 1] = (o.b * (o.H + tilt)).sum() - given.load
    matrix[2 * N - 1] = np.append(arm, o.b.sum())
    if given.moment is not None:
        missed[2 * N] = (o.b * (o.H + tilt) * x).sum() - given.moment
        matrix[2 * N] = np.append(arm * e, (o.b * x).sum())
    else:
        matrix[2 * N, 2 * N] = 1.0
    charged = matrix[:, : 2 * N] @ o.Y
    charged[N : 2 * N - 1] = 0.0  # D contains them
    charged[2 * N] *= given.moment is not None
    intensity[state.sharp] = 0.0
    return o, Linear(missed + charged, matrix, intensity)


def closures(o: Operator, ratio: Array) -> tuple[Array, Array]:
    """K_i of the N - 1 inner gaps, and their derivatives (N - 1, 2N)."""
    P, pieces, k = o.patches, o.pieces, o.gaps
    N = P.number
    if N == 1:
        return np.zeros(0), np.zeros((0, 2))
    reference, _, T, D = gap_values(o)
    integral = np.bincount(k.gap, ((reference - T * D / np.pi) * k.dx).sum(axis=1), N - 1)
    base = pieces.value(pieces.locate(P.b[:-1], "left"), P.b[:-1], 0.0)
    width = np.bincount(k.gap, k.dx.sum(axis=1), N - 1)
    K = (pieces.rises(P.b[:-1], P.a[1:]) - base * width) - (integral - base * width)
    e = P.edges
    across = np.zeros((N - 1, 2 * N))
    starts = np.flatnonzero(np.diff(k.gap, prepend=-1))
    rows = max((1 << 20) // max(k.dx.shape[1] * 2 * N, 1), 1)
    parts = np.empty((len(k.gap), 2 * N))
    for start in range(0, len(k.gap), rows):
        some = slice(start, start + rows)
        away = P.chord.apart(k.points.anchor[some, :, None] - e, k.points.offset[some, :, None])
        parts[some] = np.einsum("pn,pne->pe", T[some] * k.dx[some], 1.0 / away)
    across[k.gap[starts]] = np.add.reduceat(parts, starts)
    return K, -across * ratio[: N - 1] / np.pi


def gap_values(o: Operator, panels: GapPanels | None = None) -> tuple[Array, Array, Array, Array]:
    """The reference value of H, S_i, T_i and D_i on the nodes of gap panels.

    i is the patch to the left; outside on the left the first one.
    """
    panels = o.gaps if panels is None else panels
    P, pieces = o.patches, o.pieces
    shape = panels.dx.shape
    at_edge = pieces.value(panels.piece, panels.points.anchor[:, 0], 0.0)
    continued = pieces.value(panels.piece[:, None], panels.points.anchor, panels.points.offset)
    reference = np.where(panels.follows[:, None], continued, at_edge[:, None])
    owner = np.maximum(panels.gap, 0)
    nearer = (panels.gap + panels.right) % P.number
    anchors = np.broadcast_to(panels.points.anchor, shape)
    flat = Points(anchors.ravel(), panels.points.offset.ravel())
    T, S = (np.asarray(v).reshape(shape) for v in o.root(np.repeat(owner, shape[1]), flat))
    D = np.empty(shape)
    starts = np.append(np.flatnonzero(np.diff(panels.gap, prepend=-2)), len(panels.gap))
    for start, stop in itertools.pairwise(starts):
        some = slice(start, stop)
        x = Points(anchors[some].ravel(), panels.points.offset[some].ravel())
        i = int(owner[start])
        place = (
            P.chord.difference(x.anchor - P.c[i], x.offset) + P.c[i] if P.chord.periodic else x.x
        )
        piece = np.where(panels.follows[some], panels.piece[some], -1)
        group = o.group(i, float(place.min()), float(place.max()))
        values = group.D(
            Targets(
                x,
                reference[some].ravel(),
                np.repeat(piece, shape[1]),
                S[some].ravel(),
                np.repeat(nearer[some], shape[1]),
            )
        )
        D[some] = values.reshape(stop - start, shape[1])
    return reference, S, T, D


def solve(state: State, pieces: Pieces, given: Given) -> tuple[State, Event | None, int]:
    """Edges that meet the conditions, or the event that stopped the search on its way; and the
    steps.
    """
    low, high = (np.repeat(v, 2) for v in pieces.solid_around(state.patches.c))
    outward = np.where(np.arange(2 * state.patches.number) % 2 == 0, -1.0, 1.0)
    before, insists = np.inf, np.zeros(2 * state.patches.number, dtype=int)
    for step in range(MOST_STEPS):
        P = state.patches
        N = P.number
        _o, linear = conditions(state, pieces, given)
        size = np.abs(linear.matrix).max(axis=1)
        y = np.linalg.solve(linear.matrix / size[:, None], -linear.missed / size)
        mean = np.abs(linear.intensity[~state.sharp]).mean() if (~state.sharp).any() else 1.0
        # next to a concave corner D is larger by orders than elsewhere: one floor is not for all
        D = np.where(linear.intensity > 0.0, linear.intensity, SMALL * mean) + TINY
        D = np.where(state.sharp, 1.0, D)
        k = np.repeat(np.arange(N), 2)
        asked = np.where(state.sharp, 0.0, 2.0 * y[: 2 * N] / D)
        # where the pressure beside an edge is negative the edge has to move in
        pulls = linear.intensity < -SMALL * mean
        asked = np.where(pulls & ~state.sharp, -INWARD * outward * P.r[k], asked)
        gaps = np.stack((np.concatenate((P.gaps[-1:], P.gaps[:-1])), P.gaps), axis=1).ravel()
        r = P.r[k]
        most = np.where(
            asked * outward > 0.0,
            np.minimum(OUTWARD * r, INTO_GAP * gaps),
            np.minimum(INWARD * r, WIDTHS * gaps),
        )
        unknown = (
            state.sharp.any() and not state.charge.any()
        )  # D depends on the charges: they first
        move = np.zeros(2 * N) if unknown else np.clip(asked, -most, most)
        insists = np.where((np.abs(asked) > most) & ~unknown, insists + 1, 0)
        charge = np.where(state.sharp, state.charge + y[: 2 * N], 0.0)
        e = P.edges + move
        largest = float(np.max(np.abs(asked) / r)) if (~state.sharp).any() else 0.0
        charges = np.abs(y[: 2 * N][state.sharp]).max(initial=0.0) / max(
            np.abs(charge).max(initial=0.0), 1e-300
        )
        largest = max(largest, charges)
        sharp = state.sharp
        ends = ((e <= low) & (outward < 0.0)) | ((e >= high) & (outward > 0.0))
        if (ends & ~sharp).any():
            e, sharp = np.where(ends, np.where(outward < 0.0, low, high), e), sharp | ends
            largest = np.inf
        tilt = state.tilt + float(y[2 * N]) if given.moment is not None else state.tilt
        state = State(Patches(e[::2], e[1::2], P.chord), sharp, charge, tilt)
        wrong = sharp & (charge * outward < 0.0)
        if largest < FINAL or (largest < SETTLED and largest >= 0.5 * before):
            return (
                state,
                (Event("smooth", int(np.flatnonzero(wrong)[0])) if wrong.any() else None),
                step + 1,
            )
        before = largest
        if insists.max() >= INSISTS:
            worst = int(np.argmax(insists))
            if asked[worst] * outward[worst] <= 0.0:
                shrinking = (2 * insists >= INSISTS) & (asked * outward <= 0.0)
                return state, Event("vanish", worst // 2, tuple(k[shrinking].tolist())), step + 1
            gap = worst // 2 if worst % 2 else (worst // 2 - 1) % N
            closed = state.patches.gaps[gap] < CLOSED * state.patches.r.min()
            if closed or gap not in held_open(state.patches, pieces):
                return state, Event("merge", gap), step + 1
            insists[:] = 0
    return state, Event("stall", -1), MOST_STEPS


def punch(o: Operator) -> Array:
    """The charges at all edges of a flat punch on the patches, under a unit load."""
    P, N = o.patches, o.patches.number
    k = np.repeat(np.arange(N), 2)
    ratio = edge_ratio(P, np.arange(N))
    matrix = np.zeros((2 * N, 2 * N))
    matrix[:N] = ratio * P.chord.cosine(P.edges - P.c[:, None])
    matrix[N : 2 * N - 1] = closures(o, ratio)[1]
    matrix[2 * N - 1] = P.chord.apart(P.edges - P.c[k])
    size = np.abs(matrix).max(axis=1)
    right = np.append(np.zeros(2 * N - 1), 1.0 / size[-1])
    return np.asarray(np.linalg.solve(matrix / size[:, None], right))


def held_open(patches: Patches, pieces: Pieces) -> set[int]:
    """The gaps that never close."""
    lo, hi = patches.b, patches.b + patches.gaps
    places = pieces.never_closed
    return set(
        np.flatnonzero(np.searchsorted(places, hi, "right") > np.searchsorted(places, lo)).tolist()
    )
