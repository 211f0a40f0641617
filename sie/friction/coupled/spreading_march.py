"""The march of a contact that spreads under Q over what sticks as it is touched.

With s, how far the left edge has advanced beyond -b, as time, three conditions give w = dQ/ds and
the ways ε2 and ε3 of the right end of the stick zone and of the right edge,

    H p = E*/2 h' at x1,        p = 0 at x2,        f p - q = 0 at e2,

integrals over all s' < s (`spreading_history`). Their logarithms are series in ln s, on panels that
grow in proportion, found by collocation and Broyden's steps. The first panel goes from s = 0 to a
small part of s under Q, as two powers: how it errs is forgotten like a power of s.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS
from sie.problem.coverage import LargerLoad
from sie.progress_bar import step_done

from .broyden import STEP, zero
from .spreading_beginning import Beginning
from .spreading_history import SpreadingHistory
from .spreading_zones import SEEN, Places, SpreadingPanel

Array = NDArray[np.float64]

DEGREE, RATIO = 9, 3.0  # of a panel: terms, and how much s grows on it
# Of s under Q: the first panel; the square of it over that of a way of 1 b, by which it errs
START, LATEST, STARTS = 1e-5, 1e-2, 3e-12
FORGOTTEN = 1.5  # the power of s with which errors are forgotten, or more
LARGE = 1e-2  # half-widths of a way, with whose root goes what Q adds to the tractions
GAIN = 1.3  # of β Q/P half-widths: about s under Q
SPREAD = 0.9  # of s: ε3 at first, about
NARROW_STICK = 0.2  # half-widths: under P alone
FIRST_POINTS = 0.25, 1.0  # of the first panel
POWERS = 0.2, 0.7  # of ε2 and ε3 with s at first, about
# Of a logarithm: the last step, at the load; it may be as much longer as s is less; roundings of b
SETTLED, ROUNDINGS = 2e-13, 8.0
EXTRAPOLATED, ALIKE = 4, 1.5  # terms, on a panel that is at most so much longer in ln s
ROUNDS = 12  # of what the panels before add
# Of a logarithm: moved by less, what the panels before add is linear to rounding; before, a step is
# a part of the last one
LINEAR, NEAR, ROUGHLY = 1e-7, 1e-3, 1e-2
CUT, SHORTEST, LONGER = 0.3, 0.02, 1.6  # of a panel in ln s
DECAYED, NOISE = 1e-9, 64.0  # of the last coefficients of a panel that is not cut; roundings of b
MOST, MOST_SUMS = 60, 1800  # panels; times that sums on a panel are taken, of 5 to 10 ms each
ON_ONE = 120  # of them on one panel, before it is cut
NEXT, BEYOND = 1.02, 1.2  # the last panel goes on beyond the s at which Q seems to be reached
EXCEEDED = 1e-6  # of f p at the old edge, by how much q is more
OPEN = "a slip zone is open at the old edge, inside the stick zone"
WIDEST = 0.8  # half-widths: how far the march goes


class Known(NamedTuple):
    """What is known of the conditions at the nodes of a panel.

    steepness   of the gap at x1 under P alone
    taken       what the panels before take of it
    logs        ln ε2 and ln ε3
    values      of `SpreadingMarch._before` at these
    slopes      of the values
    """

    steepness: Array
    taken: Array
    logs: Array
    values: Array
    slopes: Array

    def before(self, logs: Array, own: tuple[Array, Array]) -> tuple[Array, Array]:
        """f p - q at e2 and p at x2: what panels add, with what this one does, and under P."""
        added, alone = self.values + self.slopes * (logs - self.logs)
        return added + np.array(own), np.exp(alone)


class SpreadingMarch:
    """The march, panel by panel."""

    def __init__(self, beginning: Beginning, kinks: tuple[float, ...] = (), n: int = DEGREE):
        self.beginning, self.normal, self.n = beginning, beginning.normal, n
        self.kinks = sorted(k for k in kinks if k > 0.0)
        self.history = SpreadingHistory(beginning.rates, beginning.normal.b, beginning.rest)
        self._jacobian: Array | None = None
        self._far, self._ended, self._sums = 0.0, 0.0, 0

    def expected(self, Q: float) -> float:
        """About s under Q."""
        return GAIN * self.normal.flat.beta * Q / self.normal.load * self.normal.b

    @property
    def moved(self) -> float:
        """About how far the zones move up to Q, over b."""
        return (self._far + self._expected_way(self._far)[0]) / self.normal.b

    @property
    def lenience(self) -> float:
        """How much more parts of small changes may err than those of large ones."""
        return max(1.0, math.sqrt(LARGE / self.moved))

    def _expected_way(self, s: float) -> tuple[float, float]:
        """About ε2 at a small s, and the power with which it goes.

        Where c is small, the slip zones being wide, f p - q under P alone is about f p (ε2/c)^(3/2)
        up to x = 0, and 2 f p beyond, and q̇ = 1/π (e2 - x)^(-1/2) b^(-1/2).
        """
        normal, c, b = self.normal, self.history.c, self.normal.b
        if c > NARROW_STICK * b:
            return 1.6 * s + math.sqrt(s * self.beginning.rest), POWERS[0]
        before = self.beginning.friction * float(normal.pressure(np.array([0.1 * b]))[0])
        load = 1.0 / (self.expected(1.0) * before)
        way = 0.9 * math.sqrt(load * s * c * math.sqrt(c / b))
        if way < c:
            return way, 0.5
        back = (0.25 * load * s) ** 2 / b
        return c + back, 2.0 * back / (c + back)

    def _early(self, s: float) -> float:
        """How much more what happens at s may err than at the load."""
        return max(self._far / s, 1.0) ** FORGOTTEN

    def started(self, far: float) -> None:
        """The first panel where s is about `far` under Q."""
        self._far, b = far, self.normal.b
        s = far * min(max(START, math.sqrt(STARTS / self.moved)), LATEST)
        at = s * np.array(FIRST_POINTS)
        e2, power = self._expected_way(s)
        self.history.width = self.history.strip_width(s, e2, SPREAD * s)
        self.history.strip = self.history.width > SEEN * b
        # Where the slip zone was narrow all ways go with s at once
        for powers, middle in (((power, POWERS[1]), s), ((1.0, 1.0), math.sqrt(at[0] * at[1]))):
            ways = (self._expected_way(middle)[0], powers[0]), (SPREAD * middle, powers[1])
            found = self._first(at, ways)
            if found is not None:
                self.history.panels = (found,)
                return
        raise ContactError("no state is found from which to follow it over smaller loads")

    def _first(self, at: Array, ways: tuple[tuple[float, float], ...]) -> SpreadingPanel | None:
        """The first panel from guesses of the ways and of their powers."""
        half = 0.5 * math.log(at[1] / at[0])
        series = np.array([[0.0, 0.0], *([math.log(e), half * power] for e, power in ways)])
        panel = SpreadingPanel(at[0], at[1], series, True)
        with np.errstate(all="ignore"):
            missed = self._missed(panel, at, self._known(panel, at))
            if missed[1] < 1.0:
                series[0, 0] -= math.log(1.0 - missed[1])
            return self._solved(SpreadingPanel(at[0], at[1], series, True), at)

    def marched(self, Q: float) -> float:
        """Panels up to the load Q; s there."""
        self.started(self.expected(Q))
        return self.onward(Q)

    def onward(self, Q: float) -> float:
        """The same from the panels on that are known."""
        history, b = self.history, self.normal.b
        while (load := history.load(math.inf)) < Q:
            last = history.panels[-1]
            if last.hi > WIDEST * b or len(history.panels) > MOST:
                raise ContactError(
                    f"the contact gained {last.hi:.3g} under |Q| = {load:.6g}, where the march ends"
                )
            self._refuse_open(last.hi)
            ahead = (Q - load) / float(last(np.array([last.hi]))[0][0])
            self._advance(last, last.hi * NEXT + BEYOND * ahead)
            step_done()
        return self._at_load(Q)

    def _refuse_open(self, s: float) -> None:
        """Raises LargerLoad if q exceeds f p at the old edge, where both are 0 under P alone."""
        b, c = self.normal.b, self.history.c
        from_b, to_c, to_b, at = np.array([[0.0], [b + c], [2.0 * b], [s]])
        places = Places(from_b, to_c, to_b, at)
        p, r, _ = self.history.inside(places)[:, 0]
        if not r > -EXCEEDED * self.beginning.friction * p:
            raise LargerLoad(OPEN)

    def missed(self, s: float) -> float:
        """What the conditions miss at s, which is no node, over what they are at b from an edge.

        Their known parts go with the root of the ways, or count only so near to e2.
        """
        history, panel = self.history, self.history.panel_of(s)
        kept, at = history.panels, np.array([s])
        history.panels = tuple(p for p in kept if p.hi <= panel.lo)
        try:
            gaps = self._missed(panel, at, self._known(panel, at))
        finally:
            history.panels = kept
        ways = np.array([s, *self.history.zones(s)[::-1]])
        return float((np.abs(gaps) * np.sqrt(ways / self.normal.b)).max())

    def _at_load(self, Q: float) -> float:
        panel = self.history.panels[-1]
        before = self.history.load(panel.lo)
        lo, hi = math.log(panel.lo), math.log(panel.hi)
        for _ in range(60):
            middle = 0.5 * (lo + hi)
            if before + self.history.load_on(panel, math.exp(middle)) < Q:
                lo = middle
            else:
                hi = middle
        return math.exp(0.5 * (lo + hi))

    def _advance(self, last: SpreadingPanel, enough: float) -> None:
        """One more panel, which need not go on beyond `enough`."""
        # As long as the last one, or longer, if that had to be cut
        fold = math.log(RATIO)
        if not last.first and last.hi != self._ended:
            fold = min(fold, LONGER * last.length)
        lo, hi = last.hi, min(last.hi * math.exp(fold), enough)
        ahead = [k - self.normal.b for k in self.kinks if k - self.normal.b > lo * (1.0 + 1e-9)]
        hi = min(hi, *ahead) if ahead else hi
        whole, stopped = hi, (hi if ahead else 0.0)
        while True:
            found = self._panel(last, lo, hi)
            if found is not None:
                tail = float(np.abs(found.series[:, -2:]).max())
                noise = NOISE * EPS * self.normal.b / lo
                if tail < max(DECAYED * self._early(lo) * self.lenience, noise):
                    break
                if math.log(hi / lo) < SHORTEST:
                    break
                # The right edge enters what stuck under P alone, or slip the left half of it, where
                # γ has a kink
                end = self._entry(found)
                if lo * 1.01 < end < hi * 0.99:
                    hi = stopped = end
                    continue
            elif math.log(hi / lo) < SHORTEST:
                raise ContactError(f"the march ends where the contact gained {lo:.6g}")
            hi = lo * (hi / lo) ** CUT
        if hi < whole:
            self._jacobian = None
        self._ended = hi if hi == stopped else 0.0
        self.history.panels = (*self.history.panels, found)
        self.history.width = self.history.strip_width(hi, *self.history.zones(hi))

    def _entry(self, panel: SpreadingPanel) -> float:
        """The s on the panel at which ε3 = b - c, or else ε2 = c, or 0."""
        y = np.linspace(-1.0, 1.0, 65)
        for row, aim in ((2, self.beginning.rest), (1, self.normal.c)):
            way = chebyshev.evaluate(panel.series[row], y) - math.log(aim)
            k = np.flatnonzero((way[:-1] < 0.0) & (way[1:] >= 0.0))
            if k.size:
                i = int(k[0])
                part = y[i] - way[i] * (y[i + 1] - y[i]) / (way[i + 1] - way[i])
                return panel.lo * math.exp(0.5 * panel.length * (1.0 + part))
        return 0.0

    def _panel(self, last: SpreadingPanel, lo: float, hi: float) -> SpreadingPanel | None:
        """The panel that goes on like the last one at first."""
        half, n = 0.5 * math.log(hi / lo), self.n
        s = lo * np.exp(half * (1.0 + chebyshev.points(n)))
        # A short panel tells little of a longer one
        terms = EXTRAPOLATED if 2.0 * half < ALIKE * last.length else 2
        rough = chebyshev.points(min(terms, last.series.shape[1]))
        few = chebyshev.transform(np.array([chebyshev.evaluate(c, rough) for c in last.series]))
        y = last.variable(s)
        series = chebyshev.transform(np.array([chebyshev.evaluate(c, y) for c in few]))
        with np.errstate(all="ignore"):
            return self._solved(SpreadingPanel(lo, hi, series), s)

    # -- collocation -------------------------------------------------------------------------------

    def _missed(self, panel: SpreadingPanel, s: Array, known: Known) -> Array:
        """What the conditions miss, over their known parts."""
        history = self.history
        _, e2, e3 = panel(s)
        kept = history.panels
        history.panels = (*kept, panel)
        try:
            at_x1 = history.beside(history.at("x1", s, e2, e3), (panel,)).real
            at_x2 = history.inside(history.at("x2", s, e2, e3), (panel,))[0]
            at_e2 = history.inside(history.at("e2", s, e2, e3), (panel,))[1]
        finally:
            history.panels = kept
        (at_e2, at_x2), (r, p) = known.before(np.log(np.array([e2, e3])), (at_e2, at_x2))
        at_x1 = at_x1 + known.taken
        return np.concatenate((1.0 + at_x1 / known.steepness, 1.0 + at_x2 / p, 1.0 + at_e2 / r))

    def _before(self, panel: SpreadingPanel, s: Array, logs: Array) -> Array:
        """f p - q at e2 and p at x2 for ln ε2 and ln ε3, before this panel adds to them.

        They are what the panels before it add, and the logarithms of those under P alone.
        """
        (e2, e3), history = np.exp(logs), self.history
        kept = history.panels
        history.panels = (*kept, panel)
        try:
            at_x2 = history.inside(history.at("x2", s, e2, e3), kept)[0]
            at_e2 = history.inside(history.at("e2", s, e2, e3), kept)[1]
        finally:
            history.panels = kept
        alone = self.beginning.deficit(self.normal.c - e2), self.beginning.pressure(e3)
        return np.array([[at_e2, at_x2], np.log(alone)])

    def _solved(self, panel: SpreadingPanel, s: Array) -> SpreadingPanel | None:
        """The panel whose series meet the conditions at these s.

        What the panels before add is linear in ln ε2 and ln ε3 of each place, until these move by
        little.
        """
        gap, settled = 1.0, self._settled(float(s.min()))
        if panel.first:
            return self._iterated(panel, s, None, settled)
        known = self._known(panel, s)
        rounding = ROUNDINGS * EPS * self.normal.b / float(s.min())
        step, linear = max(STEP, math.sqrt(rounding)), max(LINEAR, settled)
        moved = self._before(panel, s, known.logs + step)
        known = known._replace(slopes=(moved - known.values) / step)
        most = self._sums + ON_ONE
        for _ in range(ROUNDS):
            if self._sums > most:
                return None
            finish = gap < NEAR
            found = self._iterated(panel, s, known, settled if finish else ROUGHLY * gap)
            if found is None:
                return found
            panel, logs = found, np.log(np.array(found(s)[1:]))
            way = logs - known.logs
            gap = float(np.abs(way).max())
            if finish and gap < linear:
                return panel
            values = self._before(panel, s, logs)
            if not np.isfinite(values).all():
                return None
            far = np.abs(way) > linear
            secant = (values - known.values) / np.where(far, way, 1.0)
            slopes = np.where(far, secant, known.slopes)
            known = known._replace(logs=logs, values=values, slopes=slopes)
        return None

    def _known(self, panel: SpreadingPanel, s: Array) -> Known:
        """What is known at the zones of the panel, with no slopes yet."""
        logs, at = np.log(np.array(panel(s)[1:])), self.history.at("x1", s, s, s)
        values = self._before(panel, s, logs)
        taken = self.history.beside(at).real
        return Known(self.beginning.steepness(s), taken, logs, values, 0.0 * values)

    def _settled(self, s: float) -> float:
        return max(SETTLED * self._early(s) * self.lenience, ROUNDINGS * EPS * self.normal.b / s)

    def _iterated(
        self, panel: SpreadingPanel, s: Array, known: Known | None, settled: float
    ) -> SpreadingPanel | None:
        """The panel that meets the conditions by Broyden's steps; None known: as it is there."""
        n = len(s)
        T = chebyshev.polynomials(n, panel.variable(s)).T
        values, back = (panel.series @ T.T).ravel(), np.linalg.inv(T)

        def of(values: Array) -> SpreadingPanel:
            return SpreadingPanel(panel.lo, panel.hi, values.reshape(3, n) @ back.T, panel.first)

        def missed(values: Array) -> Array:
            self._sums += 1
            if self._sums > MOST_SUMS:
                raise ContactError(
                    f"the march takes more than {MOST_SUMS} steps where the contact gained "
                    f"{panel.lo:.3g}"
                )
            trial = of(values)
            return self._missed(trial, s, known or self._known(trial, s))

        J = None if panel.first else self._jacobian
        found = zero(missed, values, J if J is not None and len(J) == 3 * n else None, settled)
        if found is None:
            return None
        if not panel.first:
            self._jacobian = found[1]
        return of(found[0])
