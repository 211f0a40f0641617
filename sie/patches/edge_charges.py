"""The point charges at the edges of N patches that change their conditions by given amounts.

When an edge e of patch k moves by δ, F changes by (G/2π) D_k(e) T_k(z)/d(z, e) δ: a point charge at
e. With u_e = d(e, c_k) D_k(e) δ/2, and a change θ of the tilt, the conditions of `newton` change by

    C_j by Σ u_e κ(e - c_j) + θ ∫ cos dν_j         K_i by -(1/π) ∫_{gap i} Ψ (V - V(c_i)) dx
    P by Σ u_e + θ ∫ dβ                            M by Σ u_e e + θ ∫ t dβ

with the sum κ of 1/z over all periods, the field V(z) = Σ u_e κ(z - e), Ψ(z) = T_i(z)/d(z, c_i),
which is the same for all i, and dβ = d(t, c_i) dν_i. The field V has poles at the edges, where Ψ²
is zero, and Ψ² has poles at the centres. So by Liouville's theorem

    Ψ² V = W,    W(z) = Σ_k w_k κ(z - c_k) + v_k/d(z, c_k)²,    v_k = -d(r_k, 0)² S_k(c_k)² V(c_k)

The C give the V(c_k), and the K and P the N unknown w_k,

    Σ_k ∫_{gap i} (w_k κ(x - c_k) + v_k/d(x, c_k)²)/Ψ dx = V(c_i) ∫_{gap i} Ψ dx - π K_i
    Σ w_k = P            Σ w_k c_k + Σ v_k = M

and the charges are the residues of W/Ψ². The equations stay well conditioned where gaps close.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.numerics.tree import CHARGES, FAR, FEWEST, POINTS, add, gathered, parts, ranges

from .panels import GapPanels, Patches

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class EdgeCharges:
    """The charges at the edges of patches, for given changes of the conditions.

    patches     the N patches
    gaps        the panels in the gaps
    roots       T_i on their nodes, i the patch to the left
    S           S_i at a, c and b of each patch, (N, 3)
    plain       what a tilt of 1 adds to the C, (N,)
    force       what it adds to P
    moment      what it adds to M; None where the tilt is given, and not the moment
    """

    patches: Patches
    gaps: GapPanels
    roots: Array
    S: Array
    plain: Array
    force: float
    moment: float | None

    def of(self, changes: Array) -> Array:
        """Charges y = D_k(e) δ/2 at the edges and the change of the tilt, (2N + 1, m).

        They change C, K, P and M, or the tilt where that is given, by columns (2N + 1, m).
        """
        P, N = self.patches, self.patches.number
        # the last column: what a tilt of 1 asks for
        V = np.column_stack((-changes[:N], self.plain))
        K, load = (np.column_stack((v, 0.0 * v[:, :1])) for v in (changes[N:-2], changes[-2:-1]))
        load[0, -1] = -self.force
        v = -(P.chord.apart(P.r) ** 2 * self.S[:, 1] ** 2)[:, None] * V
        w = self._simple(K, load, V, v)
        tilt = changes[-1]
        if self.moment is not None:
            moment = P.c @ w + v.sum(axis=0)
            tilt = (tilt - moment[:-1]) / (moment[-1] + self.moment)
        w, v = (s[:, :-1] + s[:, -1:] * tilt for s in (w, v))
        return np.vstack((self._residues(w, v), tilt))

    @cached_property
    def _gaps(self) -> tuple[Array, Array, Array]:
        """∫ κ(x - c_k)/Ψ dx and ∫ 1/(Ψ d(x, c_k)²) dx over gaps i, (N - 1, N), and ∫ Ψ dx."""
        P, k = self.patches, self.gaps
        psi = self.roots / P.chord.apart(k.points.anchor - P.c[k.gap, None], k.points.offset)
        simple, double = across_gaps(P, k, k.dx / psi)
        whole = np.bincount(k.gap, (psi * k.dx).sum(axis=1), P.number - 1)
        return simple, double, np.asarray(whole, dtype=float)

    def _simple(self, K: Array, load: Array, V: Array, v: Array) -> Array:
        """The charges w (N, m) at the centres."""
        if len(V) == 1:
            return load
        simple, double, psi = self._gaps
        matrix = np.vstack((simple, np.ones(len(V))))
        right = np.vstack((V[:-1] * psi[:, None] - np.pi * K - double @ v, load))
        size = np.abs(matrix).max(axis=1, keepdims=True)
        return np.asarray(np.linalg.solve(matrix / size, right / size))

    def _residues(self, w: Array, v: Array) -> Array:
        """Those of W/Ψ² at the edges e over d(e, c_k), (2N, m)."""
        P, chord = self.patches, self.patches.chord
        k = np.repeat(np.arange(P.number), 2)
        r, whole = chord.apart(P.r)[k, None], P.whole[k, None]
        out = np.tile([-1.0, 1.0], P.number)[:, None] * w[k] / (2.0 * r) + v[k] / (r * whole)
        for some in parts(2 * P.number, P.number):
            simple, double = chord.poles(chord.difference(P.edges[some, None] - P.c))
            own = np.arange(len(simple)), k[some]
            simple[own] = double[own] = 0.0
            out[some] += r[some] / whole[some] * (simple @ w + double @ v)
        return np.asarray(out / self.S[:, ::2].reshape(-1, 1) ** 2)


def across_gaps(P: Patches, k: GapPanels, weight: Array) -> Array:
    """The integrals over all gaps of poles at the centres of all patches, (2, N - 1, N).

        A_ik = Σ_{x in gap i} w(x) κ(x - c_k),    B_ik = Σ_{x in gap i} w(x)/d(x, c_k)²

    for weights w on the nodes of the gaps, which charges stand for where a centre is far.
    """
    half, gaps = 0.5 * P.gaps[: P.number - 1], np.arange(P.number - 1)
    middle = P.b[: P.number - 1] + half
    out = np.zeros((2, P.number - 1, P.number))
    apart = P.chord.difference(middle[:, None] - P.c)
    near = np.abs(apart) < FAR * half[:, None] if P.number >= FEWEST else np.ones_like(apart, bool)
    if not near.all():
        charges, (anchor, offset) = (
            np.zeros((len(gaps), CHARGES)),
            (k.points.anchor, k.points.offset),
        )
        u = ((anchor - middle[k.gap, None]) + offset) / half[k.gap, None]
        add(charges, k.gap, gathered(u, weight[None])[0])
        for some in parts(len(gaps), CHARGES * P.number):
            step = apart[some, :, None] + half[some, None, None] * POINTS
            for sums, kernel in zip(out, P.chord.poles(step), strict=True):
                sums[some] = (kernel @ charges[some, :, None])[..., 0]
    gap, centre = np.nonzero(near)
    first, last = (np.searchsorted(k.gap, gap, side) for side in ("left", "right"))
    pair = np.repeat(np.arange(len(gap)), last - first)
    panel, c = ranges(first, last - first), P.c[centre[pair], None]
    step = P.chord.difference(k.points.anchor[panel] - c, k.points.offset[panel])
    for sums, kernel in zip(out, P.chord.poles(step), strict=True):
        sums[gap, centre] = np.bincount(pair, (kernel * weight[panel]).sum(axis=1), len(gap))
    return out
