"""A step in which one end of the stick zone recedes, and the other is an edge that grows and sticks.

With s the slip at the end u that recedes, ξ the coordinate from there to the edge b(t) of contact,
and q = s f (p - q*), the part q* vanishes where it slips and changes in the stick zone [u, b] by

    dq*/dt = [A/π - B (ξ - μ)]/sqrt((ξ - u)(b - ξ)),    A = dP - s dQ/f,    B = G dθ - s dτ/f,

μ the centre and ρ the half-width of the zone. A point that the edge brings into contact has q* = 0.
The end arrives at ξ when q* is 0 there: an equation of Abel's kind for the time t(u),

    q*0(u) + ∫ [A/π - B (u - (v + b)/2)]/sqrt((u - v)(b - u)) dt(v) = 0,

with b = b(t). Time is a series in the root of the distance on each panel; it begins like
the root where the edge nearly slips from the start. The edge sticks while

    0 <= (A - π B ρ) sqrt(r/ρ) <= 2 (dP - π G r dθ),

r the half-width of contact; beyond it slips by s below, by -s above. The slip at u is that of the
stick zone's layer. `BothStick` has the state where neither edge slips.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.graded_rule import NODES
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import false_position

from .growing_contact import Course, Rates, divided
from .marched_step import FrozenEdge, Held, MarchedStep, places
from .slip_onset import Onset
from .travelling_zone import FALL, RISE, WEIGHT

Array = NDArray[np.float64]
Rule = tuple[Array, Array, Array]

TERMS, FEWER = 16, 12  # of the time on a panel, and of what it is judged by
RESOLVED = 1e-12  # of ρ: what the last terms of a panel leave of its end
FIRST, SHORTEST = 0.05, 1e-8  # of ρ: the first panel, and one that goes to a mark in any case
MOST_STEPS, SETTLED = 12, 1e-14
MOST_PANELS = 300
TOGETHER = 40_000  # values at a time
SAME = 1e-12  # of a half-width: places that are nearer to each other are one
WATCHED = 0.5 * (1.0 + np.linspace(-1.0, 1.0, 17))  # of a panel: where it is seen whether it sticks
WORK_NODES = 10
_g, _w = chebyshev.gauss_legendre(NODES)
STEADY = np.ones(2)  # of M, for time in proportion to the distance
HALVINGS, NEWTON, TINY = 8, 6, 1e-12  # for w at a time
GRADED: Rule = (RISE, FALL, WEIGHT)
ROUGH: Rule = (np.sin(0.5 * math.pi * _g) ** 2, np.cos(0.5 * math.pi * _g) ** 2, 0.5 * math.pi * np.sin(math.pi * _g) * _w)
PLAIN: Rule = (_g**2, (1.0 - _g) * (1.0 + _g), 2.0 * _g * _w)


@dataclass(frozen=True, eq=False)
class Panel:
    """t = time + length w M, M = Σ c_n T_n(2w - 1), w² = (u - start)/length, up to w = `last`."""

    start: float
    length: float
    time: float
    series: Array
    last: float = 1.0

    @property
    def end(self) -> float:
        return self.start + self.length * self.last**2

    @property
    def until(self) -> float:
        """The time at the end."""
        return float(self.times(np.array(self.last)))

    def times(self, w: Array) -> Array:
        grown: Array = self.length * w * chebyshev.evaluate(self.series, 2.0 * w - 1.0)
        return self.time + grown

    def pace(self, w: Array) -> Array:
        """dt/du."""
        pace: Array = chebyshev.evaluate(self._doubled, 2.0 * w - 1.0) / (2.0 * w)
        return pace

    @cached_property
    def _doubled(self) -> Array:
        """M + w dM/dw as a series."""
        s = chebyshev.points(len(self.series))
        slope = divided(self.series, s, s)
        return chebyshev.transform(chebyshev.evaluate(self.series, s) + (1.0 + s) * slope)

    def root(self, time: Array) -> Array:
        """w at times, by halving and Newton's method."""
        lo, hi = np.zeros(time.shape), np.full(time.shape, self.last)
        for _ in range(HALVINGS):
            middle = 0.5 * (lo + hi)
            later = self.times(middle) > time
            lo, hi = np.where(later, lo, middle), np.where(later, middle, hi)
        w = 0.5 * (lo + hi)
        for _ in range(NEWTON):
            step = (self.times(w) - time) / (2.0 * self.length * w * self.pace(w))
            w = np.clip(w - step, TINY, self.last)
        return w


