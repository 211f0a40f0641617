"""The answer for dissimilar bodies after P, and then Q and bulk stress at constant P.

States are solved about an origin in the contact, for β > 0; β < 0 turns the signs of q, of the
slip and of the strain.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.contact.known_contact import Edges
from sie.errors import ContactError
from sie.friction.state import intervals
from sie.numerics.graded_panels import Pieces
from sie.numerics.interval import Interval
from sie.traction.base import FAR_AWAY, InContact, on_line, zero_or_nan

from .traction import EDGE, REACH, OnPieces, Piece, places, tabulated
from .work import work

if TYPE_CHECKING:
    from sie.problem.scene import Scene
    from sie.profiles.base import Profile

    from .pressed import Pressed
    from .step import Loaded

Array = NDArray[np.float64]
Zones = tuple[tuple[float, float], ...]

LEAST = 1e-300
ONE = 1e-13  # of the contact: marks that are nearer are one
PRESSED = 1e-9  # of P: what the state of the normal load may miss


@dataclass(frozen=True, eq=False)
class CoupledContact:
    """A state in the coordinates of the scene.

    pressed         the contact under P alone, and how it grew
    loaded          the state, about the origin of that
    sign            of β
    half_modulus    E*/2
    previous        the state at the point of the path before, None under P alone
    """

    pressed: Pressed
    loaded: Loaded
    sign: float
    half_modulus: float
    previous: CoupledContact | None = None

    @classmethod
    def of(cls, pressed: Pressed, scene: Scene) -> CoupledContact:
        """The state of a scene under P alone."""
        return cls(pressed, pressed.loaded, math.copysign(1.0, scene.beta), 0.5 * scene.Estar)

    def under(self, Q: float, tau: float) -> CoupledContact:
        """The state after a step to Q and τ; ContactError where friction is kept by none."""
        Q, tau = self.sign * Q, self.sign * tau
        if (Q, tau) == (self.loaded.Q, self.loaded.strain):
            return self
        known = float(np.abs(self.loaded.first.state.missed).max())
        if not known <= PRESSED:
            raise ContactError(
                f"the slip that the normal load left is known to {known:.1g} of f p alone, too "
                "little to go on from; raise friction, or give dundurs = 0 to neglect β"
            )
        after = self.loaded.stepped(Q, tau)
        if after is None:
            raise refused(self.loaded, Q)
        return replace(self, loaded=after, previous=self)

    # -- zones and loads ---------------------------------------------------------------------------

    @property
    def origin(self) -> float:
        return self.pressed.origin

    @cached_property
    def contact(self) -> Interval:
        if self.previous is None:
            return self.pressed.contact
        lo, hi = self.loaded.zones.ends[[0, -1]].tolist()
        return Interval(self.origin + lo, self.origin + hi)

    @property
    def sharp(self) -> bool:
        """Whether the edges are corners, where the tractions are infinite."""
        return self.pressed.sharp

    @property
    def full_stick(self) -> bool:
        """Whether the slip zones are narrower than a part 1e-15 of the contact."""
        return self.previous is None and self.pressed.flat.bonded

    @property
    def stick(self) -> Zones:
        """The stick zones."""
        if self.full_stick:
            return (self.contact[:2],)
        return tuple((self.origin + lo, self.origin + hi) for lo, hi in self.loaded.zones.stick)

    @property
    def slip_widths(self) -> tuple[float, float]:
        """The widths of the slip zones at both edges, to full relative accuracy."""
        widths = self.loaded.zones.widths
        return (0.0, 0.0) if self.full_stick else (widths[0], widths[-1])

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        zones = () if self.full_stick else self.loaded.zones.slip
        return tuple((self.origin + lo, self.origin + hi, self.sign * s) for lo, hi, s in zones)

    @property
    def edges(self) -> Edges:
        P, sharp = self.loaded.question.P, (self.sharp, self.sharp)
        return Edges(self.contact, P, self.moment, 0.0, sharp, 0.0, 0.0, 0.0, 0)

    @cached_property
    def moment(self) -> float:
        """∫p x dx."""
        at, (p, _, _) = self.loaded.fields.whole
        return self.origin * self.loaded.question.P + float(at.weight @ (p * at.x))

    @property
    def kind(self) -> str:
        """The slip in words."""
        if self.full_stick:
            return "full stick, its zones narrower than 1e-15 of the contact; β couples p and q"
        if self.previous is None:
            way = "outwards" if self.sign > 0.0 else "inwards"
            return f"{way} on both sides while the normal load grew; β couples p and q"
        left, *_, right = ["+" if s > 0.0 else "-" for _, _, s in self.slip_zones]
        where = f"towards {left}x" if left == right else f"towards {left}x left and {right}x right"
        return f"{where} beside the stick zone; β couples p and q"

    # -- tractions ---------------------------------------------------------------------------------

    def rows(self, x: Array, rest: Array | None = None) -> Array:
        """Rows of p and q in contact; at a tip of the profile p is infinite, and q is told as 0."""
        rows = self._rows(x - self.origin, rest)
        if self.previous is None and self.pressed.tip:
            rows[0, x == self.origin], rows[1, x == self.origin] = np.inf, 0.0
        return rows

    def _rows(self, x: Array, rest: Array | None = None) -> Array:
        p, q, _ = self.loaded.fields(x, rest)
        return np.stack((p, self.sign * q))

    @property
    def values(self) -> InContact:
        """The tractions about the origin."""
        lo, hi = self.loaded.zones.ends[[0, -1]].tolist()
        marks = (lo, *(x - self.origin for x in self.marks[1:-1]), hi)
        return InContact(Interval(lo, hi), marks, self._rows, self.origin, self.sharp)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places in the contact where p or q is not smooth, with its edges, ascending."""
        (lo, hi), kinks = self.contact[:2], self.loaded.question.slope.kinks
        places = {self.origin + x for x in (*self.loaded.marks, *kinks)}
        return (lo, *sorted(x for x in places if lo < x < hi), hi)

    @cached_property
    def _tables(self) -> list[list[Piece]]:
        """p and q on each piece."""
        fields, pieces = self.loaded.fields, self.loaded.state.pieces
        reach = EDGE / (1.0 + min(0.0, *pieces.powers.tolist())) if self.sharp else REACH
        v, found = tabulated(places(reach)), []
        cuts = pieces.cuts.tolist()
        cuts[0], cuts[-1] = (edge - self.origin for edge in self.contact[:2])
        for k, length in enumerate(pieces.lengths.tolist()):
            p, q, _ = fields.on_piece(k, v)
            found.append([Piece(cuts[k], cuts[k + 1], length, f) for f in (p, self.sign * q)])
        return found

    @cached_property
    def tractions(self) -> tuple[OnPieces, OnPieces]:
        """p and q with their potentials."""

        def traction(k: int, load: float) -> OnPieces:
            def values(x: Array) -> Array:
                return self.rows(x)[k]

            def tables() -> list[Piece]:
                return [pair[k] for pair in self._tables]

            marks, sharp = self.marks, self.sharp
            return OnPieces(self.contact, values, tables, load, self.origin, marks, sharp)

        return traction(0, self.loaded.question.P), traction(1, self.sign * self.loaded.Q)

    # -- slip --------------------------------------------------------------------------------------

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x since it came into contact, same shape: 0 outside the contact."""

        def value(flat: Array) -> Array:
            g, (lo, hi) = np.zeros(flat.shape), self.contact[:2]
            inside = (flat >= lo) & (flat <= hi)
            g[inside] = self.sign / self.half_modulus * self._slip(flat[inside] - self.origin)
            return g

        return on_line(value, x)

    def _slip(self, x: Array) -> Array:
        """E*/2 times the slip for β > 0, at places about the origin."""
        g = self._gained(x)
        lo, hi = (edge - self.origin for edge in self.pressed.contact[:2])
        touched = (x >= lo) & (x <= hi)
        g[touched] += self.pressed.slip(x[touched])
        return g

    def _gained(self, x: Array) -> Array:
        """E*/2 times the slip since P alone, turn by turn."""
        total, now = np.zeros(len(x)), self.loaded
        while now.before is not None:
            total += slipped(now, now.before, x)
            now = now.before
        return total

    @property
    def least_slip(self) -> float:
        """The least slip in its direction, over the largest."""
        if self.previous is None:
            return self.pressed.least_slip
        return min(self.loaded.verdict.slip, self.loaded.verdict.rate)

    @property
    def kept(self) -> tuple[tuple[float, float], CoupledContact | None]:
        """A zone that sticks, and an earlier state since which it has; None from the first."""
        before = self.loaded.before
        if before is not None:
            earlier = None if before.before is None else self.previous
            return self.stick[0], replace(self, loaded=before, previous=earlier)
        lighter = self.pressed.lighter
        if lighter is None:
            return self.stick[0], None
        earlier = replace(self, pressed=lighter, loaded=lighter.loaded)
        return earlier.stick[0], earlier

    @property
    def strain_kept(self) -> float:
        """What a bulk stress changed γ by since that state."""
        before = self.loaded.before
        return self.sign * (self.loaded.strain - (before.strain if before else 0.0))

    @cached_property
    def energy(self) -> float:
        """The dissipated energy since the bodies touched."""
        if self.previous is None:
            return self.pressed.energy / self.half_modulus
        done = work(self.previous.loaded, self.loaded)
        return self.previous.energy + done / self.half_modulus

    @cached_property
    def shift(self) -> float:
        """The shift of the indenter, less that of a contact bonded as P left it.

        That is Q/π [ln(2X/b) - Re ψ(1/2 + iη) + ψ(1/2)] to a far X, tanh πη = β, ψ the digamma
        function.
        """
        from scipy.special import digamma  # noqa: PLC0415 -- heavy, and seldom asked for

        first, ends = self.loaded.first, self.loaded.first.zones.ends
        middle, b = 0.5 * float(ends[0] + ends[-1]), 0.5 * float(np.ptp(ends))
        edge = max(float(ends[-1]), float(self.loaded.zones.ends[-1]))  # beyond both contacts
        question = self.loaded.question
        eta = 0.0 if question.approximate else math.atanh(question.beta) / math.pi
        bonded = math.log(0.5 * b) + float((digamma(0.5 + 1j * eta) - digamma(0.5)).real)
        moved = _to_far(self.loaded, edge) - _to_far(first, edge)
        moved += float(self._gained(np.array([edge]))[0])
        moved += self.loaded.strain * (edge - middle)  # with the body under bulk stress
        return self.sign * (moved + self.loaded.Q / math.pi * bonded) / self.half_modulus

    # -- beside the contact ------------------------------------------------------------------------

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        lo, hi = profile.domain
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        known = np.isfinite(flat) & (out == 0.0)
        for edge, side in ((self.contact.x1, -1.0), (self.contact.x2, 1.0)):
            beside = known & (side * (flat - edge) > 0.0)
            apart = np.minimum(np.abs(flat[beside] - edge), FAR_AWAY * self.contact.r)
            rise = profile.height(flat[beside]) - profile.height(np.array(edge))
            out[beside] = rise - self.loaded.fields.raised(apart, side) / self.half_modulus
        return out.reshape(np.shape(x))


def slipped(after: Loaded, before: Loaded, x: Array) -> Array:
    """E*/2 times what the surfaces at places move against each other from one state to a later one.

    Beside a contact too: places may leave it and come back.
    """
    out, ends = np.zeros(len(x)), after.zones.ends
    marks = np.array([*before.state.pieces.cuts, *after.question.slope.kinks, *ends[[0, -1]]])
    outer = min(ends[0], x.min(initial=np.inf)), max(ends[-1], x.max(initial=-np.inf))
    for first, last, on_left in ((outer[0], ends[1], True), (ends[-2], outer[1], False)):
        own = (x >= first) & (x <= last)
        if own.any():
            inside = np.unique(marks[(marks > first) & (marks < last)])
            rule = Pieces.places(intervals([(first, last)], inside, ONE * (ends[-1] - ends[0])))
            total = Pieces.integral(rule, _strain(after, rule.x) - _strain(before, rule.x))
            out[own] = total(x[own]) - (total.last if on_left else 0.0)
    return out


def _strain(state: Loaded, x: Array) -> Array:
    """E*/2 g' at places in the contact and beside it."""
    lo, hi = state.zones.ends[[0, -1]]
    found, touching = np.empty(len(x)), (x >= lo) & (x <= hi)
    found[touching] = state.fields.gamma(x[touching])
    for edge, side in ((lo, -1.0), (hi, 1.0)):
        own = side * (x - edge) > 0.0
        found[own] = state.fields.beside(np.abs(x[own] - edge), side)[1]
    return found - state.strain


def _to_far(state: Loaded, start: float) -> float:
    """∫γ dx from a place beyond the contact to a far X, less Q/π ln X."""
    at, (_, q, _) = state.fields.whole
    log = np.log(np.maximum(start - at.x, LEAST)) / math.pi
    return -float(at.weight @ (q * log))


def refused(state: Loaded, Q: float) -> ContactError:
    """The ContactError: no zones keep the friction law."""
    P, limit = state.question.P, state.friction * state.question.P
    return ContactError(
        f"dissimilar bodies (β f = {state.question.beta * state.friction:.3g}) under P = {P:.6g}, "
        f"|Q| = {abs(Q):.6g} ({abs(Q) / limit:.3g} f P): slip turns inside a zone, or contact that "
        "is gained sticks, which is not solved; change Q, or give dundurs = 0"
    )
