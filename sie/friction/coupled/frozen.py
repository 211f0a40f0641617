"""What the growth of a contact under P leaves at each place: its slip gradient and its slip.

With the rates of the flat punch under P = 1, γ^ of the slip gradient and g^ of the slip (`flat`),

    γ(x) = ∫ P'(s) γ^((x - m)/s) ds/s,     g(x) = ∫ P'(s) g^((x - m)/s) ds

over all contacts, the first also over those before x was touched; contacts in which x sticks add
nothing. So γ stays as soon as the stick zone has reached x: it does not depend on the load after.
The integrals are cut where an edge passes x and where the end of the stick zone does, and where
panels end; on each part the trapezoidal rule of `pieces` holds.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .fields import interpolated
from .growth import STEP, Panel, trapezoidal

if TYPE_CHECKING:
    from .flat import FlatPunch

Array = NDArray[np.float64]
Passing = tuple[NDArray[np.intp], Array]
Rate = Callable[[Array, Array, Array], Array]

NEWTONS, SETTLED = 40, 1e-15  # steps to the place where an end passes x, and parts of s
LEAST = 1e-300
SHIFTS = 4  # places of the tables in a step of the rule
FOLDS = 24.0  # e-folds of γ next to a mark
MARGIN = 1.5  # of v, beyond the stick zone, for the interpolation
SAME = 1e-13  # of a half-width: marks that are nearer are one


@dataclass(frozen=True, eq=False)
class Frozen:
    """Integrals over all contacts.

    flat        functions of the flat punch
    panels      P' and the middle
    """

    flat: FlatPunch
    panels: tuple[Panel, ...]

    def gradient(self, x: Array, side: float) -> Array:
        """γ where x sticks at last, for places that the edge of this side passes."""
        touched = self.passed(x, side, 1.0)
        before = self._before(x, side, touched)
        return before + self._after(x, side, math.inf, self._gradient_rate)

    def slip(self, x: Array, side: float, s: float) -> Array:
        """The slip outwards in the contact of the half-width s, since it touched."""
        return self._after(x, side, s, self._slip_rate)

    def _gradient_rate(self, from_c: Array, e: Array, s: Array) -> Array:
        values: Array = self.flat.gradient(from_c / s, e / s) / s
        return values

    def _slip_rate(self, from_c: Array, e: Array, s: Array) -> Array:
        return self.flat.slip(from_c / s, e / s)

    # -- the growth --------------------------------------------------------------------------------

    @property
    def base(self) -> tuple[float, float]:
        """What sticks from the first: a part of the flat base, or the place that touched first."""
        return self.start(0, -1.0, self.flat.c), self.start(0, 1.0, self.flat.c)

    def _panel(self, s: float) -> Panel:
        ahead = [panel for panel in self.panels if panel.lo <= s]
        return ahead[-1] if ahead else self.panels[0]

    def middle(self, s: float) -> float:
        """m."""
        panel = self._panel(s)
        return panel.middle + float(panel.moved(np.array(0.0), np.array(s - panel.lo)))

    def load(self, s: float) -> float:
        """P."""
        return sum(panel.load(s - panel.lo) for panel in self.panels)

    def rate(self, s: Array) -> Array:
        """P'."""
        values = np.empty(len(s))
        for k, width in enumerate(s.tolist()):
            panel = self._panel(width)
            values[k] = float(panel(np.array(width - panel.lo)))
        return values

    def passings(self, events: Sequence[float], s: float) -> tuple[float, ...]:
        """The half-widths at which an end of the stick zone passes where an edge met a kink."""
        found = []
        for event, side in itertools.product(events, (1.0, -1.0)):
            place = np.array([self.middle(event) + side * event])
            if event > 0.0 and side * (self.middle(s) - place[0]) + self.flat.c * s > 0.0:
                k, ahead = self.passed(place, side, self.flat.c)
                found.append(self.panels[int(k[0])].lo + float(ahead[0]))
        return tuple(found)

    # -- when ends pass a place --------------------------------------------------------------------

    def start(self, k: int, side: float, part: float) -> float:
        """m ± part s where a panel begins."""
        panel = self.panels[k]
        return panel.middle + side * part * panel.lo

    def passed(self, x: Array, side: float, part: float) -> Passing:
        """The panel, and s - lo on it, at which m ± part s passes x; 0 if it is passed before."""
        starts = [side * self.start(k, side, part) for k in range(len(self.panels))]
        k = np.clip(np.searchsorted(starts, side * x, side="right") - 1, 0, len(starts) - 1)
        ahead = np.zeros(len(x))
        for j in np.unique(k):
            own, panel = k == j, self.panels[j]
            far = np.maximum(side * (x[own] - self.start(j, side, part)), 0.0)
            at = np.minimum(far / part, panel.length)
            for _ in range(NEWTONS):
                missed = part * at + side * panel.moved(np.zeros(1), at) - far
                step = missed / (part + side * panel.turn(at))
                at = np.clip(at - step, 0.0, panel.length)
                if float(np.abs(step).max()) <= SETTLED * panel.hi:
                    break
            ahead[own] = at
        return k, ahead

    # -- the integrals -----------------------------------------------------------------------------

    def _before(self, x: Array, side: float, touched: Passing) -> Array:
        """∫P' γ^ ds/s over contacts that have not reached x."""
        (k, ahead), total, flat = touched, np.zeros(len(x)), self.flat
        for j, panel in enumerate(self.panels):
            own = np.flatnonzero((k > j) | ((k == j) & (ahead > 0.0)))
            if not own.size:
                continue
            whole = k[own] > j
            end = np.where(whole, panel.length, ahead[own])[:, None]
            edge = self.start(j, side, 1.0) + side * panel.spread(side)
            gap = np.where(whole, np.maximum(side * (x[own] - edge), 0.0), 0.0)[:, None]
            # next to a place that touches first γ^ falls with the square of s
            room = 2.0 + panel.power if panel.lo == 0.0 else 1.0 + min(panel.power, 0.0)
            part, rest, weight = trapezoidal(room, 1.0 - flat.exponent)
            inside, left = end * part, end * rest
            E, s = gap + left - side * panel.moved(end, -left), panel.lo + inside
            values = flat.gradient_beside(np.maximum(E, LEAST) / s) * panel(inside) / s
            total[own] += end[:, 0] * (values @ weight)
        return total

    def _after(self, x: Array, side: float, until: float, rate: Rate) -> Array:
        """∫P' rate ds over contacts up to s = until in which x slips."""
        c, total = self.flat.c, np.zeros(len(x))
        (k, ahead), (k_c, ahead_c) = self.passed(x, side, 1.0), self.passed(x, side, c)
        for j, panel in enumerate(self.panels):
            sticks = (k_c == j) & (ahead_c < panel.length)
            lo = np.where(k < j, 0.0, np.where(k == j, ahead, math.inf))
            last = np.where(k_c < j, 0.0, np.where(sticks, ahead_c, panel.length))
            length = np.minimum(last, until - panel.lo) - lo
            whole = sticks & (k == j) & (ahead > 0.0) & (ahead_c <= until - panel.lo)
            length[whole] = self._slipping(panel, side, ahead[whole])
            own = np.flatnonzero(length > 0.0)
            if not own.size:
                continue
            at, first, length = x[own, None], lo[own, None], length[own, None]
            exact = (sticks & (ahead_c <= until - panel.lo))[own, None]
            last = first + length
            room = min(1.0 + panel.power, 1.0 - self.flat.exponent)
            part, rest, weight = trapezoidal(room, 1.0 + self.flat.exponent)
            past, left = length * part, length * rest
            # how far the edge is beyond x at first, and x beyond the stick zone at last
            edge = np.where(first > 0.0, 0.0, side * (self.start(j, side, 1.0) - at))
            end = self.start(j, side, c) + side * c * last + panel.moved(np.zeros(1), last)
            stick = np.where(exact, 0.0, side * (at - end))
            e = np.maximum(edge, 0.0) + past + side * panel.moved(first, past)
            d = np.maximum(stick, 0.0) + c * left - side * panel.moved(last, -left)
            values = rate(np.maximum(d, LEAST), np.maximum(e, LEAST), panel.lo + first + past)
            total[own] += length[:, 0] * ((values * panel(first + past)) @ weight)
        return total

    def _slipping(self, panel: Panel, side: float, ahead: Array) -> Array:
        """How far s grows from where an edge passes a place to where the stick zone reaches it.

        To relative accuracy: of a narrow slip zone the difference of both would lose all digits.
        """
        c, width = self.flat.c, self.flat.rest * (panel.lo + ahead)
        length = np.minimum(width / c, panel.length)
        for _ in range(NEWTONS):
            missed = c * length + side * panel.moved(ahead, length) - width
            step = missed / (c + side * panel.turn(ahead + length))
            length = np.maximum(length - step, 0.5 * length)
            if float((np.abs(step) / np.maximum(length, LEAST)).max(initial=0.0)) <= 10.0 * SETTLED:
                break
        return length

    # -- the gradient as a function ----------------------------------------------------------------

    def marks(self, events: Sequence[float]) -> tuple[float, ...]:
        """Places where γ is not smooth, given the half-widths at which edges passed kinks."""
        parts = (-1.0, -self.flat.c, self.flat.c, 1.0)
        places = [self.middle(s) + part * s for s, part in itertools.product(events, parts)]
        kept: list[float] = []
        for x in sorted(places):
            if not kept or x - kept[-1] > SAME * self.panels[-1].hi:
                kept.append(x)
        return tuple(kept)


