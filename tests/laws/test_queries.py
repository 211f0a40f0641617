"""Every query has a value at every x, and no x changes the value at another."""

import warnings
from functools import partial
from itertools import product

import numpy as np
import pytest

import sie

GIVEN = {"modulus": 1.0, "poisson": 0.3, "normal_load": 0.3, "friction": 0.4}
ROUNDED, TRACE = sie.RoundedFlat(0.5, 1.0), np.linspace(-2.0, 2.0, 81)


def solved(profile=ROUNDED, **changes):
    return sie.solve(sie.Scene(profile=profile, **{**GIVEN, **changes}))


SOLUTIONS = {
    "no shear": solved(sie.Parabola(1.0)),
    "slip of one sign": solved(tangential_load=0.05),
    "hardly any slip": solved(tangential_load=1e-5),
    "slip of both signs": solved(tangential_load=0.03, bulk_stress=0.5),
    "sliding": solved(tangential_load=0.12),
    "sharp edges": solved(sie.Flat(1.0), tangential_load=0.05),
    "a corner": solved(sie.Wedge(0.2), tangential_load=0.05),
    "a series": solved(sie.FromFunction("sinh(x)", domain=(-30.0, 30.0)), tangential_load=0.05),
    "a cusp": solved(sie.Power(1.5, 0.2), tangential_load=0.12),
    "many pieces": solved(sie.Sampled(TRACE, 0.5 * TRACE**2), tangential_load=0.05),
    "dissimilar": solved(sliding=1, dundurs=0.2),
    "bonded": solved(sie.Flat(1.0), friction=np.inf, dundurs=0.2, tangential_load=0.1),
    "after a path": sie.follow(
        sie.Scene(profile=ROUNDED, **GIVEN), sie.Path([(0.3, 0.05), (0.3, -0.03), (0.4, 0.01)])
    )[-1],
}
PAIR = sie.CauchyEquation([(-2.0, -1.0), (1.0, 2.0)], lambda x: x, total=[1.0, 2.0]).solve()


def of_density(density):
    return {
        "value": density,
        "hilbert": density.hilbert,
        **{
            f"{name}, side {side}": partial(getattr(density, name), side=side)
            for name, side in product(("cauchy", "cauchy_derivative"), (1, 0, -1))
        },
        "F of both potentials": lambda x: density.potentials(x)[0],
        "F' of both potentials": lambda x: density.potentials(x)[1],
    }


def of_solution(name):
    """The queries of a solution by their names, each with its value at infinity."""
    solution = SOLUTIONS[name]
    for traction in ("pressure", "shear"):
        for query, function in of_density(getattr(solution, traction)).items():
            yield f"{traction}, {query}", function, 0.0
    yield "gap", solution.gap, np.inf
    if name != "dissimilar":
        yield "slip", solution.slip, 0.0


QUERIES = {
    **{name: list(of_solution(name)) for name in SOLUTIONS},
    "two intervals": [(*query, 0.0) for query in of_density(PAIR).items()],
    "no traction": [(*query, 0.0) for query in of_density(sie.ZERO).items()],
}
ORDINARY = np.array([-3.0, -0.71, -0.2, 0.1, 0.33, 0.8, 2.5])


@pytest.fixture(autouse=True)
def no_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.mark.parametrize("name", QUERIES)
def test_at_any_x_a_query_has_its_value_and_leaves_the_others_alone(name):
    sizes = 10.0 ** np.array([-300, -150, -20, 20, 150, 300])
    for what, query, far_away in QUERIES[name]:
        alone = query(ORDINARY)
        mixed = query(np.insert(ORDINARY, 3, np.nan))
        assert np.isnan(mixed[3]) and np.array_equal(np.delete(mixed, 3), alone), what
        assert np.isnan(query(np.nan)) and np.isnan(query([np.nan, np.nan])).all(), what
        mixed = query(np.concatenate(([-np.inf], ORDINARY, [np.inf])))
        assert np.array_equal(mixed[1:-1], alone), what
        assert (mixed[[0, -1]] == far_away).all() and query(np.inf) == far_away, what
        assert query([]).shape == (0,) and query(np.zeros((0, 3))).shape == (0, 3), what
        assert query(ORDINARY.reshape(7, 1)).shape == (7, 1) and np.shape(query(0.1)) == (), what
        assert np.array_equal(query([3, 5]), query([3.0, 5.0])), what
        assert not np.isnan(query(np.concatenate((-sizes[::-1], [0.0], sizes)))).any(), what


