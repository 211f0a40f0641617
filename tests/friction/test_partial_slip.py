"""Cattaneo and Mindlin for any profile, against closed forms in many digits."""

import math

import numpy as np
import pytest
from slip_cases import E, F, P, left_over, mp, rounded_load, sheared

import sie
from analytic import cattaneo_rounded, rounded_flat

FRACTIONS = (1e-14, 1e-9, 1e-4, 0.009, 0.011, 0.6, 1.0 - 1e-6, 1.0 - 1e-14)


def closed(a, solution):
    """What `analytic` is asked for the contact, in 70 digits."""
    scene = solution.scene
    Q, load = mp.mpf(scene.tangential_load), mp.mpf(scene.normal_load)
    given = {"half_flat": mp.mpf(a), "radius": mp.one, "modulus": mp.mpf(E), "lib": mp}
    return {**given, "normal_load": load, "friction": mp.mpf(F), "tangential_load": Q}


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("fraction", FRACTIONS)
@pytest.mark.parametrize("a", [0.0, 0.5, 1.0 - 1e-9], ids=["hertz", "0.5", "1-1e-9"])
def test_the_rounded_punch_and_hertz_in_partial_slip(a, fraction):
    """Ciavarella, Hills & Monno (1998), eq. (20): but for rounding of the edges of a thin zone."""
    profile = sie.RoundedFlat(a, 1.0) if a else sie.Parabola(1.0)
    load = float(rounded_load(mp.mpf(a), mp.mpf(1)))
    solution = sheared(profile, fraction, load)
    exact = closed(a, solution)
    rim, slipped = (f(**exact) for f in (cattaneo_rounded.stick_rim, cattaneo_rounded.slip_width))
    state = solution.tangential
    inner = state.corrective.contact
    assert abs(solution.stick[0][1] / (a + rim) - 1) < 3e-16
    assert solution.stick[0][0] == -solution.stick[0][1]
    assert abs((inner.x2 - mp.mpf(a) + inner.tail2) / rim - 1) < 1e-13
    rounded = 4.0 * math.ulp(1.0) / fraction
    assert abs(state.lengths[1] / slipped - 1) < 2e-13 + rounded
    lost = cattaneo_rounded.dissipation(**exact) / 4  # of a cycle, four times that of its loading
    assert abs(solution.energy_lost / lost - 1) < 1e-12 + 3.0 * rounded
    assert abs(solution.shear.resultant - solution.scene.tangential_load) < 1e-15 * F * load
    shape = {name: exact[name] for name in ("half_flat", "radius", "modulus", "lib")}
    peak = F * rounded_flat.pressure(0.0, rim=rim + slipped, **shape)
    c = a + rim
    for x in (0.0, 0.5 * float(c), 0.99 * float(c)):
        assert abs(float(solution.shear(x)) - cattaneo_rounded.shear(x, **exact)) < 1e-13 * peak
    x = math.nextafter(solution.edges[1], 0.0)
    if slipped > 1e-6 * (rim + slipped) and x > c:  # of the effect of one ulp of x
        slip = cattaneo_rounded.slip(x, **exact)
        assert abs(float(solution.slip(x)) / slip - 1) < 1e-12 + 4 * math.ulp(x) / slipped


def test_the_shear_next_to_the_stick_zone_of_a_thin_slip_zone():
    """There q falls from f p like the square root of the distance."""
    solution = sheared(sie.Parabola(1.0), 1e-3)
    b, c = (mp.sqrt(4 * load / (mp.pi * E)) for load in (mp.mpf(P), left_over(solution)))
    for t in (1e-1, 1e-3, 1e-6, 1e-9):
        x = float(c) * (1.0 - 1e-3 * t)
        q = E * F / 2 * (mp.sqrt(b * b - mp.mpf(x) ** 2) - mp.sqrt(c * c - mp.mpf(x) ** 2))
        # The last term is the effect of an ulp of c.
        assert abs(float(solution.shear(x)) / q - 1) < 1e-12 + 2 * math.ulp(x) / mp.sqrt(
            (c - x) * (b - c)
        )


@pytest.mark.parametrize(
    "profile",
    [sie.Polynomial((0.0, 0.0, 0.06, 0.02, 0.02)), sie.Power(6.5, 0.6), sie.Power(2.5, 0.6)],
    ids=repr,
)
@pytest.mark.parametrize("tilt", [-0.08, 0.03, 0.5])
def test_next_to_sliding_the_stick_zone_of_a_tilted_profile_is_where_it_touched_first(
    profile, tilt
):
    """A parabola there, P - |Q|/f = π E*/4 h'' c², but for terms of the order of c."""
    solution = sheared(profile, 1.0 - 1e-13, tilt=tilt)
    ((lo, hi),) = solution.stick
    z, step = 0.5 * (lo + hi), 1e-5
    curvature = float(np.diff(profile.slope([z - step, z + step]))[0]) / (2.0 * step)
    c = 0.5 * (hi - lo)
    assert abs(float(profile.slope(z)) + tilt) < 2e-6 * curvature * c
    assert c == pytest.approx(
        math.sqrt(4.0 * float(left_over(solution)) / (math.pi * E * curvature)), rel=1e-6
    )


