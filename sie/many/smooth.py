"""Slopes that are smooth in the contact, by their values at Chebyshev nodes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.inheritance import override
from sie.numerics import chebyshev
from sie.numerics.interval import EPS

from .families import Array, Contact, Family
from .newton import Integrals, newton

SIZES = (24, 48, 96, 192)  # nodes of a smooth slope
RESOLVED, MISSED = 2e-14, 1e-12  # its last coefficients, and what it may miss at probes
PROBES = np.array([-0.9413, -0.6137, -0.2871, 0.0519, 0.3833, 0.7211, 0.9687])
FARTHER = np.array([1.25, 1.7, 2.5, 4.0, 8.0, 16.0, 64.0])  # half-widths, where a slope has to rise
BISECTIONS = 60


@lru_cache(maxsize=8)
def _transform(N: int) -> tuple[Array, Array]:
    """Nodes, and the matrix from values there to Chebyshev coefficients."""
    angle = math.pi * (np.arange(N) + 0.5) / N
    matrix = 2.0 / N * np.cos(np.outer(angle, np.arange(N)))
    matrix[:, 0] *= 0.5
    return np.cos(angle), matrix


@dataclass(frozen=True)
class Smooth(Family):
    """A slope that is smooth in the contact, by its values at Chebyshev nodes.

    slope      H at places (n, k), for parameters (n, 1)
    values     the parameters, (n,)
    axis       of symmetry, or None
    breaks     where H is not smooth, and the domain
    convex     whether H is known to rise
    """

    slope: Callable[..., Any]
    values: dict[str, Array]
    axis: float | None = None
    breaks: tuple[float, ...] = ()
    domain: tuple[float, float] = (-math.inf, math.inf)
    convex: bool = False

    @override
    def takes(self, tilt: Array, of_width: bool) -> NDArray[np.bool_]:
        return np.ones(tilt.shape, dtype=bool)

    @override
    def part(self, which: Any) -> Smooth:
        values = {name: v[which] for name, v in self.values.items()}
        return Smooth(self.slope, values, self.axis, self.breaks, self.domain, self.convex)

    def H(self, x: Array, tilt: Array) -> Array:
        """h' with the tilt, at x (n, k); infinite beyond the domain."""
        given = {name: v[:, None] for name, v in self.values.items()}
        lo, hi = self.domain
        H = np.broadcast_to(np.asarray(self.slope(np.clip(x, lo, hi), **given), float), x.shape)
        return np.where((x < lo) | (x > hi), np.copysign(np.inf, x - lo), H + tilt[:, None])

    @override
    def contact(self, size: Array, tilt: Array, of_width: bool) -> Contact:
        with np.errstate(all="ignore"):  # what that leaves is nan, and answered elsewhere
            upright = self.axis is not None and not tilt.any()
            m = np.full(size.shape, self.axis) if upright else self._lowest(tilt, size)
            best = Contact(m.copy(), np.full(size.shape, np.nan), size.copy(), size.copy())
            for N in SIZES:
                left = np.flatnonzero(np.isnan(best.r))
                if not left.size:
                    break
                some, free = self.part(left), (not upright, not of_width)
                found = newton(
                    lambda m, r: some._integrals(m, r, tilt[left], N),  # noqa: B023
                    (m[left], size[left]),
                    size[left],
                    free,
                )
                good = some._resolved(found, tilt[left], N)
                for old, new in zip(best, found, strict=True):
                    old[left[good]] = new[good]
            return best

    def _lowest(self, tilt: Array, step: Array) -> Array:
        """Where H = 0, by bisection between places found at growing distances."""
        lo, hi = -step, step.copy()
        for _ in range(BISECTIONS):
            wide = self.H(np.stack((lo, hi), axis=1), tilt)
            lo, hi = (
                np.where(wide[:, 0] > 0.0, 2.0 * lo, lo),
                np.where(wide[:, 1] < 0.0, 2.0 * hi, hi),
            )
        for _ in range(BISECTIONS):
            middle = 0.5 * (lo + hi)
            below = self.H(middle[:, None], tilt)[:, 0] < 0.0
            lo, hi = np.where(below, middle, lo), np.where(below, hi, middle)
        return 0.5 * (lo + hi)

    def _coefficients(self, m: Array, r: Array, tilt: Array, N: int) -> Array:
        s, matrix = _transform(N)
        return np.asarray(self.H(m[:, None] + r[:, None] * s, tilt) @ matrix)

    def _integrals(self, m: Array, r: Array, tilt: Array, N: int) -> Integrals:
        c, n = self._coefficients(m, r, tilt, N), np.arange(N)
        J0, J1 = c[:, 1::2] @ n[1::2], c[:, ::2] @ n[::2]
        parts = c[:, 0], 0.5 * c[:, 1], J0, J1, 0.5 * c[:, 0] - 0.25 * c[:, 2]
        return Integrals(*(np.asarray(math.pi * part) for part in parts))

    def _resolved(self, found: Contact, tilt: Array, N: int) -> NDArray[np.bool_]:
        """Whether the series is H: it decays, meets H elsewhere, and H rises as far as is seen."""
        m, r = found.m[:, None], found.r[:, None]
        c = self._coefficients(found.m, found.r, tilt, N)
        size = np.abs(c).max(axis=1)
        missed = self.H(m + r * PROBES, tilt) - chebyshev.evaluate(c.T[:, :, None], PROBES)
        good = np.abs(c[:, -3:]).max(axis=1) <= RESOLVED * size
        good &= np.abs(missed).max(axis=1) <= MISSED * size
        for b in (*self.breaks, *self.domain):
            good &= np.abs(b - found.m) >= found.r * (1.0 if b in self.breaks else 1.0 + EPS)
        if not self.convex:
            places = np.concatenate((-FARTHER[::-1], np.linspace(-1.0, 1.0, 33), FARTHER))
            lo, hi = self.domain
            H = self.H(np.clip(m + r * places, lo, hi), tilt)
            good &= (np.diff(H, axis=1) >= -MISSED * size[:, None]).all(axis=1)
        return np.asarray(good)

    @override
    def pressure(self, contact: Contact, tilt: Array, x: Array) -> Array:
        s = x / contact.r[:, None]
        for N in SIZES:
            c = self._coefficients(contact.m, contact.r, tilt, N)
            if (np.abs(c[:, -3:]).max(axis=1) <= RESOLVED * np.abs(c).max(axis=1)).all():
                break
        U = chebyshev.evaluate_second_kind(c.T[1:, :, None], s)
        return np.asarray(np.sqrt(np.maximum((1.0 - s) * (1.0 + s), 0.0)) * U)
