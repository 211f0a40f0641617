"""K of many cracks at once: the solution of a crack's equation as weights of the stress on it.

The equation has no length but the depth a. One solved system therefore gives, for all depths,

    K = sqrt(π a) Σ_i W_i σ(a ξ_i)

Cells (`faces`) tell where all of a crack is open; a crack that is not takes an equation of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sie.cauchy.density import Part
from sie.cauchy.equation import CauchyEquation
from sie.cauchy.system import System
from sie.numerics import jacobi

from .edge_crack import EdgeCrack, regular_kernel
from .faces import cells, opened

Array = NDArray[np.float64]
Stress = Callable[[Array], tuple[Array, Array]]

# W then has 9 digits for a stress that varies over a thousandth of the depth, next to the surface,
# and 13 where it varies over a tenth
NODES = 192
# Cells at the tip in which the sign of K tells more than that of the opening does
AT_TIP = 3


@lru_cache(maxsize=1)
def unit_weights() -> tuple[Array, Array]:
    """ξ and W."""
    equation = CauchyEquation((0.0, 1.0), g=0.0, k=regular_kernel, ends=("finite", "singular"))
    problem = equation.problem
    system = System(problem, (NODES,))
    x, response = system.of_values()
    (weight,), (interval,) = problem.weights, problem.maps
    at_tip = jacobi.polynomials(weight, NODES, np.ones(1))[:, 0]
    unit = Part(interval, weight, np.ones(1)).intensities[1] / at_tip[0]
    # B for g = 1 has K = -sqrt(2π) times its intensity, and g is -σ
    return x, math.sqrt(2.0) * unit * (at_tip @ response)


def modes(stress: Stress, depth: Array) -> tuple[Array, Array]:
    """K_I >= 0 and K_II of cracks of these depths, whose faces may touch.

    `stress` gives σ_xx and σ_xy at an array of depths on their line.
    """
    x, W = unit_weights()
    _, middles, A = cells()
    normal, shear = stress(depth[:, None] * np.concatenate((x, middles)))
    scale, n = np.sqrt(np.pi * depth), len(x)
    K = scale * (normal[:, :n] @ W)
    sigma = normal[:, n:].T
    apart = np.linalg.solve(A, sigma)[:-AT_TIP] > 0.0
    for i in np.flatnonzero(~apart.all(axis=0)):
        open_at_tip = opened(A, sigma[:, i])[-1]
        K[i] = EdgeCrack(float(depth[i]), lambda y: stress(y)[0]).mode_1 if open_at_tip else 0.0
    return np.maximum(K, 0.0), scale * (shear[:, :n] @ W)
