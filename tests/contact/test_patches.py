"""Contact in several patches, against values of thirty digits and laws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import solved

import sie
from sie.patches import certificate

TWO = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
ROUNDED = sie.Row(
    [sie.RoundedFlat(0.4, 1.0).shifted(-1.2), sie.RoundedFlat(0.25, 2.0).shifted(1.0).raised(0.01)]
)
FLATS = sie.Row([sie.Flat(0.4).shifted(-0.6), sie.Flat(0.55).shifted(0.85)])


def waved(x):
    return x - 0.6 * np.sin(12.0 * x + 0.7)


def harmonics(x):
    return 0.8 * np.sin(x) + 1.05 * np.sin(3.0 * x + 0.5) + 0.84 * np.sin(7.0 * x + 1.1)


# Edges by Newton's method on the integral equation in 30 digits, by two different routes.
REFERENCES = {
    "two parabolas": (
        {"profile": TWO, "normal_load": 0.4},
        (-1.583259866386028, -0.5352490379744177, 0.6034852112374817, 1.269847059573996),
    ),
    "two parabolas under a moment": (
        {"profile": TWO, "normal_load": 0.4, "moment": 0.05},
        (-1.4586494119000068, -0.5433431080009849, 0.5878260184514227, 1.3454802188258234),
    ),
    "wavy punch": (
        {"profile": sie.FromFunction(waved, domain=(-2.0, 2.0)), "normal_load": 0.228},
        (-0.43237913911396203, -0.12219005194204682, 0.001890506233437465,
         0.352657113232932, 0.6302796532851106, 0.6890729844189019),
    ),
    "two rounded flats": (
        {"profile": ROUNDED, "normal_load": 0.6},
        (-2.2077445537801064, -0.4322494089516196, 0.2150844950708833, 2.1984352398583987),
    ),
    "three harmonics": (
        {"profile": sie.Periodic(sie.FromFunction(harmonics), 2.0 * np.pi), "normal_load": 3.0},
        (-2.787302433508856, -1.7014107978420885, -1.221104816631071,
         0.9822849637598969, 1.312094138295231, 2.4838367704880184),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFERENCES)
def test_the_edges_of_all_patches_are_the_references_and_certified(name):
    asked, expected = REFERENCES[name]
    solution = solved(**asked)
    edges, period = np.ravel(solution.patches), asked["profile"].period
    if period < np.inf:
        edges = np.sort(edges - period * np.round((edges - np.mean(expected)) / period))
    narrowest = np.diff(expected)[::2].min()
    np.testing.assert_allclose(edges, expected, rtol=0.0, atol=2e-13 * narrowest)
    assert solution.check().ok
    if "moment" in asked:
        assert solution.tilt == pytest.approx(-0.07597308212919692, rel=1e-13)


def test_patch_loads_of_two_parabolas():
    loads = solved(profile=TWO, normal_load=0.4).patch_loads
    assert loads == pytest.approx((0.222276321277639299, 0.177723678722360700), rel=1e-14)


def test_patch_loads_of_level_flats():
    solution = solved(profile=FLATS, normal_load=1.0)
    assert solution.patch_loads[0] == pytest.approx(0.458724602705791840, rel=1e-14)
    x, zero = np.array([-0.9, -0.3, 0.5, 1.2]), 0.0465571332180433652833
    root = np.sqrt(np.abs((x + 1.0) * (x + 0.2) * (x - 0.3) * (x - 1.4)))
    assert solution.pressure(x) == pytest.approx(np.abs(x - zero) / (np.pi * root), rel=1e-13)


def test_a_row_of_one_convex_profile_is_that_profile():
    one = solved(profile=sie.Parabola(1.0), normal_load=0.4)
    row = solved(profile=sie.Row([sie.Parabola(1.0)]), normal_load=0.4)
    x = np.linspace(-0.7, 0.7, 29)
    assert row.edges == pytest.approx(one.edges, rel=1e-14)
    assert row.pressure(x) == pytest.approx(one.pressure(x), rel=1e-13)
    assert row.gap(2.0 * x) == pytest.approx(one.gap(2.0 * x), rel=1e-11, abs=1e-15)
    z = np.linspace(-1.0, 1.0, 9) + 0.2j
    assert row.pressure.cauchy(z) == pytest.approx(one.pressure.cauchy(z), rel=1e-13)
    assert row.stress(x, 0.3).xy == pytest.approx(one.stress(x, 0.3).xy, abs=1e-13)


SCENES = {
    "row": {"profile": TWO, "normal_load": 0.4},
    "flats": {"profile": FLATS, "normal_load": 1.0},
    "wave": {"profile": sie.Periodic(sie.FromFunction(harmonics), 2.0 * np.pi), "normal_load": 3.0},
    "trace": {
        "profile": sie.Sampled(np.linspace(-2, 2, 201), 0.1 * np.cos(9 * np.linspace(-2, 2, 201)))
        + sie.Parabola(4.0),
        "normal_load": 0.2,
    },
}


@pytest.mark.parametrize("name", SCENES)
def test_patch_loads_add_up_to_the_load(name):
    solution = solved(**SCENES[name])
    assert sum(solution.patch_loads) == pytest.approx(solution.normal_load, rel=1e-8)


@pytest.mark.parametrize("name", SCENES)
def test_the_mirror_image_has_mirrored_patches(name):
    asked = SCENES[name]
    one = solved(**asked)
    other = solved(**(asked | {"profile": asked["profile"].mirrored()}))
    ends = np.sort(-np.array(other.patches).ravel())
    period = asked["profile"].period
    start = np.array(one.patches).ravel()
    if period < np.inf:
        ends = np.sort(np.mod(ends - start[0] + 1e-6, period)) + start[0] - 1e-6
    np.testing.assert_allclose(ends, start, rtol=0.0, atol=1e-12 * np.abs(start).max())


@pytest.mark.parametrize("name", SCENES)
def test_pressure_and_load_scale_with_the_modulus(name):
    one = solved(**SCENES[name])
    stiff = sie.Scene(modulus=1e6, **(SCENES[name] | {"normal_load": 1e6 * one.normal_load}))
    np.testing.assert_allclose(sie.solve(stiff).patches, one.patches, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("name", ["row", "wave"])
@pytest.mark.parametrize("depth", [0.02, 0.05, 0.2])
def test_the_potential_below_the_surface_is_the_integral_of_the_pressure(name, depth):
    """Closer to the surface than a panel is long, and farther from it than a series ends."""
    solution = solved(**SCENES[name])
    period = solution.scene.profile.period
    x = np.linspace(*solution.edges, 17) + 1j * depth
    angle = np.linspace(0.0, np.pi, 4001)
    angle = 0.5 * (angle[1:] + angle[:-1])  # the midpoint rule of an even periodic function
    total = 0.0
    for a, b in solution.patches:
        t = 0.5 * (a + b) - 0.5 * (b - a) * np.cos(angle)
        weight = solution.pressure(t) * np.sin(angle) * 0.5 * (b - a) / 4000
        d = x[:, None] - t
        kernel = 1.0 / d if np.isinf(period) else np.pi / period / np.tan(np.pi * d / period)
        total = total + kernel @ weight
    assert solution.pressure.cauchy(x) == pytest.approx(total, rel=1e-12)


@pytest.mark.parametrize("name", ["row", "wave", "trace"])
def test_the_gap_opens_as_the_potential_says(name):
    """Every gap, the last one of a period too, which ends in the next; where it ends it is 0."""
    solution = solved(**SCENES[name])
    ends = np.ravel(solution.patches)[1:]
    period = solution.scene.profile.period
    ends = np.append(ends, solution.patches[0][0] + period) if period < np.inf else ends[:-1]
    assert solution.gap(ends) == pytest.approx(0.0, abs=1e-14)
    for lo, hi in ends.reshape(-1, 2):
        x = lo + (hi - lo) * np.linspace(0.2, 0.8, 7)
        step = 1e-5 * (hi - lo)
        opened = (solution.gap(x + step) - solution.gap(x - step)) / (2.0 * step)
        H = solution.scene.profile.slope(x) - 2.0 * solution.pressure.hilbert(x)
        finite = np.isfinite(opened) & np.isfinite(H)
        assert opened[finite] == pytest.approx(H[finite], abs=1e-6)


PARABOLAS = sie.Row([sie.Parabola(1.0).shifted(1.3 * k).raised(0.01 * (k % 3)) for k in range(10)])


@pytest.mark.parametrize(("row", "load"), [(TWO, 0.4), (PARABOLAS, 1.5)])
def test_the_gap_over_a_concave_corner_is_as_exact_as_elsewhere(row, load):
    """From the first edge on it is ∫(H - F) dx, F by the potential, H on both sides by heights."""
    solution = solved(profile=row, normal_load=load)
    lo, hi = solution.patches[0][1], solution.patches[1][0]
    g, w = np.polynomial.legendre.leggauss(40)
    for part in (0.1, 0.3, 0.45, 0.55, 0.8):
        root = np.sqrt(part * (hi - lo)) * 0.5 * (g + 1.0)
        pulled = (solution.pressure.hilbert(lo + root**2) * root * w).sum() * (root[-1] + root[0])
        x = np.array([lo, lo + part * (hi - lo)])
        expected = np.diff(row.height(x))[0] - 2.0 * pulled
        assert float(solution.gap(x[1])) == pytest.approx(expected, rel=3e-14, abs=0.0)


@pytest.mark.parametrize(("row", "load"), [(TWO, 0.4), (PARABOLAS, 1.5)])
@pytest.mark.parametrize("wrong", [1e-8, 2e-12])
def test_a_wrong_gap_is_not_certified(row, load, wrong, monkeypatch):
    solution, right = solved(profile=row, normal_load=load), certificate.gap
    assert solution.check().gap < 1e-14
    middle = np.mean((solution.patches[0][1], solution.patches[1][0]))

    def beside(o, x):
        return right(o, x) * np.where(x > middle, 1.0 + wrong, 1.0)

    monkeypatch.setattr(certificate, "gap", beside)
    again = solved(profile=row, normal_load=load).check()
    assert 0.1 * wrong < again.gap < 2.0 * wrong
    assert not again.ok


def test_a_shift_by_a_period_changes_nothing():
    solution = solved(**SCENES["wave"])
    x = np.linspace(-3.0, 3.0, 13)
    there = x + 40.0 * np.pi
    assert solution.pressure(there) == pytest.approx(solution.pressure(x), rel=1e-11, abs=1e-12)
    assert solution.gap(there) == pytest.approx(solution.gap(x), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ["row", "wave", "trace"])
def test_the_derivative_of_the_potential_on_the_surface_is_that_of_slope_and_pressure(name):
    solution = solved(**SCENES[name])
    lo, hi = solution.patches[0]
    x = lo + (hi - lo) * np.array([0.21, 0.52, 0.83])
    step = 1e-5 * (hi - lo)
    p, slope = solution.pressure, solution.scene.profile.slope
    steep = p.cauchy_derivative(x)
    rise = (p(x + step) - p(x - step)) / (2.0 * step)
    assert steep.imag == pytest.approx(-rise, rel=1e-5, abs=1e-5 * np.abs(rise).max())
    bend = (slope(x + step) - slope(x - step)) / (2.0 * step)
    assert steep.real == pytest.approx(0.5 * bend, rel=1e-5, abs=1e-6)


def test_the_wave_in_full_contact():
    profile = sie.FromFunction(lambda x: np.pi * np.sin(2.0 * np.pi * x))
    solution = solved(profile=sie.Periodic(profile, 1.0), normal_load=2.0)
    x = np.linspace(-0.5, 0.5, 11)
    exact = 2.0 + 0.5 * np.pi * np.cos(2.0 * np.pi * x)
    assert solution.pressure(x) == pytest.approx(exact, rel=1e-13)
    assert solution.check().ok
    assert not solution.gap(x).any()


SHEARED = {"friction": 0.5, "tangential_load": 0.1}


def test_the_shear_of_a_row_of_one_is_that_of_its_profile():
    loads = {**SHEARED, "normal_load": 0.4, "bulk_stress": 0.05}
    one = solved(profile=sie.Parabola(1.0), **loads)
    row = solved(profile=sie.Row([sie.Parabola(1.0)]), **loads)
    x = np.linspace(-0.7, 0.7, 15)
    assert row.stick[0] == pytest.approx(one.stick[0], rel=1e-12)
    assert row.shear(x) == pytest.approx(one.shear(x), abs=1e-13)
    assert row.slip(x) == pytest.approx(one.slip(x), abs=1e-12)
    assert row.energy_lost == pytest.approx(one.energy_lost, rel=1e-9)
    assert row.shift == pytest.approx(one.shift, rel=1e-8)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({**SCENES["wave"], "moment": 0.1}, "leave out tilt and moment"),
        ({"profile": sie.Sampled([-1, 0, 1, 2], [1, 0, 0.5, 0])}, "end of the trace"),
        ({**SCENES["wave"], **SHEARED, "bulk_stress": 0.1}, "no periodic answer"),
        ({**SCENES["row"], "friction": 0.5, "bulk_stress": 0.1}, "slip to either side"),
        ({**SCENES["row"], "friction": float("inf")}, "full stick"),
    ],
)
def test_what_is_not_covered_is_refused_with_the_reason(asked, words):
    solution = solved(**asked)
    with pytest.raises(sie.ContactError, match=words):
        _ = solution.check(), solution.stick


@pytest.mark.slow
@given(st.integers(0, 10**9))
@settings(max_examples=20, deadline=None)
def test_a_random_row_is_certified_or_refused(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    profiles = [
        sie.Parabola(float(10.0 ** rng.uniform(-0.7, 0.7))).shifted(float(x)).raised(float(z))
        for x, z in zip(rng.uniform(0.0, n, n), rng.uniform(0.0, 0.1, n), strict=True)
    ]
    solution = solved(profile=sie.Row(profiles), normal_load=float(10.0 ** rng.uniform(-4.0, 0.0)))
    try:
        certificate = solution.check()
    except sie.ContactError:
        return
    assert certificate.ok or certificate.tension  # a concave corner closed to rounding is named


WELLS = sie.Polynomial((0.0, 0.0, -0.5, 0.0, 1.0))


@pytest.mark.parametrize(
    "profile",
    [
        WELLS,
        sie.Row([sie.Parabola(1.0), sie.Parabola(1.0).shifted(3.0)]),
        sie.Periodic(sie.Parabola(1.0), 2.0),
    ],
)
def test_half_width_of_several_patches_is_refused_and_the_load_answered(profile):
    with pytest.raises(sie.LoadError, match=r"one patch .* give normal_load") as refused:
        _ = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=0.2)).edges
    assert len(str(refused.value).split()) <= 40
    assert sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=0.02)).check().ok


def test_half_width_of_a_patch_merged_from_two_gives_the_load():
    load = sie.solve(sie.Scene(profile=WELLS, modulus=1.0, half_width=1.5)).normal_load
    back = sie.solve(sie.Scene(profile=WELLS, modulus=1.0, normal_load=load))
    assert back.half_width == pytest.approx(1.5, rel=1e-13)
    assert back.check().ok
