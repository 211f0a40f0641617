"""The extremes of a path: zones that retreat, the least slip, large and small units."""

from dataclasses import replace

import numpy as np
import pytest
from path_cases import FP, HERTZ, E, F, P, at_constant_load

import sie
from oracles.kalker import Mesh
from sie.io.export import as_dict
from sie.io.report import summary
from sie.io.scene_file import SceneFile


def test_where_zones_retreat_the_path_matters_and_the_certificate_notes_it():
    """In one step the mesh finds the state given; in proportion, in many, another one."""
    Q, sigma = 0.6 * FP, 0.5
    solution = sie.solve(replace(HERTZ, tangential_load=Q, bulk_stress=sigma))
    assert not solution.tangential.advancing
    assert "retreat" in str(solution.check())
    mesh = Mesh(solution.edges, 200, E)
    bound = F * solution.pressure(mesh.x)
    errors = []
    for steps in (1, 30):
        q = np.zeros(200)
        for k in range(1, steps + 1):
            q, _ = mesh.step(q, bound, Q * k / steps, 2.0 * 0.25 * sigma / steps / E)
        errors.append(np.abs(q - solution.shear(mesh.x)).mean() / bound.max())
    assert errors[0] < 3e-4
    assert errors[1] > 3.0 * errors[0]


@pytest.mark.parametrize("sigma", [0.5, 0.0])
def test_reports_without_a_certificate_note_zones_that_retreat(sigma):
    """The text and the JSON: where the shear matters, and not where only the pressure is wanted."""
    solution = sie.solve(replace(HERTZ, tangential_load=0.6 * FP, bulk_stress=sigma))

    def reports(*want):
        file = SceneFile(solution.scene, want=want)
        return summary(solution, file), " ".join(as_dict(solution, file)["notes"])

    assert all(
        ("retreat" in report) is (sigma != 0.0) for report in (*reports(), *reports("stress"))
    )
    assert not any("retreat" in report for report in reports("pressure"))


@pytest.mark.parametrize("part", [1e-17, 1e-25, 1e-50])
def test_the_energy_of_the_shortest_slip_zones_is_the_first_term_of_its_series(part):
    """f² P² (Q/f P)³/(3 π E*): the zones are shorter than the rounding of the load."""
    lost = at_constant_load(HERTZ, part)[0].energy_lost
    assert lost == pytest.approx(FP * FP * part**3 / (3.0 * np.pi * E), rel=1e-12)


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("length", "modulus"), [(1e60, 1e60), (1e-60, 1e-50), (1e100, 1e50)])
def test_the_energy_of_loads_whose_squares_are_no_doubles_is_that_in_other_units(length, modulus):
    points = [(0.375, 0.1), (0.5, -0.05), (0.25, 0.02)]

    def lost(L, Estar):
        unit = L * Estar
        profile = sie.RoundedFlat(0.7 * L, L)
        scene = sie.Scene(profile=profile, modulus=2.0 * Estar, normal_load=unit, friction=F)
        path = sie.Path([(unit * N, unit * Q) for N, Q in points])
        return [solution.energy_lost for solution in sie.follow(scene, path)]

    expected = [energy * length * length * modulus for energy in lost(1.0, 1.0)]
    assert lost(length, modulus) == pytest.approx(expected, rel=1e-11)


def test_the_energy_under_a_load_that_is_negligible_next_to_the_largest_is_that_of_its_own_path():
    small = (1e-20, 1e-21)
    alone = sie.follow(HERTZ, sie.Path([small]))[0].energy_lost
    assert sie.follow(HERTZ, sie.Path([small, (P, 0.0)]))[0].energy_lost == pytest.approx(
        alone, rel=1e-12
    )


@pytest.mark.slow
def test_an_energy_that_is_no_double_in_its_units_is_refused():
    scene = sie.Scene(profile=sie.Parabola(1e60), modulus=2e120, normal_load=1e180, friction=F)
    last = sie.follow(scene, sie.Path([(1e180, 1e179), (1.2e180, -1e179)]))[-1]
    with pytest.raises(sie.ContactError, match="no double in these units"):
        _ = last.energy_lost


@pytest.mark.parametrize("excess", [2.0**-55, 2.0**-54, 2.0**-53])
def test_a_load_that_rises_and_sticks_but_for_rounding_does_not_slip(excess):
    """|dQ| = f dP but for an ulp."""
    after = sie.follow(HERTZ, sie.Path([(0.75, 0.125 + excess), (1.0, 0.0)]))[1]
    assert after.tangential.slipped == ()
    assert after.stick == (after.edges,)
