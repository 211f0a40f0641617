"""Scenes as arrays, and derivatives, as ratios in one run (`extra_info`).

`microseconds` is that of a scene; `ratio` is over the closed form in the same chunks, over a sweep
one point after the other, or over the solution whose derivative is taken.
"""

import time

import numpy as np
import pytest

import sie
from sie.sweeps import sweep as of_sweep
from validation.harness.timing import compared

RNG = np.random.default_rng(34)
CHUNK, POINTS = 16, 1001
SCENES = {"rounded flats": 100_000, "tilted": 100_000, "sinh": 10_000, "lopsided": 10_000}


def question(name):
    n = SCENES[name]
    P = RNG.uniform(0.05, 1.0, n)
    if name in ("rounded flats", "tilted"):
        punches = sie.RoundedFlat(RNG.uniform(0.1, 1.0, n), RNG.uniform(0.5, 2.0, n))
        return punches, {"normal_load": P, "tilt": 0.01 if name == "tilted" else 0.0}
    if name == "sinh":
        return sie.FromFunction(np.sinh, domain=(-30.0, 30.0), parity="even"), {"normal_load": P}
    return sie.FromFunction("sinh(x) + x**2/4"), {"normal_load": P}


@pytest.mark.parametrize("name", SCENES)
def test_edges_of_many_scenes(benchmark, name):
    profile, given = question(name)
    sie.solve_many(profile, modulus=1.0, **given)  # imports
    begin = time.perf_counter()
    many = sie.solve_many(profile, modulus=1.0, **given)
    benchmark.extra_info["microseconds"] = 1e6 * (time.perf_counter() - begin) / SCENES[name]
    assert (many.refused == "").all()
    benchmark(lambda: sie.solve_many(profile, modulus=1.0, **given))


def closed_form(b, a, s):
    """Eq. (32) of Ciavarella, Hills & Monno with R = E* = 1, in as few NumPy calls as it takes."""
    phi, phi0 = np.arcsin(s), np.arcsin(a / b)[:, None]
    logarithms = s * np.log(np.abs(np.sin(phi + phi0) / np.sin(phi - phi0)))
    tangents = np.abs(np.tan((phi + phi0) / 2) * np.tan((phi - phi0) / 2))
    logarithms += (a / b)[:, None] * np.log(tangents)
    return b[:, None] * ((np.pi - 2 * phi0) * np.cos(phi) + logarithms) / (2 * np.pi)


def test_edges_and_1001_pressures_over_the_closed_form(benchmark):
    a, P = RNG.uniform(0.1, 1.0, 1000), RNG.uniform(0.05, 1.0, 1000)
    x = np.linspace(-0.5, 0.5, POINTS)

    def many():
        return sie.solve_many(sie.RoundedFlat(a, 1.0), modulus=1.0, normal_load=P).pressure(x)

    b = sie.solve_many(sie.RoundedFlat(a, 1.0), modulus=1.0, normal_load=P).half_width
    s = np.linspace(-0.9995, 0.9995, POINTS)
    parts = [slice(k, k + CHUNK) for k in range(0, len(a), CHUNK)]
    benchmark.extra_info["ratio"] = compared(
        many, lambda: [closed_form(b[k], a[k], s) for k in parts]
    )[1]
    benchmark(many)


def test_a_sweep_over_one_point_after_the_other(benchmark, monkeypatch):
    scene = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.3)

    def seconds(scenes):
        over = {"normal_load": np.linspace(0.1, 0.4, scenes)}
        begin = time.perf_counter()
        sie.sweep(scene, over=over)
        return (time.perf_counter() - begin) / scenes

    sie.sweep(scene, over={"normal_load": [0.1]})  # imports xarray
    at_once = seconds(100_000)
    with monkeypatch.context() as patch:
        patch.setattr(of_sweep, "as_arrays", lambda *_: None)
        benchmark.extra_info["ratio"] = seconds(5_000) / at_once
    benchmark.extra_info["microseconds"] = 1e6 * at_once
    benchmark(lambda: seconds(100_000))


@pytest.mark.parametrize("points", [1_000, 10_000])
@pytest.mark.parametrize("quantity", ["half_width", "peak_pressure"])
def test_all_heights_over_one_solution(benchmark, points, quantity):
    x = np.linspace(-1.6, 1.6, points)
    h = np.cosh(x) - 1.0 + 0.05 * np.sin(3.0 * x)

    def solved():
        trace = sie.Sampled(x, h)
        solution = sie.solve(sie.Scene(profile=trace, modulus=1.0, normal_load=0.4))
        solution.pressure(np.linspace(-0.4, 0.4, 1001))
        return solution

    solution = solved()
    run = lambda: solution.gradient(quantity)  # noqa: E731
    benchmark.extra_info["ratio"] = compared(run, solved)[1]
    benchmark(run)


def test_a_derivative_and_1001_pressures_over_one_solution(benchmark):
    x = np.linspace(-0.4, 0.4, 1001)
    question = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.3)
    solution = sie.solve(question)
    run = lambda: solution.derivative("profile.radius").pressure(x)  # noqa: E731
    benchmark.extra_info["ratio"] = compared(run, lambda: sie.solve(question).pressure(x))[1]
    benchmark(run)
