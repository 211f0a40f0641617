"""Stick, slip and shear of a state of the engine, and the state that a large bulk stress leaves.

Where π r |τ| > |Q| the two edges slip in opposite directions, that of τ at the left one. The state
is that of one finite step from no shear (`equations`), at constant P: of the friction law in total
displacements, as in Nowell & Hills (1987). A narrow stick zone [c - ρ, c + ρ] lies where slip in
both directions balances Q, and of Hertz's contact with the half-width d about c it has

    ρ = 4 d exp(-1 - π |τ|/(2 f p(c)))

from which Newton's method starts.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.coupled.traction import smooth_between
from sie.numerics.graded_panels import Pieces, Rule
from sie.numerics.interval import Interval
from sie.numerics.root_finding import false_position
from sie.traction.combination import superposed

from .cells import zones_on_cells
from .equations import scaled_shift, slip_work
from .finite_step import Part, newton
from .loading import limit_on
from .potentials import RelativeSlip
from .slip import Slip, Step
from .state import SAME, Contact, State, Zones, intervals, refuse_inadmissible

if TYPE_CHECKING:
    from sie.traction.base import Density

Array = NDArray[np.float64]
Zone = tuple[float, float]

MOST = 13.0  # of τ/(f p(c)): beyond, the stick zone is narrower than 1e-8 of the contact
MARKED = 512  # breaks in contact that are marks: a state is solved once; of more each is below 1e-8
WIDE = 0.75  # of the distance to the nearer edge: a stick zone at most, at a guess
# of the contact: nearer to an end of stick an infinite pressure costs q more than 1e-8
BESIDE = 1e-3


class StateSlip(Slip):
    """Stick, slip and shear of a state, `locked`."""

    contacts = ()

    @property
    @abstractmethod
    def locked(self) -> State: ...

    @cached_property
    def shear(self) -> Density:
        state = self.locked
        contact = state.contact
        room = SAME * contact.width

        def of_patch(x1: float, x2: float) -> Density:
            zone, marks = Interval(x1, x2), state.marks
            inside = marks[(marks > x1 + room) & (marks < x2 - room)]
            rule = Rule.graded(intervals([(x1, x2)], inside, room))
            load = float(rule.weight @ state.shear.on(rule))
            return smooth_between(zone, state.shear, inside.tolist(), load)

        found = [of_patch(*patch) for patch in contact.patches]
        return found[0] if len(found) == 1 else superposed(*((1.0, q) for q in found))

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        return self.locked.stick

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        return self.locked.slip

    @property
    def levels(self) -> tuple[float, ...]:
        return tuple(self.locked.marks.tolist())


@dataclass(frozen=True, eq=False)
class TwoSignedSlip(StateSlip):
    """Slip in opposite directions at the two edges: a finite step from no shear, at constant P."""

    step: Step
    part: Part
    kind = "two signs"
    promised = 1e-8

    @property
    def locked(self) -> State:
        return self.part.state

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self.step.contact

    @property
    def friction(self) -> float:  # type: ignore[override]
        return self.step.scene.friction

    @property
    def advancing(self) -> bool:  # type: ignore[override]
        """Whether s (Q ∓ π ρ τ) >= 0 at both ends, from the first stick zone to the last."""
        Q, strain, (lo, hi) = self.step.Q, math.pi * self.step.tau, self.stick[0]
        narrow, sign = 0.5 * (hi - lo), math.copysign(1.0, self.step.tau)
        return all(
            sign * (Q + strain * rho) >= 0.0 <= sign * (strain * rho - Q)
            for rho in (self.contact.r, narrow)
        )

    @cached_property
    def _gained(self) -> RelativeSlip:
        return RelativeSlip(self.part.equations)

    def slip(self, x: Array) -> Array:
        return self._gained.at(x) * (2.0 / self.step.scene.Estar)

    @property
    def energy(self) -> float:
        now = self.part.state.contact
        return slip_work(self._gained, now.limit.on, now) * 2.0 / self.step.scene.Estar

    @property
    def shift(self) -> float:
        contact, step = self.contact, self.step
        stuck = math.pi * step.tau * contact.m - step.Q * math.log(0.5 * contact.r)
        shifted = scaled_shift(self.part.before, self.part.state, self.part.stuck)
        return (shifted - stuck) / (0.5 * math.pi * step.scene.Estar)


def two_signed(step: Step) -> TwoSignedSlip:
    """The state where the two edges slip in opposite directions.

    Raises ContactError at sharp edges, and where no zones are found.
    """
    patches, pressure = step.full.patches, step.full.pressure
    limit = limit_on(step.scene, patches, pressure, MARKED)
    infinite = limit.marks[np.isinf(pressure(limit.marks))]
    _refuse_slip_at(infinite, patches[0], patches[0])
    before = State.untouched(Contact(patches, limit, 0.0, 0.0))
    after = Contact(patches, limit, step.Q, step.tau)
    guess = _zones(after)
    try:
        found = newton(before, after, guess)
    except ContactError:
        found = newton(before, after, zones_on_cells(before, after)[0])
    refuse_inadmissible(before, found.state, found.state.stick)
    _refuse_slip_at(infinite, found.state.stick[0], patches[0])
    return TwoSignedSlip(step, Part(found, found.state, 0.0, 1.0))


def _refuse_slip_at(infinite: Array, stick: Zone, patch: Zone) -> None:
    """Refuse an infinite pressure outside of the stick zone, or so near to an end that it shows."""
    inside = BESIDE * (patch[1] - patch[0])
    slips = infinite[(infinite <= stick[0] + inside) | (infinite >= stick[1] - inside)]
    if slips.size:
        raise ContactError(
            "the bulk stress makes the two edges slip in opposite directions, which is not covered "
            f"where a point of infinite pressure slips, x = {slips[0]:.6g}: round the profile "
            "there, or lower the bulk stress"
        )


def _zones(after: Contact) -> Zones:
    """The narrow stick zone between slip in opposite directions, about."""
    ((x1, x2),), sign = after.patches, math.copysign(1.0, after.tau)
    places = Pieces.places(after.limit.ends)
    force = Pieces.integral(places, after.limit.on(places))
    aim = 0.5 * (force.last + sign * after.Q)

    def missed(c: float) -> float:
        return float(force(np.array([c]))[0]) - aim

    c = false_position(missed, x1, x2, (-aim, force.last - aim), lambda *_: False)
    near, limit = min(c - x1, x2 - c), float(after.limit(np.array([c]))[0])
    strain = abs(after.tau) / limit
    if strain > MOST:
        share = 0.999 * MOST / strain
        raise ContactError(
            f"the bulk stress is {strain:.4g} times f p at x = {c:.6g} and leaves a stick zone too "
            f"narrow for doubles: give at most {share:.4g} times as much"
        )
    rho = near * min(WIDE, 4.0 * math.exp(-1.0 - 0.5 * math.pi * strain))
    return Zones(((c - rho, c + rho),), (sign, -sign))
