"""How zones move while a contact spreads under Q, by series in ln s, and when they pass a place.

At constant P the left edge is at -b - s; the right end of the stick zone and the right edge have
moved left by ε2 and ε3, and Q grows by w ds. ln w, ln ε2 and ln ε3 are series in ln s on panels,
and the first panel, from s = 0 on, has powers of s. The weights of the rates (`edge_rate`), which
depend on the zones alone, are series in ln s too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev

from .edge_rate import EdgeRates, Lengths, Weights
from .panels import graded

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

FROM_START = 1e-25  # of the first panel, to s = 0
SEEN = 1e-20  # of ε: narrower strips change no digit of a traction
WEIGHT_NODES = 18  # of a panel, for the weights of the rates; of the first, from LEAST of it on
FIRST_NODES, LEAST = 40, 1e-9
EARLIEST = -60.0  # ln of a part of the first panel: places that are passed before were at s = 0
BISECTIONS, CLOSE = 64, 4e-16  # steps at most; of ln s, the last one, a rounding of 1


@dataclass(frozen=True, eq=False)
class SpreadingPanel:
    """ln w, ln ε2, ln ε3 as series in ln s for lo <= s <= hi; the first is continued to s = 0."""

    lo: float
    hi: float
    series: Array = field(repr=False)
    first: bool = False

    @cached_property
    def length(self) -> float:
        """ln hi/lo."""
        return math.log(self.hi / self.lo)

    @property
    def start(self) -> float:
        return 0.0 if self.first else self.lo

    def variable(self, s: Array) -> Array:
        values: Array = 2.0 / self.length * np.log(s / self.lo) - 1.0
        return values

    def __call__(self, s: Array) -> tuple[Array, Array, Array]:
        """w, ε2 and ε3."""
        y = self.variable(s)
        rows = self.series.T.reshape(-1, 3, *(1,) * y.ndim)
        w, e2, e3 = np.exp(chebyshev.evaluate(rows, y))
        return w, e2, e3

    def slopes(self, s: Array) -> tuple[Array, Array]:
        """The derivatives of ε2 and ε3 with s."""
        y = self.variable(s)
        rates = []
        for row in self.series[1:]:
            own = np.polynomial.chebyshev.chebval(y, np.polynomial.chebyshev.chebder(row))
            rates.append(np.exp(chebyshev.evaluate(row, y)) * own * 2.0 / (self.length * s))
        return rates[0], rates[1]

    def moved(self, k: int, s: Array, by: Array, to: Array) -> Array:
        """ε_k at to = s + by less that at s, to relative accuracy however small `by` is."""
        y = self.variable(s)
        near = np.abs(by) < 0.5 * s
        # Beyond, the difference of logarithms keeps its digits
        dv = np.where(near, np.log1p(np.where(near, by, 0.0) / s), np.log(to / s))
        step = 2.0 / self.length * dv
        y, step = np.broadcast_arrays(y, step)
        rise = chebyshev.quotient(self.series[k], y + step, y + 0.0) * step
        return np.exp(chebyshev.evaluate(self.series[k], y)) * np.expm1(rise)


class Places(NamedTuple):
    """Places x by x + b, c - x and b - x, and how far the edge has advanced for each.

    end     "x1", "e2" or "x2" if all are these ends of the zones at that s, or ""
    """

    from_b: Array
    to_c: Array
    to_b: Array
    s: Array
    end: str = ""

    def of(self, k: Indices) -> Places:
        return Places(self.from_b[k], self.to_c[k], self.to_b[k], self.s[k], self.end)


class SpreadingZones:
    """The zones on panels that are given, in a contact with half-widths b > c under P alone.

    rest        b - c
    strip       whether the strip is so wide that it is seen
    width       about how wide it is
    """

    def __init__(self, rates: EdgeRates, b: float, rest: float) -> None:
        self.rates, self.b, self.rest = rates, b, rest
        self.panels: tuple[SpreadingPanel, ...] = ()
        self._weights: dict[int, tuple[SpreadingPanel, Array]] = {}
        self.strip, self.width = True, 0.0

    @property
    def c(self) -> float:
        return self.b - self.rest

    # -- zones -------------------------------------------------------------------------------------

    def lengths_of_zones(self, s: Array, e2: Array, e3: Array) -> tuple[Array, Array]:
        """e2 - x1 and x2 - e2."""
        return self.b + self.c + s - e2, self.rest + e2 - e3

    def weights(self, s: Array, e2: Array, e3: Array) -> Weights:
        stuck, slipping = self.lengths_of_zones(s, e2, e3)
        flat = self.rates.weights((slipping / stuck).ravel())
        return Weights(*(part.reshape(*part.shape[:-1], *np.shape(s)) for part in flat))

    def weights_on(self, panel: SpreadingPanel, s: Array) -> Weights:
        """The weights, interpolated; before the first panel those at its start."""
        rows, lo = self._series(panel)
        y = np.log(s / panel.hi) * (-2.0 / math.log(lo)) + 1.0
        T = chebyshev.polynomials(rows.shape[-1], np.maximum(y, -1.0))
        values = np.tensordot(rows, T, axes=1)
        if not self.strip:
            return Weights(values.reshape(2, 1, *s.shape), values[:0], s)
        n = (len(values) - 1) // 4
        outer, inner = (
            part.reshape(2, n, *s.shape) for part in (values[: 2 * n], values[2 * n : -1])
        )
        return Weights(outer, inner, values[-1])

    def _series(self, panel: SpreadingPanel) -> tuple[Array, float]:
        """Chebyshev series of the weights in ln s, and where they begin, over hi."""
        lo = LEAST if panel.first else panel.lo / panel.hi
        if id(panel) not in self._weights:
            n = FIRST_NODES if panel.first else WEIGHT_NODES
            s = panel.hi * np.exp(0.5 * math.log(lo) * (1.0 - chebyshev.points(n)))
            _, e2, e3 = panel(s)
            at = self.weights(s, e2, e3)
            parts = [at.outer.reshape(-1, len(s)), at.inner.reshape(-1, len(s)), at.log[None]]
            rows = np.concatenate(parts) if self.strip else at.outer[:, 0]
            kept = {id(own) for own in self.panels}
            self._weights = {k: v for k, v in self._weights.items() if k in kept}
            self._weights[id(panel)] = panel, chebyshev.transform(rows)
        return self._weights[id(panel)][1], lo

    def gradient_rate(
        self, s: float, places: tuple[Array, ...], ways: tuple[float, float]
    ) -> Array:
        """γ̇ at the distances from x1, e2 and x2, where the zones have moved by ε2 and ε3."""
        shape, (one, e2, e3) = places[0].shape, (np.array([v]) for v in (s, *ways))
        lengths = (np.full(shape, v[0]) for v in self.lengths_of_zones(one, e2, e3))
        weights = Weights(
            *(
                np.broadcast_to(v[..., None], (*v.shape[:-1], *shape))
                for v in self.weights(one, e2, e3)
            )
        )
        values: Array = self.rates.inside(Lengths(*places, *lengths), weights, self.strip)[2]
        return values

    def strip_width(self, s: float, e2: float, e3: float) -> float:
        """The width of the strip of these zones."""
        at = np.array([s]), np.array([e2]), np.array([e3])
        stuck, slipping = self.lengths_of_zones(*at)
        log = self.weights(*at).log
        return float((np.exp(log) * stuck * (stuck + slipping) / slipping)[0])

    def width_at(self, panel: SpreadingPanel, s: Array) -> Array:
        """The width of the strip."""
        _, e2, e3 = panel(s)
        stuck, slipping = self.lengths_of_zones(s, e2, e3)
        t = np.exp(self.weights_on(panel, s).log)
        # x - x1 at t = ε
        width: Array = t * stuck * (stuck + slipping) / (slipping + t * stuck)
        return width

    def load(self, s: float) -> float:
        """Q = ∫w."""
        total = 0.0
        for panel in self.panels:
            if panel.start < s:
                total += self.load_on(panel, s)
        return total

    @staticmethod
    def load_on(panel: SpreadingPanel, s: float) -> float:
        length = min(panel.hi, s) - panel.start
        before = FROM_START * length if panel.first else panel.lo
        _, ahead, _, weight = graded(np.array([length]), np.array([before]), np.array([math.inf]))
        return float((panel(panel.start + ahead)[0] * weight).sum())

    def zones(self, s: float) -> tuple[float, float]:
        """ε2 and ε3 at s."""
        _, e2, e3 = self.panel_of(s)(np.array([s]))
        return float(e2[0]), float(e3[0])

    def panel_of(self, s: float) -> SpreadingPanel:
        return next((p for p in self.panels if s <= p.hi), self.panels[-1])

    # -- places ------------------------------------------------------------------------------------

    def at(self, end: str, s: Array, e2: Array, e3: Array) -> Places:
        """The ends "x1", "e2" and "x2" of the zones."""
        b, c, rest = self.b, self.c, self.rest
        if end == "x1":
            return Places(-s, b + c + s, 2.0 * b + s, s, end)
        if end == "e2":
            return Places(b + c - e2, e2, rest + e2, s, end)
        return Places(2.0 * b - e3, e3 - rest, e3, s, end)

    def passed(self, places: Places) -> Array:
        """s' at which the end of the stick zone passes each place; infinite if not before s."""
        found = np.where(places.to_c <= 0.0, -1.0, math.inf)
        if places.end in ("x1", "e2"):
            return found
        with np.errstate(divide="ignore", invalid="ignore"):
            aim = np.log(places.to_c)
        for panel in self.panels:
            hi = np.log(np.minimum(panel.hi, places.s) / panel.lo)
            lo = EARLIEST if panel.first else 0.0

            def rise(v: Array, panel: SpreadingPanel = panel) -> Array:
                values: Array = chebyshev.evaluate(panel.series[1], 2.0 / panel.length * v - 1.0)
                return values

            def steep(v: Array, panel: SpreadingPanel = panel) -> Array:
                c = np.polynomial.chebyshev.chebder(panel.series[1]) * 2.0 / panel.length
                values: Array = chebyshev.evaluate(c, 2.0 / panel.length * v - 1.0)
                return values

            k = np.flatnonzero(np.isinf(found) & (places.s > panel.start) & (aim < rise(hi)))
            if not k.size:
                continue
            a: Array = np.full(len(k), lo)
            b: Array = hi[k]
            middle: Array = 0.5 * (a + b)
            for _ in range(BISECTIONS):
                gap = rise(middle) - aim[k]
                a, b = np.where(gap < 0.0, middle, a), np.where(gap < 0.0, b, middle)
                step = middle - gap / steep(middle)
                last, inside = middle, (step >= a) & (step <= b)
                middle = np.where(inside, step, 0.5 * (a + b))  # by halves where Newton leaves
                if float(np.abs(middle - last).max()) < CLOSE:
                    break
            found[k] = panel.lo * np.exp(middle)
        return found

    def times(self, places: Places) -> tuple[Array, Array]:
        """About how much later the end of the stick zone and the right edge pass each place."""
        s = np.unique(places.s)
        times = np.empty((2, len(places.s)))
        for one in s.tolist():
            k, at = places.s == one, np.array([one])
            panel = self.panel_of(one)
            _, e2, e3 = panel(at)
            speeds = panel.slopes(at)
            for row, (gap, e, v) in enumerate(
                zip((places.to_c[k], places.to_b[k]), (e2, e3), speeds, strict=True)
            ):
                times[row, k] = np.maximum(gap - e, 0.0) / np.abs(v)
        if places.end == "e2":
            times[0] = 0.0
        if places.end == "x2":
            times[1] = 0.0
        return times[0], times[1]