MASKED = np.ma.array(TRACE, mask=TRACE[3] == TRACE)
NO_NUMBERS = ("left", [None], {}, np.array(["1.0"]), [10**400], [[0.1], [0.2, 0.3]])


@pytest.mark.parametrize("name", QUERIES)
def test_an_argument_that_is_no_number_is_refused_in_a_sentence(name):
    for _, query, _ in QUERIES[name]:
        for bad in NO_NUMBERS:
            with pytest.raises(ValueError, match=r"is not an array of (real )?numbers: give"):
                query(bad)
        with pytest.raises(ValueError, match="has masked entries"):
            query(MASKED)


@pytest.mark.parametrize("name", SOLUTIONS)
def test_an_imaginary_part_is_never_dropped(name):
    solution = SOLUTIONS[name]
    for query in (
        solution.pressure,
        solution.shear,
        solution.gap,
        solution.pressure.hilbert,
        solution.scene.profile.height,
    ):
        with pytest.raises(ValueError, match="x is not an array of real numbers"):
            query(np.array([0.1 + 0.2j]))


@pytest.mark.parametrize("name", SOLUTIONS)
def test_stresses_far_and_near_are_numbers(name):
    solution, sizes = SOLUTIONS[name], 10.0 ** np.array([-300, -150, -20, 20, 150, 300])
    x = np.concatenate((-sizes, sizes))
    stress = solution.stress(x, np.concatenate(([0.0], sizes))[:, None])
    far = solution.stress([-1e300, 0.0, 1e300], 1e300)
    for component in (*stress, stress.mises, *stress.principal):
        assert not np.isnan(component).any()
    assert (
        far.xx == pytest.approx(solution.scene.bulk_stress, abs=1e-290)
        and (np.abs(far.yy) <= 1e-290).all()
    )


PROFILES = {
    **{name: solution.scene.profile for name, solution in SOLUTIONS.items()},
    "polynomial": sie.Polynomial((0.0, 0.0, 1.0, 0.2, 1.0)),
    "pieces": sie.Piecewise((-0.5, 1.0), ((0.25, 0.5), (0.0,), (-2.0, 2.0))),
    "function": sie.FromFunction("x"),
    "tilted": sie.Flat(1.0).tilted(0.1),
    "moved": sie.Piecewise((-0.5,), ((0.25, 0.5), (0.0, 1.0))).mirrored().shifted(0.3),
    "sum": sie.RoundedFlat(0.5, 1.0) + sie.Power(2.5, 0.2),
}


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_the_height_and_the_slope_of_nan_are_nan_and_no_height_warns_of_overflow(profile):
    for query in (profile.height, profile.slope):
        alone, mixed = query(ORDINARY), query(np.insert(ORDINARY, 3, np.nan))
        assert np.isnan(mixed[3]) and np.isnan(query(np.nan))
        assert np.array_equal(np.delete(mixed, 3), alone)
        assert not np.isnan(query([-np.inf, -1e300, -1e160, 1e160, 1e300, np.inf])).any()
    assert (profile.height([-np.inf, np.inf]) == np.inf).all()


@pytest.mark.parametrize(
    "build",
    [
        lambda: sie.Sampled(MASKED, TRACE**2),
        lambda: sie.Sampled(TRACE, MASKED**2, mend=True),
        lambda: sie.Polynomial(MASKED),
        lambda: sie.Path(np.ma.array([[1.0, 0.0], [2.0, 0.1]], mask=[[0, 0], [0, 1]])),
        lambda: sie.Parabola(MASKED[3]),
    ],
    ids=["x of a trace", "h of a trace", "coefficients", "path", "a single number"],
)
def test_what_is_masked_is_no_part_of_a_scene(build):
    with pytest.raises(ValueError, match="masked"):
        build()
