"""Fatigue parameters against closed forms and a scan of planes."""

from types import SimpleNamespace

import numpy as np
import pytest

import sie

BODY = sie.Elastic(115e3, 0.32)
K, YIELD = 0.4, 300.0


class Uniform:
    """A state of the same stress everywhere."""

    def __init__(self, xx, yy, xy, body=BODY):
        out = 0.0 if body.plane == "stress" else body.poisson * (np.add(xx, yy))
        self.components = {"xx": xx, "yy": yy, "xy": xy, "zz": out}
        self.tractions = SimpleNamespace(known_body=body)

    def stress(self, x, y):
        shape = np.broadcast_shapes(np.shape(x), np.shape(y))
        return SimpleNamespace(
            **{name: np.broadcast_to(v, shape) for name, v in self.components.items()}
        )


def parameters(cycle, *place):
    return {
        "swt": cycle.swt(*place),
        "findley": cycle.findley(*place, k=K),
        "fatemi-socie": cycle.fatemi_socie(*place, k=K, yield_stress=YIELD),
    }


S = 200.0
REVERSED = sie.Cycle([Uniform(S, 0.0, 0.0), Uniform(-S, 0.0, 0.0)])
SHEARED = sie.Cycle([Uniform(0.0, 0.0, S), Uniform(0.0, 0.0, -S)])
E, NU = BODY.young, BODY.poisson


PLATE = sie.Elastic(115e3, 0.32, plane="stress")
IN_A_PLATE = sie.Cycle([Uniform(S, 0.0, 0.0, PLATE), Uniform(-S, 0.0, 0.0, PLATE)])
CLOSED = {
    "tension of a plate, SWT": (IN_A_PLATE.swt, {}, S**2 / E),
    "shear, SWT": (SHEARED.swt, {}, S**2 * (1.0 + NU) / E),
    "shear, Findley": (SHEARED.findley, {"k": K}, S * np.hypot(1.0, K)),
    "shear, Fatemi-Socie without a weight": (
        SHEARED.fatemi_socie, {"k": 0.0, "yield_stress": YIELD}, S / BODY.shear_modulus
    ),
}  # fmt: skip


@pytest.mark.parametrize(("parameter", "given", "exact"), CLOSED.values(), ids=CLOSED)
def test_a_parameter_of_a_reversed_stress_has_its_closed_form(parameter, given, exact):
    assert parameter(0.0, 0.0, **given).value == pytest.approx(exact, rel=1e-13)


def test_reversed_tension_gives_smith_watson_topper_on_the_plane_across_it():
    worst = REVERSED.swt(0.0, 0.0)
    assert worst.value == pytest.approx(S**2 * (1.0 - NU**2) / E, rel=1e-13)
    assert np.sin(worst.angle) == pytest.approx(0.0, abs=1e-7) and worst.out_of_plane < 1e-7


def test_reversed_tension_gives_findleys_parameter_in_closed_form():
    worst = REVERSED.findley(0.0, 0.0, k=K)
    assert worst.value == pytest.approx(0.5 * S * (K + np.sqrt(1.0 + K**2)), rel=1e-13)
    assert abs(np.tan(2.0 * worst.angle)) == pytest.approx(1.0 / K, rel=1e-6)


def test_below_a_pulsating_pressure_findleys_plane_has_a_normal_out_of_the_plane():
    # σ_xx = σ_yy: nothing is sheared on planes along z.
    worst = sie.Cycle([Uniform(0.0, 0.0, 0.0), Uniform(S, S, 0.0)]).findley(0.0, 0.0, k=0.0)
    assert worst.value == pytest.approx(0.25 * S * (1.0 - 2.0 * NU), rel=1e-13)
    assert worst.out_of_plane == pytest.approx(0.25 * np.pi, abs=1e-6)


def on_planes(cycle, theta, psi):
    """The parameters on planes of these normals, by tensors and vectors."""
    n = np.stack((np.cos(psi) * np.cos(theta), np.cos(psi) * np.sin(theta), np.sin(psi)), axis=-1)
    tensors = cycle.history(0.0, 0.0)
    traction = np.einsum("tij,...j->t...i", tensors, n)
    normal = (traction * n).sum(axis=-1)
    shear = traction - normal[..., None] * n
    amplitude = 0.5 * np.linalg.norm(shear[:, None] - shear[None], axis=-1).max(axis=(0, 1))
    trace = np.trace(tensors, axis1=1, axis2=2).reshape(-1, *[1] * np.ndim(theta))
    strain = ((1.0 + NU) * normal - NU * trace) / E
    top = normal.max(axis=0)
    return {
        "swt": np.maximum(top, 0.0) * 0.5 * np.ptp(strain, axis=0),
        "findley": amplitude + K * top,
        "fatemi-socie": amplitude / BODY.shear_modulus * np.maximum(1.0 + K * top / YIELD, 0.0),
    }


