"""A part of a step on which something comes to stick: one unknown function on each strip.

What sticks anew, where contact grows and sticks and behind an end that advances, keeps the slope
of slip that it has then: on its strip, which begins at x0, Re F - Δτ = D(x), whatever the time.
D enters the equations of a finite step as data, ν' = D/|T_k| on the strip as far as the end has
come. At each moment of a part every end then has one unknown:

    it recedes           its place
    it is a stuck edge   one coefficient of D
    it advances          its place and one coefficient of D, with one more equation: K = 0

    D(x) = v w Σ_{k<n} c_k T_k(2v - 1),    v = sqrt(|x - x0|/L)

w is about sqrt(|x - x0'|), x0' the other end of the stick zone as the part begins.

The moments t_i, i = 1...n, are those of `loading`. Moving an end adds a charge to F as in a finite
step, and D enters linearly, so that all derivatives but those of K are exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.inheritance import override
from sie.numerics import chebyshev
from sie.numerics.graded_panels import Pieces

from .equations import Equations
from .loading import MOMENTS, TAU
from .onset import Motion, Onset
from .state import Zones

if TYPE_CHECKING:
    from sie.numerics.graded_panels import Rule

    from .loading import LoadStep
    from .rates import Rates
    from .state import Contact, State

Array = NDArray[np.float64]

STEPS = 25  # of Newton's method
SETTLED, GOOD = 2e-14, 1e-10  # of the contact: the longest step of an end
CLOSEST = 0.6  # of the distance to its neighbour: an end moves so far at most in a step
NEAR = 1e-4  # of the contact: after so short a step the slopes of K are kept
FAR, ABSURD = 0.1, 1e4  # steps of the contact, and D over f p, that show that it does not converge
ROUNDED = 1e-4  # of f p: the smallest D of which so much is resolved
DIFFERENCE = 1e-6  # of the distance to its neighbour: the step of a difference


@dataclass(frozen=True)
class Strip:
    """What end j of the stick zones gains.

    x0       where it begins
    width    of the stick zone then, which a contact that grows from nothing soon exceeds
    length   about its final one
    """

    j: int
    x0: float
    width: float
    length: float

    @property
    def outward(self) -> float:
        return 1.0 if self.j % 2 else -1.0

    def reaches(self, end: float) -> tuple[float, float]:
        return (min(self.x0, end), max(self.x0, end))

    def basis(self, rule: Rule) -> Array:
        """The functions that c multiplies, (n, places)."""
        near = rule.from_lo if self.outward > 0.0 else rule.from_hi
        v = np.sqrt(near / self.length)
        far = np.sqrt((near + self.width) / (self.length + self.width))
        found: Array = v * far * chebyshev.polynomials(MOMENTS, 2.0 * v - 1.0)
        return found


@dataclass(frozen=True, eq=False)
class StripEquations(Equations):
    """The equations of a finite step with strips among the data."""

    strips: tuple[Strip, ...]
    series: Array  # c of each strip, (strips, n)

    @cached_property
    def sources(self) -> Array:
        """The intervals beside the stick zones, then the strips."""
        ends = [strip.reaches(self.stick.ravel()[strip.j]) for strip in self.strips]
        return np.concatenate((self.beside, np.array(ends).reshape(-1, 2)))

    @property
    @override
    def slipped_strips(self) -> list[tuple[float, float, Pieces]]:
        found = []
        for strip, c in zip(self.strips, self.series, strict=True):
            lo, hi = strip.reaches(float(self.stick.ravel()[strip.j]))
            places = Pieces.places(np.array([[lo, hi]]))
            whole = Pieces.integral(places, c @ strip.basis(places))
            if strip.outward < 0.0:
                whole.series[..., 0] -= whole.last
            found.append((lo, hi, whole))
        return found

    @property
    def begins(self) -> Array:
        """Where strips begin."""
        return np.array([strip.x0 for strip in self.strips])

    @cached_property
    def on_strips(self) -> list[slice]:
        each = len(self.rule.lo) // len(self.sources)
        first = each * len(self.beside)
        return [slice(first + k * each, first + (k + 1) * each) for k in range(len(self.strips))]

    @cached_property
    def bases(self) -> list[Array]:
        """The basis of each strip at its places."""
        return [
            strip.basis(self.rule.among(part))
            for strip, part in zip(self.strips, self.on_strips, strict=True)
        ]

    @cached_property
    def change(self) -> Array:
        """Δq beside the stick zones, ±D on the strips: ν_k is then of one form for both."""
        found = [self.slipped]
        for strip, part, basis, c in zip(
            self.strips, self.on_strips, self.bases, self.series, strict=True
        ):
            found.append(self._side(strip, part) * (c @ basis))
        return np.concatenate(found)

    def _side(self, strip: Strip, part: slice) -> Array:
        """The sign of x - μ on a strip."""
        found: Array = np.sign(self.rule.among(part).x - self.centres[strip.j // 2])
        return found

    def by_gap(self, strip: Strip) -> int:
        """The gap that a strip is beside; -1 for an outer one."""
        k = strip.j // 2 if strip.j % 2 else strip.j // 2 - 1
        return k if 0 <= k < len(self.gaps) else -1

    @cached_property
    def residual(self) -> Array:
        """By how much the equations are missed, (2N)."""
        found = super().residual.copy()
        for strip, part, basis, c in zip(
            self.strips, self.on_strips, self.bases, self.series, strict=True
        ):
            if self.by_gap(strip) >= 0:
                row = len(self.stick) + 1 + self.by_gap(strip)
                found[row] += self.rule.weight[part] @ (c @ basis)
        return found

    def by_series(self, k: int) -> Array:
        """Derivatives of the residual by the c of strip k, (2N, n)."""
        strip, part, basis = self.strips[k], self.on_strips[k], self.bases[k]
        rule, d, N = self.rule.among(part), self.chord, len(self.stick)
        out = np.zeros((2 * N, MOMENTS))
        scaled = basis * (rule.weight * self._side(strip, part) / self.ratios_at(part))
        for i, m in enumerate(self.centres):
            apart = rule.apart(m)
            out[i] = (scaled / d(apart)) @ d.cosine(apart)
        out[N] = scaled.sum(axis=1)
        for i, over in enumerate(self.over_gaps):
            out[N + 1 + i] = (scaled / d(rule.apart(self.centres[i]))) @ over[part]
            if self.by_gap(strip) == i:
                out[N + 1 + i] += basis @ rule.weight
        return out

    def ratios_at(self, part: slice) -> Array:
        return np.broadcast_to(self.ratios(self.rule.apart), self.rule.lo.shape)[part]

    def in_stick(self, k: int, places: Rule) -> Array:
        """Δq at places in stick zone k."""
        psi = self.psi(k, places, self._on_own_strip(k, places))
        found: Array = -self.size_of_root(k, places) * psi
        return found

    def _on_own_strip(self, k: int, places: Rule) -> Array:
        """ν_k' = D/|T_k| at places of zone k on its strips; 0 elsewhere."""
        found = np.zeros(len(places.lo))
        for strip, c in zip(self.strips, self.series, strict=True):
            lo, hi = strip.reaches(self.stick.ravel()[strip.j])
            own = (places.lo >= lo) & (places.hi <= hi)
            if strip.j // 2 == k and own.any():
                x = places.among(own)
                found[own] = c @ strip.basis(x) / self.size_of_root(k, x)
        return found


