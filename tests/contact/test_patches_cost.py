"""What many patches cost, in counts; and that sums from afar are the plain sums."""

import numpy as np
import pytest

import sie
from sie.numerics.chord import Chord, Points
from sie.patches import edge_charges, full, newton, start, state, tension
from sie.patches.edge_moves import Damping
from sie.patches.operator import Operator
from sie.patches.panels import Patches
from sie.patches.state import State
from sie.profiles.profile_pieces import of_profile


def rough(points, seed=3):
    """A spline through a rough periodic trace whose waves shorten with its spacing."""
    rng = np.random.default_rng(seed)
    k = np.arange(points // 50, points // 4)
    x = np.arange(points) / points
    h = (k**-1.3 * np.cos(2.0 * np.pi * (np.outer(x, k) + rng.uniform(size=len(k))))).sum(axis=1)
    h *= 1.0 / (points * h.std())
    return sie.Periodic(sie.Sampled(np.append(x, 1.0), np.append(h, h[0])), 1.0)


def operator(count, period):
    """The operator of many equal patches of a row of parabolas."""
    middles = np.arange(count) + 0.3 * np.sin(np.arange(count))
    row = sie.Row([sie.Parabola(1.0).shifted(float(x)) for x in middles])
    profile = row if period == np.inf else sie.Periodic(row, period)
    width = np.where(np.arange(count) % 3, 0.1, 0.02)
    patches = Patches(middles - width, middles + width, Chord(period))
    window = (-0.5, count - 0.5) if period == np.inf else profile.domain
    if period < np.inf:
        window = (profile.start, profile.start + period)
    return Operator(patches, of_profile(profile, window, 1e-15), np.zeros(2 * count))


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("period", [np.inf, 120.0])
def test_poles_at_centres_act_on_far_gaps_as_their_plain_sum_says(period):
    o = operator(110, period)
    k, P = o.gaps, o.patches
    poles = P.chord.poles(
        P.chord.difference(k.points.anchor[..., None] - P.c, k.points.offset[..., None])
    )
    for kernel, across in zip(poles, edge_charges.across_gaps(P, k, k.dx), strict=True):
        plain = np.zeros((P.number - 1, P.number))
        np.add.at(plain, k.gap, (k.dx[..., None] * kernel).sum(axis=1))
        scale = np.abs(plain).max(axis=1, keepdims=True)
        np.testing.assert_allclose(across / scale, plain / scale, rtol=0.0, atol=1e-14)


def changed_by(o, y, tilt):
    """The change of the conditions (2N + 1,) by charges at the edges, as it is defined."""
    P, d = o.patches, o.patches.chord.apart
    e, N, k = P.edges, P.number, o.gaps
    patch = np.repeat(np.arange(N), 2)
    arm = d(e - P.c[patch])
    ratio = np.where(patch == np.arange(N)[:, None], 1.0, arm / d(e - P.c[:, None]))
    _, plain = o.closures
    T, _ = o.root(k.gap, k.points, k.gap)
    across = np.zeros((N - 1, 2 * N))
    kernel = 1.0 / d(k.points.anchor[..., None] - e, k.points.offset[..., None])
    np.add.at(across, k.gap, ((k.dx * T)[..., None] * kernel).sum(axis=1))
    return np.concatenate(
        (
            (ratio * P.chord.cosine(e - P.c[:, None])) @ y + tilt * plain,
            -(across * ratio[:-1]) @ y / np.pi,
            [arm @ y + tilt * o.b.sum()],
            [(arm * e) @ y + tilt * (o.b * o.panels.points.x).sum()],
        )
    )


@pytest.mark.parametrize(("period", "moment"), [(np.inf, True), (np.inf, False), (14.0, False)])
@pytest.mark.parametrize("gap", [0.3, 1e-6])
def test_charges_at_the_edges_change_the_conditions_as_asked(period, moment, gap):
    count = 12
    before = operator(count, period)
    P = before.patches
    a = P.a.copy()
    a[5] = P.b[4] + gap * P.r[4]
    o = Operator(Patches(a, P.b, P.chord), before.pieces, np.zeros(2 * count))
    asked = np.random.default_rng(1).normal(size=2 * count + 1)
    charges = newton.edge_charges(o, moment).of(asked[:, None])[:, 0]
    reached = changed_by(o, charges[:-1], charges[-1])
    if not moment:
        reached[-1] = charges[-1]
    np.testing.assert_allclose(reached, asked, rtol=0.0, atol=1e-13 / min(gap, 0.1))


@pytest.mark.slow(but=1)
@pytest.mark.parametrize("period", [np.inf, 120.0])
def test_roots_off_the_surface_are_the_plain_product(period):
    o = operator(110, period)
    P, d = o.patches, o.patches.chord.apart
    i = np.arange(0, P.number, 5)
    rng = np.random.default_rng(0)
    offset = rng.normal(size=(len(i), 4)) + 1j * 10.0 ** rng.uniform(-6.0, 1.0, (len(i), 4))
    x = Points(P.b[i, None], offset)
    plain = np.ones(offset.shape, dtype=complex)
    for j in range(P.number):
        left, middle, right = (d(x.anchor - v[j], offset) for v in (P.a, P.c, P.b))
        plain *= np.where((i == j)[:, None], 1.0, np.sqrt((left / middle) * (right / middle)))
    np.testing.assert_allclose(o.others(i, x), plain, rtol=1e-12)


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
    grid = start.grid_pressure(profile.height, (0.0, 1.0), 4096, 0.005, True)
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


@pytest.mark.parametrize("most", [0.5, 3.0, 10.0])
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


@pytest.mark.parametrize("least", [2048.0, 3000.0, 15_000.0, 150_000.0, 262_144.0])
def test_grids_have_few_cells_more_than_asked_and_halve_to_the_coarsest(least):
    cells = start.cells_of(least)
    assert least <= cells < 1.14 * least
    coarsest = cells >> int(np.log2(cells / start.COARSEST) + 0.999)
    assert coarsest in start.FAST
    assert cells % coarsest == 0


@pytest.mark.parametrize("period", [True, False])
@pytest.mark.parametrize("cells", start.FAST)
def test_grids_of_all_numbers_of_cells_carry_their_load(cells, period):
    grid = start.grid_pressure(lambda x: np.cos(2.0 * np.pi * x), (0.0, 1.0), cells, 0.1, period)
    assert len(grid.p) == cells
    assert grid.p.sum() * grid.dx == pytest.approx(0.1)


def test_edges_that_no_event_touches_keep_what_they_asked_for():
    line = Chord()
    none, no = np.zeros(6), np.zeros(6, dtype=bool)
    before = State(Patches(np.array([0.0, 2.0, 4.0]), np.array([1.0, 3.0, 5.0]), line), no, none, 0)
    after = State(Patches(np.array([0.0, 4.0]), np.array([3.0, 5.0]), line), no[:4], none[:4], 0)
    damping = Damping(*(np.arange(6.0) + m for m in (10.0, 20.0, 30.0, 40.0)))
    kept, _ = damping.carried(before, after)
    assert kept.insists.tolist() == [30.0, 33.0, 34.0, 35.0]


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
