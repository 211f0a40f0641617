"""The contact of dissimilar bodies under a symmetric convex profile, pressed with friction: edges, P', tractions.

The half-width b comes from P = ∫P' ds. It is not larger than without friction, as friction stiffens
the contact: the frictionless contact bounds the search, and refuses what no contact can carry. Where
b reaches a corner at the indenter's end, what is left of the load is that of a flat punch. β < 0 only
turns the sign of the shear and of the slip.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from sie.contact.edges import Edges
from sie.contact.normal import ECONOMY, normal_contact
from sie.errors import ContactError, LoadError
from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import EPS, interval_about
from sie.problem.scene import Scene
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope

from .coupled_flat import FULL_STICK
from .coupled_functions import FlatFunctions, flat_functions
from .coupled_growth import Piece, load_slope, power_law_growth, solved_growth
from .coupled_profile import GrowthPanel, Superposition, _graded, _rules

Array = NDArray[np.float64]

WIDER = 1.0 + 64.0 * EPS  # than the frictionless contact: as far as P' is known
FALLING = 1e-9  # of the largest P': below it a negative one is not rounding
ENERGY_NODES = 24
NEAR_EDGE = 0.3  # half-widths beside the edge on which H is smooth but for its power there


@dataclass(frozen=True, eq=False)
class CoupledContact:
    """The state under the load P, with y = |x - axis|.

    flat            functions of the flat punch; |β| and f
    growth          P' on panels, from the axis outwards
    corner_load     what an indenter whose end is a corner carries beyond ∫P'
    axis, b         the contact is axis ± b
    load            P
    sign            of β
    half_modulus    E*/2
    kinks           y at which h' or h'' jumps, up to b
    """

    flat: FlatFunctions
    growth: tuple[GrowthPanel, ...]
    corner_load: float
    axis: float
    b: float
    load: float
    sign: float
    half_modulus: float
    kinks: tuple[float, ...] = field(default=())

    @property
    def c(self) -> float:
        """Half the width of the stick zone."""
        return self.b if self.full_stick else self.flat.c * self.b

    @property
    def full_stick(self) -> bool:
        """Whether the slip zones are narrower than a part FULL_STICK of the contact."""
        return self.flat.rest <= FULL_STICK * (1.0 + 1e-6)

    @cached_property
    def superposition(self) -> Superposition:
        return Superposition(self.flat, self.growth)

    @property
    def flat_base(self) -> float:
        """Half the width of the profile's flat base, or of the flat punch."""
        return self.growth[0].origin if self.growth else self.b

    def pressure(self, y: Array) -> Array:
        """p at 0 <= y <= b."""
        p = self._of(self.superposition.pressure, y)
        if not self.flat_base:
            p[y == 0.0] = self._pressure_on_axis
        return p + self._of_corner(self.flat.pressure, y, self.b)

    def shear(self, y: Array) -> Array:
        """q on the right; odd in x."""
        deficit = self._of(self.superposition.shear_deficit, y)
        deficit += self._of_corner(self.flat.shear_deficit, y, self.b)
        inside = y < self.flat.c * self.b
        p = self.pressure(y)
        q = self.flat.friction * p
        q[inside] -= deficit[inside]
        q[y == 0.0] = 0.0
        return self.sign * q

    def slip(self, y: Array) -> Array:
        """The slip since y came into contact, on the right; odd in x."""
        g = self._of(self.superposition.slip, y) + self._of_corner(self.flat.slip, y, 1.0)
        return self.sign / self.half_modulus * g

    def _of(self, function: Callable[[Array, Array], Array], y: Array) -> Array:
        values = np.zeros(len(y))
        inside = (y > 0.0) & (y <= self.b) if not self.flat_base else y <= self.b
        values[inside] = function(y[inside], np.full(int(inside.sum()), self.b))
        return values

    def _of_corner(
        self, function: Callable[[Array, Array, Array], Array], y: Array, unit: float
    ) -> Array:
        """A function of the flat punch of half-width b under the load of the corner."""
        if not self.corner_load:
            return np.zeros(len(y))
        t, c = y / self.b, self.flat.c
        e = (self.b - y) / self.b
        from_c = np.abs(self.flat.rest - e) if c > 0.5 else np.abs(t - c)
        return self.corner_load / unit * function(t, e, from_c)

    @cached_property
    def _pressure_on_axis(self) -> float:
        """p(0) = A(0) ∫P'/s ds without a flat base; inf under a wedge."""
        first, *others = self.growth
        A = float(self.flat.A(np.array([0.0]), np.array([1.0]))[0])
        start = float(first(np.array([0.0]))[0]) if not first.power else 0.0
        if abs(start) > FALLING * float(np.abs(first.series).max()):
            return math.inf
        hi = min(first.hi, self.b)
        x, _, w = with_weight(ENERGY_NODES, 0.0, first.power - 1.0 if first.power else 0.0)
        total = float(w @ (first(hi * x) / x))
        for panel in others:
            if panel.lo < self.b:
                length = min(panel.hi, self.b) - panel.lo
                x, _, w = with_weight(ENERGY_NODES, 0.0, panel.power)
                total += length * float(w @ (panel(length * x) / (panel.lo + length * x)))
        return A * total

    # -- beside the contact --------------------------------------------------------------------------------------------

    def hilbert_outside(self, y: Array) -> Array:
        """1/π PV∫p/(y - t) dt at y > b."""
        H = load_slope(self.flat, self.growth, self.b, y)
        if self.corner_load:
            H += self.corner_load * self.flat.outside(self.b / y, (y - self.b) / y) / y
        return H

    def raised(self, y: Array) -> Array:
        """2/E* times the integral of that from b to each y >= b: how far the surfaces part less than the profile rises."""
        ahead = y - self.b
        none = np.full(len(y), np.inf)
        owner, start, size, _, kind = _graded(ahead, np.full(len(y), NEAR_EDGE * self.b), none)
        z, _, w = _rules(1.0 - self.flat.h if not self.corner_load else -self.flat.h, 0.0)
        at = self.b + (start[:, None] + size[:, None] * z[kind])
        H = self.hilbert_outside(at.ravel()).reshape(at.shape)
        integral = size * (H * w[kind]).sum(axis=1)
        return np.bincount(owner, integral, minlength=len(y)) / self.half_modulus

    @cached_property
    def energy(self) -> float:
        """What friction turned into heat: ∫ f p |dg| over both slip zones, while P grew."""
        flat, total = self.flat, 0.0
        steps = [(p, min(p.hi, self.b - p.origin) - p.lo) for p in self.growth]
        for panel, length in steps:
            if length > 0.0:
                x, _, w = with_weight(ENERGY_NODES, 0.0, panel.power)
                s = panel.origin + panel.lo + length * x
                total += length * float((w * panel(length * x)) @ self._rate(s))
        if self.corner_load:
            # The flat's own part grows as the square of its load
            edge = self._rate(np.array([self.b]))[0]
            total += self.corner_load * float(edge) + 0.5 * self.corner_load**2 * flat.dissipation
        return 2.0 * total / self.half_modulus

    def _rate(self, s: Array) -> Array:
        """∫ f p ĝ dx over c s < x < s, p the pressure under P(s)."""
        t, e, from_c, weight = self.flat.slip_places
        x = (s[:, None] * t).ravel()
        p = self.superposition.pressure(x, np.repeat(s, len(t))).reshape(len(s), -1)
        g = self.flat.slip(t, e, from_c)
        rate: Array = s * self.flat.friction * (p @ (weight * g))
        return rate


