"""A tangential load on dissimilar bodies pressed together before: the edges of contact and stick.

P is constant, Q > 0 and β > 0 (other signs are mirror images). Both slip zones get the sign of Q:
the right one grows from that of the normal load, a new one grows from the left edge, and the old
left one sticks with the slip gradient γ that it had. As the zones move in one direction only, the
state depends on Q alone. The four edges x1 < e1 < e2 < x2 meet four conditions,

    ∫p_d dx = 0,    p finite at x1 and at x2,    f P - ∫(f p - q) dx = Q,

with p = p_s + p_d, p_s full sliding on [x1, x2] under P (`on_panels`) and p_d of `zones`.
The start joins what is known at both ends: at Q = 0 the zones of the normal load, and next to f P a
stick zone x0 ± l sqrt(1 - Q/(f P)) where the slip gradient of full sliding less γ,

    G = f E*/2 h' + β (1 + f²) p_s - γ,

passes zero; there f p - q solves the equation of a Hertzian contact, l² = 2 f P/(π G'). Where that
is too far off, the load is followed from another one (`load_path`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import edge_integrals
from sie.contact.known_contact import Edges
from sie.numerics.interval import EPS, Interval
from sie.problem.coverage import refuse_corners
from sie.problem.scene import Scene
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.traction.on_panels import SlidingDensity
from sie.traction.panels import Panels
from sie.traction.piece_quadrature import SlidingGeometry

from .contact import CoupledContact
from .gradient import SlipGradient, Tabulated, tabulated
from .slip_rate import SlipRate
from .zones import Rule, StickProblem, Zones, stick_rule

Array = NDArray[np.float64]

NEARLY = 1e-9  # of the half-width, from the ends of what the zones may be
# Where values are wanted: panels shrink to such parts of the half-width next to kinks, if they are
# few, and of the stick zone at its ends; growth
DEEP, FEW, APART, DEEPEST, RATIO = 1e-12, 8, 1e-9, 1e-17, 3.0
NOWHERE = np.zeros(0)
WINDOW = 1.02  # times the widest contact: where the slope is resolved
FIRST = (0.5, 0.99, 0.9, 0.1)  # parts of f P from which the load is followed
ROUNDED = 0.15  # of the places looked at, those beside a flat base
# Of the room about the last point to stick: zones that fit in it, the short ones beside flat bases
FITTING = (0.3, 0.1, 0.03)
# Half-widths: nearer edges pass a corner of the profile; others keep such a part of the distance
AT_CORNER, NEARER = 1e-4, 0.03
FOLDS = 1.5  # by which a step may change a logarithm


def sliding_pressure(
    slope: Slope, contact: Interval, half_modulus: float, epsilon: float, load: float
) -> SlidingDensity:
    """p in full sliding on any contact, with the singular ends that the load asks for."""
    I = edge_integrals(slope, contact, None, False, epsilon)
    cos, r = math.cos(math.pi * epsilon), contact.r
    G = half_modulus * cos
    difference = 2.0 * G * cos * I.I0 / math.pi
    weighted = 2.0 * cos / (math.pi * r) * (load - G * r * (I.I1 + 2.0 * epsilon * I.I0))
    k1 = 0.5 * (weighted + (1.0 + 2.0 * epsilon) * difference)
    panels = Panels(SlidingGeometry(slope, contact, epsilon), I.I0)
    return SlidingDensity(contact, half_modulus, k1, k1 - difference, load, 0.0, panels)


class Trial(NamedTuple):
    """What four edges give: the parts of the state, and the conditions that they miss."""

    zones: Zones
    sliding: SlidingDensity
    problem: StickProblem
    missed: Array

    @property
    def edges(self) -> Array:
        return np.array(self.zones)


@dataclass(frozen=True, eq=False)
class TangentialSearch:
    """The search for the four edges, on the profile with its axis at 0.

    `iteration` moves them as far as `room` and `ahead` allow.

    normal          the state under P alone
    slope           h' on the profile
    friction        f
    widest          edges of the contact in full sliding under P
    """

    normal: CoupledContact
    slope: Slope
    friction: float
    widest: tuple[float, float]

    @property
    def beta(self) -> float:
        return self.normal.flat.beta

    @property
    def theta(self) -> float:
        return math.atan(self.beta * self.friction) / math.pi

    @property
    def limit(self) -> float:
        """f P."""
        return self.friction * self.normal.load

    @property
    def stress(self) -> float:
        """The mean of f p under P alone."""
        return 0.5 * self.limit / self.normal.b

    @cached_property
    def resolved_slope(self) -> Slope:
        """h' on straight pieces and series, as far as any contact may reach."""
        (x1, x2), b = self.widest, self.normal.b
        lo, hi = self.slope.domain
        return refined(self.slope, max(WINDOW * min(x1, -b), lo), min(WINDOW * max(x2, b), hi), EPS)

    @cached_property
    def gamma(self) -> Tabulated:
        """γ in the contact under P alone, on panels that resolve pressures in sliding as well."""
        state, gradient = self.normal, SlipGradient(self.normal.superposition, self.normal.ahead)
        (x1, x2), b, more = self.widest, state.b, 0.5 * (WINDOW - 1.0)
        lo, hi = self.resolved_slope.domain
        # Beside an almost flat base pressures on a wider window would be so large that their
        # rounding exceeds what is to be resolved
        left, right = (end + more * (end - state.flat_base) for end in (max(-x1, b), max(x2, b)))
        window = Interval(max(-left, lo), min(right, hi))
        panels = Panels(SlidingGeometry(self.resolved_slope, window, -self.theta), 0.0)
        any_pressure = SlidingDensity(window, state.half_modulus, 0.0, 0.0, 0.0, 0.0, panels)
        return tabulated(
            lambda y: gradient(y, self.H(y)),
            (
                lambda y: self.friction * any_pressure(y),
                lambda y: self.friction * any_pressure(-y),
            ),
            state.marks,
            self.stress,
        )

    def H(self, x: Array) -> Array:
        """E*/2 h'."""
        values: Array = self.normal.half_modulus * self.slope(x)
        return values

    def closest(self, zones: Zones, Q: float) -> Trial:
        """The state with a rule that shrinks to the very ends of the stick zone, and to kinks of γ.

        Principal values next to these need it; the conditions do not.
        """
        normal = self.normal
        kinks = {y for y in normal.marks[:-1] if y > APART * normal.b}
        kinks = {0.0, normal.c} | (kinks if len(kinks) <= FEW else set())
        beside = normal.b * RATIO ** -np.arange(0.0, math.log(1.0 / DEEP) / math.log(RATIO))
        places = np.array([[y, -y] for y in sorted(kinks)]).ravel()[:, None]
        cuts = np.concatenate(((places + beside).ravel(), (places - beside).ravel(), places[:, 0]))
        return self.trial(np.array(zones), Q, DEEPEST * zones.stuck, cuts)

    def trial(
        self, edges: Array, Q: float, nearest: float = math.inf, cuts: Array = NOWHERE
    ) -> Trial:
        """The parts of the state with these edges."""
        zones, f, beta = Zones(*edges.tolist()), self.friction, self.beta
        contact = Interval(zones.x1, zones.x2)
        a1, a2 = 0.5 + self.theta, 0.5 - self.theta
        P, G = self.normal.load, self.normal.half_modulus
        sliding = sliding_pressure(self.resolved_slope, contact, G, -self.theta, P)
        beyond = self._to_kink(zones)
        rule = stick_rule(zones, (a1, a2), np.append(self.gamma.cuts, cuts), min(nearest, beyond))
        problem = StickProblem(zones, beta, f, rule, self.gradient_of_rest(sliding, rule))
        found, width = problem.answer, 2.0 * contact.r
        size, remaining = self.limit / self.normal.b, self.limit - Q
        left = beta * found.left + 0.5 * sliding.k1 * width**a1
        right = beta * found.right + 0.5 * sliding.k2 * width**a2
        missed = (
            found.load / size,
            self.friction * left / (size * self.normal.b**a1),
            self.friction * right / (size * self.normal.b**a2),
            (remaining - found.stuck) / remaining,
        )
        return Trial(zones, sliding, problem, np.array(missed))

    def _to_kink(self, zones: Zones) -> float:
        """How near to an end of the stick zone γ_d is not smooth in a slip zone."""
        marks = np.array(self.normal.marks[:-1])
        places = np.concatenate((-marks, [0.0], marks))
        left, right = zones.e1 - places, places - zones.e2
        return float(np.concatenate((left[left > 0.0], right[right > 0.0], [math.inf])).min())

    def second_moment(self, contact: Interval) -> float:
        """∫p x dx about its centre that the slope alone causes in a contact that slides."""
        k = edge_integrals(self.resolved_slope, contact, None, False, -self.theta)
        G = self.normal.half_modulus * math.cos(math.pi * self.theta)
        return -G * contact.r**2 * (k.C2 - 0.5 * k.I0)

    def gradient_of_rest(self, sliding: SlidingDensity, rule: Rule) -> Array:
        """γ_d at the places of a rule."""
        f, beta, (x1, x2) = self.friction, self.beta, sliding.interval
        # Next to a narrow slip zone the singular ends vary over fewer doubles than x tells apart
        to_left, to_right = rule.left + (rule.ends[0] - x1), rule.right + (x2 - rule.ends[1])
        ends = 0.5 * (sliding.k1 * to_right + sliding.k2 * to_left)
        ends *= to_right ** (self.theta - 0.5) * to_left ** (-self.theta - 0.5)
        p = replace(sliding, k1=0.0, k2=0.0)(rule.x) + ends
        return self.gamma(rule.x) - f * self.H(rule.x) - beta * (1.0 + f * f) * p

    # -- the search --------------------------------------------------------------------------------

    def least_slip(self, trial: Trial) -> float:
        """The least slip that Q + dQ adds along Q in a slip zone, over the largest."""
        return SlipRate(trial.zones, self.beta, self.friction).least

    @cached_property
    def _bounds(self) -> tuple[float, float]:
        """What bounds the stick zone: an edge of contact and an end of stick under P alone."""
        return -self.normal.b, self.normal.c

    @property
    def first_edges(self) -> Array:
        """The edges as Q tends to 0, with no slip on the left."""
        (lo, hi), b = self._bounds, self.normal.b
        return np.array([-b, lo, hi, b])

    @property
    def _looked_at(self) -> Array:
        """Places that the stick zone may reach in a contact that slides."""
        lo, hi = self._bounds
        room = min(hi, self.widest[1]) - lo
        crowded = math.log(self.normal.ahead / room) / math.log(ROUNDED)
        x: Array = lo + room * np.linspace(0.0, 1.0, 203)[1:-1] ** max(2.0, crowded)
        return x

    @property
    def spreads(self) -> bool:
        """Whether surfaces beside the contact of P alone are the last to slip."""
        return bool(self._last_stick[0] == self._looked_at[0])

    @property
    def first_loads(self) -> tuple[float, ...]:
        """Loads to follow; the stick zones of the last ones are far from both of their bounds."""
        (lo, hi), (x0, half) = self._bounds, self._last_stick
        room = min(x0 - lo, hi - x0, half) / half
        parts = (*FIRST, *(1.0 - (part * room) ** 2 for part in FITTING))
        return tuple(part * self.limit for part in parts)

    @cached_property
    def _last_stick(self) -> tuple[float, float]:
        """x0 and l, in a contact that slides: x0 has slipped least."""
        f, beta, b = self.friction, self.beta, self.normal.b
        contact = Interval(*self.widest)
        G, P = self.normal.half_modulus, self.normal.load
        sliding = sliding_pressure(self.resolved_slope, contact, G, -self.theta, P)
        x = self._looked_at
        slips = f * self.H(x) + beta * (1.0 + f * f) * sliding(x) - self.gamma(x)
        k = int(np.argmin(np.cumsum((slips[1:] + slips[:-1]) * np.diff(x)))) + 1
        if slips[:2].sum() > 0.0 and k == 1:
            return float(x[0]), b
        k = k if slips[k] > 0.0 else min(k + 1, len(x) - 1)
        rise = (slips[k] - slips[k - 1]) / (x[k] - x[k - 1])
        if rise <= 0.0:
            return float(x[k]), b
        x0 = float(np.clip(x[k] - slips[k] / rise, x[0], x[-1]))
        return x0, math.sqrt(2.0 * self.limit / (math.pi * rise))

    def start(self, Q: float) -> Array:
        """Four edges next to those under Q."""
        (lo, hi), (x0, half) = self._bounds, self._last_stick
        part = Q / self.limit
        left, right = min(half, x0 - lo), min(half, hi - x0)
        cos, sin = math.sqrt(1.0 - part), math.sqrt(part)
        e1 = x0 - cos * (left + (x0 - lo - left) * cos * cos)
        e2 = x0 + cos * right + (hi - x0 - right) * (1.0 - sin)
        b = self.normal.b
        x1, x2 = (end + part * (edge - end) for end, edge in zip((-b, b), self.widest, strict=True))
        near = NEARLY * b
        e1, e2 = (
            max(e1, lo + near, x1 + near),
            min(e2, hi - near * (1.0 - hi / b) - EPS * b, x2 - near),
        )
        return np.array([x1, e1, e2, x2])

    def ahead(self, edges: Array, step: Array) -> Array:
        """The edges after a step; the stick zone moves in the logarithm of the room to its bounds.

        Next to Q = 0 a step is many times as long as that.
        """
        new, bounds = edges + step, np.array(self._bounds)
        gaps = edges[1:3] - bounds
        new[1:3] = bounds + gaps * np.exp(np.clip(step[1:3] / gaps, -FOLDS, FOLDS))
        # The conditions have powers and logarithms of the distance from a corner of the profile
        for corner in self.corners:
            before = edges - corner
            crosses = (before * (new - corner) < 0.0) & (np.abs(before) > AT_CORNER * self.normal.b)
            new[crosses] = corner + NEARER * before[crosses]
        return new

    @cached_property
    def corners(self) -> tuple[float, ...]:
        """Places where the slope jumps, by more than its rounding at the edge under P alone."""
        rounding = EPS * abs(float(self.slope(np.array([self.normal.b]))[0]))
        return tuple(place for place, rise in self.slope.rises if abs(rise) > rounding)

    def room(self, edges: Array) -> Array:
        """How far each edge may move either way, to the next edge or bound; not positive beyond."""
        lo, hi = self._bounds
        least, most = self.resolved_slope.domain
        x1, e1, e2, x2 = edges.tolist()
        left, stuck, right = e1 - x1, e2 - e1, x2 - e2
        return np.array(
            [
                min(left, x1 - least),
                min(left, stuck, e1 - lo),
                min(stuck, right, hi - e2),
                min(right, most - x2),
            ]
        )


def tangential_search(
    scene: Scene, normal: CoupledContact, contact: Callable[[Scene], Edges]
) -> TangentialSearch:
    """The search under the scene's P; ContactError for contacts that end at corners.

    `contact` finds the edges of a scene, of full sliding here.
    """
    sliding = Scene(
        profile=scene.profile,
        modulus=scene.Estar,
        dundurs=abs(scene.beta),
        friction=scene.friction,
        normal_load=normal.load,
        sliding=1,
    )
    edges = contact(sliding)
    if normal.corner_load or any(edges.sharp):
        refuse_corners(scene)
    widest = edges.contact.x1 - normal.axis, edges.contact.x2 - normal.axis
    slope = scene.profile.pieces.shifted(-normal.axis) if normal.axis else scene.profile.pieces
    return TangentialSearch(normal, slope, scene.friction, widest)
