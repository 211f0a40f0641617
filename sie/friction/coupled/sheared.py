"""Pressure, shear, slip and gap of dissimilar bodies under P, then Q.

In the frame of `tangential` (axis at 0, β > 0, Q > 0), with p_d, γ_d, Ψ, χ of
`zones`, V the pressure of full sliding without its singular ends k1, k2, and r = f p - q:

    stick   p = p_s + p_d,  (1 - β²) p_d = A - β γ_d,       q = f p - r,  H r + β f r = g
    slip    p = V + (x2 - x)^(1/2+θ) (x - x1)^(1/2-θ) S,    q = f p
            γ = f E*/2 h' + β (1 + f²) p - H r
    beside  H p = H p_s + χ Ψ

S, smooth up to the edge, is what k1, k2 and χ Ψ leave there. β < 0 turns the signs of q and of the
slip, and a Q against the sign of β is the mirror image.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.problem.coverage import old_slip_width
from sie.profiles.base import Profile
from sie.traction.base import on_line, zero_or_nan
from sie.traction.in_contact import InContact
from sie.traction.on_panels import SlidingDensity

from .contact import CoupledContact
from .gradient import RESOLVED, SlipGradient
from .integral import RATIO, Integral, integral, outwards, towards_ends
from .near_corner import Corner, stuck_corners
from .tangential import TangentialSearch, Trial
from .two_sided import Known, TwoSidedTraction, both_tractions

Array = NDArray[np.float64]

BESIDE = 1e-9  # half-widths from a corner of the profile, where values infinite there are evaluated
ABREAST = 1e-12  # half-widths from the edge: nearer H p is a difference of large numbers
# Parts of the way between two places next to which f p - q is small, or p infinite
LOOKED_AT = 0.5 + 0.5 * np.tanh(np.linspace(-8.0, 8.0, 49))
EDGE_DEGREE = 24  # of S on the outer half of a slip zone


@dataclass(frozen=True, eq=False)
class ShearedContact:
    """The state under P and Q.

    search      the search that found the edges, with the state under P alone
    trial       the state in the frame of the search
    Q           |tangential load|
    sign        of β
    flip        -1 if the frame is a mirror image
    """

    search: TangentialSearch
    trial: Trial
    Q: float
    sign: float
    flip: float

    # -- zones and loads ---------------------------------------------------------------------------

    @property
    def axis(self) -> float:
        return self.search.normal.axis

    @property
    def friction(self) -> float:
        return self.search.friction

    @property
    def contact(self) -> Interval:
        """The edges in the frame of the bodies."""
        return Interval(*self._placed(self.trial.zones.x1, self.trial.zones.x2))

    def _placed(self, lo: float, hi: float) -> tuple[float, float]:
        one, other = (self.axis + self.flip * u for u in (lo, hi))
        return min(one, other), max(one, other)

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zone."""
        return (self._placed(self.trial.zones.e1, self.trial.zones.e2),)

    @property
    def slip_zones(self) -> tuple[tuple[float, float, float], ...]:
        """(lo, hi, sign of q)."""
        x1, e1, e2, x2 = self.trial.zones
        zones = ((*self._placed(x1, e1), self.turn), (*self._placed(e2, x2), self.turn))
        return tuple(sorted(zones))

    @property
    def turn(self) -> float:
        """The sign of Q, and of q and the slip against those in the frame."""
        return self.sign * self.flip

    @cached_property
    def state(self) -> Trial:
        """The state with a rule that shrinks to the very ends of the stick zone."""
        return self.search.closest(self.trial.zones, self.Q)

    @cached_property
    def moment(self) -> float:
        """∫p x dx about the axis, in the frame: of p_s and of p_d."""
        sliding, rule = self.state.sliding, self.state.problem.rule
        panels, r, e = sliding.panels, sliding.contact.r, sliding.epsilon
        ends = sliding.k2 * (1.0 + 2.0 * e) ** 2 - sliding.k1 * (1.0 - 2.0 * e) ** 2
        of_slope = self.search.second_moment(sliding.contact)
        about_centre = of_slope + math.pi * r * r / (4.0 * panels.edge.cos) * ends
        rest = self.search.beta * float(self.state.problem.masses @ rule.x)
        return sliding.contact.m * self.search.normal.load + about_centre + rest

    # -- tractions, in the frame -------------------------------------------------------------------

    @cached_property
    def _regular(self) -> SlidingDensity:
        """V."""
        return replace(self.state.sliding, k1=0.0, k2=0.0)

    def frame_pressure(self, u: Array) -> Array:
        """p at x1 <= u <= x2."""
        zones, p = self.state.zones, self._regular(u)
        stuck = (u >= zones.e1) & (u <= zones.e2)
        p[stuck] = self._stuck_pressure(u[stuck])
        for corner in self._stuck_corners:
            corner.corrected(p, u, self._stuck_pressure, self._pressure_before)
        for on_right in (False, True):
            slips = u > zones.e2 if on_right else u < zones.e1
            p[slips] += self._beside_stick(u[slips], on_right)
        return p

    def _pressure_before(self, u: Array) -> Array:
        return self.search.normal.pressure(np.abs(u))

    def _stuck_pressure(self, u: Array) -> Array:
        beta, problem = self.search.beta, self.state.problem
        zones, sliding = self.state.zones, self.state.sliding(u)
        A = problem.A_at(u - zones.e1, zones.e2 - u)
        p: Array = sliding + beta * (A - self._gamma_of_rest(u, sliding)) / (1.0 - beta * beta)
        return p

    def _gamma_of_rest(self, u: Array, sliding: Array) -> Array:
        f, beta = self.friction, self.search.beta
        rest: Array = self.search.gamma(u) - f * self.search.H(u) - beta * (1.0 + f * f) * sliding
        return rest

    def _beside_stick(self, u: Array, on_right: bool) -> Array:
        """p - V in a slip zone."""
        (x1, e1, e2, x2), (a1, a2) = self.state.zones, self._exponents
        out, outer = np.empty(len(u)), u > 0.5 * (e2 + x2) if on_right else u < 0.5 * (x1 + e1)
        scale = (x2 - u) ** a1 * (u - x1) ** a2
        at, series = 0.5 * (x2 - e2) if on_right else 0.5 * (e1 - x1), self._edge_series[on_right]
        d = (x2 - u[outer] if on_right else u[outer] - x1) / at
        out[outer] = chebyshev.evaluate(series, 2.0 * d - 1.0)
        out[~outer] = self._S(u[~outer], on_right)
        out *= scale
        return out

    @property
    def _exponents(self) -> tuple[float, float]:
        return self.state.problem.map.exponents

    def _S(self, u: Array, on_right: bool) -> Array:
        """S in a slip zone, nearer to the stick zone than to the edge."""
        (x1, e1, e2, x2), (a1, a2) = self.state.zones, self._exponents
        sliding, problem = self.state.sliding, self.state.problem
        strength = (
            (1.0 if on_right else -1.0) * self.search.beta * math.cos(math.pi * problem.map.theta)
        )
        ends = 0.5 * (sliding.k1 * (x2 - u) + sliding.k2 * (u - x1))
        both = ends + strength * np.abs(u - e2) ** a2 * np.abs(u - e1) ** a1 * problem.Psi(u)
        S: Array = both / ((x2 - u) * (u - x1))
        return S

    @cached_property
    def _edge_series(self) -> tuple[Array, Array]:
        """S next to the left and the right edge, in the distance from it."""
        x1, e1, e2, x2 = self.state.zones
        part = 0.5 * (1.0 + chebyshev.points(EDGE_DEGREE))
        left = self._S(x1 + 0.5 * (e1 - x1) * part, False)
        right = self._S(x2 - 0.5 * (x2 - e2) * part, True)
        return chebyshev.transform(left), chebyshev.transform(right)

    def deficit(self, u: Array) -> Array:
        """f p - q at x1 <= u <= x2, 0 in slip."""
        zones, r = self.state.zones, np.zeros(len(u))
        stuck = (u > zones.e1) & (u < zones.e2)
        r[stuck] = self._stuck_deficit(u[stuck])
        for corner in self._stuck_corners:
            corner.corrected(r, u, self._stuck_deficit, self._deficit_before)
        return r

    def _stuck_deficit(self, u: Array) -> Array:
        gamma = self._gamma_of_rest(u, self.state.sliding(u))
        r: Array = self.state.problem.deficit(u, gamma)
        return r

    def _deficit_before(self, u: Array) -> Array:
        """f p - q under P alone."""
        normal = self.search.normal
        p, q = normal.pressure_and_shear(np.abs(u))
        r: Array = self.friction * p - normal.sign * np.sign(u) * q
        return r

    @cached_property
    def _stuck_corners(self) -> tuple[Corner, ...]:
        return stuck_corners(self.search.corners, self.state.zones.e1, self.state.zones.e2)

    def frame_shear(self, u: Array) -> Array:
        """q; under a corner of the profile, where p is infinite, the mean of q on both sides."""
        q: Array = self._frame_tractions(u)[1]
        return q

    def _frame_tractions(self, u: Array) -> Array:
        """Rows of p and q."""
        p = self.frame_pressure(u)
        corner = np.isinf(p)
        q = np.empty(len(u))
        q[~corner] = self.friction * p[~corner] - self.deficit(u[~corner])
        if corner.any():
            aside = BESIDE * self.state.sliding.contact.r
            beside = (self.frame_shear(u[corner] + step) for step in (-aside, aside))
            q[corner] = 0.5 * sum(beside, np.zeros(int(corner.sum())))
        return np.stack((p, q))

    def in_frame(self, x: Array) -> Array:
        """u of x, on the edges where x is."""
        u: Array = self.flip * (x - self.axis)
        (x1, _, _, x2), (lo, hi) = self.state.zones, self.contact[:2]
        left, right = (x1, x2) if self.flip > 0.0 else (x2, x1)
        return np.where(x == lo, left, np.where(x == hi, right, u))

    # -- slip --------------------------------------------------------------------------------------

    @cached_property
    def _gained(self) -> tuple[Integral, Integral]:
        """E*/2 times what the slip gains under Q, up to e1 and from e2: ∫(γ - that under P)."""
        (x1, e1, e2, x2), b = self.state.zones, self.search.normal.b
        cuts = self.search.gamma.cuts
        spread = b + (-x1 - b) * RATIO ** -np.arange(30.0)
        # A corner up to b is one of the cuts, but for rounding
        beyond = [corner for corner in self.search.corners if corner < -b]
        left = towards_ends(x1, e1, np.concatenate((cuts, -spread, beyond)))
        return integral(self._gain, left), integral(self._gain, towards_ends(e2, x2, cuts))

    @property
    def least_slip(self) -> float:
        """The least slip along Q in a slip zone, over the largest; positive by the friction law.

        It is that of the rate with Q, and that under Q of what was in contact before, which is left
        out where it is less than the error of γ, and next to the old edge, where the slip of the
        normal load went on under small loads.
        """
        (left, right), (x1, e1, e2, x2) = self._gained, self.state.zones
        inner = self.search.normal.b * (1.0 - old_slip_width(self.search.beta, self.friction))
        gained = left(left.cuts[left.cuts >= -inner]) - left(left.cuts[-1:])
        gained = np.append(gained, right(right.cuts))
        least, rounding = float(gained.min()), RESOLVED * self.search.stress * max(e1 - x1, x2 - e2)
        least = least / float(np.abs(gained).max()) if least < -rounding else 0.0
        return min(least, self.search.least_slip(self.trial))

    @property
    def least_deficit(self) -> float:
        """The least f p - q in stick, over its size, by which friction is exceeded if negative.

        It is looked for towards the ends of the stick zone and corners of the profile in it.
        """
        (_, e1, e2, _), stress = self.trial.zones, self.search.stress
        ends = [e1, *(corner.place for corner in self._stuck_corners), e2]
        u = np.concatenate([lo + (hi - lo) * LOOKED_AT for lo, hi in itertools.pairwise(ends)])
        return float(self.deficit(u).min()) / stress

    def _gain(self, u: Array) -> Array:
        """γ - that under P alone, in slip."""
        f, beta, search = self.friction, self.search.beta, self.search
        H, p, b = search.H(u), self.frame_pressure(u), search.normal.b
        gamma = f * H + beta * (1.0 + f * f) * p - self.state.problem.H_deficit(u)
        before, beside = search.gamma(np.clip(u, -b, b)), u < -b
        if beside.any():
            normal = search.normal
            gradient = SlipGradient(normal.superposition, normal.ahead)
            y = -u[beside]
            before[beside] = gradient.beside(y, normal.hilbert_outside(y))
        gain: Array = gamma - before
        return gain

    def relative_slip(self, x: ArrayLike) -> Array:
        """The slip at x, same shape: 0 outside the contact."""

        def value(flat: Array) -> Array:
            u, g = self.in_frame(flat), np.zeros(flat.shape)
            x1, e1, e2, x2 = self.state.zones
            normal, left, right = self.search.normal, *self._gained
            old = (np.abs(u) <= normal.b) & (u >= x1) & (u <= x2)
            g[old] = np.sign(u[old]) * normal.sign * normal.slip(np.abs(u[old]))
            beyond, before = (u > e2) & (u <= x2), (u < e1) & (u >= x1)
            g[beyond] += right(u[beyond]) / normal.half_modulus
            whole = left(np.array([e1]))
            g[before] += (left(u[before]) - whole) / normal.half_modulus
            return self.turn * g

        return on_line(value, x)

    # -- beside the contact ------------------------------------------------------------------------

    def hilbert_outside(self, u: Array) -> Array:
        """1/π ∫p/(u - t) dt beside the contact, in the frame."""
        (x1, e1, e2, x2), (a1, a2) = self.state.zones, self._exponents
        chi = np.abs((u - e2) / (u - x2)) ** a2 * np.abs((u - e1) / (u - x1)) ** a1
        H: Array = self.state.sliding.hilbert(u)
        return H + self.search.beta * chi * self.state.problem.Psi(u)

    def gap(self, x: Array, profile: Profile) -> Array:
        """The gap between the deformed bodies: 0 in contact."""
        flat = np.asarray(x, dtype=float).ravel()
        lo, hi = profile.domain
        out: Array = zero_or_nan(flat)
        out[(flat < lo) | (flat > hi) | np.isinf(flat)] = np.inf
        (first, last), u = self.contact[:2], self.in_frame(flat)
        x1, _, _, x2 = self.state.zones
        known = np.isfinite(flat) & (out == 0.0)
        for edge, side in ((first, flat < first), (last, flat > last)):
            beside = side & known
            if beside.any():
                rise = profile.height(flat[beside]) - profile.height(np.array(edge))
                on_right = (edge == last) == (self.flip > 0.0)
                raised = self._raised(x2 if on_right else x1, u[beside])
                out[beside] = rise - raised / self.search.normal.half_modulus
        return out.reshape(np.shape(x))

    def _raised(self, edge: float, u: Array) -> Array:
        """E*/2 times how far the surfaces part less than the profile rises, from an edge on."""
        side = math.copysign(1.0, float(u[0]) - edge)
        width = self.contact.r

        def H(d: Array) -> Array:
            return side * self.hilbert_outside(edge + side * np.maximum(d, ABREAST * width))

        return outwards(H, np.abs(u - edge), width)

    # -- with their potentials ---------------------------------------------------------------------

    @cached_property
    def tractions(self) -> tuple[TwoSidedTraction, TwoSidedTraction]:
        """p and q with their potentials, which share their panels."""
        at = self.axis + self.flip * 0.5 * (self.trial.zones.e1 + self.trial.zones.e2)

        def pressure(x: Array) -> Array:
            return self.frame_pressure(self.in_frame(x))

        def shear(x: Array) -> Array:
            return self.turn * self.frame_shear(self.in_frame(x))

        (a1, a2), P = self._exponents, self.search.normal.load
        known = Known(
            at,
            self.marks,
            (a2, a1) if self.flip > 0.0 else (a1, a2),
            (P, self.turn * self.Q),
            self.axis * P + self.flip * self.moment,
        )
        return both_tractions((pressure, shear), self._both, known)

    def _both(self, x: Array) -> Array:
        """Rows of p and q."""
        values: Array = np.array([[1.0], [self.turn]]) * self._frame_tractions(self.in_frame(x))
        return values

    @property
    def values(self) -> InContact:
        return InContact(self.contact, self.marks, lambda x, _: self._both(x))

    @property
    def kept(self) -> tuple[tuple[float, float], CoupledContact]:
        """What sticks, and the state under P alone."""
        return self.stick[0], self.search.normal

    @property
    def kind(self) -> str:
        way = "+" if self.turn > 0.0 else "-"
        return f"towards {way}x beside the stick zone; β couples p and q"

    @property
    def frame_marks(self) -> tuple[float, ...]:
        """The same in the frame."""
        return tuple(
            sorted({*self.trial.zones, *(self.flip * (x - self.axis) for x in self.marks)})
        )

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Places in the contact where p or q is not smooth, with its edges, ascending."""
        (lo, hi), normal = self.contact[:2], self.search.normal
        ends = [end for zone in self.stick for end in zone]
        # A corner beside the contact of P alone may lie in that under Q
        of_normal = {*normal.marks, *map(abs, self.search.corners)}
        places = {*ends, *(self.axis + s * y for y in of_normal for s in (-1.0, 1.0)), self.axis}
        kept = [x for x in places if lo < x < hi]
        return (lo, *sorted(kept), hi)
