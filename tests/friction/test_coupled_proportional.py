"""Dissimilar bodies under P and Q that grow in proportion from zero."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import dissimilar

import sie
from oracles.spence import oblique_contact
from sie.certificate.coupled_shear_check import sheared_certificate
from sie.friction.coupled.oblique import inclination


def scene(profile=None, beta=0.3, friction=0.3, load=1.0):
    return dissimilar(profile, beta, friction, normal_load=load)


def solved(profile=None, beta=0.3, friction=0.3, part=0.3, load=1.0):
    path = sie.Path([(0.0, 0.0), (load, part * friction * load)])
    return sie.follow(scene(profile, beta, friction, load), path)[1]


@pytest.mark.parametrize(
    ("profile", "beta", "friction", "part"),
    [
        (None, 0.3, 0.3, 0.3),
        (None, 0.07, 0.3, 0.3),
        (None, 0.45, 0.05, 1e-7),
        (sie.Power(2.5, 0.4), 0.3, 0.3, -0.2),
        (sie.Power(5.0, 0.4).shifted(2.0), -0.2, 0.9, 0.2),
        (sie.Polynomial((0.0, 0.0, 0.0, 0.0, 0.4)), 0.5, 0.5, 0.1),
        # Slip zones of P alone as narrow as are resolved, and nearly all stick behind the axis
        (sie.Power(1.3, 0.4), -0.0019, 7.95, 2.7e-6),
        (sie.Power(2.779, 0.4), 0.1255, 1.407, 0.5162),
        (sie.Power(16.0, 0.4), 0.1706, 3.525, -0.32),
    ],
)
def test_certificate_holds_under_loads_in_proportion(profile, beta, friction, part):
    certificate = solved(profile, beta, friction, part).check()
    assert certificate.ok
    assert max(certificate.error, certificate.shear.error) < 1e-12


def test_certificate_does_not_depend_on_where_a_small_contact_lies():
    assert solved(sie.Power(1.3, 0.4).shifted(30.0), 0.0882, 0.0172, 2.2e-6, 2e-4).check().ok


def test_certificate_is_not_ok_for_another_mismatch():
    right = solved()
    wrong = replace(right.scene, dundurs=0.3001)
    assert not sheared_certificate(right.coupled[1], wrong, 1e-13).ok


@pytest.mark.parametrize(
    ("beta", "friction", "part"), [(0.3, 0.3, 0.3), (0.5, 0.5, 0.2), (0.2, 0.6, 0.3)]
)
def test_loads_and_zones_are_those_of_a_grid_step_by_step(beta, friction, part):
    solution, n = solved(None, beta, friction, part), 50
    grid = oblique_contact(lambda x: 0.5 * x * x, solution.edges, n, (beta, friction))
    (P, Q), cell = grid.loads, np.ptp(grid.x) / (2 * n - 1)
    assert pytest.approx(part * friction, rel=4e-3) == Q / P
    assert pytest.approx(1.0, rel=0.02) == P
    ((e1, e2),) = solution.stick
    stuck = grid.x[grid.sticks]
    assert stuck[0] == pytest.approx(e1, abs=1.5 * cell)
    assert stuck[-1] == pytest.approx(e2, abs=1.5 * cell)
    inner = slice(4, -4)
    assert solution.shear(grid.x)[inner] == pytest.approx(grid.shear[inner], abs=0.02)


@pytest.mark.parametrize("exponent", [1.5, 2.0, 5.0])
def test_answer_without_shear_is_that_of_the_normal_load(exponent):
    profile = sie.Power(exponent, 0.4)
    one, other = solved(profile, part=0.0), sie.solve(scene(profile))
    x = other.half_width * np.array([-0.97, -0.6, -0.1, 0.3, 0.8])
    assert one.edges == pytest.approx(other.edges, rel=1e-13)
    assert one.pressure(x) == pytest.approx(other.pressure(x), rel=1e-12)
    assert one.shear(x) == pytest.approx(other.shear(x), abs=1e-12)
    assert one.slip(x) == pytest.approx(other.slip(x), abs=1e-12)
    assert one.gap(1.5 * x) == pytest.approx(other.gap(1.5 * x), abs=1e-12)
    assert one.energy_lost == pytest.approx(other.energy_lost, rel=1e-11)


@pytest.mark.parametrize(("beta", "part"), [(0.3, -0.3), (-0.3, 0.3), (-0.3, -0.3)])
def test_signs_of_the_load_and_of_the_mismatch_give_mirror_images(beta, part):
    one, other = solved(), solved(None, beta, 0.3, part)
    flip, sign = math.copysign(1.0, beta * part), math.copysign(1.0, part)
    x = np.linspace(*other.edges, 41)[1:-1]
    assert other.pressure(x) == pytest.approx(one.pressure(flip * x), rel=1e-11)
    assert other.shear(x) == pytest.approx(sign * one.shear(flip * x), abs=1e-12)
    assert other.slip(x) == pytest.approx(sign * one.slip(flip * x), abs=1e-12)


def test_slip_is_what_the_shear_does_to_the_surfaces():
    before, after = solved(load=1.0), solved(load=1.0 + 1e-4)
    ((e1, e2),) = before.stick
    x1, x2 = before.edges
    stuck = np.linspace(e1, e2, 9)[1:-1]
    slips = np.append(np.linspace(x1, e1, 7)[1:-1], np.linspace(e2, x2, 7)[1:-1])
    assert after.slip(stuck) == pytest.approx(before.slip(stuck), abs=1e-14)
    moved = after.slip(slips) - before.slip(slips)
    assert (moved * np.sign(slips - 0.5 * (e1 + e2)) > 0.0).all()


def test_energy_is_the_work_of_friction_on_the_slip():
    one, other = solved(load=0.99), solved(load=1.01)
    lo, hi = one.edges
    phi = (np.arange(2000) + 0.5) * math.pi / 2000
    x = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(phi)
    carried = 0.5 * np.abs(one.shear(x) + other.shear(x))
    work = carried * np.abs(other.slip(x) - one.slip(x)) * np.sin(phi)
    lost = other.energy_lost - one.energy_lost
    assert lost == pytest.approx(work.sum() * 0.5 * (hi - lo) * math.pi / 2000, rel=2e-2)


def test_zones_grow_in_proportion_to_the_contact():
    history = sie.follow(
        scene(sie.Power(3.0, 0.4)), sie.Path([(0.0, 0.0), (0.5, 0.03), (4.0, 0.24)])
    )
    small, large = (np.append(history[k].edges, history[k].stick[0]) for k in (1, 2))
    assert large == pytest.approx(2.0 * small, rel=1e-12)
    assert [row["normal_load"] for row in history.rows()] == [0.0, 0.5, 4.0]


def test_every_load_below_the_limit_of_friction_has_its_inclination():
    flat = solved().coupled[1].right.flat
    turns = [inclination(flat, part * 0.3) for part in (0.0, 1e-6, 0.3, 0.9, 0.999)]
    assert turns[0] == 0.0
    assert (np.diff(turns) < 0.0).all()


def refused(history):
    with pytest.raises(sie.ContactError) as caught:
        _ = history[1].edges
    return str(caught.value)


def test_refusal_of_a_large_load_names_the_largest_that_is_certified():
    limit = 0.381 * 0.3
    words = refused(sie.follow(scene(), sie.Path([(0.0, 0.0), (1.0, 0.2)])))
    assert "0.1143 P = 0.381 f P" in words
    assert solved(part=0.99 * limit / 0.3).check().ok
    assert "would slip again" in refused(
        sie.follow(scene(), sie.Path([(0.0, 0.0), (1.0, 1.01 * limit)]))
    )


def test_profiles_that_are_no_power_law_are_refused():
    path = sie.Path([(0.0, 0.0), (1.0, 0.05)])
    assert "power laws" in refused(sie.follow(scene(sie.RoundedFlat(0.5, 1.0)), path))


def test_slip_zones_below_resolution_are_refused_where_the_shear_widens_them():
    weak = scene(beta=0.001)
    assert sie.follow(weak, sie.Path([(0.0, 0.0), (1.0, 1e-4)]))[1].check().ok
    words = refused(sie.follow(weak, sie.Path([(0.0, 0.0), (1.0, 0.09)])))
    assert "narrower than 1e-15" in words


@pytest.mark.parametrize(
    "points",
    [
        [(1.0, 0.0), (1.0, 0.1), (1.0, 0.05)],
        [(1.0, 0.0), (1.0, 0.1), (1.0, -0.2)],
        [(1.0, 0.1), (2.0, 0.1)],
        [(0.0, 0.0), (1.0, 0.1), (2.0, 0.1)],
        [(0.0, 0.0), (1.0, 0.1), (0.5, 0.05)],
    ],
)
def test_other_paths_of_dissimilar_bodies_are_refused(points):
    with pytest.raises(
        sie.ContactError, match=r"in proportion on a path that begins with \(0, 0, 0\)"
    ):
        sie.follow(scene(), sie.Path(points))


def test_the_beginning_of_the_path_has_no_contact():
    history = sie.follow(scene(), sie.Path([(0.0, 0.0), (1.0, 0.05)]))
    with pytest.raises(sie.ContactError, match="P = 0"):
        _ = history[0].edges


def test_points_where_the_normal_load_grows_and_then_the_tangential_one_are_those_of_scenes():
    path = sie.Path([(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, -0.15), (1.0, -0.2)])
    history = sie.follow(scene(), path)
    assert [row["energy_lost"] for row in history.rows()] == sorted(
        row["energy_lost"] for row in history.rows()
    )
    for point, (P, Q, _) in list(zip(history, path.points, strict=True))[1:]:
        alone = sie.solve(replace(scene(load=P), tangential_load=Q))
        assert point.edges == pytest.approx(alone.edges, rel=1e-12)
        assert point.stick[0] == pytest.approx(alone.stick[0], rel=1e-11)
        assert point.slip(0.3) == pytest.approx(float(alone.slip(0.3)), rel=1e-9, abs=1e-15)
        assert point.shear.resultant == Q and point.check().ok


def test_a_path_of_scenes_is_refused_before_any_work_where_all_slides():
    with pytest.raises(sie.LoadError, match="bodies slide"):
        sie.follow(scene(), sie.Path([(1.0, 0.0), (1.0, 0.1), (1.0, 0.4)]))
