"""Load paths: Masing's memory, P and Q together, the cost of a cycle, and a mesh solver.

The mesh solver does not use superposition.
"""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sie
from oracles.kalker import Mesh
from sie.friction.memory import LoadMemory
from sie.friction.slip_state import edge_frames
from sie.friction.slip_zones import slip_zone
from sie.io.export import as_dict
from sie.io.report import summary
from sie.io.scene_file import SceneFile

E, F, P = 2.0, 0.5, 0.375
PUNCH = sie.Scene(profile=sie.RoundedFlat(0.7, 1.0), modulus=E, normal_load=P, friction=F)
HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=E, normal_load=P, friction=F)
LOPSIDED = sie.Scene(
    profile=sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6)),
    modulus=E,
    normal_load=P,
    friction=F,
    tilt=0.02,
)
FP = F * P
# The contact ends at a corner of the indenter on one side.
CORNERED = [
    replace(HERTZ, profile=sie.Piecewise(ends, ((0.0, 1.0),)))
    for ends in ((-0.3, np.inf), (-np.inf, 0.3))
]


def at_constant_load(scene, *fractions):
    return sie.follow(scene, sie.Path([(P, k * FP) for k in fractions]))


# -- constant P -----------------------------------------------------------------------------------


def test_a_path_of_one_point_is_the_scene():
    followed = at_constant_load(PUNCH, 0.8)[0]
    scene = sie.solve(followed.scene)
    x = np.linspace(-1.0, 1.0, 21)
    assert followed.stick == scene.stick
    assert (followed.shear(x) == scene.shear(x)).all()
    assert (followed.slip(x) == scene.slip(x)).all()
    assert followed.energy_lost == scene.energy_lost


@pytest.mark.parametrize("scene", [PUNCH, HERTZ, LOPSIDED], ids=["punch", "hertz", "lopsided"])
def test_unloading_is_half_of_the_first_loading_twice(scene):
    """From Q_max to Q: q = q(Q_max) - 2 q((Q_max - Q)/2), Mindlin & Deresiewicz 1953; slip
    likewise.
    """
    unloaded = at_constant_load(scene, 0.75, 0.25)[1]
    first, half = (
        sie.solve(sie.Scene(**fields(scene), tangential_load=k * FP)) for k in (0.75, 0.25)
    )
    x = np.linspace(*first.edges, 31)
    assert unloaded.stick == half.stick
    assert unloaded.shear(x) == pytest.approx(first.shear(x) - 2.0 * half.shear(x), abs=1e-15)
    assert unloaded.slip(x) == pytest.approx(first.slip(x) - 2.0 * half.slip(x), abs=1e-16)
    assert unloaded.energy_lost == pytest.approx(
        first.energy_lost + 2.0 * half.energy_lost, rel=1e-13
    )
    assert unloaded.check().ok


def fields(scene):
    return {
        name: getattr(scene, name)
        for name in ("profile", "modulus", "normal_load", "friction", "tilt")
    }


def test_a_closed_loop_closes_after_the_first_cycle_and_leaves_no_memory():
    first, _, small, back, again, down = at_constant_load(PUNCH, 0.8, -0.8, 0.4, -0.2, 0.8, -0.8)
    x = np.linspace(-1.0, 1.0, 41)
    assert again.stick == first.stick
    assert again.shear(x) == pytest.approx(first.shear(x), abs=1e-15)
    assert again.slip(x) == pytest.approx(first.slip(x), abs=1e-16)
    assert down.shear(x) == pytest.approx(-first.shear(x), abs=1e-15)
    assert first.stick[0][1] < small.stick[0][1] < back.stick[0][1]
    assert len(again.history.turning_points[4].memory.layers) == 1


@pytest.mark.parametrize("scene", [PUNCH, *CORNERED], ids=["smooth", "left corner", "right corner"])
def test_the_loop_of_load_over_shift_encloses_the_energy_lost(scene):
    """∮Q dδ: by Simpson on one branch, which the other mirrors."""
    n = 201
    Q = 0.8 * np.cos(np.linspace(0.0, np.pi, n))  # from the top down, densely at both ends
    history = at_constant_load(scene, *Q)
    t, shift = np.linspace(0.0, np.pi, n), np.array([s.shift for s in history])
    weight = np.full(n, 2.0)
    weight[1::2], weight[[0, -1]] = 4.0, 1.0
    # ∫δ dQ = ∫ δ(t) Q'(t) dt, and -δ on the way up
    area = -2.0 * float((weight * shift * -0.8 * FP * np.sin(t)).sum()) * (np.pi / (n - 1)) / 3.0
    assert area == pytest.approx(2.0 * (history[-1].energy_lost - history[0].energy_lost), rel=1e-7)


