"""Dissimilar bodies: full sliding (q = ±f p acts back on the pressure) and full stick (a bonded
flat punch).
"""

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import analytic
import sie
from sie.numerics.interval import Interval
from sie.profiles.slope import Slope
from sie.traction.piece_quadrature import SlidingGeometry

SIMILAR = {"modulus": 2.0}
RIM = sie.RoundedFlat(half_flat=1.0, radius=50.0)
PROFILES = {
    "parabola": sie.Parabola(3.0),
    "rounded flat": RIM,
    "wedge": sie.Wedge(0.1),
    "power": sie.Power(2.5, 0.1),
    "catenary": sie.FromFunction(slope=np.sinh),
    "corners of every kind": RIM + sie.Wedge(0.01).shifted(0.3),
    "thin rim": sie.RoundedFlat(half_flat=1.0, radius=1e4),
}
COUPLINGS = (0.3, -0.3, 0.49, 1e-3)


def slid(profile, coupling, **given):
    """Full sliding in +x with β f = coupling."""
    return sie.solve(
        sie.Scene(
            profile=profile, **SIMILAR, dundurs=0.5 * coupling, friction=2.0, sliding=1, **given
        )
    )


def shift(coupling):
    return -math.atan(coupling) / math.pi


def inside(solution, n=201):
    x1, x2 = solution.edges
    return (
        solution.centre + solution.half_width * np.cos((np.arange(n) + 0.5) * np.pi / n)
        if x1 < x2
        else None
    )


# -- closed forms ---------------------------------------------------------------------------------


@pytest.mark.parametrize("coupling", COUPLINGS)
def test_sliding_hertz(coupling):
    R, w, e = 3.0, 1.1, shift(coupling)
    solution = slid(sie.Parabola(R), coupling, half_width=w)
    c1, c2 = w * (1 - 2 * e), w * (1 + 2 * e)
    assert solution.edges == pytest.approx((-c1, c2), rel=1e-14)
    assert solution.normal_load == pytest.approx(
        math.pi * 2.0 * w * w * (0.25 - e * e) / R, rel=1e-14
    )
    x = inside(solution)
    assert solution.pressure(x) == pytest.approx(
        2.0 * math.cos(math.pi * e) / (2 * R) * (c2 - x) ** (0.5 - e) * (c1 + x) ** (0.5 + e),
        rel=1e-11,
    )


@pytest.mark.parametrize("coupling", COUPLINGS)
def test_sliding_flat(coupling):
    b, P, e = 1.0, 2.0, shift(coupling)
    solution = slid(sie.Flat(b), coupling, normal_load=P)
    x = np.linspace(-0.999, 0.999, 201)
    assert solution.pressure(x) == pytest.approx(
        P * math.cos(math.pi * e) / math.pi * (b - x) ** (-0.5 - e) * (b + x) ** (-0.5 + e),
        rel=1e-13,
    )
    assert solution.moment == pytest.approx(2 * e * P * b, rel=1e-13)


@pytest.mark.parametrize("coupling", [0.3, -0.15])
def test_rounded_punch_against_principal_value_quadrature_with_thirty_digits(coupling):
    """Both edges satisfy their conditions, and p is the inversion formula of Muskhelishvili §
    110.
    """
    a, R = 1.0, 50.0
    solution = slid(RIM, coupling, half_width=1.3)
    mp = mpmath.mp.clone()
    mp.dps = 30
    e, half = -mp.atan(mp.mpf(coupling)) / mp.pi, mp.mpf(1) / 2
    x1, x2 = map(mp.mpf, solution.edges)

    def over_rims(f):
        """∫ H f / w over both rims, the edges' powers taken away by t = edge ± u^4."""
        total = mp.mpf(0)
        for edge, sign in ((x1, 1), (x2, -1)):
            length = -sign * edge - a

            def integrand(u, edge=edge, sign=sign):
                near = u**4
                t = edge + sign * near
                far = (x2 - x1) - near
                left, right = (near, far) if sign > 0 else (far, near)
                H_over_w = (t + sign * a) / R * left ** (-half - e) * right ** (e - half)
                return H_over_w * f(t) * 4 * u**3

            total += mp.quad(integrand, mp.linspace(0, mp.root(length, 4), 5))
        return total

    c = mp.cos(mp.pi * e)
    assert abs(over_rims(lambda t: 1)) < 1e-14 * abs(over_rims(lambda t: t))
    # E*/2 = 1
    assert solution.normal_load == pytest.approx(float(c * over_rims(lambda t: t)), rel=1e-14)
    for x in (-0.9, 0.0, 0.75, 0.999):  # on the flat, where no principal value is needed
        root = (x - x1) ** (half + e) * (x2 - x) ** (half - e)
        p = c**2 / mp.pi * root * over_rims(lambda t, x=x: 1 / (t - mp.mpf(x)))
        assert float(solution.pressure(x)) == pytest.approx(float(p), rel=1e-12)


