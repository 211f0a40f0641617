"""Partial slip under a bulk stress beside P and Q."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import strategies
from hypothesis import given, settings
from hypothesis import strategies as st
from slip_cases import E, F, P, left_over, mp, rounded_load, sheared

import sie


def test_a_moderate_bulk_stress_shifts_the_stick_zone_of_hertz():
    """Nowell & Hills (1987): e = σ b/(4 f p0), c = b sqrt(1 - Q/(f P))."""
    sigma, solution = 0.05, sheared(sie.Parabola(1.0), 0.6, bulk_stress=0.05)
    b, p0 = solution.half_width, 2.0 * P / (np.pi * solution.half_width)
    e, c = sigma * b / (4.0 * F * p0), b * math.sqrt(0.4)
    assert solution.stick[0] == pytest.approx((e - c, e + c), rel=1e-13)
    assert solution.tangential.kind == "one sign"
    x = np.linspace(e - 0.99 * c, e + 0.99 * c, 9)
    q = F * p0 * (np.sqrt(1.0 - (x / b) ** 2) - c / b * np.sqrt(1.0 - ((x - e) / c) ** 2))
    assert solution.shear(x) == pytest.approx(q, rel=1e-12)


def test_with_bulk_stress_the_stick_zone_can_end_inside_the_flat():
    """Both edges' conditions, ∫H/w = 0 and the load, to all digits (b = R = 1)."""
    load = float(rounded_load(mp.mpf("0.7"), mp.mpf(1)))
    solution = sheared(sie.RoundedFlat(0.7, 1.0), 0.8, load, bulk_stress=0.06 * F * E)
    scene, (lo, hi) = solution.scene, solution.stick[0]
    assert (round(lo, 4), round(hi, 4)) == (-0.4437, 0.8862)
    m, r = (mp.mpf(lo) + hi) / 2, (mp.mpf(hi) - lo) / 2

    strain, a = mp.mpf(scene.bulk_stress) / (2 * F * E), mp.mpf(0.7)

    def H(phi):
        t = m + r * mp.sin(phi)
        return max(t - a, 0) + min(t + a, 0) - strain

    ends = [-mp.pi / 2, mp.asin((a - m) / r), mp.pi / 2]
    assert abs(mp.quad(H, ends)) < 1e-15
    load = E * r / 2 * mp.quad(lambda phi: H(phi) * mp.sin(phi), ends)
    assert abs(load / left_over(solution) - 1) < 1e-14


def test_a_stick_zone_at_a_sharp_edge_may_slip_against_the_load():
    """All of Q is held at the edge: q = -f (p - p̂), p̂ under P + |Q|/f."""
    scene = sie.Scene(
        profile=sie.Flat(1.0), modulus=2.0, normal_load=0.2, friction=0.6, tilt=0.125,
        tangential_load=0.02, bulk_stress=0.1,
    )  # fmt: skip
    solution = sie.solve(scene)
    assert solution.tangential.kind == "one sign"
    ((lo, hi, sign),) = solution.tangential.slipped
    assert sign == -1.0 and solution.stick == ((-1.0, lo),) and hi == solution.edges[1]
    t = (np.arange(20_000) + 0.5) * np.pi / 20_000
    x, r = solution.centre + solution.half_width * np.cos(t), solution.half_width
    assert float(solution.shear(x) @ (r * np.sin(t))) * np.pi / 20_000 == pytest.approx(
        0.02, rel=1e-4
    )
    assert solution.check().shear.ok


def reverse_slip_of_hertz(strain):
    """c/b under a bulk stress alone, strain = τ/(f p0), by s² = c² + (1 - c²) sin² t."""

    def excess(c):
        k = 1 - c * c
        integrand = lambda t: k * mp.cos(t) ** 2 / mp.sqrt(c * c + k * mp.sin(t) ** 2)  # noqa: E731
        return mp.quad(integrand, [0, mp.pi / 2]) - mp.pi / 2 * strain

    return mp.findroot(excess, (mp.mpf("0.3"), mp.mpf("0.9")), solver="anderson")


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_bulk_stress_alone_gives_two_signed_slip(sign):
    solution = sheared(sie.Parabola(1.0), 0.0, bulk_stress=sign * 0.4)
    b, p0 = solution.half_width, 2.0 * P / (np.pi * solution.half_width)
    c = reverse_slip_of_hertz(mp.mpf(0.1) / (F * p0))
    assert solution.stick[0] == pytest.approx((-b * float(c), b * float(c)), rel=1e-13)
    assert solution.tangential.kind == "two signs"
    x = 0.5 * (b + solution.stick[0][1])
    assert float(solution.shear(x)) == pytest.approx(
        -sign * F * float(solution.pressure(x)), rel=1e-14
    )
    assert float(solution.shear(-x)) == pytest.approx(-float(solution.shear(x)), rel=1e-14)
    assert solution.check().ok


