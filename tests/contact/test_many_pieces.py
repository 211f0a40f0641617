"""Many pieces: batched formulas are those of piece by piece; memory isn't pieces times points."""

import tracemalloc

import numpy as np
import pytest

import sie
from sie.traction import panels


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


def test_memory_is_not_the_product_of_pieces_and_points():
    p, x = sie.solve(chained(10_000, 0.0)).pressure, np.linspace(-0.4, 0.4, 10_000)
    tracemalloc.start()
    p(x)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10_000 * 10_000 / 2


def chained(pieces, jump, **more):
    """A slope of straight pieces through x + 0.3 x³, with small jumps if wanted."""
    x = np.linspace(-1.0, 1.0, pieces + 1)
    H = x + 0.3 * x**3
    steep = np.diff(H) / np.diff(x)
    rows = np.stack((H[:-1] - steep * x[:-1] + jump * x[:-1], steep), axis=1)
    return sie.Scene(
        profile=sie.Piecewise(x.tolist(), rows.tolist()), modulus=2.0, normal_load=0.5, **more
    )


FLAT_BETWEEN_JUMPS = sie.Piecewise(
    np.linspace(-2.0, 2.0, 61),
    [
        (0.0, 0.0) if abs(m) < 0.04 else (m + 0.3 * np.sign(m), 0.3)
        for m in np.arange(-59, 60, 2) / 30
    ],
)
SLIDING = {"dundurs": 0.2, "friction": 1.5, "sliding": 1}
MANY_PIECES = {
    "chain": chained(150, 0.0),
    "with jumps": chained(150, 1e-3),
    "chain, sliding": chained(150, 0.0, **SLIDING),
    "with jumps, sliding": chained(150, 1e-3, **SLIDING),
    # The flat pieces are left out, so that the pieces on both sides of them do not meet.
    "a flat between two jumps": sie.Scene(profile=FLAT_BETWEEN_JUMPS, modulus=1.0, half_width=1.2),
}


@pytest.mark.parametrize("scene", MANY_PIECES.values(), ids=MANY_PIECES)
def test_sums_over_pairs_have_the_values_of_a_loop_over_the_pieces(scene, monkeypatch):
    batched, rng = sie.solve(scene), np.random.default_rng(7)
    r = batched.half_width
    x = batched.centre + r * np.concatenate((rng.uniform(-1.0, 1.0, 60), [-1.0, 1.0]))
    z = batched.centre + r * (
        rng.uniform(-1.5, 1.5, 500) + 1j * 10.0 ** rng.uniform(-10.0, 1.0, 500)
    )
    beside = batched.edges[1] + r * 10.0 ** np.arange(-12.0, 0.0)
    p, (F, dF) = batched.pressure(x), batched.pressure.potentials(z)
    gap = batched.gap(beside)
    monkeypatch.setattr(panels, "MANY", 10**9)
    looped = sie.solve(scene)
    F_looped, dF_looped = looped.pressure.potentials(z)
    assert p == pytest.approx(looped.pressure(x), rel=1e-12)
    assert gap == pytest.approx(looped.gap(beside), rel=1e-9, abs=1e-15)
    assert np.abs(F - F_looped).max() <= 1e-14 * np.abs(F_looped).max()
    assert (np.abs(dF - dF_looped) <= 1e-13 * np.abs(dF_looped)).all()
