"""The shift of the indenter on dissimilar bodies under Q.

The shift is 2/E* ∫(γ - γ of P alone) dx from the stick zone to where both are Q/(πx), less that of
a bonded contact [-b, b]. There p + i q is (x - b)^(-1/2 - iη) (x + b)^(-1/2 + iη), tanh πη = β, and

    ∫_b^X Fq dx = Q/π [ln(2X/b) - Re ψ(1/2 + iη) + ψ(1/2)],       ψ the digamma function.

docs/derivations/coupled_slip.md
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .integral import integral, on_marks
from .sheared import ShearedContact

Array = NDArray[np.float64]


def tangential_shift(state: ShearedContact) -> float:
    """The shift, less that of a bonded contact.

    It is that of γ by the logarithm of its shear, with ∫γ dx = β P/2 on either side of the axis
    under P alone.
    """
    from scipy.special import digamma  # noqa: PLC0415 -- heavy, and for dissimilar bodies only

    search, start = state.search, state.trial.zones.e2
    normal, beta, gamma = search.normal, search.beta, search.gamma
    x, weight = on_marks(state.frame_marks)
    q, p = state.frame_shear(x), state.frame_pressure(x)
    shift = float(weight @ (beta * (x > start) * p - q * np.log(np.abs(x - start)) / math.pi))
    inner = gamma.cuts[(gamma.cuts > 0.0) & (gamma.cuts < abs(start))]
    kept = integral(gamma.__call__, np.concatenate(([0.0], inner, [abs(start)])))
    shift += math.copysign(float(kept.series.sum()), start) - 0.5 * beta * normal.load
    eta = math.atanh(beta) / math.pi
    bonded = float(digamma(0.5 + 1j * eta).real) - float(digamma(0.5))
    shift += state.Q / math.pi * (math.log(0.5 * normal.b) + bonded)
    return state.turn * shift / normal.half_modulus
