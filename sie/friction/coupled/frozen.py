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
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .growth import LEAST, Before, Panel, trapezoidal

if TYPE_CHECKING:
    from .flat import FlatPunch

Array = NDArray[np.float64]
Rate = Callable[[Array, Array], Array]  # of the distances from stick and edge, half-width 1

NEWTONS, SETTLED = 40, 1e-15  # steps to the place where an end passes x, and parts of s
NEAREST = 1e-150  # from where a panel begins, a place
WINDOW = 1.3  # half-widths from the middle
SAME = 1e-13  # of a half-width: marks that are nearer are one


class Stretch(NamedTuple):
    """The part on one panel of stretches of growth.

    own             which stretches have a part there
    lo, length      s less that where the panel begins, and how much of it
    first, last     whether the stretch begins there, and ends
    """

    panel: Panel
    own: NDArray[np.intp]
    lo: Array
    length: Array
    first: NDArray[np.bool_]
    last: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Frozen:
    """Integrals over all contacts.

    flat        functions of the flat punch
    panels      P' and the middle
    """

    flat: FlatPunch
    panels: tuple[Panel, ...]

    # -- the growth --------------------------------------------------------------------------------

    @property
    def base(self) -> tuple[float, float]:
        """What sticks from the first: a part of the flat base, or the place that touched first."""
        first = self.panels[0]
        return first.middle - self.flat.c * first.lo, first.middle + self.flat.c * first.lo

    def _panel(self, s: float) -> Panel:
        ahead = [panel for panel in self.panels if panel.lo <= s]
        return ahead[-1] if ahead else self.panels[0]

    def middle(self, s: float) -> float:
        """m."""
        panel = self._panel(s)
        return panel.middle + float(panel.moved(np.array(0.0), np.array(s - panel.lo)))

    def window(self, s: float) -> tuple[float, float]:
        """What no contact under Q leaves, about the place that touched first."""
        middle = self.middle(s) - self.panels[0].middle
        return middle - WINDOW * s, middle + WINDOW * s

    def load(self, s: float) -> float:
        """P."""
        return sum(panel.load(s - panel.lo) for panel in self.panels)

    def rate(self, s: float) -> float:
        """P'."""
        panel = self._panel(s)
        return float(panel(np.array(s - panel.lo)))

    def marks(self, events: Sequence[float]) -> tuple[float, ...]:
        """Places where γ is not smooth, given the half-widths at which edges passed kinks."""
        parts = (-1.0, -self.flat.c, self.flat.c, 1.0)
        places = [self.middle(s) + part * s for s, part in itertools.product(events, parts)]
        kept: list[float] = []
        for x in sorted(places):
            if not kept or x - kept[-1] > SAME * self.panels[-1].hi:
                kept.append(x)
        return tuple(kept)

    # -- when ends pass a place --------------------------------------------------------------------

    def _touched(self, x: Array, side: float) -> tuple[NDArray[np.intp], Array]:
        """The panel, and s - lo on it, at which the edge passes x; 0 if it touches at first."""
        starts = [side * panel.middle + panel.lo for panel in self.panels]
        k = np.clip(np.searchsorted(starts, side * x, side="right") - 1, 0, len(starts) - 1)
        ahead = np.zeros(len(x))
        for j in np.unique(k):
            own, panel = k == j, self.panels[j]
            far = np.maximum(side * x[own] - starts[j], 0.0)
            at = np.minimum(far, panel.length)
            for _ in range(NEWTONS):
                missed = at + side * panel.moved(np.zeros(1), at) - far
                step = missed / (1.0 + side * panel.turn(at))
                at = np.clip(at - step, 0.0, panel.length)
                if float(np.abs(step).max()) <= SETTLED * panel.hi:
                    break
            ahead[own] = at
        return k, ahead

    def _slipping(self, x: Array, side: float, s: Array) -> Array:
        """How far the half-width grows from s until the stick zone reaches x.

        To relative accuracy: of a narrow slip zone the difference of both would lose all digits.
        """
        c, first = self.flat.c, self.panels[0]
        width, most = self.flat.rest * s, self.panels[-1].hi - s
        at_first = s <= first.lo
        width[at_first] = side * (x[at_first] - first.middle) - c * first.lo
        length = np.clip(width / c, 0.0, most)
        for _ in range(NEWTONS):
            moved, turn = np.zeros(len(x)), np.zeros(len(x))
            for panel, own, lo, by, _, _ in self._stretches(s, length):
                moved[own] += panel.moved(lo, by)
                turn[own] = panel.turn(lo + by)
            step = (c * length + side * moved - width) / (c + side * turn)
            length = np.clip(length - step, 0.5 * length, most)
            if float((np.abs(step) / np.maximum(length, LEAST)).max(initial=0.0)) <= 10.0 * SETTLED:
                break
        return length

    def _stretches(self, s: Array, length: Array) -> Iterator[Stretch]:
        """The parts on panels of growth from s on."""
        done = np.zeros(len(s))
        for j, panel in enumerate(self.panels):
            lo = np.maximum(s - panel.lo, 0.0)
            room = np.inf if j == len(self.panels) - 1 else panel.length - lo
            by = np.clip(length - done, 0.0, np.maximum(room, 0.0))
            own = np.flatnonzero(by > 0.0)
            if own.size:
                left = length - done - by
                yield Stretch(panel, own, lo[own], by[own], done[own] == 0.0, left[own] <= 0.0)
            done += by

    # -- the integrals -----------------------------------------------------------------------------

    def gradient(self, x: Array, side: float) -> Array:
        """γ where x sticks at last, for places that the edge of this side passes."""
        (k, ahead), flat, total = self._touched(x, side), self.flat, np.zeros(len(x))
        for j in np.unique(k[(k > 0) | (ahead > 0.0)]).tolist():
            own = np.flatnonzero((k == j) & ((ahead > 0.0) | (j > 0)))
            at = np.maximum(ahead[own], NEAREST)
            before = Before(flat, self.panels[:j], self.panels[j], side, at)
            total[own] = before.integral(flat.gradient_beside)
        s = np.array([self.panels[j].lo for j in k.tolist()]) + ahead
        length = self._slipping(x, side, s)
        return total + self._over(x, side, (s, length, length), self.flat.gradient, -1.0)

    def slip(self, x: Array, side: float, until: float) -> Array:
        """The slip outwards in the contact of the half-width `until`, since it touched."""
        k, ahead = self._touched(x, side)
        s = np.array([self.panels[j].lo for j in k.tolist()]) + ahead
        whole = self._slipping(x, side, s)
        length = np.minimum(whole, until - s)
        return self._over(x, side, (s, length, whole), self.flat.slip, 0.0)

    def _over(
        self, x: Array, side: float, growth: tuple[Array, Array, Array], rate: Rate, power: float
    ) -> Array:
        """∫P' rate s^power ds from where x is touched on, while it slips.

        Given are s there, how far it grows, and how far until the stick zone reaches x.
        """
        (s, length, whole), c, h = growth, self.flat.c, self.flat.exponent
        total, touches, stuck = np.zeros(len(x)), s > self.panels[0].lo, length >= whole
        for panel, own, lo, grown, first, last in self._stretches(s, length):
            room = min(1.0 + panel.power, 1.0 - h) if panel is self.panels[0] else 1.0 - h
            part, rest, weight = trapezoidal(room, 1.0 + h)
            at, start, by = x[own, None], lo[:, None], grown[:, None]
            end, past, left = start + by, by * part, by * rest
            # how far the edge is beyond x at first, and x beyond the stick zone at last
            edge = panel.lo + start + side * (panel.middle + panel.moved(np.zeros(1), start) - at)
            stick = side * (at - panel.middle - panel.moved(np.zeros(1), end)) - c * (
                panel.lo + end
            )
            edge[first & touches[own]] = 0.0
            stick[last & stuck[own]] = 0.0
            e = np.maximum(edge, 0.0) + past + side * panel.moved(start, past)
            d = np.maximum(stick, 0.0) + c * left - side * panel.moved(end, -left)
            width = panel.lo + start + past
            values = rate(np.maximum(d, LEAST) / width, np.maximum(e, LEAST) / width)
            mass = by * weight * panel(start + past) * width**power
            total[own] += (values * mass).sum(axis=1)
        return total
