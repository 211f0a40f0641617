"""Many pieces: fast sums are the dense ones, batched formulas those of piece by piece, and memory
isn't pieces times points.
"""

import tracemalloc
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import sie
from oracles import normal_contact
from oracles.normal_contact import mp
from sie.certificate.quadrature import composite_rule
from sie.contact.edge_integrals import edge_integrals
from sie.numerics.cauchy_sums import LEAF, KernelSums
from sie.numerics.graded_rule import NODES
from sie.numerics.interval import Interval
from sie.profiles.slope import Slope
from sie.traction import panels, potential
from sie.traction.piece_quadrature import Geometry, SlidingGeometry

CONTACT = Interval(-1.01, 0.97)


def spline_slope(n, roughness=0.0, seed=0):
    """The slope of a spline through n + 1 points; rough ones have noise of that size on their
    heights.
    """
    x = np.linspace(-1.2, 1.3, n + 1)
    h = (
        np.cosh(x)
        - 1.0
        + 0.1 * x**3
        + roughness * np.random.default_rng(seed).standard_normal(n + 1)
    )
    c = CubicSpline(x, h).c
    return Slope(x, x[:-1], np.stack((c[2], 2.0 * c[1], 3.0 * c[0]), axis=1), np.full(n, 2))


def rows(kind, n, rng):
    ends = {
        "even": np.linspace(-1.0, 1.0, n + 1),
        "graded": np.append(0.0, np.geomspace(1e-12, 1.0, n)),
    }[kind]
    lo, length = ends[:-1], np.diff(ends)
    return (
        lo,
        length,
        length[:, None] * np.sort(rng.random((n, 9)), axis=1),
        rng.standard_normal((n, 9)),
    )


@pytest.mark.parametrize("kind", ["even", "graded"])
@pytest.mark.parametrize("n", [2, 3, 41, 1000])
@pytest.mark.parametrize("plane", [False, True], ids=["line", "plane"])
def test_far_sums_equal_the_dense_sum_to_rounding(kind, n, plane):
    rng = np.random.default_rng(n)
    lo, length, offset, charge = rows(kind, n, rng)
    z = np.concatenate(
        (rng.uniform(-1.5, 1.5, 60), rng.uniform(-30.0, 30.0, 20), 10.0 ** rng.uniform(-12, 0, 20))
    )
    z = z + 1j * 10.0 ** rng.uniform(-9, 1, len(z)) if plane else z
    far, k, i = KernelSums(lo, length, offset, charge).far(z)
    for j, at in enumerate(z):
        kernel = charge / ((lo - at)[:, None] + offset)
        kernel[k[i == j]] = 0.0
        assert abs(far[j] - kernel.sum()) <= 2e-15 * np.abs(kernel).sum()


def test_each_near_pair_is_left_out_once_and_no_other():
    rng = np.random.default_rng(0)
    lo, length, offset, charge = rows("even", 500, rng)
    z = rng.uniform(-1.2, 1.2, 300)
    _, k, i = KernelSums(lo, length, offset, charge).far(z)
    assert len(set(zip(k.tolist(), i.tolist(), strict=True))) == len(k)
    beside = np.abs(z[i] - (lo[k] + 0.5 * length[k])) <= 12.0 * length[k]
    assert beside.all()
    own = np.searchsorted(lo, z, side="right") - 1
    found = set(zip(k.tolist(), i.tolist(), strict=True))
    assert all((row, j) in found for j, row in enumerate(own.tolist()) if -1.0 <= z[j] <= 1.0)


@pytest.mark.parametrize("n", [100, 1000, 10_000])
def test_a_point_has_few_near_pieces_for_any_number_of_pieces(n):
    rng = np.random.default_rng(0)
    lo, length, offset, charge = rows("even", n, rng)
    _, k, _ = KernelSums(lo, length, offset, charge).far(rng.uniform(-1.0, 1.0, n))
    assert len(k) <= 3 * LEAF * n  # its own leaf and both beside it