# -- a part of a step ------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Span:
    """What a part of a step is about: the state at its start, how its ends move, its moments.

    before    the state at the start
    step      the step of loads
    onset     the motions
    begun     the share of the step at the start
    length    that of the part
    """

    before: State
    step: LoadStep
    onset: Onset
    begun: float
    length: float

    @cached_property
    def moments(self) -> Array:
        """Shares of the step, after the start."""
        return self.begun + self.length * TAU[1:] ** 2

    @cached_property
    def contacts(self) -> list[Contact]:
        found = [self.step.at(float(t)) for t in self.moments]
        if any(len(c.patches) != len(self.onset.patches) for c in found):
            raise ContactError("the number of patches changes while something sticks anew")
        return found

    @property
    def motions(self) -> list[Motion]:
        return [end.motion for end in self.onset.ends]

    @cached_property
    def start(self) -> Array:
        """The places of all ends at the start."""
        return np.array([end.place for end in self.onset.ends])

    def which(self, *motions: Motion) -> list[int]:
        return [j for j, one in enumerate(self.motions) if one in motions]

    @cached_property
    def free(self) -> list[int]:
        return self.which(Motion.RECEDES, Motion.ADVANCES)

    def with_edges(self, places: Array) -> Array:
        """Places of all ends at the moments, (n, 2N), with those of stuck edges put in."""
        found = places.copy()
        old = np.array(self.onset.patches).ravel()
        for j in self.which(Motion.GROWS):
            k = int(np.abs(old - self.start[j]).argmin())
            found[:, j] = [np.array(c.patches).ravel()[k] for c in self.contacts]
        return found

    def rates(self, i: int, ends: Array) -> Rates:
        """The rates at moment i, given all ends."""
        found = replace(self.onset.placed(ends), patches=self.contacts[i].patches)
        return found.rates(self.step.rates, self.step.friction, self.contacts[i].period)


