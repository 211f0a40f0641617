"""Contact by steps of the load, and of the tilt, where a start for the whole load leads nowhere.

At fixed tilt the patches only grow, appear and merge with the load: dp/dP is the pressure of the
flat punch on the patches, and positive. So the patches of a smaller load are a start for a larger
one. At a fixed moment that is not so: then the whole load at some tilt comes first, and after it
the tilt, along which the moment of the pressure falls.
"""

from __future__ import annotations

from collections.abc import Callable

from sie.errors import ContactError

from .admissible import Found
from .newton import State
from .of_scene import Problem, changed
from .pieces import Pieces
from .repairs import settled

LIGHTEST = 10  # quarters of the load, one of another, of which one has to lead somewhere
FIRST = 2.0  # the first step of the load, as a factor
FINEST = 1.0 + 1e-4  # a step of the load; ...
NARROWEST = 1e-4  # ... and of the tilt, of what is left to go
STEPS = 200

Start = Callable[[Problem], State]


def continued(problem: Problem, pieces: Pieces, start: Start, tilt: float) -> Found:
    """The contact of a problem, from those of smaller loads at this tilt. Raises ContactError."""
    level = changed(problem, tilt=tilt, moment=None)
    found, load = _light(level, pieces, start)
    factor = FIRST
    for _ in range(STEPS):
        if load >= problem.given.load:
            break
        wanted = min(load * factor, problem.given.load)
        try:
            found = settled(found.state, pieces, changed(level, load=wanted))
        except ContactError:
            factor **= 0.5
            if factor < FINEST:
                raise
        else:
            load, factor = wanted, min(factor**2, FIRST)
    return found if problem.given.moment is None else _turned(problem, pieces, found)


def _light(problem: Problem, pieces: Pieces, start: Start) -> tuple[Found, float]:
    """The contact of the largest load, by quarters, that is found from a start of its own."""
    load = problem.given.load
    for _ in range(LIGHTEST):
        load *= 0.25
        lighter = changed(problem, load=load)
        try:
            return settled(start(lighter), pieces, lighter), load
        except ContactError as error:
            last = error
    raise last


def _turned(problem: Problem, pieces: Pieces, found: Found) -> Found:
    """The contact under the moment of a problem, from one of the same load, by steps of it."""
    asked = problem.given.moment
    assert asked is not None
    o = found.operator
    now = float((o.b * (o.H + o.H0 + found.state.tilt) * o.panels.points.x).sum())
    step = asked - now
    for _ in range(STEPS):
        wanted = asked if abs(asked - now) <= abs(step) else now + step
        try:
            found = settled(found.state, pieces, changed(problem, moment=wanted))
        except ContactError:
            step *= 0.5
            if abs(step) < NARROWEST * abs(asked - now):
                raise
        else:
            if wanted == asked:
                break
            now, step = wanted, 2.0 * step
    return found