def both_ways(monkeypatch, build, value):
    """The value by pairs and by a loop over the pieces."""
    out = []
    for many in (0, 10**9):
        monkeypatch.setattr(panels, "MANY", many)
        out.append(value(build()))
    return out


@pytest.mark.slow(but=3)
@pytest.mark.parametrize("n", [30, 200])
@pytest.mark.parametrize("epsilon", [0.0, 0.06], ids=["similar", "sliding"])
@pytest.mark.parametrize("roughness", [0.0, 1e-3], ids=["smooth", "rough"])
def test_pairs_give_the_values_of_piece_by_piece(n, epsilon, roughness, monkeypatch):
    """To the loop's rounding, which grows with the curvature of the pieces: the pairs have less, as
    the next test shows.
    """
    slope, rng = spline_slope(n, roughness), np.random.default_rng(1)
    beyond = 10.0 ** np.sort(rng.uniform(-13, 2, 60))
    x = np.sort(
        np.concatenate(
            (rng.uniform(-1.01, 0.97, 60), [-1.01, 0.97], slope.breaks[n // 2 : n // 2 + 4])
        )
    )

    def build():
        if epsilon:
            return panels.Panels(SlidingGeometry(slope, CONTACT, epsilon))
        return panels.Panels(Geometry(slope, CONTACT))

    inside, dense = both_ways(monkeypatch, build, lambda p: potential.on_contact(p, x))
    assert np.abs(inside - dense).max() <= (1e-13 if roughness else 1e-14) * np.abs(dense).max()
    edge = np.array([-1.01 + 1e-12, 0.97 - 1e-12])
    inside, dense = both_ways(monkeypatch, build, lambda p: potential.on_contact(p, edge))
    assert inside == pytest.approx(dense, rel=1e-13)
    for side in (0.97 + beyond, (-1.01 - beyond)[::-1]):
        (V, H), (V_dense, H_dense) = both_ways(
            monkeypatch, build, lambda p, x=side: potential.beside(p, x)
        )
        cos = np.cos(np.pi * epsilon)
        assert (
            np.abs((V - V_dense) - np.pi / cos * (H - H_dense)).max()
            <= 2e-14 * np.abs(V_dense - np.pi / cos * H_dense).max()
        )
    z = x + 1j * 10.0 ** rng.uniform(-14, 2, len(x))
    plane, dense = both_ways(monkeypatch, build, lambda p: potential.upper(p, z)[0])
    assert (np.abs(plane - dense) <= 2e-14 * np.abs(dense)).all()


@pytest.mark.slow
def test_pairs_of_a_rough_spline_are_exact_to_rounding():
    slope = spline_slope(200, 1e-3)
    exact = ExactSpline(slope, CONTACT.x1, CONTACT.x2)
    x = np.random.default_rng(2).uniform(-1.01, 0.97, 8)
    # π p/G of smooth edges
    found = potential.on_contact(panels.Panels(Geometry(slope, CONTACT)), x)
    assert found == pytest.approx(
        [float(exact.pressure(at, mp.pi)) for at in x], abs=1e-14 * np.abs(found).max()
    )


def test_a_loop_over_pieces_is_never_entered_with_many(monkeypatch):
    monkeypatch.setattr(potential, "_ranges", None)
    monkeypatch.setattr(potential, "_regions", None)
    p = panels.Panels(Geometry(spline_slope(300), CONTACT))
    assert np.isfinite(potential.on_contact(p, np.linspace(-1.0, 0.9, 50))).all()
    assert np.isfinite(potential.upper(p, np.linspace(-1.0, 0.9, 50) + 0.1j)).all()


def test_jumps_of_a_slope_of_many_pieces_are_infinite_where_they_are():
    """A staircase of wedges: upward jumps at every tenth break."""
    n = 60
    breaks = np.linspace(-2.0, 2.0, n + 1)
    rows = [(0.125 * (k // 10), 1.0) for k in range(n)]
    mean = np.mean([c for c, _ in rows])
    profile = sie.Piecewise(breaks, [(c - mean, s) for c, s in rows])
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, half_width=1.0))
    x1, x2 = solution.edges
    jumps = [b for k, b in enumerate(breaks[1:-1], 1) if k % 10 == 0 and x1 < b < x2]
    assert jumps and np.isinf(solution.pressure(jumps)).all()
    assert np.isfinite(
        solution.pressure([b for b in breaks if x1 < b < x2 and b not in jumps])
    ).all()


def test_moments_with_short_rules_are_those_of_long_ones(monkeypatch):
    slope = spline_slope(2000, 1e-4)
    short = edge_integrals(slope, CONTACT)
    monkeypatch.setattr("sie.contact.edge_integrals.MANY", 10**9)
    long = edge_integrals(slope, CONTACT)
    scale = long.positive + long.negative
    assert short[:3] == pytest.approx(long[:3], abs=1e-15 * scale)
    assert short[3:5] == pytest.approx(long[3:5], rel=1e-13)


class ExactSpline:
    """A slope of parabolas and its contact in 40 digits: Gauss-Legendre in φ on every piece, where
    12 nodes leave 1e-36.

    p(x) = G/π w(x) ∫ (H(t) - H(x)) / (t - x) dφ, with H = H_k on piece k: a polynomial quotient,
    and (H_k(x) - H(x)) ∫ dφ / (t - x), whose antiderivative is ln |sin((φ - φx)/2) / cos((φ +
    φx)/2)| / w(x).
    """

    def __init__(self, slope, x1, x2):
        x1, x2 = mp.mpf(x1), mp.mpf(x2)
        self.m, self.r = (x1 + x2) / 2, (x2 - x1) / 2
        # Ends, their angles, origin, coefficients, and the nodes (t, sin φ, weight)
        self.pieces = []
        g, w = normal_contact.gauss_legendre(12)
        rows = zip(
            pairwise(slope.breaks.tolist()),
            slope.origins.tolist(),
            slope.coefficients.tolist(),
            strict=True,
        )
        for (lo, hi), origin, c in rows:
            A, B = max(mp.mpf(lo), x1), min(mp.mpf(hi), x2)
            if A < B:
                a, b = mp.asin((A - self.m) / self.r), mp.asin((B - self.m) / self.r)
                sines = [mp.sin(a + (b - a) * node) for node in g]
                nodes = [
                    (self.m + self.r * s, s, (b - a) * weight)
                    for s, weight in zip(sines, w, strict=True)
                ]
                self.pieces.append((A, B, a, b, mp.mpf(origin), [mp.mpf(v) for v in c], nodes))

    @staticmethod
    def value(origin, c, t):
        return c[0] + (t - origin) * (c[1] + (t - origin) * c[2])

    def integrals(self):
        """∫ H dφ, which is zero, and r ∫ H sin φ dφ, which is P/G."""
        rows = [(self.value(o, c, t), s, w) for *_, o, c, nodes in self.pieces for t, s, w in nodes]
        return mp.fsum(w * H for H, _, w in rows), self.r * mp.fsum(w * H * s for H, s, w in rows)

    def pressure(self, x, G):
        x = mp.mpf(x)
        angle = mp.asin((x - self.m) / self.r)
        w = self.r * mp.cos(angle)
        H = next(self.value(o, c, x) for A, B, *_, o, c, _ in self.pieces if A <= x < B)

        def log(phi):
            return mp.log(abs(mp.sin((phi - angle) / 2) / mp.cos((phi + angle) / 2)))

        total = mp.zero
        for A, B, a, b, o, c, nodes in self.pieces:
            total += sum(weight * (c[1] + c[2] * (t + x - 2 * o)) for t, _, weight in nodes)
            rest = self.value(o, c, x) - H
            if not A <= x < B and rest:
                total += rest / w * (log(b) - log(a))
        return G / mp.pi * w * total


@pytest.mark.slow
def test_a_spline_through_a_thousand_samples_has_its_exact_pressure():
    """The promise is 1e-11. The edges are tried by the conditions that they meet, whose slopes in r
    are of the size of H.
    """
    x = np.linspace(-1.5, 1.6, 1000)
    profile = sie.Sampled(x, np.cosh(x) - 1.0 + 0.1 * x**3 + 0.05 * np.abs(x) ** 3)
    solution = sie.solve(sie.Scene(profile=profile, modulus=1.0, normal_load=0.5))
    truth = ExactSpline(profile.pieces, *solution.edges)
    balance, load = truth.integrals()
    assert abs(balance) <= 1e-14
    assert float(load) * 0.5 == pytest.approx(0.5, rel=1e-14)
    x1, x2 = solution.edges
    at = np.array([x1 + 1e-3, -0.3, float(x[500]) + 1e-9, 0.123456, x2 - 1e-3])
    exact = np.array([float(truth.pressure(v, mp.mpf(0.5))) for v in at])
    assert solution.pressure(at) == pytest.approx(exact, rel=2e-13)


def test_memory_is_not_the_product_of_pieces_and_points():
    p = panels.Panels(Geometry(spline_slope(10_000), CONTACT))
    x = np.linspace(-1.0, 0.9, 10_000)
    tracemalloc.start()
    potential.on_contact(p, x)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10_000 * 10_000 * 8 / 8


def test_the_certificate_of_many_pieces_detects_a_wrong_pressure(monkeypatch):
    x = np.linspace(-2.0, 2.2, 400)
    scene = sie.Scene(
        profile=sie.Sampled(x, x * x / 2 + 0.05 * x**3 + 0.01 * x**4), modulus=1.0, normal_load=1.0
    )
    assert sie.solve(scene).check().error < 1e-14
    right = potential._difference
    monkeypatch.setattr(potential, "_difference", lambda *args: right(*args) * (1.0 + 1e-9))
    found = sie.solve(scene).check()
    assert not found.ok and found.error > 1e-11


def test_the_certificate_s_rule_integrates_the_logarithms_of_corners_of_many_kinds():
    """∫ (x-e)^(m+1) ln|x-e| over the contact, at a break where the m-th derivative of the slope
    jumps.
    """
    n = 64
    breaks = np.linspace(-2.0, 2.0, n + 1)
    for m in (0, 1, 2):
        e = breaks[30]
        c = np.zeros((n, 3))
        c[:, 0], c[:, 1] = breaks[:-1], 1.0
        for k in range(30, n):
            # the polynomial (t - e)^m about each piece's own origin
            c[k, : m + 1] += (
                np.polynomial.polynomial.polyfromroots([e - breaks[k]] * m) if m else 1.0
            )
        slope = Slope(breaks, breaks[:-1], c, np.full(n, 2))
        rule = composite_rule(Interval(-1.0, 1.1), slope)
        exact = sum(
            s ** (m + 1) * d ** (m + 2) * (np.log(d) / (m + 2) - 1.0 / (m + 2) ** 2)
            for s, d in ((1, 1.1 - e), (-1, 1.0 + e))
        )
        distance = np.abs(rule.x - e)
        values = (rule.x - e) ** (m + 1) * np.log(np.where(distance == 0.0, 1.0, distance))
        assert rule.weight @ values == pytest.approx(exact, abs=1e-14)


def test_panels_of_the_rule_are_few_where_nothing_jumps():
    rule = composite_rule(CONTACT, spline_slope(3000))
    pieces = sum(CONTACT.x1 < b < CONTACT.x2 for b, _ in pairwise(spline_slope(3000).breaks))
    assert len(rule.x) <= 4 * pieces * NODES


def chained(pieces, jump, **more):
    """A slope of straight pieces through x + 0.3 x³, with small jumps if wanted."""
    x = np.linspace(-1.0, 1.0, pieces + 1)
    H = x + 0.3 * x**3
    steep = np.diff(H) / np.diff(x)
    rows = np.stack((H[:-1] - steep * x[:-1] + jump * x[:-1], steep), axis=1)
    return sie.Scene(
        profile=sie.Piecewise(x.tolist(), rows.tolist()), modulus=2.0, normal_load=0.5, **more
    )


def test_the_stress_next_to_a_flat_between_two_jumps_is_that_of_a_loop(monkeypatch):
    """The flat pieces are left out, so that the pieces on both sides of them do not meet."""
    breaks = np.linspace(-2.0, 2.0, 61)
    middles = 0.5 * (breaks[1:] + breaks[:-1])
    rows = [(0.0, 0.0) if abs(m) < 0.04 else (m + 0.3 * np.sign(m), 0.3) for m in middles]
    scene = sie.Scene(profile=sie.Piecewise(breaks, rows), modulus=1.0, half_width=1.2)
    z = np.linspace(-0.2, 0.2, 41) + 1j * np.geomspace(1e-3, 0.1, 5)[:, None]
    _, dF = sie.solve(scene).pressure.potentials(z)
    monkeypatch.setattr(panels, "MANY", 10**9)
    _, dF_looped = sie.solve(scene).pressure.potentials(z)
    assert (np.abs(dF - dF_looped) <= 1e-13 * np.abs(dF_looped)).all()


@pytest.mark.parametrize("jump", [0.0, 1e-3])
@pytest.mark.parametrize(
    "more", [{}, {"dundurs": 0.2, "friction": 1.5, "sliding": 1}], ids=["similar", "dissimilar"]
)
def test_both_potentials_are_those_of_a_loop_over_the_pieces(jump, more, monkeypatch):
    scene = chained(150, jump, **more)
    batched = sie.solve(scene)
    rng = np.random.default_rng(7)
    z = batched.centre + batched.half_width * (
        rng.uniform(-1.5, 1.5, 500) + 1j * 10.0 ** rng.uniform(-10.0, 1.0, 500)
    )
    F, dF = batched.pressure.potentials(z)
    monkeypatch.setattr(panels, "MANY", 10**9)
    F_looped, dF_looped = sie.solve(scene).pressure.potentials(z)
    assert np.abs(F - F_looped).max() <= 1e-14 * np.abs(F_looped).max()
    assert (np.abs(dF - dF_looped) <= 1e-13 * np.abs(dF_looped)).all()


def test_where_a_function_was_split_p_is_that_of_the_closed_forms():
    """Its two series miss each other by 3e-15 there, and L_e = -36: p was off by 2.4e-14."""
    parts = [sie.Parabola(5.6974532625325), sie.Power(2.122394723090034, 0.41882542797476685)]
    contact = {"modulus": 1.0, "half_width": 1.1}
    p = sie.solve(sie.Scene(profile=parts[0] + parts[1], **contact)).pressure
    closed = [sie.solve(sie.Scene(profile=part, **contact)).pressure for part in parts]
    split = np.array([b for b in p.breaks if 1e-3 < abs(b) < 1.1])
    assert len(split) >= 10
    assert 0.55 in split
    beside = 10.0 ** np.arange(-16.0, -1.0)
    x = np.outer(split, np.concatenate(([1.0], 1.0 + beside, 1.0 - beside)))
    exact = closed[0](x) + closed[1](x)
    assert np.abs(p(x) - exact).max() <= 6e-15 * exact.max()  # 3e-15 was measured, everywhere


@pytest.mark.parametrize("coupling", [0.3, -0.49])
def test_where_the_slope_of_sliding_is_split_p_is_that_of_the_closed_form(coupling):
    R, w, e = 3.0, 1.1, -np.arctan(coupling) / np.pi
    scene = sie.Scene(
        profile=sie.Parabola(R), modulus=2.0, dundurs=coupling, friction=1.0, sliding=1,
        half_width=w,
    )  # fmt: skip
    p = sie.solve(scene).pressure
    (split,) = p.panels.geometry.ends[1, :-1]
    x = split + np.concatenate(([0.0], 10.0 ** np.arange(-16.0, 0.0)))
    exact = np.cos(np.pi * e) / R * (w * (1 + 2 * e) - x) ** (0.5 - e)
    exact *= (w * (1 - 2 * e) + x) ** (0.5 + e)
    # 5e-16 was measured, and 2.5e-15 with the logarithm of the two pieces
    assert np.abs(p(x) - exact).max() <= 1.2e-15 * exact.max()
