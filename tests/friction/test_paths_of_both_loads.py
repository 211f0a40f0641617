"""Load paths along which P and Q change together."""

from dataclasses import replace

import numpy as np
import pytest
from path_cases import FP, HERTZ, PUNCH, E, F, P, at_constant_load

import sie


def test_proportional_loading_below_friction_does_not_slip():
    """dQ/dP = k < f from nothing: q = k p (Mindlin & Deresiewicz)."""
    history = sie.follow(PUNCH, sie.Path([(0.0, 0.0), (P, 0.6 * FP)]))
    x = np.linspace(-0.9, 0.9, 11)
    assert history[1].stick == (history[1].edges,)
    exact = 0.6 * F * history[1].pressure(x)
    assert history[1].shear(x) == pytest.approx(exact, rel=5e-12, abs=0.0)
    assert history[1].energy_lost == 0.0
    assert (history[1].slip(x) == 0.0).all()


def test_loading_above_friction_slips_like_a_smaller_normal_load():
    """dQ/dP > f: q = f (p - p̂), p̂ under P - Q/f, as if P had come first (Jäger 1998)."""
    together = sie.follow(HERTZ, sie.Path([(0.1, 0.0), (P, 0.75 * FP)]))[1]
    after = sie.solve(replace(HERTZ, tangential_load=0.75 * FP))
    x = 0.99 * np.linspace(*after.edges, 21)
    assert together.stick[0] == pytest.approx(after.stick[0], rel=1e-14)
    assert together.shear(x) == pytest.approx(after.shear(x), abs=1e-14)
    assert 0.0 < together.energy_lost < after.energy_lost


def test_a_locked_in_layer_survives_more_normal_load():
    """Q first at constant P, then P alone: nothing slips, q stays and the limit grows."""
    first, second = sie.follow(HERTZ, sie.Path([(0.2, 0.05), (0.3, 0.05)]))
    x = np.linspace(*second.edges, 21)
    assert second.stick == (second.edges,)
    assert second.shear(x) == pytest.approx(first.shear(x), abs=1e-14)
    assert second.energy_lost == first.energy_lost


def test_unloading_along_the_loading_path_removes_all_shear():
    there, back = list(
        sie.follow(HERTZ, sie.Path([(0.0, 0.0), (0.1, 0.03), (0.4, 0.05), (0.1, 0.03)]))
    )[1::2]
    x = 0.99 * np.linspace(*there.edges, 21)
    assert back.shear(x) == pytest.approx(there.shear(x), abs=1e-15)
    assert back.energy_lost == 0.0


def test_energy_while_the_normal_load_changes_tends_to_that_at_constant_load():
    almost = sie.follow(HERTZ, sie.Path([(P, 0.1 * FP), (P * (1.0 + 1e-9), 0.7 * FP)]))[1]
    constant = at_constant_load(HERTZ, 0.1, 0.7)[1]
    assert almost.energy_lost == pytest.approx(constant.energy_lost, rel=1e-7)


TRACE = np.linspace(-1.6, 1.6, 161)
KINDS = {
    "punch": sie.RoundedFlat(0.5, 1.0),
    "wedge": sie.Wedge(0.3),
    "power 2.5": sie.Power(2.5, 0.5),
    "tilted punch": sie.RoundedFlat(0.5, 1.0).tilted(0.02),
    "lopsided": sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6)),
    "two radii": sie.Piecewise([-0.5, 0.25], [(0.5, 1.0), (0.0,), (-0.75, 3.0)]),
    "function": sie.FromFunction("sinh(x) + x**2/8", domain=(-3.0, 3.0)),
    "trace": sie.Sampled(TRACE, TRACE**2 / 2 + TRACE**3 / 20),
}
TURNING = [(0.1, 0.02), (0.3, 0.1), (0.25, -0.05), (0.1, 0.02)]


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_energy_of_a_path_is_that_of_the_path_cut_into_parts(name):
    scene = sie.Scene(profile=KINDS[name], modulus=1.0, normal_load=0.3, friction=0.5)
    whole, parts = (
        sie.follow(scene, sie.Path(TURNING)),
        sie.follow(scene, sie.Path(TURNING).subdivided(2)),
    )
    for one, same in zip(whole, parts[::2], strict=True):
        assert one.energy_lost == pytest.approx(same.energy_lost, rel=1e-9)


JUMP = sie.Piecewise([-0.4, 0.0], [(0.1, 1.5), (0.0, 1.0), (0.0, 1.5)])
OVER_THE_JUMP = [(0.17463394504062985, -0.18860466064388023), (0.3, 0.3028715783482759),
                 (0.3, 0.35964), (0.11927161476021313, 0.1187)]  # fmt: skip


@pytest.mark.slow
def test_energy_while_an_edge_passes_a_jump_is_that_of_the_mirrored_path():
    """Beside the jump the half-width hardly grows: Newton's method has to settle there."""
    scene = sie.Scene(profile=JUMP, modulus=1.0, normal_load=0.3, friction=1.2)
    image = replace(scene, profile=JUMP.mirrored())
    here = sie.follow(scene, sie.Path(OVER_THE_JUMP))
    there = sie.follow(image, sie.Path([(P, -Q) for P, Q in OVER_THE_JUMP]))
    for one, other in zip(here[:3], there[:3], strict=True):
        assert one.energy_lost == pytest.approx(other.energy_lost, rel=1e-9)


def test_energy_of_loading_hertz_with_a_growing_normal_load():
    """W = f²/(π E*) (k/f - 1) ∫ [P ln(P/L) - P + L] dP, L(P) = P - (P - P0) k/f, dQ/dP = k > f."""
    P0, P1, k = 0.1, 0.2, 1.5 * F
    lost = sie.follow(HERTZ, sie.Path([(P0, 0.0), (P1, k * (P1 - P0))]))[1].energy_lost
    g, w = np.polynomial.legendre.leggauss(60)
    load = P0 + (P1 - P0) * 0.5 * (1.0 + g)
    level = load - (load - P0) * k / F
    rate = F * F / (np.pi * E) * (k / F - 1.0) * (load * np.log(load / level) - load + level)
    assert lost == pytest.approx(0.5 * (P1 - P0) * float(w @ rate), rel=1e-10)


def test_normal_load_alone_comes_before_anything():
    """What is applied after P alone went up and down finds a contact that was never sheared."""
    Q, sigma = 0.4 * FP, 0.1
    loads = [(P, Q, sigma), (P, -0.2 * Q, -0.2 * sigma)]
    later = sie.follow(HERTZ, sie.Path([(0.0, 0.0), (0.0, 0.0), (2.0 * P, 0.0), (P, 0.0), *loads]))
    at_once = sie.follow(HERTZ, sie.Path(loads))
    x = np.linspace(*at_once[0].edges, 21)
    for one, other in zip(later[4:], at_once, strict=True):
        assert one.stick == other.stick
        assert (one.energy_lost, one.shift) == (other.energy_lost, other.shift)
        assert (one.shear(x) == other.shear(x)).all() and (one.slip(x) == other.slip(x)).all()


def test_no_moment_on_a_symmetric_profile_is_no_tilt():
    path = sie.Path([(P, 0.05), (2 * P, 0.3), (P, 0.1)])
    balanced, upright = (
        sie.follow(replace(HERTZ, tilt=0.0, **more), path) for more in ({}, {"moment": 0.0})
    )
    for one, other in zip(balanced, upright, strict=True):
        assert one.stick == other.stick and one.energy_lost == other.energy_lost
