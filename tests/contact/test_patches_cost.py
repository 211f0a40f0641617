"""What many patches cost, in counts; and that sums from afar are the plain sums."""

import numpy as np
import pytest
from traces import rough_trace

import sie
from sie.numerics.chord import Chord, Points
from sie.patches import full, newton, start, state, tension


def rough(points):
    return sie.Periodic(rough_trace(points, 3), 2.0 + 2.0 / points)


@pytest.mark.parametrize("period", [np.inf, 2.0])
def test_chords_to_far_charges_are_chords(period):
    chord = Chord(period)
    t = Points(np.array([[0.7], [1.9]]), np.array([[-0.01, 0.0, 0.02]] * 2))
    x = Points(np.zeros((2, 1)), np.array([[-0.3, 0.1, 0.5], [0.0, 0.2 + 0.1j, -0.1]]))
    plain = chord.apart((t.anchor - x.anchor)[:, None], t.offset[:, None, :] - x.offset[:, :, None])
    np.testing.assert_allclose(chord.beyond(t, x), plain, rtol=4e-15)


@pytest.mark.parametrize("points", [200, 800])
def test_full_contact_is_ruled_out_at_a_few_places_of_a_rough_profile(points, monkeypatch):
    asked = []
    original = full.FullPressure.__call__
    monkeypatch.setattr(
        full.FullPressure,
        "__call__",
        lambda self, x: asked.append(np.size(x)) or original(self, x),
    )
    scene = sie.Scene(profile=rough(points), modulus=1.0, normal_load=0.005)
    assert len(sie.solve(scene).patches) > 1
    assert sum(asked) <= full.SUSPECTS


def test_a_grid_of_a_rough_profile_is_done_in_a_few_steps_on_each_level(monkeypatch):
    steps = []
    original = start.System.displaced
    monkeypatch.setattr(
        start.System, "displaced", lambda self, q: steps.append(1) or original(self, q)
    )
    profile = rough(1000)
    grid = start.grid_pressure(profile.height, (-1.0, 1.0), 4096, 0.005, True)
    levels = 5
    assert grid.p.min() == 0.0
    assert len(steps) < 3 * start.PRECONDITIONED * levels / 2


@pytest.mark.parametrize("seed", range(3))
def test_bodies_touch_where_a_grid_of_a_noisy_wave_has_pressure(seed):
    """Noise brings some cells into contact at each step: the others come to rest all the same."""
    cells, load, noise = 4096, 4.0, 0.003
    x = (np.arange(cells) + 0.5) / cells
    h = noise * np.random.default_rng(seed).standard_normal(cells) - 0.1 * np.cos(2.0 * np.pi * x)
    p = start.grid_pressure(lambda at: np.interp(at, x, h), (0.0, 1.0), cells, load, True).p
    displacement = start.System(
        h, 1.0 / cells, load, start._influence(cells, 1.0 / cells, True)
    ).displaced(p)
    assert np.std((displacement + h)[p > 0.0]) < 1e-2 * noise


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("most", [3.0, 0.5, 10.0])
def test_a_search_ends_with_its_effort_and_says_what_to_do(most, monkeypatch):
    steps, original = [], newton.conditions

    def counted(*given):
        steps.append(1)
        return original(*given)

    def astray(at, *given):  # no edge ever comes to rest
        return 0.01 * np.resize([1.0, -1.0], len(at.charge)) * at.patches.r.min()

    monkeypatch.setattr(newton, "conditions", counted)
    monkeypatch.setattr(newton, "wished", astray)
    monkeypatch.setattr(state, "MOST_EFFORT", most)
    row = sie.Row([sie.Parabola(1.0).shifted(3.0 * k) for k in range(8)])
    scene = sie.Scene(profile=row, modulus=1.0, normal_load=0.5)
    with pytest.raises(sie.LoadError, match=r"do not settle at normal_load.*change the load"):
        _ = sie.solve(scene).patches
    assert len(steps) <= most


def test_the_bounds_beside_sharp_edges_need_few_halvings(monkeypatch):
    asked, places = [], tension.intensities

    def counted(o, panel, angle):
        asked.append(len(panel) / len(o.panels.lo))
        return places(o, panel, angle)

    monkeypatch.setattr(tension, "intensities", counted)
    row = sie.Row([sie.Flat(0.4).shifted(float(k)) for k in range(20)])
    solution = sie.solve(sie.Scene(profile=row, modulus=1.0, normal_load=20.0))
    assert len(solution.patches) == 20
    assert sum(asked) < 3.0 * asked.count(1.0)
