"""Two patches, rows of patches and rows of cracks: edges, potentials, openings, limits."""

import math

import numpy as np
import pytest
from closed_forms import EPS, call, coarse, mp, resultant

from analytic import cracks, flat_row, parabola_row, two_flats, two_parabolas, wavy

FLATS = {"inner": 1.0, "outer": 2.0, "normal_load": 3.0}
PARABOLAS = {"inner": 1.0, "outer": 2.0, "radius": 2.0, "modulus": 3.0}
WAVE = {"half_width": 0.6, "wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0}
CRESTS = {"half_width": 0.6, "radius": 3.0, "period": 2.0, "modulus": 5.0}
ROW = {"half_width": 0.6, "period": 2.0, "mean_pressure": 5.0}


def test_two_flats_keep_their_difference_of_height() -> None:
    """The integral between the flats of the potential less the tilt, whose sign is that of -M."""
    given = {**FLATS, "moment": -2.0}
    tilt = two_flats.tilt(**given, modulus=2, lib=mp)
    between = resultant(lambda t: two_flats.potential(t, **given, lib=mp).real - tilt, (-1, 1))
    assert abs(between) < 1e-22 < tilt


def test_the_opening_of_two_cracks_closes_at_both_tips() -> None:
    """Its slope is sigma (x² - C)/sqrt(...), ∫ over a crack = 0; at the tips it is singular."""
    a, b = mp.mpf("0.7"), mp.mpf(2)
    weight = lambda t: 1 / mp.sqrt((t * t - a * a) * (b * b - t * t))  # noqa: E731
    safe = lambda t: weight(t) if a < t < b else mp.inf  # noqa: E731
    C = resultant(safe, (a, b), lambda t: t * t) / resultant(safe, (a, b))
    at_a, at_b = cracks.pair(inner=a, outer=b, tension=3, lib=mp)
    assert abs(at_a / (3 * mp.sqrt(mp.pi) * (C - a * a) / mp.sqrt(a * (b * b - a * a))) - 1) < 1e-22
    assert abs(at_b / (3 * mp.sqrt(mp.pi) * (b * b - C) / mp.sqrt(b * (b * b - a * a))) - 1) < 1e-22


@pytest.mark.parametrize("load", [1e-20, 1e-3, 1.0, 30.0, 1e4])
def test_edges_of_two_parabolas_invert_load_and_distance(load: float) -> None:
    c1, c2 = two_parabolas.edges(
        normal_load=load, distance=1.0, radius=2.0, modulus=3.0, lib=coarse
    )
    assert (
        abs(two_parabolas.load(inner=c1, outer=c2, radius=2, modulus=3, lib=coarse) / load - 1)
        < 1e-18
    )
    assert abs(two_parabolas.distance(inner=c1, outer=c2, lib=coarse) - 1) < 1e-28
    near, far = two_parabolas.edges(normal_load=load, distance=1.0, radius=2.0, modulus=3.0)
    conditioning = 4 * math.log(c2 / c1) + 4  # how ln c1 answers to ln P
    assert abs(near / c1 - 1) < conditioning * EPS and abs(far / c2 - 1) < 8 * EPS


@pytest.mark.parametrize("a", [1e-9, 0.3, 0.999999])
def test_half_widths_of_wave_and_row_invert_the_mean_pressure(a: float) -> None:
    crests = {"radius": 3.0, "period": 2.0, "modulus": 5.0}
    exact = parabola_row.mean_pressure(half_width=mp.mpf(a), **crests, lib=mp)
    assert abs(parabola_row.half_width(mean_pressure=exact, **crests, lib=mp) / a - 1) < 1e-25
    shape = {"wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0}
    assert wavy.half_width(
        mean_pressure=wavy.mean_pressure(half_width=a, **shape), **shape
    ) == pytest.approx(a, rel=1e-9)
    exact = wavy.mean_pressure(half_width=mp.mpf(a), **shape, lib=mp)
    assert abs(wavy.half_width(mean_pressure=exact, **shape, lib=mp) - a) < 1e-28


@pytest.mark.parametrize("side", [+1, -1])
def test_potentials_tend_to_their_side_of_the_contact_and_have_the_slope_there(side: int) -> None:
    step = mp.mpc(0, side * mp.mpf("1e-40"))
    for function, given, x in (
        (two_flats.potential, {**FLATS, "moment": -2.0}, 1.3),
        (wavy.potential, WAVE, 6.2),
        (flat_row.potential, ROW, -4.3),
    ):
        beside = function(mp.mpf(x) + step, **given, lib=mp)
        assert abs(function(x, **given, side=side, lib=mp) - beside) < 1e-35
    slope = wavy.slope(6.2, wavelength=2.0, amplitude=0.3)
    assert wavy.potential(6.2, **WAVE, side=side).real == pytest.approx(2.5 * slope, rel=1e-13)


@pytest.mark.parametrize("height", [3.0, 90.0, 1e9])
def test_far_from_the_surface_the_potential_of_a_row_is_its_mean_pressure(height: float) -> None:
    mean = wavy.mean_pressure(**WAVE)
    assert wavy.potential(0.3 + 1j * height, **WAVE) == pytest.approx(
        -1j * mean, rel=10 * math.exp(-min(height, 30) * math.pi) + 4 * EPS
    )
    assert flat_row.potential(0.3 - 1j * height, **ROW) == pytest.approx(
        5j, rel=10 * math.exp(-min(height, 30) * math.pi) + 4 * EPS
    )


def test_partial_and_complete_contact_of_the_wave_meet() -> None:
    x, shape = np.linspace(-3, 3, 31), {"wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0}
    whole = wavy.complete_pressure(x, mean_pressure=wavy.closing_pressure(**shape), **shape)
    np.testing.assert_allclose(
        wavy.pressure(x, half_width=1.0, **shape), whole, rtol=1e-13, atol=1e-13
    )


def test_cracks_far_from_others_and_with_thin_bridges() -> None:
    assert cracks.pair(inner=1e9, outer=1e9 + 2, tension=3.0) == pytest.approx(
        (3 * math.sqrt(math.pi),) * 2, rel=1e-8
    )
    merged = cracks.pair(inner=1e-300, outer=1.0, tension=3.0)[1]  # D/K -> 1 - 1/ln(4b/a)
    assert merged == pytest.approx(3 * math.sqrt(math.pi) * (1 - 1 / math.log(4e300)), rel=8 * EPS)
    assert cracks.row(half_length=1e-9, period=1.0, tension=3.0) == pytest.approx(
        3 * math.sqrt(math.pi * 1e-9), rel=8 * EPS
    )


SHAPE = {"wavelength": 2.0, "amplitude": 0.3, "modulus": 5.0}


def test_pressure_is_zero_beside_the_patches_and_infinite_at_sharp_corners_only() -> None:
    x = np.array([-2.0, -1.0, 0.0, 1.0, 2.0, 2.5])
    assert two_flats.pressure(x, **FLATS).tolist() == [math.inf, math.inf, 0, math.inf, math.inf, 0]
    assert two_parabolas.pressure(x, **PARABOLAS).tolist() == [0] * 6
    assert flat_row.pressure(np.array([0.6, 1.0, 2.0 - 0.6]), **ROW).tolist()[1] == 0
    assert wavy.pressure(np.array([0.6, 1.0]), **WAVE).tolist() == [0, 0]


TURNED = {"inner": 2.0, "outer": 1.0}
WIDE = {"half_width": 1.5}
REFUSED = [
    (two_flats.pressure, {"x": 0.0, **FLATS, "moment": 9.0}, r"exceeds largest_moment = .*lifts"),
    (two_flats.largest_moment, {**TURNED, "normal_load": 1.0}, "outer = 1.0 is not more than"),
    (two_parabolas.distance, TURNED, "outer = 1.0 is not more than inner = 2.0"),
    (cracks.pair, {**TURNED, "tension": 1.0}, "outer = 1.0 is not more than inner = 2.0"),
    (wavy.half_width, {"mean_pressure": 100.0, **SHAPE}, "touch everywhere"),
    (wavy.complete_pressure, {"x": 0.0, "mean_pressure": 0.1, **SHAPE}, "troughs are open"),
    (wavy.mean_pressure, {**WAVE, **WIDE}, "half_width = 1.5 exceeds wavelength/2 = 1.0"),
    (flat_row.pressure, {"x": 0.0, **ROW, **WIDE}, "half_width = 1.5 is not less than period/2"),
    (parabola_row.pressure, {"x": 0.0, **CRESTS, **WIDE}, "1.5 is not less than period/2"),
    (cracks.row, {"half_length": 1.5, "period": 2.0, "tension": 1.0}, "not less than period/2"),
    (two_parabolas.edges, {"normal_load": 1e9, "distance": 1.0, "radius": 1.0, "modulus": 1.0},
     "give a smaller load"),
]  # fmt: skip


@pytest.mark.parametrize("lib", [np, mp])
def test_invalid_arguments_are_refused(lib) -> None:
    for function, given, words in REFUSED:
        with pytest.raises(ValueError, match=words):
            call(function, given, lib=lib)
