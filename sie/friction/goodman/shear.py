"""The shear and the slip of Goodman's approximation while the normal load grows.

The pressure is that without friction, whose increment under dP is that of a flat punch of the
present contact m ∓ r. Where the slip in stick stays, so is the increment of the shear, so that with
t = (x - m)/r and the flat's functions (`functions`), over all r that reach x,

    q(x) = f ∫ ρ(t) φ(t) dP/r,      g(x) = 2/E* ∫ ĝ(t) dP over r with |t| > k,

ρ = ±1 in slip and q/(f p) of the flat in stick. This holds for unsymmetric contacts as well, as
long as both ends m ± k r of the stick zone move outwards: |dm/dr| <= k. A point comes into contact
in slip, sticks at r*, m + k r* = x, and sticks from then on. All terms are positive but where the
middle of the contact passes x.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.coupled.panels import shrinking
from sie.friction.coupled.profile import NEAREST
from sie.numerics.gauss_jacobi import gauss_jacobi
from sie.numerics.interval import EPS

from .functions import GoodmanFlat
from .growth import ContactTable, Panel

Array = NDArray[np.float64]

NODES = 16
TOGETHER = 256  # places at a time: more do not fit a processor's cache
# Halvings and Newton's steps to the half-width that reaches a place; differences for derivatives
HALVED, NEWTONS, STEP = 8, 5, 0.05
LOOKS = 24  # places on a panel at which the ends of the stick zone must move outwards
TURNING = 1e-9  # |dm/dr| beyond k by so much is not rounding


class Nodes(NamedTuple):
    """Nodes of the integrals over r of some places.

    owner                   index of the place
    half_width, weight      r and dP
    offset                  x - m
    from_edge, from_stick   r - |x - m| and k r - (x - m)
    """

    owner: NDArray[np.intp]
    half_width: Array
    weight: Array
    offset: Array
    from_edge: Array
    from_stick: Array


class Start(NamedTuple):
    """Where integrals over r begin, and r - (x - m) and k r - (x - m) there."""

    half_width: Array
    from_edge: Array
    from_stick: Array


class GoodmanGrowth:
    """Shear and slip at places y = x - middle on the right of where the profile touched first.

    Mirrored, y is middle - x, and the left is the right.
    """

    def __init__(self, flat: GoodmanFlat, table: ContactTable, mirrored: bool = False) -> None:
        self.flat, self.table, self.side = flat, table, -1.0 if mirrored else 1.0
        self._refuse_receding()

    def shear(self, y: Array) -> Array:
        """q on the contact."""
        parts = [self._shear(y[i : i + TOGETHER]) for i in range(0, len(y), TOGETHER)]
        return np.concatenate([np.zeros(0), *parts])

    def _shear(self, y: Array) -> Array:
        top = np.full(len(y), self.table.end)
        sticks = self._reaching(y, self.flat.k)
        q = self._sum(_flat_pressure, y, self._reaching(y, 1.0), np.minimum(sticks.half_width, top))
        return self.flat.friction * (q + self._sum(self._in_stick, y, sticks, top))

    def slip(self, y: Array) -> Array:
        """E*/2 times the slip."""
        end = np.minimum(self._reaching(y, self.flat.k).half_width, self.table.end)
        return self._sum(self._in_slip, y, self._reaching(y, 1.0), end, to_stick=True)

    def pressure(self, y: Array, top: Array) -> Array:
        """p under the lighter load at which the half-width is top."""
        return self._sum(_flat_pressure, y, self._reaching(y, 1.0), top)

    def dissipation(self, r: Array) -> Array:
        """E*/2 times the energy that the slip of dP = 1 dissipates, at half-widths r (1-d)."""
        t, e, dt = self.flat.slip_places
        y = self._centre(r)[:, None] + r[:, None] * t
        p = self.pressure(y.ravel(), np.repeat(r, len(t))).reshape(y.shape)
        rate: Array = self.flat.friction * r * (p @ (dt * self.flat.slip(t, e)))
        return rate

    def stick_end(self, r: float) -> float:
        """The right end of the stick zone of the contact of half-width r, from the middle."""
        return float(self._centre(np.array([r]))[0]) + self.flat.k * r

    def _in_stick(self, at: Nodes) -> Array:
        r, k = at.half_width, self.flat.k
        part = at.offset / (k * r)
        off = np.where(part > 0.0, at.from_stick / (k * r), 1.0 + part)
        square = at.from_edge * (2.0 * r - at.from_edge) / (r * r)
        return self.flat.ratio(part, np.maximum(off, 0.0), square) * _flat_pressure(at)

    def _in_slip(self, at: Nodes) -> Array:
        r = at.half_width
        return self.flat.slip(at.offset / r, at.from_edge / r)

    # -- integrals ---------------------------------------------------------------------------------

    def _sum(
        self,
        integrand: Callable[[Nodes], Array],
        y: Array,
        start: Start,
        end: Array,
        to_stick: bool = False,
    ) -> Array:
        """∫ integrand dP from start to end; to_stick where it is a power of the distance there."""
        total = np.zeros(len(y))
        for panel in self.table.panels:
            lo, hi = np.maximum(start.half_width, panel.lo), np.minimum(end, panel.hi)
            which = np.flatnonzero(hi > lo)
            if which.size:
                begin = Start(*(column[which] for column in start))
                at = self._nodes(panel, y[which], begin, (lo[which], hi[which]), to_stick)
                values = np.bincount(at.owner, at.weight * integrand(at), minlength=len(which))
                total[which] += values
        return total

    def _nodes(
        self, panel: Panel, y: Array, begin: Start, ends: tuple[Array, Array], to_stick: bool
    ) -> Nodes:
        """Nodes on the part of a panel between both ends, graded towards what is behind."""
        lo, length = ends[0], ends[1] - ends[0]
        since = lo - begin.half_width
        sticking = begin.from_stick >= 0.0
        behind = since + np.where(sticking, begin.from_stick / self.flat.k, begin.from_edge)
        behind = np.where(behind > 0.0, behind, begin.from_edge)
        next_behind = [np.where(d > 0.0, d, length) for d in (behind, lo - panel.lo)]
        scale = np.maximum(np.minimum(*next_behind), NEAREST * panel.hi)
        after = length if to_stick else np.full(len(y), np.inf)
        owner, first, size, _, kind = shrinking(length, scale, after)
        x, _, w = gauss_jacobi(NODES, 0.0, 0.0)
        # In the root of the distance from a start or an end of its own
        places = np.array([x * x, x, 1.0 - x * x])
        weights = np.array([2.0 * x * w, w, 2.0 * x * w])
        ahead = first[:, None] + size[:, None] * places[kind]
        rate, centre = panel.at((lo - panel.lo)[owner][:, None] + ahead)
        centre, r = self.side * centre, lo[owner][:, None] + ahead
        moved = centre - self._centre(begin.half_width)[owner][:, None]
        grown = since[owner][:, None] + ahead
        offset = y[owner][:, None] - centre
        from_edge = begin.from_edge[owner][:, None] + grown + moved
        from_stick = begin.from_stick[owner][:, None] + self.flat.k * grown + moved
        columns = (
            r,
            size[:, None] * weights[kind] * rate,
            offset,
            np.clip(np.where(offset < 0.0, 2.0 * r - from_edge, from_edge), NEAREST * r, r),
            from_stick,
        )
        return Nodes(np.repeat(owner, NODES), *(column.ravel() for column in columns))

    def _centre(self, r: Array) -> Array:
        centre = np.zeros(r.shape)
        ends = [*(panel.lo for panel in self.table.panels[1:]), math.inf]
        for panel, following in zip(self.table.panels, ends, strict=False):
            here = (r >= panel.lo) & (r < following)
            if here.any():
                ahead = np.minimum(r[here], panel.hi) - panel.lo
                centre[here] = self.side * panel.centre_at(ahead)
        return centre

    def _reaching(self, y: Array, part: float) -> Start:
        """The half-width at which m + part r = y, or that of first touch."""
        k, start, rest = self.flat.k, self.table.start, self.flat.modulus.rest
        if self.table.search.axis is not None:
            r = np.maximum(y / part, start)
        else:
            r = self._crossing(y, part)
        first = r <= start * (1.0 + 4.0 * EPS)
        from_base = self._centre(np.full(len(y), start)) - y
        inside = first & (start > 0.0)
        if part == 1.0:
            edge = np.where(inside, np.maximum(from_base + start, 0.0), 0.0)
            return Start(np.where(first, start, r), edge, np.full(len(y), -1.0))
        edge = np.where(inside, from_base + start, rest * np.where(first, start, r))
        stick = np.where(inside, np.maximum(from_base + k * start, 0.0), 0.0)
        return Start(np.where(first, start, r), edge, stick)

    def _crossing(self, y: Array, part: float) -> Array:
        """The half-width at which m + part r = y, inf where it does not come so far."""
        first, last = (float(self._end(np.array([r]), part)[0]) for r in self._ends)
        r = np.where(y < last, self._ends[0], np.inf)
        between = (y > first) & (y < last)
        wanted = y[between]

        steps = (np.arange(LOOKS) / LOOKS) ** 2
        grid = np.concatenate([p.lo + (p.hi - p.lo) * steps for p in self.table.panels])
        grid = np.append(grid, self._ends[1])
        k = np.clip(np.searchsorted(self._end(grid, part), wanted), 1, len(grid) - 1)
        lo, hi = grid[k - 1], grid[k]
        for _ in range(HALVED):
            middle = 0.5 * (lo + hi)
            under = self._end(middle, part) < wanted
            lo, hi = np.where(under, middle, lo), np.where(under, hi, middle)
        found = 0.5 * (lo + hi)
        for _ in range(NEWTONS):
            h = STEP * (hi - lo) + NEAREST
            rise = (self._end(found + h, part) - self._end(found - h, part)) / (2.0 * h)
            step = (wanted - self._end(found, part)) / np.where(rise > 0.0, rise, np.inf)
            found = np.clip(found + step, lo, hi)
        r[between] = np.clip(found, *self._ends)
        return r

    @property
    def _ends(self) -> tuple[float, float]:
        return self.table.start, self.table.end

    def _end(self, r: Array, part: float) -> Array:
        end: Array = self._centre(r) + part * r
        return end

    def _refuse_receding(self) -> None:
        """ContactError where an end of the stick zone moves inwards."""
        for panel in self.table.panels:
            ahead = (panel.hi - panel.lo) * (np.arange(LOOKS + 1) / LOOKS) ** 2
            ends = self.side * panel.centre_at(ahead) + self.flat.k * (panel.lo + ahead)
            if (np.diff(ends) < -TURNING * self.table.end).any():
                raise ContactError(
                    "the contact moves aside faster than it grows: its stick zone, "
                    f"{self.flat.k:.4g} of the width, would recede at one end on the way to a "
                    f"half-width of {panel.hi:.6g}, and Goodman's approximation is solved for "
                    "stick zones that only grow; raise the friction, reduce the tilt, or give "
                    "dundurs = 0 to neglect β"
                )


def _flat_pressure(at: Nodes) -> Array:
    p: Array = 1.0 / (math.pi * np.sqrt(at.from_edge * (2.0 * at.half_width - at.from_edge)))
    return p
