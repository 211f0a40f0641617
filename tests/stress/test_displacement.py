"""The displacement in both bodies: closed forms, the strains, the gap and the slip, any gauge."""

import mpmath
import numpy as np
import pytest

import sie

STEEL, TITANIUM = sie.Elastic(210e3, 0.3), sie.Elastic(110e3, 0.33)
FEET = sie.Row([sie.Parabola(50.0).shifted(-0.5), sie.Parabola(40.0).shifted(0.5)])
SHEARED = {"friction": 0.3, "tangential_load": 80.0}
GIVEN = {
    "Hertz": {"profile": sie.Parabola(50.0)},
    "rounded flat, Q and bulk stress": {
        "profile": sie.RoundedFlat(1.0, 50.0),
        "bulk_stress": 30.0,
        **SHEARED,
    },
    "tilted": {"profile": sie.RoundedFlat(1.0, 50.0), "moment": 60.0, **SHEARED},
    "sharp edges": {"profile": sie.Flat(1.0)},
    "wedge": {"profile": sie.Wedge(0.01)},
    "two patches": {"profile": FEET, **SHEARED},
    "sharp edges between smooth ones": {
        "profile": sie.Row(
            [sie.Parabola(50.0).shifted(-2.0), sie.Flat(0.5), sie.Parabola(50.0).shifted(2.0)]
        ),
        "normal_load": 5000.0,
    },
    "per period": {"profile": sie.Periodic(sie.Parabola(50.0), 2.0)},
    "full stick": {
        "profile": sie.Flat(1.0),
        "indenter": sie.RIGID,
        "friction": np.inf,
        "tangential_load": 100.0,
    },
    "dissimilar": {"profile": sie.Parabola(50.0), "indenter": TITANIUM, **SHEARED},
}
SOLVED = {
    name: sie.solve(sie.Scene(**{"body": STEEL, "normal_load": 500.0, **given}))
    for name, given in GIVEN.items()
}
EVERY = pytest.mark.parametrize("solution", SOLVED.values(), ids=SOLVED)
mp = mpmath.mp.clone()
mp.dps = 30


def mc_ewen(x, y, b, p0):
    """σ_xx and σ_yy below Hertz's pressure (McEwen 1949; Johnson 1985, eq. (4.49))."""
    s = b**2 - x**2 + y**2
    root = mp.sqrt(s**2 + 4 * x**2 * y**2)
    m, n = mp.sqrt((root + s) / 2), mp.sign(x) * mp.sqrt((root - s) / 2)
    quotient = (y**2 + n**2) / (m**2 + n**2)
    return -p0 / b * (m * (1 + quotient) - 2 * y), -p0 / b * m * (1 - quotient)


def test_the_displacement_below_hertz_is_the_integral_of_mc_ewens_strains():
    solution = SOLVED["Hertz"]
    b, E, nu = mp.mpf(solution.half_width), mp.mpf(210e3), mp.mpf(3) / 10
    p0 = 2 * mp.mpf(500) / (mp.pi * b)

    def strains(x, y):
        xx, yy = mc_ewen(x, y, b, p0)
        flat = 1 - nu**2, nu * (1 + nu)
        return (flat[0] * xx - flat[1] * yy) / E, (flat[0] * yy - flat[1] * xx) / E

    def reached(x, y):
        """From the surface's middle: along the axis of symmetry, where u_x = 0, then along x."""
        down = mp.quad(lambda t: strains(mp.mpf(0), t)[1], [y, 5 * b, 10 * b])
        return mp.quad(lambda t: strains(t, y)[0], [0, x]), -down

    largest = float(abs(solution.displacement(0.0, 0.0).y))
    for x, y in ((0.4, 0.3), (1.7, 0.05), (2.5, 3.0)):
        along, _ = reached(x * b, y * b)
        u = solution.displacement(x * float(b), y * float(b))
        assert abs(float(along) - u.x) < 1e-13 * largest
    for y in (0.01, 0.3, 2.0):
        _, down = reached(mp.mpf(0), y * b)
        u = solution.displacement(0.0, y * float(b), zero=(0.0, 10.0 * float(b)))
        assert abs(float(down) - u.y) < 1e-13 * largest


