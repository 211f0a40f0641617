"""How the frictionless contact of any profile grows with its load, as series in its half-width.

With x1, x2 = m ∓ r and the integrals of `contact.edges`, a contact of half-width r at a given tilt
has I0 = 0, which fixes its centre m, and

    dP/dr = 2 G r/(1/JL + 1/JR),      dm/dr = (JL - JR)/(JL + JR),      G = E*/2.

Both are tabulated on panels of r between the half-widths r0 at which an edge passes a break of the
profile. A break leaves powers of (r - r0)^(1/2), which grow in proportion to the distance from
there beyond a scale of their own, so that the series are in v, r = r0 + scale sinh² v.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import EdgeIntegrals
from sie.errors import ContactError
from sie.friction.coupled.tables import chopped, summed
from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval
from sie.profiles.power_law import PowerLaw

Array = NDArray[np.float64]

DEGREE = 32
DECAYED = 1e-14  # of a series, its last coefficients
CARRIED = 1e-10  # of the load, at first touch: more than rounding
NEGLIGIBLE = 1e-14  # of the load over the half-width: what a short panel may miss of the pressure
NOISE = 16.0 * EPS  # of the half-width: to so much the places of edges are known
MOST_BREAKS = 12  # each asks for panels of its own, and for minutes where they are many
MOST = 200  # panels: beyond, none is cut
NEAR = 1e-8  # of the way to the next break: where dm/dr is looked at, behind a break
SHORT = 1e-12  # of its half-width: such a panel is not cut
SHORTEST = 1e-6  # of the first panel: what is cut further may grow to one side alone
NEWTONS, SETTLED = 60, 4.0 * EPS
NOWHERE = 1e-300  # of a panel: v at its beginning


@dataclass(frozen=True, eq=False)
class Panel:
    """dP/dr = r^power Σ w_k T_k(y) and dm/dr = Σ m_k T_k(y), y between -1 and 1 in proportion to v.

    lo, hi          half-widths at its ends
    begin, scale    r = begin + scale sinh² v
    corner          whether both edges have passed a corner there: dP/dr is the series over sinh v
    """

    lo: float
    hi: float
    begin: float
    scale: float
    power: float
    load_rates: Array = field(repr=False)
    turns: Array = field(repr=False)
    corner: bool = False

    @property
    def length(self) -> float:
        return self.hi - self.lo

    @cached_property
    def depths(self) -> tuple[float, float]:
        """v at both ends."""
        ends = (self.lo - self.begin) / self.scale, (self.hi - self.begin) / self.scale
        return math.asinh(math.sqrt(ends[0])), math.asinh(math.sqrt(ends[1]))

    def _root(self, ahead: Array) -> Array:
        """The root of (r - begin)/scale at r = lo + ahead."""
        root: Array = np.sqrt(np.maximum((self.lo - self.begin + ahead) / self.scale, 0.0))
        return root

    def _place(self, root: Array) -> Array:
        first, last = self.depths
        place: Array = 2.0 * (np.arcsinh(root) - first) / (last - first) - 1.0
        return place

    def load_rate(self, ahead: Array) -> Array:
        """dP/dr at r = lo + ahead."""
        root = self._root(ahead)
        rate = summed(self.load_rates, self._place(root))
        if self.corner:
            rate = rate / np.maximum(root, NOWHERE)
        return rate * (self.lo + ahead) ** self.power if self.power else rate

    def turn(self, ahead: Array) -> Array:
        """dm/dr there."""
        return summed(self.turns, self._place(self._root(ahead)))

    @cached_property
    def _shifts(self) -> Array:
        """The series of m less that at lo."""
        y = chebyshev.points(2 * DEGREE)
        half = 0.5 * (self.depths[1] - self.depths[0])
        v = self.depths[0] + half * (1.0 + y)
        rates = summed(self.turns, y) * half * self.scale * np.sinh(2.0 * v)
        series: Array = chebyshev.antiderivative(chopped(chebyshev.transform(rates), EPS))
        return series

    def moved(self, ahead: Array, by: Array) -> Array:
        """m(lo + ahead + by) - m(lo + ahead), to relative accuracy however small `by` is."""
        if not self.turns.any():
            return np.zeros(np.broadcast(ahead, by).shape)
        a, b = self._root(ahead), self._root(ahead + by)
        across = b * np.sqrt(1.0 + a * a) + a * np.sqrt(1.0 + b * b)
        step = np.arcsinh(by / (self.scale * np.maximum(across, NOWHERE)))
        rise = chebyshev.quotient(self._shifts, self._place(a), self._place(b))
        return step * rise * (2.0 / (self.depths[1] - self.depths[0]))


class Search(Protocol):
    """The search for contacts of one profile, as far as its growth needs it."""

    half_modulus: float
    axis: float | None

    def touch(self) -> tuple[float, float]: ...

    def integrals(self, contact: Interval) -> EdgeIntegrals: ...

    def load(self, contact: Interval, k: EdgeIntegrals) -> float: ...


class Edge(Protocol):
    """The contact under the load, which edges are sharp, P and the tilt."""

    @property
    def contact(self) -> Interval: ...

    @property
    def sharp(self) -> tuple[bool, bool]: ...

    @property
    def normal_load(self) -> float: ...

    @property
    def tilt(self) -> float: ...


class ContactTable:
    """The contacts of a scene's profile, at the tilt of a normal contact, up to that contact.

    start, end              half-widths at first touch and under the load
    first_centre, middle    centres of the contact then
    stick                   the part of a contact that sticks
    corner_load             what the corners at both ends of a contact carry that no longer grows
    cornered                whether an edge of an unsymmetric contact is at a corner
    """

    def __init__(
        self,
        search: Search,
        edges: Edge,
        breaks: list[float],
        law: PowerLaw | None = None,
        stick: float = 1.0,
    ) -> None:
        self.search, self.stick = search, stick
        self.middle, self.end = edges.contact.m, edges.contact.r
        z1, z2 = self.search.touch()
        self.start = min(0.5 * (z2 - z1), self.end)
        upright = edges.tilt == 0.0 and self.search.axis is not None
        self.law = law if upright else None
        self.corner_load = 0.0
        self.cornered = any(edges.sharp) and self.search.axis is None
        if any(edges.sharp) and not self.cornered:
            whole = self.search.load(edges.contact, self.search.integrals(edges.contact))
            self.corner_load = edges.normal_load - whole
        self.first_centre = 0.5 * (z1 + z2)
        self._breaks: list[float] = [] if self.law else breaks
        if self.start:
            self._refuse_other_starts()

    def contact(self, r: float, near: float) -> tuple[float, EdgeIntegrals]:
        """The centre of the contact of half-width r, from one near to it, and its integrals."""
        if self.search.axis is not None:
            m = self.search.axis
            return m, self.search.integrals(Interval(m - r, m + r))
        # The weighted mean I0 of the slope rises with m: 0 lies between two contacts of this width
        # that both hold the place of first touch
        m, lo, hi = near, self.first_centre - r, self.first_centre + r
        before, nearest = math.inf, SETTLED * max(self.end, abs(m))
        for _ in range(NEWTONS):
            m = m if lo <= m <= hi else 0.5 * (lo + hi)
            k = self.search.integrals(Interval(m - r, m + r))
            lo, hi = (m, hi) if k.I0 < 0.0 else (lo, m)
            # Where all of the contact is straight there is no tangent
            tangent = k.JL > 0.0 and k.JR > 0.0
            step = -2.0 * k.I0 / (k.JL + k.JR) if tangent else math.inf
            # The slope of a trace is known to rounding of the whole contact
            if abs(step) <= nearest or (tangent and hi - lo <= nearest):
                return m + min(max(step, lo - m), hi - m), k
            # Next to a corner tangents are steep, and lead back and forth
            m = m + step if abs(step) <= 0.5 * before else 0.5 * (lo + hi)
            before = abs(step)
        raise self._unsteady(r)

    @staticmethod
    def _unsteady(r: float) -> ContactError:
        return ContactError(
            f"no contact in one patch of half-width {r:.6g} leads to this one: it does not grow "
            "steadily with the load, as Goodman's approximation needs; give a convex profile, or "
            "dundurs = 0 to neglect β"
        )

    def _refuse_other_starts(self) -> None:
        """Raises ContactError where the contact at first touch carries a load.

        It was then in several patches.
        """
        contact = Interval(self.first_centre - self.start, self.first_centre + self.start)
        if self.start < self.end:
            carried = self.search.load(contact, self.search.integrals(contact))
            if abs(carried) > CARRIED * self._mean_pressure * self.end:
                raise self._unsteady(self.start)

    @cached_property
    def panels(self) -> tuple[Panel, ...]:
        """Ascending; () under a flat punch."""
        if self.cornered:
            raise ContactError(
                "the contact is not symmetric and has reached a corner of the indenter: its "
                "stick zone would recede there while the load grows, which Goodman's "
                "approximation does not solve; give a profile that is symmetric, or smooth at "
                "both edges"
            )
        if self.law is not None:
            m = self.law.exponent
            rate = np.array([m * self._mean_pressure * self.end ** (1.0 - m)])
            return (Panel(0.0, self.end, 0.0, self.end, m - 1.0, rate, np.zeros(1)),)
        done: list[Panel] = []
        for begin, end in itertools.pairwise(self.ends):
            scale = self._scale(begin, end)
            todo = [(begin, end)]
            while todo:
                lo, hi = todo.pop()
                panel, missed = self._panel(lo, hi, begin, scale)
                short = hi - lo <= SHORT * hi
                if (
                    short
                    or missed <= max(NEGLIGIBLE, NOISE * self.end / hi)
                    or len(done) + len(todo) > MOST
                ):
                    done.append(panel)
                    continue
                if hi < SHORTEST * self.ends[1]:
                    self._refuse_one_sided(panel)
                middle = begin + scale * math.sinh(0.5 * sum(panel.depths)) ** 2
                todo += [(middle, hi), (lo, middle)]
        return tuple(done)

    def _refuse_one_sided(self, first: Panel) -> None:
        """Raises ContactError where one edge stays behind as the contact begins to grow.

        It does so where h' jumps on one side only, or has unlike powers on both: dm/dr is then ± 1.
        """
        moved = float(first.moved(np.zeros(1), np.array([first.length]))[0])
        if abs(moved) > self.stick * first.length:
            raise ContactError(
                f"the profile rises with unlike powers of the distance on both sides of x = "
                f"{self.first_centre:.6g}, where it touches first: the contact grows to one side "
                "alone there, so that its stick zone would recede, which Goodman's approximation "
                "does not solve; give a profile whose slope goes with one power on both sides, or "
                "dundurs = 0 to neglect β"
            )

    def _scale(self, begin: float, end: float) -> float:
        """A distance from the half-width at which an edge passes a break: dm/dr changes by one."""
        length = end - begin
        if not begin or self.search.axis is not None:
            return length
        steps = length * np.array([1.0, 4.0]) * NEAR
        near, far = (self._turn_at(begin + step) for step in steps.tolist())
        # dm/dr goes with the root of the distance
        return float(
            np.clip(NEAR * length / max(far - near, near - far, NEAR) ** 2, NEAR * length, length)
        )

    @cached_property
    def ends(self) -> list[float]:
        """Half-widths at first touch, where an edge passes a break, and under the load."""
        if self.end <= self.start * (1.0 + SETTLED):
            return []
        passed = {self.start, self.end}
        inside = sum(abs(x - self.middle) < self.end for x in self._breaks)
        if self.search.axis is None and inside > MOST_BREAKS:
            raise ContactError(
                f"the contact holds {inside} places where the profile or a derivative jumps, and "
                "Goodman's approximation follows the growth of a contact without symmetry past "
                f"{MOST_BREAKS} of them at most; fit fewer points or a smooth profile, or give "
                "dundurs = 0 to neglect β"
            )
        for x in self._breaks:
            for side in (-1.0, 1.0):
                r = self._passing(x, side)
                # The place of first touch is known to rounding of the contact
                if self.start + SETTLED * self.end < r < self.end * (1.0 - SETTLED):
                    passed.add(r)
        ends = sorted(passed)
        apart = [b for a, b in itertools.pairwise(ends) if b - a > SETTLED * b]
        return [self.start, *apart]

    def _passing(self, x: float, side: float) -> float:
        """The half-width at which this edge is at x, 0 where it does not pass it."""
        if self.search.axis is not None:
            return side * (x - self.search.axis)
        if not side * (x - self.first_centre) > self.start:
            return 0.0
        if not side * (self.middle - x) + self.end > 0.0:
            return 0.0
        from scipy.optimize import brentq  # noqa: PLC0415 -- heavy, and for few profiles only

        def mean_slope(r: float) -> float:
            other = x - 2.0 * side * r
            return self.search.integrals(Interval(min(x, other), max(x, other))).I0

        # This edge stays while the other one, which is told well, passes from the place of first
        # touch to its last place
        least, most = side * (x - self.first_centre), side * (x - self.middle) + self.end
        return float(brentq(mean_slope, 0.5 * least, 0.5 * most, xtol=EPS * self.end, rtol=SETTLED))

    def _near(self, r: float) -> float:
        part = (r - self.start) / (self.end - self.start)
        return self.first_centre + part * (self.middle - self.first_centre)

    def _panel(self, lo: float, hi: float, begin: float, scale: float) -> tuple[Panel, float]:
        corner = self.search.axis is not None and begin > 0.0
        panel = Panel(lo, hi, begin, scale, 0.0, np.zeros(1), np.zeros(1), corner)
        first, last = panel.depths
        v = first + 0.5 * (last - first) * (1.0 + chebyshev.points(DEGREE))
        half_widths = begin + scale * np.sinh(v) ** 2
        rates, turns = np.empty(DEGREE), np.zeros(DEGREE)
        m, G, before = self._near(float(half_widths[-1])), self.search.half_modulus, 0.0
        for j, r in reversed(list(enumerate(half_widths.tolist()))):
            if before:
                m += float(turns[j + 1]) * (r - before)
            (m, k), before = self.contact(r, m), r
            rates[j] = 2.0 * G * r / (1.0 / k.JL + 1.0 / k.JR)
            if self.search.axis is None:
                turns[j] = (k.JL - k.JR) / (k.JL + k.JR)
        if not (rates >= 0.0).all():
            raise self._unsteady(float(half_widths[np.argmin(rates)]))
        if corner:
            rates = rates * np.sinh(v)
        series = chebyshev.transform(np.stack((rates, turns)))
        of_rate, of_turn = np.abs(series[:, -3:]).max(axis=1).tolist()
        if of_rate <= DECAYED * np.abs(series[0]).max():
            of_rate = 0.0
        if of_turn <= DECAYED:
            of_turn = 0.0
        part = (hi - lo) / hi
        missed = of_rate * part / self._mean_pressure + of_turn * part * (hi - lo) / self.end
        return replace(panel, load_rates=chopped(series[0]), turns=chopped(series[1])), missed

    def _turn_at(self, r: float) -> float:
        """dm/dr."""
        _, k = self.contact(r, self._near(r))
        return (k.JL - k.JR) / (k.JL + k.JR)

    @cached_property
    def centres(self) -> tuple[float, ...]:
        """The centres where the panels begin, and at the end, from that of the whole contact."""
        moves = [float(p.moved(np.zeros(1), np.array([p.length]))[0]) for p in self.panels]
        back = [-sum(moves[k:]) for k in range(len(moves))]
        return *back, 0.0

    @property
    def _mean_pressure(self) -> float:
        return self.load / self.end

    @cached_property
    def load(self) -> float:
        """What the contact carries without its corners."""
        contact = Interval(self.middle - self.end, self.middle + self.end)
        return self.search.load(contact, self.search.integrals(contact))
