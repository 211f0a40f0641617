"""A part of a step on which something comes to stick, up to its first event (`events`).

The part is solved again until the event is at its end. An end that meets an edge comes near it in
parts, each of which leaves a fifth of the room.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from sie.errors import ContactError
from sie.numerics.zones import left_over

from .cells import zones_on_cells
from .events import AT_THE_END, UNRESOLVED, Event, first_event, is_there, margin_at
from .finite_step import Part
from .loading import MOMENTS, LoadStep, at_share, in_time
from .onset import End, Motion, Onset, resting_place, set_out
from .rates import Rates
from .state import EXCEEDED, TURNS, State, excess_in_stick, overlaps, refuse_inadmissible
from .strips import Panel, Span, solved_panel

Array = NDArray[np.float64]

LEAPS = 4.0 ** np.arange(-10, -3)  # of a part: so much longer it is after a leap
JUST_BEYOND = (1e-3, 1e-6)  # of a leap: so far an end is beyond it, at a guess
RELEASED = 1e-6  # of the largest f p: |q| so close to f p has reached it
SHORTER = 1.0 / 3.0  # of a part that is not solved
SHORTEST = 1e-9  # of a step: a part
NEARLY = 0.9999  # of τ: an event before it shortens the part
ON_MARK = 3e-9  # of the contact: an end that recedes and is so close to a mark is on it
SOON = 1e-5  # of a step: in a part so short an advancing end meets nothing
SMALL = 1e-2  # of the room: an end advances so far, at a guess
APPROACH = 0.8  # of what is left to an event that a part cannot end at
LONGER = 5.0  # times a part, where a longer one was not solved: the next
LEAP = 10.0  # times as far as the event is seen: so far the length of a part is corrected
BEFORE_IT = 0.95  # of the way to a mark: so far the next part goes
AGAIN = 16  # times a part is solved to end at its event
TWICE = 2.0  # times the length of an excess: slip that relieves it
SEEN = 1e-3  # of the contact: an end that moves less is not seen on cells
SENSELESS = 1e-2  # the same, of a part of which nothing is believed


def strip_part(
    state: State, step: LoadStep, begun: float, zones: Onset, last: Part | None = None
) -> Part:
    """The part from a share of a step on. Raises ContactError if none is found.

    last: the part before, which says how long this one may be, and by which ends are guessed first
    """
    rest, most = 1.0 - begun, last.longest if last else 1.0
    length, failed, guess = min(rest, most), 2.0, None
    aims: list[tuple[float, float, tuple[int, float | None]]] = []
    event: Event | None = None
    shorter: Panel | None = None  # one that is solved, before an event that was seen ahead of it
    ahead = np.inf  # from its end to that event
    for _ in range(AGAIN):
        span = Span(state, step, zones, begun, length)
        panel, event, good = _tried(span, guess, last, (event, length < failed))
        if not good and shorter is not None:
            longest = min(APPROACH * ahead, LONGER * shorter.span.length)
            return _ended(shorter, None, longest)
        if panel is None or not good:
            failed, length = length, SHORTER * length
            guess = None if panel is None else _places(panel, SHORTER**0.5)
            if length < SHORTEST:
                break
            continue
        if event is not None and event.share > 1.0 and length >= min(rest, most):
            ahead = event.ahead(length)  # it comes after the part
            event = replace(event, share=1.0) if is_there(panel, event) else None
        if event is None or abs(event.share - 1.0) < AT_THE_END:
            leapt = past_leap(panel, event, rest)
            longest = 1.0 if failed > 1.0 else LONGER * length
            longest = longest if event else min(longest, APPROACH * ahead)
            return leapt or _ended(panel, event, longest)
        if event.share > 1.0:
            shorter, ahead = panel, event.ahead(length)
        aims.append((length, length * event.share**2, (event.j, event.place)))
        before, length = length, min(_aimed(aims, shorter.span.length if shorter else 0.0), rest)
        if shorter is not None and length >= NEARLY * failed:  # that was tried
            longest = min(APPROACH * ahead, LONGER * shorter.span.length)
            return past_leap(shorter, event, rest) or _ended(shorter, None, longest)
        guess = _places(panel, (length / before) ** 0.5)
    raise ContactError("what sticks anew is not found in a part however short")


def with_receding_ends(
    state: State, step: LoadStep, begun: float, zones: Onset, last: Part | None
) -> Onset:
    """The zones with ends that leapt to where K = 0 and recede, where K rises as loads change."""
    ends, known = list(zones.ends), last.known if last else {}
    leapt = [j for j, e in enumerate(ends) if e.motion is Motion.ADVANCES and e.place not in known]
    if not leapt:
        return zones
    try:
        length = min(1.0 - begun, last.longest if last else 1.0)
        span = Span(state, step, zones, begun, length)
        K = span.rates(0, span.with_edges(np.tile(span.start, (MOMENTS, 1)))[0]).K.ravel()
    except ContactError:
        return zones
    for j in leapt:
        if ends[j].sense * K[j] > 0.0:
            ends[j] = replace(ends[j], motion=Motion.RECEDES)
    return zones.of_ends(ends)


def _tried(
    span: Span, guess: Array | None, last: Part | None, sought: tuple[Event | None, bool]
) -> tuple[Panel | None, Event | None, bool]:
    """A part of a length, its first event, and whether it is good up to that or to its end."""
    panel = None
    try:
        panel = _solved(span, guess, last.panel if last else None)
        if panel.unresolved > SENSELESS:
            return panel, None, False
        event = first_event(panel, *sought)
    except ContactError:
        return panel, None, False
    if event is not None and event.share <= NEARLY:  # what is doubtful may come after it
        return panel, event, True
    doubtful = panel.unresolved > UNRESOLVED or min(r.turning for r in panel.rates) < TURNS
    return panel, None if doubtful else event, not doubtful


def _aimed(aims: list[tuple[float, float, tuple[int, float | None]]], known: float) -> float:
    """The length of a part that ends at its event, from lengths and where events were seen.

    A length that is too long shows the event a little late, in proportion: by the secant. Beyond a
    mark places are not smooth: the next length is one before it, from one where it was ahead.
    """
    length, seen, event = aims[-1]
    if event[1] is not None and np.isfinite(event[1]):
        return seen if seen > length else known + BEFORE_IT * (seen - known)
    if len(aims) > 1 and aims[-2][2] == event:
        before, seen_before, _ = aims[-2]
        change = (seen - length) - (seen_before - before)
        step = -(seen - length) * (length - before) / change if change else 0.0
        if 0.0 < step * (seen - length) <= LEAP * (seen - length) ** 2 and length + step > 0.0:
            return length + step
    return seen


# -- guesses and interpolation -------------------------------------------------------------------


def _solved(span: Span, guess: Array | None, earlier: Panel | None) -> Panel:
    """The part from a guess; without one by the speeds that ends have had, then by cells."""
    if guess is not None:
        return solved_panel(span, guess)
    if earlier is not None:
        with suppress(ContactError):
            return solved_panel(span, _ahead(earlier, span))
    opened = span.onset.opened
    return solved_panel(span, _guess(span) if opened is None else _opened(span, opened))


def _ahead(panel: Panel, span: Span) -> Array:
    """The places of the ends at the end of a part, if they keep their speeds of the one before."""
    before = panel.span
    if before.motions != span.motions:
        raise ContactError("other ends move than before")
    series = in_time(np.concatenate(([before.start], panel.places)))
    slopes = np.asarray(np.polynomial.chebyshev.chebder(series), np.float64)
    final = span.start + span.length / before.length * at_share(slopes, 1.0)
    if not (np.diff(span.with_edges(np.tile(final, (MOMENTS, 1)))[-1]) > 0.0).all():
        raise ContactError("ends would meet")
    return np.asarray(final, dtype=np.float64)


def _opened(span: Span, k: int) -> Array:
    """The places of the ends at the moments, where ends k and k + 1 begin inside a stick zone.

    Where nothing slips there |q| exceeds f p, next to a mark in an excess m - κ |x - x0|. Slip with
    both ends bounded then has the length 2 m/κ.
    """
    panel = solved_panel(whole := replace(span, onset=span.onset.without(k)), _guess(whole))
    start, sense = span.start[k], span.onset.ends[k].sense
    opening = np.full((MOMENTS, 2), start)
    for i, now in enumerate(panel.equations):
        x, q, limit = now.stuck_shear
        order = np.argsort(x)
        x, margin = x[order], (limit - sense * q)[order]
        for side, outward in enumerate((-1.0, 1.0)):
            inside = np.flatnonzero((outward * (x - start) > 0.0) & (margin > 0.0))
            if inside.size:
                j = inside[-1] if outward < 0.0 else inside[0]
                share = margin[j] / (margin[j] - min(margin[j - int(outward)], 0.0))
                edge = x[j] + share * (x[j - int(outward)] - x[j])
                opening[i, side] = start + TWICE * (edge - start)
    return np.concatenate((panel.places[:, :k], opening, panel.places[:, k:]), axis=1)


def _guess(span: Span) -> Array:
    """The places of the ends at the end of a part, about."""
    final = _receded(span)
    zones = span.onset.placed(span.with_edges(np.tile(final, (MOMENTS, 1)))[-1])
    zones = zones.on(span.contacts[-1].patches)

    def rates(now: Onset) -> Rates:
        return now.rates(span.step.rates, span.step.friction, span.before.contact.period)

    for j in span.which(Motion.ADVANCES):
        place = resting_place(zones, rates, j)
        if place is None and span.length > SOON:
            raise ContactError("an advancing end meets an edge or another stick zone before")
        if place is None:
            place = final[j] + SMALL * (zones.outer(j) - final[j])
        zones = zones.moved(j, replace(zones.ends[j], place=place))
        final[j] = place
    return final


def _receded(span: Span) -> Array:
    """The places of the ends if none advances: where no cell shows them, as they set out."""
    before, step, final = span.before, span.step, span.start.copy()
    which = span.which(Motion.RECEDES)
    if not which:
        return final
    moved = span.length * set_out(before, span.onset, step.rates, step.friction)
    if np.abs(moved).max() <= SEEN * before.contact.width:
        return final + moved
    for cells in zones_on_cells(before, span.contacts[-1]):
        if len(cells.stick) == len(span.onset.zones):
            final[which] = np.ravel(cells.stick)[which]
            break
    return final


def _places(panel: Panel, share: float) -> Array:
    """The places of the ends at a share of τ."""
    return at_share(in_time(np.concatenate(([panel.span.start], panel.places))), share)


# -- an end that leaps ---------------------------------------------------------------------------


def past_leap(panel: Panel, event: Event | None, longest: float) -> Part | None:
    """A part a little longer than a solved one, at whose end an end has leapt to a mark.

    Where loads come back to what they were, q comes back to f p at nearly the same time from a mark
    of the shear to an end. Slip begins at the mark, and soon nothing sticks between it and the end.

    event     that at the end of the solved part: slip begins in stick, or an end comes to a mark
    longest   the length that the part has at most

    None where that is not admissible, as of slip that begins for the first time.
    """
    leap = event and (event.opened or _released(panel, event))
    if not leap:
        return None
    (place, sense), span, last = leap, panel.span, panel.places[-1]
    leaps = [
        j
        for j in span.which(Motion.RECEDES)
        if span.onset.ends[j].sense == sense and (place - last[j]) * (last[j ^ 1] - last[j]) > 0.0
    ]
    if not leaps:
        return None
    lengths = np.unique(np.minimum(span.length * (1.0 + LEAPS), longest))
    for length, beyond in product(lengths.tolist(), JUST_BEYOND):
        guess = panel.places.copy()
        guess[-1, leaps] = place + beyond * (place - last[leaps])
        try:
            found = solved_panel(replace(span, length=length), guess)
            if _has_leapt(found, place):
                state = found.equations[-1].state
                refuse_inadmissible(span.before, state, overlaps(span.before.stick, state.stick))
                return _ended(found, None)
        except ContactError:
            continue
    return None


def _released(panel: Panel, event: Event) -> tuple[float, float] | None:
    """The mark to which an end leaps from the one that it has come to, and the direction of slip.

    Between the two |q| is f p already.
    """
    if event.place is None or event.j not in panel.span.which(Motion.RECEDES):
        return None
    other, marks = panel.places[-1, event.j ^ 1], panel.span.before.marks
    inner = marks[(marks - event.place) * (other - marks) > 0.0]
    if not inner.size:
        return None
    place = float(inner[np.abs(inner - event.place).argmin()])
    sense, now = panel.span.onset.ends[event.j].sense, panel.equations[-1]
    margin = margin_at(now, 0.5 * (place + event.place), sense)
    return (place, sense) if margin <= RELEASED * now.after.peak else None


def _has_leapt(found: Panel, place: float) -> bool:
    """Whether an end has passed a place, and slip goes on in its direction."""
    stick, peak = found.equations[-1].zones.stick, found.span.contacts[-1].peak
    return (
        not any(a < place < b for a, b in stick)
        and np.abs(found.series[:, -2:]).max() / peak <= UNRESOLVED
        and found.rates[-1].turning >= TURNS
    )


# -- the end of a part ---------------------------------------------------------------------------


def _ended(panel: Panel, event: Event | None, longest: float = 1.0) -> Part:
    """The state at the end of a part, with the end of the event at its place."""
    span, ends = panel.span, panel.places[-1].copy()
    known = {}
    for j in span.which(Motion.ADVANCES):
        known[j] = span.onset.ends[j]
    if event is not None:
        known.pop(event.j, None)
        if event.place is not None and np.isfinite(event.place):
            ends[event.j] = event.place
        if event.then is not None:
            known[event.j] = event.then
    for j in span.which(Motion.RECEDES):
        apart = np.abs(span.before.marks - ends[j])
        if apart.min() <= ON_MARK * span.before.contact.width:
            ends[j] = span.before.marks[apart.argmin()]
    last = replace(panel, places=np.concatenate((panel.places[:-1], [ends])))
    what_next = {float(ends[j]): replace(end, place=float(ends[j])) for j, end in known.items()}
    opened = event.opened if event is not None else None
    equations = last.equations[-1]
    state = equations.state
    if excess_in_stick(state) > EXCEEDED:
        raise ContactError("|q| exceeds f p in stick where a part ends")
    if event is not None and event.arrives:
        state = _stuck_through(state, float(ends[event.j]))
        what_next |= _growing(state, panel.rates[-1])
    until = span.begun + span.length
    return Part(equations, state, span.begun, until, panel, what_next, opened, longest)


def _growing(state: State, rates: Rates) -> dict[float, End]:
    """The stuck edges that grow: at an arrival |K| = f K_p to what room was left."""
    stuck = np.array(state.stick).ravel()
    edges = zip(np.array(state.contact.patches).ravel(), rates.Kp.ravel(), strict=True)
    return {
        float(e): End(float(e), 0.0, Motion.GROWS) for e, Kp in edges if Kp > 0.0 and e in stuck
    }


def _stuck_through(state: State, place: float) -> State:
    """A state with the rest of the slip zone beside an end stuck, up to an edge or another zone."""
    lo, hi, _ = min(state.slip, key=lambda zone: min(abs(zone[0] - place), abs(zone[1] - place)))
    slip = tuple(zone for zone in state.slip if zone[:2] != (lo, hi))
    stick = left_over(state.contact.patches, tuple(zone[:2] for zone in slip), state.contact.period)
    return replace(state, stick=stick, slip=slip)
