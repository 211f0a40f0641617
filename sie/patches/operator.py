"""The one operator of contact in N patches, on the line and per period.

    W_i(x) = sqrt(d(x, a_i) d(b_i, x))
    S_i(x) = Π_{j≠i} sqrt(d(x, a_j) d(x, b_j)) / |d(x, c_j)|
    T_i(z) = sqrt(d(z, a_i) d(z, b_i)) S_i(z)
    dν_i = dt/|T_i|, on patch k with the sign of d(t, c_k)/d(t, c_i)

    D_i(x) = ∫_{patches} (H(t) - H(x))/d(t, x) dν_i
    p = (G/π) |T_i| D_i on patch i                g' = (1/π) T_i D_i in a gap

Everything is evaluated in blocks of places that share the patch i, all blocks at once. Nodes of
panels near a block are summed as they are, those close to a place in closed form (`measure`); far
panels act through the charges of a `tree`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.chord import Points
from sie.numerics.tree import Level, Tree, add, far_sums, parts, ranges

from .measure import Measure, Targets, close, integrals
from .panels import GapPanels, gap_panels

if TYPE_CHECKING:
    from sie.profiles.pieces import Pieces

    from .state import Findings, Given, State

Array = NDArray[np.float64]
Index = NDArray[np.int64]


BLOCK = 16  # places in a block
SHARED = 24  # panels, about, on which the blocks share their far sums


@dataclass(frozen=True, eq=False)
class Operator(Measure):
    """D_i at blocks of places.

    Y    the point charges of sharp edges (2N,), a_1, b_1, a_2 ..., in units of slope
    """

    Y: Array

    def D(self, t: Targets) -> Any:
        """D_i at targets, (B, n)."""
        t = t._replace(reference=t.reference - self.H0)
        groups = self.groups(t.i, t.x, t.group)
        extents, places = (groups.narrow, groups.wide), t.x.offset.size
        near = self.tree.separated(self.patches.chord, groups.i, *extents, places)
        block, pair = groups.blocks(near.group)
        total = self._near(t, block, near.row[pair])
        if near.far:
            far = far_sums(self.patches.chord, groups, near, t.x, self._charges_at, odd=True)
            total += far[..., 0] - t.reference * far[..., 1]
        return total

    @cached_property
    def tree(self) -> Tree:
        """Charges of Hω, ω, Hb, b; the point charges are sources of Hω and Hb."""
        k, d, Y = self.panels, self.patches.chord.apart, self._of_panels
        lever = d(k.points.anchor[:, 0] - self.patches.c[k.patch])
        edge = np.stack((Y, 0.0 * Y, Y * lever, 0.0 * Y))[..., None]
        nodes = np.stack((self.H * self.omega, self.omega, self.H * self.b, self.b))
        sources = Points(k.points.anchor, np.pad(k.points.offset, ((0, 0), (0, 1))))
        return Tree(self.ends, k.patch, sources, np.concatenate((nodes, edge), axis=2))

    @cached_property
    def _of_panels(self) -> Array:
        """The point charges of the edges at which panels begin, 0 on the others."""
        k = self.panels
        return np.asarray(np.where(k.lo == 0.0, self.Y[2 * k.patch + k.right], 0.0))

    def _pointed(self, i: Index, panel: Index) -> tuple[Index, Array, Array]:
        """Which of the panels have a point charge, Y_e ρ_i(e), ρ_i(e) = d(e, c_k)/d(e, c_i), e."""
        some = np.flatnonzero(self._of_panels[panel])
        q, c, d = panel[some], self.patches.c, self.patches.chord.apart
        e = self.panels.points.anchor[q, 0]
        Y = self._of_panels[q] * d(e - c[self.panels.patch[q]]) / d(e - c[i[some]])
        return some, Y, e

    @cached_property
    def gaps(self) -> GapPanels:
        """The panels beside the patches."""
        return gap_panels(self.patches, self.pieces)

    def measure(self, i: Index, panel: Index) -> Array:
        """dν_i on panels, (m, n)."""
        k, c = self.panels, self.patches.c
        own = k.patch[panel] == i
        t = k.points[panel]
        distance = self.patches.chord.apart(t.anchor - c[i, None], t.offset)
        distance[own] = 1.0
        return np.where(own[:, None], self.omega[panel], self.b[panel] / distance)

    def _near(self, t: Targets, block: Index, panel: Index) -> Any:
        """The sums over near panels, and in closed form what is close to a place."""
        k, chord = self.panels, self.patches.chord
        total = np.zeros(t.x.offset.shape, dtype=np.result_type(t.x.offset, t.reference))
        for some in parts(len(block), k.angle.shape[1] * total.shape[1]):
            row, q = block[some], panel[some]
            # only differences of H count: about a local value the sums of both lose nothing
            local = np.real(t.reference[row, :1])
            nu = self.measure(t.i[row], q)
            step = chord.beyond(self.centred[q], t.x[row])
            pair, place = np.nonzero(close(self, q, t.x[row]))
            step[pair, place] = np.inf
            kernel = np.reciprocal(step, out=step)
            sums = kernel @ np.stack((nu * (self.H[q] - local), nu), axis=2)
            value = sums[..., 0] - (t.reference[row] - local) * sums[..., 1]
            if pair.size:
                value[pair, place] += integrals(self, q[pair], nu[pair], t.flat(row[pair], place))
            charged, Y, e = self._pointed(t.i[row], q)
            x = t.x[row[charged]]
            value[charged] += Y[:, None] / chord.apart(e[:, None] - x.anchor, -x.offset)
            add(total, row, value)
        return total

    def _charges_at(self, level: Level, node: Index, i: Index, x: Points) -> Any:
        """Σ H dν_i/d(t, x) and Σ dν_i/d(t, x) of far nodes, (m, n, 2)."""
        q, charge = self._far_measure(level, node, i)
        kernel = 1.0 / self.patches.chord.beyond(q, x)
        return kernel @ charge

    def _far_measure(self, level: Level, node: Index, i: Index) -> tuple[Points, Array]:
        """Points of far nodes and their charges of H dν_i and dν_i, (m, CHARGES, 2)."""
        q, c = level.points(node), self.patches.c
        own = (level.first[node] == i) & (level.last[node] == i)
        distance = self.patches.chord.apart(q.anchor - c[i, None], q.offset)
        distance[own] = 1.0
        charge = np.where(own[:, None], level.charges[:2, node], level.charges[2:, node] / distance)
        return q, charge.transpose(1, 2, 0)

    def resultants(self, tilt: float) -> tuple[float, float]:
        """P and (on the line) M over E*/2, where the slope is H + tilt."""
        P, force = self.patches, self.b * (self.H + self.H0 + tilt)
        charges = P.chord.apart(P.edges - np.repeat(P.c, 2)) * self.Y
        moment = (force * self.panels.points.x).sum() + charges @ P.edges
        return float(force.sum() + charges.sum()), float(moment)

    @cached_property
    def gap_roots(self) -> tuple[Array, Array]:
        """T_i and S_i on the nodes of `gaps`, i the patch to the left."""
        k = self.gaps
        return self.root(np.maximum(k.gap, 0), k.points, k.gap)

    @cached_property
    def closures(self) -> tuple[Array, Array]:
        """∫ H cos dν_i and ∫ cos dν_i of all patches i, the first with the point charges."""
        P, N = self.patches, self.patches.number
        every = np.arange(N)
        x = Points(P.edges.reshape(N, 2), np.zeros((N, 2)))
        groups = self.groups(every, x, every)
        near = self.tree.separated(P.chord, every, groups.narrow, groups.wide, N)
        t, c = self.panels.points[near.row], P.c[near.group, None]
        nu = self.measure(near.group, near.row) * P.chord.cosine(t.anchor - c, t.offset)
        total = np.zeros((N, 2))
        sums = np.stack(((nu * self.H[near.row]).sum(axis=1), nu.sum(axis=1)), axis=1)
        charged, Y, e = self._pointed(near.group, near.row)
        sums[charged, 0] += Y * P.chord.cosine(e - P.c[near.group[charged]])
        add(total, near.group, sums)
        for level, node, group in near.far:
            q, charge = self._far_measure(level, node, group)
            cosine = P.chord.cosine(q.anchor - P.c[group, None], q.offset)
            add(total, group, (charge * cosine[..., None]).sum(axis=1))
        return total[:, 0], total[:, 1]


# -- D at points of the patches and in the gaps ----------------------------------------------------


def intensities(o: Operator, panel: Index, angle: Array) -> tuple[Array, Array]:
    """D at angles (m, n) on panels (m,), and where that is."""
    k, P = o.panels, o.patches
    inward = 2.0 * P.r[k.patch[panel], None] * np.sin(0.5 * angle) ** 2
    anchor, offset = k.points.anchor[panel], np.where(k.right[panel, None], -inward, inward)
    patch, piece = (np.repeat(v[panel], angle.shape[1]) for v in (k.patch, k.piece))
    x = Points(np.repeat(anchor[:, 0], angle.shape[1]), offset.ravel())
    return on_patches(o, patch, x, piece)[1].reshape(angle.shape), anchor + offset


def on_patches(o: Operator, i: Index, x: Points, piece: Index) -> tuple[Array, Array]:
    """|T_i| and D_i at points x (m,) on patches i and on these pieces of H."""
    at = blocks(i, x.x)
    i, x, piece = i[at[:, 0]], x[at], piece[at]
    starts = np.flatnonzero(np.diff(i, prepend=-1))
    count = np.diff(np.append(starts, len(i)))
    shared = -(-SHARED * len(i) // len(o.panels.lo))
    group = np.cumsum(ranges(np.zeros_like(count), count) % shared == 0)
    owner = np.broadcast_to(i[:, None], at.shape)
    T, S = o.root(i, x, group)
    reference = o.pieces.value(piece, x.anchor, x.offset)
    out = np.empty((2, int(at.max(initial=-1)) + 1))
    out[:, at] = np.abs(T), o.D(Targets(i, group, x, reference, piece, owner, S))
    return out[0], out[1]


def at_edges(o: Operator) -> Array:
    """D at all edges (2N,); a smooth edge is that of no other charge."""
    P, N = o.patches, o.patches.number
    piece = np.stack((o.pieces.locate(P.a), o.pieces.locate(P.b, "left")), axis=1)
    x, i = Points(P.edges.reshape(N, 2), np.zeros((N, 2))), np.arange(N)
    H, owner = o.pieces.value(piece, x.anchor, x.offset), np.broadcast_to(i[:, None], (N, 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(o.D(Targets(i, i, x, H, piece, owner, o.S[:, ::2]))).ravel()


def blocks(i: Index, x: Array) -> Index:
    """Places of the patches i (m,) as blocks (B, n) of neighbours; the last of a patch fills up."""
    order = np.lexsort((x, i))
    starts = np.flatnonzero(np.diff(i[order], prepend=-1))
    stops = np.append(starts[1:], len(i))
    count = -(-(stops - starts) // BLOCK)
    first = np.repeat(starts, count) + BLOCK * ranges(np.zeros_like(count), count)
    return order[
        np.minimum(first[:, None] + np.arange(BLOCK), np.repeat(stops, count)[:, None] - 1)
    ]


def gap_values(o: Operator, panels: GapPanels | None = None) -> tuple[Array, Array, Array]:
    """The reference value of H, T_i and D_i on the nodes of gap panels.

    i is the patch to the left; outside on the left the first one.
    """
    P, pieces = o.patches, o.pieces
    if panels is None:
        panels, (T, S) = o.gaps, o.gap_roots
    else:
        T, S = o.root(np.maximum(panels.gap, 0), panels.points, panels.gap)
    shape = panels.dx.shape
    at_edge = pieces.value(panels.piece, panels.points.anchor[:, 0], 0.0)
    continued = pieces.value(panels.piece[:, None], panels.points.anchor, panels.points.offset)
    reference = np.where(panels.follows[:, None], continued, at_edge[:, None])
    piece = np.where(panels.follows, panels.piece, -1)[:, None]
    nearer = ((panels.gap + panels.right) % P.number)[:, None]
    targets = Targets(
        np.maximum(panels.gap, 0),
        panels.gap,
        panels.points,
        reference,
        np.broadcast_to(piece, shape),
        np.broadcast_to(nearer, shape),
        S,
    )
    return reference, T, np.asarray(o.D(targets))


@dataclass(frozen=True, eq=False)
class Found:
    """An answer: a state that its findings certify, for what was given."""

    state: State
    operator: Operator
    given: Given
    findings: Findings
    steps: int


def operator_of(state: State, pieces: Pieces) -> Operator:
    """The operator of a state, with the charges of its sharp edges."""
    return Operator(state.patches, pieces, np.where(state.sharp, state.charge, 0.0))