@dataclass(frozen=True, eq=False)
class Panel:
    """A solved part: places of the ends at its moments, (n, 2N), and c of its strips, (S, n)."""

    span: Span
    strips: tuple[Strip, ...]
    places: Array
    series: Array
    rough: bool = False  # as of equations

    @cached_property
    def equations(self) -> list[StripEquations]:
        span, signs = self.span, self.span.onset.signs.signs
        return [
            StripEquations(
                span.before,
                contact,
                Zones(tuple((float(a), float(b)) for a, b in ends.reshape(-1, 2)), signs),
                self.strips,
                self.series,
                rough=self.rough,
            )
            for contact, ends in zip(span.contacts, self.places, strict=True)
        ]

    @cached_property
    def rates(self) -> list[Rates]:
        return [self.span.rates(i, ends) for i, ends in enumerate(self.places)]

    def system(self, slopes: list[Array]) -> tuple[Array, Array]:
        """Residuals and their derivatives by the places of free ends, then by c.

        slopes: those of K, as of `slopes`
        """
        span, n = self.span, MOMENTS
        E, free, adv = 2 * len(span.onset.zones), span.free, span.which(Motion.ADVANCES)
        rows, F = E + len(adv), len(free)
        matrix = np.zeros((n * rows, n * F + n * len(self.strips)))
        right = np.zeros(n * rows)
        for i, now in enumerate(self.equations):
            at, own = slice(i * rows, i * rows + E), slice(i * F, (i + 1) * F)
            right[at] = now.residual
            matrix[at, own] = now.derivatives[:, free]
            for k in range(len(self.strips)):
                matrix[at, n * F + k * n : n * F + (k + 1) * n] = now.by_series(k)
            if adv:
                right[i * rows + E : (i + 1) * rows] = self.rates[i].K.ravel()[adv]
                matrix[i * rows + E : (i + 1) * rows, own] = slopes[i]
        return right, matrix

    def slopes(self) -> list[Array]:
        """The derivatives of K of the advancing ends by the free ones, at each moment."""
        adv, free = self.span.which(Motion.ADVANCES), self.span.free
        found = [np.zeros((len(adv), len(free))) for _ in self.places]
        for i, ends in enumerate(self.places if adv else []):
            K = self.rates[i].K.ravel()[adv]
            for column, j in enumerate(free):
                step = np.zeros_like(ends)
                # into the stick zone, where room is left
                step[j] = DIFFERENCE * (ends[j ^ 1] - ends[j])
                moved = self.span.rates(i, ends + step).K.ravel()[adv]
                found[i][:, column] = (moved - K) / step[j]
        return found

    def moved(self, step: Array) -> tuple[Panel, float]:
        """The panel after a step of Newton's method, shortened, and the longest move of an end."""
        free, n = self.span.free, MOMENTS
        moves = np.zeros_like(self.places)
        moves[:, free] = step[: n * len(free)].reshape(n, -1)
        share = min((_share(now, move) for now, move in zip(self.equations, moves, strict=True)))
        series = self.series + share * step[n * len(free) :].reshape(self.series.shape)
        longest = float(np.abs(moves).max(initial=0.0))
        return replace(self, places=self.places + share * moves, series=series), longest

    @cached_property
    def unresolved(self) -> float:
        """The last two coefficients of D over the largest, or over what of f p rounding moves."""
        sizes, peak = np.abs(self.series), self.span.before.contact.peak
        largest = np.maximum(sizes.max(axis=1, initial=0.0), ROUNDED * peak)
        return float(np.max(sizes[:, -2:].max(axis=1, initial=0.0) / largest, initial=0.0))


