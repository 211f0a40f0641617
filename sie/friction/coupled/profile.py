"""Superposition of flat punches: the tractions and the slip under a symmetric convex profile.

Under monotone normal load the rate of every state is that of a flat punch of the contact's width
(its slope does not change, nor does the slip in stick), so that with P'(s) = dP/ds

    p(x) = ∫ P'(s) φ(x/s) ds/s,   q alike,   g(x) = 2/E* ∫ P'(s) ĝ(x/s) ds,   max(|x|, a) < s < b

with φ, ψ, ĝ those of the flat under P = 1 on |t| < 1 (`functions`), and c/b is the
flat's. Each function of t = x/s is smooth between its singular places times known powers at
these; P' is (s - lo)^e times a polynomial on each of its panels. The integrals are Gauss-Jacobi
and Gauss-Legendre on panels that shrink towards the next singularity, all x at once.

Spence (1975), J. Elasticity 5, 297, for the stick zone that no profile changes.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.gauss_jacobi import with_weight
from sie.progress_bar import step_done

from .functions import FlatFunctions
from .panels import LONGEST, NODES, graded, totals
from .tables import chopped, summed

Array = NDArray[np.float64]

TOGETHER = 256  # intervals that are integrated at once: larger arrays cost more
NEAREST = 1e-17  # of the half-width, to a singularity of P' that x may be on
STEEPEST = 20.0  # of the logarithm of a power of s, on a panel at most


@dataclass(frozen=True, eq=False)
class GrowthPanel:
    """P'(s) = d^power Σ c_k T_k for lo <= s - origin <= hi, d the distance from a place before.

    From the origin, the half-width of a flat base, short panels keep their digits. The place, where
    P' is not smooth, lies `behind` the panel, and the series is one in the logarithm of d; if
    that is infinite, d = s - origin - lo, and the series is one in s.
    """

    origin: float
    lo: float
    hi: float
    power: float
    series: Array = field(repr=False)
    behind: float = math.inf

    def __call__(self, ahead: Array) -> Array:
        """P' at s = origin + lo + ahead."""
        values = summed(self._chopped, self.variable(ahead))
        return values * self.factor(ahead) if self.power else values

    def factor(self, ahead: Any) -> Any:
        """d^power."""
        return (ahead if self.behind == math.inf else self.behind + ahead) ** self.power

    @property
    def at_start(self) -> float:
        """The exponent of P' at lo."""
        return self.power if self.behind == math.inf else 0.0

    def variable(self, ahead: Array) -> Array:
        """That of the series."""
        length, behind = self.hi - self.lo, self.behind
        if behind == math.inf:
            return 2.0 / length * ahead - 1.0
        return 2.0 / math.log1p(length / behind) * np.log1p(ahead / behind) - 1.0

    @cached_property
    def _chopped(self) -> Array:
        return chopped(self.series)

    def nodes(self, part: Array | float) -> Any:
        """s - origin - lo at parts of the panel in that variable."""
        length, behind = self.hi - self.lo, self.behind
        if behind == math.inf:
            return length * part
        return behind * np.expm1(math.log1p(length / behind) * part)

    def rule(self, length: float, n: int, shift: float = 0.0) -> tuple[Array, Array]:
        """Places ahead of lo and weights of ds on a first part of the panel.

        They serve P' (s - lo)^shift times a smooth function.
        """
        x, _, w = with_weight(n, 0.0, self.at_start + shift)
        if self.behind == math.inf:
            return length * x, length * w
        log = math.log1p(length / self.behind)
        ahead = self.behind * np.expm1(log * x)
        return ahead, log * (self.behind + ahead) * w

    @cached_property
    def places(self) -> tuple[Array, Array]:
        """s - origin and P' ds of a Gauss rule over the panel."""
        ahead, weight = self.rule(self.hi - self.lo, max(len(self.series), NODES))
        return self.lo + ahead, weight * self(ahead)

    def load(self, ahead: float) -> float:
        """∫P' ds from its beginning to origin + ahead.

        That end may lie before the panel, on it or beyond.
        """
        if ahead <= self.lo:
            return 0.0
        return self._whole if ahead >= self.hi else self._load(ahead - self.lo)

    @cached_property
    def _whole(self) -> float:
        return self._load(self.hi - self.lo)

    def _load(self, length: float) -> float:
        ahead, weight = self.rule(length, max(len(self.series), NODES))
        return float(weight @ self(ahead))


Function = Callable[[Array, Array, Array], Array]


