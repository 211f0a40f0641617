"""The certificate: does the answer satisfy the question? Measured on the pressure's values alone, at points that no solver used.

    residual      max |1/π PV∫p(t)/(x - t) dt - E*/2 h'(x)| / peak       the integral equation (1)
    equilibrium   |∫p dx - P| / P,    |∫p x dx - M| / (P r)              the equation is blind to C/w(x): these are not
    inequalities  p >= 0 in contact, gap >= 0 outside
    resolution    E*/2 |h' - its resolution| / peak                      of a function
    edges         ΔP/(π r peak), ΔP the load that wrong edges carry      by their conditions

The integrals are composite Gauss-Legendre in the angle φ, graded towards the breaks of the slope: nothing of the closed forms is used.
The resolution is compared at points of a low-discrepancy sequence (`unseen`). An edge x2 that is
off by δ carries ΔP = G r JR δ too much (`edges`), and leaves ΔP/(π w(x)) in the pressure,
w = sqrt((x - x1)(x2 - x)), like the load on a flat punch: next to the edge that is p(x) δ/(2 d), d
the distance from it. δ is at least half an ulp of x2, if x2 is kept as a double; the rounding of
∫H dφ is a part of ΔP.
"""

from __future__ import annotations

import math
import textwrap
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import Moments, moments
from sie.contact.gap import gap, gap_slope
from sie.contact.small_strains import notes, regular_points
from sie.errors import InequalityError
from sie.numerics.interval import EPS, Interval
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.profiles.unresolved import largest_misfit
from sie.traction.of_slope import SlopeDensity
from sie.traction.sliding_panels import sliding_moments

from .quadrature import Rule, angles, composite_rule, inner_breaks, position

Array = NDArray[np.float64]
Intervals = tuple[tuple[float, float], ...]

PROMISE = (
    "At a distance d from the nearer edge the pressure is wrong by at most "
    "3 (error + edges sqrt(r/d)) of its peak, or of p(x) where that is larger, but for errors "
    "below 1e-15 of the peak, for what one ulp of x changes, and for what a function does on less "
    "than 5e-4 of the contact."
)
WIDE = 79  # columns of a terminal
LEAST = 8.0 * EPS  # rounding of single pressures, which the integrals average out ...
LEAST_OF_FUNCTION = 16.0 * EPS  # ... and a function is resolved to a few ulp of its largest value
SUMMED = 4.0 * EPS  # rounding of ∫H dφ, of the sum of its terms' sizes
EXPLAINED = (
    16.0  # what one ulp of x does may add up to this multiple in a principal value next to a corner
)
MOST_EXPLAINED = 0.1  # of the peak: where rounding of x can do more than that, nothing is certified
WELL_POSED = 0.05  # singular values below this fraction are what the points cannot tell
MISPLACED = 4.0  # error of the pressure near a misplaced edge, over the constant that it leaves in the residual, about
# Tension or overlap below this fraction of the peak is rounding.
TOLERATED = 1e-11
FAR = 1e3  # half-widths, how far out the gap is looked at
STEEP = 1e6  # times the slopes in the contact
SCAN = 40
# Distances from an edge, in half-widths.
AHEAD = np.concatenate((np.geomspace(1e-6, 1.0, SCAN), np.geomspace(1.0, FAR, 2 * SCAN)[1:]))
NAMED = 3  # intervals that a message names
RETREAT = "with Q and σ in proportion the zones of slip would retreat on the way here"
TOGETHER = 2**17  # entries of a matrix that are computed at once
ROUNDING = (
    8.0 * EPS
)  # of the slopes in the contact: by less a slope that rises may fall from point to point
SCANNED = (
    600  # points in contact at which the pressure's sign is looked at, at least 3 on every piece
)


