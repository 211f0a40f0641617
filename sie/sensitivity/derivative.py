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

from .contact_rate import ContactRate, Given, contact_rate
from .parameters import Parameter, parameter
from .shear_rate import ShearRate, shear_rate

Array = NDArray[np.float64]
NODES = 14  # of the slope beside an edge
BESIDE = 1e-6  # half-widths about a summit of p, where its place is found by p'
ZOOMS, ZOOM_PLACES = 4, 24
SAME_PEAK = (
    1e-7  # relative: peaks closer than that are one of several, and so are their derivatives
)


class Derivative:
    """The derivative of the answers of a solution by one number of its scene.

    `solution.derivative(name)` makes it. Every answer is that of the solution over that of the
    number, computed when it is read.

    Parameters
    ----------
    solution : Solution
        The solution.
    name : str or Profile
        As of `Solution.derivative`.

    Raises
    ------
    ValueError
        For a name that is no number of the scene.
    ContactError
        For bodies whose shear acts on the pressure; by any answer, where derivatives are one-sided.

    Notes
    -----
    The pressure is linear in h' on a given contact, and an edge that moves adds a square-root
    singularity. So the derivative of the pressure is infinite at edges; elsewhere it is as exact as
    the pressure (see the explanation of derivatives in the documentation).

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.RoundedFlat(1.0, 1.0), modulus=1.0, normal_load=1.0)
    >>> round(sie.solve(scene).derivative("profile.radius").half_width, 10)
    0.5240149793
    """

    def __init__(self, solution: Any, name: str | Profile) -> None:
        scene = solution.scene
        if scene.bonded or scene.coupled or scene.epsilon:
            raise ContactError(
                "derivatives are known where the shear leaves the pressure alone: give dundurs = 0 "
                "to neglect β, or friction = 0"
            )
        self.solution, self.name = solution, name
        self._by: Parameter = parameter(scene, name)

    def __repr__(self) -> str:
        return f"Derivative({self.name!r})"

    @cached_property
    def _contact(self) -> ContactRate:
        scene, normal = self.solution.scene, self.solution.normal
        given = Given(scene.half_width is not None, scene.moment is not None)
        p = self.solution.pressure
        return contact_rate(normal, p, scene.profile, self._by.contact, given)

    @cached_property
    def _shear(self) -> ShearRate:
        return shear_rate(self.solution, self._by, self._contact)

    # -- answers -----------------------------------------------------------------------------------

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        """That of the patches as (x1, x2)."""
        return self._contact.patches

    @property
    def edges(self) -> tuple[float, float]:
        """That of the outermost two edges."""
        return self.patches[0][0], self.patches[-1][1]

    @property
    def half_width(self) -> float:
        """That of the half-width."""
        return 0.5 * (self.edges[1] - self.edges[0])

    @property
    def centre(self) -> float:
        """That of the centre."""
        return 0.5 * (self.edges[0] + self.edges[1])

    @property
    def contact_length(self) -> float:
        """That of the length of all patches."""
        return sum(x2 - x1 for x1, x2 in self.patches)

    @property
    def normal_load(self) -> float:
        """That of the normal load."""
        return self._contact.load

    @property
    def moment(self) -> float:
        """That of the moment about x = 0."""
        return self._contact.moment

    @property
    def tilt(self) -> float:
        """That of the tilt."""
        return self._contact.tilt

    @property
    def pressure(self) -> Density:
        """That of the pressure at fixed x, a `Density`; infinite at an edge that moves."""
        return self._contact.pressure

    @property
    def shear(self) -> Density:
        """That of the shear at fixed x, a `Density`."""
        return self._shear.shear

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """That of the stick zones as (lo, hi)."""
        return self._shear.stick

    def stress(self, x: ArrayLike, y: ArrayLike) -> StressDerivative:
        """That of the stress at points of the body.

        Parameters
        ----------
        x, y : array_like of float
            Positions and depths, y >= 0, length. They are broadcast against each other.

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

    def _j2(self, x: float, y: float) -> float:
        """That of the second invariant; at an edge, which moves, p = q = 0 and σ_xx alone acts."""
        moved = self._moved(x)
        if y or not moved:
            return float(self.stress(x, y).j2)
        s = self.solution.stress(x, 0.0)
        return float(2.0 * s.j2 / s.xx) * self._tension_at_edge(x, moved) + self._of_poisson(s)

    def _of_poisson(self, s: Stress) -> float:
        t = self.solution.tractions
        if t.plane == "stress" or not self._by.poisson:
            return 0.0
        return float(s.xx**2) * (2.0 * t.known_poisson - 1.0) / 3.0 * self._by.poisson

    def _moved(self, x: float) -> float:
        """The move of the edge at x; 0 where there is none, or it is held by a corner."""
        pairs = zip(self.solution.patches, self.patches, strict=True)
        moves = {edge: moved for ends, moving in pairs for edge, moved in zip(ends, moving)}
        return moves.get(x, 0.0)

    def _tension_at_edge(self, x: float, moved: float) -> float:
        return self._by.bulk_stress - 2.0 * _of_hilbert(self._shear, x, moved)

    @property
    def peak_tension(self) -> float:
        """That of the largest σ_xx on the surface, `Solution.peak_tension`."""
        value, x = self.solution.peak_tension()
        if not math.isfinite(value):
            raise ContactError("the largest tension is infinite, beside a corner of the indenter")
        moved = self._moved(x)
        return self._tension_at_edge(x, moved) if moved else float(self.stress(x, 0.0).xx)


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
        s, d = self._stress, self
        mean = (s.xx + s.yy + s.zz) / 3.0
        direct = (s.xx - mean) * d.xx + (s.yy - mean) * d.yy + (s.zz - mean) * d.zz
        return np.asarray(direct + 2.0 * s.xy * d.xy)

    @property
    def mises(self) -> Array:
        """That of the von Mises stress sqrt(3 J2)."""
        return np.asarray(1.5 * self.j2 / self._stress.mises)


def peaks(solution: Any) -> list[float]:
    """The places of the largest pressure, to rounding. ContactError where it is infinite."""
    from sie.io.sample_points import peak  # noqa: PLC0415 -- a higher layer

    largest, places = peak(solution)
    if math.isinf(largest):
        raise ContactError(
            "the largest pressure is infinite, under a corner of the profile: round the corner"
        )
    return [_summit(solution.pressure, x, solution.half_width) for x in places]


def _summit(p: Density, x: float, r: float) -> float:
    """The zero of p' next to x, which values of p tell to the root of rounding only."""
    lo, hi = x - BESIDE * r, x + BESIDE * r
    for _ in range(ZOOMS):
        near = np.linspace(lo, hi, ZOOM_PLACES)
        rises = p.cauchy_derivative(near).imag < 0.0  # F' = hilbert' - i p'
        if rises[-1] or not rises[0]:
            return x
        k = int(np.flatnonzero(rises)[-1])
        lo, hi = float(near[k]), float(near[k + 1])
    return 0.5 * (lo + hi)


