"""What Q added to the tractions while the contact spread: integrals over its edge's advance.

With the zones of `spreading_zones` and the rates of `edge_rate`

    p(x) = p of P alone + ∫ w ṗ(x) ds',     q and γ alike,    0 < s' < s.

A place is touched at s' = -x - b and passed by the stick zone's end at ε2 = c - x: there rates are
infinite, and distances are counted from there.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight

from .edge_rate import Lengths, Weights
from .panels import LONGEST, graded, totals
from .spreading_zones import FROM_START, Indices, Places, SpreadingPanel, SpreadingZones

Array = NDArray[np.float64]

SHORTER = 0.5 * LONGEST  # of a panel of v: beside the kernel its integrand has all of the series
AT_ONCE = 1e-34  # of an interval, to a singularity at its end
FAR, ON_FAR = 1.0, 14  # lengths of a panel to the next singularity: there one rule does, with nodes
BEFORE_STRIP = 0.03  # widths of the strip: nearer to the edge panels may be long
STRIPS = 2.0  # widths: no place beyond them is on the strip, whose width changes little
WIDTHS = 3  # steps towards the width of the strip when its end passes a place
NONE = np.zeros(0)
CASES = tuple((i, j) for i in (False, True) for j in (False, True))  # at start, at end


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


class SpreadingHistory(SpreadingZones):
    """The integrals over the panels of the zones."""

    def inside(self, places: Places, panels: tuple[SpreadingPanel, ...] | None = None) -> Array:
        """Rows of ∫w ṗ, ∫w (f ṗ - q̇) and ∫w γ̇ in contact; 0 for f p - q where it slips at s.

        The sums are taken over some of the panels or all.
        """
        total, passed = np.zeros((3, len(places.s))), self.passed(places)
        times = self.times(places)
        for panel in self.panels if panels is None else panels:
            self._while_stuck(total, panel, places, (passed, *times))
            self._while_slipping(total, panel, places, (passed, times[1]))
        total[1, np.isfinite(passed)] = 0.0
        return total

    def _while_stuck(
        self, total: Array, panel: SpreadingPanel, places: Places, times: tuple[Array, ...]
    ) -> None:
        """Adds what places gain on the panel before the end of the stick zone passes them."""
        passed, to_e2, to_x2 = times
        touched = np.maximum(-places.from_b, 0.0)
        start, end = np.maximum(panel.start, touched), np.minimum(panel.hi, places.s)
        stop = np.minimum(end, passed)
        base = FROM_START * (end - start) if panel.first else np.maximum(start - touched, 0.0)
        fresh = (touched > 0.0) & (touched >= panel.start)
        later = (places.s - stop) + np.where(np.isinf(passed), to_e2, to_x2)
        last = (places.s <= panel.hi) & np.isinf(passed) & (places.end == "e2")
        offset = np.zeros(len(places.s))
        for at_start, at_end in CASES:
            k = np.flatnonzero((stop > start) & (fresh == at_start) & (last == at_end))
            if at_start and self.strip and k.size:
                k = self._in_strip(total, panel, places, (k, start, stop, offset))
            elif self.strip and k.size:
                self._leaving_strip(total, panel, places, (k, start, stop, base, later))
            marks = ("touched",) * at_start + ("e2",) * at_end
            powers = 0.0, (-0.5 - self.rates.theta) * at_end
            near = BEFORE_STRIP * self.width if at_start and self.strip else 0.0
            piece = Piece(k, start[k], stop[k], base[k], later[k], powers, marks, near)
            if at_start:
                piece = piece._replace(offset=offset[k], span=stop[k] - start[k])
            self._add(total, panel, places, piece)

    def _while_slipping(
        self, total: Array, panel: SpreadingPanel, places: Places, times: tuple[Array, ...]
    ) -> None:
        """Adds what places gain on the panel after the end of the stick zone passed them."""
        (passed, to_x2), theta = times, self.rates.theta
        end = np.minimum(panel.hi, places.s)
        start = np.maximum(panel.start, np.minimum(passed, places.s))
        fresh, later = passed >= panel.start, (places.s - end) + to_x2
        at_once = panel.first & (passed < 0.0)
        base = np.where(at_once, FROM_START * end, start - np.minimum(passed, start))
        last = (places.s <= panel.hi) & (places.end == "x2")
        for at_start, at_end in CASES:
            k = np.flatnonzero((end > start) & (fresh == at_start) & (last == at_end))
            marks = ("passed",) * at_start + ("x2",) * at_end
            powers = (-0.5 - theta) * at_start, (theta - 0.5) * at_end
            piece = Piece(k, start[k], end[k], base[k], later[k], powers, marks)
            self._add(total, panel, places, piece)

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
        # Beyond the panel its series mean nothing
        on_strip = np.minimum(self.width, stop[k] - touched)
        for _ in range(WIDTHS):
            on_strip = np.minimum(self.width_at(panel, touched + on_strip), stop[k] - touched)
        start[k] = touched + on_strip
        powers = self.rates.theta - 0.5, 0.0
        piece = Piece(k, touched, start[k], on_strip, 0.0 * on_strip, powers, ("touched",))
        self._add(total, panel, places, piece._replace(offset=np.zeros(len(k)), span=on_strip))
        offset[k] = on_strip
        return k[touched + on_strip < stop[k]]

    def _leaving_strip(
        self,
        total: Array,
        panel: SpreadingPanel,
        places: Places,
        intervals: tuple[Indices, Array, Array, Array, Array],
    ) -> None:
        """Adds what places slip that the strip still covers at the start, and moves starts.

        Where the strip leaves a place before or after the interval rates are singular there.
        """
        k, start, stop, base, later = intervals
        # The strip ends at x when x1 has moved by its width less x + b
        k = k[(start + places.from_b)[k] < STRIPS * self.width]
        if not k.size:
            return
        end = stop[k]
        for _ in range(WIDTHS):
            at = np.clip(end, start[k], stop[k])
            end = self.width_at(panel, np.maximum(at, panel.lo)) - places.from_b[k]
        before, after = (end > 0.0) & (end <= start[k]), end >= stop[k]
        base[k[before]] = np.minimum(base[k], start[k] - end)[before]
        later[k[after]] = np.minimum(later[k], end - stop[k])[after]
        inside = (end > start[k]) & (end < stop[k])
        k, end = k[inside], end[inside]
        self._add(total, panel, places, Piece(k, start[k], end, base[k], 0.0 * end))
        start[k], base[k] = end, 0.0

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
            self._add_far(total, panel, places.of(piece.which[far]), piece.which[far], beyond)
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

    def _add_far(
        self, total: NDArray[Any], panel: SpreadingPanel, places: Places, k: Indices, beyond: bool
    ) -> None:
        """Adds the integrals over all of a panel that is far from what happens to the places."""
        x, _, w = with_weight(ON_FAR, 0.0, 0.0)
        s = (panel.lo * np.exp(panel.length * x))[None]
        values = self._values(panel, places, s, (), None, beyond=beyond)
        rows = (values * (panel.length * w * s)).sum(axis=-1)
        for row, sums in zip(total, rows, strict=True):
            row[k] += sums

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
        weights = self.weights_on(panel, s)
        if weights.log.shape != shape:
            weights = Weights(*(np.broadcast_to(v, (*v.shape[:-2], *shape)) for v in weights))
        if beyond:
            return (w * self.rates.beside(at, weights, self.strip))[None]
        return w * np.array(self.rates.inside(at, weights, self.strip))
