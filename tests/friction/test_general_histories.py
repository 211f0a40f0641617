"""P, Q, bulk stress and tilt together along a path, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from history_cases import FALLING, HERTZ, LOPSIDED, P0, S, f, followed, hertz_stick, inside, scaled

import sie
from sie.contact import edges


def test_falling_load_leaves_the_stick_zone_of_the_end_loads_alone():
    """Reduced load P - Q/f, tilt -2τ/(f E*), although P fell on the way."""
    solution = followed(HERTZ, FALLING)[-1]
    assert solution.stick[0] == pytest.approx(hertz_stick(0.4, -0.15), abs=1e-14)
    x = np.linspace(-0.8, 0.8, 33)
    inner = np.sqrt(np.maximum(0.4 - (x - 0.15) ** 2, 0.0)) / 2.0
    q = f * (np.sqrt(np.maximum(0.7 - x * x, 0.0)) / 2.0 - inner)
    assert solution.shear(x) == pytest.approx(q, abs=1e-13)
    assert solution.check().ok


def test_the_energy_of_a_falling_load_is_that_of_the_slip_rate():
    """∫∫ f p (2/E*) f {(A/π) arccosh v ∓ B ρ sqrt(v² - 1)}, A = dP - dQ/f, B = -dτ/f."""
    A, B = (-0.3 + 0.1) * P0, -0.2 * S / 4.0 / f
    g, w = np.polynomial.legendre.leggauss(40)
    angle, weight = 0.5 * np.pi * 0.5 * (g + 1.0), 0.25 * np.pi * w
    lost = 0.0
    for t, share in zip(0.5 * (g + 1.0), 0.5 * w, strict=True):
        r = np.sqrt(1.0 - 0.3 * t)
        rho, m = np.sqrt(0.6 - 0.2 * t), 0.05 + 0.1 * t
        for side in (1.0, -1.0):
            length = r - side * m - rho
            from_edge = length * np.cos(angle) ** 2
            p = 0.5 * np.sqrt(from_edge * (2.0 * r - from_edge))
            v = 1.0 + length * np.sin(angle) ** 2 / rho
            dx = length * 2.0 * np.sin(angle) * np.cos(angle) * weight
            rate = -A / np.pi * np.arccosh(v) + side * B * rho * np.sqrt(v * v - 1.0)
            lost += share * 2.0 * f * f * float(dx @ (p * rate))
    _, before, after = followed(HERTZ, FALLING)
    assert after.energy_lost - before.energy_lost == pytest.approx(lost, rel=1e-11)


def test_opposite_slip_under_a_falling_load_is_that_of_the_end_loads():
    path = followed(HERTZ, [(1, 0, 0), (0.8, 0.05, 0.5)])[-1]
    scene = sie.solve(path.scene)
    x = inside(scene, 31)
    assert path.stick[0] == pytest.approx(scene.stick[0], abs=1e-14)
    assert path.shear(x) == pytest.approx(scene.shear(x), abs=1e-14)
    assert path.slip(x) == pytest.approx(scene.slip(x), abs=1e-15)
    assert path.energy_lost == pytest.approx(4.183032e-4, abs=5e-11)


RETURN = [(1, 0, 0), (1.49, 0.53, 0.17), (1, 0, 0), (1.49, 0.53, 0.17)]


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("scene", [HERTZ, LOPSIDED], ids=["hertz", "lopsided"])
def test_loads_come_back_to_those_under_which_one_edge_stuck_and_the_other_slipped(scene):
    """Where the end of the stick zone leaps at last over what slipped back; as in two parts."""
    midway = (1.35, 0.53 * 5.0 / 7.0, 0.17 * 5.0 / 7.0)
    whole, parts = followed(scene, RETURN), followed(scene, [*RETURN[:3], midway, RETURN[3]])
    one, two, x = whole[-1], parts[-1], inside(whole[-1])
    assert one.check().ok and two.check().ok
    assert one.stick[0] == pytest.approx(two.stick[0], abs=1e-9)
    assert one.shear(x) == pytest.approx(two.shear(x), abs=1e-8)
    assert one.energy_lost == pytest.approx(two.energy_lost, rel=1e-6)
    assert one.stick[0] == pytest.approx(whole[1].stick[0], abs=1e-3)


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([(P0, 0.1, 0.0), (P0, 0.0, 0.0), (-P0, 0.0, 0.0)], "P of point 2 = -0.78.*must touch"),
        ([(P0, 0.1, 0.0), (P0, 0.3, 0.0)], "step 1 .*exceeds f P"),
        ([(P0, 0.1, 0.1), (1.1 * P0, 0.1, 0.0), (0.3 * P0, -0.1, 0.0)], "step 2 .*exceeds f P"),
        ([(P0, 0.3, 0.0), (P0, 0.1, 0.0)], "step 0 .*exceeds f P"),
        ([(P0, 0.1, 0.0), (P0, np.nan, 0.0)], "Q of point 1 is nan"),
        ([(P0, 0.1, 0.0), (P0, 0.1, np.inf)], "σ of point 1 = inf"),
        ([(P0, 0.1, 0.0), (1e300, 0.1, 0.0)], "P of point 1 = 1e.300"),
        ([(P0, 0.1, 0.0), (1e-300, 0.0, 0.0)], "P of point 1 = 1e-300"),
        ([], "no points"),
        (None, "points = None is not a list"),
        ([(0.0, 0.0), (0.0, 0.0)], "nothing ever touches"),
        ([(1.0,)], r"\(1\.0,\).*give \(P, Q\)"),
    ],
)
def test_a_path_that_cannot_be_is_refused_with_its_step_before_any_work(points, said, monkeypatch):
    def worked(*_):
        raise AssertionError("a contact was solved")

    monkeypatch.setattr(edges, "edge_integrals", worked)
    with pytest.raises((ValueError, sie.ContactError), match=said):
        sie.follow(HERTZ, sie.Path(points))


@pytest.mark.parametrize(("P", "s"), [(0.8 * P0, 0.0), (1.3 * P0, 0.0), (P0, 0.1 * S)])
def test_a_step_to_sliding_leaves_f_p_and_the_next_one_begins_from_it(P, s):
    ends = ((P, less * f * P, s) for less in (1.0 - 1e-15, 1.0 - 1e-8))
    slid, nearly = (sie.follow(HERTZ, sie.Path([(P0, 0.1), end, (P0, 0.0)])) for end in ends)
    assert slid[1].stick == () and slid[2].check().ok
    assert slid[1].shear(0.1) == pytest.approx(f * slid[1].pressure(0.1), rel=1e-13)
    assert slid[1].energy_lost == pytest.approx(nearly[1].energy_lost, rel=1e-6)
    assert slid[2].stick[0] == pytest.approx(nearly[2].stick[0], rel=1e-6)


def test_bodies_that_slide_through_all_of_a_step_are_refused():
    with pytest.raises(sie.ContactError, match=r"slide all the way"):
        sie.follow(HERTZ, sie.Path([(P0, f * P0), (0.8 * P0, 0.8 * f * P0)]))


@pytest.mark.parametrize(
    ("turns", "said"),
    [
        ({"tilt": [0.1]}, "1 values of tilt for 2 points"),
        ({"tilt": [0.1, np.nan]}, "tilt of point 1 is nan"),
        ({"tilt": [0.0, 0.1], "moment": [0.0, 0.1]}, "both tilt and moment"),
        ({"moment": 3.0}, "moment = 3.0 is not"),
    ],
)
def test_turns_of_a_path_that_mean_nothing_are_refused(turns, said):
    with pytest.raises(ValueError, match=said):
        sie.Path([(1.0, 0.1), (1.0, 0.2)], **turns)


def test_a_path_with_tilt_is_a_value():
    path = sie.Path([(1.0, 0.1), (1.0, 0.2, 0.3)], tilt=[0.0, 0.1])
    assert eval(repr(path), {"Path": sie.Path}) == path and hash(path) == hash(path)
    assert path.subdivided(2).tilt == (0.0, 0.05, 0.1)
    with pytest.raises(ValueError, match="scene has a moment"):
        sie.follow(replace(HERTZ, moment=0.0), path)


GROWING = [(1, 0, 0), (1.3, 0.7, 0.1)]


def slip_rate(x, share):
    """That of the gap of the reduced contact on GROWING, R = E* = 1; 0 before x touches."""
    level, centre = 1.0 + share * (0.3 - 0.7), 0.5 * 0.1 * share
    away, r = x - centre, np.sqrt(level)
    v = np.maximum(np.abs(away) / r, 1.0)
    load, turn = P0 * (0.7 - 0.3), -0.5 * 0.1
    rate = f * (2.0 / np.pi * load * np.arccosh(v) + turn * np.sign(away) * r * np.sqrt(v * v - 1))
    return np.where(np.abs(x) <= np.sqrt(1.0 + 0.3 * share), rate, 0.0)


def gauss(lo, hi, n=60):
    """Nodes and weights from lo to hi, dense at both ends."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, weight = 0.5 * (1.0 + x), 0.5 * w
    return lo + (hi - lo) * t * t * (3.0 - 2.0 * t), (hi - lo) * 6.0 * t * (1.0 - t) * weight


