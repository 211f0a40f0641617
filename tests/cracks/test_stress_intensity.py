"""Cracks below a fretted contact over a cycle: reference numbers, closure, arrest, refusals."""

import json
import math

import matplotlib.pyplot as plt
import numpy as np
import pytest

import sie
from oracles.edge_crack import edge_crack
from sie.cli import main
from sie.io import scene_file

HERTZ = sie.Scene(
    profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0, friction=0.3, tangential_load=0.15
)


@pytest.fixture(scope="module")
def pad():
    return sie.solve(HERTZ)


@pytest.fixture(scope="module")
def cycle(pad):
    return sie.Cycle([pad.with_(tangential_load=0.0), pad])


def test_cracks_at_the_trailing_edge_of_a_cylinder(pad, cycle):
    # f = .3, Q = f P/2 after P, crack at x = -b; by collocation, before this was written
    b = pad.half_width
    K = cycle.stress_intensity(at=-b, depth=b * np.array([0.01, 0.05, 0.1, 0.2]))
    unit = 2.0 / (math.pi * b) * math.sqrt(math.pi * b)
    expected = [0.03020, 0.02772, 0.00549, 0.0]
    assert np.round(K.mode_1[1] / unit, 5).tolist() == expected
    assert (K.mode_1[0] == 0.0).all()  # under P alone the surface is in compression
    assert K.check().ok


def test_a_bulk_stress_adds_that_of_a_crack_in_tension(pad):
    b, sigma = pad.half_width, 2.0
    states = [
        sie.solve(HERTZ).with_(bulk_stress=s, tangential_load=0.0) for s in (sigma, 2 * sigma)
    ]
    far = 1e4 * b  # beside the contact the body has its bulk stress alone
    K = sie.Cycle(states).stress_intensity(at=far, depth=[0.1 * b])
    exact = float(edge_crack(0)) * sigma * math.sqrt(math.pi * 0.1 * b)
    assert K.range[0] == pytest.approx(exact, rel=1e-6)
    assert K.mode_1[:, 0] == pytest.approx([exact, 2 * exact], rel=1e-6)


def test_many_depths_agree_with_cracks_one_by_one(pad):
    b = pad.half_width
    steady = sie.steady_cycle(HERTZ, (1.0, 0.15, 0.1), (1.0, -0.15, -0.1))
    depth = b * np.array([0.02, 0.7, 0.9, 1.4])  # apart, closed at the tip, inside, apart
    K = steady.cycle.stress_intensity(at=-b, depth=depth)
    for i, a in enumerate(depth.tolist()):
        crack = K.crack(0, a)
        assert crack.check().ok
        assert K.mode_1[0, i] == pytest.approx(crack.mode_1, rel=1e-9, abs=1e-12)
        assert K.mode_2[0, i] == pytest.approx(crack.mode_2, rel=1e-9)
    assert (K.mode_1[1] == 0.0).all() and len(K.crack(0, depth[2]).open) == 2


def test_two_hundred_depths_take_two_stresses_a_state(cycle, pad, monkeypatch):
    calls = []
    of_state = sie.Solution.stress
    monkeypatch.setattr(
        sie.Solution, "stress", lambda self, x, y: calls.append(1) or of_state(self, x, y)
    )
    b = pad.half_width
    K = cycle.stress_intensity(at=-b, depth=b * np.geomspace(1e-3, 0.1, 200))
    assert K.range.shape == (200,)
    assert len(calls) == 2


def test_a_crack_stops_where_its_range_falls_to_the_threshold(pad, cycle):
    b = pad.half_width
    K = cycle.stress_intensity(at=-b, depth=b * np.geomspace(1e-2, 1.0, 30))
    top = K.range.max()
    limits = {"threshold": 0.5 * top, "fatigue_limit": 1e3 * top}
    a = K.arrest(**limits)
    there = cycle.stress_intensity(at=-b, depth=[a])
    assert K.depth[0] < a < K.depth[-1]
    assert there.range[0] == pytest.approx(there.threshold(**limits)[0], rel=1e-9)
    assert K.arrest(threshold=1e-9 * top, fatigue_limit=1e-9 * top) < math.inf  # it closes
    open_to_the_end = cycle.stress_intensity(at=-b, depth=[1e-3 * b, 2e-3 * b])
    assert open_to_the_end.arrest(1e-6 * top, 1e3 * top) == math.inf
    assert K.arrest(1e6 * top, 1e9 * top) == K.depth[0]


