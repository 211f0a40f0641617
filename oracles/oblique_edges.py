"""Edges of contact and stick of a parabola under P, then Q, dissimilar bodies, R = E*/2 = 1.

Spence's flat punch (docs/derivations/coupled_slip.md) gives the slip gradient γ frozen under P.
The tractions under Q are those of full sliding, in closed form, and those added by sticking. Four
conditions give the edges x1 < e1 < e2 < x2: the added P is 0, p is bounded at both edges of the
contact, and Q is the given one.

The solver that this checks has the same four conditions, but no code or rule in common: here all
integrals, those of the flat punch too, are by double exponential rules that carry the distances
from the ends. Where `numpy.longdouble` has 18 digits, the edges have 16.
"""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebinterpolate, chebval
from numpy.typing import NDArray

Array = NDArray[Any]

REACH = 4.3  # of the rule: what it cuts of an end to the power -0.6 weighs less than 1e-19
TURNS = 60  # of the power iteration: more change no digit
DEGREE = 60  # of the polynomial for γ, for Q/(fP) >= 0.1; below, e1 is next to the old edge
DIFFERENCE = 1e-7  # in Newton's method
STEPS = 6  # of Newton's method, from edges in three digits

# x1, e1, e2, x2 under P = π/2, by (β, f, Q/(fP)): `edges` below with `numpy.longdouble` of 64 bits
# and the step 1/32; they change by less than 2e-16 from the step 1/24, and with twice the degree
# and turns. Another formulation, with moments of p as conditions, gives the first ten digits.
EDGES = {
    (0.3, 0.3, 0.9): (
        -1.0519254056134288,
        -0.6097293963298907,
        -0.2441632365178578,
        0.9472096729159371,
    ),
    (0.3, 0.3, 0.3): (
        -1.0057559986710576,
        -0.8926580287563062,
        0.1589120980756115,
        0.9647789598508927,
    ),
    (0.2, 0.3, 0.5): (
        -1.0153232201513209,
        -0.8398890081976050,
        0.2012260535338427,
        0.9728585172991975,
    ),
    (0.5, 0.5, 0.5): (
        -1.0721727282654909,
        -0.8194328665989966,
        -0.0293916481011252,
        0.8925278177629384,
    ),
}


class Rule(NamedTuple):
    """Nodes t on (0, 1), their distances from 1, and weights."""

    t: Array
    rest: Array
    weight: Array


def double_exponential(real: Any, step: float) -> Rule:
    n, pi = round(REACH / step), 4 * np.arctan(real(1))
    u = np.arange(-n, n + 1).astype(real) * real(step)
    t, rest = 1 / (1 + np.exp(-pi * np.sinh(u))), 1 / (1 + np.exp(pi * np.sinh(u)))
    return Rule(t, rest, pi * real(step) * np.cosh(u) * t * rest)


class Spence:
    """The parabola under P: its half-width b, c/b, and γ, from the flat punch with b = P = 1."""

    def __init__(self, pair: Any, load: Any, real: Any, step: float) -> None:
        self.rule, self.pi = double_exponential(real, step), 4 * np.arctan(real(1))
        self.beta, self.f, self.load = (real(number) for number in (*pair, load))
        self.theta = np.arctan(self.beta * self.f) / self.pi
        self.square = 1 - self.beta**2
        before, logit = real(0.0), real(0.5)  # of c/b, by secants
        lacked = self.eigenvalue_lacks(before)
        while abs(logit - before) > np.finfo(real).eps ** 0.6:
            lacks = self.eigenvalue_lacks(logit)
            change = lacks * (logit - before) / (lacks - lacked)
            before, logit, lacked = logit, logit - change, lacks
        self.eigenvalue_lacks(logit)
        self.grow()

    def eigenvalue_lacks(self, logit: Any) -> Any:
        """c^θ λ/π - sqrt(1 - β²); keeps c, the kernel and p/χ of the stick zone, r = (x/c)²."""
        self.c = c = 1 / (1 + np.exp(-logit))
        r, rest, weight = self.rule
        bare = 1 - c * c * r
        self.weight = weight * (bare / rest) ** (0.5 - self.theta) / np.sqrt(r)
        self.kernel = 1 / (1 - c * c * r[:, None] * r)
        p = np.ones_like(r) / self.weight.sum()
        for _ in range(TURNS):
            p = self.kernel @ (self.weight * p)
            eigenvalue = self.weight @ p
            p = p / eigenvalue
        self.mass = self.weight * p
        return c**self.theta * eigenvalue / self.pi - np.sqrt(self.square)

    def grow(self) -> None:
        """The parabola as a sum of flats: b, P'(s)/s, and K, where γ = K |x| in |x| < c."""
        root, around = np.sqrt(self.rule.t), self.kernel @ self.mass
        self.source = self.weight * around / (self.square * self.pi**2)
        moment = self.weight @ (root * around) / (2 * self.pi)
        self.b, self.growth = np.sqrt(2 * moment * self.load), 1 / moment
        past, rest = (1 - self.c) * self.rule.t, (1 - self.c) * self.rule.rest
        stick = (self.source * root) @ np.arctanh(self.c * root) - self.source.sum() / self.c
        slip = (1 - self.c) * self.rule.weight @ (self.in_slip(past, rest) / (self.c + past) ** 2)
        self.k = -self.square * self.growth / self.beta * (stick + slip)

    def in_slip(self, past: Array, rest: Array) -> Array:
        """The flat punch's p at x = c + past = 1 - rest."""
        x, square = self.c + past, past * (2 * self.c + past)
        chi = (square / (rest * (1 + x))) ** (0.5 - self.theta)
        masses = (self.mass / (square[:, None] + self.c**2 * self.rule.rest)).sum(axis=1)
        return np.cos(self.pi * self.theta) * chi * x / self.pi * masses

    def slipped(self, past: Any) -> Any:
        """The flat punch's ∫ γ/x² dx from c to c + past, over past^(3/2 - θ)."""
        x = self.c + past * self.rule.t
        smooth = (self.source / (1 - x[:, None] ** 2 * self.rule.t)).sum(axis=1)
        gamma = self.square / self.beta * (smooth - self.in_slip(past * self.rule.t, 1 - x))
        return self.rule.weight @ (gamma / x**2) * past ** (self.theta - 0.5)

    def table(self, widest: Any) -> Array:
        """`slipped` up to the widest zone, as a polynomial in Chebyshev's form on (-1, 1)."""

        def values(places: Array) -> Array:
            return np.array([self.slipped(widest * (1 + y) / 2) for y in places])

        return chebinterpolate(values, DEGREE)


