"""The state under P, then Q, while what the contact gains sticks as it is touched.

In the frame of `tangential` (axis at 0, β > 0, Q > 0) the zones are a strip at x1 with q = -f p,
where the slip of the normal load goes on, stick up to e2, and slip along Q from there to x2. p, q
and γ are those under P alone and what Q added (`spreading_history`). What was gained keeps the γ
with which it was touched, but for what it slips while the strip passes.

The zones are these until f p - q falls to zero at the old edge -b, inside the stick zone, where a
slip zone opens.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.errors import ContactError
from sie.numerics.interval import EPS
from sie.problem.coverage import LargerLoad, refused_spread
from sie.traction.base import on_line

from .gradient import SlipGradient
from .integral import Integral, integral, on_marks, towards_ends
from .sheared import LOOKED_AT, ShearedContact
from .spreading_beginning import Beginning
from .spreading_march import OPEN, SpreadingMarch
from .spreading_slip import StripSlip
from .spreading_zones import Places
from .tables import interpolated
from .tangential import TangentialSearch, Trial
from .two_sided import Known, TwoSidedTraction, both_tractions
from .zones import Zones

Array = NDArray[np.float64]

TOGETHER = 128  # places at once
ROUNDINGS = 8.0  # of b - x2: the least distance from x2
CHECKED = 1e-8  # of f times the mean pressure: by what friction may seem to be exceeded
SEEN = 1e-8  # half-widths: tractions are smooth where a narrower strip ended
BESIDE = 1e-4  # half-widths from the old edge: farther γ is what it was, unless the strip is wider
NARROW = 1e-12  # half-widths from x1: nearer p and q are rounding if the strip is not seen
# Of exp(-(π/2 - atan f)/η) b: contacts that gain more have a slip zone at the old edge
GAINED = 40.0
# Of the same: contacts that gain less have none. With β = 0.3, f = 2 it opens at 11
STICKS = 5.0
RESOLVED = 3e-10  # of its conditions, what the march may miss where Q is reached


class Spread(NamedTuple):
    """The zones; the strip may be narrower than the roundings of x1."""

    zones: Zones


@dataclass(frozen=True, eq=False)
class SpreadingContact(ShearedContact):
    """The state; `trial` holds the zones.

    march       the panels of what Q added
    s           how far the contact has spread beyond -b
    """

    march: SpreadingMarch = field(kw_only=True)
    s: float = field(kw_only=True)

    @property
    def state(self) -> Trial:
        return self.trial

    @property
    def spreads(self) -> bool:
        return True

    @property
    def strip(self) -> float:
        """The width of the strip at x1 with q = -f p."""
        return self.march.history.strip_width(self.s, *self.march.history.zones(self.s))

    @property
    def first_strip(self) -> float:
        """The width of the strip as Q began to grow."""
        history = self.march.history
        s = history.panels[0].lo
        return history.strip_width(s, *history.zones(s))

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """The same, with where the strip ended as Q began to grow."""
        width, b = self.first_strip, self.search.normal.b
        marks = super().marks
        if width < SEEN * b:
            return marks
        return tuple(sorted({*marks, self.axis + self.flip * (width - b)}))

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        x1, e1, e2, x2 = self.trial.zones
        right = (*self._placed(e2, x2), self.turn)
        if e1 == x1:
            return (right,)
        return tuple(sorted(((*self._placed(x1, e1), -self.turn), right)))

    # -- tractions, in the frame -------------------------------------------------------------------

    def _places(self, u: Array) -> Places:
        b, c = self.search.normal.b, self.march.history.c
        (x1, _, e2, x2), (ways) = self.trial.zones, self.march.history.zones(self.s)
        from_b = np.where(u < -0.5 * b, (u - x1) - self.s, u + b)
        # By the distance from the zones' own ends
        to_c = ways[0] + (e2 - u)
        to_b = np.maximum(ways[1] + (x2 - u), ways[1] * (1.0 + ROUNDINGS * EPS))
        return Places(from_b, np.where(u > 0.0, to_c, c - u), to_b, np.full(len(u), self.s))

    def added(self, u: Array) -> Array:
        """Rows of p, f p - q and γ that Q added at x1 < u < x2."""
        rows = [
            self.march.history.inside(self._places(u[i : i + TOGETHER]))
            for i in range(0, len(u), TOGETHER)
        ]
        return np.concatenate(rows, axis=1) if rows else np.zeros((3, 0))

    def _both(self, u: Array) -> Array:
        """Rows of p and f p - q; those asked for last are kept, as either row is asked for."""
        return self._kept_rows(u.tobytes())

    @cached_property
    def _kept_rows(self) -> Callable[[bytes], Array]:
        return lru_cache(maxsize=2)(lambda u: self._computed(np.frombuffer(u)))

    def _computed(self, u: Array) -> Array:
        (x1, _, e2, x2), b = self.trial.zones, self.search.normal.b
        rows, inside = np.zeros((2, len(u))), (u > x1) & (u < x2)
        rows[:, inside] = self.added(u[inside])[:2]
        old = inside & (np.abs(u) <= b)
        rows[0, old] += self.search.normal.pressure(np.abs(u[old]))
        stuck = old & (u < e2)
        rows[1, stuck] += self._deficit_before(u[stuck])
        rows[1, u >= e2] = 0.0
        return rows

    def _interpolated(self, u: Array, row: int) -> Array:
        marks = np.array(self.frame_marks)
        apart = np.append(True, np.diff(marks) > NARROW * marks[-1])
        values: Array = interpolated(lambda y: self._both(y)[row], marks[apart], u)
        return values

    def frame_pressure(self, u: Array) -> Array:
        """p at x1 <= u <= x2."""
        return self._interpolated(u, 0)

    def deficit(self, u: Array) -> Array:
        """f p - q at x1 <= u <= x2, 0 in slip along Q."""
        return self._interpolated(u, 1)

    def _frame_tractions(self, u: Array) -> Array:
        p, r = self.frame_pressure(u), self.deficit(u)
        return np.stack((p, self.friction * p - r))

    @cached_property
    def moment(self) -> float:
        """∫p x dx about the axis, in the frame."""
        x, weight = on_marks(self.frame_marks)
        return float(weight @ (x * self.frame_pressure(x)))

    # -- slip --------------------------------------------------------------------------------------

    @cached_property
    def _slipped(self) -> Integral:
        """E*/2 times what the slip gains under Q from e2 on."""
        _, _, e2, x2 = self.trial.zones
        cuts = np.array([y for y in self.frame_marks if e2 < y < x2])
        return integral(lambda u: self.added(u)[2], towards_ends(e2, x2, cuts))

    @cached_property
    def _slipped_back(self) -> StripSlip:
        """The slip on the strip at x1, and on what it left."""
        (x1, e0, _, _), history = self.trial.zones, self.march.history
        ends = x1, e0, max(e0, self.first_strip - history.b)
        return StripSlip(history, self.s, lambda u: self.added(u)[2], ends)

    @property
    def least_slip(self) -> float:
        """The least slip along Q that Q added in the slip zone at x2, over the largest."""
        slip = self._slipped(self._slipped.cuts[1:])
        return min(float(slip.min() / np.abs(slip).max()), 0.0)

    @cached_property
    def least_deficit(self) -> float:
        """The least f p - |q| in stick, over its size: negative where friction is exceeded."""
        (x1, e1, e2, _), b = self.trial.zones, self.search.normal.b
        ends = sorted({max(e1, x1 + NARROW * b), max(e1, -b), e2})
        u = np.concatenate([lo + (hi - lo) * LOOKED_AT for lo, hi in itertools.pairwise(ends)])
        p, r = self._both(u)
        return float(np.minimum(r, 2.0 * self.friction * p - r).min()) / self.search.stress

    @property
    def unchanged(self) -> float:
        b = self.search.normal.b
        return b - max(2.0 * self.first_strip, BESIDE * b)

    def kept_gradient(self, x: Array) -> Array:
        """E*/2 g' that x kept, from when it was touched or left the strip; bodies' frame."""
        u = self.in_frame(x)
        normal, history = self.search.normal, self.march.history
        places = self._places(u)
        before, gained = self.search.gamma(np.maximum(u, -normal.b)), u < -normal.b
        if gained.any():
            s = -places.from_b[gained]
            y = normal.b + s
            gradient = SlipGradient(normal.superposition, normal.ahead)
            before[gained] = gradient.beside(y, normal.hilbert_outside(y))
            touched = np.array([history.zones(one) for one in s.tolist()])
            at = history.at("x1", s, touched[:, 0], touched[:, 1])
            before[gained] += history.beside(at).imag
        values: Array = before + history.inside(places)[2]
        return self.sign * values

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x, same shape: 0 outside the contact.

        What was gained under Q slips on the strip, from when it is touched.
        """

        def value(flat: Array) -> Array:
            u, g = self.in_frame(flat), np.zeros(flat.shape)
            (x1, _, e2, x2), normal = self.trial.zones, self.search.normal
            old = (np.abs(u) <= normal.b) & (u >= x1) & (u <= x2)
            g[old] = np.sign(u[old]) * normal.sign * normal.slip(np.abs(u[old]))
            slips = (u > e2) & (u <= x2)
            g[slips] += self._slipped(u[slips]) / normal.half_modulus
            if self.first_strip > SEEN * normal.b:
                within = (u > x1) & (u < e2)
                g[within] += self._slipped_back(u[within]) / normal.half_modulus
            return self.turn * g

        return on_line(value, x)

    # -- beside the contact ------------------------------------------------------------------------

    def hilbert_outside(self, u: Array) -> Array:
        """1/π ∫p/(u - t) dt beside the contact, in the frame."""
        values: Array = self.flip * self.tractions[0].hilbert(self.axis + self.flip * u)
        return values

    @cached_property
    def tractions(self) -> tuple[TwoSidedTraction, TwoSidedTraction]:
        """p and q with their potentials, which share their panels."""
        at = self.axis + self.flip * 0.5 * (self.trial.zones.e1 + self.trial.zones.e2)

        def both(x: Array) -> Array:
            rows: Array = np.array([[1.0], [self.turn]]) * self._frame_tractions(self.in_frame(x))
            return rows

        powers = 0.5, 0.5 + self.march.history.rates.theta
        known = Known(
            at,
            self.marks,
            powers if self.flip > 0.0 else powers[::-1],
            (self.search.normal.load, self.turn * self.Q),
            self.axis * self.search.normal.load + self.flip * self.moment,
        )

        def pressure(x: Array) -> Array:
            return self.frame_pressure(self.in_frame(x))

        return both_tractions((pressure, lambda x: both(x)[1]), both, known)


