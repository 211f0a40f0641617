"""The rates of a state of stick and slip, whatever its history.

The pressure's follow from those of P and the tilt on the patches; the shear's from them, Q and the
bulk stress on the stick zones (`potentials`). They give the coefficient K of 1/sqrt(distance) at
each end of a stick zone, and the rate of slip beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.chord import Chord

from .potentials import (
    Density,
    Frame,
    Given,
    Places,
    Potential,
    Zones,
    in_angle,
    pressure_rate,
    pressure_rate_of_moment,
    settled_series,
)

Array = NDArray[np.float64]
TESTED = np.linspace(0.0, 1.0, 26)[1:-1]  # angles in a slip zone where its direction is tested


@dataclass(frozen=True)
class Slip:
    """The rate of slip (E*/2) dg on one slip zone, and its sense: -1 or 1."""

    lo: float
    hi: float
    sense: float
    series: Array  # of the rate in 2v - 1, x = lo + (hi - lo) sin²(πv/2)

    @classmethod
    def fitted(cls, potential: Potential, lo: float, hi: float, sense: float) -> Slip:
        """The strain integrated from the stick end of the zone, or from the nearest one."""

        def stretched(s: Array) -> Array:
            x = in_angle(lo, hi, 0.5 * (1.0 + s))
            found: Array = potential.strain(x) * np.pi * np.sqrt(x.from_lo * x.from_hi)
            return found

        series = settled_series(stretched)
        rate = 0.5 * chebyshev.antiderivative(series)  # v runs over half of [-1, 1]
        rate[0] += _slip_at(potential, lo, hi, float(rate.sum()))
        return cls(lo, hi, sense, rate)

    def at(self, x: Places) -> Any:
        v = (2.0 / np.pi) * np.arctan2(np.sqrt(x.from_lo), np.sqrt(x.from_hi))
        return chebyshev.evaluate(self.series, 2.0 * v - 1.0)


def _slip_at(potential: Potential, lo: float, hi: float, across: float) -> float:
    """The rate of slip at the lower end of a zone."""
    ends = [e for pair in potential.frame.intervals for e in pair]
    if lo in ends:
        return 0.0
    if hi in ends:
        return -across
    below = [e for e in ends if e < lo]
    if below:
        return potential.between(max(below), lo)
    return -across - potential.between(hi, min(ends))


@dataclass(frozen=True)
class LoadRates:
    """Rates of P, Q and tau = sigma/4, and of eta = (E*/2) tilt, or of the moment about x = 0."""

    P: float = 0.0
    eta: float = 0.0
    Q: float = 0.0
    tau: float = 0.0
    moment: float | None = None  # None: the tilt is given


@dataclass(frozen=True)
class Rates:
    """The rates of a state of stick and slip, whatever its history."""

    edges: tuple[tuple[float, float], ...]
    slip: tuple[tuple[float, float, float], ...]  # (lo, hi, sense)
    friction: float
    pressure: Potential
    shear: Potential

    @classmethod
    def solved(
        cls,
        edges: Zones,
        stick: Zones,
        slip: Sequence[tuple[float, float, float]],
        loads: LoadRates,
        *,
        friction: float,
        period: float = np.inf,
    ) -> Rates:
        if loads.moment is None:
            pressure = pressure_rate(edges, loads.P, loads.eta, period)
        else:
            pressure = pressure_rate_of_moment(edges, loads.P, loads.moment)
        frame = Frame(tuple(stick), Chord(period))
        given = tuple(
            Given.fitted(frame, lo, hi, _times(s * friction, pressure.density))
            for lo, hi, s in slip
            if pressure.alpha.any() or pressure.B
        )
        shear = Potential.solved(frame, loads.Q, loads.tau, given)
        return cls(tuple(edges), tuple(slip), friction, pressure, shear)

    @property
    def K(self) -> Array:
        """K at the ends of the stick zones, (N, 2)."""
        return self.shear.K

    @property
    def Kp(self) -> Array:
        """K of the pressure at the edges of the patches, (M, 2)."""
        return self.pressure.K

    @cached_property
    def signed_K(self) -> Array:
        """The K of each end times the sense of slip beside it: an end recedes where it is positive.

        It is nan at an end that is an edge of the contact.
        """
        left = {lo: s for lo, _, s in self.slip}
        right = {hi: s for _, hi, s in self.slip}
        senses = [
            [right.get(a, np.nan), left.get(b, np.nan)] for a, b in self.shear.frame.intervals
        ]
        return self.K * np.array(senses)

    @cached_property
    def slips(self) -> tuple[Slip, ...]:
        return tuple(Slip.fitted(self.shear, *zone) for zone in self.slip)

    @cached_property
    def turning(self) -> float:
        """The smallest rate of slip in the direction of its zone over the largest one."""
        rates = [one.sense * one.at(in_angle(one.lo, one.hi, TESTED)) for one in self.slips]
        largest = max((float(np.abs(rate).max()) for rate in rates), default=0.0)
        return min(float(rate.min()) for rate in rates) / largest if largest else 0.0


def _times(factor: float, density: Density) -> Density:
    return lambda x: factor * density(x)
