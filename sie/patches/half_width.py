"""The load under which the outermost edges of the patches are a given distance apart.

Half that distance r is the half-width of the contact; per period r is half of the shortest interval
that has all patches of a period. At fixed tilt the patches only grow, appear and merge with the
load P, so that r grows with P, and jumps where a patch appears beyond the others. Newton's method
on ln r(ln P) within a bracket finds P: an edge e moves by 2 y_e/D(e) under the charges y of a load.
A bracket that closes around a jump refuses the half-width. Under a given moment r may fall with P
as well, for a light load acts far from x = 0: any load of that half-width is then an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError, LoadError
from sie.numerics.interval import EPS
from sie.progress_bar import reported, step_done

from .newton import conditions, missed
from .of_scene import Problem, changed
from .operator import Found
from .panels import Patches

Array = NDArray[np.float64]

ROUNDING = 4.0  # ulp of the half-width and of an edge: by less no half-width is missed
SETTLED = 1e-9  # of the load: steps below, that stop shrinking, are rounding
# Of the load: to this two loads are told apart on both sides of a jump of r(P) ...
JUMP = 1e-5
LEAST = 1e-11  # ... and where r(P) may be just steep
CLOSER = 0.3  # of the distance in ln r from which the contact of r was not found
SLOW = 3  # steps in which a bracket has to halve
CLOSE = 4.0  # factor of the load: up to this the patches of one load are a start for another ...
CLOSEST = 1.01  # ... and up to this the only one
FIRST, MOST = 4.0, 1e4  # the first and the largest factor of the load towards a bracket
OUTSIDE = 8  # steps one way without a bracket
LAW_MISSED = 0.1  # of the growth of r since the lowest points touched
LIGHTEST = 1e-4  # of the first load: from below it no lighter one is tried
STARTS = 16.0 ** np.array([0, -1, 1, -2, 2, -4, 4, -6, 6])  # at which the first contact is sought
LOADS = 100
# Parts of a step and of a bracket, where the search for patches fails next to an event.
NEARER = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01)
ASIDE = (0.5, 0.3, 0.7, 0.1, 0.9)
SAMPLES = 256  # places of the slope from which the first load is guessed


def _leaves_open(outer: Patches, inner: Patches, width: float) -> bool:
    """Whether patches between some and others, per period, may leave a gap of this width."""
    period = outer.chord.period
    a, b = (np.concatenate((e - period, e, e + period)) for e in (outer.a, outer.b))
    for lo, hi in zip(inner.b, np.append(inner.a[1:], inner.a[0] + period), strict=True):
        near = (b >= lo) & (a <= hi)
        start, stop = np.maximum(a[near], lo), np.minimum(b[near], hi)
        least, most = start - stop[:, None], stop - start[:, None]
        if np.triu((least <= width) & (width <= most)).any():
            return True
    return False


class Ways(NamedTuple):
    """The ways to the contact of a problem.

    whole      whether it is full contact
    near       the patches from those under a close load, None if that does not lead to them
    anywhere   the patches, or ContactError
    """

    whole: Callable[[Problem], bool]
    near: Callable[[Problem, Found], Found | None]
    anywhere: Callable[[Problem], Found]


class Width(NamedTuple):
    """The half-width r under a load over E*/2, d ln r/d ln P, and the patches."""

    load: float
    r: float
    growth: float
    found: Found | None

    @property
    def constant(self) -> bool:
        """Whether it does not change with the load: in full contact, or between sharp edges."""
        return self.found is None or bool(self.found.state.sharp[[0, -1]].all())

    @property
    def rounding(self) -> float:
        """By how much ln r is uncertain."""
        if self.found is None:
            return ROUNDING * EPS
        ends = self.found.state.patches.edges[[0, -1]]
        return ROUNDING * (EPS + float(np.spacing(np.abs(ends)).max()) / self.r)

    def step(self, r: float) -> float:
        """The change of ln P that Newton's method asks for."""
        missed = float(np.log(r / self.r))
        if self.constant or not np.isfinite(self.growth) or self.growth == 0.0:
            return float(np.copysign(np.inf, missed))
        return missed / self.growth

    def lighter(self, r: float) -> float:
        """The change of ln P to a narrower r, -inf if there is none.

        r grows from the distance of the lowest points as the root of a light load; where that
        law misses r by little, the load is not light enough for it.
        """
        grown = 2.0 * self.growth  # of r since these points touched
        left = 1.0 + float(np.expm1(np.log(r / self.r))) / grown if 0.0 < grown < np.inf else 0.0
        return 2.0 * float(np.log(max(left, LAW_MISSED))) if left > -LAW_MISSED else -np.inf


