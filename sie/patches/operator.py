"""The one operator of contact in N patches, on the line and per period.

    W_i(x) = sqrt(d(x, a_i) d(b_i, x))
    S_i(x) = Π_{j≠i} sqrt(d(x, a_j) d(x, b_j)) / |d(x, c_j)|
    T_i(z) = sqrt(d(z, a_i) d(z, b_i)) S_i(z)
    dν_i = dt/|T_i|, on patch k with the sign of d(t, c_k)/d(t, c_i)

    D_i(x) = ∫_{patches} (H(t) - H(x))/d(t, x) dν_i
    p = (G/π) |T_i| D_i on patch i                g' = (1/π) T_i D_i in a gap

Everything is evaluated in blocks of places that share the patch i, all blocks at once. Nodes of
panels near a block are summed as they are, what is near a place in `close`; far panels act through
the charges of a `tree`, and so do far patches on ln S_i.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import close
from .chord import Points
from .close import Targets
from .measure import Groups, Measure, add, edge_ratio, far_sums, parts, steps
from .tree import Level, Separation

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Operator(Measure):
    """D_i at blocks of places."""

    def D(self, t: Targets) -> Any:
        """D_i at targets, (B, n)."""
        t = t._replace(reference=t.reference - self.H0)
        groups = self.groups(t.i, t.x, t.group)
        near = self.tree.separated(self.patches.chord, groups.i, groups.narrow, groups.wide)
        total = self._near(t, *self._blocks(groups, near))
        if near.far:
            far = far_sums(self.patches, groups, near, t.x, self._charges_at)
            total += far[..., 0] - t.reference * far[..., 1]
        return total - self._charged(t)

    def _blocks(self, groups: Groups, near: Separation) -> tuple[Index, Index]:
        block, pair = groups.blocks(near.group)
        return block, near.row[pair]

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
            step = steps(chord, k.points[q], t.x[row])
            pair, place = np.nonzero(close.near(self, q, t.x[row]))
            step[pair, place] = np.inf
            kernel = np.reciprocal(step, out=step)
            sums = kernel @ np.stack((nu * (self.H[q] - local), nu), axis=2)
            value = sums[..., 0] - (t.reference[row] - local) * sums[..., 1]
            if pair.size:
                value[pair, place] += close.integrals(
                    self, q[pair], nu[pair], t.flat(row[pair], place)
                )
            add(total, row, value)
        return total

    def _charges_at(self, level: Level, node: Index, i: Index, x: Points) -> Any:
        """Σ H dν_i/d(t, x) and Σ dν_i/d(t, x) of far nodes, (m, n, 2)."""
        q, charge = self._far_measure(level, node, i)
        kernel = 1.0 / steps(self.patches.chord, q, x)
        return kernel @ charge

    def _far_measure(self, level: Level, node: Index, i: Index) -> tuple[Points, Array]:
        """Points of far nodes and their charges of H dν_i and dν_i, (m, CHARGES, 2)."""
        q, c = level.points(node), self.patches.c
        own = (level.first[node] == i) & (level.last[node] == i)
        distance = self.patches.chord.apart(q.anchor - c[i, None], q.offset)
        distance[own] = 1.0
        charge = np.where(own[:, None], level.charges[:2, node], level.charges[2:, node] / distance)
        return q, charge.transpose(1, 2, 0)

    def closures(self) -> tuple[Array, Array]:
        """∫ H cos dν_i and ∫ cos dν_i of all patches i, without point charges."""
        P, N = self.patches, self.patches.number
        every = np.arange(N)
        x = Points(P.edges.reshape(N, 2), np.zeros((N, 2)))
        groups = self.groups(every, x, every)
        near = self.tree.separated(P.chord, every, groups.narrow, groups.wide)
        t, c = self.panels.points[near.row], P.c[near.group, None]
        nu = self.measure(near.group, near.row) * P.chord.cosine(t.anchor - c, t.offset)
        total = np.zeros((N, 2))
        sums = np.stack(((nu * self.H[near.row]).sum(axis=1), nu.sum(axis=1)), axis=1)
        add(total, near.group, sums)
        for level, node, group in near.far:
            q, charge = self._far_measure(level, node, group)
            cosine = P.chord.cosine(q.anchor - P.c[group, None], q.offset)
            add(total, group, (charge * cosine[..., None]).sum(axis=1))
        return total[:, 0], total[:, 1]

    def _charged(self, t: Targets) -> Any:
        """Σ Y_e ρ_i(e)/d(x, e)."""
        P = self.patches
        sharp = np.flatnonzero(self.Y)
        if not sharp.size:
            return 0.0
        charge = (self.Y * edge_ratio(P, t.i))[:, sharp]
        x = t.x
        step = P.chord.apart(x.anchor[..., None] - P.edges[sharp], x.offset[..., None])
        return ((1.0 / step) @ charge[..., None])[..., 0]
