"""The state of dissimilar bodies for any zones of stick and slip.

With H1 = E*/2 h', γ = E*/2 g', F(z) = 1/π ∫p/(z - t) dt and D = F beside the contact,

    (1)  H1 = Hp - β q      (12)  γ = Hq + β p      β > 0,   q = s f p where the bodies slip,

H² = -1 and F± = H1 + (κ ∓ i) p in slip, κ = s β f, leave one integral equation. With χ the product
of (z - l)^(1/2-sθ) (z - r)^(1/2+sθ) over the slip zones [l, r], θ = atan(β f)/π,

    A = 1/π ∫_beside D/(η - x) dη + 1/π PV∫_contact H1/(t - x) dt,   (1 - β²) p = A - β γ
    F = χ Ψ,   Ψ = 1/π ∫μ/(z - t) dt,   μ = p/χ in stick,  -cos πθ H1/χ in slip
    p = cos πθ χ PVΨ - κ H1/(1 + κ²) in slip,   q = (χ PVΨ - H1)/β in stick.

γ is given in stick. p is bounded at all ends if the moments ∫μ t^k dt vanish for k below the number
n of slip zones; that with k = n is P. D is found from its values on the nodes beside the contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .pieces import Pair, Pieces, Places, across

if TYPE_CHECKING:
    from sie.profiles.slope import Slope

Array = NDArray[np.float64]
Gradient = Callable[[Array], Array]


class HalfSlope(NamedTuple):
    """E*/2 h' of a profile, and the window that a contact may reach."""

    slope: Slope
    half_modulus: float
    window: tuple[float, float]

    def __call__(self, x: Array) -> Array:
        values: Array = self.half_modulus * self.slope(x)
        return values

    @property
    def kinks(self) -> tuple[float, ...]:
        """Places in the window where h' is not smooth."""
        lo, hi = self.window
        return tuple(x for x in self.slope.break_points if lo < x < hi)


class Question(NamedTuple):
    """What a state is asked for, but for the zones.

    beta, friction  β > 0 and f
    slope           H1
    gamma           γ where the bodies stick
    P, Q            the loads
    approximate     whether β q is left out of (1): Goodman's approximation
    """

    beta: float
    friction: float
    slope: HalfSlope
    gamma: Gradient
    P: float
    Q: float
    approximate: bool = False

    @property
    def theta(self) -> float:
        return 0.0 if self.approximate else math.atan(self.beta * self.friction) / math.pi