class Stick(NamedTuple):
    """x, the weights, the distances from e1 and e2, and γ, at the nodes of a stick zone."""

    x: Array
    weight: Array
    left: Array
    right: Array
    gamma: Array


def stick_zone(one: Spence, table: Array, widest: Any, e1: Any, e2: Any) -> Stick:
    """Panels end where γ has a break: at the old end of stick, -c, and on the axis."""
    old = -one.c * one.b
    cuts = [e1, *(x for x in (old, 0 * old) if e1 < x < e2), e2]
    panels = []
    for lo, hi in pairwise(cuts):
        far, near = (hi - lo) * one.rule.t, (hi - lo) * one.rule.rest
        x = lo + far if abs(lo) < abs(hi) else hi - near
        gamma = one.k * abs(x)
        if hi <= old:
            past = (near + (old - hi)) / one.b
            fitted = chebval(2 * past / widest - 1, table)
            gamma = gamma - one.growth * abs(x) * past ** (1.5 - one.theta) * fitted
        panels.append((x, (hi - lo) * one.rule.weight, far + (lo - e1), near + (e2 - hi), gamma))
    return Stick(*(np.concatenate(parts) for parts in zip(*panels, strict=True)))


def stuck(kernel: Array, sigma: Array, rho: Array, right: Array) -> Array:
    """The p of p - Tp = right: solved in double precision, refined in that of the arguments."""
    low, at_s, at_x = (one.astype(float) for one in (kernel, sigma, rho))
    inverse = np.linalg.inv(np.eye(len(rho)) - (low * at_s) @ (low.T * at_x))
    p = inverse @ right
    for _ in range(3):
        p = p + inverse @ (right - p + kernel @ (sigma * (kernel.T @ (rho * p))))
    return p


def conditions(one: Spence, zone: Stick, shear: Any, edges: Array) -> Array:
    """The added P, the singular parts of p at both edges, and fP + added Q - Q."""
    x1, e1, e2, x2 = edges
    r, m, a1, a2 = (x2 - x1) / 2, (x1 + x2) / 2, 0.5 + one.theta, 0.5 - one.theta
    lo, hi, at = (e1 - m) / r, (e2 - m) / r, (zone.x - m) / r
    left, right = (zone.left + (e1 - x1)) / r, (zone.right + (x2 - e2)) / r
    b = -2 * one.theta * r - m  # full sliding's p has the factor -r x² + b x + c
    c = one.load / (one.pi * r) + 2 * one.theta * b + (2 * one.theta**2 + 0.5) * r
    slid = np.cos(one.pi * one.theta) * ((b - r * at) * at + c) / (left**a1 * right**a2)
    gamma = zone.gamma - one.f * zone.x - one.beta * (1 + one.f**2) * slid
    rho = zone.weight / r * (r * right / zone.right) ** a2 * (r * left / zone.left) ** a1
    t, rest, ds = one.rule
    s = t - rest
    sigma = 2 * ds * ((1 - hi * s) / (2 * rest)) ** a2 * ((1 - lo * s) / (2 * t)) ** a1
    kernel = 1 / (1 - at[:, None] * s)
    p = rho * stuck(kernel, sigma / (one.pi**2 * one.square), rho, -one.beta / one.square * gamma)
    added = -r * sigma @ (kernel.T @ (p * at)) / (one.pi * one.beta)
    k1 = ((1 + hi) / 2) ** a2 * (1 + lo) ** a1 * (p / left).sum() / one.pi
    k2 = (1 - hi) ** a2 * ((1 - lo) / 2) ** a1 * (p / right).sum() / one.pi
    ends = k1 + (c - b - r) / 2**a2, k2 + (c + b - r) / 2**a1
    return np.array([p.sum(), *ends, one.f * one.load + added - shear])


def edges(pair: Any, loads: Any, near: Any, real: Any = float, step: float = 1 / 16) -> Array:
    """x1, e1, e2 and x2 by Newton's method from near ones: pair = β, f and loads = P, Q/(fP)."""
    load, part = loads
    one, found = Spence(pair, load, real, step), np.array(near, real)
    resticks = max(-found[1] / one.b - one.c, 0 * one.c)
    widest = resticks + (1 - one.c - resticks) / 8  # room for Newton's method, short of the edge
    table, shear = one.table(widest), real(part) * one.f * one.load

    def lacks(at: Array) -> Array:
        return conditions(one, stick_zone(one, table, widest, at[1], at[2]), shear, at)

    for _ in range(STEPS):
        now = lacks(found)
        slopes = [(lacks(found + move) - now) / DIFFERENCE for move in DIFFERENCE * np.eye(4)]
        found = found - np.linalg.solve(np.array(slopes, float).T, now.astype(float))
    return found
