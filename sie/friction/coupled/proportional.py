"""The contact of dissimilar bodies under P and Q that grew in proportion, of a power law.

Both sides of the axis are those of `oblique`: in a frame with β > 0 and Q >= 0, x < 0 is the mirror
image of another such side. Q below a part of f P only leaves the axis in the stick zone; above it
what stuck would slip again, in the other direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.contact.known_contact import Edges
from sie.errors import ContactError
from sie.numerics.interval import Interval
from sie.numerics.root_finding import false_position
from sie.problem.load_limit import refuse_sliding
from sie.problem.scene import Scene
from sie.profiles.base import Profile
from sie.profiles.power_law import PowerLaw
from sie.traction.base import on_line, zero_or_nan

from .functions import FlatFunctions, flat_functions
from .oblique import Oblique, centre, inclination, of_load
from .two_sided import Known, TwoSidedTraction, both_tractions

Array = NDArray[np.float64]

NAMED = 1e-4  # of artanh μ: the error of the largest load that is named
LEAST, MOST = 1.3, 16.0  # of exponents: beyond them powers lose digits
# artanh μ where the slip zones of P alone are below resolution: it widens one by exp(-2 artanh μ)
NARROW = -3.4
STEEPEST = -12.0  # artanh μ: below it x = 0 hardly ever sticks


class Placement(NamedTuple):
    """Where a contact lies: its axis, the sign of β, and -1 if its frame is a mirror image."""

    axis: float
    sign: float
    flip: float


@dataclass(frozen=True, eq=False)
class ProportionalContact:
    """The state under P and Q that grew in proportion, of a power law.

    right, left     both sides of it in the frame (β > 0, Q >= 0); the left one is a mirror image
    strength        C
    loads           P and |Q|
    half_modulus    E*/2
    placement       of the frame
    """

    right: Oblique
    left: Oblique
    strength: float
    loads: tuple[float, float]
    half_modulus: float
    placement: Placement

    @property
    def j(self) -> float:
        return self.right.j

    @property
    def friction(self) -> float:
        return self.right.flat.friction

    @property
    def turn(self) -> float:
        """The sign of Q, and of q and the slip against those in the frame."""
        return self.placement.sign * self.placement.flip

    @cached_property
    def b(self) -> float:
        """Half the width of the contact: P = C b^j/j times the load of the flat."""
        one, other = np.array([abs(self.right.mu)]), np.array([self.left.below])
        own = math.pi * self.right.root * float(self.right.flat.outside(one, other)[0])
        return float((self.j * self.loads[0] / (self.strength * own)) ** (1.0 / self.j))

    @cached_property
    def frame_marks(self) -> tuple[float, ...]:
        """The edges of the contact and of the stick zone, with the axis, ascending."""
        b, right, left = self.b, self.right, self.left
        return -left.edge * b, -left.stuck * b, 0.0, right.stuck * b, right.edge * b

    @property
    def marks(self) -> tuple[float, ...]:
        axis, _, flip = self.placement
        return tuple(sorted(axis + flip * u for u in self.frame_marks))

    @property
    def contact(self) -> Interval:
        return Interval(self.marks[0], self.marks[-1])

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        return ((self.marks[1], self.marks[3]),)

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        x1, e1, _, e2, x2 = self.marks
        return (x1, e1, -self.placement.sign), (e2, x2, self.placement.sign)

    # -- at places of the contact ------------------------------------------------------------------

    def _frame(self, x: Array) -> Array:
        """u of x, on the edges where x is."""
        axis, _, flip = self.placement
        u = flip * (x - axis)
        for place, own in zip(self.marks[:: int(flip)], self.frame_marks, strict=True):
            u = np.where(x == place, own, u)
        return u

    def _by_side(
        self, x: Array, function: Callable[[Oblique, Array, Array, Array], Array]
    ) -> Array:
        """A function of a side, of ξ, and of the distances from the edge and the stick zone."""
        u, b = self._frame(x), self.b
        values = np.empty(len(x))
        for side, sign in ((self.right, 1.0), (self.left, -1.0)):
            own = (u >= 0.0) if sign > 0.0 else (u < 0.0)
            xi = sign * u[own] / b
            edge, stuck = side.edge * b, side.stuck * b
            from_edge = np.abs(sign * u[own] - edge) / b
            from_stick = np.abs(sign * u[own] - stuck) / b
            values[own] = function(side, xi, from_edge, from_stick)
        return values

    def pressure(self, x: Array) -> Array:
        """p in contact."""
        size = self.strength * self.b ** (self.j - 1.0)
        return size * self._by_side(x, lambda side, *at: side.traction(0, *at))

    def shear(self, x: Array) -> Array:
        """q in contact."""
        size = self.turn * self.strength * self.b ** (self.j - 1.0)
        return size * self._by_side(x, lambda side, *at: self._sign(side) * side.traction(1, *at))

    def _sign(self, side: Oblique) -> float:
        return 1.0 if side is self.right else -1.0

    @property
    def _length(self) -> float:
        return self.strength * self.b**self.j / (self.j * self.half_modulus)

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x since it came into contact, same shape: 0 outside the contact."""

        def value(flat: Array) -> Array:
            g, (lo, *_, hi) = np.zeros(flat.shape), self.marks
            inside = (flat >= lo) & (flat <= hi)
            g[inside] = (
                self.turn
                * self._length
                * self._by_side(
                    flat[inside], lambda side, *at: self._sign(side) * side.slipped(*at)
                )
            )
            return g

        return on_line(value, x)

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        (lo, hi), (x1, *_, x2) = profile.domain, self.marks
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        beside = np.isfinite(flat) & (out == 0.0) & ((flat < x1) | (flat > x2))
        gaps = self._by_side(flat[beside], lambda side, xi, ahead, _: side.gap(xi, ahead))
        out[beside] = self._length * gaps
        return out.reshape(np.shape(x))

    def kept_gradient(self, x: Array) -> Array:
        """E*/2 times the slip gradient that sticks."""
        values = self._by_side(x, lambda side, xi, *_: side.kept * xi ** (self.j - 1.0))
        return self.placement.sign * self.strength * self.b ** (self.j - 1.0) * values

    @cached_property
    def least_slip(self) -> float:
        """The least slip gradient outwards in a slip zone, over the largest."""
        rates = [side.slip.rows[3] for side in (self.right, self.left)]
        return min(0.0, *(float(rate.min() / rate.max()) for rate in rates))

    @property
    def moment(self) -> float:
        """∫p x dx."""
        axis, _, flip = self.placement
        size = self.strength * self.b ** (self.j + 1.0) / (self.j + 1.0)
        return axis * self.loads[0] + flip * size * (
            self.right.first_moment - self.left.first_moment
        )

    @property
    def energy(self) -> float:
        """The energy that slip dissipated."""
        size = (
            self.friction
            * (self.strength * self.b**self.j) ** 2
            / (2.0 * self.j * self.half_modulus)
        )
        return size * (self.right.dissipation + self.left.dissipation)

    @cached_property
    def tractions(self) -> tuple[TwoSidedTraction, TwoSidedTraction]:
        """p and q with their potentials, which share their panels."""
        power, (P, Q) = 0.5 + self.right.flat.theta, self.loads
        known = Known(
            self.placement.axis, self.marks, (power, power), (P, self.turn * Q), self.moment
        )

        def both(x: Array) -> Array:
            return np.stack((self.pressure(x), self.shear(x)))

        return both_tractions((self.pressure, self.shear), both, known)