@pytest.mark.parametrize(
    "profile",
    [sie.Parabola(1.0), sie.RoundedFlat(0.7, 1.0), sie.Wedge(0.3), sie.Flat(1.0)],
    ids=repr,
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_full_sliding_is_f_times_the_pressure_without_a_second_solve(profile, sign, monkeypatch):
    solution = sheared(profile, sign)
    _ = solution.normal

    def refused(*_args, **_options):
        pytest.fail("a second contact was solved")

    monkeypatch.setattr(sie.answers.sheared, "normal_contact", refused)
    x = np.linspace(-0.9, 0.9, 7) * solution.half_width
    assert (solution.shear(x) == sign * F * solution.pressure(x)).all()
    assert solution.stick == ()
    assert solution.check().ok


def test_sliding_is_where_the_rounded_product_is():
    """0.3 × 500 is 150 in doubles, and a little less in exact arithmetic."""
    solution = sie.solve(sie.Scene(
        profile=sie.Parabola(1.0), modulus=E, normal_load=500.0, friction=0.3,
        tangential_load=150.0,
    ))  # fmt: skip
    assert solution.stick == ()


def test_slip_at_incipient_sliding_is_f_times_the_height_of_the_profile():
    """The corrective contact has shrunk to the flat base: its gap is h."""
    solution = sheared(sie.RoundedFlat(0.7, 1.0), 1.0)
    x = np.array([-0.99, -0.8, 0.3, 0.75, 0.9]) * solution.half_width
    assert solution.slip(x) == pytest.approx(
        F * 0.5 * np.maximum(np.abs(x) - 0.7, 0.0) ** 2, rel=1e-12, abs=0.0
    )


@pytest.mark.parametrize(
    "profile", [sie.Parabola(1.0), sie.RoundedFlat(0.4, 1.0).tilted(0.02), sie.Wedge(0.3)], ids=repr
)
@pytest.mark.parametrize(("strain", "left"), [(0.1, 1e-12), (-3.0, 1e-3)])
def test_full_sliding_under_a_bulk_stress_is_the_limit_of_what_slipped_before(
    profile, strain, left
):
    """Where the strain pulls the lowest point out of the contact, an edge slips last."""
    if strain < -1.0 and isinstance(profile, sie.Wedge):
        pytest.skip("slip in opposite directions is refused at a tip")
    whole, almost = (
        sheared(profile, fraction, bulk_stress=strain * P) for fraction in (1.0, 1.0 - left)
    )
    x = np.linspace(*whole.edges, 7)
    far = max(10.0 * left, 1e-5)
    assert whole.slip(x) == pytest.approx(
        almost.slip(x), rel=far, abs=far * np.abs(whole.slip(x)).max()
    )
    assert whole.energy_lost == pytest.approx(almost.energy_lost, rel=far)
    assert whole.shift == pytest.approx(almost.shift, rel=far)
    assert whole.check().ok


def test_a_sharp_flat_punch_sticks_as_a_whole_until_it_slides():
    """q = Q/(fP) f p: Bryant & Keer; no slip, nothing lost."""
    solution = sheared(sie.Flat(1.0), 0.75)
    x = np.linspace(-0.999, 0.999, 11)
    assert solution.stick == (solution.edges,) == ((-1.0, 1.0),)
    assert solution.shear(x) == pytest.approx(
        0.75 * F * P / (np.pi * np.sqrt(1.0 - x * x)), rel=1e-13
    )
    assert (solution.shear(np.array([-1.0, 1.0])) == np.inf).all()
    assert solution.energy_lost == 0.0


def test_under_the_tip_of_a_wedge_the_shear_is_finite():
    """p and p̂ have the same logarithm there: q -> f E* s/π ln(b/c)."""
    solution = sheared(sie.Wedge(0.25), 0.5)
    assert float(solution.shear(0.0)) == pytest.approx(
        F * E * 0.25 / np.pi * np.log(2.0), rel=1e-12
    )


def test_a_load_beyond_friction_is_refused_with_the_numbers():
    scene = {"profile": sie.Parabola(1.0), "modulus": 1.0, "friction": 0.6}
    with pytest.raises(
        sie.LoadError, match=r"\|Q\| = 620\.0 exceeds f P = 600\.0: the bodies slide"
    ) as caught:
        sie.solve(sie.Scene(normal_load=1000.0, tangential_load=620.0, **scene))
    assert caught.value.reached["limit"] == 600.0
    lazy = sie.solve(sie.Scene(half_width=1.0, tangential_load=-1.0, **scene))  # P is not known yet
    with pytest.raises(sie.LoadError, match=r"\|Q\| = 1\.0 exceeds f P = 0\.47"):
        _ = lazy.stick


def test_under_a_load_below_the_rounding_of_friction_all_sticks():
    solution = sheared(sie.Parabola(1.0), 1e-100)
    assert solution.stick == (solution.edges,) and solution.energy_lost == 0.0
    assert solution.check().ok


def test_without_a_tangential_load_everything_sticks():
    solution = sheared(sie.Parabola(1.0), 0.0)
    assert solution.stick == (solution.edges,)
    assert solution.shear is sie.ZERO
    assert "tangential" not in vars(solution)
    frictionless = sie.solve(sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0))
    assert frictionless.stick == ()
    assert frictionless.energy_lost == frictionless.shift == 0.0


@pytest.mark.parametrize("fraction", [0.0, 0.4, 1.0])
def test_the_economies_of_shear_leave_the_answer_as_it_is(fraction):
    thrifty = sheared(sie.RoundedFlat(0.7, 1.0), fraction)
    wasteful = sie.solve(thrifty.scene, economy=())
    assert ("tangential" in vars(wasteful)) is False
    x = np.linspace(-0.99, 0.99, 23) * thrifty.half_width
    scale = F * P / thrifty.half_width
    assert wasteful.shear(x) == pytest.approx(thrifty.shear(x), abs=1e-13 * scale)
    assert wasteful.slip(x) == pytest.approx(thrifty.slip(x), abs=1e-13)
    assert wasteful.energy_lost == pytest.approx(thrifty.energy_lost, rel=1e-12, abs=1e-15)
    assert wasteful.shear.resultant == pytest.approx(fraction * F * P, abs=1e-14)
