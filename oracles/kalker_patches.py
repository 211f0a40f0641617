"""Partial slip on the mesh of `kalker`, on several patches of contact or on those of one period.

Elements lie on the patches alone. The shear of those that leave the contact becomes 0, which moves
the surface under the others.
"""

import numpy as np
from numpy.typing import NDArray

from .kalker import Mesh

Array = NDArray[np.float64]


class PatchMesh(Mesh):
    """Elements of one width, n on all, in the middle of the widest patches that occur."""

    def __init__(
        self,
        patches: tuple[tuple[float, float], ...],
        n: int,
        modulus: float,
        period: float = np.inf,
    ) -> None:
        self.h, self.modulus = sum(b - a for a, b in patches) / n, modulus
        counts = [int((b - a) / self.h) for a, b in patches]
        self.x = np.concatenate(
            [
                0.5 * (a + b) + self.h * (np.arange(k) - 0.5 * (k - 1))
                for (a, b), k in zip(patches, counts, strict=True)
            ]
        )
        apart = np.subtract.outer(self.x, self.x)
        half, size = 0.5 * self.h, patches[-1][1] - patches[0][0]

        def primitive(s: Array) -> Array:  # ∫ ln|s| ds
            return s * np.log(np.abs(s) / (4.0 * size)) - s

        A = primitive(apart + half) - primitive(apart - half)
        if np.isfinite(period):  # ln|sin(π s/λ)| is ln|s| and what is smooth for |s| < λ
            A += self.h * np.log(np.abs(np.sinc(apart / period)))
        self.A = -2.0 / (np.pi * modulus) * A

    def step(self, q: Array, bound: Array, Q: float, strain: float) -> tuple[Array, Array]:
        live = bound > 0.0
        part = object.__new__(Mesh)
        part.A, part.h = self.A[np.ix_(live, live)], self.h
        part.x = strain * self.x[live] - self.A[np.ix_(live, ~live)] @ q[~live]
        new, slip = np.zeros(q.shape), np.zeros(q.shape)
        new[live], slip[live] = part.step(q[live], bound[live], Q, 1.0)
        return new, slip