@settings(max_examples=30)
@given(
    st.lists(st.integers(-50, 50).map(lambda k: k / 50), min_size=2, max_size=6),
    st.sampled_from([PUNCH, HERTZ, LOPSIDED]),
)
def test_every_point_of_every_path_obeys_the_laws(fractions, scene):
    lost = 0.0
    for solution in at_constant_load(scene, *fractions):
        assert solution.check().shear.ok, solution.check().shear
        assert solution.energy_lost >= lost
        lost = solution.energy_lost


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=12))
def test_the_layers_carry_the_load_within_their_limits(targets):
    memory = LoadMemory(1.0)
    for target in targets:
        before, (memory, done) = (
            memory,
            memory.changed(0.0, target - memory.total) if target != memory.total else (memory, ()),
        )
        assert memory.total == pytest.approx(target, abs=1e-14)
        assert all(thickness > 0.0 and abs(k) <= 1.0 for thickness, k in memory.layers)
        assert sum(thickness for thickness, _ in memory.layers) <= 1.0 + 1e-15
        pulled = sum(o.jump * (o.lower - o.upper) for slip in done for o in slip.layers)
        assert pulled == pytest.approx(abs(target - before.total), abs=1e-14)


def test_a_thousand_steps_cost_less_than_a_thousand_solves():
    """In evaluations of the edge integrals, which are most of a solve that has no closed form."""
    Q = 0.8 * np.sin(np.linspace(0.0, 2.0 * np.pi, 1001))[1:]
    punch = replace(PUNCH, profile=PUNCH.profile + sie.Parabola(10.0))
    history = at_constant_load(punch, *Q)
    zones = [solution.stick for solution in history]
    spent = sum(
        state.found.edges.evaluations
        for state in history._first_loadings.values()
        if hasattr(state, "found")
    )
    assert len(zones) == 1000 and len(history._plain) == 1
    assert spent < 0.6 * 1000 * sie.solve(punch).normal.edges.evaluations
    assert "pressure" in vars(history.plain(P))
    assert not any("corrective" in vars(state) for state in history._first_loadings.values())


def test_energy_of_ten_thousand_turning_points_takes_no_contact_for_each(monkeypatch):
    """The next, smaller one overwrites a part of each: every layer stays. One series for the growth
    of the contact serves all.
    """
    k = np.arange(10_000)
    history = at_constant_load(PUNCH, *(0.95 * (1.0 - k / 10_000) * (-1.0) ** k))
    assert len(history.turning_points[-1].memory.layers) == 10_000
    assert history.energy(9_999) > history.energy(9_998) > 0.0
    assert history.dissipation(0.0).evaluations < 500 and not history._first_loadings


def test_the_shear_of_many_turning_points_takes_the_pressure_of_the_contact_once():
    """Each corner is the difference of the same pressure and that of a smaller contact."""
    k = np.arange(100)
    history = at_constant_load(PUNCH, *(0.95 * (1.0 - k / 100) * (-1.0) ** k))
    shear, pressure = history[-1].shear, history.plain(P).slope_density
    corners = {id(part) for _, part in shear.bases}
    assert sum(part is pressure for _, part in shear.terms) == 1
    assert len(corners) <= len(history.turning_points[-1].memory.layers) + 1
    x = np.linspace(*history[-1].edges, 41)
    one_by_one = sum(weight * loading.shear(x) for weight, loading in history[-1].tangential._terms)
    assert shear(x) == pytest.approx(one_by_one, abs=1e-14)


@pytest.mark.parametrize("length", [1e-12, 1e-3, 0.3])
def test_the_pull_of_a_slip_zone_beyond_its_length_is_its_sum(length):
    solved = sie.solve(sie.Scene(**fields(PUNCH)))
    zone_ = slip_zone(
        edge_frames(solved.slope_density, solved.normal.slope(PUNCH.profile))[1], length
    )
    distance = length * np.array([0.0, 1e-8, 0.3, 0.999, 1.0, 1.001, 3.0, 1e4])
    weight = zone_.force / np.sqrt(zone_.from_stick * (zone_.from_stick + 0.8))
    assert zone_.pull(distance, 0.4) == pytest.approx(
        (weight / (distance[:, None] + zone_.from_stick)).sum(axis=1), rel=1e-13
    )