def _common(function: Callable[[Any], Any], places: Any) -> float:
    """The value at all places, which have to agree: else the largest of several has a kink."""
    values = [float(function(place)) for place in places]
    if max(values) - min(values) > SAME_PEAK * max(map(abs, values)):
        raise ContactError(
            f"the largest value is reached at {len(places)} places that change unlike, where its "
            "derivative is one-sided: break the symmetry a little"
        )
    return values[0]


def _of_hilbert(shear: ShearRate, x: float, moved: float) -> float:
    """That of 1/π PV∫ q/(x - t) dt at an edge x that moves."""
    grown = sum(c * _at_edge(density, x) for c, density in shear.rates)
    return grown + moved * sum(c * _steepness(density, x) for c, density in shear.terms)


def _at_edge(density: Density, x: float) -> float:
    """The principal value at x, from inside where x is an edge."""
    return sum(
        c
        * (
            base.hilbert_at_edges[base.interval.index(x)]
            if x in base.interval
            else float(base.hilbert(x))
        )
        for c, base in density.bases
    )


def _steepness(density: Density, x: float) -> float:
    """The derivative of the principal value at x; at an edge that of E*/2 h', from inside."""
    if x not in density.interval:
        return float(density.cauchy_derivative(x, side=0).real)
    breaks = np.array(density.breaks)
    length = np.min(np.abs(breaks[breaks != x] - x))
    inward = length if x == density.interval[0] else -length
    u = 0.5 - 0.5 * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    near = np.polynomial.Polynomial.fit(u, density.hilbert(x + inward * u), NODES - 1)
    return float(near.deriv()(0.0)) / inward
