"""The answer for dissimilar bodies after P, and then Q and bulk stress at constant P.

States are solved about an origin in the contact, for β > 0; β < 0 turns the signs of q, of the
slip and of the strain.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.contact.known_contact import Edges
from sie.errors import ContactError
from sie.numerics.interval import Interval
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.traction.base import on_line, zero_or_nan
from sie.traction.in_contact import InContact

from .fields import Fields
from .half_slope import HalfSlope
from .integral import integral, outwards, towards_ends
from .pieces import Pieces
from .state import Question, State
from .step import Loaded
from .two_sided import Known, TwoSidedTraction, both_tractions
from .work import work

if TYPE_CHECKING:
    from .contact import CoupledContact
    from .uneven_contact import UnevenContact

Array = NDArray[np.float64]

WINDOW = 1.3  # half-widths from the middle: what no contact under Q leaves
LEAST = 1e-300
GRADED: Array = 3.0 ** -np.arange(30.0)  # of a half-width: panels towards where γ is not smooth
PRESSED = 1e-9  # of P: what the state of the normal load may miss
NARROWEST = 1e-15  # of the contact: slip zones of the normal load, as wide at least


@dataclass(frozen=True, eq=False)
class LoadedContact:
    """A state at constant P in the coordinates of the scene.

    loaded      the state
    pressed     that under P alone
    origin      of the places of the states
    sign        of β
    previous    the state at the point of the path before
    """

    loaded: Loaded
    pressed: CoupledContact | UnevenContact
    origin: float
    sign: float
    previous: LoadedContact | None = None

    @property
    def half_modulus(self) -> float:
        return self.pressed.half_modulus

    def under(self, Q: float, tau: float) -> LoadedContact:
        """The state after a step to Q and τ; ContactError where friction is kept by none."""
        known = float(np.abs(self._first.state.missed).max())
        if not known <= PRESSED:
            raise ContactError(
                f"the slip that the normal load left is known to {known:.1g} of f p alone, too "
                "little to go on from; raise friction, or give dundurs = 0 to neglect β"
            )
        after = self.loaded.stepped(self.sign * Q, self.sign * tau)
        if after is None:
            raise refused(self, Q)
        return replace(self, loaded=after, previous=self)

    @property
    def _first(self) -> Loaded:
        """The state under P alone."""
        first = self.loaded
        while first.before is not None:
            first = first.before
        return first

    # -- zones and loads ---------------------------------------------------------------------------

    @cached_property
    def contact(self) -> Interval:
        lo, hi = self.loaded.zones.ends[[0, -1]].tolist()
        return Interval(self.origin + lo, self.origin + hi)

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones."""
        return tuple((self.origin + lo, self.origin + hi) for lo, hi in self.loaded.zones.stick)

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        return tuple(
            (self.origin + lo, self.origin + hi, self.sign * s)
            for lo, hi, s in self.loaded.zones.slip
        )

    @property
    def edges(self) -> Edges:
        P = self.loaded.question.P
        return Edges(self.contact, P, self.moment, 0.0, (False, False), 0.0, 0.0, 0.0, 0)

    @cached_property
    def moment(self) -> float:
        """∫p x dx."""
        at, (p, _, _) = self.loaded.fields.whole
        return self.origin * self.loaded.question.P + float(at.weight @ (p * at.x))

    @property
    def kind(self) -> str:
        """The slip in words."""
        ways = ["+" if s > 0.0 else "-" for _, _, s in self.slip_zones]
        left, right = ways[0], ways[-1]
        where = f"towards {left}x" if left == right else f"towards {left}x left and {right}x right"
        return f"{where} beside the stick zone; β couples p and q"

    # -- tractions ---------------------------------------------------------------------------------

    def rows(self, x: Array, rest: Array | None = None) -> Array:
        """Rows of p and q in contact."""
        p, q, _ = self.loaded.fields(x - self.origin, rest)
        return np.stack((p, self.sign * q))

    @property
    def values(self) -> InContact:
        """The tractions about the origin."""
        lo, hi = self.loaded.zones.ends[[0, -1]].tolist()

        def rows(x: Array, rest: Array) -> Array:
            p, q, _ = self.loaded.fields(x, rest)
            return np.stack((p, self.sign * q))

        marks = (lo, *(x - self.origin for x in self.marks[1:-1]), hi)
        return InContact(Interval(lo, hi), marks, rows, self.origin)

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places in the contact where p or q is not smooth, with its edges, ascending."""
        (lo, hi), kinks = self.contact[:2], self.loaded.question.slope.kinks
        places = {self.origin + x for x in (*self.loaded.marks, *kinks)}
        return (lo, *sorted(x for x in places if lo < x < hi), hi)

    @cached_property
    def tractions(self) -> tuple[TwoSidedTraction, TwoSidedTraction]:
        """p and q with their potentials, which share their panels."""
        lo, hi = self.stick[0]
        powers = self.loaded.state.pieces.powers
        loads = self.loaded.question.P, self.sign * self.loaded.Q
        known = Known(0.5 * (lo + hi), self.marks, (powers[0], powers[-1]), loads, self.moment)
        values = (lambda x: self.rows(x)[0], lambda x: self.rows(x)[1])
        return both_tractions(values, self.rows, known)

    # -- slip --------------------------------------------------------------------------------------

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x, same shape: 0 outside the contact."""

        def value(flat: Array) -> Array:
            lo, hi = self.contact[:2]
            inside = (flat >= lo) & (flat <= hi)
            g = np.zeros(flat.shape)
            at = flat[inside]
            g[inside] = self.sign / self.half_modulus * self._gained(at - self.origin)
            g[inside] += self.pressed.relative_slip(at)
            return g

        return on_line(value, x)

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
        verdict = self.loaded.verdict
        return min(verdict.slip, verdict.rate)

    @property
    def kept(self) -> tuple[tuple[float, float], Any]:
        """What sticks, and the state that its slip gradient was locked in by."""
        before = self.loaded.before
        earlier: Any = self.pressed
        if before is not None and before.before is not None:
            earlier = replace(self, loaded=before)
        return self.stick[0], earlier

    @property
    def strain_kept(self) -> float:
        """What a bulk stress changed γ by since that state."""
        before = self.loaded.before
        return self.sign * (self.loaded.strain - (before.strain if before else 0.0))

    @cached_property
    def energy(self) -> float:
        """The dissipated energy since P was applied."""
        if self.previous is None:
            return self.pressed.energy
        done = work(self.previous.loaded, self.loaded)
        if done is None:
            raise ContactError(
                "the energy of this step is a sum over states on the way, of which one was not "
                "found; give the step in two parts"
            )
        return self.previous.energy + done / self.half_modulus

    @cached_property
    def shift(self) -> float:
        """The shift of the indenter, less that of a contact bonded as P left it.

        That is Q/π [ln(2X/b) - Re ψ(1/2 + iη) + ψ(1/2)] to a far X, tanh πη = β, ψ the digamma
        function.
        """
        from scipy.special import digamma  # noqa: PLC0415 -- heavy, and seldom asked for

        first = self.loaded
        while first.before is not None:
            first = first.before
        start, b = self.loaded.zones.stick[0][1], 0.5 * float(np.ptp(first.zones.ends))
        eta = math.atanh(self.loaded.question.beta) / math.pi
        bonded = math.log(0.5 * b) + float((digamma(0.5 + 1j * eta) - digamma(0.5)).real)
        moved = _to_far(self.loaded, start) - _to_far(first, start)
        return self.sign * (moved + self.loaded.Q / math.pi * bonded) / self.half_modulus

    # -- beside the contact ------------------------------------------------------------------------

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        lo, hi = profile.domain
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        known, width = np.isfinite(flat) & (out == 0.0), self.contact.r
        for edge, side in ((self.contact.x1, -1.0), (self.contact.x2, 1.0)):
            beside = known & (side * (flat - edge) > 0.0)
            if beside.any():

                def H(d: Array, edge: float = edge, side: float = side) -> Array:
                    at = edge - self.origin + side * np.maximum(d, 1e-12 * width)
                    return side * self.loaded.state.beside_contact(at)[0]

                rise = profile.height(flat[beside]) - profile.height(np.array(edge))
                raised = outwards(H, np.abs(flat[beside] - edge), width)
                out[beside] = rise - raised / self.half_modulus
        return out.reshape(np.shape(x))