def test_no_point_of_a_path_is_solved_before_it_is_read():
    history = at_constant_load(PUNCH, 0.5, -0.5, 0.2)
    assert len(history) == 3
    assert not history._plain
    _ = history[1].stick
    assert len(history._first_loadings) == 1


# -- P and Q together -----------------------------------------------------------------------------


def test_proportional_loading_below_friction_does_not_slip():
    """dQ/dP = k < f from nothing: q = k p (Mindlin & Deresiewicz)."""
    history = sie.follow(PUNCH, sie.Path([(0.0, 0.0), (P, 0.6 * FP)]))
    x = np.linspace(-0.9, 0.9, 11)
    assert history[1].stick == (history[1].edges,)
    assert history[1].shear(x) == pytest.approx(0.6 * F * history[1].pressure(x), rel=1e-14)
    assert history[1].energy_lost == 0.0
    assert (history[1].slip(x) == 0.0).all()


def test_loading_above_friction_slips_like_a_smaller_normal_load():
    """dQ/dP > f: q = f (p - p̂), p̂ under P - Q/f, as if P had come first (Jäger 1998)."""
    together = sie.follow(HERTZ, sie.Path([(0.1, 0.0), (P, 0.75 * FP)]))[1]
    after = sie.solve(sie.Scene(**fields(HERTZ), tangential_load=0.75 * FP))
    x = np.linspace(*after.edges, 21)
    assert together.stick[0] == pytest.approx(after.stick[0], rel=1e-14)
    assert together.shear(x) == pytest.approx(after.shear(x), abs=1e-15)
    assert 0.0 < together.energy_lost < after.energy_lost


def test_a_locked_in_layer_survives_more_normal_load():
    """Q first at constant P, then P alone: nothing slips, q stays and the limit grows."""
    first, second = sie.follow(HERTZ, sie.Path([(0.2, 0.05), (0.3, 0.05)]))
    x = np.linspace(*second.edges, 21)
    assert second.stick == (second.edges,)
    assert second.shear(x) == pytest.approx(first.shear(x), abs=1e-15)
    assert second.energy_lost == first.energy_lost


def test_unloading_along_the_loading_path_removes_all_shear():
    there, back = list(
        sie.follow(HERTZ, sie.Path([(0.0, 0.0), (0.1, 0.03), (0.4, 0.05), (0.1, 0.03)]))
    )[1::2]
    x = np.linspace(*there.edges, 21)
    assert back.shear(x) == pytest.approx(there.shear(x), abs=1e-15)
    assert back.energy_lost == 0.0


def test_energy_while_the_normal_load_changes_tends_to_that_at_constant_load():
    almost = sie.follow(HERTZ, sie.Path([(P, 0.1 * FP), (P * (1.0 + 1e-9), 0.7 * FP)]))[
        1
    ].energy_lost
    constant = at_constant_load(HERTZ, 0.1, 0.7)[1].energy_lost
    assert almost == pytest.approx(constant, rel=1e-7)


KINDS = {
    "power 1.5": sie.Power(1.5, 0.5),
    "power 2.5": sie.Power(2.5, 0.5),
    "wedge": sie.Wedge(0.3),
    "punch": sie.RoundedFlat(0.5, 1.0),
    "tilted punch": sie.RoundedFlat(0.5, 1.0).tilted(0.02),
    "lopsided": sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6)),
    "two radii": sie.Piecewise([-0.5, 0.25], [(0.5, 1.0), (0.0,), (-0.75, 3.0)]),
    "sharp": sie.Flat(0.6) + sie.Parabola(1.0),
    "function": sie.FromFunction("sinh(x) + x**2/8", domain=(-3.0, 3.0)),
    "trace": sie.Sampled(np.linspace(-1.6, 1.6, 161),
                         np.linspace(-1.6, 1.6, 161) ** 2 / 2 + np.linspace(-1.6, 1.6,
                                                                            161) ** 3 / 20),
}  # fmt: skip
TURNING = [
    (0.1, 0.02),
    (0.3, 0.1),
    (0.25, -0.05),
    (0.1, 0.02),
    (0.3, 0.04),
    (0.2, 0.09),
    (0.2, -0.06),
    (0.26, 0.1),
]


@pytest.mark.parametrize("name", KINDS)
def test_energy_of_a_path_is_that_of_the_path_cut_into_many_parts(name):
    scene = sie.Scene(profile=KINDS[name], modulus=1.0, normal_load=0.3, friction=0.5)
    whole, parts = (
        sie.follow(scene, sie.Path(TURNING)),
        sie.follow(scene, sie.Path(TURNING).subdivided(7)),
    )
    for one, same in zip(whole, parts[::7], strict=True):
        assert one.energy_lost == pytest.approx(same.energy_lost, rel=1e-10)


