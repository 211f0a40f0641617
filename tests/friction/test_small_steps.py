"""Steps of a load path that are small beside the loads, as noise in a recorded file is."""

import warnings
from contextlib import suppress

import numpy as np
import pytest

import sie
from sie.errors import ContactError

HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, friction=0.3, normal_load=1.0)
BEFORE = [(1, 0, 0), (1, 0.1, 0.05)]


def after(points, tilt=(), scene=HERTZ):
    return sie.follow(scene, sie.Path(points, tilt=tilt))[-1]


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("size", [1e-7, 1e-9])
@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1)])
def test_an_end_that_recedes_moves_in_proportion_to_a_small_step(direction, size):
    start = np.array(after(BEFORE).stick[0])

    def moved(size):
        load = np.array(BEFORE[-1]) + size * np.array(direction)
        return np.array(after([*BEFORE, tuple(load)]).stick[0]) - start

    k = int(np.abs(moved(1e-5)).argmin())  # the end that goes on; the other one begins anew
    assert moved(size)[k] / size == pytest.approx(moved(1e-5)[k] / 1e-5, rel=1e-3, abs=4e-16 / size)


def test_a_step_within_the_rounding_of_its_loads_is_refused_with_the_remedy_to_drop_it():
    with pytest.raises(ContactError, match="drop this point of the path"):
        after([*BEFORE, (1, 0.1, 0.05 + 1e-12)])


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("size", [1e-6, 1e-9])
def test_a_small_first_loading_and_its_reversal_leave_zones_in_proportion_to_them(size):
    edge = np.array(after([(1, 0, 0)]).edges)
    point = after([(1, 0, 0), (1, size, size), (1, -size, size)])
    lengths = np.abs(np.array(point.stick[0]) - edge) / size
    known = after([(1, 0, 0), (1, 1e-4, 1e-4), (1, -1e-4, 1e-4)])
    expected = np.abs(np.array(known.stick[0]) - edge) / 1e-4
    assert lengths == pytest.approx(expected, rel=1e-3, abs=4e-16 / size)


@pytest.mark.parametrize("size", [1e-5, 1e-7])
def test_a_small_turn_moves_the_end_of_slip_that_goes_on_in_proportion(size):
    def moved(size):
        return after([*BEFORE, BEFORE[-1]], (0, 0, size)).stick[0][1] - after(BEFORE).stick[0][1]

    assert moved(size) / size == pytest.approx(moved(1e-3) / 1e-3, rel=1e-2)


@pytest.mark.slow
def test_unloading_by_a_ten_millionth_moves_an_end_by_as_little():
    small = after([*BEFORE, (1 - 1e-7, 0.1 - 1e-7, 0.05 + 1e-7)])
    assert small.stick[0][0] == pytest.approx(after(BEFORE).stick[0][0], abs=1e-7)


def test_a_flat_punch_whose_tilt_returns_with_its_shear_sticks_all_over():
    flat = sie.Scene(profile=sie.Flat(1.0), modulus=1.0, friction=0.3, normal_load=1.0)
    point = after([*BEFORE, (1, -0.1, -0.05)], (0, 0.1, -0.1), flat)
    assert point.stick == ((-1.0, 1.0),)


@pytest.mark.parametrize(("sign", "size"), [(-1, 3e-13), (1, 3e-11)])
def test_a_step_near_the_rounding_of_its_loads_is_answered_or_refused_without_warnings(sign, size):
    step = (1 + size, 0.1 + sign * size, 0.05 - sign * size)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with suppress(ContactError):
            _ = after([*BEFORE, step]).stick
