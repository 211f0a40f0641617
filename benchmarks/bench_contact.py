"""Run times for development, off by default: pip install -e ".[bench]", then python -m pytest
benchmarks --benchmark-group-by=func.

What a change costs is seen by --benchmark-autosave before it and --benchmark-compare after it.
Counts of solves and transforms, which do not depend on the machine, are asserted in
tests/contact/test_cost.py.
"""

import itertools

import numpy as np
import pytest

import sie
from sie.contact.edges import Search
from sie.friction.coupled.flat import flat_punch
from validation.harness.timing import compared
from validation.topics.speed import closed_form

PROFILES = {
    "parabola": sie.Parabola(1.0),
    "rounded flat": sie.RoundedFlat(0.5, 1.0),
    "wedge": sie.Wedge(0.3),
    "function": sie.FromFunction(np.sinh, domain=(-30.0, 30.0), parity="even"),
    "|x|^1.001": sie.Power(1.001, 0.75),
    "|x|^2.5": sie.Power(2.5, 0.75),
    "|x|^60": sie.Power(60.0, 0.75),
    "lopsided function": sie.FromFunction("sinh(x) + x**2/4"),
    "1000 pieces": sie.Piecewise(np.linspace(-2.0, 2.0, 1001), [(0.0, 1.0)] * 1000),
}
X = np.linspace(-0.4, 0.4, 1001)


def scene(profile, **given):
    return sie.Scene(profile=profile, modulus=1.0, poisson=0.3, normal_load=0.3, **given)


@pytest.mark.parametrize("name", PROFILES)
def test_solve_and_1001_pressures(benchmark, name):
    benchmark(lambda: sie.solve(scene(PROFILES[name])).pressure(X))


@pytest.mark.parametrize("name", PROFILES)
def test_over_the_closed_form_of_the_rounded_punch(benchmark, name):
    """The ratio in one run, in turns: `ratio` among the extra information of each."""
    question = scene(PROFILES[name])
    run = lambda: sie.solve(question).pressure(X)  # noqa: E731
    benchmark.extra_info["ratio"] = compared(run, closed_form)[1]
    benchmark(run)


@pytest.mark.parametrize(("beta", "friction"), [(0.3, 0.3), (0.5, 0.01), (0.05, 0.5), (0.001, 10)])
def test_stick_zone_and_1001_pressures_over_a_product_of_matrices(benchmark, beta, friction):
    """`ratio` to the product of two matrices of 400 rows, for constants that no call had before."""
    matrix = np.random.default_rng(1).random((400, 400))
    constants = itertools.count()

    def run():
        pair = {"dundurs": beta * (1.0 - 1e-9 * next(constants)), "friction": friction}
        question = sie.Scene(profile=PROFILES["rounded flat"], modulus=2.0, normal_load=0.7, **pair)
        solution = sie.solve(question)
        return solution.stick, solution.pressure(X)

    benchmark.extra_info["ratio"] = compared(run, lambda: matrix @ matrix)[1]
    benchmark(run)


@pytest.mark.parametrize("name", ["parabola", "rounded flat"])
def test_a_height_over_its_formula(benchmark, name):
    """What any x, infinite or nan, costs beside the formula at 1001 places: `ratio`."""
    profile = PROFILES[name]
    formula = type(profile).height.__wrapped__
    run = lambda: profile.height(X)  # noqa: E731
    benchmark.extra_info["ratio"] = compared(run, lambda: formula(profile, X))[1]
    benchmark(run)


@pytest.mark.parametrize("name", ["parabola", "rounded flat", "1000 pieces"])
def test_1001_gaps_over_solve_and_1001_pressures(benchmark, name):
    question, x = scene(PROFILES[name]), np.linspace(-2.0, 2.0, 1001)
    solution = sie.solve(question)
    run = lambda: solution.gap(x)  # noqa: E731
    solve = lambda: sie.solve(question).pressure(X)  # noqa: E731
    benchmark.extra_info["ratio"] = compared(run, solve)[1]
    benchmark(run)


def test_edges_over_those_without_a_closed_form_of_the_first_guess(benchmark, monkeypatch):
    """What `Search._of_linear_rise` saves: `ratio` without it."""
    question = scene(PROFILES["rounded flat"])
    run = lambda: sie.solve(question).edges  # noqa: E731

    def without():
        with monkeypatch.context() as patch:
            patch.setattr(Search, "_of_linear_rise", lambda *_: 0.0)
            run()

    benchmark.extra_info["ratio"] = compared(without, run)[1]
    benchmark(run)


@pytest.mark.parametrize("name", [name for name in PROFILES if name.startswith("|x|")])
def test_powers_over_the_rounded_flat(benchmark, name):
    question, flat = scene(PROFILES[name]), scene(PROFILES["rounded flat"])
    solves = [lambda: sie.solve(question).pressure(X), lambda: sie.solve(flat).pressure(X)]
    benchmark.extra_info["ratio"] = compared(*solves)[1]
    benchmark(solves[0])


