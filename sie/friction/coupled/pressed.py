"""The contact of dissimilar bodies under a normal load alone.

Its zones are those of a flat punch on the same contact. With the slip gradient that growing left
where the bodies stick (`frozen`) they make a state like any other; slip and dissipated energy are
integrals over the growth.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.clenshaw_curtis import integral
from sie.numerics.graded_panels import Pieces as Series
from sie.numerics.graded_panels import Rule
from sie.numerics.interval import Interval

from .fields import Fields
from .frozen import Frozen
from .pieces import FINE, Pieces
from .search import state_of
from .state import HalfSlope, Question
from .step import Loaded

if TYPE_CHECKING:
    from .flat import FlatPunch

Array = NDArray[np.float64]

LIGHTER = 0.9  # of the growth beyond the flat base: what sticks then sticks already
PARTS: Array = np.linspace(0.0625, 0.9375, 8)  # of a slip zone, at which slip is tested
ENERGY = 2e-8  # of the energy of pressing, what its sums differ by
TOLD = 1e-7  # of the contact: places in narrower slip zones are not told by x


@dataclass(frozen=True, eq=False)
class Pressed:
    """A flat punch, and what it has in common with a contact that grew.

    flat            functions of the flat punch; |β| and f
    load            P
    friction        f of the scene; where nothing would slip that of `flat` is smaller
    half_width      of the contact
    origin          of the places of the state: the middle
    """

    flat: FlatPunch
    load: float
    friction: float
    half_width: float
    origin: float

    sharp = True  # whether the edges are corners, where the tractions are infinite
    tip = False  # whether the profile has a tip at the origin, where p is infinite

    @property
    def middle(self) -> float:
        """That of the contact."""
        return self.origin

    @property
    def contact(self) -> Interval:
        middle, b = self.middle, self.half_width
        return Interval(middle - b, middle + b)

    @cached_property
    def loaded(self) -> Loaded:
        """The state about the origin."""
        state = self.flat.state(self.half_width, self.load)
        return Loaded(Fields(state), 0.0, 0.0, friction=self.friction)

    @property
    def lighter(self) -> Pressed | None:
        """The state under a lighter load whose stick zone is looked at, or None at the first."""
        return None

    def slip(self, x: Array) -> Array:
        """E*/2 times the slip since touch for β > 0, at places about the origin."""
        t, flat = np.abs(x) / self.half_width, self.flat
        slips, g = t > flat.c, np.zeros(len(x))
        e = np.maximum((self.half_width - np.abs(x[slips])) / self.half_width, 1e-300)
        g[slips] = self.load * flat.slip(np.maximum(flat.rest - e, 1e-300), e)
        return np.sign(x) * g

    @cached_property
    def least_slip(self) -> float:
        """The least slip outwards in a slip zone, over the largest."""
        if self.flat.rest < TOLD:
            return 0.0
        ends = self.loaded.zones.ends
        inner = ends[[1, 2]][:, None] + (ends[[0, 3]] - ends[[1, 2]])[:, None] * PARTS
        slip = self.slip(inner.ravel()) * np.repeat((-1.0, 1.0), len(PARTS))
        return min(0.0, float(slip.min() / np.abs(slip).max()))

    def rate(self) -> float:
        """∫ f p g^ dx over the slip zones, g^ the slip of a flat punch under P = 1."""
        state, b, total = self.loaded.state, self.half_width, 0.0
        pieces, friction, last = state.pieces, state.question.friction, len(state.pieces.cuts) - 1
        for zone, edge, inner in ((0, 0, 1), (2, last, 2)):
            at = state.halfway.chosen(state.halfway.zone == zone)
            cuts = pieces.cut_of_ends[inner], edge
            from_c, e = (np.abs(pieces.from_cut(at, int(cut))) / b for cut in cuts)
            lost = friction * at.weight * state.pressure_in_slip(at)
            total += float(lost @ self.flat.slip(from_c, e))
        return total

    @cached_property
    def energy(self) -> float:
        """E*/2 times the dissipated energy: p and the slip of a flat punch grow with the load."""
        return 0.5 * self.load * self.rate()


@dataclass(frozen=True, eq=False)
class Grown(Pressed):
    """A contact that grew.

    origin      the place that touched first, or the middle of the flat base
    frozen      integrals over all contacts
    events      half-widths at which the growth began, or an edge passed a kink of the profile
    slope       H1: E*/2 h' about the origin
    """

    frozen: Frozen
    events: tuple[float, ...]
    slope: HalfSlope

    sharp = False

    @property
    def tip(self) -> bool:  # type: ignore[override]
        return self.frozen.panels[0].power == 0.0

    @property
    def middle(self) -> float:
        return self.frozen.middle(self.half_width)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places about the origin where γ is not smooth."""
        return tuple(x - self.origin for x in self.frozen.marks(self.events))

    @cached_property
    def gradient(self) -> tuple[Series, Series]:
        """γ where the bodies stick, on both sides of what stuck from the first."""
        m, c = self.middle - self.origin, self.flat.c * self.half_width
        inner = [base - self.origin for base in self.frozen.base]
        found = []
        for side, base, end in zip((-1.0, 1.0), inner, (m - c, m + c), strict=True):
            lo, hi = sorted((base, end))
            cuts = np.array([lo, *(x for x in self.marks if lo < x < hi), hi])

            def values(rule: Rule, side: float = side) -> Array:
                return self.frozen.gradient(rule.x + self.origin, side)

            found.append(Series.fitted(np.stack((cuts[:-1], cuts[1:]), axis=1), values))
        return found[0], found[1]

    def locked_in(self, x: Array) -> Array:
        """γ at places about the origin where the bodies stick."""
        left, right = self.gradient
        first, last = left.ends[0, 0], right.ends[-1, 1]
        values: Array = left(np.maximum(x, first)) + right(np.minimum(x, last))
        return values

    @cached_property
    def loaded(self) -> Loaded:
        s, flat, m = self.half_width, self.flat, self.middle - self.origin
        gamma, approximate = self.locked_in, flat.approximate
        question = Question(
            flat.beta, flat.friction, self.slope, gamma, self.load, 0.0, approximate
        )
        widths = flat.rest * s, 2.0 * flat.c * s, flat.rest * s
        marks = tuple(x for x in self.marks if m - s < x < m + s)
        pieces = Pieces(m - s, widths, (-1, 0, 1), marks, self.slope.kinks, flat.theta, FINE)
        return Loaded(Fields(state_of(pieces, question)), 0.0, 0.0, friction=self.friction)

    def slip(self, x: Array) -> Array:
        at, base, g = x + self.origin, self.frozen.base, np.zeros(len(x))
        for side, own in ((1.0, at > base[1]), (-1.0, at < base[0])):
            if own.any():
                g[own] = side * self.frozen.slip(at[own], side, self.half_width)
        return g

    @property
    def lighter(self) -> Grown:
        base = self.events[0]
        return self.at(base + LIGHTER * (self.half_width - base))

    def at(self, s: float) -> Grown:
        """The state when the contact was so wide."""
        before = replace(self, half_width=s, load=self.frozen.load(s))
        before.__dict__["gradient"] = self.gradient
        return before

    @cached_property
    def energy(self) -> float:
        """E*/2 times the dissipated energy: ∫ f p |dg| over both slip zones, while P grew.

        Of slip zones below 1e-8 of the contact it is known to within 1e-16 P²/E* only.
        """

        def power(s: float) -> float:
            return self.frozen.rate(s) * self.at(s).rate()

        cuts = (*self.events, self.half_width)
        parts = [integral(power, lo, hi, ENERGY) for lo, hi in itertools.pairwise(cuts)]
        if None in parts:
            raise ContactError(
                "the energy of pressing is known to less than 1e-6: smooth the profile"
            )
        return sum(part for part in parts if part)
