"""The first-yield load of a body, and the largest tension on its surface.

    von Mises   J2 = ½ s:s = |D|² + (s - σ_zz)²/3 = k²               (k: yield stress in shear)
    Tresca      max( |D|, (|D| + |s - σ_zz|)/2 ) = k

with s and D of `half_plane`. Stresses grow in proportion to the load in a contact of given edges
(stiffer bodies under more load), so that one solution gives P/k = P/√J2; charts show P/(bk). The
largest J2 may be reached twice (either side of the centre, for a/b > 0.1277 of the frictionless
rounded punch), in a flat valley, or jump to the surface as friction grows: `peak_search` finds all,
and ties are kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie import arguments
from sie.errors import ContactError

from .half_plane import Stress, Tractions
from .peak_search import largest
from .scan_columns import mesh_of
from .surface_peaks import Maximum, Measure, on_surface, surface_values

Array = NDArray[np.float64]
Criterion = Literal["mises", "tresca"]
CRITERIA = ("mises", "tresca")


@dataclass(frozen=True)
class YieldPoint:
    """The place where a body yields first, and the load.

    Parameters
    ----------
    load : float
        P/k, length: times the yield stress in shear k it is the load under which a contact of these
        edges begins to yield.
    x, y : float
        Position and depth, length; of several places the leftmost. y = 0 is the surface.
    j2 : float
        Second invariant of the stress deviator there, stress², under the load of the solution.
    stress : float
        √J2 (von Mises) or the largest shear stress (Tresca), which the criterion compares with k.
    half_width : float
        Half-width b of the contact, length.
    places : tuple of tuple of float
        All places (x, y) where the largest value is reached.
    criterion : {"mises", "tresca"}
        Yield criterion.
    """

    load: float
    x: float
    y: float
    j2: float
    stress: float
    half_width: float
    places: tuple[tuple[float, float], ...]
    criterion: Criterion = "mises"

    @property
    def ratio(self) -> float:
        """P/(bk), the ordinate of the charts."""
        return self.load / self.half_width

    @property
    def on_surface(self) -> bool:
        """Whether the body yields first on its surface."""
        return self.y == 0.0


class Peak(NamedTuple):
    """The largest tension on the surface, and where it is.

    Parameters
    ----------
    value : float
        σ_xx, stress.
    x : float
        Position, length.
    """

    value: float
    x: float


def refuse_unknown_criterion(criterion: object) -> None:
    """Raises ValueError unless a criterion is one of CRITERIA."""
    if not arguments.among(criterion, CRITERIA):
        raise ValueError(f'criterion = "{criterion}" is not known: give "mises" or "tresca"')


def elastic_limit(
    tractions: Tractions, normal_load: float, criterion: Criterion = "mises"
) -> YieldPoint:
    """The yield point of a body under these tractions.

    ValueError without Poisson's ratio, ContactError for an incompressible body under a corner.
    """
    kappa, marks = tractions.out_of_plane, tractions.marks
    infinite = marks[np.isinf(tractions.pressure(marks))]
    if kappa == 0.0 and infinite.size:
        raise ContactError(
            f"the pressure is infinite at x = {infinite[0]:.6g}, where the stress that an "
            "incompressible body (poisson = 0.5) yields by depends on the direction: round the "
            "corner, or give poisson = 0.499"
        )
    found: list[tuple[float, tuple[Maximum, ...]]] = []
    if criterion == "mises":
        maxima = largest(tractions, _quadratic(kappa / np.sqrt(3.0)))
        found.append((float(np.sqrt(maxima[0].value)), maxima))
    else:
        in_plane = largest(tractions, _quadratic(0.0))
        across = largest(tractions, _sum_of_shears(kappa))
        found += [(float(np.sqrt(in_plane[0].value)), in_plane), (0.5 * across[0].value, across)]
    stress, maxima = max(found, key=lambda f: f[0])
    x1, x2 = tractions.pressure.interval
    x, y = maxima[0].x, maxima[0].y
    j2 = stress * stress if criterion == "mises" or not kappa else float(Stress(tractions, x, y).j2)
    places = tuple((m.x, m.y) for m in maxima)
    return YieldPoint(normal_load / stress, x, y, j2, stress, 0.5 * (x2 - x1), places, criterion)


def peak_tension(tractions: Tractions) -> Peak:
    """The largest σ_xx on the surface and its place; inf beside a sharp edge.

    It is infinite where the shear traction at that edge pulls the surface away from it.

    Where σ_xx exceeds a compressive bulk stress nowhere, the value is the bulk stress, the limit
    far away, and x is the farthest place that was examined.
    """
    for edge, x, outward in zip(
        tractions.shear.interval, tractions.shear.interval, (1.0, -1.0), strict=True
    ):
        q = float(tractions.shear(np.array([edge]))[0])
        if q * outward == np.inf:
            return Peak(np.inf, x)
    mesh = mesh_of(tractions)
    found = on_surface(tractions, _tension(), mesh, surface_values(tractions, mesh.surface))
    best = max(m.value for m in found)
    middle = 0.5 * sum(tractions.pressure.interval)
    # Without a tension, σ_xx is the same on the whole free surface
    x = min((m.x for m in found if m.value == best), key=lambda x: abs(x - middle))
    return Peak(max(best, tractions.bulk_stress) + 0.0, x)


# -- measures of the stress, as functions of v = (s, D_r, D_i) -------------------------------------


def _quadratic(factor: float) -> Measure:
    """|D|² + (factor s)²; J2 for factor = (1 - 2ν)/√3."""
    weights = np.array([factor * factor, 1.0, 1.0])

    def hessian(v: Array) -> Array:
        H = np.zeros((3, 3, *v.shape[1:]))
        for i in range(3):
            H[i, i] = 2.0 * weights[i]
        return H

    used = slice(None) if factor else slice(1, None)  # s may be infinite
    return Measure(
        lambda v: np.tensordot(weights[used], v[used] * v[used], 1),
        lambda v: 2.0 * weights.reshape(3, *[1] * (v.ndim - 1)) * v,
        hessian,
    )


def _sum_of_shears(kappa: float) -> Measure:
    """|D| + κ|s|, twice the shear stress between the in-plane and the out-of-plane direction."""

    def parts(v: Array) -> tuple[Any, Any]:
        d = np.hypot(v[1], v[2])
        return d, np.stack((np.zeros_like(d), v[1], v[2])) / np.maximum(d, 1e-300)

    def value(v: Array) -> Array:
        d: Array = np.hypot(v[1], v[2])
        return d + kappa * np.abs(v[0]) if kappa else d

    def gradient(v: Array) -> Array:
        n: Array = parts(v)[1]
        n[0] = kappa * np.sign(v[0])
        return n

    def hessian(v: Array) -> Array:
        d, n = parts(v)
        H = -np.einsum("i...,j...->ij...", n, n)
        H[1, 1] += 1.0
        H[2, 2] += 1.0
        return H / np.maximum(d, 1e-300)

    return Measure(value, gradient, hessian)


def _tension() -> Measure:
    """σ_xx = s - D_r, linear."""
    direction = np.array([1.0, -1.0, 0.0])
    return Measure(
        lambda v: v[0] - v[1],
        lambda v: np.broadcast_to(direction.reshape(3, *[1] * (v.ndim - 1)), v.shape),
        lambda v: np.zeros((3, 3, *v.shape[1:])),
    )
