"""Newton's method for centre and half-width of many contacts."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST_STEPS, CLOSE = 40, 1e-8  # what is left is the square of the last step


class Contact(NamedTuple):
    """Contacts of n scenes: centre, half-width, T = P/G and the moment about the centre over G."""

    m: Array
    r: Array
    T: Array
    about: Array


class Integrals(NamedTuple):
    """∫H dφ, ∫H s dφ, ∫H_s dφ, ∫H_s s dφ and ∫H (1 - s²) dφ, H_s the derivative by s."""

    I0: Array
    I1: Array
    J0: Array
    J1: Array
    C2: Array


def newton(
    integrals: Callable[[Array, Array], Integrals],
    start: tuple[Array, Array],
    size: Array,
    of_width: bool,
) -> Contact:
    """I0 = 0 and r I1 = T for m and ln r, or for m alone where r is given.

    The derivatives of I0 and of r I1 by m and r are J0/r, J1/r and J1, J0.
    """
    m, r = start
    for _ in range(MOST_STEPS):
        k = integrals(m, r)
        carried = r * k.I1
        lacks = 0.0 * r if of_width else np.log(size / carried)
        J1 = 0.0 * r if of_width else k.J1
        # J is indefinite where the slope does not rise; then nothing settles
        det = k.J0 * k.J0 - J1 * J1
        dm = -(k.I0 * k.J0 * r + J1 * carried * lacks) / det
        du = (k.J0 * k.I1 * lacks + J1 * k.I0) / det
        lost = ~np.isfinite(lacks + dm + du)
        m = m + np.where(lost, 0.0, np.clip(dm, -r, r))
        r = r * np.exp(np.where(lost, 0.0 if of_width else 1.0, np.clip(du, -3.0, 3.0)))
        left = np.where(lost, np.inf, np.maximum(np.abs(du), np.abs(dm) / r))
        if not (left > CLOSE).any():
            break
    k = integrals(m, r)
    r = np.where((left <= CLOSE) & np.isfinite(k.C2), r, np.nan)
    return Contact(m, r, r * k.I1 if of_width else size, -r * r * k.C2)
