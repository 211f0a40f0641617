"""Where the body yields first and where its surface is torn most: against 30 digits, and against brute force."""

import numpy as np
import pytest
import strategies
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath.calculus.optimization import findroot

import sie
from analytic import rounded_flat
from validation.reference import mp

NU = 0.3
# P/(bk) and whether it is on the surface: NUMERICS' table, computed with mpmath from the closed form
KNOWN = {
    (0.0, 0.0): (4.88003571108, False), (0.3, 0.0): (5.32116806054, False), (0.5, 0.0): (5.00129193126, False),
    (0.8, 0.0): (3.52415662624, False), (0.0, 0.3): (4.081253, True), (0.3, 0.3): (3.883460, True),
    (0.5, 0.3): (3.484226, True), (0.8, 0.3): (2.372888, True),
}  # fmt: skip


def punch(a, friction=0.0, **changes):
    profile = sie.RoundedFlat(a, 1.0) if a else sie.Parabola(1.0)
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=1.0, poisson=NU))
    return solution.with_(friction=friction, tangential_load=friction * solution.normal_load, **changes)


def exact_j2(a, friction):
    """J2(x, y) of the sliding rounded punch in closed form, an mpmath function; y may be 0."""
    f, kappa = mp.mpf(friction), 1 - 2 * mp.mpf(NU)
    arguments = {"half_flat": mp.mpf(a), "half_width": mp.one, "radius": mp.one, "modulus": mp.one, "lib": mp}

    def j2(x, y):
        z = mp.mpc(x, y)
        F = rounded_flat.potential(z, **arguments)
        D = (y * mp.mpc(1, -f) * rounded_flat.potential_derivative(z, **arguments) if y else 0) - f * F
        return abs(D) ** 2 + kappa**2 / 3 * (mp.im(F) - f * mp.re(F)) ** 2

    return j2


def polished(a, friction, x, y):
    """The stationary point of the exact J2 next to (x, y), to 25 digits."""
    j2, h = exact_j2(a, friction), mp.mpf(10) ** -12

    def along(function, t):
        return (8 * (function(t + h) - function(t - h)) - (function(t + 2 * h) - function(t - 2 * h))) / (12 * h)

    if y == 0.0:
        (root,) = findroot(mp, lambda x: along(lambda t: j2(t, 0), x), mp.mpf(x), tol=1e-40, verify=False).apply(mp.re) if False else (
            mp.findroot(lambda x: along(lambda t: j2(t, 0), x), (mp.mpf(x) - 1e-6, mp.mpf(x) + 1e-6), tol=1e-40, verify=False),
        )
        return root, mp.zero, j2(root, 0)
    x, y = mp.findroot(
        lambda x, y: (along(lambda t: j2(t, y), x), along(lambda t: j2(x, t), y)), (mp.mpf(x), mp.mpf(y)), tol=1e-40, verify=False
    )
    return x, y, j2(x, y)
