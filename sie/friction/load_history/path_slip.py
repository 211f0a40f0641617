"""Stick, slip and shear at one point of a load path, from the memory there."""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.loading import contact_under
from sie.friction.loads import Loads
from sie.friction.panel_shear import PanelShear
from sie.friction.part_answers import drag, slip
from sie.friction.slip_state import Slip
from sie.friction.state import SAME, State, between, intervals
from sie.numerics import chebyshev
from sie.numerics.graded_panels import Pieces, Rule
from sie.numerics.interval import Interval
from sie.numerics.zones import left_over, within
from sie.traction.base import ZERO, Density
from sie.traction.combination import superposed

from . import changing_contact
from .changing_contact import ChangingContact
from .turning_point import TurningPoint

Array = NDArray[np.float64]

NODES, EARLY = 24, 6  # of a step: nodes in a root of its share


class Followed(changing_contact.Followed, Protocol):
    """A path that was followed, and its contacts.

    period           of the profile
    first_loading    the state of a contact that was never sheared before S rose to a depth
    plain            the solution under P and a tilt, without shear
    patches          the patches of contact under P and a tilt
    shift_of_step    the shift that slip adds in one step
    contact          the contact under loads, in one patch
    by_parts         a turning point, with the parts of the step to it
    """

    @property
    def period(self) -> float: ...
    def first_loading(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def plain(self, P: float, turn: float) -> Any: ...
    def patches(self, P: float, turn: float) -> tuple[tuple[float, float], ...]: ...
    def shift_of_step(self, index: int) -> float: ...
    def contact(self, loads: Loads) -> Interval: ...
    def by_parts(self, index: int) -> TurningPoint: ...


class PathSlip(Slip):
    """Stick, slip and shear at a point of a path.

    The shear is Σ weight × first loading over the corners of the memory.
    """

    kind = "after a path"

    def __init__(
        self, history: Followed, index: int = 0, state: TurningPoint | None = None
    ) -> None:
        self.history, self.index = history, index
        self.state = history.turning_points[index] if state is None else state
        self.normal = self.state.loads.normal
        self.friction = history.scene.friction
        if self.state.straight and isinstance(self.state.memory.total, complex):
            self._refuse_retreat()

    def _refuse_retreat(self) -> None:
        """Refuse a return from loads under which slip zones have retreated.

        A scene means one monotonic loading and has an answer; after a return the state depends on
        the path.
        """
        depth, returned = self.state.memory.deepest
        if returned and depth.imag and not self._loading(depth).advancing:
            Q, sigma = depth.real, depth.imag / self.history.shear(Loads(0.0, 0.0, 1.0)).imag
            raise ContactError(
                f"step {self.index} of the path: under the largest loads, Q = {Q:.6g} with σ = "
                f"{sigma:.6g}, zones of slip have retreated on the way, and what they left "
                "depends on that way; lower Q or σ",
                step=self.index,
            )

    @property
    def advancing(self) -> bool:  # type: ignore[override]
        memory = self.state.memory
        if not (self.state.straight and memory.total.imag):
            return True
        return all(loading.advancing for _, loading in self._terms)

    def _loading(self, depth: complex) -> Slip:
        return self.history.first_loading(self.normal, depth, self.state.turned)

    @property
    def contact(self) -> Interval:  # type: ignore[override]
        return self._plain.normal.edges.contact

    @property
    def _plain(self) -> Any:
        return self.history.plain(*self.normal)

    @property
    def _terms(self) -> list[tuple[float, Slip]]:
        return [
            (weight, self._loading(depth)) for depth, weight in self.state.memory.corners if depth
        ]

    @property
    def _now(self) -> Slip | None:
        """The first loading whose depth is that of the last step's slip."""
        return (
            self._loading(self.state.memory.top.thickness)
            if self.state.last and self.state.memory.top
            else None
        )

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        now = self._now
        return self._plain.patches if now is None else now.stick

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        now, last = self._now, self.state.last
        zones = (
            ()
            if now is None or last is None
            else tuple((lo, hi, sign * last.sign) for lo, hi, sign in now.slipped)
        )
        return *self._slipped_and_gone, *zones

    @property
    def _slipped_and_gone(self) -> tuple[tuple[float, float, float], ...]:
        """Zones that slipped while P fell, and where slip reversed or stopped as they left."""
        zones: list[tuple[float, float, float]] = []
        for gone in self.state.slips:
            if gone is not self.state.last:
                start, end = (
                    self.normal[0] - depth.real / self.friction
                    for depth in (gone.layers[0].surface[0], gone.layers[-1].lower)
                )
                outer, inner = (self.history.patches(load, self.normal[1]) for load in (start, end))
                left = left_over(outer, inner, self.history.period)
                zones += [(lo, hi, gone.sign) for lo, hi in left]
        return tuple(zones)

    @property
    def untouched(self) -> tuple[float, float]:
        terms = self._terms
        if not terms:
            return self.contact.x1, self.contact.x2
        return terms[-1][1].stick[0] if terms[-1][1].stick else (0.0, 0.0)

    @property
    def levels(self) -> tuple[float, ...]:
        return tuple(end for _, loading in self._terms for zone_ in loading.stick for end in zone_)

    @property
    def condition(self) -> float:  # type: ignore[override]
        return max((loading.condition for _, loading in self._terms), default=1.0)

    @cached_property
    def shear(self) -> Density:
        terms = self._terms
        if not terms:
            return ZERO
        if len(terms) == 1 and terms[0][0] == 1.0:
            return terms[0][1].shear
        full = 0.0  # times the pressure, which is taken once
        rest: list[tuple[float, Density]] = []
        for weight, loading in terms:
            scale, others = loading.parts
            full += weight * scale
            rest += [(weight * factor, density) for factor, density in others]
        return superposed((full, self._plain.slope_density), *rest)

    @property
    def contacts(self) -> tuple[Any, ...]:
        return tuple(contact for _, loading in self._terms for contact in loading.contacts)

    def slip(self, x: Array) -> Array:
        """Relative slip since x came into contact."""
        past = self.history.turning_points[: self.index + 1]
        if not self.state.parts and all(state.loads.normal == self.normal for state in past):
            return sum(
                (weight * loading.slip(x) for weight, loading in self._terms), np.zeros(x.shape)
            )
        total = np.zeros(x.shape)
        for index, (before, state) in enumerate(pairwise((past[0], *past))):
            if state.loads.P == 0.0:
                continue
            touches = self._touches(x, state.loads)
            start = before.loads.touching(state.loads) if state.parts else before.loads
            stayed = self._touches(x, start) & touches
            total = np.where(stayed, total, 0.0) + step_slip(self.history, index, x)
            new = touches & ~stayed
            if state.parts:
                total[new] = step_slip(self.history, index, x[new])
            elif state.slips and index and new.any():
                total[new] = ChangingContact(self.history, index).slip_of_new(x[new])
        return total

    def _touches(self, x: Array, loads: Loads) -> NDArray[np.bool_]:
        if loads.P == 0.0:
            return np.zeros(x.shape, dtype=bool)
        return within(x, self.history.plain(*loads.normal).patches, self.history.period)

    def slip_now(self, x: Array) -> Array:
        return step_slip(self.history, self.index, x)

    @cached_property
    def shift(self) -> float:
        past = self.history.turning_points[: self.index + 1]
        same = all(state.loads.normal == self.normal for state in past)
        if same and not self.state.parts:
            return sum(weight * loading.shift for weight, loading in self._terms)
        return sum(self.history.shift_of_step(index) for index in range(self.index + 1))


class CourseSlip(PathSlip):
    """Stick, slip and shear at a point of a path, the step to which was followed part by part."""

    @property
    def kind(self) -> str:  # type: ignore[override]
        return f"followed part by part, as {self.state.why}"

    @cached_property
    def shear(self) -> Density:
        state = self.state.state
        contact = state.contact
        room = SAME * contact.width

        def of_patch(x1: float, x2: float) -> Density:
            zone, marks = Interval(x1, x2), state.marks
            inside = marks[(marks > x1 + room) & (marks < x2 - room)]
            rule = Rule.graded(intervals([(x1, x2)], inside, room))
            load = float(rule.weight @ state.shear.on(rule))
            return PanelShear(zone, state.shear, inside.tolist(), load, contact.limit)

        found = [of_patch(*patch) for patch in contact.patches]
        return found[0] if len(found) == 1 else superposed(*((1.0, q) for q in found))

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        return self.state.state.stick

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        return self.state.state.slip

    @property
    def levels(self) -> tuple[float, ...]:
        return tuple(self.state.state.marks.tolist())

    @property
    def contacts(self) -> tuple[()]:
        return ()


def state_of(history: Followed, point: TurningPoint) -> State:
    """What a step from a turning point starts from."""
    if point.parts:
        return point.state
    contact, slip = contact_under(history, point.loads), PathSlip(history, state=point)
    shear = slip.shear
    if shear is ZERO:
        return State.untouched(contact)
    room = SAME * contact.width
    marks = np.unique(np.concatenate((slip.levels, contact.limit.marks)))
    q = Pieces.fitted(intervals(contact.patches, marks, room), lambda rule: shear(rule.x))
    stick = tuple((lo, hi) for lo, hi in slip.stick if hi > lo)
    zones = between(contact.patches, stick)
    signs = np.sign(q(np.array([0.5 * (lo + hi) for lo, hi in zones])))
    slips = tuple((*zone, float(s)) for zone, s in zip(zones, signs, strict=True))
    return State(contact, stick, slips, q)


def touched(history: Followed, loads: Loads) -> State:
    """The same where the bodies have just come into contact: q is in proportion to p."""
    contact = contact_under(history, loads)
    share = loads.Q / (history.scene.friction * loads.P)
    q = Pieces(contact.limit.ends, share * contact.limit.series)
    return State(contact, contact.patches, (), q)


def step_shift(history: Followed, index: int) -> float:
    """The shift that slip adds in one step."""
    state = history.turning_points[index]
    if any(any(o.surface) for event in state.slips for o in event.layers):
        return _shift_of_change(history, index)
    if state.parts:
        return _shift_of_change(history, index)

    def until(depth: complex) -> float:
        return (
            history.first_loading(state.loads.normal, depth, state.turned).shift if depth else 0.0
        )

    return sum(
        event.sign * o.jump * (until(o.lower) - until(o.upper))
        for event in state.slips
        for o in event.layers
    )


def step_slip(history: Followed, index: int, x: Array) -> Array:
    """The slip in one step, where x was in contact all along it."""
    state = history.turning_points[index]
    normal, out = state.loads.normal, np.zeros(x.shape)
    for part in state.parts:
        assert state.step is not None
        out += slip(part, state.step, x)
    if state.last is not None:  # zones that slipped before have left the contact
        for o in state.last.layers:
            for depth, sign in ((o.lower, 1.0), (o.upper, -1.0)):
                if sign < 0.0 and depth == o.surface[0]:
                    continue  # slip began at the edges
                at, under = depth, normal
                if state.turned and sign < 0.0 and any(o.surface):
                    at = depth - o.surface[0]
                    under = history.turning_points[index - 1].loads.normal
                if at.real > 0.0 or at.imag:
                    loading = history.first_loading(under, at, state.turned)
                    out += sign * o.jump * state.last.sign * loading.slip(x)
    return out


# -- while the contact changes ---------------------------------------------------------------------


def _shift_of_change(history: Followed, index: int) -> float:
    """The shift that slip adds in a step: all of it, less that without slip.

    A contact [M - R, M + R] that does not slip shifts by -2 ln R/(π E*) dQ + 2/E* M dτ.
    """
    if not history.in_one_patch:
        ChangingContact(history, index).refuse("how far slip shifts the indenter is not covered")
    point = history.by_parts(index)
    step = point.step
    assert step is not None
    u, weight = chebyshev.gauss_legendre(NODES)
    shares = u**EARLY  # beside the place of first contact R is like a power of the share
    stuck_shift = 0.0
    for share, w in zip(shares, weight * EARLY * shares / u, strict=True):
        ((x1, x2),) = step.at(float(share)).patches
        rates = step.rates
        moved = 0.5 * math.pi * rates.tau * (x1 + x2) - rates.Q * math.log(0.25 * (x2 - x1))
        stuck_shift += float(w) * moved
    whole = sum(drag(part) for part in point.parts)
    return (whole - stuck_shift) / (0.5 * math.pi * history.scene.Estar)
