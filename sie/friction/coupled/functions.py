"""Pressure, shear and slip of the flat punch in coupled partial slip, for 0 <= t = x/b.

Two functions give all of them (notation of `flat`; S is derived in
docs/derivations/coupled_slip.md):

    stick, t < c        p = A                  q = f A - χ S/β
    slip, c < t < 1     p = A - cos(πθ) χ S    q = f p         γ = Hq + β p = (1 - β²) cos(πθ) χ S/β
    near the edge       p = cos(πθ) χ Ψ                        γ = β (1 + f²) p - J

A is analytic across c and S too. With 1/χ for the inverse weight, κ = β f = cot πh,

    A(t)  = 1/((1-β²) π²) ∫ W Φ/(1 - t² s) ds,      Ψ(t) = 1/(π t) ∫ W p/(1 - c² r/t²) dr
    J(t)  = 1/π ∫_0^c r [1/(t-ξ) - 1/(t+ξ)] dξ + 2f/π ∫_0^1 p/(t+ξ) dξ,      r = f p - q = χ S/β
    S(t)  = 2 cos πh/π ∫_c^1 (A/χ)/(t+ξ) dξ + 2κ/(π(1-β²)) ∫_1^∞ Ψ/(η+t) dη
            + β/(π(1-β²)) ∫_1^∞ (J/χ) [1/(η-t) - 1/(η+t)] dη

The last is an equation of the second kind for S, all of whose terms are of the order β f: nothing
cancels as β tends to 0. (S is also N - A n, a difference; it serves where p needs S.) The slip of
the flat is g(t) = ∫_c^t γ. Tables on panels that shrink towards t = 0 and t = 1 make them cheap.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.elliptic import elliptic_functions

from .flat import FlatPunch, flat_punch, long_rule, sum_of_poles
from .panels import graded, totals
from .tables import Points, Table, joined

Array = NDArray[np.float64]
Function = Callable[[Array, Array], Array]

# β f up to which certificates hold: q = f p, and f p - q is known to so many roundings of f p
STEEPEST = 500.0
ZERO, ONE = (0.0, 1.0), (1.0, 0.0)  # as (t, 1 - t)


class FlatFunctions:
    """p, q, γ and g of the flat punch on 0 <= t <= 1, from t, e = 1 - t and |t - c|."""

    def __init__(self, punch: FlatPunch) -> None:
        self.punch = punch
        self.beta, self.friction, self.theta = punch.beta, punch.friction, punch.theta
        self.c, self.rest, self.h = punch.modulus.k, punch.modulus.rest, punch.exponent
        # sin πh = cos πθ and cos πh = sin πθ, κ = cot πh
        kappa = self.beta * self.friction
        self.sine, self.cosine = 1.0 / math.hypot(1.0, kappa), kappa / math.hypot(1.0, kappa)
        root = math.sqrt(self.c)  # as far from c as from 1 in the elliptic coordinate
        self.middle, self.beyond = root, self.rest / (1.0 + root)
        self.from_c_to_middle = float(self.beyond_c(self.middle, self.beyond))
        self._scale = self.c ** (2.0 * self.theta) / math.pi
        self._masses = self._scale * punch.weight * punch.pressure
        self._a = punch.eigenvalue / ((1.0 - self.beta**2) * math.pi) * self._masses

    def weight(self, t: Array, e: Array, from_c: Array) -> Array:
        """χ, infinite at the edge."""
        with np.errstate(divide="ignore"):
            chi: Array = (from_c * (t + self.c) / (e * (1.0 + t))) ** self.h
        return chi

    def pressure(self, t: Array, e: Array, from_c: Array) -> Array:
        """p."""
        edge = self._outer(t, e)
        p = np.empty(t.shape)
        p[edge] = (
            self.sine * self.weight(t[edge], e[edge], from_c[edge]) * self.Psi(t[edge], e[edge])
        )
        p[~edge] = self.A(t[~edge], e[~edge])
        slip = ~edge & (self.beyond_c(t, e) > 0.0)
        chi = self.weight(t[slip], e[slip], from_c[slip])
        p[slip] -= self.sine * chi * self.S_beside_c(t[slip], e[slip])
        return p

    def shear_deficit(self, t: Array, e: Array, from_c: Array) -> Array:
        """f p - q."""
        deficit, stick = np.zeros(t.shape), self.beyond_c(t, e) < 0.0
        chi = self.weight(t[stick], e[stick], from_c[stick])
        deficit[stick] = chi * self.S(t[stick], e[stick]) / self.beta
        return deficit

    def slip(self, t: Array, e: Array, from_c: Array) -> Array:
        """g."""
        regular, singular = self.slip_near_edge
        g, edge = np.zeros(t.shape), self._outer(t, e)
        g[edge] = regular(t[edge], e[edge]) + singular(t[edge], e[edge]) * e[edge] ** (1.0 - self.h)
        near_c = ~edge & (self.beyond_c(t, e) > 0.0)
        g[near_c] = self.slip_near_c(t[near_c], e[near_c]) * from_c[near_c] ** (1.0 + self.h)
        return g

    # -- tables ------------------------------------------------------------------------------------

    @cached_property
    def A(self) -> Table:
        return Table(ZERO, self._middle, (1.0, self.beyond), self._A)

    @cached_property
    def S(self) -> Table:
        return Table(ZERO, self._middle, (self.c, self.beyond), self._S)

    @cached_property
    def S_beside_c(self) -> Table:
        """S on c <= t <= c^(1/2) to rounding of A, which suffices for p."""
        return self._near_c(self._difference)

    @cached_property
    def Psi(self) -> Table:
        return self._near_edge(self._Psi)

    @cached_property
    def slip_near_c(self) -> Table:
        """g/(t - c)^(1+h), from γ = (t - c)^h times a function that is smooth across c."""
        h, factor = self.h, (1.0 - self.beta**2) * self.sine / self.beta

        def mean(t: Array, e: Array) -> Array:
            gap = self.beyond_c(t, e)
            owner, ahead, left, w = graded(gap, np.full(len(t), 2.0 * self.c), e, (h, 0.0))
            t, e = self.c + ahead, e[owner][:, None] + left
            S = self.S(t.ravel(), e.ravel()).reshape(t.shape)
            gamma = factor * (ahead * (t + self.c) / (e * (1.0 + t))) ** h * S
            return totals(owner, gamma * w, len(gap)) / gap ** (1.0 + h)

        return self._near_c(mean)

    @cached_property
    def slip_near_edge(self) -> tuple[Table, Table]:
        """g = regular + singular (1 - t)^(1-h) beyond c^(1/2), from γ = β (1 + f²) p - J."""
        at = np.array([self.middle]), np.array([self.beyond])
        gap, power = self.beyond_c(*at), 1.0 - self.h
        strength = self.beta * (1.0 + self.friction**2) * self.sine
        J = self._near_edge(lambda t, e: self._J(t, e, self._S_in_stick))

        def beyond(t: Array, e: Array, power: float) -> tuple[Any, ...]:
            """A rule from t to 1 for functions that are singular at c."""
            never = np.full(len(e), math.inf)
            owner, ahead, left, w = graded(e, self.beyond_c(t, e), never, (0.0, power))
            return owner, t[owner][:, None] + ahead, left, w

        def singular(t: Array, e: Array) -> Array:
            owner, u, left, w = beyond(t, e, -self.h)
            chi = self.weight(u, left, self.beyond_c(u, left))
            Psi = self.Psi(u.ravel(), left.ravel()).reshape(u.shape)
            return -strength * totals(owner, chi * Psi * w, len(e)) / e**power

        def regular(t: Array, e: Array) -> Array:
            owner, u, left, w = beyond(t, e, 0.0)
            return totals(owner, J(u.ravel(), left.ravel()).reshape(u.shape) * w, len(e))

        there = self.slip_near_c(*at) * gap ** (1.0 + self.h)
        start = (there - singular(*at) * at[1] ** (1.0 - self.h) - regular(*at))[0]
        return self._near_edge(lambda t, e: start + regular(t, e)), self._near_edge(singular)

    @cached_property
    def _outside_table(self) -> Table:
        return Table(ZERO, ONE, (1.0 / self.c, self.rest / self.c), self._potential_outside)

    @property
    def _middle(self) -> tuple[float, float]:
        """c^(1/2), as (t, 1 - t)."""
        return self.middle, self.beyond

    def _near_c(self, function: Function) -> Table:
        """A table on c <= t <= c^(1/2) of a function that is singular at -c and 1."""
        return Table((self.c, self.rest), self._middle, (2.0 * self.c, self.beyond), function)

    def _near_edge(self, function: Function) -> Table:
        """A table on c^(1/2) <= t <= 1 of a function that is singular at c and smooth at 1."""
        from_c = self.from_c_to_middle
        return Table(self._middle, ONE, (from_c, math.inf), function)

    def _outer(self, t: Array, e: Array) -> Any:
        """Where t > c^(1/2)."""
        return e < self.beyond if self.c > 0.5 else t > self.middle

    def beyond_c(self, t: Any, e: Any) -> Any:
        """t - c, from that of t and 1 - t which tells it better."""
        return self.rest - e if self.c > 0.5 else t - self.c

    # -- A and Ψ, from the eigenvector -------------------------------------------------------------

    def _A(self, t: Array, e: Array) -> Array:
        return sum_of_poles(e * (1.0 + t), t * t, self.punch.remainder, self._a)

    def _Psi(self, t: Array, e: Array) -> Array:
        square = self.beyond_c(t, e) * (t + self.c)
        Psi: Array = t * sum_of_poles(square, self.c**2, self.punch.remainder, self._masses)
        return Psi

    def outside(self, s: Array, e: Array) -> Array:
        """η D(η) at η = 1/s > 1, e = 1 - s; D = χ Ψ there, χ = ((1 - c² s²)/(1 - s²))^h."""
        D: Array = (self.below_one(s, e) / (e * (1.0 + s))) ** self.h * self._outside_table(s, e)
        return D

    def _potential_outside(self, s: Array, e: Array) -> Array:
        """η Ψ at η = 1/s."""
        gap, remainder = self.below_one(s, e), self.punch.remainder
        return sum_of_poles(gap, (self.c * s) ** 2, remainder, self._masses)

    def below_one(self, s: Array, e: Array) -> Array:
        """1 - c² s²."""
        gap: Array = e * (1.0 + s) + (s * self.punch.modulus.complement) ** 2
        return gap

    # -- S -----------------------------------------------------------------------------------------

    def _S(self, t: Array, e: Array) -> Array:
        s, (acting, back) = self._reach[0], self._acting
        kernel = _between(t, e, s.t, s.rest)
        S: Array = self._of_pressure(t) + kernel @ (acting + back @ self._S_in_stick)
        return S

    @cached_property
    def _S_in_stick(self) -> Array:
        s, stick, (acting, back) = self._reach[0], self._stick, self._acting
        kernel = _between(stick.t, stick.rest, s.t, s.rest)
        known = self._of_pressure(stick.t) + kernel @ acting
        return np.asarray(np.linalg.solve(np.eye(len(known)) - kernel @ back, known), dtype=float)

    def _of_pressure(self, t: Array) -> Array:
        """The parts of S due to A/χ in the left slip zone, and to Ψ outside."""
        beside = (1.0 / (t[:, None] + self._left_slip.t)) @ self._left_slip.weight
        s, far = self._far
        sliding = (1.0 / (1.0 + t[:, None] * s)) @ far
        factor = self.beta * self.friction / (1.0 - self.beta**2)
        both: Array = 2.0 / math.pi * (self.cosine * beside + factor * sliding)
        return both

    @cached_property
    def _far(self) -> tuple[Array, Array]:
        """Places outside, and Ψ there with its weights."""
        s = self._outside(1.0)
        return s.t, s.weight * self._potential_outside(s.t, s.rest)

    @cached_property
    def _acting(self) -> tuple[Array, Array]:
        """β J/χ outside with its weights: what friction causes, and the matrix for S in stick."""
        (s, reach), stick = self._reach, self._stick
        J = self._due_to(self._pressure, 1.0 / (1.0 + s.t[:, None] * self._pressure.t))
        r = stick.weight * self.weight(*stick[:3]) / math.pi
        back = reach[:, None] * (_between(s.t, s.rest, stick.t, stick.rest) * r)
        return self.beta * reach * 2.0 * self.friction * J, back

    @cached_property
    def _reach(self) -> tuple[Points, Array]:
        """Places outside and (1/π(1-β²)) (1/χ) cn dn du there."""
        s = self._outside(2.0 - 2.0 * self.theta)
        inverse = (s.rest * (1.0 + s.t) / self.below_one(s.t, s.rest)) ** self.h
        return s, s.weight * inverse / (math.pi * (1.0 - self.beta**2))

    @staticmethod
    def _due_to(masses: Points, kernel: Array) -> Array:
        integral: Array = kernel @ masses.weight / math.pi
        return integral

    @cached_property
    def _difference(self) -> Function:
        """S as N - A n, whose error is rounding of numbers of order one: where p needs S."""
        punch, theta = self.punch, self.theta
        aG = self._a * punch.square * self._scale * punch.kernel_of_one
        slip = self._slip_points(2.0 - 2.0 * theta, 2.0 * theta)
        inverse = slip.weight / self.weight(*slip[:3])
        s = self._outside(2.0 - 2.0 * theta)
        outside = s.weight * (s.rest * (1.0 + s.t) / self.below_one(s.t, s.rest)) ** self.h

        def difference(t: Array, e: Array) -> Array:
            n = 2.0 / math.pi * t * (_inverse(t, e, s.t, s.rest) @ outside)
            n -= 2.0 / math.pi * self.cosine * ((1.0 / (t[:, None] + slip.t)) @ inverse)
            n -= self.beta * self.friction
            N: Array = t * sum_of_poles(e * (1.0 + t), t * t, punch.remainder, aG)
            return N - self._A(t, e) * n

        return difference

    # -- places of quadrature ----------------------------------------------------------------------

    def _stick_points(self, a: float) -> Points:
        """0 < t < c, for (c - t)^((a - 1)/2) times a smooth function."""
        x, rest, w = long_rule(2.0 * self._tau, a, 0.0)
        sn, cn, dn = elliptic_functions(self.punch.modulus, x, rest)
        from_c = self.c * cn * cn / (1.0 + sn)
        return Points(
            self.c * sn, self.rest + from_c, from_c, w * (self.punch.modulus.K * self.c * cn * dn)
        )

    def _outside(self, a: float) -> Points:
        """1/η for η > 1, for (η - 1)^((a - 1)/2) times a smooth function; weights of cn dn du."""
        x, rest, w = long_rule(2.0 * self._tau, a, 0.0)
        sn, cn, dn = elliptic_functions(self.punch.modulus, x, rest)
        e = cn * cn / (1.0 + sn)
        return Points(sn, e, 1.0 - self.c * sn, w * (self.punch.modulus.K * cn * dn))

    def _slip_points(self, a: float, b: float, lo: float = 0.0, hi: float = 1.0) -> Points:
        """A part of c < t < 1, in the elliptic coordinate v, for (hi - v)^a (v - lo)^b."""
        x, rest, w = long_rule(2.0 / (self._tau * (hi - lo)), a, b)
        return self._of_slip_zone(lo + (hi - lo) * x, (1.0 - hi) + (hi - lo) * rest, (hi - lo) * w)

    def _of_slip_zone(self, part: Array, remaining: Array, w: Array) -> Points:
        """The places at these parts of the elliptic coordinate."""
        swapped = self.punch.modulus.swapped
        sn, cn, dn = elliptic_functions(swapped, part, remaining)
        t = self.c / dn
        from_c = t * (swapped.k * sn) ** 2 / (1.0 + dn)
        e = (swapped.k * cn / dn) ** 2 / (1.0 + t)
        dt = swapped.K * t * swapped.k**2 * sn * cn / dn
        return Points(t, e, from_c, w * dt)

    @property
    def _tau(self) -> float:
        return self.punch.modulus.K_complement / self.punch.modulus.K

    # -- p, r and A/χ there ------------------------------------------------------------------------

    @cached_property
    def _stick(self) -> Points:
        return self._stick_points(2.0 - 2.0 * self.theta)

    @cached_property
    def _pressure(self) -> Points:
        """p dt on 0 < t < 1."""
        theta = self.theta
        stick, slip = self._stick_points(1.0), self._slip_points(0.0, 1.0, hi=0.5)
        deviating = self._slip_points(0.0, 2.0 - 2.0 * theta, hi=0.5)
        edge = self._slip_points(2.0 * theta, 0.0, lo=0.5)
        S = self._difference(deviating.t, deviating.rest)
        return joined(
            stick.times(self._A(stick.t, stick.rest)),
            slip.times(self._A(slip.t, slip.rest)),
            deviating.times(-self.sine * self.weight(*deviating[:3]) * S),
            edge.times(self.sine * self.weight(*edge[:3]) * self._Psi(edge.t, edge.rest)),
        )

    @cached_property
    def _left_slip(self) -> Points:
        """A/χ dt on c < t < 1; next to the edge A = p + β γ/(1 - β²)."""
        beta, f, theta = self.beta, self.friction, self.theta
        near_c = self._slip_points(0.0, 2.0 * theta, hi=0.5)
        edge = self._slip_points(1.0, 0.0, lo=0.5)
        acting = self._slip_points(2.0 - 2.0 * theta, 0.0, lo=0.5)
        coupled = beta / (1.0 - beta * beta)
        S = self._difference(self._stick.t, self._stick.rest)
        J = self._J(acting.t, acting.rest, S)
        return joined(
            near_c.times(self._A(near_c.t, near_c.rest) / self.weight(*near_c[:3])),
            edge.times(
                (1.0 + coupled * beta * (1.0 + f * f)) * self.sine * self._Psi(edge.t, edge.rest)
            ),
            acting.times(-coupled * J / self.weight(*acting[:3])),
        )

    def _J(self, t: Array, e: Array, S: Array) -> Array:
        """J at t nearer to 1 than to c, given S at the places in stick."""
        stick = self._stick
        r = stick.weight * self.weight(*stick[:3]) * S / self.beta
        apart = stick.rest - e[:, None] if self.c > 0.5 else t[:, None] - stick.t
        kernel = 1.0 / apart - 1.0 / (t[:, None] + stick.t)
        p = self._pressure
        J: Array = (kernel @ r) / math.pi
        J += 2.0 * self.friction * self._due_to(p, 1.0 / (t[:, None] + p.t))
        return J


def _inverse(t: Array, e: Array, s: Array, rest: Array) -> Array:
    """1/(1 - t² s²), given 1 - t and 1 - s."""
    values = e[:, None] * (1.0 - rest)
    values += rest
    values *= 1.0 + t[:, None] * s
    return np.divide(1.0, values, out=values)


def _between(t: Array, e: Array, s: Array, rest: Array) -> Array:
    """1/(1 - t s) - 1/(1 + t s)."""
    values = _inverse(t, e, s, rest)
    values *= 2.0 * s
    values *= t[:, None]
    return values


@lru_cache(maxsize=8)
def flat_functions(beta: float, friction: float) -> FlatFunctions:
    """Those of `flat_punch`, with their tables as far as these were asked for.

    Raises ContactError where friction is too large for an answer of enough digits.
    """
    punch = flat_punch(beta, friction)
    if beta * friction > STEEPEST and not punch.bonded:
        raise ContactError(
            f"friction = {friction:.6g} is too large for an answer that is certified: the shear in "
            "slip is so many times the pressure, and the rest has few digits; give friction = "
            f"{STEEPEST / beta:.6g} or less, as zones hardly change above"
        )
    return FlatFunctions(punch)
