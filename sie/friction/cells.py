"""What sticks and what slips after a step, on cells with constant Δq.

    minimise ½ Δq·A Δq + Δτ Δq·x,    A q = -1/π ∫ q(t) ln|d(x, t)| dt,    |q| <= f p,  ∫Δq = ΔQ

over all q at once, which is the state at the end of a step in which each point slips in one
direction only (Duvaut & Lions 1972). An active set finds it; it gives the number of stick zones,
the directions of slip beside them, and a guess of their ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.chord import Chord
from sie.numerics.zones import united

from .state import SAME, Contact, State, Zones, intervals

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

CELLS = 16  # between neighbouring marks, graded to both
FEWEST = 64  # on a patch
MOST = 120  # changes of the set
BEYOND, OPPOSING = 1e-12, 1e-12  # of f p, and of the slip: less is rounding
LIMIT = 2e-3  # of f p: q so close to it may have reached it
THIN = 1e-3  # of the contact: slip inside stick, and the reverse, that is not believed at first
NARROW = 1e-9  # of the contact: no cell is narrower


def zones_on_cells(before: State, after: Contact) -> tuple[Zones, ...]:
    """The zones at the end of a step: at first without what only few cells show.

    Raises ContactError where nothing sticks.
    """
    edges = _cells(before, after)
    x = edges.mean(axis=1)
    at, new = _slip(edges, before, after)
    patch = np.zeros(len(x), dtype=int)
    for k, (lo, hi) in enumerate(after.patches):
        patch[(x > lo) & (x < hi)] = k + 1
    share = np.abs(new) / np.maximum(after.limit(x), 1e-300)
    found = []
    size = np.diff(edges, axis=1)[:, 0] / after.width
    for few, thin in ((3, THIN), (1, 0.0)):
        plain = _plain(at, new, share, patch, (few, thin, size))
        zones = _zones(edges, plain, patch, new, (before, after))
        if zones.stick and zones not in found:
            found.append(zones)
    if not found:
        raise ContactError("no cell of the grid sticks, and nothing carries what is left of Q")
    return tuple(found)


def _plain(
    at: Array, new: Array, share: Array, patch: Ints, short: tuple[int, float, Array]
) -> Array:
    """Cells without short runs of slip inside stick, and of stick at f p inside slip.

    short: the cells of such a run at most, its width, and the widths of all cells
    """
    out, (few, thin, size) = at.copy(), short
    cuts = np.flatnonzero((np.diff(at) != 0.0) | (np.diff(patch) != 0)) + 1
    runs = np.split(np.arange(len(at)), cuts)
    for last, run, following in zip(runs, runs[1:], runs[2:], strict=False):
        k, j, m = last[-1], run[0], following[0]
        if not patch[k] == patch[j] == patch[m]:
            continue
        slides = few > 1 and at[j] == 0.0 and bool((new[run] * at[k] > 0.0).all())
        slides = slides and share[run].min() >= 1.0 - LIMIT
        if size[run].sum() < thin or (at[k] == at[m] and (len(run) <= few or slides)):
            out[run] = out[k]
    return out


def _zones(
    edges: Array, at: Array, patch: Ints, new: Array, states: tuple[State, Contact]
) -> Zones:
    """The zones of cells, with slip at all edges; `new` is q, `states` are start and end."""
    before, after = states
    h, x = np.diff(edges, axis=1)[:, 0], edges.mean(axis=1)
    stick, signs = [], []
    for k, (x1, x2) in enumerate(after.patches):
        here = np.flatnonzero(patch == k + 1)
        runs = np.split(here, np.flatnonzero(np.diff(at[here])) + 1)
        for n, run in enumerate(runs):
            first, last = n == 0, n + 1 == len(runs)
            if at[run[0]]:
                if n and at[runs[n - 1][0]]:  # slip in both directions side by side
                    continue
                signs.append(float(at[run[0]]))
                continue
            lo, hi = edges[run[0], 0], edges[run[-1], 1]
            if first:  # slip at an edge may be narrower than a cell
                lo = x1 + 0.2 * h[run[0]]
                signs.append(_towards(before, after, x[run[0]], new[run[0]]))
            if last:
                hi = x2 - 0.2 * h[run[-1]]
            stick.append((float(lo), float(hi)))
            if last:
                signs.append(_towards(before, after, x[run[-1]], new[run[-1]]))
    return Zones(tuple(stick), tuple(signs))


def _towards(before: State, after: Contact, x: float, new: float) -> float:
    """The direction in which slip begins next to an edge: that in which q/(f p) changes there."""
    at = np.array([x])
    old, limit = float(before.shear(at)[0]), float(before.contact.limit(at)[0])
    share = old / limit if limit > 0.0 else 0.0
    change = new / max(float(after.limit(at)[0]), 1e-300) - share
    return float(np.sign(change) or np.sign(old) or 1.0)


def _cells(before: State, after: Contact) -> Array:
    """Cells (n, 2), graded to marks and edges."""
    old = before.contact
    edges = np.array((*old.patches, *after.patches)).ravel()
    marks = np.unique(np.concatenate((before.marks, after.limit.marks, edges)))
    parts = intervals(united((*old.patches, *after.patches)), marks, SAME * after.width)
    out = []
    for lo, hi in parts:
        n = max(CELLS, int(np.ceil(FEWEST * (hi - lo) / after.width)))
        cuts = lo + (hi - lo) * np.sin(0.5 * np.pi * np.arange(n + 1) / n) ** 2
        cuts[-1] = hi
        kept = np.append(np.diff(cuts) > NARROW * after.width, True)
        kept[0] = True
        cuts = cuts[kept]
        out.append(np.stack((cuts[:-1], cuts[1:]), axis=1))
    return np.concatenate(out)


def _slip(edges: Array, before: State, after: Contact) -> tuple[Array, Array]:
    """For each cell the direction of q where it slips, 0 where it sticks; and q."""
    x = edges.mean(axis=1)
    loads = after.Q - before.contact.Q, after.tau - before.contact.tau
    carried = before.shear(x), after.limit(x)
    found = slip_of_cells(edges, carried, loads, _compliance(edges, after))
    if found is None:
        raise ContactError("stick and slip do not settle on a grid")
    return found


def slip_of_cells(
    edges: Array, carried: tuple[Array, Array], loads: tuple[float, float], A: Array
) -> tuple[Array, Array] | None:
    """For each cell the direction of q where it slips, 0 where it sticks; and q.

    Given are q before the step and f p after it, ΔQ and Δτ, and the compliance of the cells. None
    where the active set does not settle.
    """
    x, h = edges.mean(axis=1), np.diff(edges, axis=1)[:, 0]
    (q, bound), (dQ, dtau) = carried, loads
    at, seen, one = np.zeros(len(x)), set(), False
    for _ in range(MOST):
        sticks = at == 0.0
        moved = np.where(sticks, 0.0, at * bound - q)
        m = int(sticks.sum())
        if not m:
            return at, at * bound
        K = np.zeros((m + 1, m + 1))
        K[:m, :m], K[:m, m], K[m, :m] = A[np.ix_(sticks, sticks)], -1.0, h[sticks]
        right = np.append(-dtau * x[sticks] - A[sticks] @ moved, dQ - h @ moved)
        found = np.linalg.solve(K, right)
        moved[sticks] = found[:m]
        new = q + moved
        slip = found[m] - A @ moved - dtau * x
        over = np.where(sticks, np.abs(new) - bound * (1.0 + BEYOND), -1.0)
        back = np.where(sticks, -1.0, -at * slip - OPPOSING * np.abs(slip).max())
        out, into = over > 0.0, back > 0.0
        if not (out | into).any():
            return at, new
        key = at.tobytes()
        one = one or key in seen
        seen.add(key)
        if one:  # one at a time once a set repeats
            worst = int(np.maximum(over / bound.max(), back / np.abs(slip).max()).argmax())
            only = np.arange(len(x)) == worst
            out, into = out & only, into & only
        at = np.where(out, np.sign(new), np.where(into, 0.0, at))
    return None


def compliance(edges: Array, unit: float) -> Array:
    """A of cells on a half-plane; lengths in logarithms in a unit."""
    s = edges.T[:, None, :] - edges.mean(axis=1)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        primitive = np.where(s == 0.0, 0.0, s * np.log(np.abs(s) / unit)) - s
    A: Array = -(primitive[1] - primitive[0]) / np.pi
    return A


def _compliance(edges: Array, after: Contact) -> Array:
    """The same on what may repeat."""
    A, x, h = compliance(edges, after.width), edges.mean(axis=1), np.diff(edges, axis=1)[:, 0]
    if np.isfinite(after.period):
        step = x[:, None] - x
        ratio = np.where(step == 0.0, 1.0, Chord(after.period)(step) / np.where(step, step, 1.0))
        A = A - np.log(np.abs(ratio)) * h / np.pi
    return A