def slipped(after: Loaded, before: Loaded, x: Array) -> Array:
    """E*/2 times the slip from one state to a later one."""
    out, ends = np.zeros(len(x)), after.zones.ends
    lo, hi = before.zones.ends[[0, -1]]
    places = np.array([*before.state.pieces.cuts.tolist(), *after.question.slope.kinks])
    near = 0.5 * (hi - lo) * np.concatenate((-GRADED, [0.0], GRADED))
    inner = (places[:, None] + near).ravel()

    def gain(u: Array) -> Array:
        gamma, touched = after.fields.gamma(u), (u >= lo) & (u <= hi)
        gamma[touched] -= before.fields.gamma(u[touched])
        if not touched.all():
            gamma[~touched] -= before.state.beside_contact(u[~touched])[1]
        return gamma - (after.strain - before.strain)

    for first, last, on_left in ((ends[0], ends[1], True), (ends[-2], ends[-1], False)):
        own = (x >= first) & (x <= last)
        if own.any():
            total = integral(gain, towards_ends(first, last, inner))
            out[own] = total(x[own]) - (total(np.array([last])) if on_left else 0.0)
    return out


def _to_far(state: Loaded, start: float) -> float:
    """∫γ dx from a place to a far X, less Q/π ln X."""
    at, (p, q, _) = state.fields.whole
    log = np.log(np.maximum(np.abs(at.x - start), LEAST)) / math.pi
    beta = state.question.beta
    return float(at.weight @ (beta * (at.x > start) * p - q * log))


