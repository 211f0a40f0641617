"""Wear of a flat punch that slides on a fixed width: modes that decay, and the even pressure left.

Archard's law on |x| < a: what is worn per time is k v p, v the speed. The worn height and the
displacement add up to a rigid approach,

    2/(π E*) ∫ ln(1/|x - t|) p_t(t) dt + k v p = const,      ∫ p dx = P,

so that p = P/(2a) + Σ C_n φ_n exp(-T/(a μ_n)), T = π E* k v t/2 a length, with the eigenvalues of
∫ ln(1/|x - t|) φ_n dt = μ_n φ_n + const on |x| < 1 among functions of zero mean (Galin 1961).

In Legendre polynomials the kernel is exact: for n >= 1

    ∫ ln(1/|x - t|) P_n(t) dt = 2/(2n + 1) [Q_{n-1}(x) - Q_{n+1}(x)],
    ∫ P_m Q_k dx = [1 - (-1)^(m+k)] / [(m - k)(m + k + 1)].

Galin, Contact Problems (1961, transl. Springer 2008); Galin & Goryacheva, PMM 41 (1977) 826-831.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import Legendre, legendre
from numpy.typing import NDArray

from sie import arguments

Array = NDArray[np.float64]

# Polynomials of each parity: the sum over them leaves 1e-12 of the first ten eigenvalues
TERMS = 120
NODES = 600  # of the angle in which p is sampled
MOST = 20  # eigenvalues that are given: of these all digits shown are right


@dataclass(frozen=True)
class WearModes:
    """The modes of wear on the fixed width 2a; `wear_modes` makes it."""

    half_width: float

    @property
    def eigenvalues(self) -> Array:
        """μ_n of the first twenty modes, descending, even and odd ones together; pure numbers."""
        return spectrum()[0][:MOST]

    @property
    def lengths(self) -> Array:
        """a μ_n: the T = π E* k v t/2 in which each mode falls to 1/e."""
        return self.half_width * self.eigenvalues

    def mode(self, n: int) -> Legendre:
        """The mode n = 0, 1, ..., as a Legendre series in x with ∫ φ² dx = a.

        Parameters
        ----------
        n : int
            Its number, from 0.

        Returns
        -------
        numpy.polynomial.Legendre
            φ_n, which is called with x.
        """
        if not arguments.among(n, range(MOST)):
            raise ValueError(f"n = {n!r} is no mode: give a whole number from 0 to {MOST - 1}")
        return self._series(spectrum()[1][:, n])

    def pressure(self, p0: Callable[[Array], Any], time: float) -> Legendre:
        """The pressure after some wear.

        Parameters
        ----------
        p0 : callable or Density
            The pressure before, a function of an array of x in (-a, a); it may be infinite at the
            ends like that of a flat punch.
        time : float
            T = π E* k v t/2, length: t in the unit of time of k v, the height that is worn per time
            and pressure.

        Returns
        -------
        numpy.polynomial.Legendre
            p(x), which is called with x; `.integ()` is its integral.

        Notes
        -----
        The load is that of p0. At times below 1e-3 a the series still has what it cuts off.
        """
        T, a = arguments.not_negative("time", time), self.half_width
        g, w = legendre.leggauss(NODES)
        angle = 0.5 * np.pi * g
        x = np.sin(angle)
        values = arguments.real_values("p0", p0, a * x) * (0.5 * np.pi * w * np.cos(angle))
        degrees = np.arange(2 * TERMS + 1)
        moments = legendre.legvander(x, 2 * TERMS).T @ values * np.sqrt(degrees + 0.5)
        mu, modes = spectrum()
        decayed = modes @ (np.exp(-T / (a * mu)) * (modes.T @ moments[1:]))
        return self._series(decayed, moments[0])

    def _series(self, normalised: Array, mean: float = 0.0) -> Legendre:
        a, degrees = self.half_width, np.arange(len(normalised) + 1)
        coefficients = np.concatenate(([mean], normalised)) * np.sqrt(degrees + 0.5)
        return Legendre(coefficients, domain=[-a, a])


@lru_cache(maxsize=1)
def spectrum() -> tuple[Array, Array]:
    """μ, descending, and the modes as columns of coefficients of orthonormal P_1, P_2, ..."""
    n = np.arange(1, 2 * TERMS + 1)
    m = n[:, None]

    def product(k: NDArray[np.int_]) -> Array:
        """∫ P_m Q_k dx."""
        odd = (m + k) % 2 == 1
        return np.where(odd, 2.0, 0.0) / np.where(odd, (m - k) * (m + k + 1), 1)

    kernel = 2.0 / (2 * n + 1) * (product(n - 1) - product(n + 1))
    norm = np.sqrt(n + 0.5)
    values, vectors = np.linalg.eigh(norm[:, None] * kernel * norm)
    return values[::-1], vectors[:, ::-1]


def wear_modes(half_width: float = 1.0) -> WearModes:
    """The modes in which the pressure under a flat punch that slides and wears becomes even.

    Parameters
    ----------
    half_width : float, optional
        Half-width a > 0 of the punch, length.

    Returns
    -------
    WearModes
        `.eigenvalues`, `.lengths`, `.mode(n)`, `.pressure(p0, time)`.

    Raises
    ------
    ValueError
        For a half-width that is not positive.

    References
    ----------
    Galin & Goryacheva, J. Appl. Math. Mech. 41 (1977) 826-831.

    Examples
    --------
    >>> import sie
    >>> sie.wear_modes().eigenvalues[:3].round(8).tolist()
    [1.56600511, 0.90972723, 0.61295835]
    """
    return WearModes(arguments.positive("half_width", half_width))
