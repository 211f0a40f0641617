"""Growth in which the stick zone recedes at one end at a time, from stage to stage.

An end m ∓ k r of the stick zone advances as long as it moves outwards. Where it would move inwards
it recedes: u(r) is then the place at which what sticks has come to the limit, V(u(r), r) = 0
(`moving_history`), an equation of Abel's kind in which every later state depends on the earlier
ones. It is met at the points of a panel, on which 1 + t1 = (u - m + r)/r is a polynomial in the
panel's variable, by Newton's method; between those points it tells the error. The other end
advances. Where t1 comes back to -k both ends advance again.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError

from .collocation import Collocation, Trial
from .growth import ContactTable, Panel
from .moving_history import MovingHistory, Stage
from .receding_flat import BEYOND, RecedingFlat
from .root_series import RootSeries

Array = NDArray[np.float64]

LOOKS = 48  # places on a panel of the growth where the ends' motion is looked at
MISSED = 1e-8  # of the mean of f p: what V may differ from 0 by between the points
SHORTEST = 1e-9  # of the half-width: a panel that is not cut
ROUGH = 3e-8  # of the mean of f p: what a panel that is not cut may miss
TOLD = 1e-12  # of the half-width: distances of places
AIMS, AIMED = 2, 1e-2  # tries to end a panel on a mark; what one may miss of the load before
AT_MARK = 1e-11  # of the half-width: an end that is so near to a mark is on it
NEAR_MARK, NUDGE = 1e-2, 1e-4  # of the way of an end, of a panel: where its speed is constant
MOST, CUTS = 20, 4  # panels that are tried, and cuts of one: each try takes some tenths of a second
ONSET = 1.0  # of the way since a panel of the growth began: the first panel that recedes
SHORTER, LONGER = 0.4, 2.5  # the next panel, after one that fails or succeeds
FAINT = 1e-13  # of the half-width under the load: a part of the growth that leaves no trace
TURNING = 1e-9  # of the half-width: an end that moves inwards by less is rounding


class March:
    """The stages of a table's contacts, one after another."""

    def __init__(self, flat: RecedingFlat, table: ContactTable) -> None:
        self.flat, self.table = flat, table
        self.stages: list[Stage] = []
        self.k = float(flat.natural.k[0])
        self._length, self.tried = math.inf, 0

    def run(self) -> MovingHistory:
        side = 0.0  # both ends advance
        for panel, centre in zip(self.table.panels, self.table.centres, strict=False):
            r = panel.lo
            while r < panel.hi * (1.0 - FAINT):
                if not side:
                    r, side = self._advance(panel, centre, r)
                else:
                    r, side = self._recede(panel, centre, r, side)
        return MovingHistory(tuple(self.stages))

    def _advance(self, panel: Panel, centre: float, r: float) -> tuple[float, float]:
        """Up to where an end would move inwards: there, and the side of that end (or 0)."""
        part = np.arange(LOOKS + 1) / LOOKS
        looks = r + (panel.hi - r) * part * part
        turns = panel.turn(looks - panel.lo)
        over = np.flatnonzero(np.abs(turns[1:-1]) > self.k)
        stop, side = panel.hi, 0.0
        if over.size:
            j = int(over[0]) + 1
            side = math.copysign(1.0, float(turns[j]))
            stop = self._turning(panel, side, float(looks[j - 1]), float(looks[j]))
            stop = stop if stop > r * (1.0 + FAINT) else r
            # dm/dr may begin like a root where the panel of the growth does
            since = stop - panel.begin
            self._length = ONSET * (since if since > 0.0 else panel.hi - panel.lo)
        if stop > r:
            self.stages.append(Stage(self.flat, panel, centre, r, stop))
        return stop, side

    def _turning(self, panel: Panel, side: float, lo: float, hi: float) -> float:
        """Where dm/dr passes ± k, by bisection; lo where it has passed before."""

        def over(r: float) -> bool:
            turn = float(panel.turn(np.array([r - panel.lo]))[0])
            return side * turn > self.k

        if over(lo):
            return lo
        for _ in range(60):
            middle = 0.5 * (lo + hi)
            lo, hi = (lo, middle) if over(middle) else (middle, hi)
        return hi

    # -- an end that recedes -----------------------------------------------------------------------

    def _recede(self, panel: Panel, centre: float, r: float, side: float) -> tuple[float, float]:
        """One panel of the receding end, as long as it can be."""
        last = self.stages[-1] if self.stages else None
        e, slope = float(self.flat.natural.e[0]), 0.0
        smooth = last is not None and not last.recedes and r > panel.begin
        if last is not None and last.recedes:
            ends = np.array([last.hi - NUDGE * (last.hi - last.lo), last.hi])
            before, e = last.zone(ends).e.tolist()
            slope = (e - before) / (ends[1] - ends[0])
        stop = min(panel.hi, r + self._length)
        if stop > panel.hi - 0.1 * (stop - r):
            stop = panel.hi
        aims, cuts, past = AIMS, 0, None
        while True:
            self.tried += 1
            begin = None if last is None else e
            trial = Trial(self.flat, panel, centre, (r, stop), side, begin, slope, smooth)
            if last is not None and past is None:
                past = self._past(trial)
            stage, missed = Collocation(trial, past, self.table.load).solve()
            met = self._met(stage, past) if past is not None and missed < AIMED else stop
            if aims and met != stop and r < met < panel.hi:
                stop, aims = met, aims - 1
                continue
            cuts += 1
            short = stop - r <= SHORTEST * stop or cuts > CUTS
            if missed <= MISSED or (short and missed <= ROUGH):
                break
            if short or self.tried > MOST:
                raise ContactError(
                    "the contact moves aside faster than it grows, so that an end of its stick "
                    "zone recedes, and where it is in Goodman's approximation is followed up to a "
                    f"half-width of {r:.6g} only, of {self.table.end:.6g}; reduce the load or the "
                    "tilt, or give dundurs = 0 to neglect β"
                )
            stop, aims = r + SHORTER * (stop - r), AIMS
        self._length = LONGER * (stop - r)
        stage, stop, over = self._until_return(stage, stop)
        self._refuse_two(stage)
        self.stages.append(stage)
        return stop, 0.0 if over else side

    def _met(self, stage: Stage, past: RootSeries) -> float:
        """Where the end comes to the first mark, the stage's end where it comes to none."""
        marks = past.ends[1:-1]
        r = np.array([stage.lo, stage.hi - NUDGE * (stage.hi - stage.lo), stage.hi])
        u, before, v = stage.first_end(r).tolist()
        near = NEAR_MARK * (v - u)
        marks = marks[(marks > u) & (marks < v + near)]
        if not marks.size:
            return stage.hi
        missed = float(marks[0]) - v
        if abs(missed) <= AT_MARK * stage.hi:
            return stage.hi
        if abs(missed) <= near:
            return stage.hi + missed * float(r[2] - r[1]) / max(v - before, abs(missed))
        lo, hi = stage.lo, stage.hi
        for _ in range(60):
            middle = 0.5 * (lo + hi)
            below = float(stage.first_end(np.array([middle]))[0]) < marks[0]
            lo, hi = (middle, hi) if below else (lo, middle)
        return hi

    def _past(self, trial: Trial) -> RootSeries:
        """V under the load at which a panel begins, where the end may come on it."""
        history, r, side = MovingHistory(tuple(self.stages)), trial.ends[0], trial.side
        natural = Stage(self.flat, trial.panel, trial.centre, *trial.ends, side)
        looks = r + (trial.ends[1] - r) * np.arange(LOOKS + 1) / LOOKS
        u, a = history.stick(self.stages[-1], r)
        first, second = (u, a) if side > 0.0 else (-a, -u)
        right = float((natural.middle(looks[:1]) + r)[0])
        top = float(natural.first_end(looks).max()) + BEYOND * r * min(self.k, 1.0 - self.k)
        inner = [side * x for x in self.marks()]
        least = first + 10.0 * AT_MARK * r
        pieces = sorted({x for x in (*inner, second, right) if least < x < min(top, right)})
        ends = np.array([first, *pieces, min(top, right)])
        keep = np.append(True, np.diff(ends) > FAINT * self.table.end)
        told = first + TOLD * r

        def lack(y: Array) -> Array:
            # Nearer to the end of the stick zone than doubles tell V is a root of the distance
            V = history.lack(side * np.maximum(y, told), -side)
            return V * np.sqrt(np.clip((y - first) / (told - first), 0.0, 1.0))

        return RootSeries(lack, ends[keep])

    def marks(self) -> list[float]:
        """Places at which an end was when it changed its motion."""
        places: list[float] = []
        breaks = {panel.begin for panel in self.table.panels}
        for number, stage in enumerate(self.stages):
            before = self.stages[max(number - 1, 0)]
            if not number or before.recedes != stage.recedes or stage.lo in breaks:
                places += (stage.side * stage.ends()[:, 0]).tolist()
        return places

    def _until_return(self, stage: Stage, stop: float) -> tuple[Stage, float, bool]:
        """The stage up to where both ends advance again, if they do."""
        rest = float(self.flat.natural.e[0])
        part = np.arange(1, LOOKS + 1) / LOOKS
        r = stage.lo + (stage.hi - stage.lo) * part
        back = np.flatnonzero(stage.zone(r).e > rest)
        if not back.size:
            return stage, stop, False
        j = int(back[0])
        lo, hi = (float(r[j - 1]) if j else stage.lo), float(r[j])
        for _ in range(60):
            middle = 0.5 * (lo + hi)
            if float(stage.zone(np.array([middle])).e[0]) > rest:
                hi = middle
            else:
                lo = middle
        return replace(stage, hi=hi), hi, True

    def _refuse_two(self, stage: Stage) -> None:
        part = np.arange(LOOKS + 1) / LOOKS
        r = stage.lo + (stage.hi - stage.lo) * part
        fall = np.diff(stage.second_end(r))
        if (fall < -TURNING * self.table.end).any():
            raise ContactError(
                "both ends of the stick zone would recede at a half-width of "
                f"{float(r[1:][np.argmin(fall)]):.6g} while the load grows, which Goodman's "
                "approximation is not solved for; change the load, or give dundurs = 0 to neglect β"
            )