@settings(max_examples=40)
@given(
    st.lists(st.tuples(st.integers(1, 40), st.integers(-9, 9)), min_size=2, max_size=6),
    st.sampled_from([PUNCH, HERTZ, LOPSIDED]),
)
def test_energy_of_every_oblique_path_is_that_of_the_path_cut_into_parts(points, scene):
    path = sie.Path([(0.02 * p, 0.1 * q * F * 0.02 * p) for p, q in points])
    whole, parts = sie.follow(scene, path), sie.follow(scene, path.subdivided(9))
    assert whole[-1].energy_lost == pytest.approx(parts[-1].energy_lost, rel=1e-10, abs=1e-16)
    x = np.linspace(*whole[-1].edges, 23)
    assert whole[-1].shear(x) == pytest.approx(parts[-1].shear(x), abs=1e-11)


def test_slip_that_turns_while_the_normal_load_falls_is_reported_in_both_directions():
    """The layers: κ = 0.9 f on top, -f below. P falls: slip + until the edges have passed them,
    then slip -.
    """
    history = sie.follow(HERTZ, sie.Path([(0.2, -0.09), (0.4, 0.0), (0.1, -0.045)]))
    last = history[-1].tangential
    first, turned = history.turning_points[-1].slips
    assert first.sign == -turned.sign
    ((a, b, plus), (c, d, minus), *now) = last.slipped
    assert plus == minus == first.sign and {sign for _, _, sign in now} == {turned.sign}
    x1, x2 = history[-1].edges
    before = sie.solve(sie.Scene(**fields(HERTZ) | {"normal_load": 0.4})).edges
    assert before[0] == pytest.approx(a) and before[1] == pytest.approx(d) and b <= x1 and x2 <= c
    parts = sie.follow(HERTZ, sie.Path([(0.2, -0.09), (0.4, 0.0), (0.1, -0.045)]).subdivided(8))
    x = np.linspace(x1, x2, 15)
    total = sum(solution.tangential.slip_now(x) for solution in parts[-8:])
    assert last.slip_now(x) == pytest.approx(total, abs=1e-14)
    assert history[-1].energy_lost == pytest.approx(parts[-1].energy_lost, rel=1e-12)


@given(
    st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(0.02, 1.0)), min_size=2, max_size=6),
    st.floats(0.05, 0.95),
    st.floats(-2.0, 2.0),
)
def test_slip_while_the_normal_load_falls_accounts_for_the_tangential_load(layers, share, rate):
    """Q falls by what the layers carried away, and rises by the pull of the slip; no front is
    behind the edge.
    """
    memory = LoadMemory(1.0)
    for target, _ in layers:
        if target != memory.total:
            memory, _ = memory.changed(0.0, 0.9 * target - memory.total)
    thickness = share * 0.9
    if abs(memory.total + rate * thickness) >= 1.0 - thickness:
        return  # the bodies slide
    lower, slips = memory.changed(-thickness, rate * thickness)
    assert lower.level == pytest.approx(1.0 - thickness, abs=1e-14)
    assert lower.total == pytest.approx(memory.total + rate * thickness, abs=1e-13)
    for slip in slips:
        for o in slip.layers:
            assert o.lower >= o.upper and 0.0 < o.jump <= 2.0
            assert o.surface[0] <= o.upper + 1e-13 and o.surface[1] <= o.lower + 1e-13


def test_energy_of_a_lopsided_profile_depends_on_its_half_width_alone():
    """h' = sinh x + x²/10 - t: ∫h'/w = π [sinh m I0(r) + (m² + r²/2)/10 - t], P = π G r [cosh m
    I1(r) + m r/10], for each half-width r.
    """
    G, load, Q, f = mpmath.mpf("0.5"), mpmath.mpf(0.3), mpmath.mpf(0.1), mpmath.mpf(0.5)

    def under(r):
        m = mpmath.findroot(
            lambda m: mpmath.sinh(m) * mpmath.besseli(0, r) + (m * m + r * r / 2) / 10, -r * r / 20
        )
        return mpmath.pi * G * r * (mpmath.cosh(m) * mpmath.besseli(1, r) + m * r / 10)

    b, c = (
        mpmath.findroot(lambda r, y=y: under(r) - y, (0.3, 0.7), solver="anderson", tol=1e-24)
        for y in (load, load - Q / f)
    )
    by_hand = (
        f
        * f
        / (mpmath.pi * G)
        * mpmath.quad(lambda r: (load - under(r)) * (under(r) - load + Q / f) / r, [c, b])
    )
    profile = sie.FromFunction(lambda x: np.sinh(x) + 0.1 * x * x, domain=(-3.0, 3.0))
    scene = sie.Scene(
        profile=profile, modulus=1.0, normal_load=0.3, friction=0.5, tangential_load=0.1
    )
    assert sie.solve(scene).energy_lost == pytest.approx(float(by_hand), rel=1e-12)


