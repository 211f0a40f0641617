"""Reports of traces: what was measured and mended, and the error that noise implies."""

import json

import numpy as np
import pytest

import sie
from sie.io import export, report, scene_file

X = np.linspace(-1.0, 1.0, 401)


def white(seed, size=401):
    return np.random.default_rng(seed).standard_normal(size)


def solved(profile, **given):
    given = {"normal_load": 0.1} | given
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, **given))


def reported(profile, **given):
    (report,) = solved(profile, **given).trace_reports()
    return report


def test_the_misfit_of_a_repeated_trace_is_that_of_its_periodic_spline():
    x = np.linspace(0.0, 1.0, 201)
    h = 0.01 * np.cos(2.0 * np.pi * x)
    profile = sie.Periodic(sie.Sampled(x, h, 1e-4), 1.0)
    misfits = h - profile.height(x)
    found = reported(profile, normal_load=0.005)
    assert found.misfit == pytest.approx(np.sqrt(np.mean(misfits**2)), rel=1e-9)


def largest_error(found, exact):
    """The largest difference of the pressures over the peak, up to the outer edges."""
    lo, hi = np.array([found.edges, exact.edges]).T
    x = 0.5 * (min(lo) + max(hi)) + 0.5 * (max(hi) - min(lo)) * np.cos(
        np.linspace(0.0, np.pi, 1001)
    )
    p = exact.pressure(x)
    return np.abs(found.pressure(x) - p).max() / p.max()


PROFILES = {
    "parabola": (0.5 * X**2, sie.Parabola(1.0)),
    "cosh": (0.25 * np.cosh(2.0 * X), sie.FromFunction("sinh(2*x)/2", domain=(-1.0, 1.0))),
    "rounded": (np.maximum(np.abs(X) - 0.4, 0.0) ** 2 / 0.8, sie.RoundedFlat(0.4, 0.4)),
}
ASKED = {
    "load": {},
    "half-width": {"normal_load": None, "half_width": 0.5},
    "moment": {"moment": 2e-3},
}
CASES = [(profile, "load") for profile in PROFILES] + [
    ("parabola", "half-width"),
    ("parabola", "moment"),
]


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("profile", "asked"), CASES)
def test_the_stated_error_covers_the_true_one_and_is_no_multiple_of_it(profile, asked):
    """Noise of 1e-4 of the height; 2.5 standard deviations cover 9 of 10 cases."""
    h, shape = PROFILES[profile]
    exact = solved(shape, **ASKED[asked])
    stated, true, edges, moved = [], [], [], []
    for seed in range(20):
        found = solved(sie.Sampled(X, h + 1e-4 * np.ptp(h) * white(seed), "gcv"), **ASKED[asked])
        (report,) = found.trace_reports()
        stated.append(report.pressure_error)
        true.append(largest_error(found, exact))
        edges.append(max(report.edge_errors))
        moved.append(np.abs(np.subtract(found.edges, exact.edges)).max())
    ratio, ratio_of_edges = np.divide(stated, true), np.divide(edges, moved)
    assert np.count_nonzero(ratio >= 1.0) >= 18
    assert np.count_nonzero(ratio_of_edges >= 1.0) >= 18
    assert np.median(ratio) <= 10.0
    assert np.median(ratio_of_edges) <= 10.0


def test_smoothing_beyond_cross_validation_counts_as_an_error():
    h, shape = PROFILES["rounded"]
    found = solved(sie.Sampled(X, h + 1e-5 * white(0), 0.1))
    true = largest_error(found, solved(shape))
    assert true > 0.1
    assert true <= found.trace_reports()[0].pressure_error <= 2.0 * true


@pytest.mark.parametrize("smoothing", [0.0, "gcv"])
def test_a_trace_without_noise_is_distinguished_from_a_noisy_one(smoothing):
    assert reported(sie.Sampled(X, 0.25 * np.cosh(2.0 * X), smoothing)).pressure_error <= 1e-3


def test_a_profile_that_is_no_trace_has_no_report():
    assert solved(sie.Parabola(1.0)).trace_reports() == ()
    assert solved(sie.Flat(1.0), friction=float("inf")).trace_reports() == ()


@pytest.mark.parametrize("smoothing", [0.0, 1e-4, "gcv"])
@pytest.mark.parametrize("size", [1e-4, 1e-8])
def test_outliers_are_found_and_stay(smoothing, size):
    h = 0.5 * X**2 + size * white(8)
    bad = [5, 120, 121, 260, 263, 395]
    h[bad] += size * np.array([40.0, -60.0, -40.0, 200.0, 50.0, 40.0])
    trace = sie.Sampled(X, h, smoothing)
    assert list(trace.outliers) == bad
    assert (trace.heights == h).all()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("profile", PROFILES)
