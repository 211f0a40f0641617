"""Contact in several patches: rough traces, and how the cost grows with the number of patches.

python -m pytest benchmarks/bench_patches.py            times
python benchmarks/bench_patches.py [POINTS ...]         growth at a fixed density of patches
"""

import sys
from time import process_time

import numpy as np
import pytest

import sie
from validation.rivals.rough_profile import MEAN
from validation.rivals.rough_profile import rough as smooth_and_rough
from validation.rivals.solvers import boundary_elements

MODULUS = 1.0


def rough(points, seed=1, hurst=0.8, rms=0.01):
    """A self-affine trace that rises towards both ends."""
    rng = np.random.default_rng(seed)
    k = np.arange(1, points // 2)
    spectrum = np.zeros(points // 2 + 1, dtype=complex)
    phases = rng.uniform(0.0, 2.0 * np.pi, len(k))
    spectrum[1 : points // 2] = k ** -(hurst + 0.5) * np.exp(1j * phases)
    x, h = np.linspace(-1.0, 1.0, points), np.fft.irfft(spectrum, points)
    return sie.Sampled(x, h * (rms / h.std()) + 0.08 * x**4)


def solved(profile, load):
    return sie.solve(sie.Scene(profile=profile, modulus=MODULUS, normal_load=load)).patches


@pytest.mark.parametrize("count", [5, 20, 80])
def test_a_row_of_parabolas(benchmark, count):
    row = sie.Row([sie.Parabola(1.0).shifted(3.0 * k) for k in range(count)])
    patches = benchmark.pedantic(solved, (row, 0.1 * count), rounds=3)
    assert len(patches) == count


@pytest.mark.parametrize(
    ("points", "load"), [(300, 0.02), (1000, 0.02), (3000, 0.03), (10_000, 0.04)]
)
def test_a_rough_trace(benchmark, points, load):
    trace = rough(points)
    assert len(benchmark.pedantic(solved, (trace, load), rounds=1)) > 10


@pytest.mark.parametrize("points", [16_384, 65_536, 100_000])
def test_a_rough_trace_over_a_grid(benchmark, points):
    """`check` is over the edges, `grid` the textbook's FFT elements at the points over them."""
    solved(smooth_and_rough(1024), MEAN)  # imports
    trace = smooth_and_rough(points)
    height = trace.height(np.arange(points) / points)
    solution = sie.solve(sie.Scene(profile=trace, modulus=MODULUS, normal_load=MEAN))
    times = [process_time()]
    for act in (
        lambda: solution.patches,
        solution.check,
        lambda: boundary_elements(height, 1.0 / points, MEAN, periodic=True),
    ):
        act()
        times.append(process_time())
    edges, check, grid = np.diff(times).tolist()
    benchmark.extra_info.update(edges=edges, check=check / edges, grid=grid / edges)
    assert benchmark.pedantic(solved, (trace, MEAN), rounds=1)


def self_similar(points, seed=1):
    """A trace whose waves shorten with its spacing: the patches for each point are as many."""
    rng = np.random.default_rng(seed)
    k, long = np.arange(1, points // 2), points / 250.0
    amplitude = np.where(k >= long, (np.maximum(k, long) / long) ** -1.3, 1.0) * (k >= long / 4.0)
    spectrum = np.zeros(points // 2 + 1, dtype=complex)
    spectrum[1 : points // 2] = amplitude * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, len(k)))
    x, h = np.linspace(-1.0, 1.0, points), np.fft.irfft(spectrum, points)
    ends = 0.5 * np.maximum(np.abs(x) - 0.9, 0.0) ** 2
    return sie.Sampled(x, h * (10.0 / points / h.std()) + ends)


def repeated(points):
    """The same waves, as a spline that repeats without a joint."""
    x = np.linspace(0.0, 2.0, points + 1)
    h = np.asarray(self_similar(points).heights)
    h = np.fft.irfft(np.fft.rfft(h)[: points // 4], points)  # four points on the shortest wave
    h = np.roll(h, -int(np.argmax(h)))
    return sie.Periodic(sie.Sampled(x, np.append(h, h[0])), 2.0)


@pytest.mark.parametrize("make", [self_similar, repeated])
@pytest.mark.parametrize("points", [1000, 3000, 10_000, 30_000, 100_000])
def test_a_fixed_density_of_patches(benchmark, make, points):
    """The growth exponent is the slope of these times over the number of points."""
    trace = make(points)
    assert len(benchmark.pedantic(solved, (trace, 0.01), rounds=1)) > points / 150


def test_the_stress_below_two_patches(benchmark):
    row = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
    solution = sie.solve(sie.Scene(profile=row, modulus=MODULUS, poisson=0.3, normal_load=0.4))
    x, depth = np.meshgrid(np.linspace(-2.0, 2.0, 200), np.linspace(0.01, 2.0, 200))
    assert solution.patches
    assert np.isfinite(benchmark(lambda: solution.stress(x, depth).mises)).all()


def test_the_elastic_limit_of_two_patches(benchmark):
    row = sie.Row([sie.Parabola(1.0).shifted(-1.0), sie.Parabola(0.5).shifted(0.9).raised(0.02)])
    scene = sie.Scene(profile=row, modulus=MODULUS, poisson=0.3, normal_load=0.4)
    assert benchmark(lambda: sie.solve(scene).elastic_limit())


def growth(sizes):
    """Prints points, patches, processor time, and exponents from the first and the last size on."""
    solved(self_similar(300), 0.01)  # imports count for no size
    for make in (self_similar, repeated):
        print(make.__name__)
        seen = []
        for points in sizes:
            trace, start = make(points), process_time()
            patches = len(solved(trace, 0.01))
            seen.append((points, process_time() - start))
            (n, t), ends = seen[-1], (seen[0], seen[-2]) if len(seen) > 1 else ()
            exponents = "   ".join(f"n^{np.log(t / t0) / np.log(n / n0):.2f}" for n0, t0 in ends)
            print(f"{points:8d} points {patches:6d} patches {t:8.2f} s   {exponents}", flush=True)


if __name__ == "__main__":
    growth([int(v) for v in sys.argv[1:]] or [1000, 3000, 10_000, 30_000, 100_000])
