"""The rates of pressure and shear fulfil their equations for any intervals, line and period."""

from itertools import pairwise

import numpy as np
import pytest

from sie.friction.potentials import Between, in_angle
from sie.friction.rates import LoadRates, Rates

FRICTION = 0.3
EDGES = ((-2.0, -1.0), (0.5, 2.0))
LOADS = LoadRates(P=1.3, eta=0.2, Q=0.4, tau=0.1)
STICK = {
    "two": ((-1.8, -1.3), (0.7, 1.5)),
    "three": ((-1.8, -1.3), (0.7, 0.9), (1.2, 1.5)),
    "one of two patches": ((0.7, 1.5),),
}
SLIP = {
    "two": ((-2.0, -1.8, 1), (-1.3, -1.0, 1), (0.5, 0.7, -1), (1.5, 2.0, 1)),
    "three": ((-2.0, -1.8, 1), (-1.3, -1.0, 1), (0.5, 0.7, -1), (0.9, 1.2, 1), (1.5, 2.0, 1)),
    "one of two patches": ((-2.0, -1.0, 1), (0.5, 0.7, -1), (1.5, 2.0, 1)),
}
EVERY = [(case, period) for case in STICK for period in (np.inf, 5.0)]


def gauss(lo, hi, n=400):
    g, w = np.polynomial.legendre.leggauss(n)
    x = in_angle(lo, hi, 0.5 * (1.0 + g))
    return x, 0.5 * np.pi * np.sqrt(x.from_lo * x.from_hi) * w


def rates(case, period=np.inf, loads=LOADS):
    if np.isfinite(period):
        loads = LoadRates(P=loads.P, Q=loads.Q)
    return Rates.solved(EDGES, STICK[case], SLIP[case], loads, friction=FRICTION, period=period)


def charges(r):
    """Places and charges of the whole shear rate."""
    for a, b in r.shear.frame.intervals:
        x, w = gauss(a, b)
        yield x.lo + x.from_lo, w * r.shear.density(x)
    for lo, hi, s in r.slip:
        x, w = gauss(lo, hi)
        yield x.lo + x.from_lo, w * s * FRICTION * r.pressure.density(x)


@pytest.mark.parametrize(("case", "period"), EVERY)
def test_the_shear_rate_carries_the_load_and_has_its_potential(case, period):
    r = rates(case, period)
    places, q = (np.concatenate(part) for part in zip(*charges(r)))
    assert q.sum() == pytest.approx(LOADS.Q, abs=1e-14)
    z = np.array([0.3 + 0.5j, -1 + 0.2j, 2 + 0.3j])
    step = z[:, None] - places
    kernel = 1 / step if np.isinf(period) else np.pi / period / np.tan(np.pi / period * step)
    potential = r.shear.B + r.shear.value(Between(0.0, 0.0, z, -z))
    np.testing.assert_allclose(potential, kernel @ q / np.pi, atol=1e-14)


@pytest.mark.parametrize(("case", "period"), EVERY)
def test_every_gap_keeps_its_width(case, period):
    r = rates(case, period)
    ends = [*r.shear.frame.intervals, (r.shear.frame.intervals[0][0] + period, 0.0)]
    for (_, b), (a, _) in pairwise(ends):
        if np.isfinite(a):
            assert r.shear.between(b, a) == pytest.approx(0.0, abs=3e-14)
