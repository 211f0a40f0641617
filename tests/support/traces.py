"""Sampled profiles, and the contact of one."""

import numpy as np

import sie

X = np.linspace(-2.0, 2.2, 211)
H = 0.5 * X**2 + 0.03 * X**3 + 0.01 * X**4


def pressed(profile: sie.Profile, load: float = 1.0) -> sie.Solution:
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=load))


def rough_trace(points: int, seed: int, hurst: float = 0.8, size: float = 0.01) -> sie.Sampled:
    """A self-affine profile on [-1, 1], with waves down to its spacing and unequal ends."""
    rng = np.random.default_rng(seed)
    k = np.arange(4, points // 4)
    x = np.linspace(-1.0, 1.0, points)
    phase = rng.uniform(0.0, 2.0 * np.pi, len(k))
    h = (k ** -(hurst + 0.5) * np.cos(0.5 * np.pi * np.outer(x, k) + phase)).sum(axis=1)
    return sie.Sampled(x, size * h / h.std())
