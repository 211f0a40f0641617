"""Contact in several patches: rough traces, and how the cost grows with the number of patches.

python -m pytest benchmarks/bench_patches.py
"""

import numpy as np
import pytest

import sie

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


@pytest.mark.parametrize("points", [300, 1000])
def test_a_rough_trace(benchmark, points):
    trace = rough(points)
    assert len(benchmark.pedantic(solved, (trace, 0.02), rounds=1)) > 10
