"""Tractive rolling against Carter's closed form, and by the laws of stick and slip."""

import math

import numpy as np
import pytest

import sie

PROFILES = [
    sie.RoundedFlat(1.0, 5.0),
    sie.Power(4.0, 0.1),
    sie.Polynomial((0.0, 0.02, 0.1, 0.02, 0.03)),
    sie.FromFunction("0.1*sinh(x)").shifted(0.3),
]


def scene(profile, Q, **more):
    given = {"modulus": 2.0, "normal_load": 0.3, "friction": 0.4, "tangential_load": Q, **more}
    return sie.Scene(profile=profile, **given)


@pytest.mark.parametrize("share", [-0.3, 0.05, 0.75, 0.99])
def test_a_cylinder_rolls_as_carter_says(share):
    Q, R = share * 0.12, 3.0
    found = sie.rolling(scene(sie.Parabola(R), Q))
    b = found.solution.half_width
    c = b * math.sqrt(1.0 - abs(share))
    assert found.stick == pytest.approx((b - 2.0 * c, b), abs=1e-14 * b)
    assert found.creep == pytest.approx(math.copysign(0.4 * (b - c) / R, Q), rel=1e-13)
    x = np.linspace(-0.99, 0.99, 32) * b
    stuck = np.sqrt(np.maximum(c**2 - (x - b + c) ** 2, 0.0))
    q = math.copysign(0.4, Q) * 2.0 * 0.3 / (math.pi * b**2) * (np.sqrt(b**2 - x**2) - stuck)
    assert found.shear(x) == pytest.approx(q, abs=1e-13)


@pytest.mark.parametrize("leading", ["right", "left"])
@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: type(p).__name__)
def test_what_sticks_has_one_creep_and_what_slips_has_f_p(profile, leading):
    found = sie.rolling(scene(profile, 0.05), leading)
    solution, (lo, hi) = found.solution, found.stick
    edge = solution.edges[leading == "right"]
    assert (hi if leading == "right" else lo) == pytest.approx(edge, abs=1e-13)
    assert found.shear.resultant == pytest.approx(0.05, rel=1e-13)
    x = lo + (hi - lo) * np.linspace(0.01, 0.99, 25)
    strains = 2.0 / 2.0 * found.shear.hilbert(x)
    assert np.abs(strains) == pytest.approx(found.creep, rel=1e-10)
    assert (np.abs(found.shear(x)) <= 0.4 * solution.pressure(x)).all()
    beyond = np.setdiff1d(np.linspace(*solution.edges, 51)[1:-1], x)
    beyond = beyond[(beyond < lo) | (beyond > hi)]
    assert found.shear(beyond) == pytest.approx(0.4 * solution.pressure(beyond), rel=1e-14)


def test_a_mirrored_wheel_rolls_the_other_way():
    profile = PROFILES[2]
    right, left = (
        sie.rolling(scene(profile, 0.05)),
        sie.rolling(scene(profile.mirrored(), 0.05), "left"),
    )
    assert left.creep == pytest.approx(right.creep, rel=1e-12)


@pytest.mark.parametrize(
    ("profile", "more", "error", "word"),
    [
        (sie.Parabola(1.0), {"Q": 0.0}, ValueError, "transmitted"),
        (sie.Parabola(1.0), {"leading": "top"}, ValueError, "'right' or 'left'"),
        (sie.Parabola(1.0), {"dundurs": 0.2}, sie.ContactError, "dundurs = 0"),
        (sie.Parabola(1.0), {"Q": 0.12}, sie.ContactError, "below f P"),
        (sie.Flat(1.0), {}, sie.ContactError, "round it"),
    ],
)
def test_what_does_not_roll_is_refused(profile, more, error, word):
    given = {"Q": 0.05, "leading": "right", **more}
    leading, Q = given.pop("leading"), given.pop("Q")
    with pytest.raises(error, match=word):
        sie.rolling(scene(profile, Q, **given), leading)