def test_energy_while_an_edge_passes_a_jump_is_that_of_the_mirrored_path():
    """Beside the jump the half-width hardly grows: a step of Newton's method that did not settle
    there is no contact.
    """
    profile = sie.Piecewise([-0.4, 0.0], [(0.1, 1.5), (0.0, 1.0), (0.0, 1.5)])
    points = [
        (0.17463394504062985, -0.18860466064388023),
        (0.3, 0.3028715783482759),
        (0.3, 0.35964),
        (0.11927161476021313, 0.1187),
    ]
    here, there = (
        sie.follow(
            sie.Scene(profile=p, modulus=1.0, normal_load=0.3, friction=1.2),
            sie.Path([(P, s * Q) for P, Q in points]),
        )
        for p, s in ((profile, 1.0), (profile.mirrored(), -1.0))
    )
    for one, other in zip(here, there, strict=True):
        assert one.energy_lost == pytest.approx(other.energy_lost, rel=1e-12)


def test_the_energy_of_small_loads_has_as_many_digits_as_that_of_large_ones():
    """A front from 0.3 down to a load 450 times as small: what a panel may miss is measured by the
    loads that it is for.
    """
    scene = sie.Scene(
        profile=sie.Power(2.5, 0.5).shifted(0.3).tilted(0.05),
        modulus=1.0,
        normal_load=0.3,
        friction=1.2,
    )
    path = sie.Path([(0.3, 0.0), (0.0006679102250409004, 0.0007213430430441724)])
    whole, parts = sie.follow(scene, path)[-1], sie.follow(scene, path.subdivided(16))[-1]
    assert whole.energy_lost == pytest.approx(parts.energy_lost, rel=1e-10)


def test_energy_of_loading_hertz_with_a_growing_normal_load():
    """W = 2/(π E*) ∫∫ f ln(r'/r) over the layers, r² ∝ P: by hand for P from P0 to P1, dQ/dP = k >
    f.

    W = f²/(π E*) (k/f - 1) ∫ [P ln(P/L) - P + L] dP,    L(P) = P - (P - P0) k/f
    """
    P0, P1, k = 0.1, 0.2, 1.5 * F
    lost = sie.follow(HERTZ, sie.Path([(P0, 0.0), (P1, k * (P1 - P0))]))[1].energy_lost
    g, w = np.polynomial.legendre.leggauss(60)
    load = P0 + (P1 - P0) * 0.5 * (1.0 + g)
    level = load - (load - P0) * k / F
    by_hand = (
        F
        * F
        / (np.pi * E)
        * (k / F - 1.0)
        * 0.5
        * (P1 - P0)
        * w
        @ (load * np.log(load / level) - load + level)
    )
    assert lost == pytest.approx(by_hand, rel=1e-10)


def test_normal_load_alone_comes_before_anything():
    """From (0, 0, 0), up, down: what is applied later, bulk stress included, finds a contact that
    was never sheared.
    """
    Q, sigma = 0.4 * FP, 0.1
    loads = [(P, Q, sigma), (P, -0.2 * Q, -0.2 * sigma)]
    later = sie.follow(HERTZ, sie.Path([(0.0, 0.0), (0.0, 0.0), (2.0 * P, 0.0), (P, 0.0), *loads]))
    at_once = sie.follow(HERTZ, sie.Path(loads))
    x = np.linspace(*at_once[0].edges, 21)
    for one, other in zip(later[4:], at_once, strict=True):
        assert (
            one.stick == other.stick
            and one.energy_lost == other.energy_lost
            and one.shift == other.shift
        )
        assert (one.shear(x) == other.shear(x)).all() and (one.slip(x) == other.slip(x)).all()


def test_no_moment_on_a_symmetric_profile_is_no_tilt():
    path = sie.Path([(P, 0.05), (2 * P, 0.3), (P, 0.1)])
    balanced, upright = (
        sie.follow(sie.Scene(**fields(HERTZ) | {"tilt": 0.0} | more), path)
        for more in ({}, {"moment": 0.0})
    )
    for one, other in zip(balanced, upright, strict=True):
        assert one.stick == other.stick and one.energy_lost == other.energy_lost


