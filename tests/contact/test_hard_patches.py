"""Contacts in several patches on which the search or its certificate once failed."""

import numpy as np
import pytest
from traces import rough_trace

import sie
from analytic import two_parabolas


def parabolas(*places):
    """A row of parabolas, each with its radius, place and height."""
    return sie.Row([sie.Parabola(R).shifted(x).raised(z) for R, x, z in places])


def flats(*places):
    return sie.Row([sie.Flat(a).shifted(x).raised(z) for a, x, z in places])


def rounded_flats(*places):
    return sie.Row([sie.RoundedFlat(a, R).shifted(x).raised(z) for a, R, x, z in places])


def waves(x):
    """The slope of a shallow bowl with waves, which have no end."""
    return x / 7.5 - 0.05 * np.sin(11.0 * x + 0.3) - 0.03 * np.sin(7.0 * x - 1.0)


def rounded_ends(points):
    """A rough trace that rises at both ends; between its points a patch leaves narrow panels."""
    trace = rough_trace(points, 1)
    x = trace.points
    return sie.Sampled(x, trace.heights + 0.5 * np.maximum(np.abs(x) - 0.9, 0.0) ** 2)


def crowded():
    """Newton's method takes no edge over a corner: what overlaps beyond has to become a patch."""
    rng = np.random.default_rng([7, 8416])
    rng.uniform(-6, 2)
    n = int(rng.integers(2, 51))
    radii, x = 10 ** rng.uniform(-0.7, 0.7, n), np.cumsum(rng.uniform(0.2, 1.8, n))
    heights = rng.uniform(0, 0.1, n)
    return parabolas(*zip(radii.tolist(), x.tolist(), heights.tolist(), strict=True))


def shows(part):
    """Two parabolas, the narrow one of which shows over so much of its radius of about 0.25."""
    place, length, curvature = 0.04, 0.25 * part, 1.0 / 0.25 - 1.0 / 4.0
    height = 0.5 * place**2 / (4.0 - 0.25) - curvature * length**2 / 8.0
    return parabolas((4.0, 0.0, 0.0), (0.25, place, height))


def two_places(place):
    return rounded_flats((0.05, 0.3, place, 0.0), (0.05, 0.3, place + 3.0, 0.1))


BOWL, WELLS = sie.FromFunction(waves), sie.Polynomial((0.0, 0.0, -1.0, 0.0, 0.5))
THIRTEEN = flats(*((0.2 + 0.02 * k, 1.9 * k, 0.0) for k in range(13)))
THREE_FLATS = flats((0.49, 1.6796, 0.0101848), (0.179, 3.1852, 0.0035474), (0.186, 22.5, 0.0))
EQUAL_FLATS = flats(*((0.2, x, 0.0) for x in (0.0, 1.5, 3.07)))
FAR_APART = rounded_flats(
    (0.43, 0.12, 1.4, 0.014), (0.4, 0.9, 9.6, 0.0014), (0.3, 4.9, 18.4, 0.013)
)  # fmt: skip
KNOTS = 0.01 * np.arange(240)
WAVE = sie.Sampled(KNOTS, 1e-4 * np.cos(2.0 * np.pi * KNOTS / 2.4))
# A narrow parabola shows by 1e-5 under a wide one: at its corners p falls like 1e-4 ln x.
ROUNDED_AWAY = parabolas((1.3, 0.064, 3.7e-4), (0.7, 0.049, 5.5e-4))


def rough(points, seed, period, size=0.01):
    return sie.Periodic(rough_trace(points, seed, size=size), period)


