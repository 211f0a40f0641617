"""Tractions made of others: a multiple, a sum. Full sliding is friction times pressure; nothing is solved twice.

Potentials are linear, so that a stress asks each density underneath once (`Density.parts`), however often it occurs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .density import ZERO, Density

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Sum(Density):
    """Σ factor × density. `superposed` builds it."""

    terms: tuple[tuple[float, Density], ...]

    @property
    def resultant(self) -> float:  # type: ignore[override]
        return sum(factor * d.resultant for factor, d in self.terms)

    @property
    def moment(self) -> float:  # type: ignore[override]
        return sum(factor * d.moment for factor, d in self.terms)

    @property
    def interval(self) -> tuple[float, float]:
        lows, highs = zip(*(d.interval for _, d in self.terms), strict=True)
        return min(lows), max(highs)

    @property
    def breaks(self) -> tuple[float, ...]:
        return tuple(sorted({b for _, d in self.terms for b in d.breaks}))

    @property
    def parts(self) -> tuple[tuple[float, Density], ...]:
        return tuple((factor * inner, part) for factor, d in self.terms for inner, part in d.parts)

    @property
    def hilbert_at_edges(self) -> tuple[float, float]:
        x1, x2 = self.interval
        return self._limit(x1, 0), self._limit(x2, 1)

    def __call__(self, x: ArrayLike) -> Array:
        return self._total([d(x) for _, d in self.terms])

    def hilbert(self, x: ArrayLike) -> Array:
        return self._total([d.hilbert(x) for _, d in self.terms])

    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._total([d.cauchy(z, side) for _, d in self.terms])

    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        return self._total([d.cauchy_derivative(z, side) for _, d in self.terms])

    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        pairs = [d.potentials(z, side) for _, d in self.terms]
        return self._total([F for F, _ in pairs]), self._total([dF for _, dF in pairs])

    def _total(self, values: list[Any]) -> Any:
        """Σ factor × value, part by part: a real factor times inf + 0j would be nan."""
        total = np.zeros_like(values[0])
        for (factor, _), value in zip(self.terms, values, strict=True):
            if np.iscomplexobj(value):
                total.real += factor * value.real
                total.imag += factor * value.imag
            else:
                total += factor * value
        return total

    def _limit(self, x: float, end: int) -> float:
        return sum(
            factor * (d.hilbert_at_edges[end] if d.interval[end] == x else float(d.hilbert(np.array([x]))[0])) for factor, d in self.terms
        )


def superposed(*terms: tuple[float, Density]) -> Density:
    """Σ factor × density: zeros left out, and the density itself where that is all there is."""
    kept = tuple((float(factor), d) for factor, d in terms if factor != 0.0 and d is not ZERO)
    if not kept:
        return ZERO
    return kept[0][1] if len(kept) == 1 and kept[0][0] == 1.0 else Sum(kept)


def scaled(factor: float, density: Density) -> Density:
    """factor × density."""
    return superposed((factor, density))