# -- refusals -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([(P, 0.1), (P, 0.3)], r"step 1 .*exceeds f P"),
    ],
)
def test_a_step_that_is_not_covered_is_named_before_work(points, said):
    with pytest.raises(sie.ContactError, match=said) as caught:
        sie.follow(PUNCH, sie.Path(points))
    assert "step" in caught.value.reached


def test_a_normal_load_that_grows_at_a_given_moment_locks_the_shear_in():
    """The contact rolls towards the origin as it grows, and contains the one before."""
    tilted = sie.Scene(profile=sie.Parabola(1.0), modulus=E, normal_load=P, friction=F, moment=0.01)
    first, second = sie.follow(tilted, sie.Path([(P, 0.05), (2 * P, 0.05)]))
    x = np.linspace(*second.edges, 21)
    assert second.stick == (second.edges,) and second.tilt != first.tilt
    assert second.shear(x) == pytest.approx(first.shear(x), abs=1e-14)
    assert second.energy_lost == first.energy_lost


RETREAT = (P, 0.6 * FP, 0.5)


def test_zones_that_retreat_on_the_way_to_the_first_point_are_followed():
    """As from (P, 0, 0), and on from there; a scene has the state in total displacements."""
    first, then = sie.follow(HERTZ, sie.Path([RETREAT, (P, 0.0, 0.0)]))
    later = sie.follow(HERTZ, sie.Path([(P, 0.0, 0.0), RETREAT]))[1]
    scene = sie.solve(replace(HERTZ, tangential_load=RETREAT[1], bulk_stress=RETREAT[2]))
    x = np.linspace(*first.edges, 21)
    assert (first.shear(x) == later.shear(x)).all() and (first.slip(x) == later.slip(x)).all()
    assert first.energy_lost == later.energy_lost and first.slip_notes == ()
    assert first.check().ok and then.check().ok
    assert first.stick != scene.stick and "retreat" in scene.notes[-1]


def test_where_the_way_to_the_first_point_is_not_covered_it_is_answered_like_a_scene(monkeypatch):
    """With the same remark, and no step from there; the reason is told."""

    def refused(*_):
        raise sie.ContactError("the stick zone would meet another one")

    monkeypatch.setattr(sie.History, "march", refused)
    scene = sie.solve(replace(HERTZ, tangential_load=RETREAT[1], bulk_stress=RETREAT[2]))
    (point,) = sie.follow(HERTZ, sie.Path([RETREAT]))
    x = np.linspace(*scene.edges, 21)
    assert (point.shear(x) == scene.shear(x)).all() and point.energy_lost == scene.energy_lost
    assert point.notes == scene.notes and "retreat" in point.notes[-1]
    with pytest.raises(sie.ContactError, match=r"step 1 .*retreat.*would meet another one"):
        sie.follow(HERTZ, sie.Path([RETREAT, (P, 0.1 * FP, 0.5)]))


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([], "no points"),
        (None, "points = None is not a list"),
        ([(0.0, 0.0), (0.0, 0.0)], "nothing ever touches"),
        ([(1.0,)], r"\(1\.0,\).*give \(P, Q\)"),
        ([(1.0, np.nan)], "Q of point 0 is nan"),
        ([(1.0, 0.0), (0.0, 0.0)], "P of point 1 = 0"),
        ([(-1.0, 0.0)], "P of point 0 = -1"),
        ([3.0], r"3\.0.*give \(P, Q\)"),
    ],
)
def test_an_invalid_path_is_refused(points, said):
    with pytest.raises(ValueError, match=said):
        sie.Path(points)


def test_a_path_without_friction_carries_no_tangential_load():
    plain = sie.Scene(profile=sie.Parabola(1.0), modulus=E, normal_load=P)
    with pytest.raises(ValueError, match=r"0\.1 without friction"):
        sie.follow(plain, sie.Path([(P, 0.1)]))
    assert sie.follow(plain, sie.Path([(P, 0.0), (2 * P, 0.0)]))[1].shear is sie.ZERO


def test_an_unloaded_beginning_has_no_solution():
    history = sie.follow(HERTZ, sie.Path([(0.0, 0.0), (P, 0.0)]))
    with pytest.raises(sie.LoadError, match="nothing touches"):
        _ = history[0].edges
    assert history[-1].edges == sie.solve(HERTZ).edges


def test_a_point_of_a_path_is_not_changed_into_another():
    with pytest.raises(ValueError, match="path"):
        at_constant_load(HERTZ, 0.5)[0].with_(tangential_load=0.1)


