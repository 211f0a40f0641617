"""The certificate of a shear traction, measured at points that no solver used.

residual      max |1/π PV∫q(t)/(x - t) dt - τ| / max|q|     where the contact never slipped
equilibrium   |∫q dx - Q| / ∫|q| dx
excess        largest |q| - f p, and of ||q| - f p| in slip zones, over the peak of f p
opposing      smallest slip in the direction of q over the largest

q is a sum of terms, each integrated by a rule on its own contact, in one patch or several; per
period the kernel is (π/λ) cot(π(x - t)/λ).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.slip import Slip
from sie.friction.state import SAME, change_of_shear, excess_in_stick, intervals, opposing_slip
from sie.numerics.chord import Chord, Points
from sie.numerics.graded_panels import Rule as GradedRule
from sie.numerics.interval import EPS, Interval
from sie.numerics.zones import within
from sie.patches.panels import Patches
from sie.patches.result import PatchCertificate
from sie.patches.rule import Rule, principal_value
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.traction.base import Density

from .quadrature import Rule as OneRule
from .quadrature import composite_rule, finite
from .result import EXPLAINED, ShearCertificate

if TYPE_CHECKING:
    from sie.friction.finite_step import Part

Array = NDArray[np.float64]

POINTS = 24  # in the stick zone
BESIDE = 0.05  # of the distance of two nodes: a place closer to one divides rounding by that
# Terms of a shear that are integrated one by one: a rule for all grows with their number, and so
# does the cost of a value.
MANY = 12
# The end of a zone is known to this part of the contact: there |q| falls from f p like a root.
ENDS = 32.0 * EPS
SLIPS = 400  # places at which the direction of slip is measured, about


class Term(NamedTuple):
    """A part of the shear, factor × density, and the rule for its integrals.

    f         the density on the rule
    exact     whether the rule knows its places by their distances from edges
    """

    factor: float
    density: Any
    patches: Patches
    rule: Rule
    f: Array
    exact: bool = False

    @property
    def contact(self) -> Interval:
        """The outermost edges."""
        return Interval(float(self.patches.a[0]), float(self.patches.b[-1]))

    def placed(self, x: Array) -> tuple[Points, NDArray[np.int64]]:
        """Places by the nearest edge where the term has several patches, and their patches."""
        if self.patches.number > 1:
            points, patch, _ = self.density.placed(x)
            return points, patch
        return Points(x, 0.0 * x), np.zeros(len(x), dtype=np.int64)


def on_contact(factor: float, density: Callable[[Array], Array], rule: OneRule) -> Term:
    """A term on one patch, by a composite rule."""
    return Term(factor, density, rule.line, rule.on, finite(density(rule.x)))


def shear_certificate(
    state: Slip,
    pressure: Density,
    loads: tuple[float, float],
    slope: Slope,
    *,
    tol: float,
    of_pressures: Sequence[PatchCertificate] = (),
) -> ShearCertificate:
    """Measure a state; `loads` are Q and τ.

    `of_pressures` certify the pressures of several patches that q is the sum of.
    """
    # What cannot be measured is infinite, and not ok.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        terms, own = _terms(state, pressure, slope)
        x, weight, chord = own.rule.points.x, own.rule.weight, own.patches.chord
        p = state.friction * (own.f if own.density is pressure else finite(pressure(x)))
        q = finite(sum((t.factor * _at_rule(t, own) for t in terms), np.zeros(len(x))))
        scale = np.abs(q) if q.any() else p  # without shear what is missed is compared with f p
        size, peak = float(weight @ scale), float(scale.max())
        at = _places(state, terms, chord)
        force, equation, of_force, of_equation = integrals(terms, at)
        # what the pressures that q is the difference of are rounded by
        digits = max((c.measured_to / EXPLAINED for c in of_pressures), default=0.0)
        of_force += digits * sum(abs(t.factor) * float(t.rule.weight @ np.abs(t.f)) for t in terms)
        highest = digits * sum(abs(t.factor) * float(np.abs(t.f).max()) for t in terms)
        # q may be of another pressure, whose edges and places are rounded apart from those of p
        rounding = p * np.minimum(np.spacing(np.abs(x)) / _from_edges(own), 1.0)
        q_near_p = np.sign(q) * np.clip(p, np.abs(q) - rounding, np.abs(q) + rounding)
        some = slice(None, None, max(len(x) // SLIPS, 1))
        return ShearCertificate(
            residual=float(np.abs(equation - loads[1]).max(initial=0.0)) / peak,
            equilibrium=abs(force - loads[0]) / size,
            excess=excess(state.slipped, state.contact, x, p, q_near_p) / float(p.max()),
            opposing=opposing(state, state.slip_now(x[some]), x[some]),
            abscissae=max(of_force / size, (float(of_equation.max(initial=0.0)) + highest) / peak),
            condition=state.condition,
            advancing=state.advancing,
            kind=state.kind,
            tol=max(tol, state.promised),
        )


def _terms(state: Slip, pressure: Density, slope: Slope) -> tuple[list[Term], Term]:
    """The terms of the shear, and that whose places are those of p."""
    bases = state.shear.bases
    densities = [pressure, *(density for _, density in bases)]
    several = any(hasattr(d, "patches") for d in densities)
    contacts = [getattr(d, "contact", None) for d in densities]
    if not several and (len(bases) <= MANY or None in contacts):
        zones = (*state.stick, *(zone[:2] for zone in state.slipped))
        ends = {*state.levels, *(end for zone in zones for end in zone)}
        own = on_own_rule(state.shear, state.contact, ends, slope)
        return [own], own
    x1, x2 = state.contact[:2]
    resolution = None if several else refined(slope, x1, x2, EPS)
    known = {id(d): _term(d, slope, resolution) for d in densities if d.interval[0] < d.interval[1]}
    terms = [known[id(d)]._replace(factor=factor) for factor, d in bases if id(d) in known]
    return terms, known[id(pressure)]


def _term(density: Any, slope: Slope, resolution: Slope | None) -> Term:
    """A pressure on its patches, or on its contact."""
    if not hasattr(density, "patches"):
        rule = composite_rule(density.contact, slope, resolution=resolution)
        return on_contact(1.0, density, rule)
    patches = Patches.of(density.patches, Chord(density.period))
    return Term(1.0, density, patches, density.rule, finite(density.at_rule), exact=True)


def on_own_rule(
    density: Density, contact: Interval, marks: Collection[float], slope: Slope
) -> Term:
    """A shear on one contact, by a rule that shrinks towards the marks in it as well."""
    inside = np.array([x for x in marks if contact.x1 < x < contact.x2])
    return on_contact(1.0, density, composite_rule(contact, slope, inside))


def _at_rule(term: Term, own: Term) -> Array:
    """A density at the places of p."""
    return term.f if term.rule is own.rule else finite(term.density(own.rule.points.x))


def _from_edges(term: Term) -> Array:
    """The distances from the nearest edges of patches, of an ulp at least."""
    x = term.rule.points.x
    apart = np.abs(term.patches.chord.difference(x[:, None] - term.patches.edges)).min(axis=1)
    return np.asarray(np.maximum(apart, np.spacing(np.abs(x))))


def integrals(terms: Sequence[Term], at: Array) -> tuple[float, Array, float, Array]:
    """∫q dx, 1/π PV∫q/(x - t) at points, by subtracting q there; and rounding of both.

    Rounding is what one ulp of the nodes, which are counted from the edges, does. In a narrow stick
    zone next to a sharp edge, where q is infinite, the nodes there dominate.
    """
    force, of_force, equation, of_equation = 0.0, 0.0, np.zeros(len(at)), np.zeros(len(at))
    for term in terms:
        rule, values = term.rule, term.density(at)
        force += term.factor * float(rule.weight @ term.f)
        equation += term.factor * principal_value(
            term.patches, rule, term.f, term.placed(at), values
        )
        if term.exact:
            continue
        contact, x = term.contact, rule.points.x
        ulp = float(np.spacing(contact.r + abs(contact.m)))
        inwards, at_inwards = (place + np.where(place < contact.m, ulp, -ulp) for place in (x, at))
        moved = rule.weight * np.abs(finite(term.density(inwards)) - term.f)
        distance = np.abs(at[:, None] - x)
        distance[distance == 0.0] = np.inf
        of_force += abs(term.factor) * float(moved.sum())
        here = np.abs(finite(term.density(at_inwards)) - values)
        of_equation += abs(term.factor) * (here + (1.0 / distance) @ moved / np.pi)
    return force, equation, of_force, of_equation


def excess(
    slipped: Sequence[tuple[float, float, float]], contact: Interval, x: Array, p: Array, q: Array
) -> float:
    """The largest |q| - f p in stick, or error of |q| = f p in slip."""
    margin = ENDS * (contact.r + abs(contact.m))
    ends = np.array([e for zone in slipped for e in zone[:2]])
    near = (np.abs(x[:, None] - ends) <= margin).any(axis=1)
    # A node on a corner, where p is infinite, was set to 0.
    x, p, q = (values[(p > 0.0) & ~near] for values in (x, p, q))
    worst = float((np.abs(q) - p).max(initial=-np.inf))
    for lo, hi, sign in slipped:
        slipping = (x > lo) & (x < hi)
        worst = max(worst, float(np.abs(sign * q - p)[slipping].max(initial=0.0)))
    return worst


def opposing(state: Slip, slip: Array, x: Array) -> float:
    """The smallest slip in its own direction since the last turning point, over the largest."""
    largest = float(np.abs(slip).max(initial=0.0))
    along = [sign * slip[(x > lo) & (x < hi)] for lo, hi, sign in state.slipped]
    lowest = min((float(slips.min(initial=0.0)) for slips in along), default=0.0)
    return lowest / largest if largest else 0.0


def _places(state: Slip, terms: Sequence[Term], chord: Chord) -> Array:
    """Places that never slipped, between the nodes of all terms."""
    if not any(term.exact for term in terms):
        return points(state.untouched, terms) if terms else np.zeros(0)
    lightest = min(terms, key=lambda term: term.density.resultant)
    if lightest.exact:
        x = lightest.density.rules[1].points.x
    else:
        x = points(lightest.contact[:2], [lightest])
    kept = np.ones(len(x), dtype=bool)
    for term in terms:
        kept &= within(x, term.patches.zones, chord.period)
        nodes = term.rule.points.x
        if chord.periodic:
            nodes = x[0] + chord.difference(nodes - x[0])
            nodes = np.concatenate([nodes - chord.period, nodes, nodes + chord.period])
        nodes = np.unique(nodes)
        k = np.clip(np.searchsorted(nodes, x), 1, len(nodes) - 1)
        apart = np.minimum(np.abs(x - nodes[k - 1]), np.abs(nodes[k] - x))
        kept &= apart > BESIDE * (nodes[k] - nodes[k - 1])
    return np.asarray(x[kept])


def points(zone: tuple[float, float], terms: Sequence[Term]) -> Array:
    """Places in a zone, half-way between the ascending nodes of some rules.

    Of many rules these are the farthest apart in the neighbourhood.
    """
    (lo, hi), near = zone, len(terms) - 1
    nodes = np.unique(np.concatenate([term.rule.points.x for term in terms]))
    at = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS)
    k = np.clip(np.searchsorted(nodes, at)[:, None] + np.arange(-near, near + 1), 1, len(nodes) - 1)
    k = k[np.arange(POINTS), np.argmax(nodes[k] - nodes[k - 1], axis=1)]
    at = np.unique(0.5 * (nodes[k - 1] + nodes[k]))
    return np.asarray(at[(at > lo) & (at < hi) & ~np.isin(at, nodes)])


# -- after steps that were followed part by part ---------------------------------------------------

FOLLOWED = 1e-8  # of the largest shear, and of a half-width: what is promised of them
FAINT = 1e-4  # of the largest f p, a shear: of a smaller one that is promised of so large a one


def certificate_of_parts(state: Slip, parts: Sequence[Part], tol: float) -> ShearCertificate:
    """The certificate from the changes of the shear in the parts of the last step.

    It is measured from the states at the ends of parts: 1/π PV∫ Δq/(x - t) dt - Δτ where the
    surface stuck all along.
    """
    last = parts[-1].state
    contact = last.contact
    # what stuck to just before the end is in no answer where all slides there
    asked = parts if state.stick else parts[:-1]
    changes = (change_of_shear(part.before, part.state, part.stuck) for part in asked)
    missed = max(changes, default=0.0)
    ends = intervals(contact.patches, last.marks, SAME * contact.width)
    rule = GradedRule.graded(ends)
    q, p = last.shear.on(rule), contact.limit.on(rule)
    size = max(float(rule.weight @ np.abs(q)), FAINT * float(rule.weight @ p))
    peak = max(float(np.abs(q).max()), FAINT * float(p.max()))
    return ShearCertificate(
        residual=missed / peak,
        equilibrium=abs(float(rule.weight @ q) - contact.Q) / size,
        excess=excess_in_stick(last),
        opposing=-max(opposing_slip(part.before, part.state, part.stuck) for part in parts),
        abscissae=0.0,
        condition=1.0,
        advancing=True,
        kind=state.kind,
        tol=max(tol, FOLLOWED),
    )
