"""Profiles that touch in a second valley, which is far from the first one or narrow beside it."""

from contextlib import suppress

import numpy as np
import pytest
from scenes import solved

import sie

TURN = float(2.0 * np.pi)
PROFILES = {
    "waves on a bounded indenter": sie.FromFunction("x - 1.5*sin(2*x)", domain=(-3.0, 3.0)),
    "waves without ends": sie.FromFunction("x - 1.5*sin(2*x)"),
}


@pytest.mark.parametrize("load", [1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_two_equal_valleys_carry_half_of_a_light_load_each(profile, load):
    contact = solved(profile, modulus=2.0, normal_load=load)
    np.testing.assert_allclose(contact.patch_loads, [load / 2, load / 2], rtol=1e-6)


def test_a_valley_higher_than_a_light_load_presses_stays_open():
    profile = sie.FromFunction("x - 1.5*sin(2*x) + 1e-3", domain=(-3.0, 3.0))
    contact = solved(profile, modulus=2.0, normal_load=1e-6)
    assert len(contact.patches) == 1


EQUAL = {
    "a formula": (PROFILES["waves without ends"], 2),
    "a function": (sie.FromFunction(lambda x: x**3 - x, domain=(-2.0, 2.0)), 2),
    "a polynomial": (sie.Polynomial((0.0, 0.0, -0.5, 0.0, 0.25)), 2),
    "a row": (sie.Row([sie.Parabola(1.0).shifted(x) for x in (-2.0, 0.0, 2.0)]), 3),
    "a period": (sie.Periodic(sie.FromFunction("0.2*sin(3*x)", domain=(0.5, 0.5 + TURN)), TURN), 3),
}


@pytest.mark.slow(but=3)
@pytest.mark.parametrize("load", [1e-7, 1e-8, 1e-9])
@pytest.mark.parametrize(("profile", "valleys"), EQUAL.values(), ids=EQUAL)
def test_equal_valleys_all_touch_however_light_the_load(profile, valleys, load):
    contact = solved(profile, modulus=2.0, normal_load=load)
    assert len(contact.patches) == valleys
    assert contact.check().ok


@pytest.mark.parametrize(("profile", "valleys"), EQUAL.values(), ids=EQUAL)
def test_a_load_that_the_rounding_of_h_would_share_is_refused(profile, valleys):
    with pytest.raises(sie.LoadError, match=r"the rounding of h decides .*: raise the load"):
        _ = solved(profile, modulus=2.0, normal_load=1e-16).patches


@pytest.mark.parametrize("raised", [1e-10, 1e-12, 1e-16])
def test_flats_of_almost_equal_height_share_a_light_load_by_it(raised):
    """The heights of flats are exact, and so is their difference."""
    row = sie.Row([sie.Flat(0.3).shifted(-1.0), sie.Flat(0.3).shifted(1.0).raised(raised)])
    few, many = (
        len(solved(row, modulus=2.0, normal_load=part * raised).patches) for part in (0.1, 10.0)
    )
    assert (few, many) == (1, 2)


def test_the_certificate_says_how_well_a_light_load_is_shared():
    contact = solved(EQUAL["a formula"][0], modulus=2.0, normal_load=1e-8)
    assert any("loads of the patches" in note for note in contact.check().notes)


@pytest.mark.parametrize("width", [0.02, 0.002])
def test_a_narrow_valley_far_from_the_widest_is_where_a_light_load_acts(width):
    def slope(x):
        t = (x - 7.65) / width
        return x + 60.0 * t / width * np.exp(-t * t)

    profile = sie.FromFunction(slope, domain=(-10.0, 10.0))
    contact = solved(profile, modulus=2.0, normal_load=1e-6)
    assert contact.patches[0] == pytest.approx((7.65, 7.65), abs=width)


def test_a_valley_that_touches_more_lightly_than_the_rounding_of_its_neighbour_is_found():
    """The gap is looked at as far as the profile has valleys, not in half-widths of the contact."""
    deeper = sie.Polynomial((0.0, 1e-8, -0.5, 0.0, 0.25))
    light, heavier = (solved(deeper, modulus=2.0, normal_load=P) for P in (1e-9, 1e-7))
    assert (len(light.patches), len(heavier.patches)) == (1, 2)


def valley(place, width, depth):
    """A parabola with a valley of a width at half of its depth."""
    w = width / (2.0 * np.sqrt(np.log(2.0)))
    return lambda x: x + 2.0 * depth * (x - place) / w**2 * np.exp(-(((x - place) / w) ** 2))


@pytest.mark.parametrize("domain", [(-np.inf, np.inf), (-3.0, 3.0)])
@pytest.mark.parametrize("part", [0.01, 0.033])
def test_a_valley_as_wide_as_a_hundredth_of_its_distance_is_seen(domain, part):
    profile = sie.FromFunction(valley(1.5, 1.5 * part, 0.9), domain=domain)
    contact = solved(profile, normal_load=0.5)
    assert any(a < 1.5 < b for a, b in contact.patches)
    assert contact.check().ok


class Hidden:
    """A slope with a valley that does not show before it is told to: a search misses it."""

    def __init__(self, base, place, width, depth):
        self.base, self.place, self.depth = base, place, depth
        self.w, self.shows = width / (2.0 * np.sqrt(np.log(2.0))), False

    def height(self, x):
        return -self.depth * np.exp(-(((x - self.place) / self.w) ** 2))

    def __call__(self, x):
        bent = -2.0 * (x - self.place) / self.w**2 * self.height(x)
        return self.base(x) + (bent if self.shows else 0.0)


def test_the_certificate_of_one_patch_sees_a_valley_that_the_search_has_missed():
    slope = Hidden(lambda x: x, 1.5, 0.005, 0.9)
    found = solved(sie.FromFunction(slope), normal_load=0.5)
    assert len(found.patches) == 1
    slope.shows = True
    assert not found.check().ok
    assert found.check().lowest_gap < 0.0


@pytest.mark.parametrize(("place", "width"), [(0.5, 0.1), (-0.2, 0.05), (0.5, 0.01)])
def test_the_lowest_gap_of_two_patches_is_the_least_of_many_beside_them(place, width):
    """Over the largest of the same gap, as the certificate states it."""
    slope = Hidden(lambda x: x - 1.5 * np.sin(2.0 * x), place, width, 0.7)
    found = sie.solve(sie.Scene(profile=sie.FromFunction(slope), modulus=2.0, normal_load=0.1))
    (_, a), (b, _) = found.patches
    x = np.linspace(a, b, 5001)
    gaps = found.gap(x) + slope.height(x)
    slope.shows = True
    certificate = found.check()
    assert not certificate.ok
    assert certificate.lowest_gap == pytest.approx(gaps.min() / gaps.max(), rel=2e-3)
    ((lo, hi),) = certificate.overlap
    overlapping = x[gaps < -1e-12]
    assert (lo, hi) == pytest.approx((overlapping[0], overlapping[-1]), abs=0.1 * width)


def test_a_far_valley_that_carries_all_of_the_load_is_seen_by_its_length():
    """Closer places, where the slope falls, do not make the part on which it falls a long one."""
    profile = sie.FromFunction(valley(-16.8, 0.44, 180.4))
    solution = solved(profile, normal_load=0.9257)
    hinted = sie.FromFunction(valley(-16.8, 0.44, 180.4), breaks=(-16.8,))
    named = solved(hinted, normal_load=0.9257)
    assert solution.edges == pytest.approx(named.edges, abs=1e-10)
    assert solution.edges[1] < -16.7
    assert solution.check().ok


def test_a_bump_is_one_patch_on_a_bounded_indenter_and_never_certified_without_an_end():
    """The slope of a Gauss bump falls beyond x = 1: at some distance the surface touches again."""

    def pressed(domain):
        bump = sie.FromFunction(lambda x: x * np.exp(-x * x / 2.0), domain=domain)
        return solved(bump, normal_load=0.2)

    assert len(pressed((-8.0, 8.0)).patches) == 1
    assert pressed((-8.0, 8.0)).check().ok
    with suppress(sie.LoadError):  # by rounding it is found that no patches settle, or not
        assert not pressed((-np.inf, np.inf)).check().ok
