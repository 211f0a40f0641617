"""The integrals over panels that a place is close to.

Of the same piece of H the difference quotient is exact. Of another piece k the pole at x is
integrated in closed form,

    ∫_panel (H_k(t) - H(x))/d(t, x) dν_i = Gauss' sum + (H_k(x) - H(x)) f(x) (J - Gauss' sum of J)
    J = ∫_panel dt/(W_k d(t, x)),          f = dν_i W_k/dt

as what (H_k(x) - H(x))/d(t, x) leaves in Gauss' rule is known.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .chord import Points
from .measure import NEAR, Measure

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class Targets(NamedTuple):
    """Blocks of places at which D_i is evaluated.

    i            (B,) the patch of each block
    group        (B,) ascending numbers; blocks of a group are neighbours that share i
    x            (B, n) places
    reference    (B, n) the value of H that is taken out: H_piece(x), or any value where piece < 0
    piece        (B, n) index of a piece, or -1
    owner        (B, n) the patch that x is on, or the nearer one: beyond the middle of a gap no
                 pole is taken out of the other's panels, whose f is not smooth up to there
    S            (B, n) S_i
    """

    i: Index
    group: Index
    x: Points
    reference: Any
    piece: Any
    owner: Any
    S: Any

    def flat(self, block: Index, place: Index) -> Targets:
        """Single places, as arrays (m,)."""
        x = Points(np.broadcast_to(self.x.anchor, self.x.offset.shape), self.x.offset)
        values = (self.x[block, place] if v is self.x else v[block, place] for v in self[3:])
        return Targets(self.i[block], self.group[block], x[block, place], *values)


def near(o: Measure, panel: Index, x: Points) -> NDArray[np.bool_]:
    """Whether places (m, n) are close to the panels (m,)."""
    k, P = o.panels, o.patches
    right = k.right[panel, None]
    inward = P.chord.difference(x.anchor - k.points.anchor[panel], x.offset)
    inward = np.where(right, -inward, inward)
    if not np.iscomplexobj(inward):
        lo, hi = o.beside
        return np.asarray((lo[panel, None] < inward) & (inward < hi[panel, None]))
    lo, hi = k.lo[panel, None], k.hi[panel, None]
    angle = 2.0 * np.arcsin(np.sqrt(inward / (2.0 * P.r[k.patch[panel], None])))
    # a square root may have either sign: the nearer image counts
    middle, reach = 0.5 * (lo + hi), NEAR * 0.5 * (hi - lo)
    return np.asarray(np.minimum(np.abs(angle - middle), np.abs(angle.conj() - middle)) < reach)


def integrals(o: Measure, panel: Index, nu: Array, t: Targets) -> Any:
    """∫_panel (H - reference)/d(t, x) dν_i of panels (m,) at places (m,); nu (m, n) is dν_i."""
    k = o.panels
    own = k.piece[panel]
    same = own == t.piece
    sums = np.empty(len(panel), dtype=np.result_type(t.x.offset, t.reference))
    sums[same] = _quotients(o, panel[same], nu[same], t.x[same])
    other = np.flatnonzero(~same)
    if not other.size:
        return sums
    q, x, ref = panel[other], t.x[other], t.reference[other]
    points = k.points[q]
    step = o.patches.chord.apart(
        points.anchor - x.anchor[:, None], points.offset - x.offset[:, None]
    )
    step = np.where(step == 0.0, np.inf, step)
    sums[other] = (nu[other] * ((o.H[q] - ref[:, None]) / step)).sum(axis=1)
    residue = o.pieces.value(own[other], x.anchor, x.offset) - o.H0 - ref
    lo, hi = o.pieces.ends[own[other]], o.pieces.ends[own[other] + 1]
    real = np.real(x.x)
    beyond = np.maximum(np.maximum(lo - real, real - hi), np.abs(np.imag(x.offset)))
    counts = (beyond <= o.pieces.reach[own[other]]) & (residue != 0.0)
    # not beside a repetition of the panel: of one patch per period both sides of a gap are it
    here = np.abs(x.anchor - points.anchor[:, 0]) <= 0.5 * o.patches.chord.period
    counts &= here & (k.patch[q] == t.owner[other])
    if counts.any():
        q, x, residue, at = q[counts], x[counts], residue[counts], other[counts]
        gauss = (o.weight[q] / step[counts]).sum(axis=1)
        pole = _pole(o, q, x)
        rounding = ~np.isfinite(pole) & (np.abs(residue) < 1e-12)
        pole = np.where(rounding, gauss, pole)
        sums[at] += residue * _f(o, q, x, t.i[at], t.S[at]) * (pole - gauss)
    return sums


def _quotients(o: Measure, panel: Index, nu: Array, x: Points) -> Any:
    """The same where H at the place is that of the panel's piece."""
    t = o.panels.points[panel]
    xs = x.anchor[:, None], x.offset[:, None]
    exact = o.pieces.divided(o.panels.piece[panel, None], (t.anchor, t.offset), xs)
    if o.patches.chord.periodic:
        plain = (t.anchor - xs[0]) + (t.offset - xs[1])
        step = o.patches.chord.apart(t.anchor - xs[0], t.offset - xs[1])
        zero = step == 0.0
        exact = exact * np.where(zero, 1.0, plain / np.where(zero, 1.0, step))
    return (nu * exact).sum(axis=1)


def _f(o: Measure, panel: Index, x: Points, i: Index, S: Any) -> Any:
    """dν_i/(dt/W_k) of the panel's patch k, continued to x."""
    P = o.patches
    patch = o.panels.patch[panel]
    f = 1.0 / S
    other = patch != i
    if not other.any():
        return f
    x, k, i, S = x[other], patch[other], i[other], S[other]
    d = P.chord.apart
    ratio = d(x.anchor - P.c[k], x.offset) / d(x.anchor - P.c[i], x.offset)
    own, theirs = (d(x.anchor - P.a[j], x.offset) * d(x.anchor - P.b[j], x.offset) for j in (i, k))
    if np.iscomplexobj(ratio):
        f[other] = np.sqrt(theirs / own / ratio**2) * ratio / S
    else:
        f[other] = np.sign(ratio) * np.sqrt(np.abs(theirs / own)) / S
    return f


def _pole(o: Measure, panel: Index, x: Points) -> Any:
    """∫_panel dt/(W_k(t) d(t, x)), a principal value on the panel."""
    P, k = o.patches, o.panels
    patch, right = k.patch[panel], k.right[panel]
    inward = P.chord.difference(x.anchor - k.points.anchor[panel, 0], x.offset)
    inward = np.where(right, -inward, inward)
    near, far = P.chord.apart(0.0, inward), P.chord.apart(2.0 * P.r[patch], -inward)
    t1, t2 = o.tau[0][panel], o.tau[1][panel]
    square = near / far
    size = np.where(right, -2.0, 2.0) / far
    with np.errstate(divide="ignore", invalid="ignore"):
        if np.iscomplexobj(square):
            tau = np.sqrt(square)
            return size * np.arctanh(tau * (t2 - t1) / (t1 * t2 - square)) / tau
        tau = np.sqrt(np.abs(square))
        outside = np.arctan2(tau * (t2 - t1), t1 * t2 + np.abs(square))
        u = tau * (t2 - t1) / (t1 * t2 - square)
        inside = np.arctanh(np.where(np.abs(u) > 1.0, 1.0 / u, u))
        value = np.where(square < 0.0, outside, inside) / tau
        return size * np.where(tau == 0.0, 1.0 / t1 - 1.0 / t2, value)
