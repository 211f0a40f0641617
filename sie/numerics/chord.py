"""The chord between two places, and the anchored points that keep its digits.

    d(x, y) = x - y  on the line,        d(x, y) = (λ/π) sin(π(x - y)/λ)  per period λ

With it the formulas of a row of patches that is repeated for ever are those of the line. A point is
an anchor, an edge of a patch, and its offset from that: the difference of two points is that of
their anchors plus that of their offsets, so that a point 1e-15 beside an edge is as good as any.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Points:
    """Places anchor + offset; the offset may be complex, a point of the plane."""

    anchor: Any
    offset: Any

    def __getitem__(self, k: Any) -> Points:
        return Points(self.anchor[k], self.offset[k])

    @property
    def x(self) -> Any:
        return self.anchor + self.offset


def _parity(turns: Any) -> Any:
    """-1 of odd numbers, 1 of even ones."""
    return 1.0 - 2.0 * np.abs(turns - 2.0 * np.rint(0.5 * turns))


def _cosine_and_sine(angle: Any) -> tuple[Any, Any]:
    """By the tangent of half the angle: NumPy takes twenty of those while it takes one sine."""
    if np.iscomplexobj(angle):
        return np.cos(angle), np.sin(angle)
    t = np.tan(0.5 * angle)
    square = 1.0 / (1.0 + t * t)
    return (1.0 - t) * (1.0 + t) * square, 2.0 * t * square


@dataclass(frozen=True)
class Chord:
    """Differences and chords of places; `period` is inf on the line."""

    period: float = np.inf

    @property
    def periodic(self) -> bool:
        return self.period < np.inf

    def __call__(self, step: Any) -> Any:
        """d of differences shorter than a period, which may be complex."""
        return self.both(0.0, step)[0] if self.periodic else step

    def logarithm(self, step: Any) -> Any:
        """ln|d| of such differences."""
        return np.log(np.abs(self(step)))

    def apart(self, step: Any, offset: Any = 0.0) -> Any:
        """d for a difference of anchors and one of offsets. Whole periods go into the sign."""
        return self.both(step, offset)[0] if self.periodic else step + offset

    def cosine(self, step: Any, offset: Any = 0.0) -> Any:
        """cos(π(x - y)/λ); 1 on the line."""
        return self.both(step, offset)[1]

    def both(self, step: Any, offset: Any = 0.0) -> tuple[Any, Any]:
        """d and cos(π(x - y)/λ), with which d of a sum of differences is that of a sine."""
        if not self.periodic:
            return step + offset, np.ones_like(step + offset)
        turns = np.rint(step / self.period)
        angle = (np.pi / self.period) * ((step - turns * self.period) + offset)
        cosine, sine = _cosine_and_sine(angle)
        sign = _parity(turns)
        return ((self.period / np.pi) * sign) * sine, sign * cosine

    def beyond(self, t: Points, x: Points) -> Any:
        """d(t, x) of sources (m, s) that share an anchor (m, 1) and places (m, n): (m, n, s).

        The places are farther from the anchor than the sources. The addition theorem takes a sine
        of each, not of each pair.
        """
        step = t.anchor - x.anchor
        if not self.periodic:
            return (step - x.offset)[:, :, None] + t.offset[:, None, :]
        far = np.stack(self.both(step, -x.offset), axis=2)
        cosine, sine = _cosine_and_sine((np.pi / self.period) * t.offset)
        return far @ np.stack((cosine, (self.period / np.pi) * sine), axis=1)

    def sign(self, step: Any) -> Any:
        """-1 where `difference` takes an odd number of periods out of a step; 1 elsewhere."""
        if not self.periodic:
            return np.ones_like(step)
        return _parity(np.rint(step / self.period))

    def difference(self, step: Any, offset: Any = 0.0) -> Any:
        """x - y, less whole periods of the anchors' difference."""
        if not self.periodic:
            return step + offset
        return (step - self.period * np.rint(step / self.period)) + offset

    def kernel(self, step: Any) -> Any:
        """1/(x - t) of steps x - t; per period (π/λ) cot(π(x - t)/λ), the sum over all. 0 at 0."""
        zero = step == 0.0
        if not self.periodic:
            return 1.0 / (np.where(zero, np.inf, step) if zero.any() else step)
        angle = (np.pi / self.period) * np.where(zero, 0.5 * self.period, step)
        return np.where(zero, 0.0, (np.pi / self.period) / np.tan(angle))

    def poles(self, step: Any) -> tuple[Any, Any]:
        """1/(x - t) and 1/(x - t)² of steps x - t that are not 0; per period the sums over all."""
        if not self.periodic:
            simple = 1.0 / step
            return simple, simple * simple
        wave = np.pi / self.period
        simple = wave / np.tan(wave * step)
        return simple, simple * simple + wave * wave

    def distance(self, x: Any, lo: Any, hi: Any) -> Any:
        """The distance of x from [lo, hi], or from its nearest repetition."""
        middle = 0.5 * (lo + hi)
        return np.abs(self.difference(x - middle)) - 0.5 * (hi - lo)
