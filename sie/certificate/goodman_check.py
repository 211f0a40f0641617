"""The certificate of the shear in Goodman's approximation, on values of p and q alone.

residual      max |γ - γ'| / max|q|,  γ = 1/π PV∫q/(x - t) dt + β p,  where the bodies stuck under a
              lighter load already; γ' is γ under that load, 0 where the contact does not grow
equilibrium   |∫q dx - Q| / ∫|q| dx
excess        largest |q| - f p, and of ||q| - f p| in slip zones, over the peak of f p
opposing      smallest slip in the direction of q over the largest, under the normal load
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from sie.friction.states import GrownSlip
from sie.numerics.gauss_jacobi import with_weight
from sie.numerics.interval import EPS, Interval

from .quadrature import Rule, composite_rule
from .result import ShearCertificate
from .shear_check import Term, excess, finite, integrals, opposing, points

Array = NDArray[np.float64]

OF_SHEAR = 1e-10  # of the largest shear: what is promised of (12)
NODES, RATIO, LEVELS = 12, 3.0, 17  # panels towards a mark, in the root of the distance
P_ROUNDING = 16.0 * EPS  # of p, which q is balanced with in (12)


def goodman_certificate(state: GrownSlip, kind: str, tol: float) -> ShearCertificate:
    """Measured on a state and on that under a lighter load; `kind` says what is neglected."""
    pressure, (term,) = state.step.pressure, _terms(state)
    x, weight = term.rule.x, term.rule.weight
    p, q = finite(state.friction * pressure(x)), finite(state.shear(x))
    size, peak = float(weight @ np.abs(q)), float(np.abs(q).max())
    at = points(state, [term])
    force, gamma, of_force, of_gamma = integrals([term], at)
    due = np.zeros(len(at))
    if state.lighter is not None:
        _, before, _, of_before = integrals(_terms(state.lighter), at)
        change = state.lighter.step.pressure(at) - pressure(at)
        due, of_gamma = before + state.step.scene.beta * change, of_gamma + of_before
    else:
        due = -state.step.scene.beta * pressure(at)
    of_p = P_ROUNDING * float(pressure(at).max(initial=0.0))
    return ShearCertificate(
        residual=float(np.abs(gamma - due).max(initial=0.0)) / peak,
        equilibrium=abs(force - state.step.Q) / size,
        excess=excess(state, pressure.contact, x, p, q) / float(p.max()),
        opposing=opposing(state, x) if state.zones is None else 0.0,
        abscissae=max(of_force / size, (float(of_gamma.max(initial=0.0)) + of_p) / peak),
        condition=1.0,
        advancing=True,
        kind=f"{state.kind}; {kind}",
        tol=max(tol, OF_SHEAR),
    )


def _terms(state: GrownSlip) -> list[Term]:
    contact = state.contact
    if any(state.step.normal.edges.sharp):
        x1, x2 = state.step.pressure.interval
        inside = np.array([x for x in state.marks if x1 < x < x2])
        rule = composite_rule(contact, state.step.slope, inside)
    else:
        rule = _between(state.marks, contact)
    return [Term(1.0, state.shear, contact, rule)]


def _between(marks: tuple[float, ...], contact: Interval) -> Rule:
    """Panels that shrink towards all marks, in roots of the distance from them."""
    u = RATIO ** -np.arange(LEVELS, -0.5, -1.0)
    nodes, _, w = with_weight(NODES, 0.0, 0.0)
    ends = np.append(0.0, u)
    length = np.diff(ends)[:, None]
    place, weight = (ends[:-1, None] + length * nodes).ravel(), (length * w).ravel()
    x, dx = [], []
    for lo, hi in itertools.pairwise(marks):
        half = 0.5 * (hi - lo)
        x += [lo + half * place**2, (hi - half * place**2)[::-1]]
        dx += [2.0 * half * place * weight, (2.0 * half * place * weight)[::-1]]
    at = np.concatenate(x)
    return Rule(at, np.zeros_like(at), np.concatenate(dx), at[:0], slice(None), contact)
