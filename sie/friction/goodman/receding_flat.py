"""The rates of a flat punch whose stick zone recedes at its left end, in Goodman's approximation.

On |t| < 1 under dP = 1, p = φ(t) = 1/(π sqrt(1 - t²)), Hq = -β p on the stick zone [t1, t2] and q =
∓ f p beside it. At t2, which advances, the change of q is bounded; at t1, which recedes, it may be
infinite. With the map

    w = (t + μ)/(1 + μ t),      w = ± κ at t2, t1,      w sn(u, κ) = 1,

sqrt(t² - 1) Fq is a function on the rectangle |Re u| < K, 0 < Im u < K' with the known parts of
docs/derivations/goodman.md, and a pole at the corner that is t1. With w = κ sn v in stick,

    q/(f φ) = v/K + π d/2 [Z(v) + dn v sqrt((1 - sn v)/(1 + sn v))],      d = 4 K (K'/K - β/f)/π²,

Z Jacobi's zeta function. No resultant, Q = 0 at t = ∞, is one equation for κ, given t1:

    F/(π K) + d/2 [Z + κ (1 - κ μ) sqrt((1 - μ²)/(1 - κ² μ²))] = 0,      F and Z at sn = μ.

d = 0, μ = 0 is the flat whose stick zone advances at both ends.

Whittaker & Watson (1927), §§ 22.3, 22.73; Carlson (1979) for the integrals.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.numerics.elliptic import TERMS, modulus_of, modulus_of_ratio
from sie.numerics.interval import EPS

Array = NDArray[np.float64]

NEAREST, SETTLED = 1e-15, 4.0 * EPS  # of K'/K: when it is found


class Zone(NamedTuple):
    """The constants of stick zones, one of each: `rest` is 1 - κ, `off` 1 - μ, `e` 1 + t1."""

    e: Array
    k: Array
    rest: Array
    K: Array
    d: Array
    mu: Array
    off: Array
    zeta: Array

    @property
    def right_slip(self) -> Array:
        """1 - t2."""
        width: Array = self.rest * (1.0 + self.mu) / (self.off + self.mu * self.rest)
        return width


class Distances(NamedTuple):
    """Distances of places from the left and right edges, and from the ends of the stick zone."""

    left: Array
    right: Array
    first: Array
    second: Array


@dataclass(frozen=True)
class RecedingFlat:
    """Rates of the flat with these ratios of the quarter periods, β/f, where it advances."""

    ratio: float

    @cached_property
    def natural(self) -> Zone:
        """The stick zone that advances at both ends."""
        m = modulus_of_ratio(self.ratio)
        zeta = _second_complete(np.array(m.complement**2))
        values = (m.rest, m.k, m.rest, m.K, 0.0, 0.0, 1.0)
        e, k, rest, K, d, mu, off = (np.array([v]) for v in values)
        return Zone(e, k, rest, K, d, mu, off, np.atleast_1d(zeta))

    def zone(self, e: float) -> Zone:
        """The stick zone that begins at t1 = e - 1, wider than that which advances."""
        from scipy.optimize import brentq  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

        start = np.array([e])

        def force(ratio: float) -> float:
            return float(resultant(zone_of_ratio(start, np.array([ratio]), self.ratio))[0])

        least = modulus_of(1.0 - e, math.sqrt(e * (2.0 - e)))
        whole = least.K_complement / least.K
        if not whole < self.ratio or force(self.ratio) * force(whole) >= 0.0:
            return self.natural
        found = float(brentq(force, whole, self.ratio, xtol=NEAREST * whole, rtol=SETTLED))
        return zone_of_ratio(start, np.array([found]), self.ratio)


@lru_cache(maxsize=8)
def receding_flat(ratio: float) -> RecedingFlat:
    return RecedingFlat(ratio)


def ratio(zone: Zone, places: Distances) -> Array:
    """q/(f p) of the change in stick."""
    k, mu, off = zone.k, zone.mu, zone.off
    spread = off * (1.0 + mu)  # 1 - μ²
    here = off + mu * places.left  # 1 + μ t
    below = places.first / k * spread / (here * (off + mu * zone.e))
    until = off + mu * (2.0 - zone.right_slip)
    above = places.second / k * spread / (here * until)
    below, above = np.maximum(below, 0.0), np.maximum(above, 0.0)
    sn = np.where(below < 1.0, below - 1.0, 1.0 - above)
    cn2 = below * above
    dn2 = places.left * places.right * spread / (here * here)
    v = sn * _first(cn2, dn2)
    zeta = _zeta(zone, sn, cn2, dn2, v)
    pole = np.sqrt(dn2) * np.sqrt(above / np.maximum(below, 1e-300))
    values: Array = v / zone.K + 0.5 * math.pi * zone.d * (zeta + np.where(zone.d, pole, 0.0))
    return values


def zone_of_ratio(e: Array, ratio: Array, natural: float) -> Zone:
    """Zones that begin at e - 1 with K'/K of these values, whatever resultant they have."""
    k, complement, K = _modulus(ratio)
    rest = complement * complement / (1.0 + k)
    whole = e + rest - e * rest
    d = 4.0 / math.pi**2 * K * (ratio - natural)
    mu, off = (rest - e) / whole, e * (2.0 - rest) / whole
    return Zone(e, k, rest, K, d, mu, off, _second_complete(complement * complement))


