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

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .functions import FlatFunctions
from .panels import INNERMOST, graded, totals
from .uneven_growth import UnevenPanel

Array = NDArray[np.float64]

BEFORE, EDGE, NEAR_C, STICK = range(4)
NEWTONS = 7
NEAR = 0.7  # of a panel's length: nearer to a singularity it is integrated on shrinking panels
TOGETHER = 512  # intervals that are integrated at once: larger arrays cost more
NEAREST = 1e-17  # of the half-width, to a singularity
NO_LESS = 1e-300  # keeps a quotient of two zeros from being nan


class Stretch(NamedTuple):
    """Intervals of s on one panel and in one zone.

    which       the places
    side        1 for those that the right edge reached first, -1 for the others
    start       from the panel's beginning
    length      of each
    E           the distance from the edge at the start
    ends        whether each ends where its zone ends
    """

    panel: UnevenPanel
    zone: int
    which: NDArray[np.intp]
    side: Array
    start: Array
    length: Array
    E: Array
    ends: NDArray[np.bool_]

    def of(self, k: NDArray[np.intp]) -> Stretch:
        """Some of them."""
        start, length, E = self.start[k], self.length[k], self.E[k]
        which, side, ends = self.which[k], self.side[k], self.ends[k]
        return Stretch(self.panel, self.zone, which, side, start, length, E, ends)

    @property
    def s(self) -> Array:
        return self.panel.lo + self.start

    @property
    def rise(self) -> Array:
        """How E grows from the start to the end."""
        panel = self.panel
        rise = panel.length + self.side * panel.whole_shift
        less = (self.start > 0.0) | (self.length < panel.length)
        if less.any():
            moved = panel.moved(self.start[less], self.length[less])
            rise[less] = self.length[less] + self.side[less] * moved
        return rise


class Nodes(NamedTuple):
    """Places of a flat punch: |t|, 1 - |t| and ||t| - c|, and whether t < 0."""

    t: Array
    e: Array
    from_c: Array
    back: NDArray[np.bool_]


class Kernel(NamedTuple):
    """A function of places of the flat, its exponents at t = 1 and t = c, and the power of 1/s."""

    value: Callable[[Nodes], Array]
    at_edge: float = 0.0
    at_c: float = 0.0
    per_s: int = 1


