"""The certificate of full stick: both equations at once, at points that the solver did not use.

With φ = p + i q, iβ φ(x) - 1/π PV∫φ(t)/(t - x) dt = E*/2 tilt on the whole contact, and
∫φ dx = P + i Q. φ oscillates towards both edges, and is infinite there. The gap is zero by
assumption, and tension is allowed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.cauchy.density import JacobiDensity
from sie.contact.known_contact import Edges
from sie.contact.small_strains import BESIDE, notes
from sie.problem.scene import Scene
from sie.traction.in_contact import InContact

from .coupled_check import Nodes
from .result import Certificate

Array = NDArray[np.float64]


def full_stick_certificate(
    edges: Edges, found: JacobiDensity, scene: Scene, tol: float
) -> Certificate:
    """Residual of both equations between the nodes of a graded quadrature, and equilibrium."""
    (part,), contact = found.parts, edges.contact

    def rows(x: Array, rest: Array) -> Array:
        other, on_left = 2.0 * contact.r - rest, x < contact.m
        phi = part.value(np.where(on_left, other, rest), np.where(on_left, rest, other))
        return np.stack((phi.real, phi.imag))

    nodes = Nodes(InContact(contact, (contact.x1, contact.x2), rows, exact=True))
    at, (p, _), load = nodes.looked_at, nodes.rows, nodes.rows @ nodes.weight
    residual = nodes.principal_values(at) + scene.beta * np.stack((-at.rows[1], at.rows[0]))
    residual[0] -= 0.5 * scene.Estar * edges.tilt
    loads = np.array([edges.normal_load, scene.tangential_load])
    moment, size = float(nodes.weight @ (p * nodes.left)) + contact.x1 * load[0], np.hypot(*loads)
    highest = float(p[nodes.rest > BESIDE * contact.r].max())
    return Certificate(
        residual=float(np.hypot(*residual).max() / np.hypot(*at.rows).max()),
        implied=found.error,
        force=float(np.hypot(*(load - loads)) / size),
        moment=float(abs(moment - edges.moment) / (size * contact.r)),
        lowest_pressure=0.0,
        lowest_gap=0.0,
        abscissae=0.0,
        tol=tol,
        notes=notes(np.array([edges.tilt]), highest / scene.Estar),
    )
