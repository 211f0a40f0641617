"""Stick, slip and shear at one point of a load path, from the memory there."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.friction.loads import Loads
from sie.friction.slip_state import Slip
from sie.numerics.halving import integral
from sie.numerics.interval import Interval
from sie.numerics.zones import left_over, within
from sie.traction.base import ZERO, Density
from sie.traction.combination import superposed

from . import changing_contact
from .changing_contact import ChangingContact
from .growing_contact import LoadChange, Span
from .marched_step import Held, MarchedStep, drag
from .panel_shear import PanelShear
from .slip_onset import onsets
from .turning_point import TurningPoint

Array = NDArray[np.float64]


class Followed(changing_contact.Followed, Protocol):
    """A path that was followed, and its contacts.

    period           of the profile
    first_loading    the state of a contact that was never sheared before S rose to a depth
    plain            the solution under P and a tilt, without shear
    patches          the patches of contact under P and a tilt
    shift_of_step    the shift that slip adds in one step
    contact          the contact under loads, in one patch
    """

    @property
    def period(self) -> float: ...
    def first_loading(self, normal: tuple[float, float], depth: complex, turned: bool) -> Slip: ...
    def plain(self, P: float, turn: float) -> Any: ...
    def patches(self, P: float, turn: float) -> tuple[tuple[float, float], ...]: ...
    def shift_of_step(self, index: int) -> float: ...
    def contact(self, loads: Loads) -> Interval: ...


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
        if not self.state.marched and all(state.loads.normal == self.normal for state in past):
            return sum(
                (weight * loading.slip(x) for weight, loading in self._terms), np.zeros(x.shape)
            )
        total = np.zeros(x.shape)
        for index, (before, state) in enumerate(pairwise((past[0], *past))):
            if state.loads.P == 0.0:
                continue
            touches = self._touches(x, state.loads)
            start = before.loads.touching(state.loads) if state.marched else before.loads
            stayed = self._touches(x, start) & touches
            total = np.where(stayed, total, 0.0) + step_slip(self.history, index, x)
            new = touches & ~stayed
            if state.marched and new.any():
                total[new] = _marched_slip_of_new(self.history, index, x[new])
            if state.slips and index and new.any():
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
        if same and not self.state.marched:
            return sum(weight * loading.shift for weight, loading in self._terms)
        return sum(self.history.shift_of_step(index) for index in range(self.index + 1))


class MarchedSlip(PathSlip):
    """Stick, slip and shear at a point of a path that was marched to."""

    @property
    def kind(self) -> str:  # type: ignore[override]
        return f"marched, as {self.state.why}"

    @property
    def marched(self) -> tuple[MarchedStep, ...]:
        """The parts of the last step."""
        return self.state.marched

    @property
    def error(self) -> float:
        """The error of the ends of the stick zone over its half-width, of all steps together."""
        past = self.history.turning_points[: self.index + 1]
        return sum(part.error for point in past for part in point.marched)

    @cached_property
    def shear(self) -> Density:
        return self.marched[-1].shear

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        return self.marched[-1].sticks

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        return self.marched[-1].slipped

    @property
    def levels(self) -> tuple[float, ...]:
        return self.marched[-1].marks

    @property
    def contacts(self) -> tuple[()]:
        return ()


def touched(history: Followed, loads: Loads, end: Loads) -> Held:
    """What a step to `end` starts from that has just brought the bodies into contact.

    Q and P grow in one proportion, and the bulk stress and the tilt do not matter yet; but a flat
    has its width at once. Where slip begins with it at one edge alone, the state is that of the
    same loads in proportion on a flat.
    """
    p, (Q, tau) = history.pressure_at(loads), history.sheared_by(loads)
    stick = Interval(p.contact.x1, p.contact.x2)
    found = Held(Q, tau, p, superposed((Q / loads.P, p)), stick, (0.0, 0.0), tuple(p.breaks))
    change, f = LoadChange(history, loads, end), history.scene.friction
    signs = next((way.signs for way in onsets(found, change, f)), found.signs)
    if all(signs) or not any(signs):
        return found
    state = history.on_the_way(loads.normal, history.shear(loads), True)
    c1, c2 = state.stick[0]
    stick = Interval(c1 if signs[0] else stick.x1, c2 if signs[1] else stick.x2)
    marks = (*state.levels, *state.shear.breaks)
    return replace(found, shear=state.shear, stick=stick, signs=signs, marks=marks)


def held(history: Followed, point: TurningPoint, loads: tuple[float, float]) -> Held:
    """What a step from a turning point under Q and τ starts from."""
    if point.marched:
        return point.marched[-1].held
    found, contact = _layered(history, point, loads), history.contact(point.loads)
    if found.shear is ZERO:
        return found
    # on panels, as a step evaluates it often

    def limit(x: Array) -> Array:
        return history.scene.friction * found.pressure(x)

    shear = PanelShear(contact, found.shear, found.marks, loads[0], limit)
    return replace(found, shear=shear)


def _layered(history: Followed, point: TurningPoint, loads: tuple[float, float]) -> Held:
    """The same after a step that layers answer, with the shear as it is."""
    state = PathSlip(history, state=point)
    contact, zones = state.contact, state.slipped
    stick = Interval(*state.stick[0]) if state.stick else Interval(contact.m, contact.m)
    left = [sign for _, hi, sign in zones if hi == stick.x1]
    right = [sign for lo, _, sign in zones if lo == stick.x2]
    signs = (left or [0.0])[-1], (right or [0.0])[-1]
    pressure = history.plain(*point.loads.normal).slope_density
    marks = (*state.levels, *state.shear.breaks)
    return Held(*loads, pressure, state.shear, stick, signs, marks)


def step_shift(history: Followed, index: int) -> float:
    """The shift that slip adds in one step."""
    state = history.turning_points[index]
    if any(any(o.surface) for event in state.slips for o in event.layers):
        return _shift_of_change(history, index)
    if state.marched:
        before = history.turning_points[max(index - 1, 0)]
        if before.loads.normal != state.loads.normal:
            return _shift_of_change(history, index)
        return sum(part.integrals.shift for part in state.marched)

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
    for part in state.marched:
        out += part.slip(x)
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
    """The shift that slip adds while the contact changes: all of it, less that without slip.

    A contact [M - R, M + R] that does not slip shifts by -2 ln R/(π E*) dQ + 2/E* M dτ.
    """
    before, point = history.turning_points[index - 1 : index + 1]
    start = before.loads.touching(point.loads)
    if not history.in_one_patch:
        ChangingContact(history, index).refuse("how far slip shifts the indenter is not covered")
    change = LoadChange(history, start, point.loads)
    span = Span.of(change, 0.0, 1.0)

    def without_slip(part: float) -> float:
        share = span.share(np.array(part))
        contact = change.pressure(float(share)).contact
        dQ, dtau = change.rates.Q, change.rates.tau
        moved = math.pi * dtau * contact.m - dQ * math.log(contact.r)
        return moved * span.length / float(span.pace(share, share))

    if point.marched:
        whole = sum(part.drag for part in point.marched)
    else:
        first, end = (_layered(history, o, history.sheared_by(o.loads)) for o in (before, point))
        old = first.pressure.contact
        stuck = Interval(max(old.x1, end.stick.x1), min(old.x2, end.stick.x2))
        whole = drag(first, end, stuck)
    stuck_shift = integral(without_slip, abs(change.rates.Q) + abs(without_slip(1.0)))
    half_modulus = 0.5 * history.scene.Estar
    return (whole - stuck_shift) / (math.pi * half_modulus)


def _marched_slip_of_new(history: Followed, index: int, x: Array) -> Array:
    """The slip at places (1-d) that came into contact in a marched step, since then."""
    parts, step = history.turning_points[index].marched, ChangingContact(history, index)
    places = [(step.crossed(float(at)), np.array([at])) for at in x]
    return np.array([sum(part.slip_since(*place)[0] for part in parts) for place in places])
