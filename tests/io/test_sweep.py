"""A sweep answers what single solutions answer, and keeps failures with their reasons."""

from dataclasses import replace

import numpy as np
import pytest
from sweep_cases import LOADS, SCENE, TILTS, plain, single

import sie


def peak(solution):
    return float(solution.pressure(solution.centre))


def test_every_point_equals_a_single_solution(executor):
    over = {"normal_load": LOADS, "tilt": TILTS}
    found = plain(sie.sweep(SCENE, over, ["half_width", "edges"], executor=executor, chunk=2))
    assert found["half_width"].shape == (3, 2)
    for i, P in enumerate(LOADS):
        for j, tilt in enumerate(TILTS):
            alone = single(normal_load=P, tilt=tilt)
            assert (found["x1"][i, j], found["x2"][i, j]) == alone.edges
            assert found["half_width"][i, j] == alone.half_width
    assert (found["reason"] == "").all()
    assert (found["normal_load"] == LOADS).all()


def test_parameters_of_the_profile_and_quantities_of_patches_are_those_of_single_solutions():
    found = plain(sie.sweep(SCENE, over={"profile.half_flat": [0.2, 0.4]}, want={"p0": peak}))
    assert found["p0"][1] == peak(single(profile=sie.RoundedFlat(0.4, 1.0)))
    row = sie.Row([sie.Parabola(1.0).shifted(3.0 * k).raised(0.01 * k) for k in range(3)])
    scene, loads = sie.Scene(profile=row, modulus=1.0, normal_load=1.0), [1e-3, 0.5]
    found = plain(sie.sweep(scene, {"normal_load": loads}, ["patches", "contact_length"]))
    solutions = [sie.solve(replace(scene, normal_load=P)) for P in loads]
    assert found["patches"].tolist() == [len(s.patches) for s in solutions]
    assert found["contact_length"].tolist() == [s.contact_length for s in solutions]


def a_punch(a, f):
    P = 0.1 + a
    loads = {"normal_load": P, "friction": f, "tangential_load": f * P}
    return replace(SCENE, profile=sie.RoundedFlat(a, 1.0), **loads)


def test_a_function_may_build_the_scene():
    over = {"a": [0.2, 0.4], "f": [0.1, 0.3]}
    found = plain(sie.sweep(a_punch, over, ["elastic_limit", "peak_tension"]))
    alone = sie.solve(a_punch(0.4, 0.1)).elastic_limit()
    assert found["elastic_limit"][1, 0] == alone.ratio
    assert found["elastic_limit_y"][1, 0] == alone.y
    assert found["peak_tension"].shape == (2, 2)


def test_a_point_without_an_answer_keeps_its_reason(executor):
    flat = sie.Scene(profile=sie.Flat(1.0), modulus=1.0, normal_load=1.0)
    over = {"moment": [0.5, 2.0], "normal_load": [1.0, -1.0]}
    found = plain(sie.sweep(flat, over, "half_width", executor=executor))
    assert found["half_width"][0, 0] == 1.0
    assert np.isnan(found["half_width"]).tolist() == [[False, True], [True, True]]
    assert "moment 2" in found["reason"][1, 0] and "normal_load = -1" in found["reason"][0, 1]


def test_arrays_are_kept_with_their_own_dimensions():
    x = np.linspace(-0.3, 0.3, 5)
    found = plain(sie.sweep(SCENE, {"normal_load": LOADS}, {"p": lambda s: s.pressure(x)}))
    assert found["p"].shape == (3, 5)
    assert (found["p"][2] == single(normal_load=0.4).pressure(x)).all()


def test_the_normal_problem_is_solved_once_for_all_frictions(monkeypatch):
    solved = []
    original = sie.answers.frictionless.by_pieces
    counted = lambda *args: solved.append(1) or original(*args)  # noqa: E731
    monkeypatch.setattr(sie.answers.frictionless, "by_pieces", counted)
    over = {"normal_load": [0.1, 0.2], "friction": np.linspace(0, 1, 10)}
    sie.sweep(SCENE, over, "half_width")
    assert len(solved) == 2


