"""Histories, ranges and Ruiz' parameters of a cycle."""

import sys

import numpy as np
import pytest

import sie

SCENE = sie.Scene(
    profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, poisson=0.3, normal_load=0.3, friction=0.4
)
X, Y = np.linspace(-1.2, 1.2, 7), np.array([[0.0], [0.1], [0.5]])


class Moved:
    """A solution with a slip of the test's own."""

    def __init__(self, solution, slip):
        self.solution, self.moved = solution, slip

    def __getattr__(self, name):
        return getattr(self.solution, name)

    def slip(self, x):
        return self.moved * np.cos(np.asarray(x))


@pytest.fixture(scope="module")
def cycle():
    """Sliding to and fro, with a bulk stress in phase."""
    Q = 0.4 * 0.3
    states = [(Q, 0.02, 1.0), (-Q, -0.01, -3.0), (Q, 0.02, 1.0)]
    plain = sie.solve(SCENE)
    return sie.Cycle(
        [Moved(plain.with_(tangential_load=q, bulk_stress=s), slip) for q, s, slip in states]
    )


def test_the_history_holds_the_tensors_of_every_step(cycle):
    tensors = cycle.history(X, Y)
    assert tensors.shape == (3, 3, 7, 3, 3)
    assert (tensors == np.swapaxes(tensors, -1, -2)).all()
    s = cycle.states[1].stress(X, Y)
    for (i, j), values in {(0, 0): s.xx, (1, 1): s.yy, (0, 1): s.xy, (2, 2): s.zz}.items():
        assert (tensors[1, ..., i, j] == values).all()


def test_the_range_is_between_the_extremes(cycle):
    found, stresses = cycle.range(X, Y), [state.stress(X, Y) for state in cycle.states]
    for name in ("xx", "yy", "xy", "zz"):
        values = np.stack([getattr(s, name) for s in stresses])
        assert (found[name].lowest == values.min(axis=0)).all() and (
            found[name].range == np.ptp(values, axis=0)
        ).all()
        assert (found[name].amplitude == 0.5 * found[name].range).all()


def test_ruizs_parameters_are_products_of_amplitude_traction_and_tension(cycle):
    x = np.linspace(-1.0, 1.0, 9) * cycle.states[0].half_width
    amplitude = 2.0 * np.cos(x)
    assert cycle.slip_range(x).amplitude == pytest.approx(amplitude)
    work = 0.4 * cycle.states[0].pressure(x) * amplitude
    assert cycle.friction_work(x) == pytest.approx(work, rel=1e-13)
    tension = np.maximum(*(state.stress(x, 0.0).xx for state in cycle.states[:2]))
    assert cycle.ruiz(x) == pytest.approx(np.maximum(tension, 0.0) * work, rel=1e-13)


def test_at_a_sharp_edge_the_range_is_infinite_and_without_slip_there_is_no_work():
    scene = sie.Scene(profile=sie.Flat(1.0), modulus=1.0, normal_load=0.3, friction=0.4)
    cycle = sie.Cycle(sie.follow(scene, sie.Path([(0.3, 0.0), (0.4, 0.0), (0.3, 0.0)])))
    assert cycle.range([0.0, 1.0], 0.0)["yy"].range[1] == np.inf
    assert cycle.range([0.0, 1.0], 0.0)["yy"].amplitude[1] == np.inf
    assert (cycle.friction_work([0.0, 1.0]) == 0.0).all() and cycle.ruiz(1.0) == 0.0


STATES = sie.follow(
    sie.Scene(profile=sie.Parabola(1.0), body=sie.Elastic(1.0, 0.3), normal_load=1.0, friction=0.5),
    sie.Path([(1.0, 0.2), (1.0, -0.2), (1.0, 0.2)]),
)


@pytest.mark.parametrize("name", ["history", "range", "swt"])
def test_shapes_that_do_not_fit_are_refused_in_a_sentence(name):
    with pytest.raises(ValueError, match="do not fit: give a depth for each position"):
        getattr(sie.Cycle(STATES), name)([1.0, 2.0, 3.0], [1.0, 2.0])


def test_one_state_is_no_cycle():
    with pytest.raises(ValueError, match="1 states make no cycle"):
        sie.Cycle([sie.solve(SCENE)])


def test_in_plane_ranges_need_no_poisson_ratio():
    scene = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, normal_load=0.3, friction=0.4)
    states = [sie.solve(scene).with_(tangential_load=q) for q in (0.12, -0.12)]
    cycle = sie.Cycle(states)
    assert cycle.range(X, Y).keys() == {"xx", "yy", "xy"}
    assert (
        cycle.range(X, Y)["xx"].highest == np.maximum(*(s.stress(X, Y).xx for s in states))
    ).all()


PATH = sie.Path([(0.3, 0.1), (0.3, -0.1), (0.3, 0.06), (0.3, -0.02), (0.3, 0.1)])


def test_a_path_in_parts_shows_extremes_between_its_turning_points():
    turning, parts = (
        sie.Cycle(sie.follow(SCENE, path)).range(X, Y)["xx"] for path in (PATH, PATH.subdivided(8))
    )
    assert (parts.lowest <= turning.lowest + 1e-14).all() and (
        parts.highest >= turning.highest - 1e-14
    ).all()
    assert (parts.range > turning.range * (1.0 + 1e-3)).any()


@pytest.mark.parametrize(
    ("parts", "said"), [(0, "is not a whole"), (2.5, "is not a whole"), (10**6, "give fewer parts")]
)
def test_parts_that_are_no_count_or_more_than_memory_holds_are_refused(parts, said):
    with pytest.raises(ValueError, match=said):
        PATH.subdivided(parts)


COLUMNS = ["P", "Q", "sigma", "x1", "x2", "stick_from", "stick_to"]


@pytest.fixture(params=["with pandas", "without"])
def rows(request, monkeypatch):
    """A function that makes a list of the rows of a table."""
    if request.param == "without":
        monkeypatch.setitem(sys.modules, "pandas", None)
        return lambda table: table
    pytest.importorskip("pandas")
    return lambda table: table.to_dict("records")


def test_the_table_has_a_row_for_each_turning_point(rows):
    history = sie.follow(SCENE, PATH)
    found = rows(sie.Cycle(history).table())
    for row, point, loads in zip(found, history, PATH.points, strict=True):
        (stick,) = point.stick
        expected = (*loads, *point.edges, *stick, point.energy_lost)
        assert list(row) == [*COLUMNS, "energy_lost"]
        assert list(row.values()) == pytest.approx(expected, rel=1e-14)


def test_the_table_of_a_steady_cycle_has_its_permanent_stick_zone(rows):
    A, B = (0.3, 0.1, 0.02), (0.25, -0.05, -0.01)
    steady = sie.steady_cycle(SCENE, A, B)
    found = rows(steady.cycle.table())
    assert [list(row)[:7] for row in found] == [COLUMNS] * 2
    for row, loads in zip(found, (A, B), strict=True):
        assert [row[name] for name in ("P", "Q", "sigma")] == list(loads)
        assert (row["stick_from"], row["stick_to"]) == steady.stick[0]