def coupled_contact(scene: Scene, tol: float) -> tuple[Edges, CoupledContact]:
    """The edges and the state; ContactError where no contact answers."""
    beta, profile = scene.beta, scene.profile
    assert profile.axis is not None
    flat = flat_functions(abs(beta), scene.friction)
    half_modulus = 0.5 * scene.Estar
    bound = normal_contact(
        Scene(
            profile=profile,
            modulus=scene.Estar,
            normal_load=scene.normal_load,
            half_width=scene.half_width,
        ),
        tol,
        ECONOMY,
    )
    widest, sharp = bound.edges.contact.r, bound.edges.sharp[0]
    law = profile.power_law
    kinks: tuple[float, ...] = ()
    if law is not None:
        slope = half_modulus * law.exponent * law.coefficient * widest ** (law.exponent - 1.0)
        growth: tuple[GrowthPanel, ...] = (
            power_law_growth(flat, law.exponent, slope, widest * WIDER),
        )
    else:
        pieces = _pieces(profile.pieces, profile.axis, widest, half_modulus)
        kinks = tuple(piece.lo for piece in pieces[1:] if piece.kinked)
        growth = solved_growth(flat, pieces) if pieces else ()
    b, load, corner = _width(growth, widest, sharp, scene)
    _refuse_falling(growth, b, profile.axis)
    contact = interval_about(profile.axis, b).rounded((profile.axis,))
    state = CoupledContact(
        flat,
        growth,
        corner,
        profile.axis,
        b,
        load,
        math.copysign(1.0, beta),
        half_modulus,
        tuple(k for k in kinks if k < b),
    )
    edges = Edges(contact, load, contact.m * load, 0.0, (corner > 0.0, corner > 0.0), 0.0, 0.0, 0.0, 0)
    return edges, state


