"""The one operator of contact in N patches, on the line and per period.

    W_i(x) = sqrt(d(x, a_i) d(b_i, x))
    S_i(x) = Π_{j≠i} sqrt(d(x, a_j) d(x, b_j)) / |d(x, c_j)|
    T_i(z) = sqrt(d(z, a_i) d(z, b_i)) S_i(z)
    dν_i = dt/|T_i|, on patch k with the sign of d(t, c_k)/d(t, c_i)

    D_i(x) = ∫_{patches} (H(t) - H(x))/d(t, x) dν_i
    p = (G/π) |T_i| D_i on patch i                g' = (1/π) T_i D_i in a gap

Beside patch i its own nodes are summed as they are. Where x is near a panel the difference quotient
of the same piece of H is taken exactly, and of another piece k the pole at x is integrated in
closed form: what (H_k(x) - H(x))/d(t, x) leaves in Gauss' rule is known. Cells of panels that are
far from x act through a few charges on their Chebyshev points (Dutt, Gu & Rokhlin 1996).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .chord import Points
from .panels import GapPanels, Patches, PatchPanels, gap_panels, patch_panels
from .pieces import Pieces

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# half-lengths of a panel, in its angle, from its middle: Gauss' rule sees no pole beyond
NEAR = 2.5
FAR = 3.0  # half-lengths of a cell from its middle: its charges serve from here on
CHARGES = 20  # of a cell: (FAR + sqrt(FAR² - 1))**-CHARGES is rounding
CELL = 64  # nodes in a cell, about
CHUNK = 1 << 18  # entries of an array that are computed at once


class Cells(NamedTuple):
    """Runs of panels of one patch: first panel and end, middles and half-lengths, and charges of ω,
    ωH, b, bH on Chebyshev points.
    """

    start: Index
    stop: Index
    patch: Index
    middle: Array
    half: Array
    points: Array  # (cells, CHARGES), offsets from the middle
    charges: Array  # (4, cells, CHARGES)


class Targets(NamedTuple):
    """The places at which D_i is evaluated, all (m,).

    x            places
    reference    the value of H that is taken out: H_piece(x), or any value where piece < 0
    piece        index of a piece, or -1
    S            S_i
    owner        the patch that x is on, or the nearer one: beyond the middle of a gap no pole is
                 taken out of the other's panels, whose f is not smooth up to there
    """

    x: Points
    reference: Any
    piece: Any
    S: Any
    owner: Any

    def part(self, some: Any) -> Targets:
        return Targets(self.x[some], *(v[some] for v in self[1:]))


@dataclass(frozen=True, eq=False)
class Operator:
    """The slope H on patches; `charge` (2N,) are the point charges of sharp edges, a_1, b_1, a_2
    ..., in units of slope.
    """

    patches: Patches
    pieces: Pieces
    charge: Array = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def Y(self) -> Array:
        return self.charge if self.charge.size else np.zeros(2 * self.patches.number)

    @cached_property
    def panels(self) -> PatchPanels:
        return patch_panels(self.patches, self.pieces)

    @cached_property
    def gaps(self) -> GapPanels:
        return gap_panels(self.patches, self.pieces)

    # -- the root ----------------------------------------------------------------------------------

    def others(self, i: Index, x: Points) -> Any:
        """S_i at points (flat arrays), one patch i for each; S_i > 0 off the other patches."""
        P, d = self.patches, self.patches.chord.apart
        out = np.ones(x.offset.shape, dtype=x.offset.dtype)
        N = P.number
        if N == 1:
            return out
        for some in _parts(len(out), N):
            anchor, offset = x.anchor[some, None], x.offset[some, None]
            middle = d(anchor - P.c, offset)
            middle[np.arange(len(middle)), i[some]] = 1.0
            ratio = (d(anchor - P.a, offset) / middle) * (d(anchor - P.b, offset) / middle)
            ratio[np.arange(len(ratio)), i[some]] = 1.0
            if np.iscomplexobj(ratio):
                out[some] = np.sqrt(ratio).prod(axis=1)
            else:
                out[some] = np.sqrt(np.abs(ratio)).prod(axis=1)
        return out

    def root(self, i: Index, x: Points) -> tuple[Any, Any]:
        """(T_i, S_i) at points; on the line of patch i itself |T_i|."""
        P, d = self.patches, self.patches.chord.apart
        S = self.others(i, x)
        left, right = d(x.anchor - P.a[i], x.offset), d(x.anchor - P.b[i], x.offset)
        if np.iscomplexobj(S):
            middle = d(x.anchor - P.c[i], x.offset)
            return middle * np.sqrt((left / middle) * (right / middle)) * S, S
        T = np.sqrt(np.abs(left * right)) * S
        return np.where((left < 0.0) & (right < 0.0), -T, T), S

    # -- the measure on the patches ----------------------------------------------------------------

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
    def omega(self) -> Array:
        """dν_k on the nodes of patch k itself, (p, n)."""
        k = self.panels
        points = Points(
            np.broadcast_to(k.points.anchor, k.points.offset.shape).ravel(), k.points.offset.ravel()
        )
        owner = np.repeat(k.patch, k.angle.shape[1])
        return self.weight / self.others(owner, points).reshape(k.angle.shape)

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
    def tau(self) -> tuple[Array, Array]:
        """sqrt(d(t, edge)/d(other edge, t)) at both ends of each panel."""
        k, P = self.panels, self.patches
        d = P.chord.apart
        ends = []
        for angle in (k.lo, k.hi):
            s = 2.0 * P.r[k.patch] * np.sin(0.5 * angle) ** 2
            ends.append(np.sqrt(d(0.0, s) / d(2.0 * P.r[k.patch], -s)))
        return ends[0], ends[1]

    @cached_property
    def cells(self) -> Cells:
        k, n = self.panels, self.panels.angle.shape[1]
        many = max(CELL // n, 1)
        count = np.bincount(k.patch, minlength=self.patches.number)
        first = np.cumsum(count) - count
        starts = np.concatenate(
            [np.arange(f, f + c, many) for f, c in zip(first, count, strict=True)]
        )
        # the panels of a patch: those from a ascend, those from b descend; cells do not mix them
        turn = np.flatnonzero(np.diff(k.right.astype(int)) != 0) + 1
        starts = np.union1d(starts, turn)
        stops = np.append(starts[1:], len(k.patch))
        x = k.points.x
        lo, hi = (
            np.minimum.reduceat(x.min(axis=1), starts),
            np.maximum.reduceat(x.max(axis=1), starts),
        )
        middle, half = 0.5 * (lo + hi), np.maximum(0.5 * (hi - lo), np.spacing(np.abs(hi)))
        cell = np.repeat(np.arange(len(starts)), stops - starts)
        u = ((k.points.anchor - middle[cell, None]) + k.points.offset) / half[cell, None]
        sources = (self.omega, self.omega * self.H, self.b, self.b * self.H)
        moments = np.empty((4, len(starts), CHARGES))
        before, now = np.ones_like(u), u
        for order in range(CHARGES):
            T = before if order == 0 else now
            for j, q in enumerate(sources):
                moments[j, :, order] = np.add.reduceat((q * T).sum(axis=1), starts)
            if order:
                before, now = now, 2.0 * u * now - before
        points = half[:, None] * chebyshev.points(CHARGES)
        return Cells(starts, stops, k.patch[starts], middle, half, points, moments @ SPREAD)

    # -- sums for one group of targets -------------------------------------------------------------

    def group(self, i: int, lo: float, hi: float) -> Group:
        """What sums at targets between lo and hi need that use T_i: which cells act through
        charges, which panels node by node.
        """
        P, cells = self.patches, self.cells
        wide = (
            min(lo, float(P.c[i])),
            max(hi, float(P.c[i])),
        )  # b/d(t, c_i) of other patches has a pole at c_i
        far = np.where(
            cells.patch == i,
            P.chord.distance(cells.middle, lo, hi) >= FAR * cells.half,
            P.chord.distance(cells.middle, *wide) >= FAR * cells.half,
        )
        near = np.flatnonzero(~far)
        counts = cells.stop[near] - cells.start[near]
        panels = np.repeat(cells.start[near], counts) + (
            np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        )
        return Group(self, i, np.flatnonzero(far), panels)

    def at_edges(self) -> Iterator[tuple[int, Group]]:
        for i in range(self.patches.number):
            yield i, self.group(i, float(self.patches.a[i]), float(self.patches.b[i]))


@dataclass(frozen=True, eq=False)
class Group:
    """Sums over all sources at targets that use T_i."""

    operator: Operator
    i: int
    far: Index
    near: Index

    @cached_property
    def _far(self) -> tuple[Points, Array, Array]:
        """Points of the far charges, and the charges of dν_i and H dν_i."""
        o, cells = self.operator, self.operator.cells
        middle, offset = cells.middle[self.far, None], cells.points[self.far]
        own = (cells.patch[self.far] == self.i)[:, None]
        w, wH, b, bH = cells.charges[:, self.far]
        distance = o.patches.chord.apart(middle - o.patches.c[self.i], offset)
        distance[own[:, 0]] = 1.0
        points = Points(np.broadcast_to(middle, offset.shape).ravel(), offset.ravel())
        return (
            points,
            np.where(own, w, b / distance).ravel(),
            np.where(own, wH, bH / distance).ravel(),
        )

    @cached_property
    def _near(self) -> tuple[Array, Array]:
        """d(t, c_k)/d(t, c_i) on the near panels (1 on patch i), and dν_i there."""
        o, k = self.operator, self.operator.panels
        points = k.points[self.near]
        patch = k.patch[self.near]
        own = patch == self.i
        d, c = o.patches.chord.apart, o.patches.c
        ratio = np.ones(points.offset.shape)
        others = ~own
        if others.any():
            p = points[others]
            ratio[others] = d(p.anchor - c[patch[others], None], p.offset) / d(
                p.anchor - c[self.i], p.offset
            )
        return ratio, o.omega[self.near] * ratio

    def closure(self) -> tuple[float, float]:
        """∫ H cos dν_i and ∫ cos dν_i, without point charges."""
        o = self.operator
        chord, c = o.patches.chord, o.patches.c[self.i]
        t, w, wH = self._far
        k = o.panels.points[self.near]
        _, nu = self._near
        cos_far, cos_near = (
            chord.cosine(t.anchor - c, t.offset),
            chord.cosine(k.anchor - c, k.offset),
        )
        nu = nu * cos_near
        plain = float(w @ cos_far + nu.sum())
        return float(wH @ cos_far + (nu * o.H[self.near]).sum()), plain

    def D(self, targets: Targets) -> Any:
        """D_i at targets."""
        o, x = self.operator, targets.x
        total = np.empty(x.offset.shape, dtype=np.result_type(x.offset, targets.reference))
        targets = targets._replace(reference=targets.reference - o.H0)
        width = self.near.size * o.panels.angle.shape[1] + self.far.size * CHARGES
        for some in _parts(len(total), max(width, 1)):
            total[some] = self._D(targets.part(some))
        return total - self._charged(x)

    def _charged(self, x: Points) -> Any:
        """Σ Y_e ρ_i(e)/d(x, e)."""
        o, P = self.operator, self.operator.patches
        sharp = np.flatnonzero(o.Y)
        if not sharp.size:
            return 0.0
        rho = edge_ratio(P, self.i)[sharp]
        return (1.0 / P.chord.apart(x.anchor[:, None] - P.edges[sharp], x.offset[:, None])) @ (
            o.Y[sharp] * rho
        )

    def _D(self, targets: Targets) -> Any:
        o, x, reference = self.operator, targets.x, targets.reference
        total = self._by_charges(x, reference)
        if not self.near.size:
            return total
        # only differences of H count: about a local value the sums of both lose nothing
        local = float(np.real(reference[0]))
        t = o.panels.points[self.near]
        _, nu = self._near
        charge = nu * (o.H[self.near] - local)
        step = o.patches.chord.apart(
            t.anchor - x.anchor[:, None, None], t.offset - x.offset[:, None, None]
        )
        rows, panels = self._close(x)
        close = step[rows, panels]
        step[rows, panels] = np.inf
        kernel = np.reciprocal(step, out=step).reshape(len(total), -1)
        total += kernel @ charge.ravel() - (reference - local) * (kernel @ nu.ravel())
        if rows.size:
            shared = self._shared(targets, rows, panels, close)
            if np.iscomplexobj(shared):
                total += np.bincount(rows, shared.real, len(total)) + 1j * np.bincount(
                    rows, shared.imag, len(total)
                )
            else:
                total += np.bincount(rows, shared, len(total))
        return total

    def _by_charges(self, x: Points, reference: Any) -> Any:
        """The sums over far cells; those far from all targets are interpolated between them."""
        o = self.operator
        total = np.zeros(x.offset.shape, dtype=np.result_type(x.offset, reference))
        if not self.far.size:
            return total
        t, w, wH = self._far
        apart = o.patches.chord.apart
        lo, hi = float(np.real(x.x).min()), float(np.real(x.x).max())
        direct = np.ones(self.far.size, dtype=bool)
        if len(total) > 2 * CHARGES and not np.iscomplexobj(x.offset):
            cells = o.cells
            away = o.patches.chord.distance(cells.middle[self.far], lo, hi) - cells.half[self.far]
            direct = away < (FAR - 1.0) * 0.5 * (hi - lo)
        each = np.repeat(direct, CHARGES)
        if each.any():
            some = t[each]
            kernel = 1.0 / apart(some.anchor - x.anchor[:, None], some.offset - x.offset[:, None])
            total += kernel @ wH[each] - reference * (kernel @ w[each])
        if not each.all():
            some = t[~each]
            middle, half = 0.5 * (lo + hi), 0.5 * (hi - lo)
            nodes = middle + half * chebyshev.points(CHARGES)
            kernel = 1.0 / apart(some.anchor - nodes[:, None], some.offset)
            series = chebyshev.transform(np.stack((kernel @ wH[~each], kernel @ w[~each])))
            s = ((x.anchor - middle) + x.offset) / half
            total += chebyshev.evaluate(series[0], s) - reference * chebyshev.evaluate(series[1], s)
        return total

    def _close(self, x: Points) -> tuple[Index, Index]:
        """(target, panel) that are near each other, panels counted among `near`."""
        _o, k, P = self.operator, self.operator.panels, self.operator.patches
        code = 2 * k.patch[self.near] + k.right[self.near]
        sides, place = np.unique(code, return_inverse=True)
        patch, right = sides // 2, sides % 2 == 1
        edge = np.where(right, P.b[patch], P.a[patch])
        inward = P.chord.difference(x.anchor[:, None] - edge, x.offset[:, None])
        inward = np.where(right, -inward, inward)
        angle = 2.0 * np.arcsin(np.sqrt((inward / (2.0 * P.r[patch])).astype(complex)))
        lo, hi = k.lo[self.near], k.hi[self.near]
        angle = angle[:, place]
        # a square root may have either sign: the nearer image counts
        middle, reach = 0.5 * (lo + hi), NEAR * 0.5 * (hi - lo)
        away = np.minimum(np.abs(angle - middle), np.abs(angle.conj() - middle))
        rows, panels = np.nonzero(away < reach)
        return rows, panels

    def _shared(self, targets: Targets, rows: Index, panels: Index, step: Any) -> Any:
        """The integral over each near panel: the exact quotient on the same piece of H, and on
        others the pole apart.
        """
        x, reference, piece, S, owner = targets
        o, k = self.operator, self.operator.panels
        own = k.piece[self.near][panels]
        same = own == piece[rows]
        nu = self._near[1][panels]
        sums = np.empty(len(rows), dtype=np.result_type(x.offset, reference))
        if same.any():
            t = k.points[self.near[panels[same]]]
            xs = x.anchor[rows[same], None], x.offset[rows[same], None]
            exact = o.pieces.divided(own[same][:, None], (t.anchor, t.offset), xs)
            if o.patches.chord.periodic:
                plain = (t.anchor - xs[0]) + (t.offset - xs[1])
                zero = step[same] == 0.0
                exact = exact * np.where(zero, 1.0, plain / np.where(zero, 1.0, step[same]))
            sums[same] = (nu[same] * exact).sum(axis=1)
        other = np.flatnonzero(~same)
        if not other.size:
            return sums
        step = np.where(step[other] == 0.0, np.inf, step[other])
        q, places, ref = self.near[panels[other]], x[rows[other]], reference[rows[other]]
        sums[other] = (nu[other] * ((o.H[q] - ref[:, None]) / step)).sum(axis=1)
        residue = o.pieces.value(own[other], places.anchor, places.offset) - o.H0 - ref
        lo, hi = o.pieces.ends[own[other]], o.pieces.ends[own[other] + 1]
        real = np.real(places.x)
        beyond = np.maximum(np.maximum(lo - real, real - hi), np.abs(np.imag(places.offset)))
        counts = (beyond <= o.pieces.reach[own[other]]) & (residue != 0.0)
        # not beside a repetition of the panel: of one patch per period both sides of a gap are it
        here = np.abs(places.anchor - k.points.anchor[q, 0]) <= 0.5 * o.patches.chord.period
        counts &= here & (k.patch[q] == owner[rows[other]])
        if counts.any():
            q, places, residue = q[counts], places[counts], residue[counts]
            gauss = (o.weight[q] / step[counts]).sum(axis=1)
            pole = self._pole(q, places)
            rounding = ~np.isfinite(pole) & (np.abs(residue) < 1e-12)
            pole = np.where(rounding, gauss, pole)
            sums[other[counts]] += (
                residue * self._f(q, places, S[rows[other]][counts]) * (pole - gauss)
            )
        return sums

    def _f(self, panel: Index, x: Points, S: Any) -> Any:
        """dν_i/(dt/W_k) of the panel's patch k, continued to x."""
        o, P = self.operator, self.operator.patches
        patch = o.panels.patch[panel]
        f = 1.0 / S
        other = patch != self.i
        if not other.any():
            return f
        x, k, S = x[other], patch[other], S[other]
        d = P.chord.apart
        ratio = d(x.anchor - P.c[k], x.offset) / d(x.anchor - P.c[self.i], x.offset)
        own, theirs = (
            d(x.anchor - P.a[j], x.offset) * d(x.anchor - P.b[j], x.offset)
            for j in (np.full(k.shape, self.i), k)
        )
        if np.iscomplexobj(ratio):
            f[other] = np.sqrt(theirs / own / ratio**2) * ratio / S
        else:
            f[other] = np.sign(ratio) * np.sqrt(np.abs(theirs / own)) / S
        return f

    def _pole(self, panel: Index, x: Points) -> Any:
        """∫_panel dt/(W_k(t) d(t, x)), a principal value on the panel."""
        o, P = self.operator, self.operator.patches
        k = o.panels
        patch, right = k.patch[panel], k.right[panel]
        edge = np.where(right, P.b[patch], P.a[patch])
        inward = P.chord.difference(x.anchor - edge, x.offset)
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


def edge_ratio(patches: Patches, i: Any) -> Array:
    """ρ_i(e) = d(e, c_k)/d(e, c_i) of all edges e, those of patch k: (2N,), or (i, 2N)."""
    d, c = patches.chord.apart, patches.c
    k = np.repeat(np.arange(patches.number), 2)
    own = d(patches.edges - c[k])
    rho = own / d(patches.edges - np.asarray(c[i])[..., None])
    return np.asarray(np.where(k == np.asarray(i)[..., None], 1.0, rho))


def _parts(rows: int, columns: int) -> list[slice]:
    size = max(CHUNK // columns, 1)
    return [slice(start, start + size) for start in range(0, rows, size)]


def _spread() -> Array:
    """Charges on the Chebyshev points that have given moments, as a matrix (n, i)."""
    quarter = np.outer(np.arange(CHARGES), 2 * np.arange(CHARGES, 0, -1) - 1) % (4 * CHARGES)
    Q: Array = np.cos(np.pi / (2 * CHARGES) * quarter) * (2.0 / CHARGES)
    Q[0] *= 0.5
    return Q


SPREAD = _spread()
