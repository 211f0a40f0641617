"""A stick zone that recedes at one end as the bodies touch, where growth is not in proportion.

The smallest contacts of unlike parabolas or wedges grow in proportion, whatever the profile is like
farther away: dm/dr = ν and dP/dr goes with a power of r. There the ends are those of `proportion`.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from sie.errors import ContactError

from .proportion import Proportion
from .receding_flat import receding_flat
from .spells import Course, Spell, in_proportion
from .zone_table import ZoneTable

SMALL = 1e-6  # of the half-width at the first break: the contacts that grow in proportion
ALIKE = 1e-4  # of dm/dr and of the power of dP/dr: what they may change by in these


def from_touch(course: Course, zones: ZoneTable, side: int, first_break: float) -> Spell:
    """The first spell, up to a small part of the half-width at the first break."""
    panel = course.panel
    small = min(SMALL * first_break, panel.length)
    ahead = small * np.array([0.25, 0.5, 1.0])
    turns, rates = panel.turn(ahead), panel.load_rate(ahead)
    powers = np.log2(rates[1:] / rates[:-1])
    if panel.lo or np.ptp(turns) > ALIKE or abs(powers[1] - powers[0]) > ALIKE:
        raise ContactError(
            "the contact moves aside faster than it grows where it touches first: its stick zone "
            "would recede at one end at once, which Goodman's approximation solves only where the "
            "smallest contacts grow in proportion, as those of a wedge or of two parabolas do; "
            "raise the friction, reduce the tilt, or give dundurs = 0 to neglect β"
        )
    turn, power = float(turns[1]), float(powers[1])
    growth = Proportion(receding_flat(zones.flat.ratio), abs(turn), power)
    part = replace(course, last=math.asinh(math.sqrt(small / panel.scale)))
    return in_proportion(part, zones, math.copysign(turn, side), growth.advance)
