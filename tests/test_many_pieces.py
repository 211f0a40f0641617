"""Potentials of slopes with many pieces: the batched formulas are the loop's, in the body too."""

import numpy as np
import pytest

import sie
from sie import panels


def chained(pieces, jump, **more):
    """A slope of straight pieces through x + 0.3 x³, with small jumps if wanted."""
    x = np.linspace(-1.0, 1.0, pieces + 1)
    H = x + 0.3 * x**3
    steep = np.diff(H) / np.diff(x)
    rows = np.stack((H[:-1] - steep * x[:-1] + jump * x[:-1], steep), axis=1)
    return sie.Scene(profile=sie.Piecewise(x.tolist(), rows.tolist()), modulus=2.0, normal_load=0.5, **more)


@pytest.mark.parametrize("jump", [0.0, 1e-3])
@pytest.mark.parametrize("more", [{}, {"dundurs": 0.2, "friction": 1.5, "sliding": 1}], ids=["similar", "dissimilar"])
def test_both_potentials_are_those_of_a_loop_over_the_pieces(jump, more, monkeypatch):
    scene = chained(150, jump, **more)
    batched = sie.solve(scene)
    rng = np.random.default_rng(7)
    z = batched.centre + batched.half_width * (rng.uniform(-1.5, 1.5, 500) + 1j * 10.0 ** rng.uniform(-10.0, 1.0, 500))
    F, dF = batched.pressure.potentials(z)
    monkeypatch.setattr(panels, "MANY", 10**9)
    F_looped, dF_looped = sie.solve(scene).pressure.potentials(z)
    assert np.abs(F - F_looped).max() <= 1e-14 * np.abs(F_looped).max()
    assert (np.abs(dF - dF_looped) <= 1e-13 * np.abs(dF_looped)).all()
