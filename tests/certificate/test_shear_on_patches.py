"""The certificate of a shear on several patches, and wrong shears that fail it."""

from functools import cache

import numpy as np
import pytest

import sie
from sie.certificate.shear_check import shear_certificate

TWO = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
ROUNDED = sie.Row([sie.RoundedFlat(0.4, 1.0).shifted(-1.2), sie.RoundedFlat(0.25, 2.0).shifted(1)])
WAVES = sie.Periodic(sie.FromFunction("sin(x) + sin(3*x + 0.5)"), 2.0 * np.pi)
FULL = sie.Periodic(sie.FromFunction("0.01*sin(x)"), 2.0 * np.pi)
F = 0.5
each = pytest.mark.parametrize(
    "profile", [TWO, ROUNDED, WAVES, FULL], ids=["row", "flats", "period", "full"]
)


@cache
def pressed(profile):
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=0.6, friction=F))


def sheared(profile, part, **asked):
    return pressed(profile).with_(tangential_load=0.3 * part, **asked)


def measured(solution, shear=None, Q=None, tau=0.0):
    """The certificate of a shear in place of that of a solution, under other loads."""
    state = solution.tangential
    if shear is not None:
        state.__dict__["shear"] = shear
    loads = solution.tangential_load if Q is None else Q, tau
    pressures = [c.certificate(1e-13) for c in (solution.in_patches, *state.contacts)]
    slope = solution.scene.profile.pieces
    return shear_certificate(
        state, solution.pressure, loads, slope, tol=1e-13, of_pressures=pressures
    )


def test_pressures_whose_edges_are_rounded_apart_are_no_excess_of_friction():
    """The shear on one patch, of a profile that may touch in two, is made of another pressure."""
    profile = sie.Polynomial((0.0, 0.011940933832244222, -0.25, 0.0, 0.25))
    P, Q = 0.22353196588895907, -0.013625963439846001
    scene = sie.Scene(profile=profile, modulus=1.0, normal_load=P, friction=0.3)
    solution = sie.follow(scene, sie.Path([(P, Q, 0.0)]))[0]
    assert solution.check().ok
    more = sie.superposed((1.0 + 1e-9, solution.tangential.shear))
    assert measured(solution, more).excess > 1e-11


@pytest.mark.slow(but=5)
@each
@pytest.mark.parametrize("part", [-0.4, 0.99])
def test_a_shear_is_certified_to_rounding(profile, part):
    certificate = sheared(profile, part).check()
    shear = certificate.shear
    assert certificate.ok and shear.ok
    assert max(shear.residual, shear.equilibrium, shear.excess) < 1e-13
    assert "shear equation (12) in stick" in str(certificate)
    assert certificate.as_dict()["shear"]["ok"]


@each
def test_a_small_shear_is_certified_to_what_it_is_a_difference_of(profile):
    shear = sheared(profile, 1e-6).check().shear
    assert shear.ok and shear.residual < 1e-9 and shear.equilibrium < 1e-8


@pytest.mark.slow(but=5)
@each
@pytest.mark.parametrize("part", [1e-6, 0.4])
def test_a_shear_with_another_load_fails(profile, part):
    solution = sheared(profile, part)
    assert not measured(solution, Q=solution.tangential_load * (1.0 + 1e-6)).ok


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("profile", [TWO, WAVES], ids=["row", "period"])
@pytest.mark.parametrize("part", [1e-6, 0.4])
def test_a_shear_in_stick_zones_at_another_place_fails(profile, part):
    solution = sheared(profile, part)
    factor, ((other, _),) = solution.tangential.parts
    moved = sheared(profile.shifted(1e-4 * part), part).tangential.corrective
    certificate = measured(solution, sie.superposed((factor, solution.pressure), (other, moved)))
    assert not certificate.ok
    assert certificate.residual > 1e-8


def test_a_shear_of_another_strain_fails():
    assert not measured(sheared(TWO, 0.4), tau=1e-9).ok


def test_a_shear_beyond_friction_fails():
    solution = sheared(TWO, 0.4)
    assert measured(solution, sie.scaled(1.5 * F, solution.pressure), Q=0.45).excess > 0.1


def test_slip_against_the_shear_fails():
    solution = sheared(WAVES, 0.4)
    forward = solution.tangential.slip
    vars(solution.tangential)["slip"] = lambda x: -forward(x)
    assert measured(solution).opposing == -1.0


def test_the_shear_under_a_bulk_stress_and_on_a_path_is_measured():
    stretched = sheared(TWO, 0.4, bulk_stress=0.02)
    path = sie.follow(sheared(WAVES, 0.4).scene, sie.Path([(0.6, 0.2), (0.6, -0.1), (0.5, 0.05)]))
    for certificate in (stretched.check(), path[1].check(), path[2].check()):
        assert certificate.ok and certificate.shear.residual < 1e-12
