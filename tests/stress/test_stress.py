"""The stress in the body: 40-digit references and the laws of elasticity."""

from functools import cache

import numpy as np
import pytest
import strategies
from hypothesis import given
from stress_cases import PUNCH, SCENES, SHARP, STEEL, F, sliding

import sie
from oracles import half_plane_stress
from oracles.normal_contact import mp
from validation.cases import SMOOTH_CASES, exact, solved

DEPTHS = (1e-10, 1e-6, 1e-2, 1.0, 1e3)
KINDS = ("parabola", "rounded", "sinh", "corners", "two radii", "blunt", "cubic", "six", "|x|^2.5")
REFERENCED = [next(c for c in reversed(SMOOTH_CASES) if c.name == kind) for kind in KINDS]
EVERY = pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)


def peak(solution):
    x1, x2 = solution.edges
    p = solution.pressure(np.linspace(x1, x2, 2003)[1:-1])
    return float(p[np.isfinite(p)].max())


@cache
def places(case):
    """Abscissae of a case, and the same ones with the edges beyond double precision."""
    solution, truth = solved(case), exact(case)
    (x1, x2), r, m = solution.edges, solution.half_width, solution.centre
    inner = [b for b in case.profile.breaks if x1 < b < x2]
    return [(x, mp.mpf(x)) for x in (m + 0.31 * r, x2 + 0.4 * r, *inner[:2])] + [
        (x1, truth.x1),
        (x2, truth.x2),
    ]


@pytest.mark.slow(but=15)
@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("case", REFERENCED, ids=str)
def test_every_component_agrees_with_forty_digits_under_kinks_and_edges_too(case, depth):
    solution = sliding(case.scene, bulk_stress=0.25)
    y = depth * solution.half_width
    for x, x_exact in places(case):
        truth, found = (
            half_plane_stress.stresses(exact(case), x_exact, y, F, bulk=0.25),
            solution.stress(x, y),
        )
        for component in ("xx", "yy", "xy"):
            error = float(mp.mpf(float(getattr(found, component))) - getattr(truth, component))
            assert abs(error) <= 1e-13 * peak(solution), (component, x)


SHEARED = {
    "profile": sie.RoundedFlat(0.5, 1.0),
    "modulus": 1.0,
    "normal_load": 0.3,
    "friction": 0.4,
}


def shear(**given):
    return sie.solve(sie.Scene(**{**SHEARED, **given})).shear


TRACTIONS = {
    "pressure": sie.solve(PUNCH).pressure,
    "sharp edges": sie.solve(SHARP).pressure,
    "slip of one sign": shear(tangential_load=0.09),
    "slip of both signs": shear(tangential_load=0.03, bulk_stress=0.5),
    "slip of both signs, mirrored": shear(tangential_load=-0.03, bulk_stress=-2.0),
    "after a path": sie.follow(sie.Scene(**SHEARED), sie.Path([(0.3, 0.1), (0.3, -0.05)]))[1].shear,
    "dissimilar, pressed": shear(dundurs=0.2),
    "dissimilar, sliding": shear(dundurs=0.2, sliding=1),
    "bonded": shear(profile=sie.Flat(1.0), dundurs=0.3, friction=np.inf),
}


@pytest.mark.parametrize("density", TRACTIONS.values(), ids=TRACTIONS)
def test_the_derivative_of_a_potential_is_its_derivative(density):
    """By Cauchy's formula on a circle that stays within the body."""
    x1, x2 = density.interval
    m, r, omega = 0.5 * (x1 + x2), 0.5 * (x2 - x1), np.exp(2j * np.pi * np.arange(32) / 32)
    for w in (0.3 + 0.2j, -0.9 + 0.05j, 1.01 + 0.03j, -1.3 + 0.4j, 0.1 + 2j, 20 + 9j, 0.6 - 0.1j):
        z, radius = m + r * w, 0.3 * r * w.imag
        around = density.cauchy(z + radius * omega)
        slope, bound = (around / omega).mean() / radius, 1e-13 * np.abs(around).max() / abs(radius)
        assert density.cauchy_derivative(z) == pytest.approx(slope, rel=1e-11, abs=bound)