@pytest.mark.parametrize("odd", [lambda p: p[0], lambda p: p[None]], ids=["number", "matrix"])
def test_a_value_of_another_rank_costs_itself_only(odd):
    x = np.linspace(-0.1, 0.1, 3)
    want = {
        "p": lambda s: odd(s.pressure(x)) if s.normal_load == 0.2 else s.pressure(x),
        "b": lambda s: s.half_width,
    }
    found = plain(sie.sweep(SCENE, over={"normal_load": LOADS}, want=want))
    assert np.isnan(found["p"]).all(axis=1).tolist() == [False, True, False]
    assert np.isfinite(found["b"]).all()
    assert found["reason"][1].startswith("p has") and found["reason"][0] == ""


@pytest.mark.parametrize("value", [[[1.0], [1.0, 2.0]], 1j, "wide", None])
def test_a_value_that_is_no_number_is_reported_in_a_sentence(value):
    want = {"v": lambda s: value if s.normal_load == 0.2 else 1.0}
    found = plain(sie.sweep(SCENE, {"normal_load": LOADS}, want))
    assert np.isnan(found["v"]).tolist() == [False, True, False]
    assert found["reason"][1].startswith("v is neither a number nor an array of numbers")


@pytest.mark.parametrize("want", list(sie.QUANTITIES))
def test_a_quantity_is_nan_by_its_own_names_where_no_point_has_an_answer(want):
    sliding = sie.solve(SCENE).with_(friction=0.3).scene
    answered, failed = (
        plain(sie.sweep(sliding, over={"tangential_load": [Q]}, want=want)) for Q in (0.01, 9.0)
    )
    assert failed.keys() == answered.keys()
    values = failed.keys() - {"tangential_load", "reason"}
    assert all(np.isnan(failed[name]).all() for name in values)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"over": {}}, "nothing to sweep over"),
        ({"over": {"normal_laod": [1.0]}}, '"normal_laod" is not known: choose body'),
        ({"over": {"half_flat": [1.0]}}, 'is not known: choose "profile.half_flat"'),
        ({"over": {"tilt": []}}, "holds no values"),
        ({"over": {"tilt": np.array(0.1)}}, "holds no values"),
        ({"over": {"tilt": [0.1]}, "want": {"b": "width"}}, 'want "width" is not known'),
        ({"over": {"tilt": [0.1]}, "want": {"b": 3}}, 'want "3" is not known'),
        ({"over": {"tilt": [0.1]}, "want": {"reason": peak}}, "another name"),
        ({"over": {"tilt": [0.1]}, "units": {"lenght": "m"}}, "are no labels of units"),
    ],
)
def test_an_invalid_sweep_is_refused_before_any_work(arguments, words):
    with pytest.raises(ValueError, match=words):
        sie.sweep(SCENE, **arguments)


def test_with_xarray_every_quantity_and_parameter_of_the_package_has_its_name_and_unit():
    pytest.importorskip("xarray")
    over = {"normal_load": [0.1, 0.2], "profile.radius": [1.0], "friction": [0.1]}
    units = {"length": "m", "force": "N/m", "stress": "Pa"}
    scene = replace(SCENE, profile=sie.Parabola(1.0), poisson=0.3)
    found = sie.sweep(scene, over=over, want=list(sie.QUANTITIES), units=units)
    for name, variable in {**found.data_vars, **found.coords}.items():
        assert name == "reason" or set(variable.attrs) == {"long_name", "units"}, name
    assert found["normal_load"].attrs["units"] == "N/m"
    assert found["moment"].attrs["units"] == "N/m m" and found["error"].attrs["units"] == "1"
    assert found["profile.radius"].attrs == {"long_name": "radius", "units": "m"}


def test_xarray_writes_the_result_with_its_reasons(tmp_path):
    xarray = pytest.importorskip("xarray")
    found = sie.sweep(SCENE, {"normal_load": [0.1, -1.0]}, ["half_width", "edges"])
    found.to_netcdf(tmp_path / "sweep.nc")
    with xarray.open_dataset(tmp_path / "sweep.nc") as read:
        xarray.testing.assert_identical(read.load(), found)