@reported("load of the half-width, trial")
def contact_of_half_width(problem: Problem, ways: Ways) -> tuple[Problem, Found]:
    """The problem with the load of its half-width, and the patches under that.

    Raises ContactError where no load has that half-width.
    """
    search = Search(problem, ways)
    now, factor, last, outside = search.first(), FIRST, np.inf, 0
    sizes, lightest = [np.inf] * SLOW, LIGHTEST * now.load
    for _ in range(LOADS):
        step_done()
        if (direct := search.direct(now)) is not None:
            return direct
        step = now.step(search.r)
        if search.reached(now, step, last) and now.found is not None:
            return changed(problem, load=now.load), now.found
        ends, last = search.bracketed(now), abs(step)
        if ends is None:
            step = now.lighter(search.r) if step < 0.0 else step
            if outside == OUTSIDE or (step == -np.inf and now.load < lightest):
                break
            most, outside = np.log(factor), outside + 1
            now = search.outside(now, float(np.clip(step, -most, most)))
            factor = min(factor**2, MOST)
            continue
        sizes.append(float(np.log(ends[1].load / ends[0].load)))
        if sizes[-1] < (JUMP if search.jumps else LEAST):
            break
        slow = sizes[-1] > 0.5 * sizes[-1 - SLOW]
        now = search.inside(ends, now.load * float(np.exp(step)) if not slow else np.nan)
    raise search.refusal()


