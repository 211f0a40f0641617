"""Stick, slip and shear at one point of a load path, from the memory there."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.graded_panels import Pieces
from sie.numerics.interval import Interval
from sie.numerics.zones import left_over, within
from sie.traction.base import Density
from sie.traction.combination import ZERO, superposed

from .equations import scaled_shift
from .load_steps import Followable, TurningPoint
from .loading import Loads, contact_under
from .slip import Slip
from .slip_of_state import StateSlip
from .state import SAME, State, intervals
from .step_energy import work
from .zones_between import slip

Array = NDArray[np.float64]

NODES, EARLY = 24, 6  # of a step: nodes in a root of its share


class PathSlip(Slip):
    """Stick, slip and shear at a point of a path.

    The shear is Σ weight × first loading over the corners of the memory.
    """

    kind = "after a path"

    def __init__(
        self, history: Followable, index: int = 0, state: TurningPoint | None = None
    ) -> None:
        self.history, self.index = history, index
        self.state = history.turning_points[index] if state is None else state
        self.normal = self.state.loads.normal
        self.friction = history.scene.friction

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
        layers = self.state.memory.layers
        return self._loading(layers[0][0]) if self.state.slipped and layers else None

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:  # type: ignore[override]
        now = self._now
        return self._plain.patches if now is None else now.stick

    @property
    def slipped(self) -> tuple[tuple[float, float, float], ...]:
        now = self._now
        if now is None:
            return ()
        return tuple((lo, hi, sign * self.state.sign) for lo, hi, sign in now.slipped)

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

    @property
    def promised(self) -> float:  # type: ignore[override]
        return sum(abs(weight) * loading.promised for weight, loading in self._terms)

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
        total = np.zeros(x.shape)
        for index, (before, state) in enumerate(pairwise((past[0], *past))):
            if state.loads.P == 0.0:
                continue
            touches = self._touches(x, state.loads)
            stayed = self._touches(x, before.loads.touching(state.loads)) & touches
            total = np.where(stayed, total, 0.0)
            total[touches] += step_slip(self.history, index, x[touches])
        return total

    def _touches(self, x: Array, loads: Loads) -> NDArray[np.bool_]:
        if loads.P == 0.0:
            return np.zeros(x.shape, dtype=bool)
        return within(x, self.history.plain(*loads.normal).patches, self.history.period)

    def slip_now(self, x: Array) -> Array:
        return step_slip(self.history, self.index, x)

    @cached_property
    def shift(self) -> float:
        return sum(self.history.shift_of_step(index) for index in range(self.index + 1))


class CourseSlip(StateSlip, PathSlip):
    """Stick, slip and shear at a point of a path, the step to which was followed part by part."""

    @property
    def kind(self) -> str:  # type: ignore[override]
        return f"followed part by part, as {self.state.why}"

    @property
    def locked(self) -> State:
        state = self.state.state
        if self.state.slides is None:
            return state
        s = math.copysign(1.0, state.contact.Q)
        return replace(state, stick=(), slip=tuple((*patch, s) for patch in state.stick))


def state_of(history: Followable, point: TurningPoint) -> State:
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
    stick = tuple((lo, hi) for lo, hi in slip.stick if hi > lo) or contact.patches
    zones = left_over(contact.patches, stick)
    signs = np.sign(q(np.array([0.5 * (lo + hi) for lo, hi in zones])))
    slips = tuple((*zone, float(s)) for zone, s in zip(zones, signs, strict=True))
    return State(contact, stick, slips, q)


# -- what a step adds ------------------------------------------------------------------------------


def _overwritten(history: Followable, point: TurningPoint) -> Iterator[tuple[float, Slip]]:
    """The first loadings whose sum, each times a factor, is what slip adds in a step by layers."""
    for layer in point.slipped:
        for depth, factor in ((layer.lower, layer.jump), (layer.upper, -layer.jump)):
            if depth:
                yield factor, history.first_loading(point.loads.normal, depth, point.turned)


def step_energy(history: Followable, index: int) -> float:
    """The energy that friction dissipates in one step."""
    state = history.turning_points[index]
    if state.step is not None:
        with np.errstate(all="ignore"):  # what that leaves is not accurate, and refused
            return sum(work(part, state.step) for part in state.parts)
    return sum(factor * loading.energy for factor, loading in _overwritten(history, state))


def step_slip(history: Followable, index: int, x: Array) -> Array:
    """The slip in one step; where x came into contact in it, since then."""
    state, out = history.turning_points[index], np.zeros(x.shape)
    for part in state.parts:
        assert state.step is not None
        out += slip(part, state.step, x)
    for factor, loading in _overwritten(history, state):
        out += state.sign * factor * loading.slip(x)
    return out


def step_shift(history: Followable, index: int) -> float:
    """The shift that slip adds in one step."""
    state = history.turning_points[index]
    if state.step is not None:
        return _shift_of_parts(history, state)
    parts = _overwritten(history, state)
    return state.sign * sum(factor * loading.shift for factor, loading in parts)


def _shift_of_parts(history: Followable, point: TurningPoint) -> float:
    """The shift that slip adds in a step: all of it, less that without slip.

    A contact [M - R, M + R] that does not slip shifts by -2 ln R/(π E*) dQ + 2/E* M dτ.
    """
    step = point.step
    assert step is not None
    if not history.in_one_patch:
        raise ContactError(
            f"the step to {point.loads} is followed in several patches: how far slip shifts the "
            "indenter in it is not covered; keep P, the tilt and the proportion of Q and σ"
        )
    u, weight = chebyshev.gauss_legendre(NODES)
    shares = u**EARLY  # beside the place of first contact R is like a power of the share
    stuck_shift = 0.0
    for share, w in zip(shares, weight * EARLY * shares / u, strict=True):
        ((x1, x2),) = step.at(float(share)).patches
        rates = step.rates
        moved = 0.5 * math.pi * rates.tau * (x1 + x2) - rates.Q * math.log(0.25 * (x2 - x1))
        stuck_shift += float(w) * moved
    whole = sum(scaled_shift(part.before, part.state, part.stuck) for part in point.parts)
    return (whole - stuck_shift) / (0.5 * math.pi * history.scene.Estar)
