"""Other methods in short form: Gauss-Chebyshev, Erdogan-Gupta, FFT boundary elements.

They are a global Gauss-Chebyshev series, the dense Erdogan-Gupta solver of the textbooks, and an
FFT boundary-element solver. None of them shares code with the packages. The first two are given the
edges of the contact, which this package computes.

    E*/2 H(x) = 1/π PV∫ p(t)/(x - t) dt on [lo, hi]
    p = w g,  w(s) = sqrt(1 - s²),  s from -1 to 1
"""

from __future__ import annotations

import importlib.util
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.fft import dct, irfft, next_fast_len, rfft

Array = np.ndarray[Any, Any]
Slope = Callable[[Array], Array]
MOST_ITERATIONS = 2000
CONVERGED = 1e-14


def gauss_chebyshev(
    slope: Slope, lo: float, hi: float, n: int, x: Array, *, modulus: float = 1.0
) -> Array:
    """One series for the whole contact, from n samples by one transform.

    H = Σ c_k T_k, p = E*/2 sqrt(1 - s²) Σ c_k U_{k-1}.
    """
    theta = (np.arange(n) + 0.5) * np.pi / n
    c = dct(slope(0.5 * (lo + hi) + 0.5 * (hi - lo) * np.cos(theta)), type=2) / n
    s = (2.0 * x - lo - hi) / (hi - lo)
    older = old = np.zeros_like(s)
    for a in c[:0:-1]:  # Clenshaw for U
        older, old = old, a + 2.0 * s * old - older
    return 0.5 * modulus * np.sqrt((1.0 - s) * (1.0 + s)) * old


def erdogan_gupta(
    slope: Slope, lo: float, hi: float, n: int, x: Array, *, modulus: float = 1.0
) -> Array:
    """The quadrature of Erdogan & Gupta (1972), both ends bounded: n nodes, n + 1 collocation
    points, the middle one left out (n even).

    Σ_j (1 - t_j²)/(n + 1) g(t_j)/(x_i - t_j) = E*/2 H(x_i) by elimination,
    t_j = cos(jπ/(n+1)),  x_i = cos((2i-1)π/(2n+2));
    between the nodes the polynomial through them, in the barycentric form.
    """
    matrix, t, at = erdogan_gupta_matrix(n)
    m, r = 0.5 * (lo + hi), 0.5 * (hi - lo)
    g = np.linalg.solve(matrix, 0.5 * modulus * slope(m + r * at))
    s = (x - m) / r
    apart = s[:, None] - t
    weight = (-1.0) ** np.arange(n) * (1.0 - t) * (1.0 + t) / np.where(apart == 0.0, 1e-300, apart)
    return np.sqrt((1.0 - s) * (1.0 + s)) * (weight @ g / weight.sum(axis=1))


