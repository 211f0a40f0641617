"""A sampled profile, and its contact."""

import numpy as np

import sie

X = np.linspace(-2.0, 2.2, 211)
H = 0.5 * X**2 + 0.03 * X**3 + 0.01 * X**4


def pressed(profile: sie.Profile, load: float = 1.0) -> sie.Solution:
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=load))
