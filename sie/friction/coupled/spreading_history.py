"""What Q added to the tractions while the contact spread: integrals over its edge's advance.

At constant P the left edge is -b - s; the right end of the stick zone and the right edge have moved
left by ε2 and ε3, and Q grows by w ds. With the rates of `edge_rate`

    p(x) = p of P alone + ∫ w ṗ(x) ds',     q and γ alike,    0 < s' < s,

where ln w, ln ε2 and ln ε3 are series in ln s on panels, and the first panel, from s = 0 on, has
powers of s. A place is touched at s' = -x - b and passed by the stick zone's end at ε2 = c - x:
there rates are infinite, and distances are counted from there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.gauss_jacobi import with_weight

from .edge_rate import EdgeRates, Lengths, Weights
from .panels import LONGEST, graded, totals

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

SHORTER = 0.5 * LONGEST  # of a panel of v: beside the kernel its integrand has all of the series
AT_ONCE = 1e-34  # of an interval, to a singularity at its end
FROM_START = 1e-25  # of the first panel, to s = 0
FAR, ON_FAR = 1.0, 14  # lengths of a panel to the next singularity: there one rule does, with nodes
SEEN = 1e-20  # of ε: narrower strips change no digit of a traction
BEFORE_STRIP = 0.03  # widths of the strip: nearer to the edge panels may be long
WEIGHT_NODES = 18  # of a panel, for the weights of the rates; of the first, from LEAST of it on
FIRST_NODES, LEAST = 40, 1e-9
BISECTIONS = 64
NONE = np.zeros(0)
WIDTHS = 3  # steps towards the width of the strip when its end passes a place


@dataclass(frozen=True, eq=False)
class SpreadingPanel:
    """ln w, ln ε2, ln ε3 as series in ln s for lo <= s <= hi; the first is continued to s = 0.

    weights     those of the rates at Chebyshev points of ln s, transformed; of the first, None
    """

    lo: float
    hi: float
    series: Array = field(repr=False)
    first: bool = False

    @cached_property
    def length(self) -> float:
        """ln hi/lo."""
        return math.log(self.hi / self.lo)

    @property
    def start(self) -> float:
        return 0.0 if self.first else self.lo

    def variable(self, s: Array) -> Array:
        values: Array = 2.0 / self.length * np.log(s / self.lo) - 1.0
        return values

    def __call__(self, s: Array) -> tuple[Array, Array, Array]:
        """w, ε2 and ε3."""
        y = self.variable(s)
        w, e2, e3 = (np.exp(chebyshev.evaluate(row, y)) for row in self.series)
        return w, e2, e3

    def slopes(self, s: Array) -> tuple[Array, Array]:
        """The derivatives of ε2 and ε3 with s."""
        y = self.variable(s)
        rates = []
        for row in self.series[1:]:
            own = np.polynomial.chebyshev.chebval(y, np.polynomial.chebyshev.chebder(row))
            rates.append(np.exp(chebyshev.evaluate(row, y)) * own * 2.0 / (self.length * s))
        return rates[0], rates[1]

    def moved(self, k: int, s: Array, by: Array, to: Array) -> Array:
        """ε_k at to = s + by less that at s, to relative accuracy however small `by` is."""
        y = self.variable(s)
        near = np.abs(by) < 0.5 * s
        # Beyond, the difference of logarithms keeps its digits
        dv = np.where(near, np.log1p(np.where(near, by, 0.0) / s), np.log(to / s))
        step = 2.0 / self.length * dv
        y, step = np.broadcast_arrays(y, step)
        rise = chebyshev.quotient(self.series[k], y + step, y + 0.0) * step
        return np.exp(chebyshev.evaluate(self.series[k], y)) * np.expm1(rise)


class Places(NamedTuple):
    """Places x by x + b, c - x and b - x, and how far the edge has advanced for each.

    end     "x1", "e2" or "x2" if all are these ends of the zones at that s, or ""
    """

    from_b: Array
    to_c: Array
    to_b: Array
    s: Array
    end: str = ""

    def of(self, k: Indices) -> Places:
        return Places(self.from_b[k], self.to_c[k], self.to_b[k], self.s[k], self.end)


class Piece(NamedTuple):
    """Intervals of s' on one panel, for the places `which`.

    before, after       to the next singularities
    powers              of the distance at both ends
    marks               what happens at an end: "touched", "passed" at the start, or the place's end
    near                from where on panels next to the end may be long, or the start if touched
    offset, span        of a start that is touched: the distance from x1 there; hi - lo
    """

    which: Indices
    lo: Array
    hi: Array
    before: Array
    after: Array
    powers: tuple[float, float] = (0.0, 0.0)
    marks: tuple[str, ...] = ()
    near: float = 0.0
    offset: Array = NONE
    span: Array = NONE


class SpreadingHistory:
    """The integrals over panels that are given, under rates of a contact with half-widths b > c.

    rest        b - c
    strip       whether the strip is so wide that it is seen
    width       about how wide it is
    """

    def __init__(self, rates: EdgeRates, b: float, rest: float) -> None:
        self.rates, self.b, self.rest = rates, b, rest
        self.panels: tuple[SpreadingPanel, ...] = ()
        self._weights: dict[int, tuple[SpreadingPanel, Array]] = {}
        self.strip, self.width = True, 0.0

    @property
    def c(self) -> float:
        return self.b - self.rest

    # -- zones -------------------------------------------------------------------------------------

    def lengths_of_zones(self, s: Array, e2: Array, e3: Array) -> tuple[Array, Array]:
        """e2 - x1 and x2 - e2."""
        return self.b + self.c + s - e2, self.rest + e2 - e3

    def weights(self, s: Array, e2: Array, e3: Array) -> Weights:
        stuck, slipping = self.lengths_of_zones(s, e2, e3)
        flat = self.rates.weights((slipping / stuck).ravel())
        return Weights(*(part.reshape(*part.shape[:-1], *np.shape(s)) for part in flat))

    def _weights_on(self, panel: SpreadingPanel, s: Array) -> Weights:
        """The weights, interpolated; before the first panel those at its start."""
        rows, lo = self._series(panel)
        y = np.log(s / panel.hi) * (-2.0 / math.log(lo)) + 1.0
        T = chebyshev.polynomials(rows.shape[-1], np.maximum(y, -1.0))
        values = np.tensordot(rows, T, axes=1)
        if not self.strip:
            return Weights(values.reshape(2, 1, *s.shape), values[:0], s)
        n = (len(values) - 1) // 4
        outer, inner = (
            part.reshape(2, n, *s.shape) for part in (values[: 2 * n], values[2 * n : -1])
        )
        return Weights(outer, inner, values[-1])

    def _series(self, panel: SpreadingPanel) -> tuple[Array, float]:
        """Chebyshev series of the weights in ln s, and where they begin, over hi."""
        lo = LEAST if panel.first else panel.lo / panel.hi
        if id(panel) not in self._weights:
            n = FIRST_NODES if panel.first else WEIGHT_NODES
            s = panel.hi * np.exp(0.5 * math.log(lo) * (1.0 - chebyshev.points(n)))
            _, e2, e3 = panel(s)
            at = self.weights(s, e2, e3)
            parts = [at.outer.reshape(-1, len(s)), at.inner.reshape(-1, len(s)), at.log[None]]
            rows = np.concatenate(parts) if self.strip else at.outer[:, 0]
            kept = {id(own) for own in self.panels}
            self._weights = {k: v for k, v in self._weights.items() if k in kept}
            self._weights[id(panel)] = panel, chebyshev.transform(rows)
        return self._weights[id(panel)][1], lo

    def strip_width(self, s: float, e2: float, e3: float) -> float:
        """The width of the strip of these zones."""
        at = np.array([s]), np.array([e2]), np.array([e3])
        stuck, slipping = self.lengths_of_zones(*at)
        log = self.weights(*at).log
        return float((np.exp(log) * stuck * (stuck + slipping) / slipping)[0])

    def load(self, s: float) -> float:
        """Q = ∫w."""
        total = 0.0
        for panel in self.panels:
            if panel.start < s:
                total += self.load_on(panel, s)
        return total

    @staticmethod
    def load_on(panel: SpreadingPanel, s: float) -> float:
        length = min(panel.hi, s) - panel.start
        before = FROM_START * length if panel.first else panel.lo
        _, ahead, _, weight = graded(np.array([length]), np.array([before]), np.array([math.inf]))
        return float((panel(panel.start + ahead)[0] * weight).sum())

    def zones(self, s: float) -> tuple[float, float]:
        """ε2 and ε3 at s."""
        _, e2, e3 = self.panel_of(s)(np.array([s]))
        return float(e2[0]), float(e3[0])

    def panel_of(self, s: float) -> SpreadingPanel:
        return next((p for p in self.panels if s <= p.hi), self.panels[-1])

    # -- places ------------------------------------------------------------------------------------

    def at(self, end: str, s: Array, e2: Array, e3: Array) -> Places:
        """The ends "x1", "e2" and "x2" of the zones."""
        b, c, rest = self.b, self.c, self.rest
        if end == "x1":
            return Places(-s, b + c + s, 2.0 * b + s, s, end)
        if end == "e2":
            return Places(b + c - e2, e2, rest + e2, s, end)
        return Places(2.0 * b - e3, e3 - rest, e3, s, end)

    def passed(self, places: Places) -> Array:
        """s' at which the end of the stick zone passes each place; infinite if not before s."""
        found = np.where(places.to_c <= 0.0, -1.0, math.inf)
        if places.end in ("x1", "e2"):
            return found
        with np.errstate(divide="ignore", invalid="ignore"):
            aim = np.log(places.to_c)
        for panel in self.panels:
            hi = np.log(np.minimum(panel.hi, places.s) / panel.lo)
            lo = -60.0 if panel.first else 0.0

            def rise(v: Array, panel: SpreadingPanel = panel) -> Array:
                values: Array = chebyshev.evaluate(panel.series[1], 2.0 / panel.length * v - 1.0)
                return values

            k = np.flatnonzero(np.isinf(found) & (places.s > panel.start) & (aim < rise(hi)))
            if not k.size:
                continue
            a, b = np.full(len(k), lo), hi[k]
            for _ in range(BISECTIONS):
                middle = 0.5 * (a + b)
                short = rise(middle) < aim[k]
                a, b = np.where(short, middle, a), np.where(short, b, middle)
            found[k] = panel.lo * np.exp(0.5 * (a + b))
        return found

    # -- sums --------------------------------------------------------------------------------------

    def inside(self, places: Places) -> Array:
        """Rows of ∫w ṗ, ∫w (f ṗ - q̇) and ∫w γ̇ in contact; 0 for f p - q where it slips at s."""
        theta, n = self.rates.theta, len(places.s)
        total, passed = np.zeros((3, n)), self.passed(places)
        touched = np.maximum(-places.from_b, 0.0)
        to_e2, to_x2 = self._times(places)
        for panel in self.panels:
            start, end = np.maximum(panel.start, touched), np.minimum(panel.hi, places.s)
            stop = np.minimum(end, passed)
            own = places.s <= panel.hi
            base = FROM_START * (end - start) if panel.first else np.maximum(start - touched, 0.0)
            fresh = (touched > 0.0) & (touched >= panel.start)
            later = (places.s - stop) + np.where(np.isinf(passed), to_e2, to_x2)
            last = own & np.isinf(passed) & (places.end == "e2")
            offset = np.zeros(n)
            for at_start in (False, True):
                for at_end in (False, True):
                    k = np.flatnonzero((stop > start) & (fresh == at_start) & (last == at_end))
                    if at_start and self.strip and k.size:
                        k = self._in_strip(total, panel, places, (k, start, stop, offset))
                    marks = ("touched",) * at_start + ("e2",) * at_end
                    powers = 0.0, (-0.5 - theta) * at_end
                    near = BEFORE_STRIP * self.width if at_start and self.strip else 0.0
                    piece = Piece(k, start[k], stop[k], base[k], later[k], powers, marks, near)
                    if at_start:
                        piece = piece._replace(offset=offset[k], span=stop[k] - start[k])
                    self._add(total, panel, places, piece)
            start = np.maximum(panel.start, np.minimum(passed, places.s))
            fresh, later = passed >= panel.start, (places.s - end) + to_x2
            base = np.where(
                panel.first & (passed < 0.0), FROM_START * end, start - np.minimum(passed, start)
            )
            last = own & (places.end == "x2")
            for at_start in (False, True):
                for at_end in (False, True):
                    k = np.flatnonzero((end > start) & (fresh == at_start) & (last == at_end))
                    marks = ("passed",) * at_start + ("x2",) * at_end
                    powers = (-0.5 - theta) * at_start, (theta - 0.5) * at_end
                    piece = Piece(k, start[k], end[k], base[k], later[k], powers, marks)
                    self._add(total, panel, places, piece)
        total[1, np.isfinite(passed)] = 0.0
        return total

    def _in_strip(
        self,
        total: Array,
        panel: SpreadingPanel,
        places: Places,
        intervals: tuple[Indices, Array, Array, Array],
    ) -> Indices:
        """Adds what places slip on the strip after they are touched, and moves starts to its end.

        Those places are returned that stick before the interval ends.
        """
        k, start, stop, offset = intervals
        touched = start[k].copy()
        on_strip = np.full(len(k), self.width)
        for _ in range(WIDTHS):
            on_strip = np.minimum(self._width_at(panel, touched + on_strip), stop[k] - touched)
        start[k] = touched + on_strip
        powers = self.rates.theta - 0.5, 0.0
        piece = Piece(k, touched, start[k], on_strip, 0.0 * on_strip, powers, ("touched",))
        self._add(total, panel, places, piece._replace(offset=np.zeros(len(k)), span=on_strip))
        offset[k] = on_strip
        return k[touched + on_strip < stop[k]]

    def _width_at(self, panel: SpreadingPanel, s: Array) -> Array:
        """The width of the strip."""
        _, e2, e3 = panel(s)
        stuck, slipping = self.lengths_of_zones(s, e2, e3)
        t = np.exp(self._weights_on(panel, s).log)
        # x - x1 at t = ε
        width: Array = t * stuck * (stuck + slipping) / (slipping + t * stuck)
        return width

    def _times(self, places: Places) -> tuple[Array, Array]:
        """About how much later the end of the stick zone and the right edge pass each place."""
        s = np.unique(places.s)
        times = np.empty((2, len(places.s)))
        for one in s.tolist():
            k, at = places.s == one, np.array([one])
            panel = self.panel_of(one)
            _, e2, e3 = panel(at)
            speeds = panel.slopes(at)
            for row, (gap, e, v) in enumerate(
                zip((places.to_c[k], places.to_b[k]), (e2, e3), speeds, strict=True)
            ):
                times[row, k] = np.maximum(gap - e, 0.0) / np.abs(v)
        if places.end == "e2":
            times[0] = 0.0
        if places.end == "x2":
            times[1] = 0.0
        return times[0], times[1]

    def beside(
        self, places: Places, panels: tuple[SpreadingPanel, ...] | None = None
    ) -> NDArray[np.complex128]:
        """∫w (F ṗ + i F q̇) at x1 or beyond it, over some of the panels or all."""
        total = np.zeros(len(places.s), dtype=complex)
        for panel in self.panels if panels is None else panels:
            end, start = np.minimum(panel.hi, places.s), np.full(len(places.s), panel.start)
            gap = np.maximum(-places.from_b - end, 0.0)
            last = (places.s <= panel.hi) & (places.end == "x1")
            near = BEFORE_STRIP * self.width if self.strip else 0.0
            base = FROM_START * end if panel.first else start
            for at_end in (False, True):
                k = np.flatnonzero((end > start) & (last == at_end))
                marks = ("x1",) * at_end
                piece = Piece(k, start[k], end[k], base[k], gap[k], (0.0, 0.0), marks, near)
                self._add(total[None], panel, places, piece)
        return total

    def _add(
        self, total: NDArray[Any], panel: SpreadingPanel, places: Places, piece: Piece
    ) -> None:
        """Adds the integrals over intervals to the sums of their places."""
        if not piece.which.size:
            return
        length = piece.span if piece.span.size else piece.hi - piece.lo
        near_ends = np.minimum(piece.before, piece.after) < FAR * length
        whole = (piece.lo == panel.start) & (piece.hi == panel.hi)
        far = whole & ~near_ends & (not panel.first) & (not piece.marks)
        beyond = bool((places.from_b[piece.which] < -places.s[piece.which]).any())
        beyond = beyond or places.end == "x1"
        if far.any():
            x, _, w = with_weight(ON_FAR, 0.0, 0.0)
            s = (panel.lo * np.exp(panel.length * x))[None]
            k = piece.which[far]
            values = self._values(panel, places.of(k), s, (), None, beyond=beyond)
            rows = (values * (panel.length * w * s)).sum(axis=-1)
            for row, sums in zip(total, rows, strict=True):
                row[k] += sums
        near = ~far
        if not near.any():
            return
        k, lo, length = piece.which[near], piece.lo[near], length[near]
        marks = piece.marks
        before = AT_ONCE * length if {"touched", "passed"} & set(marks) else piece.before[near]
        before = np.maximum(before, AT_ONCE * length)
        after = np.maximum(piece.after[near], AT_ONCE * length)
        if beyond:
            owner, left, ahead, weight = graded(
                length, after, before, near=piece.near, longest=SHORTER
            )
        else:
            owner, ahead, left, weight = graded(
                length, before, after, piece.powers, near=piece.near, longest=SHORTER
            )
        s = lo[owner][:, None] + ahead
        ends = ahead, left, lo[owner][:, None], piece.hi[near][owner][:, None]
        if "touched" in marks:
            ends = piece.offset[near][owner][:, None] + ahead, *ends[1:]
        values = self._values(panel, places.of(k[owner]), s, marks, ends, beyond=beyond)
        for row, one in zip(total, values * weight, strict=True):
            if np.iscomplexobj(one):
                row[k] += totals(owner, one.real, len(k)) + 1j * totals(owner, one.imag, len(k))
            else:
                row[k] += totals(owner, one, len(k))

    def _values(
        self,
        panel: SpreadingPanel,
        places: Places,
        s: Array,
        marks: tuple[str, ...],
        ends: tuple[Array, ...] | None,
        *,
        beyond: bool,
    ) -> NDArray[Any]:
        """w times the rates for rows of s, one row of them or one a place."""
        w, e2, e3 = panel(s)
        from_b, to_c, to_b = (column[:, None] for column in places[:3])
        to_x1, to_e2, to_x2 = from_b + s, to_c - e2, to_b - e3
        if ends is not None:
            ahead, left, lo, hi = ends
            if "touched" in marks:
                to_x1 = ahead
            if "x1" in marks:
                to_x1 = -left
            if "passed" in marks:
                to_e2 = -panel.moved(1, lo, ahead, s)
            if "e2" in marks:
                to_e2 = -panel.moved(1, hi, -left, s)
            if "x2" in marks:
                to_x2 = -panel.moved(2, hi, -left, s)
        stuck, slipping = self.lengths_of_zones(s, e2, e3)
        shape = to_x2.shape
        at = Lengths(to_x1, to_e2, to_x2, *(np.broadcast_to(v, shape) for v in (stuck, slipping)))
        weights = self._weights_on(panel, s)
        if weights.log.shape != shape:
            weights = Weights(*(np.broadcast_to(v, (*v.shape[:-2], *shape)) for v in weights))
        if beyond:
            return (w * self.rates.beside(at, weights, self.strip))[None]
        return w * np.array(self.rates.inside(at, weights, self.strip))
