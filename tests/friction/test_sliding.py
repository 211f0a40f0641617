"""Dissimilar bodies in full sliding, and in full stick under a flat punch."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sliding_cases import RIM, SIMILAR, bonded, inside, slid

import sie
from analytic import bonded_flat, sliding_flat, sliding_hertz, sliding_rounded_flat

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


@pytest.mark.parametrize("coupling", COUPLINGS)
def test_the_sliding_parabola_of_both_packages(coupling):
    R, w = 3.0, 1.1
    solution = slid(sie.Parabola(R), coupling, half_width=w)
    closed = {"half_width": w, "radius": R, "modulus": 2.0, "coupling": coupling}
    edges = sliding_hertz.edges(half_width=w, coupling=coupling)
    assert solution.edges == pytest.approx([float(x) for x in edges], rel=1e-14)
    assert solution.normal_load == pytest.approx(float(sliding_hertz.load(**closed)), rel=1e-14)
    x = inside(solution)
    assert solution.pressure(x) == pytest.approx(sliding_hertz.pressure(x, **closed), rel=1e-11)


@pytest.mark.parametrize("coupling", COUPLINGS)
@pytest.mark.parametrize("tilt", [0.0, 0.05, -0.12])
def test_the_sliding_flat_of_both_packages(coupling, tilt):
    solution = slid(sie.Flat(1.5), coupling, normal_load=2.0, tilt=tilt)
    assert solution.sharp == (True, True)
    closed = {"half_width": 1.5, "normal_load": 2.0, "coupling": coupling}
    closed["moment"] = solution.moment
    x = 1.5 * np.linspace(-0.999, 0.999, 201)
    assert solution.pressure(x) == pytest.approx(sliding_flat.pressure(x, **closed), rel=1e-11)
    found = float(sliding_flat.tilt(**closed, modulus=2.0))
    assert found == pytest.approx(tilt, rel=1e-11, abs=1e-13)


@pytest.mark.parametrize("half_flat", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("coupling", [0.3, -0.3, 0.1])
def test_the_sliding_rounded_punch_of_both_packages(coupling, half_flat):
    P, R = 0.1, 50.0
    solution = slid(sie.RoundedFlat(half_flat, R), coupling, normal_load=P)
    closed = {"half_flat": half_flat, "radius": R, "modulus": 2.0, "coupling": coupling}
    closed["normal_load"] = P
    rims, contact = sliding_rounded_flat.rims(**closed), solution.normal.edges.contact
    found = [-half_flat - contact.x1 - contact.tail1, contact.x2 - half_flat + contact.tail2]
    assert found == pytest.approx([float(r) for r in rims], rel=1e-12)
    x = inside(solution)
    exact = sliding_rounded_flat.pressure(x, **closed)
    # Nearer to it the rounding of the edge to a double is the difference.
    middle = np.abs(x - solution.centre) < 0.999 * solution.half_width
    assert solution.pressure(x)[middle] == pytest.approx(exact[middle], rel=1e-12)
    moment = float(sliding_rounded_flat.moment(**closed))
    assert solution.moment == pytest.approx(moment, rel=1e-12)


@pytest.mark.parametrize("beta", [0.3, -0.2, 0.0, 0.49])
def test_the_bonded_flat_of_both_packages(beta):
    b, P, Q = 2.0, 5.0, -2.0
    solution, x = sie.solve(bonded(beta, P, Q, b)), np.linspace(-1.99, 1.99, 101)
    closed = {"half_width": b, "normal_load": P, "shear_load": Q, "dundurs": beta}
    moment = solution.moment
    for found, form in (
        (solution.pressure, bonded_flat.pressure),
        (solution.shear, bonded_flat.shear),
    ):
        exact = form(x, **closed, moment=moment)
        assert found(x) == pytest.approx(exact, abs=1e-13 * np.abs(exact).max())
    loads = solution.pressure.resultant, solution.shear.resultant
    assert loads == pytest.approx((P, Q), rel=1e-14)
    assert solution.tilt == 0.0 and solution.check().ok


@pytest.mark.parametrize("beta", [0.4, -0.4])
@pytest.mark.parametrize(
    "given",
    [{"tangential_load": 0.1, "friction": math.inf}, {"sliding": 1, "friction": 0.7}],
    ids=str,
)
def test_at_a_sharp_edge_of_dissimilar_bodies_stresses_are_infinite_and_the_load_to_yield_vanishes(
    beta, given
):
    """Pressure and the shear's Hilbert transform are both infinite: their difference is no nan."""
    pair = {"modulus": 3.0, "dundurs": beta, "poisson": 0.3}
    solution = sie.solve(sie.Scene(profile=sie.Flat(2.0), normal_load=0.2, **pair, **given))
    stress = solution.stress([-2.0, 2.0], 0.0)
    assert (
        np.abs([stress.xx, stress.yy, stress.xy, stress.mises, stress.in_plane_sum]) == np.inf
    ).all()
    assert solution.elastic_limit().load == 0.0


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
    other = one.with_(profile=PROFILES[name].mirrored(), sliding=-1, tilt=-0.001)
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
