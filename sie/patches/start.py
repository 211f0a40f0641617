"""A first guess of the patches: conjugate gradients on a grid, from coarse grids to fine ones.

The pressure minimises ½∫p u + ∫p h under p >= 0 and ∫p = P (Polonsky & Keer 1999), with
u = -1/(πG) ∫p ln|x - t| on the line and the harmonics p_k/(G|k|) per period; each product takes two
FFTs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

COARSEST = 256  # cells
# of the coarsest of the grids that lead to a fine one: the even lengths of fast transforms
FAST = (144, 150, 160, 180, 192, 200, 216, 240, COARSEST)
ITERATIONS, PRECONDITIONED = 400, 200  # on one grid
# Steps from one look for overlaps to the next: new contact ends the conjugate directions, and in
# noise some comes with every step
SELDOM = 5
# relative changes of the pressure in a step: below them a grid is done, and may be used
STILL, LAST = 1e-5, 2e-4


class Grid(NamedTuple):
    """Cells of length dx from lo, and p, the pressure over E*/2 on each.

    `periodic`: whether the grid is a period.
    """

    lo: float
    dx: float
    p: Array
    periodic: bool

    @property
    def x(self) -> Array:
        return np.asarray(self.lo + self.dx * (np.arange(len(self.p)) + 0.5), dtype=float)


def grid_pressure(
    height: Callable[[Array], Array],
    window: tuple[float, float],
    cells: int,
    load: float,
    periodic: bool,
) -> Grid:
    """The pressure over E*/2 on a grid of the window.

    Heights may be infinite where there is no indenter.
    """
    lo, hi = window
    n = cells
    while n > COARSEST:
        n //= 2
    p = np.ones(0)
    while True:
        dx = (hi - lo) / n
        h = height(np.asarray(lo + dx * (np.arange(n) + 0.5), dtype=float))
        p = np.repeat(p, n // len(p)) if p.size else np.isfinite(h).astype(float)
        p = np.where(np.isfinite(h), p, 0.0)
        if not p.any():
            p = np.isfinite(h).astype(float)
        p *= load / (p.sum() * dx)
        p = _relaxed(h, p, dx, load, periodic)
        if n >= cells:
            return Grid(lo, dx, p, periodic)
        n *= 2


def cells_of(least: float) -> int:
    """The fewest cells, not fewer than these, of a grid that is fast on all levels."""
    doubled = 1 << max(math.ceil(math.log2(least / COARSEST)), 0)
    return doubled * next(n for n in FAST if n * doubled >= least)


def _influence(n: int, dx: float, periodic: bool) -> Array:
    """The transform of the displacement under a load on one cell."""
    if periodic:
        k = 2.0 * np.pi * np.arange(n // 2 + 1) / (n * dx)
        with np.errstate(divide="ignore"):
            # over the mean of a cell: sinc
            return np.where(k > 0.0, np.sinc(0.5 * k * dx / np.pi) / k, 0.0)
    offset = np.arange(n + 1) + 0.5
    primitive = offset * (np.log(offset) - 1.0)
    kernel = np.empty(n + 1)
    kernel[1:] = np.diff(primitive)
    kernel[0] = 2.0 * primitive[0]
    kernel = (dx / np.pi) * (np.log(n) - kernel)  # lengths over the window: more load sinks more
    return np.fft.rfft(np.concatenate((kernel, kernel[-2:0:-1]))).real


def _relaxed(h: Array, p: Array, dx: float, load: float, periodic: bool) -> Array:
    n = len(h)
    size = n if periodic else 2 * n
    K = _influence(n, dx, periodic)
    k = np.asarray(2.0 * np.pi * np.arange(size // 2 + 1) / (size * dx), dtype=float)
    system = System(h, dx, load, K)
    found, done = _gradients(system, p, k, PRECONDITIONED)
    if not done:  # noise from cell to cell lets preconditioned steps go to and fro
        found, _ = _gradients(system, p, np.ones_like(k), ITERATIONS)
    if not (found > 0.0).any() or not np.isfinite(found).all():
        raise FloatingPointError("no pressure on the grid")
    return found


class System(NamedTuple):
    """Heights on cells dx, the load, and the transform of the displacement."""

    h: Array
    dx: float
    load: float
    influence: Array

    def transformed(self, q: Array, factors: Array) -> Array:
        """The product of q with the operator that has these factors of its harmonics."""
        size = 2 * (len(self.influence) - 1)
        return np.asarray(np.fft.irfft(np.fft.rfft(q, size) * factors, size)[: len(self.h)])

    def displaced(self, q: Array) -> Array:
        return self.transformed(q, self.influence)


def _gradients(system: System, p: Array, stiffness: Array, most: int) -> tuple[Array, bool]:
    """The pressure after steps of conjugate gradients, and whether the last ones were small.

    `stiffness` of the harmonics preconditions them (Vollebregt 2014): |k| nearly inverts 1/|k|, and
    1 leaves them plain. Directions are those of Polak & Ribiere, as the contact changes.
    """
    solid = np.isfinite(system.h)
    h = np.where(solid, system.h, 0.0)
    t, last, before, conjugate = np.zeros(len(h)), np.zeros(len(h)), 1.0, 0.0
    change = 1.0
    for number in range(most):
        contact = p > 0.0
        if not contact.any() or not np.isfinite(p).all():
            return p, False
        gap = system.displaced(p) + h
        gap -= gap[contact].mean()
        r = np.where(contact, gap, 0.0)
        z = system.transformed(r, stiffness)
        now = float(r @ z)
        if now <= 0.0:
            return p, now == 0.0
        turn = max(float((r - last) @ z), 0.0)
        t = np.where(contact, z + conjugate * (turn / before) * t, 0.0)
        before, last = now, r
        t[contact] -= t[contact].mean()
        along = float(t @ system.displaced(t))
        if along == 0.0:  # the load is lost in the rounding of h
            return p, True
        step = float(r @ t) / along
        old = p
        p = np.maximum(p - step * t, 0.0)
        looks = change <= STILL or number % SELDOM == 0
        overlap = (p == 0.0) & (gap < 0.0) & solid & looks
        conjugate = 0.0 if overlap.any() else 1.0
        if overlap.any():
            deep = np.where(overlap, gap, 0.0)
            p = np.maximum(p - (deep @ deep) / (deep @ system.displaced(deep)) * deep, 0.0)
        p *= system.load / (p.sum() * system.dx)
        change = float(np.abs(p - old).sum() / p.sum())
        if change <= STILL and looks and not overlap.any():
            return p, True
    return p, change <= LAST
