"""The certificate of full stick: both equations at once, at points that the solver did not use.

With φ = p + i q, iβ φ(x) - 1/π PV∫φ(t)/(t - x) dt = E*/2 tilt on the whole contact, and
∫φ dx = P + i Q. φ oscillates towards both edges, so that the rule is graded there. The gap is zero
by assumption, and tension is allowed.
"""

from __future__ import annotations

import numpy as np

from sie.cauchy.density import JacobiDensity
from sie.contact.known_contact import Edges
from sie.contact.small_strains import BESIDE, notes
from sie.numerics.interval import Interval
from sie.problem.scene import Scene

from .quadrature import edge_graded_rule
from .result import Certificate


def full_stick_certificate(
    edges: Edges, found: JacobiDensity, scene: Scene, tol: float
) -> Certificate:
    """Residual of both equations between the nodes of a graded quadrature, and equilibrium."""
    (part,) = found.parts
    width, x1 = 2.0 * edges.contact.r, edges.contact.x1
    rule = edge_graded_rule(Interval(0.0, width))
    left, right, weight = rule.x, width * np.sin(0.5 * rule.angle) ** 2, rule.weight
    phi = part.value(right, left)
    between = rule.between  # distances from the left edge
    values = part.value(width - between, between)
    principal = ((phi - values[:, None]) / (between[:, None] - left)) @ weight
    principal += values * np.log(between / (width - between))
    residual = principal / np.pi + 1j * scene.beta * values - 0.5 * scene.Estar * edges.tilt
    P, peak = complex(edges.normal_load, scene.tangential_load), np.abs(values).max()
    moment = weight @ (phi * left) + x1 * (weight @ phi)
    highest = float(phi.real[np.minimum(right, left) > BESIDE * edges.contact.r].max())
    return Certificate(
        residual=float(np.abs(residual).max() / peak),
        implied=found.error,
        force=float(abs(weight @ phi - P) / abs(P)),
        moment=float(abs(moment.real - edges.moment) / (abs(P) * 0.5 * width)),
        lowest_pressure=0.0,
        lowest_gap=0.0,
        abscissae=0.0,
        tol=tol,
        notes=notes(np.array([edges.tilt]), highest / scene.Estar),
    )
