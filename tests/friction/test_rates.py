"""The rates of pressure and shear fulfil their equations for any intervals, line and period."""

from itertools import pairwise

import numpy as np
import pytest

from sie.friction.rates import LoadRates, Rates
from sie.numerics.chord import Chord
from sie.numerics.graded_panels import Rule

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


def rates(case, period):
    loads = LOADS if np.isinf(period) else LoadRates(P=LOADS.P, Q=LOADS.Q)
    return Rates.solved(EDGES, STICK[case], SLIP[case], loads, friction=FRICTION, period=period)


def shear_of(r, cuts=()):
    """Places and charges of the whole shear rate, by rules graded to the cuts too."""
    for zones, values in (
        (r.shear.zones, r.shear.density),
        (r.shear.slip, lambda x: FRICTION * r.pressure.density(x)),
    ):
        for lo, hi, *sense in zones:
            ends = np.array([lo, *[x for x in cuts if lo < x < hi], hi])
            rule = Rule.graded(np.stack((ends[:-1], ends[1:]), axis=1))
            yield rule, rule.weight * values(rule) * (sense[0] if sense else 1)


@pytest.mark.parametrize("period", [np.inf, 5.0])
@pytest.mark.parametrize("case", STICK)
def test_the_shear_rate_carries_the_load_and_has_the_strain_of_the_bulk_stress(case, period):
    r, chord = rates(case, period), Chord(period)
    assert sum(q.sum() for _, q in shear_of(r)) == pytest.approx(LOADS.Q, abs=1e-14)
    for a, b in r.shear.zones:
        y = a + 0.3 * (b - a)
        here = float(r.shear.density(Rule.graded(np.array([[y, y]])))[0])
        strain = here * float(chord.logarithm(y - a) - chord.logarithm(b - y))
        for rule, q in shear_of(r, [y]):
            apart, own = -rule.apart_from(y), (rule.lo >= a) & (rule.hi <= b)
            strain += (q - here * own * rule.weight) @ (chord.cosine(apart) / chord(apart))
        assert strain / np.pi == pytest.approx(r.shear.B, abs=1e-12)


@pytest.mark.parametrize("period", [np.inf, 5.0])
@pytest.mark.parametrize("case", ["two", "three"])
def test_every_gap_keeps_its_width(case, period):
    r, chord = rates(case, period), Chord(period)
    ends = [e for zone in r.shear.zones for e in zone]
    cuts = sorted(e + away for e in ends for k in (2, 4, 6, 8) for away in (-(0.1**k), 0.1**k))
    for (_, b), (a, _) in pairwise(r.shear.zones):
        grown = -np.pi * r.shear.B * (a - b)
        for rule, q in shear_of(r, cuts):  # graded to the logarithms
            to_a, to_b = (chord.logarithm(rule.apart_from(e)) for e in (a, b))
            grown += q @ (to_a - to_b)
        assert grown == pytest.approx(0.0, abs=3e-13)
