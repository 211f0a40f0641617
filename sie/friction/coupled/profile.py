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

import math
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.progress_bar import step_done

from .functions import FlatFunctions
from .load_rate import GrowthPanel, Stack
from .panels import LONGEST, graded, totals

Array = NDArray[np.float64]

TOGETHER = 256  # intervals that are integrated at once: larger arrays cost more
NEAREST = 1e-17  # of the half-width, to a singularity of P' that x may be on
STEEPEST = 20.0  # of the logarithm of a power of s, on a panel at most


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
    """Intervals of s for some of the x, each on one panel of P'.

    They are given by their beginnings, beyond x and beyond lo of the panel, their lengths and
    scales.

    before, after   distances from either end to the next singularity, inf if there is none
    near            distance from the first one within which P' is smooth, and less than s
    """

    which: NDArray[np.intp]
    panel: NDArray[np.intp]
    from_x: Array
    from_lo: Array
    length: Array
    to_c: Array  # |x/c - s| at the end from which it is counted
    before: Array
    after: Array
    near: Array


class Superposition:
    """The integrals over s up to origin + b, of P' on its panels."""

    def __init__(self, flat: FlatFunctions, growth: tuple[GrowthPanel, ...]) -> None:
        self.flat, self.growth, self.stack = flat, growth, Stack(growth)

    def pressure(self, x: Array, b: Array, beyond: Array | None = None) -> Array:
        """p at 0 < x <= origin + b, for each x with a contact of its own.

        `beyond` is x - origin where that is known better than from x.
        """
        return self._sum(self._pressure_kernels, x, b, over_s=True, beyond=beyond)

    def shear_deficit(self, x: Array, b: Array, beyond: Array | None = None) -> Array:
        """f p - q, 0 in slip."""
        return self._sum(self._deficit_kernels, x, b, over_s=True, beyond=beyond)

    def slip(self, x: Array, b: Array) -> Array:
        """E*/2 times the slip of x > 0 since it came into contact."""
        return self._sum(self._slip_kernels, x, b, over_s=False)

    # -- kernels -----------------------------------------------------------------------------------

    def _near_edge(self, value: Function, power: float, pole: float = 1.0) -> Kernel:
        """A function on c^(1/2) <= t <= 1."""
        f = self.flat
        behind = f.from_c_to_middle / (f.c * f.middle)
        return Kernel(value, f.middle, 1.0, 0.0, behind, f.beyond / f.middle, pole, power)

    def _beside_c(self, value: Function, at_c: float) -> Kernel:
        """A function on c <= t <= c^(1/2)."""
        f = self.flat
        span = f.from_c_to_middle / (f.c * f.middle)
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

    def _sum(
        self,
        kernels: tuple[Kernel, ...],
        x: Array,
        b: Array,
        over_s: bool,
        beyond: Array | None = None,
    ) -> Array:
        total = np.zeros(len(x))
        from_origin = x - self.stack.origin if beyond is None else beyond
        for kernel in kernels:
            for powers, part in self._parts(kernel, x, from_origin, b):
                step_done(0)
                total += self._integral(kernel, powers, part, x, over_s)
        return total

    def _parts(
        self, kernel: Kernel, x: Array, from_origin: Array, b: Array
    ) -> Iterator[tuple[tuple[float, float], Part]]:
        """The intervals of s - origin that lie on a panel and below b, by the powers at both ends.

        They begin or end at the kernel's own places, or the panel's.
        """
        all_ = self.stack
        start, top = all_.lo[:, None], np.minimum(b, all_.hi[:, None])
        # From x on: in x/t, a little more than x, the digits of a narrow slip zone are lost
        below_lo = x * (kernel.above + kernel.span) if kernel.lo else np.full(len(x), np.inf)
        behind = (from_origin - start) + x * kernel.above
        beyond = (from_origin - top) + below_lo
        length = np.where(
            behind >= 0.0,
            np.where(beyond <= 0.0, x * kernel.span, (top - from_origin) - x * kernel.above),
            np.where(beyond <= 0.0, (from_origin - start) + below_lo, top - start),
        )
        first = np.where(behind >= 0.0, kernel.power, all_.at_start[:, None])
        last = np.where(beyond <= 0.0, kernel.at_c, 0.0)
        for at_start in {kernel.power, *all_.at_start.tolist()}:
            for at_end in {kernel.at_c, 0.0}:
                k, i = np.nonzero((length > 0.0) & (first == at_start) & (last == at_end))
                if k.size:
                    ends = behind[k, i], length[k, i], (top - from_origin)[k, i]
                    yield (at_start, at_end), self._part(kernel, k, i, x[i], ends)

    def _part(
        self,
        kernel: Kernel,
        panel: NDArray[np.intp],
        which: NDArray[np.intp],
        x: Array,
        ends: tuple[Array, Array, Array],
    ) -> Part:
        """Intervals of these x on these panels.

        Given are how far the kernel begins behind the beginning of the panel, how long they are,
        and how far x lies before the end of the panel.
        """
        (behind, length, ahead), all_, c = ends, self.stack, self.flat.c
        own_start, own_end = behind >= 0.0, ahead >= x * (kernel.above + kernel.span)
        from_lo = np.maximum(behind, 0.0)
        start = all_.lo[panel] + from_lo
        nearest = NEAREST * (all_.origin + start + length)
        to_kink = from_lo + all_.kink[panel]
        from_x = x * kernel.above - np.minimum(behind, 0.0)
        to_pole = -behind if kernel.pole == kernel.hi else (all_.origin - x / kernel.pole) + start
        before = np.where(
            own_start,
            np.minimum(from_x if kernel.above else x, np.maximum(to_kink, nearest)),
            np.minimum(np.maximum(to_pole, nearest), all_.behind[panel]),
        )
        if kernel.hi == c:
            to_c = np.maximum(-behind, 0.0)
        else:
            to_c = np.maximum(x * (self.flat.rest / c) - ahead, 0.0)
            to_c = np.where(own_end, x * kernel.behind, to_c)
        after = np.full(len(x), np.inf)
        if kernel.at_c:
            after = np.where(own_end, length, np.maximum(to_c, nearest))
        near = np.minimum(to_kink, all_.origin + start)
        return Part(which, panel, from_x, from_lo, length, to_c, before, after, near)

    def _integral(
        self, kernel: Kernel, powers: tuple[float, float], part: Part, x: Array, over_s: bool
    ) -> Array:
        """∫ P' kernel ds, or ds/s, over all intervals with these powers, for each x."""
        sums = np.empty(len(part.which))
        longest = min(LONGEST, STEEPEST / max(1.0, self.stack.power[part.panel].max()))
        for k in range(0, len(sums), TOGETHER):
            columns: list[Any] = [column[k : k + TOGETHER] for column in part]
            which, panel, from_x, from_lo, length, to_c, before, after, near = columns
            owner, ahead, left, weight = graded(
                length, before, after, powers, longest=longest, near=near
            )
            to_c = to_c[owner][:, None] + (ahead if kernel.hi == self.flat.c else left)
            from_x = from_x[owner][:, None] + ahead
            at = x[which[owner]][:, None]
            s = at + from_x
            values = kernel.value(at / s, from_x / s, to_c * (self.flat.c / s)) * weight
            ahead += from_lo[owner][:, None]
            values *= self.stack(panel[owner], ahead)
            if over_s:
                values /= s
            sums[k : k + TOGETHER] = totals(owner, values, len(which))
        total: Array = np.bincount(part.which, sums, minlength=len(x)).astype(float)
        return total
