"""Stress intensity factors of cracks in a row: the problems of rows of contacts, under tension.

Two collinear cracks a < |x| < b under a remote tension sigma (Willmore 1949; Tada, Paris & Irwin,
The Stress Analysis of Cracks Handbook), with complete elliptic integrals of modulus k, k² = 1 -
(a/b)², and D = (K - E)/k²:

    K_I(b) = sigma sqrt(pi b) k D/K,      K_I(a) = sigma sqrt(pi b) sqrt(b/a) k (1 - D/K)

A row of cracks of length 2a, one in each period W (Westergaard 1939; Tada, Paris & Irwin):

    K_I = sigma sqrt(W tan(pi a/W))

K_I = lim sqrt(2 pi r) sigma_yy(r), r the distance ahead of the tip.
"""

import numpy as np

from analytic._core.documentation import TADA, documented
from analytic._core.elliptic import ratio_D
from analytic._core.numbers import Library, Number, as_result
from analytic._core.parameters import patch_ends, positives, real, refuse

SOURCES = (TADA,)


@documented("the two stress intensity factors, stress times root of length", *SOURCES)
def pair(
    *, inner: Number, outer: Number, tension: Number, lib: Library = np
) -> tuple[Number, Number]:
    """The factors (K_I at |x| = a, K_I at |x| = b) of the two collinear cracks a < |x| < b.

    >>> found = pair(inner=1e9, outer=1e9 + 2.0, tension=1.0) / np.sqrt(np.pi)
    >>> tuple(round(float(K), 9) for K in found)
    (1.0, 1.0)
    """
    (a, b), sigma = patch_ends(inner, outer, lib), real("tension", tension, lib)
    k = lib.sqrt((b - a) / b) * lib.sqrt((b + a) / b)
    D_K, scale = ratio_D(lib, k, a / b), sigma * lib.sqrt(lib.pi * b) * k
    return as_result(scale * lib.sqrt(b / a) * (1 - D_K)), as_result(scale * D_K)


@documented("the stress intensity factor, stress times root of length", *SOURCES)
def row(*, half_length: Number, period: Number, tension: Number, lib: Library = np) -> Number:
    """The factor K_I = sigma sqrt(W tan(pi a/W)) of a row of cracks of length 2a.

    Each period W > 2a holds one crack.

    >>> round(float(row(half_length=1.0, period=4.0, tension=1.0)), 12)
    2.0
    """
    a, W = positives(lib, half_length=half_length, period=period)
    sigma = real("tension", tension, lib)
    message = (
        "half_length = {} is not less than period/2 = {}; give cracks with bridges between them."
    )
    refuse(2 * a >= W, message, a, W / 2)
    angle = lib.pi * (a / W)
    return as_result(sigma * lib.sqrt(W) * lib.sqrt(lib.sin(angle) / _cosine(lib, a, W)))


def _cosine(lib: Library, a: Number, W: Number) -> Number:
    """cos(pi a/W), by the sine of what is left of the bridge."""
    return lib.sin(lib.pi * ((W / 2 - a) / W))