# The profile, the load, what else is given, how many patches there are, and bounds of what the
# certificate measures.
HARD = {
    "corners that doubles round": (
        flats((0.42, 5.3, 0.0), (0.116, 7.26, 0.0)), 4.1, {}, 2,
        {"residual": 1e-12, "force": 1e-12},
    ),
    "a corner that closes to rounding": (ROUNDED_AWAY, 0.05, {}, None, {"residual": 3e-13}),
    "more flats than are searched roughly": (THIRTEEN, 0.05, {}, 13, {}),
    # The knots 0.01 k and the even cuts of the period differ by rounding.
    "knots within rounding of a panel": (
        sie.Periodic(WAVE, 2.4), 2.4, {}, None, {"error": 1e-13}
    ),
    "one patch a period": (rough(60, 4, 2.05, 0.001), 5.0, {}, 1, {}),
    **{f"a light load between corners, {P}": (FAR_APART, P, {"moment": 5.2 * P}, 2, {})
       for P in (1e-4, 1e-5, 1e-6)},
    **{f"waves without end, {P}": (BOWL, P, {}, None, {"residual": 1e-13}) for P in (20.0, 200.0)},
    # A move of the smooth edge depends on the charge of the sharp one.
    **{f"beside a sharp edge, tilt {tilt}":
       (EQUAL_FLATS, 2.5e-4, {"tilt": tilt}, None, {"force": 3e-14}) for tilt in (-0.018, 0.03)},
    **{f"the corner of a tilted flat, {P}": (THREE_FLATS, P, {"tilt": 0.0029733}, 2, {})
       for P in (0.00041, 0.00042, 0.000435)},
    # All places are as near to one edge of such a patch as to the other, to 1e-10 of it.
    **{f"parabolas nearly fill their period, {P}, {z}":
       (sie.Periodic(parabolas((1.0, 0.0, 0.0), (1.0, 1.0, z)), 2.5), P, {}, 1, {})
       for P, z in ((10.0, 0.0), (12.0, 0.1), (14.0, 0.05), (17.0, 0.2), (20.0, 0.05))},
    # The two halves of such a patch are nearer to each other than to their repetitions.
    **{f"longer than half a period, {n}":
       (rough(n, 4, 2.0 + 2.0 / n, 0.001), P, {}, None, {"residual": 1e-13})
       for n, P in ((60, 5.0), (97, 5.0), (240, 20.0))},
    **{f"closed corners, {part}, {P}": (shows(part), P, {}, None, {"measured_to": 1e-10})
       for part, P in ((1e-3, 0.02), (2e-3, 0.2), (5e-3, 0.02), (5e-3, 0.2))},
    **{f"far from the origin, {d}": (
        parabolas((1.0, 0.0, 0.0), (1.0, d, 0.0)), 1e-4, {}, 2,
        {"measured_to": 100.0 * np.spacing(d) / np.sqrt(2e-4 / np.pi)},
    ) for d in (30.0, 1e3)},
    **{f"a moment about a distant origin, {x}, {P}":
       (two_places(x), P, {"moment": (x + 0.01) * P}, None, {"measured_to": 1e-6})
       for x, P in ((5.3, 1e-6), (50.0, 1e-6), (50.0, 1e-4))},
    **{f"a load whose square is no double, {P}": (WELLS, P, {}, None, {}) for P in (1e154, 1e160)},
    **{f"rough, {seed}": (rough(200, seed, 2.01), 0.05, {}, None, {"residual": 2e-14})
       for seed in range(3)},
    **{f"narrow panels beside wide ones, {P}":
       (rounded_ends(1000), P, {}, None, {"residual": 2e-12}) for P in (0.003, 0.01)},
    **{f"a moment between two waves, {lever}": (BOWL, 1e-3, {"moment": 1e-3 * lever}, 2, {})
       for lever in (-0.1, 0.0, 0.2)},
    "a patch missing beyond a corner": (crowded(), 6.16, {}, None, {}),
    "more flats, periodic": (sie.Periodic(THIRTEEN, 26.0), 0.05, {}, 13, {}),
}  # fmt: skip


@pytest.mark.slow(but=31)
@pytest.mark.parametrize("name", HARD)
def test_a_contact_that_once_failed_is_certified(name):
    profile, load, given, patches, bounds = HARD[name]
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=load, **given))
    certificate = solution.check()
    assert certificate.ok and certificate.tension == ()
    assert patches is None or len(solution.patches) == patches
    for what, most in bounds.items():
        assert getattr(certificate, what) < most


@pytest.mark.parametrize("load", [3.0, 8.4])
def test_no_patch_covers_a_concave_corner(load):
    """There the pressure of a closed contact is -inf, between the nodes of a polynomial."""
    row = rounded_flats(
        (0.44, 0.63, 1.2, 0.002), (0.23, 4.1, 2.53, 0.008), (0.25, 1.18, 4.26, 0.019)
    )
    solution = sie.solve(sie.Scene(profile=row, modulus=1.0, normal_load=load))
    lo, hi = solution.edges
    jumps = ((x, row.slope(x + np.array([-1e-9, 1e-9]))) for x in row.breaks)
    corners = [x for x, (below, above) in jumps if lo < x < hi and above < below - 1e-3]
    assert corners
    for corner in corners:
        assert not any(a < corner < b for a, b in solution.patches)
        near = corner + np.geomspace(1e-6, 1e-2, 9)[:, None] * np.array([-1.0, 1.0])
        assert solution.pressure(near).min() >= 0.0
    assert solution.check().ok