# -- a mesh ---------------------------------------------------------------------------------------


def on_a_mesh(scene, points, n, answered=None):
    """(mean error of q over f p0, largest error of slip over the largest slip, worst misplaced end
    in elements) at each point; `answered` are the points of the answers, if others.
    """
    history = sie.follow(scene, sie.Path(answered or points))
    mesh = Mesh(history[0].edges, n, E)
    bound = F * history[0].pressure(mesh.x)
    q, slip, tau = np.zeros(n), np.zeros(n), 0.0
    errors = []
    for (_, Q, sigma), solution in zip(points, history, strict=True):
        q, moved = mesh.step(q, bound, Q, 2.0 * (0.25 * sigma - tau) / E)
        tau, slip = 0.25 * sigma, slip + moved
        stuck = mesh.x[moved == 0.0]
        lo, hi = solution.stick[0]
        ends = (
            max(abs(stuck.min() - 0.5 * mesh.h - lo), abs(stuck.max() + 0.5 * mesh.h - hi)) / mesh.h
        )
        scale = np.abs(solution.slip(mesh.x)).max() or 1.0
        errors.append(
            (
                np.abs(q - solution.shear(mesh.x)).mean() / bound.max(),
                np.abs(slip - solution.slip(mesh.x)).max() / scale,
                ends,
            )
        )
    return np.array(errors)


def mesh_error(scene, points, n):
    """The largest mean error of q over f p0 that a mesh explains, at each point.

    A step adds ±2 f p^, p^ = 0 at the ends of the stick zone. A mesh places each of them within an
    element, and is wrong there by at most what p^ is an element farther in, which p exceeds at the
    edge of contact. Steps add up.
    """
    solved = sie.solve(sie.Scene(**fields(scene)))
    x = np.linspace(*solved.edges, n + 1)
    beside = solved.pressure(x[[1, -2]]).sum() / solved.pressure(x).max()
    return np.arange(1, len(points) + 1) * 2.0 * beside / n


def shrinking(last, turns):
    """Every sequence of so many turning points, each well inside the one before: nothing is wiped
    out, where a mesh and a formula may take different sides.
    """
    inside = [k for k in range(1 - abs(last), abs(last)) if abs(last - k) > 2]
    return [[]] if turns == 0 else [[k, *rest] for k in inside for rest in shrinking(k, turns - 1)]


SHRINKING = [steps for turns in (2, 3, 4) for steps in shrinking(10, turns)]


# (scene, Q of a step over f P, σ of a step)
CASES = [
    (HERTZ, 0.08, 0.0), (PUNCH, 0.08, 0.0), (LOPSIDED, 0.08, 0.0),
    (HERTZ, 0.08, 0.006), (LOPSIDED, 0.08, 0.004),
    (HERTZ, 0.008, 0.15), (LOPSIDED, 0.008, 0.1), (PUNCH, 0.0, 0.05), (HERTZ, 0.0, 0.2),
]  # fmt: skip


@settings(max_examples=12)
@given(st.sampled_from(SHRINKING), st.sampled_from(CASES))
def test_random_histories_agree_with_a_mesh_to_its_error(steps, case):
    """Moderate and large bulk stress included; σ is in proportion to Q. First order: half the
    element, half the error.
    """
    scene, Q, sigma = case
    points = [(P, k * Q * FP, k * sigma) for k in steps]
    coarse, fine = on_a_mesh(scene, points, 100), on_a_mesh(scene, points, 400)
    for errors, n in ((coarse, 100), (fine, 400)):
        assert (errors[:, 0] < mesh_error(scene, points, n)).all()
        assert errors[:, 2].max() < 1.5
    assert fine[:, 0].mean() < 0.45 * coarse[:, 0].mean()
    # In a zone of a few elements the slip is known to few digits, on any mesh.
    assert fine[-1, 1] < 0.45 * coarse[-1, 1]


@pytest.mark.parametrize("part", [0.2, -0.5, 0.8])
def test_a_mesh_tells_a_stick_zone_that_ends_three_elements_off(part):
    """Hertz: c² = b² (1 - Q/f P)."""
    n, zone = 100, np.sqrt(1.0 - abs(part)) - 6.0 / 100
    wrong = np.copysign(1.0 - zone * zone, part)
    points, answered = [(P, part * FP, 0.0)], [(P, wrong * FP)]
    ((q, _, ends),) = on_a_mesh(HERTZ, points, n, answered)
    assert q > 2.0 * mesh_error(HERTZ, points, n)[0] and ends > 2.0


