"""The certificate of a shear traction, measured at points that no solver used.

residual      max |1/π PV∫q(t)/(x - t) dt - τ| / max|q|     where the contact never slipped
equilibrium   |∫q dx - Q| / ∫|q| dx
excess        largest |q| - f p, and of ||q| - f p| in slip zones, over the peak of f p
opposing      smallest slip in the direction of q over the largest
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.friction.states import Slip
from sie.numerics.interval import EPS, Interval
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity

from .quadrature import Rule, composite_rule
from .result import ShearCertificate

Array = NDArray[np.float64]

POINTS = 24  # in the stick zone
# of the contact, to which the end of a zone is known: there |q| falls from f p like a square root
ENDS = 32.0 * EPS


def shear_certificate(
    state: Slip, pressure: SlopeDensity, loads: tuple[float, float], slope: Slope, tol: float
) -> ShearCertificate:
    """Measure a state; `loads` are Q and τ."""
    ends = (
        [c for zone in state.stick for c in zone]
        + [c for lo, hi, _ in state.slipped for c in (lo, hi)]
        + list(state.levels)
    )
    x1, x2 = pressure.interval
    rule = composite_rule(pressure.contact, slope, np.array([c for c in set(ends) if x1 < c < x2]))
    with np.errstate(
        divide="ignore", invalid="ignore", over="ignore"
    ):  # what cannot be measured is infinite, and not ok
        return _measured(state, pressure, loads, rule, tol)


def _measured(
    state: Slip, pressure: SlopeDensity, loads: tuple[float, float], rule: Rule, tol: float
) -> ShearCertificate:
    x, weight = rule.x, rule.weight
    p, q = _finite(state.friction * pressure(x)), _finite(state.shear(x))
    size, peak = float(weight @ np.abs(q)), float(np.abs(q).max())
    if size == 0.0:
        size = peak = state.friction * pressure.resultant
    of_force, of_equation = _rounding(state, pressure.contact, x, weight, q)
    return ShearCertificate(
        residual=_residual(state, pressure.contact, rule, q, loads[1]) / peak,
        equilibrium=abs(float(weight @ q) - loads[0]) / size,
        excess=_excess(state, pressure.contact, x, p, q) / float(p.max()),
        opposing=_opposing(state, x),
        abscissae=max(of_force / size, of_equation / peak),
        condition=state.condition,
        advancing=state.advancing,
        kind=state.kind,
        tol=tol,
    )


def _residual(state: Slip, contact: Interval, rule: Rule, q: Array, tau: float) -> float:
    """1/π PV∫q/(x - t) - τ in the zone that never slipped, by subtracting q there."""
    at = _points(state, rule.x)
    if not at.size:
        return 0.0
    values = state.shear(at)
    distance = at[:, None] - rule.x
    distance[distance == 0.0] = np.inf
    whole = values * np.log(contact.from_left(at) / contact.from_right(at))
    return float(
        np.abs((((q - values[:, None]) / distance) @ rule.weight + whole) / np.pi - tau).max()
    )


def _excess(state: Slip, contact: Interval, x: Array, p: Array, q: Array) -> float:
    worst = float(
        np.where(p > 0.0, np.abs(q) - p, -np.inf).max()
    )  # a node on a corner, where p is infinite, was set to 0
    margin = ENDS * (contact.r + abs(contact.m))
    for lo, hi, sign in state.slipped:
        slipping = (x > lo + margin) & (x < hi - margin) & (p > 0.0)
        worst = max(worst, float(np.abs(sign * q - p)[slipping].max(initial=0.0)))
    return worst


def _opposing(state: Slip, x: Array) -> float:
    """Of the slip since the last turning point: smallest in its own direction, over the largest."""
    slip = state.slip_now(x)
    largest = float(np.abs(slip).max(initial=0.0))
    lowest = min(
        (
            float((sign * slip[(x > lo) & (x < hi)]).min(initial=0.0))
            for lo, hi, sign in state.slipped
        ),
        default=0.0,
    )
    return lowest / largest if largest else 0.0


def _rounding(
    state: Slip, contact: Interval, x: Array, weight: Array, q: Array
) -> tuple[float, float]:
    """What one ulp of the nodes, which are counted from the edges, does to ∫q dx and to the
    equation where that is measured.

    In a narrow stick zone next to a sharp edge, where q is infinite, it is the nodes there that the
    equation feels.
    """
    ulp = float(np.spacing(contact.r + abs(contact.m)))

    def moved_inwards(x: Array) -> Array:
        return x + np.where(x < contact.m, ulp, -ulp)

    at = _points(state, x)
    moved = np.abs(_finite(state.shear(moved_inwards(x))) - q)
    here = np.abs(_finite(state.shear(moved_inwards(at))) - state.shear(at))
    felt = (1.0 / np.abs(at[:, None] - x)) @ (weight * moved) / np.pi
    return float(weight @ moved), float((here + felt).max(initial=0.0))


def _points(state: Slip, nodes: Array) -> Array:
    """Where the equation is measured: over the zone that never slipped, half-way between nodes."""
    lo, hi = state.untouched
    nodes = np.unique(nodes)
    at = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS)
    k = np.clip(np.searchsorted(nodes, at), 1, len(nodes) - 1)
    at = np.unique(0.5 * (nodes[k - 1] + nodes[k]))
    inside: Array = at[(at > lo) & (at < hi) & ~np.isin(at, nodes)]
    return inside


def _finite(values: Array) -> Array:
    return np.where(np.isfinite(values), values, 0.0)
