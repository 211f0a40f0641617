"""The certificate of a shear traction, measured at points that no solver used.

residual      max |1/π PV∫q(t)/(x - t) dt - τ| / max|q|     where the contact never slipped
equilibrium   |∫q dx - Q| / ∫|q| dx
excess        largest |q| - f p, and of ||q| - f p| in slip zones, over the peak of f p
opposing      smallest slip in the direction of q over the largest

Where dissimilar bodies slip while the normal load grows (Goodman's approximation) the residual is
max |γ - γ'| / max|q|, γ = 1/π PV∫q/(x - t) dt + β p, where they stuck under a lighter load already;
γ' is γ under that load, 0 where the contact does not grow.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.load_history.marched_step import MarchedStep
from sie.friction.slip_state import GrownSlip, Slip
from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import EPS, Interval
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.traction.base import Density
from sie.traction.of_slope import SlopeDensity

from .quadrature import Rule, composite_rule
from .result import ShearCertificate

Array = NDArray[np.float64]

POINTS = 24  # in the stick zone
# Terms of a shear that are integrated one by one: a rule for all grows with their number, and so
# does the cost of a value.
MANY = 12
# The end of a zone is known to this part of the contact: there |q| falls from f p like a root.
ENDS = 32.0 * EPS


class Term(NamedTuple):
    """factor × density, a part of the shear, and the rule for its integrals."""

    factor: float
    density: Callable[[Array], Array]
    contact: Interval
    rule: Rule


def shear_certificate(
    state: Slip, pressure: SlopeDensity, loads: tuple[float, float], slope: Slope, tol: float
) -> ShearCertificate:
    """Measure a state; `loads` are Q and τ."""
    contact, bases = pressure.contact, state.shear.bases
    resolution = refined(slope, contact.x1, contact.x2, EPS)
    if len(bases) > MANY and all(isinstance(density, SlopeDensity) for _, density in bases):
        rule = composite_rule(contact, slope, resolution=resolution)
        terms = [
            Term(factor, d, d.contact, composite_rule(d.contact, slope, resolution=resolution))
            for factor, d in bases
            if isinstance(d, SlopeDensity)
        ]
    else:
        zones = (*state.stick, *(zone[:2] for zone in state.slipped))
        ends = {*state.levels, *(end for zone in zones for end in zone)}
        x1, x2 = pressure.interval
        inside = np.array([c for c in ends if x1 < c < x2])
        rule = composite_rule(contact, slope, inside, resolution=resolution)
        terms = [Term(1.0, state.shear, contact, rule)]
    # What cannot be measured is infinite, and not ok.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return _measured(state, pressure, loads, rule, terms, tol=tol)


def _measured(
    state: Slip,
    pressure: SlopeDensity,
    loads: tuple[float, float],
    rule: Rule,
    terms: list[Term],
    *,
    tol: float,
) -> ShearCertificate:
    x, weight = rule.x, rule.weight
    p, q = finite(state.friction * pressure(x)), finite(state.shear(x))
    size, peak = float(weight @ np.abs(q)), float(np.abs(q).max())
    if size == 0.0:
        size = peak = state.friction * pressure.resultant
    force, equation, of_force, of_equation = integrals(terms, points(state.untouched, terms))
    return ShearCertificate(
        residual=float(np.abs(equation - loads[1]).max(initial=0.0)) / peak,
        equilibrium=abs(force - loads[0]) / size,
        excess=excess(state, pressure.contact, x, p, q) / float(p.max()),
        opposing=opposing(state, state.slip_now(x), x),
        abscissae=max(of_force / size, float(of_equation.max(initial=0.0)) / peak),
        condition=state.condition,
        advancing=state.advancing,
        kind=state.kind,
        tol=tol,
    )


def integrals(terms: list[Term], at: Array) -> tuple[float, Array, float, Array]:
    """∫q dx, 1/π PV∫q/(x - t) at points, by subtracting q there; and rounding of both.

    Rounding is what one ulp of the nodes, which are counted from the edges, does. In a narrow stick
    zone next to a sharp edge, where q is infinite, the nodes there dominate.
    """
    force, of_force, equation, of_equation = 0.0, 0.0, np.zeros(len(at)), np.zeros(len(at))
    for factor, density, contact, (x, _, weight, *_) in terms:
        ulp = float(np.spacing(contact.r + abs(contact.m)))
        inwards, at_inwards = (place + np.where(place < contact.m, ulp, -ulp) for place in (x, at))
        q, values = finite(density(x)), density(at)
        moved = weight * np.abs(finite(density(inwards)) - q)
        distance = at[:, None] - x
        distance[distance == 0.0] = np.inf
        whole = values * np.log(contact.from_left(at) / contact.from_right(at))
        force += factor * float(weight @ q)
        equation += factor / np.pi * (((q - values[:, None]) / distance) @ weight + whole)
        of_force += abs(factor) * float(moved.sum())
        here = np.abs(finite(density(at_inwards)) - values)
        of_equation += abs(factor) * (here + (1.0 / np.abs(distance)) @ moved / np.pi)
    return force, equation, of_force, of_equation


def excess(state: Slip, contact: Interval, x: Array, p: Array, q: Array) -> float:
    """The largest |q| - f p in stick, or error of |q| = f p in slip."""
    # A node on a corner, where p is infinite, was set to 0.
    worst = float(np.where(p > 0.0, np.abs(q) - p, -np.inf).max())
    margin = ENDS * (contact.r + abs(contact.m))
    for lo, hi, sign in state.slipped:
        slipping = (x > lo + margin) & (x < hi - margin) & (p > 0.0)
        worst = max(worst, float(np.abs(sign * q - p)[slipping].max(initial=0.0)))
    return worst


def opposing(state: Slip, slip: Array, x: Array) -> float:
    """The smallest slip in its own direction since the last turning point, over the largest."""
    largest = float(np.abs(slip).max(initial=0.0))
    lowest = min(
        (
            float((sign * slip[(x > lo) & (x < hi)]).min(initial=0.0))
            for lo, hi, sign in state.slipped
        ),
        default=0.0,
    )
    return lowest / largest if largest else 0.0


def points(held: tuple[float, float], terms: list[Term]) -> Array:
    """The places of measurement over a zone that sticks."""
    nodes = np.unique(np.concatenate([term.rule.x for term in terms]))
    return places_between(held, nodes, len(terms), POINTS)


def places_between(held: tuple[float, float], nodes: Array, rules: int, number: int) -> Array:
    """Places in a zone, half-way between the ascending nodes of some rules.

    Of many rules these are the farthest apart in the neighbourhood.
    """
    (lo, hi), near = held, rules - 1
    at = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(np.pi * (np.arange(number) + 0.5) / number)
    k = np.clip(np.searchsorted(nodes, at)[:, None] + np.arange(-near, near + 1), 1, len(nodes) - 1)
    widest = np.argmax(nodes[k] - nodes[k - 1], axis=1)
    k = k[np.arange(number), widest]
    at = np.unique(0.5 * (nodes[k - 1] + nodes[k]))
    inside: Array = at[(at > lo) & (at < hi) & ~np.isin(at, nodes)]
    return inside


def finite(values: Array) -> Array:
    """The values, with 0 in place of infinities."""
    return np.where(np.isfinite(values), values, 0.0)


# -- after steps that were marched -----------------------------------------------------------------

MARCHED = 1e-8  # of the largest shear, and of a half-width: what is promised of them
FAINT = 1e-4  # of the largest f p, a shear: of a smaller one that is promised of so large a one


def marched_certificate(
    state: Slip, parts: tuple[MarchedStep, ...], error: float, slope: Slope, tol: float
) -> ShearCertificate:
    """The certificate from the changes of the shear in the parts of the last step.

    The residual is at least the error of the ends of the stick zone over its half-width.
    """
    terms = [_on_own_rule(part.shear, part.pressure.contact, part.marks, slope) for part in parts]
    residual = of_change = 0.0
    for part, term in zip(parts, terms, strict=True):
        begun = part.latest()
        old = begun.pressure.contact
        before = _on_own_rule(begun.shear, old, begun.marks, slope)
        pair = [term, before._replace(factor=-1.0)]
        at = np.concatenate([points(zone, pair) for zone in part.kept_in(old)])
        _, change, _, rounding = integrals(pair, at)
        missed = np.abs(change - (part.tau - begun.tau)).max(initial=0.0)
        residual, of_change = max(residual, float(missed)), max(of_change, float(rounding.max()))
    contact, (x, _, weight, *_) = parts[-1].pressure.contact, terms[-1].rule
    p, q = state.friction * parts[-1].pressure(x), parts[-1].shear(x)
    size = max(float(weight @ np.abs(q)), FAINT * float(weight @ p))
    peak = max(float(np.abs(q).max()), FAINT * float(p.max()))
    # An end is known to so much, and q falls from f p there like a root.
    known = np.abs(np.subtract.outer(parts[-1].marks, x)).min(axis=0) > MARCHED * contact.r
    force, _, of_force, _ = integrals(terms[-1:], np.zeros(0))
    return ShearCertificate(
        residual=max(residual / peak, error),
        equilibrium=abs(force - parts[-1].Q) / size,
        excess=excess(state, contact, x[known], p[known], q[known]) / float(p.max()),
        opposing=opposing(state, parts[-1].slip(x), x),
        abscissae=max(of_force / size, of_change / peak),
        condition=1.0,
        advancing=True,
        kind=f"{state.kind}; the ends of the stick zone within {error:.0e} of its half-width",
        tol=max(tol, MARCHED),
    )


def _on_own_rule(density: Density, contact: Interval, marks: Sequence[float], slope: Slope) -> Term:
    inside = np.array([x for x in marks if contact.x1 < x < contact.x2])
    return Term(1.0, density, contact, composite_rule(contact, slope, inside))


# -- while the normal load grows ------------------------------------------------------------------

OF_SHEAR = 1e-10  # of the largest shear: what is promised of (12)
NODES, RATIO = 12, 3.0  # panels towards a mark, in the root of the distance
# ... and so many: at an edge the shear goes with a logarithm as well where the slip zone is narrow
AT_EDGE, INSIDE = 17, 9
P_ROUNDING = 16.0 * EPS  # of p, which q is balanced with in (12)


def goodman_certificate(state: GrownSlip, tol: float) -> ShearCertificate:
    """Measured on a state and on those before."""
    pressure, (term,) = state.step.pressure, _terms(state)
    x, weight = term.rule.x, term.rule.weight
    p, q = finite(state.friction * pressure(x)), finite(term.density(x))
    size, peak = float(weight @ np.abs(q)), float(np.abs(q).max())
    contact = pressure.contact
    # Nearer to an edge p and q are roots of distances that doubles do not tell
    margin = ENDS * (contact.r + abs(contact.m))
    known = (contact.from_left(x) > margin) & (contact.from_right(x) > margin)
    force, _, of_force, _ = integrals([term], np.empty(0))
    missed, of_gamma = _kept(state, term)
    return ShearCertificate(
        residual=missed / peak,
        equilibrium=abs(force - state.step.Q) / size,
        excess=excess(state, contact, x[known], p[known], q[known]) / float(p.max()),
        opposing=opposing(state, state.slip_now(x), x) if state.zones is None else 0.0,
        abscissae=max(of_force / size, of_gamma / peak),
        condition=1.0,
        advancing=True,
        kind=state.kind,
        tol=max(tol, OF_SHEAR),
    )


def _kept(state: GrownSlip, term: Term) -> tuple[float, float]:
    """By how much H q + β p changed at most where bodies did not slip, and its rounding.

    What sticks under Q has not slipped since P alone; then, nor did what stuck under a lighter load
    and sticks still. Without such places nothing is known.
    """
    before, light = state.before_Q, state.lighter
    if before is not None:
        at = points(state.stick[0], [term])
        change = term._replace(density=lambda x: term.density(x) - before.shear(x))
        _, gamma, _, rounding = integrals([change], at)
        missed, of_gamma = _kept(before, *_terms(before))
        missed = max(missed, float(np.abs(gamma).max(initial=0.0)))
        return missed, max(of_gamma, float(rounding.max(initial=0.0)))
    pressure, beta = state.step.pressure, state.step.scene.beta
    at = points(state.untouched, [term])
    _, gamma, _, rounding = integrals([term], at)
    due = -beta * pressure(at)
    if light is not None:
        _, then, _, of_then = integrals(_terms(light), at)
        due, rounding = due + then + beta * light.step.pressure(at), rounding + of_then
    missed = float(np.abs(gamma - due).max()) if len(at) else math.inf
    of_p = P_ROUNDING * float(pressure(at).max(initial=0.0))
    return missed, float(rounding.max(initial=0.0)) + of_p


@dataclass(frozen=True, eq=False)
class _Remembered:
    """A shear with its values at the nodes of a rule, which are wanted again and again."""

    density: Density
    x: Array

    @cached_property
    def values(self) -> Array:
        return self.density(self.x)

    def __call__(self, x: Array) -> Array:
        return self.values if x is self.x else self.density(x)


def _terms(state: GrownSlip) -> list[Term]:
    contact = state.contact
    if any(state.step.normal.edges.sharp):
        x1, x2 = state.step.pressure.interval
        inside = np.array([x for x in state.marks if x1 < x < x2])
        rule = composite_rule(contact, state.step.slope, inside)
    else:
        rule = _between(state.marks, contact)
    return [Term(1.0, _Remembered(state.shear, rule.x), contact, rule)]


def _between(marks: tuple[float, ...], contact: Interval) -> Rule:
    """Panels that shrink towards all marks, in roots of the distance from them."""
    nodes, _, w = with_weight(NODES, 0.0, 0.0)

    def towards(end: float, middle: float) -> tuple[Array, Array]:
        levels = AT_EDGE if end in (marks[0], marks[-1]) else INSIDE
        ends = np.append(0.0, RATIO ** -np.arange(levels, -0.5, -1.0))
        length = np.diff(ends)[:, None]
        place, weight = (ends[:-1, None] + length * nodes).ravel(), (length * w).ravel()
        return end + (middle - end) * place**2, 2.0 * abs(middle - end) * place * weight

    x, dx = [], []
    for lo, hi in itertools.pairwise(marks):
        middle = 0.5 * (lo + hi)
        (left, rise), (right, fall) = towards(lo, middle), towards(hi, middle)
        x += [left, right[::-1]]
        dx += [rise, fall[::-1]]
    at = np.concatenate(x)
    return Rule(at, np.zeros_like(at), np.concatenate(dx), at[:0], slice(None), contact)
