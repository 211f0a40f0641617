"""Dissimilar bodies: full sliding (q = ±f p acts back on the pressure) and full stick (a bonded
flat punch).
"""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sliding_cases import RIM, SIMILAR, bonded, inside, slid

import analytic
import sie

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


def shift(coupling):
    return -math.atan(coupling) / math.pi


# -- closed forms ----------------------------------------------------------------------------------


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


# -- laws ------------------------------------------------------------------------------------------


GIVEN = (
    {"normal_load": 0.1},
    {"half_width": 1.3},
    {"normal_load": 0.1, "tilt": 0.002},
    {"normal_load": 0.1, "moment": 0.004},
)


@pytest.mark.slow(but=27)
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


@pytest.mark.parametrize("moment", [-2.0, 0.0, 3.5])
def test_the_tilt_of_a_bonded_punch_answers_the_moment(moment):
    solution = sie.solve(bonded(0.3, moment=moment))
    assert solution.pressure.moment == pytest.approx(moment, abs=1e-13)
    assert sie.solve(bonded(0.3, tilt=solution.tilt)).moment == pytest.approx(moment, abs=1e-13)
    assert solution.check().ok, solution.check()