@dataclass(frozen=True, eq=False)
class Zone:
    """A stick zone in the direction from the end that recedes to the edge that grows.

    course      the contact
    direction   1 if the edge that sticks is the right one, -1 if it is the left one
    load        A, the rate of P less s/f times that of Q
    rates       the rates of the loads in this direction
    slip        s f
    friction    f
    """

    course: Course
    direction: float
    rates: Rates
    sign: float
    friction: float

    @property
    def load(self) -> float:
        return self.rates.P - self.sign * self.rates.Q / self.friction

    def edge(self, time: Array) -> Array:
        """b at times."""
        return self.direction * self.course.edge(self.direction > 0.0, time)

    def far_edge(self, time: Array) -> Array:
        """The edge of contact beside the end that recedes."""
        return self.direction * self.course.edge(self.direction < 0.0, time)

    def turn(self, time: Array) -> Array:
        """B at times."""
        pull = self.sign * self.rates.tau / self.friction
        if not self.rates.by_moment:
            return np.full(time.shape, self.rates.turn - pull)
        near, far = self.edge(time), self.far_edge(time)
        turn: Array = self.rates.strain(0.5 * (near + far), 0.5 * (near - far)) - pull
        return turn

    def held_by(self, time: Array, u: Array) -> tuple[Array, Array]:
        """By how much the edge sticks: what it may lose until it slips by s, and by -s."""
        near, far = self.edge(time), self.far_edge(time)
        rho, r = 0.5 * (near - u), 0.5 * (near - far)
        grown = 2.0 * (self.rates.P - math.pi * r * self.rates.strain(0.5 * (near + far), r))
        held = (self.load - math.pi * rho * self.turn(time)) * np.sqrt(r / rho)
        return held, grown - held


@dataclass(frozen=True, eq=False)
class EdgeSticks(MarchedStep):
    """The state after one end of the stick zone receded while the other, an edge, grew and stuck.

    zone     the stick zone in the direction of the edge
    panels   the time on the way of the end
    share    the share of the step at its end
    error    the error of the end of the way over its half-width, from fewer terms
    slips    the sign of the slip that begins at the edge at the end, 0 if none does
    """

    zone: Zone
    panels: tuple[Panel, ...]
    share: float
    error: float = 0.0
    slips: float = 0.0

    @property
    def then(self) -> Onset:
        """What goes on after its end."""
        left, right = self.signs
        return Onset((left or self.slips, right or self.slips), (left != 0.0, right != 0.0))

    @cached_property
    def stick(self) -> Interval:
        d, end = self.zone.direction, self.panels[-1].end
        edge = self.pressure.contact.x2 if d > 0.0 else self.pressure.contact.x1
        return Interval(min(d * end, edge), max(d * end, edge))

    @property
    def reach(self) -> tuple[float, float]:
        return self.stick.x1, self.stick.x2

    @property
    def kept(self) -> tuple[float, float]:
        old = self.before.pressure.contact
        return max(self.stick.x1, old.x1), min(self.stick.x2, old.x2)

    @property
    def _places(self) -> tuple[float, ...]:
        """Where p and q may not be smooth.

        The end changes its speed at a mark, which is left at the edge at that time.
        """
        before, (zone, panels) = super()._places, (self.zone, self.panels)
        near = SAME * self.before.pressure.contact.r
        passed = [
            panel.time
            for panel in panels[1:]
            if np.abs(zone.direction * panel.start - np.array(before)).min() <= near
        ]
        left = zone.direction * zone.edge(np.array(passed))
        return *before, zone.direction * panels[0].start, *left.tolist()

    def in_stick(self, x: Array) -> Array:
        bound = (self.signs[0] or self.signs[1]) * self.friction
        way = added(self.zone, self.panels, self.zone.direction * x)
        q: Array = bound * (self.pressure(x) - way) - self.before.lacking(bound, x)
        return q

    def until(self, share: float) -> EdgeSticks:
        """The same at an earlier share of the step."""
        panels = [panel for panel in self.panels if panel.time < share]
        last = panels[-1]
        if last.until > share:
            panels[-1] = replace(last, last=float(last.root(np.array(share))))
        course = self.zone.course
        Q, tau = course.shear(share)
        p = course.pressure(share)
        return replace(self, pressure=p, Q=Q, tau=tau, panels=tuple(panels), share=share)

    def slip(self, x: Array) -> Array:
        place, total = self.zone.direction * x, np.zeros(len(x))
        for panel in self.panels:
            far = panel.start - place > panel.end - panel.start
            for some, rule in _rows(far, PLAIN) + _rows(~far & (place < panel.end), GRADED):
                low = np.maximum(panel.start, place[some])[:, None]
                length = (panel.end - low) * rule[0]
                u = low + length
                w = np.sqrt(((low - panel.start) + length) / panel.length)
                time = panel.times(w)
                rho = 0.5 * (self.zone.edge(time) - u)
                v = (np.maximum(panel.start - place[some], 0.0)[:, None] + length) / rho
                rate = self._rate(v, rho, time) * panel.pace(w)
                total[some] += (panel.end - low)[:, 0] * (rate @ rule[2])
        return total

    def _rate(self, v: Array, rho: Array, time: Array) -> Array:
        """dΔg/dt beside the end that recedes, v - 1 as the distance over ρ."""
        root = np.sqrt(v * (v + 2.0))
        rate = self.zone.load / math.pi * np.log1p(v + root) + self.zone.turn(time) * rho * root
        s = self.signs[0] or self.signs[1]
        slip: Array = -s * self.friction * rate / self.pressure.half_modulus
        return slip

    @cached_property
    def work(self) -> float:
        """f ∫∫ p |dΔg| dx."""
        g, weight = chebyshev.gauss_legendre(WORK_NODES)
        total = 0.0
        for panel in self.panels:
            w = panel.last * g
            steps = 2.0 * panel.length * w * panel.last * weight * panel.pace(w)
            for time, at, step in zip(panel.times(w).tolist(), w.tolist(), steps.tolist()):
                total += step * self._power(time, panel.start + panel.length * at**2)
        return total

    def _power(self, time: float, u: float) -> float:
        zone, d = self.zone, self.zone.direction
        p = zone.course.pressure(time)
        edge = p.contact.x1 if d > 0.0 else p.contact.x2
        marks = np.array([*p.breaks])
        frame = FrozenEdge(edge, -d, 2.0 * p.contact.r, p, marks)
        slips = frame.zone(u - d * edge)
        rho = 0.5 * (float(zone.edge(np.array(time))) - u)
        rate = self._rate(slips.from_stick / rho, np.array(rho), np.array(time))
        return self.friction * float(slips.force @ np.abs(rate))


