"""Load paths: turning points, and what each step between two of them overwrites. Floats only: nothing is solved here.

What is covered is told in `history`; a step that is not raises ContactError, which names it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from numbers import Integral
from typing import Any

from sie import arguments
from sie.errors import ContactError
from sie.friction.memory import Ladder, Slipped
from sie.friction.partial_slip import refuse_sliding
from sie.numerics.interval import EPS

from .scene import Scene

TOUCHING = "the bodies must touch all along the path, which may begin at (0, 0, 0)"
ROUNDED = 4.0 * EPS  # of f P: by so much a rise in proportion may exceed |dQ| = f dP
PROPORTIONAL = (
    1e-12  # of the largest bulk stress: what (Q, σ) may be off a straight line through the origin
)


@dataclass(frozen=True)
class Path:
    """Turning points (P, Q, σ) of the normal load, the tangential load and the bulk stress; σ may be left out.

    >>> Path([(10.0, 0.0), (10.0, 2.0), (10.0, -2.0)]).points[1]
    (10.0, 2.0, 0.0)
    """

    points: tuple[tuple[float, float, float], ...]

    def __init__(self, points: Iterable[Sequence[float]]) -> None:
        given = arguments.listed("points", points, "[(P, Q, σ), ...]")
        found = tuple(_point(k, point) for k, point in enumerate(given))
        if not found:
            raise ValueError("the path has no points: give [(P, Q, σ), ...]")
        touching = next((k for k, (P, _, _) in enumerate(found) if P > 0.0), None)
        if touching is None:
            raise ValueError(
                "P = 0 at every point of the path: nothing ever touches; add a point with P > 0"
            )
        for k, (P, _, _) in enumerate(found):
            if P == 0.0 and k > touching:
                raise ValueError(f"P of point {k} = 0 is not positive: {TOUCHING}")
        object.__setattr__(self, "points", found)

    def __len__(self) -> int:
        return len(self.points)

    def subdivided(self, parts: int) -> Path:
        """The same path with every step in so many equal parts, but for that to its first point: shows what happens between two of them.

        >>> Path([(10.0, 0.0), (10.0, 2.0)]).subdivided(2)
        Path([(10.0, 0.0, 0.0), (10.0, 1.0, 0.0), (10.0, 2.0, 0.0)])
        """
        if isinstance(parts, bool) or not isinstance(parts, Integral) or parts < 1:
            raise ValueError(
                f"parts = {parts!r} is not a whole number of at least 1: give how many parts a step gets"
            )
        shares = [k / int(parts) for k in range(1, int(parts))]
        points = [self.points[0]]
        for end in self.points[1:]:
            start = points[-1]
            points += [
                tuple(a + share * (b - a) for a, b in zip(start, end, strict=True))
                for share in shares
            ]
            points.append(end)
        return Path(points)

    def __repr__(self) -> str:
        return f"Path({list(self.points)!r})"


def _point(k: int, point: Any) -> tuple[float, float, float]:
    try:
        values = tuple(point)
    except TypeError:
        values = ()
    if len(values) not in (2, 3):
        raise ValueError(f"point {k} of the path is {point!r}: give (P, Q) or (P, Q, σ)")
    P, Q, sigma = (
        arguments.finite(f"{name} of point {k}", v)
        for name, v in zip("PQσ", (*values, 0.0)[:3], strict=True)
    )
    if P < 0.0 or (P == 0.0 and (Q != 0.0 or sigma != 0.0)):
        raise ValueError(f"P of point {k} = {P:g} is not positive: {TOUCHING}")
    return P, Q, sigma


@dataclass(frozen=True)
class State:
    """A turning point: its loads, the ladder there, and what slipped since the last one, in the order of time."""

    loads: tuple[float, float, float]
    ladder: Ladder
    slips: tuple[Slipped, ...] = ()

    @property
    def last(self) -> Slipped | None:
        """What slips at the end of the step; None if nothing does, or what slipped has left the contact."""
        return self.slips[-1] if self.slips and self.slips[-1].layers[-1].lower > 0.0 else None


def direction(path: Path) -> tuple[float, float]:
    """(Q, σ) of one unit of amplitude: (1, 0) without bulk stress."""
    _, Q, sigma = max(path.points, key=lambda point: abs(point[2]))
    return (Q, sigma) if sigma else (1.0, 0.0)


def states(scene: Scene, path: Path) -> tuple[State, ...]:
    unit, f = direction(path), scene.friction
    state = State((0.0, 0.0, 0.0), Ladder(0.0))
    found = []
    for k, loads in enumerate(path.points):
        P, Q, _ = loads
        if f == 0.0 and Q != 0.0:
            raise ValueError(
                f"Q of point {k} = {Q:g} without friction: a frictionless contact carries none; give friction > 0"
            )
        try:
            refuse_sliding(f, P, Q)
            before = State((P, 0.0, 0.0), Ladder(_size(f, P, unit))) if k == 0 else state
            state = _stepped(scene, before, loads, unit)
        except ContactError as problem:
            raise type(problem)(
                f"step {k} of the path, to (P, Q, σ) = {_shown(loads)}: {problem}", step=k
            ) from None
        found.append(state)
    return tuple(found)


def _shown(loads: tuple[float, float, float]) -> str:
    return f"({', '.join(f'{v:.6g}' for v in loads)})"


def _size(f: float, P: float, unit: tuple[float, float]) -> float:
    return f * P / abs(unit[0]) if unit[0] else math.inf


def _stepped(
    scene: Scene, before: State, loads: tuple[float, float, float], unit: tuple[float, float]
) -> State:
    (P0, Q0, sigma0), (P, Q, sigma), f = before.loads, loads, scene.friction
    if f == 0.0:
        return State(loads, Ladder(0.0))
    amplitude = sigma / unit[1] if unit[1] else Q
    if abs(amplitude * unit[0] - Q) > PROPORTIONAL * max(abs(unit[0]), f * P * EPS):
        raise ContactError(
            f"(Q, σ) is not in proportion to ({unit[0]:.6g}, {unit[1]:.6g}), the path's largest bulk stress: the zones of slip of one "
            "direction do not contain those of the other; keep Q and σ in proportion, or leave σ out"
        )
    if P == P0:
        return _pulled(loads, before.ladder, amplitude)
    if (Q0, sigma0) == (Q, sigma) == (0.0, 0.0) and before.ladder.top is None:
        return State(loads, Ladder(_size(f, P, unit)))  # nothing was ever sheared
    if unit[1]:
        raise ContactError(
            "P changes on a path with a bulk stress, after it or together with it: no superposition is exact then; "
            "reach P before Q and σ and keep it constant, or leave σ out"
        )
    if scene.moment is not None and not (scene.moment == 0.0 == scene.profile.axis):
        raise ContactError(
            "P changes at a given moment, which tilts the profile: its contacts are not nested; give tilt instead"
        )
    if P > P0:
        rise = f * (P - P0)
        k = (Q - Q0) / rise
        ladder = replace(before.ladder.thickened(rise, min(max(k, -1.0), 1.0)), size=f * P)
        if abs(Q - Q0) <= rise + ROUNDED * f * P:
            return State(loads, ladder)
        pulled = _pulled(loads, ladder, Q)
        return replace(pulled, slips=tuple(slip.while_raised(rise) for slip in pulled.slips))
    ladder, slips = before.ladder.lowered(f * (P0 - P), (Q - Q0) / (f * (P0 - P)))
    return State(loads, replace(ladder, size=f * P), slips)


def _pulled(loads: tuple[float, float, float], ladder: Ladder, amplitude: float) -> State:
    step = amplitude - ladder.total
    if abs(step) <= 4.0 * EPS * max(abs(amplitude), abs(ladder.total)):
        return State(loads, ladder)
    new, done = ladder.pulled(step)
    return State(loads, new, (Slipped(math.copysign(1.0, step), done),) if done else ())
