"""Laws of load paths of every kind: bounds of the shear, work, memory, symmetry, steady state."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import sie
from oracles.random_histories import KINDS, random_path

MODULUS, RADIUS, FRICTION, LOAD = 3.0, 2.0, 0.4, 1.7
HALF = np.sqrt(4.0 * LOAD * RADIUS / (np.pi * MODULUS))  # of the contact under LOAD
PROFILES = (
    sie.Parabola(RADIUS),
    sie.Polynomial((0.0, 0.0, 0.5 / RADIUS, 0.2 / RADIUS**2, 0.2 / RADIUS**3)),
)
Q_UNIT = FRICTION * LOAD
NODES = 12
# Kinds whose energy is known along the whole path: where P, σ and tilt change together a front may
# be held up at first, or at a moment come to an earlier one, and then only its end is known.
KNOWN = tuple(kind for kind in KINDS if not kind.startswith("in phase") and kind != "moment")
CLOSED = tuple(kind for kind in KINDS if kind != "moment")
UNITS = np.array([LOAD, Q_UNIT, 4.0 * Q_UNIT / (np.pi * HALF)])


@st.composite
def paths(draw, kinds=tuple(KINDS), profiles=PROFILES):
    """A scene and a path of one of the kinds, with lengths, stresses and friction of its own."""
    kind, seed = draw(st.sampled_from(kinds)), draw(st.integers(0, 2**32 - 1))
    points = np.array(random_path(kind, np.random.default_rng(seed)))
    unit = LOAD * HALF if kind == "moment" else HALF / RADIUS
    turns = {"moment" if kind == "moment" else "tilt": (unit * points[:, 3]).tolist()}
    profile, loads = draw(st.sampled_from(profiles)), {"normal_load": LOAD, "friction": FRICTION}
    scene = sie.Scene(profile=profile, modulus=MODULUS, **loads)
    return scene, sie.Path((points[:, :3] * UNITS).tolist(), **turns)


def inside(solution, n=41):
    x1, x2 = solution.edges
    return 0.5 * (x1 + x2) - 0.5 * (x2 - x1) * np.cos(np.pi * (np.arange(n) + 0.5) / n)


def apart(one, other):
    """The largest difference of q over the largest f p."""
    x = inside(one)
    bound = FRICTION * float(one.pressure(x).max())
    return float(np.abs(one.shear(x) - other.shear(x)).max()) / bound


def onwards(path, *ends):
    """The path, then straight to each of the ends, (P, Q, σ, turn)."""
    rows = [(*point, turn) for point, turn in zip(path.points, path.turns, strict=True)]
    rows += [tuple(map(float, end)) for end in ends]
    name = "moment" if path.moment else "tilt"
    return sie.Path([row[:3] for row in rows], **{name: [row[3] for row in rows]})


def last_step(path):
    before, end = (np.array((*path.points[k], path.turns[k])) for k in (-2, -1))
    return before, end


def loop_area(scene, path):
    """∮Q dδ - 2/E* ∮(∫q x dx) dτ from the end of the path to the point before, and back.

    The shift δ is that of slip and dδ = -2/(π E*) ln r dQ + 2/E* m dτ without slip. The step back
    passes no earlier turning point on the way, so that all is smooth: Gauss.
    """
    before, end = last_step(path)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    shares = (*(0.5 * (1.0 + nodes)), 1.0)
    there = [end + share * (before - end) for share in shares]
    back = [before + share * (end - before) for share in shares]
    history = sie.follow(scene, onwards(path, *there, *back))
    first = len(path.points) - 1
    area, start = 0.0, history[first]
    for k, change in ((first, before - end), (first + NODES + 1, end - before)):
        *states, last = history[k + 1 : k + NODES + 2]
        area += last.tangential_load * last.shift - start.tangential_load * start.shift
        for state, weight in zip(states, 0.5 * weights, strict=True):
            x1, x2 = state.edges
            Q, dtau = state.tangential_load, 0.25 * change[2]
            moment = state.shear.moment - 0.5 * (x1 + x2) * Q
            elastic = -2.0 / np.pi * np.log(0.5 * (x2 - x1)) * Q / MODULUS
            area += weight * ((elastic - state.shift) * change[1] - 2.0 / MODULUS * moment * dtau)
        start = last
    return area


@pytest.mark.slow
@settings(max_examples=20)
@given(paths())
def test_every_state_is_certified_and_carries_its_load(case):
    """|q| <= f p, = ± f p in slip, slip along q, what sticks does not stretch."""
    for state in sie.follow(*case):
        assert state.check().ok
        assert state.shear.resultant == pytest.approx(state.tangential_load, abs=1e-12 * Q_UNIT)


@pytest.mark.slow
@settings(max_examples=15)
@given(paths())
def test_the_mirror_image_of_a_path_has_the_mirrored_answer(case):
    scene, path = case
    image = sie.Path(
        [(P, -Q, sigma) for P, Q, sigma in path.points],
        tilt=[-turn for turn in path.tilt],
        moment=[-turn for turn in path.moment],
    )
    flipped = replace(scene, profile=scene.profile.mirrored())
    for one, other in zip(sie.follow(scene, path), sie.follow(flipped, image), strict=True):
        x = inside(one)
        bound = FRICTION * float(one.pressure(x).max())
        assert other.shear(-x) == pytest.approx(-one.shear(x), abs=1e-11 * bound)
        assert [[-hi, -lo] for lo, hi in other.stick] == pytest.approx(
            np.array(one.stick), abs=1e-11 * HALF
        )


@settings(max_examples=3)
@given(paths(KNOWN), st.integers(2, 4))
def test_a_path_cut_into_parts_gives_the_same(case, parts):
    scene, path = case
    whole, cut = sie.follow(scene, path), sie.follow(scene, path.subdivided(parts))
    size = Q_UNIT / MODULUS
    for one, other in zip(whole, cut[::parts], strict=True):
        assert apart(one, other) < 1e-10
        assert other.energy_lost == pytest.approx(one.energy_lost, rel=1e-8, abs=1e-11 * size)
        assert other.shift == pytest.approx(one.shift, abs=1e-9 * size)


@pytest.mark.slow
@settings(max_examples=12)
@given(paths(), st.floats(0.1, 0.9), st.floats(0.1, 0.9))
def test_a_loop_within_a_step_is_forgotten(case, first, second):
    """Return-point memory: back by a part of the last step, forth by less, and back to its end."""
    scene, path = case
    before, end = last_step(path)
    turn = end + first * (before - end)
    inner = turn + second * (end - turn)
    loop = sie.follow(scene, onwards(path, turn, inner, turn, end))
    assert apart(loop[-5], loop[-1]) < 1e-10
    assert apart(loop[-4], loop[-2]) < 1e-10


@pytest.mark.slow
@settings(max_examples=4)
@given(paths(CLOSED))
def test_the_energy_of_a_loop_is_its_area(case):
    scene, path = case
    before, end = last_step(path)
    P, Q = before[:2] - end[:2]
    assume(abs(Q) > 1.1 * FRICTION * abs(P))  # slip all the way, or none
    history = sie.follow(scene, onwards(path, before, end))
    try:
        lost, area = history[-1].energy_lost - history[-3].energy_lost, loop_area(scene, path)
    except sie.ContactError:
        return  # a front is held up in an earlier step, or where one load is nearly turned back
    assert area == pytest.approx(lost, rel=1e-9, abs=1e-11 * Q_UNIT**2 / MODULUS)


@pytest.mark.slow
@settings(max_examples=8)
@given(paths())
def test_a_steady_cycle_is_that_of_the_path_that_settles(case):
    scene, path = case
    assume(not path.moment)
    B, A = last_step(path)
    try:
        cycle = sie.steady_cycle(scene, A, B)
    except sie.ContactError:
        return
    *_, first, second, third = sie.follow(scene, onwards(path, B, A, B, A))
    x = inside(first)
    bound = FRICTION * float(first.pressure(x).max())
    change = np.abs(third.shear(x) - second.shear(x))
    assert cycle.shear_range(x) == pytest.approx(change, abs=1e-10 * bound)
    with suppress(sie.ContactError):  # a front is held up on the way
        lost, size = third.energy_lost - first.energy_lost, Q_UNIT**2 / MODULUS
        assert cycle.energy == pytest.approx(lost, rel=1e-8, abs=1e-11 * size)