def test_noise_alone_and_the_kinks_of_a_pad_are_no_outliers(profile, seed):
    h = PROFILES[profile][0]
    assert sie.Sampled(X, h + 1e-4 * white(seed)).outliers == ()
    assert sie.Sampled(X + 1e-3 * seed, h).outliers == ()


@pytest.mark.parametrize(
    "h",
    [np.abs(X), np.abs(X - 0.0013), np.zeros(401), X],
    ids=["wedge", "beside a point", "flat", "line"],
)
def test_a_trace_without_noise_has_no_outliers_but_the_point_that_is_off(h):
    assert sie.Sampled(X, h).outliers == ()
    off = h.copy()
    off[90] += 1e-3
    assert sie.Sampled(X, off).outliers == (90,)


def test_mended_points_are_reported():
    x = np.concatenate((X[::-1], [0.0, 0.005]))
    h = np.append(0.5 * X[::-1] ** 2, [0.0, 1e-5])
    h[100:180] = np.nan
    report = reported(sie.Sampled(x, h, mend=True))
    assert report.mended == (80, 2, True)
    ((missing, lo, hi),) = ((gap.missing, gap.lo, gap.hi) for gap in report.gaps)
    assert (missing, lo, hi) == (80, X[220], X[301])
    assert reported(sie.Sampled(X, 0.5 * X**2).smoothed("gcv")).mended == (0, 0, False)
    assert reported(sie.Sampled(x, h, mend=True).levelled()).mended == report.mended


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_the_report_has_the_levelling_that_is_left(sign):
    h = np.maximum(np.abs(X) - 0.4, 0.0) ** 2 / 0.8
    askew = sie.Sampled(X, h + sign * 2e-3 * X)
    assert reported(askew, normal_load=1e-4).tilt == pytest.approx(sign * 2e-3, rel=1e-6)
    assert reported(askew, tilt=-sign * 2e-3).tilt == pytest.approx(0.0, abs=1e-12)
    assert reported(askew.tilted(-sign * 2e-3)).tilt == pytest.approx(0.0, abs=1e-12)


def test_the_reports_of_a_scene_file_keep_noise_and_certificate_apart():
    h = 0.5 * (X**2 + 1e-4 * white(1))
    h[40] += 0.01
    h[200:220] = np.nan
    solution = solved(sie.Sampled(X, h, "gcv", mend=True))
    file = scene_file.SceneFile(solution.scene, "", scene_file.Units(), ("check",), ())
    text, parsed = report.summary(solution, file), json.loads(export.json_text(solution, file))
    for row in (
        "estimated relative error of the pressure",
        "noise estimate",
        "20 points without a value",
    ):
        assert text.count(row) == 1
    (trace,) = parsed["traces"]
    assert trace["pressure_error"] > 1e-3 > 1e9 * parsed["check"]["error"]
    assert trace["smoothing"] == solution.scene.profile.lam
    assert trace["misfit"] == solution.scene.profile.misfit
    assert trace["mended"] == {"left_out": 20, "averaged": 0, "sorted": False}
    assert [gap["missing"] for gap in trace["gaps"]] == [20]
    assert [x for x, _ in trace["outliers"]] == [X[40]]
    assert "traces" not in json.loads(export.json_text(solved(sie.Parabola(1.0)), file))


@pytest.mark.slow
@pytest.mark.parametrize("smoothing", [0.0, "gcv"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_error_stated_for_several_patches_covers_that_of_the_noise(smoothing, seed):
    x = np.linspace(-2.0, 2.0, 401)
    clean = 0.1 * np.cos(9.0 * x) + x * x / 8.0
    noisy = clean + 1e-4 * np.random.default_rng(seed).standard_normal(len(x))
    given = {"modulus": 1.0, "normal_load": 0.2}
    measured = sie.solve(sie.Scene(profile=sie.Sampled(x, noisy, smoothing), **given))
    true = sie.solve(sie.Scene(profile=sie.Sampled(x, clean), **given))
    (report,) = measured.trace_reports()
    at = np.linspace(-1.2, 1.2, 2001)
    error = np.abs(measured.pressure(at) - true.pressure(at)).max() / true.pressure(at).max()
    assert len(measured.patches) > 1
    assert error < report.pressure_error < 0.5
    moved = np.abs(np.subtract(measured.edges, true.edges))
    assert (moved < 4.0 * np.array(report.edge_errors)).all()
