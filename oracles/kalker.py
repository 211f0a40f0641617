"""Partial slip on a mesh: Kalker's minimum of complementary energy, step by step. It shares nothing
with the solver that it checks.

Constant shear on each of n equal elements; the displacement of the indenter relative to the body
grows by

    Δg = δ - A Δq - (2 Δτ/E*) x,    A q = -2/(π E*) ∫ q(t) ln|x - t| dt    (δ: the rigid shift)

and a step minimises ½ Δq·A Δq + Δq·x 2Δτ/E* over |q| <= f p with ∫q = Q: where q is below its bound
Δg = 0, at a bound Δg pulls towards it (Kalker 1990, Three-Dimensional Elastic Bodies in Rolling
Contact, § 4.2; Duvaut & Lions 1972). A primal-dual active set finds it.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST = 200


class Mesh:
    """n elements on the contact (x1, x2): midpoints x, width h, the matrix A at the midpoints."""

    def __init__(self, interval: tuple[float, float], n: int, modulus: float) -> None:
        edges = np.linspace(interval[0], interval[1], n + 1)
        self.x, self.h, self.modulus = 0.5 * (edges[:-1] + edges[1:]), edges[1] - edges[0], modulus
        # The unit of length in the logarithm: its choice moves δ only
        size = interval[1] - interval[0]

        def primitive(s: Array) -> Any:  # ∫ ln|s| ds
            return s * np.log(np.abs(s) / (4.0 * size)) - s

        far = np.arange(n) * self.h
        row = (
            -2.0
            / (np.pi * modulus)
            * (primitive(far + 0.5 * self.h) - primitive(far - 0.5 * self.h))
        )
        self.A = row[np.abs(np.subtract.outer(np.arange(n), np.arange(n)))]

    def step(self, q: Array, bound: Array, Q: float, strain: float) -> tuple[Array, Array]:
        """(q after the step, Δg): `bound` = f p there, `strain` = 2 Δτ/E*."""
        n = len(q)
        start, free = np.clip(q, -bound, bound), np.ones(n, dtype=bool)
        new, at = start.copy(), np.zeros(n)
        for _ in range(MOST):
            fixed = ~free
            new[fixed] = at[fixed] * bound[fixed]
            # A Δq - δ = -strain x on the free elements, h Σ q = Q
            m = int(free.sum())
            K = np.zeros((m + 1, m + 1))
            K[:m, :m], K[:m, m], K[m, :m] = self.A[np.ix_(free, free)], -1.0, self.h
            moved = new - q
            right = np.empty(m + 1)
            right[:m] = -strain * self.x[free] - self.A[np.ix_(free, fixed)] @ moved[fixed]
            right[m] = Q - self.h * (new[fixed].sum() + q[free].sum())
            found = np.linalg.solve(K, right)
            new[free] = q[free] + found[:m]
            slip = found[m] - self.A @ (new - q) - strain * self.x
            # Free elements beyond their bound are held there. Held ones whose slip opposes it are
            # released.
            out = free & (np.abs(new) > bound * (1.0 + 1e-13))
            back = fixed & (at * slip < -1e-14 * np.abs(slip).max())
            if not out.any() and not back.any():
                return new, np.where(free, 0.0, slip)
            at = np.where(out, np.sign(new), at)
            free = (free & ~out) | back
        raise AssertionError("the active set does not settle")

    def pressure(self, gap: Array, P: float, guess: Array) -> Array:
        """The pressure of the normal load P on bodies with this gap before they deform."""
        n, free = len(gap), guess > 0.0 if guess.any() else np.ones(len(gap), dtype=bool)
        for _ in range(MOST):
            m = int(free.sum())
            K = np.zeros((m + 1, m + 1))
            K[:m, :m], K[:m, m], K[m, :m] = self.A[np.ix_(free, free)], -1.0, self.h
            found = np.linalg.solve(K, np.append(-gap[free], P))
            p = np.zeros(n)
            p[free] = found[:m]
            opening = gap + self.A @ p - found[m]
            out, back = p < 0.0, ~free & (opening < -1e-14 * np.abs(gap).max())
            if not out.any() and not back.any():
                return p
            free = (free & ~out) | back
        raise AssertionError("the active set does not settle")