@EVERY
def test_its_derivatives_are_those_of_the_stress(solution):
    rng = np.random.default_rng(1)
    b = solution.half_width
    x = solution.centre + rng.uniform(-2.0, 2.0, 100) * b
    y = 10.0 ** rng.uniform(-1.0, 0.5, 100) * b
    h = 2e-4 * y
    right, left = solution.displacement(x + h, y), solution.displacement(x - h, y)
    low, high = solution.displacement(x, y + h), solution.displacement(x, y - h)
    of_x, of_y = (1.0, -1.0) * np.array([right.x, left.x]).T, (low.y - high.y) / (2.0 * h)
    found = (
        (of_x.sum(axis=1) / (2.0 * h), of_y),
        ((low.x - high.x) / (2.0 * h), (right.y - left.y) / (2.0 * h)),
    )
    g = solution.stress(x, y).gradients
    largest = max(np.abs(part).max() for part in g)
    for numbers, exact in zip((*found[0], *found[1]), (g.xx, g.yy, g.xy, g.yx), strict=True):
        assert np.abs(numbers - exact).max() < 1e-7 * largest


@EVERY
def test_the_surfaces_are_apart_by_the_gap_and_the_profile(solution):
    b, scene = solution.half_width, solution.scene
    x = np.append(solution.centre + b * np.linspace(-1.7, 1.7, 200), np.ravel(solution.patches))
    body, indenter = (solution.displacement(x, 0.0 * x, name) for name in ("body", "indenter"))
    height, gap = scene.profile.height(x), solution.gap(x)
    known = np.isfinite(gap)
    apart = (body.y - indenter.y)[known] - (gap[known] - height[known])
    tol = 1e-11 if scene.coupled else 1e-13
    assert np.abs(apart).max() < tol * np.abs(body.y).max()


@pytest.mark.parametrize("name", ["rounded flat, Q and bulk stress", "tilted", "two patches"])
def test_the_surfaces_of_similar_bodies_are_apart_by_the_slip(name):
    solution = SOLVED[name]
    for lo, hi in solution.patches:
        x = np.linspace(lo, hi, 101)[1:-1]
        body, indenter = (solution.displacement(x, 0.0 * x, name) for name in ("body", "indenter"))
        slip = indenter.x - body.x - solution.slip(x)
        assert np.abs(slip).max() < 1e-13 * np.abs(body.y).max()


def test_the_gauge_holds_a_point_and_turns_both_bodies():
    solution = SOLVED["tilted"]
    plain = solution.displacement([0.3, -2.0], [0.5, 1.0], zero=(1.0, 4.0))
    turned = solution.displacement([0.3, -2.0], [0.5, 1.0], zero=(1.0, 4.0), rotation=1e-3)
    assert solution.displacement(1.0, 4.0, zero=(1.0, 4.0)).x == 0.0 == turned.zero[0] - 1.0
    assert turned.x - plain.x == pytest.approx(1e-3 * np.array([3.5, 3.0]), rel=1e-12)
    assert turned.y - plain.y == pytest.approx(1e-3 * np.array([-0.7, -3.0]), rel=1e-12)


def test_the_approach_is_how_far_the_opposite_point_moves():
    solution = SOLVED["Hertz"]
    deep = 10.0 * solution.half_width
    found = solution.displacement(0.0, 0.0, zero=(0.0, deep))
    opposite = solution.displacement(0.0, -deep, "indenter", zero=(0.0, deep))
    assert found.approach == pytest.approx(float(opposite.y), rel=1e-14)
    # Johnson 1985, eq. (5.58), of each body: P/π (1-ν²)/E (2 ln(2d/b) - ν/(1-ν)), far below
    each = 500.0 * 0.91 / (np.pi * 210e3) * (2.0 * np.log(20.0) - 0.3 / 0.7)
    assert found.approach == pytest.approx(2.0 * each, rel=2e-3)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ((0.0, -1.0, "body"), "depths y >= 0"),
        ((0.0, 1.0, "indenter"), "heights y <= 0"),
        ((0.0, 1.0, "both"), "give 'body' or 'indenter'"),
        ((np.nan, 1.0, "body"), "finite x"),
    ],
)
def test_points_outside_of_the_body_are_refused(asked, words):
    with pytest.raises(ValueError, match=words):
        SOLVED["Hertz"].displacement(*asked)


def test_it_needs_the_elastic_constants():
    plain = sie.solve(sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0))
    with pytest.raises(ValueError, match="give the body by young and poisson"):
        plain.displacement(0.0, 0.0)
