"""Slip of new points of contact in a step that slips while the contact changes.

The stick zone is the contact of a level Λ^, and the slip beside it grows by s j times f times what
the gap of Λ^ grows by, j the jump of κ that the front passes (`memory`). A point that comes into
contact while this goes on slips from then on: by what the gap of the present Λ^ has more than that
of the Λ^ of its arrival.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sie.contact.edges import Search
from sie.errors import ContactError
from sie.friction.contact_growth import near_contact
from sie.friction.loading import Contacts, LoadStep
from sie.friction.loads import Loads
from sie.friction.memory import SlippedLayer
from sie.friction.slip_state import Slip
from sie.numerics.interval import EPS, Interval
from sie.numerics.root_finding import false_position

from .known_zones import KnownZones
from .turning_point import TurningPoint

Array = NDArray[np.float64]

# Shares of a step between which it is sought when an edge passes a point.
SEARCHED = (0.0, 0.25, 0.5, 0.75, 1.0)
SETTLED = 4.0 * EPS


class Followed(Contacts, Protocol):
    """A path that was followed, and its contacts.

    turning_points   the layers after each step
    in_one_patch     whether the contact is one patch under every load
    arm              π r₀
    level            Λ of loads
    shear            S of loads
    on_the_way       the state of a contact that was never sheared before S rose to a depth
    upright_contact  the contact under P, in one patch, beside others at the same tilt
    tilt_of          the tilt of a level
    contact_at       the contact under P at a tilt
    """

    turning_points: tuple[TurningPoint, ...]

    @property
    def in_one_patch(self) -> bool: ...
    @property
    def arm(self) -> float: ...
    def level(self, loads: Loads) -> complex: ...
    def shear(self, loads: Loads) -> complex: ...
    def on_the_way(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def upright_contact(self, P: float, turn: float) -> Interval: ...
    def tilt_of(self, level: complex) -> float: ...
    def contact_at(self, P: float, tilt: float) -> Interval: ...


class ChangingContact:
    """One step of a path, in which slip goes on while the contact changes."""

    def __init__(self, path: Followed, index: int) -> None:
        self.path, self.index = path, index
        self.state = path.turning_points[index]
        self.end = self.state.loads
        self.start = path.turning_points[index - 1].loads.touching(self.end)
        self.change = LoadStep(path, self.start, self.end)
        self.rise = path.level(self.end) - path.level(self.start)
        self._states: dict[tuple[Loads, complex], Slip] = {}
        self._edges = KnownZones()

    def slip_of_new(self, x: Array) -> Array:
        """The slip at the end of the step at x, which came into contact in it."""
        self._refuse_slip(x)
        return np.array([self._slip(at, self.crossed(at), 1.0) for at in x.tolist()])

    def slip_of_left(self, x: Array) -> Array:
        """The slip in the step at x, until it left the contact."""
        self._refuse_slip(x)
        return np.array([self._slip(at, 0.0, self.crossed(at)) for at in x.tolist()])

    def _slip(self, x: float, begin: float, end: float) -> float:
        """The slip at x from one share of the step to another, while it is in contact."""
        event, total = self.state.last, 0.0
        if event is None:
            return 0.0
        for o in event.layers:
            first, last = self.shares(o)
            depths = [
                (share, self._front(o, event.sign, share))
                for share in (min(max(share, first), last) for share in (begin, end))
            ]
            upper, lower = (self._beside(*place, x, begin == 0.0) for place in depths)
            total += o.jump * event.sign * (lower - upper)
        return total

    # -- contacts and states on the way ------------------------------------------------------------

    def _contact(self, share: float) -> Interval:
        loads = self.change.loads(share)
        return self._zone(self.path.level(loads), share, self._edges)

    def _zone(self, level: complex, share: float, near: KnownZones) -> Interval:
        """The contact of a level; `near` are those at other shares of the step."""
        path, scene, start = self.path, self.path.scene, self.start
        load = level.real / scene.friction
        if not (self.rise.imag or level.imag):
            return path.upright_contact(load, start.turn)
        tilt, pieces = path.tilt_of(level), scene.profile.pieces
        guess, found = near.guess(share), None
        if guess is not None and not pieces.functions:
            search = Search(pieces.tilted(tilt), 0.5 * scene.Estar)
            found = near_contact(search, load, guess, load)
        zone = found.interval if found else path.contact_at(load, tilt)
        near.add(share, zone)
        return zone

    def _below(self, loads: Loads, depth: complex) -> complex:
        """A depth below the level at the end of the step, counted from that under other loads."""
        return depth - (self.path.level(self.end) - self.path.level(loads))

    def _beside(self, share: float, depth: complex, x: float, leaves: bool) -> float:
        """f times the gap of Λ^ at x, which is in contact at a share of the step.

        The gap of one profile does not depend on the contact around it, which may be that before x
        leaves or after it came; where slip has opposite signs, it does.
        """
        around = self.start if leaves else self.end
        loads = self.change.loads(share) if self.state.turned else around
        key = loads, self._below(loads, depth)
        if abs(key[1]) <= SETTLED * abs(self.path.level(loads)):
            return 0.0
        if key not in self._states:
            self._states[key] = self.path.on_the_way(loads.normal, key[1], self.state.turned)
        contact = self._states[key].contact
        inside = np.nextafter(contact.x1, np.inf), np.nextafter(contact.x2, -np.inf)
        return float(self._states[key].slip(np.clip([x], *inside))[0])

    def shares(self, o: SlippedLayer) -> tuple[float, float]:
        """The shares of the step at which the front enters and leaves a layer."""
        first, last = (1.0 - (surface / self.rise).real for surface in o.surface)
        return first, last

    def _front(self, o: SlippedLayer, sign: float, share: float) -> complex:
        """The depth of the front in a layer below the level at the end of the step."""

        def carried(share: float) -> complex:
            loads = self.change.loads(share)
            return sign * self.path.shear(loads) - self.path.level(loads)

        return o.upper + (carried(share) - carried(self.shares(o)[0])) / o.jump

    def crossed(self, x: float) -> float:
        """The share of the step at which an edge passes x.

        It is the last time if x comes into contact, the first if it leaves.
        """
        first = self._contact(0.0)
        comes = min(first.from_left(x), first.from_right(x)) < 0.0
        right = x > (first if comes else self._contact(1.0)).m

        def inside(share: float) -> float:
            contact = self._contact(share)
            return float(contact.from_right(x) if right else contact.from_left(x))

        known = [(share, inside(share)) for share in SEARCHED]
        if known[0][1] >= 0.0:
            k = next((k for k, (_, room) in enumerate(known) if room < 0.0), len(known) - 1) - 1
        else:
            k = max(k for k, (_, room) in enumerate(known[:-1]) if room < 0.0)
        (low, at_low), (high, at_high) = known[k : k + 2]
        if at_low * at_high >= 0.0:  # x is at the edge at the start or the end
            return high if at_low else low

        def settled(a: float, b: float, value: float) -> bool:
            return b - a <= SETTLED

        return false_position(inside, low, high, (at_low, at_high), settled)

    def _refuse_slip(self, x: Array) -> None:
        self.refuse(
            f"how far x = {float(x[0]):.6g} slips while it is in contact is not covered; ask for "
            f"points within the contact under P = {min(self.start.P, self.end.P):.6g}"
        )

    def refuse(self, what: str) -> None:
        """Refuse steps in which fronts are not where P and the tilt alone put them."""
        why = ""
        if not self.path.in_one_patch:
            why = "the contact is not in one patch under every load"
        elif not all(event.timed for event in self.state.slips):
            why = "one end of the stick zone is held up or passes an earlier one before the other"
        elif self.path.curved and any(len(event.layers) > 1 for event in self.state.slips):
            why = "the tilt follows from the moment, the front passes an earlier one"
        if why:
            raise ContactError(
                f"step {self.index} of the path, to {self.end}: {why} while the contact changes "
                f"and slips: {what}",
                step=self.index,
            )
