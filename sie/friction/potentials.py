"""The potential of a shear or a pressure that is unknown on zones and known beside them.

On zones [a_k, b_k], k = 1...N, of centres μ_k, a density has 1/π PV∫ ρ(t)/(x - t) dt = B; beside
them ρ is given. With d the chord of a period, or the difference of two places, and

    T_k(z) = d(z, μ_k) Π_i [d(z, a_i) d(z, b_i)/d(z, μ_i)²]^(1/2)
    F(z)   = B + T_k(z) Ψ_k(z),   Ψ_k(z) = 1/π ∫ dν_k(t)/d(z, t),   dν_k = ρ/T_k dt; any k

the conditions of balance, ∫ρ dt = A, and one rigid shift of all zones are 2N equations

    Σ cos(t - μ_k) dν_k = -π B for each k,      Σ d(t, μ_k) dν_k = A
    PV∫ T_k Ψ_k dx = 0 over each gap between neighbouring zones

The integral over a gap is a series in the place of a charge (`Gap`). On zone k the density is
-|T_k| Re Ψ_k, beside the zones Re F - B is the strain (Muskhelishvili 1953, chapter 11).

A pole y_e at an end e adds y_e T_k(z)/d(z, e) to F, k the zone of e, and the equations are linear
in the poles. They are what a state gains per length where an end moves (`equations`). Of a rate
they are the unknowns: there the density is like K/sqrt(distance) (`rates`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.chord import Chord
from sie.numerics.graded_panels import OF_RULES, Pieces, Rule, breaks_for, principal_value
from sie.numerics.zones import Slips

Array = NDArray[np.float64]

NODES, MOST_NODES = 48, 6144  # of the series over a gap, doubled until it has settled
SETTLED, TAIL = 1e-13, 6  # of the largest coefficient: the last ones of a series that has settled
NEGLIGIBLE = 1e-17  # of the same: left out


class Gap:
    """What a charge ν_k at t adds to PV∫ (F - B) dx over the gap between zones k and k + 1.

    With T_k cos(π(x - c)/λ) = sqrt(1 - u²) Σ γ_n U_n(u), u ~ tan(π(x - c)/λ), c the gap's centre,
    it is -Re Σ γ_n w^(n+1)/cos(π(t - c)/λ), w = u_t - sqrt(u_t² - 1).
    """

    def __init__(self, ends: tuple[float, float], chord: Chord, root: Callable[[Rule], Array]):
        self.ends, self.chord = np.array(ends), chord
        self.centre = float(self.ends.mean())
        n = NODES
        while True:
            u = chebyshev.points(n)
            places, cosine = self._places(0.5 * (1.0 + u), 0.5 * (1.0 - u))
            c = chebyshev.transform(root(places) * cosine / np.sqrt((1.0 + u) * (1.0 - u)))
            size = np.abs(c)
            if size[-TAIL:].max() <= SETTLED * size.max() or np.isnan(size).any():
                break
            if n == MOST_NODES:
                raise ContactError(
                    f"the gap [{ends[0]:g}, {ends[1]:g}] is too long for the zones beside it: "
                    f"{MOST_NODES} terms do not settle its series"
                )
            n *= 2
        c = np.append(c[: chebyshev.chopped_length(c, NEGLIGIBLE * size.max())], (0.0, 0.0))
        self.series = 0.5 * (c[:-2] - c[2:])
        self.series[0] += 0.5 * c[0]

    def _places(self, left: Array, right: Array) -> tuple[Rule, Array]:
        """Places at shares left and right of the gap in u, and cos(π(x - c)/λ) there."""
        lo, hi = np.repeat(self.ends[:, None], len(left), axis=1)
        length, ends = float(hi[0] - lo[0]), self.ends[None]
        if not self.chord.periodic:
            return Rule(ends, lo, hi, length * left, length * right, 0.0 * lo), np.ones_like(left)
        wave = np.pi / self.chord.period
        half = 0.5 * wave * length
        angle = np.arctan(np.tan(half) * (left - right))
        near = 2.0 * np.sin(half) * np.cos(angle)
        from_lo = np.arctan2(near * left, np.cos(angle + half)) / wave
        from_hi = np.arctan2(near * right, np.cos(angle - half)) / wave
        return Rule(ends, lo, hi, from_lo, from_hi, 0.0 * lo), np.cos(angle)

    def at(self, apart: Callable[[float], Array]) -> Array:
        """That of charges at places t, by t - e for places e; nan at ends that touch."""
        d, cosine = self.chord, self.chord.cosine(apart(self.centre))
        half = float(d(0.5 * np.diff(self.ends))[0])
        with np.errstate(divide="ignore", invalid="ignore"):
            left, right = (d(apart(float(e))) / (half * cosine) + 0j for e in self.ends)
            w = 1.0 / (0.5 * (left + right) + np.sqrt(left) * np.sqrt(right))
        found: Array = -(w * np.polynomial.polynomial.polyval(w, self.series)).real / cosine
        return found


class Potential(ABC):
    """F of a density that is unknown on zones.

    rough   whether coarse rules do: for the equations, and not for what is next to an end
    """

    rough: bool

    @property
    @abstractmethod
    def chord(self) -> Chord: ...

    @property
    @abstractmethod
    def stick(self) -> Array:
        """The zones, (N, 2)."""

    @property
    @abstractmethod
    def slip(self) -> Slips:
        """The zones beside them, with the direction of slip."""

    @property
    @abstractmethod
    def sources(self) -> Array:
        """The intervals on which the density is given, (n, 2)."""

    @property
    @abstractmethod
    def change(self) -> Array:
        """The density at the places of the rule on them."""

    @cached_property
    def rule(self) -> Rule:
        """Places on the sources."""
        return Rule.graded(self.sources, self.breaks(self.sources) if self.rough else OF_RULES)

    def breaks(self, ends: Array) -> tuple[float, ...]:
        """Those of a rule on intervals: as fine as the nearest place beyond an end asks for."""
        points = np.unique(np.append(ends, self.singular))
        k = np.searchsorted(points, ends)
        steps = np.concatenate(([np.inf], np.diff(points), [np.inf]))
        beyond = np.stack((steps[k[:, 0]], steps[k[:, 1] + 1]), axis=1)
        nearest = float((beyond / np.diff(ends, axis=1)).min(initial=np.inf))
        return breaks_for(math.sqrt(nearest)) if 0.0 < nearest < np.inf else OF_RULES

    @abstractmethod
    def known(self, places: Rule, sense: float) -> Array:
        """The density at places in a zone that slips in a direction."""

    @property
    def poles(self) -> Array:
        """The pole at each end, (2N); none of a bounded density."""
        return np.zeros(0)

    @property
    def slipped_strips(self) -> list[tuple[float, float, Pieces]]:
        """The integral of D over each strip that is among the data; a finite step has none."""
        return []

    @cached_property
    def centres(self) -> Array:
        return self.stick.mean(axis=1)

    def ratios(self, apart: Callable[[float], Any]) -> Array:
        """Π_i [d(z, a_i) d(z, b_i)/d(z, μ_i)²]^(1/2)."""
        d = self.chord
        out: Any = np.ones(())
        for (a, b), m in zip(self.stick, self.centres, strict=True):
            middle = d(apart(m))
            ratio = (d(apart(a)) / middle) * (d(apart(b)) / middle)
            out = out * np.sqrt(np.abs(ratio))
        return out

    @cached_property
    def charges(self) -> Array:
        """ν_k, (N, places)."""
        ratios = self.ratios(self.rule.apart)
        scaled = self.rule.weight * self.change / ratios
        return np.array([scaled / self.chord(self.rule.apart(m)) for m in self.centres])

    @cached_property
    def gaps(self) -> list[Gap]:
        """Those between neighbouring zones."""
        inner = self.stick.ravel()[1:-1].reshape(-1, 2).tolist()
        return [
            Gap((lo, hi), self.chord, partial(self._root, k)) for k, (lo, hi) in enumerate(inner)
        ]

    def _root(self, k: int, places: Rule) -> Array:
        """T_k at places beside the zones."""
        found: Array = self.chord(places.apart(self.centres[k])) * self.ratios(places.apart)
        return found

    @cached_property
    def over_gaps(self) -> list[Array]:
        """What a charge ν_k at each place adds to PV∫ (F - B) dx over gap k."""
        return [gap.at(self.rule.apart_from) for gap in self.gaps]

    @cached_property
    def scales(self) -> Array:
        """T_j/T_k at each end, j its zone, (N, 2N)."""
        d, ends = self.chord, self.stick.ravel()
        own = d(ends - np.repeat(self.centres, 2))
        found: Array = own / d(ends - self.centres[:, None])
        return found

    def missed(self, A: float, B: float) -> Array:
        """By how much the density that is given misses the equations, (2N)."""
        d, apart = self.chord, self.rule.apart
        out = [
            float(nu @ d.cosine(apart(m))) + np.pi * B
            for m, nu in zip(self.centres, self.charges, strict=True)
        ]
        out.append(float(self.charges[0] @ d(apart(self.centres[0]))) - A)
        out += [float(of @ self.charges[k]) for k, of in enumerate(self.over_gaps)]
        return np.array(out)

    @cached_property
    def by_poles(self) -> Array:
        """The derivatives of what is missed by the poles, (2N, 2N)."""
        N, d, ends = len(self.stick), self.chord, self.stick.ravel()
        out = np.zeros((2 * N, 2 * N))
        out[:N] = np.pi * self.scales * d.cosine(ends - self.centres[:, None])
        out[N] = np.pi * self.scales[0] * d(ends - self.centres[0])
        for k, gap in enumerate(self.gaps):
            out[N + 1 + k] = np.pi * self.scales[k] * gap.at(lambda e: ends - e)
        return out

    def psi(self, k: int, places: Rule, density: Array) -> Array:
        """Ψ_k at places on the axis; `density` is ν_k' at those where data are given."""
        total, singular = np.zeros(len(places.lo)), self.singular
        for n, (lo, hi) in enumerate(self.rule.ends):
            at, source = self.rule.part(n)
            own = (density.size > 0) & (places.lo >= lo) & (places.hi <= hi)
            if own.any():
                nu = self.charges[k][at] / source.weight, density[own]
                roots = bool((singular == lo).any()), bool((singular == hi).any())
                x = places.among(own)
                total[own] += principal_value(source, nu, x, roots, self.chord)
            if not own.all():
                x = places.among(~own)
                total[~own] += (1.0 / self.chord(x.from_all(source))) @ self.charges[k][at]
        total /= np.pi
        for e, y in zip(self.stick.ravel(), self.poles * self.scales[k] if self.poles.size else ()):
            total += y / self.chord(places.apart(e))
        return total

    @property
    def singular(self) -> Array:
        """Where ν' is like 1/sqrt(distance)."""
        return self.stick.ravel()

    def size_of_root(self, k: int, places: Rule) -> Array:
        """|T_k| at places in zone k."""
        d = self.chord
        a, b = self.stick[k]
        out: Array = np.sqrt(np.abs(d(places.apart(a)) * d(places.apart(b))))
        for i, ((lo, hi), m) in enumerate(zip(self.stick, self.centres, strict=True)):
            if i != k:
                middle = d(places.apart(m))
                out *= np.sqrt((d(places.apart(lo)) / middle) * (d(places.apart(hi)) / middle))
        return out

    def in_stick(self, k: int, places: Rule) -> Array:
        """The density at places in zone k."""
        found: Array = -self.size_of_root(k, places) * self.psi(k, places, np.zeros(0))
        return found

    def strain(self, places: Rule, sense: float) -> Array:
        """Re F - B at places in a zone that slips in a direction."""
        middle = 0.5 * float(places.ends.min() + places.ends.max())
        k = int(np.abs(self.stick - middle).min(axis=1).argmin())
        root = self._root(k, places)
        found: Array = root * self.psi(k, places, self.known(places, sense) / root)
        return found


