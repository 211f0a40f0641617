"""The pressure on a known contact, from the slope of the profile there; the contact as a whole.

A polynomial, or a function that one Chebyshev series resolved in the search for the edges, takes
that series and its exact transform, any other slope exact integrals over its pieces.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from sie.numerics.interval import Interval
from sie.problem.request import ECONOMY
from sie.problem.scene import Scene
from sie.profiles.resolution import accuracy_for, refined
from sie.profiles.slope import Slope
from sie.traction.of_slope import SlopeDensity, TransformDensity
from sie.traction.on_panels import PanelDensity
from sie.traction.panels import Panels
from sie.traction.piece_quadrature import Geometry, SlidingGeometry

from .gap import gap
from .known_contact import Edges, Normal

Array = NDArray[np.float64]


def pressure(
    normal: Normal, scene: Scene, tol: float, economy: Collection[str] = ECONOMY
) -> SlopeDensity:
    """The pressure that solves (1) on the contact.

    It is a transform where the slope is smooth there, and exact panels elsewhere.
    """
    edges = normal.edges
    contact, G = edges.contact, 0.5 * scene.Estar
    common = (contact, G, edges.k1, edges.k2, edges.normal_load, edges.moment)
    if normal.series is not None:
        return TransformDensity(*common, normal.series)
    declared = normal.slope(scene.profile)
    if scene.epsilon:
        slope = refined(declared, contact.x1, contact.x2, accuracy_for(tol))
        geometry = SlidingGeometry(
            slope, contact, scene.epsilon, keep_zero="zero panels" not in economy
        )
        return PanelDensity(*common, Panels(geometry, edges.I0))
    if "transform" in economy:
        series = slope_series(declared, contact)
        if series is not None:
            if not any(edges.sharp):
                series[0] = 0.0  # the edges' condition, which quadrature met to rounding
            return TransformDensity(*common, series)
    slope = refined(declared, contact.x1, contact.x2, accuracy_for(tol))
    return PanelDensity(
        *common, Panels(Geometry(slope, contact, keep_zero="zero panels" not in economy), edges.I0)
    )


def slope_series(slope: Slope, contact: Interval) -> Array | None:
    """Chebyshev coefficients of H over the whole contact.

    None if a break lies inside, and for functions, of which pieces are resolved.
    """
    breaks = slope.break_points
    inner = bisect_right(breaks, contact.x1), bisect_left(breaks, contact.x2)
    if slope.functions or inner[0] < inner[1]:
        return None
    k = Geometry(slope, contact, keep_zero=True)
    return k.chebyshev_slope(max(int(slope.degrees[k.k[0]]) + 1, 2))[0] if len(k.k) == 1 else None


@dataclass(frozen=True, eq=False)
class OnePatch:
    """The contact `normal` of a scene's profile."""

    normal: Normal
    scene: Scene
    tol: float
    economy: Collection[str]

    @property
    def edges(self) -> Edges:
        return self.normal.edges

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        return (self.edges.contact[:2],)

    @cached_property
    def pressure(self) -> SlopeDensity:
        return pressure(self.normal, self.scene, self.tol, self.economy)

    @property
    def slope(self) -> Slope:
        return self.normal.slope(self.scene.profile)

    def gap(self, x: Array) -> Array:
        return gap(x, self.pressure, self.slope)

    def moved(
        self, contact: Interval, origin: tuple[float, float]
    ) -> tuple[SlopeDensity, Slope, Callable[[Array], Array]]:
        """Pressure, slope and gap by distances from an origin, from which the contact is given."""
        x, tail = origin
        density = self.pressure.moved(contact, -x, -tail)
        slope = self.slope.shifted(-x).shifted(-tail)
        return density, slope, partial(gap, density=density, slope=slope)
