"""The growth d ln r/d ln y of a contact with its load y, as Chebyshev series in ln y on panels.

Panels begin where an edge passes a break of the profile: from there on the growth goes with the
root of the distance.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS

from .contact_growth import ContactGrowth

Array = NDArray[np.float64]

SIZES = (9, 17, 33)  # points that a panel is tried with before it is cut
TAIL = 3
# The error allowed of the last coefficients of d ln r/d ln y; across many breaks, of a trace
FINE, COARSE = 1024.0 * EPS, 1e-11
LONG = 1e-5  # in ln y: on a longer panel ln r itself is expanded where d ln r/d ln y is rough
# ... or this, where twice as many points do not make them smaller: the slope of a function is known
# by its series
NOISE = 1e-10
NOISELESS = 1.0 / 64.0  # of sqrt(largest load/load): so much rounding of the slope FINE allows for
NEAREST = EPS * EPS  # to the beginning of a panel, as a part of its length
SHORTEST = 1e-10  # a panel whose ends are so near to each other, as a ratio, is not cut
FEW = 8  # so many breaks are cut at without trial
LOWEST = 1e-18  # of the largest load: below, nothing adds to an energy
RATIO = 4.0  # of the loads at the ends of a part of an integral over y, at most


@dataclass(frozen=True, eq=False)
class Panel:
    """d ln r/d ln y for lo <= y <= hi, with t = ln(y/lo)/ln(hi/lo), as a series in 2 t - 1.

    If an edge passes a break at lo (`kinked`), of sqrt(t) d ln r/d ln y in 2 sqrt(t) - 1.
    """

    lo: float
    hi: float
    kinked: bool
    series: Array


class GrowthPanels:
    """The panels of all loads that were asked for, ascending."""

    def __init__(self, contacts: ContactGrowth) -> None:
        self._contacts, self.top = contacts, contacts.top
        self.panels: list[Panel] = []

    def at(self, y: Array) -> NDArray[np.int64]:
        """The panels that hold these loads."""
        k = np.searchsorted([p.lo for p in self.panels], y, side="right") - 1
        return np.clip(k, 0, len(self.panels) - 1)

    def rate(self, k: NDArray[np.int64], y: Array) -> Array:
        """d ln r/d ln y at y (K, n) on the panels k."""
        panels = self.panels
        lo, hi, kinked = (
            np.array([getattr(p, name) for p in panels])[k][:, None]
            for name in ("lo", "hi", "kinked")
        )
        t = np.clip(np.log1p((y - lo) / lo) / np.log1p((hi - lo) / lo), NEAREST, 1.0)
        s = 2.0 * np.where(kinked, np.sqrt(t), t) - 1.0
        width = max(len(p.series) for p in panels)
        series = np.zeros((len(panels), width))
        for row, p in zip(series, panels, strict=True):
            row[: len(p.series)] = p.series
        after = values = np.zeros(y.shape)  # Clenshaw (1955)
        for c in series.T[:0:-1]:
            values, after = c[k][:, None] + 2.0 * s * values - after, values
        total: Array = (series[k, :1] + s * values - after) / np.where(kinked, np.sqrt(t), 1.0)
        return total

    def cuts(self) -> list[float]:
        """The cuts of an integral over y: the ends of panels, and more where a part is long."""
        low = self.panels[0].lo if self.panels else self.top
        geometric = self.top / RATIO ** np.arange(
            1, int(math.log(self.top / low) / math.log(RATIO)) + 1
        )
        return sorted({*(end for p in self.panels for end in (p.lo, p.hi)), *geometric.tolist()})

    def cover(self, lo: float, hi: float) -> None:
        """Panels for every load from lo to hi, where there are none yet."""
        lo, hi = max(lo, LOWEST * self.top), min(hi, self.top)
        panels, gaps = self.panels, []
        k = bisect_right(panels, lo, key=lambda p: p.hi)
        below = panels[k - 1].hi if k else 0.0
        while lo < hi:
            until = panels[k].lo if k < len(panels) else hi
            if lo < until:
                gaps.append((lo, min(until, hi), below))
            if until >= hi:
                break
            lo = below = panels[k].hi
            k += 1
        for start, end, limit in gaps:
            at_break = self._break_below(start, end, limit)
            k = bisect_right(panels, end, key=lambda p: p.hi)
            panels[k:k] = self._resolved(at_break or start, end, at_break > 0.0)

    def _break_below(self, level: float, top: float, limit: float) -> float:
        """The level at which an edge passed the nearest break.

        It is 0 where that is far below the edge, or below `limit`.
        """
        here, there = self._contacts.contact(level).interval, self._contacts.contact(top).interval
        found = [0.0]
        for right in (False, True):
            passed = [
                b
                for b in self._contacts.breaks
                if (
                    self._contacts.touch[1] < b < here.x2
                    if right
                    else here.x1 < b < self._contacts.touch[0]
                )
            ]
            if passed:
                b = max(passed) if right else min(passed)
                moved, since = (
                    (there.x2 - here.x2, here.x2 - b)
                    if right
                    else (here.x1 - there.x1, b - here.x1)
                )
                if since <= moved:
                    found.append(self._contacts.level_at(b, right, here))
        return max(y if max(limit, LOWEST * self.top) < y < level else 0.0 for y in found)

    def _resolved(
        self, lo: float, hi: float, kinked: bool, whole: float = 0.0, below: bool = False
    ) -> list[Panel]:
        """Panels from lo to hi.

        `whole` is the length of all that are asked for, of which a short one may miss more.

        An edge passes a break at lo (`kinked`), at hi (`below`), or neither.
        """
        whole = whole or hi - lo
        inside = self._contacts.passed(lo, hi)
        cut = (
            self._contacts.level_at(
                *inside[len(inside) // 2],
                self._contacts.contact(math.sqrt(lo) * math.sqrt(hi)).interval,
            )
            if inside
            else 0.0
        )
        at_break = lo * (1.0 + SHORTEST) < cut < hi * (1.0 - SHORTEST)
        if not (at_break and len(inside) <= FEW):
            before = math.inf
            for n in SIZES:
                series, missed = self._series(lo, hi, kinked, n)
                if hi - lo <= SHORTEST * lo:
                    return [Panel(lo, hi, kinked, series)]
                # Beside what a front of such a load dissipates
                enough = (COARSE if at_break else FINE) * min(whole, hi) / (hi - lo)
                if missed <= enough or 0.25 * before <= missed <= NOISE:
                    return [Panel(lo, hi, kinked, series)]
                if missed * (missed / before) ** 2 > enough:
                    break  # twice as many points would not be enough
                before = missed
        if not at_break:
            cut = lo * (hi / lo) ** (0.25 if kinked else 0.75 if below else 0.5)
        upper = self._resolved(cut, hi, at_break, whole, below)
        return self._resolved(lo, cut, kinked, whole, at_break) + upper

    def _series(self, lo: float, hi: float, kinked: bool, n: int) -> tuple[Array, float]:
        """The series of a panel, and how large its last coefficients are."""
        s = chebyshev.points(n)
        t = 0.5 * (1.0 + s)
        y = lo * (hi / lo) ** (t * t if kinked else t)
        length = math.log1p((hi - lo) / lo)
        # The slope near where it is 0 is known to rounding of its larger values
        scale = max(NOISELESS * math.sqrt(self.top / hi), 1.0)
        if length > LONG and (
            self._contacts.search.slope.functions or len(self._contacts.breaks) > FEW
        ):
            contacts = [self._contacts.contact(level).interval for level in y.tolist()]
            series = chebyshev.transform(np.log([[c.r / contacts[-1].r for c in contacts]]))[0]
            missed = float(np.abs(series[-TAIL:]).max()) / scale / length
            return np.polynomial.chebyshev.chebder(series) * (
                (1.0 if kinked else 2.0) / length
            ), missed
        values = np.array([self._contacts.rate(level) for level in y.tolist()])
        if kinked:
            values = values * t
        series = chebyshev.transform(values[None, :])[0]
        scale *= float(np.abs(values).max())
        return series, float(np.abs(series[-TAIL:]).max()) / scale if scale else 0.0