def test_large_bulk_stress_that_opens_both_zones_is_reached_by_any_number_of_steps():
    """The zones only grow: a mesh finds the same in 1 step and in 30."""
    Q, sigma = 0.16 * FP, 0.45
    solution = sie.solve(sie.Scene(**fields(HERTZ), tangential_load=Q, bulk_stress=sigma))
    assert solution.tangential.kind == "two signs" and solution.tangential.advancing
    mesh = Mesh(solution.edges, 200, E)
    bound = F * solution.pressure(mesh.x)
    for steps in (1, 30):
        q = np.zeros(200)
        for k in range(1, steps + 1):
            q, _ = mesh.step(q, bound, Q * k / steps, 2.0 * 0.25 * sigma / steps / E)
        assert np.abs(q - solution.shear(mesh.x)).mean() < 1e-3 * bound.max()


def test_where_zones_retreat_the_path_matters_and_the_certificate_notes_it():
    """In one step the mesh finds the state given; in proportion, in many, another one."""
    Q, sigma = 0.6 * FP, 0.5
    solution = sie.solve(sie.Scene(**fields(HERTZ), tangential_load=Q, bulk_stress=sigma))
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
    solution = sie.solve(sie.Scene(**fields(HERTZ), tangential_load=0.6 * FP, bulk_stress=sigma))

    def reports(*want):
        file = SceneFile(solution.scene, want=want)
        return summary(solution, file), " ".join(as_dict(solution, file)["notes"])

    assert all(
        ("retreat" in report) is (sigma != 0.0) for report in (*reports(), *reports("stress"))
    )
    assert not any("retreat" in report for report in reports("pressure"))


def test_normal_and_tangential_loads_that_change_together_agree_with_a_mesh():
    """Hertz: up and down in P and Q, in small steps on a mesh as wide as the widest contact."""
    points = [(0.3, 0.05), (0.36, 0.12), (0.28, 0.02), (0.28, -0.06), (0.34, -0.1), (0.34, 0.05)]
    errors = []
    for n, steps in ((80, 16), (240, 48)):
        mesh = Mesh((-np.sqrt(2 * 0.36 / np.pi), np.sqrt(2 * 0.36 / np.pi)), n, E)
        q, lost, before, worst = np.zeros(n), 0.0, None, 0.0
        for point, solution in zip(points, sie.follow(HERTZ, sie.Path(points)), strict=True):
            for load, Q in [point] if before is None else np.linspace(before, point, steps + 1)[1:]:
                b2 = 2 * load / np.pi  # E* = 2, R = 1
                bound = F * np.sqrt(np.maximum(b2 - mesh.x**2, 0.0))
                q, moved = mesh.step(q, bound, Q, 0.0)
                lost += mesh.h * float(np.abs(q * moved)[bound > 0.0].sum())
            before = point
            worst = max(worst, np.abs(q - solution.shear(mesh.x)).mean() / bound.max())
        errors.append((worst, abs(lost / solution.energy_lost - 1.0)))
    (coarse, _), (fine, energy) = errors
    assert fine < 0.5 * coarse < 1e-3
    assert energy < 2e-3


@pytest.mark.parametrize("part", [1e-17, 1e-25, 1e-50])
def test_the_energy_of_the_shortest_slip_zones_is_the_first_term_of_its_series(part):
    """f² P² (Q/f P)³/(3 π E*): the zones are shorter than the rounding of the load."""
    lost = at_constant_load(HERTZ, part)[0].energy_lost
    assert lost == pytest.approx(FP * FP * part**3 / (3.0 * np.pi * E), rel=1e-12)


@pytest.mark.parametrize(("length", "modulus"), [(1e60, 1e120), (1e-60, 1e-50), (1e100, 1e50)])
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


def test_the_energy_under_a_load_that_is_negligible_next_to_the_largest_is_refused_with_a_remedy():
    small = (1e-20, 1e-21)
    history = sie.follow(HERTZ, sie.Path([small, (P, 0.0)]))
    with pytest.raises(sie.LoadError, match="as a path of their own"):
        _ = history[0].energy_lost
    assert sie.follow(HERTZ, sie.Path([small]))[0].energy_lost > 0.0


@pytest.mark.parametrize("excess", [2.0**-55, 2.0**-54, 2.0**-53])
def test_a_load_that_rises_and_sticks_but_for_rounding_does_not_slip(excess):
    """|dQ| = f dP but for an ulp."""
    after = sie.follow(HERTZ, sie.Path([(0.75, 0.125 + excess), (1.0, 0.0)]))[1]
    assert after.tangential.slipped == ()
    assert after.stick == (after.edges,)