@dataclass(frozen=True)
class Certificate:
    """What was measured on an answer. Numbers are relative: to the peak pressure (residual, inequalities), to P and P r (equilibrium).

    At a distance d from the nearer edge the pressure is wrong by at most
    3 (error + edges sqrt(r/d)) of its peak, or of p(x) where that is larger, but for errors below
    1e-15 of the peak, for what one ulp of x changes, and for what a function does on less than
    5e-4 of the contact.

    abscissae       how much of the above is rounding of x itself: where p changes within one ulp of x no double can tell more
    implied         the error of the pressure that would leave this residual
    resolution      how far a function is from its resolution at points of its own, as a pressure
    edges           what the load and rounding leave unknown of the edges, as an error of the
                    pressure at a distance r from them
    error           the estimated relative error of the pressure: the largest of these
    tension, overlap    the intervals of x where p < 0 in contact and gap < 0 outside, as closely as these were scanned
    notes           sentences on what the equations leave out: strains that are not small; they do
                    not count for `ok`

    Where dissimilar bodies slide, with exponents 1/2 ± ε at the edges, the root is
    (r/d)^(1/2 + |ε|).
    """

    residual: float
    implied: float
    force: float
    moment: float
    lowest_pressure: float
    lowest_gap: float
    abscissae: float
    tol: float
    tension: Intervals = ()
    overlap: Intervals = ()
    shear: ShearCertificate | None = None
    resolution: float = 0.0
    edges: float = 0.0
    notes: tuple[str, ...] = ()

    @property
    def error(self) -> float:
        defects = (
            self.residual,
            self.implied,
            self.force,
            self.moment,
            self.resolution,
            self.edges,
        )
        return max(LEAST, *(float("inf") if math.isnan(d) else d for d in defects))

    @property
    def ok(self) -> bool:
        """Every defect within tol, but for what rounding of the abscissae explains."""
        allowed = _allowed(self.tol, self.abscissae)
        if self.shear is not None and not self.shear.ok:
            return False
        return (
            self.error <= allowed
            and self.lowest_pressure >= -max(allowed, TOLERATED)
            and self.lowest_gap >= -max(allowed, TOLERATED)
        )

    def as_dict(self) -> dict[str, Any]:
        numbers = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "shear"} | {
            "error": self.error,
            "ok": self.ok,
        }
        numbers |= {name: list(map(list, numbers[name])) for name in ("tension", "overlap")} | {
            "notes": list(self.notes)
        }
        return numbers | ({} if self.shear is None else {"shear": self.shear.as_dict()})

    def __str__(self) -> str:
        rows: tuple[tuple[str, str], ...] = (
            ("integral equation (1), residual / peak", f"{self.residual:.1e}"),
            ("error of the pressure that would leave it / peak", f"{self.implied:.1e}"),
            ("equilibrium of forces, |∫p - P| / P", f"{self.force:.1e}"),
            ("equilibrium of moments, |∫px - M| / (P r)", f"{self.moment:.1e}"),
            ("lowest pressure in contact / peak", f"{self.lowest_pressure:+.1e}"),
            ("lowest gap outside / indentation scale", f"{self.lowest_gap:+.1e}"),
            ("of this, rounding of x itself", f"{self.abscissae:.1e}"),
            ("function against its resolution, as p / peak", f"{self.resolution:.1e}"),
            ("edges, as p / peak at a distance r from them", f"{self.edges:.1e}"),
            ("estimated relative error of the pressure", f"{self.error:.1e}"),
        )
        for name, intervals in (("p < 0", self.tension), ("gap < 0", self.overlap)):
            rows += ((f"{name} for {_shown(intervals)}", ""),) if intervals else ()
        verdict = (
            f"certified to {max(self.tol, EXPLAINED * self.abscissae):.0e}"
            if self.ok
            else f"NOT certified to {self.tol:.0e}"
        )
        rows += self.shear.rows if self.shear is not None else ()
        lines = [f"{name:<48} {value:>9}".rstrip() for name, value in rows]
        remarks = self.shear.remarks if self.shear is not None else ()
        return "\n".join([*lines, *remarks, verdict, *textwrap.wrap(PROMISE, WIDE), *self.notes])


