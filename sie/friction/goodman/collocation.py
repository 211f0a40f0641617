"""One panel of the growth in which the stick zone recedes at one end.

On the panel 1 + t1 = e is a polynomial in the panel's variable. At its points V(u(r), r) = 0, V
what came before, which is tabulated over the places, and the panel's own part.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS

from .growth import Panel
from .moving_history import MovingHistory, Stage
from .receding_flat import BEYOND, RecedingFlat
from .root_series import RootSeries

Array = NDArray[np.float64]

DEGREE = 12  # of the polynomial
NEWTONS, HALVINGS = 20, 6
GUESSES, FARTHEST = 14, 25.0  # bisections for the first guess, of a logarithm from its largest
HALVED, PROPORTIONAL = 46, 1e-10  # bisections from nothing, and what is then missed of the load
SETTLED, STALLED = 1e-12, 1e-6  # of 1 + t1: Newton's method has ended, or rounding ends it
SMALL = 1e-16  # of the load: V times r is 0
DIFFERENCE = 1e-7  # of a value: the step of a difference quotient
FRACTION = 1e-4  # of the way that the end goes: the same
LOOKS = 48  # places at which the end has to move inwards
ROUNDING = 1e-12  # of the half-width: an end that moves by less stands


class Trial(NamedTuple):
    """A panel to be found: a part of one of the growth, with e and de/dr where it begins.

    e is None at nothing.
    """

    flat: RecedingFlat
    panel: Panel
    centre: float
    ends: tuple[float, float]
    side: float
    start: float | None
    slope: float
    plain: bool


class Collocation:
    """The equations of one panel."""

    def __init__(self, trial: Trial, past: RootSeries | None, load: float) -> None:
        self.trial, self.past, self.load = trial, past, load
        if trial.start is None:
            self.places = self.nodes = chebyshev.points(DEGREE)
        else:
            self.nodes = -np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)
            self.places = self.nodes[1:]
        self.r = self._half_widths(self.places)

    @cached_property
    def _to_series(self) -> Array:
        n = len(self.nodes)
        powers = chebyshev.polynomials(n, self.nodes).T
        matrix: Array = np.asarray(np.linalg.inv(powers), dtype=np.float64)
        return matrix

    @property
    def _limits(self) -> tuple[float, float]:
        rest, k = (float(v[0]) for v in (self.trial.flat.natural.e, self.trial.flat.natural.k))
        return 1e-12 * rest, rest + 0.9 * BEYOND * min(k, rest)

    def _half_widths(self, places: Array) -> Array:
        lo, hi = self.trial.ends
        if self.trial.plain:
            return lo + (hi - lo) * 0.5 * (1.0 + places)
        r: Array = lo + (hi - lo) * np.sin(0.25 * math.pi * (1.0 + places)) ** 2
        return r

    def stage(self, values: Array) -> Stage:
        """The stage with these e at the points."""
        t = self.trial
        known = values if t.start is None else np.append(t.start, values)
        series = self._to_series @ known
        return Stage(t.flat, t.panel, t.centre, *t.ends, t.side, series, t.ends[1], t.plain)

    def lack(self, stage: Stage, r: Array) -> Array:
        """V at u(r)."""
        u = stage.first_end(r)
        own = MovingHistory((stage,)).lack(stage.side * u, -stage.side, r)
        return own if self.past is None else own + self.past(u)

    def solve(self) -> tuple[Stage, float]:
        """The stage, and what V times r misses between its points, of the load."""
        # A growth in proportion has a constant e, found as exactly as rounding allows
        start = self.trial.start
        values = self._guess() if start is None else np.full(len(self.r), start)
        constant = self.stage(values)
        if rises(constant) and (missed := self._missed(constant)) <= PROPORTIONAL:
            return constant, missed
        values = values if start is None else self._guess()
        before, J = math.inf, None
        lowest, highest = self._limits
        trial = self.stage(values)
        V = self.lack(trial, self.r)
        for _ in range(NEWTONS):
            J = self._derivatives(values) if J is None else J
            scale = np.abs(J).max(axis=1, keepdims=True)
            if not (np.isfinite(V).all() and np.isfinite(J).all() and (scale > 0.0).all()):
                return trial, math.inf
            step = -np.linalg.lstsq(J / scale, V / scale[:, 0], rcond=None)[0]
            for _ in range(HALVINGS):
                new = values + step
                trial = self.stage(new)
                if (new > lowest).all() and (new < highest).all() and self._forward(trial):
                    break
                step = 0.5 * step
            else:
                return trial, math.inf
            size = float(np.abs(step).max() / np.abs(values).max())
            values = new
            V = self.lack(trial, self.r)
            small = float((np.abs(V) * self.r).max()) <= SMALL * self.load
            if size <= SETTLED or small or (size >= 0.5 * before and size < STALLED):
                break
            if size > 0.3 * before:
                J = None
            before = size
        else:
            return trial, math.inf
        if not rises(trial):
            return trial, math.inf
        return trial, self._missed(trial)

    def _missed(self, trial: Stage) -> float:
        """V times r between the points, of the load."""
        between = self._half_widths(0.5 * (self.places[1:] + self.places[:-1]))
        wrong = np.abs(self.lack(trial, between)) * between
        return float(wrong.max()) / self.load

    def _forward(self, stage: Stage) -> bool:
        return bool((np.diff(stage.first_end(self.r)) > 0.0).all())

    def _guess(self) -> Array:
        """The e of one parameter for which V is 0 at the last point.

        It is constant from nothing, as in a growth in proportion, and a parabola elsewhere.
        """
        lo, hi = self.trial.ends
        start = self.trial.start
        ahead = self.r - lo
        part = np.ones_like(ahead) if start is None else (ahead / ahead[-1]) ** 2
        e, slope = (0.0, 0.0) if start is None else (start, self.trial.slope)
        base = e + slope * ahead

        def lack(end: float) -> float:
            trial = self.stage(base + (end - base[-1]) * part)
            return float(self.lack(trial, self.r[-1:])[0]) if rises(trial) else -math.inf

        lowest, highest = self._limits
        if start is None:
            low, high = (math.log(x / (1.0 - x)) for x in (lowest, highest))
        else:
            # By how much the end moves: less is less certain
            natural = Stage(self.trial.flat, self.trial.panel, self.trial.centre, lo, hi)
            m = self.trial.side * natural.middle(np.array([lo, self.r[-1]]))
            there = (float(m[0] - m[1]) + self.r[-1] - lo * (1.0 - e)) / self.r[-1]
            high = math.log(max(highest - there, EPS))
            low = high - FARTHEST

        def end_at(place: float) -> float:
            if start is None:
                return 1.0 / (1.0 + math.exp(-place))
            return there + math.exp(place)

        for _ in range(GUESSES if start is not None else HALVED):
            middle = 0.5 * (low + high)
            above = lack(end_at(middle)) > 0.0
            low, high = (low, middle) if above else (middle, high)
        return base + (end_at(high) - base[-1]) * part

    def _derivatives(self, values: Array) -> Array:
        """The derivatives of V at the points by the values there."""
        stage = self.stage(values)
        base = self.lack(stage, self.r)
        u = stage.first_end(np.array(self.trial.ends))
        way = float(abs(u[1] - u[0])) / self.trial.ends[1]
        J = np.empty((len(values), len(values)))
        for j, step in enumerate(np.minimum(DIFFERENCE * values, FRACTION * way)):
            moved = values.copy()
            moved[j] -= step
            J[:, j] = (base - self.lack(self.stage(moved), self.r)) / step
        return J


def rises(stage: Stage) -> bool:
    """Whether the end that recedes moves inwards all along a stage."""
    part = (np.arange(LOOKS + 1) / LOOKS) ** 2
    u = stage.first_end(stage.lo + (stage.hi - stage.lo) * part)
    return bool((np.diff(u) > -ROUNDING * stage.hi).all())
