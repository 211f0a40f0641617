"""The growth of a contact of dissimilar bodies from first touch to the load.

Each panel of `growth` ends where an edge reaches a place at which the profile is not smooth, where
its series ask for it, or beyond the load. What is refused is refused with the load at which it
happens.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.root_finding import false_position
from sie.profiles.lowest_points import lowest_points
from sie.profiles.slope import Slope
from sie.progress_bar import step_done

from .growth import DEGREE, Panel, collocated

if TYPE_CHECKING:
    from .flat import FlatPunch

Array = NDArray[np.float64]

DECAYED = 1e-13  # of a series, its last coefficients
NEGLIGIBLE = 1e-12  # of the load, or of the half-width: what a short panel may miss
UNRESOLVED = 1e-9  # of the same: what is refused
NO_LESS = 0.5  # of what a panel missed before it was cut
CUT = 0.4  # of a panel that is cut
FOLDS = 5.0  # e-folds of the distance from a kink, that a panel behind it may reach over
# What a panel misses that begins at a kink: its power of the length, and the shortest cut
STEEPLY, LEAST_CUT = 0.7, 1e-4
SHORTEST = 1e-13  # of the half-width, a panel
MOST = 400  # panels
BEYOND = 1.01  # of the length at which an edge seems to reach a kink, a panel
LANDED = 1e-14  # of the half-width: an edge at a kink
CLOSE = 1e-12  # of the half-width: kinks so near the place of first contact are that place
FIRST = 1e-8  # of the half-width from first contact: where the power of the slope is measured
WHOLE = 1e-3  # of twice a power, from a whole number
FALLING = 1e-9  # of the largest P': below it a negative one is not rounding
LOOKS = 200  # places of a panel at which P' is looked at
# The same for the middle, of the panel: from first touch on it may turn back early
SPREAD: Array = np.geomspace(1e-12, 1.0, 20000)
NEGLECT = "set friction = 0, or give dundurs = 0 to neglect β"


def never(a: float, b: float, missed: float) -> bool:
    """False: a root is sought to rounding."""
    return False


class Touch(NamedTuple):
    """The flat base, or the place, that touches first, and on each side the slope beside it.

    powers      (q, q'), h' ~ d^q at a distance d
    strengths   the factors of these, both positive
    """

    lo: float
    hi: float
    powers: tuple[float, float]
    strengths: tuple[float, float]


@dataclass
class Edge:
    """An edge on its way: the piece of the slope, where that was entered, and how far ago."""

    sign: float
    piece: int
    entered: float
    since: float
    profile: Slope
    half_modulus: float

    @property
    def place(self) -> float:
        return self.entered + self.sign * self.since

    @property
    def _ahead(self) -> float:
        """The next place where the profile is not smooth."""
        return float(self.profile.breaks[self.piece + (self.sign > 0.0)])

    @property
    def end(self) -> float:
        """The distance to that."""
        return self.sign * (self._ahead - self.entered) - self.since

    @property
    def stays(self) -> bool:
        """Whether the edge would stay there: at the indenter's end, or where its slope jumps."""
        if self.piece == (len(self.profile.origins) - 1 if self.sign > 0.0 else 0):
            return True
        return self.profile.corner(self._ahead)[0] != 0.0

    def slope(self, rise: Array) -> Array:
        """E*/2 h' ahead, as it rises outwards."""
        u = self.sign * (self.since + rise)
        found = self.profile.value(np.array([self.piece]), self.entered, u.ravel())
        values: Array = self.sign * self.half_modulus * found.reshape(rise.shape)
        return values

    def passed(self) -> None:
        """Enters the next piece."""
        self.entered, self.since = self._ahead, 0.0
        self.piece += int(self.sign)


def first_touch(slope: Slope, r: float) -> Touch:
    """Where a convex profile touches first, given the half-width of a contact."""
    start, end = lowest_points(slope)
    near = float(slope.breaks[np.argmin(np.abs(slope.breaks - start))])
    if start == end and abs(near - start) <= CLOSE * r:
        start = end = near
    sides = [_beside(slope, place, sign, r) for place, sign in ((start, -1.0), (end, 1.0))]
    powers, strengths = zip(*sides, strict=True)
    return Touch(start, end, (powers[0], powers[1]), (strengths[0], strengths[1]))


def _beside(slope: Slope, place: float, sign: float, r: float) -> tuple[float, float]:
    """The power of the slope beside a place, outwards, and its factor."""
    side = edge_at(slope, place, sign, 1.0)
    if side is None:
        return 0.0, math.inf
    d = min(FIRST * r, 1e-3 * side.end)
    one, two = side.slope(np.array([d, 2.0 * d])).tolist()
    if one <= 0.0 or two <= 0.0:
        return 0.0, 0.0
    power = math.log2(two / one)
    if abs(2.0 * power - round(2.0 * power)) < WHOLE:
        power = 0.5 * round(2.0 * power)
    return power, one / d**power


def edge_at(slope: Slope, place: float, sign: float, half_modulus: float) -> Edge | None:
    """An edge that starts outwards there; None where the indenter ends."""
    right = int(np.searchsorted(slope.breaks, place, side="right")) - 1
    left = int(np.searchsorted(slope.breaks, place, side="left")) - 1
    piece = right if sign > 0.0 else left
    if not 0 <= piece < len(slope.origins):
        return None
    return Edge(sign, piece, place, 0.0, slope, half_modulus)


class March:
    """The panels from first touch on."""

    def __init__(
        self,
        flat: FlatPunch,
        slope: Slope,
        half_modulus: float,
        touch: Touch,
        exponent: float = 0.0,
    ) -> None:
        self.flat, self.touch = flat, touch
        self.panels: list[Panel] = []
        self.base = 0.5 * (touch.hi - touch.lo)
        self.middle = touch.lo + self.base
        left, right = (
            edge_at(slope, place, sign, half_modulus)
            for place, sign in ((touch.lo, -1.0), (touch.hi, 1.0))
        )
        self.power, self.rate = self._start(left is None or right is None)
        assert left is not None and right is not None
        self.edges = right, left
        # of a power law, h = C |x|^m: P' is one power then
        self.exponent = exponent
        if exponent:
            self.power = exponent - 1.0
        self.load = 0.0
        # Where the last panel began that P' begins with a broken power of the distance from
        self.kinked = self.base
        self.kinks: list[float] = []
        self._scale = 0.0  # the largest load that any panel carried

    def _start(self, ends: bool) -> tuple[float, float]:
        """The power of P' and m' at first touch."""
        (q, other), (left, right) = self.touch.powers, self.touch.strengths
        uneven = abs(q - other) > WHOLE or min(left, right) <= 0.0
        if ends or uneven or math.inf in (left, right):
            where = f"x = {self.touch.lo:.6g}" + (f" ... {self.touch.hi:.6g}" if self.base else "")
            raise ContactError(
                f"the profile touches first at {where}, and rises so unlike on both sides, as at a "
                "corner, that one edge of contact stays there: behind it what stuck would slip, "
                f"which is not solved; round the corner, change the tilt, {NEGLECT}"
            )
        power = self.flat.exponent - 1.0 + q if self.base else q
        turn = (left / right) ** (1.0 / (q + self.flat.exponent)) if self.base else 1.0
        return power, (turn - 1.0) / (turn + 1.0)

    @property
    def s(self) -> float:
        return self.panels[-1].hi if self.panels else self.base

    def advance(self, goal: float) -> Panel:
        """One more panel, as far as goal at most."""
        lo, before = self.s, math.inf
        length, fresh = self._longest(goal), lo == self.kinked
        while True:
            step_done(0)
            if length < SHORTEST * goal or len(self.panels) > MOST:
                raise ContactError(self._unresolved())
            panel = self._solved(lo, length)
            if panel is None:
                length *= CUT
                continue
            self._scale = max(self._scale, self.load + panel.load(math.inf))
            missed = self._missed(panel, goal)
            if missed <= NEGLIGIBLE or missed > NO_LESS * before:
                break
            before = missed
            length *= max((NEGLIGIBLE / missed) ** STEEPLY, LEAST_CUT) if fresh else CUT
        if missed > UNRESOLVED:
            raise ContactError(self._unresolved())
        panel = panel.cut(self._crossing(panel))
        self._accept(panel)
        return panel

    def _longest(self, goal: float) -> float:
        """How long a panel is tried."""
        lo = self.s
        length, rate = goal - lo, self.rate
        if self.panels:
            last = self.panels[-1]
            rate = float(last.turn(np.array(last.length)))
        if lo > self.kinked:
            length = min(length, math.expm1(FOLDS) * (lo - self.kinked))
        for edge in self.edges:
            length = min(length, BEYOND * edge.end / (1.0 + edge.sign * rate))
        return length

    def _solved(self, lo: float, length: float) -> Panel | None:
        last = self.panels[-1] if self.panels else None
        behind, power = (lo - self.kinked or math.inf, 0.0) if last else (math.inf, self.power)
        middle = last.middle + last.whole_shift if last else self.middle
        rate = float(last.turn(np.array(last.length))) if last else self.rate
        degree = 1 if self.exponent else DEGREE
        series = np.zeros(degree)
        empty = Panel(lo, lo + length, power, behind, middle, series, series)
        shifts = chebyshev.transform(rate * empty.ahead(chebyshev.points(degree)))
        return collocated(self.flat, self.panels, replace(empty, shifts=shifts), self.edges)

    def _missed(self, panel: Panel, goal: float) -> float:
        """What the last coefficients of both series carry, in parts of the load and of the goal."""
        if self.exponent:
            return 0.0
        size, length = np.abs(panel.series), panel.length
        tail = float(size[-3:].max())
        load = tail * length ** (1.0 + panel.power) if tail > DECAYED * size.max() else 0.0
        turned = float(np.abs(panel.shifts[-3:]).max())
        return max(load / self._scale, turned / goal if turned > DECAYED * length else 0.0)

    def _crossing(self, panel: Panel) -> float:
        """How far ahead an edge meets its next kink, the length of the panel if none does."""
        ahead = panel.length
        for edge in self.edges:
            far = edge.end
            if panel.spread(edge.sign) <= far + LANDED * panel.hi:
                continue

            def beyond(d: float, edge: Edge = edge, far: float = far) -> float:
                moved = float(panel.moved(np.array(0.0), np.array(d)))
                return d + edge.sign * moved - far

            ends = -far, beyond(panel.length)
            found = false_position(beyond, 0.0, panel.length, ends, never)
            ahead = min(ahead, found)
        return ahead

    def _accept(self, panel: Panel) -> None:
        self.load += panel.load(math.inf)
        self.panels.append(panel)
        for edge in self.edges:
            edge.since += panel.spread(edge.sign)
            if not edge.stays and abs(edge.end) <= 10.0 * LANDED * panel.hi:
                edge.passed()
                self.kinked = panel.hi
                self.kinks.append(panel.hi)

    @property
    def stopped(self) -> Edge | None:
        """The edge that reached a corner of the indenter."""
        hi = self.s
        for edge in self.edges:
            if edge.stays and edge.end <= 10.0 * LANDED * hi:
                return edge
        return None

    def _unresolved(self) -> str:
        return (
            f"the contact of half-width {self.s:.6g} under P = {self.load:.6g} of dissimilar "
            "bodies would not grow steadily, or its growth is not resolved: smooth the profile, "
            f"change the tilt, {NEGLECT}"
        )


def refuse_turning(panel: Panel, ahead: float, before: float, flat: FlatPunch) -> None:
    """Raises ContactError where an end of the stick zone would move back, or P' < 0."""
    places = ahead * SPREAD if panel.power else np.append(0.0, ahead * SPREAD)
    load = panel(ahead * (np.arange(LOOKS) + 1.0) / LOOKS)
    turned = np.abs(panel.turn(places)) >= flat.c
    if turned.any():
        k = int(np.argmax(turned))
        last, turn = float(places[max(k - 1, 0)]), float(panel.turn(places[k]))
        raise ContactError(_turning(panel.lo + last, before + panel.load(last), turn, flat.c))
    if (load < -FALLING * np.abs(load).max()).any():
        raise ContactError(
            "the contact of dissimilar bodies with friction would not grow steadily under P = "
            f"{before:.6g}: coupled slip is solved for convex profiles; smooth the profile, or "
            "give dundurs = 0 to neglect β"
        )


def _turning(s: float, P: float, turn: float, c: float) -> str:
    """Why there is no answer beyond the half-width s and the load P."""
    start = f"from P = {P:.4g} on, at the half-width {s:.4g}," if P > 0.0 else "at once"
    way, less = "right" if turn > 0.0 else "left", "lower the load, " if P > 0.0 else ""
    return (
        f"{start} the middle of the contact moves to the {way} {_below_one(abs(turn))} times as "
        "fast as its half-width grows. Both ends of the stick zone of dissimilar bodies move "
        f"outwards only below {_below_one(c)}; beyond, what stuck slips again, and how is not "
        f"solved; {less}change the tilt, {NEGLECT}"
    )


def _below_one(part: float) -> str:
    """A part in words that tell it from 1."""
    return f"{part:.3g}" if part < 0.99 else f"(1 - {1.0 - part:.2g})"