def derivatives(function, x, y, span):
    """(∂/∂x, ∂/∂y) of analytic functions by Chebyshev interpolation in a cross about (x, y)."""
    nodes = np.polynomial.chebyshev.chebpts1(20)

    def slope(values):
        c = np.polynomial.chebyshev.chebfit(nodes, values, 19)
        return np.polynomial.chebyshev.chebval(0.0, np.polynomial.chebyshev.chebder(c)) / span

    return slope(function(x + span * nodes, y)), slope(function(x, y + span * nodes))


@EVERY
@pytest.mark.parametrize("at", [(0.0, 0.5), (0.9, 0.03), (-1.3, 0.2), (4.0, 7.0)])
def test_the_stress_is_in_equilibrium_and_compatible(scene, at):
    solution = sliding(scene, bulk_stress=3.0) if scene is not SHARP else sliding(scene)
    r, m = solution.half_width, solution.centre
    x, y, span = m + at[0] * r, at[1] * r, 0.25 * at[1] * r
    stress = solution.stress
    xx_x, _ = derivatives(lambda x, y: stress(x, y).xx, x, y, span)
    xy_x, xy_y = derivatives(lambda x, y: stress(x, y).xy, x, y, span)
    _, yy_y = derivatives(lambda x, y: stress(x, y).yy, x, y, span)
    scale = peak(solution) / y
    assert abs(xx_x + xy_y) <= 1e-11 * scale
    assert abs(xy_x + yy_y) <= 1e-11 * scale
    # compatibility: σ_xx + σ_yy is harmonic, the mean over a circle is its value at the centre
    turn = 2 * np.pi * np.arange(64) / 64
    ring = stress(x + 0.5 * y * np.cos(turn), y + 0.5 * y * np.sin(turn)).in_plane_sum
    assert ring.mean() == pytest.approx(
        float(stress(x, y).in_plane_sum), abs=1e-13 * peak(solution)
    )


@EVERY
def test_strains_are_those_of_the_displacement_gradients_and_rotations_are_theirs_too(scene):
    if scene.body is None:
        scene = sie.Scene(profile=scene.profile, body=STEEL, half_width=1.0)
    solution = sliding(scene)
    r = solution.half_width
    x, y = solution.centre + 0.4 * r, 0.3 * r
    g, e = solution.stress(x, y).gradients, solution.stress(x, y).strain
    scale = peak(solution) / STEEL.young
    assert (g.xx, g.yy, g.xy + g.yx) == pytest.approx((e.xx, e.yy, 2 * e.xy))
    # the gradients of one displacement: ∂y (u_x,x) = ∂x (u_x,y), ∂y (u_y,x) = ∂x (u_y,y)
    of = {
        name: derivatives(
            lambda x, y, name=name: getattr(solution.stress(x, y).gradients, name), x, y, 0.2 * y
        )
        for name in ("xx", "xy", "yx", "yy")
    }
    assert of["xx"][1] == pytest.approx(of["xy"][0], abs=1e-10 * scale / y)
    assert of["yx"][1] == pytest.approx(of["yy"][0], abs=1e-10 * scale / y)