@pytest.mark.parametrize("name", PROFILES)
def test_certificate(benchmark, name):
    solution = sie.solve(scene(PROFILES[name]))
    _ = solution.pressure

    def run():
        solution.__dict__.pop("certificate", None)
        return solution.check()

    benchmark(run)


def test_sliding_of_dissimilar_bodies(benchmark):
    question = scene(PROFILES["rounded flat"], dundurs=0.2, friction=0.5, sliding=1)
    benchmark(lambda: sie.solve(question).pressure(X))


def test_partial_slip(benchmark):
    question = scene(PROFILES["rounded flat"], friction=0.5, tangential_load=0.1)
    benchmark(lambda: sie.solve(question).shear(X))


@pytest.mark.parametrize("scenes", [1000, 8000])
def test_sweep_on_one_core(benchmark, scenes):
    """Eight times the scenes take eight times as long."""
    over = {"normal_load": np.linspace(0.1, 0.4, scenes)}
    benchmark(lambda: sie.sweep(scene(PROFILES["rounded flat"]), over=over))


OBLIQUE = {
    **{name: PROFILES[name] for name in ("parabola", "rounded flat", "wedge", "function")},
    "power 1.5": sie.Power(1.5, 0.5),
    "power 2.5": sie.Power(2.5, 0.5),
    "two radii": sie.Piecewise([-0.5, 0.25], [(0.5, 1.0), (0.0,), (-0.75, 3.0)]),
    "lopsided": sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6)),
    "trace of 401 points": sie.Sampled(
        np.linspace(-1.6, 1.6, 401), np.cosh(np.linspace(-1.6, 1.6, 401))
    ),
}


@pytest.mark.parametrize("name", OBLIQUE)
def test_energy_of_an_oblique_path_of_four_points(benchmark, name):
    path, question = (
        sie.Path([(0.1, 0.01), (0.3, 0.1), (0.25, -0.05), (0.4, 0.15)]),
        scene(OBLIQUE[name], friction=0.5),
    )
    benchmark(lambda: sie.follow(question, path)[-1].energy_lost)


@pytest.mark.parametrize("turns", [1_000, 10_000])
def test_energy_of_remembered_turning_points(benchmark, turns):
    k = np.arange(turns)
    path = sie.Path([(0.3, Q) for Q in 0.14 * (1.0 - k / turns) * (-1.0) ** k])
    question = scene(PROFILES["rounded flat"], friction=0.5)
    benchmark(lambda: sie.follow(question, path)[-1].energy_lost)


def test_shear_of_a_thousand_remembered_turning_points(benchmark):
    k = np.arange(1_000)
    path = sie.Path([(0.3, Q) for Q in 0.14 * (1.0 - k / 1_000) * (-1.0) ** k])
    question = scene(PROFILES["rounded flat"], friction=0.5)
    benchmark(lambda: sie.follow(question, path)[-1].shear(X))


def test_stick_zones_over_those_without_a_guess(benchmark, monkeypatch):
    """What a guess from known stick zones saves (`_KnownZones`): `ratio` without it."""
    k = np.arange(1_000)
    path = sie.Path([(0.3, Q) for Q in 0.14 * (1.0 - k / 1_000) * (-1.0) ** k])
    question = scene(PROFILES["rounded flat"], friction=0.5)
    run = lambda: [point.stick for point in sie.follow(question, path)]  # noqa: E731

    def without():
        with monkeypatch.context() as patch:
            patch.setattr(sie.paths.path_contacts._KnownZones, "guess", lambda *_: None)
            run()

    benchmark.extra_info["ratio"] = compared(without, run)[1]
    benchmark(run)


def test_stress_on_a_grid(benchmark):
    solution = sie.solve(scene(PROFILES["rounded flat"], friction=0.5, sliding=1))
    x, y = np.linspace(-2.0, 2.0, 200), np.linspace(0.01, 3.0, 200)[:, None]
    benchmark(lambda: solution.stress(x, y).j2)


@pytest.mark.parametrize("n", [64, 1024])
def test_cauchy_equation(benchmark, n):
    equation = sie.CauchyEquation((-1.0, 1.0), g=np.exp, total=0.0)
    benchmark(lambda: equation.solve(n=n))


@pytest.mark.parametrize("friction", [0.1, 0.3, 1.0])
@pytest.mark.parametrize("dundurs", [0.07, 0.3])
def test_dissimilar_rounded_flat_in_partial_slip(benchmark, dundurs, friction):
    def solved():
        flat_punch.cache_clear()
        solution = sie.solve(scene(sie.RoundedFlat(0.5, 1.0), dundurs=dundurs, friction=friction))
        return solution.stick, solution.pressure(X)

    benchmark(solved)