@dataclass(frozen=True)
class ShearCertificate:
    """What was measured on a shear traction (see `slipcheck`). Relative to the largest |q|, to ∫|q| dx, to f times the peak pressure.

    condition     how much larger the relative error of the load on the stick zone is than that of P or Q
    advancing     whether the zones of slip only grow on the way to this state
    """

    residual: float
    equilibrium: float
    excess: float
    opposing: float
    abscissae: float
    condition: float
    advancing: bool
    kind: str
    tol: float

    @property
    def error(self) -> float:
        return max(
            LEAST,
            *(
                float("inf") if math.isnan(d) else d
                for d in (self.residual, self.equilibrium, self.excess)
            ),
        )

    @property
    def ok(self) -> bool:
        allowed = _allowed(self.tol, self.abscissae)
        return self.error <= allowed and self.opposing >= -max(allowed, TOLERATED)

    def as_dict(self) -> dict[str, Any]:
        return {f.name: getattr(self, f.name) for f in fields(self)} | {
            "error": self.error,
            "ok": self.ok,
        }

    @property
    def rows(self) -> tuple[tuple[str, str], ...]:
        return (
            ("shear equation (12) in stick, residual / peak", f"{self.residual:.1e}"),
            ("equilibrium, |∫q - Q| / ∫|q|", f"{self.equilibrium:.1e}"),
            ("friction, largest |q| - f p / peak of f p", f"{self.excess:+.1e}"),
            ("lowest slip along q / largest slip", f"{self.opposing:+.1e}"),
            ("of this, rounding of x itself", f"{self.abscissae:.1e}"),
            ("error of the stick zone's load per error of Q", f"{self.condition:.1e}"),
        )

    @property
    def remarks(self) -> tuple[str, ...]:
        if self.advancing:
            return (f"slip: {self.kind}",)
        return (f"slip: {self.kind}, in total displacements: {RETREAT}",)


def _allowed(tol: float, abscissae: float) -> float:
    return tol + min(EXPLAINED * abscissae, MOST_EXPLAINED)


def certificate(density: SlopeDensity, slope: Slope, tol: float) -> Certificate:
    """Measure an answer; `slope` includes the tilt."""
    with np.errstate(
        divide="ignore", invalid="ignore", over="ignore"
    ):  # what cannot be measured is infinite, and not ok
        return _measured(density, slope, tol)


def _measured(density: SlopeDensity, slope: Slope, tol: float) -> Certificate:
    contact = density.contact
    resolved = refined(slope, contact.x1, contact.x2, EPS) if density.resolves else slope
    rule = composite_rule(contact, slope, epsilon=density.epsilon, resolution=resolved)
    x, weight = rule.x, rule.weight
    p = _finite(density(x))
    peak = float(p.max())
    P, r = density.resultant, contact.r
    H, H_beside, H_at_edges = _slopes(slope, contact, rule.between)
    residual = _residual(density, H, rule, p)
    outside, gaps = _gaps(density, slope)
    of_force, of_equation = _rounding(density, H_beside - H, rule, p)
    regular = regular_points(density, slope, x)
    bounded_peak = float(p[regular].max(initial=0.0))
    by_values = bool(slope.functions) and density.resolves
    unseen = largest_misfit(slope, density.resolved_slope, resolved, contact) if by_values else 0.0
    resolution = max(density.half_modulus * unseen / peak, LEAST_OF_FUNCTION if by_values else 0.0)
    return Certificate(
        residual=float(np.abs(residual).max()) / peak,
        implied=_implied(residual, contact, rule.between) / peak,
        force=abs(float(weight @ p) - P) / P,
        moment=abs(
            float(weight @ (p * ((x - contact.m) / r))) + P * (contact.m / r) - density.moment / r
        )
        / P,  # P r may underflow
        lowest_pressure=min(float(p.min()) / peak, 0.0),
        lowest_gap=float(gaps.min(initial=0.0)),
        abscissae=max(of_force / P, of_equation / peak),
        tol=tol,
        tension=_below(x, p / peak),
        overlap=_below(outside, gaps),
        resolution=resolution,
        edges=_load_on_edges(density, resolved, rule) / (math.pi * r * (bounded_peak or peak)),
        notes=notes(np.concatenate((H, H_at_edges)), bounded_peak / (2.0 * density.half_modulus)),
    )


def _load_on_edges(density: SlopeDensity, slope: Slope, rule: Rule) -> float:
    """ΔP, by which smooth edges miss their conditions.

    As measured, by rounding of the integrals, and by that of the edges to doubles.
    """
    contact, r, e = density.contact, density.contact.r, density.epsilon
    G = density.half_modulus * math.cos(math.pi * e)
    k = _moments(density, slope, rule)
    rounding = SUMMED * r * (k.positive + k.negative)
    edges = (
        (density.k1, contact.x1, contact.tail1, k.I1 - k.I0, k.JL, 0.5 + e),
        (density.k2, contact.x2, contact.tail2, k.I1 + k.I0, k.JR, 0.5 - e),
    )
    missed = 0.0
    for singular, x, tail, K, J, share in edges:
        if not singular:
            kept = 0.0 if tail else 0.5 * math.ulp(x)  # a tail holds what rounding took
            missed = max(
                missed, abs(density.resultant / G - r * K) + kept * (r * J + share * abs(k.I0))
            )
    return G * (missed + rounding)