@dataclass(eq=False)
class RelativeSlip:
    """(E*/2) Δg from a place that stuck all along, or the rate of g, of a potential.

    (E*/2) dΔg/dx = Re F - B beside the stick zones, and D on strips. Beside a stick zone it is
    fitted on panels and integrated from the end of the zone: an end that receded stuck all along,
    one that gained a strip slipped by the integral of D before.
    """

    potential: Potential

    def at(self, x: Array) -> Array:
        total = np.zeros(x.shape)
        for lo, hi, pieces in [*self.beside, *self.strips]:
            inside = (x >= lo) & (x <= hi)
            total[inside] = pieces(x[inside])
        return total

    @property
    def slipped(self) -> list[tuple[float, float, float, Pieces]]:
        """Δg and the direction of slip where the surface slips, or did before it stuck.

        A strip behind an edge that grows and sticks never slipped.
        """
        slip = self.potential.slip
        senses = {e: s for lo, hi, s in slip for e in (lo, hi)}
        found = [(lo, hi, senses[lo], pieces) for lo, hi, pieces in self.beside]
        for lo, hi, pieces in self.strips:
            sense = senses.get(lo) or senses.get(hi)
            if sense:
                found.append((lo, hi, sense, pieces))
        return found

    @cached_property
    def at_ends(self) -> dict[float, float]:
        """Δg at the ends of the stick zones."""
        found = dict.fromkeys(self.potential.stick.ravel().tolist(), 0.0)
        for lo, hi, pieces in self.strips:
            for e in (lo, hi):
                if e in found:
                    found[e] = float(pieces(np.array([e]))[0])
        return found

    @cached_property
    def strips(self) -> list[tuple[float, float, Pieces]]:
        """The integral of D over each strip, from its beginning."""
        return self.potential.slipped_strips

    @cached_property
    def beside(self) -> list[tuple[float, float, Pieces]]:
        """Δg on each slip zone."""
        now, found = self.potential, []
        for lo, hi, s in now.slip:
            ends = now.rule.ends
            ends = ends[(ends[:, 0] >= lo) & (ends[:, 1] <= hi)]
            if not ends.size:  # as short as marks are known
                continue
            places = Pieces.places(ends)
            whole = Pieces.integral(places, now.strain(places, s))
            if lo in self.at_ends:
                start = self.at_ends[lo]
            elif hi in self.at_ends:
                start = self.at_ends[hi] - whole.last
            else:
                start = self._across_gap(lo, hi, whole.last)
            whole.series[..., 0] += start
            found.append((lo, hi, whole))
        return found

    def _across_gap(self, lo: float, hi: float, across: float) -> float:
        """Δg at the left edge of a patch that slides as a whole, from the nearest stick zone."""
        ends = self.potential.stick.ravel()
        if (ends < lo).any():
            e = float(ends[ends < lo].max())
            return self.at_ends[e] + self._gained(e, lo)
        e = float(ends.min())
        return self.at_ends[e] - self._gained(hi, e) - across

    def _gained(self, lo: float, hi: float) -> float:
        """What Δg gains between places outside the stick zones."""
        now, total = self.potential, 0.0
        inside = now.sources[(now.sources[:, 0] >= lo) & (now.sources[:, 1] <= hi)]
        for a, b in pairwise(np.unique(np.append(inside, (lo, hi))).tolist()):
            places = Pieces.places(np.array([[a, b]]))
            sense = next((s for x1, x2, s in now.slip if x1 <= a and b <= x2), 0.0)
            total += Pieces.integral(places, now.strain(places, sense)).last
        return total
