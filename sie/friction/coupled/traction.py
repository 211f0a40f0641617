"""The tractions of coupled partial slip, with their potentials.

Values come from the state itself; the potential from Chebyshev series on panels of each half of the
contact, cut in two until they resolve the traction, the last one times (1 - x/b)^α with the
exponent α of the edge.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import Interval
from sie.traction.base import Complex, Density, on_surface, reflected, shallow

from .half_potential import DEGREE, Panels

Array = NDArray[np.float64]

RESOLVED = 2e-14  # of the largest traction: the last coefficients of a panel
FAINT = 1e-15  # of the largest traction times b: what a short panel may miss
FAINTER = 1e-19  # the same where principal values at the panel's ends count
# Tails below ROUGH that a cut leaves above SAME of what they were are rounding
ROUGH, SAME = 1e-8, 0.8
TOLD = 1e-12  # of the distance from 0: nodes of a shorter panel are few doubles apart
LEAST = 1e-300  # of a panel, to an edge where the traction may be infinite


class OnHalves(Density):
    """A traction with panels on both sides of a place `middle` of the contact."""

    contact: Interval

    @property
    def middle(self) -> float:
        raise NotImplementedError

    @property
    def sharp(self) -> bool:
        """Whether the traction is infinite at the edges."""
        return False

    def _potentials(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        """(F, F') at z - middle, Im z > 0 (F' is 0 where it is not asked for)."""
        raise NotImplementedError

    @property
    def interval(self) -> tuple[float, float]:
        return self.contact.x1, self.contact.x2

    def hilbert(self, x: ArrayLike) -> Array:
        def principal(flat: Array) -> Array:
            z = (flat - self.middle) + 1j * shallow(self.contact.r)
            values: Array = self._potentials(np.asarray(z, dtype=complex), derivative=False)[0].real
            if self.sharp:  # as for other sharp edges
                values[(flat == self.contact.x1) | (flat == self.contact.x2)] = 0.0
            return values

        return self._on_line(principal, x)

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._in_plane(lambda u: self._value(u, self._raised(u, False)[0], side), z, side)

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._in_plane(
            lambda u: _steepness(u, self._raised(u, True)[1], side), z, side, True
        )

    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        slopes: list[Complex] = []

        def value(u: Complex) -> Complex:
            F, dF = self._raised(u, True)
            slopes.append(dF)
            return self._value(u, F, side)

        F = self._in_plane(value, z, side)
        return F, self._in_plane(lambda u: _steepness(u, slopes[0], side), z, side, True)

    def _raised(self, z: Complex, derivative: bool) -> tuple[Complex, Complex]:
        """(F, F') at z, for places on the surface a little above it."""
        raised = z - self.middle
        raised.imag[z.imag == 0.0] = shallow(self.contact.r)
        pairs = reflected(lambda u: np.stack(self._potentials(u, derivative), axis=-1), raised)
        return pairs[:, 0], pairs[:, 1]

    def _value(self, z: Complex, F: Complex, side: int) -> Complex:
        """F with the values on the surface of that side."""
        real = z.imag == 0.0
        if real.any():
            F[real] = on_surface(F.real[real], self._on_surface(z.real[real]), side)
        return F

    def _on_surface(self, x: Array) -> Array:
        """The traction at x, as the potential has it."""
        return self(x)

    def _potential(self, z: Any) -> Complex:
        return self._potentials(z, derivative=False)[0]

    def _derivative(self, z: Any) -> Complex:
        return self._potentials(z, derivative=True)[1]


def _steepness(z: Complex, dF: Complex, side: int) -> Complex:
    """F' with the values on the surface of that side."""
    dF.imag[z.imag == 0.0] *= side
    return dF


def resolved_panels(
    values: Callable[[Array, Array], Array],
    marks: tuple[float, ...],
    power: float,
    resolved: float = RESOLVED,
    short: float = 1.0,
    *,
    principal: bool = False,
    least: float = LEAST,
) -> tuple[Panels, ...]:
    """Panels of several functions of 0 < y < b that are smooth between the marks, b the last.

    `values` has a row of each, at y and b - y, which next to b is known better than from y. Panels
    that are longer than `short`, of b, are resolved at every place; of others the force alone may
    be what they are resolved to, or the principal values at their ends. Functions smaller than
    `least` are resolved as if they were as large.
    """
    b = marks[-1]
    part = 0.5 * (1.0 + chebyshev.points(DEGREE))
    ends = (0.0, *marks)
    open_ = [(lo, hi, math.inf) for lo, hi in itertools.pairwise(ends) if hi > lo]
    done: list[tuple[float, float, Array]] = []
    largest = np.full((1, 1), least)
    while open_:
        lo, hi, before = (np.array(column) for column in zip(*open_, strict=True))
        y = lo[:, None] + (hi - lo)[:, None] * part
        rest = (b - hi)[:, None] + (hi - lo)[:, None] * (1.0 - part)
        f = values(y.ravel(), rest.ravel()).reshape(-1, *y.shape)
        if hi[-1] == b:
            f[:, -1] /= (1.0 - part) ** power
        sizes = np.abs(f[..., 1:-1]).max(axis=2)
        # A short panel at a corner would hide what panels beside it miss
        inner = sizes[:, hi < b].max(axis=1, keepdims=True, initial=0.0)
        largest = np.maximum(largest, inner)
        series = chebyshev.transform(f)
        tail = np.abs(series[..., -2:]).max(axis=2) / np.maximum(sizes, largest)
        # A mark next to the axis is seen from as near as it is
        faint = FAINTER * np.where(lo > 0.0, hi, b) if principal else FAINT * b
        of_force = (tail * (hi - lo) <= faint) & (hi - lo <= short * b)
        settled = ((tail <= resolved) | of_force).all(axis=0)
        tail = tail.max(axis=0)
        settled |= (tail < ROUGH) & (tail > SAME * before)
        settled |= hi - lo <= TOLD * lo
        done += [(lo[k], hi[k], series[:, k]) for k in np.flatnonzero(settled)]
        open_ = []
        for k in np.flatnonzero(~settled).tolist():
            middle = 0.5 * (lo[k] + hi[k])
            open_ += [(lo[k], middle, tail[k]), (middle, hi[k], tail[k])]
    done.sort(key=lambda panel: panel[0])
    lo, hi = (np.array([panel[j] for panel in done]) for j in (0, 1))
    series = np.stack([panel[2] for panel in done], axis=1)
    return tuple(Panels(lo, hi, s, power) for s in series)


def joined_panels(
    values: Callable[[Array, Array], Array], marks: tuple[float, ...], power: float
) -> tuple[Panels, ...]:
    """Panels as of `resolved_panels` that meet wherever all functions are finite.

    Where two panels miss each other the principal value is infinite, like the logarithm: a straight
    line is added to each series. At marks, where what the functions miss is largest, principal
    values are as near as the series, so that even short panels have to be near.
    """
    panels = resolved_panels(values, marks, power, principal=True)
    lo = panels[0].lo
    at_ends = values(lo, marks[-1] - lo)
    # At the last mark the last series has a factor
    at_ends = np.append(at_ends, np.full((len(at_ends), 1), np.inf), axis=1)
    finite = np.asarray(np.isfinite(at_ends).all(axis=0))
    # Next to a mark as near to the edge as doubles tell values there are rounding
    finite[:-1] &= marks[-1] - lo > TOLD * marks[-1]
    signs, joined = (-1.0) ** np.arange(DEGREE), []
    for own, f in zip(panels, at_ends, strict=True):
        start = np.where(finite[:-1], f[:-1] - own.series @ signs, 0.0)
        end = np.where(finite[1:], f[1:] - own.series.sum(axis=1), 0.0)
        line = np.zeros(own.series.shape)
        line[:, :2] = 0.5 * np.stack((start + end, end - start), axis=1)
        joined.append(own._replace(series=own.series + line))
    return tuple(joined)
