"""Events on load paths: a first contact that is sheared, small steps, several sticks, returns."""

import math
import warnings
from contextlib import suppress
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from history_cases import HERTZ, P0, F, S, f, followed, inside

import sie

P1 = 0.8
ON_NOTHING = {
    "parabola": sie.Parabola(1.0),
    "power": sie.Power(4.0, 1.0),
    "rounded flat": sie.RoundedFlat(0.7, 1.0),
}


@cache
def from_nothing(name, *points, tilt=()):
    scene = sie.Scene(profile=ON_NOTHING[name], modulus=1.0, normal_load=P1, friction=f)
    return sie.follow(scene, sie.Path([(0.0, 0.0, 0.0), *points], tilt=tilt))


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("name", "digits"), [("parabola", 1e-12), ("power", 1e-10)])
def test_a_contact_that_grows_and_sticks_has_the_shear_of_its_pressure_and_the_place(name, digits):
    Q, sigma = 0.1, 0.1
    last = from_nothing(name, (P1, Q, sigma))[-1]
    x = np.linspace(*last.edges, 40)[1:-1]
    due = (Q - math.pi * sigma / 4.0 * x) / P1 * last.pressure(x)
    assert last.shear(x) == pytest.approx(due, abs=digits)


def test_a_contact_that_rolls_while_it_grows_and_sticks_has_a_closed_form():
    # In P = π/4 r², m = -θ: dq = [dQ/π - dτ (x - m)]/w for loads in proportion to P.
    Q, sigma, tilt = 0.1, 0.1, 0.05
    last = from_nothing("parabola", (P1, Q, sigma), tilt=(0.0, tilt))[-1]
    x = np.linspace(*last.edges, 30)[1:-1]
    roots = [np.roots([tilt**2, 2.0 * tilt * at - 4.0 * P1 / math.pi, at**2]) for at in x]
    touched = np.array([pair.real.min() for pair in roots])
    angle, weight = np.polynomial.legendre.leggauss(60)
    due = []
    for at, begun in zip(x, touched, strict=True):
        # t = begun + (1 - begun) s², and r² - (x - m)² = tilt² (t - begun) (other root - t)
        s = 0.5 * (angle + 1.0)
        t = begun + (1.0 - begun) * s**2
        other = max(np.roots([tilt**2, 2.0 * tilt * at - 4.0 * P1 / math.pi, at**2]).real)
        rate = (Q / math.pi - sigma / 4.0 * (at + tilt * t)) / (tilt * np.sqrt(other - t))
        due.append(math.sqrt(1.0 - begun) * float(weight @ rate))
    assert last.shear(x) == pytest.approx(np.array(due), abs=1e-11)
    assert last.energy_lost == 0.0 and not last.slip(x).any()
    assert last.shift == pytest.approx(0.0, abs=1e-12)


def test_zones_that_open_at_both_edges_of_a_flat_from_the_beginning_are_those_of_its_loads():
    loads = (P1, 0.0, 0.5)
    last = from_nothing("rounded flat", loads)[-1]
    scene = replace(last.scene, tangential_load=0.0, bulk_stress=loads[2])
    assert last.stick[0] == pytest.approx(sie.solve(scene).stick[0], abs=1e-9)


UNIT = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, friction=0.3, normal_load=1.0)
BEFORE = [(1, 0, 0), (1, 0.1, 0.05)]


def after(points, tilt=()):
    return sie.follow(UNIT, sie.Path(points, tilt=tilt))[-1]


# Paths that end in steps of a size. The end of slip that goes on moves least.
SMALL = {
    "σ up": lambda s: [*BEFORE, (1, 0.1, 0.05 + s)],
    "σ down": lambda s: [*BEFORE, (1, 0.1, 0.05 - s)],
    "unloading": lambda s: [*BEFORE, (1 - s, 0.1 - s, 0.05 + s)],
    "first loading and its reversal": lambda s: [(1, 0, 0), (1, s, s), (1, -s, s)],
}


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(
    ("name", "size"), [(n, s) for n in SMALL for s in (1e-7, 1e-9) if (n, s) != ("unloading", 1e-9)]
)
def test_an_end_moves_in_proportion_to_a_small_step(name, size):
    steps = SMALL[name]
    start = steps(0.0)
    start = after(start[:1]).edges if start[1] == start[0] else after(start[:-1]).stick[0]

    def moved(size):
        return np.array(after(steps(size)).stick[0]) - start

    k = int(np.abs(moved(1e-5)).argmin())
    assert moved(size)[k] / size == pytest.approx(moved(1e-5)[k] / 1e-5, rel=1e-3, abs=4e-16 / size)


@pytest.mark.parametrize("size", [1e-5, 1e-7])
def test_an_end_of_slip_that_goes_on_moves_in_proportion_to_a_small_turn(size):
    def moved(size):
        return after([*BEFORE, BEFORE[-1]], (0, 0, size)).stick[0][1] - after(BEFORE).stick[0][1]

    assert moved(size) / size == pytest.approx(moved(1e-3) / 1e-3, rel=1e-2)


def test_a_step_within_the_rounding_of_its_loads_is_refused_with_the_remedy_to_drop_it():
    with pytest.raises(sie.ContactError, match="drop this point of the path"):
        after([*BEFORE, (1, 0.1, 0.05 + 1e-12)])


