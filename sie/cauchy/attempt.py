"""The density from so many nodes, and its errors: decay, residual, rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics import chebyshev
from sie.numerics.interval import EPS

from .density import JacobiDensity, Part
from .formulation import PROBES, Problem, constant_of, positive
from .rounding import Spread

Array = NDArray[Any]

TAIL = 2  # the last coefficients that must have decayed ...
DECAYED = 0.1  # ... to this part of the tolerance, relative to the largest
ROUNDING = 4.0 * EPS  # of the largest term of the equation: coefficients below it have decayed
# The rounding of numbers below 2e-308, which have fewer digits than others.
SUBNORMAL = 64.0 * 5e-324


class Attempt(NamedTuple):
    """A density and its estimated errors, relative.

    For each interval they are the decay of the coefficients, the residual (and the error that it
    does not show), and the rounding of both. The constant by which g is not consistent follows, and
    the effect of rounding on each interval where that takes another solution.
    """

    density: JacobiDensity
    tails: Array
    residuals: Array
    rounding: Array
    noise: Array
    defect: float
    spreads: Callable[[], list[Spread]]

    @property
    def progress(self) -> float:
        """The error without rounding, which more nodes may reduce."""
        return max(float(self.tails.max()), float(self.residuals.max()))

    def unresolved(self, tol: float) -> NDArray[np.bool_]:
        """Whether each part is not resolved to tol: its tail or its residual is too large."""
        tails = self.tails > np.maximum(DECAYED * tol, self.rounding)
        residuals = self.residuals > np.maximum(tol, self.noise)
        unresolved: NDArray[np.bool_] = tails | residuals
        return unresolved

    def answer(self) -> JacobiDensity:
        """The density; its errors include those of rounding."""
        spreads = self.spreads()
        parts = tuple(
            part.less_certain(of.coefficients)
            for part, of in zip(self.density.parts, spreads, strict=True)
        )
        return replace(
            self.density,
            parts=parts,
            error=max(self.density.error, *(of.relative for of in spreads)),
        )


class Terms(NamedTuple):
    """The terms of the equation on one interval, times dx/ds.

    They are its nodes, the residual at PROBES, and two terms of it everywhere. The relative error
    of the integrals at its nodes follows, and the error of the terms by rounded positions.
    """

    n: int
    left_over: Array
    wanted: Array
    other: Array
    aliased: float
    unsure: float


def attempted(
    problem: Problem,
    coefficients: list[Array],
    unknown: Array,
    terms: list[Terms],
    spreads: Callable[[], list[Spread]],
) -> Attempt:
    """The density of these coefficients, with its residuals, tails and rounding."""
    largest = max(float(np.abs(c).max()) for c in coefficients)
    measured = [
        _measured(problem, i, c, of, largest)
        for i, (c, of) in enumerate(zip(coefficients, terms, strict=True))
    ]
    parts = tuple(of.part for of in measured)
    residuals = np.array([of.residual for of in measured])
    tails = np.array([of.tail for of in measured])
    error = max(float(tails.max()), float(residuals.max()), 2.0 * EPS)
    constants, lacking = unknown[: len(problem.free)], unknown[len(problem.free) :]
    density = JacobiDensity(
        parts, tuple(constants.tolist()), tuple(of.n for of in terms), error, float(residuals.max())
    )
    g = max(float(np.abs(of.wanted).max()) for of in terms)
    defect = (
        float(np.abs(lacking).max(initial=0.0)) * max(m.stretch for m in measured) / positive(g)
    )
    rounding = np.array([of.rounding for of in measured])
    noise = np.array([of.noise for of in measured])
    return Attempt(density, tails, residuals, rounding, noise, defect, spreads)


class _Measured(NamedTuple):
    part: Part
    tail: float
    residual: float
    rounding: float
    noise: float
    stretch: float


def _measured(problem: Problem, i: int, c: Array, of: Terms, largest: float) -> _Measured:
    """The coefficients of one interval that are kept, and their errors.

    Residuals are weighted as in the norm in which the singular operator is an isometry: next to a
    singular end of 1/w they mean less.
    """
    interval, weight = problem.maps[i], problem.weights[i]
    scale = positive(np.abs(c).max(), EPS * largest)
    term = positive(np.abs(of.wanted).max(), np.abs(of.other).max())
    inverse = weight.inverse
    norm = (1.0 - PROBES) ** (0.5 * inverse.alpha.real + 0.25) * (1.0 + PROBES) ** (
        0.5 * inverse.beta.real + 0.25
    )
    residual = max(float((np.abs(of.left_over) * norm).max() / (term * norm.max())), of.aliased)
    rough = max(ROUNDING * term, of.unsure, SUBNORMAL)
    rounding = rough * abs(inverse.total) ** 0.5 / (abs(constant_of(problem, weight)) * scale)
    tail = float(np.abs(c[-TAIL:]).max()) / scale
    kept = chebyshev.chopped_length(c, 0.25 * EPS * scale)
    part = Part(
        interval,
        weight,
        c[:kept],
        np.full(kept, max(tail, residual, 2.0 * EPS) * scale / len(c) ** 0.5),
    )
    middle = interval.distances(np.ones(1), np.ones(1))[2]
    return _Measured(part, tail, residual, float(rounding), rough / term, float(middle[0]))
