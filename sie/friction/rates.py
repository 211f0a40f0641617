"""The rates of a state of stick and slip, whatever its history.

    pressure    on the patches            A = dP, B = (E*/2) d tilt      nothing is given
    shear       on the stick zones        A = dQ, B = dτ                 s f dp in the slip zones

They are potentials whose poles are unknown (`potentials`). A rate is like K/sqrt(distance) at an
end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override
from sie.numerics.chord import Chord
from sie.numerics.graded_panels import Rule
from sie.numerics.zones import Slips, Zones

from .potentials import Potential, RelativeSlip

if TYPE_CHECKING:
    from .equations import Equations

Array = NDArray[np.float64]
# angles in a slip zone where its direction is tested
TESTED = np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, 26)[1:-1]) ** 2


@dataclass(frozen=True)
class LoadRates:
    """Rates of P, Q and tau = sigma/4, and of eta = (E*/2) tilt, or of the moment about x = 0."""

    P: float = 0.0
    eta: float = 0.0
    Q: float = 0.0
    tau: float = 0.0
    moment: float | None = None  # None: the tilt is given


@dataclass(frozen=True, eq=False)
class Rate(Potential):
    """The rate of a density on zones.

    zones    those on which it is unknown
    A, B     its resultant, and the strain on the zones
    slip     the slip zones, and
    given    the rate there in the direction of slip
    beyond   where that is infinite
    rough    no, where slip is integrated over the gap to a patch that slides, next to its data
    """

    zones: Zones
    period: float
    A: float
    B: float
    slip: Slips = ()
    given: Callable[[Rule], Array] = lambda places: np.zeros_like(places.lo)
    beyond: Zones = ()
    rough: bool = False

    @cached_property
    def stick(self) -> Array:
        return np.array(self.zones, dtype=float).reshape(-1, 2)

    @property
    def chord(self) -> Chord:
        return Chord(self.period)

    @cached_property
    def sources(self) -> Array:
        return np.array([zone[:2] for zone in self.slip]).reshape(-1, 2)

    @cached_property
    def change(self) -> Array:
        parts = [self.known(self.rule.part(n)[1], s) for n, (*_, s) in enumerate(self.slip)]
        return np.concatenate([*parts, np.zeros(0)])

    def known(self, places: Rule, sense: float) -> Array:
        return sense * self.given(places)

    @property
    @override
    def singular(self) -> Array:
        return np.append(self.stick, self.beyond)

    @cached_property
    def poles(self) -> Array:
        matrix = self.by_poles
        if not np.isfinite(matrix).all():  # zones touch, as where slip begins between them
            return np.full(len(matrix), np.nan)
        return np.asarray(np.linalg.solve(matrix, -self.missed(self.A, self.B)))

    @cached_property
    def K(self) -> Array:
        """The density's coefficient of 1/sqrt(distance) at each end, (N, 2)."""
        d, N = self.chord, len(self.stick)
        found = self.poles.reshape(N, 2) * [-1.0, 1.0]
        for k, (a, b) in enumerate(self.stick):
            others = np.arange(N) != k
            lo, hi = self.stick[others].T
            for side, e in enumerate((a, b)):
                ratios = d(e - lo) * d(e - hi) / d(e - self.centres[others]) ** 2
                found[k, side] *= np.sqrt(d(b - a) * np.prod(ratios))
        return np.asarray(found)

    def density(self, places: Rule) -> Array:
        """The density at places in the zones."""
        found = np.zeros(len(places.lo))
        zones = np.searchsorted(self.stick[:, 0], 0.5 * (places.lo + places.hi), "right") - 1
        for k in np.unique(zones):
            found[zones == k] = self.in_stick(int(k), places.among(zones == k))
        return found

    @property
    def moment(self) -> float:
        """∫ x ρ dx on the line where nothing is given, from F at infinity."""
        first = self.centres[0]
        poles, apart = self.poles * self.scales[0], self.stick.ravel() - first
        squares = float(np.sum((0.5 * np.diff(self.stick, axis=1)) ** 2))
        return float(np.pi * (poles @ apart**2 + 0.5 * self.B * squares) + first * self.A)


@dataclass(frozen=True)
class Rates:
    """The rates of a state of stick and slip."""

    edges: Zones
    friction: float
    pressure: Rate
    shear: Rate

    @classmethod
    def solved(
        cls,
        edges: Zones,
        stick: Zones,
        slip: Slips,
        loads: LoadRates,
        *,
        friction: float,
        period: float = np.inf,
    ) -> Rates:
        pressure = Rate(edges, period, loads.P, loads.eta)
        if loads.moment is not None:
            load, turn = Rate(edges, period, loads.P, 0.0), Rate(edges, period, 0.0, 1.0)
            tilt = (loads.moment - load.moment) / turn.moment
            pressure = Rate(edges, period, loads.P, tilt)

        def limit(places: Rule) -> Array:
            changes = pressure.A or pressure.B
            return friction * pressure.density(places) if changes else np.zeros_like(places.lo)

        shear = Rate(stick, period, loads.Q, loads.tau, tuple(slip), limit, edges, len(edges) == 1)
        return cls(edges, friction, pressure, shear)

    @classmethod
    def where(cls, now: Equations, loads: LoadRates, friction: float) -> Rates:
        """The rates where equations are solved."""
        patches, stick, period = now.after.patches, now.zones.stick, now.after.period
        return cls.solved(patches, stick, now.slip, loads, friction=friction, period=period)

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
        left = {lo: s for lo, _, s in self.shear.slip}
        right = {hi: s for _, hi, s in self.shear.slip}
        senses = [[right.get(a, np.nan), left.get(b, np.nan)] for a, b in self.shear.zones]
        return self.K * np.array(senses)

    @cached_property
    def slips(self) -> Array:
        """The rates of slip in the direction of each slip zone, at TESTED, (zones, places)."""
        slips = RelativeSlip(self.shear)
        rates = [s * slips.at(lo + (hi - lo) * TESTED) for lo, hi, s in self.shear.slip]
        return np.array(rates).reshape(-1, len(TESTED))

    @property
    def turning(self) -> float:
        """The smallest rate of slip in the direction of its zone over the largest one."""
        largest = float(np.abs(self.slips).max(initial=0.0))
        return float(self.slips.min()) / largest if largest else 0.0
