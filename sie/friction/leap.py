"""The end of a stick zone that leaps over all that had slipped before.

Where loads come back to what they were, q comes back to f p at nearly the same time from a mark of
the shear to that end. What slips begins to slip at the mark, and soon nothing sticks between it and
the end. A part ends after that: the state there follows from the one at the start of the part.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from sie.errors import ContactError

from .admissible import EXCEEDED, built, excess_in_stick, opposing_slip
from .onset import Motion
from .state import overlaps
from .strips import Panel, solved_panel

LEAPS = 4.0 ** np.arange(-10, -3)  # of a part: so much longer it is after a leap
JUST_BEYOND = 1e-3  # of a leap: so far an end is beyond it, at a guess
UNRESOLVED = 1e-6  # of the largest f p: the last two coefficients of D
TURNS = -1e-7  # of the largest rate of slip
OPPOSING = 1e-10  # of the largest slip: by so much it may oppose its direction


def past_leap(panel: Panel, place: float, sense: float, longest: float) -> Panel | None:
    """A part a little longer than a solved one, at whose end an end has leapt to a place.

    place, sense   where slip begins in stick at the end of the solved part, and its direction
    longest        the length that the part has at most

    None where that is not admissible, as of slip that begins for the first time.
    """
    span, guess = panel.span, panel.places.copy()
    for j in span.which(Motion.RECEDES):
        inward = -1.0 if j % 2 else 1.0
        if span.onset.ends[j].sense == sense and (place - guess[-1, j]) * inward > 0.0:
            guess[-1, j] = place + JUST_BEYOND * (place - guess[-1, j])
    if (guess == panel.places).all():
        return None
    lengths = span.length * (1.0 + LEAPS)
    if lengths[-1] > longest:
        lengths = np.append(lengths[lengths < longest], longest)
    for length in lengths.tolist():
        try:
            found = solved_panel(replace(span, length=length), guess)
        except ContactError:
            continue
        if _has_leapt(found, place):
            return found
    return None


def _has_leapt(found: Panel, place: float) -> bool:
    """Whether an end has passed a place, and the state at the end of a part is admissible."""
    before, state = found.span.before, built(found.equations[-1])
    left = np.abs(found.series[:, -2:]).max() / state.contact.peak
    return (
        not any(a < place < b for a, b in state.stick)
        and left <= UNRESOLVED
        and found.rates[-1].turning >= TURNS
        and excess_in_stick(state) <= EXCEEDED
        and opposing_slip(before, state, overlaps(before.stick, state.stick)) <= OPPOSING
    )
