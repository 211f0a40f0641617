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
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.state import intervals
from sie.numerics.graded_panels import Pieces

from .view import View
from .work import work

if TYPE_CHECKING:
    from .pressed import Pressed
    from .step import Loaded

Array = NDArray[np.float64]

LEAST = 1e-300
ONE = 1e-13  # of the contact: marks that are nearer are one
PRESSED = 1e-9  # of P: what the state of the normal load may miss


@dataclass(frozen=True, eq=False)
class LoadedContact(View):
    """A state at constant P in the coordinates of the scene.

    loaded      the state
    pressed     that under P alone
    origin      of the places of the states
    sign        of β
    previous    the state at the point of the path before
    """

    loaded: Loaded
    pressed: Pressed
    origin: float
    sign: float
    previous: LoadedContact | None = None

    @property
    def half_modulus(self) -> float:  # type: ignore[override]
        return self.pressed.half_modulus

    def under(self, Q: float, tau: float) -> LoadedContact:
        """The state after a step to Q and τ; ContactError where friction is kept by none."""
        known = float(np.abs(self.loaded.first.state.missed).max())
        if not known <= PRESSED:
            raise ContactError(
                f"the slip that the normal load left is known to {known:.1g} of f p alone, too "
                "little to go on from; raise friction, or give dundurs = 0 to neglect β"
            )
        after = self.loaded.stepped(self.sign * Q, self.sign * tau)
        if after is None:
            raise refused(self, Q)
        return replace(self, loaded=after, previous=self)

    # -- slip --------------------------------------------------------------------------------------

    def _slip(self, x: Array) -> Array:
        g = self._gained(x)
        lo, hi = (edge - self.origin for edge in self.pressed.contact[:2])
        touched = (x >= lo) & (x <= hi)
        g[touched] += self.pressed._slip(x[touched])
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


def pressed_contact(pressed: Pressed) -> LoadedContact:
    """The state under P alone, as the first of others at constant P."""
    return LoadedContact(pressed.loaded, pressed, pressed.origin, pressed.sign)


def refused(state: LoadedContact, Q: float) -> ContactError:
    """The ContactError: no zones keep the friction law."""
    question, friction = state.loaded.question, state.loaded.friction
    P, limit = question.P, friction * question.P
    return ContactError(
        f"dissimilar bodies (β f = {question.beta * friction:.3g}) under P = {P:.6g}, "
        f"|Q| = {abs(Q):.6g} ({abs(Q) / limit:.3g} f P): slip turns inside a zone, or contact that "
        "is gained sticks, which is not solved; change Q, or give dundurs = 0"
    )
