"""The shear and the slip of Goodman's approximation while the normal load grows.

The pressure is that without friction, whose increment under dP is that of a flat punch of the
present contact m ∓ r. Where the slip in stick stays, so is the increment of the shear, so that with
t = (x - m)/r and the flat's functions (`functions`), over all r that reach x,

    q(x) = f ∫ ρ(t) φ(t) dP/r,      g(x) = 2/E* ∫ ĝ(t) dP over r with |t| > k,

ρ = ±1 in slip and q/(f p) of the flat in stick. This holds for unsymmetric contacts as well, as
long as both ends m ± k r of the stick zone move outwards: |dm/dr| <= k. A point comes into contact
in slip, sticks at r*, m + k r* = x, and sticks from then on. All terms are positive but where the
middle of the contact passes x.

The distances e = m + r - x from the edge and s = m + k r - x from the end of the stick zone are
counted from r*, where s = 0 and e = (1 - k) r*: both are known to relative accuracy, however narrow
the slip zone is. From a place r0 on, behind which the nearest singularity lies at the distance B,

    r = r0 + B sinh² v

makes roots of the distances from both smooth functions of v.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.coupled.panels import totals
from sie.friction.coupled.profile import NEAREST
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import EPS

from .functions import GoodmanFlat
from .growth import ContactTable, Panel

Array = NDArray[np.float64]

NODES, LONGEST = 16, 3.0  # of a panel of v, and its length: singularities lie beyond π/2 i
SHORT = 1.0  # where there is one ahead as well, at twice the distance
TOGETHER = 256  # places at a time: more do not fit a processor's cache
LOOKS = 24  # places on a panel at which the ends of the stick zone must move outwards
TURNING = 1e-9  # of the half-width: an end that moves inwards by less is rounding
FAINT = 1e-12  # of the load: what a lighter one does leaves no trace
STEPS, SETTLED = 60, 1e-13  # of Newton's method for a half-width, which then takes one step more


class Contacts(NamedTuple):
    """Contacts in the history of some places x, one of each.

    panel, ahead            number of the panel, and r less that at its beginning
    from_edge, from_stick   e = m + r - x, and s = m + k r - x
    """

    panel: NDArray[np.intp]
    ahead: Array
    from_edge: Array
    from_stick: Array


class Piece(NamedTuple):
    """Parts of one panel of half-widths, as arrays, from r = lo + ahead on.

    length                  negative where r decreases from there
    from_edge, from_stick   e and s at their beginning
    behind                  distance of the nearest singularity behind it
    """

    ahead: Array
    length: Array
    from_edge: Array
    from_stick: Array
    behind: Array


class Nodes(NamedTuple):
    """Nodes of the integrals over r: half-widths, x - m, the distance of the nearer edge, and s."""

    half_width: Array
    offset: Array
    from_edge: Array
    from_stick: Array


class GoodmanGrowth:
    """Shear and slip at places y = x - middle on the right of where the profile touched first.

    Mirrored, y is middle - x, and the left is the right.
    """

    def __init__(self, flat: GoodmanFlat, table: ContactTable, mirrored: bool = False) -> None:
        self.flat, self.table, self.side = flat, table, -1.0 if mirrored else 1.0
        self._looks: dict[int, tuple[Array, Array]] = {}

    def shear(self, y: Array) -> Array:
        """q in the stick zone."""
        parts = [self._shear(y[i : i + TOGETHER]) for i in range(0, len(y), TOGETHER)]
        return np.concatenate([np.zeros(0), *parts])

    def _shear(self, y: Array) -> Array:
        begun = self._sticking(y)
        q = self._before(begun, _flat_pressure) + self._since(begun, self._in_stick)
        return self.flat.friction * q

    def slip(self, y: Array) -> Array:
        """E*/2 times the slip."""
        begun, end = self._sticking(y), self._at_end(y)
        slips = end.from_stick < 0.0
        last = Contacts(*(np.where(slips, *both) for both in zip(end, begun, strict=True)))
        return self._before(last, self._in_slip, to_stick=True)

    def pressure(self, from_edge: Array, r: Array) -> Array:
        """p at a distance from the right edge, under the lighter load at which r is that."""
        return self._before(self._contacts(r, from_edge), _flat_pressure)

    def dissipation(self, r: Array) -> Array:
        """E*/2 times the energy that the slip of dP = 1 dissipates, at half-widths r (1-d)."""
        t, e, dt = self.flat.slip_places
        distance = r[:, None] * e
        p = self.pressure(distance.ravel(), np.repeat(r, len(t))).reshape(distance.shape)
        rate: Array = self.flat.friction * r * (p @ (dt * self.flat.slip(t, e)))
        return rate

    def stick_end(self, r: float) -> float:
        """The right end of the stick zone of the contact of half-width r, from the middle."""
        if not self.table.panels:
            return self.flat.k * r
        k, ahead = self._place(np.array([r]))
        panel, centre = self.table.panels[k[0]], self.table.centres[k[0]]
        centre += float(panel.moved(np.zeros(1), ahead)[0])
        return self.side * centre + self.flat.k * r

    def _in_stick(self, at: Nodes) -> Array:
        r, k = at.half_width, self.flat.k
        part = at.offset / (k * r)
        off = np.where(part > 0.0, at.from_stick / (k * r), 1.0 + part)
        square = at.from_edge * (2.0 * r - at.from_edge) / (r * r)
        return self.flat.ratio(part, np.maximum(off, 0.0), square) * _flat_pressure(at)

    def _in_slip(self, at: Nodes) -> Array:
        r = at.half_width
        return self.flat.slip(at.offset / r, at.from_edge / r)

    # -- contacts in the history of places ---------------------------------------------------------

    @cached_property
    def _begins(self) -> Array:
        """The half-widths at which panels begin; that of the contact where it does not grow."""
        return np.array([panel.lo for panel in self.table.panels] or [self.table.end])

    def _place(self, r: Array) -> tuple[NDArray[np.intp], Array]:
        """The panels that end with these half-widths or hold them, and how far along."""
        lo = self._begins
        k = np.maximum(np.searchsorted(lo, r) - 1, 0)
        return k, r - lo[k]

    def _contacts(self, r: Array, from_edge: Array) -> Contacts:
        return Contacts(*self._place(r), from_edge, from_edge - self.flat.modulus.rest * r)

    def _at_end(self, y: Array) -> Contacts:
        return self._contacts(np.full(len(y), self.table.end), self.table.end - y)

    def _sticking(self, y: Array) -> Contacts:
        """The contacts in which the places began to stick, those at first touch, or at the end."""
        k, lo = self.flat.k, self._begins
        centres = self.side * np.array(self.table.centres)[: len(lo)]
        begin = centres + k * lo
        number = np.maximum(np.searchsorted(begin, y) - 1, 0)
        ahead = np.zeros(len(y))
        for j, panel in enumerate(self.table.panels):
            own = number == j
            if own.any():
                rise = y[own] - begin[j]
                ahead[own] = self._reached(panel, k, np.zeros(1), rise, self._near(j, rise))
        rest = self.flat.modulus.rest * (lo[number] + ahead)
        stuck = np.maximum(begin[0] - y, 0.0) if self.table.start else np.zeros(len(y))
        edge = np.where(stuck > 0.0, centres[0] + lo[0] - y, rest)
        return Contacts(number, ahead, edge, stuck)

    def _near(self, number: int, rise: Array) -> Array:
        """About where the end of the stick zone has moved so far on a panel."""
        if number not in self._looks:
            panel = self.table.panels[number]
            ahead = panel.length * (np.arange(LOOKS + 1) / LOOKS) ** 2
            risen = self._rise(panel, self.flat.k, np.zeros(1), ahead)
            self._looks[number] = np.maximum.accumulate(risen), ahead
        values: Array = np.interp(rise, *self._looks[number])
        return values

    def _reached(
        self, panel: Panel, part: float, ahead: Array, rise: Array, near: Array | float = 0.0
    ) -> Array:
        """By how much r has to grow from lo + ahead until m + part r has grown by so much.

        It may be negative, and does not lead out of the panel.
        """
        limit = np.where(rise < 0.0, ahead, panel.length - ahead)
        rise, sign = np.abs(rise), np.copysign(1.0, rise)
        lo, hi = np.zeros(len(rise)), limit
        found = np.minimum(near, limit)
        for _ in range(STEPS):
            by = sign * found
            missed = rise - part * found - sign * self.side * panel.moved(ahead, by)
            rate = part + self.side * panel.turn(ahead + by)
            lo, hi = np.where(missed > 0.0, found, lo), np.where(missed > 0.0, hi, found)
            rate = np.maximum(rate, NEAREST)
            step = missed / rate
            inside = (found + step >= lo) & (found + step <= hi)
            moved = np.where(inside, found + step, 0.5 * (lo + hi))
            settled = np.abs(moved - found) <= (SETTLED + 4.0 * EPS / rate) * moved
            found = moved
            if settled.all():
                break
        return sign * found

    # -- integrals ---------------------------------------------------------------------------------

    def _before(
        self, last: Contacts, integrand: Callable[[Nodes], Array], to_stick: bool = False
    ) -> Array:
        """∫ integrand dP from where the places came into contact up to the last contacts.

        to_stick where the integrand is a power of s in the end.
        """
        total = np.zeros(len(last.ahead))
        e, s = last.from_edge.copy(), last.from_stick.copy()
        for j, panel in reversed(list(enumerate(self.table.panels))):
            own = np.flatnonzero((last.panel >= j) & (e > 0.0))
            if not own.size:
                continue
            top = np.where(last.panel[own] == j, last.ahead[own], panel.length)
            first = np.maximum(e[own] - self._rise(panel, 1.0, np.zeros(len(own)), top), 0.0)
            length, inside = top.copy(), first == 0.0
            length[inside] = -self._reached(panel, 1.0, top[inside], -e[own[inside]])
            ahead = np.where(inside, top - length, 0.0)
            at = first, s[own] - self._rise(panel, self.flat.k, ahead, length)
            since = panel.lo - panel.begin + ahead
            behind = np.where(since > 0.0, since, panel.scale)
            behind = np.where(inside, behind, np.minimum(behind, 0.5 * first))
            if to_stick:
                piece = Piece(ahead, 0.5 * length, *at, behind)
                total[own] += self._integral(panel, piece, integrand, SHORT)
                back = np.where(s[own] < 0.0, np.minimum(-s[own], length), length)
                piece = Piece(top, -0.5 * length, e[own], s[own], back)
                total[own] += self._integral(panel, piece, integrand, SHORT)
            else:
                total[own] += self._integral(panel, Piece(ahead, length, *at, behind), integrand)
            e[own], s[own] = at
        return total

    def _since(self, first: Contacts, integrand: Callable[[Nodes], Array]) -> Array:
        """∫ integrand dP from the first contacts to the end."""
        total, k = np.zeros(len(first.ahead)), self.flat.k
        e, s = first.from_edge.copy(), first.from_stick.copy()
        for j, panel in enumerate(self.table.panels):
            own = np.flatnonzero(first.panel <= j)
            if not own.size:
                continue
            ahead = np.where(first.panel[own] == j, first.ahead[own], 0.0)
            length, r = panel.length - ahead, panel.lo + ahead
            # Both ends of the contact and of the stick zone: they move by 2 dr at most
            ends = e[own], s[own], 2.0 * r - e[own], 2.0 * k * r - s[own]
            since = r - panel.begin
            distances = np.array([2.0 * since, 2.0 * (since + panel.scale), 2.0 * r, *ends])
            behind = 0.5 * np.where(distances > 0.0, distances, np.inf).min(axis=0)
            piece = Piece(ahead, length, e[own], s[own], np.minimum(behind, panel.hi))
            total[own] += self._integral(panel, piece, integrand)
            e[own] += self._rise(panel, 1.0, ahead, length)
            s[own] += self._rise(panel, k, ahead, length)
        return total

    def _rise(self, panel: Panel, part: float, ahead: Array, by: Array) -> Array:
        """The growth of m + part r."""
        rise: Array = part * by + self.side * panel.moved(ahead, by)
        return rise

    def _integral(
        self,
        panel: Panel,
        piece: Piece,
        integrand: Callable[[Nodes], Array],
        longest: float = LONGEST,
    ) -> Array:
        """∫ integrand dP over parts of a panel."""
        behind = np.maximum(piece.behind, NEAREST * panel.hi)
        depth = np.arcsinh(np.sqrt(np.abs(piece.length) / behind))
        count = np.ceil(depth / longest).astype(np.intp)
        row = np.repeat(np.arange(len(count)), count)
        number = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
        x, _, w = gauss_jacobi(NODES, 0.0, 0.0)
        size = (depth / np.maximum(count, 1))[row][:, None]
        v = size * (number[:, None] + x)
        scale = behind[row][:, None]
        ahead, _, e, s, _ = (column[row][:, None] for column in piece)
        by = np.copysign(scale, piece.length[row][:, None]) * np.sinh(v) ** 2
        moved = self.side * panel.moved(ahead, by)
        r, e = panel.lo + ahead + by, e + by + moved
        near = np.minimum(e, np.maximum(2.0 * r - e, NEAREST * r))
        at = Nodes(r, r - e, near, s + self.flat.k * by + moved)
        mass = scale * np.sinh(2.0 * v) * size * w * panel.load_rate(ahead + by)
        values = integrand(Nodes(*(column.ravel() for column in at))).reshape(mass.shape)
        return totals(row, mass * values, len(count))

    @cached_property
    def recedes(self) -> float:
        """A half-width at which an end of the stick zone would move inwards, 0 where none does.

        Then this does not hold.
        """
        carried = 0.0
        for panel in self.table.panels:
            ahead = panel.length * (np.arange(LOOKS + 1) / LOOKS) ** 2
            rise = np.diff(self._rise(panel, self.flat.k, np.zeros(1), ahead))
            rates = panel.load_rate(ahead[1:])
            load = carried + np.cumsum(rates * np.diff(ahead))
            carried = float(load[-1])
            receding = (rise < -TURNING * self.table.end) & (load > FAINT * self.table.load)
            if receding.any():
                return panel.lo + float(ahead[1:][receding][-1])
        return 0.0


def _flat_pressure(at: Nodes) -> Array:
    p: Array = 1.0 / (math.pi * np.sqrt(at.from_edge * (2.0 * at.half_width - at.from_edge)))
    return p
