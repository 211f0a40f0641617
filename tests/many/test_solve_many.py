"""Scenes as arrays have the answers of `solve`, one by one, and its refusals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sie
from sie.sweeps import sweep as of_sweep

N = 12
RNG = np.random.default_rng(34)
A, R, E = RNG.uniform(0.1, 1.0, N), RNG.uniform(0.5, 2.0, N), RNG.uniform(0.5, 2.0, N)
P, TILT = RNG.uniform(0.05, 1.0, N), RNG.uniform(-0.1, 0.1, N)
F, Q = RNG.uniform(0.2, 0.6, N), RNG.uniform(-0.1, 0.1, N) * P
X = np.linspace(-1.0, 1.0, 21)
BAR = 1e-13
SLIPS = {"friction": F, "tangential_load": Q, "bulk_stress": 0.02 * Q}


def lopsided(x, k):
    return np.sinh(k * x) + 0.1 * x**2


def bumpy(x):
    return x + 0.5 * np.sin(9.0 * x)


CASES = {
    "parabolas": (sie.Parabola(R), lambda k: sie.Parabola(R[k]), {"tilt": TILT, **SLIPS}),
    "punches": (sie.RoundedFlat(A, R), lambda k: sie.RoundedFlat(A[k], R[k]), SLIPS),
    "tilted": (sie.RoundedFlat(A, 1.0), lambda k: sie.RoundedFlat(A[k], 1.0), {"tilt": TILT}),
    "thin rims": (
        sie.RoundedFlat(1.0, 1e-4 * R), lambda k: sie.RoundedFlat(1.0, 1e-4 * R[k]), {}
    ),
    "tips": (sie.Wedge(A), lambda k: sie.Wedge(A[k]), {}),
    "corners": (sie.Flat(A), lambda k: sie.Flat(A[k]), {"tilt": 1e-3 * TILT}),
    "powers": (sie.Power(2.7, A), lambda k: sie.Power(2.7, A[k]), {"tilt": TILT * (X[:N] > 0.0)}),
    "a polynomial": (
        sie.Polynomial((0.0, 0.1, 0.5, 0.1, 0.3)),
        lambda _: sie.Polynomial((0.0, 0.1, 0.5, 0.1, 0.3)),
        {"tilt": TILT, "friction": F, "tangential_load": Q},
    ),
    "a function of a parameter": (
        lopsided,
        lambda k: sie.FromFunction(lambda x: lopsided(x, R[k])),
        {"tilt": TILT, "parameters": {"k": R}},
    ),
    "a wavy function": (
        sie.FromFunction(bumpy), lambda _: sie.FromFunction(bumpy), {"tilt": 0.3 * TILT}
    ),
    "half-widths": (
        sie.RoundedFlat(0.5 * P, R),
        lambda k: sie.RoundedFlat(0.5 * P[k], R[k]),
        {"half_width": P},
    ),
}  # fmt: skip


def scenes(one, given):
    load = {} if "half_width" in given else {"normal_load": P}
    numbers = {k: v for k, v in (given | load).items() if k != "parameters"}
    for k in range(N):
        each = {name: float(np.broadcast_to(v, N)[k]) for name, v in numbers.items()}
        yield sie.Scene(profile=one(k), modulus=E[k], **each)


@pytest.mark.parametrize("case", CASES)
def test_answers_are_those_of_one_by_one(case):
    profile, one, given = CASES[case]
    load = {} if "half_width" in given else {"normal_load": P}
    many = sie.solve_many(profile, modulus=E, **load, **given)
    assert (many.refused == "").all()
    p = many.pressure(X)
    for k, scene in enumerate(scenes(one, given)):
        alone = sie.solve(scene)
        b, force = alone.half_width, alone.normal_load
        assert many.edges[k] == pytest.approx(alone.edges, abs=BAR * b)
        assert many.normal_load[k] == pytest.approx(force, rel=BAR)
        assert many.moment[k] == pytest.approx(alone.moment, abs=BAR * force * b)
        assert many.tilt[k] == alone.tilt
        exact = alone.pressure(X)
        finite = np.isfinite(exact)
        assert p[k][finite] == pytest.approx(exact[finite], abs=20 * BAR * force / b)
        stick = alone.stick[0] if len(alone.stick) == 1 else (np.nan, np.nan)
        assert many.stick[k] == pytest.approx(stick, abs=10 * BAR * b, nan_ok=True)


@given(st.floats(-8.0, 4.0), st.floats(-4.0, 2.0), st.floats(-2.0, 2.0))
def test_rounded_punches_of_all_sizes(load, half_flat, radius):
    P, a, R = 10.0**load, 10.0**half_flat, 10.0**radius
    many = sie.solve_many(sie.RoundedFlat(np.array([a]), R), modulus=1.0, normal_load=P)
    alone = sie.solve(sie.Scene(profile=sie.RoundedFlat(a, R), modulus=1.0, normal_load=P))
    assert many.half_width[0] == pytest.approx(alone.half_width, rel=1e-14)
    x = alone.half_width * np.array([0.0, 0.3, 0.7])
    assert many.pressure(x)[0] == pytest.approx(alone.pressure(x), rel=1e-11)


def test_numbers_are_broadcast_to_a_grid_of_scenes():
    punches = sie.RoundedFlat(half_flat=A[:3, None], radius=1.0)
    many = sie.solve_many(punches, modulus=1.0, normal_load=P[None, :5])
    assert many.half_width.shape == many.peak_pressure.shape == many.refused.shape == (3, 5)
    assert many.edges.shape == many.stick.shape == (3, 5, 2)
    assert many.pressure(np.zeros((2, 4))).shape == (3, 5, 2, 4)
    one = sie.solve_many(sie.RoundedFlat(A[2], 1.0), modulus=1.0, normal_load=P[4])
    assert one.half_width.shape == () and one.half_width == many.half_width[2, 4]


def test_the_peak_is_the_largest_pressure():
    many = sie.solve_many(sie.RoundedFlat(np.array([0.2, 1.5]), 1.0), modulus=1.0, normal_load=1.0)
    x = np.linspace(-2.4, 2.4, 20001)
    assert many.peak_pressure == pytest.approx(many.pressure(x).max(axis=1), rel=1e-6)
    assert (many.peak_pressure >= many.pressure(x).max(axis=1)).all()
    tips = sie.solve_many(sie.Wedge(np.array([0.1, 0.2])), modulus=1.0, normal_load=1.0)
    assert np.isinf(tips.peak_pressure).all()


def test_a_refused_scene_is_nan_and_has_the_reason_of_solve():
    loads, Q = np.array([1.0, -1.0, 1.0]), np.array([0.1, 0.1, 0.9])
    punch = sie.Parabola(1.0)
    many = sie.solve_many(punch, modulus=1.0, normal_load=loads, friction=0.5, tangential_load=Q)
    assert np.isfinite(many.half_width).tolist() == [True, False, False]
    assert "normal_load = -1" in many.refused[1] and "exceeds f P" in many.refused[2]
    assert np.isnan(many.pressure(0.0)[1:]).all() and np.isnan(many.edges[1]).all()
    assert repr(many) == "Many(scenes of shape (3,), 2 refused)"


def test_a_contact_that_reaches_the_end_of_a_trace_is_refused_in_its_place():
    x = np.linspace(-1.0, 1.0, 41)
    many = sie.solve_many(sie.Sampled(x, x**2), modulus=1.0, normal_load=[0.1, 100.0])
    assert many.half_width[0] > 0.0 and "end of the trace" in many.refused[1]


def test_several_patches_are_answered_as_by_solve():
    row = sie.Row([sie.Parabola(1.0), sie.Parabola(1.0).shifted(3.0)])
    many = sie.solve_many(row, modulus=1.0, normal_load=[0.1, 0.2])
    alone = sie.solve(sie.Scene(profile=row, modulus=1.0, normal_load=0.2))
    assert many.edges[1] == pytest.approx(alone.edges, rel=1e-15)


def test_arrays_of_parameters_are_no_single_scene():
    with pytest.raises(ValueError, match="solve_many"):
        sie.Scene(profile=sie.Parabola(R), modulus=1.0, normal_load=1.0)
    with pytest.raises(ValueError, match="radius = -1"):
        sie.Parabola(np.array([1.0, -1.0]))


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({}, "exactly one"),
        ({"normal_load": 1.0, "half_width": 1.0}, "exactly one"),
        ({"normal_load": [1.0, 2.0], "tilt": [0.0, 0.0, 0.0]}, "no common shape"),
        ({"normal_load": "much"}, "normal_load"),
    ],
)
def test_numbers_of_no_question_are_refused(given, what):
    with pytest.raises(ValueError, match=what):
        sie.solve_many(sie.Parabola(1.0), modulus=1.0, **given)


PUNCH = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.3)
STEEL = sie.Scene(profile=sie.Parabola(2.0), body=sie.Elastic(200.0, 0.3), half_width=0.3)
OVER = {"profile.half_flat": [0.2, 0.4, 0.6, 0.8], "normal_load": [0.1, 0.5, 1], "tilt": [0, 0.01]}
SWEEPS = {
    "punches": (PUNCH, {**OVER, "modulus": [1.0, 2.0]}, ("half_width", "edges", "moment")),
    "steel": (STEEL, {"normal_load": np.geomspace(0.1, 10.0, 40)}, "centre"),
    "friction": (STEEL, {"half_width": np.linspace(0.1, 1.0, 40), "friction": [0.0, 0.3]},
                 ("half_width", "normal_load", "contact_length", "patches", "gap_volume", "tilt")),
}  # fmt: skip


@pytest.mark.parametrize("case", SWEEPS)
def test_a_sweep_as_arrays_has_values_and_labels_of_one_point_after_the_other(case, monkeypatch):
    scene, over, want = SWEEPS[case]
    calls = []
    whole = of_sweep.as_arrays
    monkeypatch.setattr(of_sweep, "as_arrays", lambda *a: calls.append(whole(*a)) or calls[-1])
    at_once = sie.sweep(scene, over, want)
    assert calls[0] is not None
    monkeypatch.setattr(of_sweep, "as_arrays", lambda *_: None)
    each = sie.sweep(scene, over, want)
    assert list(at_once) == list(each)
    for name in each:
        one, other = np.asarray(at_once[name]), np.asarray(each[name])
        assert one.shape == other.shape
        if one.dtype == object:
            assert (one == other).all()
        else:
            assert one == pytest.approx(other, rel=1e-14, abs=1e-15)
        if hasattr(at_once[name], "attrs"):
            assert at_once[name].attrs == each[name].attrs
            assert at_once[name].dims == each[name].dims


def test_a_sweep_with_a_point_without_answer_names_it_as_before():
    swept = sie.sweep(PUNCH, {"normal_load": [*np.linspace(0.1, 1.0, 40), -1.0]}, "half_width")
    reasons = np.asarray(swept["reason"])
    assert "normal_load" in reasons[-1] and not any(reasons[:-1])
