"""The state at the end of a step in which stick zones only shrink, from that at its start.

Where the surface stuck all along the change Δq of the shear has 1/π PV∫ Δq/(x - t) dt = Δτ,
whatever is locked in; beside it Δq = s f p₁ - q₀ is known, s the direction of slip. With stick
zones [a_k, b_k], k = 1...N, of centres μ_k, on the line or per period (d is the chord)

    T_k(z) = d(z, μ_k) Π_i [d(z, a_i) d(z, b_i)/d(z, μ_i)²]^(1/2)
    F(z)   = Δτ + T_k(z) 1/π ∫ dν_k(t)/d(z, t),      dν_k = Δq/T_k dt on slip; any k
    Σ cos(t - μ_k) dν_k = -π Δτ for each k,      Σ d(t, μ_k) dν_k = ΔQ
    PV∫ T_k Ψ_k dx = 0 over each gap between neighbouring zones: one rigid shift of all

are 2N equations for 2N ends. On zone k Δq = -|T_k| Re Ψ_k. The integral over a gap is a series in
the place of a charge (`Gap`). Moving an end e adds a charge κ_e at e, from which
the derivatives follow (docs/derivations/marching.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics import chebyshev
from sie.numerics.chord import Chord
from sie.numerics.graded_panels import (
    OF_RULES,
    OF_SERIES,
    Pieces,
    Rule,
    breaks_for,
    gauss_shares,
    principal_value,
)
from sie.numerics.zones import left_over, united

from .potentials import Between, Frame, beyond_piece, on_piece, settled_series
from .rates import LoadRates, Rates
from .state import KNOWN, SAME, Contact, Ends, State, Zones, intervals

Array = NDArray[np.float64]
NEAREST = 5  # places next to an end, from which what is there follows
FEW = 3  # nodes a panel of the places where |q| <= f p is tested on the way


class Gap:
    """What a charge ν_k at t adds to Re ∫ (F - Δτ) dx over the gap between zones k and k + 1.

    With T_k cos(π(z - c)/λ) = sqrt(1 - u²) Σ γ_n U_n(u), u ~ tan(π(z - c)/λ), c the gap's centre,
    that is -Re Σ γ_n w^(n+1)/cos(π(t - c)/λ), w = u_t - sqrt(u_t² - 1).
    """

    def __init__(self, lo: float, hi: float, chord: Chord, root: Callable[[Any], Array]) -> None:
        self.lo, self.hi, self.frame = lo, hi, Frame(((lo, hi),), chord)

        def smooth(s: Array) -> Array:
            sine, cosine = np.sqrt(0.5 * (1.0 + s)), np.sqrt(0.5 * (1.0 - s))
            z, turned, _ = on_piece(self.frame, lo, hi, sine, cosine)
            found: Array = root(z) * turned / (2.0 * sine * cosine)
            return found

        c = settled_series(smooth)
        c = c[: chebyshev.chopped_length(c, 1e-17 * np.abs(c).max())]
        self.series = 0.5 * (c - np.append(c[2:], np.zeros(min(2, len(c)))))
        self.series[0] += 0.5 * c[0]

    def at(self, t: Any) -> Array:
        left, right, cosine = beyond_piece(self.frame, self.lo, self.hi, t)
        w = 1.0 / (0.5 * (left + right) + np.sqrt(left + 0j) * np.sqrt(right + 0j))
        found: Array = -(w * np.polynomial.polynomial.polyval(w, self.series)).real / cosine
        return found


def _at_end(near: Array, h: Array, side: float) -> float:
    """What h is at distance 0, by a polynomial through the nearest places; they are in order."""
    x, values = (part[:NEAREST] if side > 0.0 else part[::-1][:NEAREST] for part in (near, h))
    total = 0.0
    for k, value in enumerate(values):
        others = np.delete(x, k)
        total += value * float(np.prod(others / (others - x[k])))
    return total


@dataclass(frozen=True, eq=False)
class Equations:
    """The 2N equations for given zones, and the potential.

    before   the state at the start
    after    the contact at the end
    zones    stick zones and directions of slip
    rough    whether rules do for the residual alone, and not for q next to an end
    """

    before: State
    after: Contact
    zones: Zones
    rough: bool = field(default=False, kw_only=True)

    @property
    def chord(self) -> Chord:
        return Chord(self.after.period)

    @property
    def slipped_strips(self) -> list[tuple[float, float, Pieces]]:
        """The integral of D over each strip that is among the data; a finite step has none."""
        return []

    @cached_property
    def stick(self) -> Array:
        return np.array(self.zones.stick, dtype=float).reshape(-1, 2)

    @cached_property
    def centres(self) -> Array:
        return self.stick.mean(axis=1)

    @cached_property
    def touched(self) -> Ends:
        """What is in contact at the start or at the end."""
        return united((*self.before.contact.patches, *self.after.patches))

    @cached_property
    def beside(self) -> Array:
        """The intervals between marks beside the stick zones, (n, 2)."""
        old, new = self.before.contact, self.after
        edges = np.array((*old.patches, *new.patches)).ravel()
        marks = np.unique(np.concatenate((self.before.marks, new.limit.marks, edges)))
        return intervals(left_over(self.touched, self.zones.stick), marks, SAME * new.width)

    @property
    def sources(self) -> Array:
        """The intervals where Δq, or on strips D, is given; those beside the stick zones first."""
        return self.beside

    @cached_property
    def rule(self) -> Rule:
        """Places on them."""
        return Rule.graded(self.sources, self.breaks(self.sources) if self.rough else OF_RULES)

    def breaks(self, ends: Array) -> tuple[float, ...]:
        """Those of a rule on intervals: as fine as the nearest place beyond an end asks for."""
        points = np.unique(np.append(ends, self.stick))
        k = np.searchsorted(points, ends)
        steps = np.concatenate(([np.inf], np.diff(points), [np.inf]))
        beyond = np.stack((steps[k[:, 0]], steps[k[:, 1] + 1]), axis=1)
        nearest = float((beyond / np.diff(ends, axis=1)).min(initial=np.inf))
        return breaks_for(math.sqrt(nearest)) if 0.0 < nearest < np.inf else OF_RULES

    @cached_property
    def slip(self) -> tuple[tuple[float, float, float], ...]:
        beside = left_over(self.after.patches, self.zones.stick)
        if len(beside) != len(self.zones.signs):
            raise ContactError("a stick zone reaches an edge of the contact")
        return tuple((*zone, s) for zone, s in zip(beside, self.zones.signs, strict=True))

    def rates(self, loads: LoadRates, friction: float) -> Rates:
        """The rates where these are solved."""
        patches, period = self.after.patches, self.after.period
        return Rates.solved(
            patches, self.zones.stick, self.slip, loads, friction=friction, period=period
        )

    @property
    def begins(self) -> Array:
        """Where strips begin."""
        return np.zeros(0)

    @cached_property
    def change(self) -> Array:
        """Δq at the places."""
        return self.slipped

    @cached_property
    def slipped(self) -> Array:
        """Δq beside the stick zones."""
        count = len(self.rule.lo) // max(len(self.sources), 1) * len(self.beside)
        rule = self.rule.among(slice(0, count), self.beside)
        middle, signs = 0.5 * (rule.lo + rule.hi), np.zeros(len(rule.lo))
        for lo, hi, s in self.slip:
            signs[(middle > lo) & (middle < hi)] = s
        return signs * self.after.limit.on(rule) - self.before.shear.on(rule)

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
        """Those between neighbouring stick zones."""
        return [
            Gap(float(b), float(a), self.chord, partial(self._root, k))
            for k, ((_, b), (a, _)) in enumerate(pairwise(self.stick))
        ]

    def _root(self, k: int, z: Between) -> Array:
        """T_k at places beside the stick zones."""

        def apart(e: float) -> Array:
            return np.where(z.from_lo <= z.from_hi, (z.lo - e) + z.from_lo, (z.hi - e) - z.from_hi)

        found: Array = self.chord(apart(self.centres[k])) * self.ratios(apart)
        return found

    @cached_property
    def residual(self) -> Array:
        """By how much the equations are missed, (2N)."""
        d, old, new = self.chord, self.before.contact, self.after
        out = []
        for m, nu in zip(self.centres, self.charges, strict=True):
            cos = d.cosine(self.rule.apart(m))
            out.append(float(nu @ cos) + math.pi * (new.tau - old.tau))
        out.append(float(self.charges[0] @ d(self.rule.apart(self.centres[0]))))
        out[-1] -= new.Q - old.Q
        out += [float(of @ self.charges[k]) for k, of in enumerate(self.over_gaps)]
        return np.array(out)

    @cached_property
    def over_gaps(self) -> list[Array]:
        """What a charge ν_k at each place adds to Re ∫ (F - Δτ) dx over gap k."""
        return [gap.at(self.rule) for gap in self.gaps]

    @cached_property
    def stuck_shear(self) -> tuple[Array, Array, Array]:
        """A few places in the stick zones, q and f p there."""
        marks = np.unique(np.concatenate((self.before.marks, self.after.limit.marks, self.begins)))
        found = []
        for k, zone in enumerate(self.zones.stick):
            ends = intervals([zone], marks, SAME * self.after.width)
            rule = Rule.of(ends, gauss_shares(OF_SERIES, FEW))
            q = self.before.shear.on(rule) + self.in_stick(k, rule)
            found.append((rule.x, q, self.after.limit.on(rule)))
        x, q, limit = (np.concatenate(part) for part in zip(*found, strict=True))
        return x, q, limit

    @property
    def excess(self) -> float:
        """The largest |q| - f p at those places over the peak of f p."""
        _, q, limit = self.stuck_shear
        return float((np.abs(q) - limit).max()) / self.after.peak

    @cached_property
    def charge_of_ends(self) -> Array:
        """κ of each end: what moving it adds to F is κ T_k(z)/d(z, e).

        2π κ is the finite part of ∫ dν_k/d(t, e).
        """
        out, r = [], self.rule
        for k, zone in enumerate(self.stick):
            nu = self.charges[k]
            for e in zone:
                apart = r.apart(e)
                near, terms = np.abs(apart), 0.0
                with np.errstate(all="ignore"):
                    total = nu / self.chord(apart)
                for side, anchors, other in ((1.0, r.lo, r.hi), (-1.0, r.hi, r.lo)):
                    at = anchors == e
                    if at.any():
                        h = nu[at] * np.sqrt(near[at]) / r.weight[at]
                        h0 = _at_end(near[at], h, side)
                        pole = h0 * r.weight[at] / near[at] ** 1.5
                        total[at] = total[at] - side * pole
                        terms -= side * h0 * 2.0 / math.sqrt(abs(other[at][0] - e))
                out.append((float(total.sum()) + terms) / (2.0 * math.pi))
        return np.array(out)

    @cached_property
    def derivatives(self) -> Array:
        """Those of the residual by the ends, (2N, 2N)."""
        N, d = len(self.stick), self.chord
        out = np.zeros((2 * N, 2 * N))
        for j, (e, kappa) in enumerate(zip(self.stick.ravel(), self.charge_of_ends, strict=True)):
            own = float(d(e - self.centres[j // 2]))
            for k, m in enumerate(self.centres):
                out[k, j] = math.pi * kappa * own / d(e - m) * d.cosine(e - m)
            out[N, j] = math.pi * kappa * own
            for k, gap in enumerate(self.gaps):
                ratio = own / float(d(e - self.centres[k]))
                out[N + 1 + k, j] = math.pi * kappa * ratio * float(gap.at(Between(e, e, 0.0, 0.0)))
        return out

    def in_stick(self, k: int, places: Rule) -> Array:
        """Δq at places in stick zone k."""
        found: Array = -self.size_of_root(k, places) * self.psi(k, places, np.zeros(0))
        return found

    def psi(self, k: int, places: Rule, density: Array) -> Array:
        """Ψ_k at places on the axis; `density` is ν_k' at those where data are given."""
        total, ends = np.zeros(len(places.lo)), self.stick.ravel()
        for n, (lo, hi) in enumerate(self.rule.ends):
            at, source = self.rule.part(n)
            own = (density.size > 0) & (places.lo >= lo) & (places.hi <= hi)
            if own.any():
                nu = self.charges[k][at] / source.weight, density[own]
                roots = bool((ends == lo).any()), bool((ends == hi).any())
                x = places.among(own)
                total[own] += principal_value(source, nu, x, roots, self.chord)
            if not own.all():
                x = places.among(~own)
                total[~own] += (1.0 / self.chord(x.from_all(source))) @ self.charges[k][at]
        return total / math.pi

    def size_of_root(self, k: int, places: Rule) -> Array:
        """|T_k| at places in stick zone k."""
        d = self.chord
        a, b = self.stick[k]
        out: Array = np.sqrt(np.abs(d(places.apart(a)) * d(places.apart(b))))
        for i, ((lo, hi), m) in enumerate(zip(self.stick, self.centres, strict=True)):
            if i != k:
                middle = d(places.apart(m))
                out *= np.sqrt((d(places.apart(lo)) / middle) * (d(places.apart(hi)) / middle))
        return out

    @cached_property
    def state(self) -> State:
        """The state that solved equations leave; slip no longer than `SAME` is none."""
        before, after = self.before, self.after
        same = SAME * after.width
        slip = tuple(zone for zone in self.slip if zone[1] - zone[0] > same)
        marks = np.unique(np.concatenate((before.marks, after.limit.marks, self.begins)))
        parts, values = [], []
        for lo, hi, s in slip:
            parts.append(Pieces.places(intervals([(lo, hi)], after.limit.marks, same)))
            values.append(s * after.limit.on(parts[-1]))
        for k, zone in enumerate(self.zones.stick):
            part = Pieces.places(intervals([zone], marks, same))
            near = np.minimum(part.from_lo, part.from_hi) <= KNOWN * after.width
            limit = np.where(near, after.limit.on(part), np.inf)
            q = before.shear.on(part) + self.in_stick(k, part)
            parts.append(part)
            values.append(np.minimum(np.maximum(q, -limit), limit))
        ends = np.concatenate([part.ends for part in parts])
        order, series = np.argsort(ends[:, 0]), Pieces.of_values(ends, np.concatenate(values))
        stick = left_over(after.patches, tuple(zone[:2] for zone in slip), after.period)
        return State(after, stick, slip, Pieces(ends[order], series[order]))
