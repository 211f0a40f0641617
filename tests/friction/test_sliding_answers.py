"""What is said and kept of full sliding and of full stick."""

from dataclasses import replace

import numpy as np
import pytest
from sliding_cases import RIM, SIMILAR, bonded, inside, slid

import sie

PRESSED = sie.Scene(profile=RIM, **SIMILAR, normal_load=0.1)


def test_shear_is_friction_times_pressure_and_nothing_is_solved_for_it():
    solution = slid(RIM, 0.3, normal_load=0.1)
    x = inside(solution, 11)
    assert solution.shear(x) == pytest.approx(2.0 * solution.pressure(x), rel=1e-15)
    assert solution.tangential_load == 0.2
    assert set(vars(solution)) >= {"normal", "pressure"}


def test_a_tangential_load_of_f_times_p_is_full_sliding():
    rough = replace(PRESSED, dundurs=0.1, friction=0.3)
    given, said = (
        sie.solve(replace(rough, **s)) for s in ({"tangential_load": -0.03}, {"sliding": -1})
    )
    assert given.edges == said.edges


def test_a_change_of_direction_is_a_new_contact_and_a_change_of_nothing_is_not():
    solution = slid(RIM, 0.3, normal_load=0.1)
    edges = solution.edges
    assert "normal" in vars(solution.with_(tangential_load=0.2, sliding=0))
    assert solution.with_(sliding=-1).edges == pytest.approx((-edges[1], -edges[0]), rel=1e-13)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (replace(PRESSED, dundurs=0.2), "f = 0: no shear acts back"),
        (replace(PRESSED, dundurs=0.2, friction=0.5, sliding=1), "exponents 1/2 ±"),
        (replace(PRESSED, friction=0.5, sliding=1), "uncoupled"),
        (bonded(0.3), "one equation for p + iq"),
    ],
)
def test_the_plan_says_how_pressure_and_shear_are_coupled(scene, words):
    assert words in str(sie.plan(scene))


PAIR = {
    "body": sie.Elastic(young=115e3, poisson=0.32),
    "indenter": sie.Elastic(young=210e3, poisson=0.3),
}


@pytest.mark.parametrize("loads", [{"moment": 10.0}, {"tangential_load": 30.0, "moment": 10.0}])
def test_the_remedy_for_dissimilar_bodies_keeps_all_but_their_coupling(loads):
    """Followed, it is the contact of bodies with β = 0 whose E* is that of the scene."""
    scene = sie.Scene(profile=sie.Parabola(50.0), **PAIR, friction=0.4, normal_load=200.0, **loads)
    with pytest.raises(sie.ContactError, match="give dundurs = 0") as refusal:
        sie.solve(scene)
    assert f"{scene.beta:.4g}" in str(refusal.value)
    followed = sie.solve(replace(scene, dundurs=0))
    body, indenter = ((1.0 - e.poisson**2) / e.young for e in PAIR.values())
    assert followed.scene.Estar == pytest.approx(1.0 / (body + indenter), rel=1e-15)
    bodies = {"modulus": scene.Estar, "friction": 0.4}
    same = sie.solve(sie.Scene(profile=sie.Parabola(50.0), **bodies, normal_load=200.0, **loads))
    assert followed.energy_lost == pytest.approx(same.energy_lost, rel=1e-12)
    assert np.array(followed.stick) == pytest.approx(np.array(same.stick), rel=1e-12)
    assert followed.check().ok
    x = np.array([-0.9, 0.1, 1.3]) * followed.half_width
    assert followed.surface_stress(x).xx == pytest.approx(same.surface_stress(x).xx, abs=1e-9)


def test_bodies_that_differ_by_rounding_are_similar():
    body, other = sie.Elastic(210e3, 0.3), sie.Elastic(210e3 * (1.0 + 1e-15), 0.30000000000000004)
    loads = {"friction": 0.3, "normal_load": 200.0, "tangential_load": 30.0}
    one = sie.Scene(profile=sie.Parabola(50.0), body=body, indenter=other, **loads)
    assert one.beta == 0.0
    same = sie.solve(replace(one, indenter=body))
    assert sie.solve(one).energy_lost == pytest.approx(same.energy_lost, rel=1e-13)
    assert sie.solve(replace(one, indenter=sie.RIGID, body=sie.Elastic(210e3, 0.5))).stick


@pytest.mark.parametrize(
    ("beta", "similar"), [(9e-13, True), (-9e-13, True), (1.1e-12, False), (-1.1e-12, False)]
)
def test_beta_below_1e_minus_12_is_zero(beta, similar):
    assert (
        sie.Scene(profile=RIM, modulus=1.0, dundurs=beta, normal_load=1.0).beta == 0.0
    ) is similar
    # β = (1 - 2ν) / (2 - 2ν) on a rigid indenter
    nearly = sie.Elastic(1.0, 0.5 - 0.5 * abs(beta))
    scene = sie.Scene(profile=RIM, body=nearly, indenter=sie.RIGID, normal_load=1.0)
    assert (scene.beta == 0.0) is similar


def test_a_changed_beta_changes_a_bonded_punch():
    first = sie.solve(bonded(0.1))
    _ = first.pressure(0.5)
    assert first.with_(dundurs=0.3).pressure(0.5) == sie.solve(bonded(0.3)).pressure(0.5)
