"""What is printed of a public object is short, however large the object is."""

import subprocess
import sys

import numpy as np
import pytest

import sie

LONGEST = 2000  # characters
SCENE = {"modulus": 1.0, "poisson": 0.3, "normal_load": 1.0, "friction": 0.5}
PARABOLA = sie.Scene(profile=sie.Parabola(1.0), **SCENE)
X = np.linspace(-1.0, 1.0, 3001)
PATH = sie.Path([(1.0, 0.3 * float(np.sin(t))) for t in np.linspace(0.01, 6.28, 162)])
HISTORY = sie.follow(PARABOLA, PATH)
SHEARED = sie.solve(PARABOLA).with_(tangential_load=0.2)
ROW = sie.Row([sie.Parabola(1.0).shifted(3.0 * k) for k in range(3000)])
EQUATION = sie.CauchyEquation((-1.0, 1.0), g=np.exp, total=0.0)
TRACE = sie.Sampled(X, X * X)
SUM = sie.Parabola(1.0)
for k in range(200):
    SUM = SUM + sie.Parabola(2.0 + k)
OBJECTS = {
    "trace": TRACE,
    "row": ROW,
    "row in a scene": sie.Scene(profile=ROW, **SCENE),
    "row of rows": sie.Row([sie.Row([sie.Parabola(1.0)] * 40)] * 40),
    "sum": SUM,
    "periodic": sie.Periodic(TRACE, 2.0),
    "pieces": sie.Piecewise(np.linspace(-1.0, 1.0, 1001), [(0.0, 1.0)] * 1000),
    "polynomial": sie.Polynomial(tuple(np.linspace(1.0, 2.0, 900))),
    "path": PATH,
    "history": HISTORY,
    "point of a path": HISTORY[-1],
    "its shear": HISTORY[-1].shear,
    "cycle": sie.Cycle(HISTORY),
    "steady cycle": sie.steady_cycle(PARABOLA, (1.0, 0.3), (1.0, -0.3)),
    "solution": SHEARED,
    "pressure": SHEARED.pressure,
    "shear": SHEARED.shear,
    "certificate": SHEARED.check(),
    "elastic limit": SHEARED.elastic_limit(),
    "tension": SHEARED.peak_tension(),
    "stress": SHEARED.stress(X, 0.1),
    "plan": sie.plan(PARABOLA),
    "combination": sie.superposed(*[(1.0, SHEARED.pressure)] * 300),
    "equation": EQUATION,
    "density": EQUATION.solve(),
    "sweep": sie.sweep(PARABOLA, {"normal_load": np.linspace(0.1, 1.0, 20)}, progress=False),
    "noise of a trace": sie.solve(sie.Scene(profile=TRACE, **SCENE)).trace_reports(),
    **{name: getattr(sie, name) for name in sie.__all__},
}


@pytest.mark.parametrize("name", OBJECTS)
def test_what_is_printed_of_a_public_object_is_short(name):
    assert len(repr(OBJECTS[name])) < LONGEST


@pytest.mark.parametrize("name", ["row", "pieces", "polynomial", "path"])
def test_a_long_list_is_printed_with_its_first_and_its_last(name):
    assert " more>, " in repr(OBJECTS[name])


def test_public_modules_are_there_when_they_are_asked_for_and_not_before():
    program = (
        "import sie, sys; assert 'sie.live.teaching' not in sys.modules; "
        "sie.teaching.solve; sie.charts; sie.no_such"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], check=False, capture_output=True, text=True
    )
    assert "has no attribute 'no_such'" in done.stderr
