"""What changes in the question changes in the answer as it must."""

import laws
import numpy as np
import pytest
import strategies
from hypothesis import given
from hypothesis import strategies as st
from strategies import between, log_between

import sie

PROMISE = 1e-13
S = np.array([-0.97, -0.6, -0.21, 0.05, 0.33, 0.8, 0.99])  # where, in half-widths from the centre


@given(strategies.scenes())
def test_the_mirrored_scene_has_the_mirrored_answer(scene):
    one = sie.solve(scene)
    other = one.with_(profile=scene.profile.mirrored(), tilt=-scene.tilt)
    r = one.half_width
    assert other.half_width == pytest.approx(r, rel=PROMISE)
    assert other.centre == pytest.approx(-one.centre, abs=PROMISE * (r + abs(one.centre)))
    assert other.moment == pytest.approx(
        -one.moment, abs=PROMISE * scene.normal_load * (r + abs(one.centre))
    )
    assert other.sharp == one.sharp[::-1]
    x = one.centre + r * S
    rounding = 1e-15 * abs(one.centre) / r
    peak = laws.peak(one.pressure, one.edges, scene.profile.breaks)
    x = x[np.abs(x[:, None] - np.array([*scene.profile.breaks, 9e9])).min(axis=1) > 1e-3 * r]
    assert other.pressure(-x) == pytest.approx(
        one.pressure(x), abs=(PROMISE + 100 * rounding) * peak
    )


@given(strategies.scenes(), st.integers(-16, 16))
def test_a_shift_of_the_profile_shifts_the_answer(scene, n):
    one, dx = sie.solve(scene), n / 8
    other = one.with_(profile=scene.profile.shifted(dx))
    r, P = one.half_width, scene.normal_load
    far = (abs(one.centre) + abs(dx)) / r
    assert other.half_width == pytest.approx(r, rel=PROMISE)
    assert other.centre == pytest.approx(one.centre + dx, abs=PROMISE * r * (1 + far))
    assert other.moment == pytest.approx(one.moment + dx * P, abs=PROMISE * P * r * (1 + far))
    x = one.centre + r * S
    x = x[np.abs(x[:, None] - np.array([*scene.profile.breaks, 9e9])).min(axis=1) > 1e-3 * r]
    peak = laws.peak(one.pressure, one.edges, scene.profile.breaks)
    assert other.pressure(x + dx) == pytest.approx(
        one.pressure(x), abs=(PROMISE + 1e-13 * far) * peak
    )


@given(strategies.scenes())
def test_tilt_and_moment_are_inverse_to_each_other(scene):
    one = sie.solve(scene)
    other = one.with_(moment=one.moment)
    r, P = one.half_width, scene.normal_load
    # dM/dtilt = -π/4 E* r²
    size = P / (scene.Estar * r) + abs(one.centre) / r * P / (scene.Estar * r)
    assert other.tilt == pytest.approx(one.tilt, abs=4 * PROMISE * max(size, abs(one.tilt)))
    assert other.moment == pytest.approx(one.moment, abs=PROMISE * P * (r + abs(one.centre)))
    assert other.half_width == pytest.approx(r, rel=2 * PROMISE * (1 + abs(one.centre) / r))


@given(strategies.scenes(sharp=False))
def test_load_and_half_width_are_inverse_to_each_other(scene):
    one = sie.solve(scene)
    other = one.with_(half_width=one.half_width)
    assert other.normal_load == pytest.approx(one.normal_load, rel=1e-12)
    assert other.centre == pytest.approx(
        one.centre, abs=PROMISE * (one.half_width + abs(one.centre))
    )


@given(strategies.scenes(), strategies.dyadic(-1, 1))
def test_a_tilt_of_the_scene_is_a_tilt_of_the_profile(scene, share):
    tilt = share * scene.tilt
    one = sie.solve(scene)
    other = one.with_(profile=scene.profile.tilted(tilt), tilt=scene.tilt - tilt)
    assert other.half_width == pytest.approx(one.half_width, rel=PROMISE)
    assert other.moment == pytest.approx(
        one.moment, abs=PROMISE * scene.normal_load * (one.half_width + abs(one.centre))
    )


@given(strategies.scenes(profile=sie.RoundedFlat(0.5, 1.0)), between(1.01, 5.0))
def test_the_pressure_grows_everywhere_with_the_load(scene, factor):
    light, heavy = sie.solve(scene), sie.solve(scene).with_(normal_load=factor * scene.normal_load)
    x = light.centre + light.half_width * S
    assert (heavy.pressure(x) > light.pressure(x)).all()


@given(log_between(0.1, 10), log_between(0.1, 10), log_between(0.1, 10), between(-0.9, 0.9))
def test_slopes_superpose_while_the_edges_are_the_same(rise, radius, width, tilt):
    """Symmetric profiles, one half-width: pressures, loads and potentials add."""
    parts = [sie.Wedge(rise), sie.Parabola(radius), sie.Power(4, rise / radius)]
    alone = [sie.solve(sie.Scene(profile=p, modulus=1.0, half_width=width)) for p in parts]
    together = sie.solve(
        sie.Scene(profile=parts[0] + parts[1] + parts[2], modulus=1.0, half_width=width)
    )
    assert together.normal_load == pytest.approx(sum(s.normal_load for s in alone), rel=PROMISE)
    x = width * np.array([-0.9, -0.4, 1e-3, 0.2, 0.7, 0.99])
    assert together.pressure(x) == pytest.approx(sum(s.pressure(x) for s in alone), rel=PROMISE)
    z = width * (0.3 + 0.2j)
    assert complex(together.pressure.cauchy(z)) == pytest.approx(
        sum(complex(s.pressure.cauchy(z)) for s in alone), rel=PROMISE
    )
