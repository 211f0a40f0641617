"""Contacts of sampled profiles: patches, shear, stress, and mesh results beside them."""

import re

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from traces import H, X, pressed

import sie


def cosine(x):
    return 0.01 * np.cos(2.0 * np.pi * x) + 0.002 * np.sin(6.0 * np.pi * x)


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("last", [1.0, 0.995], ids=["ends in the same place", "ends a step before"])
@pytest.mark.parametrize(
    "made",
    [
        lambda x: sie.Sampled(x, cosine(x)),
        lambda x: sie.Sampled(-x[::-1], cosine(x[::-1])).mirrored(),
        lambda x: sie.Sampled(x, cosine(x) - 0.02 * x).tilted(0.02),
    ],
    ids=["trace", "mirrored", "tilted"],
)
def test_a_repeated_trace_presses_as_its_function_over_the_seam(made, last):
    """The seam, at 0.41, lies inside a patch."""
    x = 0.41 + np.linspace(0.0, last, round(200 * last) + 1)
    traced, exact = (
        sie.solve(sie.Scene(profile=sie.Periodic(one, 1.0), modulus=1.0, normal_load=0.01))
        for one in (made(x), sie.FromFunction("-0.02*pi*sin(2*pi*x) + 0.012*pi*cos(6*pi*x)"))
    )
    assert not any("do not meet" in note for note in traced.notes)
    places = np.linspace(0.0, 1.0, 301)
    assert traced.check().ok
    assert traced.pressure(places) == pytest.approx(exact.pressure(places), abs=3e-5)


@pytest.mark.parametrize(
    ("smoothing", "apart"),
    [(0.0, 1e-15), (1e-8, 1e-15), (1e-4, 1e-13), (1e-1, 1e-8)],  # the last with a knot in 4 points
)
def test_a_repeated_trace_does_not_depend_on_where_its_period_begins(smoothing, apart):
    x = np.linspace(0.0, 1.0, 101)[:-1]
    h = cosine(x) + 1e-4 * np.random.default_rng(4).standard_normal(100)
    one = sie.Periodic(sie.Sampled(x, h, smoothing), 1.0)
    other = sie.Periodic(
        sie.Sampled(np.append(x[37:], x[:37] + 1.0), np.append(h[37:], h[:37]), smoothing), 1.0
    )
    assert not one.joint and not other.joint
    places = np.linspace(-0.2, 0.3, 97)
    assert one.height(places) == pytest.approx(other.height(places), abs=apart)
    assert one.slope(places) == pytest.approx(other.slope(places), abs=1e3 * apart)
    left = 1.0 / (1.0 + 0.01 * smoothing * (2.0 * np.pi) ** 4)  # of the longest wave
    waves = 2.0 * np.fft.rfft(one.height(x))[1].real / 100.0
    assert waves == pytest.approx(0.01 * left, abs=5e-5)


@pytest.mark.parametrize(
    ("h", "period", "says"),
    [
        (lambda x: cosine(x) + 0.004 * x, 1.0, r"bends .* times .* with a corner"),
        (lambda x: (x - 0.5) ** 2, 1.0, r"bends .* times .* with a corner"),
        (cosine, 1.2, "with 0.2 without indenter"),
    ],
)
def test_a_repeated_trace_whose_ends_do_not_meet_says_by_how_much(h, period, says):
    x = np.linspace(0.0, 1.0, 41)
    profile = sie.Periodic(sie.Sampled(x, h(x)), period)
    assert re.search(f"the ends of the trace do not meet at x = .*{says}", profile.joint)
    assert (
        profile.joint in sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=2e-3)).notes
    )


@pytest.mark.parametrize("jump", [False, True])
def test_the_slope_of_a_noisy_trace_meets_within_its_noise(jump):
    x = np.linspace(0.0, 1.0, 401)
    h = (x - 0.5) ** 2 if jump else cosine(x)
    noisy = h + 1e-4 * np.random.default_rng(2).standard_normal(401)
    assert bool(sie.Periodic(sie.Sampled(x, noisy, "gcv"), 1.0).joint) == jump


@pytest.mark.parametrize("h", [-H, 0.0 * X + 3.0, H - 4.0 * X])
def test_a_contact_at_the_end_of_a_trace_is_refused_with_what_a_trace_may_lack(h):
    with pytest.raises(sie.ContactError, match=r'end of the trace.*levelled\(\).*"surface"'):
        pressed(sie.Sampled(X, h), 1.0).edges  # noqa: B018 -- computes it


def wavy_pad(height, waves):
    x = np.linspace(-3.0, 3.0, 601)
    return sie.Sampled(
        x,
        np.maximum(np.abs(x) - 1.0, 0.0) ** 2 / 60.0 + height * np.cos(waves * x + 0.3) + 1e-3 * x,
    )


@pytest.mark.parametrize("load", [3e-3, 1e-2])
def test_waves_on_a_base_do_not_hide_the_contact_that_presses_them_flat(load):
    # Contacts that begin at the lowest wave and grow with the load end in it.
    solution = pressed(wavy_pad(1e-4, 6.0), load)
    assert solution.check().ok
    same = sie.solve(
        sie.Scene(profile=solution.scene.profile, modulus=1.0, half_width=solution.half_width)
    )
    assert (same.edges, same.normal_load) == (
        pytest.approx(solution.edges, rel=1e-12),
        pytest.approx(load, rel=1e-12),
    )


@pytest.mark.slow
@given(st.floats(1e-5, 3e-4), st.floats(3.0, 30.0), st.floats(1e-5, 1e-2))
# An edge within some ulp of a point of the trace
@example(3.208964811676877e-05, 9.81311208978229, 0.0031236263147810506)
@settings(max_examples=20)
def test_waves_on_a_base_are_solved_or_refused(height, waves, load):
    try:
        found = pressed(wavy_pad(height, waves), load).check()
        says = "" if found.ok or found.error <= 1e-11 else "not certified"
    except sie.ContactError as refused:
        says = str(refused)
    assert not says or "smooth" in says


def test_friction_stress_yield_and_tension_of_a_trace_are_those_of_its_function():
    x = np.linspace(-2.0, 2.0, 401)
    given = {"modulus": 1.0, "normal_load": 0.5, "poisson": 0.3}
    given |= {"friction": 0.5, "tangential_load": 0.1}
    sampled = sie.solve(sie.Scene(profile=sie.Sampled(x, np.cosh(x) - 1.0), **given))
    exact = sie.solve(sie.Scene(profile=sie.FromFunction(np.sinh, domain=(-2.0, 2.0)), **given))
    assert sampled.check().ok
    (c1, c2), (d1, d2) = sampled.stick[0], exact.stick[0]
    assert (c1, c2) == pytest.approx((d1, d2), abs=1e-8)  # the spline's own error
    at = np.linspace(-0.9, 0.9, 9) * exact.half_width
    assert sampled.shear(at) == pytest.approx(exact.shear(at), abs=1e-6)
    assert sampled.stress(at, 0.3).mises == pytest.approx(exact.stress(at, 0.3).mises, abs=1e-8)
    assert sampled.elastic_limit().stress == pytest.approx(exact.elastic_limit().stress, rel=1e-6)
    assert sampled.peak_tension().value == pytest.approx(exact.peak_tension().value, rel=1e-5)