def _moments(density: SlopeDensity, slope: Slope, rule: Rule) -> Moments:
    if not density.resolves:
        return _by_rule(slope, density.contact, rule)
    if density.epsilon:
        return sliding_moments(slope, density.contact, density.epsilon)
    return moments(slope, density.contact)


def _by_rule(slope: Slope, contact: Interval, rule: Rule) -> Moments:
    """The moments of a slope that no polynomials resolve, without C2 and the sizes.

    With ψ from the right edge 1 + sin φ = 2 cos²(ψ/2), and r JR = ∫cot(ψ/2) dH, r JL = ∫tan(ψ/2) dH.
    """
    H, psi = slope(rule.x), rule.angle
    HdF = H * rule.weight / (contact.r * np.sin(psi))
    middle, dH = 0.25 * (psi[1:] + psi[:-1]), H[:-1] - H[1:]
    JR, JL = (float(dH @ steep) / contact.r for steep in (1.0 / np.tan(middle), np.tan(middle)))
    positive, negative = float(np.maximum(HdF, 0.0).sum()), -float(np.minimum(HdF, 0.0).sum())
    return Moments(
        positive - negative, float(HdF @ np.cos(psi)), 0.0, JR, JL, positive, negative, 0.0, 0.0
    )


def _finite(p: Array) -> Array:
    """p with its infinities dropped: a node that rounding put on a corner of the profile has the weight of rounding."""
    return np.where(np.isfinite(p), p, 0.0)


def slope_rises(density: SlopeDensity, slope: Slope) -> bool:
    """Whether h' rises wherever `verify_inequalities` would look, and no edge pulls: then p > 0 and gap > 0 follow."""
    contact = density.contact
    even = np.pi * (np.arange(SCANNED) + 0.5) / SCANNED
    inside = position(contact, even) if slope.functions else _scan(contact, slope)
    x = np.sort(np.concatenate((inside, inner_breaks(contact, slope), _beside(contact, slope))))
    H = slope(x)
    rounding = ROUNDING * density.slope_scale
    return (
        bool((H[1:] >= H[:-1] - rounding).all())
        and min(density.k1, density.k2) >= 0.0 < density.resultant
    )


def verify_inequalities(density: SlopeDensity, slope: Slope) -> None:
    """Raise InequalityError, saying where, if one patch of contact would need p < 0 inside or gap < 0 outside."""
    x = np.concatenate((_scan(density.contact, slope), inner_breaks(density.contact, slope)))
    p = density(x)
    peak = float(p[np.isfinite(p)].max())
    patch = (
        f"a single patch of contact [{density.interval[0]:.6g}, {density.interval[1]:.6g}] would"
    )
    worst = int(np.argmin(p))
    if p[worst] < -TOLERATED * peak or peak <= 0.0 or min(density.k1, density.k2) < 0.0:
        where = (
            float(x[worst])
            if min(density.k1, density.k2) >= 0.0
            else density.interval[int(density.k2 < density.k1)]
        )
        intervals = _below(x, p / abs(peak))
        raise InequalityError(
            f"{patch} need tension at x = {where:.6g} (p = {float(p[worst]):.3g}, peak {peak:.3g}){_among(intervals)}: "
            "the profile is not convex there and lifts off; "
            "give normal_load, under which several patches are found, raise the load or smooth the profile",
            x=where,
            edges=density.interval,
            tension=intervals,
        )
    x, gaps = _gaps(density, slope)
    if gaps.size and gaps.min() < -TOLERATED:
        where, intervals = float(x[np.argmin(gaps)]), _below(x, gaps)
        raise InequalityError(
            f"{patch} overlap the body at x = {where:.6g}{_among(intervals)}: "
            "the profile touches there too; give normal_load, under which several patches are found, "
            "lower the load, raise it until they merge, or smooth the profile",
            x=where,
            edges=density.interval,
            overlap=intervals,
        )


