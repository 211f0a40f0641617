"""The events that end a part of a step on which something comes to stick.

They are roots over the part: an end recedes no longer (s K = 0), turns, or comes to a mark of the
shear; a stuck edge begins to slip (|K| = f K_p); an advancing end meets an edge or another stick
zone; slip begins inside a stick zone (|q| = f p).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .loading import TAU, at_share, in_time
from .onset import ROUNDED, End, Motion
from .state import EXCEEDED
from .strips import Panel, StripEquations

Array = NDArray[np.float64]

FINE = np.linspace(0.02, 1.0, 197)  # shares of τ at which events are looked for
BEYOND = 1.75  # times τ: so far ahead an arrival is seen
ARRIVED = 1e-7  # of the contact: room that is none
AGAIN_SINCE = 0.7  # of τ: before it an event at the end of a part is not looked for again
OPENS = 0.3  # of τ: before it slip that begins inside stick is too short for its K
AT_THE_END = 1e-9  # of a part: an event so close to its end is there
UNRESOLVED = 1e-6  # of the largest coefficient of D: the last two
AT_AN_EDGE = 1e-6  # of the contact: slip that begins so near to an edge begins at it
NO_ROOM = 1e-6  # of the contact: so little room is none where an end comes near an edge in steps


@dataclass(frozen=True)
class Event:
    """What ends a part: the share of τ, end j of the stick zones, and what it does next.

    place   where the end is then, if that is known: at a mark, an edge, another zone
    """

    share: float
    j: int
    then: End | None = None
    place: float | None = None
    opened: tuple[float, float] | None = None  # where slip begins in stick, and its direction

    @property
    def arrives(self) -> bool:
        """Whether an advancing end meets an edge or another stick zone."""
        return self.place is not None and bool(np.isnan(self.place))

    def ahead(self, length: float) -> float:
        """From the end of a part to an arrival; inf to another event."""
        return length * (self.share**2 - 1.0) if self.arrives else np.inf


def first_event(panel: Panel, last: Event | None, beyond: bool) -> Event | None:
    """The first event of a part.

    last     that by which the part was shortened
    beyond   an arrival a little later counts too
    """
    upto = BEYOND if beyond else 1.0
    found = [*_of_ends(panel, last, upto), *_of_edges(panel), *_arrivals(panel, upto)]
    sooner = min((event.share for event in found), default=np.inf)
    if panel.unresolved <= UNRESOLVED:
        found += _openings(panel, last.opened if last else None, sooner)
    return min(found, key=lambda event: event.share, default=None)


def _root(series: Array, upto: float = 1.0, since: float = 0.0) -> float | None:
    """The first τ, or one soon after 1, at which a series is below zero."""
    shares = np.append(FINE, np.arange(1.0005, max(upto, 1.002), 5e-4))
    shares = shares[shares >= since]
    values = at_share(series, shares)
    negative = np.flatnonzero(values < 0.0)
    if not negative.size:
        return None
    positive = np.flatnonzero(values[: negative[0]] >= 0.0)
    if not positive.size:
        return float(shares[0])
    lo, hi = shares[positive[-1]], shares[positive[-1] + 1]
    for _ in range(60):
        middle = 0.5 * (lo + hi)
        lo, hi = (lo, middle) if at_share(series, middle) < 0.0 else (middle, hi)
    return float(0.5 * (lo + hi))


def _of_ends(panel: Panel, last: Event | None, upto: float) -> Iterator[Event]:
    """Ends that stop, turn, or come to a mark; to that sought, later too."""
    span, K = panel.span, np.array([r.K.ravel() for r in panel.rates])
    marks = np.unique(np.concatenate((span.before.marks, span.contacts[-1].limit.marks)))
    edges = np.array([c.patches for c in (span.before.contact, span.contacts[-1])]).ravel()
    opened = span.onset.opened
    for j, end in enumerate(span.onset.ends):
        path = np.append(span.start[j], panel.places[:, j])
        series = in_time(path)
        if end.motion is Motion.RECEDES:
            opens = opened is not None and j - opened in (0, 1)
            share = _root(in_time(end.sense * K[:, j]), since=OPENS if opens else 0.0)
            if share is not None:
                yield Event(share, j, End(0.0, end.sense, Motion.ADVANCES))
        outward = 1.0 if j % 2 else -1.0
        if end.motion is Motion.ADVANCES:
            speed = np.asarray(np.polynomial.chebyshev.chebder(outward * series), np.float64)
            share = _root(speed)
            if share is not None:
                yield Event(share, j, End(0.0, end.sense, Motion.RECEDES))
        way = np.sign(path[-1] - path[0])
        near = 1e-9 * span.before.contact.width
        sought = marks == (last.place if last is not None and last.j == j else np.nan)
        passed = way * (path[-1] - marks) > -(upto**2 - 0.998) * abs(path[-1] - path[0])
        for mark in marks[(way * (marks - path[0]) > near) & (passed | sought)]:
            if (
                np.abs(edges - mark).min() < near
                and mark not in span.contacts[-1].limit.marks[1:-1]
            ):
                continue
            shifted = -way * series
            shifted[0] += way * mark
            share = _root(shifted, BEYOND if last is not None and last.place == mark else upto)
            if share is not None:
                then = end.motion if end.motion is Motion.ADVANCES else None
                yield Event(share, j, End(0.0, end.sense, then) if then else None, float(mark))


def _of_edges(panel: Panel) -> Iterator[Event]:
    """Stuck edges that begin to slip."""
    old = np.array(panel.span.onset.patches).ravel()
    for j in panel.span.which(Motion.GROWS):
        k = int(np.abs(old - panel.span.start[j]).argmin())
        K = np.array([r.K.ravel()[j] for r in panel.rates])
        Kp = np.array([(1.0 + ROUNDED) * r.friction * r.Kp.ravel()[k] for r in panel.rates])
        for sense in (1.0, -1.0):
            share = _root(in_time(Kp - sense * K))
            if share is not None:
                yield Event(share, j, End(0.0, sense))


def _arrivals(panel: Panel, upto: float) -> Iterator[Event]:
    """Advancing ends that meet an edge, or another stick zone."""
    span = panel.span
    for j in span.which(Motion.ADVANCES):
        share = _root(in_time(_room(panel, j) - ARRIVED * span.before.contact.width), upto)
        if share is not None:
            yield Event(share, j, place=np.nan)


def _room(panel: Panel, j: int) -> Array:
    """The room that is left to an advancing end, at the start and at the moments."""
    span = panel.span
    outer = [
        span.onset.placed(ends).on(c.patches).outer(j)
        for ends, c in zip(panel.places, span.contacts, strict=True)
    ]
    return np.abs(
        np.append(span.onset.outer(j), outer) - np.append(span.start[j], panel.places[:, j])
    )


def is_there(panel: Panel, event: Event) -> bool:
    """Whether an event is an arrival for which next to no room is left."""
    return event.arrives and bool(
        _room(panel, event.j)[-1] <= NO_ROOM * panel.span.before.contact.width
    )


def _openings(panel: Panel, known: tuple[float, float] | None, sooner: float) -> Iterator[Event]:
    """Slip that begins inside a stick zone, before a share of τ at which another event is.

    known: the place, and the direction of slip, if a longer part told them
    """
    peak, since = panel.span.before.contact.peak, AGAIN_SINCE
    for i, now in enumerate(panel.equations if known is None else []):
        if TAU[i + 1] > sooner + AT_THE_END:
            return
        if panel.span.onset.opened is not None and TAU[i + 1] < OPENS:
            continue
        if now.excess * now.after.peak > EXCEEDED * peak:
            x, q, limit = now.stuck_shear
            k = int((np.abs(q) - limit).argmax())
            edges = np.array(now.after.patches).ravel()
            if np.abs(edges - x[k]).min() < AT_AN_EDGE * now.after.width:
                continue
            known, since = (float(x[k]), float(np.sign(q[k]))), float(TAU[i])
            break
    if known is not None:
        margins = [margin_at(now, *known) for now in panel.equations]
        share = _root(in_time(np.array(margins)), since=since)
        if share is not None:
            yield Event(share, -1, opened=known)


def margin_at(now: StripEquations, x: float, sense: float) -> float:
    """The margin f p - s q at a place in stick, by interpolation between a few."""
    places, q, limit = now.stuck_shear
    order = np.argsort(places)
    return float(np.interp(x, places[order], (limit - sense * q)[order]))
