"""Newton's method for the ends of the zones.

Unknown are the edges of the contact, and the logarithms of the widths of all zones but the widest:
they stay positive, and keep their digits. The zones are found by a quick rule first, whose
derivatives serve for the last digits.

The zones that Newton's method starts from are those of cells, narrower towards the edges, as if
bodies were alike and p were known.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sie.friction.cells import compliance, slip_of_cells

from .goodman import Uncoupled
from .pieces import FINE, QUICK, Fineness, Pieces
from .state import Question, State

Array = NDArray[np.float64]

SETTLED, ACCEPTED = 2e-13, 1e-11  # of P and f P: what the conditions may miss
ROUGHLY = 1e-7  # the same by the quick rule
MOST_STEPS, HALVINGS = 25, 5
DIFFERENCE, NARROWEST = 1e-6, 1e-6  # for derivatives: of widths, and of zones at the edges
FOLDS = 1.0  # by which a step may change a width
CELLS = 72
LEAST = 1e-9  # of a cell, and of what it carries
STALE = 0.4  # of what was missed: a slower step asks for new derivatives


class Zones(NamedTuple):
    """Ends of zones by the left edge and widths, their signs, and marks inside them."""

    left: float
    widths: tuple[float, ...]
    signs: tuple[int, ...]

    @property
    def ends(self) -> Array:
        """The ends, ascending."""
        return self.left + np.append(0.0, np.cumsum(self.widths))

    @property
    def stick(self) -> tuple[tuple[float, float], ...]:
        """The stick zones."""
        ends = self.ends.tolist()
        return tuple((ends[k], ends[k + 1]) for k, sign in enumerate(self.signs) if not sign)

    @property
    def slip(self) -> tuple[tuple[float, float, int], ...]:
        """(lo, hi, sign of q) of the slip zones."""
        ends = self.ends.tolist()
        return tuple((ends[k], ends[k + 1], sign) for k, sign in enumerate(self.signs) if sign)


def zones_between(ends: Array, signs: tuple[int, ...]) -> Zones:
    """Zones from their ends."""
    return Zones(float(ends[0]), tuple(np.diff(ends).tolist()), signs)


def zones_of(state: State) -> Zones:
    """The zones of a state."""
    return Zones(state.pieces.left, state.pieces.widths, state.pieces.signs)


class Found(NamedTuple):
    """A state, its unknowns, and the derivatives of what it misses."""

    state: State
    unknowns: Array
    slopes: Array | None


class Unknowns(NamedTuple):
    """What Newton's method looks for: both edges over a unit, then ln of other widths.

    signs       of the zones
    widest      the zone whose width is what the others leave
    unit        of the edges
    """

    signs: tuple[int, ...]
    widest: int
    unit: float

    def told(self, zones: Zones) -> Array:
        """The unknowns of zones."""
        edges = zones.ends[[0, -1]] / self.unit
        return np.append(edges, np.log(np.delete(zones.widths, self.widest)))

    def zones(self, u: Array) -> Zones | None:
        """The zones of unknowns, if there are any."""
        left, right = (u[:2] * self.unit).tolist()
        widths = np.exp(u[2:]).tolist()
        widths.insert(self.widest, right - left - sum(widths))
        return Zones(left, tuple(widths), self.signs) if widths[self.widest] > 0.0 else None

    def through(self, u: Array, end: int, mark: float) -> Array:
        """The unknowns of which one edge is replaced so that an end of a zone is at a mark."""
        u, widths = u.copy(), np.insert(np.exp(u[2:]), self.widest, 0.0)
        if end <= self.widest:
            u[0] = (mark - widths[:end].sum()) / self.unit
        else:
            u[1] = (mark + widths[end:].sum()) / self.unit
        return u


def _unknowns(zones: Zones) -> Unknowns:
    return Unknowns(zones.signs, int(np.argmax(zones.widths)), 0.5 * float(sum(zones.widths)))


Trial = Callable[[Array], tuple[State | None, Array]]
NOWHERE: Array = np.array([math.inf])  # what is missed where zones overlap


def settled(
    question: Question, start: Zones, marks: tuple[float, ...], accepted: float = ACCEPTED
) -> State | None:
    """The state next to zones that miss its conditions, or None."""
    unknowns = _unknowns(start)

    def trial(fineness: Fineness) -> Trial:
        def state(u: Array) -> tuple[State | None, Array]:
            zones = unknowns.zones(u)
            found = _state(question, zones, marks, fineness) if zones else None
            return found, found.missed if found else NOWHERE

        return state

    told, rough = (unknowns.told(start), None), (ROUGHLY, ROUGHLY)
    found = _descended(trial(QUICK), told, rough)
    if found is not None and accepted < ROUGHLY:
        found = _descended(trial(FINE), found[1:], (SETTLED, accepted))
    return found.state if found else None


def passing(
    question: Callable[[float], Question],
    start: tuple[float, Zones],
    marks: tuple[float, ...],
    end: int,
    mark: float,
) -> tuple[float, State] | None:
    """The part of a way, and the state roughly, where an end of the zones is at a mark.

    The part takes the place of an edge among the unknowns.
    """
    part, zones = start
    ends = zones.ends
    ends[end] = mark
    if not (np.diff(ends) > 0.0).all():
        return None
    zones = zones_between(ends, zones.signs)
    unknowns = _unknowns(zones)
    edge = 0 if end <= unknowns.widest else 1

    def trial(u: Array) -> tuple[State | None, Array]:
        now = unknowns.zones(unknowns.through(u, end, mark))
        found = _state(question(float(u[edge])), now, marks, QUICK) if now else None
        return found, found.missed if found else NOWHERE

    u = unknowns.told(zones)
    u[edge] = part
    found = _descended(trial, (u, None), (ROUGHLY, ROUGHLY))
    return (float(found.unknowns[edge]), found.state) if found else None


def _state(question: Question, zones: Zones, marks: tuple[float, ...], fineness: Fineness) -> State:
    kinks, theta = question.slope.kinks, question.theta
    pieces = Pieces(zones.left, zones.widths, zones.signs, marks, kinks, theta, fineness)
    return state_of(pieces, question)


def state_of(pieces: Pieces, question: Question) -> State:
    """The state for zones, in Goodman's approximation if that is asked for."""
    return Uncoupled(pieces, question) if question.approximate else State(pieces, question)