def _below(x: Array, values: Array) -> Intervals:
    """The intervals where values are below -TOLERATED, from where they change sign between two of the points."""
    order = np.argsort(x, kind="stable")
    x, values = x[order], values[order]
    low = np.concatenate(([False], values < -TOLERATED, [False]))
    starts, ends = np.flatnonzero(low[1:] & ~low[:-1]), np.flatnonzero(low[:-1] & ~low[1:]) - 1

    def crossing(inner: int, outer: int) -> float:
        if (
            not 0 <= outer < len(x)
            or not np.isfinite(values[[inner, outer]]).all()
            or values[outer] <= 0.0
        ):
            return float(x[inner])
        return float(
            x[inner] + (x[outer] - x[inner]) * values[inner] / (values[inner] - values[outer])
        )

    return tuple(
        (crossing(i, i - 1), crossing(j, j + 1))
        for i, j in zip(starts.tolist(), ends.tolist(), strict=True)
    )


def _shown(intervals: Intervals) -> str:
    shown = ", ".join(f"[{lo:.6g}, {hi:.6g}]" for lo, hi in intervals[:NAMED])
    return f"x in {shown}{f' and {len(intervals) - NAMED} more' if len(intervals) > NAMED else ''}"


def _among(intervals: Intervals) -> str:
    """The intervals, in a sentence that has named their worst point."""
    return f", for {_shown(intervals)}" if any(lo < hi for lo, hi in intervals) else ""


