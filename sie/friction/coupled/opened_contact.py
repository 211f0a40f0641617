"""The state under P, then Q, while a slip zone is open at the old edge, inside the stick zone.

In the frame of `tangential` the zones are those of `opened_state`, found by `opened_march`. p is
that state's, and with 1/π PV∫p/(x - t) dt from the potential of p

    stick   β q = H p - E*/2 h',          slip   q = f p, and the slip gains ∫(γ - γ before) dx,

γ = H q + β p. So (12), which gives p, is checked in stick, and (1) in slip, where nothing was asked
of p and q.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.interval import EPS, Interval
from sie.problem.coverage import refused_opened
from sie.traction.base import on_line

from .half_potential import Panels
from .integral import Integral, integral, on_marks, towards_ends
from .opened_march import OpenedMarch, OpenedPoint
from .opened_state import OpenedState
from .opened_zones import Distances
from .opening import marched
from .sheared import EDGE_DEGREE, LOOKED_AT, ShearedContact
from .spreading_march import SpreadingMarch
from .tangential import TangentialSearch
from .traction import joined_panels
from .two_sided import Known, TwoSidedTraction, both_tractions
from .zones import Zones

Array = NDArray[np.float64]


NEAREST = 1e-10  # of a slip zone, from an end: nearer p - p there is a power of the distance
ROUNDINGS = 8.0  # of b
BLURRED = 1e-6  # of what was gained: so near to x1 the strip counts that is left out


class Opened(NamedTuple):
    """The edges, with the ends of the right stick zone."""

    zones: Zones


@dataclass(frozen=True, eq=False)
class OpenedContact(ShearedContact):
    """The state; `trial` holds the edges.

    march       what the state depends on
    point       the zones
    """

    march: OpenedMarch = field(kw_only=True)
    point: OpenedPoint = field(kw_only=True)

    @property
    def spreads(self) -> bool:
        return True

    @property
    def doubt(self) -> float:
        """By how much γ may err where surfaces stick, over the mean f p.

        It differs by so much on two panels where they meet, or the strip that is left out changes
        it.
        """
        h1 = self.known.zones.h1
        jumps = (jump for s, jump in self.march.jumps if -s < h1)
        return max(self.march.unseen, *jumps, 0.0)

    @property
    def state(self) -> Opened:  # type: ignore[override]
        return self.trial  # type: ignore[return-value]

    @cached_property
    def known(self) -> OpenedState:
        """The state, with a rule that shrinks to the very ends of the zones."""
        return self.march.state(self.point.s, self.point.logs, fine=True)

    @cached_property
    def ends(self) -> tuple[float, ...]:
        """x1, h1, h2, e2 and x2 in the frame."""
        b, zones = self.search.normal.b, self.known.zones
        return tuple(y - b for y in (zones.x1, zones.h1, zones.h2, zones.e2, zones.x2))

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        x1, h1, h2, e2, _ = self.ends
        return tuple(sorted((self._placed(x1, h1), self._placed(h2, e2))))

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        _, h1, h2, e2, x2 = self.ends
        zones = ((*self._placed(h1, h2), self.turn), (*self._placed(e2, x2), self.turn))
        return tuple(sorted(zones))

    # -- p and q, in the frame ---------------------------------------------------------------------

    def _zone(self, u: Array) -> NDArray[np.intp]:
        """0 and 2 in stick, 1 and 3 in slip."""
        return np.clip(np.searchsorted(self.ends, u) - 1, 0, 3)

    def _located(self, u: Array, k: int) -> tuple[Array, Distances]:
        """Places from the old edge and distances from the ends of the zones, in the zone k."""
        zones = self.known.zones
        lo, hi = self.ends[k : k + 2]
        left, right = np.maximum(u - lo, 0.0), np.maximum(hi - u, 0.0)
        if k == 0:
            left = np.maximum(left - zones.strip, 0.0)
        one = (zones.e0, zones.h1, zones.h2, zones.e2)[k]
        other = (zones.h1, zones.h2, zones.e2, zones.x2)[k]
        x = np.where(left < right, one + left, other - right)
        within = (zones.in_left_stick, zones.in_slip, zones.in_right_stick, zones.ahead)[k]
        return x, within(left, right)

    def frame_pressure(self, u: Array) -> Array:
        """p at x1 <= u <= x2."""
        own, p, zone = self.known, np.empty(len(u)), self._zone(u)
        for k, values in enumerate((self._stuck, self._inside, self._stuck, self._ahead)):
            if (there := zone == k).any():
                p[there] = values(u[there], k)
        (_, h1, h2, e2, _), rounded = self.ends, ROUNDINGS * EPS * self.search.normal.b
        for end, k, away, power in ((h1, 0, 1.0, 0.0), (h2, 2, -1.0, 1.0), (e2, 2, 1.0, 0.0)):
            d = away * (u - end)
            least = NEAREST * (own.zones.slipping if end == e2 else own.zones.opened)
            if (there := (d >= 0.0) & (d < least)).any():
                stuck = self._stuck(np.array([end]), k)
                values = self._ahead if end == e2 else self._inside
                beyond = values(np.array([end + away * least]), 3 if end == e2 else 1)
                # A place that is rounded beyond the end is the end
                part = np.where(d[there] < rounded, 0.0, d[there] / least) ** abs(power - own.mu)
                p[there] = stuck + part * (beyond - stuck)
        # On the strip, which only makes exponents real, p rises from 0
        part = (u - self.ends[0]) / own.zones.strip
        p[part < 1.0] *= np.maximum(part[part < 1.0], 0.0)
        # Beside it, where p + i q turns with ln d, the strip of old slip is left out
        near = self._blurred(u)
        p[near] = np.maximum(p[near], 0.0)
        return p

    def _blurred(self, u: Array) -> NDArray[np.bool_]:
        """Whether places are so near to x1 that the strip counts which is left out."""
        near: NDArray[np.bool_] = u - self.ends[0] < BLURRED * self.point.s
        return near

    def _stuck(self, u: Array, k: int) -> Array:
        x, at = self._located(u, k)
        return self.known.stuck_pressure(x, at, self.march.kept(x))

    def _inside(self, u: Array, k: int) -> Array:
        x, at = self._located(u, k)
        p: Array = self.known.full_sliding(x, at) + self.known.inside(at.h1, at.h2)[0][:, 0]
        return p

    def _ahead(self, u: Array, k: int) -> Array:
        """p in the slip zone at x2: V and (x2 - x)^(1/2 + θ) S."""
        x, at = self._located(u, k)
        near, half = at.x2 < at.e2, 0.5 * self.known.zones.slipping
        S = np.empty(len(u))
        S[near] = chebyshev.evaluate(self._series_at_x2, 2.0 * at.x2[near] / half - 1.0)
        far = Distances(*(d[~near] for d in at))
        S[~near] = self.known.singular_part(far) / far.x2
        values: Array = self.known.regular_sliding(x) + at.x2 ** (1.0 - self.known.mu) * S
        return values

    @cached_property
    def _series_at_x2(self) -> Array:
        """S next to x2, in the distance from it."""
        zones = self.known.zones
        d = 0.25 * zones.slipping * (1.0 + chebyshev.points(EDGE_DEGREE))
        at = zones.ahead(zones.slipping - d, d)
        return chebyshev.transform(self.known.singular_part(at) / d)

    def deficit(self, u: Array) -> Array:
        """f p - q at x1 <= u <= x2, 0 in slip along Q."""
        r, stuck = np.zeros(len(u)), self._zone(u) % 2 == 0
        v = u[stuck]
        q = (self._frame_density.hilbert(v) - self.search.H(v)) / self.search.beta
        limit = self.friction * self.frame_pressure(v)
        # The slip of the normal load goes on in a strip that is left out: there |q| is f p at most
        near = self._blurred(v)
        r[stuck] = np.where(near, np.clip(limit - q, 0.0, 2.0 * limit), limit - q)
        return r

    def _frame_tractions(self, u: Array) -> Array:
        p = self.frame_pressure(u)
        return np.stack((p, self.friction * p - self.deficit(u)))

    @cached_property
    def _frame_density(self) -> TwoSidedTraction:
        """p in the frame with its potential."""
        zones, marks = self.trial.zones, self.frame_marks
        split = 0.5 * (zones.e1 + zones.e2)

        def half(side: float, power: float) -> Panels:
            ends = sorted(side * (u - split) for u in marks if side * (u - split) > 0.0)
            (panels,) = joined_panels(
                lambda y, _: self.frame_pressure(split + side * y)[None], tuple(ends), power
            )
            return panels

        powers = self._powers
        return TwoSidedTraction(
            self.frame_pressure,
            lambda: (half(1.0, powers[1]), half(-1.0, powers[0])),
            split,
            self.search.normal.load,
            marks,
            Interval(marks[0], marks[-1]),
        )

    @property
    def _powers(self) -> tuple[float, float]:
        """Of the distances from x1 and x2."""
        return 0.5, 0.5 + self.search.theta

    @cached_property
    def moment(self) -> float:
        """∫p x dx about the axis, in the frame."""
        x, weight = on_marks(self.frame_marks)
        return float(weight @ (x * self.frame_pressure(x)))

    @cached_property
    def tractions(self) -> tuple[TwoSidedTraction, TwoSidedTraction]:
        """p and q with their potentials, which share their panels."""
        at = self.axis + self.flip * 0.5 * (self.trial.zones.e1 + self.trial.zones.e2)

        def both(x: Array) -> Array:
            rows: Array = np.array([[1.0], [self.turn]]) * self._frame_tractions(self.in_frame(x))
            return rows

        known = Known(
            at,
            self.marks,
            self._powers if self.flip > 0.0 else self._powers[::-1],
            (self.search.normal.load, self.turn * self.Q),
            self.axis * self.search.normal.load + self.flip * self.moment,
        )

        def pressure(x: Array) -> Array:
            return self.frame_pressure(self.in_frame(x))

        return both_tractions((pressure, lambda x: both(x)[1]), both, known)

    # -- slip --------------------------------------------------------------------------------------

    def _gain(self, u: Array) -> Array:
        """γ - that before, in slip along Q."""
        x = self.axis + self.flip * u
        Hq = self.flip * self.turn * self.tractions[1].hilbert(x)
        gamma = Hq + self.search.beta * self.frame_pressure(u)
        gain: Array = gamma - self.march.kept(u + self.search.normal.b)
        return gain

    @cached_property
    def _gained(self) -> tuple[Integral, Integral]:
        """E*/2 times what the slip gains inside the stick zone from h1 on, and from e2 on."""
        _, h1, h2, e2, x2 = self.ends
        return self._integrated(h1, h2), self._integrated(e2, x2)

    def _integrated(self, lo: float, hi: float) -> Integral:
        ends = [lo, *(mark for mark in self.frame_marks if lo < mark < hi), hi]
        nowhere = np.zeros(0)
        cuts = [towards_ends(*pair, nowhere) for pair in itertools.pairwise(ends)]
        return integral(self._gain, np.unique(np.concatenate(cuts)))

    @property
    def least_slip(self) -> float:
        """The least slip along Q that Q added in a slip zone, over the largest."""
        inside, ahead = (part(part.cuts[1:]) for part in self._gained)
        least = min(float(inside[:-1].min()), float(ahead.min()))
        return min(least / float(np.abs(ahead).max()), 0.0)

    @property
    def least_deficit(self) -> float:
        """The least f p - |q| in stick, over its size: negative where friction is exceeded."""
        x1, h1, h2, e2, _ = self.ends
        first = x1 + 2.0 * self.known.zones.strip
        u = np.concatenate([lo + (hi - lo) * LOOKED_AT for lo, hi in ((first, h1), (h2, e2))])
        p, q = self._frame_tractions(u)
        return float((self.friction * p - np.abs(q)).min()) / self.search.stress

    def kept_gradient(self, x: Array) -> Array:
        """E*/2 g' with which x, beside the contact under P alone, was touched; bodies' frame."""
        values: Array = self.sign * self.march.kept(self.in_frame(x) + self.search.normal.b)
        return values

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x, same shape: 0 outside the contact, and where what was gained sticks."""

        def value(flat: Array) -> Array:
            u, g = self.in_frame(flat), np.zeros(flat.shape)
            x1, h1, h2, e2, x2 = self.ends
            normal = self.search.normal
            old = (np.abs(u) <= normal.b) & (u >= x1) & (u <= x2)
            g[old] = np.sign(u[old]) * normal.sign * normal.slip(np.abs(u[old]))
            for (lo, hi), part in zip(((h1, h2), (e2, x2)), self._gained, strict=True):
                slips = (u > lo) & (u <= hi)
                g[slips] += part(u[slips]) / normal.half_modulus
            return self.turn * g

        return on_line(value, x)

    # -- beside the contact ------------------------------------------------------------------------

    def hilbert_outside(self, u: Array) -> Array:
        """1/π ∫p/(u - t) dt beside the contact, in the frame."""
        values: Array = self.flip * self.tractions[0].hilbert(self.axis + self.flip * u)
        return values


def opened_contact(search: TangentialSearch, Q: float, march: SpreadingMarch) -> ShearedContact:
    """The state under Q > 0 with β > 0, larger than the load under which the zone opens.

    The march is that to smaller loads, or has not begun. Raises ContactError where none is
    certified.
    """
    try:
        opened = marched(search, march, Q)
    # Integrals whose zones are not finite fail in any of these ways
    except (ContactError, ArithmeticError, ValueError, IndexError, np.linalg.LinAlgError) as error:
        covered = isinstance(error, ContactError)
        why = str(error) if covered else "its zones are not found"
        raise refused_opened(search.beta * search.friction, (Q, search.limit), why) from None
    if opened.ended:
        return ShearedContact(search, search.found(Q, arrived=True), Q, 1.0, 1.0)
    zones, b = opened.zones(opened.last.s, opened.last.logs), search.normal.b
    edges = Opened(Zones(*(y - b for y in (zones.x1, zones.h2, zones.e2, zones.x2))))
    return OpenedContact(search, edges, Q, 1.0, 1.0, march=opened, point=opened.last)  # type: ignore[arg-type]