@pytest.mark.parametrize("gap", [1e-9, 1e-10, 5e-11, 2e-11, 1e-11, 1e-12, 1e-13])
@pytest.mark.parametrize("middle", [0.0, 5.0])
def test_a_concave_corner_that_nearly_closes_is_open_or_closed_without_tension(gap, middle):
    inner, outer, shape = 0.5 * gap, 0.5 * gap + 1.0, {"radius": 1.0, "modulus": 1.0}
    d = float(two_parabolas.distance(inner=inner, outer=outer))
    load = float(two_parabolas.load(inner=inner, outer=outer, **shape))
    row = parabolas(*((1.0, middle + s * d, 0.0) for s in (-1.0, 1.0)))
    solution = sie.solve(sie.Scene(profile=row, modulus=1.0, normal_load=load))
    assert solution.check().ok
    assert len(solution.patches) == 2 or gap < 1e-10
    assert solution.patches[-1][1] == pytest.approx(middle + outer, abs=1e-9)


@pytest.mark.parametrize("load", [1e-4, 1e-6])
def test_a_flat_pressed_lightly_keeps_within_its_concave_corners(load):
    """Its edges are close to the kinks at the ends of its base, beside which h' is small."""
    row = rounded_flats(
        (0.13, 0.86, 1.32, 0.02), (0.45, 0.21, 2.76, 0.012), (0.38, 0.26, 4.4, 0.015)
    )
    solution = sie.solve(sie.Scene(profile=row, modulus=1.0, normal_load=load))
    assert solution.check().ok
    assert solution.patches[0] == pytest.approx((2.31, 3.21), abs=0.01)


@pytest.mark.parametrize("load", [1e-5, 1e-3, 0.1])
@pytest.mark.parametrize("distance", [5.7, 6.5])
def test_walls_that_the_contact_is_far_from_change_nothing(distance, load):
    """The first indenter ends at x = 3, outside of the window about the contact."""
    gentle = sie.Piecewise((-3.0, 3.0), [(0.0, 0.5, 0.0, 0.02)]).raised(2.0)
    lowest = sie.Piecewise((-3.0, 3.0), [(0.0, 1.0, 0.0, 0.2)]).shifted(distance)
    whole, alone = (
        sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=load))
        for profile in (sie.Row([gentle, lowest]), lowest)
    )
    assert whole.edges == pytest.approx(alone.edges, rel=1e-12)


@pytest.mark.parametrize(("distance", "load"), [(3.0, 0.1), (3.0, 1.0), (1.0, 1.0)])
def test_a_flat_in_a_bowl_is_at_its_own_height(distance, load):
    """h jumps at both ends of the flat, without room for a gap between the indenters."""
    flat = sie.Flat(0.3).shifted(distance)
    part = sie.Piecewise((-1.5, distance - 0.4), [(0.0, 1.0)])
    whole, apart = (
        sie.solve(sie.Scene(profile=sie.Row([bowl, flat]), modulus=1.0, normal_load=load))
        for bowl in (sie.Parabola(1.0), part)
    )
    assert np.array(whole.patches) == pytest.approx(np.array(apart.patches), rel=1e-10)
    assert whole.check().ok


@pytest.mark.parametrize("moment", [{}, {"moment": 0.3}])
def test_a_load_under_which_no_search_settles_is_refused_by_its_name(moment, monkeypatch):
    calls = []

    def astray(*_):
        calls.append(1)
        raise sie.LoadError("stopped")

    monkeypatch.setattr("sie.patches.solver.settled", astray)
    row = parabolas((1.0, 0.0, 0.0), (0.5, 2.0, 0.1))
    scene = sie.Scene(profile=row, modulus=2.0, normal_load=0.6, **moment)
    with pytest.raises(sie.LoadError, match=r"normal_load = 0\.6: .* change the load") as error:
        _ = sie.solve(scene).patches
    assert ("or the moment" in str(error.value)) == bool(moment)
    assert len(calls) <= 3
