"""The measure dν_i on the patches and the root T_i, at blocks of places that share the patch i.

    W_i(x) = sqrt(d(x, a_i) d(b_i, x))
    S_i(x) = Π_{j≠i} sqrt(d(x, a_j) d(x, b_j)) / |d(x, c_j)|
    T_i(z) = sqrt(d(z, a_i) d(z, b_i)) S_i(z)
    dν_i = dt/|T_i|, on patch k with the sign of d(t, c_k)/d(t, c_i)

Far patches act on ln S_i through the charges of a tree. Over a panel that a place is close to, the
difference quotient of the same piece of H is exact, and of another piece k the pole at x is
integrated in closed form,

    ∫_panel (H_k(t) - H(x))/d(t, x) dν_i = Gauss' sum + (H_k(x) - H(x)) f(x) (J - Gauss' sum of J)
    J = ∫_panel dt/(W_k d(t, x)),          f = dν_i W_k/dt

as what (H_k(x) - H(x))/d(t, x) leaves in Gauss' rule is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Points
from sie.numerics.tree import Groups, Level, Tree, far_sums, multiply, parts

from .panels import Patches, PatchPanels, patch_panels

if TYPE_CHECKING:
    from sie.profiles.pieces import Pieces

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]

# half-lengths of a panel, in its angle, from its middle: Gauss' rule resolves poles beyond
NEAR = 2.5
LIFTED = 1e3


@dataclass(frozen=True, eq=False)
class Measure:
    """The slope H on patches, and what the integrals over them have in common."""

    patches: Patches
    pieces: Pieces

    # -- the root ----------------------------------------------------------------------------------

    @cached_property
    def _tree_of_roots(self) -> Tree:
        """Charges of ln S at a, c and b of each patch."""
        P = self.patches
        sources = Points(np.stack((P.a, P.c, P.b), axis=1), np.zeros((P.number, 3)))
        charges = np.tile([0.5, -1.0, 0.5], (1, P.number, 1))
        return Tree((P.a, P.b), np.arange(P.number), sources, charges)

    def root(self, i: Index, x: Points, group: Index | None = None) -> tuple[Any, Any]:
        """(T_i, S_i) at blocks of points (B, n), or at points (m,); on patch i itself |T_i|."""
        P, d = self.patches, self.patches.chord.apart
        if x.offset.ndim == 1:
            T, S = self.root(i, Points(x.anchor[:, None], x.offset[:, None]))
            return T[:, 0], S[:, 0]
        S = self.others(i, x, group)
        j = i[:, None]
        left, right = d(x.anchor - P.a[j], x.offset), d(x.anchor - P.b[j], x.offset)
        if np.iscomplexobj(S):
            middle = d(x.anchor - P.c[j], x.offset)
            return middle * np.sqrt(left / middle) * np.sqrt(right / middle) * S, S
        T = np.sqrt(np.abs(left * right)) * S
        return np.where((left < 0.0) & (right < 0.0), -T, T), S

    def others(self, i: Index, x: Points, group: Index | None = None) -> Any:
        """S_i at blocks of points; S_i > 0 off the other patches."""
        N = self.patches.number
        out = np.ones(x.offset.shape, dtype=x.offset.dtype)
        if N == 1:
            return out
        groups = self.groups(i, x, np.arange(len(i)) if group is None else group)
        chord, extent = self.patches.chord, groups.wide
        near = self._tree_of_roots.separated(chord, groups.i, extent, extent, x.offset.size)
        out *= np.exp(far_sums(chord, groups, near, x, self._logarithms)[..., 0])
        block, pair = groups.blocks(near.group)
        offset = chord.both(0.0, x.offset)
        for some in parts(len(block), out.shape[1]):
            j, at = near.row[pair[some]], block[some]
            multiply(out, at, self._factor(j, j == i[at], x.anchor[at], [v[at] for v in offset]))
        return out

    @cached_property
    def S(self) -> Array:
        """S_i at a, c and b of each patch i, (N, 3)."""
        P, every = self.patches, np.arange(self.patches.number)
        x = Points(np.stack((P.a, P.c, P.b), axis=1), np.zeros((P.number, 3)))
        return np.asarray(self.others(every, x, every))

    def _logarithms(self, level: Level, node: Index, i: Index, x: Points) -> Any:
        """ln S of far nodes at places, (m, n, 1)."""
        q = level.points(node)
        step = self.patches.chord.beyond(q, x)
        if np.iscomplexobj(step):  # the charges add to zero: any branch that no point crosses
            step *= np.where(step[..., :1].real < 0.0, -1.0, 1.0)
        else:
            np.abs(step, out=step)
        return np.log(step, out=step) @ level.charges[0, node, :, None]

    def _factor(self, j: Index, own: Mask, anchor: Array, offset: list[Any]) -> Any:
        """What patches j contribute to S at blocks, 1 where that is the block's own patch."""
        P, chord = self.patches, self.patches.chord
        steps = (chord.both(anchor - v[j, None]) for v in (P.a, P.b, P.c))
        left, right, middle = (d * offset[1] + cosine * offset[0] for d, cosine in steps)
        middle[own] = 1.0
        ratio = (left / middle) * (right / middle)
        ratio[own] = 1.0
        return np.sqrt(ratio if np.iscomplexobj(ratio) else np.abs(ratio))

    # -- the measure on the patches ----------------------------------------------------------------

    @cached_property
    def panels(self) -> PatchPanels:
        return patch_panels(self.patches, self.pieces)

    @cached_property
    def centred(self) -> Points:
        """The nodes, counted from the middle of each panel."""
        t = self.panels.points
        middle = t.anchor + t.offset.mean(axis=1, keepdims=True)
        return Points(middle, (t.anchor - middle) + t.offset)

    @cached_property
    def weight(self) -> Array:
        """dt/W on each node, (p, n): the angle on the line."""
        k, P = self.panels, self.patches
        if not P.chord.periodic:
            return k.angle
        inward = np.abs(k.points.offset)
        outward = 2.0 * P.r[k.patch, None] - inward
        d = P.chord.apart
        return k.angle * np.sqrt(
            (inward / d(0.0, inward)) * (outward / d(2.0 * P.r[k.patch, None], -inward))
        )

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """The interval of each panel."""
        k, r = self.panels, self.patches.r[self.panels.patch]
        near, far = (
            k.points.anchor[:, 0] + np.where(k.right, -2.0, 2.0) * r * np.sin(0.5 * angle) ** 2
            for angle in (k.lo, k.hi)
        )
        return np.minimum(near, far), np.maximum(near, far)

    @cached_property
    def omega(self) -> Array:
        """dν_k on the nodes of patch k itself, (p, n)."""
        k = self.panels
        return np.asarray(self.weight / self.others(k.patch, k.points, k.patch))

    @cached_property
    def b(self) -> Array:
        """d(t, c_k) dν_k on the nodes, (p, n): dν_i is b/d(t, c_i) for every i."""
        k, P = self.panels, self.patches
        return self.omega * P.chord.apart(k.points.anchor - P.c[k.patch, None], k.points.offset)

    @cached_property
    def H(self) -> Array:
        """H on the nodes, less `H0`."""
        k = self.panels
        return self.pieces.value(k.piece[:, None], k.points.anchor, k.points.offset) - self.H0

    @cached_property
    def H0(self) -> float:
        """A value of H, taken out of all sums: only differences count."""
        k = self.panels
        return float(
            np.mean(self.pieces.value(k.piece, k.points.anchor[:, 0], k.points.offset[:, 0]))
        )

    @cached_property
    def bounds(self) -> tuple[tuple[Array, Array, Array], ...]:
        """The ends of the panels: distances from the edge, d(other edge, t), τ.

        τ = sqrt(d(t, edge)/d(other edge, t)).
        """
        k, P = self.panels, self.patches
        d = P.chord.apart
        ends = []
        for angle in (k.lo, k.hi):
            s = 2.0 * P.r[k.patch] * np.sin(0.5 * angle) ** 2
            far = d(2.0 * P.r[k.patch], -s)
            ends.append((s, far, np.sqrt(d(0.0, s) / far)))
        return tuple(ends)

    @cached_property
    def beside(self) -> tuple[Array, Array]:
        """The places close to each panel on the line, counted inwards from its edge.

        They are angles of NEAR half-lengths from its middle, imaginary ones beside the patch.
        """
        k = self.panels
        middle, reach = 0.5 * (k.lo + k.hi), NEAR * 0.5 * (k.hi - k.lo)
        inner = np.sin(0.5 * np.maximum(middle - reach, 0.0)) ** 2
        beside = np.sinh(0.5 * np.sqrt(np.maximum(reach**2 - middle**2, 0.0))) ** 2
        size = 2.0 * self.patches.r[k.patch]
        lo = np.where(reach > middle, -size * beside, size * inner)
        return lo, size * np.sin(0.5 * np.minimum(middle + reach, np.pi)) ** 2

    def follows(self, k: Index, x: Points) -> Mask:
        """Whether the pieces k may be continued to places x.

        Off the line so far that the terms of a series grow LIFTED times: a pole that is left in a
        sum over a long panel costs more.
        """
        pieces, real, imag = self.pieces, np.real(x.x), np.abs(np.imag(x.offset))
        lo, hi = pieces.breaks[k], pieces.breaks[k + 1]
        beyond = np.maximum(np.maximum(lo - real, real - hi), imag)
        near = beyond <= pieces.reach[k]
        if not np.iscomplexobj(x.offset) or not pieces.series.shape[1]:
            return np.asarray(near)
        s = 2.0 * ((x.anchor - 0.5 * (lo + hi)) + x.offset) / (hi - lo)
        rho = np.abs(s + np.sqrt(s - 1.0) * np.sqrt(s + 1.0))
        return np.asarray(near | (rho <= self._lifted[k]))

    @cached_property
    def _lifted(self) -> Array:
        """The Bernstein radius of `follows` of each piece; 0 of those that are no series."""
        series = self.pieces.series[:, 1:].any(axis=1) & ~self.pieces.void
        return np.where(series, chebyshev.reach(self.pieces.series, LIFTED), 0.0)

    def groups(self, i: Index, x: Points, group: Index) -> Groups:
        """The groups of blocks that follow each other, and the intervals that they are in."""
        P = self.patches
        place = np.real(x.x)
        if P.chord.periodic:
            c = P.c[i, None]
            place = P.chord.difference(np.real(x.anchor) - c, np.real(x.offset)) + c
        first = np.flatnonzero(np.diff(group, prepend=-2))
        lo = np.minimum.reduceat(place.min(axis=1), first)
        hi = np.maximum.reduceat(place.max(axis=1), first)
        c = P.c[i[first]]  # b/d(t, c_i) of other patches has a pole there
        wide = np.minimum(lo, c), np.maximum(hi, c)
        return Groups(np.append(first, len(i)), i[first], c, (lo, hi), wide)