def erdogan_gupta_matrix(n: int) -> tuple[Array, Array, Array]:
    """The square matrix, the nodes t and the collocation points."""
    j = np.arange(1, n + 1) * np.pi / (n + 1)
    i = (2 * np.delete(np.arange(1, n + 2), n // 2) - 1) * np.pi / (2 * n + 2)
    t, at = np.cos(j), np.cos(i)
    return np.sin(j) ** 2 / (n + 1) / (at[:, None] - t), t, at


def boundary_elements(
    gap: Array, spacing: float, load: float, *, periodic: bool = False, modulus: float = 1.0
) -> Array:
    """Constant pressures on equal elements under a load, by conjugate gradients and FFT.

    The method is that of Polonsky & Keer (1999).

    `gap` at the elements' centres. The surface sinks by -2/(πE*) ∫ p ln|x - t| dt, or, periodic, by
    2/(E* |k|) for each wave number k.
    """
    convolved = (
        _periodic(len(gap), spacing, modulus) if periodic else _free(len(gap), spacing, modulus)
    )
    p = np.full(len(gap), load / (len(gap) * spacing))
    direction, before, keep = np.zeros_like(p), 1.0, 0.0
    for _ in range(MOST_ITERATIONS):
        touching = p > 0.0
        g = convolved(p) + gap
        g -= g[touching].mean()
        square = float(g[touching] @ g[touching])
        direction = np.where(touching, g + keep * (square / before) * direction, 0.0)
        r = convolved(direction)
        r -= r[touching].mean()
        step = float(g[touching] @ direction[touching]) / float(r[touching] @ direction[touching])
        new = np.maximum(p - step * direction, 0.0)
        overlapping = (new == 0.0) & (g < 0.0)
        keep, before = (0.0 if overlapping.any() else 1.0), square
        new[overlapping] -= step * g[overlapping]
        new *= load / (new.sum() * spacing)
        change = float(np.abs(new - p).max() / new.max())
        p = new
        if change < CONVERGED:
            break
    return p


def _free(n: int, spacing: float, modulus: float) -> Callable[[Array], Array]:
    """The product with the matrix of ∫ ln|x - t| over elements, padded with zeros."""
    size = next_fast_len(2 * n, real=True)
    k = np.arange(size)
    ends = (np.minimum(k, size - k)[:, None] + np.array([-0.5, 0.5])) * spacing
    antiderivative = ends * np.log(np.abs(ends)) - ends
    kernel = rfft(-2.0 / (np.pi * modulus) * np.diff(antiderivative, axis=1)[:, 0])
    return lambda p: irfft(kernel * rfft(p, size), size)[:n]


def _periodic(n: int, spacing: float, modulus: float) -> Callable[[Array], Array]:
    wave = 2.0 * np.pi * np.arange(n // 2 + 1) / (n * spacing)
    wave[0] = np.inf
    return lambda p: irfft(2.0 / (modulus * wave) * rfft(p), n)


# -- codes of others, where they are installed (extra `peers`) ------------------------------------


def tamaas(gap: Array, spacing: float, load: float) -> Array:
    """Tamaas (Frérot et al. 2020): basic_1d, Polonsky-Keer-Rey, E* = 1, periodic."""
    import tamaas as tm  # noqa: PLC0415

    tm.set_log_level(tm.LogLevel.error)
    n = len(gap)
    model = tm.Model(tm.model_type.basic_1d, [n * spacing], [n])
    model.E, model.nu = 1.0, 0.0
    solver = tm.PolonskyKeerRey(model, -gap, CONVERGED)
    solver.dump_freq = 10**9
    solver.solve(load / (n * spacing))
    return np.array(model.traction).ravel()


def contact_mechanics(gap: Array, spacing: float, load: float) -> Array:
    """ContactMechanics (Pastewka et al.): periodic FFT half-space, E* = 1, its own Polonsky-Keer
    solver.
    """
    with warnings.catch_warnings():  # of what it imports and does not need
        warnings.simplefilter("ignore", ImportWarning)
        from ContactMechanics import PeriodicFFTElasticHalfSpace  # noqa: PLC0415
        from ContactMechanics.Systems import NonSmoothContactSystem  # noqa: PLC0415
        from SurfaceTopography import UniformLineScan  # noqa: PLC0415

    n = len(gap)
    system = NonSmoothContactSystem(
        PeriodicFFTElasticHalfSpace((n,), 1.0, (n * spacing,)),
        UniformLineScan(-gap, n * spacing, periodic=True),
    )
    found = system.minimize_proxy(
        external_force=load, pentol=1e-12 * float(np.ptp(gap)), maxiter=MOST_ITERATIONS
    )
    return np.abs(np.asarray(found.jac).ravel()) / spacing


INSTALLABLE = {
    "Tamaas": ("tamaas", tamaas),
    "ContactMechanics": ("ContactMechanics", contact_mechanics),
}


def installed(module: str) -> bool:
    return importlib.util.find_spec(module) is not None
