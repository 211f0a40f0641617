"""A sweep answers what single solutions answer, keeps failures and reasons, runs anywhere, and loses nothing."""

import sys
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import sie

module = sys.modules["sie.sweep"]  # `sie.sweep` is the function
SCENE = sie.Scene(profile=sie.RoundedFlat(0.5, 1.0), modulus=1.0, poisson=0.3, normal_load=0.3)
LOADS, TILTS = [0.1, 0.2, 0.4], [0.0, 0.01]


def plain(found):
    """The arrays by name, whatever the kind of the result."""
    return {name: np.asarray(found[name]) for name in found} if isinstance(found, dict) else {n: found[n].values for n in found.variables}


def peak(solution):
    return float(solution.pressure(solution.centre))


def single(**changes):
    return sie.solve(SCENE).with_(**changes)


@pytest.fixture(params=[None, ThreadPoolExecutor, ProcessPoolExecutor], ids=["here", "threads", "processes"])
def executor(request):
    if request.param is None:
        yield None
        return
    with request.param(max_workers=2) as pool:
        yield pool


def test_every_point_is_what_a_single_solution_says(executor):
    found = plain(sie.sweep(SCENE, over={"normal_load": LOADS, "tilt": TILTS}, want=["half_width", "edges"], executor=executor, chunk=2))
    assert found["half_width"].shape == (3, 2)
    for i, P in enumerate(LOADS):
        for j, tilt in enumerate(TILTS):
            alone = single(normal_load=P, tilt=tilt)
            assert (found["x1"][i, j], found["x2"][i, j]) == alone.edges
            assert found["half_width"][i, j] == alone.half_width
    assert (found["reason"] == "").all()
    assert (found["normal_load"] == LOADS).all()


def test_functions_of_the_solution_and_parameters_of_the_profile():
    found = plain(sie.sweep(SCENE, over={"profile.half_flat": [0.2, 0.4]}, want={"p0": peak}))
    assert found["p0"][1] == peak(single(profile=sie.RoundedFlat(0.4, 1.0)))


def a_punch(a, f):
    P = 0.1 + a
    return sie.Scene(profile=sie.RoundedFlat(a, 1.0), modulus=1.0, poisson=0.3, normal_load=P, friction=f, tangential_load=f * P)


def test_a_function_may_build_the_scene():
    found = plain(sie.sweep(a_punch, over={"a": [0.2, 0.4], "f": [0.1, 0.3]}, want=["elastic_limit", "peak_tension"]))
    alone = sie.solve(a_punch(0.4, 0.1)).elastic_limit()
    assert found["elastic_limit"][1, 0] == alone.ratio
    assert found["elastic_limit_y"][1, 0] == alone.y
    assert found["peak_tension"].shape == (2, 2)


def test_what_has_no_answer_keeps_its_reason(executor):
    flat = sie.Scene(profile=sie.Flat(1.0), modulus=1.0, normal_load=1.0)
    found = plain(sie.sweep(flat, over={"moment": [0.5, 2.0], "normal_load": [1.0, -1.0]}, want="half_width", executor=executor))
    assert found["half_width"][0, 0] == 1.0
    assert np.isnan(found["half_width"]).tolist() == [[False, True], [True, True]]
    assert "moment 2" in found["reason"][1, 0] and "normal_load = -1" in found["reason"][0, 1]


def test_arrays_are_kept_with_their_own_dimensions():
    x = np.linspace(-0.3, 0.3, 5)
    found = plain(sie.sweep(SCENE, over={"normal_load": LOADS}, want={"p": lambda s: s.pressure(x)}))
    assert found["p"].shape == (3, 5)
    assert (found["p"][2] == single(normal_load=0.4).pressure(x)).all()


def test_the_normal_problem_is_solved_once_for_all_frictions(monkeypatch):
    solved = []
    original = sie.solution.normal_contact
    monkeypatch.setattr(sie.solution, "normal_contact", lambda *args: solved.append(1) or original(*args))
    sie.sweep(SCENE, over={"normal_load": [0.1, 0.2], "friction": np.linspace(0, 1, 20)}, want="half_width")
    assert len(solved) == 2


class Interrupting(Executor):
    """Runs two chunks, then the user presses Ctrl-C."""

    def __init__(self):
        self.futures = []

    def submit(self, function, /, *args, **kwargs):
        future = Future()
        self.futures.append(future)
        if len(self.futures) <= 2:
            future.set_result(function(*args, **kwargs))
        return future