@dataclass(frozen=True, eq=False)
class State:
    """p, q and γ for zones that need not be right: `missed` says what they miss."""

    pieces: Pieces
    question: Question

    # -- the integral equation ---------------------------------------------------------------------

    @cached_property
    def nodes(self) -> Places:
        return self.pieces.rule(0.0)

    @cached_property
    def halfway(self) -> Places:
        return self.pieces.rule(0.5)

    @cached_property
    def beside(self) -> Places:
        return self.pieces.outside()

    @property
    def middle(self) -> float:
        return 0.5 * float(self.pieces.ends[0] + self.pieces.ends[-1])

    @property
    def half_width(self) -> float:
        return 0.5 * self.pieces.length

    def chi(self, at: Places) -> Array:
        """χ in stick, and in slip its real factor; in units of half_width^n."""
        size = np.exp(self.pieces.log_chi(at) - self.pieces.slip_zones * math.log(self.half_width))
        values: Array = np.where(self.sticks(at), 1.0, -1.0) * self.pieces.turns[at.zone] * size
        return values

    def sticks(self, at: Places) -> NDArray[np.bool_]:
        return self.pieces.sign[at.zone] == 0.0

    @cached_property
    def _solved(self) -> Solved:
        beta, n, t, eta = self.question.beta, self.pieces.slip_zones, self.nodes, self.beside
        sticks, chi, halfway = self.sticks(t), self.chi(t), self.halfway
        across = self.cauchy(halfway, t)
        size = np.exp(self.pieces.log_chi(eta) - n * math.log(self.half_width))
        chi_beside = np.where(eta.anchor == 0, (-1.0) ** n, 1.0) * size
        kernel, weight = self.cauchy(eta, t), t.weight / chi
        factor = weight * self._arm(t) ** n
        L = kernel * (chi_beside * self._arm(eta) ** -n)[:, None]
        L *= factor
        M = kernel.T[sticks] * eta.weight
        slip = -math.cos(math.pi * self.question.theta) * self.question.slope(t.x[~sticks])
        d0 = L[:, ~sticks] @ slip
        of_slope = (self.question.slope(halfway.x) * halfway.weight) @ across
        source = of_slope[sticks] - beta * self.question.gamma(t.x[sticks])
        source /= 1.0 - beta**2
        L, M = L[:, sticks], M / (1.0 - beta**2)
        D = np.asarray(np.linalg.solve(np.eye(len(d0)) - L @ M, L @ source + d0), dtype=float)
        p = M @ D + source
        mass = np.empty(len(t.x))
        mass[sticks], mass[~sticks] = p, slip
        mass *= weight
        return Solved(mass, D, across @ mass)

    def _arm(self, at: Places) -> Array:
        """(x - middle) over half the width."""
        to_left, to_right = self._to_edges(at)
        arm: Array = 0.5 * (to_left - to_right) / self.half_width
        return arm

    def _to_edges(self, at: Places) -> tuple[Array, Array]:
        last = len(self.pieces.cuts) - 1
        return self.pieces.from_cut(at, 0), -self.pieces.from_cut(at, last)

    # -- fields ------------------------------------------------------------------------------------

    def psi(self, at: Places, sources: Places | None = None, mass: Array | None = None) -> Array:
        """PVΨ at places half a step from the sources, the nodes unless given."""
        kernel = self.cauchy(at, self.nodes if sources is None else sources)
        values: Array = kernel @ (self._solved.mass if mass is None else mass)
        return values

    def cauchy(self, at: Places, sources: Places) -> Array:
        """1/(π (x - t)) of all pairs."""
        kernel = self.pieces.apart(at, sources)
        return np.divide(1.0 / math.pi, kernel, out=kernel)

    def rows(self, rules: Pair, kernel: Array) -> list[Array]:
        """p, q in slip, and γ in stick on rules half a step apart, 0 for the others.

        `kernel` is that of `cauchy` from the second rule to the first.
        """
        loads = [self.question.slope(at.x) * at.weight for at in rules]
        known = [self._in_stick(*pair) for pair in zip(rules, across(kernel, loads), strict=True)]
        sources = [p * at.weight / self.chi(at) for at, (p, _) in zip(rules, known, strict=True)]
        found, flows = [], across(kernel, sources)
        for at, (stuck, gamma), flow in zip(rules, known, flows, strict=True):
            p = np.where(self.sticks(at), stuck, self._in_slip(at, flow))
            limit = self.pieces.sign[at.zone] * self.question.friction
            found.append(np.stack((p, limit * p, gamma)))
        return found

    def _in_stick(self, at: Places, flow: Array) -> tuple[Array, Array]:
        """μ χ, which is p in stick, and γ there, from PV∫H1/(x - t) dt/π."""
        question, sticks, D = self.question, self.sticks(at), self.beside.weight * self._solved.D
        mass, gamma = (
            -math.cos(math.pi * question.theta) * question.slope(at.x),
            np.zeros(len(at.x)),
        )
        stuck = at.chosen(sticks)
        gamma[sticks] = question.gamma(stuck.x)
        A = -flow[sticks] - self.cauchy(stuck, self.beside) @ D
        mass[sticks] = (A - question.beta * gamma[sticks]) / (1.0 - question.beta**2)
        return mass, gamma

    def root(self, at: Places) -> Array:
        """ω in slip; in stick, where ω is imaginary, i ω above the contact."""
        pieces = self.pieces
        log, zones = np.zeros(len(at.x)), np.flatnonzero(pieces.sign == 0.0)
        for zone in zones:
            for cut in pieces.cut_of_ends[[zone, zone + 1]]:
                log += 0.5 * np.log(np.abs(pieces.from_cut(at, int(cut))))
        # ω changes its sign across each stick zone to the right
        ahead = np.array([np.count_nonzero(zones > k) for k in range(len(pieces.sign))])
        turns = (-1.0) ** (ahead + (pieces.sign == 0.0))
        values: Array = turns[at.zone] * np.exp(log)
        return values

    @cached_property
    def shear_halfway(self) -> Array:
        """q on the nodes halfway."""
        at, question, flow = self.halfway, self.question, self._solved.flow
        limit = self.pieces.sign[at.zone] * question.friction
        stick = (self.chi(at) * flow - question.slope(at.x)) / question.beta
        values: Array = np.where(self.sticks(at), stick, limit * self._in_slip(at, flow))
        return values

    def _in_slip(self, at: Places, flow: Array) -> Array:
        """p in slip by Ψ."""
        question, H1 = self.question, self.question.slope(at.x)
        kappa = self.pieces.sign[at.zone] * question.beta * question.friction
        cos = math.cos(math.pi * question.theta)
        values: Array = cos * self.chi(at) * flow - kappa * H1 / (1.0 + kappa**2)
        return values

    @cached_property
    def missed(self) -> Array:
        """What moments, P and Q miss, as parts of P and of f P; 0 for the right zones."""
        question, n = self.question, self.pieces.slip_zones
        arm, mass = self._arm(self.nodes), self._solved.mass
        moments = np.array([mass @ arm**k for k in range(n + 1)]) / question.P
        moments[n] -= 1.0
        Q = float(self.halfway.weight @ self.shear_halfway)
        return np.append(moments, (Q - question.Q) / (question.friction * question.P))

    # -- rates -------------------------------------------------------------------------------------

    def rates(self, dQ: float, strain: float) -> tuple[Places, Array]:
        """Places that slip, and the rate of γ there, while Q grows by dQ and γ in stick by strain.

        All ends e move, so that exponents are smaller by 1: F = χ (Ψ + polynomial)/Π(z - e), the
        polynomial of the degree n - 2 as P is constant.
        """
        question, pieces, eta = self.question, self.pieces, self.pieces.outside(1.0)
        at, beta, chi_beside = pieces.rule(0.5, 1.0), question.beta, self._chi_of_rates(eta, True)
        psi, D = self._rates_solved(at, eta, chi_beside)
        flow, sticks = self._chi_of_rates(at)[:, None] * psi, self.sticks(at)
        sign = pieces.sign[at.zone][:, None]
        slipping = math.cos(math.pi * question.theta) * flow
        q = np.where(sticks[:, None], flow / beta, sign * question.friction * slipping)
        resultants = at.weight @ q
        mixed = np.array([(dQ - resultants[1] * strain) / resultants[0], strain])
        places = at.chosen(~sticks)
        A = -self.cauchy(places, eta) @ (eta.weight * chi_beside * (D @ mixed))
        gamma = (A - (1.0 - beta**2) * (slipping[~sticks] @ mixed)) / beta
        return places, gamma

    def _rates_solved(self, at: Places, eta: Places, chi_beside: Array) -> tuple[Array, Array]:
        """F/χ at places in contact, and D/χ beside it, of the polynomial 1 and of γ = 1 in stick.

        χ is infinite at the edges.
        """
        pieces, beta = self.pieces, self.question.beta
        t = pieces.rule(0.0, 1.0)
        t = t.chosen(self.sticks(t))
        kernel, weight = self.cauchy(eta, t), t.weight / self._chi_of_rates(t)
        L = kernel * weight
        M = kernel.T * (eta.weight * chi_beside) / (1.0 - beta**2)
        source = np.full(len(t.x), -beta / (1.0 - beta**2))
        right = np.stack((np.ones(len(eta.x)), L @ source), axis=1)
        D = np.asarray(np.linalg.solve(np.eye(len(eta.x)) - L @ M, right), dtype=float)
        p = M @ D
        p[:, 1] += source
        psi = self.psi(at, t, p * weight[:, None])
        psi[:, 0] += 1.0
        return psi, D

    def pressure_in_slip(self, at: Places) -> Array:
        """p at places in slip half a step from the nodes."""
        return self._in_slip(at, self.psi(at))

    def _chi_of_rates(self, at: Places, beside: bool = False) -> Array:
        n = self.pieces.slip_zones
        size = np.exp(self.pieces.log_chi(at, 1.0) + n * math.log(self.half_width))
        turns = np.where(at.anchor == 0, (-1.0) ** n, 1.0) if beside else self.pieces.turns[at.zone]
        values: Array = turns * size
        return values


class Solved(NamedTuple):
    """What the integral equation gives.

    mass    μ times weights on the nodes
    D       D beside the contact
    flow    PVΨ on the nodes halfway
    """

    mass: Array
    D: Array
    flow: Array
