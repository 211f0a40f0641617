"""What the certificate promises: no error far above its estimate, nothing unseen in a function."""

import math

import numpy as np
import pytest

import sie
from oracles import normal_contact
from oracles.normal_contact import mp
from sie.certificate import result
from sie.certificate.result import BESIDES, PROMISE
from sie.contact import normal

SHARE = 3.0  # of the promise
SLIGHT = 1e-15  # of the peak


def solved(profile, load=0.3, **given):
    loads = {} if "half_width" in given else {"normal_load": load}
    return sie.solve(sie.Scene(profile=profile, modulus=1.0, **loads, **given))


def pressed(slope, load=0.3, **given):
    return solved(sie.FromFunction(slope, **given), load)


def bound(certificate, distance):
    """The promise, at a distance from an edge in half-widths, over the peak."""
    return np.maximum(SHARE * (certificate.error + certificate.edges / np.sqrt(distance)), SLIGHT)


INF = mp.inf
PIECES = ((0.5, 2.0), (0.0625, 0.25), (-1.9375, 4.25))
RIM = mp.mpf(0.3)  # as the profile has it
# The profile, its breaks and pieces exactly, the load and the tilt.
CASES = {
    "rounded flat": (
        sie.RoundedFlat(0.3, 2.0),
        ((-INF, -RIM, RIM, INF), ((RIM / 2, mp.mpf(0.5)), (mp.zero,), (-RIM / 2, mp.mpf(0.5)))),
        0.1,
        0.0,
    ),
    "tilted": (sie.Parabola(1.0), ((-INF, INF), ((0.0, 1.0),)), 0.01, 0.17),
    "uneven": (
        sie.Piecewise((-0.25, 0.5), PIECES), ((-INF, -0.25, 0.5, INF), PIECES), 0.3, -0.03
    ),
    "cubic": (
        sie.Polynomial((0.0, 0.0, 0.1, 0.1, 1.0)), ((-INF, INF), ((0.0, 0.2, 0.3, 4.0),)), 0.05, 0.0
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_the_error_given_the_load_keeps_the_promise_up_to_the_edges(name):
    profile, (breaks, rows), load, tilt = CASES[name]
    solution = solved(profile, load, tilt=tilt)
    truth = normal_contact.contact(
        normal_contact.polynomials(breaks, rows).tilted(tilt), 1.0, solution.edges, load=load
    )
    x1, x2, r = float(truth.x1), float(truth.x2), float(truth.r)
    away = r * np.array([1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 0.3, 0.9])
    x = np.concatenate((x1 + away, x2 - away))
    x = x[(x > x1) & (x < x2)]
    expected = [truth.pressure(v) for v in x.tolist()]
    found = solution.check()
    assert found.ok
    for v, p, e in zip(x.tolist(), solution.pressure(x).tolist(), expected, strict=True):
        distance = float(min(mp.mpf(v) - truth.x1, truth.x2 - mp.mpf(v)) / truth.r)
        assert abs(float(mp.mpf(p) - e)) <= bound(found, distance) * float(max(expected))


def test_the_error_by_the_edges_is_neither_zero_nor_far_too_large():
    """An edge is known to an ulp of the load times its condition: p(x) δ/(2 d) is wrong."""
    found = solved(sie.RoundedFlat(0.3, 2.0), 0.1).check()
    assert 1e-17 < found.edges < 1e-14


def test_edges_far_from_x_0_are_known_better_than_to_an_ulp_of_x():
    """A thousand half-widths from x = 0 doubles are 1e-13 r apart; what they miss is kept."""
    profile = sie.Parabola(1.0).shifted(1000.3)
    found = solved(profile).check()
    assert found.edges < 0.1 * math.ulp(1000.3)
    assert found.ok


X = np.arange(-32.0, 33.0) / 16.0  # squares and cubes of which are doubles
LEVEL = 30.0 + 2.0**-13


def _with_level(level):
    """Profiles whose slope is `level` and a small one, in doubles without rounding."""
    small = ([level, 2e-3], [level, 1e-3], [level, 3e-3])
    pieces, shape = sie.Piecewise([-1.0, 1.0], small), X**2 / 1024 + X**3 / 4096
    half = sie.Piecewise([-0.5], [[0.75 * level, 1e-3], [0.75 * level, 2e-3]])
    return {
        "pieces": pieces,
        "sum": half + sie.Parabola(1024.0).shifted(0.25) + sie.Polynomial([0, 0.25 * level, 1e-4]),
        "trace": sie.Sampled(X, level * X + shape),
    }


@pytest.mark.parametrize("kind", _with_level(0.0))
def test_a_slope_that_a_tilt_cancels_costs_no_digits_that_the_certificate_does_not_show(kind):
    """With the slope 30.0001 and the tilt -30.0001 + 1e-4 it is the contact of the slope 1e-4."""
    rest = 2.0**-13
    tilted = sie.Scene(
        profile=_with_level(LEVEL)[kind], modulus=1.0, half_width=0.5, tilt=rest - LEVEL
    )
    level = sie.Scene(profile=_with_level(0.0)[kind], modulus=1.0, half_width=0.5, tilt=rest)
    one, other = sie.solve(tilted), sie.solve(level)
    found = one.check()
    assert found.ok
    x = other.centre + 0.5 * np.linspace(-0.99, 0.99, 41)
    error = np.abs(one.pressure(x) - other.pressure(x)).max() / other.pressure(x).max()
    assert error <= 3.0 * (found.error + 10.0 * found.edges)
    np.testing.assert_allclose(one.edges, other.edges, rtol=0.0, atol=1e-14)


def test_the_same_promise_is_printed_and_documented():
    found = solved(sie.Parabola(1.0)).check()
    assert PROMISE in " ".join(str(found).split())
    assert f"{PROMISE} {BESIDES}" in " ".join(result.Certificate.__doc__.split())
    for nearer in (1.0, 1e2, 1e4):
        assert f"{3.0 * (found.error + found.edges * nearer**0.5):.1e}" in str(found)


def test_a_rounded_edge_between_two_doubles_is_not_certified():
    """It is 1e-50 wide: rounding of x would explain any defect."""
    found = solved(sie.RoundedFlat(1.0, 1e-150), 1.0).check()
    assert not found.ok
    assert "NOT certified to 1e-13" in str(found)


AT = 0.21337
UNDECLARED = {
    "jump": (lambda x: x + 0.3 * np.sign(x - 0.2), (0.2,)),
    "small jump": (lambda x: x + 0.001 * np.sign(x + 0.37), (-0.37,)),
    "kink": (lambda x: x + 0.7 * np.maximum(x - 0.03199622862669049, 0.0), (0.03199622862669049,)),
    "cusp": (lambda x: x + 0.3 * np.sign(x - AT) * np.abs(x - AT) ** 0.3, (AT,)),
    "narrow bump": (
        lambda x: x + 1e-5 * np.exp(-(((x - 0.3137) / 1e-4) ** 2)),
        tuple(0.3137 + 1e-4 * np.arange(-8, 9)),
    ),
    "faint bump": (
        lambda x: x + 1e-9 * np.exp(-(((x + AT) / 3e-3) ** 2)),
        tuple(-AT + 3e-3 * np.arange(-8, 9)),
    ),
}


@pytest.mark.slow(but=3)
@pytest.mark.parametrize("load", [0.3, 0.2871])
@pytest.mark.parametrize("name", UNDECLARED)
def test_undeclared_features_are_found_and_resolved(name, load):
    slope, breaks = UNDECLARED[name]
    found, declared = pressed(slope, load), pressed(slope, load, breaks=breaks)
    (x1, x2), r = declared.edges, declared.half_width
    assert found.edges == pytest.approx(declared.edges, abs=1e-14 * r)
    x = np.linspace(x1 + 0.01 * r, x2 - 0.01 * r, 2001)
    x = x[np.abs(x[:, None] - np.array(breaks)).min(axis=1) > 1e-5]
    assert found.pressure(x) == pytest.approx(
        declared.pressure(x), abs=3e-14 * float(declared.pressure(x).max())
    )
    assert found.check().ok


@pytest.mark.parametrize("name", ["narrow bump", "faint bump"])
def test_the_certificate_detects_a_feature_that_the_solver_missed(name, monkeypatch):
    """The solver does not test between its points: the certificate does, at points of its own."""
    slope, breaks = UNDECLARED[name]
    right = pressed(slope, breaks=breaks)
    monkeypatch.setattr(normal, "LOOKS", 0)
    blind = pressed(slope)
    x = np.linspace(-0.95, 0.95, 4001) * right.half_width + right.centre
    error = float(np.abs(blind.pressure(x) - right.pressure(x)).max() / right.pressure(x).max())
    found = blind.check()
    assert error > 1e-10
    assert not found.ok
    assert found.error >= error / SHARE


@pytest.mark.slow(but=2)
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("part", [3e-3, 1.7e-4, 1.9e-5, 1e-6, 1.3e-8])
def test_a_kink_just_inside_an_edge_is_found(part, side):
    """All that it changes lies between it and the edge; a declared one is known exactly."""
    b = side * math.sqrt(1.2 / math.pi) * (1.0 - part)

    def slope(x):
        return x + 0.05 * side * np.maximum(side * (x - b), 0.0)

    found, declared = pressed(slope), pressed(slope, breaks=(b,))
    lo, hi = declared.edges
    angle = np.linspace(0.0, math.pi, 402)[1:-1]
    x = 0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(angle)
    p, q = found.pressure(x), declared.pressure(x)
    promised = bound(found.check(), 1.0 - np.abs(np.cos(angle)))
    assert (np.abs(p - q) <= 2.0 * promised * q.max()).all()


def test_nan_on_a_thousandth_of_the_contact_is_refused_where_it_is():
    with pytest.raises(ValueError, match=r"slope returned nan at x = 0\.(299|300)"):
        pressed(lambda x: np.where(np.abs(x - 0.3) < 1e-3, np.nan, x)).pressure(0.0)


def test_a_slope_that_returns_a_list_of_the_right_shape_is_a_function_all_the_same():
    assert pressed(lambda x: [*x]).half_width == pytest.approx(
        pressed(lambda x: x).half_width, rel=1e-15
    )


@pytest.mark.parametrize("corner", [0.0, -1e-30, -2.1426e-288, 5e-324])
def test_equilibrium_at_a_corner_next_to_x_0_is_measured_to_rounding(corner):
    """A node that rounding puts at x = 0 takes ln 1e-288 for the logarithm of its distance."""
    profile = sie.Piecewise((-math.inf, corner, math.inf), ((-0.487, 0.2), (0.513, 0.2)))
    scene = sie.Scene(
        profile=profile, modulus=2.0, dundurs=-5e-6, friction=2.0, sliding=1, normal_load=1e-3
    )
    certificate = sie.solve(scene).check()
    assert certificate.force < 4e-15  # a few roundings of 1000 values; 4e-16 was measured
    assert certificate.moment < 4e-15


def test_steep_slopes_carry_a_note_and_are_certified_all_the_same():
    found = solved(sie.Parabola(1.0), half_width=50.0).check()
    assert found.ok
    assert (
        "slope in the contact reaches 50; above 0.2 half-plane elasticity (small strains) is "
        "outside its range" in found.notes[0]
    )
    assert "pressure reaches 25 E*" in found.notes[1]
    assert found.as_dict()["notes"] == list(found.notes)
    assert all(note in str(found) for note in found.notes)


def test_small_slopes_and_pressures_carry_no_note():
    solution = solved(sie.RoundedFlat(1.0, 100.0), half_width=2.0)
    assert solution.notes == solution.check().notes == ()


@pytest.mark.parametrize(("load", "noted"), [(0.01, False), (0.1, True)])
@pytest.mark.parametrize(
    "given", [{}, {"friction": math.inf, "dundurs": 0.05}], ids=["frictionless", "bonded"]
)
def test_next_to_a_sharp_edge_the_pressure_that_counts_is_a_thousandth_of_r_away(
    load, noted, given
):
    """Where it is infinite some pressure exceeds any bound."""
    solution = solved(sie.Flat(1.0), load, **given)
    assert bool(solution.notes) is noted


@pytest.mark.parametrize("tol", [1e-3, 1e-6, 1e-9])
def test_a_function_resolved_to_a_coarse_tolerance_is_answered_to_it(tol):
    """The error of a coarse resolution is not taken for a feature that it missed."""
    wave = sie.FromFunction(
        lambda x: np.sin(2.0 * np.arctan(x)) / (1.0 + x * x), domain=(-2.0, 2.0), parity="even"
    )
    coarse, fine = (
        sie.solve(sie.Scene(profile=wave, modulus=1.0, half_width=0.5), tol=t) for t in (tol, 1e-13)
    )
    x = np.linspace(-0.49, 0.49, 101)
    assert not coarse.normal.seen
    assert np.abs(coarse.pressure(x) - fine.pressure(x)).max() <= tol * fine.pressure(x).max()


PAIR = {
    "profile": sie.Parabola(50.0),
    "body": sie.Elastic(115e3, 0.32),
    "indenter": sie.Elastic(210e3, 0.3),
    "normal_load": 100.0,
}


LIKE = {"dundurs": 0}
GOODMAN = {"coupling": "goodman"}
ROUGH = {"friction": 0.5}
NEGLECTED = [
    (True, LIKE | ROUGH | {"tangential_load": 10.0}),
    *((True, pair | ROUGH | loads) for pair in (LIKE, GOODMAN) for loads in ({}, {"sliding": 1})),
    (False, LIKE | ROUGH | {"indenter": PAIR["body"], "tangential_load": 10.0}),
    *((False, given) for given in (LIKE, GOODMAN, ROUGH)),
]


@pytest.mark.parametrize(("neglected", "given"), NEGLECTED)
def test_what_is_neglected_of_dissimilar_bodies_is_a_note(neglected, given):
    solution = sie.solve(sie.Scene(**PAIR | given))
    assert len(solution.notes) == neglected
    for note in solution.notes:
        assert "is neglected" in note or "is left out" in note
        assert note in solution.check().notes and note in str(solution.check())


@pytest.mark.parametrize("load", [7e-12, 7e-30, 7e-50, 7e-76])
def test_a_certificate_whose_sums_rounding_of_x_decides_says_what_is_known(load):
    """Beside a flat base the rim of a light contact is narrower than doubles are apart."""
    profile = sie.RoundedFlat(0.5, 2.0)
    solution = solved(profile, load)
    found = solution.check()
    said = any("One ulp of x" in note for note in found.notes)
    assert found.ok != said
    assert said == (load < 1e-40)
    # P = 2 E* sqrt(2 a) rim^(3/2)/(3 R), to leading order in rim/a
    contact = solution.normal.edges.contact
    assert (contact.x2 - 0.5) + contact.tail2 == pytest.approx((3.0 * load) ** (2 / 3), rel=1e-7)
