"""Rough traces: self-affine profiles whose waves shorten down to their spacing."""

import numpy as np

import sie


def rough_trace(points, seed, hurst=0.8, size=0.01):
    """One on [-1, 1] whose ends are not equally high."""
    rng = np.random.default_rng(seed)
    k = np.arange(4, points // 4)
    x = np.linspace(-1.0, 1.0, points)
    phase = rng.uniform(0.0, 2.0 * np.pi, len(k))
    h = (k ** -(hurst + 0.5) * np.cos(0.5 * np.pi * np.outer(x, k) + phase)).sum(axis=1)
    return sie.Sampled(x, size * h / h.std())