def _descended(
    trial: Trial,
    start: tuple[Array, Array | None],
    limits: tuple[float, float],
) -> Found | None:
    """Newton's method until no more than the first limit is missed; the second one is accepted."""
    u, slopes = start
    (state, missed), fresh = trial(u), False
    enough, accepted = limits
    for _ in range(MOST_STEPS):
        size = float(np.abs(missed).max())
        if not math.isfinite(size):
            return None
        if size <= enough:
            break
        if slopes is None:
            slopes, fresh = _slopes(trial, u, missed), True
        if not np.isfinite(slopes).all():
            return None
        step = np.asarray(np.linalg.lstsq(slopes, -missed, rcond=None)[0], dtype=float)
        step *= min(1.0, FOLDS / float(np.abs(step).max()))
        shortened = _shortened(trial, u, step, size)
        if shortened is None:
            if fresh or size <= accepted:
                break
            slopes = None
            continue
        new, after, less = shortened
        change, moved = less - missed, new - u
        u, state, missed, fresh = new, after, less, False
        if float(np.abs(missed).max()) > STALE * size:
            slopes = None
        else:  # Broyden's update
            slopes = slopes + np.outer(change - slopes @ moved, moved) / float(moved @ moved)
    if state is None or float(np.abs(missed).max()) > accepted:
        return None
    return Found(state, u, slopes)