def proportional_contact(scene: Scene) -> tuple[Edges, ProportionalContact]:
    """The edges and the state under the scene's P and Q, which grew in proportion from 0.

    Raises ContactError for other profiles than power laws, and where Q/P is too large.
    """
    law, P, Q = _law(scene.profile), scene.normal_load, scene.tangential_load
    if law is None or not LEAST <= law.exponent <= MOST:
        raise ContactError(
            "P and Q of dissimilar bodies that grow in proportion are solved for power laws h = "
            f"A |x|^m, {LEAST} <= m <= {MOST}, and {scene.profile!r} is none of these: how its "
            "zones move is not solved; press it with P first, then apply Q, or give dundurs = 0 to "
            "neglect β"
        )
    assert P is not None
    refuse_sliding(scene.friction, P, Q)
    flat = flat_functions(abs(scene.beta), scene.friction)
    turn = inclination(flat, abs(Q) / P)
    if flat.punch.bonded and turn < NARROW:
        raise ContactError(
            f"dissimilar bodies (β = {scene.beta:.4g}) with friction = {scene.friction:g} under "
            f"Q = {Q / P:.4g} P in proportion from zero: the slip zones of P alone are narrower "
            "than 1e-15 of the contact, and how Q widens one of them is not resolved; lower Q, "
            "press with P first, or give dundurs = 0 to neglect β"
        )
    if turn < STEEPEST:
        raise ContactError(_too_oblique(flat, law.exponent, (P, abs(Q))))
    nu = centre(flat, turn, law.exponent)
    right, left = (Oblique(flat, s * turn, s * nu, law.exponent) for s in (1.0, -1.0))
    if right.stuck <= 0.0:
        raise ContactError(_too_oblique(flat, law.exponent, (P, abs(Q))))
    half_modulus, sign = 0.5 * scene.Estar, math.copysign(1.0, scene.beta)
    strength = half_modulus * law.exponent * law.coefficient * math.exp(-right.rise(nu))
    placement = Placement(law.axis, sign, math.copysign(1.0, sign * Q))
    state = ProportionalContact(right, left, strength, (P, abs(Q)), half_modulus, placement)
    edges = Edges(state.contact, P, state.moment, 0.0, (False, False), 0.0, 0.0, 0.0, 0)
    return edges, state


def _law(profile: Profile) -> PowerLaw | None:
    """The power law that a profile is; a polynomial of one term is one, and a parabola anywhere."""
    slope = profile.pieces
    if profile.power_law or slope.functions or len(slope.origins) > 1:
        return profile.power_law
    c, axis = slope.coefficients[0], float(slope.origins[0])
    (terms,) = np.nonzero(c)
    if np.isfinite(slope.domain).any() or not terms.size:
        return None
    last, a = int(terms[-1]), float(c[terms[-1]])
    if last == 1:
        axis -= float(c[0]) / a
    elif terms.size > 1:
        return None
    return PowerLaw(last + 1.0, a / (last + 1.0), axis) if last % 2 and a > 0.0 else None


def _too_oblique(flat: FlatFunctions, j: float, loads: tuple[float, float]) -> str:
    """Why these loads have no answer, with the largest Q/P that has."""

    def stuck(z: float) -> float:
        return Oblique(flat, -z, centre(flat, -z, j), j).stuck

    end = NAMED
    while stuck(end) > 0.0:
        end += 0.5
    start = max(end - 0.5, 0.0)
    ends = stuck(start), stuck(end)
    z = false_position(stuck, start, end, ends, lambda a, b, value: b - a < NAMED)
    P, Q = loads
    most = of_load(flat, z)
    return (
        f"dissimilar bodies under Q = {Q / P:.4g} P in proportion from zero: what sticks first "
        f"would slip again, the other way, where Q exceeds {most:.4g} P = "
        f"{most / flat.friction:.3g} f P, and the zones then depend on more than the loads; lower "
        "Q to that, press with P first, or give dundurs = 0 to neglect β"
    )