@pytest.mark.parametrize("half_flat", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("coupling", [0.3, -0.3, 0.1])
def test_the_sliding_rounded_punch_of_both_packages(coupling, half_flat):
    P, R = 0.1, 50.0
    solution = slid(sie.RoundedFlat(half_flat, R), coupling, normal_load=P)
    closed = {
        "half_flat": half_flat,
        "radius": R,
        "modulus": 2.0,
        "coupling": coupling,
        "normal_load": P,
    }
    rims = analytic.dissimilar.sliding_rounded_flat.rims(**closed)
    contact = solution.normal.edges.contact
    assert [
        -half_flat - contact.x1 - contact.tail1,
        contact.x2 - half_flat + contact.tail2,
    ] == pytest.approx([float(r) for r in rims], rel=1e-12)
    x = inside(solution)
    exact = analytic.dissimilar.sliding_rounded_flat.pressure(x, **closed)
    # Nearer to it the rounding of the edge to a double is the difference.
    middle = np.abs(x - solution.centre) < 0.999 * solution.half_width
    assert solution.pressure(x)[middle] == pytest.approx(exact[middle], rel=1e-12)
    assert solution.moment == pytest.approx(
        float(analytic.dissimilar.sliding_rounded_flat.moment(**closed)), rel=1e-12
    )


@pytest.mark.parametrize("beta", [0.3, -0.2, 0.0, 0.49])
def test_bonded_flat(beta):
    b, P, Q, eta = 2.0, 5.0, -2.0, math.atanh(beta) / math.pi
    solution = sie.solve(bonded(beta, P, Q, b))
    x = np.linspace(-1.99, 1.99, 101)
    exact = (
        (P + 1j * Q)
        / math.pi
        * math.cosh(math.pi * eta)
        * (b * b - x * x) ** -0.5
        * np.exp(1j * eta * np.log((b + x) / (b - x)))
    )
    assert solution.pressure(x) + 1j * solution.shear(x) == pytest.approx(exact, rel=1e-13)
    assert (solution.pressure.resultant, solution.shear.resultant) == pytest.approx(
        (P, Q), rel=1e-14
    )
    assert solution.tilt == 0.0
    assert solution.check().ok, solution.check()


def bonded(beta, P=5.0, Q=2.0, b=2.0, **given):
    return sie.Scene(
        profile=sie.Flat(b),
        modulus=3.0,
        dundurs=beta,
        friction=math.inf,
        normal_load=P,
        tangential_load=Q,
        **given,
    )


@pytest.mark.parametrize("beta", [0.4, -0.4])
@pytest.mark.parametrize(
    "given",
    [{"tangential_load": 0.1, "friction": math.inf}, {"sliding": 1, "friction": 0.7}],
    ids=str,
)
def test_at_a_sharp_edge_of_dissimilar_bodies_stresses_are_infinite_and_the_load_to_yield_vanishes(
    beta, given
):
    """Pressure and the shear's Hilbert transform are both infinite there: their difference is no
    nan.
    """
    solution = sie.solve(
        sie.Scene(
            profile=sie.Flat(2.0), modulus=3.0, dundurs=beta, poisson=0.3, normal_load=0.2, **given
        )
    )
    stress = solution.stress([-2.0, 2.0], 0.0)
    assert (
        np.abs([stress.xx, stress.yy, stress.xy, stress.mises, stress.in_plane_sum]) == np.inf
    ).all()
    assert solution.elastic_limit().load == 0.0


# -- laws -----------------------------------------------------------------------------------------

GIVEN = (
    {"normal_load": 0.1},
    {"half_width": 1.3},
    {"normal_load": 0.1, "tilt": 0.002},
    {"normal_load": 0.1, "moment": 0.004},
)


@pytest.mark.parametrize("given", GIVEN, ids=str)
@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("coupling", [0.3, -0.49])
def test_every_profile_is_certified(name, coupling, given):
    solution = slid(PROFILES[name], coupling, **given)
    certificate = solution.check()
    assert certificate.ok, certificate
    for what, value in given.items():
        assert getattr(solution, what) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("name", PROFILES)
def test_the_mirror_image_slides_the_other_way(name):
    one = slid(PROFILES[name], 0.3, normal_load=0.1, tilt=0.001)
    scene = one.scene
    other = sie.solve(
        sie.Scene(
            profile=scene.profile.mirrored(),
            modulus=2.0,
            dundurs=0.15,
            friction=2.0,
            sliding=-1,
            normal_load=0.1,
            tilt=-0.001,
        )
    )
    x = inside(one, 31)
    assert other.edges == pytest.approx((-one.edges[1], -one.edges[0]), rel=1e-12)
    assert other.pressure(-x) == pytest.approx(
        one.pressure(x), rel=1e-10, abs=1e-13 * one.pressure(0.0)
    )
    assert other.shear.resultant == -one.shear.resultant == -2.0 * 0.1


@pytest.mark.parametrize("name", [n for n in PROFILES if n != "thin rim"])
def test_a_vanishing_coupling_leaves_the_pressure_of_similar_bodies(name):
    similar = sie.solve(sie.Scene(profile=PROFILES[name], **SIMILAR, normal_load=0.1))
    coupled = slid(PROFILES[name], 1e-12, normal_load=0.1)
    x = similar.centre + 0.99 * similar.half_width * np.linspace(-1, 1, 41)
    assert coupled.edges == pytest.approx(similar.edges, rel=1e-10)
    finite = np.isfinite(similar.pressure(x))
    assert coupled.pressure(x)[finite] == pytest.approx(similar.pressure(x)[finite], rel=1e-10)


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("coupling", [0.3, -0.49])
def test_plemelj_and_the_far_field(name, coupling):
    p = slid(PROFILES[name], coupling, normal_load=0.1).pressure
    x1, x2 = p.interval
    x = x1 + (x2 - x1) * np.array([0.01, 0.2, 0.6, 0.99])
    above, below, between = p.cauchy(x, +1), p.cauchy(x, -1), p.cauchy(x, 0)
    assert above - below == pytest.approx(-2j * p(x), rel=1e-13)
    assert between.real == pytest.approx(p.hilbert(x), rel=1e-13)
    r = 0.5 * (x2 - x1)
    near = p.cauchy(x + 1e-13j * r)
    assert near == pytest.approx(above, abs=2e-11 * float(np.abs(above).max()))
    z = 1e6 * r * np.exp(1j * np.array([0.1, 1.0, 2.0, 3.0]))
    assert z * p.cauchy(z) == pytest.approx((p.resultant + p.moment / z) / math.pi, rel=1e-11)


@settings(deadline=None, max_examples=20)
@given(
    breaks=st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=4, unique_by=lambda b: round(b, 2)),
    coupling=st.floats(-0.49, 0.49).filter(lambda c: abs(c) > 1e-6),
    load=st.floats(1e-3, 10.0),
)
@example(
    breaks=[-0.9999999999999999, 1.1125369292536007e-308, 0.9999999999999999],
    coupling=0.48460092629331114,
    load=1e-3,
)
@example(breaks=[-2.142599941379084e-288], coupling=-1e-5, load=1e-3)
def test_random_convex_chains_are_certified(breaks, coupling, load):
    slopes = np.linspace(-0.5, 0.5, len(breaks) + 1) + 0.013
    ends = [-math.inf, *sorted(breaks), math.inf]
    solution = slid(
        sie.Piecewise(ends, [[float(s), 0.2] for s in slopes]), coupling, normal_load=load
    )
    assert solution.check().ok, solution.check()
    assert solution.pressure.resultant == pytest.approx(load, rel=1e-13)