def edge_ratio(patches: Patches, i: Any) -> Array:
    """ρ_i(e) = d(e, c_k)/d(e, c_i) of all edges e, those of patch k: (2N,), or (i, 2N)."""
    d, c = patches.chord.apart, patches.c
    k = np.repeat(np.arange(patches.number), 2)
    own = d(patches.edges - c[k])
    rho = own / d(patches.edges - np.asarray(c[i])[..., None])
    return np.asarray(np.where(k == np.asarray(i)[..., None], 1.0, rho))


# -- integrals over panels that a place is close to ------------------------------------------------


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


def _inward(o: Measure, panel: Index, x: Points) -> Any:
    """Places (m, n) as they are counted inwards from the edge of panels (m,).

    They are taken in the period in which they are nearer to the panel.
    """
    k, chord = o.panels, o.patches.chord
    step = x.anchor - k.points.anchor[panel]
    if chord.periodic:  # a patch may be longer than half a period
        middle = k.points.offset[panel, k.points.offset.shape[1] // 2, None]
        step = step - chord.period * np.rint((step + np.real(x.offset) - middle) / chord.period)
    inward = step + x.offset
    return np.where(k.right[panel, None], -inward, inward)


def close(o: Measure, panel: Index, x: Points) -> Mask:
    """Whether places (m, n) are close to the panels (m,)."""
    k, P = o.panels, o.patches
    inward = _inward(o, panel, x)
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
    counts = o.follows(own[other], x) & (residue != 0.0)
    # not beside a repetition of the panel: of one patch per period both sides of a gap are it
    middle = points.x[:, points.offset.shape[1] // 2]
    here = np.abs(np.real(x.x) - middle) <= 0.5 * o.patches.chord.period
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
    """∫_panel dt/(W_k(t) d(t, x)), a principal value on the panel.

    By the addition theorem τ² - τ_x² = d(b, a) d(t, x)/(d(b, t) d(b, x)), which keeps its digits on
    a patch that nearly fills its period, where all τ are about 1.
    """
    P, k = o.patches, o.panels
    patch, right = k.patch[panel], k.right[panel]
    inward = _inward(o, panel, x[:, None])[:, 0]
    d = P.chord.apart
    near, far = d(0.0, inward), d(2.0 * P.r[patch], -inward)
    (s1, far1, t1), (s2, far2, t2) = ([v[panel] for v in end] for end in o.bounds)
    square = near / far
    size = np.where(right, -2.0, 2.0) / far
    whole = P.whole[patch]
    rise = whole * d(0.0, s2 - s1) / (far1 * far2 * (t1 + t2))  # τ_2 - τ_1
    away = whole * d(0.0, s1 - inward) / (far1 * far) + t1 * rise  # τ_1 τ_2 - τ_x²
    with np.errstate(divide="ignore", invalid="ignore"):
        if np.iscomplexobj(square):
            tau = np.sqrt(square)
            return size * np.arctanh(tau * rise / away) / tau
        tau = np.sqrt(np.abs(square))
        outside = np.arctan2(tau * rise, t1 * t2 + np.abs(square))
        u = tau * rise / away
        inside = np.arctanh(np.where(np.abs(u) > 1.0, 1.0 / u, u))
        value = np.where(square < 0.0, outside, inside) / tau
        return size * np.where(tau == 0.0, 1.0 / t1 - 1.0 / t2, value)