class Kernel(NamedTuple):
    """A function of t, 1 - t and |t - c| on lo <= t <= hi, as it is integrated over s = x/t.

    above           (1 - hi)/hi, so that s - x = x above at its end
    behind          (lo - c)/(c lo), so that x/c - s = x behind at its other end
    span            1/lo - 1/hi, so that the interval is x span long
    pole            where it is singular next, t >= hi
    power, at_c     its exponents at t = hi and, if lo = c, at c; 0 where it is smooth
    """

    value: Function
    lo: float
    hi: float
    above: float
    behind: float = 0.0
    span: float = math.inf
    pole: float = 1.0
    power: float = 0.0
    at_c: float = 0.0


class Part(NamedTuple):
    """Intervals of s for some of the x.

    They are given by their beginnings, beyond x and beyond lo of the panel, their lengths and
    scales.

    before, after   distances from either end to the next singularity, inf if there is none
    near            distance from the first one within which P' is smooth, and less than s
    powers          exponents at both ends
    """

    which: NDArray[np.intp]
    from_x: Array
    from_lo: Array
    length: Array
    to_c: Array  # |x/c - s| at the end from which it is counted
    before: Array
    after: Array
    near: Array
    powers: tuple[float, float]


class Superposition:
    """The integrals over s up to origin + b, of P' on its panels."""

    def __init__(self, flat: FlatFunctions, growth: tuple[GrowthPanel, ...]) -> None:
        self.flat, self.growth = flat, growth

    def pressure(self, x: Array, b: Array) -> Array:
        """p at 0 < x <= origin + b, for each x with a contact of its own."""
        return self._sum(self._pressure_kernels, x, b, over_s=True)

    def shear_deficit(self, x: Array, b: Array) -> Array:
        """f p - q, 0 in slip."""
        return self._sum(self._deficit_kernels, x, b, over_s=True)

    def slip(self, x: Array, b: Array) -> Array:
        """E*/2 times the slip of x > 0 since it came into contact."""
        return self._sum(self._slip_kernels, x, b, over_s=False)

    # -- kernels -----------------------------------------------------------------------------------

    def _near_edge(self, value: Function, power: float, pole: float = 1.0) -> Kernel:
        """A function on c^(1/2) <= t <= 1."""
        f = self.flat
        behind = (f.rest - f.beyond) / (f.c * f.middle)
        return Kernel(value, f.middle, 1.0, 0.0, behind, f.beyond / f.middle, pole, power)

    def _beside_c(self, value: Function, at_c: float) -> Kernel:
        """A function on c <= t <= c^(1/2)."""
        f = self.flat
        span = (f.rest - f.beyond) / (f.c * f.middle)
        return Kernel(value, f.c, f.middle, f.beyond / f.middle, span=span, at_c=at_c)

    @cached_property
    def _pressure_kernels(self) -> tuple[Kernel, ...]:
        f = self.flat
        chi, A, S, Psi = f.weight, f.A, f.S_beside_c, f.Psi
        return (
            self._near_edge(lambda t, e, d: f.sine * chi(t, e, d) * Psi(t, e), -f.h),
            Kernel(lambda t, e, d: A(t, e), 0.0, f.middle, f.beyond / f.middle),
            self._beside_c(lambda t, e, d: -f.sine * chi(t, e, d) * S(t, e), f.h),
        )

    @cached_property
    def _deficit_kernels(self) -> tuple[Kernel, ...]:
        f = self.flat

        def deficit(t: Array, e: Array, from_c: Array) -> Array:
            return f.weight(t, e, from_c) * f.S(t, e) / f.beta

        return (Kernel(deficit, 0.0, f.c, f.rest / f.c, pole=f.c, power=f.h),)

    @cached_property
    def _slip_kernels(self) -> tuple[Kernel, ...]:
        f, smoother = self.flat, 1.0 - self.flat.h
        near_c, (regular, singular) = f.slip_near_c, f.slip_near_edge
        return (
            self._near_edge(lambda t, e, d: regular(t, e), 0.0, math.inf),
            self._near_edge(lambda t, e, d: singular(t, e) * e**smoother, smoother),
            self._beside_c(lambda t, e, d: near_c(t, e) * d ** (1.0 + f.h), 1.0 + f.h),
        )

    # -- integrals ---------------------------------------------------------------------------------

    def _sum(self, kernels: tuple[Kernel, ...], x: Array, b: Array, over_s: bool) -> Array:
        total = np.zeros(len(x))
        for kernel in kernels:
            alike: dict[tuple[float, float], list[tuple[GrowthPanel, Part]]] = {}
            for panel in self.growth:
                for part in self._parts(kernel, panel, x, b):
                    alike.setdefault(part.powers, []).append((panel, part))
            for powers, parts in alike.items():
                step_done(0)
                total += self._integral(kernel, powers, parts, x, over_s)
        return total

    def _parts(self, kernel: Kernel, panel: GrowthPanel, x: Array, b: Array) -> Iterator[Part]:
        """The intervals of s - origin that lie on the panel and below b.

        They come in groups, by what they begin and end at.
        """
        begin = (x - panel.origin) + x * kernel.above
        end = x / kernel.lo - panel.origin if kernel.lo else np.full(len(x), np.inf)
        top = np.minimum(b, panel.hi)
        lo, hi = np.maximum(begin, panel.lo), np.minimum(end, top)
        for own_start in (True, False):
            for own_end in (True, False):
                # Between two places of its own an interval may be shorter than the doubles are
                # apart
                longer = (lo <= hi) if own_start and own_end else (lo < hi)
                chosen = longer & ((begin >= panel.lo) == own_start) & ((end <= top) == own_end)
                if chosen.any():
                    i = np.flatnonzero(chosen)
                    at = x[i], lo[i], hi[i]
                    yield self._part(kernel, panel, i, at, (own_start, own_end))

    def _part(
        self,
        kernel: Kernel,
        panel: GrowthPanel,
        which: NDArray[np.intp],
        at: tuple[Array, Array, Array],
        own: tuple[bool, bool],
    ) -> Part:
        """The intervals (lo, hi) of some x.

        They begin or end at the kernel's own places, or the panel's.
        """
        (x, lo, hi), (own_start, own_end) = at, own
        c, origin = self.flat.c, panel.origin
        from_lo, nearest = lo - panel.lo, NEAREST * (origin + hi)
        length = x * kernel.span if own_start and own_end else hi - lo
        to_kink = from_lo if panel.at_start else from_lo + panel.behind
        if own_start:
            from_x = x * kernel.above
            before = np.minimum(from_x if kernel.above else x, np.maximum(to_kink, nearest))
        else:
            from_x = (origin - x) + lo
            before = np.maximum((origin - x / kernel.pole) + lo, nearest)
            before = np.minimum(before, panel.behind)
        if kernel.hi == c:
            to_c = np.zeros(len(x)) if own_start else np.maximum((origin - x / c) + lo, 0.0)
        else:
            to_c = x * kernel.behind if own_end else np.maximum((x / c - origin) - hi, 0.0)
        after = np.full(len(x), np.inf)
        if kernel.at_c:
            after = length if own_end else np.maximum(to_c, nearest)
        powers = kernel.power if own_start else panel.at_start, kernel.at_c if own_end else 0.0
        near = np.minimum(to_kink, origin + lo)
        return Part(which, from_x, from_lo, length, to_c, before, after, near, powers)

    def _integral(
        self,
        kernel: Kernel,
        powers: tuple[float, float],
        parts: list[tuple[GrowthPanel, Part]],
        x: Array,
        over_s: bool,
    ) -> Array:
        """∫ P' kernel ds, or ds/s, over all intervals with these powers, for each x."""
        columns = [np.concatenate(c) for c in zip(*(p[:-1] for _, p in parts), strict=True)]
        first = np.cumsum([0, *(len(part.which) for _, part in parts)])
        sums = np.empty(first[-1])
        steepest = max(panel.power for panel, _ in parts)
        longest = min(LONGEST, STEEPEST / max(steepest, 1.0))
        for k in range(0, len(sums), TOGETHER):
            few = slice(k, k + TOGETHER)
            which, from_x, from_lo, length, to_c, before, after, near = (c[few] for c in columns)
            owner, ahead, left, weight = graded(
                length, before, after, powers, longest=longest, near=near
            )
            to_c = to_c[owner][:, None] + (ahead if kernel.hi == self.flat.c else left)
            from_x, from_lo = from_x[owner][:, None] + ahead, from_lo[owner][:, None] + ahead
            at = x[which[owner]][:, None]
            s = at + from_x
            values = kernel.value(at / s, from_x / s, to_c * (self.flat.c / s)) * weight
            ends = np.searchsorted(owner, np.clip(first - k, 0, len(which))).tolist()
            for (panel, _), (lo, hi) in zip(parts, itertools.pairwise(ends), strict=True):
                if hi > lo:
                    values[lo:hi] *= panel(from_lo[lo:hi])
            if over_s:
                values /= s
            sums[few] = totals(owner, values, len(which))
        total: Array = np.bincount(columns[0], sums, minlength=len(x)).astype(float)
        return total
