"""The march of a contact in which a slip zone has opened at the old edge, over growing Q.

With s = -b - x1 as time the conditions of `opened_state` determine h1, h2, e2, x2 and γ at x1,
which stays where it was touched: γ is a polynomial in ln s on panels, whose values at Radau's
points, with the zones there, are found by Newton's and Broyden's methods. Before the zone opened γ
is that of `spreading_contact`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.progress_bar import step_done

from .opened_gradient import GradientPanel, KeptGradient, between
from .opened_search import SlidingOf
from .opened_state import OpenedState
from .opened_zones import OpenedZones

Array = NDArray[np.float64]

POINTS = 8  # of a panel
STRIP = 1e-11  # of s: the strip that makes exponents real, about the error of what is found
FIRST, LONGER, LONGEST = 1.1, 2.0, 1.35  # of s; of s since the zone opened; of s: panels
SHORTER = 0.5  # of what still sticks beside the edge: what a panel may take
CLOSED = 1e-6  # of s: less that sticks beside the edge moves x1 by a sixth of it
NEAR_END, SURELY = 0.05, 3.0  # of s; times the load at which a straight line has it end
STEP, SETTLED, ROUGH, STALLED = 1e-6, 2e-10, 1e-7, 0.5  # of the unknowns, and of the last step
FARTHEST, STEPS = 1.0, 14  # of the logarithms, a step; steps
AGAIN = 0.3  # of the last step: derivatives are taken anew if a step is longer
FEW = 4  # points by which guesses are continued
OPENING, OPENING_STEPS, NEARLY = (1e-4, 5e-5), 40, 1e-2  # of b: the slip zone at first


class OpenedPoint(NamedTuple):
    """Zones at s: ln of (c - e2)/s, (b - x2)/s, -h1/b and h2/b from the old edge, and Q."""

    s: float
    logs: Array
    Q: float


class OpenedMarch:
    """The march, panel by panel, from the s at which the zone opens.

    kept        γ as far as it is known
    start       s, Q, and ln of (c - e2)/s and (b - x2)/s where the zone opens
    slopes      of these logarithms with ln s before
    sliding     computes p_s
    unseen      of s: the strip of old slip at the edge that is left out
    ended       whether nothing sticks beside the edge under the load that was asked for
    """

    def __init__(
        self, kept: KeptGradient, start: OpenedPoint, slopes: Array, sliding: SlidingOf
    ) -> None:
        self.kept, self.search, self.start = kept, kept.search, start
        self.slopes, self.sliding = slopes, sliding
        self.ended, self.unseen = False, 0.0
        self.jumps: list[tuple[float, float]] = []
        self.s = start.s
        self._last: tuple[OpenedPoint, ...] = ()
        self._hole = np.log(OPENING)
        self._J: Array | None = None

    # -- states ------------------------------------------------------------------------------------

    def zones(self, s: float, logs: Array) -> OpenedZones:
        normal = self.search.normal
        b, (e2, e3, g1, g2) = normal.b, np.exp(logs).tolist()
        strip = STRIP * s
        return OpenedZones(strip, -s, -b * g1, b * g2, b + normal.c - s * e2, 2.0 * b - s * e3)

    def state(
        self, s: float, logs: Array, panel: GradientPanel | None = None, *, fine: bool = False
    ) -> OpenedState:
        """The state at s; γ at the nodes of a panel takes columns of its own."""
        zones, kept = self.zones(s, logs), self.kept

        def gamma(y: Array) -> Array:
            columns = np.zeros((len(y), 1 if panel is None else 1 + len(panel.nodes)))
            own = y < (-math.inf if panel is None else -panel.lo)
            columns[~own, 0] = kept(y[~own])
            if panel is not None:
                rows = between(panel.nodes, np.log(np.minimum(-y[own], s)))
                columns[own, 1:], columns[own, 0] = rows, rows @ panel.values
            return columns

        before = kept.integral(zones.h1, zones.h2)
        lows = [p.lo for p in kept.panels if p.lo >= self.start.s]
        own = [] if panel is None else [panel.lo]
        cuts = np.concatenate(
            (self.search.gamma.cuts + self.search.normal.b, -np.array(lows + own))
        )
        return OpenedState(self.search, self.sliding, zones, gamma, cuts, before=before, fine=fine)

    # -- panels ------------------------------------------------------------------------------------

    def advanced(self, hi: float) -> tuple[GradientPanel, list[OpenedPoint]]:
        """The panel from where the march is up to hi, and its points."""
        lo = self.s
        nodes = math.log(lo) + math.log(hi / lo) * _radau(POINTS)
        s = np.exp(nodes)
        logs = np.array([self._guess(one) for one in s.tolist()])
        if self._last:
            last, few = self.kept.panels[-1], slice(-FEW, None)
            first = between(last.nodes[few], nodes) @ last.values[few]
        else:
            first = self.kept.continued(nodes)
        return self._solved(GradientPanel(lo, hi, nodes, first), logs, None)

    def shortened(
        self, panel: GradientPanel, points: list[OpenedPoint], hi: float
    ) -> tuple[GradientPanel, list[OpenedPoint]]:
        """The panel up to a smaller hi, from the one that goes on beyond it."""
        nodes = math.log(panel.lo) + math.log(hi / panel.lo) * _radau(POINTS)
        logs = np.array([self._between(points, s) for s in np.exp(nodes).tolist()])
        shorter = GradientPanel(panel.lo, hi, nodes, panel(np.exp(nodes)))
        return self._solved(shorter, logs, self._J)

    def _solved(
        self, panel: GradientPanel, logs: Array, J: Array | None
    ) -> tuple[GradientPanel, list[OpenedPoint]]:
        """The panel that meets the conditions at its nodes, by Broyden's steps."""
        s, stress, before = np.exp(panel.nodes).tolist(), self.search.stress, math.inf
        states = [self.state(a, y, panel) for a, y in zip(s, logs, strict=True)]
        fresh = False
        for _ in range(STEPS):
            now = np.concatenate([state.missed[:, 0] for state in states])
            if not np.isfinite(now).all():
                break
            if J is None:
                J, fresh = self._jacobian(s, logs, panel, states), True
            try:
                step = -np.linalg.solve(J, now)
            except np.linalg.LinAlgError:
                break
            of_logs, of_gamma = step[: logs.size].reshape(logs.shape), step[logs.size :]
            farthest = float(np.abs(of_logs).max())
            size = max(farthest, float(np.abs(of_gamma).max()) / stress)
            if size > AGAIN * before and not fresh:
                J, before = None, math.inf
                continue
            part = min(1.0, FARTHEST / farthest)
            logs = logs + part * of_logs
            panel = panel._replace(values=panel.values + part * of_gamma)
            states = [self.state(a, y, panel) for a, y in zip(s, logs, strict=True)]
            if size < SETTLED or (size < ROUGH and size > STALLED * before):
                self._J = J
                points = zip(s, logs, states, strict=True)
                return panel, [OpenedPoint(a, y, float(one.load[0])) for a, y, one in points]
            later = np.concatenate([state.missed[:, 0] for state in states])
            step = part * step
            J = J + np.outer(later - now - J @ step, step) / (step @ step)
            fresh = part < 1.0 and fresh
            before = size
        raise ContactError(f"the march ends where the contact gained {panel.lo:.6g}")

    def _jacobian(
        self, s: list[float], logs: Array, panel: GradientPanel, states: list[OpenedState]
    ) -> Array:
        """The derivatives of the conditions, by the logarithms and by γ at the nodes."""
        n, m = logs.shape
        k = m + 1
        J = np.zeros((n * k, n * k))
        for i, (at, own) in enumerate(zip(s, states, strict=True)):
            rows = slice(i * k, (i + 1) * k)
            J[rows, n * m :] = own.missed[:, 1:]
            for j in range(m):
                moved = logs[i].copy()
                moved[j] += STEP
                change = self.state(at, moved, panel).missed[:, 0] - own.missed[:, 0]
                J[rows, i * m + j] = change / STEP
        return J

    def _guess(self, s: float) -> Array:
        """The logarithms at s, continued from the last panel."""
        so = self.start.s
        if not self._last:
            smooth = self.start.logs[:2] + self.slopes * math.log(s / so)
            self._hole = self._first_zone(s, smooth, self._hole)
            return np.append(smooth, self._hole)
        return self._between(self._last[-FEW:], s)

    def _between(self, points: Sequence[OpenedPoint], s: float) -> Array:
        """The logarithms at s by polynomials through some points."""
        at, logs = np.log([p.s for p in points]), np.array([p.logs for p in points])
        smooth = between(at, np.array([math.log(s)])) @ logs[:, :2]
        so = self.start.s
        since = np.log([p.s - so for p in points])
        opened = between(since, np.array([math.log(s - so)])) @ logs[:, 2:]
        guess: Array = np.append(smooth, opened)
        return guess

    def _first_zone(self, s: float, smooth: Array, hole: Array) -> Array:
        """h1 and h2 just after the zone opened, the other edges given."""
        for _ in range(OPENING_STEPS):
            now = self.state(s, np.append(smooth, hole)).missed[3:, 0]
            J = np.empty((2, 2))
            for j in range(2):
                moved = hole.copy()
                moved[j] += 10.0 * STEP
                J[:, j] = self.state(s, np.append(smooth, moved)).missed[3:, 0] - now
            step = -np.linalg.solve(J / (10.0 * STEP), now)
            size = float(np.abs(step).max())
            hole = hole + min(1.0, 0.7 / size) * step
            if size < NEARLY:
                return hole
        raise ContactError(f"no slip zone is found where the contact gained {s:.6g}")

    def take(self, panel: GradientPanel, points: list[OpenedPoint]) -> None:
        self.jumps.append((panel.lo, self.jump(panel)))
        self.kept, self._last = self.kept.with_panel(panel), tuple(points)
        self.s = panel.hi
        step_done()

    # -- the march ---------------------------------------------------------------------------------

    @property
    def stuck(self) -> float:
        """What sticks beside the edge, over s."""
        return self._stuck(self._last[-1]) if self._last else 1.0

    def _stuck(self, point: OpenedPoint) -> float:
        return 1.0 - self.search.normal.b * math.exp(float(point.logs[2])) / point.s

    @property
    def closed(self) -> bool:
        """Whether nothing sticks beside the edge any more."""
        return self.stuck < CLOSED

    def ends_before(self, Q: float) -> bool:
        """Whether nothing sticks beside the edge under Q, by how that falls with the load."""
        if len(self._last) < 2 or self.stuck > NEAR_END:
            return False
        one, other = self._last[-2:]
        fall = (self._stuck(one) - self._stuck(other)) / (other.Q - one.Q)
        return fall > 0.0 and other.Q + SURELY * self.stuck / fall < Q

    @property
    def last(self) -> OpenedPoint:
        """Where the march is."""
        return self._last[-1] if self._last else self.start

    def jump(self, panel: GradientPanel) -> float:
        """By how much γ differs where a panel goes on from the last one, over the mean of f p."""
        at = np.array([panel.lo])
        gap = float((panel(at) - self.kept.panels[-1](at))[0])
        return abs(gap) / self.search.stress

    def next_end(self) -> float:
        """Where the next panel ends."""
        so, s = self.start.s, self.s
        if not self._last:
            return s * FIRST
        hi = min(so + LONGER * (s - so), LONGEST * s)
        one, other = self._last[-2:]
        rate = (self._stuck(other) - self._stuck(one)) / (other.s - one.s)
        if rate < 0.0:
            left = self.stuck
            hi = min(hi, s - SHORTER * left / rate, s * (1.0 + SHORTER * left))
        return hi


def _radau(n: int) -> Array:
    """Radau's points on 0 < x <= 1."""
    c = np.zeros(n + 1)
    c[n], c[n - 1] = 1.0, -1.0
    roots: Array = np.sort(np.polynomial.legendre.legroots(c).real)
    return 0.5 * (1.0 + roots)
