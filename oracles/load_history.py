"""Partial slip on a mesh under any history of P, Q, bulk stress and tilt, increment by increment.

Constant p and q on each of n equal elements; with A of `kalker`, similar bodies. Each increment
solves two quadratic programmes,

    p:  minimise ½ p·A p + p·(h + θ x)      over p >= 0,       with ∫p = P
    q:  minimise ½ q·A q + q·(g + 2τ x/E*)  over |q| <= f p,   with ∫q = Q

where g + 2τ x/E* + A q is constant where the bodies stick: g is frozen there, and elsewhere it is
what the surfaces had when they touched. The errors are of the first order in the elements and
increments: compare q and energies on two meshes. In a steady cycle the ends of stick zones
alternate between neighbouring elements.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .kalker import Mesh

Array = NDArray[np.float64]


class State(NamedTuple):
    """The state at a turning point: tractions on the elements, slip, energy lost since the start.

    `slip` is counted from when each element came into contact. `shift` is what slip adds to the
    shift of the indenter: at each time the mean under the pressure of a flat punch on the contact.
    """

    pressure: Array
    shear: Array
    slip: Array
    energy: float
    shift: float


def history(
    mesh: Mesh,
    gap: Callable[[Array], Array],
    friction: float,
    points: Sequence[Sequence[float]],
    increments: int,
) -> list[State]:
    """The states at turning points (P, Q, σ, tilt); the first is reached by P and tilt, then the
    rest, all others in so many equal increments.
    """
    x, n = mesh.x, len(mesh.x)
    P, _, _, tilt = points[0]
    p = mesh.pressure(gap(x) + tilt * x, P, np.zeros(n))
    q, slip, energy, shift = np.zeros(n), np.zeros(n), 0.0, 0.0
    before, found = np.array([P, 0.0, 0.0, tilt]), []
    for target in np.array(points, dtype=float):
        for share in np.arange(1, increments + 1) / increments:
            P, Q, _, tilt = before + share * (target - before)
            strain = 0.5 * (target[2] - before[2]) / increments / mesh.modulus
            old, p = p, mesh.pressure(gap(x) + tilt * x, P, p)
            q, moved = mesh.step(q, friction * p, Q, strain)
            energy += float(mesh.h * 0.5 * friction * (old + p) @ np.abs(moved))
            slip = np.where(p > 0.0, slip + moved, 0.0)
            shift += float(moved[p > 0.0] @ _punch(mesh, p > 0.0))
        before = target
        found.append(State(p, q, slip, energy, shift))
    return found


def _punch(mesh: Mesh, touching: NDArray[np.bool_]) -> Array:
    """The shares of the elements in the load of a flat punch."""
    pressure: Array = np.linalg.solve(mesh.A[np.ix_(touching, touching)], np.ones(touching.sum()))
    return pressure / pressure.sum()