def test_the_threshold_of_short_cracks_is_the_fatigue_limit(cycle):
    K = cycle.stress_intensity(at=0.0, depth=[1e-6])
    assert K.threshold(150.0, 600.0)[0] == pytest.approx(600.0 * math.sqrt(math.pi * 1e-6), 1e-4)


def test_a_table_and_a_picture(cycle, pad):
    K = cycle.stress_intensity(at=pad.edges[0], depth=[0.01, 0.1])
    rows = K.table()
    names = [*rows.columns] if hasattr(rows, "columns") else [*rows[0]]
    assert names[:4] == ["depth", "K1_max", "K1_min", "K1_range"]
    _, ax = plt.subplots()
    assert K.plot(ax=ax, threshold=1.0, fatigue_limit=2.0) is ax
    assert len(ax.lines) == 3
    plt.close("all")


@pytest.mark.parametrize(
    ("asked", "word"),
    [
        ({"depth": [-0.1]}, "not inside the body"),
        ({"depth": [0.0]}, "not inside the body"),
        ({"depth": [1e-17]}, "below what doubles resolve"),
        ({"depth": [0.2, 0.1]}, "do not ascend"),
        ({"depth": []}, "give 1 to"),
        ({"depth": [0.1], "face_friction": 0.2}, "without friction"),
        ({"depth": [0.1], "at": float("inf")}, "at"),
    ],
)
def test_what_is_no_crack_is_refused_before_any_work(cycle, monkeypatch, asked, word):
    monkeypatch.setattr(sie.Solution, "stress", None)
    with pytest.raises(ValueError, match=word):
        sie.stress.fretting.Cycle.stress_intensity(cycle, **{"at": -1.0, **asked})


def test_one_scene_file_leads_from_the_pad_to_the_arrest_of_a_crack(tmp_path, capsys):
    path = tmp_path / "crack.toml"
    path.write_text(scene_file.example("crack"), encoding="utf-8")
    assert main(["solve", str(path), "--json", str(tmp_path / "out.json")]) == 0
    assert "arrest          at 0." in capsys.readouterr().out
    crack = json.loads((tmp_path / "out.json").read_text())["crack"]
    assert crack["depth"][0] < crack["arrest"] < crack["depth"][-1]
    assert crack["certificate"]["residual"] < 1e-8
    assert crack["x"] < 0.0  # the largest Q is along +x, so that the left edge trails


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ('at = "trailing edge"', 'at = "middle"', "is not known"),
        ("fatigue_limit = 400.0", "", "without fatigue_limit"),
        ("depths = [0.01, ", "friction = 0.3\ndepths = [0.01, ", "without friction"),
        ("depths = [0.01, ", "depths = [-0.01, ", "not positive"),
    ],
)
def test_a_table_of_no_crack_is_refused(tmp_path, capsys, old, new, word):
    text = scene_file.example("crack")
    assert old in text
    path = tmp_path / "crack.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    assert main(["solve", str(path), "--want", "crack"]) == 2
    assert word in " ".join(capsys.readouterr().err.split())


def test_cracks_that_are_wanted_of_no_table_are_refused(tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(scene_file.example("parabola"), encoding="utf-8")
    assert main(["solve", str(path), "--want", "crack"]) == 2
    assert "needs the table [crack]" in capsys.readouterr().err


def test_cracks_at_an_edge_under_a_changing_load_are_certified():
    scene = sie.Scene(
        profile=sie.Parabola(7.5), modulus=1.0, poisson=0.3, normal_load=0.06, friction=0.5
    )
    path = sie.Path([(0.06, 0.0, 0.0), (0.06, 0.012, 0.002), (0.06, -0.01, -0.002)])
    history = sie.follow(scene, path)
    edge, b = history[0].edges[0], history[0].half_width
    found = sie.Cycle(history[1:]).stress_intensity(edge, [0.01 * b, 0.1 * b])
    assert found.check().ok
