"""The validity of half-plane elasticity: small slopes and small pressures.

Linear elasticity on the undeformed half-plane needs small strains. These are of the order of the
slope, and of p/E*. Beyond, an answer satisfies the equations but does not describe the bodies.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import inner
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity

Array = NDArray[np.float64]

STEEPEST = 0.2  # slope in the contact
HIGHEST = 0.25  # peak pressure over E*
BESIDE = 1e-3  # of the half-width: nearer to where it is infinite the pressure is not tested


def notes(slopes: Array, pressure: float) -> tuple[str, ...]:
    """Sentences on slopes in the contact, and on a pressure over E*, that are not small."""
    outside = "half-plane elasticity (small strains) is outside its range"
    steepest = float(np.abs(slopes[np.isfinite(slopes)]).max(initial=0.0))
    said = []
    if steepest > STEEPEST:
        said.append(
            f"note: the slope in the contact reaches {steepest:.3g}; above {STEEPEST:g} {outside}"
        )
    if pressure > HIGHEST:
        said.append(f"note: the pressure reaches {pressure:.3g} E*; above E*/4 {outside}")
    return tuple(said)


def regular_points(density: SlopeDensity, slope: Slope, x: Array) -> NDArray[np.bool_]:
    """Whether each x is away from sharp edges and corners, where the pressure is infinite."""
    contact = density.contact
    infinite = [
        edge for edge, k in zip(density.interval, (density.k1, density.k2), strict=True) if k
    ]
    if not slope.continuous:
        breaks = inner(contact, slope.breaks)
        infinite += breaks[np.isinf(density(breaks))].tolist()
    places = np.array([-np.inf, *sorted(infinite), np.inf])
    k = np.searchsorted(places, x, side="right").clip(1, len(places) - 1)
    regular: NDArray[np.bool_] = np.minimum(x - places[k - 1], places[k] - x) > BESIDE * contact.r
    return regular