def test_the_stress_under_two_signed_slip_is_continuous_to_the_surface():
    """In each slip zone and in the stick zone: the surface is evaluated by formulas of its own."""
    scene = sie.Scene(
        profile=sie.Parabola(1.0), modulus=1.0, poisson=0.3, normal_load=0.3, friction=0.5,
        tangential_load=0.01, bulk_stress=1.0,
    )  # fmt: skip
    solution = sie.solve(scene)
    ((lo, hi),), b = solution.stick, solution.half_width
    x = np.array([0.5 * (lo - b), 0.5 * (lo + hi), 0.5 * (hi + b)])
    assert solution.shear(x[0]) > 0.0 > solution.shear(x[2])
    below = solution.stress(x, 1e-10 * b)
    for name in ("xx", "yy", "xy"):
        assert getattr(solution.stress(x, 0.0), name) == pytest.approx(
            getattr(below, name), rel=1e-8, abs=1e-9
        )


@pytest.mark.parametrize("strain", [2.0, 5.0, 9.0, 12.9])
def test_a_large_bulk_stress_leaves_a_narrow_stick_zone_of_hertz(strain):
    """f p0 [K(k) - E(k)] = π τ/2, k² = 1 - ρ²/b²; ρ falls below 1e-8 b."""
    b = math.sqrt(4.0 * P / (math.pi * E))
    p0 = 2.0 * P / (math.pi * b)
    solution = sheared(sie.Parabola(1.0), 0.0, bulk_stress=4.0 * strain * F * p0)
    with mp.workdps(160):  # 1 - c²/b²
        difference = lambda m: mp.ellipk(m) - mp.ellipe(m) - mp.pi * strain / 2  # noqa: E731
        c = mp.exp(mp.findroot(lambda u: difference(1 - mp.exp(2 * u)), -1.57 * strain))
    ((lo, hi),) = solution.stick
    assert abs(0.5 * (hi - lo) - b * c) < 1e-13 * b
    assert abs(0.5 * (hi + lo)) < 1e-13 * b
    assert solution.check().ok


@pytest.mark.parametrize("tilt", [0.15, 0.3])
@pytest.mark.parametrize("strain", [0.3, 0.6, 2.0])
def test_bulk_stress_alone_holds_the_mirror_image_of_a_tilted_punch_by_the_mirrored_zone(
    tilt, strain
):
    """With Q = 0 the sides differ by a lopsided pressure only, not by their load."""
    here, there = (
        sheared(sie.RoundedFlat(1.0, 1.0 / 6.0), 0.0, tilt=sign * tilt, bulk_stress=strain * P)
        for sign in (1.0, -1.0)
    )
    ((lo, hi),) = here.stick
    ((low, high),) = there.stick
    assert here.edges[0] <= lo < hi <= here.edges[1]
    assert (-high, -low) == pytest.approx((lo, hi), rel=1e-12)
    assert here.check().ok


@pytest.mark.parametrize(("fraction", "strain"), [(0.0, 100.0), (0.5, 1e4), (-0.999, 9.0)])
def test_a_bulk_stress_that_leaves_hardly_a_point_of_stick_is_refused_with_one_that_is_solved(
    fraction, strain
):
    stress = 8.0 * strain * F * P / (math.pi * math.sqrt(4.0 * P / (math.pi * E)))
    scene = sheared(sie.Parabola(1.0), fraction, bulk_stress=stress).scene
    with pytest.raises(sie.ContactError, match="too narrow for doubles") as caught:
        _ = sie.solve(scene).stick
    part = float(re.search(r"at most (\S+) times", str(caught.value))[1])
    assert sie.solve(replace(scene, bulk_stress=part * stress)).check().ok


@pytest.mark.parametrize(
    ("profile", "rounded"),
    [(sie.Flat(1.0), sie.RoundedFlat(1.0, 0.5)), (sie.Wedge(0.3), sie.Parabola(2.0))],
    ids=["flat", "wedge"],
)
def test_opposite_slip_at_an_infinite_pressure_is_refused_and_solved_where_that_is_rounded(
    profile, rounded
):
    with pytest.raises(sie.ContactError, match=r"infinite pressure slips, x = .* round"):
        _ = sheared(profile, 0.5, bulk_stress=4.0 * P).stick
    assert sheared(rounded, 0.3, bulk_stress=4.0 * P).check().ok


def test_the_tip_of_a_wedge_may_stick_between_opposite_slip():
    solution = sheared(sie.Wedge(0.3), 0.05, bulk_stress=4.0 * P)
    assert solution.stick[0][0] < 0.0 < solution.stick[0][1]
    assert solution.check() and solution.check().shear.error < 1e-9


