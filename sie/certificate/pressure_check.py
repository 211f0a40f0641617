"""The certificate of a pressure: measured on its values alone, at points that no solver used.

    residual      max |1/π PV∫p(t)/(x - t) dt - E*/2 h'(x)| / peak     the integral equation (1)
    equilibrium   |∫p dx - P| / P,    |∫p x dx - M| / (P r)
    inequalities  p >= 0 in contact, gap >= 0 outside
    resolution    E*/2 |h' - its resolution| / peak                    of a function
    edges         ΔP/(π r peak), ΔP the load that wrong edges carry    by their conditions

Equilibrium is measured separately, because with w = sqrt((x - x1)(x2 - x)) the residual does not
show an error C/w(x). The integrals are composite Gauss-Legendre in the angle φ, graded towards the
breaks of the slope; nothing of the closed forms is used. The resolution is compared at points of a
low-discrepancy sequence (`profiles.look`). An edge x2 that is off by δ carries ΔP = G r JR δ
too much (`contact.edges`), and leaves ΔP/(π w(x)) in the pressure, like the load on a flat punch:
next to the edge that is p(x) δ/(2 d), d the distance from it. δ is at least half an ulp of x2, if
x2 is kept as a double. The rounding of ∫H dφ is a part of ΔP, and so is that of the terms of H.

Where an edge is sharp the pressure has no peak: there `peak` is that of p sqrt(1 - s²).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sie.contact.edge_integrals import edge_integrals
from sie.contact.gap import relative_gaps
from sie.contact.small_strains import notes, regular_points
from sie.numerics.chord import Points
from sie.numerics.interval import EPS, Interval
from sie.patches.rule import principal_value
from sie.profiles.look import FINER, largest_misfit, start_of
from sie.profiles.resolution import refined
from sie.profiles.slope import Slope
from sie.progress_bar import reported
from sie.traction.of_slope import SlopeDensity

from .quadrature import Rule, composite_rule, finite
from .result import TOLERATED, Certificate, Intervals, unresolved

Array = NDArray[np.float64]

LEAST_OF_FUNCTION = 16.0 * EPS  # ... and a function is resolved to a few ulp of its largest value
SUMMED = 4.0 * EPS  # rounding of ∫H dφ, of the sum of its terms' sizes
WELL_POSED = 0.05  # smaller singular values belong to errors that the points do not show
# error of the pressure near a misplaced edge, over the constant that it leaves in the residual,
# about
MISPLACED = 4.0


@reported("certificate")
def certificate(density: SlopeDensity, slope: Slope, tol: float) -> Certificate:
    """Measure an answer; `slope` includes the tilt."""
    # What cannot be measured is infinite, and not ok.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return _measured(density, slope, tol)


def _measured(density: SlopeDensity, slope: Slope, tol: float) -> Certificate:
    contact = density.contact
    resolved = refined(slope, contact.x1, contact.x2, EPS)
    rule = composite_rule(contact, slope, epsilon=density.epsilon, resolution=resolved)
    p = finite(density(rule.x))
    root = _of_sharp_edges(density, rule.x)
    if density.k1 or density.k2:  # p dx = p root r dφ, both at x as it is rounded
        weight = rule.weight * root / np.sin(rule.angle)
        rule = rule._replace(on=rule.on._replace(weight=weight))
    peak = float((p * root).max())
    H, H_beside, H_at_edges = _slopes(slope, contact, rule.between)
    residual = _residual(density, H, rule, p)
    outside, gaps = relative_gaps(density, slope, FINER, start_of(density.interval))
    of_force, of_equation = _rounding(density, H_beside - H, rule, p)
    abscissae = max(of_force / density.resultant, of_equation / peak)
    force, moment = _equilibrium(density, rule, p)
    regular = regular_points(density, slope, rule.x)
    bounded_peak = float(p[regular].max(initial=0.0))
    by_values = bool(slope.functions)
    unseen = largest_misfit(slope, density.resolved_slope, contact) if by_values else 0.0
    resolution = max(density.half_modulus * unseen / peak, LEAST_OF_FUNCTION if by_values else 0.0)
    return Certificate(
        residual=float(np.abs(residual).max()) / peak,
        implied=_implied(residual, contact, rule.between) / peak,
        force=force,
        moment=moment,
        lowest_pressure=min(float(p.min()) / peak, 0.0),
        lowest_gap=float(gaps.min(initial=0.0)),
        abscissae=abscissae,
        tol=tol,
        tension=intervals_below(rule.x, p / peak),
        overlap=intervals_below(outside, gaps),
        resolution=resolution,
        edges=_load_on_edges(density, resolved, rule)
        / (math.pi * contact.r * (bounded_peak or peak)),
        root=0.5 + abs(density.epsilon),
        notes=unresolved(abscissae)
        + notes(np.concatenate((H, H_at_edges)), bounded_peak / (2.0 * density.half_modulus)),
    )


def _equilibrium(density: SlopeDensity, rule: Rule, p: Array) -> tuple[float, float]:
    """The defects of force and moment over P and P r; P r may underflow."""
    P, r, m = density.resultant, density.contact.r, density.contact.m
    arm = float(rule.weight @ (p * ((rule.x - m) / r)))
    return abs(float(rule.weight @ p) - P) / P, abs(arm + P * (m / r) - density.moment / r) / P


def _of_sharp_edges(density: SlopeDensity, x: Array) -> Array:
    """sqrt(1 - s²), times which a pressure with a sharp edge is finite; 1 without one."""
    if not (density.k1 or density.k2):
        return np.ones_like(x)
    left, right = density.contact.from_left(x), density.contact.from_right(x)
    root: Array = np.sqrt(left) * np.sqrt(right) / density.contact.r
    return root


def _load_on_edges(density: SlopeDensity, slope: Slope, rule: Rule) -> float:
    """ΔP, by which smooth edges miss their conditions.

    As measured, by rounding of the integrals, and by that of the edges to doubles.
    """
    contact, r, e = density.contact, density.contact.r, density.epsilon
    G = density.half_modulus * math.cos(math.pi * e)
    k = edge_integrals(slope, contact, epsilon=density.epsilon)
    of_terms = EPS * math.pi * float(_sizes_of_terms(slope, rule.x).max())
    rounding = r * (SUMMED * (k.positive + k.negative) + of_terms)
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


def _sizes_of_terms(slope: Slope, x: Array) -> Array:
    """Σ_j |c_j (x - origin)^j|: H is rounded to EPS of it, however much of it cancels."""
    k = np.searchsorted(slope.breaks[1:-1], x)
    y, c = np.abs(x - slope.origins[k]), np.abs(slope.coefficients)
    values: Array = c[k, -1]
    for j in range(c.shape[1] - 2, -1, -1):
        values = values * y + c[k, j]
    return values


def _slopes(slope: Slope, contact: Interval, at: Array) -> tuple[Array, Array, Array]:
    """H at points, one ulp further in, and at the edges."""
    H = slope(np.concatenate((at, np.nextafter(at, contact.m), (contact.x1, contact.x2))))
    return H[: len(at)], H[len(at) : 2 * len(at)], H[2 * len(at) :]


def _residual(density: SlopeDensity, H: Array, rule: Rule, p: Array) -> Array:
    """1/π PV∫p/(x - t) - E*/2 H between the nodes."""
    at, values = Points(rule.between, 0.0 * rule.between), density(rule.between)
    found = principal_value(rule.line, rule.on, p, (at, np.zeros(len(values), int)), values)
    return found + math.tan(math.pi * density.epsilon) * values - density.half_modulus * H


def _implied(residual: Array, contact: Interval, at: Array) -> float:
    """The largest error of p that leaves this residual.

    r = Σ r_n T_n, fitted to the points, is what sqrt(1 - s²) Σ r_n U_{n-1} leaves.

    A constant r_0 belongs to edges in the wrong place, where the pressure is wrong by more than
    r_0.
    """
    angle = 2.0 * np.arctan2(np.sqrt(contact.from_right(at)), np.sqrt(contact.from_left(at)))
    n = np.arange(max(len(at) // 3, 1))
    r = np.linalg.lstsq(np.cos(np.outer(angle, n)), residual, rcond=WELL_POSED)[0]
    grid = np.linspace(0.0, np.pi, 65)
    return float(np.abs(np.sin(np.outer(grid, n)) @ r).max() + MISPLACED * abs(r[0]))


def _rounding(density: SlopeDensity, change: Array, rule: Rule, p: Array) -> tuple[float, float]:
    """The part of both errors that rounding of x explains.

    The errors are that of ∫p dx, and that of the equation between the nodes, a stress.

    It is |p'| ulp(x), with p' from node to node, or p over twice the distance to an edge where that
    is less: noise of p must not pass for rounding. `change` is that of H in one ulp between nodes.
    """
    order = np.argsort(rule.x, kind="stable")
    x, weight, p = rule.x[order], rule.weight[order], p[order]
    ulp, apart = np.spacing(np.abs(x)), np.diff(x)
    from_edge = np.maximum(
        np.minimum(density.contact.from_left(x), density.contact.from_right(x)), 0.0
    )
    of_root = np.abs(p) * np.minimum(ulp / np.maximum(2.0 * from_edge, ulp), 1.0)
    root, sharp = _of_sharp_edges(density, x), bool(density.k1 or density.k2)
    weight, p = weight / root, p * root  # the weights of sharp edges have the root of p
    steps = np.abs(np.diff(p)) * np.minimum(ulp[1:] / np.maximum(apart, ulp[1:]), 1.0)
    moved = np.zeros_like(p) if sharp else of_root
    moved[1:] = np.maximum(moved[1:], steps)
    moved[:-1] = np.maximum(moved[:-1], steps)
    of_value = moved / root + of_root * sharp
    at = rule.between
    near = np.clip(np.searchsorted(x, at), 1, len(x) - 1) - 1
    return float(weight @ moved), float(
        (of_value[near] + density.half_modulus * np.abs(change)).max()
    )


def intervals_below(x: Array, values: Array) -> Intervals:
    """The intervals where values are below -TOLERATED.

    They begin and end where values change sign between two of the points.
    """
    order = np.argsort(x, kind="stable")
    x, values = x[order], values[order]
    low = np.concatenate(([False], values < -TOLERATED, [False]))
    starts, ends = np.flatnonzero(low[1:] & ~low[:-1]), np.flatnonzero(low[:-1] & ~low[1:]) - 1

    def crossing(inner: int, outer: int) -> float:
        outer = min(max(outer, 0), len(x) - 1)
        rise = values[outer] - values[inner]
        crosses = values[outer] > 0.0 and np.isfinite(rise)
        return float(x[inner] - ((x[outer] - x[inner]) * values[inner] / rise if crosses else 0.0))

    return tuple(
        (crossing(i, i - 1), crossing(j, j + 1))
        for i, j in zip(starts.tolist(), ends.tolist(), strict=True)
    )
