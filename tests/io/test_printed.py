"""What is printed of a public object is short, however large the object is."""

import numpy as np
import pytest

import sie

LONGEST = 2000  # characters
SCENE = {"modulus": 1.0, "poisson": 0.3, "normal_load": 1.0, "friction": 0.5}
PARABOLA = sie.Scene(profile=sie.Parabola(1.0), **SCENE)
X = np.linspace(-1.0, 1.0, 601)


@pytest.fixture(scope="module")
def printed():
    """What is printed of large objects of every public class."""
    path = sie.Path([(1.0, 0.3 * float(np.sin(t))) for t in np.linspace(0.01, 6.28, 162)])
    history, sheared = sie.follow(PARABOLA, path), sie.solve(PARABOLA).with_(tangential_load=0.2)
    row = sie.Row([sie.Parabola(1.0).shifted(3.0 * k) for k in range(300)])
    equation = sie.CauchyEquation((-1.0, 1.0), g=np.exp, total=0.0)
    trace, added = sie.Sampled(X, X * X), sie.Parabola(1.0)
    for k in range(200):
        added = added + sie.Parabola(2.0 + k)
    objects = {
        "trace": trace,
        "row": row,
        "row in a scene": sie.Scene(profile=row, **SCENE),
        "row of rows": sie.Row([sie.Row([sie.Parabola(1.0)] * 40)] * 40),
        "sum": added,
        "periodic": sie.Periodic(trace, 2.0),
        "pieces": sie.Piecewise(np.linspace(-1.0, 1.0, 1001), [(0.0, 1.0)] * 1000),
        "polynomial": sie.Polynomial(tuple(np.linspace(1.0, 2.0, 900))),
        "path": path,
        "history": history,
        "point of a path": history[-1],
        "its shear": history[-1].shear,
        "cycle": sie.Cycle(history),
        "steady cycle": sie.steady_cycle(PARABOLA, (1.0, 0.3), (1.0, -0.3)),
        "solution": sheared,
        "pressure": sheared.pressure,
        "shear": sheared.shear,
        "certificate": sheared.check(),
        "elastic limit": sheared.elastic_limit(),
        "tension": sheared.peak_tension(),
        "stress": sheared.stress(X, 0.1),
        "plan": sie.plan(PARABOLA),
        "combination": sie.superposed(*[(1.0, sheared.pressure)] * 300),
        "equation": equation,
        "density": equation.solve(),
        "sweep": sie.sweep(PARABOLA, {"normal_load": np.linspace(0.1, 1.0, 20)}, progress=False),
        "noise of a trace": sie.solve(sie.Scene(profile=trace, **SCENE)).trace_reports(),
        **{name: getattr(sie, name) for name in sie.__all__},
    }
    return {name: repr(value) for name, value in objects.items()}


def test_what_is_printed_of_a_public_object_is_short(printed):
    assert {name for name, text in printed.items() if len(text) >= LONGEST} == set()


def test_a_long_list_is_printed_with_its_first_and_its_last(printed):
    for name in ("row", "pieces", "polynomial", "path"):
        assert " more>, " in printed[name]
