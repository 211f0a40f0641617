"""Superposition of flat punches whose middles move: tractions and slip under an uneven profile.

With P'(s) ds pressed on [m(s) - s, m(s) + s] (`uneven_growth`) and φ, ψ, ĝ of the flat under P = 1
on |t| < 1 (`functions`),

    p(x) = ∫ P'(s) φ(t) ds/s,   q alike,   g(x) = 2/E* ∫ P'(s) ĝ(t) ds,   t = (x - m(s))/s,

over all contacts that hold x. A place comes into contact at one edge, slips until t = c, and sticks
from there on. Each interval of s lies on one panel and in one of three zones: next to the edge, as
far as t = c^(1/2), next to c, and in stick; E = s (1 - |t|), the distance from the edge that came
first, is counted along with it, so that narrow slip zones keep their digits.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .functions import FlatFunctions
from .panels import LONGEST, graded, totals
from .uneven_growth import UnevenPanel

Array = NDArray[np.float64]

BEFORE, EDGE, NEAR_C, STICK = range(4)
NEWTONS = 7
NEAR = 0.7  # of a panel's length: nearer to a singularity it is integrated on panels that shrink
TOGETHER = 512  # intervals that are integrated at once: larger arrays cost more
NEAREST = 1e-17  # of the half-width, to a singularity


class Stretch(NamedTuple):
    """Intervals of s on one panel and in one zone.

    which       the places
    start       from the panel's beginning
    length      of each
    E           the distance from the edge at the start
    ends        whether each ends where its zone ends
    """

    panel: UnevenPanel
    zone: int
    which: NDArray[np.intp]
    start: Array
    length: Array
    E: Array
    ends: NDArray[np.bool_]

    def of(self, k: NDArray[np.intp]) -> Stretch:
        """Some of them."""
        start, length, E = self.start[k], self.length[k], self.E[k]
        return Stretch(self.panel, self.zone, self.which[k], start, length, E, self.ends[k])


class Nodes(NamedTuple):
    """Places of a flat punch: t, 1 - t and |t - c| where t >= 0, those of |t| elsewhere."""

    t: Array
    e: Array
    from_c: Array
    back: NDArray[np.bool_]


Function = Callable[[Nodes], Array]


class UnevenSums:
    """The integrals over s as far as each place asks for; `first` is [x1, x2] of first touch."""

    def __init__(
        self, flat: FlatFunctions, panels: tuple[UnevenPanel, ...], first: tuple[float, float]
    ) -> None:
        self.flat, self.panels = flat, panels
        self.base, self.middle = 0.5 * (first[1] - first[0]), panels[0].middle
        self.first = first
        self.parts = 0.0, flat.beyond, flat.rest

    def sides(self, x: Array) -> Array:
        """1 for places that the right edge reached first."""
        return np.where(x < self.middle, -1.0, 1.0)

    def pressure(self, x: Array, end: Array) -> Array:
        """p under the contact of half-width `end`, of each x."""
        p = np.zeros(len(x))
        for stretch in self._stretches(x, end):
            self._add_pressure(p, stretch, x)
        return p

    def pressure_and_deficit(self, x: Array, end: Array) -> tuple[Array, Array]:
        """p, and f p - q on the side that came first, 0 in slip."""
        f, p, deficit = self.flat, np.zeros(len(x)), np.zeros(len(x))

        def value(n: Nodes) -> Array:
            values: Array = f.weight(*n[:3]) * f.S(n.t, n.e) / f.beta
            back = n.back
            if back.any():
                values[back] = 2.0 * f.friction * f.A(n.t[back], n.e[back]) - values[back]
            return values

        for stretch in self._stretches(x, end):
            self._add_pressure(p, stretch, x)
            if stretch.zone == STICK:
                self._add(deficit, stretch, x, value, at_c=f.h)
        return p, deficit

    def _add_pressure(self, p: Array, stretch: Stretch, x: Array) -> None:
        f, chi = self.flat, self.flat.weight
        if stretch.zone == EDGE:
            self._add(p, stretch, x, lambda n: f.sine * chi(*n[:3]) * f.Psi(n.t, n.e), -f.h)
            return
        self._add(p, stretch, x, lambda n: f.A(n.t, n.e))
        if stretch.zone == NEAR_C:

            def beside_c(n: Nodes) -> Array:
                values: Array = -f.sine * chi(*n[:3]) * f.S_beside_c(n.t, n.e)
                return values

            self._add(p, stretch, x, beside_c, at_c=f.h)

    def slip(self, x: Array, end: Array) -> Array:
        """E*/2 times the slip outwards since x came into contact."""
        f, g = self.flat, np.zeros(len(x))
        near_c, (regular, singular) = f.slip_near_c, f.slip_near_edge
        smoother = 1.0 - f.h
        for stretch in self._stretches(x, end):
            if stretch.zone == EDGE:
                self._add(g, stretch, x, lambda n: regular(n.t, n.e), over_s=False)
                self._add(
                    g,
                    stretch,
                    x,
                    lambda n: singular(n.t, n.e) * n.e**smoother,
                    smoother,
                    over_s=False,
                )
            if stretch.zone == NEAR_C:
                self._add(
                    g,
                    stretch,
                    x,
                    lambda n: near_c(n.t, n.e) * n.from_c ** (1.0 + f.h),
                    at_c=1.0 + f.h,
                    over_s=False,
                )
        return g

    # -- intervals ---------------------------------------------------------------------------------

    def _stretches(self, x: Array, end: Array) -> list[Stretch]:
        """All intervals of s, panel by panel."""
        side, offset = self.sides(x), np.abs(x - self.middle)
        E = self.base - offset
        zone = np.full(len(x), STICK)
        for k in (NEAR_C, EDGE):
            zone[self.parts[k] * self.base > E] = k
        zone[E < 0.0] = BEFORE
        found = []
        for panel in self.panels:
            top = np.minimum(end, panel.hi) - panel.lo
            start = np.zeros(len(x))
            waiting = zone == BEFORE
            later = waiting & (E + panel.length + side * panel.whole_shift < 0.0)
            E[later] += (panel.length + side * panel.whole_shift)[later]
            active = (start < top) & ~later
            for k in (BEFORE, EDGE, NEAR_C, STICK):
                i = np.flatnonzero((zone == k) & active)
                if not i.size:
                    continue
                part = self.parts[k] if k < STICK else -1.0
                length, rise, ends = self._through(
                    panel, side[i], start[i], top[i] - start[i], E[i], part
                )
                if k != BEFORE:
                    found.append(Stretch(panel, k, i, start[i], length, E[i], ends))
                start[i] = np.where(ends, start[i] + length, top[i])
                active[i] = ends
                E[i] += rise
                if part >= 0.0:
                    j = i[ends]
                    zone[j] = k + 1
                    E[j] = part * (panel.lo + start[j])
        return found

    def _through(
        self, panel: UnevenPanel, side: Array, start: Array, room: Array, E: Array, part: float
    ) -> tuple[Array, Array, NDArray[np.bool_]]:
        """How far s goes until E = part s, or as far as there is room; how E grows; and which."""

        rise = panel.spread(1.0) - panel.length  # of whole panels
        rise = panel.length + side * rise
        less = (start > 0.0) | (room < panel.length)
        if less.any():
            rise[less] = room[less] + side[less] * panel.moved(start[less], room[less])
        if part < 0.0:
            return room, rise, np.zeros(len(room), dtype=bool)
        s = panel.lo + start
        missed = E - part * s
        over = missed + rise - part * room
        ends = over >= 0.0
        length = room.copy()
        if ends.any():
            k = np.flatnonzero(ends)
            d = room[k] * np.clip(missed[k] / (missed[k] - over[k] - EPS_LIKE), 0.0, 1.0)
            for _ in range(NEWTONS):
                ahead = d + side[k] * panel.moved(start[k], d)
                rate = 1.0 - part + side[k] * panel.rate(start[k] + d)
                d = np.clip(d - (missed[k] + ahead - part * d) / rate, 0.0, room[k])
            length[k] = d
        return length, rise, ends

    # -- integrals ---------------------------------------------------------------------------------

    def _add(
        self,
        total: Array,
        stretch: Stretch,
        x: Array,
        function: Function,
        at_edge: float = 0.0,
        at_c: float = 0.0,
        over_s: bool = True,
    ) -> None:
        """Adds ∫P' function ds, or ds/s, of the intervals with the same powers at their ends.

        `at_edge` and `at_c` are the function's exponents at t = 1 and t = c.
        """
        panel, zone = stretch.panel, stretch.zone
        left = stretch.length > 0.0
        if zone == STICK:
            gap = self._from_c(stretch) if at_c else stretch.E
            far = (stretch.length == panel.length) & (gap >= NEAR * panel.length)
            far &= (1.0 + self.flat.c) * panel.hi - stretch.E >= 3.0 * panel.length
            far &= left & (panel.lo > 0.0)
            if far.any():
                self._add_far(total, stretch, np.flatnonzero(far), x, function, over_s)
                left &= ~far
        own = np.zeros(len(left), dtype=bool)
        if zone == EDGE and at_edge:
            own = stretch.E <= 0.0
        elif zone == STICK and at_c:
            own = self._from_c(stretch) <= 0.0
        begins = (stretch.start == 0.0) & (panel.power != 0.0 or panel.lo == 0.0)
        ends = stretch.ends & (zone == NEAR_C) & (at_c != 0.0)
        kinds = 4 * own + 2 * begins + ends
        for kind in np.unique(kinds[left]).tolist():
            k = np.flatnonzero(left & (kinds == kind))
            first = 0.0
            if kind & 2:
                first = panel.power - (1.0 if over_s and panel.lo == 0.0 else 0.0)
            if kind & 4 and not (kind & 2 and panel.lo == 0.0):
                first += at_edge if zone == EDGE else at_c
            if first <= -1.0:
                total[stretch.which[k]] = np.inf
                continue
            powers = first, at_c if kind & 1 else 0.0
            for few in (k[j : j + TOGETHER] for j in range(0, len(k), TOGETHER)):
                self._integrate(total, stretch.of(few), x, function, powers, at_c, over_s)

    def _add_far(
        self,
        total: Array,
        stretch: Stretch,
        k: NDArray[np.intp],
        x: Array,
        function: Function,
        over_s: bool,
    ) -> None:
        """Adds the integrals over whole panels that are far from all singularities."""
        panel, (inside, mass) = stretch.panel, stretch.panel.places
        s = panel.lo + inside
        part = mass / s if over_s else mass
        side = self.sides(x[stretch.which[k]])[:, None]
        e = (stretch.E[k][:, None] + (inside + side * panel.moved_at_places)) / s
        values = function(self._nodes(e, np.abs(self.flat.rest - e))).reshape(e.shape)
        total[stretch.which[k]] += values @ part

    def _nodes(self, e: Array, from_c: Array) -> Nodes:
        """Places of the flat, given 1 - t and |t - c|."""
        t = 1.0 - e
        back = t < 0.0
        if back.any():
            t, from_c = np.abs(t), np.where(back, self.flat.c - np.abs(t), from_c)
            e = np.where(back, 1.0 - t, e)
        return Nodes(t.ravel(), e.ravel(), from_c.ravel(), back.ravel())

    def _from_c(self, stretch: Stretch) -> Array:
        """s (c - t) at the start of intervals in stick."""
        s = stretch.panel.lo + stretch.start
        return stretch.E - self.flat.rest * s

    def _integrate(
        self,
        total: Array,
        part: Stretch,
        x: Array,
        function: Function,
        powers: tuple[float, float],
        at_c: float,
        over_s: bool,
    ) -> None:
        f, panel = self.flat, part.panel
        side = self.sides(x[part.which])
        s0 = panel.lo + part.start
        hi = s0 + part.length
        nearest = NEAREST * hi
        before = np.full(len(s0), np.inf)
        if panel.power:
            before = np.where(part.start > 0.0, part.start, np.inf)
        near = np.minimum(before, s0)
        if part.zone == STICK and at_c:
            from_c = self._from_c(part)
            to_singular = np.where(from_c > 0.0, from_c, part.E)
        else:
            to_singular = np.where(part.E > 0.0, part.E, np.inf)
        # E grows by less than twice what s does
        before = np.maximum(np.minimum(before, 0.5 * to_singular), nearest)
        after = np.full(len(s0), np.inf)
        end = part.E + part.length + side * panel.moved(part.start, part.length)
        if part.zone == NEAR_C and at_c:
            after = np.where(part.ends, part.length, np.maximum(f.rest * hi - end, nearest))
        elif part.zone == STICK:
            after = np.maximum(0.5 * ((1.0 + f.c) * hi - end), nearest)
        owner, ahead, left, weight = graded(
            part.length, before, after, powers, longest=LONGEST, near=near
        )
        start = part.start[owner][:, None]
        s = (panel.lo + start) + ahead
        moved = side[owner][:, None] * panel.moved(start, ahead)
        E = part.E[owner][:, None] + (ahead + moved)
        e = E / s
        from_c = np.abs(f.rest - e)
        if part.zone == NEAR_C and part.ends.all():
            last = (part.start + part.length)[owner][:, None]
            back = left - side[owner][:, None] * panel.moved(last, -left)
            from_c = np.maximum(back - f.rest * left, 0.0) / s
        if part.zone == STICK:
            more = self._from_c(part)[owner][:, None]
            from_c = (np.maximum(more, 0.0) + ((1.0 - f.rest) * ahead + moved)) / s
        values = function(self._nodes(e, from_c)).reshape(s.shape) * panel(start + ahead) * weight
        if over_s:
            values /= s
        np.add.at(total, part.which, totals(owner, values, len(s0)))


EPS_LIKE = 1e-300  # keeps 0/0 from a quotient of two zeros
