"""The contact of dissimilar bodies under a normal load alone.

Its zones are those of a flat punch on the same contact. With the slip gradient that growing left
where the bodies stick (`frozen`) they make a state like any other; slip and dissipated energy are
integrals over the growth.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import Interval

from .fields import Fields
from .frozen import Frozen, Gradient
from .pieces import FINE, Pieces
from .search import state_of
from .state import HalfSlope, Question
from .step import Loaded
from .view import View

if TYPE_CHECKING:
    from sie.profiles.slope import Slope

    from .flat import FlatPunch

Array = NDArray[np.float64]

WINDOW = 1.3  # half-widths from the middle: what no contact under Q leaves
STAYED = 1e-9  # half-widths: by less a middle has not moved
LIGHTER = 0.9  # of the growth beyond the flat base: what sticks then sticks already
PARTS: Array = np.linspace(0.0625, 0.9375, 8)  # of a slip zone, at which slip is tested
TOLD = 1e-7  # of the contact: places in narrower slip zones are not told by x
# Places of s between two kinks at which the power of friction is summed, and the root of the
# distance from a kink in which it is smooth
ENERGY_NODES, FOLD = 12, 3.0
FEW, MANY_NODES = 4, 32  # kinks; and places where there are more


@dataclass(frozen=True, eq=False)
class Pressed(View):
    """What a contact that grew and a flat punch have in common.

    flat            functions of the flat punch; |β| and f
    load            P
    sign            of β
    half_modulus    E*/2
    friction        f of the scene; where nothing would slip that of `flat` is smaller
    half_width      of the contact
    """

    flat: FlatPunch
    load: float
    sign: float
    half_modulus: float
    friction: float
    half_width: float

    shift = strain_kept = 0.0

    @cached_property
    def contact(self) -> Interval:
        middle, b = self.middle, self.half_width
        return Interval(middle - b, middle + b)

    @property
    def middle(self) -> float:
        """That of the contact."""
        return self.origin

    @property
    def kept(self) -> tuple[tuple[float, float], Any]:
        """What stuck under a lighter load, and the state under that."""
        raise NotImplementedError

    @property
    def energy(self) -> float:
        """The dissipated energy."""
        raise NotImplementedError

    @property
    def full_stick(self) -> bool:
        """Whether the slip zones are narrower than a part FULL_STICK of the contact."""
        return self.flat.bonded

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        return (self.contact[:2],) if self.full_stick else super().stick

    @property
    def slip_width(self) -> float:
        """The width of each zone of slip, to full relative accuracy."""
        return 0.0 if self.full_stick else self.flat.rest * self.half_width

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        return () if self.full_stick else super().slip_zones

    @property
    def kind(self) -> str:
        """The slip under a normal load alone, in words."""
        if self.full_stick:
            return "full stick, its zones narrower than 1e-15 of the contact; β couples p and q"
        way = "outwards" if self.sign > 0.0 else "inwards"
        return f"{way} on both sides while the normal load grew; β couples p and q"

    @cached_property
    def least_slip(self) -> float:
        """The least slip outwards in a slip zone, over the largest."""
        if self.flat.rest < TOLD:
            return 0.0
        ends = self.loaded.zones.ends
        inner = ends[[1, 2]][:, None] + (ends[[0, 3]] - ends[[1, 2]])[:, None] * PARTS
        slip = self._slip(inner.ravel()) * np.repeat((-1.0, 1.0), len(PARTS))
        return min(0.0, float(slip.min() / np.abs(slip).max()))

    def rate(self) -> float:
        """∫ f p g^ dx over the slip zones, g^ the slip of a flat punch under P = 1."""
        state, flat = self.loaded.state, self.flat
        at, q = state.halfway, state.shear_halfway
        edges = -state.pieces.from_cut(at, len(state.pieces.cuts) - 1), state.pieces.from_cut(at, 0)
        e, right = np.minimum(*edges), edges[0] < edges[1]
        slips = ~state.sticks(at)
        inner = [np.abs(state.pieces.from_cut(at, k)) for k in state.pieces.cut_of_ends[[1, 2]]]
        from_c = np.where(right, inner[1], inner[0])[slips] / self.half_width
        g = flat.slip(from_c, e[slips] / self.half_width)
        return float((at.weight * np.abs(q))[slips] @ g)


@dataclass(frozen=True, eq=False)
class Grown(Pressed):
    """A contact that grew.

    frozen      integrals over all contacts
    events      half-widths at which the growth began, or an edge passed a kink of the profile
    slope       h'
    """

    frozen: Frozen
    events: tuple[float, ...]
    slope: Slope

    @property
    def middle(self) -> float:
        return self.frozen.middle(self.half_width)

    @property
    def base(self) -> float:
        """Half the width of the flat base."""
        return self.events[0]

    @property
    def axis(self) -> float:
        """The middle if it stayed, as under a symmetric profile; nan if it moved."""
        moved = abs(self.middle - self.origin) > STAYED * self.half_width
        return math.nan if moved else self.origin

    @cached_property
    def origin(self) -> float:  # type: ignore[override]
        """The place that touched first, or the middle of the flat base."""
        return self.frozen.panels[0].middle

    @cached_property
    def marks_of_growth(self) -> tuple[float, ...]:
        return self.frozen.marks(self.events)

    @cached_property
    def gradient(self) -> Gradient:
        """γ where the bodies stick."""
        c, m = self.flat.c * self.half_width, self.middle
        stick = m - c, m + c
        return Gradient(self.frozen, self.marks_of_growth, stick, self.axis)

    @cached_property
    def loaded(self) -> Loaded:  # type: ignore[override]
        """The state about the origin."""
        s, flat, origin, gradient = self.half_width, self.flat, self.origin, self.gradient
        m = self.middle - origin
        slope = self.slope.shifted(-origin) if origin else self.slope
        window = m - WINDOW * s, m + WINDOW * s
        half = HalfSlope(slope, self.half_modulus, window)
        question = Question(
            flat.beta,
            flat.friction,
            half,
            lambda x: gradient(x + origin),
            self.load,
            0.0,
            flat.approximate,
        )
        marks = (x - origin for x in self.marks_of_growth)
        pieces = Pieces(
            m - s,
            (flat.rest * s, 2.0 * flat.c * s, flat.rest * s),
            (-1, 0, 1),
            tuple(x for x in marks if m - s < x < m + s),
            half.kinks,
            flat.theta,
            FINE,
        )
        return Loaded(Fields(state_of(pieces, question)), 0.0, 0.0, friction=self.friction)

    def rows(self, x: Array, rest: Array | None = None) -> Array:
        """Rows of p and q in contact; at a tip of the profile p is infinite, and q is told as 0."""
        rows = super().rows(x, rest)
        if self.frozen.panels[0].power == 0.0:
            rows[0, x == self.origin], rows[1, x == self.origin] = np.inf, 0.0
        return rows

    def _slip(self, x: Array) -> Array:
        at, base, g = x + self.origin, self.frozen.base, np.zeros(len(x))
        for side, own in ((1.0, at > base[1]), (-1.0, at < base[0])):
            if own.any():
                g[own] = side * self.frozen.slip(at[own], side, self.half_width)
        return g

    @property
    def kept(self) -> tuple[tuple[float, float], Grown]:
        """What stuck under a lighter load, and the state under that."""
        before = self.at(self.base + LIGHTER * (self.half_width - self.base))
        return before.stick[0], before

    def at(self, s: float) -> Grown:
        """The state when the contact was so wide."""
        before = replace(self, half_width=s, load=self.frozen.load(s))
        before.__dict__["gradient"] = self.gradient
        return before

    @cached_property
    def energy(self) -> float:
        """The dissipated energy: ∫ f p |dg| over both slip zones, while P grew.

        The kinks of traces are many and faint: they only cost.

        Of slip zones below 1e-8 of the contact it is known to within 1e-16 P²/E* only.
        """
        many = len(self.events) > FEW
        events = self.events[:1] if many else self.events
        nodes, total = MANY_NODES if many else ENERGY_NODES, 0.0
        end = self.half_width
        passings = self.frozen.passings(events, end)
        cuts = sorted({*events, *(s for s in passings if s < end), end})
        first = self.frozen.panels[0]
        for lo, hi in itertools.pairwise(cuts):
            start = lo == cuts[0]
            # a broken power of the distance from a kink is smooth in the root of its FOLD
            fold = FOLD if len(cuts) > 2 or lo else 1.0
            power = (1.0 + first.power if lo else 2.0 * first.power + 2.0) if start else 1.0
            x, _, weight = with_weight(nodes, 0.0, fold * power - 1.0)
            s, part = lo + (hi - lo) * x**fold, fold * (hi - lo) * weight * x ** (fold - 1.0)
            rates = np.array([self.at(width).rate() for width in s.tolist()])
            total += float((part * self.frozen.rate(s)) @ rates)
        return total / self.half_modulus


@dataclass(frozen=True, eq=False)
class Flat(Pressed):
    """A flat punch, whose edges are corners.

    origin      its middle
    """

    origin: float
    sharp = True

    @property
    def axis(self) -> float:
        return self.origin

    @cached_property
    def loaded(self) -> Loaded:  # type: ignore[override]
        state = self.flat.state(self.half_width, self.load)
        return Loaded(Fields(state), 0.0, 0.0, friction=self.friction)

    def _slip(self, x: Array) -> Array:
        t, flat = np.abs(x) / self.half_width, self.flat
        slips, g = t > flat.c, np.zeros(len(x))
        e = np.maximum((self.half_width - np.abs(x[slips])) / self.half_width, 1e-300)
        g[slips] = self.load * flat.slip(np.maximum(flat.rest - e, 1e-300), e)
        return np.sign(x) * g

    @property
    def kept(self) -> tuple[tuple[float, float], None]:
        """What stuck from the first."""
        return self.stick[0], None

    @cached_property
    def energy(self) -> float:
        """The dissipated energy: p and the slip grow with the load."""
        return 0.5 * self.load * self.rate() / self.half_modulus
