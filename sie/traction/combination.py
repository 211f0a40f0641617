"""Multiples and sums of tractions. Full sliding is friction times pressure.

Potentials are linear, so that a stress evaluates each density once (`Density.bases`), however often
it occurs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sie import arguments
from sie.arguments import abridged
from sie.inheritance import override

from .base import Density, refuse_side, zero_or_nan

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# How far beside a place, of the interval, a sum is looked at whose terms are infinite there.
BESIDE, CLOSER = 1e-7, 1e-9
GROWS = 1e-4  # of the size of the terms: by so much it grows in between where it is infinite


@dataclass(frozen=True, eq=False)
class Combination(Density):
    """Σ factor × density, each zero outside its own interval.

    `resultant` and `moment` are theirs, summed. `superposed` builds it; without terms it is no
    traction, `ZERO`.

    >>> Combination(((2.0, ZERO),)).resultant
    0.0
    """

    terms: tuple[tuple[float, Density], ...] = ()

    def __repr__(self) -> str:
        return f"Combination(({abridged(self.terms)}))"

    @cached_property
    def resultant(self) -> float:  # type: ignore[override]
        """∫p dx, the sum of those of the terms."""
        return sum((factor * density.resultant for factor, density in self.terms), 0.0)

    @cached_property
    def moment(self) -> float:  # type: ignore[override]
        """∫p x dx, the sum of those of the terms."""
        return sum((factor * density.moment for factor, density in self.terms), 0.0)

    @property
    @override
    def interval(self) -> tuple[float, float]:
        ends = [density.interval for _, density in self.terms]
        lo, hi = min((a for a, _ in ends), default=0.0), max((b for _, b in ends), default=0.0)
        return lo, hi

    @property
    @override
    def breaks(self) -> tuple[float, ...]:
        return tuple(sorted({b for _, density in self.terms for b in density.breaks}))

    @property
    @override
    def singular(self) -> tuple[float, ...]:
        return tuple(sorted({b for _, density in self.terms for b in density.singular}))

    @property
    @override
    def bases(self) -> tuple[tuple[float, Density], ...]:
        return tuple(
            (factor * inner, part)
            for factor, density in self.terms
            for inner, part in density.bases
        )

    @property
    @override
    def hilbert_at_edges(self) -> tuple[float, float]:
        x1, x2 = self.interval
        return self._limit(x1, 0), self._limit(x2, 1)

    def _limit(self, x: float, end: int) -> float:
        return sum(
            factor
            * (
                d.hilbert_at_edges[end]
                if d.interval[end] == x
                else float(d.hilbert(np.array([x]))[0])
            )
            for factor, d in self.terms
        )

    @override
    def __call__(self, x: ArrayLike) -> Array:
        x = arguments.reals("x", x)
        flat = x.ravel()
        with np.errstate(invalid="ignore"):
            total: Array = self._total([density(flat) for _, density in self.terms], flat)
        for k in np.flatnonzero(np.isnan(total) & ~np.isnan(flat)):
            total[k] = self._beside(float(flat[k]), lambda density, y: density(y))
        return total.reshape(x.shape)

    def _beside(self, x: float, value: Callable[[Density, Array], Array]) -> float:
        """The sum at x, where terms are infinite, by values beside: infinite where it grows."""
        lo, hi = self.interval
        far, near = (part * (hi - lo) for part in (BESIDE, CLOSER))
        places = np.array([[y, z] for y, z in ((x + far, x + near), (x - far, x - near))])
        places = places[(lo < places[:, 0]) & (places[:, 0] < hi)]
        values = [factor * value(density, places.ravel()) for factor, density in self.terms]
        sums, size = (np.sum(v, axis=0).reshape(-1, 2) for v in (values, np.abs(values)))
        rise = float(sums[0, 1] - sums[0, 0])
        if abs(rise) > GROWS * size.max():
            return math.copysign(math.inf, rise)
        return float(sums[:, 0].mean())

    def _steepness(self, x: float) -> float:
        return self._beside(x, lambda density, y: density.cauchy_derivative(y).imag)

    @override
    def hilbert(self, x: ArrayLike) -> Array:
        values = [density.hilbert(x) for _, density in self.terms]
        total: Array = self._total(values, arguments.reals("x", x))
        return total

    @override
    def cauchy(self, z: ArrayLike, side: int = 1) -> Complex:
        refuse_side(side)
        values = [density.cauchy(z, side) for _, density in self.terms]
        return self._without_nan(values, z, lambda x: -side * float(self(x)))

    @override
    def cauchy_derivative(self, z: ArrayLike, side: int = 1) -> Complex:
        refuse_side(side)
        values = [density.cauchy_derivative(z, side) for _, density in self.terms]
        return self._without_nan(values, z, lambda x: side * self._steepness(x))

    @override
    def potentials(self, z: ArrayLike, side: int = 1) -> tuple[Complex, Complex]:
        refuse_side(side)
        pairs = [density.potentials(z, side) for _, density in self.terms]
        F = self._without_nan([F for F, _ in pairs], z, lambda x: -side * float(self(x)))
        return F, self._without_nan([dF for _, dF in pairs], z, lambda x: side * self._steepness(x))

    def _without_nan(
        self, values: list[Complex], z: ArrayLike, imaginary: Callable[[float], float]
    ) -> Complex:
        """The sum of values at z.

        At real z where terms are infinite, its imaginary part comes from `imaginary`.
        """
        with np.errstate(invalid="ignore"):
            total: Complex = self._total(values, arguments.complexes("z", z))
        lost = np.isnan(total)
        if lost.any():
            for place in zip(*np.nonzero(np.atleast_1d(lost & ~np.isnan(z))), strict=True):
                np.atleast_1d(total.imag)[place] = imaginary(
                    float(np.atleast_1d(np.real(z))[place])
                )
        return total

    def _total(self, values: list[Any], z: Any) -> Any:
        """Σ factor × value, part by part: a real factor times inf + 0j would be nan."""
        total = zero_or_nan(z)
        for (factor, _), value in zip(self.terms, values, strict=True):
            if np.iscomplexobj(value):
                total.real += factor * value.real
                total.imag += factor * value.imag
            else:
                total += factor * value
        return total


ZERO = Combination()


def superposed(*terms: tuple[float, Density]) -> Density:
    """The sum of multiples of tractions.

    Parameters
    ----------
    *terms : (float, Density)
        Factors and tractions. Terms with the factor 0 are left out.

    Returns
    -------
    Density
        Σ factor × density; the density itself where that is all there is, `ZERO` where nothing is.

    Raises
    ------
    ValueError
        If a term is no pair of a finite factor and a density.

    Notes
    -----
    Each term is zero outside its own interval. The potentials of a density that occurs several
    times are computed once.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(2.0), modulus=1.0, normal_load=0.1)
    >>> p = sie.solve(scene).pressure
    >>> round(sie.superposed((0.3, p), (-0.1, p)).resultant, 12)
    0.02
    """
    pairs = [arguments.listed("a term", term, "(factor, density)") for term in terms]
    for pair in pairs:
        if len(pair) != 2 or not isinstance(pair[1], Density):
            raise ValueError(f"{pair!r} is no factor and density: give (factor, density)")
    given = [(arguments.finite("factor", factor), d) for factor, d in pairs]
    kept = tuple((factor, d) for factor, d in given if factor != 0.0 and d is not ZERO)
    if not kept:
        return ZERO
    return kept[0][1] if len(kept) == 1 and kept[0][0] == 1.0 else Combination(kept)


def scaled(factor: float, density: Density) -> Density:
    """A multiple of a traction.

    Parameters
    ----------
    factor : float
        A finite number without unit, such as the coefficient of friction.
    density : Density
        A traction.

    Returns
    -------
    Density
        factor × density; `ZERO` if the factor is 0.

    Raises
    ------
    ValueError
        If the factor is no finite number, or `density` is no density.

    Examples
    --------
    >>> import sie
    >>> sie.scaled(0.5, sie.ZERO) is sie.ZERO
    True
    """
    return superposed((factor, density))
