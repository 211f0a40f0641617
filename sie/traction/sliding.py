"""Full sliding of dissimilar bodies: q = f p acts back on the pressure, and the exponents leave
1/2.

    1/π PV∫ p(t)/(x - t) dt + tan(πε) p(x) = E*/2 H(x),        tan πε = -β f

f with the sign of sliding. With w(x) = (x - x1)^(1/2+ε) (x2 - x)^(1/2-ε) the solution is

    p = E*/2 cos²(πε) (w/π PV∫ H/(w (t - x)) dt + tan(πε) H)

and V(z) of `potential` gives both terms at once. Singular ends add
k1/2 ((x2-x)/(x-x1))^(1/2-ε) + k2/2 ((x-x1)/(x2-x))^(1/2+ε).

References: Galin, Contact Problems (1961); Hills, Nowell & Sackfield (1993) § 2.5; Muskhelishvili
(1953) §§ 107-110 for the edges.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sie.numerics import lerch
from sie.profiles.power_law import Corner, PowerLaw

from .on_panels import PanelDensity

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class SlidingDensity(PanelDensity):
    """The pressure in full sliding."""

    def _of_powers(self, laws: list[PowerLaw | Corner], y: Array, b: float) -> Array:
        """As H and p are conjugate, 1/π PV∫p/(x - t) + p tan πε = H is met with H sin πε cos πε."""
        slope = np.sum([law.slope_at(y) for law in laws], axis=0)
        cos, sin = self.panels.edge.cos, math.sin(math.pi * self.epsilon)
        return cos * cos * super()._of_powers(laws, y, b) + sin * cos * slope

    def _potentials_of_powers(self, laws: list[PowerLaw | Corner], y: Complex, b: float) -> Complex:
        """The same: Re((1 + i tan πε) F) = H."""
        turn = self.panels.edge.cos * np.exp(-1j * np.pi * self.epsilon)
        out: Complex = turn * super()._potentials_of_powers(laws, y, b)
        return out

    def _singular_pair(self, z: Complex, far: bool) -> Complex:
        left, right, r = self.contact.from_left(z), -self.contact.from_right(z), self.contact.r
        at_left, half = 0.5 + self.epsilon, 0.5 / self.panels.edge.cos
        logarithm = lerch.log1p(2.0 * r / right) if far else np.log(left / right)
        power = np.expm1 if far else np.exp
        ends = self.k2 * power(at_left * logarithm) - self.k1 * power((at_left - 1.0) * logarithm)
        steep = self.k2 * at_left * np.exp(at_left * logarithm) - self.k1 * (
            at_left - 1.0
        ) * np.exp((at_left - 1.0) * logarithm)
        return np.array([half * ends, -2.0 * half * r * steep / (left * right)])

    def _hilbert_inside(self, x: Array) -> Array:
        # Where p is infinite so is this; only the slope's part is given there, as for similar
        # bodies
        p = self(x)
        return self.half_modulus * self._slope(x) - math.tan(math.pi * self.epsilon) * np.where(
            np.isfinite(p), p, 0.0
        )

    def _edge(self, ratio: Array, on_left: bool) -> Array:
        out: Array = ratio ** (0.5 - self.epsilon if on_left else 0.5 + self.epsilon)
        return out

    def _singular_outside(self, left: Any, right: Any) -> Any:
        ratio = left / right if np.iscomplexobj(left) else np.abs(left / right)
        return (0.5 / self.panels.edge.cos) * (
            self.k2 * ratio ** (0.5 + self.epsilon) - self.k1 * ratio ** (self.epsilon - 0.5)
        )