@pytest.mark.parametrize("steps", [2, 3, 7])
@pytest.mark.parametrize("seed", range(4))
def test_no_plane_of_a_scan_exceeds_the_critical_one_which_has_its_value(steps, seed):
    random = np.random.default_rng(seed)
    stresses = random.normal(size=(steps, 3)) * 100.0 + random.normal(size=3) * 200.0
    cycle = sie.Cycle([Uniform(*stress) for stress in stresses.tolist()])
    angles = np.linspace(0.0, np.pi, 90, endpoint=False)
    scan = on_planes(cycle, *np.meshgrid(angles, np.linspace(0.0, 0.5 * np.pi, 31)))
    for name, worst in parameters(cycle, 0.0, 0.0).items():
        assert scan[name].max() <= worst.value + 1e-12 * abs(worst.value)
        there = on_planes(cycle, worst.angle, worst.out_of_plane)[name]
        assert there == pytest.approx(worst.value, rel=1e-12)


def test_a_body_that_is_never_in_tension_has_no_smith_watson_topper():
    cycle = sie.Cycle([Uniform(-S, -S, 0.0), Uniform(-2.0 * S, -S, 10.0)])
    assert cycle.swt(0.0, 0.0).value == 0.0


SCENE = sie.Scene(profile=sie.RoundedFlat(1.0, 50.0), body=BODY, normal_load=500.0, friction=0.6)
LOADS = sie.Path([(500.0, 250.0), (500.0, -150.0), (500.0, 250.0)])


@pytest.fixture(scope="module")
def cycle():
    return sie.Cycle(sie.follow(SCENE, LOADS))


@pytest.mark.slow(but=1)
@pytest.mark.parametrize(("name", "y"), [("swt", 0.0), ("findley", 0.05), ("fatemi-socie", 0.0)])
def test_no_place_at_a_depth_exceeds_the_worst_one(name, y, cycle):
    worst = parameters(cycle, None, y)[name]
    x1, x2 = cycle.states[0].edges
    away = (x2 - x1) * np.geomspace(1e-6, 1.0, 15)
    near = np.concatenate((worst.x - away, worst.x + away))
    there = parameters(cycle, np.append(near, worst.x), y)[name].value
    assert (there[:-1] <= worst.value * (1.0 + 1e-6)).all()
    assert there[-1] == pytest.approx(worst.value, rel=1e-9) and worst.y == y


def test_where_two_planes_compete_along_the_surface_the_higher_place_is_found():
    scene = sie.Scene(profile=sie.Power(4, 1e-3), body=BODY, normal_load=50.0, friction=0.5)
    path = sie.Path([(50.0, 10.0), (50.0, -10.0)])
    cycle = sie.Cycle(sie.follow(scene, path))
    y = 0.01 * cycle.states[0].half_width
    worst = cycle.findley(y=y, k=0.3)
    x = cycle.states[0].edges[1] * np.linspace(0.9, 1.05, 200)
    everywhere = cycle.findley(np.concatenate((-x, x)), y, k=0.3).value
    assert everywhere.max() <= worst.value * (1.0 + 1e-9)


def test_at_the_trailing_edge_the_worst_plane_is_across_the_surface(cycle):
    worst = cycle.swt()
    assert worst.x == pytest.approx(cycle.states[0].edges[0], rel=1e-9)
    xx = np.array([float(s.stress(worst.x, 0.0).xx) for s in cycle.states])
    expected = xx.max() * 0.5 * np.ptp(xx) * (1.0 - NU**2) / E
    assert worst.value == pytest.approx(expected, rel=1e-9)


def test_depths_are_answered_one_by_one(cycle):
    depths = np.array([0.02, 0.1])
    worst = cycle.findley(y=depths, k=K)
    assert worst.value.shape == (2,)
    assert worst.value[1] == pytest.approx(cycle.findley(y=0.1, k=K).value, rel=1e-12)


def test_points_have_the_shape_of_the_answer(cycle):
    worst = cycle.swt(np.zeros((3, 1)), np.array([0.1, 0.2]))
    assert worst.value.shape == worst.angle.shape == worst.x.shape == (3, 2)
    assert cycle.swt(np.zeros(0), 0.1).value.shape == (0,)


def test_a_sharp_edge_is_refused_on_the_surface_and_answered_at_a_depth():
    scene = sie.Scene(profile=sie.Flat(1.0), body=BODY, normal_load=500.0, friction=0.6)
    cycle = sie.Cycle(sie.follow(scene, LOADS))
    for x in (None, [0.0, 1.0]):
        with pytest.raises(sie.ContactError, match=r"infinite at x = -?1, .* at a depth"):
            cycle.swt(x)
    assert cycle.swt(y=0.05).value > 0.0


@pytest.mark.parametrize("make", [lambda c: c.swt(0.0), lambda c: c.findley(0.0, k=K)])
def test_without_elastic_constants_a_parameter_is_refused(make):
    scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=1.0, friction=0.5)
    cycle = sie.Cycle(sie.follow(scene, sie.Path([(1.0, 0.3), (1.0, -0.3)])))
    with pytest.raises(ValueError, match="young and poisson"):
        make(cycle)


@pytest.mark.parametrize(("k", "yield_stress"), [(-0.1, YIELD), (K, 0.0), (K, float("nan"))])
def test_constants_of_no_material_are_refused(k, yield_stress, cycle):
    with pytest.raises(ValueError, match=r"k|yield_stress"):
        cycle.fatemi_socie(0.0, k=k, yield_stress=yield_stress)
