"""Paths of P, Q, bulk stress and tilt, in phase or not, and steady cycles.

Stick zones of Hertz are closed forms: its contact under P at a tilt θ is centred at -θ. Energies
and the zones of a lopsided profile come from a step by step solution of the rate problem, given
here with their digits. Random paths are held against a mesh that moves by increments
(`oracles.load_history`), on two grids: its error is of the first order, and has to fall with the
element. Work, memory and steady state are laws that need no reference.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import cycle, islice, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

import sie
from oracles.kalker import Mesh
from oracles.load_history import history as on_a_mesh
from oracles.random_histories import KINDS, MARCHED, random_path
from validation.harness.measures import largest
from validation.harness.records import Claim, Curve, Doing, Record, Table, checked, in_turn

TITLE = "Paths of all loads, and steady cycles"
SECONDS = (4.0, 40.0)
TIMED = False
EXACT, TABULATED, FOLLOWED, IN_PARTS = 1e-12, 2e-7, 1e-12, 1e-11
MARCHED_TO = 1e-9  # of the half-width; the certificate promises ten times as much
# Bounds for the mesh: mean error of q over the largest f p, that of the energy, and their decrease.
MEAN_ERROR, ENERGY_ERROR, HALVED = 4e-3, 3e-2, 0.75
BALANCE = 1e-9
# Elements and increments per step of the two meshes; a moment, whose tilt is not in proportion to
# time, gets parts of a step.
GRIDS, PARTS = ((60, 8), (120, 16)), 4
BY = "this project"

P0, f = np.pi / 4.0, 0.3
F, S = f * P0, 4.0 * f * P0 / np.pi
Points = Sequence[tuple[float, ...]]
Array = NDArray[np.float64]


def _scene(profile: sie.Profile) -> sie.Scene:
    return sie.Scene(profile=profile, modulus=1.0, normal_load=P0, friction=f)


HERTZ = _scene(sie.Parabola(1.0))
LOPSIDED = _scene(sie.Polynomial((0.0, 0.0, 0.5, 0.1, 0.125)))
# Points are (P/P0, Q/F, σ/S, tilt), where P0 has the half-width 1 and S = 4 F/π.
FALLING = [(1, 0, 0), (1, 0.4, 0.1), (0.7, 0.3, 0.3)]
OPPOSITE = [(1, 0, 0), (0.8, 0.05, 0.5)]
IN_PHASE: list[tuple[float, ...]] = [(1, 0, 0), *[(1.2, 0.55, 0.1), (0.9, -0.3, -0.1)] * 3]
OUT_OF_PHASE = [(1, 0.4, 0), (1, 0, 0.2), (1, -0.4, 0), (1, 0, -0.2), (1, 0.4, 0)]
DRAWN = [(1, 0, 0), *[(1.1, 0.5, 0.05), (1, -0.4, -0.05)] * 2]
HELD_UP = [(1, 0, 0), (1.3, 0.55, 0.2), (0.8, -0.3, -0.15), (1.3, 0.55, 0.2)]

MEAN_STRESS, TRAVELLING = "Q cycles under a constant σ", "a stick zone travels"
MARCHED_PATHS: dict[str, Points] = {
    MEAN_STRESS: [(1, 0, 0.3), (1, 0.5, 0.3), (1, -0.5, 0.3), (1, 0.5, 0.3)],
    TRAVELLING: [(1, 0, 0), (1, 0.5, 3)],
    "two stick zones": [(1, 0.06, -0.36), (1, -0.31, 0.08)],
}

# (name, points, (P/P0, tilt) of the stick zone at each point from the second)
ZONES: tuple[tuple[str, Points, Points], ...] = (
    ("P falls, Q and σ grow", FALLING, [(0.6, -0.05), (0.4, -0.15)]),
    ("in phase", IN_PHASE[:4], [(0.65, -0.05), (0.6, -0.05), (0.625, -0.05)]),
    ("P, Q, σ at any rate", HELD_UP, [(0.75, -0.1), (0.5, -0.075), (0.625, -0.0875)]),
    ("Q and σ out of phase", OUT_OF_PHASE, [(0.8, 0.05), (0.6, 0.0), (0.8, 0.05), (0.6, 0.0)]),
)
# (name, scene, points, energy since the start)
ENERGIES: tuple[tuple[str, sie.Scene, Points, float], ...] = (
    ("P falls, Q and σ grow", HERTZ, FALLING, 9.494428e-4),
    ("slip of opposite signs, P falls", HERTZ, OPPOSITE, 4.183032e-4),
    ("Q and σ out of phase", HERTZ, OUT_OF_PHASE, 1.1932322e-3),
)
# (name, scene, A, B, permanent stick zone, energy per cycle)
STEADY: tuple[tuple[Any, ...], ...] = (
    ("lopsided, all vary", LOPSIDED, (1.2, 0.6, 0.15, -0.04), (0.9, -0.2, -0.1, 0.06),
     (-0.75913821, 0.71742219), 8.81199143e-4),
    ("lopsided, mean σ", LOPSIDED, (1, 0.5, 0.3), (1, -0.3, 0.3),
     (-0.77427281, 0.66151665), 8.04651659e-4),
    ("tilt in phase", HERTZ, (1, 0.5, 0, -0.1), (1, -0.5, 0, 0.1),
     (-0.70710678, 0.70710678), 1.77372505e-3),
    ("mean Q", HERTZ, (1.1, 0.7, 0.3), (0.9, 0.1, 0.1),
     (-0.78666003, 0.88666003), 4.41165813e-4),
)  # fmt: skip


def scaled(points: Points) -> list[tuple[float, ...]]:
    return [(P * P0, Q * F, sigma * S, *tilt) for P, Q, sigma, *tilt in points]


def followed(scene: sie.Scene, points: Points, parts: int = 1) -> sie.History:
    loads = scaled(points)
    tilt = [point[3] for point in loads] if len(loads[0]) == 4 else []
    path = sie.Path([point[:3] for point in loads], tilt=tilt)
    return sie.follow(scene, path.subdivided(parts))


def compute(quick: bool) -> Iterator[Record]:
    yield from in_turn(
        ("closed forms", _tabulated()),
        ("steady cycles", _steady()),
        ("marching", _marched(quick)),
        ("laws", _laws()),
        ("random paths on a mesh", _on_meshes(quick)),
    )
    yield from _drawn()


# -- closed forms, and step by step solutions -----------------------------------------------------


def _tabulated() -> Iterator[Record]:
    rows = [(name, _zone_error((points, zones))) for name, points, zones in ZONES]
    named = "no P in the closed form: half of the change of Q alone"
    wrong = [(1.0 - 0.5 * abs(Q), tilt) for (_, Q, _), (_, tilt) in zip(FALLING[1:], ZONES[0][2])]
    what = "stick zones of Hertz under P, Q and σ: largest error / half-width"
    error = largest(error for _, error in rows)
    yield Claim(what, BY, error, _zone_error((FALLING, wrong)), named, high=EXACT)
    yield Table("Stick zones of Hertz against closed forms", ("path", "error"), rows)
    yield checked(
        lambda cases: largest(
            abs(followed(scene, points)[-1].energy_lost / energy - 1.0)
            for _, scene, points, energy in cases
        ),
        ENERGIES,
        [("", HERTZ, FALLING[::2], ENERGIES[0][3])],
        what="energy along a path against step by step solutions: largest relative error",
        by=BY,
        named="straight to the last point of the first path",
        high=TABULATED,
    )


def _zone_error(case: tuple[Points, Points]) -> float:
    points, zones = case
    return largest(
        abs(end - (sign * np.sqrt(level) - tilt))
        for solution, (level, tilt) in zip(list(followed(HERTZ, points))[1:], zones, strict=True)
        for end, sign in zip(solution.stick[0], (-1.0, 1.0), strict=True)
    )


def _steady() -> Iterator[Record]:
    rows = []
    for name, scene, A, B, zone, energy in STEADY:
        cycle = _cycle(scene, A, B)
        ends = largest(abs(a - b) for a, b in zip(cycle.stick[0], zone, strict=True))
        rows.append((name, ends, abs(cycle.energy / energy - 1.0)))
    name, scene, A, B, zone, energy = STEADY[-1]
    other = _cycle(scene, A, (*B[:2], A[2]))
    named = f"{name}, with σ held at that of A"
    wrong = largest(abs(a - b) for a, b in zip(other.stick[0], zone, strict=True))
    what = "permanent stick zones against step by step solutions: largest error / half-width"
    yield Claim(what, BY, largest(row[1] for row in rows), wrong, named, high=1e-8)
    what = "energy per steady cycle against step by step solutions: largest relative error"
    spoiled = abs(other.energy / energy - 1.0)
    yield Claim(what, BY, largest(row[2] for row in rows), spoiled, named, high=TABULATED)
    header = ("cycle", "error of the stick zone", "error of the energy")
    yield Table("Steady cycles without a history", header, rows)


def _cycle(scene: sie.Scene, A: tuple[float, ...], B: tuple[float, ...]) -> sie.SteadyCycle:
    start, end = scaled([A, B])
    return sie.steady_cycle(scene, start, end)


# -- steps that no layers answer ------------------------------------------------------------------


def _marched(quick: bool) -> Iterator[Record]:
    ends = [abs(end) for end in followed(HERTZ, MARCHED_PATHS[MEAN_STRESS])[3].stick[0]]
    yield checked(
        lambda share: largest(abs(end - np.sqrt(1.0 - share)) for end in ends),
        *(0.5, 0.49),
        what="stick zone of a cycle of Q under a constant σ against Mindlin's without it",
        by=BY,
        named="Mindlin's zone for 0.98 of the range of Q",
        high=MARCHED_TO,
    )
    (c1, c2), (_, Q, sigma) = (
        followed(HERTZ, MARCHED_PATHS[TRAVELLING])[-1].stick[0],
        MARCHED_PATHS[TRAVELLING][1],
    )
    yield checked(
        lambda rate: abs((c2 - c1) / (2.0 * Q * F / (np.pi * 0.25 * rate * S)) - 1.0),
        *(sigma, 0.99 * sigma),
        what="width of a stick zone that travels, 2 |dQ/(π dτ)|: relative error",
        by=BY,
        named="the width of 0.99 of the rate of σ",
        high=MARCHED_TO,
    )
    rows = [
        (name, *_in_parts(points))
        for name, points in MARCHED_PATHS.items()
        if name == TRAVELLING or not quick
    ]
    what = "ends of marched stick zones against the path in three parts: largest error"
    named = "parts of a path that ends at 0.99 of σ"
    error, wrong = largest(row[1] for row in rows), min(row[2] for row in rows)
    yield Claim(f"{what} / half-width", BY, error, wrong, named, high=MARCHED_TO)
    header = ("path", "ends", "those of another path", "residual in the certificate")
    yield Table("Steps that no layers answer, against the same path in parts", header, rows)


def _in_parts(points: Points) -> tuple[float, float, float]:
    """Errors of the ends against a path in parts, and against that to another σ; the residual."""
    whole, (*before, (P, Q, sigma)) = followed(HERTZ, points)[-1], points
    others = [followed(HERTZ, path, 3)[-1] for path in (points, [*before, (P, Q, 0.99 * sigma)])]
    right, wrong = (float(np.abs(np.subtract(whole.stick, o.stick)).max()) for o in others)
    sheared = whole.check().shear
    assert sheared is not None
    return right, wrong, sheared.residual


# -- laws -----------------------------------------------------------------------------------------


def _laws() -> Iterator[Claim]:
    states = followed(HERTZ, OUT_OF_PHASE)
    lost = states[4].energy_lost - states[0].energy_lost
    full, without = (abs(_area(bulk) / lost - 1.0) for bulk in (True, False))
    what, wrong = "energy of a loop of Q and σ against its area", "the work of Q alone"
    yield Claim(what, BY, full, without, wrong, high=BALANCE)
    yield checked(
        _left_by_a_loop,
        (1.0, 0.1, 0.0),
        (1.0, 0.7, 0.2),
        what="q after a nested loop of P, Q and σ, less q before, over f p",
        by=BY,
        named="a loop that is larger than the step before",
        high=FOLLOWED,
    )
    yield checked(
        _unsettled,
        3,
        1,
        what="range of q in the steady cycle, less that of the path from its third turn, over f p",
        by=BY,
        named="the range between the first two turning points",
        high=IN_PARTS,
    )


def _area(bulk: bool, n: int = 16) -> float:
    """∮Q dδ - 2/E* ∮(∫q x dx) dτ, each branch by Gauss's rule: it passes no earlier turning point
    on the way.
    """
    nodes, weights = np.polynomial.legendre.leggauss(n)
    area = 0.0
    for k, (a, b) in enumerate(pairwise(OUT_OF_PHASE)):
        states, shift = _branch(k, np.array([0.0, *(0.5 * (1.0 + nodes)), 1.0]))
        dQ, dsigma = (end - start for start, end in list(zip(*scaled([a, b]), strict=True))[1:])
        area += scaled([b])[0][1] * shift[-1] - scaled([a])[0][1] * shift[0]
        area -= 0.5 * dQ * float(weights @ shift[1:-1])
        if bulk:
            moment = np.array([state.shear.moment for state in states[1:-1]])
            area -= 0.25 * dsigma * float(weights @ moment)
    return area


def _branch(k: int, shares: Array) -> tuple[Sequence[sie.Solution], Array]:
    """The states between two turning points of the loop out of phase, and their shift."""
    a, b = OUT_OF_PHASE[k : k + 2]
    between = [tuple(np.add(a, t * np.subtract(b, a)).tolist()) for t in shares]
    states = followed(HERTZ, [*OUT_OF_PHASE[:k], *between])[k:]
    return states, np.array([state.shift for state in states])


def _left_by_a_loop(corner: tuple[float, ...]) -> float:
    start, end = (1.0, 0.6, 0.1), (0.95, -0.2, -0.05)
    before, _, after = list(followed(LOPSIDED, [start, end, corner, end]))[1:]
    return _apart(before, after)


def _apart(one: sie.Solution, other: sie.Solution) -> float:
    """The largest difference of q over the largest f p."""
    x1, x2 = one.edges
    x = 0.5 * (x1 + x2) + 0.49 * (x2 - x1) * np.linspace(-1.0, 1.0, 81)
    bound = f * float(one.pressure(x).max())
    return float(np.abs(one.shear(x) - other.shear(x)).max()) / bound


def _unsettled(first: int) -> float:
    """The range of q from a turning point of the path in phase to the next, less the steady one."""
    states = followed(HERTZ, IN_PHASE)
    cycle = _cycle(HERTZ, *IN_PHASE[1:3])
    x = np.linspace(-1.0, 1.0, 81)
    found = np.abs(states[first].shear(x) - states[first + 1].shear(x))
    return float(np.abs(found - cycle.shear_range(x)).max()) / (0.5 * f)


# -- random paths on a mesh -----------------------------------------------------------------------


def _of_kind(kind: str, rng: np.random.Generator, scenes: Sequence[sie.Scene]) -> sie.History:
    """A random path of this kind along which slip dissipates energy."""
    while True:
        scene, points = scenes[int(rng.integers(len(scenes)))], random_path(kind, rng)
        loads, turns = scaled([point[:3] for point in points]), [point[3] for point in points]
        if kind == "moment":
            path = sie.Path(loads, moment=[turn * P0 for turn in turns]).subdivided(PARTS)
        else:
            path = sie.Path(loads, tilt=turns)
        states = sie.follow(scene, path)
        if not _energy(states) <= 1e-3 * F * F:
            return states


def _on_meshes(quick: bool) -> Iterator[Record]:
    scenes, number = ((HERTZ,), 2) if quick else ((HERTZ, LOPSIDED), 60)
    rng = np.random.default_rng(17)
    kinds = list(islice(cycle([*KINDS, *MARCHED]), number))
    paths = [_of_kind(kind, rng, scenes) for kind in kinds]
    found = []
    for k, states in enumerate(paths):
        yield Doing(f"random path {k} on a mesh")
        found.append([_errors(states, grid) for grid in GRIDS])
    coarse, fine = (np.nanmean([row[k] for row in found], axis=0) for k in (0, 1))
    mirrored, less = ([_errors(paths[0], grid, share) for grid in GRIDS] for share in (-1.0, 0.9))
    what = f"{number} random paths against a mesh: "
    for quantity, (low, high), wrong, named, bar in (
        ("q over the peak of f p", (fine[0], coarse[0]), [e[0] for e in mirrored],
         "the mesh under -Q and -σ", MEAN_ERROR),
        ("energy over itself", (fine[1], coarse[1]), [e[1] for e in less],
         "the mesh under 0.9 Q and 0.9 σ", ENERGY_ERROR),
    ):  # fmt: skip
        yield Claim(f"{what}mean error of {quantity}", BY, low, wrong[1], named, high=bar)
        falls = f"{what}how the mean error of {quantity} falls with half the element"
        yield Claim(falls, BY, low / high, wrong[1] / wrong[0], named, high=HALVED)
    rows = [
        (k, kind, _profile(states), *(error for grid in row for error in grid))
        for k, (kind, states, row) in enumerate(zip(kinds, paths, found, strict=True))
    ]
    header = ("path", "kind", "profile", "q, coarse", "energy", "q, fine", "energy")
    yield Table("Random paths against a mesh on two grids", header, rows)


def _profile(states: sie.History) -> str:
    return "Hertz" if states.scene.profile == HERTZ.profile else "lopsided"


def _energy(states: sie.History) -> float:
    """The energy lost along a path, nan where a front is held up and only its end is known."""
    try:
        return states[-1].energy_lost
    except sie.ContactError:
        return math.nan


def _errors(states: sie.History, grid: tuple[int, int], share: float = 1.0) -> tuple[float, float]:
    """The largest mean error of q at a turning point over the peak of f p, and that of the energy
    over itself, nan where it is not known, against a mesh that follows the path with this share of
    Q and σ.
    """
    n, increments = grid
    mesh, height = Mesh((-1.4, 1.4), n, 1.0), states.scene.profile.height
    points = [
        (P, share * Q, share * sigma, state.tilt)
        for (P, Q, sigma), state in zip(states.path.points, states, strict=True)
    ]
    steps = increments // PARTS if states.path.moment else increments
    found = on_a_mesh(mesh, height, f, points, steps)
    q = largest(
        float(np.abs(state.shear(mesh.x) - true.shear).mean())
        for state, true in zip(states, found, strict=True)
    )
    return q / (0.5 * f), abs(found[-1].energy / _energy(states) - 1.0)


# -- curves ---------------------------------------------------------------------------------------


def _drawn() -> Iterator[Curve]:
    share = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 25)))
    for k, name in enumerate(("Q falls, σ grows", "Q, σ fall", "Q grows, σ falls", "Q, σ grow")):
        states, shift = _branch(k, share)
        Q = [state.tangential_load / F for state in states]
        yield Curve("loop", name, shift, Q)
    for k in range(1, len(DRAWN)):  # a new stick zone begins at the edges
        before, *states = list(followed(HERTZ, DRAWN[: k + 1], 24))[24 * (k - 1) :]
        steps = k - 1 + np.linspace(0.0, 1.0, 25)
        zones = [before.edges, *(state.stick[0] for state in states)]
        for side in (0, 1):
            yield Curve("zones", "stick zone", steps, [zone[side] for zone in zones])
            edges = [state.edges[side] for state in (before, *states)]
            yield Curve("zones", "contact", steps, edges)