class UnevenSums:
    """The integrals over s as far as each place asks for; `first` is [x1, x2] of first touch."""

    def __init__(
        self, flat: FlatFunctions, panels: tuple[UnevenPanel, ...], first: tuple[float, float]
    ) -> None:
        self.flat, self.panels = flat, panels
        self.base, self.middle = 0.5 * (first[1] - first[0]), panels[0].middle
        # E/s where a zone ends
        self.parts = 0.0, flat.beyond, flat.rest, -1.0

    def sides(self, x: Array) -> Array:
        """1 for places that the right edge reached first, -1 for the others."""
        return np.where(x < self.middle, -1.0, 1.0)

    def pressure(self, x: Array, end: Array) -> Array:
        """p under the contact of half-width `end`, of each x."""
        p = np.zeros(len(x))
        for stretch in self._stretches(x, end):
            self._add_all(p, stretch, self._of_pressure(stretch.zone))
        return p

    def pressure_and_deficit(self, x: Array, end: Array) -> tuple[Array, Array]:
        """p, and f p - q on the side that came first, 0 in slip."""
        p, deficit = np.zeros(len(x)), np.zeros(len(x))
        for stretch in self._stretches(x, end):
            self._add_all(p, stretch, self._of_pressure(stretch.zone))
            if stretch.zone == STICK:
                self._add(deficit, stretch, Kernel(self._deficit, at_c=self.flat.h))
        return p, deficit

    def slip(self, x: Array, end: Array) -> Array:
        """E*/2 times the slip outwards since x came into contact."""
        g = np.zeros(len(x))
        for stretch in self._stretches(x, end):
            self._add_all(g, stretch, self._of_slip(stretch.zone))
        return g

    # -- kernels -----------------------------------------------------------------------------------

    def _of_pressure(self, zone: int) -> tuple[Kernel, ...]:
        f, chi = self.flat, self.flat.weight
        if zone == EDGE:
            return (Kernel(lambda n: f.sine * chi(*n[:3]) * f.Psi(n.t, n.e), -f.h),)
        A = Kernel(lambda n: f.A(n.t, n.e))
        if zone == STICK:
            return (A,)
        return A, Kernel(lambda n: -f.sine * chi(*n[:3]) * f.S_beside_c(n.t, n.e), at_c=f.h)

    def _deficit(self, n: Nodes) -> Array:
        f, back = self.flat, n.back
        values: Array = f.weight(*n[:3]) * f.S(n.t, n.e) / f.beta
        if back.any():  # q is odd
            values[back] = 2.0 * f.friction * f.A(n.t[back], n.e[back]) - values[back]
        return values

    def _of_slip(self, zone: int) -> tuple[Kernel, ...]:
        f, smoother = self.flat, 1.0 - self.flat.h
        near_c, (regular, singular) = f.slip_near_c, f.slip_near_edge
        if zone == EDGE:
            return (
                Kernel(lambda n: regular(n.t, n.e), per_s=0),
                Kernel(lambda n: singular(n.t, n.e) * n.e**smoother, smoother, per_s=0),
            )
        if zone == STICK:
            return ()
        power = 1.0 + f.h
        return (Kernel(lambda n: near_c(n.t, n.e) * n.from_c**power, at_c=power, per_s=0),)

    # -- intervals ---------------------------------------------------------------------------------

    def _stretches(self, x: Array, end: Array) -> Iterator[Stretch]:
        """All intervals of s, panel by panel."""
        side = self.sides(x)
        y = np.abs(x - self.middle)
        y = np.where(y > 0.0, np.maximum(y, INNERMOST * end), 0.0)
        E = self.base - y
        zone = np.full(len(x), STICK)
        for k in (NEAR_C, EDGE):
            zone[self.parts[k] * self.base > E] = k
        zone[E < 0.0] = BEFORE
        for panel in self.panels:
            top = np.minimum(end, panel.hi) - panel.lo
            start, spread = np.zeros(len(x)), panel.length + side * panel.whole_shift
            later = (zone == BEFORE) & (E + spread < 0.0)
            E[later] += spread[later]
            active = (start < top) & ~later
            for k in (BEFORE, EDGE, NEAR_C, STICK):
                i = np.flatnonzero((zone == k) & active)
                if not i.size:
                    continue
                never = np.zeros(len(i), dtype=bool)
                room = Stretch(panel, k, i, side[i], start[i], top[i] - start[i], E[i], never)
                found, rise = _through(room, self.parts[k])
                if k != BEFORE:
                    yield found
                start[i], active[i] = start[i] + found.length, found.ends
                E[i] += rise
                j = i[found.ends]
                zone[j], E[j] = k + 1, self.parts[k] * (panel.lo + start[j])

    # -- integrals ---------------------------------------------------------------------------------

    def _add_all(self, total: Array, stretch: Stretch, kernels: tuple[Kernel, ...]) -> None:
        for kernel in kernels:
            self._add(total, stretch, kernel)

    def _add(self, total: Array, stretch: Stretch, kernel: Kernel) -> None:
        """Adds ∫P' kernel ds of all intervals, of those with the same powers together."""
        panel, zone = stretch.panel, stretch.zone
        left = stretch.length > 0.0
        if zone == STICK:
            far = left & self._far(stretch, kernel)
            self._add_far(total, stretch.of(np.flatnonzero(far)), kernel)
            left &= ~far
        gap, power = stretch.E, kernel.at_edge
        if zone == STICK:
            gap, power = self._from_c(stretch), kernel.at_c
        from_axis = panel.lo == 0.0
        begins = (stretch.start == 0.0) & (panel.power != 0.0 or from_axis)
        own = (gap <= 0.0) & (power != 0.0) & ~(begins & from_axis)
        ends = stretch.ends & (zone == NEAR_C) & (kernel.at_c != 0.0)
        kinds = 4 * own + 2 * begins + ends
        for kind in np.unique(kinds[left]).tolist():
            k = np.flatnonzero(left & (kinds == kind))
            first = power if kind & 4 else 0.0
            if kind & 2:
                first += panel.power - (kernel.per_s if from_axis else 0.0)
            if first <= -1.0:
                total[stretch.which[k]] = np.inf
                continue
            powers = first, kernel.at_c if kind & 1 else 0.0
            for few in (k[j : j + TOGETHER] for j in range(0, len(k), TOGETHER)):
                self._add_graded(total, stretch.of(few), kernel, powers)

    def _far(self, stretch: Stretch, kernel: Kernel) -> NDArray[np.bool_]:
        """Which intervals are whole panels, far from all singularities."""
        panel = stretch.panel
        gap = self._from_c(stretch) if kernel.at_c else stretch.E
        far = (stretch.length == panel.length) & (gap >= NEAR * panel.length)
        far &= (1.0 + self.flat.c) * panel.hi - stretch.E >= 3.0 * panel.length
        return far & (panel.lo > 0.0)

    def _from_c(self, stretch: Stretch) -> Array:
        """s (c - t) at the start of intervals in stick."""
        return stretch.E - self.flat.rest * stretch.s

    def _nodes(self, e: Array, from_c: Array) -> Nodes:
        """Places of the flat, given 1 - t and |t - c|."""
        t = 1.0 - e
        back = t < 0.0
        if back.any():
            t, from_c = np.abs(t), np.where(back, self.flat.c - np.abs(t), from_c)
            e = np.where(back, 1.0 - t, e)
        return Nodes(t.ravel(), e.ravel(), from_c.ravel(), back.ravel())

    def _add_far(self, total: Array, stretch: Stretch, kernel: Kernel) -> None:
        """Adds the integrals over whole panels by one rule."""
        panel, (inside, mass) = stretch.panel, stretch.panel.places
        if stretch.which.size:
            s = panel.lo + inside
            moved = stretch.side[:, None] * panel.moved_at_places
            e = (stretch.E[:, None] + (inside + moved)) / s
            values = kernel.value(self._nodes(e, np.abs(self.flat.rest - e))).reshape(e.shape)
            total[stretch.which] += values @ (mass / s**kernel.per_s)

    def _singular(self, part: Stretch, kernel: Kernel) -> tuple[Array, Array, Array]:
        """The distances of the next singularities before and after, and where P' is smooth."""
        f, s, hi = self.flat, part.s, part.s + part.length
        before = np.full(len(s), np.inf)
        if part.panel.power:
            before = np.where(part.start > 0.0, part.start, np.inf)
        near, gap = np.minimum(before, s), part.E
        if part.zone == STICK and kernel.at_c:
            from_c = self._from_c(part)
            gap = np.where(from_c > 0.0, from_c, part.E)
        # E grows by less than twice what s does
        before = np.minimum(before, np.where(gap > 0.0, 0.5 * gap, np.inf))
        after, end = np.full(len(s), np.inf), part.E + part.rise
        if part.zone == NEAR_C and kernel.at_c:
            after = np.where(part.ends, part.length, f.rest * hi - end)
        elif part.zone == STICK:
            after = 0.5 * ((1.0 + f.c) * hi - end)
        return np.maximum(before, NEAREST * s), np.maximum(after, NEAREST * hi), near

    def _add_graded(
        self, total: Array, part: Stretch, kernel: Kernel, powers: tuple[float, float]
    ) -> None:
        """Adds the integrals of intervals with the same powers at their ends."""
        rest, panel = self.flat.rest, part.panel
        before, after, near = self._singular(part, kernel)
        owner, ahead, left, weight = graded(part.length, before, after, powers, near=near)
        start, side = part.start[owner][:, None], part.side[owner][:, None]
        s, moved = (panel.lo + start) + ahead, side * panel.moved(start, ahead)
        e = (part.E[owner][:, None] + (ahead + moved)) / s
        from_c = np.abs(rest - e)
        if part.zone == NEAR_C and powers[1]:
            last = (part.start + part.length)[owner][:, None]
            back = left - side * panel.moved(last, -left)
            from_c = np.maximum(back - rest * left, 0.0) / s
        if part.zone == STICK:
            more = np.maximum(self._from_c(part), 0.0)[owner][:, None]
            from_c = (more + ((1.0 - rest) * ahead + moved)) / s
        values = kernel.value(self._nodes(e, from_c)).reshape(s.shape)
        values *= panel(start + ahead) * weight / s**kernel.per_s
        np.add.at(total, part.which, totals(owner, values, len(part.which)))


def _through(room: Stretch, part: float) -> tuple[Stretch, Array]:
    """The intervals until E = part s, or as far as there is room; and how E grows."""
    rise, panel = room.rise, room.panel
    missed = room.E - part * room.s
    over = missed + rise - part * room.length
    k = np.flatnonzero(over >= 0.0) if part >= 0.0 else np.zeros(0, dtype=np.intp)
    if not k.size:
        return room, rise
    start, side, most, missed = room.start[k], room.side[k], room.length[k], missed[k]
    d = most * np.clip(missed / (missed - over[k] - NO_LESS), 0.0, 1.0)
    for _ in range(NEWTONS):
        ahead = d + side * panel.moved(start, d)
        rate = 1.0 - part + side * panel.rate(start + d)
        d = np.clip(d - (missed + ahead - part * d) / rate, 0.0, most)
    length, ends = room.length.copy(), over >= 0.0
    length[k] = d
    return room._replace(length=length, ends=ends), rise