@pytest.mark.parametrize("distance", [1e-3, 1e-30, 1e-200, 1.1e-308, 5e-324])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("e", [0.144, -0.144, -3e-6])
def test_dt_over_w_is_exact_on_pieces_that_end_next_to_an_edge(e, side, distance):
    """∫ dt/w from an edge is the incomplete beta function of the distance from it over 2r."""
    ends = np.sort(side * np.array([-math.inf, -1.5, 0.0, math.inf]))
    slope = Slope(ends, np.zeros(3), np.ones((3, 1)), np.zeros(3, dtype=np.int64))
    pieces = SlidingGeometry(slope, Interval(*sorted((-3.0 * side, distance * side))), e)

    def from_edge(b):
        from_it, half = mpmath.mpf(distance) - side * b, mpmath.mpf(0.5)
        share = from_it / (mpmath.mpf(distance) + 3)
        return mpmath.betainc(half + side * e, half - side * e, 0, share)

    exact = [float(abs(from_edge(hi) - from_edge(lo))) for lo, hi in pieces.ends.T.tolist()]
    # an ulp of a distance near the least double is more
    least = math.ulp(distance) / distance
    assert pieces.totals == pytest.approx(exact, rel=4e-15 + least)  # 4e-16 was measured
    assert pieces.totals.sum() == pytest.approx(sum(exact), rel=4e-15)


