"""Edges, zones and γ of dissimilar bodies meet conditions in which neither p nor q occurs."""

import numpy as np
import pytest

import sie
from oracles.bonded_edge import missed
from sie.friction.coupled.tangential import TangentialSearch

PROFILES = {
    "parabola": sie.Parabola(1.0),
    "quartic": sie.Power(4.0, 0.4),
    "rounded flat": sie.RoundedFlat(0.5, 1.0),
}


def search(profile: sie.Profile, beta: float, friction: float) -> TangentialSearch:
    scene = sie.Scene(
        profile=profile,
        modulus=2.0,
        dundurs=beta,
        friction=friction,
        normal_load=1.0,
        tangential_load=0.5 * friction,
    )
    return sie.solve(scene).tangential_search


def missed_under_P(
    found: TangentialSearch, stick: float = 1.0, load: float = 1.0, gradient: float = 1.0
) -> float:
    """What is missed with c, P and γ changed by factors."""
    state = found.normal
    marks = tuple(sign * y for y in (0.0, *state.marks) for sign in (-1.0, 1.0))
    misses = missed(
        (found.beta, found.friction),
        (-state.b, stick * state.c, state.b),
        (load * state.load, 0.0),
        (found.H, lambda x: gradient * found.gamma(x)),
        marks,
    )
    return float(np.abs(misses).max())


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.5, 0.5), (0.2, 0.6), (-0.4, 0.5)])
def test_zones_and_slip_gradient_under_P_meet_hypergeometric_conditions(
    name: str, beta: float, friction: float
) -> None:
    assert missed_under_P(search(PROFILES[name], beta, friction)) < 1e-10


@pytest.mark.parametrize(
    "wrong", [{"stick": 0.95}, {"load": 1.0 + 1e-6}, {"gradient": 1.0 + 1e-6}], ids=str
)
def test_hypergeometric_conditions_tell_wrong_input(wrong: dict[str, float]) -> None:
    assert missed_under_P(search(PROFILES["parabola"], 0.3, 0.3), **wrong) > 1e-8