class Search:
    """The search for the load of a half-width r, and the nearest found on both sides of r."""

    below: Width | None = None
    above: Width | None = None
    tried = np.inf  # how far off in ln r a contact was that did not lead to that of r

    def __init__(self, problem: Problem, ways: Ways) -> None:
        r = problem.given.half_width
        assert r is not None
        self.problem, self.ways, self.r = problem, ways, r
        lo, hi = problem.domain
        self.widest = 0.5 * (problem.chord.period if problem.chord.periodic else hi - lo)
        if r > self.widest * (1.0 + ROUNDING * EPS):
            whose = "half of the period" if problem.chord.periodic else "that of the indenter"
            raise LoadError(
                f"the half-width {r:.6g} exceeds {whose}, {self.widest:.6g}: give at most that, or "
                "a normal_load"
            )

    def first(self) -> Width:
        """The contact under a load that slopes on the half-width may carry, or one like it."""
        breaks = self.problem.breaks[np.isfinite(self.problem.breaks)]
        first, last = (breaks.min(), breaks.max()) if breaks.size else (0.0, 0.0)
        x = np.linspace(first - self.r, last + self.r, SAMPLES)
        H = self.problem.slope(np.clip(x, *self.problem.domain))
        H = H[np.isfinite(H)] + self.problem.given.tilt
        guess = self.r * (float(np.abs(H).max(initial=0.0)) or 1.0)
        return self.at((guess * STARTS).tolist(), None)

    def direct(self, now: Width) -> tuple[Problem, Found] | None:
        """The patches of the half-width itself, from those of another; None if that fails."""
        off, narrowest = abs(float(np.log(self.r / now.r))), 4.0 * EPS * self.widest
        if now.found is None or now.constant or self.widest - self.r <= narrowest:
            return None
        if off > CLOSER * self.tried:  # it would fail as it did before
            return None
        self.tried = off
        found = self.ways.near(changed(self.problem, load=np.nan), now.found)
        if found is None:
            return None
        given = self.problem.given._replace(load=0.0)
        linear = conditions(found.state, found.operator, given)
        load = float(missed(found.state, found.operator, given, linear)[-2])
        return changed(self.problem, load=load), found

    def at(self, loads: Iterable[float], error: ContactError | None) -> Width:
        """The half-width under the first of some loads for which patches are found."""
        for load in loads:
            try:
                found = self.patches(changed(self.problem, load=load))
            except ContactError as refused:
                error = error or refused
                continue
            return self.width(load, found)
        assert error is not None
        raise error

    def patches(self, asked: Problem) -> Found | None:
        """The patches of a problem; None in full contact."""
        if self.ways.whole(asked):
            return None
        seen = [w for w in (self.below, self.above) if w is not None and w.found is not None]
        apart = [abs(np.log(w.load / asked.given.load)) for w in seen]
        for k in np.argsort(apart):
            if apart[k] < np.log(CLOSE) and (found := self.ways.near(asked, seen[k].found)):
                return found
        if min(apart, default=np.inf) < np.log(CLOSEST):
            raise LoadError("no patches were found next to an event")
        return self.ways.anywhere(asked)

    def width(self, load: float, found: Found | None) -> Width:
        if found is None:
            return Width(load, 0.5 * self.problem.chord.period, 0.0, None)
        state = found.state
        given = self.problem.given._replace(load=load)
        moved = conditions(state, found.operator, given).growth(state, load)
        P, last = state.patches, len(moved) - 1
        whole = P.hull
        if P.chord.periodic:
            last = 2 * int(np.argmax(P.gaps)) + 1
            whole = P.chord.period - float(P.gaps.max())
        growth = float(moved[last] - moved[(last + 1) % len(moved)]) / whole
        return Width(load, 0.5 * whole, growth, found)

    def reached(self, now: Width, step: float, last: float) -> bool:
        missed = abs(float(np.log(self.r / now.r)))
        if missed <= now.rounding:
            if now.constant:
                raise LoadError(self._of_many(now))
            return True
        # The step may ask for less than the load resolves, or for no less than the one before. A
        # bisection is no such step: it leads away. Next to full contact r is steep in the load.
        rounded = abs(step) <= ROUNDING * EPS or 0.5 * last <= abs(step) < SETTLED
        return rounded and missed < SETTLED

    def bracketed(self, now: Width) -> tuple[Width, Width] | None:
        """Half-widths on both sides of r, the lighter load first; None if there are none yet."""
        if now.r < self.r:
            self.below = now
        else:
            self.above = now
        if self.below is None or self.above is None:
            return None
        lighter, heavier = sorted((self.below, self.above), key=lambda w: w.load)
        return lighter, heavier

    def outside(self, now: Width, step: float) -> Width:
        """The half-width after a step of ln P, or a part of that."""
        return self.at([now.load * float(np.exp(part * step)) for part in NEARER], None)

    def inside(self, ends: tuple[Width, Width], wanted: float) -> Width:
        """The half-width under a load between two, the wanted one if it is."""
        lo, hi = ends[0].load, ends[1].load
        others = [lo * (hi / lo) ** part for part in ASIDE]
        try:
            return self.at([wanted, *others] if lo < wanted < hi else others, None)
        except ContactError:
            if hi / lo < CLOSEST:
                raise self.refusal() from None
            raise

    @property
    def jumps(self) -> bool:
        """Whether no lighter load than that of `above` can have the half-width.

        At fixed tilt the outermost edges under a lighter load are on its patches, and not between
        those of `below`; per period so are those of its widest gap. With a moment the tilt may be
        another one.
        """
        if self.problem.given.moment is not None:
            return True
        if not (self.below and self.above and self.below.found and self.above.found):
            return False
        P, inner = self.above.found.state.patches, self.below.found.state.patches
        if P.chord.periodic:
            return not _leaves_open(P, inner, P.chord.period - 2.0 * self.r)
        left, right = P.a <= inner.a[0], P.b >= inner.b[-1]
        least = np.maximum(P.a, inner.b[-1]) - np.minimum(P.b, inner.a[0])[:, None]
        most = P.b - P.a[:, None]
        possible = left[:, None] & right & (least <= 2.0 * self.r) & (2.0 * self.r <= most)
        return not bool(possible.any())

    def refusal(self) -> LoadError:
        """The refusal of a half-width between two that belong to nearly the same load."""
        if self.below is None or self.above is None:
            return LoadError(self._of_none())
        G = self.problem.half_modulus
        low, high = (
            f"{w.r:.12g} at normal_load = {G * w.load:.12g}" for w in (self.below, self.above)
        )
        way, cause = (
            ("jumps", "as a patch of contact appears beyond the others")
            if self.jumps
            else ("rises", "and rounding hides the patches between")
        )
        return LoadError(
            f"no load was found that gives half_width = {self.r:.12g}: it {way} from {low} to "
            f"{high}, {cause}; give normal_load, or a half_width that is not between these"
        )

    def _of_none(self) -> str:
        (seen,) = [w for w in (self.below, self.above) if w is not None]
        side = "narrower than" if seen is self.above else "wider than"
        return (
            f"no load gives half_width = {self.r:.6g}: none was found under which the contact is "
            f"{side} {seen.r:.6g}, which it is at normal_load = "
            f"{self.problem.half_modulus * seen.load:.6g}: give normal_load"
        )

    def _of_many(self, now: Width) -> str:
        kind = "full contact has" if now.found is None else "a contact with sharp edges has"
        return (
            f"{kind} half_width = {self.r:.6g} under many loads, normal_load = "
            f"{self.problem.half_modulus * now.load:.6g} is one of them: give normal_load"
        )
