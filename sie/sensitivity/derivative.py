"""The derivative of the answers of a solution by one number of its scene."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.errors import ContactError
from sie.profiles.base import Profile
from sie.stress.half_plane import Stress
from sie.traction.base import Density

from .parameters import change_by
from .rates import ShearRate, Zones, contact_rate, shear_rate

Array = NDArray[np.float64]
NODES = 14  # of the slope beside an edge
# relative: peaks closer than that are one of several, and so are their derivatives
SAME_PEAK = 1e-7


class OfPatches:
    """The moves of edges, (x1, x2) of each patch, and what follows from them."""

    def __init__(self, patches: Zones) -> None:
        self.patches = patches
        self.edges = self.left_edge, self.right_edge = patches[0][0], patches[-1][1]
        self.half_width = 0.5 * (self.right_edge - self.left_edge)
        self.centre = 0.5 * (self.left_edge + self.right_edge)
        self.contact_length = sum(x2 - x1 for x1, x2 in patches)


class Derivative(OfPatches):
    """The derivative of the answers of a solution by one number of its scene.

    `solution.derivative(name)` makes it, and says what a name is.

    Attributes
    ----------
    patches : tuple of (float, float)
        That of the patches as (x1, x2).
    edges : (float, float)
        That of the outermost two edges; `left_edge` and `right_edge` by themselves.
    half_width, centre, contact_length : float
        That of the half-width, of the centre and of the length of all patches.
    normal_load, moment, tilt : float
        That of the load, of its moment about x = 0, and of the tilt.
    pressure : Density
        That of the pressure at fixed x; infinite at an edge that moves.

    Notes
    -----
    The pressure is linear in h' on a given contact, and an edge that moves adds a square-root
    singularity. So the derivative of the pressure is infinite at edges; elsewhere it is as exact as
    the pressure (see the explanation of derivatives in the documentation).
    """

    def __init__(self, solution: Any, name: str | Profile) -> None:
        scene = solution.scene
        if scene.bonded or scene.coupled or scene.epsilon:
            raise ContactError(
                "derivatives are known where the shear leaves the pressure alone: give dundurs = 0 "
                "to neglect β, or friction = 0"
            )
        self.solution, self.name, self._by = solution, name, change_by(scene, name)
        self._contact = contact_rate(solution.normal, solution.pressure, scene.profile, self._by)
        super().__init__(self._contact.patches)
        self.normal_load, self.moment, self.tilt, self.pressure = self._contact[1:]

    def __repr__(self) -> str:
        return f"Derivative({self.name!r})"

    # -- answers -----------------------------------------------------------------------------------

    @cached_property
    def _shear(self) -> ShearRate:
        return shear_rate(self.solution, self._by, self._contact)

    @property
    def shear(self) -> Density:
        """That of the shear at fixed x, a `Density`. ContactError where it is one-sided."""
        return self._shear.shear

    @property
    def stick(self) -> Zones:
        """That of the stick zones as (lo, hi). ContactError where it is one-sided."""
        return self._shear.stick

    def stress(self, x: ArrayLike, y: ArrayLike) -> StressDerivative:
        """That of the stress at points of the body, whose places are those of `Solution.stress`.

        Returns
        -------
        StressDerivative
            Components, J2 and the von Mises stress, arrays of the broadcast shape.
        """
        return StressDerivative(self, x, y)

    @property
    def peak_pressure(self) -> float:
        """That of the largest pressure. ContactError where it is infinite."""
        return _common(self.pressure, peaks(self.solution))

    @property
    def elastic_limit(self) -> float:
        """That of the load P/k at first yield by von Mises' criterion, `YieldPoint.load`."""
        found = self.solution.elastic_limit()
        P, J = self.solution.normal_load, found.j2
        grown = _common(lambda place: self._j2(*place), found.places)
        return self.normal_load / math.sqrt(J) - 0.5 * P * grown / J**1.5

    @property
    def peak_tension(self) -> float:
        """That of the largest σ_xx on the surface, `Solution.peak_tension`."""
        value, x = self.solution.peak_tension()
        if not math.isfinite(value):
            raise ContactError("the largest tension is infinite, beside a corner of the indenter")
        return self._tension(x)

    def _j2(self, x: float, y: float) -> float:
        """That of the second invariant; at an edge, which moves, p = q = 0 and σ_xx alone acts."""
        d = self.stress(x, y)
        if y or not self._moved(x):
            return float(d.j2)
        xx, nu = self._tension(x), self.solution.tractions.known_poisson
        known = nu if self.solution.tractions.plane == "strain" else 0.0
        return float(d._invariant(xx, 0.0, 0.0, known * xx + d._poisson * d._stress.xx))

    def _moved(self, x: float) -> float:
        """The move of the edge at x; 0 where there is none, or it is held by a corner."""
        pairs = zip(self.solution.patches, self.patches, strict=True)
        moves = {edge: moved for ends, moving in pairs for edge, moved in zip(ends, moving)}
        return moves.get(x, 0.0)

    def _tension(self, x: float) -> float:
        """That of σ_xx on the surface at x; an edge that moves is followed, p = 0 there."""
        moved = self._moved(x)
        if not moved:
            return float(self.stress(x, 0.0).xx)
        grown = sum(c * _of_hilbert(density, x)[0] for c, density in self._shear.rates)
        along = sum(c * _of_hilbert(density, x)[1] for c, density in self._shear.terms)
        return self._by.bulk_stress - 2.0 * (grown + moved * along)