def test_points_slip_from_when_they_touch():
    solution = followed(HERTZ, GROWING)[1]
    for x in (1.005, 1.05, 1.1, 1.14, -1.02, -1.13):
        share, weight = gauss((x * x - 1.0) / 0.3, 1.0)
        expected = float(weight @ slip_rate(x, share))
        assert solution.slip(x) == pytest.approx(expected, abs=1e-10)


def test_the_shift_is_the_mean_slip_under_a_flat_punch_on_the_contact_of_the_time():
    total = 0.0
    for share, weight in zip(*gauss(0.0, 1.0, 30), strict=True):
        a, r, centre = np.sqrt(1.0 + 0.3 * share), np.sqrt(1.0 - 0.4 * share), 0.05 * share
        for zone in (gauss(-a, centre - r), gauss(centre + r, a)):
            x, w = zone
            total += weight * float(w @ (slip_rate(x, share) / np.sqrt(a * a - x * x))) / np.pi
    assert followed(HERTZ, GROWING)[1].shift == pytest.approx(total, rel=1e-9)


@pytest.mark.slow
def test_the_slip_range_of_a_steady_cycle_holds_for_points_that_leave_the_contact():
    A, B = scaled([(1.2, 0.55, 0.0), (0.9, -0.3, 0.0)])
    steady = sie.steady_cycle(HERTZ, A, B)
    x = np.array([0.5, 0.9, 0.94, 0.95, 1.0, 1.05, 1.09, -0.95, -1.05])
    period = sie.follow(HERTZ, sie.Path([A, B, A, B, A]).subdivided(2))[4:]
    slip = np.array([solution.slip(x) for solution in period])
    assert steady.slip_range(x) == pytest.approx(slip.max(axis=0) - slip.min(axis=0), abs=1e-9)
    work = sie.Cycle(steady).friction_work(x)
    assert (work[1:] > 0.0).all() and steady.slip_range(1.2) == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("moments", [(0.0, 0.02), (0.0, 0.0)], ids=["given", "none"])
def test_energy_and_shift_at_a_given_moment_are_those_of_the_tilts_that_carry_it(moments):
    """A path of so many straight parts in the tilt is off by their square: extrapolated."""
    points = scaled([(1, 0, 0), (1.2, 0.6, 0.05)])
    path = sie.Path(points, moment=moments)
    whole = sie.follow(replace(LOPSIDED, moment=0.0), path)
    found = []
    for n in (4, 8):
        parts = path.subdivided(n)
        tilts = [solution.tilt for solution in sie.follow(whole.scene, parts)]
        last = sie.follow(LOPSIDED, sie.Path(parts.points, tilt=tilts))[-1]
        found.append((last.energy_lost, last.shift))
    (coarse, fine), last = np.array(found), whole[-1]
    expected = (4.0 * fine - coarse) / 3.0
    assert (last.energy_lost, last.shift) == pytest.approx(tuple(expected), rel=1e-6)