def _scan(contact: Interval, slope: Slope) -> Array:
    """Points inside every piece in the contact, evenly in the angle: many where there are few pieces."""
    resolution = refined(slope, contact.x1, contact.x2, EPS) if slope.functions else slope
    ends = np.concatenate(([0.0], angles(contact, inner_breaks(contact, resolution)), [np.pi]))
    n = max(SCANNED // (len(ends) - 1), 3)
    fractions = (np.arange(n) + 0.5) / n
    return position(contact, (ends[:-1, None] + np.diff(ends)[:, None] * fractions).ravel())


def _slopes(slope: Slope, contact: Interval, at: Array) -> tuple[Array, Array, Array]:
    """H at points, one ulp further in, and at the edges."""
    H = slope(np.concatenate((at, np.nextafter(at, contact.m), (contact.x1, contact.x2))))
    return H[: len(at)], H[len(at) : 2 * len(at)], H[2 * len(at) :]


def _residual(density: SlopeDensity, H: Array, rule: Rule, p: Array) -> Array:
    """1/π PV∫p/(x - t) - E*/2 H between the nodes, by subtracting p there: what is left of the integrand is smooth."""
    at, x = rule.between, rule.x
    values = density(at)
    taken_out = np.ones(1) if rule.inner == slice(None) else np.zeros(len(x))
    taken_out[rule.inner] = 1.0
    integral = values * np.log(rule.ends.from_left(at) / rule.ends.from_right(at))
    rows = max(TOGETHER // len(x), 1)
    for k in range(0, len(at), rows):
        some = slice(k, k + rows)
        integrand = p - values[some, None] * taken_out
        distance = at[some, None] - x
        integrand /= distance
        summed = integrand @ rule.weight
        if not np.isfinite(summed).all():
            integrand[distance == 0.0] = 0.0  # the node is the point: on a panel of a few ulp
            summed = integrand @ rule.weight
        integral[some] += summed
    return (
        integral / np.pi + math.tan(math.pi * density.epsilon) * values - density.half_modulus * H
    )


def _implied(residual: Array, contact: Interval, at: Array) -> float:
    """The largest error of p that leaves this residual: r = Σ r_n T_n is what sqrt(1 - s²) Σ r_n U_{n-1} leaves, fitted to the points.

    A constant r_0 belongs to edges in the wrong place, where the pressure is wrong by more than r_0.
    """
    angle = 2.0 * np.arctan2(np.sqrt(contact.from_right(at)), np.sqrt(contact.from_left(at)))
    n = np.arange(max(len(at) // 3, 1))
    r = np.linalg.lstsq(np.cos(np.outer(angle, n)), residual, rcond=WELL_POSED)[0]
    grid = np.linspace(0.0, np.pi, 65)
    return float(np.abs(np.sin(np.outer(grid, n)) @ r).max() + MISPLACED * abs(r[0]))


def _rounding(density: SlopeDensity, change: Array, rule: Rule, p: Array) -> tuple[float, float]:
    """What rounding of x can explain: of ∫p dx, and of both sides of the equation between the nodes, as a stress.

    |p'| ulp(x), with p' from node to node, or p over twice the distance to an edge: noise of p
    itself must not excuse itself. `change` is that of H in one ulp between the nodes.
    """
    order = np.argsort(rule.x, kind="stable")
    x, weight, p = rule.x[order], rule.weight[order], p[order]
    ulp, apart = np.spacing(np.abs(x)), np.diff(x)
    steps = np.abs(np.diff(p)) * np.minimum(ulp[1:] / np.maximum(apart, ulp[1:]), 1.0)
    from_edge = np.maximum(
        np.minimum(density.contact.from_left(x), density.contact.from_right(x)), 0.0
    )
    moved = np.abs(p) * np.minimum(ulp / np.maximum(2.0 * from_edge, ulp), 1.0)
    moved[1:] = np.maximum(moved[1:], steps)
    moved[:-1] = np.maximum(moved[:-1], steps)
    at = rule.between
    near = np.clip(np.searchsorted(x, at), 1, len(x) - 1) - 1
    return float(weight @ moved), float((moved[near] + density.half_modulus * np.abs(change)).max())


def _beside(contact: Interval, slope: Slope) -> Array:
    """Points beside the contact, out to FAR half-widths or the ends of the indenter, its breaks among them."""
    lo, hi = slope.domain
    distance = contact.r * AHEAD
    outer = slope.breaks[np.isfinite(slope.breaks)]
    x = np.concatenate((contact.x2 + distance, contact.x1 - distance, outer))
    return x[((contact.from_left(x) < 0.0) | (contact.from_right(x) < 0.0)) & (x >= lo) & (x <= hi)]


def _gaps(density: SlopeDensity, slope: Slope) -> tuple[Array, Array]:
    """Points beside the contact, out to FAR half-widths, and the gap there relative to its largest value within one half-width."""
    contact, r = density.contact, density.contact.r
    x = _beside(contact, slope)
    if _opens_everywhere(x, density, slope):
        return x, np.zeros(len(x))
    # A function may overflow out there; from where it opens that steeply on, the gap is not looked at
    outward = np.sign(x - contact.m)
    opens = ~(
        outward * slope(x)
        < STEEP * max(density.slope_scale, density.resultant / (density.half_modulus * r))
    )
    left, right = (
        np.abs(x[opens & (outward == side)] - contact.m).min(initial=np.inf) for side in (-1.0, 1.0)
    )
    x = x[np.abs(x - contact.m) < np.where(outward > 0.0, right, left)]
    if not x.size:
        return x, x
    values = gap(x, density, slope)
    scale = max(
        float(
            np.abs(values[np.minimum(np.abs(x - contact.x1), np.abs(x - contact.x2)) <= r]).max(
                initial=0.0
            )
        ),
        density.resultant / density.half_modulus * 1e-3,
    )
    return x, values / scale


def _opens_everywhere(x: Array, density: SlopeDensity, slope: Slope) -> bool:
    """Whether the gap grows outwards at x, at the breaks among them from both sides: then it need not be integrated.

    Between its breaks a polynomial slope or a power does nothing unseen there; a function might.
    """
    if slope.functions and density.resolves:
        return False
    if not (slope.functions or slope.continuous):
        x = np.concatenate((x, np.nextafter(x, -np.inf), np.nextafter(x, np.inf)))
    if _slope_rises_outwards(x, density, slope):
        return True
    left, right = density.contact.from_left(x) < 0.0, density.contact.from_right(x) < 0.0
    for sign, side in ((-1.0, left), (1.0, right)):
        if side.any() and not (sign * gap_slope(x[side], density, slope) >= 0.0).all():
            return False
    return True


def _slope_rises_outwards(x: Array, density: SlopeDensity, slope: Slope) -> bool:
    """Whether H rises from smooth edges on, over x beside the contact: then the gap opens.

    For p >= 0 in contact 1/π∫p/(x - t) dt falls outwards, from its value E*/2 H at the edge.
    """
    x1, x2 = density.interval
    if (density.k1 and x.min(initial=x1) < x1) or (density.k2 and x.max(initial=x2) > x2):
        return False
    H = slope(np.sort(np.concatenate((x, (x1, x2)))))
    return bool((H[1:] >= H[:-1]).all())
