"""The load of a half-width that several patches have together."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

import sie
from analytic import parabola_row, wavy
from sie.io import scene_file
from sie.io.report import tension_summary
from sie.patches.half_width import Search, Width

TWO = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
FLATS = sie.Row([sie.Flat(0.4).shifted(-0.6), sie.Flat(0.55).shifted(0.85)])
WAVY = sie.FromFunction("x - 0.6*sin(12*x + 0.7)", domain=(-2.0, 2.0))
HARMONICS = sie.Periodic(
    sie.FromFunction("0.8*sin(x) + 1.05*sin(3*x + 0.5) + 0.84*sin(7*x + 1.1)"), 2.0 * np.pi
)


def solved(**asked):
    return sie.solve(sie.Scene(modulus=1.0, poisson=0.3, **asked))


@pytest.mark.parametrize(
    "asked",
    [
        {"profile": TWO, "normal_load": 0.4},
        {"profile": TWO, "normal_load": 0.4, "tilt": 0.05},
        {"profile": TWO, "normal_load": 0.4, "moment": 0.05},
        {"profile": WAVY, "normal_load": 0.228},
        {"profile": HARMONICS, "normal_load": 3.0},
    ],
    ids=["row", "tilted", "moment", "wavy", "period"],
)
def test_the_half_width_of_a_load_gives_the_load(asked):
    solution = solved(**asked)
    back = solution.with_(half_width=solution.half_width)
    assert back.normal_load == pytest.approx(asked["normal_load"], rel=1e-13)
    assert back.half_width == pytest.approx(solution.half_width, rel=1e-15)
    assert back.patches == pytest.approx(np.array(solution.patches), rel=1e-13)
    assert back.check().ok


@pytest.mark.parametrize("part", [1e-3, 0.4, 0.95])
def test_the_half_width_of_a_wave_has_its_load_in_closed_form(part):
    wave = sie.Periodic(sie.FromFunction("pi*sin(2*pi*x)"), 1.0)
    half = 0.5 * part
    mean = wavy.mean_pressure(half_width=half, wavelength=1.0, amplitude=0.5, modulus=1.0)
    assert solved(profile=wave, half_width=half).normal_load == pytest.approx(mean, rel=1e-13)


@pytest.mark.parametrize("part", [0.1, 0.7])
def test_the_half_width_of_a_row_of_parabolas_has_its_load_in_closed_form(part):
    row = sie.Periodic(sie.Parabola(1.0), 2.0)
    mean = parabola_row.mean_pressure(half_width=part, radius=1.0, period=2.0, modulus=1.0)
    found = solved(profile=row, half_width=part).normal_load
    assert found == pytest.approx(2.0 * mean, rel=1e-13)


@pytest.mark.parametrize(("profile", "inside"), [(TWO, 0.95), (HARMONICS, 1.0)])
def test_a_half_width_that_the_load_jumps_over_is_refused_with_both_sides(profile, inside):
    with pytest.raises(sie.ContactError, match="appears beyond the others") as refused:
        _ = solved(profile=profile, half_width=inside).normal_load
    below, light, above, heavy = map(
        float, re.findall(r"(?:from|to|load =) ([\d.e-]*\d)", str(refused.value))
    )
    assert below < inside < above
    assert light == pytest.approx(heavy, rel=1e-4)
    for half, load in ((below, light), (above, heavy)):
        assert solved(profile=profile, normal_load=load).half_width == pytest.approx(half, rel=1e-3)


@pytest.mark.parametrize(
    ("profile", "half", "words"),
    [
        (FLATS, 1.2, "sharp edges has half_width = 1.2 under many loads"),
        (FLATS, 0.5, "narrower than 1.2"),
        (FLATS, 1.3, "exceeds that of the indenter, 1.2"),
        (sie.Periodic(sie.Parabola(1.0), 2.0), 1.1, "exceeds half of the period, 1"),
        (HARMONICS, np.pi, "full contact has half_width"),
    ],
)
def test_a_half_width_without_one_load_is_refused_with_the_reason(profile, half, words):
    with pytest.raises(sie.ContactError, match=words):
        _ = solved(profile=profile, half_width=half).normal_load


def test_a_half_width_serves_scene_files_sweeps_and_plans(tmp_path):
    (tmp_path / "row.toml").write_text(
        "[profile]\nkind = 'row'\n"
        "[[profile.of]]\nkind = 'parabola'\nradius = 1.0\nshifted = -1.0\n"
        "[[profile.of]]\nkind = 'parabola'\nradius = 0.5\nshifted = 0.9\nraised = 0.02\n"
        "[pair]\nmodulus = 1.0\n[load]\nhalf_width = 1.2\n"
    )
    scene = sie.Scene(profile=TWO, modulus=1.0, half_width=1.2)
    load = sie.solve(scene).normal_load
    assert sie.solve(scene_file.read(tmp_path / "row.toml").scene).normal_load == load
    swept = sie.sweep(scene, over={"half_width": [1.2, 1.5]}, want="normal_load")
    assert swept["normal_load"][0] == pytest.approx(load, rel=1e-14)
    assert "half-width given: its load" in str(sie.plan(scene))


def test_friction_acts_on_the_load_of_a_half_width():
    load = solved(profile=TWO, half_width=1.2).normal_load
    asked = {"friction": 0.5, "tangential_load": 0.3 * load}
    one = solved(profile=TWO, half_width=1.2, **asked)
    other = solved(profile=TWO, normal_load=load, **asked)
    assert one.stick == pytest.approx(np.array(other.stick), rel=1e-13)


def test_noise_of_a_trace_moves_the_edges_of_a_given_half_width_together():
    x = np.linspace(-1.0, 1.0, 161)
    noise = 1e-5 * np.random.default_rng(5).normal(size=len(x))
    trace = sie.Sampled(x, 0.5 * x**2 + 0.02 * np.cos(12.0 * x) + noise, smoothing="gcv")
    solution = solved(profile=trace, normal_load=0.02)
    assert len(solution.patches) > 1
    (report,) = solution.with_(half_width=solution.half_width).trace_reports()
    left, right = report.edge_errors
    assert left == pytest.approx(right, rel=1e-6)


@pytest.mark.parametrize("profile", [TWO, HARMONICS])
def test_a_surface_without_tension_is_said_to_have_none(profile):
    report = tension_summary(solved(profile=profile, normal_load=0.4), scene_file.UNITS)
    assert "none" in report and "x =" not in report


def test_a_load_beside_the_one_that_is_sought_ends_no_search():
    """As after a bisection next to the answer, which rounding kept from being met."""
    search = SimpleNamespace(r=0.475)
    beside = Width(3.1222327, 0.474986, 4.255, None)
    assert not Search.reached(search, beside, 6.7e-6, 7.3e-16)


@pytest.mark.parametrize("load", [1e-6, 1e-8, 1e-10])
def test_a_light_contact_on_equal_valleys_is_found_from_its_half_width(load):
    row = sie.Row([sie.Parabola(0.5).shifted(-0.92), sie.Parabola(1.0).shifted(0.92)])
    asked = sie.Scene(profile=row, modulus=1.0, normal_load=load)
    given = sie.solve(asked)
    found = sie.solve(
        sie.Scene(profile=row, modulus=1.0, normal_load=None, half_width=given.half_width)
    )
    assert found.check().ok
    assert found.half_width == pytest.approx(given.half_width, rel=2e-15)
    # 2e-15 of r against its growth since the valleys touched, 5e-3 sqrt(P), twice for ln P
    assert found.normal_load == pytest.approx(load, rel=1e-12 / load**0.5)