class StressDerivative:
    """The derivative of the stress at points of the body, computed as it is read.

    Parameters
    ----------
    derivative : Derivative
        The derivative of the solution.
    x, y : array_like of float
        As of `Solution.stress`.
    """

    def __init__(self, derivative: Derivative, x: ArrayLike, y: ArrayLike) -> None:
        solution, by = derivative.solution, derivative._by
        tractions = replace(
            solution.tractions,
            pressure=derivative.pressure,
            shear=derivative.shear,
            bulk_stress=by.bulk_stress,
        )
        self._grown, self._stress = Stress(tractions, x, y), solution.stress(x, y)
        self._poisson = by.poisson if tractions.plane == "strain" else 0.0

    @property
    def xx(self) -> Array:
        """That of σ_xx."""
        return self._grown.xx

    @property
    def yy(self) -> Array:
        """That of σ_yy."""
        return self._grown.yy

    @property
    def xy(self) -> Array:
        """That of σ_xy."""
        return self._grown.xy

    @property
    def zz(self) -> Array:
        """That of σ_zz."""
        return self._grown.zz + self._poisson * (self._stress.xx + self._stress.yy)

    @property
    def j2(self) -> Array:
        """That of the second invariant of the deviator."""
        return self._invariant(self.xx, self.yy, self.xy, self.zz)

    def _invariant(self, xx: Any, yy: Any, xy: Any, zz: Any) -> Array:
        """That of the second invariant by those of the components."""
        s = self._stress
        mean = (s.xx + s.yy + s.zz) / 3.0
        direct = (s.xx - mean) * xx + (s.yy - mean) * yy + (s.zz - mean) * zz
        return np.asarray(direct + 2.0 * s.xy * xy)

    @property
    def mises(self) -> Array:
        """That of the von Mises stress sqrt(3 J2)."""
        return np.asarray(1.5 * self.j2 / self._stress.mises)


def peaks(solution: Any) -> tuple[float, ...]:
    """The places of the largest pressure, to rounding. ContactError where it is infinite."""
    from sie.io.sample_points import peak  # noqa: PLC0415 -- where a peak is asked for

    largest, places = peak(solution)
    if math.isinf(largest):
        raise ContactError(
            "the largest pressure is infinite, under a corner of the profile: round the corner"
        )
    return places


def _common(function: Callable[[Any], Any], places: Any) -> float:
    """The value at all places, which have to agree: else the largest of several has a kink."""
    values = [float(function(place)) for place in places]
    if max(values) - min(values) > SAME_PEAK * max(map(abs, values)):
        raise ContactError(
            f"the largest value is reached at {len(places)} places that change unlike, where its "
            "derivative is one-sided: break the symmetry a little"
        )
    return values[0]


def _of_hilbert(density: Density, x: float) -> tuple[float, float]:
    """1/π PV∫ p/(x - t) dt at x, and its derivative by x; at an edge from inside, E*/2 h'."""
    if all(x not in base.interval for _, base in density.bases):
        return float(density.hilbert(x)), float(density.cauchy_derivative(x, side=0).real)
    breaks = np.array(density.breaks)
    length = np.min(np.abs(breaks[breaks != x] - x))
    inward = length if x == density.interval[0] else -length
    u = 0.5 - 0.5 * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    near = np.polynomial.Polynomial.fit(u, density.hilbert(x + inward * u), NODES - 1)
    return float(near(0.0)), float(near.deriv()(0.0)) / inward