class Gradient:
    """γ where the bodies stick, from tables between marks that are made where they are asked for.

    They are in the variable of `pieces`, in which it is smooth whatever its power at a mark. Given
    are the marks, the stick zone, and the axis if the middle stayed, else nan.
    """

    def __init__(
        self, frozen: Frozen, marks: tuple[float, ...], stick: tuple[float, float], axis: float
    ) -> None:
        last, c = frozen.panels[-1], frozen.flat.c
        middle = last.middle + last.whole_shift
        self.base = frozen.base
        ends = middle - c * last.hi, middle + c * last.hi
        inner = [x for x in marks if ends[0] < x < ends[1]]
        self.frozen, self.cuts = frozen, np.array(sorted({*ends, *inner, *self.base}))
        self.stick, self.axis = stick, axis
        self._known: dict[int, tuple[float, Array]] = {}

    def __call__(self, x: Array) -> Array:
        if math.isfinite(self.axis):
            x = self.axis + np.abs(x - self.axis)
        k = np.clip(np.searchsorted(self.cuts, x, side="right") - 1, 0, len(self.cuts) - 2)
        values = np.zeros(len(x))
        for piece in np.unique(k):
            lo, hi = self.cuts[piece], self.cuts[piece + 1]
            if lo >= self.base[0] and hi <= self.base[1]:
                continue
            own = k == piece
            first, table = self._table(int(piece))
            place = (_variable(x[own] - lo, hi - x[own]) - first) * (SHIFTS / STEP)
            values[own] = interpolated(table, np.maximum(place, 0.0))[0]
        return values

    def _table(self, piece: int) -> tuple[float, Array]:
        """The first v, and γ, within the stick zone."""
        if piece not in self._known:
            lo, hi = self.cuts[piece], self.cuts[piece + 1]
            ends = np.clip(self.stick, lo, hi)
            least, most = _variable(ends - lo, hi - ends).tolist()
            first, last = max(-FOLDS, least - MARGIN), min(FOLDS, most + MARGIN)
            count = math.ceil((last - first) * SHIFTS / STEP) + 1
            v = first + STEP / SHIFTS * np.arange(count)
            e = np.exp(-np.abs(v))
            ahead = (hi - lo) * e / (1.0 + e)
            side = 1.0 if lo >= self.base[1] else -1.0
            x = np.where(v < 0.0, lo + ahead, hi - ahead)
            self._known[piece] = first, self.frozen.gradient(x, side)[None]
        return self._known[piece]


def _variable(from_lo: Array, from_hi: Array) -> Array:
    return np.clip(np.log(np.maximum(from_lo, LEAST) / np.maximum(from_hi, LEAST)), -FOLDS, FOLDS)
