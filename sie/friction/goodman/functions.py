"""The flat punch in Goodman's approximation: p = φ(t) = 1/(π sqrt(1 - t²)) without friction, and q.

On |t| < 1 under P = 1, β > 0, with stick on |t| < k, Hq = -β p there and q = f p sgn t beside it.
Times sqrt(z² - 1) the potential of q maps the half-plane on a rectangle (its real part is known
in slip, its imaginary part in stick and beside the contact), so that with Jacobi's functions of
modulus k and z sn u = 1

    Fq(z) = f u/(π K sqrt(z² - 1)),      β/f = K'/K.

In stick t = k sn v, and q/(f p) = v/K. On the right slip zone t = dn(s, k'), and

    Hq + β p = f (K' - s)/(π K sqrt(1 - t²)) > 0.

Goodman (1962), J. Appl. Mech. 29, 515; Whittaker & Watson (1927), § 22.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.friction.coupled.flat import NARROWEST_RATIO
from sie.numerics import chebyshev
from sie.numerics.elliptic import Modulus, elliptic_functions, modulus_of_ratio
from sie.numerics.gauss_jacobi import gauss_jacobi

Array = NDArray[np.float64]

# beyond it c = 4 exp(-π K'/2K) is lost even beside a double's smallest lengths; c² is a double
WIDEST_RATIO = 200.0
CHOP = 2e-17  # of the largest coefficient

# Nodes for a function of the slip zone's elliptic coordinate, and how many more a long zone needs
NODES, PER_RATIO = 24, 14.0


def _first_kind(x: Array, y: Any, z: Any) -> Array:
    """Carlson's R_F."""
    from scipy.special import elliprf  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

    values: Array = np.asarray(elliprf(x, y, z), dtype=float)
    return values


@dataclass(frozen=True)
class GoodmanFlat:
    """Functions of the flat punch.

    beta        β > 0
    friction    f, as far as doubles tell it from a larger one
    """

    beta: float
    friction: float

    @cached_property
    def modulus(self) -> Modulus:
        return modulus_of_ratio(min(self.beta / self.friction, WIDEST_RATIO))

    @property
    def k(self) -> float:
        """Half the width of the stick zone."""
        return self.modulus.k

    def ratio(self, part: Array, from_stick: Array, square: Array) -> Array:
        """q/(f p) at t = k part, given 1 - |part| and 1 - t²."""
        size = np.abs(part)
        off = from_stick * (1.0 + size)  # 1 - part²
        ratio, complement = np.empty(part.shape), self.modulus.complement**2
        # Near the middle directly, near the end as 1 minus the complement
        middle = size < 0.5
        inner = _first_kind(off[middle], square[middle], 1.0)
        ratio[middle] = size[middle] * inner / self.modulus.K
        near = ~middle
        outer = _first_kind(complement * size[near] ** 2, complement, square[near])
        ratio[near] = 1.0 - np.sqrt(off[near]) * outer / self.modulus.K
        values: Array = np.copysign(ratio, part)
        return values

    def slip(self, t: Array, from_edge: Array) -> Array:
        """∫ (Hq + β p) from the end of the stick zone to t on the right slip zone."""
        complement = self.modulus.complement
        rest = self.modulus.rest
        past = np.maximum(rest - from_edge, 0.0) if self.k > 0.5 else np.maximum(t - self.k, 0.0)
        square = from_edge * (1.0 + t)
        inner = past * (t + self.k)
        s = np.sqrt(square) * _first_kind(inner, t * t * complement**2, complement**2)
        return chebyshev.evaluate(self._slip, 2.0 * s / self.modulus.K_complement - 1.0)

    @property
    def slip_places(self) -> tuple[Array, Array, Array]:
        """t, 1 - t and dt of a rule over the right slip zone."""
        zone = self.modulus.swapped
        x, rest, w = gauss_jacobi(self._nodes, 0.0, 0.0)
        sn, cn, dn = elliptic_functions(zone, x, rest)
        square = (zone.k * sn) ** 2
        return dn, square / (1.0 + dn), zone.K * w * zone.k**2 * sn * cn

    @property
    def _nodes(self) -> int:
        return NODES + math.ceil(PER_RATIO * self.modulus.K_complement / self.modulus.K)

    @cached_property
    def _slip(self) -> Array:
        """Series in s/K' of f/(π K) ∫_s^K' (Θ(u) - Θ(s)) du, Θ = arcsin(k' sn(u, k'))."""
        zone = self.modulus.swapped
        n = self._nodes
        s = 0.5 * (1.0 + chebyshev.points(n))
        _, rest, w = gauss_jacobi(n, 0.0, 0.0)

        def angle(part: Array, remaining: Array) -> Array:
            sn, _, dn = elliptic_functions(zone, part, remaining)
            values: Array = np.arctan2(zone.k * sn, dn)
            return values

        left = (1.0 - s)[:, None]
        inner = angle(1.0 - left * rest, left * rest)
        integral = zone.K * left[:, 0] * (inner @ w - angle(s, 1.0 - s))
        return chopped(self.friction / (math.pi * self.modulus.K) * chebyshev.transform(integral))


@lru_cache(maxsize=8)
def goodman_flat(beta: float, friction: float) -> GoodmanFlat:
    """Where the slip zone would be narrower than rounding, f is that which makes it so wide."""
    return GoodmanFlat(beta, min(friction, beta / NARROWEST_RATIO))


def chopped(c: Array, least: float = CHOP) -> Array:
    """A series without its last coefficients below this part of the largest one."""
    kept = np.flatnonzero(np.abs(c) > least * np.abs(c).max())
    return c[: kept[-1] + 1] if kept.size else c[:1]
