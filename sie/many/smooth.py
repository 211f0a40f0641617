"""Newton's method for many contacts, and slopes that are smooth there, by their values at nodes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS

Array = NDArray[np.float64]

MOST_STEPS, CLOSE = 40, 1e-8  # of Newton's method; what is left is the square of the last step
SIZES = (24, 48, 96, 192)  # nodes of a smooth slope
RESOLVED, MISSED = 2e-14, 1e-12  # its last coefficients, and what it may miss at probes
PROBES = np.array([-0.9413, -0.6137, -0.2871, 0.0519, 0.3833, 0.7211, 0.9687])
FARTHER = np.array([1.25, 1.7, 2.5, 4.0, 8.0, 16.0, 64.0])  # half-widths, where a slope has to rise
BISECTIONS = 60


class Contact(NamedTuple):
    """Contacts of n scenes: centre, half-width, T = P/G and the moment about the centre over G."""

    m: Array
    r: Array
    T: Array
    about: Array


class Integrals(NamedTuple):
    """∫H dφ, ∫H s dφ, ∫H_s dφ, ∫H_s s dφ and ∫H (1 - s²) dφ, H_s the derivative by s."""

    I0: Array
    I1: Array
    J0: Array
    J1: Array
    C2: Array


def newton(
    integrals: Callable[[Array, Array], Integrals],
    start: tuple[Array, Array],
    size: Array,
    of_width: bool,
) -> Contact:
    """I0 = 0 and r I1 = T for m and ln r, or for m alone where r is given.

    The derivatives of I0 and of r I1 by m and r are J0/r, J1/r and J1, J0.
    """
    m, r = start
    for _ in range(MOST_STEPS):
        k = integrals(m, r)
        carried = r * k.I1
        lacks = 0.0 * r if of_width else np.log(size / carried)
        J1 = 0.0 * r if of_width else k.J1
        # J is indefinite where the slope does not rise; then nothing settles
        det = k.J0 * k.J0 - J1 * J1
        dm = -(k.I0 * k.J0 * r + J1 * carried * lacks) / det
        du = (k.J0 * k.I1 * lacks + J1 * k.I0) / det
        lost = ~np.isfinite(lacks + dm + du)
        m = m + np.where(lost, 0.0, np.clip(dm, -r, r))
        r = r * np.exp(np.where(lost, 0.0 if of_width else 1.0, np.clip(du, -3.0, 3.0)))
        left = np.where(lost, np.inf, np.maximum(np.abs(du), np.abs(dm) / r))
        if not (left > CLOSE).any():
            break
    k = integrals(m, r)
    r = np.where((left <= CLOSE) & np.isfinite(k.C2), r, np.nan)
    return Contact(m, r, r * k.I1 if of_width else size, -r * r * k.C2)


@dataclass(frozen=True)
class Smooth:
    """A slope that is smooth in the contact; where its nodes do not resolve it, answers are nan.

    slope      H at places (n, k), with parameters (n, 1) of these names
    axis       of symmetry, or None
    breaks     where H is not smooth
    domain     where H is known
    convex     whether H is known to rise
    """

    slope: Callable[..., Any]
    names: tuple[str, ...] = ()
    axis: float | None = None
    breaks: tuple[float, ...] = ()
    domain: tuple[float, float] = (-math.inf, math.inf)
    convex: bool = False
    tilts: bool = True

    def H(self, x: Array, tilt: Array, *values: Array) -> Array:
        """h' with the tilt, at x (n, k); infinite beyond the domain."""
        given = dict(zip(self.names, (v.reshape(-1, 1) for v in values), strict=True))
        lo, hi = self.domain
        h = np.broadcast_to(np.asarray(self.slope(np.clip(x, lo, hi), **given), float), x.shape)
        outside = (x < lo) | (x > hi)
        return np.where(outside, np.copysign(np.inf, x - lo), h + tilt.reshape(-1, 1))

    def contact(self, size: Array, tilt: Array, of_width: bool, *values: Array) -> Contact:
        """The contacts under T, or of half-widths r; nan where there is no answer."""
        upright = self.axis is not None and not tilt.any()
        m = np.full(size.shape, self.axis) if upright else self._lowest(size, tilt, *values)
        best = Contact(m.copy(), *(np.full(size.shape, np.nan) for _ in range(3)))
        for N in SIZES:
            left = np.flatnonzero(np.isnan(best.r))
            if not left.size:
                break
            some, *own = (v[left] for v in (size, tilt, *values))
            found = newton(
                lambda m, r: self._integrals(m, r, N, *own),  # noqa: B023
                (m[left], some),
                some,
                of_width,
            )
            good = self._resolved(found, N, *own)
            for old, new in zip(best, found, strict=True):
                old[left[good]] = new[good]
        return best

    def _lowest(self, step: Array, tilt: Array, *values: Array) -> Array:
        """Where H = 0, by bisection between places found at growing distances."""
        lo, hi = -step, step.copy()
        for _ in range(BISECTIONS):
            wide = self.H(np.stack((lo, hi), axis=1), tilt, *values)
            lo = np.where(wide[:, 0] > 0.0, 2.0 * lo, lo)
            hi = np.where(wide[:, 1] < 0.0, 2.0 * hi, hi)
        for _ in range(BISECTIONS):
            middle = 0.5 * (lo + hi)
            below = self.H(middle[:, None], tilt, *values)[:, 0] < 0.0
            lo, hi = np.where(below, middle, lo), np.where(below, hi, middle)
        return 0.5 * (lo + hi)

    def _coefficients(self, m: Array, r: Array, N: int, *own: Array) -> Array:
        places = m[:, None] + r[:, None] * chebyshev.points(N)
        return np.asarray(self.H(places, *own) @ chebyshev.charges(N).T)

    def _integrals(self, m: Array, r: Array, N: int, *own: Array) -> Integrals:
        c, n = self._coefficients(m, r, N, *own), np.arange(N)
        J0, J1 = c[:, 1::2] @ n[1::2], c[:, ::2] @ n[::2]
        parts = c[:, 0], 0.5 * c[:, 1], J0, J1, 0.5 * c[:, 0] - 0.25 * c[:, 2]
        return Integrals(*(np.asarray(math.pi * part) for part in parts))

    def _resolved(self, found: Contact, N: int, *own: Array) -> NDArray[np.bool_]:
        """Whether the series is H: it decays, meets H elsewhere, and H rises as far as is seen."""
        m, r = found.m[:, None], found.r[:, None]
        c = self._coefficients(found.m, found.r, N, *own)
        size = np.abs(c).max(axis=1)
        missed = self.H(m + r * PROBES, *own) - chebyshev.evaluate(c.T[:, :, None], PROBES)
        good = _decays(c) & (np.abs(missed).max(axis=1) <= MISSED * size)
        for b in (*self.breaks, *self.domain):
            good &= np.abs(b - found.m) >= found.r * (1.0 if b in self.breaks else 1.0 + EPS)
        if not self.convex:
            places = np.concatenate((-FARTHER[::-1], np.linspace(-1.0, 1.0, 33), FARTHER))
            rise = np.diff(self.H(np.clip(m + r * places, *self.domain), *own), axis=1)
            good &= (rise >= -MISSED * size[:, None]).all(axis=1)
        return np.asarray(good)

    def pressure(self, x: Array, found: Contact, *own: Array) -> Array:
        """p/G at x (n, k) from the centre."""
        s = x / found.r
        for N in SIZES:
            c = self._coefficients(found.m[:, 0], found.r[:, 0], N, *own)
            if _decays(c).all():
                break
        U = chebyshev.evaluate_second_kind(c.T[1:, :, None], s)
        return np.asarray(np.sqrt(np.maximum((1.0 - s) * (1.0 + s), 0.0)) * U)


def _decays(c: Array) -> NDArray[np.bool_]:
    return np.asarray(np.abs(c[:, -3:]).max(axis=1) <= RESOLVED * np.abs(c).max(axis=1))