@pytest.mark.parametrize(("sign", "size"), [(-1, 3e-13), (1, 3e-11)])
def test_a_step_near_the_rounding_of_its_loads_is_answered_or_refused_without_warnings(sign, size):
    step = (1 + size, 0.1 + sign * size, 0.05 - sign * size)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with suppress(sie.ContactError):
            _ = after([*BEFORE, step]).stick


# Points are (Q/F, σ/S). The gap goes on slipping at the end of an earlier stick zone; it is in an
# earlier zone of slip.
TWO_STICKS = {
    "at the end of an earlier zone": [(0.06, -0.36), (-0.31, 0.08)],
    "in an earlier zone of slip": [(-0.1, 0.36), (0.32, -0.41), (0.5, -0.17)],
}


def at_p0(points):
    return history_of(tuple((1.0, *point) for point in points))


@cache
def history_of(points):
    """Tests share what they only read."""
    return followed(HERTZ, points)


@pytest.mark.parametrize("points", TWO_STICKS.values(), ids=TWO_STICKS)
def test_no_point_of_one_stick_zone_moves_from_those_of_the_other(points):
    end = at_p0(points)[-1]
    (_, lo), (hi, _) = end.stick
    middle, last = end.tangential.slip_now(np.array([0.5 * (lo + hi), hi - 1e-12]))
    assert middle != 0.0 and abs(last) <= 1e-10 * abs(middle)


@pytest.mark.slow
def test_one_stick_zone_is_left_after_a_larger_return():
    history = at_p0([*TWO_STICKS["at the end of an earlier zone"], (-0.6, 0.6)])
    assert [len(solution.stick) for solution in history] == [1, 2, 1]
    assert history[-1].check().ok


@pytest.mark.slow
def test_a_gap_opens_inside_the_stick_zone_and_joins_the_slip_beside_it():
    """Q held while σ is reversed: the gap opens behind an earlier end and takes over the zone."""
    start, turned = (0.4, 0.25), (0.4, -0.25)
    numbers = []
    for share in (0.45, 0.459, 0.463):
        on_the_way = tuple(a + share * (b - a) for a, b in zip(start, turned))
        numbers.append(len(at_p0([(0.4, 0.0), start, on_the_way])[-1].stick))
    assert numbers == [1, 2, 1]


@pytest.mark.slow
@pytest.mark.parametrize("P", [P0, 1.2 * P0], ids=("constant P", "P grows"))
def test_bulk_stress_that_leaves_no_stick_zone_on_the_grid_is_refused(P):
    path = sie.Path([(P0, 0.0, 0.0), (P, 0.5 * F, 30.0 * S)])
    with pytest.raises(sie.ContactError, match=r"^step 1 of the path"):
        sie.follow(HERTZ, path)


@pytest.mark.slow
def test_energy_is_refused_where_slip_turned_beside_several_stick_zones_and_the_state_is_not():
    turned = at_p0([(0.0, 0.0), (-0.72, 0.07), (-0.56, 0.79), (0.08, 0.08)])[-1]
    assert turned.check().ok
    with pytest.raises(sie.ContactError, match="turns on the way"):
        _ = turned.energy_lost


BACK_IN_PHASE = [(1, 0, 0), (0.73, 0.28, -0.112), (1, 0, 0), (0.73, 0.28, -0.112)]


@pytest.mark.slow
def test_loads_that_return_in_phase_bring_back_the_shear_that_they_left():
    """An edge that grew and stuck slips as it retreats, until it is where it was."""
    first, grown, again = followed(HERTZ, BACK_IN_PHASE)[1:]
    x = inside(first)
    assert grown.history.turning_points[2].parts and grown.history.turning_points[3].parts
    assert again.shear(x) == pytest.approx(first.shear(x), abs=1e-9 * f)


RETURNS = [(1, 0, 0), (1.15, 0.135, 0.08), (1.015, 0.0135, 0.008), (1.15, 0.135, 0.08)]


@pytest.mark.slow
def test_a_return_on_which_zones_of_slip_join_at_its_end_is_that_of_its_halves():
    whole, halves = followed(HERTZ, RETURNS)[-1], followed(HERTZ, RETURNS, parts=2)[-1]
    x = inside(whole)
    assert whole.check().ok and halves.check().ok
    assert whole.shear(x) == pytest.approx(halves.shear(x), abs=1e-8 * f)


@pytest.mark.slow
def test_loads_that_return_to_where_slip_ended_are_balanced_to_rounding():
    profile = sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6))
    scene = sie.Scene(profile=profile, modulus=2.0, normal_load=0.375, friction=0.5, tilt=0.02)
    most, least = (0.3491272, -0.0438307, -0.1277112), (0.3724127, -0.00438307, -0.01277112)
    path = sie.Path([(0.375, 0, 0), most, least, most])
    certificate = sie.follow(scene, path)[-1].check()
    assert certificate.ok and certificate.shear.equilibrium < 1e-11


def test_certificate_and_plan_say_which_steps_are_followed_part_by_part():
    history = followed(HERTZ, [(1, 0.4, 0), (1, 0.4, 0.25)])
    (layers, parts), told = str(history.plan).splitlines()[:2], str(history[1].check())
    assert "layers" in layers and "part by part: Q and bulk stress change in another" in parts
    assert "followed part by part, as Q and bulk stress change in another" in told
