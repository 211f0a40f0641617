"""The certificate of the shear in Goodman's approximation, on values of p and q alone.

residual      max |γ - γ'| / max|q|,  γ = 1/π PV∫q/(x - t) dt + β p,  where the bodies stuck under a
              lighter load already; γ' is γ under that load, 0 where the contact does not grow
equilibrium   |∫q dx - Q| / ∫|q| dx
excess        largest |q| - f p, and of ||q| - f p| in slip zones, over the peak of f p
opposing      smallest slip in the direction of q over the largest, under the normal load
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.friction.goodman import GoodmanSlip
from sie.numerics.interval import EPS
from sie.profiles.resolution import refined

from .quadrature import composite_rule
from .result import ShearCertificate
from .shear_check import Term, excess, finite, integrals, opposing, points

Array = NDArray[np.float64]

OF_SHEAR = 1e-10  # of the largest shear: what is promised of (12)
P_ROUNDING = 16.0 * EPS  # of p, which q is balanced with in (12)


def goodman_certificate(state: GoodmanSlip, kind: str, tol: float) -> ShearCertificate:
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


def _terms(state: GoodmanSlip) -> list[Term]:
    contact, slope = state.contact, state.step.slope
    resolution = refined(slope, contact.x1, contact.x2, EPS)
    x1, x2 = state.step.pressure.interval
    inside = np.array([x for x in state.marks if x1 < x < x2])
    rule = composite_rule(contact, slope, inside, resolution=resolution)
    return [Term(1.0, state.shear, contact, rule)]