@pytest.mark.parametrize("moment", [-2.0, 0.0, 3.5])
def test_the_tilt_of_a_bonded_punch_answers_the_moment(moment):
    solution = sie.solve(bonded(0.3, moment=moment))
    assert solution.pressure.moment == pytest.approx(moment, abs=1e-13)
    assert sie.solve(bonded(0.3, tilt=solution.tilt)).moment == pytest.approx(moment, abs=1e-13)
    assert solution.check().ok, solution.check()


# -- what is said about it ------------------------------------------------------------------------


def test_shear_is_friction_times_pressure_and_nothing_is_solved_for_it():
    solution = slid(RIM, 0.3, normal_load=0.1)
    x = inside(solution, 11)
    assert solution.shear(x) == pytest.approx(2.0 * solution.pressure(x), rel=1e-15)
    assert solution.tangential_load == 0.2
    assert set(vars(solution)) >= {"normal", "pressure"}


def test_a_tangential_load_of_f_times_p_is_full_sliding():
    given = sie.Scene(
        profile=RIM, **SIMILAR, dundurs=0.1, friction=0.3, normal_load=0.1, tangential_load=-0.03
    )
    said = sie.Scene(profile=RIM, **SIMILAR, dundurs=0.1, friction=0.3, normal_load=0.1, sliding=-1)
    assert sie.solve(given).edges == sie.solve(said).edges


def test_a_change_of_direction_is_a_new_contact_and_a_change_of_nothing_is_not():
    solution = slid(RIM, 0.3, normal_load=0.1)
    edges = solution.edges
    assert "normal" in vars(solution.with_(tangential_load=0.2, sliding=0))
    assert solution.with_(sliding=-1).edges == pytest.approx((-edges[1], -edges[0]), rel=1e-13)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (
            sie.Scene(profile=RIM, **SIMILAR, dundurs=0.2, normal_load=0.1),
            "f = 0: no shear acts back",
        ),
        (
            sie.Scene(
                profile=RIM, **SIMILAR, dundurs=0.2, friction=0.5, sliding=1, normal_load=0.1
            ),
            "exponents 1/2 ±",
        ),
        (sie.Scene(profile=RIM, **SIMILAR, friction=0.5, sliding=1, normal_load=0.1), "uncoupled"),
        (bonded(0.3), "1/2 ± iη"),
    ],
)
def test_the_plan_says_how_pressure_and_shear_are_coupled(scene, words):
    assert words in str(sie.plan(scene))


PAIR = {
    "body": sie.Elastic(young=115e3, poisson=0.32),
    "indenter": sie.Elastic(young=210e3, poisson=0.3),
}