def test_an_interrupt_loses_nothing(monkeypatch):
    pool, waited = Interrupting(), []
    original = module.wait

    def wait(futures, **kwargs):
        if waited:
            raise KeyboardInterrupt
        waited.append(1)
        return original(futures, **kwargs)

    monkeypatch.setattr(module, "wait", wait)
    with pytest.raises(KeyboardInterrupt) as caught:
        sie.sweep(SCENE, over={"normal_load": [0.1, 0.2, 0.3, 0.4]}, want="half_width", executor=pool, chunk=1)
    found = plain(caught.value.result)
    assert np.isfinite(found["half_width"]).tolist() == [True, True, False, False]
    assert found["reason"].tolist() == ["", "", "interrupted", "interrupted"]
    assert all(f.done() or f.cancelled() for f in pool.futures)


def test_an_interrupt_within_a_chunk_keeps_its_first_points():
    asked = []

    def impatient(solution):
        asked.append(solution)
        if len(asked) == 3:
            raise KeyboardInterrupt
        return solution.half_width

    with pytest.raises(sie.Interrupted) as caught:
        sie.sweep(SCENE, over={"normal_load": [0.1, 0.2, 0.3, 0.4]}, want={"b": impatient}, chunk=4)
    assert np.isfinite(plain(caught.value.result)["b"]).tolist() == [True, True, False, False]


def test_an_interrupt_keeps_chunks_that_are_done_but_not_yet_taken(monkeypatch):
    def wait(futures, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(module, "wait", wait)
    with pytest.raises(sie.Interrupted) as caught:
        sie.sweep(SCENE, over={"normal_load": [0.1, 0.2, 0.3]}, want="half_width", executor=Interrupting(), chunk=1)
    assert np.isfinite(plain(caught.value.result)["half_width"]).tolist() == [True, True, False]


def one_in_three(solution):
    return 1.0 / (solution.normal_load - 0.2)


def test_a_function_that_raises_costs_its_own_point_only(executor):
    found = plain(sie.sweep(SCENE, over={"normal_load": LOADS}, want={"f": one_in_three}, executor=executor))
    assert np.isnan(found["f"]).tolist() == [False, True, False]
    assert found["reason"][1].startswith("ZeroDivisionError")


class Broken(Interrupting):
    """Its third worker dies."""

    def submit(self, function, /, *args, **kwargs):
        future = super().submit(function, *args, **kwargs)
        if not future.done():
            future.set_exception(RuntimeError("a worker died"))
        return future


def test_a_worker_that_dies_costs_its_own_chunk_only():
    found = plain(sie.sweep(SCENE, over={"normal_load": [0.1, 0.2, 0.3]}, want="half_width", executor=Broken(), chunk=1))
    assert np.isfinite(found["half_width"]).tolist() == [True, True, False]
    assert found["reason"][2] == "RuntimeError: a worker died"


@pytest.mark.parametrize("want", list(sie.QUANTITIES))
def test_a_quantity_is_nan_by_its_own_names_where_no_point_has_an_answer(want):
    sliding = sie.solve(SCENE).with_(friction=0.3).scene
    answered, failed = (plain(sie.sweep(sliding, over={"tangential_load": [Q]}, want=want)) for Q in (0.01, 9.0))
    assert failed.keys() == answered.keys()
    assert all(np.isnan(failed[name]).all() for name in failed.keys() - {"tangential_load", "reason"})


def test_a_bar_is_shown_for_long_work_on_a_terminal_only(monkeypatch, capsys):
    sie.sweep(SCENE, over={"normal_load": LOADS})
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    sie.sweep(SCENE, over={"normal_load": LOADS})
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    sie.sweep(SCENE, over={"normal_load": LOADS})
    assert "/3" in capsys.readouterr().err
    sie.sweep(SCENE, over={"normal_load": LOADS}, progress=False)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"over": {}}, "nothing to sweep over"),
        ({"over": {"normal_laod": [1.0]}}, '"normal_laod" is not known: choose body'),
        ({"over": {"profile.radiuss": [1.0]}}, '"profile.radiuss" is not known: choose half_flat, radius'),
        ({"over": {"tilt": []}}, "holds no values"),
        ({"over": {"tilt": 0.1}}, "holds no values"),
        ({"over": {"tilt": [0.1]}, "want": "width"}, 'want "width" is not known'),
        ({"over": {"tilt": [0.1]}, "chunk": 0}, "chunk = 0"),
    ],
)
def test_a_bad_question_is_refused_before_any_work(arguments, words):
    with pytest.raises(ValueError, match=words):
        sie.sweep(SCENE, **arguments)


def test_with_xarray_the_result_is_labelled():
    xarray = pytest.importorskip("xarray")
    found = sie.sweep(SCENE, over={"normal_load": LOADS, "tilt": TILTS}, want="half_width")
    assert isinstance(found, xarray.Dataset)
    assert float(found["half_width"].sel(normal_load=0.2, tilt=0.01)) == single(normal_load=0.2, tilt=0.01).half_width