def _slopes(trial: Trial, u: Array, missed: Array) -> Array:
    columns, narrowest = [], min(1.0, max(math.exp(min(u[2:], default=0.0)), NARROWEST))
    for k in range(len(u)):
        other = u.copy()
        other[k] += DIFFERENCE * (narrowest if k < 2 else 1.0)
        columns.append((trial(other)[1] - missed) / (other[k] - u[k]))
    return np.stack(columns, axis=1)


def _shortened(
    trial: Trial, u: Array, step: Array, size: float
) -> tuple[Array, State | None, Array] | None:
    """Unknowns and state after a step that is halved until less is missed."""
    for _ in range(HALVINGS):
        state, missed = trial(u + step)
        if float(np.abs(missed).max()) < size:
            return u + step, state, missed
        step = 0.5 * step
    return None


# -- the start on cells --------------------------------------------------------------------------


class Carried(NamedTuple):
    """Friction on cells.

    cuts        the ends of the cells, lengths
    limit       f p of each cell after the step
    before      q before the step
    """

    cuts: Array
    limit: Array
    before: Array


def cuts_between(x1: float, x2: float) -> Array:
    """Ends of cells on a contact."""
    angle = np.linspace(0.0, math.pi, CELLS + 1)
    cuts: Array = 0.5 * (x1 + x2) - 0.5 * (x2 - x1) * np.cos(angle)
    return cuts


def zones_on_cells(cells: Carried, dQ: float, strain: float) -> Zones | None:
    """The zones after changes of Q and the strain; None where no cell sticks."""
    edges = np.stack((cells.cuts[:-1], cells.cuts[1:]), axis=1)
    A = compliance(edges, float(np.ptp(cells.cuts)))
    found = slip_of_cells(edges, (cells.before, cells.limit), (dQ, strain), A)
    if found is None or found[0].all():
        return None
    signs, change = found[0].astype(int), found[1] - cells.before
    stuck = np.flatnonzero(signs == 0)
    signs[stuck[0] : stuck[-1]] = 0  # slip inside the stick zone is not solved
    stretches = _runs(signs)
    if len(stretches) == 1 and signs.any():
        return None  # a single cell that sticks was dropped
    ends = [float(cells.cuts[a]) for a, _, _ in stretches] + [float(cells.cuts[-1])]
    kinds = [sign for _, _, sign in stretches]
    if not kinds[0]:
        width, sign = _narrow(cells, change, 0)
        ends, kinds = [ends[0], ends[0] + width, *ends[1:]], [sign, *kinds]
    if not kinds[-1]:
        width, sign = _narrow(cells, change, -1)
        ends, kinds = [*ends[:-1], ends[-1] - width, ends[-1]], [*kinds, sign]
    return zones_between(np.array(ends), tuple(kinds))


def _narrow(cells: Carried, change: Array, cell: int) -> tuple[float, int]:
    """Width and sign of a slip zone within a cell at an edge, by the change if all of it sticks.

    That is c/√d at the distance d from the edge, f p is k √d, and slip ends at 2c/k.
    """
    sign = 1 if change[cell] > 0.0 else -1
    width = float(cells.cuts[1] - cells.cuts[0]) if cell == 0 else float(np.diff(cells.cuts)[-1])
    left = max(cells.limit[cell] - sign * cells.before[cell], LEAST * cells.limit[cell])
    part = 2.0 / 3.0 * abs(float(change[cell])) / left
    return width * min(max(part, LEAST), 0.5), sign


def _runs(signs: NDArray[np.intp]) -> list[tuple[int, int, int]]:
    """(first, last + 1, sign) of cells of one kind, without single cells between equal ones."""
    signs = signs.copy()
    alone = (signs[1:-1] != signs[:-2]) & (signs[:-2] == signs[2:])
    signs[1:-1][alone] = signs[:-2][alone]
    starts = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist(), len(signs)]
    return [(a, b, int(signs[a])) for a, b in pairwise(starts)]