@pytest.mark.parametrize(
    "loads",
    [
        {"bulk_stress": 200.0},
        {"tangential_load": 30.0, "bulk_stress": 20.0},
    ],
)
def test_the_remedy_for_dissimilar_bodies_keeps_all_but_their_coupling(loads):
    """Followed, it is the contact of bodies with β = 0 whose E* and whose strain under the bulk
    stress are those of the scene.
    """
    scene = sie.Scene(profile=sie.Parabola(50.0), **PAIR, friction=0.4, normal_load=200.0, **loads)
    with pytest.raises(sie.ContactError, match="give dundurs = 0") as refusal:
        sie.solve(scene)
    assert f"{scene.beta:.4g}" in str(refusal.value)
    followed = sie.solve(replace(scene, dundurs=0))
    body, indenter = ((1.0 - e.poisson**2) / e.young for e in PAIR.values())
    assert followed.scene.Estar == pytest.approx(1.0 / (body + indenter), rel=1e-15)
    # The strain of the body in plane strain; E*/2 times it is balanced by the shear.
    strain = loads.get("bulk_stress", 0.0) * body
    similar = {name: value for name, value in loads.items() if name != "bulk_stress"} | {
        "bulk_stress": 2.0 * strain / (body + indenter)
    }
    same = sie.solve(
        sie.Scene(
            profile=sie.Parabola(50.0),
            modulus=scene.Estar,
            friction=0.4,
            normal_load=200.0,
            **similar,
        )
    )
    assert followed.energy_lost == pytest.approx(same.energy_lost, rel=1e-12)
    assert np.array(followed.stick) == pytest.approx(np.array(same.stick), rel=1e-12)
    assert followed.check().ok
    x = np.array([-0.9, 0.1, 1.3]) * followed.half_width
    assert followed.surface_stress(x).xx - same.surface_stress(x).xx == pytest.approx(
        followed.scene.bulk_stress - same.scene.bulk_stress, abs=1e-9
    )


def test_bodies_that_differ_by_rounding_are_similar():
    body, indenter = (
        sie.Elastic(210e3, 0.3),
        sie.Elastic(210e3 * (1.0 + 1e-15), 0.30000000000000004),
    )
    one = sie.Scene(
        profile=sie.Parabola(50.0),
        body=body,
        indenter=indenter,
        friction=0.3,
        normal_load=200.0,
        tangential_load=30.0,
    )
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


def test_another_beta_than_that_of_the_bodies_is_refused():
    with pytest.raises(ValueError, match=r"dundurs = 0\.1 follows .* or give 0"):
        sie.Scene(profile=RIM, **PAIR, dundurs=0.1, normal_load=1.0)


def test_a_changed_beta_changes_a_bonded_punch():
    first = sie.solve(bonded(0.1))
    _ = first.pressure(0.5)
    assert first.with_(dundurs=0.3).pressure(0.5) == sie.solve(bonded(0.3)).pressure(0.5)


def test_full_stick_is_for_flat_punches():
    with pytest.raises(sie.ContactError, match="full stick"):
        _ = sie.solve(sie.Scene(profile=RIM, **SIMILAR, friction=math.inf, normal_load=0.1)).edges


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"sliding": 2, "friction": 0.1}, "sliding = 2"),
        ({"sliding": 1}, "without friction"),
        ({"sliding": 1, "friction": 0.1, "tangential_load": 0.1}, "both sliding"),
        ({"sliding": 1, "friction": math.inf}, "infinite friction"),
    ],
)
def test_contradictory_sliding_is_refused(given, words):
    with pytest.raises(ValueError, match=words):
        sie.Scene(profile=RIM, **SIMILAR, normal_load=0.1, **given)


@pytest.mark.parametrize("coupling", COUPLINGS)
@pytest.mark.parametrize("tilt", [0.05, -0.12])
def test_a_tilted_flat_that_slides_on_both_its_edges_carries_its_load(coupling, tilt):
    """p times the roots of its singular ends is a straight line c0 + c1 s of s = x/b.

    The means of s and s² under (1 - s)^(-1/2-ε) (1 + s)^(-1/2+ε), whose integral is π/cos πε, are
    2ε and 1/2 + 2ε² (a beta distribution).
    """
    b, P, e = 1.5, 2.0, shift(coupling)
    solution = slid(sie.Flat(b), coupling, normal_load=P, tilt=tilt)
    assert solution.sharp == (True, True)
    s = np.array([-0.8, 0.1, 0.9])
    line = solution.pressure(b * s) * (1.0 - s) ** (0.5 + e) * (1.0 + s) ** (0.5 - e)
    c1 = (line[2] - line[0]) / (s[2] - s[0])
    c0 = line[0] - c1 * s[0]
    assert line[1] == pytest.approx(c0 + c1 * s[1], rel=1e-12)
    whole = np.pi / np.cos(np.pi * e)
    assert b * whole * (c0 + 2.0 * e * c1) == pytest.approx(P, rel=1e-12)
    assert b * b * whole * (2.0 * e * c0 + (0.5 + 2.0 * e * e) * c1) == pytest.approx(
        solution.moment, rel=1e-11, abs=1e-12 * P * b
    )
