"""A crack normal to the surface against the exact solution by Wiener and Hopf, and its closure."""

import math

import numpy as np
import pytest

import sie
from oracles.edge_crack import edge_crack

PROMISE = 1e-9


@pytest.mark.parametrize("power", [0, 1, 2, 3, 4, 0.5])
def test_a_crack_under_a_power_of_the_depth_is_exact(power):
    crack = sie.EdgeCrack(depth=3.0, normal=lambda y: (y / 3.0) ** power)
    exact = float(edge_crack(power))
    assert abs(crack.mode_1 / math.sqrt(3.0 * math.pi) / exact - 1.0) <= PROMISE


def test_a_stress_infinite_at_the_surface_costs_no_more_than_is_said():
    crack = sie.EdgeCrack(depth=1.0, normal=lambda y: y**-0.5)
    off = abs(crack.mode_1 / math.sqrt(math.pi) / float(edge_crack(-0.5)) - 1.0)
    assert 0.0 < off <= 2e-7


def test_the_five_constants_of_the_handbooks():
    # Tada, Paris & Irwin; the digits by Wiener and Hopf and by collocation
    handbook = [1.1215222552, 0.6828628777, 0.5254884154, 0.4409767224, 0.3868236391]
    assert [round(float(edge_crack(n)), 10) for n in range(5)] == handbook


def test_shear_has_the_kernel_of_tension_and_its_own_sign():
    crack = sie.EdgeCrack(depth=2.0, normal=1.0, shear=lambda y: -np.sqrt(y))
    tension = sie.EdgeCrack(depth=2.0, normal=np.sqrt)
    assert crack.mode_2 == pytest.approx(-tension.mode_1, rel=1e-12)


def test_modes_add_up_while_the_faces_are_apart():
    first, second = (lambda y: 1.0 + y), (lambda y: np.exp(-3.0 * y))
    together = sie.EdgeCrack(0.7, lambda y: first(y) + 2.0 * second(y))
    parts = [sie.EdgeCrack(0.7, stress).mode_1 for stress in (first, second)]
    assert together.mode_1 == pytest.approx(parts[0] + 2.0 * parts[1], rel=1e-12)


@pytest.mark.parametrize(
    ("stress", "zones"),
    [
        (lambda y: 0.3 - y, 1),  # closed at the tip
        (lambda y: np.cos(9.0 * y), 2),  # closed inside and at the tip
        (lambda y: -1.0 + 0.0 * y, 0),
        (lambda y: y - 0.9, 1),  # closed at the mouth
    ],
)
def test_closure_is_complementary(stress, zones):
    crack = sie.EdgeCrack(1.0, stress)
    assert len(crack.open) == zones
    assert crack.check().ok
    y = np.linspace(0.01, 0.99, 99)
    outside = np.all([(y < lo) | (y > hi) for lo, hi in crack.open], axis=0)
    assert (crack.opening(y)[outside & (y > 0)] <= 1e-9).all()


def test_closed_faces_at_the_mouth_leave_the_tip_open_with_a_larger_factor():
    stress = lambda y: y - 0.9  # noqa: E731
    crack = sie.EdgeCrack(1.0, stress)
    lo, hi = crack.open[0]
    overlapping = math.sqrt(math.pi) * float(edge_crack(1) - 0.9 * edge_crack(0))
    assert lo > 0.0 and hi == 1.0 and crack.mode_1 > max(overlapping, 0.0)


def test_the_opening_of_an_edge_crack_is_that_of_the_handbook_at_the_mouth():
    # Tada, Paris & Irwin: 4 σ a/E' 1.4543 to 1e-4
    assert sie.EdgeCrack(1.0, 1.0).opening(0.0) == pytest.approx(1.4543, abs=2e-4)


def test_the_certificate_sees_a_wrong_stress_and_a_wrong_zone():
    right, wrong = sie.EdgeCrack(1.0, lambda y: 0.3 - y), sie.EdgeCrack(1.0, lambda y: 0.3 - y)
    zones = right.open
    wrong.__dict__["_state"] = (((0.0, 0.3),), right._solved(right.normal, ((0.0, 0.3),)))
    assert not wrong.check().ok and wrong.check().lowest_pressure < -1e-3
    wrong.__dict__["_state"] = (zones, right._solved(lambda y: 0.31 - y, zones))
    assert wrong.check().residual > 1e-3


@pytest.mark.parametrize("depth", [0.0, -1.0, float("nan")])
def test_a_depth_that_is_none_is_refused(depth):
    with pytest.raises(ValueError, match="depth"):
        sie.EdgeCrack(depth, 1.0)


def of_surface(x, t):
    s = x + t
    return (-1.0 / s + 6.0 * x / s**2 - 4.0 * x**2 / s**3) / np.pi


def test_a_generalised_kernel_is_taken_at_either_end():
    left = sie.CauchyEquation((0.0, 2.0), g=-1.0, k=of_surface, ends=("finite", "singular"))
    right = sie.CauchyEquation(
        (-2.0, 0.0), g=1.0, k=lambda x, t: -of_surface(-x, -t), ends=("singular", "finite")
    )
    assert left.solve().intensities[0][1] == pytest.approx(right.solve().intensities[0][0], 1e-13)


@pytest.mark.parametrize(
    ("interval", "k", "word"),
    [((1.0, 2.0), of_surface, "measure x from there"), ((0.0, 2.0), None, "finite end without k")],
)
def test_a_finite_end_that_is_none_is_refused(interval, k, word):
    with pytest.raises(ValueError, match=word):
        sie.CauchyEquation(interval, g=-1.0, k=k, ends=("finite", "singular"))


@pytest.mark.parametrize("depth", [0.37, 0.375, 0.3775])
def test_a_tip_that_is_about_to_close_is_found_open(depth):
    stress = lambda y: 100.0 * np.exp(-10.0 * y) - 20.0  # noqa: E731
    crack, deeper = sie.EdgeCrack(depth, stress), sie.EdgeCrack(0.38, stress)
    assert deeper.mode_1 == 0.0 and deeper.open[0][1] > depth
    assert crack.open == ((0.0, depth),) and crack.mode_1 > 0.0