def pressed_contact(scene: Scene, pressed: CoupledContact | UnevenContact) -> LoadedContact:
    """The state under P alone, as the first of others at constant P."""
    origin, sign = _middle(pressed), math.copysign(1.0, scene.beta)
    slope = scene.profile.pieces.shifted(-origin) if origin else scene.profile.pieces
    P, beta = pressed.load, abs(scene.beta)
    b = pressed.b
    gamma = locked_in(pressed, slope, origin)
    half = HalfSlope(slope, pressed.half_modulus, (-WINDOW * b, WINDOW * b))
    question = Question(beta, pressed.flat.friction, half, gamma, P, 0.0)
    width = max(pressed.slip_width, NARROWEST * b)
    (lo, hi) = pressed.stick[0]
    widths = (width, (hi - lo) if not pressed.full_stick else 2.0 * (b - width), width)
    marks = tuple(x - origin for x in pressed_marks(pressed))
    pieces = Pieces(-b, widths, (-1, 0, 1), marks, half.kinks, question.theta)
    first = Loaded(Fields(State(pieces, question)), 0.0, 0.0, friction=scene.friction)
    return LoadedContact(first, pressed, origin, sign)


def refused(state: LoadedContact, Q: float) -> ContactError:
    """The ContactError: no zones keep the friction law."""
    question = state.loaded.question
    P, limit = question.P, question.friction * question.P
    return ContactError(
        f"dissimilar bodies (β f = {question.beta * question.friction:.3g}) under P = {P:.6g}, "
        f"|Q| = {abs(Q):.6g} ({abs(Q) / limit:.3g} f P): slip turns inside a zone, or contact that "
        "is gained sticks, which is not solved; change Q, or give dundurs = 0"
    )


def _middle(pressed: CoupledContact | UnevenContact) -> float:
    lo, hi = pressed.stick[0]
    return float(getattr(pressed, "axis", 0.5 * (lo + hi)))


def pressed_marks(pressed: CoupledContact | UnevenContact) -> tuple[float, ...]:
    """Places where γ is not smooth under P alone."""
    axis = getattr(pressed, "axis", None)
    if axis is None:
        return pressed.marks[1:-1]
    return tuple(sorted({axis, *(axis + s * y for y in pressed.marks[:-1] for s in (-1.0, 1.0))}))


def locked_in(pressed: Any, slope: Any, origin: float) -> Any:
    """γ under P alone as a function of the place about the origin."""
    from .gradient import SlipGradient  # noqa: PLC0415 -- of symmetric profiles alone

    if hasattr(pressed, "superposition"):
        gradient = SlipGradient(pressed.superposition, pressed.ahead)
        return lambda x: gradient(np.abs(x), pressed.half_modulus * slope(np.abs(x)))
    p, q = pressed.tractions
    beta = pressed.flat.beta
    return lambda x: pressed.sign * q.hilbert(x + origin) + beta * p(x + origin)
