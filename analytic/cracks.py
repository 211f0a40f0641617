"""Stress intensity factors of cracks in a row, which are to contacts what a tension is to a pressure.

Two collinear cracks a < |x| < b under a remote tension sigma (Willmore 1949; Tada, Paris & Irwin, The Stress Analysis of Cracks
Handbook), with complete elliptic integrals of modulus k, k² = 1 - (a/b)², and D = (K - E)/k²:

    K_I(b) = sigma sqrt(pi b) k D/K,      K_I(a) = sigma sqrt(pi b) sqrt(b/a) k (1 - D/K)

A row of cracks of length 2a, one in each period W (Westergaard 1939; Tada, Paris & Irwin):

    K_I = sigma sqrt(W tan(pi a/W))

K_I = lim sqrt(2 pi r) sigma_yy(r), r the distance ahead of the tip.
"""

import numpy as np

from analytic._agm import ratio_D
from analytic._lib import Library, Number, as_result, everywhere, first_where, positive, real


def pair(
    *, inner: Number, outer: Number, tension: Number, lib: Library = np
) -> tuple[Number, Number]:
    """The factors (K_I at |x| = a, K_I at |x| = b) of the two collinear cracks a < |x| < b.

    ValueError for input that has no meaning.

    >>> tuple(round(float(K), 9) for K in pair(inner=1e9, outer=1e9 + 2.0, tension=1.0) / np.sqrt(np.pi))
    (1.0, 1.0)
    """
    a, b, sigma = (
        positive("inner", inner, lib),
        positive("outer", outer, lib),
        real("tension", tension, lib),
    )
    if not everywhere(a < b):
        near, far = first_where(np.logical_not(a < b) if lib is np else True, a, b)
        raise ValueError(
            f"outer = {far} is not more than inner = {near}; give inner < outer, the tips of one crack."
        )
    k = lib.sqrt((b - a) / b) * lib.sqrt((b + a) / b)
    D_K, scale = ratio_D(lib, k, a / b), sigma * lib.sqrt(lib.pi * b) * k
    return as_result(scale * lib.sqrt(b / a) * (1 - D_K)), as_result(scale * D_K)


def row(*, half_length: Number, period: Number, tension: Number, lib: Library = np) -> Number:
    """The factor K_I = sigma sqrt(W tan(pi a/W)) of a row of cracks of length 2a, one in each period W > 2a.

    ValueError for input that has no meaning.

    >>> round(float(row(half_length=1.0, period=4.0, tension=1.0)), 12)
    2.0
    """
    a, W, sigma = (
        positive("half_length", half_length, lib),
        positive("period", period, lib),
        real("tension", tension, lib),
    )
    if not everywhere(2 * a < W):
        half, whole = first_where(np.logical_not(2 * a < W) if lib is np else True, a, W)
        raise ValueError(
            f"half_length = {half} is not less than period/2 = {whole / 2}; give cracks with bridges between them."
        )
    angle = lib.pi * (a / W)
    return as_result(sigma * lib.sqrt(W) * lib.sqrt(lib.sin(angle) / _cosine(lib, a, W)))


def _cosine(lib: Library, a: Number, W: Number) -> Number:
    """cos(pi a/W), by the sine of what is left of the bridge."""
    return lib.sin(lib.pi * ((W / 2 - a) / W))
