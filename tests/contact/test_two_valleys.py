"""Profiles that touch in a second valley, which is far from the first one or narrow beside it."""

import numpy as np
import pytest

import sie

PROFILES = {
    "waves on a bounded indenter": sie.FromFunction("x - 1.5*sin(2*x)", domain=(-3.0, 3.0)),
    "waves without ends": sie.FromFunction("x - 1.5*sin(2*x)"),
}


@pytest.mark.parametrize("load", [1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_two_equal_valleys_carry_half_of_a_light_load_each(profile, load):
    contact = sie.solve(sie.Scene(profile=profile, normal_load=load, modulus=2.0))
    np.testing.assert_allclose(contact.patch_loads, [load / 2, load / 2], rtol=1e-6)


def test_a_valley_higher_than_a_light_load_presses_stays_open():
    profile = sie.FromFunction("x - 1.5*sin(2*x) + 1e-3", domain=(-3.0, 3.0))
    contact = sie.solve(sie.Scene(profile=profile, normal_load=1e-6, modulus=2.0))
    assert len(contact.patches) == 1