@given(strategies.scenes(sharp=False), strategies.between(0.0, 0.8))
def test_the_surface_bears_the_tractions(scene, friction):
    solution = sliding(scene, friction) if scene.moment is None else sie.solve(scene)
    (x1, x2), r = solution.edges, solution.half_width
    x = np.linspace(x1 - r, x2 + r, 41)
    surface = solution.surface_stress(x)
    p, q = solution.pressure(x), solution.shear(x)
    finite = np.isfinite(p)
    assert np.abs(surface.yy[finite] + p[finite]).max() <= 1e-15 * (
        peak(solution) + np.abs(surface.xx[finite]).max()
    )
    assert (surface.xy == -q).all()
    below = solution.stress(x, 1e-14 * r)
    marks = np.array([x1, x2, *(b for b in scene.profile.breaks if np.isfinite(b))])
    near = finite & (np.abs(x[:, None] - marks).min(axis=1) > 0.01 * r)
    for name in ("xx", "yy", "xy"):
        assert np.abs(
            getattr(below, name)[near] - getattr(surface, name)[near]
        ).max() <= 1e-10 * peak(solution)


@EVERY
@pytest.mark.parametrize("radius", [1.2, 3.0, 1e4])
def test_a_half_circle_carries_the_load(scene, radius):
    solution = sliding(scene)
    nodes, weights = np.polynomial.legendre.leggauss(120)
    angle = 0.5 * np.pi * (nodes + 1.0)
    nx, ny, R = np.cos(angle), np.sin(angle), radius * solution.half_width
    s = solution.stress(solution.centre + R * nx, R * ny)
    ds = 0.5 * np.pi * R * weights
    P, Q = solution.normal_load, solution.shear.resultant
    assert -(ds * (s.xx * nx + s.xy * ny)).sum() == pytest.approx(Q, abs=2e-13 * P)
    assert -(ds * (s.xy * nx + s.yy * ny)).sum() == pytest.approx(P, rel=2e-13)


@EVERY
def test_far_away_the_stress_depends_on_the_resultant_only(scene):
    """Flamant: σ_rr = -2/(πr) (P sin θ + Q cos θ) about the line of action, but for 1/r³."""
    solution = sliding(scene)
    P, Q = solution.normal_load, solution.shear.resultant
    origin = solution.moment / P
    angle = np.linspace(0.0, np.pi, 9)
    for distance in (1e3, 1e6):
        R = distance * solution.half_width
        y = R * np.sin(angle)
        y[-1] = 0.0
        s = solution.stress(origin + R * np.cos(angle), y)
        radial = s.xx * np.cos(angle) ** 2 + s.yy * np.sin(angle) ** 2 + s.xy * np.sin(2 * angle)
        flamant = -2.0 / (np.pi * R) * (P * np.sin(angle) + Q * np.cos(angle))
        assert (
            np.abs(radial - flamant).max() <= (20.0 / distance**2 + 2e-15) * np.abs(flamant).max()
        )


def test_a_stress_unpacks_into_its_components():
    s = sliding(PUNCH).stress([0.1, 0.5], 0.2)
    xx, yy, xy, zz = s
    assert (xx == s.xx).all() and (yy == s.yy).all() and (xy == s.xy).all() and (zz == s.zz).all()


def test_bulk_stress_is_added_along_the_surface_only():
    solution = sliding(PUNCH)
    x, y = np.array([0.1, 0.5, 7.0]), np.array([0.2, 0.0, 30.0])
    plain, pulled = solution.stress(x, y), solution.with_(bulk_stress=0.5).stress(x, y)
    assert pulled.xx - plain.xx == pytest.approx(0.5)
    assert pulled.yy == pytest.approx(plain.yy, abs=1e-15) and (pulled.xy == plain.xy).all()
    assert pulled.zz - plain.zz == pytest.approx(0.15)


@pytest.mark.parametrize("depth", [1e-100, 1e-291])
def test_the_stress_below_the_middle_of_a_patch_tends_to_that_on_the_surface(depth):
    """The root of a patch is that of its edges, however near its middle is."""
    profile = sie.Periodic(sie.Parabola(40.0), 1.5)
    solution = sie.solve(sie.Scene(profile=profile, modulus=1e5, poisson=0.3, normal_load=10.0))
    near, surface = solution.stress(0.0, depth), solution.stress(0.0, 0.0)
    np.testing.assert_allclose([near.xx, near.yy], [surface.xx, surface.yy], rtol=1e-12)
