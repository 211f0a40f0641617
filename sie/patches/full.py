"""Full contact of a periodic profile, without edges.

Every harmonic A cos(kx + φ) of h gives the pressure -E*/2 k A cos(kx + φ). All of them together are
one patch per period whose two ends meet at a place e: with T = d(x, e), G = E*/2

    (G/π) T D = p(x) - p(e),   T/(d(t, x) d(t, e)) = (π/λ) [cot(π(t - x)/λ) - cot(π(t - e)/λ)]

and a gap s between those ends changes a part s² of that far away. What is left is a constant, by
the load. Two such patches, with their ends at different places, serve all others. Full contact is
the answer if p >= 0, which is verified by bounds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.contact.known_contact import Edges
from sie.numerics import chebyshev
from sie.numerics.chord import Chord, Points
from sie.numerics.graded_panels import Rule as GradedRule
from sie.numerics.interval import EPS, Interval
from sie.profiles.pieces import Pieces
from sie.traction.base import Density, refuse_side

from .bounds import TENSION
from .density import PatchPressure
from .operator import Operator
from .panels import DEEPEST, NODES, Patches, halves
from .result import CLOSE, LEAST, PatchCertificate
from .rule import Rule, principal_value

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

FEWEST = 8  # panels on which p is bounded
APART = 0.25  # of a period: the least distance of the places where the ends of patches meet
SLIT = 1e-9  # periods: the gap there, of which the square counts
CLOSED = 1e-12  # periods: a gap at a concave corner that is no wider is taken for none
# of the period: a break within rounding of an even cut leaves a panel without places between nodes
NARROWEST = 1e-10
PLACES, MIDWAY = 100, 0.443  # where the equation is measured, at this part of a panel
CLEARLY = 4.0  # of the mean: so much tension on a grid rules full contact out
CLOSE_BELOW = 0.9  # of the least pressure that was seen: a bound that is good enough
OPENING = "note: full contact is about to end: a gap opens where the load falls by {:.0e} of it"


@dataclass(frozen=True, eq=False)
class FullPressure(Density):
    """The pressure of full contact on [start, start + period], repeated.

    The load is per period; half_modulus is E*/2.
    """

    pieces: Pieces
    start: float
    period: float
    half_modulus: float
    load: float

    @property
    def interval(self) -> tuple[float, float]:
        return self.start, self.start + self.period

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        return (self.interval,)

    @property
    def loads(self) -> tuple[float, ...]:
        return (self.load,)

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return self.load

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        """∫p x dx over the period that begins at `start`."""
        x = self.rule.points.x
        turns = np.floor((x - self.start) / self.period)
        return float((self.rule.weight * self.at_rule) @ (x - self.period * turns))

    @cached_property
    def panels(self) -> tuple[Array, Array]:
        """The ends of panels on which p is smooth, (p,) and (p,)."""
        cuts, (lo, hi) = self.pieces.cuts, self.interval
        ends = np.union1d(np.linspace(lo, hi, FEWEST + 1), cuts[(cuts > lo) & (cuts < hi)])
        return ends[:-1], ends[1:]

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        return (*self.panels[0].tolist(), self.interval[1])

    @property
    def mean(self) -> float:
        return self.load / self.period

    # -- two patches whose ends meet ---------------------------------------------------------------

    @cached_property
    def parts(self) -> tuple[PatchPressure, PatchPressure]:
        """The patches, whose ends meet on the widest panel, and on another one away from that."""
        lo, hi = self.panels
        middle, chord = 0.5 * (lo + hi), Chord(self.period)
        first = middle[np.argmax(hi - lo)]
        away = np.abs(chord.difference(middle - first)) >= APART * self.period
        second = middle[np.argmax(np.where(away, hi - lo, 0.0))]
        one, other = (
            PatchPressure(o, self.half_modulus, 0.0, self.half_modulus * o.resultants(0.0)[0])
            for o in (self._slit(float(end), SLIT) for end in (first, second))
        )
        return one, other

    def _slit(self, end: float, width: float) -> Operator:
        """One patch whose ends meet at a place but for a part of the size of its places."""
        patch = end, end + self.period - width * (abs(end) + self.period)
        return Operator(Patches.of((patch,), Chord(self.period)), self.pieces, np.zeros(2))

    def _by_parts(self, value: Callable[[PatchPressure, Any], Any], z: Any) -> Any:
        """The values at z of that part whose ends meet farther away."""
        chord, out = Chord(self.period), np.empty(z.shape, dtype=complex)
        first, second = (
            np.abs(chord.difference(np.real(z) - part.interval[0])) for part in self.parts
        )
        for part, some in zip(self.parts, (~(first < second), first < second), strict=True):
            if some.any():
                out[some] = value(part, z[some])
        return out

    def _shift(self, part: PatchPressure) -> float:
        return (self.load - part.load) / self.period

    def __call__(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        shifted = self._by_parts(lambda part, at: part(at) + self._shift(part), x).real
        return np.asarray(np.where(np.isinf(x), 0.0, shifted))

    def hilbert(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        return np.asarray(self._by_parts(lambda part, at: part.hilbert(at), x).real)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        refuse_side(side)

        def shifted(part: PatchPressure, at: Complex) -> Complex:
            above = np.where(at.imag == 0.0, side, np.sign(at.imag))
            return part.cauchy(at, side) - 1j * above * self._shift(part)

        return np.asarray(self._by_parts(shifted, arguments.complexes("z", z)))

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        refuse_side(side)
        if self.steepness is not None:
            return self.steepness.cauchy(z, side)
        z = arguments.complexes("z", z)
        return np.asarray(self._by_parts(lambda part, at: part.cauchy_derivative(at, side), z))

    @cached_property
    def steepness(self) -> FullPressure | None:
        """p', the pressure by the slope H'; None where H jumps, and p is infinite."""
        lo, hi = self.interval
        if self.pieces.jump_within(np.array([lo - EPS * self.period]), np.array([hi])).any():
            return None
        return replace(self, pieces=self.pieces.derivative, load=0.0)

    # -- the certificate ---------------------------------------------------------------------------

    @cached_property
    def rules(self) -> tuple[Rule, Rule]:
        """A composite rule over a period, and places between its points.

        Both count from the ends of the panels: next to a jump of H, p is that of the exact place.
        """
        lo, hi = self.panels
        every = GradedRule.graded(np.stack((lo, hi), axis=1))
        wide = np.flatnonzero(hi - lo > NARROWEST * self.period)
        some = wide[:: max(len(wide) // PLACES, 1)]
        between = lo[some] + MIDWAY * (hi - lo)[some]
        return self._ruled(every.x, every.weight), self._ruled(between, np.zeros(len(some)))

    def _ruled(self, x: Array, weight: Array) -> Rule:
        piece = self.pieces.locate(x)
        return Rule(Points(x, np.zeros(len(x))), np.zeros(len(x), dtype=int), piece, weight)

    @property
    def rule(self) -> Rule:
        return self.rules[0]

    @cached_property
    def at_rule(self) -> Array:
        """p on the rule; 0 on a jump of H, where the weight is rounding."""
        p = self(self.rule.points.x)
        return np.where(np.isfinite(p), p, 0.0)

    @cached_property
    def lowest(self) -> float:
        """A lower bound of p over its mean, not far below the least; negative where p is."""
        seen = self._lowest_on_a_grid()
        if seen < -CLEARLY:
            return seen
        (lo, hi), lowest, least = self.panels, np.inf, np.inf
        g, _ = chebyshev.gauss_legendre(NODES)
        for _ in range(DEEPEST):
            p = self(lo[:, None] + (hi - lo)[:, None] * g)
            if (p < -TENSION * self.mean).any():
                return float(p.min()) / self.mean
            bound, least = chebyshev.lower_bound(p), min(least, float(p.min()))
            enough = bound >= CLOSE_BELOW * least - TENSION * self.mean
            lowest = min(lowest, float(bound[enough].min(initial=np.inf)))
            if enough.all():
                break
            lo, hi = halves(lo[~enough], hi[~enough])
        return lowest / self.mean

    def _lowest_on_a_grid(self) -> float:
        """The same, about: that on a uniform grid, on which H has its conjugate by FFT."""
        n = 1 << len(self.panels[0]).bit_length()
        x = np.asarray(self.start + (self.period / n) * np.arange(n), dtype=float)
        conjugate = np.fft.irfft(1j * np.fft.rfft(self.pieces(x)), n)
        return 1.0 + self.half_modulus * float(conjugate.min()) / self.mean


@dataclass(frozen=True, eq=False)
class FullContact:
    """Contact everywhere, as the answer to a scene."""

    edges: Edges
    pressure: FullPressure
    symmetric: bool = False
    gap_volume: float = 0.0
    found: None = None  # no edges are sought

    def slope(self, profile: Any) -> Any:
        return profile.pieces

    @property
    def patches(self) -> tuple[tuple[float, float], ...]:
        return self.pressure.patches

    @property
    def moment(self) -> float:
        return self.pressure.moment

    def gap(self, x: Array) -> Array:
        """No gap anywhere."""
        return np.where(np.isnan(x), np.nan, 0.0)

    def certificate(self, tol: float) -> PatchCertificate:
        """The residual of (1) by a rule over the period, and the equilibrium."""
        pressure, G = self.pressure, self.pressure.half_modulus
        (rule, at), p, x = pressure.rules, pressure.at_rule, pressure.rules[1].points
        period = Patches.of(pressure.patches, Chord(pressure.period))
        total = principal_value(period, rule, p, (x, at.patch), pressure(x.x))
        residual = np.abs(total - G * pressure.pieces.value(at.piece, x.anchor, x.offset)).max()
        condition = 1.0 / max(pressure.lowest, TENSION)
        return PatchCertificate(
            residual=float(residual) / float(p.max()),
            force=abs(float(rule.weight @ p) - pressure.load) / pressure.load,
            moment=0.0,
            lowest_pressure=min(pressure.lowest, 0.0),
            patches=1,
            condition=condition,
            measured_to=LEAST,
            tol=tol,
            notes=() if condition < CLOSE else (OPENING.format(1.0 / condition),),
        )


def full_contact(
    pieces: Pieces, start: float, period: float, half_modulus: float, load: float
) -> FullContact | None:
    """Full contact, if p >= 0 everywhere."""
    inside = pieces.void & (pieces.breaks[:-1] < start + period) & (pieces.breaks[1:] > start)
    if inside.any():
        return None
    pressure = FullPressure(pieces, start, period, half_modulus, load)
    if not pressure.lowest >= -TENSION:
        return None
    # a concave corner opens always, but what doubles do not tell from none
    corners = pieces.never_closed
    corners = corners[(corners >= start) & (corners <= start + period)]
    if (pressure(np.append(corners - CLOSED * period, corners + CLOSED * period)) < 0.0).any():
        return None
    contact, level = Interval(start, start + period), (False, False)
    edges = Edges(contact, load, np.nan, 0.0, level, 0.0, 0.0, 0.0, 0)
    return FullContact(edges, pressure)