def spreading_march(search: TangentialSearch) -> SpreadingMarch:
    """A march that has not begun."""
    normal = search.normal
    beginning = Beginning(normal, search.friction, lambda y: normal.half_modulus * search.slope(y))
    return SpreadingMarch(beginning, tuple(np.abs(search.slope.breaks).tolist()))


def spreading_state(
    search: TangentialSearch, Q: float, march: SpreadingMarch | None = None
) -> SpreadingContact:
    """The state under Q > 0 with β > 0, by a march that has not begun.

    Raises LargerLoad where a slip zone is open at the old edge, or may be where the march ends;
    ContactError where it is not, and no state is certified.
    """
    normal, march = search.normal, march or spreading_march(search)
    part = march.expected(Q) / (normal.b * march.beginning.rates.sticking)
    if part > GAINED:
        raise LargerLoad(OPEN)
    try:
        return _marched_state(search, march, Q)
    except LargerLoad:
        raise
    # Integrals whose zones are not finite fail in any of these ways
    except (ContactError, ArithmeticError, ValueError, IndexError) as error:
        if part > STICKS:
            raise LargerLoad(str(error)) from None
        covered = isinstance(error, ContactError)
        why = str(error) if covered else "its zones are not found over smaller loads"
    raise refused_spread(search.beta * search.friction, (Q, search.limit), why)


def _marched_state(search: TangentialSearch, march: SpreadingMarch, Q: float) -> SpreadingContact:
    """The state at the end of the march; raises LargerLoad where a slip zone is open."""
    normal = search.normal
    s = march.marched(Q)
    if (gap := march.missed(s)) > RESOLVED:
        raise ContactError(f"the march over smaller loads misses its conditions by {gap:.1g}")
    e2, e3 = march.history.zones(s)
    x1 = -normal.b - s
    zones = Zones(x1, x1 + march.history.strip_width(s, e2, e3), normal.c - e2, normal.b - e3)
    state = SpreadingContact(search, Spread(zones), Q, 1.0, 1.0, march=march, s=s)  # type: ignore[arg-type]
    if state.least_deficit < -CHECKED:
        raise LargerLoad(OPEN)
    return state