@pytest.mark.slow(but=3)
@pytest.mark.parametrize(
    "profile",
    [
        sie.RoundedFlat(0.5, 1.0),
        sie.Power(4.2, 0.2),
        sie.Parabola(1.0).tilted(0.1),
        sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.125)),
    ],
    ids=repr,
)
@pytest.mark.parametrize("fraction", [0.0, 0.3, -0.9])
def test_every_bulk_stress_that_leaves_a_stick_zone_is_solved(profile, fraction):
    for strain in (2.0, -5.0, 8.0):
        solution = sheared(profile, fraction, bulk_stress=strain * P)
        assert solution.check().shear.ok, solution.check().shear
        assert 0.0 < solution.energy_lost < math.inf


@pytest.mark.parametrize("fraction", [1e-7, 3e-5, 1e-3, 9e-3])
@pytest.mark.parametrize("tilt", [0.0, 0.03, 0.1])
def test_the_certificate_of_thin_zones_raises_no_false_alarm(fraction, tilt):
    """The end of a zone is known to some ulps; within these q is off f p by the root of them."""
    for profile in (
        sie.Parabola(1.0) + sie.Wedge(0.07).shifted(0.15),
        sie.RoundedFlat(0.3, 2.0),
        sie.Power(3.0, 0.5),
    ):
        assert sheared(profile, fraction, tilt=tilt).check().ok


@pytest.mark.parametrize("left", [1e-9, 1e-3])
@pytest.mark.parametrize("tilt", [0.02, -0.05])
def test_the_certificate_of_a_stick_zone_at_a_sharp_edge_raises_no_false_alarm(left, tilt):
    """q is infinite at an edge of the stick zone, which the abscissae there do not resolve."""
    for profile in (sie.Flat(1.0), sie.Flat(1.0) + sie.Parabola(8.0)):
        assert sheared(profile, 1.0 - left, tilt=tilt).check().ok


PAIRS = st.tuples(st.integers(-90, 90), st.integers(-100, 100)).map(
    lambda pair: (pair[0] / 100, pair[1] / 100)
)


@pytest.mark.slow
@settings(max_examples=30)
@given(strategies.scenes(), PAIRS, st.floats(0.05, 1.5), st.booleans())
def test_every_shear_obeys_its_law_and_that_of_the_mirror_image_is_mirrored(scene, loads, f, bulk):
    """|q| <= f p, = ± f p in slip, slip along q, ∫q = Q, equation (12) in stick: the certificate,
    on points that no solver used. Under Q -> -Q, h(x) -> h(-x): q(x) -> -q(-x). Under Q -> -Q,
    σ -> -σ: q -> -q.
    """
    Q, width = loads[0] * f * scene.normal_load, sie.solve(scene).half_width
    # slip in opposite directions would be refused at corners
    sigma = 3.99 * loads[1] * abs(Q) / (math.pi * width) if bulk else 0.0
    asked = replace(scene, friction=f, tangential_load=Q, bulk_stress=sigma)
    image = {"profile": scene.profile.mirrored(), "tilt": -scene.tilt, "tangential_load": -Q}
    one, other = sie.solve(asked), sie.solve(replace(asked, **image))
    turned = sie.solve(replace(asked, tangential_load=-Q, bulk_stress=-sigma))
    if Q or sigma:
        assert one.check().shear.ok, one.check().shear
        assert one.energy_lost >= 0.0
    assert len(one.stick) == len(other.stick) == len(turned.stick)
    far = width + abs(one.centre)
    for lo, hi in one.stick:
        assert other.stick[0] == pytest.approx((-hi, -lo), abs=1e-9 * far)
        assert turned.stick[0] == pytest.approx((lo, hi), abs=1e-12 * far)


@pytest.mark.parametrize("part", [0.1, 0.3])
def test_the_steepness_of_the_shear_at_a_kink_in_the_stick_zone_is_that_beside_it(part):
    """Pressure and corrective pressure are both infinitely steep there: their difference is not."""
    scene = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.5, friction=0.4)
    shear = sie.solve(replace(scene, tangential_load=part * 0.2)).shear
    at, *beside = shear.cauchy_derivative(np.array([0.5, 0.5 - 1e-6, 0.5 + 1e-6])).imag
    assert np.isinf(sie.solve(scene).pressure.cauchy_derivative(0.5).imag)
    assert at == pytest.approx(np.mean(beside), rel=1e-3)


@pytest.mark.parametrize("points", [60, 150])
def test_opposite_slip_on_a_trace_is_certified(points):
    x = np.linspace(-1.0, 1.0, points)
    trace = sie.Sampled(x, 0.5 * x * x + 0.002 * np.cos(9.0 * x + 0.3))
    loads = {"normal_load": 0.03, "tangential_load": 0.002, "bulk_stress": 0.08}
    solution = sie.solve(sie.Scene(profile=trace, modulus=1.0, friction=0.4, **loads))
    assert solution.tangential.kind == "two signs"
    assert solution.check().ok