def _pieces(slope: Slope, axis: float, widest: float, half_modulus: float) -> list[Piece]:
    """E*/2 h' on the right of the axis, piece by piece, without a flat base."""
    lo, hi = slope.domain
    end = min(axis + widest * WIDER, hi)
    resolved = refined(slope, axis, end, EPS)
    inner = resolved.breaks[(resolved.breaks > axis) & (resolved.breaks < end)]
    ends = [axis, *inner.tolist(), end]
    declared = set(slope.breaks.tolist())
    rises = dict(slope.rises)
    pieces: list[Piece] = []
    for left, right in zip(ends[:-1], ends[1:], strict=True):
        k = int(np.clip(np.searchsorted(resolved.breaks, left, "right") - 1, 0, len(resolved.origins) - 1))
        if not pieces and resolved.is_zero[k]:
            continue

        def H(ahead: Array, k: int = k, left: float = left) -> Array:
            at = np.array([left])
            values: Array = resolved.local(np.array([k]), at, np.zeros(1), ahead.reshape(1, -1))
            return half_modulus * values.reshape(ahead.shape)

        jumps = left in rises or (not pieces and left > axis and float(H(np.zeros(1))[0]) > 0.0)
        pieces.append(Piece(left - axis, right - axis, H, jumps, left in declared))
    return pieces


def _width(
    growth: tuple[GrowthPanel, ...], widest: float, sharp: bool, scene: Scene
) -> tuple[float, float, float]:
    """b, P and what a corner at the end of the indenter carries of it."""

    def load(b: float) -> float:
        return sum(panel.load(b) for panel in growth if panel.origin + panel.lo < b)

    if not growth:
        assert scene.normal_load is not None
        return widest, scene.normal_load, scene.normal_load
    if scene.normal_load is None:
        return widest, load(widest), 0.0
    P, most = scene.normal_load, load(widest)
    if most >= P:
        b = _root(growth, load, P, widest)
        return b, P, 0.0
    if sharp:
        return widest, P, P - most
    raise LoadError(
        f"the coupled contact of half-width {widest:.6g} carries {most:.6g} of {P:.6g}: "
        "friction should not make it softer; give dundurs = 0 to neglect β"
    )


def _root(
    growth: tuple[GrowthPanel, ...], load: Callable[[float], float], P: float, widest: float
) -> float:
    """b at which ∫P' = P, to relative accuracy of its distance from the first place of contact."""
    first = growth[0].origin

    def missed(ahead: float) -> float:
        return load(first + ahead) / P - 1.0

    lo, hi = 0.0, widest - first
    while missed(0.5 * hi) > 0.0 and hi > EPS * EPS * widest:
        hi *= 0.5
    lo = 0.5 * hi
    if missed(hi) <= 0.0:
        return first + hi
    return first + float(brentq(missed, lo, hi, xtol=1e-300, rtol=4.0 * EPS))


def _refuse_falling(growth: tuple[GrowthPanel, ...], b: float, axis: float) -> None:
    """Raises ContactError where P' < 0: the profile is not convex, and the contact would recede there."""
    for panel in growth:
        s, mass = panel.places
        near = panel.origin + s < b
        if (mass[near] < -FALLING * np.abs(mass).max()).any():
            where = axis + panel.origin + float(s[near][np.argmin(mass[near])])
            raise ContactError(
                f"the contact of dissimilar bodies with friction would not grow steadily at x = {where:.6g}: "
                "coupled slip is solved for convex profiles; smooth the profile, or give dundurs = 0 to neglect β"
            )
