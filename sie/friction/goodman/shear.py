"""The shear and the slip of Goodman's approximation while the normal load grows.

The pressure is that without friction, whose increment under dP is that of a flat punch of the
present half-width r. Where the slip in stick stays, so is the increment of the shear, so that with
t = y/r at the distance y from the axis and the flat's functions (`functions`), over all r >= y,

    q(y) = f ∫ ρ(t) φ(t) dP/r,      g(y) = 2/E* ∫ ĝ(t) dP over r with t > k,

ρ = 1 in slip and q/(f p) of the flat in stick. A point comes into contact in slip, sticks at
r = y/k, and sticks from then on. All terms are positive.

The distances e = r - y from the edge and s = k r - y from the end of the stick zone are counted
from where s = 0 and e = (1 - k) r: both are known to relative accuracy, however narrow the slip
zone is. From a place r0 on, behind which the nearest singularity lies at the distance B,

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

from sie.numerics.gauss_jacobi import gauss_jacobi

from .frame import NEAREST, totals
from .functions import GoodmanFlat
from .growth import ContactTable, Panel

Array = NDArray[np.float64]

NODES, LONGEST = 16, 3.0  # of a panel of v, and its length: singularities lie beyond π/2 i
SHORT = 1.0  # where there is one ahead as well, at twice the distance
TOGETHER = 256  # places at a time: more do not fit a processor's cache


class Contacts(NamedTuple):
    """Contacts in the history of some places y, one of each.

    panel, ahead            number of the panel, and r less that at its beginning
    from_edge, from_stick   e = r - y, and s = k r - y
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
    """Nodes of the integrals over r: half-widths, e and s."""

    half_width: Array
    from_edge: Array
    from_stick: Array


class GoodmanGrowth:
    """Shear and slip at distances y >= 0 from the axis."""

    def __init__(self, flat: GoodmanFlat, table: ContactTable) -> None:
        self.flat, self.table = flat, table

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

    def dissipation(self, r: Array) -> Array:
        """E*/2 times the energy that the slip of dP = 1 dissipates on a side, at half-widths r."""
        t, e, dt = self.flat.slip_places
        distance = r[:, None] * e
        at = self._contacts(np.repeat(r, len(t)), distance.ravel())
        p = self._before(at, _flat_pressure).reshape(distance.shape)
        rate: Array = self.flat.friction * r * (p @ (dt * self.flat.slip(t, e)))
        return rate

    def _in_stick(self, at: Nodes) -> Array:
        r, k = at.half_width, self.flat.k
        off = np.maximum(at.from_stick / (k * r), 0.0)
        square = at.from_edge * (2.0 * r - at.from_edge) / (r * r)
        return self.flat.ratio((r - at.from_edge) / (k * r), off, square) * _flat_pressure(at)

    def _in_slip(self, at: Nodes) -> Array:
        e = at.from_edge / at.half_width
        return self.flat.slip(1.0 - e, e)

    # -- contacts in the history of places ---------------------------------------------------------

    @cached_property
    def _begins(self) -> Array:
        """The half-widths at which panels begin; that of the contact where it does not grow."""
        return np.array([panel.lo for panel in self.table.panels] or [self.table.end])

    def _contacts(self, r: Array, from_edge: Array) -> Contacts:
        number = np.maximum(np.searchsorted(self._begins, r) - 1, 0)
        ahead = r - self._begins[number]
        return Contacts(number, ahead, from_edge, from_edge - self.flat.modulus.rest * r)

    def _at_end(self, y: Array) -> Contacts:
        return self._contacts(np.full(len(y), self.table.end), self.table.end - y)

    def _sticking(self, y: Array) -> Contacts:
        """The contacts in which the places began to stick, those at first touch, or at the end."""
        k, lo = self.flat.k, self._begins
        number = np.maximum(np.searchsorted(k * lo, y) - 1, 0)
        ahead = np.clip((y - k * lo[number]) / k, 0.0, self.table.end - lo[number])
        stuck = np.maximum(k * lo[0] - y, 0.0)
        rest = self.flat.modulus.rest * (lo[number] + ahead)
        return Contacts(number, ahead, np.where(stuck > 0.0, lo[0] - y, rest), stuck)

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
            length = np.minimum(top, e[own])
            first, ahead = np.maximum(e[own] - top, 0.0), top - length
            at = first, s[own] - self.flat.k * length
            since = panel.lo - panel.begin + ahead
            behind = np.where(since > 0.0, since, panel.scale)
            behind = np.where(first == 0.0, behind, np.minimum(behind, 0.5 * first))
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
            # The axis, both ends of the contact and of the stick zone, which move by dr at most
            since, ends = r - panel.begin, (e[own], s[own], 2.0 * r - e[own], 2.0 * k * r - s[own])
            distances = np.array([since, since + panel.scale, r, *(0.5 * d for d in ends)])
            behind = np.where(distances > 0.0, distances, np.inf).min(axis=0)
            piece = Piece(ahead, length, e[own], s[own], np.minimum(behind, panel.hi))
            total[own] += self._integral(panel, piece, integrand)
            e[own] += length
            s[own] += k * length
        return total

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
        at = Nodes(panel.lo + ahead + by, e + by, s + self.flat.k * by)
        mass = scale * np.sinh(2.0 * v) * size * w * panel.load_rate(ahead + by)
        values = integrand(Nodes(*(column.ravel() for column in at))).reshape(mass.shape)
        return totals(row, mass * values, len(count))


def _flat_pressure(at: Nodes) -> Array:
    p: Array = 1.0 / (math.pi * np.sqrt(at.from_edge * (2.0 * at.half_width - at.from_edge)))
    return p