def _share(now: StripEquations, moves: Array) -> float:
    """The share of moves that keeps ends between their neighbours and the edges."""
    ends, share = now.stick.ravel(), 1.0
    edges = np.array(now.after.patches)
    for j, (e, move) in enumerate(zip(ends, moves, strict=True)):
        lo, hi = edges[np.abs(edges - e).min(axis=1).argmin()] if len(edges) > 1 else edges[0]
        lo = max(lo, ends[j - 1]) if j else lo
        hi = min(hi, ends[j + 1]) if j + 1 < len(ends) else hi
        room = (hi - e) if move > 0.0 else (e - lo)
        if abs(move) > CLOSEST * room:
            share = min(share, CLOSEST * room / abs(move))
    return share


def solved_panel(span: Span, guess: Array) -> Panel:
    """The part by Newton's method. Raises ContactError where that fails.

    guess: places of the ends at its end, (2N), or at its moments, (n, 2N)
    """
    places = span.with_edges(np.broadcast_to(guess, (MOMENTS, guess.shape[-1])))
    start, final = span.start.tolist(), places[-1].tolist()
    if guess.ndim == 1:
        places = span.start + np.outer(TAU[1:] ** 2, places[-1] - span.start)
    strips = tuple(
        Strip(j, start[j], abs(start[j] - start[j ^ 1]), abs(final[j] - start[j]))
        for j in span.which(Motion.ADVANCES, Motion.GROWS)
    )
    now = Panel(span, strips, span.with_edges(places), np.zeros((len(strips), MOMENTS)), rough=True)
    last, width = math.inf, span.before.contact.width
    peak = max(contact.peak for contact in (span.before.contact, span.contacts[-1]))
    for _ in range(STEPS):
        if (now.places[:, 1::2] <= now.places[:, ::2]).any():  # a stick zone has vanished
            break
        if last > NEAR * width:
            slopes = now.slopes()
        right, matrix = now.system(slopes)
        if not (np.isfinite(matrix).all() and np.isfinite(right).all()):
            break
        rows = np.abs(matrix).max(axis=1)
        scaled = matrix / rows[:, None]
        columns = np.abs(scaled).max(axis=0)
        step = np.linalg.lstsq(scaled / columns, -right / rows, rcond=1e-14)[0] / columns
        before, (now, longest) = now.series, now.moved(step)
        change = np.abs(now.series - before).max(initial=0.0)
        size = np.abs(now.series).max(initial=0.0)
        settled = longest <= SETTLED * width and change <= 1e-11 * size
        if settled or (longest <= GOOD * width and longest >= 0.5 * last):
            return replace(now, rough=False)
        if size > ABSURD * peak or longest > last > FAR * width:
            break
        last = longest
    raise ContactError("no places of what sticks anew balance the loads")