def added(zone: Zone, panels: tuple[Panel, ...], place: Array) -> Array:
    """What a way adds to q* at places that stick at its end."""
    total = np.zeros(len(place))
    touched = zone.course.passes(zone.direction > 0.0, zone.direction * place)
    for panel in panels:
        begun, until = (zone.edge(np.array(t)) for t in (panel.time, panel.until))
        far = (place - panel.end > panel.end - panel.start) & (begun - place > until - begun)
        for some, rule in _rows(far, PLAIN) + _rows(~far & (touched < panel.until), GRADED):
            kernel, w, _ = _kernel(zone, panel, place[some], touched[some], rule)
            total[some] += (kernel[0] * panel.pace(w)).sum(axis=1)
    return total


def _rows(chosen: NDArray[np.bool_], rule: Rule) -> list[tuple[NDArray[np.intp], Rule]]:
    """Places that are treated by a rule, a few at a time."""
    rows = np.flatnonzero(chosen)
    step = max(1, TOGETHER // len(rule[0]))
    return [(rows[k : k + step], rule) for k in range(0, len(rows), step)]


def _kernel(
    zone: Zone, panel: Panel, place: Array, touched: Array, rule: Rule
) -> tuple[tuple[Array, Callable[[], Array]], Array, Array]:
    """The kernel dq*/dt du of places at nodes w, and a function for its derivative by time.

    `touched`: when each came into contact.
    """
    rise, fall, weight = rule
    late = touched > panel.time
    begun = np.where(late, touched, panel.time)
    first = np.zeros(len(place))
    if late.any():
        first[late] = panel.root(touched[late])
    low = panel.start + panel.length * first**2
    high = np.minimum(panel.end, place)
    length = (high - low)[:, None]
    grown = length * rise / panel.length  # w² - first²
    w = np.sqrt(first[:, None] ** 2 + grown)
    later = grown / (w + first[:, None])  # w - first
    s, s0 = 2.0 * w - 1.0, (2.0 * first - 1.0)[:, None]
    M = chebyshev.evaluate(panel.series, s)
    slope = divided(panel.series, s, s0) if late.any() else 0.0
    after = panel.length * later * (M + 2.0 * first[:, None] * slope)
    time = begun[:, None] + after
    right, course = zone.direction > 0.0, zone.course
    moves = zone.direction * course.moved(right, begun[:, None], time)
    room = np.where(late, 0.0, np.maximum(zone.edge(begun) - place, 0.0))[:, None]
    ahead = room + moves * after
    behind = (place - high)[:, None] + length * fall
    turn = zone.turn(time)
    root = np.sqrt(behind * ahead)
    du = length * weight
    rate = (zone.load / math.pi - 0.5 * turn * (behind - ahead)) / root

    def change() -> Array:
        pace = zone.direction * course.moved(right, time, time)
        by_time: Array = du * 0.5 * pace * (turn / root - rate / ahead)
        return by_time

    return (du * rate, change), w, time


# -- the way ---------------------------------------------------------------------------------------


def edge_sticks(
    before: Held, course: Course, signs: tuple[float, float], goes_on: bool, share: float
) -> EdgeSticks:
    """The state at the end of a course, or where the edge that sticks begins to slip.

    `signs` has the sign of slip at the end that recedes, and 0 at the edge that grows.
    Raises ContactError where there is none.
    """
    direction = 1.0 if signs[0] else -1.0
    s, f = signs[0] or signs[1], course.contacts.scene.friction
    zone = Zone(course, direction, course.rates.mirrored(direction), s, f)
    old = before.pressure.contact
    inner = before.stick if goes_on else old
    start = inner.x1 if direction > 0.0 else -inner.x2

    def missing(u: Array) -> Array:
        """q* where the end arrives."""
        return before.lacking(s * f, direction * u) / (s * f)

    edge = course.pressure(course.hi)
    marks = sorted({direction * x for x in places(before, edge)})
    marks = [u for u in marks if u > start + SAME * old.r]
    panels, slips = _way(zone, missing, (start, share), marks)
    judge = _again(zone, missing, panels)
    rho = 0.5 * (float(zone.edge(np.array(panels[-1].until))) - panels[-1].end)
    error = abs(judge - panels[-1].end) / rho
    end = panels[-1].until if slips else course.hi
    Q, tau = course.shear(end)
    p = course.pressure(end) if end < course.hi else edge
    return EdgeSticks(before, p, f, signs, Q, tau, zone, panels, end, error, slips)


def _way(
    zone: Zone, missing: Callable[[Array], Array], start: tuple[float, float], marks: list[float]
) -> tuple[tuple[Panel, ...], float]:
    """The way of the end until the course is over or the edge slips, and the sign of that slip."""
    panels: list[Panel] = []
    u, time = start
    rho = 0.5 * (float(zone.edge(np.array(time))) - u)
    length = FIRST * rho
    while len(panels) < MOST_PANELS:
        mark = next((m for m in marks if m > u + SAME * rho), math.inf)
        most = min(mark, 0.5 * (u + float(zone.edge(np.array(time))))) - u
        length = most if length > 0.7 * most else length
        panel = _solved(zone, missing, tuple(panels), (u, length, time))
        if panel is None:
            if length <= SHORTEST * rho:
                raise ContactError("the end of the stick zone does not recede steadily")
            length *= 0.4
            continue
        over = panel.until >= zone.course.hi
        if over:
            panel = replace(panel, last=float(panel.root(np.array(zone.course.hi))))
        panel, slips = _watched(zone, panel)
        panels.append(panel)
        if slips or over:
            return tuple(panels), slips
        u, time = panel.end if length < most else u + most, panel.until
        length *= 2.0
    raise ContactError("the end of the stick zone does not recede steadily")


def _solved(
    zone: Zone,
    missing: Callable[[Array], Array],
    panels: tuple[Panel, ...],
    place: tuple[float, float, float],
    terms: int = TERMS,
) -> Panel | None:
    """One more panel by Newton's method, None where it does not converge or is not resolved."""
    start, length, time = place
    w = 0.5 * (1.0 + chebyshev.points(terms))
    u = start + length * w**2
    if (u <= start).any():
        return None
    known = missing(u)
    known += added(zone, panels, u) if panels else 0.0
    size = float(np.abs(missing(u)).max())
    span = zone.course.hi - time
    pace = _first_pace(zone, known, (u, start, length, time), span)
    if pace is None:
        return None
    panel = Panel(start, length, time, 0.5 * pace * np.pad(STEADY, (0, terms - 2)))
    touched = np.full(terms, zone.course.lo)
    before = math.inf
    for _ in range(MOST_STEPS):
        (kernel, change), nodes, times = _kernel(zone, panel, u, touched, GRADED)
        if not (np.isfinite(kernel).all() and times.max() <= zone.course.hi + 2.0 * span):
            return None
        s, slopes = 2.0 * nodes - 1.0, panel.pace(nodes)
        missed = known + (kernel * slopes).sum(axis=1)
        T = chebyshev.polynomials(terms, s)
        dT = _derivatives(T, s)
        matrix = ((0.5 * T / nodes + dT) * kernel).sum(axis=2).T
        matrix += (T * (length * nodes * change() * slopes)).sum(axis=2).T
        step = np.linalg.solve(matrix, -missed)
        panel = replace(panel, series=panel.series + step)
        largest = float(np.abs(step).max() / np.abs(panel.series).max())
        if largest <= SETTLED or (largest <= 1e-9 and largest >= 0.3 * before):
            break
        before = largest
    else:
        return None
    c = np.abs(panel.series)
    steady = (panel.pace(0.5 * (1.0 + chebyshev.points(24))) > 0.0).all()
    rho = 0.5 * (float(zone.edge(np.array(time))) - start)
    if terms == TERMS and not (steady and c[-2:].max() * length <= RESOLVED * c.max() * rho):
        return None
    return panel


def _derivatives(T: Array, s: Array) -> Array:
    """T_n'(s), n first."""
    out = np.zeros(T.shape)
    if len(T) > 1:
        out[1] = 1.0
    for n in range(2, len(T)):
        out[n] = 2.0 * s * out[n - 1] + 2.0 * T[n - 1] - out[n - 2]
    return out


def _first_pace(
    zone: Zone, known: Array, place: tuple[Array, float, float, float], span: float
) -> float | None:
    """The constant dt/du with which the end of a panel is reached in time."""
    u, start, length, time = place
    last, touched = u[-1:], np.full(1, zone.course.lo)

    def missed(pace: float) -> float:
        panel = Panel(start, length, time, 0.5 * pace * STEADY)
        (kernel, _), *_ = _kernel(zone, panel, last, touched, ROUGH)
        return float(known[-1] + pace * kernel.sum())

    high = span / length
    at = missed(high)
    for _ in range(3):
        if at <= 0.0:
            break
        high *= 2.0
        at = missed(high)
    else:
        return 0.5 * high if math.isfinite(at) else None
    low, value = high, at
    for _ in range(60):
        low *= 0.25
        value = missed(low)
        if value > 0.0:
            break
        high, at = low, value
    else:
        return None
    return false_position(missed, low, high, (value, at), lambda a, b, v: b - a <= 1e-3 * b)


def _watched(zone: Zone, panel: Panel) -> tuple[Panel, float]:
    """A panel up to where the edge begins to slip, and in which direction."""

    def held(w: Array) -> tuple[Array, Array]:
        return zone.held_by(panel.times(w), panel.start + panel.length * w**2)

    w = panel.last * WATCHED
    first = (1.0, 0.0)
    for k, sign in enumerate((zone.sign, -zone.sign)):
        room = held(w)[k]
        lost = np.flatnonzero(room[1:] < 0.0)
        if lost.size:
            j = int(lost[0])

            def left(at: float, k: int = k) -> float:
                return float(held(np.array(at))[k])

            ends = float(w[j]), float(w[j + 1])
            if not room[j] > 0.0:
                raise ContactError("the edge slips at once")
            at = false_position(left, *ends, (float(room[j]), float(room[j + 1])), _settled)
            first = min(first, (at, sign))
    return (replace(panel, last=first[0]), first[1]) if first[1] else (panel, 0.0)


def _settled(a: float, b: float, value: float) -> bool:
    return b - a <= 4.0 * EPS


def _again(zone: Zone, missing: Callable[[Array], Array], panels: tuple[Panel, ...]) -> float:
    """The end of the same way from fewer terms."""
    again: tuple[Panel, ...] = ()
    time = panels[0].time
    for panel in panels:
        place = panel.start, panel.length, time
        found = _solved(zone, missing, again, place, FEWER) or panel
        again = (*again, found)
        time = found.until
    last = replace(again[-1], last=1.0)
    at = float(last.root(np.array(min(panels[-1].until, last.until))))
    return last.start + last.length * at**2
