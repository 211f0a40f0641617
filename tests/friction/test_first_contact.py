"""Load paths on which the bodies come into contact while they are sheared."""

import math
from functools import cache

import numpy as np
import pytest

import sie

P0, F = 0.8, 0.3
SCENES = {
    "parabola": sie.Parabola(1.0),
    "wedge": sie.Wedge(0.5),
    "power": sie.Power(4.0, 1.0),
    "rounded flat": sie.RoundedFlat(0.7, 1.0),
}
SHEARED = P0, 0.8 * F * P0, 0.1  # slip begins after 0.37 of the step


@cache
def followed(name, *points, tilt=()):
    scene = sie.Scene(profile=SCENES[name], modulus=1.0, normal_load=P0, friction=F)
    return sie.follow(scene, sie.Path([(0.0, 0.0, 0.0), *points], tilt=tilt))


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("name", "digits"), [("parabola", 1e-12), ("power", 1e-10)])
def test_a_contact_that_grows_and_sticks_has_the_shear_of_its_pressure_and_the_place(name, digits):
    Q, sigma = 0.1, 0.1
    last = followed(name, (P0, Q, sigma))[-1]
    x = np.linspace(*last.edges, 40)[1:-1]
    due = (Q - math.pi * sigma / 4.0 * x) / P0 * last.pressure(x)
    assert last.shear(x) == pytest.approx(due, abs=digits)


def test_a_contact_that_rolls_while_it_grows_and_sticks_has_a_closed_form():
    # In P = π/4 r², m = -θ: dq = [dQ/π - dτ (x - m)]/w for loads in proportion to P.
    Q, sigma, tilt = 0.1, 0.1, 0.05
    last = followed("parabola", (P0, Q, sigma), tilt=(0.0, tilt))[-1]
    x = np.linspace(*last.edges, 30)[1:-1]
    roots = [np.roots([tilt**2, 2.0 * tilt * at - 4.0 * P0 / math.pi, at**2]) for at in x]
    touched = np.array([pair.real.min() for pair in roots])
    angle, weight = np.polynomial.legendre.leggauss(60)
    due = []
    for at, begun in zip(x, touched, strict=True):
        # t = begun + (1 - begun) s², and r² - (x - m)² = tilt² (t - begun) (other root - t)
        s = 0.5 * (angle + 1.0)
        t = begun + (1.0 - begun) * s**2
        other = max(np.roots([tilt**2, 2.0 * tilt * at - 4.0 * P0 / math.pi, at**2]).real)
        rate = (Q / math.pi - sigma / 4.0 * (at + tilt * t)) / (tilt * np.sqrt(other - t))
        due.append(math.sqrt(1.0 - begun) * float(weight @ rate))
    assert last.shear(x) == pytest.approx(np.array(due), abs=1e-11)


@pytest.mark.slow
def test_slip_while_a_contact_grows_from_nothing_is_certified():
    assert followed("parabola", SHEARED)[-1].check().ok


@pytest.mark.slow
def test_a_step_from_nothing_is_that_of_its_parts():
    first = tuple(0.3 * load for load in SHEARED)
    whole, parts = followed("parabola", SHEARED)[-1], followed("parabola", first, SHEARED)[-1]
    assert parts.stick[0] == pytest.approx(whole.stick[0], abs=1e-9)
    assert parts.shift == pytest.approx(whole.shift, rel=1e-8)


def test_zones_that_open_at_both_edges_of_a_flat_from_the_beginning_are_those_of_its_loads():
    loads = (P0, 0.0, 0.5)
    last = followed("rounded flat", loads)[-1]
    scene = sie.Scene(
        profile=SCENES["rounded flat"],
        modulus=1.0,
        normal_load=P0,
        friction=F,
        bulk_stress=loads[2],
    )
    assert last.stick[0] == pytest.approx(sie.solve(scene).stick[0], abs=1e-9)


def test_nothing_is_lost_and_nothing_shifts_while_a_growing_contact_sticks():
    last = followed("parabola", (P0, 0.1, 0.1), tilt=(0.0, 0.05))[-1]
    assert last.energy_lost == 0.0
    assert last.shift == pytest.approx(0.0, abs=1e-12)
    assert not last.slip(np.linspace(*last.edges, 9)).any()
