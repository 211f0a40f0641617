"""How the frictionless contact of a symmetric profile grows with its load, as series.

With the integrals of `contact.edges` at a half-width r,

    dP/dr = 2 G r/(1/JL + 1/JR),      G = E*/2.

It is tabulated on panels of r between the half-widths r0 at which the edges pass a break of the
profile. A break leaves powers of (r - r0)^(1/2), so that the series are in v, r = r0 + scale
sinh² v.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sie.contact.edges import Search
from sie.contact.known_contact import Edges
from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval, interval_about
from sie.profiles.power_law import PowerLaw

from .functions import chopped

Array = NDArray[np.float64]

DEGREE = 32
DECAYED = 1e-14  # of a series, its last coefficients
CARRIED = 1e-10  # of the load, at first touch: more than rounding
NEGLIGIBLE = 1e-14  # of the load over the half-width: what a short panel may miss of the pressure
NOISE = 16.0 * EPS  # of the half-width: to so much the places of edges are known
MOST_KINKS = 30  # on a side of the contact: each asks for panels of its own
MOST = 200  # panels: beyond, none is cut
SHORT = 1e-12  # of its half-width: such a panel is not cut
APART = 4.0 * EPS  # of a half-width: breaks that edges pass nearer to each other are one
NOWHERE = 1e-300  # of a panel: v at its beginning


@dataclass(frozen=True, eq=False)
class Panel:
    """dP/dr = r^power Σ w_k T_k(y), y between -1 and 1 in proportion to v.

    lo, hi          half-widths at its ends
    begin, scale    r = begin + scale sinh² v
    corner          whether the edges have passed a corner there: dP/dr is the series over sinh v
    """

    lo: float
    hi: float
    begin: float
    scale: float
    power: float
    load_rates: Array = field(repr=False)
    corner: bool = False

    @property
    def length(self) -> float:
        return self.hi - self.lo

    @cached_property
    def depths(self) -> tuple[float, float]:
        """v at both ends."""
        ends = (self.lo - self.begin) / self.scale, (self.hi - self.begin) / self.scale
        return math.asinh(math.sqrt(ends[0])), math.asinh(math.sqrt(ends[1]))

    def load_rate(self, ahead: Array) -> Array:
        """dP/dr at r = lo + ahead."""
        root = np.sqrt(np.maximum((self.lo - self.begin + ahead) / self.scale, 0.0))
        first, last = self.depths
        place = 2.0 * (np.arcsinh(root) - first) / (last - first) - 1.0
        rate = chebyshev.evaluate(self.load_rates, place)
        if self.corner:
            rate = rate / np.maximum(root, NOWHERE)
        return rate * (self.lo + ahead) ** self.power if self.power else rate


class ContactTable:
    """The contacts of a profile that is symmetric about an axis, up to a given one.

    start, end     half-widths at first touch and under the load
    corner_load    what the corners at both ends of a contact carry that no longer grows
    """

    def __init__(
        self, search: Search, axis: float, edges: Edges, breaks: Array, law: PowerLaw | None
    ) -> None:
        self.search, self.axis, self.law = search, axis, law
        self.end = edges.contact.r
        z1, z2 = search.touch()
        self.start = min(0.5 * (z2 - z1), self.end)
        self._passed = np.zeros(0) if law else breaks - axis
        self.load = self._load(self.end)
        self.corner_load = edges.normal_load - self.load if any(edges.sharp) else 0.0
        grown = 0.0 < self.start < self.end
        # A contact that carries a load at first touch was in several patches then
        if grown and abs(self._load(self.start)) > CARRIED * self.load:
            raise self._unsteady(self.start)

    def _contact(self, r: float) -> Interval:
        return interval_about(self.axis, r)

    def _load(self, r: float) -> float:
        """What a contact carries without its corners."""
        contact = self._contact(r)
        return self.search.load(contact, self.search.integrals(contact))

    @staticmethod
    def _unsteady(r: float) -> ContactError:
        return ContactError(
            f"no contact in one patch of half-width {r:.6g} leads to this one: it does not grow "
            "steadily with the load, as Goodman's approximation needs; give a convex profile, or "
            "dundurs = 0 to neglect β"
        )

    @cached_property
    def panels(self) -> tuple[Panel, ...]:
        """Ascending; () under a flat punch."""
        if self.law is not None:
            m = self.law.exponent
            rate = np.array([m * self.load / self.end * self.end ** (1.0 - m)])
            return (Panel(0.0, self.end, 0.0, self.end, m - 1.0, rate),)
        done: list[Panel] = []
        for begin, end in itertools.pairwise(self.ends):
            todo = [(begin, end)]
            while todo:
                lo, hi = todo.pop()
                panel, missed = self._panel(lo, hi, begin, end - begin)
                enough = missed <= max(NEGLIGIBLE, NOISE * self.end / hi)
                if enough or hi - lo <= SHORT * hi or len(done) + len(todo) > MOST:
                    done.append(panel)
                    continue
                middle = begin + panel.scale * math.sinh(0.5 * sum(panel.depths)) ** 2
                todo += [(middle, hi), (lo, middle)]
        return tuple(done)

    @cached_property
    def ends(self) -> list[float]:
        """Half-widths at first touch, where the edges pass a break, and under the load."""
        if self.end <= self.start * (1.0 + APART):
            return []
        r = self._passed
        r = r[(r > self.start + APART * self.end) & (r < self.end * (1.0 - APART))]
        if len(r) > MOST_KINKS:
            raise ContactError(
                f"the profile has {len(r)} kinks on a side of the contact, and coupling = "
                f"'goodman' takes {MOST_KINKS} at most: fit fewer points or a smooth profile, or "
                "give dundurs = 0 to neglect β"
            )
        ends = [*np.unique(r).tolist(), self.end]
        apart = [b for a, b in itertools.pairwise([self.start, *ends]) if b - a > APART * b]
        return [self.start, *apart]

    def _panel(self, lo: float, hi: float, begin: float, scale: float) -> tuple[Panel, float]:
        """The panel, and what its last coefficients carry of the mean pressure."""
        panel = Panel(lo, hi, begin, scale, 0.0, np.zeros(1), begin > 0.0)
        first, last = panel.depths
        v = first + 0.5 * (last - first) * (1.0 + chebyshev.points(DEGREE))
        half_widths = begin + scale * np.sinh(v) ** 2
        each = [self.search.integrals(self._contact(r)) for r in half_widths.tolist()]
        J = np.array([2.0 / (1.0 / k.JL + 1.0 / k.JR) for k in each])
        rates = self.search.half_modulus * half_widths * J
        if not (rates >= 0.0).all():
            raise self._unsteady(float(half_widths[np.argmin(rates)]))
        series = chebyshev.transform((rates * np.sinh(v) if panel.corner else rates)[None])[0]
        tail = float(np.abs(series[-3:]).max())
        if tail <= DECAYED * float(np.abs(series).max()):
            tail = 0.0
        missed = tail * (hi - lo) / hi * self.end / self.load
        return replace(panel, load_rates=chopped(series)), missed
