"""The rates of pressure and shear fulfil their equations for any intervals, line and period."""

from itertools import pairwise

import numpy as np
import pytest

from sie.friction.potentials import (
    Between,
    above_gap,
    in_angle,
    pressure_rate,
    pressure_rate_of_moment,
)
from sie.friction.rates import LoadRates, Rates

FRICTION, EPS = 0.3, np.finfo(float).eps
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


def test_one_patch_has_the_closed_pressure_rate():
    m, half = 0.3, 1.7
    x = in_angle(m - half, m + half, np.linspace(0.001, 0.999, 9))
    expected = (1.3 / np.pi - 0.4 * (x.lo + x.from_lo - m)) / np.sqrt(x.from_lo * x.from_hi)
    p = pressure_rate([(m - half, m + half)], 1.3, 0.4)
    np.testing.assert_allclose(p.density(x), expected, rtol=40 * EPS)


def test_a_moment_is_that_of_the_density():
    p = pressure_rate_of_moment(EDGES, 1.3, 0.2)
    sums = np.zeros(2)
    for lo, hi in EDGES:
        x, w = gauss(lo, hi)
        sums += np.stack((w, w * (x.lo + x.from_lo))) @ p.density(x)
    np.testing.assert_allclose(sums, [1.3, 0.2], rtol=40 * EPS)


def test_slip_of_one_sense_has_the_closed_shear_rate():
    (m, half), (c, d), s = (0.3, 1.7), (-0.5, 1.2), 1.0
    edges = (m - half, m + half)
    slip = ((edges[0], c, s), (d, edges[1], s))
    r = Rates.solved((edges,), ((c, d),), slip, LOADS, friction=FRICTION)
    A, B = LOADS.P - s * LOADS.Q / FRICTION, LOADS.eta - s * LOADS.tau / FRICTION
    mu, rho = 0.5 * (c + d), 0.5 * (d - c)
    x = in_angle(c, d, np.linspace(0.1, 0.9, 9))
    places = x.lo + x.from_lo
    star = (A / np.pi - B * (places - mu)) / np.sqrt(x.from_lo * x.from_hi)
    p = (LOADS.P / np.pi - LOADS.eta * (places - m)) / np.sqrt(half**2 - (places - m) ** 2)
    np.testing.assert_allclose(r.shear.density(x), s * FRICTION * (p - star), rtol=1e-12)
    ends = A / np.pi + np.array([B * rho, -B * rho])
    np.testing.assert_allclose(r.K[0], -s * FRICTION * ends / np.sqrt(2 * rho), rtol=1e-12)
    x = in_angle(d, edges[1], np.linspace(0.0, 1.0, 9))
    v = (x.lo + x.from_lo - mu) / rho
    rate = -s * FRICTION * (A / np.pi * np.arccosh(v) - B * rho * np.sqrt(v**2 - 1))
    (right,) = (zone for zone in r.slips if zone.lo == d)
    np.testing.assert_allclose(right.at(x), rate, atol=1e-14)


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


@pytest.mark.parametrize("case", STICK)
def test_slip_begins_at_stick_ends_and_is_the_integral_of_strain(case):
    r = rates(case)
    for zone in r.slips:
        stick = [e for pair in STICK[case] for e in pair]
        near = max((e for e in stick if e <= zone.lo), default=None)
        x = in_angle(zone.lo, zone.hi, np.array([0.0, 1.0]))
        start = zone.at(x)[0]
        expected = r.shear.between(near, zone.lo) if near not in {None, zone.lo} else start
        assert start == pytest.approx(expected, abs=1e-14)
        for end, value in zip((zone.lo, zone.hi), zone.at(x)):
            assert end not in stick or value == pytest.approx(0.0, abs=1e-14)


def test_a_circle_above_a_gap_ends_at_its_ends():
    x, dz = above_gap(0.5, 2.0)
    assert dz.sum() == pytest.approx(1.5, abs=1e-15)
    np.testing.assert_allclose(x.lo + x.from_lo, x.hi - x.from_hi, atol=4e-16)