def resultant(zone: Zone) -> Array:
    """Q of the change, over f P: 0 for the stick zone sought."""
    mu, k = zone.mu, zone.k
    cn2 = zone.off * (1.0 + mu)
    dn2 = cn2 + (1.0 - k) * (1.0 + k) * mu * mu
    u = mu * _first(cn2, dn2)
    tail = _zeta(zone, mu, cn2, dn2, u) + k * np.sqrt(cn2 / dn2) * (1.0 - k * mu)
    values: Array = u / (math.pi * zone.K) + 0.5 * zone.d * tail
    return values


def _zeta(zone: Zone, sn: Array, cn2: Array, dn2: Array, u: Array) -> Array:
    """Jacobi's zeta function, E(u) - u E/K."""
    values: Array = zone.k**2 / 3.0 * ((u / zone.K) * zone.zeta - sn**3 * _second(cn2, dn2))
    return values


def _modulus(ratio: Array) -> tuple[Array, Array, Array]:
    """κ, κ' and K at which K'/K has these values (`numerics.elliptic`)."""
    swap = ratio < 1.0
    tau = np.where(swap, 1.0 / ratio, ratio)
    q = np.exp(-math.pi * tau)
    theta2 = 2.0 * np.exp(-0.25 * math.pi * tau) * sum(q ** (n * (n + 1)) for n in range(TERMS))
    theta3 = 1.0 + 2.0 * sum(q ** (n * n) for n in range(1, TERMS))
    theta4 = 1.0 + 2.0 * sum((-1.0) ** n * q ** (n * n) for n in range(1, TERMS))
    small, large = (theta2 / theta3) ** 2, (theta4 / theta3) ** 2
    K = 0.5 * math.pi * theta3 * theta3
    return np.where(swap, large, small), np.where(swap, small, large), np.where(swap, tau * K, K)


def _first(x: Any, y: Any) -> Array:
    """Carlson's R_F(x, y, 1)."""
    from scipy.special import elliprf  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

    values: Array = np.asarray(elliprf(x, y, 1.0), dtype=float)
    return values


def _second(x: Any, y: Any) -> Array:
    """Carlson's R_D(x, y, 1)."""
    from scipy.special import elliprd  # noqa: PLC0415

    values: Array = np.asarray(elliprd(x, y, 1.0), dtype=float)
    return values


def _second_complete(square: Any) -> Array:
    return _second(0.0, square)
